//! Modbus RTU (manual 5.6.6): the controller is a slave on a serial line; these functions work on its holding
//! registers.

use std::rc::Rc;

use super::handle::{ConnectionHandle, Found, fault};
use super::serial;
use crate::communication::opening::Opening;
use crate::communication::slave::SlaveSettings;
use crate::context::cx::{Cx, Level};
use crate::context::shown::Shown;
use crate::fault::Fault;
use crate::fieldbus::modbus::{SIZE, SharedTables, Tables};
use crate::values::{Parity, Stopbits, Str};

/// The shortest period of [`setcycle`] in us.
const SHORTEST_CYCLE: i32 = 500_000;

/// A Modbus slave. Its line is closed at first, and again once its last copy is dropped; its registers stay.
#[derive(Clone, Default, Debug)]
pub struct ModbusDev {
    handle: Rc<ConnectionHandle>,
    tables: SharedTables,
}

impl Shown for ModbusDev {
    fn type_name(&self) -> String {
        "modbus_dev".into()
    }

    fn shown(&self, _: &Cx) -> String {
        self.handle.described()
    }
}

/// Opens a line, by a name of the cell file or by the path of the device; true on success.
///
/// # Errors
/// A station outside 1 to 247, a speed or size that is not one of the manual's; the slave is open already.
#[expect(clippy::too_many_arguments, reason = "the manual's")]
pub async fn open(
    cx: &Cx,
    dev: &ModbusDev,
    devname: &Str,
    slave_id: i32,
    baud_rate: i32,
    parity: Parity,
    databits: i32,
    stop_bits: Stopbits,
) -> Result<bool, Fault> {
    cx.motion_end().await;
    let wrong = |problem: String| Fault::Domain { function: "open", problem: problem.into() };
    let unit = u8::try_from(slave_id).ok().filter(|unit| (1..=247).contains(unit));
    let unit = unit.ok_or_else(|| wrong(format!("slave_id is {slave_id}, but must be 1 to 247")))?;
    if baud_rate < 4800 {
        return Err(wrong(format!(
            "baud_rate is {baud_rate}, but must be one of 4800, 9600, 19200, 38400, 57600, 115200"
        )));
    }
    let device = cx.shared().network.device(&devname.to_text());
    let line = serial::settings(device, baud_rate, databits, stop_bits, parity)?;
    let tables = dev.tables.clone();
    dev.handle.open(cx, "open", Opening::Slave(SlaveSettings { line, unit, tables })).await
}

/// Opens a line; stop bits and parity in the order of the manual's example.
///
/// # Errors
/// Those of [`open`].
#[expect(clippy::too_many_arguments, reason = "the manual's")]
pub async fn open_stopbits_first(
    cx: &Cx,
    dev: &ModbusDev,
    devname: &Str,
    slave_id: i32,
    baud_rate: i32,
    stop_bits: Stopbits,
    databits: i32,
    parity: Parity,
) -> Result<bool, Fault> {
    open(cx, dev, devname, slave_id, baud_rate, parity, databits, stop_bits).await
}

/// Closes the line; does nothing if it is not open.
pub async fn close(cx: &Cx, dev: &ModbusDev) {
    cx.motion_end().await;
    dev.handle.close();
}

/// Reads `len` bytes of the holding registers from byte `start` on, high bytes first. True if the text was set.
///
/// # Errors
/// Bytes that no register has; the line is not open, or lost.
pub async fn read_string(cx: &Cx, dev: &ModbusDev, data: &mut Str, start: i32, len: i32) -> Result<bool, Fault> {
    let found = dev.with(cx, "read", start, len, usize::MAX, |bytes| Str::from(&*bytes)).await?;
    Ok(found.map(|text| *data = text).is_some())
}

/// Reads `len` bytes of the holding registers from byte `start` on, high bytes first. True if the array was filled.
///
/// # Errors
/// Bytes that no register has, a length beyond the array; the line is not open, or lost.
pub async fn read_bytes(cx: &Cx, dev: &ModbusDev, data: &mut [u8], start: i32, len: i32) -> Result<bool, Fault> {
    let room = data.len();
    let take = |bytes: &mut [u8]| data.iter_mut().zip(bytes).for_each(|(place, byte)| *place = *byte);
    Ok(dev.with(cx, "read", start, len, room, take).await?.is_some())
}

/// Writes a text into the holding registers from byte `start` on, high bytes first. True if it was written: the master
/// reads it from now on.
///
/// # Errors
/// Bytes that no register has; the line is not open, or lost.
pub async fn write_string(cx: &Cx, dev: &ModbusDev, data: &Str, start: i32) -> Result<bool, Fault> {
    let len = i32::try_from(data.as_bytes().len()).unwrap_or(i32::MAX);
    write_bytes(cx, dev, data.as_bytes(), start, len).await
}

/// Writes `len` bytes into the holding registers from byte `start` on, high bytes first. True if they were written: the
/// master reads them from now on.
///
/// # Errors
/// Bytes that no register has, a length beyond the array; the line is not open, or lost.
pub async fn write_bytes(cx: &Cx, dev: &ModbusDev, data: &[u8], start: i32, len: i32) -> Result<bool, Fault> {
    let put = |bytes: &mut [u8]| bytes.iter_mut().zip(data).for_each(|(place, byte)| *place = *byte);
    Ok(dev.with(cx, "write", start, len, data.len(), put).await?.is_some())
}

/// Sets all registers to 0; false if the line is not open.
///
/// # Errors
/// None.
pub async fn clearbuff(cx: &Cx, dev: &ModbusDev) -> Result<bool, Fault> {
    cx.motion_end().await;
    if !dev.handle.clear(cx).await {
        return Ok(false);
    }
    let all = 2 * SIZE as i32;
    Ok(dev.with(cx, "clearbuff", 0, all, usize::MAX, |bytes| bytes.fill(0)).await?.is_some())
}

/// Sets the longest period of the exchange between registers and line. It has no effect, as they are exchanged with
/// each request of the master.
///
/// # Errors
/// A period below 500000 us; the line is not open, or lost.
pub async fn setcycle(cx: &Cx, dev: &ModbusDev, cycle: i32) -> Result<(), Fault> {
    cx.motion_end().await;
    if cycle < SHORTEST_CYCLE {
        let problem = format!("cycle is {cycle} us, but must be {SHORTEST_CYCLE} or more").into();
        return Err(Fault::Domain { function: "setcycle", problem });
    }
    dev.assert_open("setcycle")
}

impl ModbusDev {
    fn assert_open(&self, function: &'static str) -> Result<(), Fault> {
        match self.handle.try_send(function, &[])? {
            Some(Found::Lost(reason)) => Err(fault(function, &format!("the line is lost: {reason}"))),
            _ => Ok(()),
        }
    }

    /// Calls `act` with bytes of the registers; `None` if that is not possible just now.
    async fn with<R>(
        &self,
        cx: &Cx,
        function: &'static str,
        start: i32,
        len: i32,
        room: usize,
        act: impl FnOnce(&mut [u8]) -> R,
    ) -> Result<Option<R>, Fault> {
        cx.motion_end().await;
        let wrong = |problem: String| Fault::Domain { function, problem: problem.into() };
        let range = usize::try_from(start).ok().zip(usize::try_from(len).ok());
        let range = range.filter(|(start, len)| start.saturating_add(*len) <= 2 * SIZE);
        let (start, len) = range.ok_or_else(|| {
            wrong(format!("{len} bytes from byte {start} are too many: the registers have bytes 0 to {}", 2 * SIZE - 1))
        })?;
        if len > room {
            return Err(wrong(format!("len is {len}, but the array has {room} bytes")));
        }
        self.assert_open(function)?;
        loop {
            match self.tables.try_lock() {
                Some(mut tables) => return Ok(bytes(&mut tables, start, len).map(act)),
                // A condition must be evaluated at once.
                None if cx.level() == Level::CONDITION => return Ok(None),
                None => cx.next_cycle().await,
            }
        }
    }
}

fn bytes(tables: &mut Tables, start: usize, len: usize) -> Option<&mut [u8]> {
    tables.registers_mut(0, SIZE)?.get_mut(start..start + len)
}
