//! The table of the interrupts, timers and triggers that a program has declared, in the order of declaration, and of
//! those that are due.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, VecDeque};
use std::rc::Rc;
use std::task::{Context, Poll};

use crate::context::cx::Cx;
use crate::fault::{Done, Fault, File};
use crate::values::Str;
use arl_robot::cell::Rate;

/// The most events: more are the work of a loop that declares them again and again.
const MAX_EVENTS: usize = 1024;
/// The lowest priority.
const LOWEST_PRIORITY: i32 = 255;

/// The condition and the action of an event, of any Rust type.
pub(crate) trait Code {
    /// Whether the condition holds now. `Pending`: it has not come to a result within the turns of loops of a cycle.
    fn holds(&self, cx: &Cx) -> Poll<Done<bool>>;

    /// Memory for the action to run in.
    fn room(self: Rc<Self>) -> Box<dyn Act>;
}

/// An action and the memory that it runs in: it runs as often as its event occurs, once at a time, and takes no more
/// memory.
pub(crate) trait Act {
    /// Puts the action at its beginning.
    fn begin(&mut self, cx: Rc<Cx>);

    /// Runs the action until it waits or ends; one that has not begun has ended.
    fn poll(&mut self, context: &mut Context<'_>) -> Poll<Done<()>>;
}

/// The source of an event.
#[derive(Clone, Debug)]
pub(crate) enum Source {
    /// A condition, and whether it held at its last evaluation.
    Condition { held: bool },
    /// Time.
    Time(Ticking),
    /// A condition that is evaluated while a motion is executed, whether it held at its last evaluation, and whether
    /// the motion is over.
    Motion { number: u64, held: bool, over: bool },
}

/// A timer: its first cycle, and how many intervals have been counted since.
#[derive(Clone, Debug)]
pub(crate) struct Ticking {
    /// In s.
    pub(crate) interval: f64,
    pub(crate) repeats: bool,
    start: u64,
    ticks: u64,
}

impl Ticking {
    pub(crate) fn new(interval: f64, repeats: bool, now: u64) -> Self {
        Self { interval, repeats, start: now, ticks: 0 }
    }

    /// Whether an interval is over in this cycle.
    pub(crate) fn is_over(&mut self, now: u64, rate: Rate) -> bool {
        if self.has_ended() {
            return false;
        }
        let length = self.interval.max(rate.period());
        // Counted from the start, so that intervals that are not whole cycles do not drift.
        let over = now >= self.start + rate.cycles(length * (self.ticks + 1) as f64).max(1);
        self.ticks += u64::from(over);
        over
    }

    /// Whether no interval is left to count.
    fn has_ended(&self) -> bool {
        self.ticks > 0 && !self.repeats
    }

    fn begin_anew(&mut self, now: u64) {
        (self.start, self.ticks) = (now, 0);
    }
}

/// An event that has been declared.
pub(crate) struct DeclaredEvent {
    /// The order of declaration.
    pub(crate) number: u64,
    /// The name; empty where it has none.
    pub(crate) name: Str,
    pub(crate) priority: u8,
    pub(crate) source: Source,
    pub(crate) enabled: bool,
    /// The cycle in which an event occurred that waits to be handled.
    pub(crate) arrived: Option<u64>,
    /// The place of the declaration.
    pub(crate) place: (File, u32),
    pub(crate) code: Rc<dyn Code>,
    /// The memory in which its action runs; `None` while it does.
    room: Option<Box<dyn Act>>,
}

impl DeclaredEvent {
    /// A description for messages.
    pub(crate) fn describe(&self) -> String {
        let what = match self.source {
            Source::Condition { .. } => "interrupt",
            Source::Time(_) => "timer",
            Source::Motion { .. } => "trigger",
        };
        match self.name.is_empty() {
            true => format!("the {what} of line {}", self.place.1),
            false => format!("the {what} \"{}\"", self.name),
        }
    }

    /// The event occurs now: until it is handled, further occurrences are not counted.
    pub(crate) fn happen(&mut self, now: u64, due: &mut BinaryHeap<Reverse<Rank>>) {
        if self.arrived.is_none() {
            self.arrived = Some(now);
            due.extend(self.rank().map(Reverse));
        }
    }

    fn rank(&self) -> Option<Rank> {
        Some(Rank { priority: self.priority, arrived: self.arrived?, number: self.number })
    }
}

/// The order in which events are handled.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(crate) struct Rank {
    priority: u8,
    arrived: u64,
    number: u64,
}

/// Checks a priority that a program gives.
pub(crate) fn priority(value: i32, function: &'static str) -> Result<u8, Fault> {
    u8::try_from(value).map_err(|_| {
        let problem = format!("the priority is {value}, but must be 0 to {LOWEST_PRIORITY}");
        Fault::Domain { function, problem: problem.into() }
    })
}

/// An event whose action is about to run, or runs.
pub(crate) struct Due {
    /// Its place in the order of declaration.
    number: u64,
    /// Its priority.
    pub(crate) priority: u8,
    /// Its action.
    pub(crate) action: Box<dyn Act>,
}

/// A selection of interrupts and timers.
#[derive(Clone, Debug)]
pub(crate) enum Which {
    All,
    These { name: Option<Str>, priority: Option<u8> },
}

/// The events of a channel.
#[derive(Default)]
pub(crate) struct EventTable {
    /// Interrupts and timers in the order of declaration.
    pub(crate) interrupts: Vec<DeclaredEvent>,
    /// Triggers of motions that are planned, in the order of the motions.
    pub(crate) triggers: VecDeque<DeclaredEvent>,
    /// Triggers whose motion is not planned yet, with the level of the program that declared them.
    waiting: Vec<(u32, DeclaredEvent)>,
    /// How many events have been declared.
    declared: u64,
    /// All events that wait to be handled, the first one on top; with room for all that are declared.
    pub(crate) due: BinaryHeap<Reverse<Rank>>,
}

/// A declaration.
pub(crate) struct Declaration {
    pub(crate) name: Option<Str>,
    pub(crate) priority: u8,
    pub(crate) source: Source,
    pub(crate) place: (File, u32),
    pub(crate) code: Rc<dyn Code>,
}

impl EventTable {
    /// Drops all events.
    pub(crate) fn clear(&mut self) {
        *self = Self::default();
    }

    /// Drops the events that do not belong to a planned motion.
    pub(crate) fn keep_to_motions(&mut self) {
        self.interrupts.clear();
        self.waiting.clear();
        self.find_due();
    }

    /// Adds an interrupt or a timer.
    pub(crate) fn declare(&mut self, function: &'static str, new: Declaration) -> Result<(), Fault> {
        let domain = |problem: String| Fault::Domain { function, problem: problem.into() };
        if let Some(name) = &new.name {
            if name.is_empty() {
                return Err(domain("the name is empty: leave it out, or give one".into()));
            }
            if self.interrupts.iter().any(|event| event.name == *name) {
                return Err(domain(format!("there is already an interrupt or a timer with the name \"{name}\"")));
            }
        }
        self.check_room(function)?;
        let event = self.event(new);
        self.interrupts.push(event);
        Ok(())
    }

    /// Adds a trigger of the next motion that this level of the program plans.
    pub(crate) fn declare_trigger(&mut self, level: u32, new: Declaration) -> Result<(), Fault> {
        self.check_room("trigger")?;
        let event = self.event(new);
        self.waiting.push((level, event));
        Ok(())
    }

    fn check_room(&self, function: &'static str) -> Result<(), Fault> {
        if self.interrupts.len() < MAX_EVENTS && self.waiting.len() < MAX_EVENTS {
            return Ok(());
        }
        let problem = format!("{MAX_EVENTS} are declared already, and no more are possible: is this one in a loop?");
        Err(Fault::Domain { function, problem: problem.into() })
    }

    fn event(&mut self, new: Declaration) -> DeclaredEvent {
        self.declared += 1;
        self.due.reserve(self.interrupts.len() + self.triggers.len() + self.waiting.len() + 1);
        let Declaration { name, priority, source, place, code } = new;
        let name = name.unwrap_or_default();
        let room = Some(Rc::clone(&code).room());
        DeclaredEvent { number: self.declared, name, priority, source, enabled: true, arrived: None, place, code, room }
    }

    /// Binds the triggers that a level of the program has declared to a motion.
    pub(crate) fn bind(&mut self, level: u32, motion: u64) {
        for (_, mut event) in self.waiting.extract_if(.., |(declared_by, _)| *declared_by == level) {
            event.source = Source::Motion { number: motion, held: false, over: false };
            self.triggers.push_back(event);
        }
    }

    /// Drops the triggers that a level of the program has declared for a motion that was not planned.
    pub(crate) fn unbind(&mut self, level: u32) {
        self.waiting.retain(|(declared_by, _)| *declared_by != level);
    }

    /// The indices of the selected interrupts and timers.
    ///
    /// # Errors
    /// None has that name or priority.
    pub(crate) fn find(&self, function: &'static str, which: &Which) -> Result<Vec<usize>, Fault> {
        let Which::These { name, priority } = which else { return Ok((0..self.interrupts.len()).collect()) };
        let named = |event: &DeclaredEvent| name.as_ref().is_some_and(|name| !name.is_empty() && event.name == *name);
        let ranked = |event: &DeclaredEvent| *priority == Some(event.priority);
        let missing = |what: String| {
            Err(Fault::Domain { function, problem: format!("there is no interrupt or timer {what}").into() })
        };
        if let Some(name) = name
            && !self.interrupts.iter().any(named)
        {
            return missing(format!("with the name \"{name}\""));
        }
        if let Some(priority) = priority
            && !self.interrupts.iter().any(ranked)
        {
            return missing(format!("of priority {priority}"));
        }
        let all = self.interrupts.iter().enumerate();
        Ok(all.filter(|(_, event)| named(event) || ranked(event)).map(|(at, _)| at).collect())
    }

    /// Enables interrupts and timers: timers that were disabled begin their intervals again.
    pub(crate) fn enable(&mut self, found: &[usize], now: u64) {
        for at in found {
            let Some(event) = self.interrupts.get_mut(*at).filter(|event| !event.enabled) else { continue };
            event.enabled = true;
            if let Source::Time(ticking) = &mut event.source {
                ticking.begin_anew(now);
            }
        }
    }

    /// Disables interrupts and timers: occurrences that wait to be handled are lost.
    pub(crate) fn disable(&mut self, found: &[usize]) {
        for at in found {
            if let Some(event) = self.interrupts.get_mut(*at) {
                event.enabled = false;
                event.arrived = None;
            }
        }
        self.find_due();
    }

    /// Deletes interrupts and timers.
    pub(crate) fn delete(&mut self, found: &[usize]) {
        found.iter().rev().for_each(|at| drop(self.interrupts.remove(*at)));
        self.find_due();
    }

    /// Finds the events that wait to be handled, after some may have been removed.
    fn find_due(&mut self) {
        if !self.due.is_empty() {
            self.due.clear();
            let all = self.interrupts.iter().chain(&self.triggers);
            self.due.extend(all.filter_map(DeclaredEvent::rank).map(Reverse));
        }
    }

    /// The event with this number in the order of declaration, by which the interrupts are sorted.
    fn numbered(&mut self, number: u64) -> Option<&mut DeclaredEvent> {
        match self.interrupts.binary_search_by_key(&number, |event| event.number) {
            Ok(at) => self.interrupts.get_mut(at),
            Err(_) => self.triggers.iter_mut().find(|event| event.number == number),
        }
    }

    /// Takes the next event to be handled, if it has a higher priority than `running`.
    pub(crate) fn take_due(&mut self, running: Option<u8>) -> Option<Due> {
        let Reverse(first) = *self.due.peek()?;
        if running.is_some_and(|running| first.priority >= running) {
            return None;
        }
        self.due.pop();
        let first = self.numbered(first.number)?;
        first.arrived = None;
        // The memory is missing only where an action was dropped while it ran.
        let action = first.room.take().unwrap_or_else(|| Rc::clone(&first.code).room());
        Some(Due { number: first.number, priority: first.priority, action })
    }

    /// Takes back the memory of an action that has ended, unless its event was removed.
    pub(crate) fn give_back(&mut self, due: Due) {
        if let Some(event) = self.numbered(due.number) {
            event.room = Some(due.action);
        }
    }

    /// A description of the event that was declared at this place.
    pub(crate) fn describe(&self, place: (File, u32)) -> Option<String> {
        let waiting = self.waiting.iter().map(|(_, event)| event);
        let mut all = self.interrupts.iter().chain(&self.triggers).chain(waiting);
        all.find(|event| event.place == place).map(DeclaredEvent::describe)
    }

    /// Whether an interrupt or a timer is declared.
    pub(crate) fn watches(&self) -> bool {
        !self.interrupts.is_empty()
    }

    /// Whether a timer runs.
    pub(crate) fn ticks(&self) -> bool {
        let ticks = |event: &DeclaredEvent| matches!(&event.source, Source::Time(ticking) if event.enabled && !ticking.has_ended());
        self.interrupts.iter().any(ticks)
    }

    /// Whether an event waits to be handled.
    pub(crate) fn has_due(&self) -> bool {
        !self.due.is_empty()
    }
}
