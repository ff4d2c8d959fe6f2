//! A workpiece that the robot holds to a tool that stands: speeds and ways are the TCP's against the workpiece.

use crate::tests::*;

/// A stationary tool that is met at `start`, and a line along the workpiece, by places in mm.
fn held_line(robot: &Robot, start: &Joints, part: &Frame, travel: [f64; 3], turn: [f64; 3]) -> Command {
    // The tool stands where the part is now, a little turned.
    let tool = robot.kinematics.forward(&start.axes) * part * frame([5.0, -3.0, 8.0, 20.0, 10.0, -15.0]);
    let rig =
        Rig { carried: Carried::Workpiece(tool), base: frame([100.0, 200.0, 300.0, 40.0, 0.0, 180.0]), ..Rig::bare() };
    let from = part.inverse() * rig.carried.path_frame_at(&robot.kinematics.forward(&start.axes));
    let [x, y, z, ..] = frame_components(&from);
    let to = frame([0.0, 0.0, 0.0, turn[0], turn[1], turn[2]]).rotation * from.rotation;
    let [_, _, _, a, b, c] = frame_components(&Frame::from_parts(Default::default(), to));
    let pose = [x + travel[0], y + travel[1], z + travel[2], a, b, c];
    Command { rig, ..command(Target::Line { pose, wobj: *part, external: [UNSET; 6] }) }
}

/// The path of the TCP against the flange.
fn tcp_on_workpiece(robot: &Robot, command: &Command, row: &Step) -> Frame {
    command.rig.carried.path_frame_at(&robot.kinematics.forward(&row.joints.axes))
}

#[test]
fn the_tcp_goes_straight_along_the_held_workpiece_at_its_speed() {
    let mut random = Random::new(91);
    for name in ["kr10-r1420", "irb2400-10", "tx2-60"] {
        let robot = robot(name);
        let mut planned = 0;
        while planned < 10 {
            let start = random_joints(&robot, &mut random, 0.6);
            let mut number = |size: f64| random.between(-size, size);
            let part = frame([number(100.0), number(100.0), 200.0 + number(50.0), number(90.0), number(90.0), 10.0]);
            let (travel, turn) =
                ([number(150.0), number(150.0), number(150.0)], [number(30.0), number(20.0), number(20.0)]);
            let speed = Speed { tcp: 120.0 + number(50.0), ori: 200.0, ..fast() };
            let command = Command { speed, ..held_line(&robot, &start, &part, travel, turn) };
            let mut queue = Queue::repeatable(robot.clone(), start);
            if queue.add(&command, &Settings::default()).is_err() {
                continue;
            }
            planned += 1;
            let rows = run(&mut queue, 100.0);
            assert_within_limits(&robot, &rows, name);
            let tcps: Vec<Frame> = rows.iter().map(|row| tcp_on_workpiece(&robot, &command, row)).collect();
            let (first, last) = (tcps[0], tcps[tcps.len() - 1]);
            let gone = part.inverse() * last;
            let came = part.inverse() * first;
            let moved = gone.translation.vector - came.translation.vector;
            assert!((moved - nalgebra::Vector3::from(travel)).norm() < 1e-6, "{moved} {travel:?}");
            for tcp in &tcps {
                let (off, turned) = off_line(&first, &last, tcp);
                assert!(off < 1e-6 && turned < 1e-8, "{name}: {off} mm, {turned} rad off the line");
            }
            let speeds = tcps.windows(2).map(|pair| {
                let moved = (pair[1].translation.vector - pair[0].translation.vector).norm() / CYCLE;
                (moved, pair[0].rotation.angle_to(&pair[1].rotation).to_degrees() / CYCLE)
            });
            for (moved, turned) in speeds {
                assert!(
                    moved <= 1.002 * speed.tcp && turned <= 1.002 * speed.ori,
                    "{moved} of {} mm/s, {turned} of {} deg/s",
                    speed.tcp,
                    speed.ori
                );
            }
            // What the trace shows is the TCP in the world: it stands.
            let shown = rows[rows.len() - 1].tcp;
            let Carried::Workpiece(tool) = command.rig.carried else { panic!("it stands") };
            assert!((shown.translation.vector - (command.rig.base * tool).translation.vector).norm() < 1e-9);
        }
    }
}

#[test]
fn the_programmed_speed_is_that_against_the_workpiece() {
    // The part turns about the tool's tip 400 mm from the flange, the flange sweeps fast, the tip slides slowly.
    let robot = robot("kr10-r1420");
    let start = axes([0.0, -90.0, 90.0, 0.0, 45.0, 0.0]);
    let part = frame([0.0, 0.0, 300.0, 0.0, 0.0, 0.0]);
    let speed = Speed { tcp: 50.0, ..fast() };
    let command = Command { speed, ..held_line(&robot, &start, &part, [0.0, 100.0, 0.0], [0.0, 0.0, 0.0]) };
    let mut queue = Queue::repeatable(robot.clone(), start);
    queue.add(&command, &Settings::default()).unwrap();
    let rows = run(&mut queue, 100.0);
    let highest = rows.windows(2).map(|pair| {
        let [a, b] = [0, 1].map(|index| tcp_on_workpiece(&robot, &command, &pair[index]).translation.vector);
        (b - a).norm() / CYCLE
    });
    let highest = highest.fold(0.0, f64::max);
    assert!(highest > 49.95 && highest < 50.01, "{highest}");
}

#[test]
fn a_corner_on_the_held_workpiece_is_rounded_within_its_zone() {
    let robot = robot("kr10-r1420");
    let start = axes([0.0, -90.0, 90.0, 0.0, 45.0, 0.0]);
    let part = frame([20.0, 0.0, 200.0, 0.0, 30.0, 0.0]);
    let first = held_line(&robot, &start, &part, [0.0, 100.0, 0.0], [0.0; 3]);
    let Target::Line { pose, .. } = first.target else { panic!("a line") };
    let mut next = pose;
    next[0] += 80.0;
    let first = Command { zone: Zone { tcp: 20.0, ..Zone::NONE }, speed: Speed { tcp: 200.0, ..fast() }, ..first };
    let second = Command {
        target: Target::Line { pose: next, wobj: part, external: [UNSET; 6] },
        zone: Zone::NONE,
        ..first.clone()
    };
    let mut queue = Queue::repeatable(robot.clone(), start);
    queue.add(&first, &Settings::default()).unwrap();
    queue.add(&second, &Settings::default()).unwrap();
    let rows = run(&mut queue, 100.0);
    assert_within_limits(&robot, &rows, "a corner");
    assert!(rows[2..rows.len() - 1].iter().all(|row| !row.rests), "it does not stop");
    let corner = (part * frame(pose)).translation.vector;
    let near = rows.iter().map(|row| (tcp_on_workpiece(&robot, &first, row).translation.vector - corner).norm());
    let near = near.fold(f64::INFINITY, f64::min);
    assert!(near > 1.0 && near < 20.0, "{near}");
}

#[test]
fn manual_operation_slows_the_flange_down_too() {
    let robot = robot("kr10-r1420");
    let start = axes([0.0, -90.0, 90.0, 0.0, 45.0, 0.0]);
    let part = frame([0.0, 0.0, 400.0, 0.0, 0.0, 0.0]);
    let settings = Settings { manual: true, ..Settings::default() };
    let line = held_line(&robot, &start, &part, [0.0, 1.0, 0.0], [0.0, 0.0, 40.0]);
    let axes = Command { target: Target::Joints(axes([60.0, -80.0, 80.0, 0.0, 45.0, 0.0])), ..line.clone() };
    for command in [line, axes] {
        let mut queue = Queue::repeatable(robot.clone(), start);
        queue.add(&command, &settings).unwrap();
        let rows = run(&mut queue, 100.0);
        let speeds = rows.windows(2).map(|pair| {
            let [a, b] = [0, 1].map(|index| robot.kinematics.forward(&pair[index].joints.axes).translation.vector);
            (b - a).norm() / CYCLE
        });
        let highest = speeds.fold(0.0, f64::max);
        assert!(highest > 120.0 && highest < 250.1, "{highest}");
    }
}
