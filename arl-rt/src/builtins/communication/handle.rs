//! A handle of a program is empty or holds a connection. This module has the rules of opening, reading, sending and
//! closing that sockets and serial lines share.

use std::cell::{Cell, RefCell};
use std::time::{Duration, Instant};

use crate::communication::inbox::{CAPACITY, Inbox};
use crate::communication::link::Link;
use crate::communication::opening::Opening;
use crate::communication::shared::LinkState;
use crate::context::cx::{Cx, Level};
use crate::fault::Fault;

/// How long to wait after a failed attempt before the next one.
const RETRY_PAUSE: Duration = Duration::from_millis(100);

/// A handle: empty, or a connection.
#[derive(Default, Debug)]
pub(super) struct ConnectionHandle {
    held: RefCell<Option<Held>>,
    /// The last message about failed attempts.
    last_warning: RefCell<String>,
}

/// A connection and what the program knows about it.
#[derive(Debug)]
struct Held {
    opening: Opening,
    link: Link,
    since: Instant,
    /// A call has reported to the program that the connection is established.
    known_open: Cell<bool>,
    /// A call has reported to the program that the connection is lost.
    known_lost: Cell<bool>,
}

/// The result of a call.
pub(super) enum Found<T> {
    /// The requested data.
    This(T),
    /// Not enough has arrived, or there is no room; or the buffer was not accessible just now.
    NotYet,
    /// The connection is lost, for this reason.
    Lost(String),
}

impl<T> Found<T> {
    /// Applies a function to the requested data.
    pub(super) fn then<R>(self, then: impl FnOnce(T) -> R) -> Found<R> {
        match self {
            Found::This(it) => Found::This(then(it)),
            Found::NotYet => Found::NotYet,
            Found::Lost(reason) => Found::Lost(reason),
        }
    }
}

impl ConnectionHandle {
    /// The state of the connection, for a debugger.
    pub(super) fn described(&self) -> String {
        let held = self.held.borrow();
        let Some(held) = held.as_ref().filter(|held| !held.link.is_closing()) else { return "closed".into() };
        let state = match held.link.state() {
            LinkState::Opening => "being opened".into(),
            LinkState::Open => "open".into(),
            LinkState::Failed(why) => format!("could not be opened: {why}"),
            LinkState::Lost(why) => format!("lost: {why}"),
        };
        format!("{state}, {}", held.opening)
    }

    /// Tries to open the connection; true once it is established.
    pub(super) fn attempt(&self, cx: &Cx, function: &'static str, opening: Opening) -> Result<bool, Fault> {
        let mut held = self.held.borrow_mut();
        match held.as_ref().filter(|held| !held.link.is_closing()) {
            Some(now) if now.known_open.get() => match now.link.state() {
                // An `&&` of several calls repeats those whose connections are established.
                LinkState::Open if now.opening == opening => return Ok(true),
                LinkState::Lost(_) if opening.is_free_of_closing() => {}
                LinkState::Lost(_) => return Err(fault(function, "the connection is lost: close it first")),
                _ => {
                    return Err(fault(
                        function,
                        &format!("the connection is already open, {}: close it first", now.opening),
                    ));
                }
            },
            Some(now) if now.opening == opening => match now.link.state() {
                LinkState::Opening => return Ok(false),
                // A client that connected, sent and disconnected in between still counts as connected.
                LinkState::Open | LinkState::Lost(_) => {
                    now.known_open.set(true);
                    self.last_warning.borrow_mut().clear();
                    return Ok(true);
                }
                LinkState::Failed(reason) => {
                    self.tell(cx, format!("{function} {opening}: {reason}; trying again"));
                    if now.since.elapsed() < RETRY_PAUSE {
                        return Ok(false);
                    }
                }
            },
            _ => {}
        }
        *held = None;
        let connections = cx.connections();
        if !connections.are_too_many() && (!opening.is_exclusive() || connections.are_free()) {
            *held = self.begin(cx, function, opening);
        }
        Ok(false)
    }

    /// Opens the connection and waits for the result; true if it is established.
    pub(super) async fn open(&self, cx: &Cx, function: &'static str, opening: Opening) -> Result<bool, Fault> {
        let state = |held: &Option<Held>| held.as_ref().filter(|it| !it.link.is_closing()).map(|it| it.link.state());
        if matches!(state(&self.held.borrow()), Some(LinkState::Opening | LinkState::Open)) {
            return Err(fault(function, "the connection is already open: close it first"));
        }
        self.close();
        // A connection closed just now may still hold the device.
        while !cx.connections().are_free() {
            cx.next_cycle().await;
        }
        let begun = self.begin(cx, function, opening.clone());
        *self.held.borrow_mut() = begun;
        loop {
            match state(&self.held.borrow()) {
                Some(LinkState::Opening) => {}
                Some(LinkState::Open) => {
                    self.held.borrow().iter().for_each(|held| held.known_open.set(true));
                    return Ok(true);
                }
                Some(LinkState::Failed(reason) | LinkState::Lost(reason)) => {
                    self.tell(cx, format!("{function} {opening}: {reason}"));
                    return Ok(false);
                }
                // The connection was closed meanwhile.
                None => return Ok(false),
            }
            cx.next_cycle().await;
        }
    }

    /// Begins to open the connection; `None` if the system cannot.
    fn begin(&self, cx: &Cx, function: &'static str, opening: Opening) -> Option<Held> {
        match Link::open(cx.connections(), &cx.shared().opener, opening.clone()) {
            Ok(link) => {
                cx.shared().need_real_time();
                let (known_open, known_lost) = (Cell::new(false), Cell::new(false));
                Some(Held { opening, link, since: Instant::now(), known_open, known_lost })
            }
            Err(error) => {
                self.tell(cx, format!("{function} {opening}: {error}"));
                None
            }
        }
    }

    /// Closes the connection if it exists.
    pub(super) fn close(&self) {
        self.held.take();
        self.last_warning.borrow_mut().clear();
    }

    /// Takes data from the received bytes.
    pub(super) fn take<T>(
        &self,
        function: &'static str,
        take: impl FnOnce(&mut Inbox) -> Option<T>,
    ) -> Result<Found<T>, Fault> {
        self.with(function, |held| {
            // In this order: data that arrived before the connection was lost is there once the loss is known.
            let state = held.link.state();
            let Some((taken, full)) = held.link.read(|inbox| (take(inbox), inbox.room() == 0)) else {
                return Ok(Found::NotYet);
            };
            match (taken, state) {
                (Some(taken), _) => Ok(Found::This(taken)),
                (None, LinkState::Lost(reason)) => {
                    held.known_lost.set(true);
                    Ok(Found::Lost(reason))
                }
                (None, _) if full => {
                    let text = format!("{CAPACITY} bytes have been received, but what is looked for is not among them");
                    Err(fault(function, &text))
                }
                (None, _) => Ok(Found::NotYet),
            }
        })
    }

    /// Sends bytes. While the thread holds the buffer, they wait for the next cycle: many programs do not check whether
    /// a message was sent, and an interrupted thread should not lose it.
    pub(super) async fn send(&self, cx: &Cx, function: &'static str, bytes: &[u8]) -> Result<Found<()>, Fault> {
        loop {
            match self.try_send(function, bytes)? {
                Some(found) => return Ok(found),
                // A condition must be evaluated at once.
                None if cx.level() == Level::CONDITION => return Ok(Found::NotYet),
                None => cx.next_cycle().await,
            }
        }
    }

    /// Sends bytes; `None` if the thread holds the buffer just now.
    pub(super) fn try_send(&self, function: &'static str, bytes: &[u8]) -> Result<Option<Found<()>>, Fault> {
        if bytes.len() > CAPACITY {
            let text = format!("{} bytes are too many: at most {CAPACITY} at once", bytes.len());
            return Err(Fault::Domain { function, problem: text.into() });
        }
        self.with(function, |held| {
            if let LinkState::Lost(reason) = held.link.state() {
                held.known_lost.set(true);
                return Ok(Some(Found::Lost(reason)));
            }
            Ok(held.link.send(bytes).map(|sent| if sent { Found::This(()) } else { Found::NotYet }))
        })
    }

    /// Discards the received bytes; true if the connection is established.
    pub(super) async fn clear(&self, cx: &Cx) -> bool {
        loop {
            let cleared =
                self.standing(|held| held.link.read(Inbox::clear).map(|()| held.link.state() == LinkState::Open));
            match cleared {
                None => return false,
                Some(Some(stands)) => return stands,
                // A condition must be evaluated at once.
                Some(None) if cx.level() == Level::CONDITION => return false,
                Some(None) => cx.next_cycle().await,
            }
        }
    }

    /// Whether the connection is lost, and nothing is left to be read or the program knows of the loss.
    pub(super) fn is_lost(&self) -> bool {
        let is_lost = |held: &Held| {
            matches!(held.link.state(), LinkState::Lost(_))
                && (held.known_lost.get() || held.link.read(|inbox| inbox.waiting().is_empty()) == Some(true))
        };
        self.standing(is_lost) == Some(true)
    }

    /// Calls `work` with the open connection.
    fn with<T>(&self, function: &'static str, work: impl FnOnce(&Held) -> Result<T, Fault>) -> Result<T, Fault> {
        self.standing(work).unwrap_or_else(|| Err(fault(function, "the connection is not open")))
    }

    /// Calls `work` with the connection that the program knows to be open; `None` without one.
    fn standing<T>(&self, work: impl FnOnce(&Held) -> T) -> Option<T> {
        let held = self.held.borrow();
        held.as_ref().filter(|held| held.known_open.get() && !held.link.is_closing()).map(work)
    }

    /// Warns the user, but not of the same thing twice in a row.
    fn tell(&self, cx: &Cx, text: String) {
        let mut last_warning = self.last_warning.borrow_mut();
        if *last_warning != text {
            cx.shared().warn(text.clone());
            *last_warning = text;
        }
    }
}

/// An alarm of a connection.
pub(super) fn fault(function: &'static str, problem: &str) -> Fault {
    Fault::Connection(format!("{function}: {problem}").into())
}

/// A number of bytes, from 0 to what an array or the buffer holds.
pub(super) fn length(function: &'static str, len: i32, most: usize, of: &str) -> Result<usize, Fault> {
    let length = usize::try_from(len).ok().filter(|length| *length <= most);
    length.ok_or_else(|| Fault::Domain {
        function,
        problem: format!("len is {len}, but must be 0 to {most}, {of}").into(),
    })
}
