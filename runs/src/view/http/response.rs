//! Responses as they are written to a connection.

use std::io::{self, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

/// The page may load only what this server has.
const POLICY: &str = "default-src 'self'; img-src 'self' data:; style-src 'self'; frame-ancestors 'none'";
const TEXT: &str = "text/plain; charset=utf-8";
/// How much is written at once.
const PIECE: usize = 1 << 16;

/// The outcome of a request.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(in super::super) enum Status {
    Ok,
    BadRequest,
    Forbidden,
    NotFound,
    MethodNotAllowed,
    Timeout,
    Conflict,
    TooLarge,
}

impl Status {
    /// Its number and its text.
    fn line(self) -> &'static str {
        match self {
            Self::Ok => "200 OK",
            Self::BadRequest => "400 Bad Request",
            Self::Forbidden => "403 Forbidden",
            Self::NotFound => "404 Not Found",
            Self::MethodNotAllowed => "405 Method Not Allowed",
            Self::Timeout => "408 Request Timeout",
            Self::Conflict => "409 Conflict",
            Self::TooLarge => "413 Content Too Large",
        }
    }
}

/// A response.
#[derive(Debug)]
pub(in super::super) struct Response {
    status: Status,
    kind: &'static str,
    body: Vec<u8>,
}

impl Response {
    /// Bytes of a type.
    pub(in super::super) fn new(status: Status, kind: &'static str, body: Vec<u8>) -> Self {
        Self { status, kind, body }
    }

    /// A text for people.
    pub(in super::super) fn text(status: Status, text: &str) -> Self {
        Self::new(status, TEXT, text.as_bytes().to_vec())
    }

    /// Writes it to a client that has to take all of it within a time.
    pub(super) fn write(&self, mut stream: &TcpStream, keeps_open: bool, limit: Duration) -> io::Result<()> {
        let Self { status, kind, body } = self;
        let connection = if keeps_open { "keep-alive" } else { "close" };
        let head = format!(
            "HTTP/1.1 {}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\nConnection: {connection}\r\n\
             Cache-Control: no-store\r\n\
             X-Content-Type-Options: nosniff\r\nContent-Security-Policy: {POLICY}\r\n\r\n",
            status.line(),
            body.len()
        );
        let until = Instant::now() + limit;
        for mut piece in std::iter::once(head.as_bytes()).chain(body.chunks(PIECE)) {
            while !piece.is_empty() {
                let remaining = until.saturating_duration_since(Instant::now());
                if remaining.is_zero() {
                    return Err(io::ErrorKind::TimedOut.into());
                }
                // Set for each write: `write_all` would start the time again with every byte that is taken.
                stream.set_write_timeout(Some(remaining))?;
                match stream.write(piece) {
                    Ok(0) => return Err(io::ErrorKind::WriteZero.into()),
                    Ok(count) => piece = piece.get(count..).unwrap_or_default(),
                    Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                    Err(error) => return Err(error),
                }
            }
        }
        Ok(())
    }
}
