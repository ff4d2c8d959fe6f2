//! The buttons of the teach pendant, and moving a robot beside its program.

use super::channel::Channel;
use super::channels::Channels;
use super::{Controller, Outcome, State};
use crate::io::Pendant;
use crate::unit::hold::{HeldButton, PressOutcome};

impl Controller {
    /// Presses a button of the teach pendant, for all channels. A button that cannot act now gives a warning
    /// ([`Controller::take_warnings`]) and changes nothing.
    ///
    /// ```
    /// # use arl_rt::emit::*;
    /// # struct Turn;
    /// # impl arl_rt::Program for Turn {
    /// #     fn file(&self) -> File { File::new("turn.arl") }
    /// #     fn family(&self) -> Family { Family::SixAxis }
    /// #     fn main<'a>(&'a self, cx: &'a Cx) -> BoxFuture<'a> {
    /// #         let target = Joint { j1: 90.0, j2: -90.0, j3: 90.0, j4: 0.0, j5: 45.0, j6: 0.0, ..Joint::default() };
    /// #         Box::pin(async move { motion::movej(target).run(cx).await.at(self.file(), 2) })
    /// #     }
    /// # }
    /// use arl_rt::io::Pendant;
    /// use arl_rt::{Controller, Outcome, State};
    ///
    /// let mut controller = Controller::builder().build(Box::new(Turn))?;
    /// controller.run_for(0.3);
    /// controller.press(Pendant::Pause);
    /// controller.run_for(0.5);
    /// assert_eq!(controller.state(), State::Paused);
    /// let stopped = controller.joints();
    /// // Somebody moves the robot: it goes back before it goes on.
    /// controller.jog(1, 2.0);
    /// controller.run_for(2.0);
    /// assert!((controller.joints().axes[0] - stopped.axes[0] - 2.0).abs() < 1e-6);
    /// controller.press(Pendant::Start);
    /// assert_eq!(controller.run(), Outcome::Ended);
    /// assert_eq!(controller.joints().axes[0], 90.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// The time of a [`Scenario`](crate::io::Scenario) begins with the programs: with the start button, where they are
    /// paused before their first cycle; and again with a reset of programs that have ended. Buttons that the scenario
    /// itself presses do not change its time, nor does it wait where it presses the start button itself.
    pub fn press(&mut self, button: Pendant) {
        let had_ended = self.channels.state() == State::Ended;
        press(&mut self.channels, button);
        self.time_scenario(button, had_ended);
    }

    /// Lets the time of the scenario begin with the programs, where a button pressed now makes them begin.
    fn time_scenario(&mut self, button: Pendant, had_ended: bool) {
        let (now, state) = (self.shared.now.get(), self.channels.state());
        let starts = self.scenario_starts();
        match button {
            Pendant::Pause if state == State::Paused && self.scenario.began() == now && !starts => self.scenario.wait(),
            // A robot whose servo is off does not start: the scenario may be there to switch it on.
            button if button.lets_begin() && self.scenario.waits() && (state == State::Running || starts) => {
                self.scenario.begin(now);
            }
            Pendant::Reset if had_ended && state != State::Ended => self.begin_scenario_again(),
            _ => {}
        }
    }

    /// Whether the scenario starts programs itself: at the pendant, or as a PLC.
    pub(super) fn scenario_starts(&self) -> bool {
        self.scenario.starts(self.external.is_wired().then(|| self.system().start_prog_di.get()))
    }

    /// Lets programs and scenario wait for the start button; to be called before the first cycle.
    pub(crate) fn wait_for_start(&mut self) {
        self.press(Pendant::Pause);
        self.scenario.wait();
    }

    /// Begins the scenario again together with the programs.
    pub(super) fn begin_scenario_again(&mut self) {
        let effects = &mut self.effects;
        let mut image = self.shared.io.borrow_mut();
        self.scenario.begin_again(self.shared.now.get(), &mut image, |effect| effects.push(effect));
        drop(image);
        for effect in self.effects.drain(..) {
            super::effects::act(&mut self.channels, effect);
        }
        if self.channels.state() == State::Paused {
            self.scenario.wait();
        }
    }

    /// Switches the loop running mode on or off, for all channels: a program that comes to its end is reset, as by
    /// [`Controller::reset`], and begins again. `exit` ends it all the same.
    ///
    /// ```
    /// # use arl_rt::emit::*;
    /// # struct Beat;
    /// # impl arl_rt::Program for Beat {
    /// #     fn file(&self) -> File { File::new("beat.arl") }
    /// #     fn family(&self) -> Family { Family::SixAxis }
    /// #     fn main<'a>(&'a self, cx: &'a Cx) -> BoxFuture<'a> {
    /// #         Box::pin(async move {
    /// #             let speed = cx.system().dfspeed.get().tcp;
    /// #             let line = text::print().argtoprint(&cx.time()).argtoprint(&" ").argtoprint(&speed);
    /// #             line.run(cx).at(self.file(), 1)?;
    /// #             cx.system().dfspeed.set(Speed { tcp: 70.0, ..cx.system().dfspeed.get() });
    /// #             flow::waittime(1.0).run(cx).await.at(self.file(), 2)
    /// #         })
    /// #     }
    /// # }
    /// // The program prints the time and `$DFSPEED.tcp`, sets that to 70, and waits for 1 s.
    /// let messages = arl_rt::Captured::new();
    /// let mut controller = arl_rt::Controller::builder().output(messages.clone()).build(Box::new(Beat))?;
    /// controller.set_loop(true);
    /// controller.run_for(1.5);
    /// controller.set_loop(false);
    /// assert_eq!(controller.run(), arl_rt::Outcome::Ended);
    /// // The reset has set the variable back.
    /// assert_eq!(messages.text(), "0 50\n1.001 50\n");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn set_loop(&mut self, on: bool) {
        self.channels.each(|channel| channel.channel_state().repeats.set(on));
    }

    /// Jogs an axis of the first channel's robot, from 1 (external axes follow its own), by `by` deg (mm), at manual
    /// speed, while the program is paused or has ended. A request that cannot be carried out gives a warning and
    /// changes nothing. For other robots there is [`Controller::order`].
    pub fn jog(&mut self, axis: usize, by: f64) {
        jog(self.channels.first(), axis, by);
    }

    /// Presses a button that moves the robot of a foreground channel, from 1.
    pub(crate) fn hold(&mut self, channel: u8, held: &HeldButton) -> Result<PressOutcome, String> {
        let found = self.channels.numbered(channel);
        hold(found.ok_or_else(|| format!("there is no channel {channel}"))?, held)
    }

    /// Keeps the button pressed.
    ///
    /// # Errors
    /// The button does not move the robot any more.
    pub(crate) fn keep_on(&mut self, channel: u8, held: &HeldButton) -> Result<(), String> {
        let unit = self.channels.numbered(channel).and_then(|channel| channel.channel_state().robot_mut());
        unit.map_or(Ok(()), |mut unit| unit.keep_on(held))
    }

    /// Whether the set-points of all robots are at rest.
    pub(crate) fn all_stand(&self) -> bool {
        self.channels.units().all(|unit| unit.borrow().stands())
    }

    /// Releases the button: the robot stops on its path.
    pub(crate) fn let_go(&mut self, channel: u8) {
        let unit = self.channels.numbered(channel).and_then(|channel| channel.channel_state().robot_mut());
        if let Some(mut unit) = unit {
            unit.let_go();
        }
    }

    /// Switches the motors of all robots off at once, whatever they do: an emergency. The robots brake by themselves;
    /// programs are paused. Motors come on again by [`Pendant::ServoOn`](crate::io::Pendant::ServoOn), and programs go
    /// on by the start button, after the robots have gone back to their paths.
    pub fn emergency_stop(&mut self) {
        self.press(Pendant::EmergencyStop);
    }

    /// Reports that an axis of the first channel's robot was moved by hand, by `by` deg (mm), while its servo is off.
    /// This is not needed for a real robot: its driver reports it.
    pub fn move_by_hand(&mut self, axis: usize, by: f64) {
        move_by_hand(self.channels.first(), axis, by);
    }
}

/// Presses a button.
pub(super) fn press(channels: &mut Channels, button: Pendant) {
    // A button that one person holds keeps the programs of all channels from going on.
    let goes_on = match button {
        Pendant::Start => Some("start"),
        Pendant::Step => Some("step"),
        Pendant::Reset => Some("reset"),
        _ => None,
    };
    if let Some(what) = goes_on
        && channels.foreground().any(|channel| is_held(channel, what))
    {
        return;
    }
    match button {
        Pendant::Override(speed) => super::effects::set_override(channels, speed),
        Pendant::Start => channels.each(start),
        Pendant::Pause => channels.each(|channel| pause(channel)),
        Pendant::Step => channels.each(step),
        Pendant::Reset => {
            let ended = channels.state() == State::Ended;
            channels.each(|channel| reset(channel, ended));
        }
        Pendant::Clear => channels.each(|channel| channel.channel_state().alarmed.set(false)),
        Pendant::ServoOn => channels.each(|channel| servo_on(channel)),
        Pendant::ServoOff => channels.each(|channel| servo_off(channel)),
        Pendant::EmergencyStop => channels.each(|channel| emergency_stop(channel)),
    }
}

fn refuse(channel: &Channel, what: &str, why: &str) {
    channel.channel_state().shared.warn(format!("{what} is refused: {why}"));
}

/// Whether the program may go on; warns where the servo is off.
fn may_go_on(channel: &Channel, what: &str) -> bool {
    let servo = channel.channel_state().robot().is_none_or(|unit| unit.has_servo());
    if !servo {
        refuse(channel, what, "the servo is off");
    }
    servo && channel.outcome().is_none()
}

/// Whether a button moves the robot beside its program; warns where one does.
fn is_held(channel: &Channel, what: &str) -> bool {
    let held = channel.channel_state().robot().is_some_and(|unit| unit.is_held());
    if held {
        refuse(channel, what, "a button moves the robot, or the robot has not stopped since");
    }
    held
}

fn start(channel: &mut Channel) {
    if may_go_on(channel, "start") {
        channel.channel_state().stepping.on.set(false);
        channel.channel_state().stepping.until.set(None);
        go_on(channel);
    }
}

/// Lets program and robot go on: back to the path first, where the robot was moved.
fn go_on(channel: &Channel) {
    let channel_state = channel.channel_state();
    if channel_state.paused.replace(false)
        && let Some(mut unit) = channel_state.robot_mut()
    {
        unit.go_on(channel.cx().place());
    }
}

fn pause(channel: &Channel) {
    let channel_state = channel.channel_state();
    if channel.outcome().is_none() && !channel_state.paused.replace(true) {
        channel_state.stepping.until.set(None);
        if let Some(mut unit) = channel_state.robot_mut() {
            unit.pause();
        }
    }
}

fn step(channel: &mut Channel) {
    let is_stepping = channel.channel_state().stepping.on.get() && channel.state() == State::Running;
    if is_stepping || !may_go_on(channel, "step") {
        return;
    }
    let channel_state = channel.channel_state();
    channel_state.stepping.on.set(true);
    match channel_state.robot().and_then(|unit| unit.next_motion()) {
        Some(motion) => channel_state.stepping.until.set(Some(motion)),
        None => channel_state.stepping.remaining.set(1),
    }
    go_on(channel);
}

/// Resets a program; `ended`: those of all foreground channels have ended.
fn reset(channel: &mut Channel, ended: bool) {
    match channel.state() {
        // Background programs are not reset when the others begin again.
        State::Running if ended => {}
        State::Running => refuse(channel, "reset", "the program is running: pause it first"),
        State::Paused => channel.end(Outcome::Stopped),
        State::Ended if channel.channel_state().robot().is_some_and(|unit| !unit.has_servo()) => {
            refuse(channel, "reset", "the servo is off");
        }
        State::Ended if channel.channel_state().alarmed.get() => {
            refuse(channel, "reset", "the alarm has not been cleared")
        }
        State::Ended => channel.reset(),
    }
}

fn servo_off(channel: &Channel) {
    pause(channel);
    if let Some(mut unit) = channel.channel_state().robot_mut() {
        unit.servo_off();
    }
}

fn emergency_stop(channel: &Channel) {
    pause(channel);
    if let Some(mut unit) = channel.channel_state().robot_mut() {
        unit.cut_power();
    }
}

fn servo_on(channel: &Channel) {
    let channel_state = channel.channel_state();
    let Some(mut unit) = channel_state.robot_mut() else { return };
    let keeps = channel_state.system.reset_pos_type.with(|kinds| kinds.first().is_some_and(|kind| *kind == "cmd"));
    let threshold = channel_state.system.reset_pos_threshold.with(|all| all.first().copied().unwrap_or_default());
    match unit.servo_on(keeps.then_some(threshold)) {
        Ok(true) => {}
        Ok(false) => channel_state
            .shared
            .warn("servo on: the robot was moved by more than $RESET_POS_THRESHOLD: it stays where it is now".into()),
        Err(why) => refuse(channel, "servo on", &why),
    }
}

/// Jogs an axis, from 1.
pub(super) fn jog(channel: &Channel, axis: usize, by: f64) {
    if channel.state() == State::Running {
        refuse(channel, "jogging", "the program is running: pause it first");
        return;
    }
    let paused = channel.state() == State::Paused;
    let jogged = channel.channel_state().robot_mut().map_or(Ok(()), |mut unit| {
        if paused {
            unit.pause();
        }
        unit.jog(axis, by)
    });
    if let Err(why) = jogged {
        refuse(channel, "jogging", &why);
    }
}

/// Presses a button that moves the robot of a channel.
fn hold(channel: &Channel, held: &HeldButton) -> Result<PressOutcome, String> {
    let state = channel.state();
    if state == State::Running {
        return Err("the program is running: pause it first".into());
    }
    let unit = channel.channel_state().robot_mut();
    unit.map_or(Ok(PressOutcome::Begun), |mut unit| unit.press(held, state == State::Paused))
}

/// Moves an axis, from 1, by hand.
pub(super) fn move_by_hand(channel: &Channel, axis: usize, by: f64) {
    let moved = channel.channel_state().robot_mut().map_or(Ok(()), |mut unit| unit.move_by_hand(axis, by));
    if let Err(why) = moved {
        refuse(channel, "moving the robot by hand", &why);
    }
}
