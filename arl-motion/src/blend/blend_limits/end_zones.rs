//! Blends whose ends have limits like those of the paths before and behind.
//!
//! A blend that bends sharply leaves little acceleration and jerk for all of it, although its ends hardly bend. Where
//! the ends keep the limits of the adjacent paths, the robot slows down up to where the blend bends, and not already
//! before the blend begins.

use crate::blend::blend_limits::duration::alike;
use crate::blend::blend_limits::{BlendLimits, PARTS, Quickest, Site, lower_speeds};
use crate::limits::profile::Limits;

/// Acceleration and jerk at both ends of a blend.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub(crate) struct EndZones {
    /// Number of parts of each end zone; 0: the ends have the limits of the middle.
    pub(crate) parts: usize,
    pub(crate) acc: f64,
    pub(crate) jerk: f64,
}

/// Tried numbers of parts, fewer than half of the blend.
const END_ZONE_PARTS: [usize; 4] = [2, 4, 5, 6];
/// Shares of the acceleration, and of the jerk, available at rest, for the ends and for the middle.
const END_ZONE_SHARES: [[f64; 2]; 2] = [[0.9, 0.6], [0.9, 0.9]];
const MIDDLE_SHARES: [[f64; 2]; 4] = [[0.06, 0.35], [0.06, 0.6], [0.25, 0.35], [0.25, 0.6]];

/// Tries limits with end zones, where limits without them have been found. `at_rest` is the acceleration and the jerk
/// that all places leave at rest.
pub(crate) fn try_end_zones(quickest: &mut Quickest<'_>, sites: &[Site], fastest: f64, at_rest: &Limits) {
    if quickest.best.is_none() {
        return;
    }
    let of = |[acc, jerk]: [f64; 2]| Limits { acc: at_rest.acc * acc, jerk: at_rest.jerk * jerk, ..*at_rest };
    let approaches = quickest.approaches;
    let is_like_an_approach = |outer: &Limits| approaches.iter().any(|approach| alike(&approach.limits, outer));
    let outers: Vec<Limits> = END_ZONE_SHARES.into_iter().map(of).filter(is_like_an_approach).collect();
    if outers.is_empty() {
        return;
    }
    let with_speeds = |limits: Limits| {
        let mut speeds = [fastest; PARTS];
        lower_speeds(&mut speeds, sites, limits.acc, limits.jerk);
        (limits, speeds)
    };
    let middles = MIDDLE_SHARES.map(|shares| with_speeds(of(shares)));
    for outer in outers.into_iter().map(with_speeds) {
        for middle in middles.iter().filter(|(middle, _)| !alike(middle, &outer.0)) {
            for parts in END_ZONE_PARTS {
                try_parts(quickest, parts, &outer, middle);
            }
        }
    }
}

/// Tries limits with `parts` parts in each end zone: limits and speeds `outer` in the zones, `middle` between them.
fn try_parts(
    quickest: &mut Quickest<'_>,
    parts: usize,
    (outer, outer_speeds): &(Limits, [f64; PARTS]),
    (middle, middle_speeds): &(Limits, [f64; PARTS]),
) {
    let speeds = std::array::from_fn(|part| {
        let speeds = if part < parts || part >= PARTS - parts { outer_speeds } else { middle_speeds };
        speeds.get(part).copied().unwrap_or(0.0)
    });
    if quickest.may_be_beaten_by(&speeds) {
        let end_zones = EndZones { parts, acc: outer.acc, jerk: outer.jerk };
        quickest.consider(BlendLimits { speeds, acc: middle.acc, jerk: middle.jerk, end_zones });
    }
}
