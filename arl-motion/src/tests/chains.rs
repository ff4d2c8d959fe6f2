//! Chains of short motions.

use crate::tests::*;

type Place = nalgebra::Vector3<f64>;

/// Moves along points, seen from the start in mm, with zones that take everything.
fn run_along(robot: &Arc<Robot>, points: &[[f64; 3]], tcp: f64) -> Vec<Step> {
    let start = axes([0.0, -90.0, 90.0, 0.0, 45.0, 0.0]);
    let mut queue = Queue::repeatable(robot.clone(), start);
    let origin = frame_components(&robot.kinematics.forward(&start.axes));
    let mut rows = vec![resting(&queue)];
    let mut rest = points.iter();
    loop {
        while queue.has_room()
            && let Some([x, y, z]) = rest.next()
        {
            let mut pose = origin;
            (pose[0], pose[1], pose[2]) = (origin[0] + x, origin[1] + y, origin[2] + z);
            let zone = Zone { percent: 100.0, ..Zone::NONE };
            let speed = Speed { tcp, ..fast() };
            queue.add(&Command { zone, speed, ..lin(pose) }, &Settings::default()).unwrap();
        }
        if queue.idle() {
            return rows;
        }
        rows.push(queue.step(Cycle::MS, Override::FULL));
        assert!(rows.len() < 100_000, "it does not end");
    }
}

/// The TCP's speed in each cycle.
fn speeds(rows: &[Step]) -> Vec<f64> {
    let places = |pair: &[Step]| (pair[1].tcp.translation.vector - pair[0].tcp.translation.vector).norm() / CYCLE;
    rows.windows(2).skip(1).map(places).collect()
}

/// How many cycles lie between the first and the last one at almost the programmed speed, and how many of them do not
/// have it.
fn at_speed(rows: &[Step], programmed: f64) -> (usize, usize) {
    let quick: Vec<bool> = speeds(rows).iter().map(|speed| *speed >= 0.99 * programmed).collect();
    let first = quick.iter().position(|quick| *quick).expect("it never gets up to speed");
    let last = quick.iter().rposition(|quick| *quick).unwrap();
    (last - first, quick[first..last].iter().filter(|quick| !**quick).count())
}

#[test]
fn dense_curves_keep_their_speed() {
    let robot = robot("kr10-r1420");
    let circle: Vec<[f64; 3]> = (1..=7000)
        .map(|index| {
            let (sine, cosine) = (f64::from(index) * 0.001).sin_cos();
            [0.0, 100.0 * sine, 100.0 - 100.0 * cosine]
        })
        .collect();
    let spiral: Vec<[f64; 3]> = (1..=6000)
        .map(|index| {
            // The way goes with the square of the angle.
            let turns = (f64::from(index) * 0.1 / (std::f64::consts::TAU * 2.0) + 100.0).sqrt();
            let (sine, cosine) = (turns * std::f64::consts::TAU).sin_cos();
            [0.0, 2.0 * turns * cosine - 20.0, 2.0 * turns * sine]
        })
        .collect();
    for (points, speed, least) in [(circle, 700.0, 500), (spiral, 250.0, 1000)] {
        let rows = run_along(&robot, &points, speed);
        assert_within_limits(&robot, &rows, "dense");
        let (cycles, slower) = at_speed(&rows, speed);
        assert!(cycles > least && slower == 0, "{speed} mm/s: {cycles}, {slower} of them slower");
    }
}

#[test]
fn dense_motions_of_the_axes_flow() {
    let robot = robot("kr10-r1420");
    // Which axis is the slowest changes on the way.
    let point = |index: u32| {
        let at = f64::from(index) * 0.01;
        [30.0 * at.sin(), 10.0 * (at * 0.7).sin() - 90.0, 20.0 * (1.3 * at).sin() + 90.0, 0.0, 45.0, 0.0]
    };
    // Where the axes' pace swings within each blend it takes 4617 and 1976; where the robot sets off before all are
    // laid, 2523 and 857. In T the shortest motion along the curve takes 2038.
    let chains = [(VelocityProfile::O, 600, 2450), (VelocityProfile::S, 200, 875), (VelocityProfile::T, 600, 2080)];
    for (profile, count, longest) in chains {
        let mut queue = Queue::repeatable(robot.clone(), axes(point(0)));
        for index in 1..=count {
            let (zone, speed) = (Zone { percent: 100.0, ..Zone::NONE }, Speed { percent: 30.0, ..fast() });
            let settings = Settings { profile, ..Settings::default() };
            queue.add(&Command { zone, speed, ..movej(point(index)) }, &settings).unwrap();
        }
        let rows = run(&mut queue, 100.0);
        assert_within_limits_of(&robot, &rows, profile, "dense axes");
        assert!(rows.len() < longest, "{profile:?}: {} cycles", rows.len());
    }
}

/// Distance in mm of a point from the triangle of three others.
fn off_triangle(at: &Place, [a, b, c]: [&Place; 3]) -> f64 {
    let mut least = f64::INFINITY;
    for (a, b) in [(a, b), (b, c), (a, c)] {
        let side = b - a;
        let along = ((at - a).dot(&side) / side.norm_squared()).clamp(0.0, 1.0);
        least = least.min((at - a - side * along).norm());
    }
    let normal = (b - a).cross(&(c - a));
    if normal.norm() > 1e-9 {
        let inside = |a: &Place, b: &Place| (b - a).cross(&(at - a)).dot(&normal) >= 0.0;
        if inside(a, b) && inside(b, c) && inside(c, a) {
            least = least.min(((at - a).dot(&normal) / normal.norm()).abs());
        }
    }
    least
}

#[test]
fn bent_blends_stay_in_their_corners() {
    let mut random = Random::new(95);
    let robot = robot("kr10-r1420");
    for round in 0..40 {
        // Corners of all kinds, lengths of all ratios.
        let (mut at, mut heading) = (Place::zeros(), 0.0_f64);
        let sharpest = [5.0, 30.0, 90.0, 150.0][round % 4];
        let mut points: Vec<Place> = Vec::new();
        for _ in 0..12 {
            heading += random.between(-sharpest, sharpest).to_radians();
            let length = if round < 20 { 15.0 } else { 10.0_f64.powf(random.between(-1.0, 1.5)) };
            at += Place::new(0.0, heading.cos(), heading.sin()) * length;
            points.push(at);
        }
        let list: Vec<[f64; 3]> = points.iter().map(|point| (*point).into()).collect();
        let rows = run_along(&robot, &list, 200.0);
        assert_within_limits(&robot, &rows, &format!("{round}"));
        let origin = rows[0].tcp.translation.vector;
        points.insert(0, Place::zeros());
        let middles: Vec<Place> = points.windows(2).map(|pair| (pair[0] + pair[1]) / 2.0).collect();
        for row in &rows[1..] {
            let at = row.tcp.translation.vector - origin;
            let corners = middles.windows(2).zip(&points[1..]).map(|(ends, corner)| {
                let size = (ends[0] - corner).norm().max((ends[1] - corner).norm());
                (off_triangle(&at, [&ends[0], corner, &ends[1]]), size)
            });
            let first = (off_triangle(&at, [&points[0], &middles[0], &points[0]]), 0.0);
            let last = (off_triangle(&at, [&points[12], &middles[11], &points[12]]), 0.0);
            let near = corners.chain([first, last]).any(|(off, size)| off <= 0.01 * size + 1e-6);
            assert!(near, "{round}: {at} is beside all corners");
        }
    }
}
