//! The mediator between a debugger and the programs: it halts them, and answers while they are halted.

use std::cell::{Cell, RefCell};
use std::rc::{Rc, Weak};
use std::time::{Duration, Instant};

use super::answers;
use super::link::{DebugLink, DebugRequest};
use super::plan::{HaltPlan, Point, RunMode, Statement, Why};
use crate::command::json::{number, quoted};
use crate::context::cx::{Cx, Level};
use crate::context::watcher::{Go, Watcher};
use crate::fault::Alarm;

/// The least time between two reports of motion pointers while programs run.
const POINTER_INTERVAL: Duration = Duration::from_millis(20);

/// Halts programs, and answers a debugger.
pub(super) struct Debugger {
    link: DebugLink,
    /// Whether cycles run in real time: then they go on while programs are halted.
    real: bool,
    contexts: RefCell<Vec<Weak<Cx>>>,
    plan: RefCell<HaltPlan>,
    /// How far programs were to go when they were halted.
    mode_before: Cell<RunMode>,
    /// How many statements were about to run so far.
    statements: Cell<u64>,
    /// The channel with a halted statement, on the virtual clock.
    stands_in: Cell<Option<usize>>,
    /// The channel whose program pointer was set, until its program has arrived there.
    arriving: Cell<Option<usize>>,
    /// How often something was changed by hand.
    changes: Cell<u64>,
    /// Whether programs are halted while cycles go on.
    halted: Cell<bool>,
    /// The alarm that was raised last, and its cycle: it is reported again when the program ends.
    alarm: RefCell<Option<(Alarm, u64)>>,
    /// The motion of each channel that was last reported to the debugger, and when that was.
    motions: RefCell<Vec<u64>>,
    last_sent: Cell<Option<Instant>>,
}

/// A report of a halt to the debugger.
struct Halt {
    why: Why,
    /// Another reason, should the debugger let the program pass a breakpoint.
    also: Option<Why>,
    channel: usize,
    /// Whether no statement is about to run: between two cycles.
    between: bool,
    text: String,
}

impl Halt {
    fn new(channel: usize) -> Self {
        Self { why: "step", also: None, channel, between: false, text: String::new() }
    }
}

/// Whether a request lets programs go on.
enum Reply {
    Stand,
    Go,
}

impl Debugger {
    pub(super) fn new(link: DebugLink, real: bool) -> Self {
        Self {
            link,
            real,
            contexts: RefCell::default(),
            plan: RefCell::default(),
            mode_before: Cell::new(RunMode::Continue),
            statements: Cell::new(0),
            stands_in: Cell::new(None),
            arriving: Cell::new(None),
            changes: Cell::new(0),
            halted: Cell::new(false),
            alarm: RefCell::default(),
            motions: RefCell::default(),
            last_sent: Cell::new(None),
        }
    }

    /// Waits until the debugger has set where to halt, and lets programs run.
    pub(super) fn begin(&self, contexts: Vec<Rc<Cx>>) {
        self.know(&contexts);
        let channels = answers::channels(&contexts);
        self.link.say(&format!("\"event\":\"ready\",\"channels\":{channels}"));
        self.stand();
    }

    /// Reports that no robot executes a motion any more.
    pub(super) fn end(&self, contexts: Vec<Rc<Cx>>) {
        self.know(&contexts);
        self.tell_pointers();
    }

    /// To be called between two cycles.
    pub(super) fn cycle_begins(&self, contexts: Vec<Rc<Cx>>) {
        self.know(&contexts);
        self.obey();
        if !self.real || !self.halted.get() {
            let motion = |at: usize| self.context(at).map_or(0, |cx| answers::motion(&cx));
            let cycle = self.context(0).map_or(0, |cx| cx.cycle());
            let why = self.plan.borrow().halts_between(cycle, self.statements.get(), motion);
            if let Some(why) = why {
                let at = match self.plan.borrow().run_mode() {
                    RunMode::Motion(channel, _) => channel,
                    _ => 0,
                };
                self.halt(&Halt { why, between: true, ..Halt::new(at) });
            }
        }
        if self.last_sent.get().is_none_or(|last_sent| last_sent.elapsed() >= POINTER_INTERVAL) {
            self.tell_pointers();
        }
    }

    /// Halts a run that could not go on. Returns whether something was changed by then.
    pub(super) fn nothing_can_change(&self, contexts: Vec<Rc<Cx>>, waiting: &str) -> bool {
        self.know(&contexts);
        let changes = self.changes.get();
        // When the run is repeated up to an earlier point, the changes made here are known: it passes this place again,
        // and goes on.
        let run_mode = self.plan.borrow().run_mode();
        if let RunMode::Until(point) | RunMode::Search(point) = run_mode {
            return point.cycle != u64::MAX;
        }
        if self.plan.borrow().alarms {
            self.halt(&Halt { why: "standstill", between: true, text: waiting.to_owned(), ..Halt::new(0) });
        }
        self.changes.get() != changes
    }

    /// Whether programs are halted while cycles go on.
    pub(super) fn is_halted(&self) -> bool {
        self.halted.get()
    }

    /// Whether the debugger is gone.
    pub(super) fn is_gone(&self) -> bool {
        self.link.is_gone()
    }

    /// An alarm was raised.
    pub(super) fn alarm_came_up(&self, alarm: &Alarm) {
        let Some(first) = self.context(0) else { return };
        let now = first.cycle();
        let known = self.alarm.borrow().as_ref().is_some_and(|(known, cycle)| {
            known.fault == alarm.fault && (known.file, known.line) == (alarm.file, alarm.line) && *cycle == now
        });
        if known {
            return;
        }
        *self.alarm.borrow_mut() = Some((alarm.clone(), now));
        // Where cycles go on this must not wait: the alarm ends the program, and the robot stops on its path.
        let passes = matches!(self.plan.borrow().run_mode(), RunMode::Until(_));
        if self.plan.borrow().alarms && !self.real && !passes {
            let place = |cx: &Rc<Cx>| cx.frames().all().last().map(|frame| (frame.file, frame.line));
            let all = self.all();
            // An alarm raised by a statement does not have its channel yet.
            let at = all.iter().position(|cx| place(cx) == Some((alarm.file, alarm.line)));
            let at = at.or_else(|| all.iter().position(|cx| cx.channel_state().id == alarm.channel));
            self.halt(&Halt { why: "alarm", text: alarm.to_string(), ..Halt::new(at.unwrap_or(0)) });
        }
    }

    fn know(&self, contexts: &[Rc<Cx>]) {
        *self.contexts.borrow_mut() = contexts.iter().map(Rc::downgrade).collect();
    }

    fn all(&self) -> Vec<Rc<Cx>> {
        self.contexts.borrow().iter().filter_map(Weak::upgrade).collect()
    }

    fn context(&self, at: usize) -> Option<Rc<Cx>> {
        self.contexts.borrow().get(at)?.upgrade()
    }

    /// Halts the programs: until the debugger lets them go on, or from the next cycle on.
    fn halt(&self, halt: &Halt) {
        self.mode_before.set(self.plan.borrow().run_mode());
        self.plan.borrow_mut().go(RunMode::Continue);
        self.tell_pointers();
        // What was printed so far is output before the halt.
        self.context(0).into_iter().for_each(|cx| cx.shared().flush());
        let time = self.context(0).map_or(0.0, |cx| cx.time());
        let Halt { why, also, channel, between, text } = halt;
        let cycle = self.context(0).filter(|_| *between).map(|cx| format!("\"cycle\":{},", cx.cycle()));
        let cycle = cycle.unwrap_or_default();
        self.link.say(&format!(
            "\"event\":\"stopped\",\"why\":\"{why}\",\"also\":\"{}\",\"channel\":{channel},{cycle}\
             \"statement\":{},\"time\":{},\"text\":{}",
            also.unwrap_or_default(),
            self.statements.get(),
            number(time),
            quoted(text),
        ));
        if self.real {
            self.halted.set(true);
            return;
        }
        self.stands_in.set(Some(*channel).filter(|_| !between && *why != "alarm"));
        self.stand();
        self.stands_in.set(None);
    }

    /// Answers until programs go on.
    fn stand(&self) {
        while let Some(request) = self.link.wait() {
            if let Reply::Go = self.answer(&request) {
                return;
            }
        }
    }

    /// Answers the requests that have arrived.
    fn obey(&self) {
        while let Some(request) = self.link.take() {
            if let Reply::Go = self.answer(&request) {
                self.halted.set(false);
            }
        }
    }

    fn answer(&self, request: &DebugRequest) -> Reply {
        let channel = request.whole(0) as usize;
        let run_mode = match request.word.as_str() {
            "breakpoints" => {
                self.plan.borrow_mut().set_lines(request);
                None
            }
            "kinds" => {
                self.plan.borrow_mut().set_kinds(request);
                None
            }
            "go" => Some(RunMode::Continue),
            "again" => Some(self.mode_before.get()),
            "pause" => {
                // Also where a breakpoint is just being evaluated, and then passed.
                self.mode_before.set(RunMode::Pause);
                self.plan.borrow_mut().go(RunMode::Pause);
                None
            }
            "into" => Some(RunMode::Into(channel)),
            "over" => Some(RunMode::Over(channel, self.depth(channel))),
            "out" => Some(RunMode::Over(channel, self.depth(channel).saturating_sub(1))),
            "motion" => Some(RunMode::Motion(channel, self.context(channel).map_or(0, |cx| answers::motion(&cx)))),
            "until" => Some(RunMode::Until(Point { statement: request.whole(0), cycle: request.whole(1) })),
            "search" => Some(RunMode::Search(Point { statement: request.whole(0), cycle: request.whole(1) })),
            _ => {
                let fields = match answers::answer(request, &self.all()) {
                    Ok(fields) => {
                        if answers::changes(request) {
                            self.changes.set(self.changes.get() + 1);
                        }
                        fields
                    }
                    Err(why) => format!("\"error\":{}", quoted(&why)),
                };
                // A program that is halted at a statement goes there at once: its variables are then those of the new
                // place.
                let arrives =
                    request.word == "pointer" && self.is_moved(channel) && self.stands_in.get() == Some(channel);
                self.arriving.set(Some(channel).filter(|_| arrives));
                self.link.say(&format!("\"answer\":{},\"arrives\":{arrives},{fields}", request.number));
                return if arrives { Reply::Go } else { Reply::Stand };
            }
        };
        self.link.say(&format!("\"answer\":{},\"done\":true", request.number));
        match run_mode {
            Some(run_mode) => {
                self.plan.borrow_mut().go(run_mode);
                Reply::Go
            }
            None => Reply::Stand,
        }
    }

    /// Whether the program pointer of a channel was set, and its program has not arrived there yet.
    fn is_moved(&self, channel: usize) -> bool {
        self.context(channel).is_some_and(|cx| cx.frames().is_any_moved())
    }

    /// How many nested functions a channel is in, not counting code that evaluates conditions.
    fn depth(&self, channel: usize) -> usize {
        self.context(channel).map_or(0, |cx| cx.frames().all().len())
    }

    /// Reports which motions are executed, where that has changed.
    fn tell_pointers(&self) {
        let mut known = self.motions.borrow_mut();
        for (at, cx) in self.all().iter().enumerate() {
            if known.len() <= at {
                known.resize(at + 1, 0);
            }
            let (motion, fields) = answers::motion_pointer(cx);
            if let Some(known) = known.get_mut(at).filter(|known| **known != motion) {
                *known = motion;
                self.last_sent.set(Some(Instant::now()));
                self.link.say(&format!("\"event\":\"motion\",\"channel\":{at},{fields}"));
            }
        }
    }
}

impl Watcher for Debugger {
    fn statement(&self, cx: &Cx, frame: u64) -> Go {
        let number = self.statements.get() + 1;
        self.statements.set(number);
        let is_condition = cx.level().number == Level::CONDITION.number;
        // Conditions are evaluated while programs are halted, too, and cannot wait. They are not shown.
        if self.real && is_condition {
            return Go::On;
        }
        self.obey();
        if self.halted.get() {
            return Go::NotYet;
        }
        let (id, frames) = (cx.channel_state().id, cx.frames());
        let Some((file, line, is_action)) = frames.place(frame) else { return Go::On };
        let contexts = self.contexts.borrow();
        let channel = contexts.iter().filter_map(Weak::upgrade).position(|cx| cx.channel_state().id == id).unwrap_or(0);
        drop(contexts);
        let program = cx.program();
        let statement = Statement {
            number,
            channel,
            depth: frames.depth(frame),
            folder: cx.program_itself().folder(),
            program: program.name(),
            file: file.name(),
            line,
            begins_action: is_action,
            is_condition,
        };
        let why = self.plan.borrow().halts_at(&statement);
        if let Some((why, also)) = why {
            self.halt(&Halt { why, also, ..Halt::new(channel) });
        }
        if self.halted.get() { Go::NotYet } else { Go::On }
    }

    fn goes_on(&self) -> Go {
        if let Some(channel) = self.arriving.take() {
            self.halt(&Halt { why: "goto", ..Halt::new(channel) });
        }
        if self.halted.get() { Go::NotYet } else { Go::On }
    }

    fn alarm(&self, alarm: &Alarm) {
        self.alarm_came_up(alarm);
    }
}
