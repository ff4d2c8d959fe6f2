//! Melsec (manual 5.6.5): D registers of a PLC, read and written by the MC protocol (3E frames, binary) over TCP. Each
//! call tries once and returns whether it is done.

mod frame;

use std::cell::RefCell;
use std::collections::HashSet;
use std::rc::Rc;
use std::time::{Duration, Instant};

use super::handle::{ConnectionHandle, Found, fault};
use crate::communication::opening::Opening;
use crate::context::cx::Cx;
use crate::context::shown::Shown;
use crate::fault::Fault;
use crate::values::Str;
use frame::{LAST_REGISTER, MOST_REGISTERS, ReceivedFrame};

/// How long a PLC may be silent: a second more than the time that the request allows it.
const ANSWER_TIMEOUT: Duration = Duration::from_secs(5);

/// A connection to a PLC. It is closed at first, and again once its last copy is dropped.
#[derive(Clone, Default, Debug)]
pub struct MelsecDev {
    handle: Rc<ConnectionHandle>,
    talk: Rc<RefCell<Talk>>,
}

impl Shown for MelsecDev {
    fn type_name(&self) -> String {
        "melsec_dev".into()
    }

    fn shown(&self, _: &Cx) -> String {
        self.handle.described()
    }
}

/// The state of requests and reports.
#[derive(Default, Debug)]
struct Talk {
    /// The station that the program named.
    pc: u8,
    asked: Option<Asked>,
    /// The errors of the PLC that have been reported to the user.
    reported: HashSet<String>,
}

/// A request without an answer so far.
#[derive(Debug)]
struct Asked {
    request: Vec<u8>,
    since: Instant,
}

/// Connects to a PLC; true once the connection is established.
///
/// # Errors
/// A port outside 1 to 65535, a station that is neither 0 to 247 nor 255; the connection is open to something else.
pub async fn open(cx: &Cx, dev: &MelsecDev, ip: &Str, port: i32, slave_id: i32) -> Result<bool, Fault> {
    cx.motion_end().await;
    let wrong = |problem: String| Fault::Domain { function: "open", problem: problem.into() };
    let number = u16::try_from(port).ok().filter(|number| *number > 0);
    let port = number.ok_or_else(|| wrong(format!("port is {port}, but must be 1 to 65535")))?;
    let pc = u8::try_from(slave_id).ok().filter(|pc| *pc <= 247 || *pc == 255);
    let pc =
        pc.ok_or_else(|| wrong(format!("slave_id is {slave_id}, but must be 0 to 247, or 255 for the PLC itself")))?;
    let open = dev.handle.attempt(cx, "open", Opening::Connect { host: ip.to_text().into_owned(), port })?;
    let mut talk = dev.talk.borrow_mut();
    talk.pc = pc;
    if !open {
        talk.asked = None;
    }
    Ok(open)
}

/// Closes a connection; does nothing if it is not open.
pub async fn close(cx: &Cx, dev: &MelsecDev) {
    cx.motion_end().await;
    dev.handle.close();
    dev.talk.borrow_mut().asked = None;
}

/// Reads `len` bytes of D registers, low bytes first; true once they have arrived. Until then the text stays.
///
/// # Errors
/// A start outside 0 to 16777215, a length outside 0 to 1920; the connection is not open, or lost; the PLC is silent
/// for 5 s.
pub async fn read_string(cx: &Cx, dev: &MelsecDev, data: &mut Str, start: i32, len: i32) -> Result<bool, Fault> {
    cx.motion_end().await;
    let found = dev.read(cx, start, len, usize::MAX)?;
    Ok(found.map(|bytes| *data = bytes.into()).is_some())
}

/// Reads `len` bytes of D registers, low bytes first; true once they have arrived. The rest of the array stays.
///
/// # Errors
/// Those of [`read_string`], and a length beyond the array.
pub async fn read_bytes(cx: &Cx, dev: &MelsecDev, data: &mut [u8], start: i32, len: i32) -> Result<bool, Fault> {
    cx.motion_end().await;
    let found = dev.read(cx, start, len, data.len())?;
    Ok(found.map(|bytes| data.iter_mut().zip(bytes).for_each(|(place, byte)| *place = byte)).is_some())
}

/// Writes a text, or its first `len` bytes, into D registers; true once the PLC has accepted them.
///
/// # Errors
/// Those of [`read_string`], and a length beyond the text.
pub async fn write_string(cx: &Cx, dev: &MelsecDev, data: &Str, start: i32, len: Option<i32>) -> Result<bool, Fault> {
    cx.motion_end().await;
    let all = i32::try_from(data.as_bytes().len()).unwrap_or(i32::MAX);
    dev.write(cx, data.as_bytes(), start, len.unwrap_or(all))
}

/// Writes the first `len` bytes into D registers; true once the PLC has accepted them.
///
/// # Errors
/// Those of [`read_string`], and a length beyond the array.
pub async fn write_bytes(cx: &Cx, dev: &MelsecDev, data: &[u8], start: i32, len: i32) -> Result<bool, Fault> {
    cx.motion_end().await;
    dev.write(cx, data, start, len)
}

impl MelsecDev {
    fn read(&self, cx: &Cx, start: i32, len: i32, room: usize) -> Result<Option<Vec<u8>>, Fault> {
        let (start, len) = range("read", start, len, room)?;
        let request = frame::read(self.talk.borrow().pc, start, len.div_ceil(2) as u16);
        let found = self.ask(cx, "read", len, request)?;
        let Some(mut bytes) = found else { return Ok(None) };
        if bytes.len() != len.next_multiple_of(2) {
            self.handle.close();
            let asked = len.next_multiple_of(2);
            return Err(fault("read", &format!("the PLC sent {} bytes instead of {asked}", bytes.len())));
        }
        bytes.truncate(len);
        Ok(Some(bytes))
    }

    fn write(&self, cx: &Cx, data: &[u8], start: i32, len: i32) -> Result<bool, Fault> {
        let (start, len) = range("write", start, len, data.len())?;
        let request = frame::write(self.talk.borrow().pc, start, data.get(..len).unwrap_or_default());
        Ok(self.ask(cx, "write", len, request)?.is_some())
    }

    /// Sends a request, or checks for the answer to the last one; the data once the PLC has carried it out.
    fn ask(&self, cx: &Cx, function: &'static str, len: usize, request: Vec<u8>) -> Result<Option<Vec<u8>>, Fault> {
        let mut talk = self.talk.borrow_mut();
        if let Some(asked) = &talk.asked {
            // Answers carry no number: each must be taken before the next request.
            let Some((code, data)) = self.answer(function, asked.since)? else { return Ok(None) };
            let same = asked.request == request;
            talk.asked = None;
            if same && code == 0 {
                return Ok(Some(data));
            }
            if code != 0 {
                let text = format!("{function}: the PLC refused the request with code {code:04x}h");
                if talk.reported.len() < super::MAX_REPORTED_ERRORS && talk.reported.insert(text.clone()) {
                    let (file, line) = cx.place();
                    cx.shared().warn(format!("{text} ({}:{line})", file.name()));
                }
            }
            if same {
                return Ok(None);
            }
        }
        if len == 0 {
            // Nothing to request; a connection that is not open is reported all the same.
            return Ok(match self.handle.try_send(function, &[])? {
                Some(Found::Lost(reason)) => return Err(lost(function, &reason)),
                _ => Some(Vec::new()),
            });
        }
        // Bytes that are already there would be taken for the answer.
        match self.handle.take(function, |inbox| Some(inbox.waiting().is_empty()))? {
            Found::This(true) => {}
            Found::NotYet => return Ok(None),
            Found::This(false) | Found::Lost(_) => {
                self.handle.close();
                return Err(fault(function, "the PLC has sent more than it was asked for"));
            }
        }
        // A request that could not be sent is repeated in the next cycle, as the call returns that it is not done.
        match self.handle.try_send(function, &request)? {
            Some(Found::This(())) => talk.asked = Some(Asked { request, since: Instant::now() }),
            Some(Found::NotYet) | None => {}
            Some(Found::Lost(reason)) => return Err(lost(function, &reason)),
        }
        Ok(None)
    }

    /// The answer, as code and data, if it has arrived.
    fn answer(&self, function: &'static str, since: Instant) -> Result<Option<(u16, Vec<u8>)>, Fault> {
        let found = self.handle.take(function, |inbox| match frame::first(inbox.waiting()) {
            ReceivedFrame::Answer { code, data, size } => inbox.take(size).map(|_| Ok((code, data))),
            ReceivedFrame::Part => None,
            ReceivedFrame::Garbage => Some(Err("the other side does not speak the MC protocol (3E, binary)")),
        })?;
        let problem = match found {
            Found::This(Ok(answer)) => return Ok(Some(answer)),
            Found::NotYet if since.elapsed() < ANSWER_TIMEOUT => return Ok(None),
            Found::NotYet => "the PLC does not answer",
            Found::This(Err(problem)) => problem,
            Found::Lost(reason) => return Err(lost(function, &reason)),
        };
        // Bytes that may still arrive would be taken for the answer to another request.
        self.handle.close();
        Err(fault(function, problem))
    }
}

fn lost(function: &'static str, reason: &str) -> Fault {
    fault(function, &format!("the connection to the PLC is lost: {reason}"))
}

/// The first register and the number of bytes.
fn range(function: &'static str, start: i32, len: i32, room: usize) -> Result<(u32, usize), Fault> {
    let wrong = |problem: String| Fault::Domain { function, problem: problem.into() };
    let most = (2 * MOST_REGISTERS).min(room);
    let length = usize::try_from(len).ok().filter(|length| *length <= most);
    let length = length.ok_or_else(|| wrong(format!("len is {len}, but must be 0 to {most} bytes here")))?;
    let last = i64::from(start) + length.div_ceil(2).max(1) as i64 - 1;
    match u32::try_from(start) {
        Ok(first) if last <= i64::from(LAST_REGISTER) => Ok((first, length)),
        _ => Err(wrong(format!("D{start} to D{last} do not exist, only D0 to D{LAST_REGISTER}"))),
    }
}

/// The size of the answer at the start of the received bytes, if it is complete.
#[cfg(feature = "fuzzing")]
pub(crate) fn answer_size(bytes: &[u8]) -> Option<usize> {
    match frame::first(bytes) {
        frame::ReceivedFrame::Answer { size, data, .. } => {
            assert!(data.len() < size);
            Some(size)
        }
        _ => None,
    }
}
