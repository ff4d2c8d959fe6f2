//! What moves the robot: everything that is stored as a whole when its motion is suspended, and restored as a whole.

use std::collections::VecDeque;

use crate::command::joints::Joints;
use crate::command::{Command, Settings};
use crate::overlay::CompensationState;
use crate::plan::chain::DeferredMotion;
use crate::queue::look_ahead::Waiting;
use crate::queue::path_buffer::PathBuffer;
use crate::queue::{Progress, Start};
use arl_robot::frames::Rig;

/// Up to this many nested stops need no memory allocation in the cycle.
pub(crate) const RESERVED_SUSPENSIONS: usize = 4;

/// The motions on the path and those that wait, their progress, and what was requested for them.
#[derive(Clone, Debug)]
pub(crate) struct Layer {
    pub(crate) path: PathBuffer,
    /// Motions that wait to be laid on the path.
    pub(crate) waiting: Waiting,
    /// The last motion, where its path depends on the next one.
    pub(crate) deferred: Option<DeferredMotion>,
    /// Whether no motion is expected behind the last one until the robot is at rest.
    pub(crate) concluded: bool,
    /// Where the last motion ends.
    pub(crate) end: Joints,
    /// Tool and base of the last motion.
    pub(crate) last_rig: Rig,
    /// State of a compensation at the end of the last motion.
    pub(crate) compensation_state: CompensationState,
    /// The last motion that has ended.
    pub(crate) finished: u64,
    /// The last motion that is no longer executed: it has ended, or a blend leads away from it.
    pub(crate) over: u64,
    pub(crate) execution: Execution,
    pub(crate) progress: Option<Progress>,
    pub(crate) requests: Requests,
}

/// Which motion is being executed, and for how long.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Execution {
    /// The motion being executed.
    pub(crate) started: Option<u64>,
    /// Its tool and base.
    pub(crate) rig: Rig,
    /// The motion whose time is counted, and the s that it has run at an override of 100 %.
    pub(crate) timed: u64,
    pub(crate) elapsed: f64,
}

/// What was requested for the motions of a layer.
#[derive(Clone, Debug, Default)]
pub(crate) struct Requests {
    /// The motions that are not over, and the last one that is over.
    pub(crate) asked: VecDeque<Asked>,
    /// Ranges of motion numbers, both ends included, that ended before motions with lower numbers.
    pub(crate) early: Vec<(u64, u64)>,
    /// How to continue what is suspended below, as soon as the robot is at rest with no motion left.
    pub(crate) starts: VecDeque<Start>,
    /// Whether the robot is on the return motion that the first of `starts` requires.
    pub(crate) going: bool,
    /// Motions to be planned again.
    pub(crate) anew: VecDeque<Asked>,
}

/// A motion as it was requested.
#[derive(Clone, Debug)]
pub(crate) struct Asked {
    pub(crate) number: u64,
    pub(crate) command: Command,
    pub(crate) settings: Settings,
    pub(crate) start: Joints,
    pub(crate) end: Joints,
    /// State of a compensation at its end.
    pub(crate) compensation_state: CompensationState,
}

impl Layer {
    /// A layer without motions, for a robot at rest at `start`.
    pub(crate) fn resting_at(start: Joints) -> Self {
        Self {
            path: PathBuffer::default(),
            waiting: Waiting::default(),
            deferred: None,
            concluded: false,
            end: start,
            last_rig: Rig::bare(),
            compensation_state: CompensationState::default(),
            finished: 0,
            over: 0,
            execution: Execution { started: None, rig: Rig::bare(), timed: 0, elapsed: 0.0 },
            progress: None,
            requests: Requests::reserved(),
        }
    }

    /// Suspends this layer, with the robot at rest at `here` and motions added up to the number `added`; an empty layer
    /// takes its place. `starts` and `going` define how what is suspended below it is continued.
    pub(crate) fn suspend(&mut self, here: Joints, added: u64, starts: VecDeque<Start>, going: bool) -> Self {
        let path = self.path.suspend();
        let early = self.requests.take_early();
        let next = Self {
            path: std::mem::take(&mut self.path),
            waiting: Waiting::default(),
            deferred: None,
            concluded: false,
            end: here,
            last_rig: self.execution.rig,
            compensation_state: CompensationState::default(),
            finished: added,
            over: added,
            execution: Execution { started: None, ..self.execution },
            progress: None,
            requests: Requests {
                asked: VecDeque::new(),
                early: std::mem::take(&mut self.requests.early),
                starts: std::mem::take(&mut self.requests.starts),
                going: self.requests.going,
                anew: VecDeque::new(),
            },
        };
        let suspended = std::mem::replace(self, next);
        let requests = Requests { early, starts, going, ..suspended.requests };
        Self { path, requests, ..suspended }
    }

    /// Continues a suspended layer, with the current requests.
    pub(crate) fn resume(&mut self, suspended: Self) {
        let Self { path, .. } = suspended;
        self.path.resume_suspended(path);
        let (path, requests) = (std::mem::take(&mut self.path), std::mem::take(&mut self.requests));
        *self = Self { path, requests, ..suspended };
    }
}

impl Requests {
    /// No requests, with memory reserved for those that come while the robot moves.
    fn reserved() -> Self {
        Self {
            early: Vec::with_capacity(2 * RESERVED_SUSPENSIONS),
            starts: VecDeque::with_capacity(RESERVED_SUSPENSIONS),
            ..Self::default()
        }
    }

    /// Takes over the requests of the layer below; the motions of the range `ended` have ended meanwhile.
    pub(crate) fn take_over(&mut self, below: Self, ended: (u64, u64)) {
        self.exchange_early(below.early);
        self.early.push(ended);
        (self.asked, self.anew, self.going) = (below.asked, below.anew, below.going);
        self.put_back(below.starts);
    }

    /// The number of the first motion to be planned again.
    pub(crate) fn first_anew(&self) -> Option<u64> {
        self.anew.front().map(|asked| asked.number)
    }

    /// Whether a motion ended before others with lower numbers.
    pub(crate) fn ended_early(&self, motion: u64) -> bool {
        self.early.iter().any(|(from, to)| (*from..=*to).contains(&motion))
    }

    /// Drops everything.
    pub(crate) fn clear(&mut self) {
        self.asked.clear();
        self.early.clear();
        self.starts.clear();
        self.anew.clear();
        self.going = false;
    }

    /// Takes the requests to continue; an empty list keeps its memory.
    pub(crate) fn take_starts(&mut self) -> VecDeque<Start> {
        if self.starts.is_empty() { VecDeque::new() } else { std::mem::take(&mut self.starts) }
    }

    /// Puts requests to continue back in front.
    pub(crate) fn put_back(&mut self, mut starts: VecDeque<Start>) {
        if !starts.is_empty() {
            starts.append(&mut self.starts);
            self.starts = starts;
        }
    }

    /// Takes the motions that ended early; an empty list keeps its memory.
    fn take_early(&mut self) -> Vec<(u64, u64)> {
        if self.early.is_empty() { Vec::new() } else { std::mem::take(&mut self.early) }
    }

    /// Replaces the motions that ended early.
    fn exchange_early(&mut self, early: Vec<(u64, u64)>) {
        if early.is_empty() {
            self.early.clear();
        } else {
            self.early = early;
        }
    }
}
