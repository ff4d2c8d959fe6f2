//! The fastest motion along a path beside the crate copp on the same geometry: durations and processor times.
//!
//! `cargo bench -p arl-benches --bench timing [-- PATHS [PLACES]]`

use std::error::Error;
use std::hint::black_box;

use arl_benches::splines::{ACCELERATION, JERK, SPEEDS, Spline};
use arl_benches::statistics::{Times, geometric_mean, processor_time};
use arl_rt::motion::optimal::{Edge, Row, Way, fastest};
use copp::robot::Robot;
use copp::solver::topp2_ra::{ReachSet2OptionsBuilder, Topp2ProblemBuilder, s_to_t_topp2, topp2_ra};
use copp::solver::topp3_socp::{ClarabelOptionsBuilder, Topp3ProblemBuilder, s_to_t_topp3, topp3_socp};
use nalgebra::DMatrix;

/// Points that a path follows, and how far apart they are: what the axis covers at full speed in so many s.
const POINTS: usize = 100;
const STEP: f64 = 0.015;

/// A motion's duration and what computing it took, both in s.
#[derive(Clone, Copy)]
struct Timed {
    duration: f64,
    time: f64,
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut numbers = std::env::args().skip(1).filter_map(|word| word.parse::<usize>().ok());
    let paths = numbers.next().unwrap_or(5);
    let count = numbers.next().unwrap_or(1000).max(3);
    println!("random paths of six axes along {POINTS} points, {count} places, rest to rest; computing in ms");
    println!("of processor time; copp's second round starts from the result of its first");
    println!("      velocity and acceleration          with jerk limits");
    println!(
        "path  copp/s    ms  ours/x ours/ms    first/s     ms  second/x     ms   ours/x ours/ms  first/second to ours"
    );
    let mut ratios: [Vec<f64>; 6] = Default::default();
    for seed in 1..=paths as u64 {
        let spline = Spline::random(seed, POINTS, STEP);
        let places: Vec<f64> = (0..count).map(|index| index as f64 / (count - 1) as f64).collect();
        let [second, first_round, second_round] = theirs(&spline, &places)?;
        let [plain, jerk] = [ours(&spline, &places, false)?, ours(&spline, &places, true)?];
        println!(
            "{seed:>4} {:>7.3} {:>5.2} {:>7.4} {:>7.3} {:>10.3} {:>6.0} {:>9.4} {:>6.0} {:>8.4} {:>7.2} {:>10.0} {:>6.0}",
            second.duration,
            second.time * 1e3,
            plain.duration / second.duration,
            plain.time * 1e3,
            first_round.duration,
            first_round.time * 1e3,
            second_round.duration / first_round.duration,
            second_round.time * 1e3,
            jerk.duration / first_round.duration,
            jerk.time * 1e3,
            first_round.time / jerk.time,
            second_round.time / jerk.time,
        );
        let row = [
            plain.duration / second.duration,
            second.time / plain.time,
            jerk.duration / first_round.duration,
            first_round.time / jerk.time,
            jerk.duration / second_round.duration,
            second_round.time / jerk.time,
        ];
        ratios.iter_mut().zip(row).for_each(|(ratios, ratio)| ratios.push(ratio));
    }
    let [plain, plain_faster, first, first_faster, second, second_faster] =
        ratios.map(|ratios| geometric_mean(&ratios));
    println!("geometric means: without jerk limits {plain:.4} of the duration, {plain_faster:.1} times as fast;");
    println!(
        "with them {first:.4} of the first round's, {first_faster:.0} times as fast, and {second:.4} of the second"
    );
    println!("round's, {second_faster:.0} times as fast");
    Ok(())
}

fn ours(spline: &Spline, places: &[f64], jerk: bool) -> Result<Timed, Box<dyn Error>> {
    let mut way = Way::new();
    for at in places {
        let [_, first, second, third] = spline.jet(*at);
        way.push(
            *at,
            SPEEDS.iter().enumerate().map(|(axis, speed)| Row {
                first: first[axis],
                second: second[axis],
                third: third[axis],
                vel: *speed,
                acc: speed * ACCELERATION,
                jerk: if jerk { speed * JERK } else { f64::INFINITY },
            }),
        );
    }
    let mut times = Times::default();
    let mut duration = 0.0;
    for _ in 0..10 {
        let start = processor_time();
        let law = black_box(fastest(black_box(&way), Edge::REST, Edge::REST)?);
        times.push(processor_time() - start);
        duration = law.duration();
    }
    Ok(Timed { duration, time: times.least() })
}

/// Without jerk limits; with them, one convex problem; and another one made with the result of the first.
fn theirs(spline: &Spline, places: &[f64]) -> Result<[Timed; 3], Box<dyn Error>> {
    let count = places.len();
    let jets: Vec<_> = places.iter().map(|at| spline.jet(*at)).collect();
    let matrix = |order: usize| DMatrix::from_fn(SPEEDS.len(), count, |axis, index| jets[index][order][axis]);
    let limits = |factor: f64| SPEEDS.map(|speed| speed * factor);
    let [q, first, second, third] = [0, 1, 2, 3].map(matrix);
    let both = |factor: f64| (limits(factor), limits(-factor));
    let (vel, acc, jerk) = (both(1.0), both(ACCELERATION), both(JERK));
    let mut robot = Robot::with_capacity(SPEEDS.len(), count);
    robot
        .with_s(places)?
        .with_q(&q.as_view(), &first.as_view(), &second.as_view(), Some(&third.as_view()), 0)?
        .with_axial_velocity((vel.0.as_slice(), count), (vel.1.as_slice(), count), 0)?
        .with_axial_acceleration((acc.0.as_slice(), count), (acc.1.as_slice(), count), 0)?
        .with_axial_jerk((jerk.0.as_slice(), count), (jerk.1.as_slice(), count), 0)?;
    let start = processor_time();
    let mut profile = {
        let problem = Topp2ProblemBuilder::new(&robot, (0, count - 1), (0.0, 0.0)).build()?;
        topp2_ra(&problem, &ReachSet2OptionsBuilder::new().build()?)?
    };
    let timed = |duration: f64| Timed { duration, time: (processor_time() - start).as_secs_f64() };
    let plain = timed(s_to_t_topp2(places, &profile, 0.0)?.0);
    robot.constraints.amax_substitute(&profile, 0)?;
    let options = ClarabelOptionsBuilder::new().allow_almost_solved(true).build()?;
    let mut round = || -> Result<Timed, Box<dyn Error>> {
        let next = {
            let problem =
                Topp3ProblemBuilder::new(&mut robot, 0, &profile, (0.0, 0.0), (0.0, 0.0)).build_with_linearization()?;
            topp3_socp(&problem, &options)?
        };
        let duration = s_to_t_topp3(places, next.as_parts(), 0.0)?.0;
        profile = next.a;
        Ok(timed(duration))
    };
    Ok([plain, round()?, round()?])
}
