//! Sources of the controller's time: cycles as fast as possible, or in real time.

use std::time::{Duration, Instant};

pub use super::lateness::Lateness;
pub use arl_robot::cell::Late;

/// Determines when the next cycle may begin: [`VirtualClock`], [`RealClock`], or the beat of a bus, which the cycles
/// then follow.
///
/// ```
/// use arl_rt::clock::{Clock, Lateness};
/// use std::sync::mpsc::Receiver;
/// use std::time::{Duration, Instant};
///
/// /// The beat of a bus. Its driver says when each one came.
/// struct BusClock {
///     beats: Receiver<Instant>,
///     newest: Option<Instant>,
///     lateness: Lateness,
/// }
///
/// impl Clock for BusClock {
///     fn wait_for(&mut self, _cycle: u64, period: f64) {
///         // Beats that came while a cycle took too long are lost.
///         let mut waited = 0;
///         while let Ok(beat) = self.beats.try_recv() {
///             self.newest = Some(beat);
///             waited += 1;
///         }
///         if waited == 0 {
///             match self.beats.recv_timeout(Duration::from_secs_f64(period)) {
///                 Ok(beat) => self.newest = Some(beat),
///                 // Without a beat cycles go on at their own pace, until the loss of so many stops the robot.
///                 Err(_) => {
///                     std::thread::sleep(Duration::from_secs_f64(period));
///                     self.newest = Some(Instant::now());
///                     self.lateness.note_missing(1);
///                 }
///             }
///         }
///         let behind = self.newest.map(|beat| beat.elapsed()).unwrap_or_default();
///         self.lateness.note(behind);
///         if waited > 1 {
///             self.lateness.note_lost(waited - 1);
///         }
///     }
///
///     fn due(&self, _cycle: u64, period: f64) -> Option<Instant> {
///         Some(self.newest? + Duration::from_secs_f64(period))
///     }
///
///     fn lateness(&self) -> Option<&Lateness> {
///         Some(&self.lateness)
///     }
/// }
/// # let (beat, beats) = std::sync::mpsc::channel();
/// # let mut clock = BusClock { beats, newest: None, lateness: Lateness::default() };
/// # (0..3).for_each(|_| beat.send(Instant::now()).unwrap());
/// # clock.wait_for(0, 0.001);
/// # assert_eq!((clock.lateness.cycles(), clock.lateness.lost()), (1, 2));
/// ```
pub trait Clock {
    /// Returns when the cycle with this running number (from 0) may begin. A cycle is `period` seconds long.
    fn wait_for(&mut self, cycle: u64, period: f64);

    /// When that cycle ends, in real time, if cycles take that. Called after [`wait_for`](Clock::wait_for).
    fn due(&self, cycle: u64, period: f64) -> Option<Instant> {
        let _ = (cycle, period);
        None
    }

    /// The program begins to communicate with the outside world: from the next cycle on cycles take real time. Returns
    /// a warning for the user.
    fn follow_real_time(&mut self) -> Option<&'static str> {
        None
    }

    /// Whether cycles take the time that they stand for.
    fn is_real(&self) -> bool {
        true
    }

    /// Whether cycles in which nothing can change may be skipped: where cycles take no real time. `wait_for` is then
    /// not called for them; the next cycle has the number that it would have had.
    fn may_skip(&self) -> bool {
        false
    }

    /// Sets how lost cycles are treated, as the cell file gives it.
    fn set_late(&mut self, late: Late) {
        let _ = late;
    }

    /// How late cycles began until now, if that is known. Its counts of lost and of missing cycles are compared with
    /// the limit of the cell file.
    fn lateness(&self) -> Option<&Lateness> {
        None
    }
}

/// Cycles follow each other as fast as they can: a run is a function of the program, the robot, the cell and the
/// scenario alone. From the first connection on that a program opens, they begin at points of real time, as the other
/// side lives in real time.
#[derive(Default, Debug)]
pub struct VirtualClock {
    real: Option<RealClock>,
    late: Late,
    asked_for: bool,
}

impl VirtualClock {
    /// A clock that makes cycles follow each other as fast as they can.
    pub fn new() -> Self {
        Self::default()
    }

    /// The same clock, where the user has requested it: the end of virtual time then gives a warning.
    pub fn asked_for() -> Self {
        Self { asked_for: true, ..Self::default() }
    }
}

impl Clock for VirtualClock {
    #[inline]
    fn wait_for(&mut self, cycle: u64, period: f64) {
        if let Some(real) = &mut self.real {
            real.wait_for(cycle, period);
        }
    }

    fn due(&self, cycle: u64, period: f64) -> Option<Instant> {
        self.real.as_ref()?.due(cycle, period)
    }

    fn follow_real_time(&mut self) -> Option<&'static str> {
        const WARNING: &str = "the run is connected to the outside: from here on its cycles take real time";
        let first = self.real.is_none();
        self.real.get_or_insert_with(|| RealClock::new().late(self.late));
        (first && self.asked_for).then_some(WARNING)
    }

    fn is_real(&self) -> bool {
        self.real.is_some()
    }

    fn may_skip(&self) -> bool {
        self.real.is_none()
    }

    fn set_late(&mut self, late: Late) {
        self.late = late;
    }

    fn lateness(&self) -> Option<&Lateness> {
        self.real.as_ref()?.lateness()
    }
}

/// Each cycle begins at its own point of real time, so that errors do not add up. [`Late`] sets what happens to cycles
/// whose points have passed; two cycles never begin less than half a cycle after each other.
#[derive(Default, Debug)]
pub struct RealClock {
    /// When the first cycle began, or would have begun if no cycle had been lost.
    start: Option<Instant>,
    /// When the last cycle began.
    last: Option<Instant>,
    late: Late,
    lateness: Lateness,
}

impl RealClock {
    /// A clock that starts with its first cycle.
    pub fn new() -> Self {
        Self::default()
    }

    /// How lost cycles are treated; by default the grid is held.
    pub fn late(self, late: Late) -> Self {
        Self { late, ..self }
    }
}

impl Clock for RealClock {
    fn wait_for(&mut self, cycle: u64, period: f64) {
        let since = since_start(cycle, period);
        let now = Instant::now();
        let start = *self.start.get_or_insert_with(|| now.checked_sub(since).unwrap_or(now));
        let Some(point) = start.checked_add(since) else { return };
        let soonest = self.last.and_then(|last| last.checked_add(Duration::from_secs_f64(0.5 * period)));
        sleep_until(soonest.map_or(point, |soonest| soonest.max(point)));
        let now = Instant::now();
        self.last = Some(now);
        let behind = now.saturating_duration_since(point);
        self.lateness.note(behind);
        let lost = (behind.as_secs_f64() / period).floor();
        if lost >= 1.0 {
            self.lateness.note_lost(lost as u64);
            let moved = if self.late == Late::Skip { behind } else { Duration::from_secs_f64(lost * period) };
            self.start = start.checked_add(moved);
        }
    }

    fn due(&self, cycle: u64, period: f64) -> Option<Instant> {
        self.start?.checked_add(since_start(cycle + 1, period))
    }

    fn set_late(&mut self, late: Late) {
        self.late = late;
    }

    fn lateness(&self) -> Option<&Lateness> {
        Some(&self.lateness)
    }
}

/// The time from the beginning of the first cycle to that of this one.
fn since_start(cycle: u64, period: f64) -> Duration {
    Duration::from_secs_f64(cycle as f64 * period)
}

/// Sleeps until a point of the clock, not for a time from now on: an interruption in between does not make the sleep
/// longer.
#[cfg(all(target_os = "linux", feature = "realtime"))]
fn sleep_until(point: Instant) {
    use rustix::io::Errno;
    use rustix::thread::{ClockId, clock_nanosleep_absolute};
    use rustix::time::{Timespec, clock_gettime};
    loop {
        // In this order: after an interruption in between it wakes too early, and sleeps on.
        let now = clock_gettime(ClockId::Monotonic);
        let early = point.saturating_duration_since(Instant::now());
        if early.is_zero() {
            return;
        }
        let until = Timespec::try_from(early).ok().and_then(|early| now.checked_add(early));
        match until.map(|until| clock_nanosleep_absolute(ClockId::Monotonic, &until)) {
            Some(Ok(()) | Err(Errno::INTR)) => {}
            _ => std::thread::sleep(early),
        }
    }
}

#[cfg(not(all(target_os = "linux", feature = "realtime")))]
fn sleep_until(point: Instant) {
    let early = point.saturating_duration_since(Instant::now());
    if !early.is_zero() {
        std::thread::sleep(early);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PERIOD_S: f64 = 0.01;
    const PERIOD: Duration = Duration::from_millis(10);

    /// A clock whose cycle 5 begins after this delay, and how far its grid has moved, and when that cycle and the next
    /// one began, counted from the first one.
    fn after_a_delay(late: Late, delay: Duration) -> (RealClock, [Duration; 3]) {
        let mut clock = RealClock::new().late(late);
        clock.wait_for(0, PERIOD_S);
        let start = clock.start.unwrap();
        (1..5).for_each(|cycle| clock.wait_for(cycle, PERIOD_S));
        std::thread::sleep(PERIOD + delay);
        let begin = |clock: &mut RealClock, cycle| {
            clock.wait_for(cycle, PERIOD_S);
            clock.last.unwrap() - start
        };
        let [late, next] = [5, 6].map(|cycle| begin(&mut clock, cycle));
        let moved = clock.start.unwrap() - start;
        (clock, [moved, late, next])
    }

    // How long a sleep takes depends on the machine; what is certain is that none is too short.

    #[test]
    fn a_grid_is_held() {
        let (clock, [moved, late, next]) = after_a_delay(Late::HoldGrid, PERIOD * 5 / 2);
        let lateness = clock.lateness().unwrap();
        assert!(lateness.late() >= 1 && lateness.lost() >= 2, "{lateness}");
        // Points of the grid stay whole cycles from each other, and lost cycles are not made up for.
        assert_eq!(moved, PERIOD * lateness.lost() as u32);
        assert!(late >= PERIOD * 7 && next >= PERIOD * 8 && next - late >= PERIOD / 2, "{late:?} {next:?}");
    }

    #[test]
    fn a_grid_begins_anew_where_time_is_skipped() {
        let (clock, [moved, late, next]) = after_a_delay(Late::Skip, PERIOD * 5 / 2);
        let lateness = clock.lateness().unwrap();
        assert!(lateness.late() >= 1 && lateness.lost() >= 2, "{lateness}");
        assert!(
            late >= PERIOD * 15 / 2 && moved >= PERIOD * 5 / 2 && next >= late + PERIOD,
            "{moved:?} {late:?} {next:?}"
        );
    }

    #[test]
    fn cycles_are_never_nearer_than_half_a_cycle_and_all_are_counted() {
        const SHORT_S: f64 = 1e-4;
        let mut clock = RealClock::new();
        let mut before: Option<Instant> = None;
        for cycle in 0..200 {
            clock.wait_for(cycle, SHORT_S);
            let last = clock.last.unwrap();
            assert!(before.is_none_or(|before| last - before >= Duration::from_secs_f64(0.5 * SHORT_S)));
            before = Some(last);
        }
        let lateness = clock.lateness().unwrap();
        assert_eq!(lateness.cycles(), 200);
        assert_eq!(lateness.late() == 0, lateness.lost() == 0);
        assert_eq!(VirtualClock::new().lateness(), None);
    }

    #[test]
    fn a_clock_that_becomes_real_does_as_the_cell_says() {
        let mut clock = VirtualClock::new();
        clock.set_late(Late::Skip);
        clock.wait_for(0, PERIOD_S);
        clock.follow_real_time();
        assert_eq!(clock.real.map(|real| real.late), Some(Late::Skip));
    }
}
