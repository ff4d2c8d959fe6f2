//! Gates of SCARA robots.

use crate::tests::*;

fn plain(rise: f64, sink: f64) -> Gate {
    Gate {
        rise,
        sink,
        highest: None,
        rising: Lift::default(),
        falling: Lift::default(),
        smooth: false,
        part: GatePart::Whole,
    }
}

fn at(axes: [f64; 4]) -> Joints {
    let [j1, j2, j3, j4] = axes;
    crate::tests::axes([j1, j2, j3, j4, 0.0, 0.0])
}

fn jump(robot: &Robot, to: &Joints, gate: Gate) -> Command {
    let flange = robot.kinematics.forward(&to.axes);
    let wanted = Wanted { cfg: Some(robot.kinematics.cfg(&to.axes)), turn: -1 };
    let (pose, wobj) = (frame_components(&flange), Frame::identity());
    command(Target::Gate { pose, wobj, wanted, external: to.external, gate })
}

/// Runs one gate, and returns the highest j3.
fn run_gate(robot: &Arc<Robot>, from: &Joints, to: &Joints, gate: Gate, settings: &Settings) -> (Vec<Step>, f64) {
    let mut queue = Queue::repeatable(robot.clone(), *from);
    assert_eq!(queue.add(&jump(robot, to, gate), settings), Ok(1));
    let rows = run(&mut queue, 100.0);
    let highest = rows.iter().map(|row| row.joints.axes[2]).fold(f64::NEG_INFINITY, f64::max);
    (rows, highest)
}

#[test]
fn a_gate_goes_straight_up_over_and_straight_down() {
    let mut random = Random::new(61);
    for name in ["hsr065", "cobra600"] {
        let robot = robot(name);
        let lift = robot.axes[2].clone();
        for round in 0..30 {
            let (from, to) = (random_joints(&robot, &mut random, 0.6), random_joints(&robot, &mut random, 0.6));
            let distances = (random.between(0.0, 60.0), random.between(0.0, 60.0));
            let (rise, sink) = if round % 5 == 0 { (0.0, 0.0) } else { distances };
            let (rows, highest) = run_gate(&robot, &from, &to, plain(rise, sink), &Settings::default());
            assert_within_limits(&robot, &rows, &format!("{name} {round}"));
            let last = rows.last().unwrap();
            let target = robot.kinematics.forward(&to.axes);
            assert!((last.tcp.translation.vector - target.translation.vector).norm() < 1e-6);
            // Maybe a turn away.
            let to = last.joints;
            assert!(last.finished == 1 && rows.iter().rev().skip(1).all(|row| row.finished == 0));
            let [start, end] = [from.axes[2], to.axes[2]];
            let top = (start + 2.0 * rise).max(end + 2.0 * sink).min(lift.max);
            // Cycles need not meet the very top.
            assert!((highest - top.max(start).max(end)).abs() < 1e-4, "{name} {round}: {highest} {top}");
            // What is straight is straight.
            let beside = |row: &Step, place: &Joints| {
                [0, 1, 3].map(|axis| (row.joints.axes[axis] - place.axes[axis]).abs()).into_iter().fold(0.0, f64::max)
            };
            for row in &rows {
                let height = row.joints.axes[2];
                let near = beside(row, &from) < beside(row, &to);
                let (place, free) = if near { (&from, start + rise) } else { (&to, end + sink) };
                let off = beside(row, place);
                assert!(height > free.min(top) - 1e-6 || off < 1e-5, "{name} {round}: {off} beside at {height}");
            }
        }
    }
}

#[test]
fn the_share_of_a_gate_that_is_done_only_rises() {
    let robot = robot("hsr065");
    let mut queue = Queue::repeatable(robot.clone(), at([-40.0, 60.0, 0.0, 10.0]));
    queue.add(&jump(&robot, &at([50.0, 70.0, 20.0, -90.0]), plain(25.0, 25.0)), &Settings::default()).unwrap();
    let mut done = 0.0;
    while !queue.idle() {
        queue.step(Cycle::MS, Override::FULL);
        let share = queue.progress().unwrap().share;
        assert!(share >= done && share <= 1.0, "{done} {share}");
        done = share;
    }
    assert_eq!(done, 1.0);
}

#[test]
fn a_gate_without_a_straight_end_stops_at_its_target() {
    let robot = robot("cobra600");
    let (from, to) = (at([0.0, 60.0, -60.0, 0.0]), at([-1.0, 66.0, -84.0, 0.5]));
    for profile in [VelocityProfile::T, VelocityProfile::S, VelocityProfile::O] {
        let settings = Settings { profile, ..Settings::default() };
        let mut queue = Queue::repeatable(robot.clone(), from);
        queue.add(&jump(&robot, &to, plain(18.0, 0.0)), &settings).unwrap();
        queue.add(&movej(from.axes), &settings).unwrap();
        let rows = run(&mut queue, 100.0);
        let [vel, acc, jerk] = usage(&robot, &rows);
        assert!(vel <= 1.01 && acc <= 1.01 && (jerk <= 1.01 || profile == VelocityProfile::T), "{vel} {acc} {jerk}");
        let there = rows.iter().find(|row| row.finished == 1).unwrap();
        assert_eq!(there.joints.axes[2], to.axes[2]);
    }
}

#[test]
fn a_gate_is_one_motion_without_a_stop_where_there_is_room() {
    let robot = robot("hsr065");
    let (from, to) = (at([-40.0, 60.0, 0.0, 10.0]), at([50.0, 70.0, 20.0, -90.0]));
    let (rows, _) = run_gate(&robot, &from, &to, plain(25.0, 25.0), &Settings::default());
    assert!(after_start(&rows).iter().all(|row| !row.rests));
    // At its limit it is a right-angled gate.
    let limited =
        Gate { highest: Some(robot.kinematics.forward(&to.axes).translation.vector.z + 15.0), ..plain(80.0, 25.0) };
    let (rows, highest) = run_gate(&robot, &from, &to, limited, &Settings::default());
    assert!((highest - 35.0).abs() < 1e-6, "{highest}");
    assert_eq!(after_start(&rows).iter().filter(|row| row.rests).count(), 2);
    // Slower lifts make a slower gate, and the profile T none that leaves the way.
    let slow = Gate { rising: Lift { vel: Some(5.0), acc: Some(30.0) }, ..plain(25.0, 25.0) };
    let quick = run_gate(&robot, &from, &to, plain(25.0, 25.0), &Settings::default()).0.len();
    let slow = run_gate(&robot, &from, &to, slow, &Settings::default()).0.len();
    assert!(slow > quick + 100, "{slow} {quick}");
    let trapezoidal = Settings { profile: VelocityProfile::T, ..Settings::default() };
    let (rows, highest) = run_gate(&robot, &from, &to, plain(25.0, 25.0), &trapezoidal);
    assert!((highest - 70.0).abs() < 1e-6 && rows.last().unwrap().finished == 1);
}

#[test]
fn gates_without_a_motion_across_or_without_height() {
    let robot = robot("hsr065");
    let from = at([20.0, 60.0, 0.0, 10.0]);
    // Over the same place, and to the same place.
    let (rows, highest) =
        run_gate(&robot, &from, &at([20.0, 60.0, -40.0, 10.0]), plain(25.0, 25.0), &Settings::default());
    assert!(highest == 0.0 && (rows.last().unwrap().joints.axes[2] + 40.0).abs() < 1e-6);
    let mut queue = Queue::repeatable(robot.clone(), from);
    queue.add(&jump(&robot, &from, plain(25.0, 25.0)), &Settings::default()).unwrap();
    assert!(run(&mut queue, 100.0).len() < 10);
    let (_, highest) = run_gate(&robot, &from, &at([50.0, 60.0, 0.0, 10.0]), plain(0.0, 0.0), &Settings::default());
    assert!(highest.abs() < 1e-6, "{highest}");
    // Too low a limit, for the start and for the target.
    for (start, end) in [(30.0, 0.0), (0.0, 30.0)] {
        let (from, to) = (at([20.0, 60.0, start, 10.0]), at([50.0, 60.0, end, 10.0]));
        let low = robot.kinematics.forward(&from.axes).translation.vector.z - start + 20.0;
        let mut queue = Queue::repeatable(robot.clone(), from);
        let refused =
            queue.add(&jump(&robot, &to, Gate { highest: Some(low), ..plain(25.0, 25.0) }), &Settings::default());
        assert!(matches!(refused, Err(PlanError::AboveLimit { .. })), "{refused:?}");
    }
    let mut queue =
        Queue::repeatable(crate::tests::robot("kr10-r1420"), crate::tests::axes([0.0, -90.0, 90.0, 0.0, 45.0, 0.0]));
    assert_eq!(queue.add(&jump(&robot, &from, plain(1.0, 1.0)), &Settings::default()), Err(PlanError::NotForThisRobot));
}

#[test]
fn a_gate_can_stop_above_its_target_and_sink_later() {
    let robot = robot("hsr065");
    let (from, to) = (at([-40.0, 60.0, 0.0, 10.0]), at([50.0, 70.0, 20.0, -90.0]));
    let mut queue = Queue::repeatable(robot.clone(), from);
    queue.add(&jump(&robot, &to, Gate { part: GatePart::Above, ..plain(25.0, 25.0) }), &Settings::default()).unwrap();
    let rows = run(&mut queue, 100.0);
    let above = rows.last().unwrap().joints;
    assert!((above.axes[2] - 70.0).abs() < 1e-9 && (above.axes[0] - 50.0).abs() < 1e-6);
    queue.add(&jump(&robot, &to, plain(25.0, 25.0)), &Settings::default()).unwrap();
    let rows = run(&mut queue, 100.0);
    assert!(rows.iter().all(|row| (row.joints.axes[0] - 50.0).abs() < 1e-6 && row.joints.axes[2] <= 70.0 + 1e-9));
    assert!((rows.last().unwrap().joints.axes[2] - 20.0).abs() < 1e-9);
}

#[test]
fn gates_go_on_smoothly_into_each_other() {
    let robot = robot("hsr065");
    let places = [[-40.0, 60.0, 0.0, 10.0], [50.0, 70.0, 20.0, -90.0], [0.0, 90.0, -30.0, 45.0]].map(at);
    let mut queue = Queue::repeatable(robot.clone(), places[2]);
    for place in &places {
        let gate = Gate { smooth: true, ..plain(25.0, 30.0) };
        queue.add(&jump(&robot, place, gate), &Settings::default()).unwrap();
    }
    let rows = run(&mut queue, 100.0);
    assert_within_limits(&robot, &rows, "smooth gates");
    assert!(after_start(&rows).iter().all(|row| !row.rests));
    let numbers: Vec<u64> = rows.iter().skip(1).map(|row| row.motion).collect();
    assert!(numbers.windows(2).all(|pair| pair[1] == pair[0] || pair[1] == pair[0] + 1) && numbers.last() == Some(&3));
}

/// The least time in s in which the lift goes from rest over a way, at whose end it may be as fast as it likes.
fn least_rise(robot: &Robot, profile: VelocityProfile, distance: f64) -> f64 {
    let lift = &robot.axes[2];
    let jerk = if profile == VelocityProfile::T { 1e12 } else { lift.jerk };
    let ramp = lift.acc / jerk;
    if jerk * ramp.powi(3) / 6.0 >= distance {
        return (6.0 * distance / jerk).cbrt();
    }
    // Behind the ramp with the full acceleration, from the speed that it has then.
    let (speed, rest) = (lift.acc * ramp / 2.0, distance - jerk * ramp.powi(3) / 6.0);
    let then = (speed * speed + 2.0 * lift.acc * rest).sqrt();
    assert!(then <= lift.vel);
    ramp + (then - speed) / lift.acc
}

/// Beside a lower bound: rising from rest without a stop, the way over alone, and sinking into rest.
#[test]
fn gates_take_little_longer_than_rising_going_over_and_sinking() {
    let robot = robot("hsr065");
    let (from, to) = (at([-80.0, 60.0, 0.0, 10.0]), at([30.0, 70.0, 20.0, -90.0]));
    for (profile, most) in [(VelocityProfile::T, 1.09), (VelocityProfile::S, 1.1), (VelocityProfile::O, 1.1)] {
        let settings = Settings { profile, ..Settings::default() };
        for rise in [10.0, 15.0, 25.0, 40.0, 60.0] {
            let (rows, _) = run_gate(&robot, &from, &to, plain(rise, rise), &settings);
            let [vel, acc, jerk] = usage(&robot, &rows);
            assert!(
                vel <= 1.01 && acc <= 1.01 && (jerk <= 1.01 || profile == VelocityProfile::T),
                "{profile:?} {rise}"
            );
            let mut queue = Queue::repeatable(robot.clone(), from);
            let mut over = rows.last().unwrap().joints;
            over.axes[2] = from.axes[2];
            queue.add(&movej(over.axes), &settings).unwrap();
            let over = (run(&mut queue, 100.0).len() - 1) as f64 * CYCLE;
            let bound = over + 2.0 * least_rise(&robot, profile, rise);
            let took = (rows.len() - 1) as f64 * CYCLE;
            assert!(took <= most * bound, "{profile:?}, {rise} mm: {took} s, {bound} s at least");
        }
    }
}

#[test]
fn a_gate_has_the_same_path_at_every_override_and_in_manual_operation() {
    let robot = robot("hsr065");
    let (from, to) = (at([-80.0, 60.0, 0.0, 10.0]), at([30.0, 70.0, 20.0, -90.0]));
    let gate = Gate { rising: Lift { vel: Some(30.0), acc: None }, ..plain(15.0, 25.0) };
    // How far the first axis has come where the lift is at most so high, going up or down.
    let crossings_of = |settings: &Settings| {
        let (rows, _) = run_gate(&robot, &from, &to, gate, settings);
        [20.0, 25.0, 35.0, 50.0, 65.0].map(|height| {
            let crossings = rows.windows(2).filter_map(|pair| {
                let [(a, j1), (b, next)] =
                    [0, 1].map(|row: usize| (pair[row].joints.axes[2], pair[row].joints.axes[0]));
                ((a - height) * (b - height) < 0.0).then(|| j1 + (next - j1) * (height - a) / (b - a))
            });
            crossings.collect::<Vec<_>>()
        })
    };
    let usual = crossings_of(&Settings::default());
    for settings in
        [Settings { speed_percent: 20.0, ..Settings::default() }, Settings { manual: true, ..Settings::default() }]
    {
        for (one, other) in usual.iter().zip(crossings_of(&settings)) {
            assert_eq!(one.len(), other.len());
            // Cycles are far apart.
            assert!(one.iter().zip(&other).all(|(a, b)| (a - b).abs() < 0.1), "{one:?} {other:?}");
        }
    }
}

/// Both corners of a short way over take half of it each.
#[test]
fn corners_share_a_short_motion_across() {
    let mut random = Random::new(67);
    for name in ["hsr065", "cobra600"] {
        let robot = robot(name);
        for round in 0..15 {
            let mut from = random_joints(&robot, &mut random, 0.6);
            // There is room above for both corners.
            from.axes[2] = (robot.axes[2].min + robot.axes[2].max) / 2.0;
            let mut to = from;
            for axis in [0, 1, 3] {
                to.axes[axis] += random.between(-3.0, 3.0);
            }
            let slow = Lift { vel: Some(10.0), acc: None };
            let mut queue = Queue::repeatable(robot.clone(), from);
            let gate = Gate { rising: slow, falling: slow, ..plain(10.0, 10.0) };
            queue.add(&jump(&robot, &to, gate), &Settings::default()).unwrap();
            run(&mut queue, 100.0);
            // A stop may be quicker; nothing is late that came in one piece.
            assert!(!was_late(&mut queue), "{name} {round}");
        }
    }
}
