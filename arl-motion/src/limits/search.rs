//! Finding the edge of what is possible.

/// Tolerances for the edge.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Enough {
    /// Distance from a value that is too high.
    pub(crate) value: f64,
    /// Distance of the excess below 0.
    pub(crate) excess: f64,
}

/// The highest value of a range at which `excess`, which grows over the range and is above 0 at its end, is not above
/// 0; the lowest value where the excess is above 0 there as well.
pub(crate) fn highest(low: f64, high: f64, enough: Enough, excess: impl Fn(f64) -> f64) -> f64 {
    /// As many as bisection alone would take; usually a few are enough.
    const STEPS: u32 = 50;
    let (mut low, mut high) = (low, high);
    let (mut below, mut above) = (excess(low), excess(high));
    let mut stays = 0_i32;
    for step in 0..STEPS {
        if below >= 0.0 || high - low <= enough.value {
            break;
        }
        // The zero of the secant. An end that stays repeatedly counts half, and now and then the range is bisected
        // instead.
        let secant = low - below * (high - low) / (above - below);
        let inside = secant > low && secant < high && step % 4 != 3;
        let middle = if inside { secant } else { f64::midpoint(low, high) };
        let found = excess(middle);
        if found <= 0.0 {
            (low, below, stays) = (middle, found, stays.max(0) + 1);
            if found >= -enough.excess {
                break;
            }
        } else {
            (high, above, stays) = (middle, found, stays.min(0) - 1);
        }
        if stays > 1 {
            above /= 2.0;
        } else if stays < -1 {
            below /= 2.0;
        }
    }
    low
}

#[cfg(test)]
mod tests {
    use super::*;
    use arl_robot::kinematics::random::Random;

    #[test]
    fn the_highest_value_is_found_from_below() {
        let mut random = Random::new(51);
        for excess in [0.0, 1e-9] {
            let enough = Enough { value: 1e-14, excess };
            for _ in 0..2000 {
                let (root, power) = (random.between(0.01, 0.99), random.between(0.3, 6.0));
                let over = |value: f64| value.powf(power) - root.powf(power);
                let found = highest(0.0, 1.0, enough, over);
                assert!(over(found) <= 1e-15 && found <= root * (1.0 + 1e-12), "{found} {root} {power}");
                assert!(over(found) >= -excess || found >= root * (1.0 - 1e-12), "{found} {root} {power}");
            }
        }
        assert_eq!(highest(0.2, 1.0, Enough { value: 0.0, excess: 0.0 }, |value| value), 0.2);
    }

    #[test]
    fn jumps_are_found_like_zeros() {
        let mut random = Random::new(53);
        let enough = Enough { value: 1e-9, excess: 0.0 };
        for _ in 0..2000 {
            let (edge, [below, above]) =
                (random.between(0.01, 0.99), [-4.0, -4.0].map(|least| 10.0_f64.powf(random.between(least, 1.0))));
            let found = highest(0.0, 1.0, enough, |value| if value <= edge { -below } else { above });
            assert!(found <= edge && found >= edge - 1e-3, "{found} {edge}");
        }
    }
}
