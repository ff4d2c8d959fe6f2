//! What a running program sees of the controller.

use std::cell::{Cell, RefCell};
use std::pin::Pin;
use std::rc::Rc;
use std::task::{Context, Poll};

use crate::fault::{Fault, File};
use crate::system::System;
use crate::text::print::Targets;
use crate::values::Str;
use crate::world::World;

/// How many turns of loops that do not wait fit into one cycle. A turn is a few nanoseconds at least, so that a cycle
/// without waiting takes some tens of microseconds.
const BUDGET: u32 = 20_000;

/// The view of the controller that a program has: passed to every function that acts, moves or waits.
///
/// Everything here happens on the thread of the controller; nothing locks.
#[derive(Debug)]
pub struct Cx {
    world: Rc<World>,
    /// Turns of loops that are left in this cycle.
    budget: Cell<u32>,
    /// The address below which the stack must not grow.
    stack_floor: Cell<usize>,
    /// The program's own file.
    program: File,
    file: Cell<File>,
    line: Cell<u32>,
    /// Where `print` sends its messages until it is told otherwise.
    print_to: Cell<Targets>,
    /// The file that `print` writes to until it is told otherwise.
    print_file: RefCell<Str>,
    /// Whether the program has moved the robot.
    moved: Cell<bool>,
}

impl Cx {
    pub(crate) fn new(world: Rc<World>, file: File) -> Self {
        Self {
            world,
            budget: Cell::new(BUDGET),
            stack_floor: Cell::new(0),
            program: file,
            file: Cell::new(file),
            line: Cell::new(0),
            print_to: Cell::default(),
            print_file: RefCell::default(),
            moved: Cell::new(false),
        }
    }

    /// Sets the program pointer: the line whose statement runs now.
    #[inline]
    pub fn line(&self, file: File, line: u32) {
        self.file.set(file);
        self.line.set(line);
    }

    /// The file and line of the statement that runs now.
    #[inline]
    pub fn place(&self) -> (File, u32) {
        (self.file.get(), self.line.get())
    }

    /// Counts one turn of a loop. True when the loop has to give the cycle back:
    /// `if cx.spend() { cx.next_cycle().await; }`.
    #[inline]
    pub fn spend(&self) -> bool {
        self.spend_rounds(1)
    }

    /// Counts so many turns of loops, as [`Cx::spend`] counts one.
    #[inline]
    pub fn spend_rounds(&self, rounds: u32) -> bool {
        let left = self.budget.get();
        // One instruction: whoever has too little left waits for the next cycle, which brings a whole budget.
        self.budget.set(left.wrapping_sub(rounds));
        left < rounds
    }

    /// Waits for the next cycle.
    #[inline]
    pub fn next_cycle(&self) -> NextCycle<'_> {
        NextCycle { cx: self, from: self.cycle() }
    }

    /// The running number of the cycle, from 0.
    #[inline]
    pub fn cycle(&self) -> u64 {
        self.world.now.get()
    }

    /// The time of the controller in s: that of the start of this cycle.
    #[inline]
    pub fn time(&self) -> f64 {
        self.world.rate.time(self.cycle())
    }

    /// The length of a cycle in s.
    #[inline]
    pub fn period(&self) -> f64 {
        self.world.rate.period()
    }

    /// The system variables.
    #[inline]
    pub fn system(&self) -> &System {
        &self.world.system
    }

    /// Checks that there is room on the stack for one more function. Functions ask before they call themselves.
    ///
    /// # Errors
    /// [`Fault::Depth`]: functions call each other too deep.
    #[inline]
    pub fn enter(&self) -> Result<(), Fault> {
        if stack_pointer() < self.stack_floor.get() { Err(Fault::Depth) } else { Ok(()) }
    }

    /// Gives the program a whole cycle's budget, and so many bytes of stack below the caller.
    pub(crate) fn start_cycle(&self, stack: usize) {
        self.budget.set(BUDGET);
        self.stack_floor.set(stack_pointer().saturating_sub(stack));
    }

    /// Forgets what the program before has set.
    pub(crate) fn reset(&self) {
        self.print_to.take();
        self.print_file.take();
        self.moved.set(false);
        self.line.set(0);
    }

    /// The program's own file.
    pub(crate) fn program(&self) -> File {
        self.program
    }

    /// Whether the program has moved the robot yet.
    pub(crate) fn has_moved(&self) -> bool {
        self.moved.get()
    }

    /// Notes that the program has moved the robot.
    pub(crate) fn moved(&self) {
        self.moved.set(true);
    }

    pub(crate) fn world(&self) -> &World {
        &self.world
    }

    /// Where `print` sends its messages until it is told otherwise, and which file is meant by `file`.
    pub(crate) fn print_to(&self) -> (&Cell<Targets>, &RefCell<Str>) {
        (&self.print_to, &self.print_file)
    }

    /// Waits until all motion that the program has planned has ended. Where there is none, it still counts as a turn
    /// of a loop, so that a loop of such calls cannot hold up the controller.
    #[inline]
    pub(crate) async fn motion_end(&self) {
        if self.spend() {
            self.next_cycle().await;
        }
        if self.world.motion_ended() {
            return;
        }
        self.world.conclude_motion();
        while self.world.in_trouble() || !self.world.motion_ended() {
            self.next_cycle().await;
        }
    }
}

/// The address of about the top of the stack. Stacks grow downwards wherever this crate runs.
#[inline(always)]
fn stack_pointer() -> usize {
    let here = 0_u8;
    (&raw const here) as usize
}

/// Ready in the cycle after the one in which it was made.
#[derive(Debug)]
#[must_use = "a future does nothing until it is awaited"]
pub struct NextCycle<'a> {
    cx: &'a Cx,
    from: u64,
}

impl<'a> NextCycle<'a> {
    /// The same, with values that are given back afterwards. A variable whose value is kept here need not live across
    /// the wait, so that the compiler can have it in a register.
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
