//! The promise of zones: rounding a chain off never takes longer than stopping at each of its targets.

use super::Case;
use super::check::Tally;
use super::plan::{Kind, Plan};
use super::trace::Row;
use crate::{first_seed, report, times};
use arl_tests::project::Project;

/// What is promised: so many times the time with exact stops, and so many s.
const FACTOR: f64 = 1.003;
const ALLOWANCE: f64 = 0.002;

/// A case twice: with its zones, and with exact stops.
struct Pair {
    zones: Case,
    stops: Case,
}

impl Pair {
    fn new(seed: u64) -> Pair {
        let Case { name, robot, plan, scenario } = Case::new(seed);
        let zones = Plan::read(&uniform(&plan.text), &robot.tcp);
        let stops = Plan::read(&stopping(&zones), &robot.tcp);
        let case = |ending: &str, plan: Plan| Case {
            name: format!("{name}-{ending}"),
            robot: robot.clone(),
            plan,
            scenario: scenario.clone(),
        };
        Pair { zones: case("zones", zones), stops: case("stops", stops) }
    }

    /// What is slower with zones; notes how much of the time with stops each part of the program takes.
    fn test(&self, project: &Project, tally: &mut Tally) -> Option<String> {
        let run = |case: &Case| {
            case.write(project);
            case.run(project, case.by_engine(project), false)
        };
        let (zones, stops) = match (run(&self.zones), run(&self.stops)) {
            (Ok(zones), Ok(stops)) => (zones, stops),
            (Err(failure), _) => return self.zones.refused(project, failure, tally),
            (_, Err(failure)) => return self.stops.refused(project, failure, tally),
        };
        let mut faults = Vec::new();
        let (mut zones_from, mut stops_from) = (0.0, 0.0);
        let mut from = 0;
        for motion in self.zones.plan.motions.iter().filter(|motion| motion.waits) {
            let ends = [&zones, &stops].map(|rows| end(rows, motion.line));
            let [zones_to, stops_to] = ends;
            let (with, without) = (zones_to - zones_from, stops_to - stops_from);
            tally.note("promise: of the time with stops", with / without);
            if with > FACTOR * without + ALLOWANCE {
                let (share, line) = (with / without, motion.line);
                faults.push(format!(
                    "lines {from} to {line}: {with:.3} s with zones, {without:.3} s with stops: {share:.4}"
                ));
            }
            (zones_from, stops_from, from) = (zones_to, stops_to, motion.line);
        }
        (!faults.is_empty()).then(|| self.zones.failure(project, &faults))
    }
}

impl Case {
    /// What is wrong with a run that failed: nothing where it went through the wrist by a way that ended an axis's
    /// range.
    fn refused(&self, project: &Project, failure: String, tally: &mut Tally) -> Option<String> {
        if self.turned_out(&failure).is_some() {
            tally.note("promise: not compared, as an axis would leave its range", 0.0);
            return None;
        }
        Some(self.failure(project, &[failure]))
    }
}

/// When the motion of a line is done.
fn end(rows: &[Row], line: usize) -> f64 {
    rows.iter().rfind(|row| row.line == line).expect("rows of each motion").t
}

/// A program of which the promise is given: in one profile, at one acceleration, no motion of which has its time given.
fn uniform(text: &str) -> String {
    let mut profiles = 0;
    let line = |line: &str| {
        let head = line.trim_start();
        profiles += usize::from(head.starts_with("$VEL_PROFILE"));
        match head.split(' ').next() {
            Some("accset") => "  //".to_owned(),
            Some("$VEL_PROFILE") if profiles > 1 => "  //".to_owned(),
            _ => match line.split_once(",dura:") {
                Some((before, after)) => {
                    let rest = after.find(',').map_or("", |at| &after[at..]);
                    format!("{before}{rest}")
                }
                None => line.to_owned(),
            },
        }
    };
    text.lines().map(line).map(|line| line + "\n").collect()
}

/// A program that stops at each target.
fn stopping(plan: &Plan) -> String {
    let mut lines: Vec<String> = plan.text.lines().map(str::to_owned).collect();
    for (at, motion) in plan.motions.iter().enumerate() {
        if !plan.motions.get(at + 1).is_some_and(|next| motion.goes_on_into(next)) {
            let line = &mut lines[motion.line - 1];
            *line = without_zone(line, motion.kind);
        }
    }
    lines.into_iter().map(|line| line + "\n").collect()
}

fn without_zone(line: &str, kind: Kind) -> String {
    if matches!(kind, Kind::Jump(_)) {
        return line.replace(",s:true", ",s:false");
    }
    let zone = |label: &'static str| line.find(&format!(",{label}:")).map(move |at| (at, label));
    let Some((at, label)) = ["sl", "sp", "s"].into_iter().find_map(zone) else { return line.to_owned() };
    let value = &line[at + label.len() + 2..];
    let end = if value.starts_with('{') { value.find('}').map(|at| at + 1) } else { value.find(',') };
    format!("{},sl:-1{}", &line[..at], &value[end.unwrap_or(value.len())..])
}

#[test]
fn zones_are_never_slower_than_stops() {
    let pairs: Vec<Pair> = (first_seed()..).map(Pair::new).take(8 * times() as usize).collect();
    let project = Project::new(env!("CARGO_TARGET_TMPDIR"), "arl-property-promise");
    std::fs::create_dir_all(project.folder()).unwrap();
    let halves = std::thread::scope(|scope| {
        let halves = [0, 1].map(|half| {
            let (project, pairs) = (&project, &pairs);
            scope.spawn(move || -> (Vec<String>, Tally) {
                let mut tally = Tally::default();
                let own = pairs.iter().skip(half).step_by(2);
                (own.filter_map(|pair| pair.test(project, &mut tally)).collect(), tally)
            })
        });
        halves.map(|half| half.join().expect("a thread"))
    });
    let mut tally = Tally::default();
    halves.iter().for_each(|(_, own)| tally.add(own));
    println!("{tally}");
    report(&project, halves.into_iter().flat_map(|(failures, _)| failures).collect());
}
