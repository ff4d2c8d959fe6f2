//! A scenario while it plays: which events are due, and what sets them off.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::{Action, Cause, Digital, Effect, Event, Pendant, RobotEffect, Scenario};
use crate::io::bits::Bits;
use crate::io::image::PWM_CHANNELS;
use crate::io::{Image, Pwm};
use arl_robot::cell::Rate;

/// A scenario while it plays.
#[derive(Debug)]
pub(crate) struct Playing {
    events: Vec<Event>,
    /// The places of those events that wait for an edge.
    watching: Vec<usize>,
    /// The places of those that come at a time, with that in cycles.
    timed: Vec<(usize, u64)>,
    /// What those set, as it was at first.
    at_first: Vec<Action>,
    /// The cycle from which on time counts.
    began: u64,
    /// Whether time does not count yet: the programs wait for their start.
    waits: bool,
    resets: bool,
    /// Whether it lets programs begin at the pendant.
    begins: bool,
    rate: Rate,
    due: Due,
    /// The cycle of the last event.
    played: u64,
    before_in: Bits,
    before_out: Bits,
    before_pwm: [Pwm; PWM_CHANNELS],
}

impl Playing {
    pub(crate) fn new(scenario: Scenario, image: &Image, rate: Rate) -> Self {
        let events = scenario.events;
        let (mut timed, mut watching, mut at_first) = (Vec::new(), Vec::new(), Vec::new());
        for (at, event) in events.iter().enumerate() {
            match event.cause {
                Cause::At(time) => {
                    timed.push((at, rate.cycles(time)));
                    at_first.extend(event.actions.iter().filter_map(|action| action.undone(image)));
                }
                Cause::Edge { .. } | Cause::Pwm(_) => watching.push(at),
            }
        }
        let due = Due::with_room(events.len() * 4 + 16);
        let (before_in, before_out) = (image.inputs().clone(), image.outputs().clone());
        let mut playing = Self {
            resets: presses(&events, |button| button == Pendant::Reset),
            begins: presses(&events, Pendant::lets_begin),
            events,
            watching,
            timed,
            at_first,
            began: 0,
            waits: false,
            rate,
            due,
            played: 0,
            before_in,
            before_out,
            before_pwm: image.pwms(),
        };
        playing.begin(0);
        playing
    }

    /// The cycle from which on time counts, or counted last.
    pub(crate) fn began(&self) -> u64 {
        self.began
    }

    /// Whether its time does not count yet.
    pub(crate) fn waits(&self) -> bool {
        self.waits
    }

    /// Lets time stand until [`begin`](Self::begin): somebody is to start the programs. Edges are still answered.
    pub(crate) fn wait(&mut self) {
        self.waits = true;
        let timed = &self.timed;
        self.due.retain(|event| timed.binary_search_by_key(&event, |(at, _)| *at).is_err());
    }

    /// Time counts from the start of this cycle on.
    pub(crate) fn begin(&mut self, cycle: u64) {
        self.wait();
        self.waits = false;
        self.began = cycle;
        for (event, after) in &self.timed {
            self.due.add(cycle.saturating_add(*after), *event);
        }
    }

    /// The same once more: what events at a time have set is as it was at first.
    pub(crate) fn begin_again(&mut self, cycle: u64, image: &mut Image, mut do_it: impl FnMut(Effect)) {
        self.at_first.iter().for_each(|action| action.play(image, &mut do_it));
        self.begin(cycle);
    }

    /// Whether it starts programs itself: at the pendant, or by a digital input.
    pub(crate) fn starts(&self, input: Option<i32>) -> bool {
        let sets =
            |action: &Action| matches!(action, Action::Digital(Digital::Di, channel, _) if Some(*channel) == input);
        self.begins || input.is_some() && self.events.iter().any(|event| event.actions.iter().any(sets))
    }

    /// How many effects a cycle may have at most, if no event comes twice in it.
    pub(crate) fn max_effects(&self) -> usize {
        let actions = self.events.iter().flat_map(|event| &event.actions);
        actions.filter(|action| matches!(action, Action::Effect(_))).count()
    }

    /// Sets what is due at the start of `cycle`; hands everything but inputs to `do_it`.
    pub(crate) fn play(&mut self, cycle: u64, image: &mut Image, mut do_it: impl FnMut(Effect)) {
        if self.events.is_empty() {
            return;
        }
        self.find_edges(cycle, image);
        while let Some(at) = self.due.take(cycle) {
            self.played = cycle;
            for action in self.events.get(at).map(|event| event.actions.as_slice()).unwrap_or_default() {
                action.play(image, &mut do_it);
            }
        }
    }

    /// Whether somebody at the pendant makes programs begin again that have ended.
    pub(crate) fn resets(&self) -> bool {
        self.resets
    }

    /// Whether an event is on its way, or will be in the next cycle by what has changed in this one.
    pub(crate) fn goes_on(&self, image: &Image) -> bool {
        !self.due.is_empty() || self.watched().any(|(_, event)| self.has_edge(event, image))
    }

    /// The cycle of the last event that has happened.
    pub(crate) fn played(&self) -> u64 {
        self.played
    }

    /// The cycle before which nothing happens by itself; `None`: something that has changed in this cycle sets an event
    /// off in the next one.
    pub(crate) fn quiet_until(&self, image: &Image) -> Option<u64> {
        let is_set_off = self.watched().any(|(_, event)| self.has_edge(event, image));
        (!is_set_off).then(|| self.due.next().unwrap_or(u64::MAX))
    }

    /// The events that wait for an edge, with their places.
    fn watched(&self) -> impl Iterator<Item = (usize, &Event)> {
        self.watching.iter().filter_map(|at| Some((*at, self.events.get(*at)?)))
    }

    /// Whether an event is set off by what has changed since the last cycle.
    fn has_edge(&self, event: &Event, image: &Image) -> bool {
        match event.cause {
            Cause::At(_) => false,
            Cause::Edge { output, channel, level } => {
                let (before, now) =
                    if output { (&self.before_out, image.outputs()) } else { (&self.before_in, image.inputs()) };
                before.get(channel) != level && now.get(channel) == level
            }
            Cause::Pwm(channel) => self.before_pwm.get(channel) != image.pwms().get(channel),
        }
    }

    fn find_edges(&mut self, cycle: u64, image: &Image) {
        let mut due = std::mem::take(&mut self.due);
        for (at, event) in self.watched().filter(|(_, event)| self.has_edge(event, image)) {
            // The outside has seen the edge at the end of the cycle before.
            due.add(cycle.saturating_sub(1) + self.rate.cycles(event.after), at);
        }
        self.due = due;
        self.before_pwm = image.pwms();
        self.before_in.copy_from(image.inputs());
        self.before_out.copy_from(image.outputs());
    }
}

/// Whether a button is pressed.
fn presses(events: &[Event], is_meant: impl Fn(Pendant) -> bool) -> bool {
    let mut actions = events.iter().flat_map(|event| &event.actions);
    actions.any(|action| matches!(action, Action::Effect(Effect::Pendant(button)) if is_meant(*button)))
}

impl Action {
    /// What brings back what this changes, where it lasts.
    fn undone(&self, image: &Image) -> Option<Self> {
        match *self {
            Self::Digital(what, channel, _) => Some(Self::Digital(what, channel, image.digital(what, channel).ok()?)),
            Self::Analog(channel, _) => Some(Self::Analog(channel, image.analog_input(channel).ok()?)),
            Self::Effect(Effect::Robot(robot, RobotEffect::Force(_))) => {
                Some(Self::Effect(Effect::Robot(robot, RobotEffect::Force([0.0; 3]))))
            }
            Self::Effect(Effect::Robot(robot, RobotEffect::Torque(axis, _))) => {
                Some(Self::Effect(Effect::Robot(robot, RobotEffect::Torque(axis, 0.0))))
            }
            Self::Effect(_) => None,
        }
    }
}

/// Events on their way: the earliest comes first, and those of one cycle in the order in which they were set off.
#[derive(Default, Debug)]
struct Due {
    /// Cycle, how many were set off before, and the event.
    waiting: BinaryHeap<Reverse<(u64, u64, usize)>>,
    added: u64,
}

impl Due {
    fn with_room(room: usize) -> Self {
        Self { waiting: BinaryHeap::with_capacity(room), added: 0 }
    }

    fn add(&mut self, cycle: u64, event: usize) {
        self.waiting.push(Reverse((cycle, self.added, event)));
        self.added += 1;
    }

    /// The next event that is due in a cycle or was due before.
    fn take(&mut self, cycle: u64) -> Option<usize> {
        let Reverse((when, ..)) = self.waiting.peek()?;
        if *when > cycle {
            return None;
        }
        self.waiting.pop().map(|Reverse((_, _, event))| event)
    }

    /// The cycle of the next event.
    fn next(&self) -> Option<u64> {
        self.waiting.peek().map(|Reverse((when, ..))| *when)
    }

    /// Drops all but these events.
    fn retain(&mut self, stays: impl Fn(usize) -> bool) {
        self.waiting.retain(|Reverse((_, _, event))| stays(*event));
    }

    fn is_empty(&self) -> bool {
        self.waiting.is_empty()
    }
}
