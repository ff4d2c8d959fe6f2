//! Lines and circles through the wrist singularity, with `$WRIST`.

use crate::tests::*;
use arl_robot::kinematics::PASSAGE;
use nalgebra::Vector3;

fn passing() -> Settings {
    Settings { wrist: true, ..Settings::default() }
}

/// A line of the TCP in whose middle the axes stand at `middle`; with the axes at its start.
fn through(robot: &Robot, middle: &[f64; 6], tool: &Frame, travel: Vector3<f64>) -> Option<(Joints, Command)> {
    let kinematics = &robot.kinematics;
    let pose = kinematics.forward(middle) * tool;
    let at = |share: f64| Frame::from_parts((pose.translation.vector + travel * share).into(), pose.rotation);
    let cfg = kinematics.cfg(middle);
    let start = kinematics.inverse(&(at(-0.5) * tool.inverse()), cfg, middle)?;
    let line = lin(frame_components(&at(0.5)));
    Some((axes(start), Command { rig: Rig::with_tool(*tool), ..line }))
}

/// Moves, and tests that the TCP stays on its line, that the orientation gives way little, and that all limits hold.
fn assert_passes(robot: &Arc<Robot>, start: Joints, commands: &[Command], what: &str) -> Result<Vec<Step>, PlanError> {
    let mut queue = Queue::repeatable(robot.clone(), start);
    for command in commands {
        queue.add(command, &passing())?;
    }
    let rows = run(&mut queue, 100.0);
    assert_within_limits(robot, &rows, what);
    Ok(rows)
}

#[test]
fn a_line_through_the_singularity_needs_wrist() {
    let robot = robot("kr10-r1420");
    let tool = frame([0.0, 0.0, 100.0, 0.0, 0.0, 0.0]);
    let middle = [10.0, -70.0, 80.0, 25.0, 0.002, 15.0];
    let (start, command) = through(&robot, &middle, &tool, Vector3::new(0.0, 400.0, 100.0)).unwrap();
    let refused = plan(&robot, &start, &command, &Settings::default());
    assert!(matches!(refused, Err(PlanError::Wrist { .. })), "{refused:?}");
    let rows = assert_passes(&robot, start, &[command], "through").unwrap();
    assert!(rows.last().unwrap().joints.axes[4].abs() > 3.0);
}

#[test]
fn random_lines_pass_it_within_all_limits() {
    let mut random = Random::new(92);
    for name in ["kr10-r1420", "irb2400-10", "tx2-60", "kr6-r700"] {
        let robot = robot(name);
        let (mut passed, mut tried) = (0, 0);
        while passed < 12 {
            tried += 1;
            assert!(tried < 600, "{name}: {passed} of {tried}");
            let mut middle = random_joints(&robot, &mut random, 0.5).axes;
            middle[4] = random.between(-2.0, 2.0);
            let mut number = |size: f64| random.between(-size, size);
            let tool = frame([number(50.0), number(50.0), 100.0 + number(100.0), number(90.0), number(60.0), 0.0]);
            let travel = Vector3::new(number(150.0), number(150.0), number(150.0));
            let Some((start, command)) = through(&robot, &middle, &tool, travel) else { continue };
            let speed = Speed { tcp: if passed % 2 == 0 { 300.0 } else { 1e4 }, ..fast() };
            let command = Command { speed, ..command };
            let rows = match assert_passes(&robot, start, std::slice::from_ref(&command), name) {
                Ok(rows) => rows,
                Err(PlanError::Unreachable { .. } | PlanError::AxisLimit { .. }) => continue,
                Err(error) => panic!("{name} {middle:?} {travel}: {error}"),
            };
            let (from, to) = (rows[0].joints, rows[rows.len() - 1].joints);
            let [from, to] = [from, to].map(|joints| command.rig.tcp_at(&robot.kinematics.forward(&joints.axes)));
            let mut gave = 0.0_f64;
            for row in rows.iter().skip(1) {
                let (off, turned) = off_line(&from, &to, &row.tcp);
                assert!(off < 1e-5, "{name} {middle:?}: {off} mm off the line");
                gave = gave.max(turned);
            }
            assert!(gave < 1.05 * PASSAGE, "{name}: {gave} rad");
            let Target::Line { pose, .. } = command.target else { panic!("a line") };
            let missed = frame(pose);
            assert!((to.translation.vector - missed.translation.vector).norm() < 1e-6);
            assert!(to.rotation.angle_to(&missed.rotation) < 1e-8, "the target is exact");
            passed += usize::from(gave > 0.0);
        }
    }
}

#[test]
fn a_line_may_end_at_the_singularity_and_the_next_one_begin_there() {
    let robot = robot("irb2400-10");
    let tool = frame([0.0, 0.0, 100.0, 0.0, 0.0, 0.0]);
    let singular = [0.0, 10.0, -20.0, 30.0, 0.0, -10.0];
    let (start, whole) = through(&robot, &singular, &tool, Vector3::new(100.0, 300.0, 100.0)).unwrap();
    let half = Command {
        target: lin(frame_components(&(robot.kinematics.forward(&singular) * tool))).target,
        ..whole.clone()
    };
    let rows = assert_passes(&robot, start, &[half, whole], "two halves").unwrap();
    let rests = rows[2..rows.len() - 1].iter().filter(|row| row.rests).count();
    assert!(rests > 0, "it stops at the target between");
}

#[test]
fn corners_beside_and_at_the_singularity_are_rounded_where_that_saves_time() {
    let robot = robot("kr10-r1420");
    let tool = frame([0.0, 0.0, 100.0, 0.0, 0.0, 0.0]);
    for fifth in [0.0, 0.5, 3.0] {
        let middle = [10.0, -70.0, 80.0, 25.0, fifth, 15.0];
        let (start, whole) = through(&robot, &middle, &tool, Vector3::new(0.0, 400.0, 100.0)).unwrap();
        let speed = Speed { tcp: 250.0, ..fast() };
        let corner = robot.kinematics.forward(&middle) * tool;
        let rows = |zone: Zone| {
            // The corner itself is at the singularity; and one behind it.
            let whole = Command { zone, speed, ..whole.clone() };
            let first = Command { target: lin(frame_components(&corner)).target, ..whole.clone() };
            let Target::Line { mut pose, .. } = whole.target else { panic!("a line") };
            pose[2] -= 150.0;
            let third = Command { target: lin(pose).target, zone: Zone::NONE, ..whole.clone() };
            assert_passes(&robot, start, &[first, whole, third], &format!("corners at {fifth}")).unwrap()
        };
        let (rounded, stopping) = (rows(Zone { tcp: 40.0, ..Zone::NONE }), rows(Zone::NONE));
        assert!(rounded.len() < stopping.len(), "{fifth}: {} cycles, {} with stops", rounded.len(), stopping.len());
        let stops =
            |rows: &[Step]| rows[2..rows.len() - 1].windows(2).filter(|pair| pair[0].rests && !pair[1].rests).count();
        // Beside the singularity a stop costs less than the blend through it: at one of the corners.
        let expected = if fifth == 0.0 { [0, 2] } else { [1, 2] };
        assert_eq!([stops(&rounded), stops(&stopping)], expected, "{fifth}");
    }
}

#[test]
fn a_stop_within_a_passage_stays_on_the_line_and_goes_on() {
    let robot = robot("kr10-r1420");
    let tool = frame([0.0, 0.0, 100.0, 0.0, 0.0, 0.0]);
    let middle = [10.0, -70.0, 80.0, 25.0, 0.02, 15.0];
    let (start, command) = through(&robot, &middle, &tool, Vector3::new(0.0, 400.0, 100.0)).unwrap();
    let mut queue = Queue::repeatable(robot.clone(), start);
    queue.add(&command, &passing()).unwrap();
    let whole = run(&mut queue.clone(), 100.0);
    let mut rows = vec![whole[0]];
    let end = whole[whole.len() - 1].tcp;
    while !queue.idle() {
        // It stops in the middle of the way.
        if rows.len() == whole.len() / 2 {
            queue.stop_on_path(Stop::General);
        }
        if rows.len() == whole.len() {
            assert!(queue.rests());
            queue.resume();
        }
        rows.push(queue.step(Cycle::MS, Override::FULL));
    }
    assert_within_limits(&robot, &rows, "stopped");
    for row in rows.iter().skip(1) {
        let from = command.rig.tcp_at(&robot.kinematics.forward(&start.axes));
        assert!(off_line(&from, &end, &row.tcp).0 < 1e-5);
    }
}

#[test]
fn a_held_workpiece_passes_it_with_the_tcp_exact() {
    let robot = robot("kr10-r1420");
    let part = frame([0.0, 0.0, 150.0, 0.0, 20.0, 0.0]);
    let middle = [10.0, -70.0, 80.0, 25.0, 0.02, 15.0];
    let tool = robot.kinematics.forward(&middle) * part;
    let rig = Rig { carried: Carried::Workpiece(tool), ..Rig::bare() };
    let at = |y: f64| part * frame([0.0, y, 30.0 + 0.2 * y, 0.0, 0.0, 0.0]);
    let kinematics = &robot.kinematics;
    let start = kinematics.inverse(&rig.carried.flange_at(&at(-150.0)), kinematics.cfg(&middle), &middle).unwrap();
    let pose = frame_components(&(part.inverse() * at(150.0)));
    let speed = Speed { tcp: 200.0, ..fast() };
    let line = Target::Line { pose, wobj: part, external: [UNSET; 6] };
    let command = Command { rig, speed, ..command(line) };
    let rows = assert_passes(&robot, axes(start), &[command], "held").unwrap();
    let mut gave = 0.0_f64;
    for row in &rows {
        let tcp_on_workpiece = rig.carried.path_frame_at(&kinematics.forward(&row.joints.axes));
        let (off, turned) = off_line(&at(-150.0), &at(150.0), &tcp_on_workpiece);
        assert!(off < 1e-5, "{off} mm off the line");
        gave = gave.max(turned);
    }
    assert!(gave > 1e-4 && gave < 1.05 * PASSAGE, "{gave}");
}
