//! Limits for crossing a blend that bends: one acceleration and jerk for all of it, or for its middle and for both
//! ends, and a speed for each part, so that not all of it is as slow as its sharpest place.

mod duration;
mod end_zones;

use std::ops::Range;

use crate::limits::constant::Constraint;
use crate::limits::profile::Limits;
use crate::plan::constraints::PlaceBounds;
pub(crate) use duration::Approach;
use duration::{duration, shortest};
use end_zones::EndZones;

/// Number of parts of a blend, of equal nominal time, with a speed each.
pub(crate) const PARTS: usize = 16;

/// Limits of the share of a blend that is done: its speed per s, acceleration per s2, jerk per s3.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct BlendLimits {
    /// Speed of each part.
    pub(crate) speeds: [f64; PARTS],
    /// Acceleration and jerk in the middle, or of the whole blend where it has no end zones.
    pub(crate) acc: f64,
    pub(crate) jerk: f64,
    pub(crate) end_zones: EndZones,
}

impl BlendLimits {
    /// Constant limits for the whole blend.
    pub(crate) fn even(Limits { vel, acc, jerk }: Limits) -> Self {
        Self { speeds: [vel; PARTS], acc, jerk, end_zones: EndZones::default() }
    }
}

/// Shares of the acceleration, and of the jerk, available at rest, among which the quickest limits are sought. The
/// remainder is left for the curvature.
const ACC_SHARES: [f64; 5] = [0.06, 0.12, 0.25, 0.5, 0.9];
const JERK_SHARES: [f64; 4] = [0.15, 0.35, 0.6, 0.9];

/// The quickest limits for passing a blend, no faster than `fastest`, that keep every constraint, and about how long it
/// and the approaches take with them, in s.
pub(crate) fn find_blend_limits(
    places: &[PlaceBounds],
    fastest: f64,
    approaches: &[Approach; 2],
) -> Option<(BlendLimits, f64)> {
    let at_rest = limits_at_rest(places);
    let sites: Vec<Site> = places.iter().map(Site::new).collect();
    let mut quickest = Quickest { approaches, best: None };
    try_shares(&mut quickest, &sites, fastest, &at_rest);
    end_zones::try_end_zones(&mut quickest, &sites, fastest, &at_rest);
    let (time, limits) = quickest.best?;
    limits.speeds.iter().all(|speed| *speed > 0.0).then_some((limits, time))
}

/// The acceleration and the jerk that the constraints of all places leave at rest.
fn limits_at_rest(places: &[PlaceBounds]) -> Limits {
    let rows = || places.iter().flat_map(|place| place.rows).filter(|row| row.first > 0.0);
    let lowest = |of: fn(&Constraint) -> f64| rows().map(of).fold(1e12, f64::min);
    Limits { vel: f64::INFINITY, acc: lowest(|row| row.acc / row.first), jerk: lowest(|row| row.jerk / row.first) }
}

/// Tries pairs of an acceleration and a jerk that are the same for the whole blend.
fn try_shares(quickest: &mut Quickest<'_>, sites: &[Site], fastest: f64, at_rest: &Limits) {
    // Speeds only fall as the acceleration and the jerk rise: the speeds of earlier pairs are a bound, which often
    // suffices to know that a pair is slower than another one.
    let mut with_less_acc = [[fastest; PARTS]; JERK_SHARES.len()];
    for acc_share in ACC_SHARES {
        let mut with_less_jerk = [fastest; PARTS];
        for (jerk_share, known) in JERK_SHARES.iter().zip(&mut with_less_acc) {
            for (speed, other) in known.iter_mut().zip(with_less_jerk) {
                *speed = speed.min(other);
            }
            let (acc, jerk) = (at_rest.acc * acc_share, at_rest.jerk * jerk_share);
            if quickest.may_be_beaten_by(known) {
                lower_speeds(known, sites, acc, jerk);
                if quickest.may_be_beaten_by(known) {
                    quickest.consider(BlendLimits { speeds: *known, acc, jerk, end_zones: EndZones::default() });
                }
            }
            with_less_jerk = *known;
        }
    }
}

/// The quickest limits found so far.
struct Quickest<'a> {
    approaches: &'a [Approach; 2],
    /// The limits with the time that they take, in s.
    best: Option<(f64, BlendLimits)>,
}

impl Quickest<'_> {
    /// Whether limits with these speeds, or lower ones, may be quicker.
    fn may_be_beaten_by(&self, speeds: &[f64; PARTS]) -> bool {
        self.best.as_ref().is_none_or(|(least, _)| shortest(speeds, self.approaches) < *least)
    }

    /// Takes these limits if they are quicker.
    fn consider(&mut self, limits: BlendLimits) {
        let time = duration(&limits, self.approaches);
        if self.best.as_ref().is_none_or(|(least, _)| time < *least) {
            self.best = Some((time, limits));
        }
    }
}

/// A place with the parts that it applies to, and bounds that are as strict as all of its own together.
struct Site<'a> {
    parts: Range<usize>,
    rows: &'a [Constraint],
    /// What a unit uses of the limits, as a share: of the speed limit, a unit of speed (`vel`); of the acceleration
    /// limit, one of acceleration and of squared speed (`acc`); of the jerk limit, one of jerk, of the product of speed
    /// and acceleration, and of cubed speed (`jerk`).
    vel: f64,
    acc: [f64; 2],
    jerk: [f64; 3],
}

impl<'a> Site<'a> {
    fn new(place: &PlaceBounds<'a>) -> Self {
        let [first, last] = [place.from, place.to].map(|share| share.clamp(0.0, 1.0) * PARTS as f64);
        let most = |of: fn(&Constraint) -> f64| place.rows.iter().map(of).fold(0.0, f64::max);
        Self {
            parts: first.floor() as usize..last.ceil() as usize,
            rows: place.rows,
            vel: most(|row| row.first / row.vel),
            acc: [most(|row| row.first / row.acc), most(|row| row.second / row.acc)],
            jerk: [
                most(|row| row.first / row.jerk),
                most(|row| row.second / row.jerk),
                most(|row| row.third / row.jerk),
            ],
        }
    }

    /// Whether all bounds hold up to this speed, without checking each.
    fn surely_allows(&self, speed: f64, acc: f64, jerk: f64) -> bool {
        let square = speed * speed;
        self.vel * speed <= 1.0
            && self.acc[0] * acc + self.acc[1] * square <= 1.0
            && self.jerk[0] * jerk + 3.0 * self.jerk[1] * acc * speed + self.jerk[2] * square * speed <= 1.0
    }
}

/// Lowers the speed in each part to the highest one with this acceleration and jerk.
fn lower_speeds(speeds: &mut [f64; PARTS], sites: &[Site], acc: f64, jerk: f64) {
    for site in sites {
        let touched = speeds.get_mut(site.parts.clone()).unwrap_or_default();
        let highest = touched.iter().copied().fold(0.0, f64::max);
        if site.surely_allows(highest, acc, jerk) {
            continue;
        }
        let speed = site.rows.iter().fold(highest, |speed, row| fastest_within(row, speed, acc, jerk));
        for part in touched {
            *part = part.min(speed);
        }
    }
}

/// The highest speed up to `speed` at which a bound holds with this acceleration and jerk.
fn fastest_within(row: &Constraint, speed: f64, acc: f64, jerk: f64) -> f64 {
    let Constraint { first, second, third, .. } = *row;
    let mut speed = if first * speed > row.vel { row.vel / first } else { speed };
    let remaining = row.acc - first * acc;
    if second * speed * speed > remaining {
        speed = (remaining.max(0.0) / second).sqrt();
    }
    let remaining = (row.jerk - first * jerk).max(0.0);
    let (line, cube) = (3.0 * second * acc, third);
    let taken = |speed: f64| speed * (line + cube * speed * speed);
    if taken(speed) > remaining {
        // Newton's steps approach the root from above, since `taken` grows ever faster.
        for _ in 0..40 {
            let next = speed - (taken(speed) - remaining) / (line + 3.0 * cube * speed * speed);
            if next >= speed * (1.0 - 1e-9) {
                break;
            }
            speed = next;
        }
        speed *= 1.0 - 1e-6;
    }
    speed
}

#[cfg(test)]
mod tests {
    use super::*;
    use arl_robot::kinematics::random::Random;

    fn random_places(random: &mut Random) -> Vec<(f64, Vec<Constraint>)> {
        (0..=30).map(|place| (f64::from(place) / 30.0, (0..6).map(|_| Constraint::random(random)).collect())).collect()
    }

    /// Each place applies to the path up to its neighbours.
    fn bounds_of(places: &[(f64, Vec<Constraint>)]) -> Vec<PlaceBounds<'_>> {
        let around = 1.0 / 30.0;
        places.iter().map(|(share, rows)| PlaceBounds { from: share - around, to: share + around, rows }).collect()
    }

    #[test]
    fn no_bound_is_broken_by_any_motion_within_the_limits() {
        let mut random = Random::new(31);
        for _ in 0..300 {
            let places = random_places(&mut random);
            let constraints = bounds_of(&places);
            let approach = Approach { limits: Limits { vel: 1.0, acc: 4.0, jerk: 40.0 }, length: 1.0 };
            let (BlendLimits { speeds, acc, jerk, end_zones }, _) =
                find_blend_limits(&constraints, 1.0, &[approach; 2]).unwrap();
            assert!(acc > 0.0 && jerk > 0.0);
            for (share, rows) in &places {
                let part = ((share * PARTS as f64) as usize).min(PARTS - 1);
                let vel = speeds[part];
                let is_arm = part < end_zones.parts || part >= PARTS - end_zones.parts;
                let (acc, jerk) = if is_arm { (end_zones.acc, end_zones.jerk) } else { (acc, jerk) };
                for constraint in rows {
                    constraint.assert_kept(Limits { vel, acc, jerk });
                }
            }
        }
    }

    #[test]
    fn no_pair_of_shares_is_quicker() {
        let mut random = Random::new(33);
        for _ in 0..300 {
            let places = random_places(&mut random);
            let constraints = bounds_of(&places);
            let sites: Vec<Site> = constraints.iter().map(Site::new).collect();
            let approach = |random: &mut Random| Approach {
                limits: Limits { vel: 1.0, acc: random.between(1.0, 40.0), jerk: random.between(10.0, 4000.0) },
                length: random.between(0.0, 2.0),
            };
            let approaches = [approach(&mut random), approach(&mut random)];
            let (found, least) = find_blend_limits(&constraints, 1.0, &approaches).unwrap();
            assert_eq!(least, duration(&found, &approaches));
            let most = |of: fn(&Constraint) -> f64| {
                places.iter().flat_map(|(_, rows)| rows).filter(|row| row.first > 0.0).map(of).fold(1e12, f64::min)
            };
            let (acc, jerk) = (most(|row| row.acc / row.first), most(|row| row.jerk / row.first));
            for (acc_share, jerk_share) in ACC_SHARES.iter().flat_map(|acc| JERK_SHARES.map(|jerk| (acc, jerk))) {
                let (acc, jerk) = (acc * acc_share, jerk * jerk_share);
                let mut speeds = [1.0; PARTS];
                lower_speeds(&mut speeds, &sites, acc, jerk);
                let blend_limits = BlendLimits { speeds, acc, jerk, end_zones: EndZones::default() };
                let time = duration(&blend_limits, &approaches);
                assert!(least <= time * (1.0 + 1e-5), "{least} {time} {acc_share} {jerk_share}");
            }
        }
    }

    #[test]
    fn only_the_sharp_part_is_slow() {
        let even = Constraint::even(1.0, 1.0, 10.0, 100.0);
        let sharp = Constraint { second: 200.0, third: 2000.0, ..even };
        let rows = [[even], [sharp], [even]];
        let shares = [0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0];
        let row = |share: f64| &rows[usize::from((share - 0.5).abs() < 0.05)];
        let places: Vec<_> =
            shares.iter().map(|share| PlaceBounds { from: share - 0.1, to: share + 0.1, rows: row(*share) }).collect();
        let approach = Approach { limits: Limits { vel: 1.0, acc: 10.0, jerk: 100.0 }, length: 1.0 };
        let (blend_limits, _) = find_blend_limits(&places, 1.0, &[approach; 2]).unwrap();
        assert_eq!(blend_limits.speeds[0], 1.0);
        assert!(blend_limits.speeds[PARTS / 2] < 0.25);
    }

    #[test]
    fn the_ends_of_a_hairpin_have_the_limits_of_the_paths_beside() {
        let even = Constraint::even(1.0, 1.0, 10.0, 1000.0);
        let sharp = Constraint { second: 400.0, third: 40_000.0, ..even };
        let rows = [[even], [sharp]];
        let place = |index: u32| {
            let share = f64::from(index) / 64.0;
            let is_sharp = (share - 0.5).abs() < 0.1;
            PlaceBounds { from: share - 1.0 / 64.0, to: share + 1.0 / 64.0, rows: &rows[usize::from(is_sharp)] }
        };
        let places: Vec<PlaceBounds> = (0..=64).map(place).collect();
        let limits = Limits { vel: 1.0, acc: 10.0, jerk: 1000.0 };
        let approach = Approach { limits, length: 1.0 };
        let (blend_limits, _) = find_blend_limits(&places, 1.0, &[approach; 2]).unwrap();
        assert!(
            blend_limits.end_zones.parts > 0 && blend_limits.end_zones.acc > 4.0 * blend_limits.acc,
            "{blend_limits:?}"
        );
        let without = BlendLimits { end_zones: EndZones::default(), ..blend_limits.clone() };
        assert!(duration(&blend_limits, &[approach; 2]) < 0.9 * duration(&without, &[approach; 2]));
    }
}
