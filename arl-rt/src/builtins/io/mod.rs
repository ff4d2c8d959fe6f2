//! Inputs and outputs, as programs use them.
//!
//! Async functions wait for the end of all planned motion, then act in that cycle. Channels count from 1.

mod analog;

pub use analog::{getai, getao, setao, syncao};

use crate::builtins::flow::wait_cycles;
use crate::context::cx::Cx;
use crate::fault::Fault;
use crate::io::{Digital, OutputSignal, Pwm};

/// Sets a digital output.
///
/// # Errors
/// The channel does not exist.
pub async fn setdo(cx: &Cx, chan: i32, value: bool) -> Result<(), Fault> {
    cx.motion_end().await;
    cx.shared().io.borrow_mut().set_digital(Digital::Do, chan, value)
}

/// Sets up to 32 adjacent digital outputs; the lowest bit of `value` is the level of the first.
///
/// # Errors
/// Channels that do not exist, a reversed range, more than 32 channels.
pub async fn setdo_group(cx: &Cx, from_chan: i32, to_chan: i32, value: i32) -> Result<(), Fault> {
    cx.motion_end().await;
    cx.shared().io.borrow_mut().set_digitals(Digital::Do, from_chan, to_chan, value)
}

/// Sets a digital output and continues once it has been sent: in the next cycle, or as soon as the output's island has
/// accepted it.
///
/// # Errors
/// The channel does not exist.
pub async fn syncdo(cx: &Cx, chan: i32, value: bool) -> Result<(), Fault> {
    setdo(cx, chan, value).await?;
    sent(cx, digital_outputs(chan, chan)).await;
    Ok(())
}

/// The digital outputs of a range of existing channels.
fn digital_outputs(from: i32, to: i32) -> impl Iterator<Item = OutputSignal> + Clone {
    (from..=to).map(|channel| OutputSignal::Digital(channel.unsigned_abs() as usize))
}

/// Waits until outputs of this cycle have reached their destination, at least one cycle.
async fn sent(cx: &Cx, outputs: impl Iterator<Item = OutputSignal> + Clone) {
    cx.shared().io.borrow_mut().await_outputs(outputs.clone(), cx.cycle());
    cx.next_cycle().await;
    while cx.shared().io.borrow().awaits(outputs.clone()) {
        cx.next_cycle().await;
    }
}

/// Sets up to 32 adjacent digital outputs and continues once they have been sent, like [`syncdo`].
///
/// # Errors
/// Channels that do not exist, a reversed range, more than 32 channels.
pub async fn syncdo_group(cx: &Cx, from_chan: i32, to_chan: i32, value: i32) -> Result<(), Fault> {
    setdo_group(cx, from_chan, to_chan, value).await?;
    sent(cx, digital_outputs(from_chan, to_chan)).await;
    Ok(())
}

/// The shortest pulse of an output, in s.
const SHORTEST_PULSE_S: f64 = 0.025;

/// Starts a pulse on a digital output: the level for `width` seconds, but at least 25 ms, then the opposite level. The
/// program continues at once.
///
/// # Errors
/// The channel does not exist; the width is negative or not a number.
pub async fn pulsedo(cx: &Cx, chan: i32, value: bool, width: f64) -> Result<(), Fault> {
    let rate = cx.shared().rate;
    let cycles = wait_cycles(rate, width, "pulsedo")?.max(rate.cycles(SHORTEST_PULSE_S));
    cx.motion_end().await;
    cx.shared().io.borrow_mut().pulse(cx.channel_state().index, chan, value, cx.cycle().saturating_add(cycles))
}

/// The level of a digital output.
///
/// # Errors
/// The channel does not exist.
pub async fn getdo(cx: &Cx, chan: i32) -> Result<bool, Fault> {
    cx.motion_end().await;
    cx.shared().io.borrow().digital(Digital::Do, chan)
}

/// The levels of up to 32 adjacent digital outputs, the first in the lowest bit.
///
/// # Errors
/// Channels that do not exist, a reversed range, more than 32 channels.
pub async fn getdo_group(cx: &Cx, from_chan: i32, to_chan: i32) -> Result<i32, Fault> {
    cx.motion_end().await;
    cx.shared().io.borrow().digitals(Digital::Do, from_chan, to_chan)
}

/// The level of a digital input.
///
/// # Errors
/// The channel does not exist.
pub async fn getdi(cx: &Cx, chan: i32) -> Result<bool, Fault> {
    cx.motion_end().await;
    cx.shared().io.borrow().digital(Digital::Di, chan)
}

/// The levels of up to 32 adjacent digital inputs, the first in the lowest bit.
///
/// # Errors
/// Channels that do not exist, a reversed range, more than 32 channels.
pub async fn getdi_group(cx: &Cx, from_chan: i32, to_chan: i32) -> Result<i32, Fault> {
    cx.motion_end().await;
    cx.shared().io.borrow().digitals(Digital::Di, from_chan, to_chan)
}

/// The level of an internal output signal.
///
/// # Errors
/// The signal does not exist.
pub async fn getintdo(cx: &Cx, chan: i32) -> Result<bool, Fault> {
    cx.motion_end().await;
    cx.shared().io.borrow().digital(Digital::InternalOut, chan)
}

/// The level of an internal input signal.
///
/// # Errors
/// The signal does not exist.
pub async fn getintdi(cx: &Cx, chan: i32) -> Result<bool, Fault> {
    cx.motion_end().await;
    cx.shared().io.borrow().digital(Digital::InternalIn, chan)
}

/// The level of a digital input now, even while the robot moves.
///
/// # Errors
/// The channel does not exist.
pub fn getnostopdi(cx: &Cx, chan: i32) -> Result<bool, Fault> {
    cx.shared().io.borrow().digital(Digital::Di, chan)
}

/// Sets frequency (Hz) and duty cycle (%) of a PWM output. Returns true.
///
/// # Errors
/// The channel does not exist; a frequency outside 10 to 10000, a duty cycle outside 0 to 100.
pub async fn setpwm(cx: &Cx, channel: i32, freq: i32, ratio: i32) -> Result<bool, Fault> {
    cx.motion_end().await;
    let wrong = |problem: String| Fault::Domain { function: "setpwm", problem: problem.into() };
    let frequency = u16::try_from(freq).ok().filter(|freq| (10..=10_000).contains(freq));
    let duty = u8::try_from(ratio).ok().filter(|ratio| *ratio <= 100);
    let pwm = Pwm {
        frequency: frequency.ok_or_else(|| wrong(format!("freq is {freq} Hz, but must be 10 to 10000")))?,
        duty: duty.ok_or_else(|| wrong(format!("ratio is {ratio} %, but must be 0 to 100")))?,
    };
    cx.shared().io.borrow_mut().set_pwm(channel, pwm)?;
    Ok(true)
}

/// `setdoimv`: sets a digital output as soon as the previous motion has ended, without stopping the robot.
pub fn setdoimv(channel: i32, value: bool) -> SetDoInMotion {
    SetDoInMotion { channel, value }
}

/// `setdoimv`, ready to run.
#[derive(Clone, Copy, Debug)]
#[must_use = "an instruction does nothing until it is run"]
pub struct SetDoInMotion {
    channel: i32,
    value: bool,
}

impl SetDoInMotion {
    /// Attaches the action to the motion planned last; acts at once if no motion is in progress.
    ///
    /// # Errors
    /// The channel does not exist.
    pub fn run(self, cx: &Cx) -> Result<(), Fault> {
        let channel_state = cx.channel_state();
        let mut io = cx.shared().io.borrow_mut();
        io.set_after(channel_state.index, cx.last_motion(), self.channel, self.value)?;
        io.motions_ended(channel_state.index, |motion| channel_state.robot().is_none_or(|unit| unit.has_ended(motion)));
        Ok(())
    }
}
