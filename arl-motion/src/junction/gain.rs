//! Whether a blend saves time: compares the fastest motion with it and the fastest motion with a stop at the target.

use std::cell::{OnceCell, RefCell};
use std::collections::HashMap;
use std::sync::Arc;

use crate::blend::corner::Blend;
use crate::command::joints::{ALL, Joints};
use crate::follow::segment::{Segment, is_free};
use crate::follow::shared_deque::SharedDeque;
use crate::limits::constant::quickest;
use crate::plan::constraints::{Constraints, MANUAL_SPEED_MM_S};
use crate::plan::curve::Curve;
use crate::plan::motion::Motion;
use crate::time_optimal::constraint_sampler::{ConstraintSampler, Part};
use crate::time_optimal::law_memory::key;
use crate::time_optimal::law_solver_thread::fastest_duration;
use crate::time_optimal::solver::BoundaryState;
use arl_robot::robot::Robot;

/// Time in s that a blend has to save. The law that leads along a whole chain is found at places that are farther
/// apart, and may take a little longer than the laws of two motions alone.
const LEAST_GAIN_S: f64 = 0.001;
/// Where two motions take longer than this, in s, one blend hardly matters, and matters less than the differences
/// between laws of that length.
const LONGEST_PAIR_S: f64 = 10.0;

/// Constant limits are not accurate enough where a motion takes longer with them than with those of one of its ends by
/// more than this factor. Motions shorter than this, in mm, of which there may be very many, hardly change from end to
/// end.
const UNEVEN_FACTOR: f64 = 2.0;
const SHORT_MOTION_MM: f64 = 1.0;

/// Number of durations that are remembered per thread, for programs that repeat the same motions.
const MOST_KNOWN: usize = 10_000;

thread_local! {
    /// Durations found before, by the fingerprint of what they were found from.
    static KNOWN: RefCell<HashMap<u128, Option<f64>>> = RefCell::default();
}

/// Two motions that may be blended, or stop in between.
pub(crate) struct Stopping<'a> {
    robot: &'a Robot,
    from: &'a Motion,
    to: &'a Motion,
    /// Whether constant limits are not accurate enough for how long they take.
    uneven: OnceCell<bool>,
    /// How long they take with the stop, from rest to rest, in s; `None` where that is too long, or no laws lead.
    time: OnceCell<Option<f64>>,
}

impl<'a> Stopping<'a> {
    pub(crate) fn new(robot: &'a Robot, from: &'a Motion, to: &'a Motion) -> Self {
        Self { robot, from, to, uneven: OnceCell::new(), time: OnceCell::new() }
    }

    /// Whether laws have to decide whether a blend saves time: where the governor's constant limits leave it possible
    /// that it does not, or are not accurate enough for how long the motions take.
    pub(crate) fn doubts(&self, blend: &Blend) -> bool {
        let motions = [self.from, self.to];
        motions.iter().all(|motion| is_free(motion)) && (blend.may_lose_time || self.is_uneven())
    }

    fn is_uneven(&self) -> bool {
        *self.uneven.get_or_init(|| [self.from, self.to].iter().any(|motion| is_uneven(self.robot, motion)))
    }

    /// Whether the two motions take longer with the blend, whatever leads them.
    pub(crate) fn is_faster_than(&self, blend: &Blend) -> bool {
        if !self.doubts(blend) {
            return false;
        }
        let Some(with_stop) = *self.time.get_or_init(|| self.time()) else { return false };
        self.time_with(blend).is_some_and(|with_blend| with_blend > with_stop - LEAST_GAIN_S)
    }

    fn time(&self) -> Option<f64> {
        let alone = |motion: &Motion| {
            let whole = Segment::part(motion, motion.limits?, 0, 0.0, 1.0);
            let closed_form = whole.duration().filter(|_| whole.is_even());
            closed_form.or_else(|| fastest_along(self.robot, [whole], &motion.start))
        };
        let both = alone(self.from)? + alone(self.to)?;
        (both <= LONGEST_PAIR_S).then_some(both)
    }

    fn time_with(&self, blend: &Blend) -> Option<f64> {
        let mut cut = Segment::part(self.from, self.from.limits?, 0, 0.0, blend.leave);
        cut.stops = false;
        let halves = [true, false].map(|first| Segment::half(blend, self.from, self.to, 0, first));
        let rest = Segment::part(self.to, self.to.limits?, 0, blend.join, 1.0);
        fastest_along(self.robot, [cut].into_iter().chain(halves).chain([rest]), &self.from.start)
    }
}

/// Whether constant limits are not accurate enough for how long a motion takes: those of its slowest place make it much
/// slower than those of one of its ends would, as near a singular point.
fn is_uneven(robot: &Robot, motion: &Motion) -> bool {
    let (Curve::Tool(curve), Some(limits)) = (&motion.curve, motion.limits) else { return false };
    if motion.length < SHORT_MOTION_MM {
        return false;
    }
    let quickest_at = |(at, joints): (f64, &Joints)| -> Option<f64> {
        let [first, ..] = motion.curve.rates(&robot.kinematics, at, joints)?;
        let mut constraints = Constraints::new(robot);
        constraints.all_axes(&[first, [0.0; ALL], [0.0; ALL]], &motion.pace);
        constraints.tool(curve, &motion.pace);
        if motion.pace.manual {
            constraints.cap_tool(curve, MANUAL_SPEED_MM_S);
        }
        Some(quickest(&constraints.rows).duration(1.0))
    };
    let ends = [(0.0, motion.start()), (1.0, motion.end())];
    let quickest = ends.into_iter().filter_map(quickest_at).fold(f64::INFINITY, f64::min);
    limits.duration(1.0) > UNEVEN_FACTOR * quickest
}

#[cfg(test)]
thread_local! {
    /// Number of laws that this thread has requested.
    pub(crate) static ASKED_HERE: std::cell::Cell<u32> = const { std::cell::Cell::new(0) };
}

/// How long the fastest motion along segments takes, from rest to rest, in s; `None` where no such motion is known.
fn fastest_along(robot: &Robot, segments: impl IntoIterator<Item = Segment>, start: &Joints) -> Option<f64> {
    #[cfg(test)]
    ASKED_HERE.with(|count| count.set(count.get() + 1));
    let mut shared = SharedDeque::default();
    for segment in segments.into_iter().filter(|segment| segment.time > 0.0) {
        shared.push_back(Arc::new(segment));
    }
    let part = Part::whole(shared);
    let end = part.end;
    let sampler = ConstraintSampler::new(&Arc::new(robot.clone()), part, 0.0, start);
    // Where there is too much to look at, the law would end earlier.
    let sampled =
        sampler.look(end, 1.0, BoundaryState::REST, BoundaryState::REST).filter(|sampled| sampled.end >= end)?;
    let key = key(&sampled.path, BoundaryState::REST, None);
    if let Some(known) = KNOWN.with_borrow(|known| known.get(&key).copied()) {
        return known;
    }
    let found = fastest_duration(&sampler, sampled);
    KNOWN.with_borrow_mut(|known| {
        if known.len() >= MOST_KNOWN {
            known.clear();
        }
        known.insert(key, found);
    });
    found
}
