//! A channel: a program and how far it has come.

use std::pin::Pin;
use std::rc::Rc;
use std::task::{Context, Poll, Waker};

use super::Outcome;
use crate::cx::Cx;
use crate::data;
use crate::fault::{Alarm, Done, Reason, Stop};
use crate::program::Program;
use crate::world::World;

/// How many bytes of stack a program may use in one poll where nobody says otherwise: half of what a thread gets.
pub(super) const STACK: usize = 1 << 20;

/// A program that owns what it borrows from.
type Running = Pin<Box<dyn Future<Output = Done<()>>>>;

/// What the program does.
enum Phase {
    /// Its statements run.
    Running(Running),
    /// Its statements have ended; its motion and its pulses run to their end.
    RunningOut(Next),
    /// It has ended.
    Ended(Outcome),
}

/// What comes after the last motion.
#[derive(Clone)]
enum Next {
    Restart,
    End(Outcome),
}

/// A program and how far it has come.
pub(super) struct Channel {
    program: Rc<dyn Program>,
    cx: Rc<Cx>,
    stack: usize,
    phase: Phase,
}

impl Channel {
    /// A program that will start with the next cycle.
    pub(super) fn new(program: Rc<dyn Program>, cx: Rc<Cx>, stack: usize) -> Self {
        let phase = Phase::Running(load(Rc::clone(&program), Rc::clone(&cx)));
        Self { program, cx, stack, phase }
    }

    /// Starts the program from its beginning, global variables included.
    pub(super) fn reset(&mut self) {
        self.cx.reset();
        self.phase = Phase::Running(load(Rc::clone(&self.program), Rc::clone(&self.cx)));
    }

    pub(super) fn cx(&self) -> &Cx {
        &self.cx
    }

    /// How the program ended, when it has.
    pub(super) fn outcome(&self) -> Option<&Outcome> {
        match &self.phase {
            Phase::Ended(outcome) => Some(outcome),
            _ => None,
        }
    }

    /// Lets the program run until it waits.
    pub(super) fn poll(&mut self, world: &World) {
        if let Phase::Running(running) = &mut self.phase {
            self.cx.start_cycle(self.stack);
            let mut context = Context::from_waker(Waker::noop());
            if let Poll::Ready(done) = running.as_mut().poll(&mut context) {
                let next = match done.map_err(Stop::reason) {
                    Ok(()) | Err(Reason::Exit) => Next::End(Outcome::Ended),
                    Err(Reason::Restart) => Next::Restart,
                    Err(Reason::Alarm(alarm)) => failed(world, alarm),
                };
                self.phase = Phase::RunningOut(next);
            }
        }
        if let Phase::RunningOut(next) = &self.phase {
            let moving = !world.motion_ended();
            if moving {
                world.conclude_motion();
            }
            self.phase = match next {
                Next::Restart if moving => return,
                // It starts in the next cycle, so that a program of nothing but `restart` does not hold up the others.
                Next::Restart => Phase::Running(again(Rc::clone(&self.program), Rc::clone(&self.cx))),
                Next::End(Outcome::Ended) if moving || world.io.borrow().pulsing() => return,
                Next::End(_) if moving => return,
                Next::End(outcome) => Phase::Ended(outcome.clone()),
            };
        }
    }

    /// Ends the program with an alarm that did not come from its statements.
    pub(super) fn fail(&mut self, world: &World, alarm: Alarm) {
        if !matches!(self.phase, Phase::Ended(_)) {
            self.phase = Phase::RunningOut(failed(world, alarm));
        }
    }

    /// Ends the program where it is and stops its motion on the path.
    pub(super) fn end(&mut self, world: &World, outcome: Outcome) {
        if !matches!(self.phase, Phase::Ended(_)) {
            world.stop_motion();
            world.paused.set(false);
            self.phase = Phase::RunningOut(Next::End(outcome));
        }
    }
}

/// Stops for an alarm.
fn failed(world: &World, alarm: Alarm) -> Next {
    world.stop_motion();
    world.paused.set(false);
    world.alarms.borrow_mut().insert(0, alarm.clone());
    Next::End(Outcome::Alarm(alarm))
}

/// The whole life of a program.
fn load(program: Rc<dyn Program>, cx: Rc<Cx>) -> Running {
    Box::pin(async move {
        program.init(&cx).await?;
        let world = cx.world();
        let mut alarms = data::reload(&*program, world.scripts.path()).into_iter();
        if let Some(first) = alarms.next() {
            // The first one ends the program, and is noted then; all of them come to the user.
            world.alarms.borrow_mut().extend(alarms);
            return Err(Stop::alarm(first));
        }
        program.main(&cx).await
    })
}

/// The program after `restart`: its global variables keep their values.
fn again(program: Rc<dyn Program>, cx: Rc<Cx>) -> Running {
    Box::pin(async move { program.main(&cx).await })
}
