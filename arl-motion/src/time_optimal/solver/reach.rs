//! The fastest motion without jerk limits: one backward pass for the speeds from which the end can be reached, and one
//! forward pass that takes the highest of them.

use crate::time_optimal::solver::law::Law;
use crate::time_optimal::solver::paced_warp::PacedWarp;
use crate::time_optimal::solver::warp::Warp;
use crate::time_optimal::solver::{BoundaryState, ConstrainedPath, Refusal};

/// The half plane `here` x + `next` y <= 1 of the squares of the speed at one place and the next.
#[derive(Clone, Copy, Debug)]
struct Half {
    here: f64,
    next: f64,
}

/// Finds the fastest motion within the velocity and acceleration limits of `path`.
pub(crate) fn solve(path: &ConstrainedPath, start: BoundaryState, end: BoundaryState) -> Result<Law, Refusal> {
    let (from, to) = path.span()?;
    if path.places().len() == 2 && start.rests() && end.rests() {
        // Nothing moves at either place.
        return Err(Refusal::Short);
    }
    let squares = squares(path, [start, end], ROUNDING)?;
    let pairs = path.places().windows(2).zip(squares.windows(2));
    let slopes = pairs.map(|(at, square)| (0.5 * (square[1] - square[0]) / (at[1] - at[0]), 0.0));
    let warp = Warp::new(from, to, false, false);
    let places: Vec<f64> = path.places().iter().map(|at| at - from).collect();
    Ok(Law::new(PacedWarp::even(warp, &places), &places, &squares, slopes))
}

/// The squares of its speed at the places; that at the start may exceed what is possible by the factor `most_excess`.
pub(crate) fn squares(
    path: &ConstrainedPath,
    [start, end]: [BoundaryState; 2],
    most_excess: f64,
) -> Result<Vec<f64>, Refusal> {
    let caps = caps(path);
    let mut half_planes = Vec::new();
    // The lowest and highest square of the speed at each place from which the end can be reached.
    let mut reach = vec![(0.0, 0.0); caps.len()];
    let (mut low, mut high) = (end.vel * end.vel, end.vel * end.vel);
    for (index, slot) in reach.iter_mut().enumerate().rev() {
        let cap = caps.get(index).copied().unwrap_or_default();
        if index + 1 < caps.len() {
            stretch(path, index, &mut half_planes);
            let most = extreme(&half_planes, (0.0, cap), (low, high), true).ok_or(Refusal::Fast)?;
            low = if low > 0.0 {
                extreme(&half_planes, (0.0, cap), (low, high), false).ok_or(Refusal::Fast)?.min(most)
            } else {
                0.0
            };
            high = most;
        } else if high > cap * ROUNDING {
            return Err(Refusal::Fast);
        }
        *slot = (low, high);
    }
    let mut square = start.vel * start.vel;
    if square > high * most_excess || square * most_excess < low {
        return Err(Refusal::Fast);
    }
    square = square.clamp(low, high);
    let mut squares = vec![square];
    for (index, (low, high)) in reach.iter().skip(1).enumerate() {
        stretch(path, index, &mut half_planes);
        let most = half_planes.iter().filter(|half| half.next > 0.0).fold(*high, |most, half| {
            let next = (1.0 - half.here * square) / half.next;
            most.min(next)
        });
        let next = most.max(*low);
        squares.push(next);
        square = next;
    }
    Ok(squares)
}

/// Factor that rounding may add to the square of a speed.
const ROUNDING: f64 = 1.0 + 1e-6;

/// The highest square of the speed at each place by the velocity limits; where none of them counts, the highest of all.
fn caps(path: &ConstrainedPath) -> Vec<f64> {
    let square = |index: usize| {
        let speed = path.rows(index).iter().map(|row| row.vel / row.first.abs()).fold(f64::INFINITY, f64::min);
        speed * speed
    };
    let mut caps: Vec<f64> = (0..path.places().len()).map(square).collect();
    let most = caps.iter().copied().filter(|cap| cap.is_finite()).fold(0.0, f64::max);
    for cap in &mut caps {
        *cap = cap.min(most);
    }
    caps
}

/// Collects the half planes that the acceleration limits at both ends of the stretch `index` leave.
fn stretch(path: &ConstrainedPath, index: usize, half_planes: &mut Vec<Half>) {
    half_planes.clear();
    let (Some(from), Some(to)) = (path.places().get(index), path.places().get(index + 1)) else { return };
    let slope = 0.5 / (to - from);
    for (rows, turned) in [(path.rows(index), false), (path.rows(index + 1), true)] {
        for row in rows.iter().filter(|row| row.acc.is_finite()) {
            let (along, across) = (row.first * slope / row.acc, row.second / row.acc);
            let (here, next) = if turned { (-along, along + across) } else { (across - along, along) };
            if here != 0.0 || next != 0.0 {
                half_planes.extend([Half { here, next }, Half { here: -here, next: -next }]);
            }
        }
    }
}

/// The highest or lowest x in the box of x and y and the half planes, if anything is left: by adding the half planes
/// one by one; where one cuts the optimum off, the new optimum is on its edge.
fn extreme(half_planes: &[Half], x: (f64, f64), y: (f64, f64), highest: bool) -> Option<f64> {
    let (mut best_x, mut best_y) = (if highest { x.1 } else { x.0 }, y.1);
    for (index, half) in half_planes.iter().enumerate() {
        if half.here * best_x + half.next * best_y <= 1.0 + 1e-9 {
            continue;
        }
        // Along the edge from its point closest to zero, in multiples of (next, -here).
        let norm = half.here * half.here + half.next * half.next;
        let (base_x, base_y) = (half.here / norm, half.next / norm);
        let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
        let mut clip = |rate: f64, room: f64| {
            if rate > 0.0 {
                high = high.min(room / rate);
            } else if rate < 0.0 {
                low = low.max(room / rate);
            } else if room < -1e-9 {
                low = f64::INFINITY;
            }
        };
        clip(half.next, x.1 - base_x);
        clip(-half.next, base_x - x.0);
        clip(-half.here, y.1 - base_y);
        clip(half.here, base_y - y.0);
        for other in half_planes.iter().take(index) {
            let rate = other.here * half.next - other.next * half.here;
            clip(rate, 1.0 - other.here * base_x - other.next * base_y);
        }
        if low > high {
            // Rounding may leave nothing of a single point.
            if low - high > 1e-7 * (1.0 + low.abs() + high.abs()) {
                return None;
            }
            (low, high) = (0.5 * (low + high), 0.5 * (low + high));
        }
        let along = if (half.next > 0.0) == highest { high } else { low };
        best_x = (base_x + along * half.next).clamp(x.0, x.1);
        best_y = (base_y - along * half.here).clamp(y.0, y.1);
    }
    Some(best_x)
}
