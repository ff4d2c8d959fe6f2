//! How long the motion being executed still takes.

use std::sync::Arc;

use crate::follow::remaining::{self, Leg};
use crate::follow::segment::Segment;
use crate::limits::profile::{LOOK_AHEAD_MARGIN, Limits};
use crate::queue::path_buffer::PathBuffer;

/// The part behind the known part of a law is assumed to take at most this many times its time at full speed.
const SLOWEST_BEHIND_LAW: f64 = 2.0;

impl PathBuffer {
    /// How long the path between two places takes at the full speed of each of its parts, in s.
    fn time_between(&self, from: f64, to: f64) -> f64 {
        let starts = self.segments.starts();
        let time = |(segment, start): (&Arc<Segment>, f64)| {
            let [left, right] = [from, to].map(|at| (at - start).clamp(0.0, segment.time));
            segment.time_from(left) - segment.time_from(right)
        };
        self.segments.iter().zip(starts).take_while(|(_, start)| *start < to).map(time).sum()
    }

    /// How long the motion that counts as being executed still takes, in s, after it has run for `elapsed` s at full
    /// speed: exact where it begins and ends at rest, else as its segments and those behind them allow.
    pub(crate) fn time_to_end(&mut self, elapsed: f64) -> f64 {
        let (Some(first), Some((current, _))) = (self.segments.front(), self.current()) else { return 0.0 };
        if let Some(duration) = current.duration().filter(|_| self.laws.leader.follower().is_none()) {
            return (duration - elapsed).max(0.0);
        }
        let own = |segment: &&Arc<Segment>| segment.number == current.number && !segment.leaves();
        let later = self.segments.iter().skip(1).take_while(own);
        let end = self.segments.passed() + first.time + later.clone().map(|segment| segment.time).sum::<f64>();
        if let Some((time, known)) = self.laws.leader.follower().and_then(|follower| follower.time_to(end)) {
            // Behind the known part, the same ratio to the programmed time is assumed.
            let [by_law, behind] =
                [self.time_between(self.segments.passed() + self.at, known), self.time_between(known, end)];
            let factor = if by_law > 0.0 { (time / by_law).min(SLOWEST_BEHIND_LAW) } else { 1.0 };
            return time + behind * factor;
        }
        let mut legs = [Leg { length: 0.0, limits: first.limits }; remaining::MOST_LEGS];
        let (mut known, mut at, mut stops) = (0, self.at, false);
        for (leg, segment) in legs.iter_mut().zip([first].into_iter().chain(later)) {
            let length = (segment.time - at).max(0.0);
            let vel = if length > 0.0 { length / segment.time_from(at) } else { segment.limits.vel };
            *leg = Leg { length, limits: Limits { vel, ..segment.limits } };
            (known, at, stops) = (known + 1, 0.0, segment.stops);
        }
        let legs = legs.get(..known).unwrap_or_default();
        let distance: f64 = legs.iter().map(|leg| leg.length).sum();
        let exit = if stops {
            0.0
        } else if self.laws.leader.follower().is_some() || (self.state.rests() && self.wants_laws()) {
            // Not known yet; the speed is assumed to stay about the same.
            legs.last().map_or(0.0, |last| last.limits.vel)
        } else {
            self.find_entries();
            self.timing.highest_speed(self.state.at + distance, LOOK_AHEAD_MARGIN, self.cycle)
        };
        remaining::time_over(legs, exit, self.state.vel, self.state.acc)
    }
}
