//! What interrupts and timers do, cycle by cycle, from the rules of the language alone.

use super::plan::{Action, Cause, Condition, Declaration, LOCALS, Plan, SIGNALS, Signal, Step, Switch};
use std::fmt::Write as _;

/// How a run ended.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) enum End {
    Ended,
    /// On this step of this script.
    Alarm {
        script: usize,
        step: usize,
    },
}

/// An interrupt or a timer.
struct Interrupt {
    declared: Declaration,
    /// The locals of the run of a script that declared it.
    locals: usize,
    enabled: bool,
    /// The cycle of the event that waits.
    event: Option<u64>,
    /// Whether the condition was true in the last scan.
    was: bool,
    /// The cycle from which a timer counts the next interval; none once it is done.
    counts_from: Option<u64>,
}

/// A script that has begun, and what it has to be interrupted by.
struct Running {
    script: usize,
    next: usize,
    /// Its locals.
    locals: usize,
    waits_until: u64,
    /// What ends the wait before that.
    waits_for: Option<Condition>,
    /// None for `main`.
    priority: Option<i32>,
    /// For an action that is not a script.
    turns: Option<Action>,
}

impl Running {
    fn new(script: usize, next: usize, locals: usize) -> Self {
        Self { script, next, locals, waits_until: 0, waits_for: None, priority: None, turns: None }
    }
}

/// At the end of its script.
const DONE: usize = usize::MAX;

pub(super) struct Model<'a> {
    plan: &'a Plan,
    now: u64,
    inputs: [bool; SIGNALS],
    flags: [bool; SIGNALS],
    /// Of each run of a script; interrupts use them when it is over, too.
    locals: Vec<[bool; LOCALS]>,
    /// In the order of declaration.
    interrupts: Vec<Interrupt>,
    running: Vec<Running>,
    pub(super) out: String,
}

impl<'a> Model<'a> {
    pub(super) fn new(plan: &'a Plan) -> Self {
        let (inputs, flags) = ([false; SIGNALS], [false; SIGNALS]);
        let (locals, running) = (vec![[false; LOCALS]], vec![Running::new(0, 0, 0)]);
        Self { plan, now: 0, inputs, flags, locals, interrupts: Vec::new(), running, out: String::new() }
    }

    /// Runs until the program ends; none where it does not within so many cycles.
    pub(super) fn run(&mut self, cycles: u64) -> Option<End> {
        while self.now < cycles {
            if let Some(end) = self.cycle() {
                return Some(end);
            }
            self.now += 1;
        }
        None
    }

    fn cycle(&mut self) -> Option<End> {
        for (_, input, level) in self.plan.inputs.iter().filter(|(at, ..)| *at == self.now) {
            self.inputs[*input] = *level;
        }
        self.scan();
        loop {
            self.interrupt();
            let (waits_for, locals) = self.running.last().map(|top| (top.waits_for, top.locals))?;
            let holds = waits_for.is_some_and(|condition| self.holds(condition, locals));
            let top = self.running.last_mut()?;
            if top.waits_until > self.now && !holds {
                return None;
            }
            (top.waits_until, top.waits_for) = (0, None);
            let (script, step, at_end) = (top.script, top.next, top.next == DONE);
            match top.turns.take() {
                Some(Action::Turn(flag)) => self.flags[flag] = !self.flags[flag],
                Some(Action::TurnLocal(local)) => self.locals[locals][local] = !self.locals[locals][local],
                Some(Action::Run(_)) | None => {}
            }
            match self.plan.scripts[script].get(step).filter(|_| !at_end) {
                Some(_) => {
                    self.running.last_mut()?.next += 1;
                    if let Some(end) = self.step(script, step) {
                        return Some(end);
                    }
                }
                None => {
                    self.running.pop();
                    if self.running.is_empty() {
                        // The program is alive as long as events wait.
                        let Some(_) = self.first_event() else { return Some(End::Ended) };
                        self.running.push(Running::new(0, DONE, 0));
                    }
                }
            }
        }
    }

    /// Whether a condition holds where the locals are these.
    fn holds(&self, condition: Condition, locals: usize) -> bool {
        let is = |signal: Signal| match signal {
            Signal::Input(input) => self.inputs[input],
            Signal::Flag(flag) => self.flags[flag],
            Signal::Local(local) => self.locals[locals][local],
        };
        match condition {
            Condition::Is(a) => is(a),
            Condition::Not(a) => !is(a),
            Condition::Both(a, b) => is(a) && is(b),
            Condition::Either(a, b) => is(a) || is(b),
        }
    }

    /// Notes the events of this cycle.
    fn scan(&mut self) {
        for at in 0..self.interrupts.len() {
            let is = match self.interrupts[at].declared.cause {
                Cause::Condition(condition) => self.holds(condition, self.interrupts[at].locals),
                Cause::Time { .. } => false,
            };
            let (now, interrupt) = (self.now, &mut self.interrupts[at]);
            let happens = match interrupt.declared.cause {
                Cause::Condition(_) => is && !interrupt.was,
                Cause::Time { interval, repeats } => {
                    let due = interrupt.counts_from.is_some_and(|from| now == from + interval.max(1));
                    if due {
                        interrupt.counts_from = repeats.then_some(now);
                    }
                    due
                }
            };
            interrupt.was = is;
            if happens && interrupt.enabled && interrupt.event.is_none() {
                interrupt.event = Some(now);
            }
        }
    }

    /// The event to be handled first: by priority, then by arrival, then by declaration.
    fn first_event(&self) -> Option<usize> {
        let waiting = (0..self.interrupts.len()).filter(|at| self.interrupts[*at].event.is_some());
        waiting.min_by_key(|at| (self.interrupts[*at].declared.priority, self.interrupts[*at].event))
    }

    /// Begins an action where one of higher priority than what runs is due.
    fn interrupt(&mut self) {
        let Some(first) = self.first_event() else { return };
        let priority = self.interrupts[first].declared.priority;
        let now_running = self.running.last().and_then(|running| running.priority);
        if now_running.is_some_and(|running| running <= priority) {
            return;
        }
        self.interrupts[first].event = None;
        let (action, declared_in) = (self.interrupts[first].declared.action, self.interrupts[first].locals);
        let running = match action {
            Action::Run(script) => {
                self.locals.push([false; LOCALS]);
                Running::new(script, 0, self.locals.len() - 1)
            }
            Action::Turn(_) | Action::TurnLocal(_) => {
                Running { turns: Some(action), ..Running::new(0, DONE, declared_in) }
            }
        };
        self.running.push(Running { priority: Some(priority), ..running });
    }

    fn step(&mut self, script: usize, step: usize) -> Option<End> {
        let locals = self.running.last()?.locals;
        let alarm = Some(End::Alarm { script, step });
        match self.plan.scripts[script][step] {
            Step::Note(number) => _ = writeln!(self.out, "{number} {}", self.now),
            Step::Wait(ms) => {
                let until = self.now + ms;
                self.running.last_mut()?.waits_until = until;
            }
            Step::Await(condition, ms) => {
                let until = self.now + ms;
                let top = self.running.last_mut()?;
                (top.waits_until, top.waits_for) = (until, Some(condition));
            }
            Step::Set(flag, level) => self.flags[flag] = level,
            Step::SetLocal(local, level) => self.locals[locals][local] = level,
            Step::Exit => return Some(End::Ended),
            Step::Declare(declared) => {
                let taken = self.interrupts.iter().any(|it| it.declared.name == declared.name);
                if declared.priority > 255 || (declared.name.is_some() && taken) {
                    return alarm;
                }
                let was = match declared.cause {
                    Cause::Condition(condition) => self.holds(condition, locals),
                    Cause::Time { .. } => false,
                };
                let counts_from = Some(self.now);
                self.interrupts.push(Interrupt { declared, locals, enabled: true, event: None, was, counts_from });
            }
            Step::Switch { what, name, priority } => {
                let named = |it: &Interrupt| name.is_some() && it.declared.name == name;
                let ranked = |it: &Interrupt| Some(it.declared.priority) == priority;
                let all = name.is_none() && priority.is_none();
                if (name.is_some() && !self.interrupts.iter().any(named))
                    || (priority.is_some() && !self.interrupts.iter().any(ranked))
                {
                    return alarm;
                }
                let now = self.now;
                let meant = |it: &Interrupt| all || named(it) || ranked(it);
                match what {
                    Switch::Delete => self.interrupts.retain(|it| !meant(it)),
                    Switch::Disable => self.interrupts.iter_mut().filter(|it| meant(it)).for_each(|it| {
                        (it.enabled, it.event) = (false, None);
                    }),
                    Switch::Enable => self.interrupts.iter_mut().filter(|it| meant(it) && !it.enabled).for_each(|it| {
                        (it.enabled, it.counts_from) = (true, Some(now));
                    }),
                }
            }
        }
        None
    }
}
