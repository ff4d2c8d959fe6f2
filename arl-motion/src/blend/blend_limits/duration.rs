//! About how long a blend takes with given limits, and what the motions before and behind lose by it: accurate enough
//! to choose among several.

use crate::blend::blend_limits::{BlendLimits, PARTS};
use crate::limits::profile::ALIKE_FACTOR;
use crate::limits::profile::{Change, Limits};

/// The path before or behind a blend, as far as the robot can change its speed on it for the blend.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Approach {
    /// Its limits in shares of the blend per s: 1 / nominal time is the nominal speed of the blend.
    pub(crate) limits: Limits,
    /// Its length at the blend's scale.
    pub(crate) length: f64,
}

/// A part of the path with one permitted speed.
#[derive(Clone, Copy)]
struct Part {
    length: f64,
    speed: f64,
}

/// Lengths of the parts of an approach as shares of it, the nearest to the blend first.
const APPROACH_SHARES: [f64; 6] = [1.0 / 32.0, 1.0 / 32.0, 1.0 / 16.0, 1.0 / 8.0, 1.0 / 4.0, 1.0 / 2.0];

/// About how long it takes to cross the blend and the paths before and behind it, in s.
pub(crate) fn duration(blend_limits: &BlendLimits, approaches: &[Approach; 2]) -> f64 {
    if blend_limits.end_zones.parts > 0 {
        return duration_with_end_zones(blend_limits, approaches);
    }
    let own = Limits { vel: f64::INFINITY, acc: blend_limits.acc, jerk: blend_limits.jerk };
    let [before, behind] = approaches;
    let [with_before, with_behind] = approaches.map(|approach| alike(&approach.limits, &own));
    let mut limits = own;
    let mut parts: Vec<Part> = Vec::with_capacity(PARTS + 2 * APPROACH_SHARES.len());
    if with_before {
        limits = lower(limits, &before.limits);
        parts.extend(before.parts().rev());
    }
    parts.extend(blend_limits.speeds.iter().map(|speed| Part { length: 1.0 / PARTS as f64, speed: *speed }));
    if with_behind {
        limits = lower(limits, &behind.limits);
        parts.extend(behind.parts());
    }
    let ends = approaches.map(|approach| approach.limits.vel);
    let (time, [first, last]) = time(&parts, ends, &limits);
    let shared = |joined: bool| joined.then_some(&limits);
    time + before.outside(shared(with_before), first) + behind.outside(shared(with_behind), last)
}

/// The duration with end zones: where they meet the middle of the blend there is no acceleration.
fn duration_with_end_zones(blend_limits: &BlendLimits, [before, behind]: &[Approach; 2]) -> f64 {
    let BlendLimits { speeds, acc, jerk, end_zones } = blend_limits;
    let parts: Vec<Part> = speeds.iter().map(|speed| Part { length: 1.0 / PARTS as f64, speed: *speed }).collect();
    let (first, rest) = parts.split_at(end_zones.parts);
    let (middle, last) = rest.split_at(PARTS - 2 * end_zones.parts);
    let limits = Limits { vel: f64::INFINITY, acc: *acc, jerk: *jerk };
    let outer = Limits { vel: f64::INFINITY, acc: end_zones.acc, jerk: end_zones.jerk };
    let through = |ends: [f64; 2]| time(middle, ends, &limits);
    let (mut own, [entry, exit]) =
        through([first.last(), last.first()].map(|part| part.map_or(0.0, |part| part.speed)));
    let (came, entered) = before.with_end_zone(first.iter().rev(), &outer, entry);
    let (went, exited) = behind.with_end_zone(last.iter(), &outer, exit);
    if entered < entry || exited < exit {
        (own, _) = through([entered, exited]);
    }
    own + came + went
}

/// A lower bound in s of [`duration`] with these speeds, or lower ones, whatever the acceleration and the jerk.
pub(crate) fn shortest(speeds: &[f64; PARTS], approaches: &[Approach; 2]) -> f64 {
    let own: f64 = speeds.iter().map(|speed| 1.0 / speed).sum();
    let around: f64 = approaches.iter().map(|approach| approach.length / approach.limits.vel).sum();
    own / PARTS as f64 + around
}

/// Whether two limits form one stretch, with the lower values: see the timing of the path.
pub(crate) fn alike(a: &Limits, b: &Limits) -> bool {
    let alike = |a: f64, b: f64| a <= b * ALIKE_FACTOR && b <= a * ALIKE_FACTOR;
    alike(a.acc, b.acc) && alike(a.jerk, b.jerk)
}

fn lower(a: Limits, b: &Limits) -> Limits {
    Limits { acc: a.acc.min(b.acc), jerk: a.jerk.min(b.jerk), ..a }
}

impl Approach {
    fn parts(&self) -> impl DoubleEndedIterator<Item = Part> {
        APPROACH_SHARES.iter().map(|share| Part { length: self.length * share, speed: self.limits.vel })
    }

    /// How long the approach takes with an end zone, whose parts are given from the middle of the blend on, and the
    /// speed at the inner end, which is at most `speed`.
    fn with_end_zone<'a>(&self, arm: impl Iterator<Item = &'a Part>, outer: &Limits, speed: f64) -> (f64, f64) {
        let joined = alike(&self.limits, outer);
        let limits = if joined { lower(*outer, &self.limits) } else { *outer };
        let mut parts: Vec<Part> = arm.copied().collect();
        if joined {
            parts.extend(self.parts());
        }
        let (time, [inside, outside]) = time(&parts, [speed, self.limits.vel], &limits);
        (time + self.outside(joined.then_some(&limits), outside), inside)
    }

    /// What the approach adds to the time: where it shares the blend's limits, what the ramp at its other end loses by
    /// them; where it keeps its own, all of it, when the blend is met at `speed`.
    fn outside(&self, shared: Option<&Limits>, speed: f64) -> f64 {
        match shared {
            Some(shared) => {
                let slower = Self { limits: Limits { vel: self.limits.vel, ..*shared }, ..*self };
                slower.lost(0.0) - self.lost(0.0)
            }
            None => self.lost(speed) + self.length / self.limits.vel,
        }
    }

    /// How long the approach takes with a stop in the middle of the blend, of which `more` is on this side.
    pub(crate) fn with_stop(&self, more: f64) -> f64 {
        let whole = Self { length: self.length + more, ..*self };
        whole.lost(0.0) + whole.length / whole.limits.vel
    }

    /// The time that is lost by beginning or ending at `speed`.
    fn lost(&self, speed: f64) -> f64 {
        let Self { limits, length } = self;
        if *length <= 0.0 {
            return 0.0;
        }
        let cruise = limits.vel;
        let ramp = Change::new(speed, 0.0, cruise, limits);
        let distance = ramp.distance(speed, 0.0);
        if distance <= *length {
            return ramp.duration() - distance / cruise;
        }
        let top = reach(speed, *length, limits).min(cruise);
        length / f64::midpoint(speed, top) - length / cruise
    }
}

/// How long a path takes that is entered and left at no more than `ends`, and the speeds at its start and its end.
fn time(parts: &[Part], [first, last]: [f64; 2], limits: &Limits) -> (f64, [f64; 2]) {
    let before = [first].into_iter().chain(parts.iter().map(|part| part.speed));
    let behind = parts.iter().map(|part| part.speed).chain([last]);
    let free: Vec<f64> = before.zip(behind).map(|(before, behind)| before.min(behind)).collect();
    let fastest = free.iter().copied().fold(0.0, f64::max);
    let mut speeds = free.clone();
    for (from, slow) in free.iter().enumerate() {
        // A place that is no slower than its neighbours limits nothing.
        let neighbours = [from.checked_sub(1), Some(from + 1)].map(|at| at.and_then(|at| free.get(at)));
        if neighbours.iter().flatten().all(|next| *next <= slow) {
            continue;
        }
        let (left, right) = speeds.split_at_mut(from);
        let (left, right) = (left.iter_mut().rev(), right.iter_mut().skip(1));
        let (behind, ahead) = parts.split_at(from);
        let beside = free.split_at(from);
        bind(*slow, left.zip(beside.0.iter().rev()).zip(behind.iter().rev()), fastest, limits);
        bind(*slow, right.zip(beside.1.iter().skip(1)).zip(ahead), fastest, limits);
    }
    let ends = speeds.iter().zip(speeds.iter().skip(1));
    let each = |(part, (start, end)): (&Part, (&f64, &f64))| part.length / f64::midpoint(*start, *end).min(part.speed);
    let whole = parts.iter().zip(ends).map(each).sum();
    (whole, [speeds.first(), speeds.last()].map(|speed| speed.copied().unwrap_or(0.0)))
}

/// Lowers speeds in one direction from a place with the speed `slow` to what can be reached from there. Each speed
/// comes with its value without this limit, and with the part that leads to it; no speed is above `fastest`.
fn bind<'a>(
    slow: f64,
    speeds: impl Iterator<Item = ((&'a mut f64, &'a f64), &'a Part)>,
    fastest: f64,
    limits: &Limits,
) {
    let mut distance = 0.0;
    for ((speed, free), part) in speeds {
        // From a place that is as slow, what lies behind is limited more strictly.
        if *free <= slow {
            return;
        }
        distance += part.length;
        if *speed > slow {
            let most = reach(slow, distance, limits);
            *speed = speed.min(most);
            if most >= fastest {
                return;
            }
        }
    }
}

/// The highest speed that is reached from `speed` within a distance, without acceleration at either end.
fn reach(speed: f64, distance: f64, limits: &Limits) -> f64 {
    let Limits { acc, jerk, .. } = *limits;
    // With the full acceleration for a while: way = (2 speed + gain) / 2 (gain / acc + acc / jerk).
    let ramp = acc * acc / jerk;
    let half = speed + ramp / 2.0;
    let gain = (half * half + 2.0 * (acc * distance - speed * ramp)).max(0.0).sqrt() - half;
    if gain >= ramp {
        return speed + gain;
    }
    // Without: way = (2 speed + gain) sqrt(gain / jerk), a cubic equation for the root of the gain.
    let scaled = distance * jerk.sqrt();
    let mut root = libm::cbrt(scaled).min(scaled / (2.0 * speed));
    for _ in 0..4 {
        root -= (root * (root * root + 2.0 * speed) - scaled) / (3.0 * root * root + 2.0 * speed);
    }
    speed + root * root
}

#[cfg(test)]
mod tests {
    use super::*;
    use arl_robot::kinematics::random::Random;

    #[test]
    fn a_change_of_the_speed_takes_the_distance_in_which_it_is_reached() {
        let mut random = Random::new(32);
        for _ in 0..2000 {
            let limits = Limits { vel: 1.0, acc: random.between(0.5, 20.0), jerk: random.between(1.0, 500.0) };
            let (speed, distance) = (random.between(0.0, 2.0), 10.0_f64.powf(random.between(-4.0, 1.0)));
            let goal = reach(speed, distance, &limits);
            let found = Change::new(speed, 0.0, goal, &limits).distance(speed, 0.0);
            assert!((found - distance).abs() < 1e-4 * distance, "{speed} {goal} {found} {distance} {limits:?}");
        }
    }

    #[test]
    fn a_path_takes_what_its_ramps_and_its_speeds_take() {
        let limits = Limits { vel: 1.0, acc: 10.0, jerk: 1e9 };
        let part = |length: f64, speed: f64| Part { length, speed };
        // Down from 1 to 0.5 and up again, over 0.0375 each.
        let parts = [part(0.0375, 1.0), part(0.1, 0.5), part(0.0375, 1.0)];
        let (time, ends) = time(&parts, [2.0; 2], &limits);
        assert!((time - 0.3).abs() < 1e-6 && ends.iter().all(|end| (end - 1.0).abs() < 1e-6), "{time} {ends:?}");
    }
}
