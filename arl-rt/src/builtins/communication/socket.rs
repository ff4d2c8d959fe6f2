//! Sockets (manual 5.6.1). Each call tries once and returns whether it is done.

use std::rc::Rc;

use super::handle::{ConnectionHandle, Found, fault};
use super::transfer;
use crate::communication::opening::Opening;
use crate::context::cx::Cx;
use crate::context::shown::Shown;
use crate::fault::Fault;
use crate::values::Str;

pub use super::network::{getip, setip};

/// A TCP connection. It is closed at first, and again once its last copy is dropped.
#[derive(Clone, Default, Debug)]
pub struct Socket(Rc<ConnectionHandle>);

impl Shown for Socket {
    fn type_name(&self) -> String {
        "socket".into()
    }

    fn shown(&self, _: &Cx) -> String {
        self.0.described()
    }
}

/// Connects to a server; true once the connection is established.
///
/// # Errors
/// A port outside 1 to 65535; the socket is open to something else.
pub async fn connect(cx: &Cx, s: &Socket, ip: &Str, port: i32) -> Result<bool, Fault> {
    cx.motion_end().await;
    let opening = Opening::Connect { host: ip.to_text().into_owned(), port: port_number("connect", port)? };
    s.0.attempt(cx, "connect", opening)
}

/// Listens for a client; true once one has connected.
///
/// # Errors
/// A port outside 1 to 65535; the socket is open, or was and has not been closed.
pub async fn accept(cx: &Cx, s: &Socket, ip: &Str, port: i32) -> Result<bool, Fault> {
    cx.motion_end().await;
    let port = port_number("accept", port)?;
    let host = cx.shared().network.listen(&ip.to_text());
    s.0.attempt(cx, "accept", Opening::Accept { host, port })
}

/// The error state: 0, or `$ERR_SOCKET_CLOSED` once the other side has closed the connection and either nothing is left
/// to be read or a call has noticed it.
///
/// # Errors
/// None.
pub async fn geterror(cx: &Cx, s: &Socket) -> Result<i32, Fault> {
    cx.motion_end().await;
    Ok(if s.0.is_lost() { cx.system().err_socket_closed.get() } else { 0 })
}

/// Closes a connection as soon as the bytes to send have been sent.
pub async fn close(cx: &Cx, s: &Socket) {
    cx.motion_end().await;
    s.0.close();
}

/// Sends a text; true if all of it was accepted for sending.
///
/// # Errors
/// The socket is not or no longer connected; the text is longer than 1 MiB.
pub async fn write_string(cx: &Cx, s: &Socket, data: &Str) -> Result<bool, Fault> {
    cx.motion_end().await;
    done(cx, transfer::write(cx, &s.0, data.as_bytes()).await?)
}

/// Sends the first `len` bytes; true if all of them were accepted for sending.
///
/// # Errors
/// The socket is not or no longer connected; a length below 0 or beyond the array.
pub async fn write_bytes(cx: &Cx, s: &Socket, data: &[u8], len: i32) -> Result<bool, Fault> {
    cx.motion_end().await;
    done(cx, transfer::write_first(cx, &s.0, data, len).await?)
}

/// Takes exactly `len` bytes once they have arrived.
///
/// # Errors
/// The socket is not connected, or the other side has closed it before they arrived; a length below 0 or above 1 MiB.
pub async fn read_string(cx: &Cx, s: &Socket, data: &mut Str, len: i32) -> Result<bool, Fault> {
    cx.motion_end().await;
    done(cx, transfer::read_text(&s.0, data, len)?)
}

/// Takes exactly `len` bytes once they have arrived.
///
/// # Errors
/// The socket is not connected, or the other side has closed it before they arrived; a length below 0 or beyond the
/// array.
pub async fn read_bytes(cx: &Cx, s: &Socket, data: &mut [u8], len: i32) -> Result<bool, Fault> {
    cx.motion_end().await;
    done(cx, transfer::read_bytes(&s.0, data, len)?)
}

/// Takes the text before a mark once the mark has arrived; both are removed from the buffer.
///
/// # Errors
/// The socket is not connected, or the other side has closed it before the mark arrived; an empty mark; 1 MiB without
/// it.
pub async fn readuntil(cx: &Cx, s: &Socket, data: &mut Str, cut: &Str) -> Result<bool, Fault> {
    cx.motion_end().await;
    done(cx, transfer::read_until(&s.0, data, cut)?)
}

/// Discards bytes that have arrived but have not been read; false if the socket is not connected.
///
/// # Errors
/// None.
pub async fn clearbuff(cx: &Cx, s: &Socket) -> Result<bool, Fault> {
    cx.motion_end().await;
    Ok(s.0.clear(cx).await)
}

/// A lost connection is an alarm, unless the program checks for it itself.
fn done(cx: &Cx, (function, found): (&'static str, Found<()>)) -> Result<bool, Fault> {
    match found {
        Found::This(()) => Ok(true),
        Found::NotYet => Ok(false),
        Found::Lost(_) if cx.system().detect_socket_close.get() => Ok(false),
        Found::Lost(reason) => Err(fault(function, &format!("the connection is lost: {reason}"))),
    }
}

fn port_number(function: &'static str, port: i32) -> Result<u16, Fault> {
    let number = u16::try_from(port).ok().filter(|number| *number > 0);
    number.ok_or_else(|| Fault::Domain { function, problem: format!("port is {port}, but must be 1 to 65535").into() })
}
