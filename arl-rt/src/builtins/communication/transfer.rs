//! `write`, `read` and `readuntil` work alike on sockets and serial lines. Each result is returned with the name of the
//! function, for the caller, which decides what a lost connection means.

use super::handle::{ConnectionHandle, Found, length};
use crate::communication::inbox::CAPACITY;
use crate::context::cx::Cx;
use crate::fault::Fault;
use crate::values::Str;

type Transfer = Result<(&'static str, Found<()>), Fault>;

/// Sends a text.
pub(super) async fn write(cx: &Cx, handle: &ConnectionHandle, bytes: &[u8]) -> Transfer {
    Ok(("write", handle.send(cx, "write", bytes).await?))
}

/// Sends the first bytes of an array.
pub(super) async fn write_first(cx: &Cx, handle: &ConnectionHandle, data: &[u8], len: i32) -> Transfer {
    let length = length("write", len, data.len(), "the size of the array")?;
    write(cx, handle, data.get(..length).unwrap_or_default()).await
}

/// Takes `len` bytes as a text.
pub(super) fn read_text(handle: &ConnectionHandle, data: &mut Str, len: i32) -> Transfer {
    let length = length("read", len, CAPACITY, "the size of the buffer")?;
    let found = handle.take("read", |inbox| inbox.take(length))?;
    Ok(("read", found.then(|bytes| *data = bytes.as_slice().into())))
}

/// Takes `len` bytes into the start of an array.
pub(super) fn read_bytes(handle: &ConnectionHandle, data: &mut [u8], len: i32) -> Transfer {
    let length = length("read", len, data.len(), "the size of the array")?;
    let found = handle.take("read", |inbox| inbox.take(length))?;
    Ok(("read", found.then(|bytes| data.iter_mut().zip(bytes).for_each(|(to, from)| *to = from))))
}

/// Takes the text before a mark.
pub(super) fn read_until(handle: &ConnectionHandle, data: &mut Str, cut: &Str) -> Transfer {
    const NAME: &str = "readuntil";
    if cut.is_empty() {
        return Err(Fault::Domain { function: NAME, problem: "cut is empty: give the text to read up to".into() });
    }
    let found = handle.take(NAME, |inbox| inbox.take_until(cut.as_bytes()))?;
    Ok((NAME, found.then(|bytes| *data = bytes.as_slice().into())))
}
