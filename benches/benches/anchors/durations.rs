//! The fastest motion along a path beside the crate copp on the same geometry: durations and processor times.

use std::f64::consts::PI;

use arl_benches::splines::{ACCELERATION, JERK, SPEEDS, Spline};
use arl_benches::statistics::geometric_mean;

use crate::Rows;
use crate::path::Path;
use crate::table::{Goal, Row};

/// Points that a path follows, and how far apart they are: what the axis covers at full speed in so many s.
const POINTS: usize = 100;
const STEP: f64 = 0.015;
/// Places at which a path is looked at, and how many paths there are.
const PLACES: usize = 1000;
const PATHS: u64 = 5;

pub(crate) fn rows() -> Rows {
    println!();
    println!(
        "durations: random paths of six axes along {POINTS} points, {PLACES} places, rest to rest; computing in ms;"
    );
    println!("TOPP3: copp's first convex problem, and when further ones change less than 0.1 %");
    println!("path  TOPP2/s    ms  ours/x    ms   TOPP3/s   ms  settled/x   ms   ours/s  ours/x    ms");
    // TOPP2's, ours, TOPP3's first, TOPP3's last, ours with jerk limits: durations and times.
    let mut all: [[Vec<f64>; 5]; 2] = Default::default();
    for seed in 1..=PATHS {
        let path = random_path(seed);
        let second = path.topp2()?;
        let [first, last] = path.topp3()?;
        let [plain, jerk] = [path.ours(false)?, path.ours(true)?];
        println!(
            "{seed:>4} {:>8.3} {:>5.2} {:>7.4} {:>5.2} {:>9.3} {:>4.0} {:>10.4} {:>4.0} {:>8.3} {:>7.4} {:>5.1}",
            second.duration,
            second.time * 1e3,
            plain.duration / second.duration,
            plain.time * 1e3,
            first.duration,
            first.time * 1e3,
            last.duration / first.duration,
            last.time * 1e3,
            jerk.duration,
            jerk.duration / last.duration,
            jerk.time * 1e3,
        );
        for (index, timed) in [second, plain, first, last, jerk].into_iter().enumerate() {
            all[0][index].push(timed.duration);
            all[1][index].push(timed.time * 1e3);
        }
    }
    let [durations, times] = all.map(|values| values.map(|values| geometric_mean(&values)));
    let pair = |means: &[f64; 5], theirs: usize, ours: usize| (means[theirs], means[ours]);
    Ok(vec![
        Row::beside("duration of a path without jerk limits", "copp TOPP2", pair(&durations, 0, 1), "s", 1.01),
        Row { goal: Goal::None, ..Row::beside("computing it", "copp TOPP2", pair(&times, 0, 1), "ms", 0.0) },
        Row::beside("duration of a path with jerk limits", "copp TOPP3-SOCP, first", pair(&durations, 2, 4), "s", 1.05),
        Row::beside("computing it", "copp TOPP3-SOCP, first", pair(&times, 2, 4), "ms", 0.01),
        Row::beside(
            "duration of a path with jerk limits",
            "copp TOPP3-SOCP, settled",
            pair(&durations, 3, 4),
            "s",
            1.05,
        ),
        Row::beside("computing it", "copp TOPP3-SOCP, settled", pair(&times, 3, 4), "ms", 0.01),
    ])
}

fn random_path(seed: u64) -> Path {
    let spline = Spline::random(seed, POINTS, STEP);
    let places: Vec<f64> = (0..PLACES).map(|index| index as f64 / (PLACES - 1) as f64).collect();
    let rad = PI / 180.0;
    let jets = places.iter().map(|at| {
        let jet = spline.jet(*at);
        (0..SPEEDS.len()).map(|axis| jet.map(|order| order[axis] * rad)).collect()
    });
    let limits = SPEEDS.map(|speed| [1.0, ACCELERATION, JERK].map(|factor| speed * factor * rad));
    Path { jets: jets.collect(), places, limits: limits.to_vec() }
}
