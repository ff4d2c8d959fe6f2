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
use grow::{Kind, Plan, Room, Zone, grow};
use robot::Robot;
use std::path::Path;
use trace::Row;

/// Where each robot can move freely.
const ROOMS: [(&str, Room); 5] = [
    ("kr10-r1420", Room { joints: [0.0, -90.0, 90.0, 0.0, 45.0, 0.0], swing: 12.0, reach: 120.0 }),
    ("kr6-r700", Room { joints: [10.0, -90.0, 100.0, 5.0, 45.0, 0.0], swing: 8.0, reach: 50.0 }),
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
            let rows = trace::read(&std::fs::read_to_string(file("csv")).unwrap());
            let faults = check::check(&self.robot, &self.plan, &rows);
            if at == 0 && faults.is_empty() {
                self.assert_objections(&rows);
            }
            faults
        } else {
            vec![format!("{}: {}", run.status, String::from_utf8_lossy(&run.stderr))]
        };
        (!faults.is_empty()).then(|| self.failure(project, &faults))
    }

    /// The checks would find a jolt, a line that is none, a missed target, and zones that are too small for the blends.
    fn assert_objections(&self, rows: &[Row]) {
        let finds = |plan: &Plan, rows: &[Row], what: &str| {
            let faults = check::check(&self.robot, plan, rows);
            assert!(faults.iter().any(|fault| fault.contains(what)), "nobody objects: {what}; {faults:?}");
        };
        let mut jolt = rows.to_vec();
        jolt[rows.len() / 2].axes[0] += 1e-4;
        finds(&self.plan, &jolt, "the jerk of j1");
        let (mut bent, mut missed) = (rows.to_vec(), rows.to_vec());
        for motion in &self.plan.motions {
            let own: Vec<usize> = (0..rows.len()).filter(|at| rows[*at].line == motion.line).collect();
            if motion.kind == Kind::Lin {
                bent[own[own.len() / 2]].tcp = rows[own[own.len() / 2]].tcp.map(|x| x + 0.01);
            }
            if motion.line == self.plan.motions[self.plan.motions.len() - 1].line {
                missed[own[own.len() - 1]].tcp[0] += 1e-4;
            }
        }
        finds(&self.plan, &bent, "off the path");
        finds(&self.plan, &missed, "is missed");
        let mut narrow = self.plan.clone();
        for motion in &mut narrow.motions {
            motion.zone = match motion.zone {
                Zone::Distance(size) => Zone::Distance(size / 10.0),
                other => other,
            };
        }
        finds(&narrow, rows, "from the corner of line");
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
