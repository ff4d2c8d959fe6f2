//! The limits along a part of the path, and whether a motion keeps them.

use crate::limits::profile::Limits;
use crate::time_optimal::solver::{Law, Moment, Row, Way};

/// A motion is looked at every so many s, and may use so much of the limits.
const SAMPLE_S: f64 = 0.001;
pub(crate) const MOST_USED_SHARE: f64 = 1.008;
/// By the limits at its places a motion that is known to be within them may use so much: set-points smear out what is
/// shorter than they are apart.
const MOST_KNOWN_SHARE: f64 = 1.0095;
/// Beside its ends, for so many s, a law is looked at closer by this factor, for what is far beyond the limits: where
/// it rests, what changes most does so within less than a set-point, and nobody sees it before the next law goes off.
const BESIDE_END_S: f64 = 0.004;
const CLOSER_BESIDE_END: u32 = 10;
const FAR_BEYOND: f64 = 1.1;
/// A speed below zero, in s of nominal time per s, that is rounding.
const BACKWARDS_ROUNDING: f64 = 1e-9;
/// No limits.
const NO_LIMITS: Limits = Limits { vel: f64::INFINITY, acc: f64::INFINITY, jerk: f64::INFINITY };

/// The limits along a part of the path.
#[derive(Debug)]
pub(crate) struct LimitCheck {
    way: Way,
    /// What the parameter may have at each place where it hardly moves.
    straight: Vec<Limits>,
}

/// How much of the limits a motion uses.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Used {
    /// The largest share.
    pub(crate) most: f64,
    /// What it may be.
    allowed: f64,
    /// From where to where it is more than it may be, and how much.
    pub(crate) beyond: Vec<([f64; 2], f64)>,
}

impl Used {
    /// Nothing so far, of a motion that may use so much.
    pub(crate) fn of(allowed: f64) -> Self {
        Self { most: 0.0, allowed, beyond: Vec::new() }
    }

    /// Between two places it is `share`.
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

    /// Another motion at the same place, which is known to be within the limits.
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
    /// How many rows of limits it has.
    pub(crate) fn rows(&self) -> usize {
        self.way.row_count()
    }

    pub(crate) fn new(way: Way) -> Self {
        let least = |index: usize| {
            let rows = way.rows(index).iter().filter(|row| row.first != 0.0);
            rows.fold(NO_LIMITS, |Limits { vel, acc, jerk }, row| {
                let first = row.first.abs();
                Limits {
                    vel: vel.min(row.vel / first),
                    acc: acc.min(row.acc / first),
                    jerk: jerk.min(row.jerk / first),
                }
            })
        };
        Self { straight: (0..way.places().len()).map(least).collect(), way }
    }

    /// Whether a law that is followed at another share of its speed keeps its limits, those of acceleration and jerk
    /// times `stop_scale`.
    pub(crate) fn keeps(&self, motion: &impl Timed, stop_scale: f64) -> bool {
        keeps(&Look { way: &self.way, stop_scale, between: Between::Even }, motion)
    }

    /// The same for a motion that does not follow a law.
    pub(crate) fn surely_keeps(&self, motion: &impl Timed, stop_scale: f64) -> bool {
        keeps(&Look { way: &self.way, stop_scale, between: Between::Most }, motion)
    }

    /// The limits that the parameter has all the way between two places where it hardly moves.
    pub(crate) fn straight(&self, from: f64, to: f64) -> Limits {
        let places = self.way.places();
        let first = places.partition_point(|place| *place <= from).saturating_sub(1);
        let last = places.partition_point(|place| *place < to) + 1;
        let between = self.straight.get(first..last.min(self.straight.len())).unwrap_or_default();
        let Limits { vel, acc, jerk } = between.iter().fold(NO_LIMITS, |least, here| Limits {
            vel: least.vel.min(here.vel),
            acc: least.acc.min(here.acc),
            jerk: least.jerk.min(here.jerk),
        });
        // Without any limit of its own a ramp takes a few cycles.
        Limits { vel, acc, jerk: jerk.min(1e3 * acc) }
    }
}

/// What counts between two places of a path.
#[derive(Clone, Copy)]
enum Between {
    /// The less that is used of the limits of either, for a law: it was found for what lies between.
    Least,
    /// What lies between what is used of the limits of both: derivatives change evenly from place to place.
    Even,
    /// The more.
    Most,
}

/// The share of the limits, those of acceleration and jerk times `stop_scale`, that a motion uses.
fn used(rows: &[Row], now: &Moment, stop_scale: f64) -> f64 {
    rows.iter().fold(0.0_f64, |used, row| {
        let acc = row.first * now.acc + row.second * now.vel * now.vel;
        let jerk =
            row.first * now.jerk + 3.0 * row.second * now.vel * now.acc + row.third * now.vel * now.vel * now.vel;
        let (acc, jerk) = ((acc / row.acc).abs() / stop_scale, (jerk / row.jerk).abs() / stop_scale);
        used.max((row.first * now.vel / row.vel).abs()).max(acc).max(jerk)
    })
}

/// How much of the limits a law uses, of `allowed`, along the path that it was found for; `None` where it goes
/// backwards.
pub(crate) fn used_by_law(way: &Way, law: &Law, allowed: f64) -> Option<Used> {
    let looked = Look { way, stop_scale: 1.0, between: Between::Least };
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

/// Whether a law along `way` goes forwards and keeps the limits, those of acceleration and jerk times `stop_scale`.
pub(crate) fn law_keeps(way: &Way, law: &Law, stop_scale: f64) -> bool {
    keeps(&Look { way, stop_scale, between: Between::Least }, law)
}

/// Whether a motion goes forwards and keeps the limits.
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

/// When to look at a motion that takes so many s.
fn moments(duration: f64) -> impl Iterator<Item = f64> {
    let count = (duration / SAMPLE_S).clamp(16.0, 4000.0) as u32;
    (0..=count).map(move |step| duration * f64::from(step) / f64::from(count))
}

/// When to look at a motion closer, close to its start and its end.
fn moments_beside_ends(duration: f64) -> impl Iterator<Item = f64> {
    let step = SAMPLE_S / f64::from(CLOSER_BESIDE_END);
    let count = (BESIDE_END_S.min(0.5 * duration) / step) as u32;
    (1..count).map(move |index| f64::from(index) * step).flat_map(move |time| [time, duration - time])
}

/// How the limits along a path are looked at.
struct Look<'a> {
    way: &'a Way,
    /// How many times as high limits of acceleration and jerk are.
    stop_scale: f64,
    between: Between,
}

impl Look<'_> {
    /// The share of the limits that is used.
    fn used_at(&self, now: &Moment) -> f64 {
        let (way, places) = (self.way, self.way.places());
        let used = |rows: &[Row]| used(rows, now, self.stop_scale);
        let next = places.partition_point(|place| *place <= now.at).clamp(1, places.len() - 1);
        let [before, behind] = [way.rows_behind(next - 1), way.rows_before(next)].map(used);
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
