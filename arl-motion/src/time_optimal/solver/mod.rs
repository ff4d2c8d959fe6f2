//! The fastest speed along a given path that keeps every axis's velocity, acceleration and jerk within limits.
//!
//! The unknown is x, the square of the path parameter's speed, as a function of the parameter. Velocity and
//! acceleration limits are linear in x and its slope. Without jerk limits the optimum is found by one backward and one
//! forward pass over the places (`reach`). A jerk limit bounds a linear form of x, its slope and its second derivative,
//! the bend, by 1/sqrt(x). The tangent of that bound is always below it, so every convex problem formed with it is
//! safe, and an interior point method that renews the tangents in every step (`interior`) climbs to the optimum.
//!
//! At rest, x as a function of the path parameter has an infinite bend. The problem is therefore stated over a warped
//! parameter (`warp`) of which the path parameter is the cube near rest: constant jerk then means constant speed. From
//! the warped parameter, a first guess of the speed makes a parameter that runs roughly as time does (`paced_warp`).

mod banded;
mod constrained_path;
mod error;
mod guess;
mod interior;
mod lanes;
mod law;
mod pace;
mod paced_warp;
mod program;
mod reach;
mod screen;
#[cfg(test)]
mod tests;
mod warp;
mod warped_row;

pub use constrained_path::{ConstrainedPath, Row};
pub use error::Refusal;
pub(crate) use guess::{guess_steps, thinned};
pub(crate) use interior::CREEPING;
pub use law::{Law, Moment};
pub(crate) use pace::Pace;

use warp::Warp;

/// The motion of the path parameter at an end of the path.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct BoundaryState {
    /// Speed, per s; not negative.
    pub vel: f64,
    /// Acceleration, per s2; ignored at rest, where the speed is 0.
    pub acc: f64,
}

impl BoundaryState {
    /// At rest.
    pub const REST: Self = Self { vel: 0.0, acc: 0.0 };

    fn rests(&self) -> bool {
        self.vel == 0.0
    }
}

/// Returns `count` path parameters from `from` to `to` that are close together where the motion is slow because it
/// starts or ends at rest: places for a [`ConstrainedPath`].
pub fn places(from: f64, to: f64, count: usize, start: BoundaryState, end: BoundaryState) -> Vec<f64> {
    let warp = Warp::new(from, to, start.rests(), end.rests());
    let last = count.max(2) - 1;
    let inner = |index: usize| warp.place(warp.length() * index as f64 / last as f64).at;
    (0..=last).map(|index| if index == last { to } else { inner(index) }).collect()
}

/// Finds the fastest motion along `path` from `start` to `end`.
///
/// Limits are kept at the places of the path, and between them as far as the places are close: about 100 where the path
/// bends once. From rest to rest there always is a motion. Without jerk limits the acceleration jumps, and the
/// accelerations at both ends are ignored.
///
/// A motion that starts on the path of another one has half a percent more acceleration and jerk available, and up to
/// 0.3 % more of all limits at its first 50 places. What the state there uses beyond the limits, up to 1 %, is added.
/// Where only braking is left, even that is not always enough, and the start is refused as too fast: the previous law
/// remains valid.
///
/// # Errors
/// The path has fewer than two places, or its places are not in order; rows contain values that are not numbers or
/// limits that are not positive; nothing moves along the path; or no motion within the limits has the given states at
/// both ends.
pub fn fastest(path: &ConstrainedPath, start: BoundaryState, end: BoundaryState) -> Result<Law, Refusal> {
    fastest_behind(path, start, end, None)
}

/// Finds the fastest motion where a law leads to the start, and on along the same path as far as the law goes.
pub(crate) fn fastest_behind(
    path: &ConstrainedPath,
    start: BoundaryState,
    end: BoundaryState,
    before: Option<&Law>,
) -> Result<Law, Refusal> {
    check(path, [start, end])?;
    if !path.limits_jerk() {
        return reach::solve(path, start, end);
    }
    interior::solve(&path.rising_beside_rest([start, end]), [start, end], before)
}

/// Finds the fastest motion where the pace is roughly known: that of a law ([`Law::pace`]) with other limits at the
/// same places.
pub(crate) fn fastest_near(
    path: &ConstrainedPath,
    start: BoundaryState,
    end: BoundaryState,
    pace: &Pace,
) -> Result<Law, Refusal> {
    check(path, [start, end])?;
    interior::solve_near(&path.rising_beside_rest([start, end]), [start, end], pace)
}

fn check(path: &ConstrainedPath, edges: [BoundaryState; 2]) -> Result<(), Refusal> {
    path.check()?;
    let is_sound = |edge: &BoundaryState| edge.vel >= 0.0 && edge.vel.is_finite() && edge.acc.is_finite();
    if edges.iter().all(is_sound) { Ok(()) } else { Err(Refusal::Boundary) }
}
