//! Jerk-limited profiles of one path parameter.

/// Limits of the parameter's speed, acceleration and jerk, per s, s2, s3.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Limits {
    pub(super) vel: f64,
    pub(super) acc: f64,
    pub(super) jerk: f64,
}

impl Limits {
    /// The limits of the same profile run at `factor` of its speed.
    pub(super) fn slowed(self, factor: f64) -> Self {
        Self { vel: self.vel * factor, acc: self.acc * factor * factor, jerk: self.jerk * factor * factor * factor }
    }

    /// The highest speed of the shortest profile from rest to rest over `distance`.
    fn peak(&self, distance: f64) -> f64 {
        let Limits { vel, acc, jerk } = *self;
        let ramp = acc / jerk;
        // The speed whose two ramps take up the whole distance: with the full acceleration, else without.
        let full = 0.5 * acc * ((ramp * ramp + 4.0 * distance / acc).sqrt() - ramp);
        let peak = if full >= acc * ramp { full } else { (0.25 * distance * distance * jerk).cbrt() };
        peak.min(vel)
    }

    /// The duration of the shortest profile from rest to rest over `distance`.
    pub(super) fn duration(&self, distance: f64) -> f64 {
        let peak = self.peak(distance);
        let ramp = Change::new(0.0, 0.0, peak, self);
        let rest = (distance - 2.0 * ramp.distance(0.0, 0.0)).max(0.0);
        2.0 * ramp.duration() + if peak > 0.0 { rest / peak } else { 0.0 }
    }
}

/// Where the parameter is and how it moves.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub(super) struct State {
    pub(super) at: f64,
    pub(super) vel: f64,
    pub(super) acc: f64,
}

impl State {
    pub(super) fn resting(at: f64) -> Self {
        Self { at, vel: 0.0, acc: 0.0 }
    }

    pub(super) fn rests(&self) -> bool {
        self.vel == 0.0 && self.acc == 0.0
    }

    fn after(&self, phase: Phase, time: f64) -> Self {
        let Phase { jerk, .. } = phase;
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
#[derive(Clone, Copy)]
struct Change {
    phases: [Phase; 3],
}

impl Change {
    fn new(vel: f64, acc: f64, goal: f64, limits: &Limits) -> Self {
        let (most, jerk) = (limits.acc, limits.jerk);
        // The speed that is left when the acceleration just fades out tells whether to speed up or slow down.
        let fading = vel + acc * acc.abs() / (2.0 * jerk);
        let sign = if goal >= fading { 1.0 } else { -1.0 };
        let (acc, gain) = (acc * sign, (goal - vel) * sign);
        let free = (jerk * gain + acc * acc / 2.0).max(0.0).sqrt();
        let peak = free.min(most);
        let hold = if free > most {
            // What the two ramps do not gain; the first one falls where the acceleration is too high already.
            let ramps = (peak * peak + (peak * peak - acc * acc) * (peak - acc).signum()) / (2.0 * jerk);
            ((gain - ramps) / peak).max(0.0)
        } else {
            0.0
        };
        let first = peak - acc;
        let phase = |time: f64, jerk: f64| Phase { time, jerk: jerk * sign };
        Self { phases: [phase(first.abs() / jerk, jerk * first.signum()), phase(hold, 0.0), phase(peak / jerk, -jerk)] }
    }

    fn duration(&self) -> f64 {
        self.phases.iter().map(|phase| phase.time).sum()
    }

    /// How far the change goes from a start with this speed and acceleration.
    fn distance(&self, vel: f64, acc: f64) -> f64 {
        let start = State { at: 0.0, vel, acc };
        self.phases.iter().fold(start, |state, phase| state.after(*phase, phase.time)).at
    }
}

/// A profile: the parameter over time, from some state to rest.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Profile {
    start: State,
    phases: [Phase; 7],
    duration: f64,
    end: f64,
}

impl Profile {
    /// Stays where it is.
    pub(super) fn resting(at: f64) -> Self {
        Self { start: State::resting(at), phases: [Phase::default(); 7], duration: 0.0, end: at }
    }

    /// The quickest way to rest from `state`.
    pub(super) fn stop(state: State, limits: &Limits) -> Self {
        let change = Change::new(state.vel, state.acc, 0.0, limits);
        let end = state.at + change.distance(state.vel, state.acc);
        Self::of(state, change, 0.0, Change::new(0.0, 0.0, 0.0, limits), end)
    }

    /// From `state` to rest at `end`, no faster than `limits.vel`. `None` where the way is too short to come to rest in.
    pub(super) fn to_rest(state: State, end: f64, limits: &Limits) -> Option<Self> {
        let fits = |vel: f64| Self::over(state, end, vel, limits, limits).1 >= 0.0;
        let peak = if state.rests() {
            limits.peak(end - state.at)
        } else if fits(limits.vel) {
            limits.vel
        } else if fits(0.0) {
            highest(limits.vel, fits)
        } else {
            return None;
        };
        Some(Self::over(state, end, peak, limits, limits).0)
    }

    /// From `state` to rest at `end`: first the speed becomes `limits.vel`, within `limits`; the ramp down at the end keeps
    /// to `ramp`. `None` where the way is too short for that.
    pub(super) fn reaching(state: State, end: f64, limits: &Limits, ramp: &Limits) -> Option<Self> {
        let (profile, rest) = Self::over(state, end, limits.vel, limits, ramp);
        (rest >= 0.0).then_some(profile)
    }

    /// The profile that takes on the speed `vel`, and how much of the way it goes at that speed: less than nothing where
    /// the way is too short.
    fn over(state: State, end: f64, vel: f64, limits: &Limits, ramp: &Limits) -> (Self, f64) {
        let change = Change::new(state.vel, state.acc, vel, limits);
        let down = Change::new(vel, 0.0, 0.0, ramp);
        let rest = end - state.at - change.distance(state.vel, state.acc) - down.distance(vel, 0.0);
        let cruise = if vel > 0.0 { rest.max(0.0) / vel } else { 0.0 };
        (Self::of(state, change, cruise, down, end), rest)
    }

    fn of(start: State, first: Change, cruise: f64, last: Change, end: f64) -> Self {
        let ([a, b, c], [d, e, f]) = (first.phases, last.phases);
        let phases = [a, b, c, Phase { time: cruise, jerk: 0.0 }, d, e, f];
        Self { start, phases, duration: phases.iter().map(|phase| phase.time).sum(), end }
    }

    /// How long it takes, in s.
    pub(super) fn duration(&self) -> f64 {
        self.duration
    }

    /// Where it comes to rest.
    pub(super) fn end(&self) -> f64 {
        self.end
    }

    /// The state at `time`, in s from the start of the profile.
    pub(super) fn at(&self, time: f64) -> State {
        if time >= self.duration {
            return State::resting(self.end);
        }
        let mut state = self.start;
        let mut left = time;
        for phase in self.phases {
            if left <= phase.time {
                state = state.after(phase, left);
                break;
            }
            state = state.after(phase, phase.time);
            left -= phase.time;
        }
        // Rounding must not carry it past its end.
        State { at: state.at.min(self.end), ..state }
    }

    /// When the parameter is first at `at`, in s.
    pub(super) fn time_at(&self, at: f64) -> f64 {
        if at >= self.end {
            return self.duration;
        }
        highest(self.duration, |time| self.at(time).at <= at)
    }
}

/// The highest value up to `top` for which `fits` still holds, where it holds for 0 and ceases once.
fn highest(top: f64, fits: impl Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = (0.0, top);
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if fits(middle) { low = middle } else { high = middle }
    }
    low
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::random::Random;

    fn random_limits(random: &mut Random) -> Limits {
        let vel = 10.0_f64.powf(random.between(-2.0, 2.0));
        let acc = vel * 10.0_f64.powf(random.between(-0.5, 1.5));
        Limits { vel, acc, jerk: acc * 10.0_f64.powf(random.between(-0.5, 2.0)) }
    }

    /// Every phase joins the next, and speed, acceleration and jerk stay within `limits`.
    fn check(profile: &Profile, limits: &Limits) {
        let mut state = profile.start;
        for phase in profile.phases {
            assert!(phase.time >= 0.0, "{profile:?}");
            assert!(phase.time == 0.0 || phase.jerk.abs() <= limits.jerk * 1.000_001, "{profile:?}");
            state = state.after(phase, phase.time);
            assert!(state.acc.abs() <= limits.acc * 1.000_001, "{profile:?}");
            assert!(state.vel >= -1e-9 * limits.vel && state.vel <= limits.vel * 1.000_001, "{state:?} {profile:?}");
        }
        let scale = 1e-9 * (1.0 + profile.end.abs());
        assert!((state.at - profile.end).abs() < scale, "{state:?} {profile:?}");
        assert!(state.vel.abs() < 1e-6 * limits.vel && state.acc.abs() < 1e-6 * limits.acc, "{state:?}");
    }

    #[test]
    fn rest_to_rest_is_within_limits_and_shortest() {
        let mut random = Random::new(11);
        for _ in 0..2000 {
            let limits = random_limits(&mut random);
            let profile = Profile::to_rest(State::default(), 1.0, &limits).unwrap();
            check(&profile, &limits);
            assert!((profile.duration() - limits.duration(1.0)).abs() < 1e-9 * profile.duration());
            // A profile with seven phases is the shortest when it cruises at the limit, or else does not cruise.
            let cruise = profile.phases[3].time;
            let peak = profile.at(profile.duration() / 2.0).vel;
            assert!(cruise < 1e-9 * profile.duration() || peak > limits.vel * 0.999_999, "{profile:?}");
        }
    }

    #[test]
    fn known_profiles() {
        // Cruising: 1 s at 1/s and two ramps of 0.25 s + 0.1 s (0.175 each).
        let limits = Limits { vel: 1.0, acc: 4.0, jerk: 40.0 };
        assert!((limits.duration(1.35) - (1.0 + 0.7)).abs() < 1e-12);
        // Jerk only: four equal phases of t with 2 j t3 covered.
        let limits = Limits { vel: 10.0, acc: 10.0, jerk: 4.0 };
        assert!((limits.duration(1.0) - 4.0 * 0.5).abs() < 1e-12);
    }

    #[test]
    fn a_new_speed_and_a_stop_work_from_any_state_on_the_way() {
        let mut random = Random::new(12);
        for _ in 0..5000 {
            let limits = random_limits(&mut random);
            let profile = Profile::to_rest(State::default(), 1.0, &limits).unwrap();
            let state = profile.at(random.between(0.0, profile.duration()));
            let factor = random.between(0.01, 1.0);
            let slower = Limits { vel: limits.vel * factor, ..limits };
            if let Some(changed) = Profile::reaching(state, 1.0, &slower, &limits.slowed(factor)) {
                check(&changed, &limits);
            }
            if let Some(changed) = Profile::to_rest(state, 1.0, &slower) {
                check(&changed, &limits);
                // Any state of the new profile can be changed again.
                let state = changed.at(random.between(0.0, changed.duration()));
                if let Some(again) = Profile::to_rest(state, 1.0, &limits) {
                    check(&again, &limits);
                }
            } else {
                // Only a state that brakes already as hard as it may has no other way.
                assert!(Profile::stop(state, &limits).end() > 1.0 - 1e-9, "{state:?} {limits:?}");
            }
            let stop = Profile::stop(state, &limits);
            check(&stop, &limits);
            assert!(stop.end() <= 1.0 + 1e-9, "{stop:?}");
            let fast = Limits { vel: limits.vel, acc: 5.0 * limits.acc, jerk: 5.0 * limits.jerk };
            let fast_stop = Profile::stop(state, &fast);
            check(&fast_stop, &fast);
            assert!(fast_stop.end() <= stop.end() + 1e-9);
        }
    }

    #[test]
    fn time_is_found_back() {
        let limits = Limits { vel: 1.0, acc: 4.0, jerk: 40.0 };
        let profile = Profile::to_rest(State::default(), 1.0, &limits).unwrap();
        for part in [0.1, 0.4, 0.7, 0.95] {
            let time = part * profile.duration();
            assert!((profile.time_at(profile.at(time).at) - time).abs() < 1e-9);
        }
        assert_eq!(profile.time_at(1.0), profile.duration());
    }
}
