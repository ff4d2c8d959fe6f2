//! A channel: a program and how far it has come.

use std::rc::Rc;
use std::task::{Context, Poll, Waker};

use super::Outcome;
use super::actions::Actions;
use crate::cx::{Cx, Level};
use crate::data;
use crate::event;
use crate::fault::{Alarm, Reason, Stop};
use crate::program::{Program, Running};
use crate::world::World;

/// How many bytes of stack a program may use in one poll where nobody says otherwise: half of what a thread gets.
pub(super) const STACK: usize = 1 << 20;

/// What the program does.
enum Phase {
    /// Its statements run.
    Running(Running),
    /// Its statements have ended; its motion and its pulses run to their end, and events are still handled.
    Concluding,
    /// It was ended; its motion runs to its end.
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
    actions: Actions,
}

impl Channel {
    /// A program that will start with the next cycle.
    pub(super) fn new(program: Rc<dyn Program>, cx: Rc<Cx>, stack: usize) -> Self {
        let phase = Phase::Running(load(Rc::clone(&program), Rc::clone(&cx)));
        Self { program, cx, stack, phase, actions: Actions::default() }
    }

    /// Starts the program from its beginning, global variables included.
    pub(super) fn reset(&mut self) {
        self.cx.reset();
        self.actions.clear();
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

    /// Looks for events, then lets the program and the actions of events run until they wait.
    pub(super) fn poll(&mut self, world: &World) {
        if matches!(self.phase, Phase::Running(_) | Phase::Concluding) {
            self.cx.start_cycle(self.stack);
            let mut done = event::scan(&self.cx).map_err(Reason::Alarm).and_then(|()| self.run(world));
            while let Err(reason) = done {
                self.leave(world, reason);
                // After `exit` the motion that is left may have triggers.
                let concludes = matches!(self.phase, Phase::Concluding);
                done = if concludes { self.run(world) } else { Ok(()) };
            }
        }
        if let Phase::RunningOut(next) = &self.phase {
            let moving = !world.motion_ended();
            if moving {
                world.conclude_motion();
            }
            self.phase = match next {
                _ if moving || !self.cx.connections().are_settled() => return,
                // It starts in the next cycle, so that a program of nothing but `restart` does not hold up the others.
                Next::Restart => Phase::Running(again(Rc::clone(&self.program), Rc::clone(&self.cx))),
                Next::End(outcome) => Phase::Ended(outcome.clone()),
            };
        }
    }

    /// Runs what is on top until it waits; what has ended makes room for what it interrupted.
    fn run(&mut self, world: &World) -> Result<(), Reason> {
        let mut context = Context::from_waker(Waker::noop());
        loop {
            // While the program is paused nothing of it begins.
            if !world.paused.get() {
                self.actions.begin(&self.cx);
            }
            let polled = match (self.actions.poll(&self.cx, &mut context), &mut self.phase) {
                (Some(polled), _) => polled,
                (None, Phase::Running(program)) => {
                    let polled = program.as_mut().poll(&mut context);
                    if let Poll::Ready(Ok(())) = polled {
                        self.phase = Phase::Concluding;
                    }
                    polled
                }
                (None, _) => {
                    if self.is_concluded(world) {
                        self.end_with(Next::End(Outcome::Ended));
                    }
                    Poll::Pending
                }
            };
            match polled {
                Poll::Ready(Ok(())) => {}
                Poll::Ready(Err(stop)) => return Err(stop.reason()),
                Poll::Pending => return Ok(()),
            }
        }
    }

    /// Whether nothing is left to be done once the statements have ended.
    fn is_concluded(&self, world: &World) -> bool {
        let moving = !world.motion_ended();
        if moving {
            world.conclude_motion();
        }
        if moving || world.io.borrow().pulsing() || self.cx.events().borrow().has_due() {
            return false;
        }
        self.cx.connections().close();
        self.cx.connections().are_settled()
    }

    /// Ends the program for a reason that came from its statements.
    fn leave(&mut self, world: &World, reason: Reason) {
        match reason {
            // Motion that is planned keeps its triggers.
            Reason::Exit => {
                self.cx.events().borrow_mut().keep_to_motions();
                self.actions.clear();
                self.cx.leave_level(Level::PROGRAM);
                self.phase = Phase::Concluding;
            }
            Reason::Restart => self.end_with(Next::Restart),
            Reason::Alarm(alarm) => self.end_with(failed(world, alarm)),
        }
    }

    /// Ends the program and all that it has declared.
    fn end_with(&mut self, next: Next) {
        self.actions.clear();
        self.cx.forget_events();
        self.cx.connections().close();
        self.phase = Phase::RunningOut(next);
    }

    /// Ends the program with an alarm that did not come from its statements.
    pub(super) fn fail(&mut self, world: &World, alarm: Alarm) {
        if !matches!(self.phase, Phase::Ended(_)) {
            self.end_with(failed(world, alarm));
        }
    }

    /// Ends the program where it is and stops its motion on the path.
    pub(super) fn end(&mut self, world: &World, outcome: Outcome) {
        if !matches!(self.phase, Phase::Ended(_)) {
            world.stop_motion();
            world.paused.set(false);
            self.end_with(Next::End(outcome));
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
