//! What moves the robot: all that is put away whole when its motion is suspended, and comes back whole.

use std::collections::VecDeque;

use crate::command::joints::Joints;
use crate::command::{Command, Settings};
use crate::overlay::Led;
use crate::plan::chain::Held;
use crate::queue::look_ahead::Waiting;
use crate::queue::path_buffer::PathBuffer;
use crate::queue::{Progress, Start};
use arl_robot::frames::Rig;

/// Room for so many stops within each other takes no memory in the cycle.
pub(crate) const RESERVED_SUSPENSIONS: usize = 4;

/// The motions on the path and those that wait, how far they have come, and what was asked of them.
#[derive(Clone, Debug)]
pub(crate) struct Layer {
    pub(crate) path: PathBuffer,
    /// Motions that wait until they are laid on the path.
    pub(crate) waiting: Waiting,
    /// The last motion, where its way depends on the next one.
    pub(crate) held: Option<Held>,
    /// Whether none is expected behind the last motion until the robot rests.
    pub(crate) concluded: bool,
    /// Where the last motion ends.
    pub(crate) end: Joints,
    /// What the robot carries in the last motion.
    pub(crate) last_rig: Rig,
    /// How a compensation stands at the end of the last motion.
    pub(crate) led: Led,
    /// The last motion that has ended.
    pub(crate) finished: u64,
    /// The last motion that is not executed any more: it has ended, or a blend leads away from it.
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
    /// What the robot carries in it, and where it stands.
    pub(crate) rig: Rig,
    /// The motion whose time counts, and the s that it has run at an override of 100 %.
    pub(crate) timed: u64,
    pub(crate) elapsed: f64,
}

/// What was asked of the motions of a layer.
#[derive(Clone, Debug, Default)]
pub(crate) struct Requests {
    /// The motions that are not over, and the last one that is.
    pub(crate) asked: VecDeque<Asked>,
    /// Motions, from a number to another, that ended before others with lower numbers.
    pub(crate) early: Vec<(u64, u64)>,
    /// How to go on with what is suspended below, as soon as the robot rests where nothing is left to go.
    pub(crate) starts: VecDeque<Start>,
    /// Whether the robot is on the way that the first of these asks for.
    pub(crate) going: bool,
    /// Motions to be planned anew.
    pub(crate) anew: VecDeque<Asked>,
}

/// A motion as it was asked for.
#[derive(Clone, Debug)]
pub(crate) struct Asked {
    pub(crate) number: u64,
    pub(crate) command: Command,
    pub(crate) settings: Settings,
    pub(crate) start: Joints,
    pub(crate) end: Joints,
    /// How a compensation stands at its end.
    pub(crate) led: Led,
}

impl Layer {
    /// Nothing to do for a robot that rests at `start`.
    pub(crate) fn resting_at(start: Joints) -> Self {
        Self {
            path: PathBuffer::default(),
            waiting: Waiting::default(),
            held: None,
            concluded: false,
            end: start,
            last_rig: Rig::bare(),
            led: Led::default(),
            finished: 0,
            over: 0,
            execution: Execution { started: None, rig: Rig::bare(), timed: 0, elapsed: 0.0 },
            progress: None,
            requests: Requests::reserved(),
        }
    }

    /// Puts this layer away, of a robot that rests at `here` and has been given motions up to the number `added`: what
    /// is left in its place has nothing to do. `starts` and `going` say how what is suspended below it goes on.
    pub(crate) fn suspend(&mut self, here: Joints, added: u64, starts: VecDeque<Start>, going: bool) -> Self {
        let path = self.path.suspend();
        let early = self.requests.take_early();
        let next = Self {
            path: std::mem::take(&mut self.path),
            waiting: Waiting::default(),
            held: None,
            concluded: false,
            end: here,
            last_rig: self.execution.rig,
            led: Led::default(),
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

    /// Goes on with a layer that was put away, under what is asked of the motions now.
    pub(crate) fn resume(&mut self, suspended: Self) {
        let Self { path, .. } = suspended;
        self.path.resume_suspended(path);
        let (path, requests) = (std::mem::take(&mut self.path), std::mem::take(&mut self.requests));
        *self = Self { path, requests, ..suspended };
    }
}

impl Requests {
    /// None yet, with memory for what comes while the robot moves.
    fn reserved() -> Self {
        Self {
            early: Vec::with_capacity(2 * RESERVED_SUSPENSIONS),
            starts: VecDeque::with_capacity(RESERVED_SUSPENSIONS),
            ..Self::default()
        }
    }

    /// Takes over what was asked of the layer below, motions from a number to another having ended meanwhile.
    pub(crate) fn take_over(&mut self, below: Self, ended: (u64, u64)) {
        self.exchange_early(below.early);
        self.early.push(ended);
        (self.asked, self.anew, self.going) = (below.asked, below.anew, below.going);
        self.put_back(below.starts);
    }

    /// The first motion to be planned anew.
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

    /// Takes what was said of going on; an empty list keeps its memory.
    pub(crate) fn take_starts(&mut self) -> VecDeque<Start> {
        if self.starts.is_empty() { VecDeque::new() } else { std::mem::take(&mut self.starts) }
    }

    /// Puts what was said of going on in front again.
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

    /// Exchanges the motions that ended early for others.
    fn exchange_early(&mut self, early: Vec<(u64, u64)>) {
        if early.is_empty() {
            self.early.clear();
        } else {
            self.early = early;
        }
    }
}
