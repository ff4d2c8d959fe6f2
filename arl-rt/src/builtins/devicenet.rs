//! `dnwrite` and `dnread`: the buffer that is exchanged with the DeviceNet bus.

use crate::context::cx::Cx;
use crate::fault::Fault;
use crate::fieldbus::devicenet::ErrorCode;

/// Offset or length are outside the buffer.
const OUTSIDE_BUFFER: i32 = 1;

/// The program's array has fewer bytes than the length.
const ARRAY_TOO_SHORT: i32 = 2;

/// Writes bytes into the bus's buffer. 0: done; 1: offset or length outside the buffer; 2: the array is shorter than
/// the length; other codes come from the bus.
///
/// # Errors
/// None: errors are reported by the result.
pub async fn dnwrite(cx: &Cx, offset: i32, len: i32, data: &[u8]) -> Result<i32, Fault> {
    cx.motion_end().await;
    let mut bus = cx.shared().buses.devicenet();
    let Some((offset, len)) = place(offset, len, bus.size()) else { return Ok(OUTSIDE_BUFFER) };
    let Some(data) = data.get(..len) else { return Ok(ARRAY_TOO_SHORT) };
    Ok(code(bus.write(offset, data)))
}

/// Reads bytes from the bus's buffer; the rest of the array stays. The result codes are those of [`dnwrite`].
///
/// # Errors
/// None: errors are reported by the result.
pub async fn dnread(cx: &Cx, offset: i32, len: i32, data: &mut [u8]) -> Result<i32, Fault> {
    cx.motion_end().await;
    let mut bus = cx.shared().buses.devicenet();
    let Some((offset, len)) = place(offset, len, bus.size()) else { return Ok(OUTSIDE_BUFFER) };
    let Some(data) = data.get_mut(..len) else { return Ok(ARRAY_TOO_SHORT) };
    Ok(code(bus.read(offset, data)))
}

fn place(offset: i32, len: i32, size: usize) -> Option<(usize, usize)> {
    let (offset, len) = (usize::try_from(offset).ok()?, usize::try_from(len).ok()?);
    (offset.checked_add(len)? <= size).then_some((offset, len))
}

fn code(done: Result<(), ErrorCode>) -> i32 {
    done.map_or_else(ErrorCode::number, |()| 0)
}
