//! Compensations shift and turn paths as asked, within their limits.

use crate::tests::*;
use nalgebra::Vector3;

const LIMITS: [f64; 6] = [100.0, 400.0, 4000.0, 30.0, 150.0, 1500.0];

fn compensated(by: &[(Reference, [f64; 6])]) -> Settings {
    let mut compensation = Compensation::new(1, LIMITS);
    for (reference, by) in by {
        compensation.add(*reference, by);
    }
    Settings { compensation: Some(compensation), ..Settings::default() }
}

fn queue(robot: &Arc<Robot>) -> (Queue, [f64; 6]) {
    let start = axes([0.0, -90.0, 90.0, 0.0, 90.0, 0.0]);
    let pose = frame_components(&robot.kinematics.forward(&start.axes));
    (Queue::repeatable(robot.clone(), start), pose)
}

fn moved(pose: &[f64; 6], by: [f64; 3]) -> [f64; 6] {
    let mut pose = *pose;
    for (value, by) in pose.iter_mut().zip(by) {
        *value += by;
    }
    pose
}

fn slow(pose: [f64; 6]) -> Command {
    Command { speed: Speed { tcp: 100.0, ..fast() }, ..lin(pose) }
}

fn place(pose: &[f64; 6]) -> Vector3<f64> {
    Vector3::new(pose[0], pose[1], pose[2])
}

fn end(robot: &Robot, queue: &Queue) -> Vector3<f64> {
    robot.kinematics.forward(&queue.end().axes).translation.vector
}

fn near(a: Vector3<f64>, b: Vector3<f64>) {
    assert!((a - b).norm() < 1e-5, "{a} {b}");
}

#[test]
fn it_grows_within_its_limits_stays_and_is_left_at_its_end() {
    let robot = robot("kr10-r1420");
    let (mut queue, from) = queue(&robot);
    let shift = compensated(&[(Reference::World, [20.0, 0.0, 10.0, 0.0, 0.0, 0.0])]);
    let (a, b) = (moved(&from, [0.0, 200.0, 0.0]), moved(&from, [0.0, 300.0, 0.0]));
    queue.add(&slow(a), &shift).unwrap();
    near(end(&robot, &queue), place(&a) + Vector3::new(20.0, 0.0, 10.0));
    queue.add(&slow(b), &shift).unwrap();
    near(end(&robot, &queue), place(&b) + Vector3::new(20.0, 0.0, 10.0));
    // Then without: from where it is to the plain target.
    queue.add(&slow(a), &Settings::default()).unwrap();
    near(end(&robot, &queue), place(&a));
    assert_eq!(queue.take_slowed().0, 1.0);
    let rows = run(&mut queue, 100.0);
    assert_within_limits(&robot, &rows, "shifted");
    let shifts: Vec<Vector3<f64>> = rows
        .iter()
        .filter(|row| row.motion < 3)
        .map(|row| row.tcp.translation.vector - place(&from))
        .map(|off| Vector3::new(off.x, 0.0, off.z))
        .collect();
    let mut series = shifts.clone();
    for most in &LIMITS[..3] {
        series = series.windows(2).map(|pair| (pair[1] - pair[0]) / CYCLE).collect();
        let highest = series.iter().map(Vector3::norm).fold(0.0, f64::max);
        assert!(highest <= 1.01 * most, "{highest} of {most}");
    }
    // Once there it stays.
    let there = shifts.iter().position(|off| (off.norm() - 500.0_f64.sqrt()).abs() < 1e-6).unwrap();
    assert!(shifts[there..].iter().all(|off| (off - shifts[there]).norm() < 1e-6));
    assert!(there > 300 && there < 1500, "{there}");
}

#[test]
fn each_frame_counts_along_its_own_axes() {
    let robot = robot("kr10-r1420");
    let wobj = frame([100.0, 50.0, 0.0, 90.0, 0.0, 0.0]);
    let shift_in = |reference, by: [f64; 6]| {
        let (mut queue, from) = queue(&robot);
        let to = moved(&from, [0.0, 200.0, 0.0]);
        let there = frame(to);
        let pose = frame_components(&(wobj.inverse() * there));
        let mut line = command(Target::Line { pose, wobj, external: [UNSET; 6] });
        // The robot hangs from the ceiling.
        line.rig.base = frame([0.0, 0.0, 0.0, 0.0, 0.0, 180.0]);
        queue.add(&line, &compensated(&[(reference, by)])).unwrap();
        let rows = run(&mut queue, 100.0);
        assert_within_limits(&robot, &rows, "frames");
        let last = robot.kinematics.forward(&rows.last().unwrap().joints.axes);
        let turned = (last.rotation * there.rotation.inverse()).scaled_axis().map(f64::to_degrees);
        (last.translation.vector - there.translation.vector, turned, there.rotation)
    };
    let none = Vector3::zeros();
    let by = [10.0, 20.0, 30.0, 0.0, 0.0, 0.0];
    let (off, turned, tool) = shift_in(Reference::Tool, by);
    near(off, tool * Vector3::new(10.0, 20.0, 30.0));
    near(turned, none);
    near(shift_in(Reference::Wobj, by).0, Vector3::new(-20.0, 10.0, 30.0));
    near(shift_in(Reference::World, by).0, Vector3::new(10.0, -20.0, -30.0));
    // Forward is y, left of it is -x, up is z.
    near(shift_in(Reference::ToolPath, by).0, Vector3::new(-20.0, 10.0, 30.0));
    near(shift_in(Reference::ModifyPath, by).0, Vector3::new(-20.0, 10.0, 30.0));
    // Turns: about z of each.
    let turn = [0.0, 0.0, 0.0, 15.0, 0.0, 0.0];
    let (off, turned, tool) = shift_in(Reference::Tool, turn);
    near(off, none);
    near(turned, tool * Vector3::z() * 15.0);
    near(shift_in(Reference::Wobj, turn).1, Vector3::z() * 15.0);
    near(shift_in(Reference::World, turn).1, Vector3::z() * -15.0);
    near(shift_in(Reference::ToolPath, turn).1, Vector3::z() * 15.0);
    near(shift_in(Reference::ModifyPath, turn).1, none);
}

#[test]
fn modify_path_keeps_its_side_on_the_return() {
    let robot = robot("kr10-r1420");
    for (reference, back) in [(Reference::ToolPath, 10.0), (Reference::ModifyPath, -10.0)] {
        let (mut queue, from) = queue(&robot);
        let settings = compensated(&[(reference, [0.0, 10.0, 0.0, 0.0, 0.0, 0.0])]);
        let far = moved(&from, [0.0, 200.0, 0.0]);
        queue.add(&slow(far), &settings).unwrap();
        near(end(&robot, &queue), place(&far) - Vector3::x() * 10.0);
        queue.add(&slow(from), &settings).unwrap();
        near(end(&robot, &queue), place(&from) + Vector3::x() * back);
        assert_within_limits(&robot, &run(&mut queue, 100.0), "to and fro");
    }
}

#[test]
fn more_and_less_come_with_the_next_motion_and_lead_back_to_the_path() {
    let robot = robot("kr10-r1420");
    let (mut queue, from) = queue(&robot);
    let mut settings = compensated(&[]);
    let mut to = from;
    for dx in [10.0, 15.0, -25.0] {
        to = moved(&to, [0.0, 80.0, 0.0]);
        settings.compensation.as_mut().unwrap().add(Reference::World, &[dx, 0.0, 0.0, dx, 0.0, 0.0]);
        let zone = Zone { tcp: 10.0, ..Zone::NONE };
        queue.add(&Command { zone, ..slow(to) }, &settings).unwrap();
    }
    assert!(!was_late(&mut queue));
    let rows = run(&mut queue, 100.0);
    assert_within_limits(&robot, &rows, "blended");
    let last = rows.last().unwrap();
    near(last.tcp.translation.vector, place(&to));
    assert!(last.tcp.rotation.angle_to(&frame(to).rotation) < 1e-9);
    let most = rows.iter().map(|row| row.tcp.translation.vector.x - from[0]).fold(0.0, f64::max);
    // A blend may bulge a little within its zone.
    assert!((most - 25.0).abs() < 0.1, "{most}");
    // Without a way to go it leads all the same.
    settings.compensation.as_mut().unwrap().add(Reference::World, &[0.0, 0.0, 7.0, 0.0, 0.0, 0.0]);
    queue.add(&slow(to), &settings).unwrap();
    let rows = run(&mut queue, 100.0);
    assert_within_limits(&robot, &rows, "on the spot");
    near(rows.last().unwrap().tcp.translation.vector, place(&to) + Vector3::z() * 7.0);
}

#[test]
fn a_slow_compensation_slows_a_short_motion_down() {
    let robot = robot("kr10-r1420");
    let (mut queue, from) = queue(&robot);
    let settings = compensated(&[(Reference::Wobj, [0.0, 0.0, 80.0, 0.0, 0.0, 0.0])]);
    queue.add(&slow(moved(&from, [0.0, 10.0, 0.0])), &settings).unwrap();
    assert!(queue.take_slowed().0 < 0.2);
    let rows = run(&mut queue, 100.0);
    // 80 mm at no more than 100 mm/s.
    assert!(rows.len() > 1000 && rows.len() < 5000, "{}", rows.len());
    assert_within_limits(&robot, &rows, "slow");
}

#[test]
fn random_chains_under_compensation_and_weaves_keep_every_limit() {
    let mut random = Random::new(151);
    let references = [Reference::Tool, Reference::Wobj, Reference::ToolPath, Reference::ModifyPath, Reference::World];
    for name in ["kr10-r1420", "tx2-60", "irb2400-10"] {
        let robot = robot(name);
        for round in 0..4 {
            let mut queue = Queue::repeatable(robot.clone(), random_joints(&robot, &mut random, 0.5));
            let mut settings = compensated(&[]);
            let mut pose = frame_components(&robot.kinematics.forward(&queue.end().axes));
            let (mut added, mut tried) = (0_u32, 0);
            while added < 8 && tried < 400 {
                tried += 1;
                let mut goal = pose;
                for (index, value) in goal.iter_mut().enumerate() {
                    *value += if index < 3 { random.between(-120.0, 120.0) } else { random.between(-10.0, 10.0) };
                }
                let (external, wobj) = ([UNSET; 6], Frame::identity());
                let target = match random.between(0.0, 5.0) as u32 {
                    0 => Target::Pose { pose: goal, wobj, wanted: Wanted { cfg: None, turn: -1 }, external },
                    1 | 2 => Target::Line { pose: goal, wobj, external },
                    _ => {
                        let via = [0, 1, 2].map(|i| (pose[i] + goal[i]) / 2.0 + random.between(-50.0, 50.0));
                        Target::Arc { via, pose: goal, wobj, angle: None, follow: false, external }
                    }
                };
                let by = [0, 1, 2, 3, 4, 5].map(|i| random.between(-8.0, 8.0) * if i < 3 { 1.0 } else { 0.4 });
                let mut next = settings;
                if random.between(0.0, 1.0) < 0.6 {
                    let reference = references[random.between(0.0, 5.0) as usize];
                    next.compensation.as_mut().unwrap().add(reference, &by);
                }
                next.weave = (random.between(0.0, 1.0) < 0.4).then(|| Weave {
                    shape: WeaveShape::Simple,
                    frequency: 2.0,
                    amplitude: 4.0,
                    dwells: [0.0; 3],
                    angle: 0.0,
                    radius: 0.0,
                    turned: Vector3::zeros(),
                });
                let zone = if random.between(0.0, 1.0) < 0.5 { Zone { tcp: 15.0, ..Zone::NONE } } else { Zone::NONE };
                let speed = Speed { tcp: random.between(20.0, 400.0), ori: 100.0, percent: 40.0, ..fast() };
                let command = Command { target, zone, speed, line: added + 1, ..movej([0.0; 6]) };
                if queue.add(&command, &next).is_ok() {
                    (added, settings, pose) = (added + 1, next, goal);
                }
            }
            assert!(added == 8, "{name}: {added} of {tried}");
            let end = *queue.end();
            let rows = run(&mut queue, 100.0);
            assert_within_limits(&robot, &rows, &format!("{name} {round}"));
            assert_eq!(values(&robot, &rows.last().unwrap().joints), values(&robot, &end), "{name} {round}");
        }
    }
}
