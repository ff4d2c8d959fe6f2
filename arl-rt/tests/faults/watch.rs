//! What the process holds before and after.

use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use arl_rt::emit::*;
use arl_rt::{Builder, Captured, Controller, Outcome};

use crate::common::{self, open};

/// Descriptors, threads and memory belong to the process: one test at a time.
static ALONE: Mutex<()> = Mutex::new(());

/// How much memory may stay behind, in KiB: what threads and the allocator keep. A thousand connections that leave
/// their buffers, or a flood that is kept, are far more.
const MAX_LEAKED: u64 = 12 << 10;

/// Does something after which descriptors and threads are as before, and memory is bounded.
pub(crate) fn watched<R>(work: impl FnOnce() -> R) -> R {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let (before, memory) = (open::all(), resident());
    let result = work();
    open::wait_for(before);
    let leaked = resident().saturating_sub(memory);
    assert!(leaked < MAX_LEAKED, "{leaked} KiB of memory are left");
    result
}

/// The memory of the process that is in use, in KiB.
fn resident() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).unwrap();
    line.trim().trim_end_matches(" kB").parse().unwrap()
}

/// How a program ended, and what it printed.
#[derive(PartialEq, Debug)]
pub(crate) struct End {
    pub(crate) outcome: Outcome,
    pub(crate) out: String,
}

impl End {
    /// Its alarm as text, or what it printed.
    pub(crate) fn text(&self) -> String {
        match &self.outcome {
            Outcome::Ended => self.out.clone(),
            Outcome::Alarm(alarm) => format!("{}{alarm}", self.out),
            other => panic!("{other}"),
        }
    }
}

/// A controller whose program is run several times.
pub(crate) struct Robot {
    controller: Controller,
    messages: Captured,
    read: usize,
}

impl Robot {
    pub(crate) fn new<F>(builder: Builder, program: F) -> Self
    where
        F: for<'a> Fn(&'a Cx) -> BoxFuture<'a> + 'static,
    {
        Self::of(builder, Box::new(common::script(program)))
    }

    pub(crate) fn of(builder: Builder, program: Box<dyn Program>) -> Self {
        let messages = Captured::new();
        let controller = builder.output(messages.clone()).build(program).unwrap();
        Self { controller, messages, read: 0 }
    }

    /// Runs the program to its end, from its beginning.
    pub(crate) fn run(&mut self) -> End {
        if self.controller.outcome().is_some() {
            self.controller.reset().unwrap();
        }
        // Far longer than anything takes, also on a machine with a lot to do: what never ends is told all the same.
        self.controller.run_for(600.0);
        let place = self.controller.place();
        let outcome = self.controller.outcome().cloned().unwrap_or_else(|| panic!("still running: {place:?}"));
        let all = self.messages.text();
        let out = all[self.read..].to_owned();
        self.read = all.len();
        End { outcome, out }
    }

    /// The warnings since the last call.
    pub(crate) fn warnings(&mut self) -> Vec<String> {
        self.controller.take_warnings()
    }
}

/// How often connections are opened and closed one after the other.
pub(crate) const TIMES: i32 = 1000;

/// Opens and closes a connection again and again: how often it was opened.
pub(crate) async fn again_and_again(open: impl AsyncFn() -> Done<bool>, close: impl AsyncFn()) -> Done<i32> {
    let mut opened = 0;
    for _ in 0..TIMES {
        opened += i32::from(open().await?);
        close().await;
    }
    Ok(opened)
}

/// Tries until it works; the world may take some seconds.
pub(crate) fn soon<R>(what: &str, mut attempt: impl FnMut() -> Option<R>) -> R {
    for _ in 0..20_000 {
        if let Some(result) = attempt() {
            return result;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    panic!("{what}");
}
