//! Blends keep to their zones, whatever they lie between.

use crate::follow::segment::Segment;
use crate::follow::shared_deque::SharedDeque;
use crate::geometry::parametrization::Parametrization;
use crate::junction::{Blended, blended};
use crate::plan::planner::plan;
use crate::tests::*;
use crate::time_optimal::constraint_sampler::{ConstraintSampler, Part};
use crate::time_optimal::solver::BoundaryState;

/// Corner points around a reachable place, and their lines with a zone.
fn corner_run(robot: &Arc<Robot>, points: &[[f64; 3]], zone: Zone, tcp: f64) -> (Vec<Step>, Frame) {
    let start = axes([0.0, -90.0, 90.0, 0.0, 45.0, 0.0]);
    let mut queue = Queue::repeatable(robot.clone(), start);
    let home = robot.kinematics.forward(&start.axes);
    let origin = frame_components(&home);
    for [x, y, z] in points {
        let mut pose = origin;
        (pose[0], pose[1], pose[2]) = (origin[0] + x, origin[1] + y, origin[2] + z);
        let speed = Speed { tcp, ..fast() };
        queue.add(&Command { zone, speed, ..lin(pose) }, &Settings::default()).unwrap();
    }
    (run(&mut queue, 100.0), home)
}

fn tcp_zone(distance: f64) -> Zone {
    Zone { tcp: distance, ..Zone::NONE }
}

/// Distance in mm of a point from the line between two others.
pub(super) fn off(at: &nalgebra::Vector3<f64>, a: &nalgebra::Vector3<f64>, b: &nalgebra::Vector3<f64>) -> f64 {
    let travel = b - a;
    let along = ((at - a).dot(&travel) / travel.norm_squared()).clamp(0.0, 1.0);
    (at - a - travel * along).norm()
}

#[test]
fn a_corner_stays_in_its_zone_and_is_passed_without_a_stop() {
    let robot = robot("kr10-r1420");
    for (zone, angle) in [(10.0, 90.0_f64), (40.0, 90.0), (5.0, 30.0), (40.0, 135.0), (25.0, 170.0), (300.0, 60.0)] {
        let (sine, cosine) = angle.to_radians().sin_cos();
        let points = [[0.0, 200.0, 0.0], [0.0, 200.0 + 200.0 * cosine, -200.0 * sine]];
        let (rows, home) = corner_run(&robot, &points, tcp_zone(zone), 400.0);
        assert_within_limits(&robot, &rows, &format!("{zone} mm, {angle} deg"));
        let place = |p: &[f64; 3]| home.translation.vector + nalgebra::Vector3::new(p[0], p[1], p[2]);
        let (start, corner, end) = (home.translation.vector, place(&points[0]), place(&points[1]));
        let reach = zone.min(100.0);
        let mut closest = f64::INFINITY;
        for row in &rows[1..] {
            let at = row.tcp.translation.vector;
            let from_corner = (at - corner).norm();
            closest = closest.min(from_corner);
            let off = off(&at, &start, &corner).min(off(&at, &corner, &end));
            assert!(from_corner <= reach + 1e-6 || off < 1e-3, "{off} mm off, {from_corner} mm before the corner");
        }
        assert!(closest > 0.01 * reach, "{zone} {angle}: the corner was cut, {closest}");
        // Between start and end it never stands still.
        let inner = after_start(&rows);
        assert!(inner.iter().all(|row| !row.rests), "{zone} mm, {angle} deg");
        let last = rows.last().unwrap();
        assert!((last.tcp.translation.vector - end).norm() < 1e-6);
        assert_eq!(rows.iter().map(|row| row.finished).max(), Some(2));
    }
}

#[test]
fn a_rounded_corner_is_quicker_than_a_stop() {
    let robot = robot("kr10-r1420");
    let points = [[0.0, 300.0, 0.0], [0.0, 300.0, -300.0]];
    let cycles = |zone: f64| corner_run(&robot, &points, tcp_zone(zone), 250.0).0.len();
    let (stop, small, large) = (cycles(-1.0), cycles(20.0), cycles(100.0));
    assert!(stop > small && small > large, "{stop} {small} {large}");
}

#[test]
fn a_sharp_corner_takes_hardly_longer_than_a_stop() {
    let robot = robot("kr10-r1420");
    for (angle, most) in [(30.0_f64, 1.02), (60.0, 1.03), (90.0, 1.05), (120.0, 1.12), (150.0, 1.29), (175.0, 1.24)] {
        let (sine, cosine) = angle.to_radians().sin_cos();
        let points = [[0.0, 300.0, 0.0], [0.0, 300.0 + 300.0 * cosine, -300.0 * sine]];
        let cycles = |zone: f64| corner_run(&robot, &points, tcp_zone(zone), 1000.0).0.len() as f64;
        let stop = cycles(-1.0);
        for zone in [0.5, 5.0, 20.0, 100.0] {
            let ratio = cycles(zone) / stop;
            assert!(ratio < most, "{angle} deg, {zone} mm: {ratio}");
        }
    }
}

#[test]
fn dense_points_keep_their_speed() {
    let robot = robot("kr10-r1420");
    let points: Vec<[f64; 3]> = (1..=4000).map(|index| [0.0, 0.1 * f64::from(index), 0.0]).collect();
    let start = axes([0.0, -90.0, 90.0, 0.0, 45.0, 0.0]);
    let mut queue = Queue::repeatable(robot.clone(), start);
    let origin = frame_components(&robot.kinematics.forward(&start.axes));
    let mut rows = vec![resting(&queue)];
    let mut next = 0;
    while next < points.len() || !queue.idle() {
        while next < points.len() && queue.has_room() {
            let pose = [origin[0], origin[1] + points[next][1], origin[2], origin[3], origin[4], origin[5]];
            let speed = Speed { tcp: 500.0, ..fast() };
            queue.add(&Command { zone: tcp_zone(0.05), speed, ..lin(pose) }, &Settings::default()).unwrap();
            next += 1;
        }
        rows.push(queue.step(Cycle::MS, Override::FULL));
        assert!(rows.len() < 20_000);
    }
    assert_within_limits(&robot, &rows, "dense");
    let speeds: Vec<f64> = rows
        .windows(2)
        .skip(1)
        .map(|pair| (pair[1].tcp.translation.vector - pair[0].tcp.translation.vector).norm() / CYCLE)
        .collect();
    let fast = speeds.iter().filter(|speed| **speed >= 0.99 * 500.0).count();
    // 400 mm at 500 mm/s take 0.8 s, less the ramps.
    assert!(fast > 500, "{fast} cycles of {} at full speed", speeds.len());
}

#[test]
fn random_chains_of_all_kinds_keep_every_limit() {
    run_chains(&Settings::default(), 91, 6);
}

/// Runs so many random chains on each of three robots.
pub(crate) fn run_chains(settings: &Settings, seed: u64, rounds: u32) {
    let mut random = Random::new(seed);
    for name in ["kr10-r1420", "tx2-60", "irb2400-10"] {
        let robot = with_external_axes(name);
        for round in 0..rounds {
            let mut queue = random_chain(&robot, &mut random, settings);
            let end = *queue.end();
            let rows = run(&mut queue, 100.0);
            assert_within_limits_of(&robot, &rows, settings.profile, &format!("{name} {round}"));
            assert_eq!(values(&robot, &rows.last().unwrap().joints), values(&robot, &end), "{name} {round}");
            assert_eq!(rows.last().unwrap().finished, 10);
        }
    }
}

#[test]
fn a_blend_belongs_to_the_motion_that_it_leads_into() {
    let robot = robot("kr10-r1420");
    let start = axes([0.0, -90.0, 90.0, 0.0, 45.0, 0.0]);
    let mut queue = Queue::repeatable(robot.clone(), start);
    let home = robot.kinematics.forward(&start.axes);
    let [x, y, z, a, b, c] = frame_components(&home);
    for pose in [[x, y + 200.0, z, a, b, c], [x, y + 200.0, z - 150.0, a, b, c]] {
        let speed = Speed { tcp: 300.0, ..fast() };
        queue.add(&Command { zone: tcp_zone(40.0), speed, ..lin(pose) }, &Settings::default()).unwrap();
    }
    let corner = home.translation.vector + nalgebra::Vector3::new(0.0, 200.0, 0.0);
    let mut rows: Vec<(Progress, Frame)> = Vec::new();
    while !queue.idle() {
        let step = queue.step(Cycle::MS, Override::FULL);
        rows.push((queue.progress().unwrap(), step.tcp));
    }
    for (progress, tcp) in &rows {
        let at = tcp.translation.vector;
        let length = if progress.motion == 1 { 200.0 } else { 150.0 };
        assert!((progress.elapsed_distance + progress.remaining_distance - length).abs() < 1e-9);
        assert!((progress.share * length - progress.elapsed_distance).abs() < 1e-9 && progress.remaining_time >= 0.0);
        if progress.motion == 1 {
            assert!((progress.elapsed_distance - (at - home.translation.vector).norm()).abs() < 1e-6);
            assert!(progress.remaining_distance >= 40.0 - 1e-6, "{progress:?}");
        } else if progress.elapsed_distance > 40.0 {
            assert!((progress.elapsed_distance - (at - corner).norm()).abs() < 1e-6);
        }
    }
    let second = rows.iter().position(|(progress, _)| progress.motion == 2).unwrap();
    let joined = rows[second].0;
    assert!(joined.elapsed_time == 0.0 && joined.elapsed_distance < 1.0, "{joined:?}");
    for pair in rows.windows(2).filter(|pair| pair[0].0.motion == pair[1].0.motion) {
        assert!(pair[1].0.elapsed_distance > pair[0].0.elapsed_distance);
        assert!((pair[1].0.elapsed_time - pair[0].0.elapsed_time - CYCLE).abs() < 1e-9);
    }
    let last = rows.last().unwrap().0;
    assert_eq!((last.share, last.remaining_distance, last.remaining_time), (1.0, 0.0, 0.0));
    queue.step(Cycle::MS, Override::FULL);
    assert_eq!(queue.progress(), None);
}

#[test]
fn the_remaining_time_is_what_it_takes() {
    let mut random = Random::new(97);
    let (mut off, mut whole, mut motions, mut near) = (0.0, 0.0, 0, 0.0);
    for name in ["kr10-r1420", "tx2-60"] {
        let robot = with_external_axes(name);
        for _ in 0..6 {
            let mut queue = random_chain(&robot, &mut random, &Settings::default());
            let mut rows: Vec<Progress> = Vec::new();
            while !queue.idle() {
                queue.step(Cycle::MS, Override::FULL);
                rows.extend(queue.progress());
            }
            for motion in 1..=10 {
                let of: Vec<&Progress> = rows.iter().filter(|row| row.motion == motion).collect();
                // Blends behind the first motion may become known only when it has begun.
                let known = if motion == 1 { 50 } else { 0 };
                let Some(first) = of.get(known) else { continue };
                let took = (of.len() - known) as f64 * CYCLE;
                let error = (first.remaining_time - took).abs();
                (off, whole, motions) = (off + error, whole + took, motions + 1);
                // What is near is known.
                for (remaining, row) in of.iter().rev().enumerate().take(300).skip(1) {
                    let off = (row.remaining_time - remaining as f64 * CYCLE).abs();
                    near = f64::max(near, off);
                }
            }
        }
    }
    assert!(motions > 100 && off < 0.15 * whole, "{off} s off in {whole} s");
    assert!(near < 0.1, "{near} s off shortly before the end");
}

#[test]
fn chains_without_jerk_limits_keep_speed_and_acceleration() {
    run_chains(&Settings { profile: VelocityProfile::T, ..Settings::default() }, 96, 6);
}

#[test]
fn a_zone_close_to_the_wrist_singularity_keeps_every_limit() {
    let robot = robot("irb2400-10");
    let start = axes([-9.866352982, -3.718992617, -14.120897326, -64.096022927, 8.775467905, -70.529710321]);
    let tool =
        [13.964874795113246, 0.6327020636027498, 68.06807744852545, -62.867796390442265, -20.213236509564048, 0.0];
    let settings = Settings { wrist: true, ..Settings::default() };
    let mut queue = Queue::repeatable(robot.clone(), start);
    let lines = [
        ([696.2411148, -324.4311161, 1622.6268627, 46.3329882, -74.0838386, 111.1715727], 9.38, 298.4),
        ([649.4234673, -327.7101403, 1578.2192958, 57.1326654, -75.5742638, 111.1715727], 17.86, 1e4),
        ([688.9715373, -345.6558374, 1613.7233403, 29.9077851, -82.8908987, 111.1715727], -1.0, 179.0),
    ];
    for (pose, zone, tcp) in lines {
        let mut command = Command { zone: tcp_zone(zone), speed: Speed { tcp, ..fast() }, ..lin(pose) };
        command.rig = Rig { carried: Carried::Tool(frame(tool)), ..command.rig };
        queue.add(&command, &settings).unwrap();
    }
    let rows = run(&mut queue, 100.0);
    assert_within_limits(&robot, &rows, "beside the wrist singularity");
}

/// The blend between the third line and the fourth takes half of its zone, as it would be slower than a stop with all
/// of it: it ends before the middle of the fourth, where the next one begins.
#[test]
fn a_blend_that_is_smaller_than_its_zone_does_not_bend_into_the_next_one() {
    let robot = robot("tx2-60");
    let mut queue = Queue::repeatable(robot.clone(), axes([0.0, 20.0, 90.0, 0.0, 45.0, 0.0]));
    let speed = Speed { tcp: 300.0, ..fast() };
    for pose in [
        [429.074, 9.134, 537.051, 192.0, 25.0, 180.0],
        [420.074, -10.960, 480.515, 180.0, 25.0, 180.0],
        [429.074, 34.709, 519.430, 180.0, 37.0, 180.0],
        [420.074, -24.298, 508.563, 180.0, 25.0, 180.0],
        [429.074, 32.237, 488.470, 180.0, 25.0, 192.0],
    ] {
        let zone = Zone { percent: 100.0, ..Zone::NONE };
        queue.add(&Command { speed, zone, ..lin(pose) }, &Settings::default()).unwrap();
    }
    let rows = run(&mut queue, 100.0);
    assert_within_limits(&robot, &rows, "half a zone");
}

#[test]
fn a_law_looks_at_both_sides_of_a_place_only_where_derivatives_jump() {
    let robot = robot("kr10-r1420");
    let start = axes([0.0, -90.0, 90.0, 0.0, 45.0, 0.0]);
    let pose = frame_components(&robot.kinematics.forward(&start.axes));
    let zone = Zone { tcp: 30.0, ..Zone::NONE };
    let line = |from: &Joints, [y, z]: [f64; 2]| {
        let to = [pose[0], pose[1] + y, pose[2] + z, pose[3], pose[4], pose[5]];
        Arc::new(plan(&robot, from, &Command { zone, ..lin(to) }, &Settings::default()).unwrap())
    };
    let from = line(&start, [100.0, 0.0]);
    let to = line(&from.end, [100.0, -100.0]);
    let Blended { from, to, blend, .. } = blended(&robot, None, &from, &to).unwrap();
    let mut segments = SharedDeque::default();
    for first in [true, false] {
        segments.push_back(Arc::new(Segment::half(&blend, &from, &to, 1, first)));
    }
    let part = Part::whole(segments);
    let end = part.end;
    let near = from.curve.joints(&robot.kinematics, blend.leave, &from.end);
    let sampler = ConstraintSampler::new(&robot, part, 0.0, &near);
    let path = sampler.look(end, 1.0, BoundaryState { vel: 0.5, acc: 0.0 }, BoundaryState::REST).unwrap().path;
    let jumps = (0..path.places().len()).filter(|index| path.jumps(*index)).count();
    // Between the parts, and at the end.
    assert_eq!(
        (jumps, path.places().len() > 3 * (jumps - 1)),
        (Parametrization::PARTS, true),
        "{}",
        path.places().len()
    );
}
