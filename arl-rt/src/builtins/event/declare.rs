//! `interrupt`, `timer` and `trigger`: declarations of events.

use std::rc::Rc;

use super::code::WatchedCode;
use super::scan::evaluate;
use crate::context::cx::Cx;
use crate::context::events::{Declaration, Source, Ticking, priority};
use crate::fault::{Done, Fault};
use crate::values::Str;

/// The shortest interval of a repeating timer, in s (manual 6.7).
const SHORTEST_INTERVAL_S: f64 = 0.001;

/// An event being declared: [`interrupt`], [`timer`] or [`trigger`].
#[must_use = "an instruction does nothing until it is run"]
pub struct EventDeclaration<W, A> {
    priority: i32,
    when: W,
    action: A,
}

/// The event of an interrupt: its condition.
pub struct Holds<C> {
    name: Option<Str>,
    condition: C,
}

/// The event of a timer: an interval in s, once or repeatedly.
pub struct Every {
    name: Option<Str>,
    interval: f64,
    repeats: bool,
}

/// The event of a trigger: its condition, during the next motion.
pub struct DuringMotion<C>(C);

/// `interrupt`: when the condition becomes true, the action runs. Both are passed the context.
pub fn interrupt<C, A>(when: C, action: A) -> EventDeclaration<Holds<C>, A>
where
    C: AsyncFn(&Cx) -> Done<bool> + 'static,
    A: AsyncFn(&Cx) -> Done<()> + 'static,
{
    EventDeclaration { priority: 0, when: Holds { name: None, condition: when }, action }
}

/// `timer`: when the interval is over, the action runs.
pub fn timer<A>(interval: f64, action: A) -> EventDeclaration<Every, A>
where
    A: AsyncFn(&Cx) -> Done<()> + 'static,
{
    EventDeclaration { priority: 0, when: Every { name: None, interval, repeats: false }, action }
}

/// `trigger`: when the condition becomes true during the next motion, the action runs. It has no name:
///
/// ```compile_fail,E0599
/// use arl_rt::emit::*;
/// event::trigger(async |_| Ok(true), async |_| Ok(())).name(&Str::new());
/// ```
pub fn trigger<C, A>(when: C, action: A) -> EventDeclaration<DuringMotion<C>, A>
where
    C: AsyncFn(&Cx) -> Done<bool> + 'static,
    A: AsyncFn(&Cx) -> Done<()> + 'static,
{
    EventDeclaration { priority: 10, when: DuringMotion(when), action }
}

impl<W, A> EventDeclaration<W, A> {
    /// The priority, 0 (first) to 255; the default is 0, for a trigger 10.
    pub fn priority(mut self, priority: i32) -> Self {
        self.priority = priority;
        self
    }
}

impl<C, A> EventDeclaration<Holds<C>, A>
where
    C: AsyncFn(&Cx) -> Done<bool> + 'static,
    A: AsyncFn(&Cx) -> Done<()> + 'static,
{
    /// Sets the name.
    pub fn name(mut self, name: &Str) -> Self {
        self.when.name = Some(name.clone());
        self
    }

    /// Monitors the condition from the next cycle on, until the end of the program or `delint`. A condition that holds
    /// now must first become false.
    ///
    /// # Errors
    /// The name is taken or empty, the priority is not within 0 to 255, there are too many events; the alarm of the
    /// condition.
    pub fn run(self, cx: &Cx) -> Result<(), Fault> {
        const FUNCTION: &str = "interrupt";
        let priority = priority(self.priority, FUNCTION)?;
        let code = Rc::new(WatchedCode { when: self.when.condition, action: self.action });
        let held = evaluate(cx, &*code).map_err(|problem| problem.fault(&format!("this {FUNCTION}")))?;
        let source = Source::Condition { held };
        let new = Declaration { name: self.when.name, priority, source, place: cx.place(), code };
        cx.events().borrow_mut().declare(FUNCTION, new)
    }
}

impl<A> EventDeclaration<Every, A>
where
    A: AsyncFn(&Cx) -> Done<()> + 'static,
{
    /// Sets the name.
    pub fn name(mut self, name: &Str) -> Self {
        self.when.name = Some(name.clone());
        self
    }

    /// Whether the timer repeats instead of running once.
    pub fn rmode(mut self, repeats: bool) -> Self {
        self.when.repeats = repeats;
        self
    }

    /// Starts the timer.
    ///
    /// # Errors
    /// The name is taken or empty, the priority is not within 0 to 255, the interval is below 0 s (below 0.001 s if it
    /// repeats) or not a number, there are too many events.
    pub fn run(self, cx: &Cx) -> Result<(), Fault> {
        const FUNCTION: &str = "timer";
        let priority = priority(self.priority, FUNCTION)?;
        let Every { name, interval, repeats } = self.when;
        let least = if repeats { SHORTEST_INTERVAL_S } else { 0.0 };
        if !interval.is_finite() || interval < least {
            let problem = format!("the interval is {interval} s, but must be {least} s or more");
            return Err(Fault::Domain { function: FUNCTION, problem: problem.into() });
        }
        let source = Source::Time(Ticking::new(interval, repeats, cx.cycle()));
        let code = Rc::new(WatchedCode { when: async |_: &Cx| Ok(false), action: self.action });
        let new = Declaration { name, priority, source, place: cx.place(), code };
        cx.events().borrow_mut().declare(FUNCTION, new)
    }
}

impl<C, A> EventDeclaration<DuringMotion<C>, A>
where
    C: AsyncFn(&Cx) -> Done<bool> + 'static,
    A: AsyncFn(&Cx) -> Done<()> + 'static,
{
    /// Attaches the trigger to the motion that is planned next.
    ///
    /// # Errors
    /// The priority is not within 0 to 255, or there are too many triggers for one motion.
    pub fn run(self, cx: &Cx) -> Result<(), Fault> {
        let priority = priority(self.priority, "trigger")?;
        let source = Source::Motion { number: 0, held: false, over: false };
        let code = Rc::new(WatchedCode { when: self.when.0, action: self.action });
        let new = Declaration { name: None, priority, source, place: cx.place(), code };
        cx.events().borrow_mut().declare_trigger(cx.level().number, new)
    }
}
