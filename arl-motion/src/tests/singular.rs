//! Lines near singular points: what becomes of a way does not depend on how it is cut into motions.

use crate::queue::Recorder;
use crate::tests::*;
use arl_robot::robot::Family;
use nalgebra::{UnitQuaternion, Vector3};

/// A straight way of the TCP, on which the tool may turn, and where the axes stand at its start.
struct StraightPath {
    start: Joints,
    rig: Rig,
    from: Frame,
    travel: Vector3<f64>,
    turning: Vector3<f64>,
}

impl StraightPath {
    /// The TCP at a share of the way.
    fn at(&self, share: f64) -> Frame {
        let turned = UnitQuaternion::from_scaled_axis(self.turning * share) * self.from.rotation;
        Frame::from_parts((self.from.translation.vector + self.travel * share).into(), turned)
    }

    /// The way as so many lines.
    fn cut(&self, pieces: u32) -> Vec<Command> {
        let line = |piece: u32| {
            let pose = frame_components(&self.at(f64::from(piece) / f64::from(pieces)));
            Command { rig: self.rig, ..lin(pose) }
        };
        (1..=pieces).map(line).collect()
    }
}

/// A way that comes near a singular point of the robot somewhere, or not.
fn random_path(robot: &Robot, random: &mut Random) -> Option<StraightPath> {
    let mut number = |size: f64| random.between(-size, size);
    let tool = frame([number(50.0), number(50.0), 100.0 + number(100.0), number(90.0), 0.0, 0.0]);
    let size = 10.0_f64.powf(2.0 + number(1.0));
    let upright = robot.own_axes().len() < ROBOT_AXES;
    let travel = Vector3::new(number(size), number(size), number(size));
    let turns = if random.between(0.0, 1.0) < 0.5 { 0.0 } else { 0.5 };
    let turning = [0; 3].map(|_| random.between(-turns, turns));
    let turning = if upright { Vector3::new(0.0, 0.0, turning[2]) } else { Vector3::from(turning) };
    let mut middle = random_joints(robot, random, 0.6).axes;
    let near = 10.0_f64.powf(random.between(-4.0, 1.0)) * if random.between(0.0, 1.0) < 0.5 { 1.0 } else { -1.0 };
    match (upright, random.between(0.0, 3.0) as u32) {
        (true, _) => middle[1] = near,
        (false, 0) => middle[2] += near,
        (false, _) => middle[4] = near,
    }
    let (kinematics, rig) = (&robot.kinematics, Rig::with_tool(tool));
    let pose = kinematics.forward(&middle) * tool;
    let back = random.between(0.1, 0.9);
    let from = Frame::from_parts(
        (pose.translation.vector - travel * back).into(),
        UnitQuaternion::from_scaled_axis(-turning * back) * pose.rotation,
    );
    let start = kinematics.inverse(&rig.carried.flange_at(&from), kinematics.cfg(&middle), &middle)?;
    let inside = robot.own_axes().iter().zip(&start).all(|(axis, value)| *value > axis.min && *value < axis.max);
    inside.then_some(StraightPath { start: axes(start), rig, from, travel, turning })
}

/// What becomes of motions one behind the other, each of which starts where the one before has ended. A target that
/// cannot be reached is told before what is wrong with the way there, so that the reason of a refusal may depend on
/// where targets are.
fn outcome(robot: &Robot, start: &Joints, commands: &[Command]) -> &'static str {
    let mut start = *start;
    for command in commands {
        match plan(robot, &start, command, &Settings::default()) {
            Ok(motion) => start = *motion.end(),
            Err(PlanError::Singular { .. } | PlanError::Wrist { .. }) => return "singular",
            Err(PlanError::Unreachable { .. }) => return "unreachable",
            Err(PlanError::AxisLimit { .. }) => return "range",
            Err(error) => panic!("{error}"),
        }
    }
    "reached"
}

#[test]
fn a_path_has_the_same_outcome_however_it_is_cut() {
    let mut random = Random::new(49);
    let (mut seen, mut differ) = (std::collections::BTreeSet::new(), Vec::new());
    for name in Robot::builtin_names() {
        let robot = robot(name);
        for number in 0..400 {
            let Some(path) = random_path(&robot, &mut random) else { continue };
            let outcomes = [1, 2, 4, 8].map(|pieces| outcome(&robot, &path.start, &path.cut(pieces)));
            let reached = outcomes.map(|outcome| outcome == "reached");
            if reached != [reached[0]; 4] {
                let (travel, turning) = (path.travel.as_slice(), path.turning.as_slice());
                differ.push(format!("{name} {number}: {outcomes:?}, {:?} {travel:?} {turning:?}", path.start.axes));
            }
            seen.insert((name, outcomes[0]));
        }
    }
    assert!(differ.is_empty(), "{} differ\n{}", differ.len(), differ.join("\n"));
    // All robots pass singular points, and meet others: those of a SCARA are the edge of its reach.
    for name in Robot::builtin_names() {
        let met = if robot(name).family == Family::SixAxis { "singular" } else { "unreachable" };
        assert!(["reached", met].iter().all(|outcome| seen.contains(&(name, *outcome))), "{name}: {seen:?}");
    }
}

#[test]
fn the_axes_pass_close_by_at_a_lower_speed_within_all_limits() {
    let (mut random, mut slowed) = (Random::new(50), 0);
    for name in Robot::builtin_names() {
        let robot = robot(name);
        for number in 0..100 {
            let Some(path) = random_path(&robot, &mut random) else { continue };
            let mut queue = Queue::repeatable(robot.clone(), path.start);
            let commands = path.cut(1 + number % 3);
            if !commands.iter().all(|command| queue.add(command, &Settings::default()).is_ok()) {
                continue;
            }
            let rows = run(&mut queue, 100.0);
            let what = format!("{name} {number}: {:?} {:?}", path.start.axes, path.travel.as_slice());
            assert_within_limits(&robot, &rows, &what);
            for row in rows.iter().filter(|row| row.motion > 0) {
                let (off, _) = off_line(&path.at(0.0), &path.at(1.0), &row.tcp);
                assert!(off < 1e-3, "{what}: {off} mm off the line");
            }
            slowed += u32::from(usage(&robot, &rows)[0] > 0.9);
        }
    }
    assert!(slowed > 5, "{slowed} with an axis at its limit of speed");
}

#[test]
fn a_line_past_the_wrist_singularity_is_slow_there_in_one_piece_and_in_three() {
    let robot = robot("kr10-r1420");
    let pose = |y: f64| [890.0, y, 1080.2, 0.0, 90.0, 0.0];
    let cfg = robot.kinematics.cfg(&[0.0, -90.0, 90.0, 0.0, 20.0, 0.0]);
    // How long it takes, in cycles, and how slow each line has to be.
    let moved = |targets: &[f64]| {
        let mut queue = Queue::repeatable(robot.clone(), axes([0.0, -90.0, 90.0, 0.0, 20.0, 0.0]));
        let mut recorder = Recorder::new(robot.clone(), &mut queue);
        let speed = Speed { tcp: 100.0, ..fast() };
        let lines = targets.iter().map(|y| Command { speed, ..lin(pose(*y)) });
        for command in [ptp(pose(-100.0), cfg)].into_iter().chain(lines) {
            let number = queue.add(&command, &Settings::default()).unwrap();
            recorder.planned(&mut queue, number, &command, &Settings::default());
        }
        let rows = run(&mut queue, 100.0);
        recorder.step(&mut queue, &rows[rows.len() - 1]);
        assert_within_limits(&robot, &rows, "past the singularity");
        (rows.len(), recorder.records().iter().map(|record| record.slowed).collect::<Vec<_>>())
    };
    let [(whole, slowed), (cut, slowed_in_three)] = [moved(&[100.0]), moved(&[-33.0, 33.0, 100.0])];
    assert!(whole < cut, "{whole} cycles, {cut} in three pieces");
    // It is told where, and how slow, however the way is cut.
    let ([None, Some(one)], [None, None, Some(middle), None]) = (&slowed[..], &slowed_in_three[..]) else {
        panic!("{slowed:?} {slowed_in_three:?}");
    };
    assert_eq!((one.axis, one.unit), (middle.axis, middle.unit));
    assert!((one.along - 0.5).abs() < 1e-3 && (middle.along - 0.5).abs() < 1e-3, "{one:?} {middle:?}");
    assert!(one.speed < 50.0 && (one.speed / middle.speed - 1.0).abs() < 0.01, "{one:?} {middle:?}");
}
