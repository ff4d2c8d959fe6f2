//! Changes that take effect with a motion: the load, and collision detection.

use std::collections::VecDeque;

use super::effort::Effort;
use crate::unit::dynamics::Load;
use arl_robot::kinematics::Axes;

/// A change that takes effect with a motion.
#[derive(Clone, Debug)]
pub(super) enum Change {
    /// The load on the flange.
    Load(Load),
    /// By how much the axes may differ from the model; `None`: collision detection is off.
    Detect(Option<Axes>),
}

/// The settings in effect.
#[derive(Clone, Debug)]
struct Held {
    load: Load,
    allowed: Option<Axes>,
}

impl Held {
    fn change(&mut self, change: &Change) {
        match change {
            Change::Load(load) => self.load = *load,
            Change::Detect(allowed) => self.allowed = *allowed,
        }
    }

    fn apply(&self, effort: &mut Effort) {
        effort.set_load(&self.load);
        effort.detect(self.allowed);
    }
}

/// Up to this many waiting changes, and nested stops, take no memory in the cycle.
const ROOM: usize = 8;

/// Changes that wait for their motion, in the order of the motions.
#[derive(Debug)]
pub(super) struct Changes {
    waiting: VecDeque<(u64, Change)>,
    now: Held,
    /// The waiting changes and the settings in effect when motions were set aside.
    aside: Vec<(VecDeque<(u64, Change)>, Held)>,
}

impl Changes {
    pub(super) fn new() -> Self {
        let now = Held { load: Load::none(), allowed: None };
        Self { waiting: VecDeque::with_capacity(ROOM), now, aside: Vec::with_capacity(ROOM) }
    }

    /// Resets everything: nothing is carried, and collision detection is off.
    pub(super) fn clear(&mut self, effort: &mut Effort) {
        *self = Self::new();
        self.now.apply(effort);
    }

    /// Adds a change that holds from the motion with this number on.
    pub(super) fn push(&mut self, from: u64, change: Change) {
        self.waiting.push_back((from, change));
    }

    /// Makes the changes of the motions up to this one take effect.
    pub(super) fn make(&mut self, up_to: u64, effort: &mut Effort) {
        while self.waiting.front().is_some_and(|(from, _)| *from <= up_to) {
            if let Some((_, change)) = self.waiting.pop_front() {
                self.now.change(&change);
                match change {
                    Change::Load(load) => effort.set_load(&load),
                    Change::Detect(allowed) => effort.detect(allowed),
                }
            }
        }
    }

    /// Collision detection is off from now on.
    pub(super) fn detected(&mut self) {
        self.now.allowed = None;
    }

    /// Sets changes aside or restores them, until there are as many levels of them as `stops` for the motions;
    /// `planned` is the motion planned last.
    pub(super) fn follow(&mut self, stops: usize, planned: u64, effort: &mut Effort) {
        while self.aside.len() < stops {
            // Changes since the stop are for the motions that come in between.
            let split = self.waiting.partition_point(|(from, _)| *from <= planned);
            let since = self.waiting.split_off(split);
            let before = std::mem::replace(&mut self.waiting, since);
            self.aside.push((before, self.now.clone()));
        }
        while self.aside.len() > stops {
            let Some((mut waiting, before)) = self.aside.pop() else { return };
            // Motions that go on get their former settings; those planned from now on get the current ones.
            waiting.push_back((planned + 1, Change::Load(self.now.load)));
            waiting.push_back((planned + 1, Change::Detect(self.now.allowed)));
            waiting.append(&mut self.waiting);
            self.waiting = waiting;
            self.now = before;
            self.now.apply(effort);
        }
    }
}
