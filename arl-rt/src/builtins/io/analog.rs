//! Analog inputs and outputs: values in V or mA, as the cell file gives the channels.

use super::sent;
use crate::context::cx::Cx;
use crate::fault::Fault;
use crate::io::OutputSignal;

/// The value of an analog input in V or mA.
///
/// # Errors
/// There is no such channel.
pub async fn getai(cx: &Cx, chan: i32) -> Result<f64, Fault> {
    cx.motion_end().await;
    cx.shared().io.borrow().analog_input(chan)
}

/// Sets an analog output, in V or mA.
///
/// # Errors
/// There is no such channel; a value outside -10 to 10 V or 4 to 20 mA.
pub async fn setao(cx: &Cx, chan: i32, value: f64) -> Result<(), Fault> {
    cx.motion_end().await;
    cx.shared().io.borrow_mut().set_analog_output(chan, value)
}

/// Sets an analog output, in V or mA, and goes on when it has been sent: in the next cycle, or when the island that has
/// it has taken it.
///
/// # Errors
/// There is no such channel; a value outside -10 to 10 V or 4 to 20 mA.
pub async fn syncao(cx: &Cx, chan: i32, value: f64) -> Result<(), Fault> {
    setao(cx, chan, value).await?;
    sent(cx, std::iter::once(OutputSignal::Analog(chan.unsigned_abs() as usize))).await;
    Ok(())
}

/// The value of an analog output in V or mA.
///
/// # Errors
/// There is no such channel.
pub async fn getao(cx: &Cx, chan: i32) -> Result<f64, Fault> {
    cx.motion_end().await;
    cx.shared().io.borrow().analog_output(chan)
}
