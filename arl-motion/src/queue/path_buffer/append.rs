//! How motions join the path: blended with the last one where the robot can still follow that, else behind a stop.

use std::sync::Arc;

use super::{ACCELERATION_RISE_CYCLES, Joined, PathBuffer, Tail, UnblendedTarget};
use crate::blend::no_blend::NoBlend;
use crate::blend::zone::asks;
use crate::follow::segment::Segment;
use crate::junction::blend_thread::Prepared;
use crate::junction::{self, Blended, CurvedBlends};
use crate::limits::profile::{Limits, State};
use crate::plan::motion::Motion;
use arl_robot::robot::Robot;

/// A segment that takes no longer than this, in s, is left out.
const NO_TIME_S: f64 = 1e-12;

/// Whether a stretch began with the first of the segments that were removed.
fn began(taken: &[(Arc<Segment>, bool)]) -> bool {
    taken.last().is_none_or(|(_, began)| *began)
}

impl PathBuffer {
    /// Appends a motion that [`super::limit_rise`] has made ready, with what has been prepared for it. Returns the
    /// target before the motion with the reason why it is not rounded off, where that was requested.
    pub(crate) fn append(
        &mut self,
        robot: &Robot,
        motion: &Arc<Motion>,
        number: u64,
        prepared: Option<&Prepared>,
        cycle: f64,
    ) -> Option<UnblendedTarget> {
        let limits = motion.limits?;
        self.cycle = cycle;
        let tail = self.tail.take();
        if motion.flows && tail.is_some() && self.flow_on(Segment::part(motion, limits, number, 0.0, 1.0), cycle) {
            self.settle(1);
            self.tail = Some(Tail { motion: Arc::clone(motion), joined: None });
            return None;
        }
        let tail = tail.filter(|_| !self.segments.is_empty());
        let known = prepared.zip(tail.as_ref()).map(|(prepared, tail)| prepared.take(robot, || tail.pair(motion)));
        let curved = tail.as_ref().and_then(|tail| self.curved(robot, known, tail, motion));
        let mut joined = tail.as_ref().zip(curved).and_then(|(tail, curved)| {
            let segments = self.join_curved(tail, &curved, motion, limits, number, cycle)?;
            Some(Joined { before: Some((Arc::clone(&tail.motion), curved.curvature)), segments })
        });
        let unblended_for = |corner, why| Some(UnblendedTarget { number, line: motion.line, corner, why });
        let mut unblended = if motion.flows { unblended_for(None, NoBlend::Late) } else { None };
        let mut end = Arc::clone(motion);
        if let Some(tail) = tail {
            let corner = Some(tail.motion.line);
            let blended = joined.is_none().then(|| junction::blended(robot, known, &tail.motion, motion));
            let asks = asks(robot, &tail.motion);
            match blended {
                Some(Ok(blended)) => {
                    let before = blended.leaves();
                    joined = self.round_off(&blended, number, cycle).map(|segments| Joined { before, segments });
                    unblended = if joined.is_none() { unblended_for(corner, NoBlend::Late) } else { None };
                    if joined.is_some() {
                        end = blended.to;
                    }
                }
                Some(Err(why)) if asks => unblended = unblended_for(corner, why),
                Some(Err(_)) | None => {}
            }
        }
        let limits = end.limits?;
        if joined.is_none() {
            let whole = self.ready([Segment::part(&end, limits, number, 0.0, 1.0)]);
            // In a stretch of its own, it demands nothing that the stop before it did not.
            if self.is_law_driven() || !self.lay(&whole, |_| true, cycle) {
                self.push(&whole, |_| false);
            }
        }
        self.settle(joined.as_ref().map_or(1, |joined| joined.segments));
        self.tail = Some(Tail { motion: end, joined });
        unblended
    }

    /// How the last motion is curved towards the next one; `None` where it is not, or where the robot is already on the
    /// blend before.
    fn curved(
        &self,
        robot: &Robot,
        known: Option<&junction::Junction>,
        tail: &Tail,
        motion: &Arc<Motion>,
    ) -> Option<CurvedBlends> {
        let Joined { before, segments } = tail.joined.as_ref()?;
        let (before, curvature) = before.as_ref()?;
        if self.segments.len() <= *segments {
            return None;
        }
        junction::curved(robot, known, before, *curvature, &tail.motion, motion)
    }

    /// Lays a blend behind the last one where the two meet in the middle of the last motion, and curves both there.
    /// Returns the number of segments from the new blend on, `None` where that is no longer possible.
    fn join_curved(
        &mut self,
        tail: &Tail,
        curved: &CurvedBlends,
        motion: &Motion,
        limits: Limits,
        number: u64,
        cycle: f64,
    ) -> Option<usize> {
        let Joined { before, segments: count } = tail.joined.as_ref()?;
        let (before, _) = before.as_ref()?;
        let [first, next] = &curved.blends;
        let (exited, last) = (self.segments.get(self.segments.len() - *count)?.number, self.segments.back()?.number);
        let halves = [
            Segment::half(first, before, &tail.motion, exited, true),
            Segment::half(first, before, &tail.motion, last, false),
            Segment::half(next, &tail.motion, motion, last, true),
            Segment::half(next, &tail.motion, motion, number, false),
        ];
        let rest = Segment::part(motion, limits, number, next.join, 1.0);
        let segments = self.ready(halves.into_iter().chain((rest.time > NO_TIME_S).then_some(rest)));
        let kept = self.take_back(*count);
        let same_to = self.unchanged_to(0.0);
        if self.lay_any(&segments, None, same_to, cycle) {
            return Some(segments.len() - 2);
        }
        self.put_back(kept);
        None
    }

    /// Lays a blend in place of the end of the last motion and the start of the next one. Returns the number of
    /// segments from the blend on, `None` where the robot can no longer follow it.
    fn round_off(&mut self, blended: &Blended, number: u64, cycle: f64) -> Option<usize> {
        let Blended { from: before, to: motion, blend, until } = blended;
        let (before_limits, limits) = (before.limits?, motion.limits?);
        let last = self.segments.back()?;
        // Another blend has taken the part that this one needs.
        if last.from > blend.leave {
            return None;
        }
        let gone = last.from + self.at * before.rate;
        if self.segments.len() == 1 && (gone >= blend.leave || gone > *until) {
            return None;
        }
        let same = (until.min(blend.leave) - last.from).max(0.0) / before.rate;
        let mut cut = Segment::part(before, before_limits, last.number, last.from, blend.leave);
        (cut.stops, cut.ends) = (false, false);
        let first = Segment::half(blend, before, motion, last.number, true);
        let second = Segment::half(blend, before, motion, number, false);
        let rest = Segment::part(motion, limits, number, blend.join, 1.0);
        let segments = self.ready([cut, first, second, rest].into_iter().filter(|segment| segment.time > NO_TIME_S));
        let from_blend = segments.iter().skip_while(|segment| segment.parametrization.is_none()).count();
        let kept = self.take_back(1);
        let same_to = self.unchanged_to(same);
        let own = segments.first().is_some_and(|first| first.parametrization.is_none()).then(|| began(&kept));
        if self.lay_any(&segments, own, same_to, cycle) {
            return Some(from_blend);
        }
        self.put_back(kept);
        None
    }

    /// Appends segments with whatever stretches the robot can follow; returns whether there is a way. `own`: `Some`
    /// where the first of them belongs to the motion that the robot may be on, with whether a stretch began with that
    /// motion. Up to `same_to`, in s of nominal time since the path began, the segments change nothing.
    fn lay_any(&mut self, segments: &[Arc<Segment>], own: Option<bool>, same_to: f64, cycle: f64) -> bool {
        let may = self.may_change_from(same_to);
        if self.is_law_driven() {
            if may {
                self.push(segments, |_| true);
            }
            return may;
        }
        self.lay(segments, |_| true, cycle)
            || self.lay(segments, |index| index > 0, cycle)
            // A robot that speeds up on its motion needs the limits of that motion as they are.
            || own.is_some_and(|began| self.lay(segments, |index| if index == 0 { !began } else { index > 1 }, cycle))
    }

    /// Where a change begins that lies `behind` s of nominal time behind the last segment; infinite where nothing
    /// depends on it.
    fn unchanged_to(&self, behind: f64) -> f64 {
        if self.is_watched() { self.segments.end() + behind } else { f64::INFINITY }
    }

    /// Continues from the last motion without a stop; returns whether the robot can still do that.
    fn flow_on(&mut self, segment: Segment, cycle: f64) -> bool {
        let Some(last) = self.segments.back() else { return false };
        let mut through = Segment::clone(last).flowing();
        through.stops = false;
        let segments = self.ready([through, segment.flowing()]);
        let kept = self.take_back(1);
        let same_to = self.unchanged_to(segments.first().map_or(0.0, |through| through.time));
        if self.lay_any(&segments, Some(began(&kept)), same_to, cycle) {
            return true;
        }
        self.put_back(kept);
        false
    }

    /// Appends segments if the robot can follow them, and returns whether it can. `may` is true for the index of each
    /// segment that may join the stretch before it.
    fn lay(&mut self, segments: &[Arc<Segment>], may: impl Fn(usize) -> bool, cycle: f64) -> bool {
        // Nothing depends on the path yet.
        if self.state.rests() {
            self.push(segments, may);
            return true;
        }
        self.find_entries();
        let before = self.timing.next_entry();
        self.push(segments, may);
        self.find_entries();
        // The governor looks no farther than the stretch behind the one where its backup ends.
        let unchanged = before.is_some() && self.timing.next_entry() >= before && self.backup_ends_here();
        if unchanged {
            return true;
        }
        match self.governor(cycle).holds(&self.state) {
            Some(backup) => {
                self.backup = backup;
                true
            }
            None => {
                self.take_back(segments.len());
                false
            }
        }
    }

    /// Whether the backup ends on the stretch that the robot is on.
    fn backup_ends_here(&self) -> bool {
        let State { at, vel, acc } = self.state;
        self.timing.is_on_first(at + self.backup.distance(vel, acc))
    }

    /// Makes segments ready to be pushed.
    fn ready(&self, segments: impl IntoIterator<Item = Segment>) -> Vec<Arc<Segment>> {
        // Set-points are those of whole cycles: an acceleration takes a few of them to rise, even without a jerk limit.
        let rise = ACCELERATION_RISE_CYCLES * self.cycle;
        segments.into_iter().map(|segment| Arc::new(segment.rising_in(rise))).collect()
    }
}
