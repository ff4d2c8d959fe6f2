//! The connection to a debugger: lines are received and sent on threads of their own, so that no cycle waits for them.

use std::io::{BufRead, BufReader, Result, Write};
use std::net::{Shutdown, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::{Builder, JoinHandle};

use arl_motion::beside;

use crate::command::connection;

/// A request of a debugger: a number, a word, and the arguments of the word.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct DebugRequest {
    /// The answer has the same number.
    pub(super) number: u64,
    pub(super) word: String,
    pub(super) values: Vec<String>,
}

impl DebugRequest {
    fn parse(line: &str) -> Option<Self> {
        let mut parts = line.split('\t').map(str::to_owned);
        Some(Self { number: parts.next()?.parse().ok()?, word: parts.next()?, values: parts.collect() })
    }

    /// An argument by its index; empty where it is missing.
    pub(super) fn value(&self, at: usize) -> &str {
        self.values.get(at).map_or("", String::as_str)
    }

    /// An argument that is a number; 0 where it is not one.
    pub(super) fn whole(&self, at: usize) -> u64 {
        self.value(at).parse().unwrap_or(0)
    }
}

/// The connection.
pub(crate) struct DebugLink {
    requests: Receiver<DebugRequest>,
    /// How many requests wait, so that checking costs nothing.
    waiting: Arc<AtomicUsize>,
    /// `None` at the end.
    lines: Option<Sender<String>>,
    writer: Option<JoinHandle<()>>,
    stream: TcpStream,
}

/// The number of waiting requests from which on the debugger is gone.
const GONE: usize = usize::MAX / 2;

impl DebugLink {
    pub(super) fn connect(address: &str) -> Result<Self> {
        let stream = connection::connect(address)?;
        stream.set_nodelay(true)?;
        let (sender, requests) = channel();
        let (lines, outgoing) = channel::<String>();
        let waiting = Arc::new(AtomicUsize::new(0));
        let (counter, incoming) = (Arc::clone(&waiting), BufReader::new(stream.try_clone()?));
        beside::spawn(Builder::new().name("debugger".into()), move || {
            for line in incoming.lines() {
                let Ok(line) = line else { break };
                if let Some(request) = DebugRequest::parse(&line) {
                    counter.fetch_add(1, Ordering::Release);
                    if sender.send(request).is_err() {
                        return;
                    }
                }
            }
            counter.fetch_add(GONE, Ordering::Release);
        })?;
        let mut out = stream.try_clone()?;
        let writer = beside::spawn(Builder::new().name("debugged".into()), move || {
            for line in outgoing {
                if out.write_all(line.as_bytes()).is_err() {
                    return;
                }
            }
        })?;
        Ok(Self { requests, waiting, lines: Some(lines), writer: Some(writer), stream })
    }

    /// A request that has arrived, if any.
    #[inline]
    pub(super) fn take(&self) -> Option<DebugRequest> {
        if self.waiting.load(Ordering::Acquire) == 0 {
            return None;
        }
        let request = self.requests.try_recv().ok()?;
        self.waiting.fetch_sub(1, Ordering::Release);
        Some(request)
    }

    /// The next request, once it arrives; `None` where the debugger is gone.
    pub(super) fn wait(&self) -> Option<DebugRequest> {
        let request = self.requests.recv().ok()?;
        self.waiting.fetch_sub(1, Ordering::Release);
        Some(request)
    }

    /// Whether the debugger is gone.
    pub(super) fn is_gone(&self) -> bool {
        self.waiting.load(Ordering::Acquire) >= GONE
    }

    /// Sends an object with these fields.
    pub(super) fn say(&self, fields: &str) {
        // The debugger may be gone: then the requests end, too.
        let _ = self.lines.as_ref().map(|lines| lines.send(format!("{{{fields}}}\n")));
    }
}

impl Drop for DebugLink {
    fn drop(&mut self) {
        self.lines = None;
        let _ = self.writer.take().map(JoinHandle::join);
        let _ = self.stream.shutdown(Shutdown::Both);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn requests_are_read() {
        let request = DebugRequest::parse("7\tset\t1\tx y").unwrap();
        assert_eq!((request.number, request.word.as_str(), request.whole(0), request.value(1)), (7, "set", 1, "x y"));
        assert_eq!((request.value(2), request.whole(1)), ("", 0));
        assert_eq!(DebugRequest::parse("set"), None);
        assert_eq!(DebugRequest::parse("7"), None);
    }
}
