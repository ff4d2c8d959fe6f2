//! A scenario while it plays: which events are due, and what sets them off.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::{Action, Cause, Effect, Event, Pendant, Scenario};
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
    resets: bool,
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
        let (mut due, mut watching) = (Due::with_room(events.len() * 4 + 16), Vec::new());
        for (at, event) in events.iter().enumerate() {
            match event.cause {
                Cause::At(time) => due.add(rate.cycles(time), at),
                Cause::Edge { .. } | Cause::Pwm(_) => watching.push(at),
            }
        }
        let reset = Action::Effect(Effect::Pendant(Pendant::Reset));
        let resets = events.iter().any(|event| event.actions.contains(&reset));
        let (before_in, before_out) = (image.inputs().clone(), image.outputs().clone());
        Self { events, watching, resets, rate, due, played: 0, before_in, before_out, before_pwm: image.pwms() }
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

    fn is_empty(&self) -> bool {
        self.waiting.is_empty()
    }
}
