//! Chains of lines whose corners are so flat that both halves can be rounded off completely without leaving the lines
//! noticeably.
//!
//! A dense chain stands for a smooth path. If its zones took less than half of each line, the curvature would rise and
//! fall once per line, and the jerk limit would permit only a small part of the speed. So the size of a zone means
//! nothing there: a curve that stays that close to the programmed lines counts as lying on them.

use nalgebra::SVector;

use crate::command::LARGEST_ZONE;
use crate::geometry::track::Track;
use crate::plan::curve::Curve;
use crate::plan::motion::Motion;

/// The largest distance of such a curve from the lines, in mm (TCP and linear external axes) and in deg (tool and
/// rotary external axes).
const MOST_OFF: f64 = 0.001;
/// A curve with curvature in the middle of lines (see [`crate::blend::mid_curvature`]) leaves a corner by no more than
/// this share of its zone times the change of direction, in rad: lines of unequal lengths come close to it, as a test
/// of random chains shows.
const OFF_PER_TURN: f64 = 0.405;
/// Lines of which one is longer than the other by more than this factor, or whose speeds differ by more than this
/// share, do not form a chain.
const MOST_TIMES_AS_LONG: f64 = 4.0;
const LARGEST_DIFFERENCE_OF_SPEEDS: f64 = 0.01;

/// Whether the corner between two motions belongs to such a chain.
pub(crate) fn is_smooth(from: &Motion, to: &Motion) -> bool {
    let plain = |motion: &Motion| motion.laid.is_none() && motion.timed.is_none() && motion.corner.is_none();
    let (Curve::Tool(a), Curve::Tool(b)) = (&from.curve, &to.curve) else { return false };
    let (Track::Poly(before), Track::Poly(behind)) = (&a.path.track, &b.path.track) else { return false };
    if !(plain(from) && plain(to) && a.is_even() && b.is_even() && a.goes_on(LARGEST_ZONE, b, LARGEST_ZONE)) {
        return false;
    }
    let (shorter, longer) = (from.length.min(to.length), from.length.max(to.length));
    let speeds = [from, to].map(|motion| motion.rate * motion.length);
    let [slower, faster] = [speeds[0].min(speeds[1]), speeds[0].max(speeds[1])];
    if shorter <= 1e-9
        || longer > MOST_TIMES_AS_LONG * shorter
        || slower < faster * (1.0 - LARGEST_DIFFERENCE_OF_SPEEDS)
    {
        return false;
    }
    let zone = LARGEST_ZONE * shorter;
    // Derivatives by the parameter of each line become derivatives by its length.
    let off = |first: SVector<f64, 3>, second: SVector<f64, 3>| {
        OFF_PER_TURN * zone * (second / to.length - first / from.length).norm()
    };
    let moved = off(before.derivative(1, 1.0).into(), behind.derivative(1, 0.0).into());
    let [[turning, ..], [turning_on, ..]] = [a.rotation_rates(1.0), b.rotation_rates(0.0)];
    let external = a.external.derivative(1, 1.0).into_iter().zip(b.external.derivative(1, 0.0));
    let moved_external =
        external.map(|(first, second)| OFF_PER_TURN * zone * (second / to.length - first / from.length).abs());
    moved <= MOST_OFF
        && off(turning, turning_on).to_degrees() <= MOST_OFF
        && moved_external.fold(0.0, f64::max) <= MOST_OFF
}
