//! Random targets with random tools and workpieces on the robots that are built in: what `check --robot` says of them
//! before the program runs is what the runtime says then.

use crate::{BY_ENGINE, first_seed, report, times};
use arl_robot::Robot;
use arl_robot::frames::{Mount, Setting};
use arl_robot::kinematics::{Axes, Frame, frame, frame_components};
use arl_tests::engine;
use arl_tests::project::{Files, Project};
use arl_tests::random::Random;
use arl2rs::lower::lower;
use arl2rs::{CheckOptions, check_text};
use std::path::Path;

struct Case {
    seed: u64,
    robot: Robot,
    instruction: &'static str,
    text: String,
}

/// A program that goes from one random place to another: by the axes, to a pose, or along a line.
fn grow(seed: u64) -> Case {
    let mut random = Random::new(seed);
    let names: Vec<&str> = Robot::builtin_names().collect();
    let robot = Robot::builtin(names[random.below(names.len())]).unwrap();
    let instruction = *random.pick(&["movej", "ptp", "ptp", "ptp", "lin", "lin", "lin"]);
    let start = joints(&robot, |_, min, max| between(&mut random, 0.8 * min, 0.8 * max));
    let axes = if instruction == "lin" {
        joints(&robot, |at, min, max| start[at] + between(&mut random, -0.1, 0.1) * (max - min))
    } else {
        joints(&robot, |_, min, max| between(&mut random, 1.1 * min, 1.1 * max))
    };
    let [tool, wobj] = mounts(&mut random);
    let mut flange = robot.kinematics.forward(&axes);
    if random.chance(40) {
        flange.translation.vector.x += between(&mut random, -200.0, 400.0);
    }
    let setting = Setting::new(tool_mount(&tool), wobj_mount(&wobj), Frame::identity());
    let pose = frame_components(&setting.pose_of(&flange));
    let own = robot.own_axes().len();
    let cfg = if random.chance(70) { robot.kinematics.cfg(&axes) } else { *random.pick(&[0, 2, 4, 6]) };
    let target = match instruction {
        "movej" => format!("j:{}", list(&axes[..own])),
        _ => format!("p:{{{},{cfg}}}", numbers(&pose)),
    };
    let labels = |tool: &(bool, [f64; 6]), label: &str| format!(",{label}:{{{},{}}}", list(&tool.1), tool.0);
    let (t, w) = (labels(&tool, "t"), labels(&wobj, "w"));
    let labels = if instruction == "movej" { String::new() } else { t + &w };
    let text = format!(
        "func void main()\n    movej j:{},vp:100\n    {instruction} {target}{labels},vp:100\nendfunc\n",
        list(&start[..own])
    );
    Case { seed, robot, instruction, text }
}

fn between(random: &mut Random, low: f64, high: f64) -> f64 {
    low + (high - low) * (random.next() >> 11) as f64 / (1_u64 << 53) as f64
}

/// Rounded, as programs have it.
fn joints(robot: &Robot, mut value: impl FnMut(usize, f64, f64) -> f64) -> Axes {
    let mut axes = [0.0; 6];
    for (at, (place, axis)) in axes.iter_mut().zip(robot.own_axes()).enumerate() {
        *place = (value(at, axis.min, axis.max) * 1e3).round() / 1e3;
    }
    axes
}

/// Tool and workpiece as programs give them: whether the tool is stationary or the workpiece held, and the frame.
/// Upright, so that they suit a SCARA, too, most of the time.
fn mounts(random: &mut Random) -> [(bool, [f64; 6]); 2] {
    let held = random.chance(25);
    [0, 1].map(|_| {
        let mut place = [0.0; 6];
        if random.chance(70) {
            let tilt = if random.chance(30) { 60.0 } else { 0.0 };
            let most = [80.0, 80.0, 200.0, 180.0, tilt, tilt];
            place = most.map(|most| (between(random, -most, most) * 1e3).round() / 1e3);
        }
        (held, place)
    })
}

fn tool_mount((stationary, place): &(bool, [f64; 6])) -> Mount {
    Mount { frame: frame(*place), on_flange: !stationary }
}

fn wobj_mount((held, place): &(bool, [f64; 6])) -> Mount {
    Mount { frame: frame(*place), on_flange: *held }
}

fn numbers(values: &[f64]) -> String {
    values.iter().map(|value| format!("{value:?}")).collect::<Vec<_>>().join(",")
}

fn list(values: &[f64]) -> String {
    format!("{{{}}}", numbers(values))
}

#[test]
fn warnings_of_targets_come_true() {
    let cases: Vec<Case> = (first_seed()..first_seed() + 120 * times()).map(grow).collect();
    let project = Project::new(env!("CARGO_TARGET_TMPDIR"), "arl-property-targets");
    std::fs::create_dir_all(project.folder()).unwrap();
    let mut codes = Vec::new();
    let mut warned: Vec<Vec<u16>> = Vec::new();
    for case in &cases {
        let options =
            CheckOptions { family: case.robot.family, robot: Some(case.robot.clone()), ..CheckOptions::default() };
        let checked = check_text(Path::new("main.arl"), &case.text, &Files::default(), &options);
        let program = checked.program.as_ref().unwrap_or_else(|| panic!("{:?}\n{}", checked.diagnostics, case.text));
        codes.push(lower(program).unwrap());
        warned.push(checked.diagnostics.iter().map(|found| found.code.0).collect());
    }
    let mut failures = Vec::new();
    let mut seen = std::collections::BTreeMap::new();
    let file = project.folder().join("code");
    for ((case, warned), code) in cases.iter().zip(&warned).zip(codes) {
        engine::write(code, &file);
        let mut run = engine::command(Path::new(BY_ENGINE), &file, project.folder());
        let run = run.arg("--robot").arg(&case.robot.name).output().unwrap();
        let stderr = String::from_utf8_lossy(&run.stderr);
        let alarm = !run.status.success();
        // On its way a line may meet more than is looked at before.
        let right = if case.instruction == "lin" && warned.is_empty() {
            !stderr.contains("at the target")
        } else {
            alarm != warned.is_empty()
        };
        if !right {
            failures.push(format!(
                "seed {} on {}: {warned:?}, but {}\n{stderr}{}",
                case.seed, case.robot.name, run.status, case.text
            ));
        }
        warned.iter().for_each(|code| *seen.entry(*code).or_insert(0) += 1);
        *seen.entry(u16::from(alarm)).or_insert(0) += 1;
    }
    report(&project, failures);
    // All of them come, and so do targets that are reached.
    for code in [0, 907, 908, 909, 910] {
        assert!(seen.contains_key(&code), "no case of {code}: {seen:?}");
    }
}
