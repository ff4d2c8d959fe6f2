//! A channel: a program, its progress, and its robot.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::rc::Rc;
use std::task::{Context, Poll, Waker};

use super::actions::Actions;
use super::{Outcome, State};
use crate::builtins::event;
use crate::context::channel_state::ChannelState;
use crate::context::cx::{Cx, Level};
use crate::context::program::{Program, RunningProgram};
use crate::context::programs::Programs;
use crate::context::standstill::WaitsFor;
use crate::controller::trace::Trace;
use crate::fault::{Alarm, Fault, Reason, Stop};
use crate::storage::data;
use crate::storage::pointers::CurrentPointers;
use crate::unit::RobotCycle;

/// How many bytes of stack a program may use in one poll by default: half of what a thread gets.
pub(super) const PROGRAM_STACK_BYTES: usize = 1 << 20;

/// After this many cycles of rest the program has seen that its robot rests: the one in which it came to rest, and one
/// more.
const SEEN_AT_REST: u32 = 2;

/// After this many cycles of rest a robot has settled, and further cycles change nothing in its state.
const LONG_AT_REST: u32 = 64;

/// The phase of the program.
enum Phase {
    /// Its statements run.
    Running(RunningProgram),
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
    /// The program begins again after a reset: the loop running mode.
    Again,
    End(Outcome),
}

/// The state of a program that does nothing by itself.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Repose {
    /// It has ended.
    Ended,
    /// It waits for something that does not come by itself.
    Waiting(WaitsFor),
}

/// A program, its progress, and its robot.
pub(super) struct Channel {
    channel_state: Rc<ChannelState>,
    program: Rc<dyn Program>,
    cx: Rc<Cx>,
    stack: usize,
    phase: Phase,
    actions: Actions,
    /// The alarm of an event's condition in this cycle.
    seen: Result<(), Alarm>,
    trace: Option<Trace>,
    /// Whether the program ran at the start of this cycle.
    running: bool,
    /// Whether it has come to `exit`.
    exits: bool,
    /// For how many cycles its robot has had nothing to do.
    rested: u32,
    /// The number of the controller's cycles after which it last ended.
    ended_after: u64,
}

impl Channel {
    /// A program that will start with the next cycle.
    pub(super) fn new(
        channel_state: Rc<ChannelState>,
        program: Rc<dyn Program>,
        programs: Rc<Programs>,
        stack: usize,
        trace: Option<Trace>,
    ) -> Self {
        let cx = Rc::new(Cx::new(Rc::clone(&channel_state), Rc::clone(&program), programs));
        let phase = Phase::Running(load(Rc::clone(&program), Rc::clone(&cx)));
        let actions = Actions::default();
        Self {
            channel_state,
            program,
            cx,
            stack,
            phase,
            actions,
            seen: Ok(()),
            trace,
            running: true,
            exits: false,
            rested: 0,
            ended_after: 0,
        }
    }

    /// Starts the program from its beginning, global variables included. Pulses end, and the system variables of the
    /// manual's chapter 10.2 get their defaults; the robot stays where it is.
    pub(super) fn reset(&mut self) {
        self.channel_state.shared.io.borrow_mut().end_pulses(self.channel_state.index);
        if let Some(mut unit) = self.channel_state.robot_mut() {
            unit.reset();
            self.channel_state.paused.set(!unit.has_servo());
        }
        self.exits = false;
        self.channel_state.stepping.on.set(false);
        self.channel_state.stepping.until.set(None);
        self.channel_state.reset_system();
        self.channel_state.alarmed.set(false);
        self.cx.reset();
        self.actions.clear();
        self.phase = Phase::Running(load(Rc::clone(&self.program), Rc::clone(&self.cx)));
    }

    pub(super) fn cx(&self) -> &Rc<Cx> {
        &self.cx
    }

    /// The global variables of its program, where they are of this type.
    pub(super) fn globals<G: 'static>(&self) -> Option<&G> {
        self.program.globals().downcast_ref()
    }

    pub(super) fn channel_state(&self) -> &ChannelState {
        &self.channel_state
    }

    /// The program and motion pointers, where they are not the stored ones.
    pub(super) fn pointers(&self) -> CurrentPointers {
        let motion = self.channel_state.robot().and_then(|unit| unit.motion_pointer());
        CurrentPointers { program: self.channel_state.begun.get().then(|| self.cx.place()), motion }
    }

    /// Whether the program ran in the last cycle.
    pub(super) fn ran(&self) -> bool {
        self.running
    }

    /// What the program does at the moment.
    pub(super) fn state(&self) -> State {
        match self.phase {
            Phase::Ended(_) if !self.cx.is_loading() => State::Ended,
            _ if self.channel_state.paused.get() => State::Paused,
            _ => State::Running,
        }
    }

    /// The number of the controller's cycles after which the program ended; `None` while it runs.
    pub(super) fn ended_after(&self) -> Option<u64> {
        matches!(self.phase, Phase::Ended(_)).then_some(self.ended_after)
    }

    /// How the program ended; `None` while it runs.
    pub(super) fn outcome(&self) -> Option<&Outcome> {
        match &self.phase {
            Phase::Ended(outcome) if !self.cx.is_loading() => Some(outcome),
            _ => None,
        }
    }

    /// The state of the program in `cycle`, the last one, if neither the program nor its robot did anything in it.
    pub(super) fn repose(&self, cycle: u64) -> Option<Repose> {
        if self.outcome().is_some() {
            return Some(Repose::Ended);
        }
        let paused = self.channel_state.paused.get();
        let is_at_zero = || self.channel_state.robot().is_some_and(|unit| unit.is_at_zero_override() && unit.moves());
        let waits_for = match self.phase {
            Phase::Running(_) | Phase::Concluding if paused => WaitsFor::StartButton,
            Phase::Running(_) => self.cx.waits_in(cycle)?,
            Phase::Concluding if !self.actions.is_empty() => self.cx.waits_in(cycle)?,
            // The statements have ended; an interrupt may still start the stopped motion.
            Phase::Concluding => WaitsFor::Motion,
            Phase::RunningOut(_) if is_at_zero() => WaitsFor::Motion,
            Phase::RunningOut(_) | Phase::Ended(_) => return None,
        };
        (!self.goes_on(cycle)).then(|| match waits_for {
            WaitsFor::Motion if is_at_zero() => Repose::Waiting(WaitsFor::Override),
            waits_for => Repose::Waiting(waits_for),
        })
    }

    /// Whether anything of this channel was under way in `cycle`, the last one, besides what its program waits for.
    fn goes_on(&self, cycle: u64) -> bool {
        let paused = self.channel_state.paused.get();
        self.cx.is_loading()
            || self.channel_state.has_pending_alarm()
            || self.cx.events().borrow().ticks()
            || (self.actions.is_empty() && !paused && self.cx.events().borrow().has_due())
            || self.cx.acted() >= cycle
            || (self.channel_state.robot().is_some() && self.rested < SEEN_AT_REST)
    }

    /// The cycle before which nothing of this channel changes by itself, judged by `cycle`, the last one. A trace has a
    /// row for each cycle, so a channel that writes one returns `None`.
    pub(super) fn quiet_until(&self, cycle: u64) -> Option<u64> {
        let waits_for_time = || {
            let runs = matches!(self.phase, Phase::Running(_)) && !self.channel_state.paused.get();
            self.cx.waits_until(cycle).filter(|_| runs && !self.goes_on(cycle))
        };
        let until = self.repose(cycle).map(|_| u64::MAX).or_else(waits_for_time)?;
        let has_rows = self.trace.is_some() && self.running;
        let stands = self.channel_state.robot().is_none_or(|unit| self.rested >= LONG_AT_REST && unit.is_quiet());
        (stands && !has_rows).then_some(until)
    }

    /// Checks the conditions of events.
    pub(super) fn scan_events(&mut self) {
        self.running = self.outcome().is_none();
        self.seen = if self.has_statements() {
            self.cx.start_cycle(self.stack);
            self.or_end(|channel| event::scan(&channel.cx))
        } else {
            Ok(())
        };
    }

    /// Exchanges the program where another one is to be loaded and this one has ended.
    fn exchange(&mut self) {
        self.end(Outcome::Stopped);
        if matches!(self.phase, Phase::Ended(_))
            && let Some(program) = self.cx.take_next()
        {
            self.program = program;
            let programs = Rc::clone(self.cx.programs());
            self.cx = Rc::new(Cx::new(Rc::clone(&self.channel_state), Rc::clone(&self.program), programs));
            self.cx.programs().exchange(self.channel_state.index, &self.cx);
            self.reset();
        }
    }

    /// Lets the program and the actions of events run until they wait.
    pub(super) fn poll(&mut self) {
        if self.cx.is_loading() {
            self.exchange();
        }
        if self.has_statements() && self.channel_state.robot_mut().is_some_and(|mut unit| unit.take_beyond()) {
            self.leave(Reason::Restart);
        }
        if self.has_statements() && self.channel_state.paused.get() && self.seen.is_ok() {
            return;
        }
        if self.has_statements() {
            self.channel_state.begun.set(true);
            self.cx.start_cycle(self.stack);
            let seen = std::mem::replace(&mut self.seen, Ok(()));
            let mut done = seen.map_err(Reason::Alarm).and_then(|()| self.or_end(Self::run));
            while let Err(reason) = done {
                self.leave(reason);
                // After `exit` the remaining motion may have triggers.
                let concludes = matches!(self.phase, Phase::Concluding);
                done = if concludes { self.or_end(Self::run) } else { Ok(()) };
            }
        }
        if let Phase::RunningOut(next) = &self.phase {
            let moving = !self.channel_state.motion_ended();
            if moving {
                self.channel_state.conclude_motion();
            }
            self.phase = match next {
                _ if moving || !self.cx.connections().are_settled() => return,
                // The program starts in the next cycle, so that one that only does `restart` does not hold up the
                // others.
                Next::Restart => Phase::Running(again(Rc::clone(&self.program), Rc::clone(&self.cx))),
                Next::Again => {
                    let steps = self.channel_state.stepping.on.get();
                    self.reset();
                    self.channel_state.stepping.on.set(steps);
                    return;
                }
                Next::End(outcome) => {
                    self.ended_after = self.channel_state.shared.now.get() + 1;
                    Phase::Ended(outcome.clone())
                }
            };
            self.cx.goes_on();
        }
    }

    /// Whether statements or the actions of events may run.
    fn has_statements(&self) -> bool {
        matches!(self.phase, Phase::Running(_) | Phase::Concluding)
    }

    /// One step of the robot and of its trace, at `time` in s.
    pub(super) fn step_robot(&mut self, time: f64, robot_cycle: RobotCycle) {
        let Some(mut unit) = self.channel_state.robot_mut() else { return };
        unit.step(robot_cycle);
        let goes_on = unit.moves() && !self.channel_state.paused.get() && !unit.is_at_zero_override();
        let rests = unit.rests() && !goes_on;
        self.rested = if rests { self.rested.saturating_add(1) } else { 0 };
        self.channel_state.update_system(&unit);
        let mut image = self.channel_state.shared.io.borrow_mut();
        image.motions_ended(self.channel_state.index, |motion| unit.has_ended(motion));
        if let Some(trace) = &mut self.trace
            && self.running
        {
            trace.row(time, &unit);
        }
        // A step that executes motion planned earlier ends with that motion.
        if self.channel_state.stepping.until.get().is_some_and(|motion| unit.is_over(motion)) {
            self.channel_state.stepping.until.set(None);
            self.channel_state.paused.set(true);
            self.cx.goes_on();
            unit.pause();
        }
    }

    /// Ends the program for a fault that did not come from its statements.
    pub(super) fn handle_pending_alarm(&mut self) {
        self.channel_state.warn_of_missing_blends(self.cx.shared());
        if let Some(alarm) = self.channel_state.take_pending_alarm() {
            self.fail(alarm);
        }
    }

    /// Ends the program before it acts on lost inputs. A program without a robot goes on.
    pub(super) fn fail_for_lost_io(&mut self, why: &str) {
        if self.channel_state.robot().is_some() && self.has_statements() {
            let (file, line) = self.cx.place();
            self.fail(Alarm::new(Fault::IoLost(why.into()), file, line));
        }
    }

    /// Ends the program where the robot has collided.
    pub(super) fn handle_collision(&mut self) {
        if let Some(alarm) = self.channel_state.collision(self.cx.place()) {
            self.fail(alarm);
        }
    }

    /// Ends the program where its robot had to do without set-points. A program without a robot goes on.
    pub(super) fn fail_for_lost_cycles(&mut self, why: &str) {
        if self.channel_state.robot().is_some() && !matches!(self.phase, Phase::Ended(_)) {
            let (file, line) = self.cx.place();
            self.alarm(Alarm::new(Fault::Late(why.into()), file, line));
        }
    }

    /// Ends the program where the robot does not do what it is asked for.
    pub(super) fn handle_robot_fault(&mut self) {
        if let Some(alarm) = self.channel_state.robot_alarm(self.cx.place()) {
            self.alarm(alarm);
        }
    }

    /// Ends the program with an alarm, which is also reported where the program has ended already.
    fn alarm(&mut self, alarm: Alarm) {
        if matches!(self.phase, Phase::Ended(_) | Phase::RunningOut(Next::End(Outcome::Alarm(_)))) {
            // The outcome of the program does not change.
            self.channel_state.alarmed.set(true);
            self.channel_state.shared.alarm(Alarm { channel: self.channel_state.id, ..alarm }, false);
        } else {
            self.fail(alarm);
        }
    }

    /// Does what is due in the cycle in which the program has ended.
    pub(super) fn finish_cycle(&mut self) {
        if !self.running || self.outcome().is_none() {
            return;
        }
        self.channel_state.shared.io.borrow_mut().end_pulses(self.channel_state.index);
        self.flush_trace();
    }

    /// Writes out what is buffered of the trace; before the first cycle, its first line.
    pub(super) fn flush_trace(&mut self) {
        if let Some(trace) = &mut self.trace
            && let Err(error) = trace.flush()
        {
            self.channel_state.shared.warn(format!("the trace cannot be written: {error}"));
        }
    }

    /// Runs code of the program. A panic, in a program in Rust, ends the program before it goes on to the caller of the
    /// controller's step: otherwise the program would panic in every cycle.
    fn or_end<T>(&mut self, run: impl FnOnce(&mut Self) -> T) -> T {
        catch_unwind(AssertUnwindSafe(|| run(self))).unwrap_or_else(|panic| {
            self.end(Outcome::Stopped);
            resume_unwind(panic)
        })
    }

    /// Runs the topmost action or the program until it waits; an action that has ended makes room for what it
    /// interrupted.
    fn run(&mut self) -> Result<(), Reason> {
        let mut context = Context::from_waker(Waker::noop());
        loop {
            // While the program is paused no action begins.
            if !self.channel_state.paused.get() {
                self.actions.begin(&self.cx);
            }
            let polled = match (self.actions.poll(&self.cx, &mut context), &mut self.phase) {
                (Some(polled), _) => polled,
                (None, Phase::Running(program)) => {
                    let polled = program.as_mut().poll(&mut context);
                    if let Poll::Ready(Ok(())) = polled {
                        self.phase = Phase::Concluding;
                        self.cx.goes_on();
                    }
                    polled
                }
                (None, _) => {
                    if self.is_concluded() {
                        let again = self.channel_state.repeats.get() && !self.exits;
                        self.end_with(if again { Next::Again } else { Next::End(Outcome::Ended) });
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

    /// Whether nothing is left to do once the statements have ended.
    fn is_concluded(&self) -> bool {
        let channel_state = &self.channel_state;
        if !self.cx.events().borrow().watches() && channel_state.drop_suspended() {
            channel_state
                .shared
                .warn("the program has ended while its motion was stopped: that motion is dropped".into());
        }
        let moving = !channel_state.motion_ended();
        if moving {
            channel_state.conclude_motion();
        }
        if moving
            || channel_state.shared.io.borrow().pulsing(channel_state.index)
            || self.cx.events().borrow().has_due()
        {
            return false;
        }
        self.cx.connections().close();
        self.cx.connections().are_settled()
    }

    /// Ends the program for a reason that came from its statements.
    fn leave(&mut self, reason: Reason) {
        // No statement is left that could start the stopped motion.
        self.channel_state.drop_suspended();
        match reason {
            // Planned motion keeps its triggers.
            Reason::Exit => {
                self.exits = true;
                self.cx.events().borrow_mut().keep_to_motions();
                self.actions.clear();
                self.cx.leave_level(Level::PROGRAM);
                self.phase = Phase::Concluding;
                self.cx.goes_on();
            }
            Reason::Restart => self.end_with(Next::Restart),
            Reason::Alarm(alarm) => self.fail(alarm),
        }
    }

    /// Ends the program and drops all events and connections that it has declared.
    fn end_with(&mut self, next: Next) {
        self.actions.clear();
        self.cx.forget_events();
        self.cx.connections().close();
        self.phase = Phase::RunningOut(next);
        self.cx.goes_on();
    }

    /// Ends the program with an alarm: its robot stops on its path.
    fn fail(&mut self, alarm: Alarm) {
        if !matches!(self.phase, Phase::Ended(_)) {
            let alarm = Alarm { channel: self.channel_state.id, ..alarm };
            self.channel_state.alarmed.set(true);
            if let Some(watcher) = self.channel_state.shared.watcher() {
                watcher.alarm(&alarm);
            }
            self.channel_state.shared.alarm(alarm.clone(), true);
            self.end(Outcome::Alarm(alarm));
        }
    }

    /// Ends the program from outside, and drops the one that was to run next.
    pub(super) fn stop(&mut self) {
        drop(self.cx.take_next());
        self.end(Outcome::Stopped);
    }

    /// Ends the program where it is and stops its motion on the path. Where an alarm is already ending it, that stays
    /// its outcome.
    pub(super) fn end(&mut self, outcome: Outcome) {
        let outcome = match &self.phase {
            Phase::RunningOut(Next::End(alarm @ Outcome::Alarm(_))) => alarm.clone(),
            _ => outcome,
        };
        if !matches!(self.phase, Phase::Ended(_)) {
            self.channel_state.stop_motion();
            self.channel_state.paused.set(false);
            self.end_with(Next::End(outcome));
        }
    }
}

/// The whole run of a program.
fn load(program: Rc<dyn Program>, cx: Rc<Cx>) -> RunningProgram {
    Box::pin(async move {
        program.init(&cx).await?;
        let shared = cx.shared();
        let mut alarms = data::reload(&program.data(), &shared.scripts.path().join(program.folder())).into_iter();
        if let Some(first) = alarms.next() {
            // The first alarm ends the program, and is reported then; the others are reported here.
            let channel = cx.channel_state().id;
            alarms.for_each(|alarm| shared.alarm(Alarm { channel, ..alarm }, false));
            return Err(Stop::alarm(first));
        }
        cx.programs().were_initialised(&*program);
        program.main(&cx).await
    })
}

/// The program after `restart`: its global variables keep their values.
fn again(program: Rc<dyn Program>, cx: Rc<Cx>) -> RunningProgram {
    Box::pin(async move { program.main(&cx).await })
}
