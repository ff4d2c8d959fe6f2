//! The limits along a part of the path, and whether a motion keeps them.

use crate::limits::profile::Limits;
use crate::time_optimal::solver::{ConstrainedPath, Law, Moment, Row};

/// The interval in s at which a motion is checked, and the share of the limits that it may use.
const SAMPLE_S: f64 = 0.001;
pub(crate) const MOST_USED_SHARE: f64 = 1.008;
/// The share that a motion may use by the limits at its places if it is known to be within them: set-points smear out
/// what is shorter than their distance.
const MOST_KNOWN_SHARE: f64 = 1.0095;
/// Near its ends, for this many s, a law is checked at intervals shorter by this factor for uses beyond this share of
/// the limits: where it is at rest, rapid changes take less than a set-point, and would not be noticed before the next
/// law starts.
const BESIDE_END_S: f64 = 0.004;
const CLOSER_BESIDE_END: u32 = 10;
const FAR_BEYOND: f64 = 1.1;
/// A negative speed, in s of nominal time per s, that is due to rounding.
const BACKWARDS_ROUNDING: f64 = 1e-9;
/// No limits.
const NO_LIMITS: Limits = Limits { vel: f64::INFINITY, acc: f64::INFINITY, jerk: f64::INFINITY };

/// The limits along a part of the path.
#[derive(Debug)]
pub(crate) struct LimitCheck {
    path: ConstrainedPath,
    /// The limits of the parameter at each place where it hardly moves.
    straight: Vec<Limits>,
}

/// The share of the limits that a motion uses.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Used {
    /// The largest share.
    pub(crate) most: f64,
    /// The permitted share.
    allowed: f64,
    /// Intervals in which the share is higher than permitted, with the share.
    pub(crate) beyond: Vec<([f64; 2], f64)>,
}

impl Used {
    /// Nothing used so far, by a motion that may use `allowed`.
    pub(crate) fn of(allowed: f64) -> Self {
        Self { most: 0.0, allowed, beyond: Vec::new() }
    }

    /// Notes that the share between two places is `share`.
    pub(crate) fn note(&mut self, between: [f64; 2], share: f64) {
        let share = if share.is_nan() { f64::INFINITY } else { share };
        self.most = self.most.max(share);
        if share > self.allowed {
            self.beyond.push((between, share));
        }
    }
}

/// A motion along the path over time.
pub(crate) trait Timed {
    fn at(&self, time: f64) -> Moment;
    fn duration(&self) -> f64;

    /// Another motion at the same place, known to be within the limits.
    fn known(&self, _time: f64) -> Option<Moment> {
        None
    }
}

impl Timed for Law {
    fn at(&self, time: f64) -> Moment {
        Law::at(self, time)
    }

    fn duration(&self) -> f64 {
        Law::duration(self)
    }
}

impl LimitCheck {
    /// The number of rows of limits.
    pub(crate) fn rows(&self) -> usize {
        self.path.row_count()
    }

    pub(crate) fn new(path: ConstrainedPath) -> Self {
        let least = |index: usize| {
            let rows = path.rows(index).iter().filter(|row| row.first != 0.0);
            rows.fold(NO_LIMITS, |Limits { vel, acc, jerk }, row| {
                let first = row.first.abs();
                Limits {
                    vel: vel.min(row.vel / first),
                    acc: acc.min(row.acc / first),
                    jerk: jerk.min(row.jerk / first),
                }
            })
        };
        Self { straight: (0..path.places().len()).map(least).collect(), path }
    }

    /// Whether a law that is followed at another share of its speed keeps its limits, those of acceleration and jerk
    /// times `stop_scale`.
    pub(crate) fn keeps(&self, motion: &impl Timed, stop_scale: f64) -> bool {
        keeps(&Look { path: &self.path, stop_scale, between: Between::Even }, motion)
    }

    /// Whether a motion that does not follow a law keeps the limits.
    pub(crate) fn surely_keeps(&self, motion: &impl Timed, stop_scale: f64) -> bool {
        keeps(&Look { path: &self.path, stop_scale, between: Between::Most }, motion)
    }

    /// The limits that the parameter has everywhere between two places where it hardly moves.
    pub(crate) fn straight(&self, from: f64, to: f64) -> Limits {
        let places = self.path.places();
        let first = places.partition_point(|place| *place <= from).saturating_sub(1);
        let last = places.partition_point(|place| *place < to) + 1;
        let between = self.straight.get(first..last.min(self.straight.len())).unwrap_or_default();
        let Limits { vel, acc, jerk } = between.iter().fold(NO_LIMITS, |least, here| Limits {
            vel: least.vel.min(here.vel),
            acc: least.acc.min(here.acc),
            jerk: least.jerk.min(here.jerk),
        });
        // Without any limit of its own, a ramp takes a few cycles.
        Limits { vel, acc, jerk: jerk.min(1e3 * acc) }
    }
}

/// Which use counts between two places of a path.
#[derive(Clone, Copy)]
enum Between {
    /// The lower use of the two places, for a law: it was found for what lies between.
    Least,
    /// The use interpolated between the two places: derivatives change evenly from place to place.
    Even,
    /// The higher use of the two places.
    Most,
}

/// The share of the limits that a motion uses, those of acceleration and jerk times `stop_scale`.
fn used(rows: &[Row], now: &Moment, stop_scale: f64) -> f64 {
    rows.iter().fold(0.0_f64, |used, row| {
        let acc = row.first * now.acc + row.second * now.vel * now.vel;
        let jerk =
            row.first * now.jerk + 3.0 * row.second * now.vel * now.acc + row.third * now.vel * now.vel * now.vel;
        let (acc, jerk) = ((acc / row.acc).abs() / stop_scale, (jerk / row.jerk).abs() / stop_scale);
        used.max((row.first * now.vel / row.vel).abs()).max(acc).max(jerk)
    })
}

/// The share of the limits that a law uses, of `allowed`, along the path that it was found for; `None` where the law
/// moves backwards.
pub(crate) fn used_by_law(path: &ConstrainedPath, law: &Law, allowed: f64) -> Option<Used> {
    let looked = Look { path, stop_scale: 1.0, between: Between::Least };
    let mut used = Used::of(allowed);
    for now in moments(law.duration()).map(|time| law.at(time)) {
        if now.vel.is_nan() || now.vel < -BACKWARDS_ROUNDING {
            return None;
        }
        used.note([now.at; 2], looked.used_at(&now));
    }
    for now in moments_beside_ends(law.duration()).map(|time| law.at(time)) {
        let share = looked.used_at(&now);
        if share > FAR_BEYOND {
            used.note([now.at; 2], share);
        }
    }
    Some(used)
}

/// Whether a law along `path` only moves forwards and keeps the limits, those of acceleration and jerk times
/// `stop_scale`.
pub(crate) fn law_keeps(path: &ConstrainedPath, law: &Law, stop_scale: f64) -> bool {
    keeps(&Look { path, stop_scale, between: Between::Least }, law)
}

/// Whether a motion only moves forwards and keeps the limits.
fn keeps(looked: &Look, motion: &impl Timed) -> bool {
    moments(motion.duration()).all(|time| {
        let now = motion.at(time);
        let used = looked.used_at(&now);
        let may = || {
            used <= MOST_USED_SHARE
                || motion.known(time).is_some_and(|known| used <= looked.used_at(&known).min(MOST_KNOWN_SHARE))
        };
        now.vel >= -BACKWARDS_ROUNDING && may()
    })
}

/// The times at which a motion of `duration` s is checked.
fn moments(duration: f64) -> impl Iterator<Item = f64> {
    let count = (duration / SAMPLE_S).clamp(16.0, 4000.0) as u32;
    (0..=count).map(move |step| duration * f64::from(step) / f64::from(count))
}

/// The additional times at which a motion is checked close to its start and its end.
fn moments_beside_ends(duration: f64) -> impl Iterator<Item = f64> {
    let step = SAMPLE_S / f64::from(CLOSER_BESIDE_END);
    let count = (BESIDE_END_S.min(0.5 * duration) / step) as u32;
    (1..count).map(move |index| f64::from(index) * step).flat_map(move |time| [time, duration - time])
}

/// How the limits along a path are checked.
struct Look<'a> {
    path: &'a ConstrainedPath,
    /// Factor on the limits of acceleration and jerk.
    stop_scale: f64,
    between: Between,
}

impl Look<'_> {
    /// The share of the limits that is used.
    fn used_at(&self, now: &Moment) -> f64 {
        let (path, places) = (self.path, self.path.places());
        let used = |rows: &[Row]| used(rows, now, self.stop_scale);
        let next = places.partition_point(|place| *place <= now.at).clamp(1, places.len() - 1);
        let [before, behind] = [path.rows_behind(next - 1), path.rows_before(next)].map(used);
        match self.between {
            Between::Least => before.min(behind),
            Between::Even => {
                let part = (now.at - places[next - 1]) / (places[next] - places[next - 1]);
                before + part.clamp(0.0, 1.0) * (behind - before)
            }
            Between::Most => before.max(behind),
        }
    }
}
