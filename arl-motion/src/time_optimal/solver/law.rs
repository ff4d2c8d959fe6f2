//! A timed path: the path parameter as a function of time.

use crate::time_optimal::solver::pace::Pace;
use crate::time_optimal::solver::paced_warp::PacedWarp;

/// The state of the path parameter at a moment.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Moment {
    /// The path parameter.
    pub at: f64,
    /// Its speed, per s.
    pub vel: f64,
    /// Its acceleration, per s2.
    pub acc: f64,
    /// Its jerk, per s3.
    pub jerk: f64,
}

/// The stretch from one place to the next, in which the paced parameter's acceleration changes linearly with the paced
/// parameter.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct LawInterval {
    /// The paced parameter at its start.
    pub(crate) at: f64,
    /// Speed and acceleration of the paced parameter there.
    pub(crate) vel: f64,
    pub(crate) acc: f64,
    /// Change of the acceleration with the paced parameter.
    pub(crate) bend: f64,
    /// Time at its start.
    time: f64,
}

/// A motion along a path, from its first place to its last.
#[derive(Clone, Debug)]
pub struct Law {
    warp: PacedWarp,
    /// The path parameter at the end of the path.
    end: f64,
    stretches: Vec<LawInterval>,
    duration: f64,
}

impl Law {
    /// Creates a law from the paced places, the squares of the paced parameter's speed there, and its acceleration at
    /// the start of each stretch with its change, as in [`LawInterval`].
    pub(crate) fn new(
        warp: PacedWarp,
        places: &[f64],
        squares: &[f64],
        stretches: impl Iterator<Item = (f64, f64)>,
    ) -> Self {
        let mut time = 0.0;
        let stretches = places.windows(2).zip(squares).zip(stretches).map(|((pair, square), (acc, bend))| {
            let stretch = LawInterval { at: pair[0], vel: square.max(0.0).sqrt(), acc, bend, time };
            time += stretch.duration(pair[1] - pair[0]);
            stretch
        });
        let stretches = stretches.collect();
        let end = warp.place(places.len().saturating_sub(1), warp.length()).at;
        Self { warp, end, stretches, duration: time }
    }

    /// The times at its places; `None` where the law was found over the warped parameter itself.
    pub(crate) fn pace(&self) -> Option<Pace> {
        let last = self.stretches.last().map(|last| last.after(self.duration - last.time).1);
        let speeds = self.warp.speeds(self.stretches.iter().map(|stretch| stretch.vel).chain(last))?;
        let times = self.stretches.iter().map(|stretch| stretch.time).chain([self.duration]).collect();
        Some(Pace { times, ends: [*speeds.first()?, *speeds.last()?] })
    }

    /// The times at places of its path, those that it was found from or others; `None` as for `pace`.
    pub(crate) fn pace_at(&self, places: &[f64]) -> Option<Pace> {
        let Pace { ends, .. } = self.pace()?;
        Some(Pace { times: places.iter().map(|at| self.time_at(*at)).collect(), ends })
    }

    /// The number of its stretches.
    pub(crate) fn stretches(&self) -> usize {
        self.stretches.len()
    }

    /// Passes all numbers that define it to `note`.
    pub(crate) fn numbers(&self, note: &mut impl FnMut(u64)) {
        note(self.stretches.len() as u64);
        let Self { warp, end, stretches, duration } = self;
        [*end, *duration, warp.length()].into_iter().for_each(|number| note(number.to_bits()));
        for (index, LawInterval { at, vel, acc, bend, time }) in stretches.iter().enumerate() {
            let place = warp.place(index, *at);
            [*vel, *acc, *bend, *time, place.at, place.first, place.second, place.third]
                .into_iter()
                .for_each(|number| note(number.to_bits()));
        }
    }

    /// The path parameter at its end.
    pub(crate) fn end(&self) -> f64 {
        self.end
    }

    /// The mean speed of the path parameter.
    pub(crate) fn mean_speed(&self) -> f64 {
        let start = self.warp.place(0, 0.0).at;
        if self.duration > 0.0 { (self.end - start) / self.duration } else { 0.0 }
    }

    /// The duration of the motion, in s.
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// The state `time` s after the start; before the start, that at the start, and after the end, that at the end.
    pub fn at(&self, time: f64) -> Moment {
        let time = time.clamp(0.0, self.duration);
        let index = self.stretches.partition_point(|stretch| stretch.time <= time).saturating_sub(1);
        let Some(stretch) = self.stretches.get(index) else {
            return Moment { at: self.end, vel: 0.0, acc: 0.0, jerk: 0.0 };
        };
        let (at, vel, acc) = stretch.after(time - stretch.time);
        let jerk = stretch.bend * vel;
        let place = self.warp.place(index, at.min(self.warp.length()));
        Moment {
            at: place.at,
            vel: place.first * vel,
            acc: place.first * acc + place.second * vel * vel,
            jerk: place.first * jerk + 3.0 * place.second * vel * acc + place.third * vel * vel * vel,
        }
    }

    /// The time at which the path parameter is `at`, in s from the start.
    pub fn time_at(&self, at: f64) -> f64 {
        if at >= self.end {
            return self.duration;
        }
        let at = self.warp.find(at).max(0.0);
        let index = self.stretches.partition_point(|stretch| stretch.at <= at).saturating_sub(1);
        self.stretches.get(index).map_or(0.0, |stretch| stretch.time + stretch.duration(at - stretch.at))
    }
}

impl LawInterval {
    /// The paced parameter, its speed and its acceleration after `time`.
    fn after(&self, time: f64) -> (f64, f64, f64) {
        let Self { vel, acc, bend, .. } = *self;
        let (odd, even) = growth(bend, time);
        let distance = vel * odd + acc * even;
        (self.at + distance, vel * (1.0 + bend * even) + acc * odd, acc + bend * distance)
    }

    /// The time that it takes to advance by `distance`.
    fn duration(&self, distance: f64) -> f64 {
        let Self { vel, acc, bend, .. } = *self;
        let then = (vel * vel + distance * (2.0 * acc + distance * bend)).max(0.0).sqrt();
        if distance <= 0.0 {
            return 0.0;
        }
        if vel + then <= 0.0 {
            // A single stretch from rest to rest without acceleration in between would never end.
            return 1e9;
        }
        let mut time = 2.0 * distance / (vel + then);
        let turns = bend * time * time;
        if turns.abs() > 1e-3 {
            let rate = bend.abs().sqrt();
            let after = acc + bend * distance;
            let exact = if bend > 0.0 {
                libm::log((after + rate * then) / (acc + rate * vel)) / rate
            } else {
                (libm::atan2(acc / rate, vel) - libm::atan2(after / rate, then)) / rate
            };
            if exact.is_finite() && exact > 0.0 {
                time = exact;
            }
        }
        for _ in 0..2 {
            let (at, now, _) = self.after(time);
            let step = (at - self.at - distance) / now;
            if now > 0.0 && step.abs() < 0.5 * time {
                time -= step;
            }
        }
        time
    }
}

/// sinh(r t)/r and (cosh(r t) - 1)/r2 for r2 = `bend`, of either sign.
fn growth(bend: f64, time: f64) -> (f64, f64) {
    let turns = bend * time * time;
    if turns.abs() < 1e-2 {
        let odd = 1.0 + turns / 6.0 * (1.0 + turns / 20.0 * (1.0 + turns / 42.0 * (1.0 + turns / 72.0)));
        let even = 0.5 + turns / 24.0 * (1.0 + turns / 30.0 * (1.0 + turns / 56.0 * (1.0 + turns / 90.0)));
        (time * odd, time * time * even)
    } else {
        let rate = bend.abs().sqrt();
        let angle = rate * time;
        // By the half angle, to avoid subtracting 1 from the cosine.
        let function = if bend > 0.0 { libm::sinh } else { libm::sin };
        let (odd, half) = (function(angle), function(0.5 * angle));
        (odd / rate, 2.0 * half * half / bend.abs())
    }
}
