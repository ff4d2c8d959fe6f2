//! The robot's messages as the clock of the controller.

use std::cell::RefCell;
use std::fmt;
use std::rc::Rc;
use std::time::{Duration, Instant};

use arl_rt::clock::{Clock, Lateness};

use super::link::Link;

/// For so long the controller stands still where no message comes, and for so many cycles at least. A robot gives up
/// soon after that, and the inputs and the pendant want to be heard.
const PATIENT: Duration = Duration::from_millis(30);
const PATIENT_CYCLES: f64 = 3.0;

/// How long to wait for a message in the time of the world, where cycles are `period` s long.
pub(super) fn longest_wait(period: f64) -> Duration {
    PATIENT.max(Duration::from_secs_f64(period * PATIENT_CYCLES))
}

/// Cycles begin when the robot sends. A message that is missing is a cycle that is lost: the motion does not go on
/// without it. Where none comes for 30 ms and three cycles, they go on at their own pace: then the controller finds
/// that no position comes, and the run ends.
pub struct RsiBeat {
    link: Rc<RefCell<Link>>,
    /// When the last message should have come, or came.
    point: Option<Instant>,
    silent: bool,
    lateness: Lateness,
}

impl RsiBeat {
    pub(super) fn new(link: Rc<RefCell<Link>>) -> Self {
        Self { link, point: None, silent: false, lateness: Lateness::default() }
    }
}

impl Clock for RsiBeat {
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
        // Those that were lost had points, too.
        let due = due + Duration::from_millis(received.step).saturating_sub(Duration::from_secs_f64(period));
        // One that was there already came at its point, as far as anybody knows.
        self.point = Some(if received.was_there { due.min(came) } else { came });
        if is_simulated || !received.any {
            return;
        }
        self.lateness.note(if received.was_there { came.saturating_duration_since(due) } else { Duration::ZERO });
        let beats = (received.step as f64 / (period * 1e3)).round() as u64;
        // Those that waited together were sent in time, and not taken; of the others none has come.
        let waited = received.count.clamp(1, beats.max(1)) - 1;
        let missing = beats.saturating_sub(1 + waited);
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

impl fmt::Debug for RsiBeat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("RsiBeat").finish_non_exhaustive()
    }
}
