//! Random motion programs on robots that are built in, and on others with random limits: what the trace says about limits,
//! paths, corners and targets.

mod check;
mod grow;
mod robot;
mod trace;
mod vector;

use crate::{first_seed, report, times};
use arl_tests::project::{Project, compile};
use arl_tests::random::Random;
use grow::{Plan, Room, grow};
use robot::Robot;
use std::path::Path;

/// Where each robot can move freely.
const ROOMS: [(&str, Room); 5] = [
    ("kr10-r1420", Room { joints: [0.0, -90.0, 90.0, 0.0, 45.0, 0.0], swing: 12.0, reach: 120.0 }),
    ("kr6-r700", Room { joints: [10.0, -90.0, 100.0, 5.0, 45.0, 0.0], swing: 12.0, reach: 70.0 }),
    ("irb2400-10", Room { joints: [0.0, 10.0, 10.0, 5.0, 45.0, 0.0], swing: 12.0, reach: 120.0 }),
    ("tx2-60", Room { joints: [0.0, 20.0, 70.0, 5.0, 45.0, 0.0], swing: 12.0, reach: 60.0 }),
    ("six-10", Room { joints: [0.0, 10.0, 20.0, 5.0, 45.0, 0.0], swing: 12.0, reach: 120.0 }),
];

struct Case {
    seed: u64,
    robot: Robot,
    plan: Plan,
}

impl Case {
    fn new(seed: u64) -> Case {
        let mut random = Random::new(seed);
        let (name, room) = ROOMS[seed as usize % ROOMS.len()];
        let robot = Robot::named(name);
        let robot = if random.chance(50) { robot.otherwise(&mut random) } else { robot };
        Case { seed, robot, plan: grow(&mut random, room, 30) }
    }

    /// Runs the program `at` of a command, and tells what is wrong with its trace.
    fn run(&self, project: &Project, command: &Path, at: usize) -> Option<String> {
        let file = |ending: &str| project.folder().join(format!("{}.{ending}", self.seed));
        std::fs::write(file("robot.toml"), &self.robot.text).unwrap();
        std::fs::write(file("arl"), &self.plan.text).unwrap();
        let mut run = project.choose(command, at);
        run.arg("--robot").arg(file("robot.toml")).arg("--trace").arg(file("csv")).args(["--max-time", "600"]);
        let run = run.output().unwrap();
        let faults = if run.status.success() {
            check::check(&self.robot, &self.plan, &trace::read(&std::fs::read_to_string(file("csv")).unwrap()))
        } else {
            vec![format!("{}: {}", run.status, String::from_utf8_lossy(&run.stderr))]
        };
        (!faults.is_empty()).then(|| self.failure(project, &faults))
    }

    fn failure(&self, project: &Project, faults: &[String]) -> String {
        let files = project.folder().join(format!("{}.*", self.seed));
        let faults = faults.join("\n");
        format!("seed {} on {}, see {}\n{faults}\n{}", self.seed, self.robot.name, files.display(), self.plan.text)
    }
}

#[test]
fn motions_keep_limits_paths_corners_and_targets() {
    let cases: Vec<Case> = (first_seed()..first_seed() + 10 * times()).map(Case::new).collect();
    let project = Project::new(env!("CARGO_TARGET_TMPDIR"), "arl-property-motions");
    let mut failures = Vec::new();
    let mut programs = Vec::new();
    for case in &cases {
        match compile(&[("main.arl".into(), case.plan.text.clone())]) {
            Ok(rust) => programs.push(rust),
            Err(errors) => failures.push(case.failure(&project, &[errors])),
        }
    }
    report(&project, failures);
    let command = project.build_choosing(&programs).unwrap_or_else(|errors| panic!("{errors}"));
    // Two at a time: a run takes some seconds.
    let all: Vec<(usize, &Case)> = cases.iter().enumerate().collect();
    let failures = std::thread::scope(|scope| {
        let halves = [0, 1].map(|half| {
            let cases = all.iter().skip(half).step_by(2);
            let (project, command) = (&project, &command);
            scope.spawn(move || -> Vec<String> {
                cases.filter_map(|(at, case)| case.run(project, command, *at)).collect()
            })
        });
        halves.map(|half| half.join().expect("a thread")).concat()
    });
    report(&project, failures);
}
