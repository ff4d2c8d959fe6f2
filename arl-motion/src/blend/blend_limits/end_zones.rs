//! Crossings whose ends have limits like those of the ways before and behind.
//!
//! A blend that bends sharply leaves little acceleration and jerk to all of it, though its ends hardly bend. Where these keep
//! what is there beside the blend, the robot slows down all the way to where it bends, and not before the blend begins.

use crate::blend::blend_limits::duration::{Approach, alike, duration, shortest};
use crate::blend::blend_limits::{Crossing, PARTS, Site, lower_speeds};
use crate::limits::profile::Limits;

/// Acceleration and jerk at both ends of a crossing.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub(crate) struct Arms {
    /// How many parts each of them has; 0: they are as the middle.
    pub(crate) parts: usize,
    pub(crate) acc: f64,
    pub(crate) jerk: f64,
}

/// How many parts are tried, fewer than half of the crossing.
const COUNTS: [usize; 4] = [2, 4, 5, 6];
/// Shares of the acceleration, and of the jerk, that are there at rest, for the ends and for the middle.
const OUTER: [[f64; 2]; 2] = [[0.9, 0.6], [0.9, 0.9]];
const MIDDLE: [[f64; 2]; 4] = [[0.06, 0.35], [0.06, 0.6], [0.25, 0.35], [0.25, 0.6]];

/// The quickest of a crossing, with the time that it takes, and those with arms. `acc` and `jerk` are what is there at rest.
pub(crate) fn quickest(
    best: (f64, Crossing),
    sites: &[Site],
    (fastest, acc, jerk): (f64, f64, f64),
    approaches: &[Approach; 2],
) -> Crossing {
    let (mut least, mut crossing) = best;
    let of = |[acc_share, jerk_share]: [f64; 2]| Limits {
        vel: f64::INFINITY,
        acc: acc * acc_share,
        jerk: jerk * jerk_share,
    };
    let is_like_a_way = |outer: &Limits| approaches.iter().any(|approach| alike(&approach.limits, outer));
    let outers: Vec<Limits> = OUTER.into_iter().map(of).filter(is_like_a_way).collect();
    if outers.is_empty() {
        return crossing;
    }
    let with_speeds = |limits: Limits| {
        let mut speeds = [fastest; PARTS];
        lower_speeds(&mut speeds, sites, limits.acc, limits.jerk);
        (limits, speeds)
    };
    let middles = MIDDLE.map(|shares| with_speeds(of(shares)));
    for (outer, outer_speeds) in outers.into_iter().map(with_speeds) {
        for (middle, middle_speeds) in middles.iter().filter(|(middle, _)| !alike(middle, &outer)) {
            for parts in COUNTS {
                let speeds = std::array::from_fn(|part| {
                    let speeds = if part < parts || part >= PARTS - parts { &outer_speeds } else { middle_speeds };
                    speeds.get(part).copied().unwrap_or(0.0)
                });
                if shortest(&speeds, approaches) >= least {
                    continue;
                }
                let arms = Arms { parts, acc: outer.acc, jerk: outer.jerk };
                let other = Crossing { speeds, acc: middle.acc, jerk: middle.jerk, arms };
                let time = duration(&other, approaches);
                if time < least {
                    (least, crossing) = (time, other);
                }
            }
        }
    }
    crossing
}
