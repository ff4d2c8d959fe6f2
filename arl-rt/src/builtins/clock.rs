//! Clocks: variables that measure controller time.

use std::cell::Cell;

use crate::context::cx::Cx;
use crate::context::shown::Shown;

/// A clock. It stands still at 0 until it is started.
#[derive(Clone, Default, Debug)]
pub struct Clock {
    /// Cycles before the last start.
    counted: Cell<u64>,
    /// The cycle of the last start; `None` while the clock stands still.
    since: Cell<Option<u64>>,
}

impl Clock {
    /// A clock that stands still at 0.
    pub const fn new() -> Self {
        Self { counted: Cell::new(0), since: Cell::new(None) }
    }

    fn cycles(&self, now: u64) -> u64 {
        self.counted.get() + self.since.get().map_or(0, |since| now.saturating_sub(since))
    }
}

impl Shown for Clock {
    fn type_name(&self) -> String {
        "clock".into()
    }

    fn shown(&self, cx: &Cx) -> String {
        let seconds = cx.shared().rate.time(self.cycles(cx.cycle()));
        let state = if self.since.get().is_some() { "running" } else { "stopped" };
        format!("{seconds:.3} s, {state}")
    }
}

/// Starts a clock; a stopped clock continues counting, a running one is not affected.
pub fn clkstart(cx: &Cx, c: &Clock) {
    if c.since.get().is_none() {
        c.since.set(Some(cx.cycle()));
    }
}

/// Stops a clock; it keeps its value.
pub fn clkstop(cx: &Cx, c: &Clock) {
    c.counted.set(c.cycles(cx.cycle()));
    c.since.set(None);
}

/// Sets a clock to 0; a running clock continues from there.
pub fn clkreset(cx: &Cx, c: &Clock) {
    c.counted.set(0);
    if c.since.get().is_some() {
        c.since.set(Some(cx.cycle()));
    }
}

/// The value of a clock, in s.
pub fn clkread(cx: &Cx, c: &Clock) -> f64 {
    cx.goes_on();
    cx.shared().rate.time(c.cycles(cx.cycle()))
}
