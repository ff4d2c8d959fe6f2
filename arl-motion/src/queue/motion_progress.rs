//! Progress of the motions of the queue.

use crate::follow::segment::Segment;
use crate::queue::Queue;

/// For this many cycles the remaining time of a motion is counted down before it is found again.
const CYCLES_BETWEEN_FORECASTS: u32 = 16;
/// Progress of the motion being executed. Times are those at an override of 100 %. A blend belongs to the motion that
/// it leads into, whose path counts from the target that is rounded off (manual 7.3).
#[derive(Clone, Copy, PartialEq, Debug)]
#[non_exhaustive]
pub struct Progress {
    /// Running number of the motion.
    pub motion: u64,
    /// Program line of the motion.
    pub line: u32,
    /// Time since its start, in s.
    pub elapsed_time: f64,
    /// Time to its end, in s.
    pub remaining_time: f64,
    /// Distance covered along the line, in mm; 0 for axis motions.
    pub elapsed_distance: f64,
    /// Distance left along the line, in mm; 0 for axis motions.
    pub remaining_distance: f64,
    /// Share of the motion that is done, 0 to 1; also for axis motions.
    pub share: f64,
}

impl Progress {
    /// A completed motion that goes nowhere.
    const DONE: Self = Self {
        motion: 0,
        line: 0,
        elapsed_time: 0.0,
        remaining_time: 0.0,
        elapsed_distance: 0.0,
        remaining_distance: 0.0,
        share: 1.0,
    };
}

impl Queue {
    /// The progress of the motion that was executed in the last cycle: complete, if it reached its target in that
    /// cycle. `None` where no motion was executed.
    pub fn progress(&self) -> Option<Progress> {
        self.layer.progress
    }

    /// The progress of a motion when it ended, or was left for a blend, in the last cycle. `None` where neither
    /// happened in that cycle, or where the motion was dropped.
    pub fn exited(&self, motion: u64) -> Option<Progress> {
        self.exited.iter().rev().find(|progress| progress.motion == motion).copied()
    }

    /// The progress of motions, and also of parts of motions, that ended or were left for a blend in the last cycle.
    pub(super) fn exited_motions(&self) -> &[Progress] {
        &self.exited
    }

    /// Adds time to the motion that counts as being executed.
    pub(crate) fn count_time(&mut self, passed: f64) {
        let Some((segment, _)) = self.layer.path.current() else { return };
        if self.layer.execution.timed != segment.number {
            (self.layer.execution.timed, self.layer.execution.elapsed) = (segment.number, 0.0);
        }
        self.layer.execution.elapsed += passed;
    }

    pub(crate) fn progress_at_end(&self, segment: &Segment) -> Progress {
        progress_at(segment, 1.0, segment.duration().unwrap_or(self.layer.execution.elapsed), 0.0)
    }

    /// How long the motion being executed still takes at full speed, in s; `passed` s have elapsed since the last call.
    pub(crate) fn time_left(&mut self, motion: u64, elapsed: f64, passed: f64) -> f64 {
        let (remaining, age) = match self.forecast {
            Some((of, remaining, age)) if of == motion && age < CYCLES_BETWEEN_FORECASTS => {
                ((remaining - passed).max(0.0), age + 1)
            }
            _ => (self.layer.path.time_to_end(elapsed), 0),
        };
        self.forecast = Some((motion, remaining, age));
        remaining
    }

    pub(crate) fn progress_on_path(&mut self, passed: f64) -> Option<Progress> {
        let (segment, share) = self.layer.path.current()?;
        // A motion that is entered in this very cycle has not run yet.
        let elapsed = if segment.number == self.layer.execution.timed { self.layer.execution.elapsed } else { 0.0 };
        let motion = segment.number;
        let remaining = self.time_left(motion, elapsed, passed);
        let (segment, _) = self.layer.path.current()?;
        Some(progress_at(segment, share, elapsed, remaining))
    }

    /// Notes which motions are no longer executed. Those of which nothing is known go nowhere.
    pub(crate) fn leave_behind(&mut self) {
        let ahead = self.layer.path.current().map_or(self.layer.finished + 1, |(segment, _)| segment.number);
        for motion in self.layer.over + 1..ahead {
            if !self.halt.dropping && self.exited(motion).is_none() {
                self.exited.push(Progress { motion, ..Progress::DONE });
            }
        }
        self.layer.over = self.layer.over.max(ahead - 1);
    }
}

/// The progress of the motion of a segment.
pub(crate) fn progress_at(segment: &Segment, share: f64, elapsed_time: f64, remaining_time: f64) -> Progress {
    let elapsed_distance = segment.length * share;
    Progress {
        motion: segment.number,
        line: segment.line,
        elapsed_time,
        remaining_time,
        elapsed_distance,
        remaining_distance: segment.length - elapsed_distance,
        share,
    }
}
