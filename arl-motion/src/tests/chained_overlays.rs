//! Weaves and compensations over the motions that make one path together: circles and splines.

use crate::tests::*;
use nalgebra::Vector3;

fn at_work() -> Joints {
    axes([0.0, -90.0, 90.0, 0.0, 90.0, 0.0])
}

fn zigzag() -> Weave {
    Weave {
        shape: WeaveShape::Simple,
        frequency: 2.0,
        amplitude: 5.0,
        dwells: [0.0; 3],
        angle: 0.0,
        radius: 0.0,
        turned: Vector3::zeros(),
    }
}

fn compensated(reference: Reference, by: [f64; 6]) -> Settings {
    let mut compensation = Compensation::new(1, [200.0, 1000.0, 10_000.0, 60.0, 300.0, 3000.0]);
    compensation.add(reference, &by);
    Settings { compensation: Some(compensation), ..Settings::default() }
}

/// Goes from where the robot is at work through points that are given from there, in mm.
fn along(
    robot: &Arc<Robot>,
    points: &[[f64; 3]],
    target: impl Fn([f64; 6]) -> Target,
    settings: &Settings,
) -> Vec<Step> {
    let mut queue = Queue::repeatable(robot.clone(), at_work());
    let here = frame_components(&robot.kinematics.forward(&at_work().axes));
    for (index, [x, y, z]) in points.iter().enumerate() {
        let mut pose = here;
        (pose[0], pose[1], pose[2]) = (pose[0] + x, pose[1] + y, pose[2] + z);
        let speed = Speed { tcp: 50.0, ..fast() };
        queue.add(&Command { speed, line: index as u32 + 1, ..command(target(pose)) }, settings).unwrap();
    }
    queue.conclude().unwrap();
    let rows = run(&mut queue, 100.0);
    assert!(queue.take_slowed().0 > 0.98, "it was slowed");
    rows
}

fn spl(pose: [f64; 6]) -> Target {
    Target::Spline { pose, wobj: Frame::identity(), external: [UNSET; 6] }
}

fn ccir(pose: [f64; 6]) -> Target {
    Target::Circle { pose, wobj: Frame::identity(), follow: false, external: [UNSET; 6] }
}

fn place(row: &Step) -> Vector3<f64> {
    row.tcp.translation.vector
}

/// A quarter of a circle of 200 mm, in four parts, and on along a line.
fn curve() -> Vec<[f64; 3]> {
    let part = |part: u32| (f64::from(part) * 22.5).to_radians();
    let arc = (1..=4).map(|at| [200.0 * (1.0 - part(at).cos()), 200.0 * part(at).sin(), 0.0]);
    arc.chain([[260.0, 200.0, 0.0]]).collect()
}

/// How far each row is beside a plain way, in mm.
fn beside(rows: &[Step], plain: &[Step]) -> Vec<f64> {
    let off = |row: &Step| plain.iter().map(|at| (place(at) - place(row)).norm()).fold(f64::INFINITY, f64::min);
    rows.iter().map(off).collect()
}

#[test]
fn a_weave_goes_on_along_a_spline() {
    let robot = robot("kr10-r1420");
    let plain = along(&robot, &curve(), spl, &Settings::default());
    let rows = along(&robot, &curve(), spl, &Settings { weave: Some(zigzag()), ..Settings::default() });
    assert_within_limits(&robot, &rows, "woven");
    assert!(rows[2..rows.len() - 1].iter().all(|row| !row.rests), "it stopped on the way");
    let off = beside(&rows, &plain);
    let widest = off.iter().fold(0.0_f64, |most, off| most.max(*off));
    assert!((widest - 5.0).abs() < 0.05, "{widest}");
    assert!(off.last().unwrap() < &1e-6, "it ends {} mm beside the way", off.last().unwrap());
    // 374 mm with figures of 25 mm each: it crosses the way twice in each.
    let sides = off.windows(3).filter(|off| off[1] > 4.5 && off[1] >= off[0] && off[1] > off[2]).count();
    assert!((27..=30).contains(&sides), "{sides} sides");
}

#[test]
fn a_weave_goes_along_circles_as_with_cir() {
    let robot = robot("kr10-r1420");
    let points = &curve()[..4];
    let plain = along(&robot, points, ccir, &Settings::default());
    let rows = along(&robot, points, ccir, &Settings { weave: Some(zigzag()), ..Settings::default() });
    assert_within_limits(&robot, &rows, "woven");
    let off = beside(&rows, &plain);
    let widest = off.iter().fold(0.0_f64, |most, off| most.max(*off));
    assert!((widest - 5.0).abs() < 0.05, "{widest}");
    // Each target is reached exactly, as no zone is asked for.
    for [x, y, z] in points {
        let point = place(&rows[0]) + Vector3::new(*x, *y, *z);
        let off = rows.iter().map(|row| (place(row) - point).norm()).fold(f64::INFINITY, f64::min);
        assert!(off < 1e-6, "{off}");
    }
}

#[test]
fn a_compensation_shifts_splines_and_circles_as_a_whole() {
    let robot = robot("kr10-r1420");
    let shift = Vector3::new(0.0, 0.0, 12.0);
    for target in [spl, ccir] {
        let points = &curve()[..4];
        let plain = along(&robot, points, target, &Settings::default());
        let rows = along(&robot, points, target, &compensated(Reference::World, [0.0, 0.0, 12.0, 0.0, 0.0, 0.0]));
        assert_within_limits(&robot, &rows, "compensated");
        let end = place(rows.last().unwrap()) - place(plain.last().unwrap());
        assert!((end - shift).norm() < 1e-6, "{end}");
        // It has grown when a quarter is done, and stays.
        let grown = &rows[rows.len() / 3..];
        assert!(grown.iter().all(|row| (place(row).z - place(&rows[0]).z - 12.0).abs() < 1e-6));
    }
    // Along the path's own axes: the quarter of a circle is that much wider.
    let rows = along(&robot, &curve()[..4], spl, &compensated(Reference::ToolPath, [0.0, 10.0, 0.0, 0.0, 0.0, 0.0]));
    assert_within_limits(&robot, &rows, "along the path");
    let centre = place(&rows[0]) + Vector3::new(200.0, 0.0, 0.0);
    let radii: Vec<f64> = rows[rows.len() / 3..].iter().map(|row| (place(row) - centre).norm()).collect();
    let (least, most) = radii.iter().fold((f64::INFINITY, 0.0_f64), |(least, most), r| (least.min(*r), most.max(*r)));
    assert!(least > 209.0 && most < 211.0, "{least} to {most}");
}

#[test]
fn a_weave_that_ends_within_a_spline_ends_on_the_path_without_a_stop() {
    let robot = robot("kr10-r1420");
    let mut queue = Queue::repeatable(robot.clone(), at_work());
    let here = frame_components(&robot.kinematics.forward(&at_work().axes));
    let woven = Settings { weave: Some(zigzag()), ..Settings::default() };
    for (index, [x, y, z]) in curve().iter().enumerate() {
        let mut pose = here;
        (pose[0], pose[1], pose[2]) = (pose[0] + x, pose[1] + y, pose[2] + z);
        let settings = if (1..3).contains(&index) { woven } else { Settings::default() };
        queue.add(&Command { speed: Speed { tcp: 50.0, ..fast() }, ..command(spl(pose)) }, &settings).unwrap();
    }
    queue.conclude().unwrap();
    let rows = run(&mut queue, 100.0);
    assert_within_limits(&robot, &rows, "ends");
    assert!(rows[2..rows.len() - 1].iter().all(|row| !row.rests), "it stopped on the way");
    let plain = along(&robot, &curve(), spl, &Settings::default());
    let off = beside(&rows, &plain);
    let widest = |number: u64| {
        let of = rows.iter().zip(&off).filter(|(row, _)| row.motion == number);
        of.fold(0.0_f64, |most, (_, off)| most.max(*off))
    };
    assert!(widest(1) < 0.03 && widest(4) < 0.03 && widest(5) < 0.03, "{} {} {}", widest(1), widest(4), widest(5));
    assert!((widest(2) - 5.0).abs() < 0.05 && (widest(3) - 5.0).abs() < 0.05, "{} {}", widest(2), widest(3));
}

#[test]
fn random_splines_and_circles_under_weaves_and_compensations_keep_every_limit() {
    let mut random = Random::new(157);
    let references = [Reference::Tool, Reference::Wobj, Reference::ToolPath, Reference::ModifyPath, Reference::World];
    for name in ["kr10-r1420", "tx2-60", "irb2400-10"] {
        let robot = robot(name);
        let (mut round, mut started) = (0, 0);
        while round < 6 {
            started += 1;
            assert!(started < 60, "{name}: {round} chains");
            let mut queue = Queue::repeatable(robot.clone(), random_joints(&robot, &mut random, 0.4));
            let mut settings = compensated(Reference::Tool, [0.0; 6]);
            let (mut added, mut tried) = (0_u32, 0);
            let mut pose = frame_components(&robot.kinematics.forward(&queue.end().axes));
            let mut heading =
                Vector3::new(random.between(-1.0, 1.0), random.between(-1.0, 1.0), random.between(-0.5, 0.5));
            while added < 10 && tried < 300 {
                tried += 1;
                heading += Vector3::from_fn(|_, _| random.between(-0.5, 0.5));
                let step = heading.normalize() * random.between(20.0, 80.0);
                let mut goal = pose;
                for (index, value) in goal.iter_mut().enumerate() {
                    *value += if index < 3 { step[index] } else { random.between(-4.0, 4.0) };
                }
                let (external, wobj) = ([UNSET; 6], Frame::identity());
                // Rows of one kind.
                let target = match (added / 4) % 2 {
                    0 => spl(goal),
                    _ if round % 2 == 0 => Target::Line { pose: goal, wobj, external },
                    _ => ccir(goal),
                };
                let mut next = settings;
                if random.between(0.0, 1.0) < 0.2 {
                    let by = [0, 1, 2, 3, 4, 5].map(|i| random.between(-6.0, 6.0) * if i < 3 { 1.0 } else { 0.4 });
                    next.compensation.as_mut().unwrap().add(references[random.between(0.0, 5.0) as usize], &by);
                }
                if random.between(0.0, 1.0) < 0.3 {
                    next.weave = next.weave.is_none().then(|| Weave { amplitude: 3.0, ..zigzag() });
                }
                let zone = if random.between(0.0, 1.0) < 0.5 { Zone { tcp: 12.0, ..Zone::NONE } } else { Zone::NONE };
                let speed = Speed { tcp: random.between(20.0, 300.0), ori: 100.0, ..fast() };
                let mut trial = queue.clone();
                if trial.add(&Command { target, zone, speed, line: added + 1, ..movej([0.0; 6]) }, &next).is_ok() {
                    let mut concluded = trial.clone();
                    if concluded.conclude().is_ok() || (added / 4) % 2 == 1 {
                        (queue, added, settings, pose) = (trial, added + 1, next, goal);
                        continue;
                    }
                }
                heading = Vector3::from_fn(|_, _| random.between(-1.0, 1.0));
            }
            if added < 6 {
                continue;
            }
            round += 1;
            let _ = queue.conclude();
            let rows = run(&mut queue, 100.0);
            assert_within_limits(&robot, &rows, &format!("{name} {round}"));
        }
    }
}
