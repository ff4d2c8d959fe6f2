//! A run on the virtual clock in which a program only polls in a loop: reported once, with the lines, so that nobody
//! waits before a silent screen.

use std::time::{Duration, Instant};

use crate::controller::Controller;
use crate::fault::File;

/// How many cycles are between two checks.
const EVERY: u32 = 64;
/// How long the lines of the loop are collected.
const LEARNS: Duration = Duration::from_secs(1);
/// How long nothing else must happen before it is reported.
const PATIENCE: Duration = Duration::from_secs(5);

/// Watches where a program is, in real time.
pub(super) struct Polling {
    started: Instant,
    cycles: u32,
    watched: Watched,
}

impl Polling {
    pub(super) fn new() -> Self {
        Self { started: Instant::now(), cycles: 0, watched: Watched::default() }
    }

    /// To be called after each cycle; returns the message, once.
    pub(super) fn cycle_ended(&mut self, controller: &Controller) -> Option<String> {
        self.cycles = self.cycles.wrapping_add(1);
        if !self.cycles.is_multiple_of(EVERY) {
            return None;
        }
        let (file, line) = controller.place();
        let place = (line > 0 && !controller.moves()).then_some((file, line));
        self.watched.look(self.started.elapsed(), controller.time(), place)
    }
}

/// The lines in which a program has been for some time.
#[derive(Default)]
struct Watched {
    stay: Option<Stay>,
    is_reported: bool,
}

struct Stay {
    file: File,
    first: u32,
    last: u32,
    /// When it began, in real time.
    began: Duration,
    /// When it began in controller time, in s.
    time: f64,
}

impl Watched {
    /// Notes where the program is, `None` where a robot moves or the program only calculates; `now` is real time,
    /// `time` that of the controller in s.
    fn look(&mut self, now: Duration, time: f64, place: Option<(File, u32)>) -> Option<String> {
        let Some((file, line)) = place.filter(|_| !self.is_reported) else {
            self.stay = None;
            return None;
        };
        let known = self.stay.as_mut().filter(|stay| {
            let learns = now.saturating_sub(stay.began) < LEARNS;
            stay.file == file && (learns || (stay.first..=stay.last).contains(&line))
        });
        let Some(stay) = known else {
            self.stay = Some(Stay { file, first: line, last: line, began: now, time });
            return None;
        };
        (stay.first, stay.last) = (stay.first.min(line), stay.last.max(line));
        if now.saturating_sub(stay.began) < PATIENCE {
            return None;
        }
        self.is_reported = true;
        let lines = if stay.first == stay.last {
            format!("{}:{}", stay.file.name(), stay.first)
        } else {
            format!("{}:{} to {}", stay.file.name(), stay.first, stay.last)
        };
        let seconds = time - stay.time;
        Some(format!(
            "the program has been at {lines} for {seconds:.0} s of controller time, and no robot moves; if a loop \
             polls a signal there, use `waituntil`, which says what it waits for; `--max-time` ends such a run"
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fault::File;

    fn look(watched: &mut Watched, seconds: u64, line: u32) -> Option<String> {
        let place = (line > 0).then_some((File::new("pick.arl"), line));
        watched.look(Duration::from_secs(seconds), 100.0 * seconds as f64, place)
    }

    #[test]
    fn a_loop_that_asks_is_reported_once() {
        let mut watched = Watched::default();
        for (second, line) in [(0, 3), (0, 2), (1, 3), (4, 2)] {
            assert_eq!(look(&mut watched, second, line), None);
        }
        let warning = look(&mut watched, 5, 3).unwrap();
        assert!(warning.contains("pick.arl:2 to 3 for 500 s"), "{warning}");
        assert_eq!(look(&mut watched, 20, 3), None);
    }

    #[test]
    fn a_program_that_goes_on_or_moves_is_left_alone() {
        let mut watched = Watched::default();
        for second in 0..20 {
            assert_eq!(look(&mut watched, second, 10 + second as u32), None, "it goes from line to line");
        }
        for second in 20..40 {
            assert_eq!(look(&mut watched, second, if second % 4 == 0 { 0 } else { 7 }), None, "it moves");
        }
    }
}
