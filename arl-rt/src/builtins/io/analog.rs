//! Analog inputs and outputs: values in V or mA, depending on the channel's type in the cell file.

use super::sent;
use crate::context::cx::Cx;
use crate::fault::Fault;
use crate::io::OutputSignal;

/// The value of an analog input in V or mA.
///
/// # Errors
/// The channel does not exist.
pub async fn getai(cx: &Cx, chan: i32) -> Result<f64, Fault> {
    cx.motion_end().await;
    cx.shared().io.borrow().analog_input(chan)
}

/// Sets an analog output, in V or mA.
///
/// # Errors
/// The channel does not exist; a value outside -10 to 10 V or 4 to 20 mA.
pub async fn setao(cx: &Cx, chan: i32, value: f64) -> Result<(), Fault> {
    cx.motion_end().await;
    cx.shared().io.borrow_mut().set_analog_output(chan, value)
}

/// Sets an analog output, in V or mA, and continues once it has been sent: in the next cycle, or as soon as the
/// output's island has accepted it.
///
/// # Errors
/// The channel does not exist; a value outside -10 to 10 V or 4 to 20 mA.
pub async fn syncao(cx: &Cx, chan: i32, value: f64) -> Result<(), Fault> {
    setao(cx, chan, value).await?;
    sent(cx, std::iter::once(OutputSignal::Analog(chan.unsigned_abs() as usize))).await;
    Ok(())
}

/// The value of an analog output in V or mA.
///
/// # Errors
/// The channel does not exist.
pub async fn getao(cx: &Cx, chan: i32) -> Result<f64, Fault> {
    cx.motion_end().await;
    cx.shared().io.borrow().analog_output(chan)
}
