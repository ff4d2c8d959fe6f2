//! Jerk-limited changes of one parameter's speed.

/// Looking ahead uses a little less than the limits, so that whole cycles can follow the result.
pub(crate) const LOOK_AHEAD_MARGIN: f64 = 0.998;

/// Cells whose limits differ by up to this factor share a stretch.
pub(crate) const ALIKE_FACTOR: f64 = 2.0;

/// Limits of the parameter's speed, acceleration and jerk, per s, s2, s3.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Limits {
    pub(crate) vel: f64,
    pub(crate) acc: f64,
    pub(crate) jerk: f64,
}

impl Limits {
    /// The limits of the same profile, run at `factor` times its speed.
    pub(crate) fn slowed(self, factor: f64) -> Self {
        Self { vel: self.vel * factor, acc: self.acc * factor * factor, jerk: self.jerk * factor * factor * factor }
    }

    /// Lowers the jerk so that the acceleration takes at least `time` s to rise.
    pub(crate) fn rising_in(self, time: f64) -> Self {
        Self { jerk: self.jerk.min(self.acc / time), ..self }
    }

    /// The distance of a change from one speed to a lower one, without acceleration at either end: the mean speed times
    /// the time.
    pub(crate) fn slowing(&self, from: f64, to: f64) -> f64 {
        let Self { acc, jerk, .. } = *self;
        let change = (from - to).max(0.0);
        let time = if change * jerk > acc * acc { change / acc + acc / jerk } else { 2.0 * (change / jerk).sqrt() };
        f64::midpoint(from, to) * time
    }

    /// The highest speed of the shortest profile from rest to rest over `distance`.
    fn peak(&self, distance: f64) -> f64 {
        let Limits { vel, acc, jerk } = *self;
        let ramp = acc / jerk;
        // The speed whose two ramps take up the whole distance: with the full acceleration, else without it.
        let full = 0.5 * acc * ((ramp * ramp + 4.0 * distance / acc).sqrt() - ramp);
        let peak = if full >= acc * ramp { full } else { libm::cbrt(0.25 * distance * distance * jerk) };
        peak.min(vel)
    }

    /// The duration of the shortest profile from rest to rest over `distance`.
    pub(crate) fn duration(&self, distance: f64) -> f64 {
        let peak = self.peak(distance);
        let ramp = Change::new(0.0, 0.0, peak, self);
        let rest = (distance - 2.0 * ramp.distance(0.0, 0.0)).max(0.0);
        2.0 * ramp.duration() + if peak > 0.0 { rest / peak } else { 0.0 }
    }

    /// How long the shortest profile from rest to rest over 1 takes to cover `share` from its start.
    pub(crate) fn time_to(&self, share: f64) -> f64 {
        let (mut before, mut behind) = (0.0, self.duration(1.0));
        for _ in 0..60 {
            let middle = f64::midpoint(before, behind);
            if self.state_after(middle).at < share { before = middle } else { behind = middle }
        }
        behind
    }

    /// The state of this profile `time` s after its start.
    pub(crate) fn state_after(&self, time: f64) -> State {
        let whole = self.duration(1.0);
        let speeding_up = Change::new(0.0, 0.0, self.peak(1.0), self);
        if 2.0 * time <= whole {
            return speeding_up.after(State::default(), time);
        }
        // The rest is the same, seen from the other end.
        let from_end = speeding_up.after(State::default(), (whole - time).max(0.0));
        State { at: 1.0 - from_end.at, vel: from_end.vel, acc: -from_end.acc }
    }

    /// [`Limits::duration`] where slowing down uses only `braking` times the acceleration and jerk.
    pub(crate) fn duration_braking(&self, distance: f64, braking: f64) -> f64 {
        let gently = Self { acc: self.acc * braking, jerk: self.jerk * braking, ..*self };
        let ramps = |peak: f64| [Change::new(0.0, 0.0, peak, self), Change::new(peak, 0.0, 0.0, &gently)];
        let distance_to = |peak: f64| {
            let [up, down] = ramps(peak);
            up.distance(0.0, 0.0) + down.distance(peak, 0.0)
        };
        let mut peak = self.vel;
        if distance_to(peak) > distance {
            let mut low = 0.0;
            for _ in 0..60 {
                let middle = f64::midpoint(low, peak);
                if distance_to(middle) <= distance { low = middle } else { peak = middle }
            }
        }
        let rest = (distance - distance_to(peak)).max(0.0);
        ramps(peak).iter().map(Change::duration).sum::<f64>() + if peak > 0.0 { rest / peak } else { 0.0 }
    }
}

/// The position of the parameter and how it moves.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub(crate) struct State {
    pub(crate) at: f64,
    pub(crate) vel: f64,
    pub(crate) acc: f64,
}

impl State {
    pub(crate) fn rests(&self) -> bool {
        self.vel == 0.0 && self.acc == 0.0
    }

    /// The state after `time` s of constant jerk.
    pub(crate) fn after(&self, jerk: f64, time: f64) -> Self {
        Self {
            at: self.at + time * (self.vel + time * (self.acc / 2.0 + time * jerk / 6.0)),
            vel: self.vel + time * (self.acc + time * jerk / 2.0),
            acc: self.acc + time * jerk,
        }
    }
}

#[derive(Clone, Copy, PartialEq, Debug, Default)]
struct Phase {
    time: f64,
    jerk: f64,
}

/// The quickest change from one speed and acceleration to another speed without acceleration.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub(crate) struct Change {
    phases: [Phase; 3],
}

impl Change {
    pub(crate) fn new(vel: f64, acc: f64, goal: f64, limits: &Limits) -> Self {
        let (most, jerk) = (limits.acc, limits.jerk);
        // Whether to speed up or slow down depends on the speed that is left when the acceleration just fades out.
        let fading = vel + acc * acc.abs() / (2.0 * jerk);
        let sign = if goal >= fading { 1.0 } else { -1.0 };
        let (acc, gain) = (acc * sign, (goal - vel) * sign);
        let free = (jerk * gain + acc * acc / 2.0).max(0.0).sqrt();
        let peak = free.min(most);
        let plateau = if free > most {
            // The gain that the two ramps do not provide; the first one falls where the acceleration is too high
            // already.
            let ramps = (peak * peak + (peak * peak - acc * acc) * (peak - acc).signum()) / (2.0 * jerk);
            ((gain - ramps) / peak).max(0.0)
        } else {
            0.0
        };
        let first = peak - acc;
        let phase = |time: f64, jerk: f64| Phase { time, jerk: jerk * sign };
        Self {
            phases: [phase(first.abs() / jerk, jerk * first.signum()), phase(plateau, 0.0), phase(peak / jerk, -jerk)],
        }
    }

    pub(crate) fn duration(&self) -> f64 {
        self.phases.iter().map(|phase| phase.time).sum()
    }

    /// The state `time` s after `state`, for which the change was created; behind its end the speed is constant.
    pub(crate) fn after(&self, state: State, time: f64) -> State {
        let mut state = state;
        let mut remaining = time;
        for phase in self.phases {
            let time = phase.time.min(remaining);
            state = state.after(phase.jerk, time);
            remaining -= time;
            if remaining <= 0.0 {
                return state;
            }
        }
        State { at: state.at + state.vel * remaining, acc: 0.0, ..state }
    }

    /// The rest of the change `time` s after its start.
    pub(crate) fn later(&self, time: f64) -> Self {
        let mut passed = time;
        let phases = self.phases.map(|phase| {
            let here = phase.time.min(passed);
            passed -= here;
            Phase { time: phase.time - here, ..phase }
        });
        Self { phases }
    }

    /// The jerk `time` s after the start.
    pub(crate) fn jerk(&self, time: f64) -> f64 {
        let mut end = 0.0;
        for phase in self.phases {
            end += phase.time;
            if time < end {
                return phase.jerk;
            }
        }
        0.0
    }

    /// The distance of the change from a start with this speed and acceleration.
    pub(crate) fn distance(&self, vel: f64, acc: f64) -> f64 {
        let start = State { at: 0.0, vel, acc };
        self.phases.iter().fold(start, |state, phase| state.after(phase.jerk, phase.time)).at
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use arl_robot::kinematics::random::Random;

    #[test]
    fn known_durations() {
        // Cruising: 1 s at 1/s and two ramps of 0.25 s + 0.1 s (0.175 each).
        let limits = Limits { vel: 1.0, acc: 4.0, jerk: 40.0 };
        assert!((limits.duration(1.35) - (1.0 + 0.7)).abs() < 1e-12);
        // Jerk only: four equal phases of t with 2 j t3 covered.
        let limits = Limits { vel: 10.0, acc: 10.0, jerk: 4.0 };
        assert!((limits.duration(1.0) - 4.0 * 0.5).abs() < 1e-12);
    }

    #[test]
    fn a_profile_is_where_it_is_at_the_time_that_it_takes_there() {
        let mut random = Random::new(33);
        for _ in 0..500 {
            let limits = Limits {
                vel: random.between(0.5, 5.0),
                acc: random.between(0.5, 20.0),
                jerk: random.between(1.0, 500.0),
            };
            let share = random.between(0.0, 1.0);
            let state = limits.state_after(limits.time_to(share));
            assert!((state.at - share).abs() < 1e-9, "{share} {state:?} {limits:?}");
            assert!(state.vel <= limits.vel * 1.000_001 && state.acc.abs() <= limits.acc * 1.000_001, "{state:?}");
        }
    }

    #[test]
    fn a_change_reaches_its_speed_within_the_limits() {
        let mut random = Random::new(12);
        for _ in 0..5000 {
            let limits = Limits { vel: 1.0, acc: random.between(0.5, 20.0), jerk: random.between(1.0, 500.0) };
            let acc = random.between(-limits.acc, limits.acc);
            let (vel, goal) = (random.between(0.0, 2.0), random.between(0.0, 2.0));
            let change = Change::new(vel, acc, goal, &limits);
            let mut state = State { at: 0.0, vel, acc };
            for phase in change.phases {
                assert!(phase.time >= 0.0 && phase.jerk.abs() <= limits.jerk);
                state = state.after(phase.jerk, phase.time);
                assert!(state.acc.abs() <= limits.acc * 1.000_001, "{change:?}");
            }
            assert!((state.vel - goal).abs() < 1e-9 && state.acc.abs() < 1e-9, "{state:?}");
            assert!((state.at - change.distance(vel, acc)).abs() < 1e-12);
            let slowing = Change::new(vel, 0.0, goal, &limits).distance(vel, 0.0);
            assert!(goal > vel || (slowing - limits.slowing(vel, goal)).abs() < 1e-12);
        }
    }
}
