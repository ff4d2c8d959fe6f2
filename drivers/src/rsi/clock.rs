//! The robot's messages as the clock of the controller.

use std::cell::RefCell;
use std::fmt;
use std::rc::Rc;
use std::time::{Duration, Instant};

use arl_rt::clock::{Clock, Lateness};

use super::link::Link;

/// How long, and at least for how many cycles, the controller waits without a message. A robot gives up soon after
/// that, and the inputs and the pendant must be served.
const PATIENT: Duration = Duration::from_millis(30);
const PATIENT_CYCLES: f64 = 3.0;

/// How long to wait for a message in real time, with cycles of `period` s.
pub(super) fn longest_wait(period: f64) -> Duration {
    PATIENT.max(Duration::from_secs_f64(period * PATIENT_CYCLES))
}

/// A clock whose cycles begin when the robot sends. A missing message is a lost cycle: the motion does not continue
/// without it. Without a message for 30 ms and three cycles, cycles continue at their own rate: then the controller
/// notices that positions are missing, and the run ends.
pub struct RsiClock {
    link: Rc<RefCell<Link>>,
    /// When the last message was due, or arrived.
    point: Option<Instant>,
    silent: bool,
    lateness: Lateness,
}

impl RsiClock {
    pub(super) fn new(link: Rc<RefCell<Link>>) -> Self {
        Self { link, point: None, silent: false, lateness: Lateness::default() }
    }
}

impl Clock for RsiClock {
    fn wait_for(&mut self, _cycle: u64, period: f64) {
        let mut link = self.link.borrow_mut();
        let now = Instant::now();
        let due = self.point.map_or(now, |point| point + Duration::from_secs_f64(period));
        let is_simulated = link.patience.is_some();
        let until = match &link.patience {
            Some(patience) => now + patience.limit(),
            None if self.silent => due.max(now),
            None => due.max(now) + longest_wait(period),
        };
        let received = link.receive(until);
        self.silent = !received.any;
        if let Some(patience) = &mut link.patience {
            patience.answered(received.any);
        }
        if self.silent {
            link.note_silence();
        }
        let came = Instant::now();
        // Lost messages had due times, too.
        let due = due + Duration::from_millis(received.step).saturating_sub(Duration::from_secs_f64(period));
        // A message that was already there arrived when due, as far as is known.
        self.point = Some(if received.was_there { due.min(came) } else { came });
        if is_simulated || !received.any {
            return;
        }
        self.lateness.note(if received.was_there { came.saturating_duration_since(due) } else { Duration::ZERO });
        let cycles = (received.step as f64 / (period * 1e3)).round() as u64;
        // Messages that waited together were sent in time, but not taken; the others have not arrived.
        let waited = received.count.clamp(1, cycles.max(1)) - 1;
        let missing = cycles.saturating_sub(1 + waited);
        if waited > 0 {
            self.lateness.note_lost(waited);
        }
        if missing > 0 {
            self.lateness.note_missing(missing);
        }
    }

    fn due(&self, _cycle: u64, period: f64) -> Option<Instant> {
        if self.link.borrow().patience.is_some() {
            return None;
        }
        Some(self.point? + Duration::from_secs_f64(period))
    }

    fn is_real(&self) -> bool {
        self.link.borrow().patience.is_none()
    }

    fn lateness(&self) -> Option<&Lateness> {
        Some(&self.lateness).filter(|_| self.is_real())
    }
}

impl fmt::Debug for RsiClock {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("RsiClock").finish_non_exhaustive()
    }
}
