//! The speed that keeps a programmed duration.

use crate::limits::profile::{LOOK_AHEAD_MARGIN, Limits};
use crate::limits::search::{self, Enough};

/// Tolerances: of the speed that keeps a duration, and of the duration itself, in s.
pub(crate) const DURATION_TOLERANCE: Enough = Enough { value: 1e-12, excess: 1e-9 };

/// The lowest of the speeds between two at which a motion is completed within `duration` s, braking with a margin; the
/// higher one where no speed suffices.
pub(crate) fn slowest_within(duration: f64, [lowest, highest]: [f64; 2], limits: impl Fn(f64) -> Limits) -> f64 {
    let sooner = |vel: f64| duration - limits(vel).duration_braking(1.0, LOOK_AHEAD_MARGIN);
    if sooner(highest) <= 0.0 { highest } else { search::highest(lowest, highest, DURATION_TOLERANCE, sooner) }
}
