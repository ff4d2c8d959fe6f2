//! A scenario while it plays: which events are due, and what triggers them.

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
    /// The indices of the events that wait for an edge.
    watching: Vec<usize>,
    /// The indices of the events that happen at a time, with that time in cycles.
    timed: Vec<(usize, u64)>,
    /// The initial state of everything that timed events set.
    at_first: Vec<Action>,
    /// The cycle from which time counts.
    began: u64,
    /// Whether time does not count yet because the programs wait for their start.
    waits: bool,
    resets: bool,
    /// Whether the scenario starts programs at the pendant.
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

    /// The cycle from which time counts, or counted last.
    pub(crate) fn began(&self) -> u64 {
        self.began
    }

    /// Whether the time of the scenario does not count yet.
    pub(crate) fn waits(&self) -> bool {
        self.waits
    }

    /// Stops time until [`begin`](Self::begin), while the programs wait for their start. Edges still trigger events.
    pub(crate) fn wait(&mut self) {
        self.waits = true;
        let timed = &self.timed;
        self.due.retain(|event| timed.binary_search_by_key(&event, |(at, _)| *at).is_err());
    }

    /// Lets time count from the start of this cycle.
    pub(crate) fn begin(&mut self, cycle: u64) {
        self.wait();
        self.waits = false;
        self.began = cycle;
        for (event, after) in &self.timed {
            self.due.add(cycle.saturating_add(*after), *event);
        }
    }

    /// Begins again: restores the initial state of everything that timed events set.
    pub(crate) fn begin_again(&mut self, cycle: u64, image: &mut Image, mut do_it: impl FnMut(Effect)) {
        self.at_first.iter().for_each(|action| action.play(image, &mut do_it));
        self.begin(cycle);
    }

    /// Whether the scenario itself starts programs: at the pendant, or by a digital input.
    pub(crate) fn starts(&self, input: Option<i32>) -> bool {
        let sets =
            |action: &Action| matches!(action, Action::Digital(Digital::Di, channel, _) if Some(*channel) == input);
        self.begins || input.is_some() && self.events.iter().any(|event| event.actions.iter().any(sets))
    }

    /// The most effects of a cycle, if no event happens twice in it.
    pub(crate) fn max_effects(&self) -> usize {
        let actions = self.events.iter().flat_map(|event| &event.actions);
        actions.filter(|action| matches!(action, Action::Effect(_))).count()
    }

    /// Sets the inputs that are due at the start of `cycle`; passes all other actions to `do_it`.
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

    /// Whether the scenario restarts programs that have ended, at the pendant.
    pub(crate) fn resets(&self) -> bool {
        self.resets
    }

    /// Whether an event is pending, or will be in the next cycle because of a change in this one.
    pub(crate) fn goes_on(&self, image: &Image) -> bool {
        !self.due.is_empty() || self.watched().any(|(_, event)| self.has_edge(event, image))
    }

    /// The cycle of the last event.
    pub(crate) fn played(&self) -> u64 {
        self.played
    }

    /// The cycle before which nothing happens by itself; `None` if a change in this cycle triggers an event in the next
    /// one.
    pub(crate) fn quiet_until(&self, image: &Image) -> Option<u64> {
        let is_set_off = self.watched().any(|(_, event)| self.has_edge(event, image));
        (!is_set_off).then(|| self.due.next().unwrap_or(u64::MAX))
    }

    /// The events that wait for an edge, with their indices.
    fn watched(&self) -> impl Iterator<Item = (usize, &Event)> {
        self.watching.iter().filter_map(|at| Some((*at, self.events.get(*at)?)))
    }

    /// Whether a change since the last cycle triggers an event.
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
            // The outside has seen the edge at the end of the previous cycle.
            due.add(cycle.saturating_sub(1) + self.rate.cycles(event.after), at);
        }
        self.due = due;
        self.before_pwm = image.pwms();
        self.before_in.copy_from(image.inputs());
        self.before_out.copy_from(image.outputs());
    }
}

/// Whether an event presses one of the given buttons.
fn presses(events: &[Event], is_meant: impl Fn(Pendant) -> bool) -> bool {
    let mut actions = events.iter().flat_map(|event| &event.actions);
    actions.any(|action| matches!(action, Action::Effect(Effect::Pendant(button)) if is_meant(*button)))
}

impl Action {
    /// The action that restores the current state, if the change is a lasting one.
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

/// Pending events: the earliest first, those of one cycle in the order in which they were triggered.
#[derive(Default, Debug)]
struct Due {
    /// The cycle, the number of events triggered before, and the event.
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

    /// Takes the next event that is due in a cycle or before.
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

    /// Keeps only these events.
    fn retain(&mut self, stays: impl Fn(usize) -> bool) {
        self.waiting.retain(|Reverse((_, _, event))| stays(*event));
    }

    fn is_empty(&self) -> bool {
        self.waiting.is_empty()
    }
}
