//! What is said of a run as a whole, in words.

use crate::context::standstill::Standstill;
use crate::controller::Controller;
use crate::cycle::clock_source::Lateness;

/// Warnings about what was too late in a run in real time.
pub(super) fn lateness(controller: &Controller) -> Vec<String> {
    let mut warnings = Vec::new();
    if let Some(missing) = controller.lateness().map(Lateness::missing).filter(|missing| *missing > 0) {
        let messages = if missing == 1 { "message" } else { "messages" };
        warnings.push(format!(
            "{missing} {messages} from the robot did not arrive: the robot did not send, or the network lost them; as many control cycles were lost"
        ));
    }
    if let Some(lateness) = controller.lateness().filter(|lateness| lateness.late() > 0) {
        let (late, longest) = (lateness.late(), lateness.longest().as_secs_f64() * 1e3);
        let lost = lateness.lost() - lateness.missing();
        warnings.push(format!(
            "the computer was too busy: {late} control cycles began late, the latest by {longest:.1} ms; {lost} were lost"
        ));
    }
    if controller.found_late() > 0 {
        let advice = if cfg!(debug_assertions) { "; `arl2rs build --release` makes a faster program" } else { "" };
        warnings.push(format!(
            "the computer was too busy to find the motion ahead in time, {} times: robots may have moved more slowly, or stopped on their path{advice}",
            controller.found_late()
        ));
    }
    warnings
}

/// A warning where events for a listener were left out.
pub(super) fn lost_events_warning(lost: u64) -> Option<String> {
    (lost > 0).then(|| format!("the listener was too slow for real time: events were left out {lost} times"))
}

/// The programs that wait in vain and what they wait for, each with its channel where there are several.
pub(super) fn listed(waiting: &[Standstill]) -> Vec<String> {
    let are_many = waiting.len() > 1;
    let line = |one: &Standstill| if are_many { format!("{}: {one}", one.channel) } else { one.to_string() };
    waiting.iter().map(line).collect()
}

/// The message of a run that has reached its time limit, in s.
pub(super) fn time_is_over(controller: &Controller, limit: f64) -> String {
    let place = match controller.place() {
        // Code that only calculates sets no line.
        (file, 0) => format!("is calculating in {}", file.name()),
        (file, line) => format!("is at {}:{line}", file.name()),
    };
    format!("the time limit of {limit} s has passed; the program {place}")
}
