//! Serial lines (manual 5.6.2). Each call tries once and returns whether it is done.

use std::rc::Rc;

use super::handle::{ConnectionHandle, Found, fault};
use super::transfer;
use crate::communication::line::LineSettings;
use crate::communication::opening::Opening;
use crate::context::cx::Cx;
use crate::context::shown::Shown;
use crate::fault::Fault;
use crate::values::{Parity, Stopbits, Str};

/// The speeds that a line can have, bit/s.
const BAUD_RATES: [i32; 10] = [300, 600, 1200, 2400, 4800, 9600, 19200, 38400, 57600, 115_200];

/// A serial line. It is closed at first, and again once its last copy is dropped.
#[derive(Clone, Default, Debug)]
pub struct Iodev(Rc<ConnectionHandle>);

impl Shown for Iodev {
    fn type_name(&self) -> String {
        "iodev".into()
    }

    fn shown(&self, _: &Cx) -> String {
        self.0.described()
    }
}

/// Opens a serial line, by a name of the cell file or by the path of the device; true on success.
///
/// # Errors
/// A speed or size that is not one of the manual's; the handle is open already.
pub async fn open(
    cx: &Cx,
    dev: &Iodev,
    devname: &Str,
    baud_rate: i32,
    character_size: i32,
    stop: Stopbits,
    parity: Parity,
) -> Result<bool, Fault> {
    cx.motion_end().await;
    let device = cx.shared().network.device(&devname.to_text());
    let settings = settings(device, baud_rate, character_size, stop, parity)?;
    dev.0.open(cx, "open", Opening::Line(settings)).await
}

pub(super) fn settings(
    device: String,
    baud_rate: i32,
    size: i32,
    stop: Stopbits,
    parity: Parity,
) -> Result<LineSettings, Fault> {
    let wrong = |problem: String| Fault::Domain { function: "open", problem: problem.into() };
    if !BAUD_RATES.contains(&baud_rate) {
        let known: Vec<String> = BAUD_RATES.iter().map(i32::to_string).collect();
        return Err(wrong(format!("baud_rate is {baud_rate}, but must be one of {}", known.join(", "))));
    }
    match size {
        5..=8 => Ok(LineSettings { device, baud: baud_rate.unsigned_abs(), bits: size as u8, stop, parity }),
        _ => Err(wrong(format!("character_size is {size}, but must be 5 to 8"))),
    }
}

/// Closes a line; the system still sends the bytes that were written.
pub async fn close(cx: &Cx, dev: &Iodev) {
    cx.motion_end().await;
    dev.0.close();
}

/// Sends a text; true if all of it was accepted for sending.
///
/// # Errors
/// The line is not open, or lost; the text is longer than 1 MiB.
pub async fn write_string(cx: &Cx, dev: &Iodev, data: &Str) -> Result<bool, Fault> {
    cx.motion_end().await;
    done(transfer::write(cx, &dev.0, data.as_bytes()).await?)
}

/// Sends the first `len` bytes; true if all of them were accepted for sending.
///
/// # Errors
/// The line is not open, or lost; a length below 0 or beyond the array.
pub async fn write_bytes(cx: &Cx, dev: &Iodev, data: &[u8], len: i32) -> Result<bool, Fault> {
    cx.motion_end().await;
    done(transfer::write_first(cx, &dev.0, data, len).await?)
}

/// Takes exactly `len` bytes once they have arrived.
///
/// # Errors
/// The line is not open, or lost; a length below 0 or above 1 MiB.
pub async fn read_string(cx: &Cx, dev: &Iodev, data: &mut Str, len: i32) -> Result<bool, Fault> {
    cx.motion_end().await;
    done(transfer::read_text(&dev.0, data, len)?)
}

/// Takes exactly `len` bytes once they have arrived.
///
/// # Errors
/// The line is not open, or lost; a length below 0 or beyond the array.
pub async fn read_bytes(cx: &Cx, dev: &Iodev, data: &mut [u8], len: i32) -> Result<bool, Fault> {
    cx.motion_end().await;
    done(transfer::read_bytes(&dev.0, data, len)?)
}

/// Takes the text before a mark once the mark has arrived; both are removed from the buffer.
///
/// # Errors
/// The line is not open, or lost; an empty mark; 1 MiB without it.
pub async fn readuntil(cx: &Cx, dev: &Iodev, data: &mut Str, cut: &Str) -> Result<bool, Fault> {
    cx.motion_end().await;
    done(transfer::read_until(&dev.0, data, cut)?)
}

/// Discards bytes that have arrived but have not been read; false if the line is not open.
///
/// # Errors
/// None.
pub async fn clearbuff(cx: &Cx, dev: &Iodev) -> Result<bool, Fault> {
    cx.motion_end().await;
    Ok(dev.0.clear(cx).await)
}

/// A lost line is an alarm.
fn done((function, found): (&'static str, Found<()>)) -> Result<bool, Fault> {
    match found {
        Found::This(()) => Ok(true),
        Found::NotYet => Ok(false),
        Found::Lost(reason) => Err(fault(function, &format!("the line is lost: {reason}"))),
    }
}
