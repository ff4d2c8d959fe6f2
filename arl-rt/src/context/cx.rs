//! A running program's view of the controller.
//!
//! A program is passed the context, and the context refers to the program, the other programs and the events that it
//! has declared: so this file, `program.rs`, `programs.rs` and `events.rs` import each other.

use std::any::Any;
use std::cell::{Cell, RefCell};
use std::fmt;
use std::pin::Pin;
use std::rc::Rc;
use std::task::{Context, Poll};

use crate::communication::Connections;
use crate::context::channel_state::ChannelState;
use crate::context::events::EventTable;
use crate::context::frames::Frames;
use crate::context::nesting::{Entered, Nesting};
use crate::context::output::Targets;
use crate::context::program::Program;
use crate::context::programs::Programs;
use crate::context::rounds::Rounds;
use crate::context::shared_state::SharedState;
use crate::context::standstill::{Waiting, WaitsFor};
use crate::context::system::System;
use crate::fault::{Alarm, Fault, File};
use crate::motion::Progress;
use crate::values::Str;
use arl_robot::robot::Family;

/// How many turns of loops that do not wait fit into one cycle. A turn takes a few nanoseconds at least, so that a
/// cycle without waiting takes some tens of microseconds.
const LOOP_TURNS_PER_CYCLE: i32 = 20_000;

/// A program's view of the controller: passed to every function that acts, moves or waits.
///
/// Everything here happens on the thread of the controller; nothing locks.
pub struct Cx {
    channel_state: Rc<ChannelState>,
    /// Turns of loops that are left in this cycle; below 0 where they did not suffice.
    budget: Cell<i32>,
    /// The address below which the stack must not grow.
    stack_floor: Cell<usize>,
    /// The calls of functions that may call themselves.
    nesting: Rc<Nesting>,
    program: Rc<dyn Program>,
    /// The program to run here next.
    next: RefCell<Option<Rc<dyn Program>>>,
    /// The programs of the controller.
    programs: Rc<Programs>,
    file: Cell<File>,
    line: Cell<u32>,
    /// Whether the current statement has been counted as a step.
    stepped: Cell<bool>,
    /// The kind of path with which the last motion may go on into the next.
    chained: Cell<u8>,
    /// Where `print` sends its messages until the program changes that.
    print_to: Cell<Targets>,
    /// The file that `print` writes to until the program changes that.
    print_file: RefCell<Str>,
    /// Whether the program has moved the robot.
    moved: Cell<bool>,
    /// The part of the program that runs: the program itself, the action of an event, a condition.
    level: Cell<Level>,
    /// The interrupts, timers and triggers that the program has declared.
    events: RefCell<EventTable>,
    /// The connections that the program has opened.
    connections: Connections,
    /// The motion that triggers are evaluated for, where that is not the one being executed.
    looked_at: Cell<Option<Progress>>,
    waiting: Waiting,
    /// The running functions, in programs that were made for a debugger.
    frames: Frames,
}

/// The part of the program that runs, and which motion it waits for.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Level {
    /// 0 for the program itself, 1 for the action that interrupts it, 2 for one that interrupts that.
    pub(crate) number: u32,
    /// For actions: the running number of the last motion of their own, 0 before the first.
    own_motion: Option<u64>,
}

/// The program pointer.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pointer {
    place: (File, u32),
    /// Whether the statement has been counted as a step.
    stepped: bool,
}

impl Level {
    /// The program itself: it waits for all motion.
    pub(crate) const PROGRAM: Self = Self { number: 0, own_motion: None };
    /// A condition that is evaluated: it waits for no motion.
    pub(crate) const CONDITION: Self = Self { number: u32::MAX, own_motion: Some(0) };

    /// The action of an event, `number` levels above the program: it waits for its own motion.
    pub(crate) fn action(number: u32) -> Self {
        Self { number, own_motion: Some(0) }
    }
}

impl Cx {
    pub(crate) fn new(channel_state: Rc<ChannelState>, program: Rc<dyn Program>, programs: Rc<Programs>) -> Self {
        let file = program.file();
        Self {
            channel_state,
            budget: Cell::new(LOOP_TURNS_PER_CYCLE),
            stack_floor: Cell::new(0),
            nesting: Rc::default(),
            program,
            next: RefCell::default(),
            programs,
            file: Cell::new(file),
            line: Cell::new(0),
            stepped: Cell::new(false),
            chained: Cell::new(0),
            print_to: Cell::default(),
            print_file: RefCell::default(),
            moved: Cell::new(false),
            level: Cell::new(Level::PROGRAM),
            events: RefCell::default(),
            connections: Connections::default(),
            looked_at: Cell::new(None),
            waiting: Waiting::default(),
            frames: Frames::default(),
        }
    }

    /// The running functions, in programs that were made for a debugger.
    pub(crate) fn frames(&self) -> &Frames {
        &self.frames
    }

    /// Sets the program pointer: the line whose statement runs now.
    #[inline]
    pub fn line(&self, file: File, line: u32) {
        self.file.set(file);
        self.line.set(line);
        self.stepped.set(false);
    }

    /// The file and line of the statement that runs now.
    #[inline]
    pub fn place(&self) -> (File, u32) {
        (self.file.get(), self.line.get())
    }

    /// The program pointer, for [`Cx::point_to`].
    pub(crate) fn pointer(&self) -> Pointer {
        Pointer { place: self.place(), stepped: self.stepped.get() }
    }

    /// Sets the program pointer back to `pointer`.
    pub(crate) fn point_to(&self, pointer: Pointer) {
        let (file, line) = pointer.place;
        self.line(file, line);
        self.stepped.set(pointer.stepped);
    }

    /// Counts one turn of a loop. True when the loop has to give the cycle back:
    /// `if cx.spend() { cx.next_cycle().await; }`.
    #[inline]
    pub fn spend(&self) -> bool {
        self.spend_rounds(1)
    }

    /// Counts `rounds` turns of loops, as [`Cx::spend`] counts one.
    #[inline]
    pub fn spend_rounds(&self, rounds: i32) -> bool {
        // Code that has too little left waits for the next cycle, which brings a whole budget: nothing wraps.
        let remaining = self.budget.get().wrapping_sub(rounds);
        self.budget.set(remaining);
        remaining < 0
    }

    /// Counts `rounds` turns of loops that have run without being counted. If they were too many, the next call that
    /// counts makes the program wait.
    #[inline]
    pub fn charge(&self, rounds: i32) {
        // Never far below 0, however often it is called before something waits: the next call that counts must not
        // wrap.
        self.budget.set(self.budget.get().saturating_sub(rounds).max(-1));
    }

    /// The turns of loops that are left in this cycle, for a loop in which nothing else counts.
    #[inline]
    pub fn rounds(&self) -> Rounds<'_> {
        Rounds { budget: &self.budget, remaining: self.budget.get() }
    }

    /// Waits for the next cycle.
    #[inline]
    pub fn next_cycle(&self) -> NextCycle<'_> {
        NextCycle { cx: self, from: self.cycle() }
    }

    /// Waits for the next cycle, in a loop that ends when something outside the program changes: `waituntil` with a
    /// condition that changes nothing itself. A run whose programs all wait like this and that nothing can change is at
    /// its end.
    #[inline]
    pub fn change(&self) -> NextCycle<'_> {
        self.wait_for(WaitsFor::Condition)
    }

    /// As `change`, for something else than a condition.
    #[inline]
    pub(crate) fn wait_for(&self, waits_for: WaitsFor) -> NextCycle<'_> {
        self.waiting.note(self.cycle(), waits_for);
        self.next_cycle()
    }

    /// Waits for the next cycle, in a loop that ends in that cycle by itself.
    #[inline]
    pub(crate) fn wait_until(&self, over: u64) -> NextCycle<'_> {
        self.waiting.note_time(self.cycle(), over);
        self.next_cycle()
    }

    /// Notes that something goes on in this cycle: the program does something, begins to wait, or evaluates something
    /// that changes by itself, like time.
    #[inline]
    pub fn goes_on(&self) {
        self.waiting.note_action(self.cycle());
    }

    /// What the program has waited for in `cycle`, where it did nothing else.
    pub(crate) fn waits_in(&self, cycle: u64) -> Option<WaitsFor> {
        self.waiting.in_cycle(cycle)
    }

    /// The cycle until which the program has waited in `cycle`, where it did nothing else.
    pub(crate) fn waits_until(&self, cycle: u64) -> Option<u64> {
        self.waiting.until(cycle)
    }

    /// The last cycle in which the program did something else than wait.
    pub(crate) fn acted(&self) -> u64 {
        self.waiting.acted()
    }

    /// The running number of the cycle, from 0.
    #[inline]
    pub fn cycle(&self) -> u64 {
        self.channel_state.shared.now.get()
    }

    /// The time of the controller in s: that of the start of this cycle.
    #[inline]
    pub fn time(&self) -> f64 {
        self.channel_state.shared.rate.time(self.cycle())
    }

    /// The length of a cycle in s.
    #[inline]
    pub fn period(&self) -> f64 {
        self.channel_state.shared.rate.period()
    }

    /// The system variables.
    #[inline]
    pub fn system(&self) -> &System {
        &self.channel_state.system
    }

    /// Enters a function that may call itself; the call counts until the result is dropped. `weight` is 1, and more for
    /// large functions; `bytes` is the size of the strings and arrays that were passed to it.
    ///
    /// # Errors
    /// [`Fault::Depth`]: nested calls weigh more than 20 000, or the stack of the thread is used up.
    /// [`Fault::DepthBytes`]: they hold more than 256 MiB.
    #[inline]
    pub fn enter(&self, weight: u32, bytes: usize) -> Result<Entered<&Nesting>, Fault> {
        self.has_stack()?;
        Nesting::enter(&*self.nesting, weight, bytes)
    }

    /// As [`Cx::enter`], for who keeps the result beside the context, and the function's variables not on the stack.
    ///
    /// # Errors
    /// As for [`Cx::enter`], whatever the stack of the thread has.
    pub fn enter_apart(&self, weight: u32, bytes: usize) -> Result<Entered<Rc<Nesting>>, Fault> {
        Nesting::enter(Rc::clone(&self.nesting), weight, bytes)
    }

    /// Checks that there is room on the stack for one more function.
    ///
    /// # Errors
    /// [`Fault::Depth`]: there is none.
    #[inline]
    pub fn has_stack(&self) -> Result<(), Fault> {
        if stack_pointer() < self.stack_floor.get() { Err(Fault::Depth) } else { Ok(()) }
    }

    /// The global variables of the running program. Their type `G` must be known, as it is to conditions and actions,
    /// which outlive the function that declares them.
    ///
    /// # Errors
    /// They are not a `G`.
    pub fn globals<G: Any>(&self) -> Result<&G, Fault> {
        let found = self.program.globals().downcast_ref();
        found.ok_or_else(|| Fault::Event("the interrupt belongs to another program".into()))
    }

    /// Gives the program a whole cycle's budget, and `stack` bytes of stack below the caller.
    pub(crate) fn start_cycle(&self, stack: usize) {
        if self.budget.replace(LOOP_TURNS_PER_CYCLE) < 0 {
            let full = &self.channel_state.full_cycles;
            full.set(full.get() + 1);
        }
        self.stack_floor.set(stack_pointer().saturating_sub(stack));
    }

    /// Gives the running code a whole cycle's budget; returns what was left of the old one.
    pub(crate) fn renew_budget(&self) -> i32 {
        self.budget.replace(LOOP_TURNS_PER_CYCLE)
    }

    /// Restores the budget that was left.
    pub(crate) fn restore_budget(&self, budget: i32) {
        self.budget.set(budget);
    }

    /// The interrupts, timers and triggers that the program has declared.
    pub(crate) fn events(&self) -> &RefCell<EventTable> {
        &self.events
    }

    /// The connections that the program has opened.
    pub(crate) fn connections(&self) -> &Connections {
        &self.connections
    }

    /// The progress of the motion being executed, or of the one that triggers are evaluated for.
    pub(crate) fn progress(&self) -> Option<Progress> {
        self.looked_at.get().or_else(|| self.channel_state.robot()?.progress())
    }

    /// Evaluates a condition with the progress of a motion when it ended.
    pub(crate) fn look_back<R>(&self, end: Progress, look: impl FnOnce() -> R) -> R {
        self.looked_at.set(Some(end));
        self.channel_state.set_progress_variables(&end);
        let result = look();
        self.looked_at.set(None);
        if let Some(now) = self.progress() {
            self.channel_state.set_progress_variables(&now);
        }
        result
    }

    /// The part of the program that runs.
    pub(crate) fn level(&self) -> Level {
        self.level.get()
    }

    /// Switches to another part of the program; returns the one before, for [`Cx::leave_level`].
    pub(crate) fn enter_level(&self, level: Level) -> Level {
        self.level.replace(level)
    }

    /// Switches back to the part that ran before.
    pub(crate) fn leave_level(&self, before: Level) {
        self.level.set(before);
    }

    /// Resets what the last run of the program has set.
    pub(crate) fn reset(&self) {
        self.print_to.take();
        self.print_file.take();
        self.moved.set(false);
        self.line.set(0);
        self.forget_events();
    }

    /// Drops all declared events; the program itself runs.
    pub(crate) fn forget_events(&self) {
        self.events.borrow_mut().clear();
        self.level.set(Level::PROGRAM);
    }

    /// The file that has the program's `main`.
    pub(crate) fn program(&self) -> File {
        self.program.file()
    }

    /// The program that runs.
    pub(crate) fn program_itself(&self) -> &dyn Program {
        &*self.program
    }

    /// Requests that another program run here.
    ///
    /// # Errors
    /// The program is for another family of robot, or another one is about to be loaded.
    pub(crate) fn load(&self, program: Rc<dyn Program>) -> Result<(), String> {
        if self.channel_state.robot().is_some_and(|unit| unit.robot().family != program.family()) {
            return Err(format!(
                "{} is for another family of robots than that of {}",
                program.file().name(),
                self.channel_state.id
            ));
        }
        let mut next = self.next.borrow_mut();
        if next.is_some() {
            return Err(format!("another program is being loaded into {}", self.channel_state.id));
        }
        *next = Some(program);
        Ok(())
    }

    /// Whether another program is about to be loaded.
    pub(crate) fn is_loading(&self) -> bool {
        self.next.borrow().is_some()
    }

    /// Takes the program to run here next.
    pub(crate) fn take_next(&self) -> Option<Rc<dyn Program>> {
        self.next.borrow_mut().take()
    }

    /// The programs of the controller.
    pub(crate) fn programs(&self) -> &Rc<Programs> {
        &self.programs
    }

    /// The family of robot that the program is for.
    pub(crate) fn family(&self) -> Family {
        self.program.family()
    }

    /// Whether the program has moved the robot yet.
    pub(crate) fn has_moved(&self) -> bool {
        self.moved.get()
    }

    /// Notes that the program has planned the motion with this running number.
    pub(crate) fn moved(&self, motion: u64) {
        self.moved.set(true);
        let level = self.level.get();
        self.level.set(Level { own_motion: level.own_motion.map(|_| motion), ..level });
        self.events.borrow_mut().bind(level.number, motion);
    }

    /// Notes the kind of path with which a motion may go on into the next, 0 for none; returns that of the motion
    /// before.
    pub(crate) fn chain(&self, kind: u8) -> u8 {
        self.chained.replace(kind)
    }

    /// The state that all channels share.
    #[inline]
    pub(crate) fn shared(&self) -> &SharedState {
        &self.channel_state.shared
    }

    /// The channel's own state.
    #[inline]
    pub(crate) fn channel_state(&self) -> &ChannelState {
        &self.channel_state
    }

    /// Ends the program with the alarm that this function needs a robot; it goes on with a default value until it
    /// waits.
    #[cold]
    pub(crate) fn without_robot<T: Default>(&self, function: &'static str) -> T {
        let (file, line) = self.place();
        self.channel_state.raise_alarm(Alarm::new(Fault::Background { function }, file, line));
        T::default()
    }

    /// Where `print` sends its messages until the program changes that, and the file that `file` stands for.
    pub(crate) fn print_to(&self) -> (&Cell<Targets>, &RefCell<Str>) {
        (&self.print_to, &self.print_file)
    }

    /// The running number of the motion that the next instruction follows; 0 where there is none. An action knows its
    /// own motions only.
    pub(crate) fn last_motion(&self) -> u64 {
        self.level.get().own_motion.unwrap_or_else(|| self.channel_state.motions().0)
    }

    /// Whether the motion to be waited for has ended: all motion, or, for actions, their own.
    #[inline]
    fn is_motion_over(&self) -> bool {
        match self.level.get().own_motion {
            None => self.channel_state.motion_ended_for(self.level.get().number),
            Some(own) => own == 0 || self.channel_state.has_motion_ended(own),
        }
    }

    /// Called before an instruction that moves, waits or accesses the outside: in single steps the program waits here
    /// until the instruction before has been completed, and for the button.
    pub(crate) async fn step_point(&self) {
        let stepping = &self.channel_state.stepping;
        if !stepping.on.get() || self.level.get().number != 0 || self.stepped.replace(true) {
            return;
        }
        while self.channel_state.has_pending_alarm() || !self.is_motion_over() {
            self.channel_state.conclude_motion();
            self.wait_for(WaitsFor::Motion).await;
        }
        if stepping.remaining.get() == 0 && stepping.on.get() {
            self.channel_state.paused.set(true);
            self.goes_on();
            self.next_cycle().await;
        }
        stepping.remaining.set(0);
    }

    /// In single steps: begins another step within the same instruction.
    pub(crate) async fn next_step(&self) {
        self.stepped.set(false);
        self.step_point().await;
    }

    /// Waits until all motion that the program has planned has ended; in the action of an event, all of its own.
    /// Without any motion the call still counts as a turn of a loop, so that a loop of such calls cannot hold up the
    /// controller.
    #[inline]
    pub(crate) async fn motion_end(&self) {
        if self.channel_state.stepping.on.get() {
            self.step_point().await;
        }
        if self.spend() {
            self.next_cycle().await;
        }
        if self.is_motion_over() {
            return;
        }
        self.channel_state.conclude_motion();
        self.goes_on();
        while self.channel_state.has_pending_alarm() || !self.is_motion_over() {
            self.wait_for(WaitsFor::Motion).await;
        }
    }
}

impl fmt::Debug for Cx {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Cx")
            .field("channel", &self.channel_state.id)
            .field("place", &self.place())
            .finish_non_exhaustive()
    }
}

/// The approximate address of the top of the stack. Stacks grow downwards on all platforms of this crate.
#[inline(always)]
fn stack_pointer() -> usize {
    let here = 0_u8;
    (&raw const here) as usize
}

/// Is ready in the cycle after the one in which it was made.
#[derive(Debug)]
#[must_use = "a future does nothing until it is awaited"]
pub struct NextCycle<'a> {
    cx: &'a Cx,
    from: u64,
}

impl<'a> NextCycle<'a> {
    /// The same wait, with values that are returned afterwards. A variable whose value is kept here need not live
    /// across the wait, so that the compiler can hold it in a register.
    #[inline]
    pub fn keeping<T: Copy>(self, values: T) -> Keeping<'a, T> {
        Keeping { next: self, values }
    }
}

/// Values that are ready in the next cycle.
#[derive(Debug)]
#[must_use = "a future does nothing until it is awaited"]
pub struct Keeping<'a, T> {
    next: NextCycle<'a>,
    values: T,
}

impl<T: Copy> Future for Keeping<'_, T> {
    type Output = T;

    #[inline]
    fn poll(self: Pin<&mut Self>, _: &mut Context<'_>) -> Poll<T> {
        if self.next.is_over() { Poll::Ready(self.values) } else { Poll::Pending }
    }
}

impl NextCycle<'_> {
    fn is_over(&self) -> bool {
        self.cx.cycle() != self.from
    }
}

impl Future for NextCycle<'_> {
    type Output = ();

    #[inline]
    fn poll(self: Pin<&mut Self>, _: &mut Context<'_>) -> Poll<()> {
        if self.is_over() { Poll::Ready(()) } else { Poll::Pending }
    }
}
