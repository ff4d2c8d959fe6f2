//! Modbus TCP: the controller is the server; these functions work on its own registers and coils.

use crate::context::cx::{Cx, Level};
use crate::fault::Fault;
use crate::fieldbus::modbus::{SIZE, Tables};
use crate::values::Str;

/// Reads `len` registers from `start` on as a text of two bytes a register, zeros included.
///
/// # Errors
/// None: false if the registers do not exist.
pub async fn readregisters_string(cx: &Cx, data: &mut Str, start: i32, len: i32) -> Result<bool, Fault> {
    let read = with_registers(cx, "readregisters", start, len, |registers| Ok(Str::from(&*registers))).await;
    Ok(read.map(|text| *data = text).is_some())
}

/// Reads `len` registers from `start` on as two bytes each; the rest of the array stays.
///
/// # Errors
/// None: false if the registers do not exist, or the array has no room for them.
pub async fn readregisters_bytes(cx: &Cx, data: &mut [u8], start: i32, len: i32) -> Result<bool, Fault> {
    let size = data.len();
    let read = with_registers(cx, "readregisters", start, len, |registers| {
        let room = data.get_mut(..registers.len()).ok_or_else(|| short(registers.len(), size))?;
        room.copy_from_slice(registers);
        Ok(())
    });
    Ok(read.await.is_some())
}

/// Writes a text into registers from `start` on, two bytes a register: all of it, or as much as fits into `len`
/// registers; the remaining bytes of these become 0.
///
/// # Errors
/// None: false if the registers do not exist.
pub async fn writeregisters_string(cx: &Cx, data: &Str, start: i32, len: Option<i32>) -> Result<bool, Fault> {
    let all = i32::try_from(data.as_bytes().len().div_ceil(2)).unwrap_or(i32::MAX);
    let written = with_registers(cx, "writeregisters", start, len.unwrap_or(all), |registers| {
        registers.copy_from_slice(&padded(data, registers.len()));
        Ok(())
    });
    Ok(written.await.is_some())
}

/// Writes two bytes each into `len` registers from `start` on.
///
/// # Errors
/// None: false if the registers do not exist, or the array has too few bytes.
pub async fn writeregisters_bytes(cx: &Cx, data: &[u8], start: i32, len: i32) -> Result<bool, Fault> {
    let written = with_registers(cx, "writeregisters", start, len, |registers| {
        registers.copy_from_slice(data.get(..registers.len()).ok_or_else(|| short(registers.len(), data.len()))?);
        Ok(())
    });
    Ok(written.await.is_some())
}

/// Reads `length` coils from `start` on, eight a byte, the first in the lowest bit; surplus bits become 0, the rest of
/// the array stays.
///
/// # Errors
/// None: false if the coils do not exist, or the array has no room for them.
pub async fn readcoils(cx: &Cx, data: &mut [u8], start: i32, length: i32) -> Result<bool, Fault> {
    let size = data.len();
    let read = with_coils(cx, "readcoils", start, length, |tables, start, count| {
        tables.read_coils(start, count, data).ok_or_else(|| short(count.div_ceil(8), size))
    });
    Ok(read.await.is_some())
}

/// Sets `length` coils from `start` on, eight a byte, the first from the lowest bit.
///
/// # Errors
/// None: false if the coils do not exist, or the array has too few bytes.
pub async fn writecoils(cx: &Cx, data: &[u8], start: i32, length: i32) -> Result<bool, Fault> {
    let written = with_coils(cx, "writecoils", start, length, |tables, start, count| {
        tables.write_coils(start, count, data).ok_or_else(|| short(count.div_ceil(8), data.len()))
    });
    Ok(written.await.is_some())
}

/// Calls `act` with the bytes of registers.
async fn with_registers<R>(
    cx: &Cx,
    function: &'static str,
    start: i32,
    len: i32,
    act: impl FnOnce(&mut [u8]) -> Result<R, String>,
) -> Option<R> {
    exchange(cx, function, "register", start, len, |tables, start, count| {
        // They have been checked to exist.
        act(tables.registers_mut(start, count).unwrap_or_default())
    })
    .await
}

/// Calls `act` with coils.
async fn with_coils(
    cx: &Cx,
    function: &'static str,
    start: i32,
    len: i32,
    act: impl FnOnce(&mut Tables, usize, usize) -> Result<(), String>,
) -> Option<()> {
    exchange(cx, function, "coil", start, len, act).await
}

/// Calls `act` with the tables, once all motion has ended; if that is not possible, reports the problem and returns
/// `None`.
async fn exchange<R>(
    cx: &Cx,
    function: &'static str,
    what: &'static str,
    start: i32,
    count: i32,
    act: impl FnOnce(&mut Tables, usize, usize) -> Result<R, String>,
) -> Option<R> {
    cx.motion_end().await;
    let shared = cx.shared().buses.modbus_tables();
    let done = match range(what, start, count) {
        Err(problem) => Err(problem),
        Ok((start, count)) => loop {
            match shared.try_lock() {
                Some(mut tables) => break act(&mut tables, start, count),
                // A condition must be evaluated at once.
                None if cx.level() == Level::CONDITION => return None,
                None => cx.next_cycle().await,
            }
        },
    };
    done.map_err(|problem| report(cx, format!("{function}: {problem}"))).ok()
}

/// Start and count, if these registers or coils exist.
fn range(what: &str, start: i32, count: i32) -> Result<(usize, usize), String> {
    if count < 0 {
        return Err(format!("the number of {what}s is {count}, but must be 0 or more"));
    }
    let wanted = usize::try_from(start).ok().zip(usize::try_from(count).ok());
    wanted.filter(|(start, count)| start + count <= SIZE).ok_or_else(|| {
        let named = match i64::from(start) + i64::from(count) - 1 {
            last if last > i64::from(start) => format!("{what}s {start} to {last} do not exist"),
            _ => format!("{what} {start} does not exist"),
        };
        format!("{named}, only 0 to {}", SIZE - 1)
    })
}

fn short(needed: usize, size: usize) -> String {
    format!("{needed} bytes are needed, but the array has {size}")
}

/// Warns why a function returns false, with its place in the program; each message only once, as programs try again in
/// each cycle.
fn report(cx: &Cx, problem: String) {
    let shared = cx.shared();
    let (file, line) = cx.place();
    let text = format!("{problem} ({}:{line})", file.name());
    if shared.buses.is_new_report(&text) {
        shared.warn(text);
    }
}

/// `len` bytes of a text; zeros after its end.
fn padded(text: &Str, len: usize) -> Vec<u8> {
    let mut bytes = text.as_bytes().to_vec();
    bytes.resize(len, 0);
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_exist_is_named() {
        let named = |start, count| range("coil", start, count).unwrap_err();
        assert_eq!(named(65_536, 1), "coil 65536 does not exist, only 0 to 65535");
        assert_eq!(named(-1, 0), "coil -1 does not exist, only 0 to 65535");
        assert_eq!(named(65_535, 2), "coils 65535 to 65536 do not exist, only 0 to 65535");
        assert_eq!(named(0, -1), "the number of coils is -1, but must be 0 or more");
        assert_eq!(range("coil", 65_535, 1), Ok((65_535, 1)));
        assert_eq!(
            range("coil", i32::MAX, i32::MAX).unwrap_err(),
            "coils 2147483647 to 4294967293 do not exist, only 0 to 65535"
        );
    }
}
