//! Reads requests from a connection, one after the other, each within a time limit.

use std::io::Read;
use std::net::TcpStream;
use std::time::{Duration, Instant};

use super::Limits;
use super::response::Status;

/// The longest head of a request, in bytes.
const LONGEST_HEAD: usize = 1 << 14;
/// The longest body: no order is longer.
const LONGEST_BODY: usize = 1 << 16;
/// A browser sends about 20 headers.
const MOST_HEADERS: usize = 64;

/// A request.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(in super::super) struct Request {
    pub(in super::super) method: String,
    pub(in super::super) path: String,
    /// What follows the `?`.
    pub(in super::super) query: String,
    /// The host that is requested; empty: none is named.
    pub(in super::super) host: String,
    /// The page that makes the request.
    pub(in super::super) origin: Option<String>,
    pub(in super::super) body: Vec<u8>,
    /// Whether more requests may come.
    pub(super) keeps_open: bool,
}

/// Why a request is not valid.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Problem {
    pub(super) status: Status,
    pub(super) why: &'static str,
}

const BAD: Problem = Problem { status: Status::BadRequest, why: "this is not a request of HTTP/1.1" };
const LATE: Problem = Problem { status: Status::Timeout, why: "the request took too long" };
const LONG: Problem = Problem { status: Status::TooLarge, why: "the request is too long" };
const NO_LENGTH: Problem = Problem { status: Status::BadRequest, why: "a body needs exactly one Content-Length" };

/// The requests of a connection.
pub(super) struct Requests<'a> {
    stream: &'a TcpStream,
    limits: Limits,
    /// What has arrived and was not taken yet.
    buffer: Vec<u8>,
}

/// The result of reading.
enum Came {
    Something,
    /// The other side has closed, or nothing came in time.
    Nothing,
}

impl<'a> Requests<'a> {
    pub(super) fn new(stream: &'a TcpStream, limits: Limits) -> Self {
        Self { stream, limits, buffer: Vec::new() }
    }

    /// The next request; `None` once no more come.
    pub(super) fn next(&mut self) -> Option<Result<Request, Problem>> {
        if self.buffer.is_empty() && matches!(self.read(self.limits.idle), Came::Nothing) {
            return None;
        }
        let until = Instant::now() + self.limits.exchange;
        Some(self.request(until))
    }

    fn request(&mut self, until: Instant) -> Result<Request, Problem> {
        let (mut request, head, length) = loop {
            if let Some(found) = head(&self.buffer)? {
                break found;
            }
            if self.buffer.len() > LONGEST_HEAD {
                return Err(LONG);
            }
            self.read_until(until)?;
        };
        if length > LONGEST_BODY {
            return Err(LONG);
        }
        while self.buffer.len() < head + length {
            self.read_until(until)?;
        }
        request.body = self.buffer.drain(..head + length).skip(head).collect();
        Ok(request)
    }

    fn read_until(&mut self, until: Instant) -> Result<(), Problem> {
        match self.read(until.saturating_duration_since(Instant::now())) {
            Came::Something => Ok(()),
            Came::Nothing => Err(LATE),
        }
    }

    fn read(&mut self, limit: Duration) -> Came {
        let mut chunk = [0; 4096];
        // A limit of 0 would mean no limit.
        if limit.is_zero() || self.stream.set_read_timeout(Some(limit)).is_err() {
            return Came::Nothing;
        }
        match self.stream.read(&mut chunk) {
            Ok(count @ 1..) => {
                self.buffer.extend(chunk.iter().take(count));
                Came::Something
            }
            Ok(0) | Err(_) => Came::Nothing,
        }
    }
}

/// A request without its body, the length of its head, and that of its body; `None` where more has to arrive.
fn head(bytes: &[u8]) -> Result<Option<(Request, usize, usize)>, Problem> {
    let mut headers = [httparse::EMPTY_HEADER; MOST_HEADERS];
    let mut parsed = httparse::Request::new(&mut headers);
    let httparse::Status::Complete(length) = parsed.parse(bytes).map_err(|_| BAD)? else { return Ok(None) };
    let all = |name: &str| {
        let own = parsed.headers.iter().filter(|header| header.name.eq_ignore_ascii_case(name));
        own.filter_map(|header| std::str::from_utf8(header.value).ok()).map(str::trim).collect::<Vec<_>>()
    };
    let body = match (&all("transfer-encoding")[..], &all("content-length")[..]) {
        ([], []) => 0,
        ([], [length]) if length.bytes().all(|byte| byte.is_ascii_digit()) => length.parse().map_err(|_| LONG)?,
        _ => return Err(NO_LENGTH),
    };
    let closes = all("connection")
        .iter()
        .flat_map(|value| value.split(','))
        .any(|word| word.trim().eq_ignore_ascii_case("close"));
    let (path, query) =
        parsed.path.unwrap_or_default().split_once('?').unwrap_or((parsed.path.unwrap_or_default(), ""));
    let request = Request {
        method: parsed.method.unwrap_or_default().to_owned(),
        path: path.to_owned(),
        query: query.to_owned(),
        // Several hosts count as none.
        host: match &all("host")[..] {
            [host] => (*host).to_owned(),
            _ => String::new(),
        },
        origin: all("origin").first().map(|origin| (*origin).to_owned()),
        body: Vec::new(),
        keeps_open: parsed.version == Some(1) && !closes,
    };
    Ok(Some((request, length, body)))
}
