//! Limits and durations of whole laws.

use crate::limits::profile::Limits;
use crate::time_optimal::solver::*;
use arl_robot::kinematics::random::Random;
use arl_robot::robot::Robot;

fn line(count: usize, limits: Limits) -> ConstrainedPath {
    let mut path = ConstrainedPath::new();
    for at in places(0.0, 1.0, count, BoundaryState::REST, BoundaryState::REST) {
        let Limits { vel, acc, jerk } = limits;
        path.push(at, [Row { first: 1.0, second: 0.0, third: 0.0, vel, acc, jerk }]);
    }
    path
}

/// A cubic spline through random points of all axes of a robot, at rest in its curvature at both ends; its parameter
/// goes from 0 to the number of points less one.
struct Spline {
    points: Vec<Vec<f64>>,
    /// The second derivative at each point.
    bends: Vec<Vec<f64>>,
    limits: Vec<Limits>,
}

impl Spline {
    fn random(robot: &Robot, random: &mut Random, count: usize, part: f64) -> Self {
        let mut points = Vec::new();
        for _ in 0..count {
            let one = |axis: &arl_robot::robot::Axis| {
                let (middle, half) = ((axis.min + axis.max) / 2.0, (axis.max - axis.min) / 2.0 * part);
                random.between(middle - half, middle + half)
            };
            points.push(robot.axes.iter().map(one).collect::<Vec<f64>>());
        }
        let bends = bends(&points);
        let limit = |axis: &arl_robot::robot::Axis| Limits { vel: axis.vel, acc: axis.acc, jerk: axis.jerk };
        Self { points, bends, limits: robot.axes.iter().map(limit).collect() }
    }

    fn length(&self) -> f64 {
        (self.points.len() - 1) as f64
    }

    /// Position and derivatives of an axis, on the segment `segment`.
    fn jet(&self, axis: usize, segment: usize, at: f64) -> [f64; 4] {
        let share = at - segment as f64;
        let (p, q) = (self.points[segment][axis], self.points[segment + 1][axis]);
        let (b, c) = (self.bends[segment][axis], self.bends[segment + 1][axis]);
        let slope = q - p - (2.0 * b + c) / 6.0;
        [
            p + share * (slope + share * (b / 2.0 + share * (c - b) / 6.0)),
            slope + share * (b + share * (c - b) / 2.0),
            b + share * (c - b),
            c - b,
        ]
    }

    fn rows(&self, at: f64, jerk: bool) -> Vec<Row> {
        let last = self.points.len() - 2;
        let segment = (at as usize).min(last);
        let mut rows = Vec::new();
        // Where a segment begins, the rows of the one before hold as well.
        let before = (at == segment as f64 && segment > 0).then(|| segment - 1);
        for segment in before.into_iter().chain([segment]) {
            for (axis, limits) in self.limits.iter().enumerate() {
                let [_, first, second, third] = self.jet(axis, segment, at);
                let Limits { vel, acc, jerk: most } = *limits;
                rows.push(Row { first, second, third, vel, acc, jerk: if jerk { most } else { f64::INFINITY } });
            }
        }
        rows
    }

    /// Places between `from` and the end, with the points among them.
    fn path(&self, from: f64, start: BoundaryState, jerk: bool) -> ConstrainedPath {
        let count = 150 * (self.points.len() - 1);
        let mut all = places(from, self.length(), count, start, BoundaryState::REST);
        all.extend((1..self.points.len() - 1).map(|point| point as f64).filter(|point| *point > from));
        all.sort_by(f64::total_cmp);
        // Close ones are as good as one; the points stay.
        all.dedup_by(|next, kept| *next - *kept < 1e-9);
        let mut path = ConstrainedPath::new();
        for at in all {
            path.push(at, self.rows(at, jerk));
        }
        path
    }

    /// The highest share of velocity, acceleration and jerk limits in samples of 1 ms, by differences.
    fn usage(&self, law: &Law, rests: bool) -> [f64; 3] {
        // Rest before the start.
        let lead = if rests { 3.0 } else { 0.0 };
        let step = 1e-3;
        let last = self.points.len() - 2;
        let samples = (law.duration() / step) as usize + 4;
        let mut used = [0.0_f64; 3];
        for (axis, limits) in self.limits.iter().enumerate() {
            let at = |index: usize| {
                let at = law.at((index as f64 - lead) * step).at;
                self.jet(axis, (at as usize).min(last), at)[0]
            };
            let mut series: Vec<f64> = (0..samples + 3).map(at).collect();
            for (used, most) in used.iter_mut().zip([limits.vel, limits.acc, limits.jerk]) {
                series = series.windows(2).map(|pair| (pair[1] - pair[0]) / step).collect();
                *used = series.iter().fold(*used, |used, value| used.max(value.abs() / most));
            }
        }
        used
    }
}

/// The second derivatives of the spline through the points, by the equations of continuity.
fn bends(points: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let (count, axes) = (points.len(), points[0].len());
    let mut bends = vec![vec![0.0; axes]; count];
    for axis in 0..axes {
        let (mut factors, mut sides) = (vec![0.0; count], vec![0.0; count]);
        for index in 1..count - 1 {
            let side = 6.0 * (points[index + 1][axis] - 2.0 * points[index][axis] + points[index - 1][axis]);
            let pivot = 4.0 - factors[index - 1];
            factors[index] = 1.0 / pivot;
            sides[index] = (side - sides[index - 1]) / pivot;
        }
        for index in (1..count - 1).rev() {
            bends[index][axis] = sides[index] - factors[index] * bends[index + 1][axis];
        }
    }
    bends
}

#[test]
fn a_straight_line_takes_as_long_as_the_closed_form() {
    for (vel, acc, jerk) in
        [(1.0, 4.0, 40.0), (10.0, 10.0, 4.0), (10.0, 3.0, 40.0), (0.3, 4.0, 100.0), (0.1, 10.0, 1e3)]
    {
        let limits = Limits { vel, acc, jerk };
        let law = fastest(&line(400, limits), BoundaryState::REST, BoundaryState::REST).unwrap();
        let share = law.duration() / limits.duration(1.0);
        assert!((share - 1.0).abs() < 5e-3, "{limits:?}: {share}");
        let law =
            fastest(&line(400, Limits { jerk: f64::INFINITY, ..limits }), BoundaryState::REST, BoundaryState::REST)
                .unwrap();
        let trapezoid = if vel * vel < acc { 1.0 / vel + vel / acc } else { 2.0 / acc.sqrt() };
        let share = law.duration() / trapezoid;
        assert!((share - 1.0).abs() < 5e-3, "{limits:?}: {share} without jerk");
    }
}

#[test]
fn limits_hold_between_the_places_too_and_the_duration_is_close_to_the_lower_bound() {
    let mut random = Random::new(61);
    for name in ["kr10-r1420", "six-10", "tx2-60", "hsr065"] {
        let robot = Robot::builtin(name).unwrap();
        // The more points, the less the acceleration's ramps at both ends count.
        for (count, factor) in [(2, 1.35), (3, 1.2), (4, 1.2), (6, 1.1), (10, 1.05)] {
            let spline = Spline::random(&robot, &mut random, count, 0.5);
            let law = fastest(&spline.path(0.0, BoundaryState::REST, true), BoundaryState::REST, BoundaryState::REST)
                .unwrap();
            let bound =
                fastest(&spline.path(0.0, BoundaryState::REST, false), BoundaryState::REST, BoundaryState::REST)
                    .unwrap();
            let used = spline.usage(&law, true);
            assert!(used.iter().all(|used| *used < 1.005), "{name}, {count} points: {used:?}");
            // Some limit is always used: the jerk at the start, if no other.
            assert!(used[2] > 0.98, "{name}, {count} points: {used:?}");
            let share = law.duration() / bound.duration();
            assert!(share >= 1.0 && share < factor, "{name}, {count} points: {share}");
        }
    }
}

#[test]
fn without_jerk_limits_velocity_and_acceleration_limits_hold() {
    let mut random = Random::new(63);
    let robot = Robot::builtin("kr10-r1420").unwrap();
    for count in [2, 3, 5, 8] {
        let spline = Spline::random(&robot, &mut random, count, 0.5);
        let law =
            fastest(&spline.path(0.0, BoundaryState::REST, false), BoundaryState::REST, BoundaryState::REST).unwrap();
        let [vel, acc, _] = spline.usage(&law, true);
        assert!(vel < 1.005 && acc < 1.005 && acc > 0.99, "{count} points: {vel} {acc}");
    }
}

#[test]
fn a_motion_goes_on_from_states_on_its_path() {
    let mut random = Random::new(62);
    let robot = Robot::builtin("kr10-r1420").unwrap();
    for _ in 0..6 {
        let spline = Spline::random(&robot, &mut random, 5, 0.4);
        let law =
            fastest(&spline.path(0.0, BoundaryState::REST, true), BoundaryState::REST, BoundaryState::REST).unwrap();
        for part in [0.02, 0.1, 0.3, 0.5, 0.7, 0.9, 0.97] {
            let moment = law.at(part * law.duration());
            let edge = BoundaryState { vel: moment.vel, acc: moment.acc };
            let rest = match fastest(&spline.path(moment.at, edge, true), edge, BoundaryState::REST) {
                Ok(rest) => rest,
                Err(refusal) => {
                    // Where only braking as hard as possible is left, there is no room for another motion.
                    assert!(refusal == Refusal::Fast && part > 0.6, "{part}: {refusal}");
                    continue;
                }
            };
            let used = spline.usage(&rest, false);
            // Near rest the places of an even way are far apart in time.
            let most = if part < 0.1 { 1.015 } else { 1.005 };
            assert!(used.iter().all(|used| *used < most), "{part}: {used:?}");
            let now = rest.at(0.0);
            assert!(
                (now.vel / edge.vel - 1.0).abs() < 1e-9 && (now.acc - edge.acc).abs() < 1e-6 * (1.0 + edge.acc.abs())
            );
            let share = rest.duration() / ((1.0 - part) * law.duration());
            assert!((share - 1.0).abs() < 0.01, "{part}: {share}");
        }
    }
}

#[test]
fn a_motion_goes_on_behind_a_law_that_ends_sooner() {
    let mut random = Random::new(66);
    let robot = Robot::builtin("kr10-r1420").unwrap();
    for _ in 0..4 {
        let spline = Spline::random(&robot, &mut random, 6, 0.4);
        let path = spline.path(0.0, BoundaryState::REST, true);
        let whole = fastest(&path, BoundaryState::REST, BoundaryState::REST).unwrap();
        // A law that stops on half of the way, of which about a third is gone: there the two are the same.
        let half: Vec<bool> = path.places().iter().map(|at| *at <= 0.5 * spline.length()).collect();
        let short = fastest(&path.only(&half), BoundaryState::REST, BoundaryState::REST).unwrap();
        let moment = short.at(0.3 * short.duration());
        let edge = BoundaryState { vel: moment.vel, acc: moment.acc };
        let rest =
            fastest_behind(&spline.path(moment.at, edge, true), edge, BoundaryState::REST, Some(&short)).unwrap();
        let now = rest.at(0.0);
        assert!((now.vel / edge.vel - 1.0).abs() < 1e-6, "{} {}", now.vel, edge.vel);
        let used = spline.usage(&rest, false);
        assert!(used.iter().all(|used| *used < 1.01), "{used:?}");
        let remaining = whole.duration() - whole.time_at(moment.at);
        assert!((rest.duration() / remaining - 1.0).abs() < 0.02, "{} {remaining}", rest.duration());
    }
}

#[test]
fn the_pace_behind_a_law_is_its_own_until_it_slows_down_for_its_end() {
    let path = line(200, Limits { vel: 1.0, acc: 4.0, jerk: 40.0 });
    let half: Vec<bool> = path.places().iter().map(|at| *at <= 0.5).collect();
    let short = fastest(&path.only(&half), BoundaryState::REST, BoundaryState::REST).unwrap();
    let on: Vec<bool> = path.places().iter().map(|at| *at >= 0.1).collect();
    let (path, from) = (path.only(&on), short.time_at(path.only(&on).places()[0]));
    let moment = short.at(from);
    let edges = [BoundaryState { vel: moment.vel, acc: moment.acc }, BoundaryState::REST];
    let warp = Warp::new(path.places()[0], 1.0, false, true);
    let warped: Vec<f64> = path.places().iter().map(|at| warp.find(*at)).collect();
    let guess = guess::guess_speeds(&path, &warp, &warped, edges);
    let pace = Pace::behind(&short, path.places(), &warped, &warp, &guess).unwrap();
    assert!(pace.times.windows(2).all(|pair| pair[1] > pair[0]));
    for (at, time) in path.places().iter().zip(&pace.times) {
        if *at < 0.24 {
            assert!((short.time_at(*at) - from - time).abs() < 1e-9, "{at}");
        }
    }
    let last = pace.times.last().unwrap();
    let rest = fastest_behind(&path, edges[0], BoundaryState::REST, Some(&short)).unwrap();
    assert!((0.7..1.6).contains(&(last / rest.duration())), "{last} {}", rest.duration());
}

#[test]
fn a_motion_can_end_moving() {
    let limits = Limits { vel: 1.0, acc: 4.0, jerk: 40.0 };
    let end = BoundaryState { vel: 0.5, acc: 0.0 };
    let law = fastest(&line(200, limits), BoundaryState::REST, end).unwrap();
    let moment = law.at(law.duration());
    assert!((moment.vel - 0.5).abs() < 1e-6 && moment.acc.abs() < 1e-4, "{moment:?}");
    // A second motion backwards in time takes as long.
    let back = fastest(&line(200, limits), end, BoundaryState::REST).unwrap();
    assert!((law.duration() / back.duration() - 1.0).abs() < 5e-3);
    assert!(law.duration() < limits.duration(1.0));
}

#[test]
fn state_and_time_fit_together() {
    let mut random = Random::new(64);
    let robot = Robot::builtin("six-10").unwrap();
    let spline = Spline::random(&robot, &mut random, 5, 0.5);
    for jerk in [true, false] {
        let law =
            fastest(&spline.path(0.0, BoundaryState::REST, jerk), BoundaryState::REST, BoundaryState::REST).unwrap();
        assert_eq!(law.time_at(spline.length()), law.duration());
        assert_eq!(law.time_at(0.0), 0.0);
        let step = 1e-5;
        for index in 1..200 {
            let time = law.duration() * f64::from(index) / 200.0;
            let [before, here, after] = [time - step, time, time + step].map(|time| law.at(time));
            assert!((law.time_at(here.at) - time).abs() < 1e-7, "{time}");
            assert!(((after.at - before.at) / (2.0 * step) - here.vel).abs() < 1e-3 * (1.0 + here.vel), "{time}");
            if jerk {
                assert!(
                    ((after.vel - before.vel) / (2.0 * step) - here.acc).abs() < 0.05 * (1.0 + here.acc.abs()),
                    "{time}"
                );
            }
        }
    }
}

#[test]
fn what_cannot_be_timed_is_refused() {
    let row = Row { first: 1.0, second: 0.0, third: 0.0, vel: 1.0, acc: 1.0, jerk: 1.0 };
    let of = |places: &[f64], row: Row| {
        let mut path = ConstrainedPath::new();
        places.iter().for_each(|at| path.push(*at, [row]));
        fastest(&path, BoundaryState::REST, BoundaryState::REST).map(|law| law.duration())
    };
    let even = [0.0, 0.25, 0.5, 0.75, 1.0];
    assert!(of(&even, row).is_ok());
    assert_eq!(of(&[], row), Err(Refusal::Short));
    assert_eq!(of(&[0.0], row), Err(Refusal::Short));
    assert_eq!(of(&[0.0, 0.0], row), Err(Refusal::Place { place: 1 }));
    assert_eq!(of(&[0.0, f64::NAN, 1.0], row), Err(Refusal::Place { place: 1 }));
    for bad in [
        Row { vel: 0.0, ..row },
        Row { acc: 0.0, ..row },
        Row { jerk: 0.0, ..row },
        Row { jerk: f64::NAN, ..row },
        Row { vel: f64::INFINITY, ..row },
        Row { third: f64::NAN, ..row },
    ] {
        assert_eq!(of(&even, bad), Err(Refusal::Row { place: 0 }), "{bad:?}");
    }
    assert_eq!(of(&even, Row { first: 0.0, ..row }), Err(Refusal::Still));
    let path = line(50, Limits { vel: 1.0, acc: 4.0, jerk: 40.0 });
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(
            fastest(&path, BoundaryState { vel: bad, acc: 0.0 }, BoundaryState::REST).map(|_| ()),
            Err(Refusal::Boundary)
        );
    }
    for fast in [
        BoundaryState { vel: 2.0, acc: 0.0 },
        BoundaryState { vel: 0.99, acc: 3.9 },
        BoundaryState { vel: 0.5, acc: -4.08 },
    ] {
        assert_eq!(fastest(&path, fast, BoundaryState::REST).map(|_| ()), Err(Refusal::Fast), "{fast:?}");
    }
}

#[test]
fn axes_that_stand_still_and_few_places_do_no_harm() {
    let limits = Limits { vel: 1.0, acc: 4.0, jerk: 40.0 };
    let alone = fastest(&line(200, limits), BoundaryState::REST, BoundaryState::REST).unwrap().duration();
    let Limits { vel, acc, jerk } = limits;
    let row = Row { first: 1.0, second: 0.0, third: 0.0, vel, acc, jerk };
    let mut path = ConstrainedPath::new();
    for at in places(0.0, 1.0, 200, BoundaryState::REST, BoundaryState::REST) {
        path.push(at, [Row { first: 0.0, ..row }, row]);
    }
    assert!((fastest(&path, BoundaryState::REST, BoundaryState::REST).unwrap().duration() / alone - 1.0).abs() < 1e-9);
    for count in 3..8 {
        let law = fastest(&line(count, limits), BoundaryState::REST, BoundaryState::REST).unwrap();
        assert!(law.duration() > 0.9 * alone && law.duration() < 3.0 * alone, "{count} places: {}", law.duration());
    }
}

#[test]
fn nothing_panics_whatever_the_rows_are() {
    let mut random = Random::new(65);
    for _ in 0..300 {
        let mut path = ConstrainedPath::new();
        let count = random.between(3.0, 40.0) as usize;
        let mut some =
            |low: f64, high: f64| 10.0_f64.powf(random.between(low, high)) * random.between(-1.0, 1.0).signum();
        let mut at = 0.0;
        for _ in 0..count {
            at += some(-2.0, 0.0).abs();
            let rows: Vec<Row> = (0..4)
                .map(|_| Row {
                    first: some(-2.0, 2.0),
                    second: some(-3.0, 3.0),
                    third: some(-3.0, 4.0),
                    vel: some(0.0, 2.0).abs(),
                    acc: some(1.0, 3.0).abs(),
                    jerk: some(2.0, 4.0).abs(),
                })
                .collect();
            path.push(at, rows);
        }
        let law = fastest(&path, BoundaryState::REST, BoundaryState::REST).unwrap();
        assert!(law.duration().is_finite() && law.duration() > 0.0);
        let edge = BoundaryState { vel: some(-3.0, 2.0).abs(), acc: some(-2.0, 3.0) };
        if let Ok(law) = fastest(&path, edge, BoundaryState::REST) {
            assert!(law.duration().is_finite() && law.duration() > 0.0);
        }
    }
}

#[test]
fn places_where_derivatives_jump_are_not_left_out() {
    let row = |third: f64| Row { first: 1.0, second: 0.0, third, vel: 1.0, acc: 10.0, jerk: 100.0 };
    let mut path = ConstrainedPath::new();
    for index in 0..400 {
        let at = f64::from(index) * 1e-3;
        if index % 50 == 25 { path.push_jump(at, [row(0.0), row(50.0)], 1) } else { path.push(at, [row(0.0)]) }
    }
    let steps = guess_steps(&path, [BoundaryState::REST; 2]).unwrap();
    let thinned = thinned(&path, &steps, 0.02).unwrap();
    let jumps = |path: &ConstrainedPath| (0..path.places().len()).filter(|index| path.jumps(*index)).count();
    assert_eq!((jumps(&path), jumps(&thinned)), (8, 8));
    assert!(thinned.places().len() < 200, "{}", thinned.places().len());
}

/// A way from one parameter to another, at rest at 0 and at the end, that bends sharply at each half.
fn sharp(from: f64, to: f64) -> ConstrainedPath {
    let mut path = ConstrainedPath::new();
    let start = if from > 0.0 { BoundaryState { vel: 1.0, acc: 0.0 } } else { BoundaryState::REST };
    for at in places(from, to, 600, start, BoundaryState::REST) {
        let off = ((at + 0.25).rem_euclid(0.5) - 0.25) / 0.01;
        let (bump, slope) = ((-off * off).exp(), -2.0 * off / 0.01);
        let row = |sign: f64, second: f64| Row {
            first: 1.0,
            second: sign * second * bump,
            third: sign * second * bump * slope,
            vel: 1.0,
            acc: 8.0,
            jerk: 80.0,
        };
        path.push(at, [row(1.0, 0.0), row(1.0, 3000.0), row(-1.0, 2000.0)]);
    }
    path
}

#[test]
fn places_beside_a_sharp_bend_are_not_left_out() {
    let path = sharp(0.0, 2.0);
    let steps = guess_steps(&path, [BoundaryState::REST; 2]).unwrap();
    let thinned = thinned(&path, &steps, 0.05).unwrap();
    let speeds: Vec<f64> =
        path.places().windows(2).zip(&steps).map(|(pair, step)| (pair[1] - pair[0]) / step).collect();
    let kept: Vec<usize> =
        (0..speeds.len()).filter(|index| thinned.places().contains(&path.places()[*index])).collect();
    assert!(kept.len() < 2 * path.places().len() / 3, "{} of {}", kept.len(), path.places().len());
    // Behind a place that is left out the motion is about as fast as behind the last one that is kept.
    for pair in kept.windows(2) {
        let most = |range: std::ops::Range<usize>| {
            range.map(|index| (speeds[index] / speeds[pair[0]]).ln().abs()).fold(0.0, f64::max)
        };
        assert!(most(pair[0]..pair[1]) < 1.1_f64.ln() + 1e-9, "{pair:?}: {}", most(pair[0]..pair[1]));
    }
}

#[test]
fn a_law_goes_on_behind_another_one_that_slows_down_for_its_end() {
    let before = fastest(&sharp(0.0, 1.3), BoundaryState::REST, BoundaryState::REST).unwrap();
    let mut found = 0;
    for index in 1..40 {
        let moment = before.at(before.duration() * f64::from(index) / 60.0);
        let edge = BoundaryState { vel: moment.vel, acc: moment.acc };
        let path = sharp(moment.at, 2.3);
        let alone = fastest(&path, edge, BoundaryState::REST).map(|law| law.duration());
        match fastest_behind(&path, edge, BoundaryState::REST, Some(&before)) {
            Ok(law) => {
                assert!(
                    law.duration() < 1.01 * alone.unwrap_or(f64::INFINITY),
                    "{index}: {} {alone:?}",
                    law.duration()
                );
                found += 1;
            }
            Err(refusal) => assert_eq!(alone, Err(refusal), "{index}"),
        }
    }
    // From a few states nothing is found, which may be too fast for the places here.
    assert!(found > 36, "{found}");
}

/// The most of its acceleration that a law along an even way uses, looked at closely.
fn most_acceleration(law: &Law, acc: f64) -> f64 {
    let moments = (0..=20_000).map(|step| law.at(law.duration() * f64::from(step) / 20_000.0));
    moments.map(|now| now.acc.abs() / acc).fold(0.0, f64::max)
}

#[test]
fn where_jerk_is_hardly_limited_beside_rest_accelerations_keep_their_limits_all_the_same() {
    const RISE_S: f64 = 0.002;
    for (count, acc) in [(50, 4.0), (50, 15.0), (150, 4.0), (150, 15.0), (150, 60.0), (250, 4.0), (250, 60.0)] {
        let check = |path: &ConstrainedPath, about: &str| {
            let law = fastest(path, BoundaryState::REST, BoundaryState::REST).unwrap();
            let near =
                law.pace().map(|pace| fastest_near(path, BoundaryState::REST, BoundaryState::REST, &pace).unwrap());
            let least = 1.0 + 1.0 / acc;
            for law in near.into_iter().chain([law]) {
                let (used, duration) = (most_acceleration(&law, acc), law.duration());
                assert!(used < 1.03, "{count} {acc} {about}: {used}");
                assert!(duration < 1.006 * least + RISE_S, "{count} {acc} {about}: {duration} of {least}");
            }
        };
        for rise in [1e-3, 1e-4, 1e-6, 1e-9] {
            check(&line(count, Limits { vel: 1.0, acc, jerk: acc / rise }), &format!("{rise} s"));
        }
        // Jerk is limited on the way alone.
        let mut path = ConstrainedPath::new();
        for at in places(0.0, 1.0, count, BoundaryState::REST, BoundaryState::REST) {
            let jerk = if (at - 0.5).abs() < 0.2 { 100.0 * acc } else { f64::INFINITY };
            path.push(at, [Row { first: 1.0, second: 0.0, third: 0.0, vel: 1.0, acc, jerk }]);
        }
        check(&path, "on the way");
    }
}
