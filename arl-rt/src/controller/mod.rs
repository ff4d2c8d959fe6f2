//! The controller: it owns the program, the robot, io and the clock, and runs them cycle by cycle.
//!
//! It may import from every other module but `command`.

mod actions;
mod builder;
mod channel;
mod channels;
mod drive;
mod effects;
mod external;
mod foreground;
mod handle;
mod late_limit;
mod of_cell;
mod order;
mod outcome;
mod pendant;
mod pointer_store;
mod quiet;
mod recorded;
mod running;
mod signals;
mod standstill;
mod status;
mod storing;
pub(crate) mod trace;
mod watching;

use std::cell::RefCell;
use std::net::SocketAddr;
use std::rc::Rc;
use std::sync::Arc;

pub use crate::context::run_state::State;
pub use builder::{Builder, SetupError};
pub use foreground::Foreground;
pub use handle::{Handle, HandleError};
pub use order::OrderError;
pub use outcome::Outcome;
pub(crate) use recorded::RecordedMotions;
pub use running::Running;
pub use status::{ChannelStatus, RobotStatus, Status};

use crate::context::named::{self, GlobalError, Named};
use crate::context::program::Program;
use crate::context::shared_state::SharedState;
use crate::context::subscribers::Event;
use crate::context::system::System;
use crate::cycle::channel_id::ChannelId;
use crate::cycle::clock_source::{Clock, Lateness};
use crate::fault::{Alarm, File};
use crate::fieldbus::islands::Islands;
use crate::io::{Effect, IoDriver, Pendant, Playing};
use crate::motion::Joints;
use crate::unit::{RobotCycle, Unit};
use arl_robot::cell::Names;
use arl_robot::robot::Robot;
use channel::Channel;
use channels::Channels;
use external::External;
use handle::HandleCalls;
use late_limit::{LateLimit, Lost};
use pointer_store::PointerStore;

/// Runs a program.
///
/// One [`step`](Controller::step) is one control cycle. In it, always in this order:
///
/// 1. the clock reports when the cycle begins;
/// 2. requests of other threads are carried out ([`Handle`]); inputs are read, pulses that are over end, the scenario
///    plays;
/// 3. the pendant's buttons take effect, then the signals of a PLC (external auto control); programs with robots end
///    with an alarm where inputs that they need are lost, or too many cycles;
/// 4. the conditions of interrupts, timers and triggers are checked; then the program runs until it waits, the action
///    of an event on top of what it interrupts;
/// 5. the motion goes one step: set-point to the robot's driver, feedback back, variables like `$TRAJ_LEFT_DIS`;
/// 6. outputs that waited for a motion change, then those that report the state to a PLC; all outputs are written, a
///    collision stops robot and program, messages are passed on;
/// 7. the trace gets its row.
///
/// ```
/// use arl_rt::emit::*;
///
/// /// A program by hand: what the compiler emits looks like this, too.
/// struct Blink;
///
/// impl arl_rt::Program for Blink {
///     fn file(&self) -> File {
///         File::new("blink.arl")
///     }
///     fn family(&self) -> Family {
///         Family::SixAxis
///     }
///     fn main<'a>(&'a self, cx: &'a Cx) -> BoxFuture<'a> {
///         Box::pin(async move {
///             let file = self.file();
///             while !io::getdi(cx, 1).await.at(file, 2)? {
///                 io::pulsedo(cx, 1, true, 0.25).await.at(file, 3)?;
///                 flow::waittime(0.5).run(cx).await.at(file, 4)?;
///             }
///             text::print().argtoprint(&"done after ").argtoprint(&cx.time()).run(cx).at(file, 6)
///         })
///     }
/// }
///
/// let messages = arl_rt::Captured::new();
/// let mut controller = arl_rt::Controller::builder().output(messages.clone()).build(Box::new(Blink))?;
/// controller.run_for(0.1);
/// assert!(controller.digital_output(1)?);
/// controller.run_for(1.2);
/// controller.set_digital_input(1, true)?;
/// assert_eq!(controller.run(), arl_rt::Outcome::Ended);
/// assert_eq!(messages.text(), "done after 1.5\n");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Controller {
    shared: Rc<SharedState>,
    channels: Channels,
    /// The robot of the first channel.
    unit: Rc<RefCell<Unit>>,
    clock: Box<dyn Clock>,
    late_limit: LateLimit,
    /// Whether all programs had ended before this cycle: time in which the controller is not stepped is then no loss.
    had_ended: bool,
    /// The real inputs and outputs of the cell file.
    islands: Islands,
    io: Box<dyn IoDriver>,
    scenario: Playing,
    /// The cell's names for signals.
    names: Names,
    /// What a scenario does in this cycle, except to inputs; empty between cycles, with room for all effects that can
    /// come at once.
    effects: Vec<Effect>,
    external: External,
    /// Requests of other threads.
    calls: HandleCalls,
    /// The state that the subscribers to events were last notified of.
    notified_state: State,
    /// Stores where the programs stand; `None` where that is not stored.
    pointer_store: Option<PointerStore>,
    /// Whether code outside may change something: drivers that are not ours.
    has_outside: bool,
    /// No cycle before this one is skipped.
    awake_until: u64,
    /// The first cycle in which changes may be stored again of those system variables all of whose changes are kept.
    stores_from: u64,
}

impl Controller {
    /// A builder: what a controller can be given before it starts.
    pub fn builder() -> Builder {
        Builder::default()
    }

    /// Runs one cycle.
    pub fn step(&mut self) -> State {
        self.clock.wait_for(self.shared.now.get(), self.shared.rate.period());
        self.finish_disk_work();
        self.answer_handles();
        let shared = &self.shared;
        let (cycle, rate) = (shared.now.get(), shared.rate);
        {
            let mut image = shared.io.borrow_mut();
            self.islands.read(image.inputs_mut());
            self.io.read(image.inputs_mut());
            image.outputs_reached(|output, since| {
                self.islands.has_reached(output, since) && self.io.has_reached(output, since)
            });
            image.end_pulses_of(cycle);
            self.scenario.play(cycle, &mut image, |effect| self.effects.push(effect));
        }
        for effect in self.effects.drain(..) {
            effects::act(&mut self.channels, effect);
        }
        self.read_external_control();
        // A program that has just begun may have ended by the end of the cycle.
        if !self.shared.subscribers.is_empty() {
            self.tell_state();
        }
        self.report_io_problems();
        self.report_robots();
        self.look_for_lost_cycles(cycle);
        self.channels.each(Channel::scan_events);
        self.channels.each(Channel::poll);
        self.channels.each(Channel::handle_pending_alarm);
        let (real, due) = (self.clock.is_real(), self.clock.due(cycle, rate.period()));
        self.channels
            .each(|channel| channel.step_robot(rate.time(cycle), RobotCycle { cycle: rate.into(), real, due }));
        self.write_external_outputs();
        self.islands.write(self.shared.io.borrow().outputs_all(cycle));
        self.io.write(self.shared.io.borrow().outputs_all(cycle));
        self.channels.each(Channel::handle_collision);
        self.channels.each(Channel::handle_robot_fault);
        let shared = &self.shared;
        shared.flush();
        if shared.take_real_time_need()
            && let Some(warning) = self.clock.follow_real_time()
        {
            shared.warn(warning.into());
        }
        self.channels.each(Channel::finish_cycle);
        self.store_changed_variables();
        self.note_pointers();
        self.shared.now.set(cycle + 1);
        self.had_ended = self.channels.outcome().is_some();
        self.tell_state()
    }

    /// Notifies the subscribers to events of the controller's state, where it has changed.
    fn tell_state(&mut self) -> State {
        let state = self.state();
        if std::mem::replace(&mut self.notified_state, state) != state {
            self.shared.subscribers.tell(|| Event::State(state));
        }
        state
    }

    /// Carries out what a PLC requests.
    fn read_external_control(&mut self) {
        let channel_state = self.channels.first().channel_state();
        let shared = &self.shared;
        let received = self.external.listen(&external::InputSnapshot {
            io: &shared.io.borrow(),
            system: &channel_state.system,
            cycle: shared.now.get(),
            rate: shared.rate,
            paused: self.channels.state() == State::Paused,
        });
        let pressed = match received {
            Ok(pressed) => pressed,
            Err(fault) => {
                let (file, line) = self.channels.first().cx().place();
                channel_state.raise_alarm(Alarm::new(fault, file, line));
                return;
            }
        };
        for button in pressed.into_iter().flatten() {
            // A program that has ended begins again at the start signal, not at the reset.
            let button = match (button, self.channels.state()) {
                (Pendant::Start, State::Ended) => Pendant::Reset,
                (Pendant::Reset, State::Ended) => continue,
                _ => button,
            };
            // The scenario's time goes on while the scenario plays the PLC.
            if self.scenario_starts() {
                pendant::press(&mut self.channels, button);
            } else {
                self.press(button);
            }
        }
    }

    /// Passes on warnings and faults of the islands and the io driver.
    fn report_io_problems(&mut self) {
        while let Some(warning) = self.islands.take_warning().or_else(|| self.io.take_warning()) {
            self.shared.warn(warning);
        }
        if let Some(why) = self.islands.fault().or_else(|| self.io.fault()) {
            self.channels.each(|channel| channel.fail_for_lost_io(why));
        }
    }

    /// Passes on the warnings of the robots' drivers.
    fn report_robots(&mut self) {
        for channel in self.channels.iter() {
            let state = channel.channel_state();
            while let Some(warning) = state.robot_mut().and_then(|mut unit| unit.take_driver_warning()) {
                state.shared.warn(warning);
            }
        }
    }

    /// Stops robots where too many cycles were lost: they had to do without set-points for that time.
    fn look_for_lost_cycles(&mut self, cycle: u64) {
        let lost = self.clock.lateness().map(Lost::from).unwrap_or_default();
        if self.had_ended {
            return self.late_limit.forget(lost);
        }
        if let Some(lost) = self.late_limit.look(lost, cycle) {
            let why = lost.to_string();
            self.channels.each(|channel| channel.fail_for_lost_cycles(&why));
        }
    }

    /// Reports the controller's state to a PLC.
    fn write_external_outputs(&mut self) {
        let state = self.channels.state();
        let system = &self.channels.first().channel_state().system;
        let servo_on = self.channels.first().channel_state().robot().is_some_and(|unit| unit.has_servo());
        self.external.show(&mut self.shared.io.borrow_mut(), system, state, servo_on);
    }

    /// Runs until it [is over](Controller::is_over), or at a [standstill](Controller::standstill): for ever, where a
    /// program does not end.
    pub fn run(&mut self) -> Outcome {
        let outcome = self.step_to_end();
        self.settle_state();
        outcome
    }

    /// Runs as [`run`](Controller::run) does, but stores nothing at the end.
    fn step_to_end(&mut self) -> Outcome {
        self.stay_awake();
        loop {
            let outcome = match self.channels.outcome().cloned() {
                Some(outcome) if self.is_over() => Some(outcome),
                _ => {
                    self.step();
                    self.standstill().map(Outcome::Standstill)
                }
            };
            if let Some(outcome) = outcome {
                return outcome;
            }
            self.skip_quiet_cycles(u64::MAX);
        }
    }

    /// Runs for `seconds` of controller time, or until it [is over](Controller::is_over).
    pub fn run_for(&mut self, seconds: f64) -> State {
        let end = self.shared.now.get().saturating_add(self.shared.rate.cycles(seconds));
        self.stay_awake();
        while self.shared.now.get() < end && !self.is_over() {
            self.step();
            self.skip_quiet_cycles(end);
        }
        self.state()
    }

    /// What the controller does at the moment.
    pub fn state(&self) -> State {
        self.channels.state()
    }

    /// Whether the programs have ended, those of all foreground channels where there are several, and nothing will
    /// start them again. A scenario may start them: with the pendant's reset button, or as a PLC that is wired to start
    /// programs (external auto control). As long as such a scenario has events left, the run is not over.
    pub fn is_over(&self) -> bool {
        self.channels.outcome().is_some()
            && !(self.can_begin_again() && self.scenario.goes_on(&self.shared.io.borrow()))
    }

    /// Whether the scenario or a PLC can start programs that have ended.
    fn can_begin_again(&self) -> bool {
        self.scenario.resets() || self.external.starts(self.system())
    }

    /// How the program ended; `None` while it runs.
    pub fn outcome(&self) -> Option<&Outcome> {
        self.channels.outcome()
    }

    /// Ends the programs, also those that wait to be loaded: the robots stop on their paths within the following
    /// cycles.
    pub fn stop(&mut self) {
        self.channels.each(Channel::stop);
    }

    /// Presses the start button: a program that is paused goes on.
    pub fn resume(&mut self) {
        self.press(Pendant::Start);
    }

    /// Resets the program, which starts from its beginning with the next cycle: pulses end, global variables and the
    /// system variables of the manual's chapter 10.2 get their defaults. The robot stays where it is. The time of the
    /// scenario begins again.
    ///
    /// # Errors
    /// The program still runs: [`stop`](Controller::stop) it first.
    pub fn reset(&mut self) -> Result<(), StillRunning> {
        if self.channels.iter().any(|channel| channel.outcome().is_none()) {
            return Err(StillRunning);
        }
        self.channels.each(Channel::reset);
        self.begin_scenario_again();
        Ok(())
    }

    /// Controller time in s: the start of the next cycle.
    pub fn time(&self) -> f64 {
        self.shared.rate.time(self.shared.now.get())
    }

    /// Controller time of the last cycle in s, as in its row of the trace; 0 before the first one.
    pub(crate) fn last_time(&self) -> f64 {
        self.shared.rate.time(self.shared.now.get().saturating_sub(1))
    }

    /// Whether the last cycle is one of every `every` cycles, counted from the first one.
    pub(crate) fn is_turn(&self, every: u64) -> bool {
        self.shared.now.get().checked_sub(1).is_some_and(|last| last.is_multiple_of(every.max(1)))
    }

    /// The running number of the next cycle, from 0.
    pub(crate) fn cycle(&self) -> u64 {
        self.shared.now.get()
    }

    /// Whether the first channel's program ran in the last cycle.
    pub(crate) fn first_ran(&self) -> bool {
        self.channels.first().ran()
    }

    /// The row of the last cycle in the trace of the first channel's robot.
    pub(crate) fn trace_row(&self) -> [f64; trace::COLUMNS] {
        let cycle = self.shared.now.get().saturating_sub(1);
        trace::columns(self.shared.rate.time(cycle), &self.unit.borrow())
    }

    /// The file of the motion that the first channel's robot executed in the last cycle.
    pub(crate) fn executing_file(&self) -> Option<File> {
        self.unit.borrow().executing_file()
    }

    /// The number of cycles that `seconds` take.
    pub(crate) fn cycles(&self, seconds: f64) -> u64 {
        self.shared.rate.cycles(seconds)
    }

    /// How late cycles began; `None` where the clock does not know that: the real one does.
    pub fn lateness(&self) -> Option<&Lateness> {
        self.clock.lateness()
    }

    /// In how many cycles programs had more turns of loops to make than one cycle may have: they calculated, or a loop
    /// waited by going round.
    pub fn full_cycles(&self) -> u64 {
        self.channels.iter().map(|channel| channel.channel_state().full_cycles.get()).sum()
    }

    /// How many parts of the motion ahead (time laws, blends) were computed too late, on the real clock: the robot then
    /// goes on with what it has, and comes to rest on its path at the end of that. 0 on the virtual clock, which waits
    /// for them.
    pub fn found_late(&self) -> u64 {
        self.channels.iter().filter_map(|channel| Some(channel.channel_state().robot()?.found_late())).sum()
    }

    /// The file and line of the statement that runs now.
    pub fn place(&self) -> (File, u32) {
        self.channels.first().cx().place()
    }

    /// Whether a robot has motion to do.
    pub(crate) fn moves(&self) -> bool {
        self.channels.iter().any(|channel| channel.channel_state().robot().is_some_and(|unit| unit.moves()))
    }

    /// Whether the clock runs in real time.
    pub(crate) fn is_real_time(&self) -> bool {
        self.clock.is_real()
    }

    /// The file that has the program's `main`.
    pub fn program(&self) -> File {
        self.channels.first().cx().program()
    }

    /// The global variables of the first channel's program, where they are of this type: the `Globals` of an emitted
    /// program. They can be read at any time, and set between two cycles. A program sets them itself when it starts or
    /// is reset; [`Builder::on_init`] is called after that.
    ///
    /// `docs/embedding.md` has an example.
    pub fn globals<G: 'static>(&self) -> Option<&G> {
        self.channels.first().globals()
    }

    /// The global variables of any channel's program, as `globals` returns them; also `None` where there is no such
    /// channel.
    pub fn globals_of<G: 'static>(&self, channel: ChannelId) -> Option<&G> {
        self.channels.iter().find(|it| it.channel_state().id == channel)?.globals()
    }

    /// The value of a global variable of the first program, as a literal of ARL. The name is written as for
    /// [`Builder::global`].
    ///
    /// # Errors
    /// There is no such variable, or the program was compiled without the names.
    pub fn global(&self, name: &str) -> Result<String, GlobalError> {
        let program = self.first_program();
        let value = named::with_variable(program, name, |variable| variable.slot.written())?;
        value.ok_or_else(|| named::unknown(name, &[program]))
    }

    /// Gives a global variable of the first program a value, between two cycles. Components that the literal leaves out
    /// keep their values.
    ///
    /// # Errors
    /// As [`Controller::global`], or the value does not fit.
    pub fn set_global(&mut self, name: &str, literal: &str) -> Result<(), GlobalError> {
        Named::new(name.to_owned(), literal.to_owned()).put(&[self.first_program()])
    }

    /// The program of the first channel.
    pub(crate) fn first_program(&self) -> &dyn Program {
        self.channels.first().cx().program_itself()
    }

    /// The system variables.
    pub fn system(&self) -> &System {
        &self.channels.first().channel_state().system
    }

    /// The axis positions that the robot reports, in deg (mm).
    pub fn joints(&self) -> Joints {
        *self.unit.borrow().feedback()
    }

    /// Where the Modbus TCP server listens, if there is one.
    pub fn modbus_tcp_address(&self) -> Option<SocketAddr> {
        self.shared.buses.modbus_tcp_address()
    }

    /// The robot of the first channel.
    pub fn robot(&self) -> Arc<Robot> {
        self.unit.borrow().shared_robot()
    }

    /// The warnings since the last call.
    pub fn take_warnings(&mut self) -> Vec<String> {
        self.shared.take_warnings()
    }

    /// The alarms since the last call, the one that stopped the program first.
    pub fn take_alarms(&mut self) -> Vec<Alarm> {
        self.shared.take_alarms()
    }

    /// Releases the robots after the last cycle. A robot that moves is cut off; from then on the robots report nothing.
    /// Call this before doing something slow after the last cycle with a real robot; otherwise it happens when the
    /// controller is dropped.
    pub fn close_robots(&mut self) {
        self.channels.units().for_each(|unit| unit.borrow_mut().close());
    }
}

impl Drop for Controller {
    fn drop(&mut self) {
        self.close_robots();
        self.settle_state();
        self.io.close();
    }
}

/// The program still runs, so it cannot be reset.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct StillRunning;

impl std::fmt::Display for StillRunning {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "the program is still running: stop it before a reset")
    }
}

impl std::error::Error for StillRunning {}

impl std::fmt::Debug for Controller {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Controller").field("time", &self.time()).field("state", &self.state()).finish_non_exhaustive()
    }
}
