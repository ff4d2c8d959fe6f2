//! Estimates how fast a motion can be at each place, without a search.

use crate::time_optimal::solver::screen::highest_square;
use crate::time_optimal::solver::warp::Warp;
use crate::time_optimal::solver::warped_row::WarpedRow;
use crate::time_optimal::solver::{BoundaryState, ConstrainedPath};

/// In the fastest rise from rest with limited jerk, the power 3/4 of the squared speed grows linearly with the
/// distance, at this rate times the root of the jerk; only a share of it is used, to leave room for accelerations to
/// begin and end.
const RISE: f64 = 2.12;
const GUESSED_SHARE_OF_RISE: f64 = 0.5;

/// Estimates how fast the warped parameter can be at the places, given as warped parameters: as the limits permit at an
/// even speed, and as can be reached from the neighbouring places.
pub(crate) fn guess_speeds(path: &ConstrainedPath, warp: &Warp, places: &[f64], edges: [BoundaryState; 2]) -> Vec<f64> {
    let last = places.len().saturating_sub(1);
    let mut squares = Vec::with_capacity(places.len());
    // Limits of the growth of the square, and of its power 3/4.
    let mut rises = Vec::with_capacity(places.len());
    for (index, at) in places.iter().enumerate() {
        let place = warp.place(*at);
        let edge = edges.iter().zip([0, last]).find(|(edge, at)| *at == index && !edge.rests());
        let given = edge.map_or(f64::INFINITY, |(edge, _)| edge.vel * edge.vel / (place.first * place.first));
        let (mut square, mut even, mut acc, mut jerk) = (given, 0.0_f64, f64::INFINITY, f64::INFINITY);
        for row in path.rows(index).iter().filter(|row| row.moves()) {
            let row = WarpedRow::new(row, place);
            square = square.min(1.0 / row.vel).min(1.0 / row.acc[1].abs());
            even = even.max(row.jerk[2].abs());
            acc = acc.min(1.0 / row.acc[0].abs());
            jerk = jerk.min(1.0 / row.jerk[0].abs());
        }
        squares.push(square.min(highest_square(std::iter::once(even))));
        rises.push([2.0 * acc, GUESSED_SHARE_OF_RISE * RISE * jerk.sqrt()]);
    }
    let highest = squares.iter().copied().filter(|square| square.is_finite()).fold(0.0, f64::max);
    squares.iter_mut().for_each(|square| *square = square.min(highest));
    let mut bind = |from: usize, to: usize| {
        let width = (places[to] - places[from]).abs();
        let [by_acc, by_jerk] = [0, 1].map(|order: usize| rises[from][order].min(rises[to][order]) * width);
        let by_jerk = libm::pow(libm::pow(squares[from], 0.75) + by_jerk, 4.0 / 3.0);
        squares[to] = squares[to].min(squares[from] + by_acc).min(by_jerk);
    };
    (1..places.len()).for_each(|to| bind(to - 1, to));
    (1..places.len()).rev().for_each(|from| bind(from, from - 1));
    squares.iter().map(|square| square.sqrt()).collect()
}

/// Number of smoothings in a row: a kink in the speeds would put a kink into a problem that has none of its own.
const SMOOTHINGS: usize = 24;

/// Speeds with smaller kinks: each speed is averaged with its neighbours by logarithms.
pub(crate) fn smooth(speeds: Vec<f64>) -> Vec<f64> {
    let last = speeds.len().saturating_sub(1);
    (0..SMOOTHINGS).fold(speeds, |speeds, _| {
        let at = |index: usize| speeds.get(index).copied().unwrap_or(1.0);
        let one = |index: usize| {
            let (before, here, behind) = (at(index.saturating_sub(1)), at(index), at((index + 1).min(last)));
            here.sqrt() * (before * behind).sqrt().sqrt()
        };
        (0..=last).map(one).collect()
    })
}

/// With no more places than this, none is left out: a law is found soon enough.
const FEW_PLACES: usize = 160;
/// Near a sharp blend, as near a stop, the speed changes much within a short time.
const CHANGE_OF_SPEED: f64 = 1.1;
/// Thinning to find a pace. Near a given start all places stay: the state there may leave hardly any possible motion.
const COARSE: Thinning = Thinning { closest: 0.006, change: 1.5, begun: 0.1, keeps_jumps: false };

/// A low estimate of the time that the fastest motion takes from each place to the next, in s.
pub(crate) fn guess_steps(path: &ConstrainedPath, edges: [BoundaryState; 2]) -> Option<Vec<f64>> {
    let (from, to) = path.span().ok()?;
    let warp = Warp::new(from, to, edges[0].rests(), edges[1].rests());
    let places: Vec<f64> = path.places().iter().map(|at| warp.find(*at)).collect();
    let speeds = guess_speeds(path, &warp, &places, edges);
    let step = |(place, speed): (&[f64], &[f64])| (place[1] - place[0]) / f64::midpoint(speed[0], speed[1]);
    Some(places.windows(2).zip(speeds.windows(2)).map(step).collect())
}

/// Rules for leaving out places of a path.
struct Thinning {
    /// Distance in time, in s, within which places are left out, with the exceptions below.
    closest: f64,
    /// Places stay behind which the speed differs by at least this factor from that behind the last place that is kept.
    change: f64,
    /// Places stay within this time behind the start, in s.
    begun: f64,
    /// Whether places stay where derivatives jump.
    keeps_jumps: bool,
}

/// The path without places that are closer together than `closest` s by these steps, except those where derivatives
/// jump or the speed changes much; `None` where it has few places.
pub(crate) fn thinned(path: &ConstrainedPath, steps: &[f64], closest: f64) -> Option<ConstrainedPath> {
    keep(path, steps, &Thinning { closest, change: CHANGE_OF_SPEED, begun: 0.0, keeps_jumps: true })
}

/// The path with about a third of its places, which is enough for the pace of a law, but not for the law; `None` where
/// it has few places.
pub(crate) fn coarse(path: &ConstrainedPath, edges: [BoundaryState; 2]) -> Option<ConstrainedPath> {
    let steps = guess_steps(path, edges)?;
    keep(path, &steps, &COARSE)
}

fn keep(path: &ConstrainedPath, steps: &[f64], thinning: &Thinning) -> Option<ConstrainedPath> {
    let Thinning { closest, change, begun, keeps_jumps } = *thinning;
    if path.places().len() <= FEW_PLACES {
        return None;
    }
    let lengths = path.places().windows(2).map(|pair| pair[1] - pair[0]);
    let speeds: Vec<f64> = lengths.zip(steps).map(|(length, step)| length / step).collect();
    let changes = |from: f64, to: f64| from.max(to) > change * from.min(to);
    // Assumes rest before the start, so that the place behind the start stays, too.
    let (mut time, mut since, mut before, mut keep) = (0.0, 0.0, 0.0, vec![true]);
    for (index, (step, behind)) in (1..).zip(steps.iter().zip(speeds.iter().skip(1))) {
        (time, since) = (time + step, since + step);
        let stays = time < begun || (keeps_jumps && path.jumps(index));
        let is_kept = stays || since >= closest || changes(before, *behind);
        keep.push(is_kept);
        if is_kept {
            (since, before) = (0.0, *behind);
        }
    }
    keep.push(true);
    Some(path.only(&keep))
}
