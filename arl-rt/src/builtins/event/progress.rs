//! The conditions of triggers: the progress of the current motion. Without a motion they are false.

use crate::context::cx::Cx;
use crate::motion::Progress;

/// The tolerance for reached distances, in mm: what rounding leaves of a line.
const ROUNDING_MM: f64 = 1e-6;
/// The tolerance for reached times, in s.
const ROUNDING_S: f64 = 1e-6;
/// The tolerance for reached shares, in percent.
const ROUNDING_PERCENT: f64 = 1e-6;

/// `T`: whether the motion has run for `t` s, counted at an override of 100 %.
pub fn elapsed_time(cx: &Cx, t: f64) -> bool {
    t >= 0.0 && progress(cx).is_some_and(|progress| progress.elapsed_time >= t - ROUNDING_S)
}

/// `S`: whether the TCP has travelled `s` mm of its line. Never true on axis motions.
pub fn elapsed_distance(cx: &Cx, s: f64) -> bool {
    s >= 0.0 && line(cx).is_some_and(|progress| progress.elapsed_distance >= s - ROUNDING_MM)
}

/// `StoEnd`: whether the TCP has at most `s` mm of its line left. Never true on axis motions, nor if the whole line is
/// shorter.
pub fn left_distance(cx: &Cx, s: f64) -> bool {
    let within = |progress: &Progress| s <= progress.elapsed_distance + progress.remaining_distance + ROUNDING_MM;
    s >= 0.0 && line(cx).filter(within).is_some_and(|progress| progress.remaining_distance <= s + ROUNDING_MM)
}

/// `P`: whether `p` % of the motion is done.
pub fn elapsed_percent(cx: &Cx, p: f64) -> bool {
    p >= 0.0 && progress(cx).is_some_and(|progress| progress.share * 100.0 >= p - ROUNDING_PERCENT)
}

fn progress(cx: &Cx) -> Option<Progress> {
    cx.progress()
}

/// The progress of a motion along a line.
fn line(cx: &Cx) -> Option<Progress> {
    progress(cx).filter(|progress| progress.elapsed_distance + progress.remaining_distance > 0.0)
}
