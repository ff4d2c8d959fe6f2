//! What changes with a motion: the load, and looking for collisions.

use std::collections::VecDeque;

use super::effort::Effort;
use crate::unit::dynamics::Load;
use arl_robot::kinematics::Axes;

/// What changes with a motion.
#[derive(Clone, Debug)]
pub(super) enum Change {
    /// What the flange carries.
    Load(Load),
    /// By how much the axes may differ from the model; `None`: collisions are not looked for.
    Detect(Option<Axes>),
}

/// What holds.
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

/// Room for so many changes that wait, and so many stops within each other, takes no memory in the cycle.
const ROOM: usize = 8;

/// Changes that wait for their motion, in the order of the motions.
#[derive(Debug)]
pub(super) struct Changes {
    waiting: VecDeque<(u64, Change)>,
    now: Held,
    /// What waited, and held, when motions were set aside.
    aside: Vec<(VecDeque<(u64, Change)>, Held)>,
}

impl Changes {
    pub(super) fn new() -> Self {
        let now = Held { load: Load::none(), allowed: None };
        Self { waiting: VecDeque::with_capacity(ROOM), now, aside: Vec::with_capacity(ROOM) }
    }

    /// Forgets everything: nothing is carried, and collisions are not looked for.
    pub(super) fn clear(&mut self, effort: &mut Effort) {
        *self = Self::new();
        self.now.apply(effort);
    }

    /// Lets something hold from the motion with this number on.
    pub(super) fn push(&mut self, from: u64, change: Change) {
        self.waiting.push_back((from, change));
    }

    /// Makes the changes of the motions up to this one.
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

    /// Collisions are not looked for any more, from now on.
    pub(super) fn detected(&mut self) {
        self.now.allowed = None;
    }

    /// Sets aside or takes up again what belongs to motions, until it is done for as many stops as for the motions;
    /// `planned` is the motion planned last.
    pub(super) fn follow(&mut self, stops: usize, planned: u64, effort: &mut Effort) {
        while self.aside.len() < stops {
            // What was said since the stop is for the motions that come in between.
            let split = self.waiting.partition_point(|(from, _)| *from <= planned);
            let since = self.waiting.split_off(split);
            let before = std::mem::replace(&mut self.waiting, since);
            self.aside.push((before, self.now.clone()));
        }
        while self.aside.len() > stops {
            let Some((mut waiting, before)) = self.aside.pop() else { return };
            // The motions that go on have what they had; those planned from now on what holds now.
            waiting.push_back((planned + 1, Change::Load(self.now.load)));
            waiting.push_back((planned + 1, Change::Detect(self.now.allowed)));
            waiting.append(&mut self.waiting);
            self.waiting = waiting;
            self.now = before;
            self.now.apply(effort);
        }
    }
}
