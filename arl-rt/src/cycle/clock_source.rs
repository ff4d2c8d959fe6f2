//! Where the time of the controller comes from: as fast as it can, or the time of the world.

use std::time::{Duration, Instant};

/// Says when the next cycle may begin.
pub trait Clock {
    /// Returns when the cycle with this running number (from 0) may begin. A cycle is `period` seconds long.
    fn wait_for(&mut self, cycle: u64, period: f64);

    /// When that cycle ends, by the time of the world, if cycles take such. Asked after [`wait_for`](Clock::wait_for).
    fn due(&self, cycle: u64, period: f64) -> Option<Instant> {
        let _ = (cycle, period);
        None
    }

    /// The program begins to talk to the world: from the next cycle on its time counts. Returns what the user should know.
    fn follow_real_time(&mut self) -> Option<&'static str> {
        None
    }

    /// Whether cycles take the time that they stand for.
    fn is_real(&self) -> bool {
        true
    }

    /// How many cycles began late, because the one before them took too long.
    fn overruns(&self) -> u64 {
        0
    }
}

/// Cycles follow each other as fast as they can: a run is a function of the program, the robot, the cell and the
/// scenario alone. From the first connection on that a program opens, they begin at points of real time: the other side
/// has no other.
#[derive(Default, Debug)]
pub struct VirtualClock {
    real: Option<RealClock>,
    asked_for: bool,
}

impl VirtualClock {
    /// A clock that makes cycles follow each other as fast as they can.
    pub fn new() -> Self {
        Self::default()
    }

    /// The same, where the user has asked for it: the end of virtual time is worth a warning.
    pub fn asked_for() -> Self {
        Self { real: None, asked_for: true }
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
        self.real.get_or_insert_with(RealClock::new);
        (first && self.asked_for).then_some(WARNING)
    }

    fn is_real(&self) -> bool {
        self.real.is_some()
    }

    fn overruns(&self) -> u64 {
        self.real.as_ref().map_or(0, Clock::overruns)
    }
}

/// Each cycle begins at its own point of real time, so that errors do not add up. A cycle that comes more than one
/// period too late is an overrun; the cycles after it catch up.
#[derive(Default, Debug)]
pub struct RealClock {
    start: Option<Instant>,
    overruns: u64,
}

impl RealClock {
    /// A clock that starts with its first cycle.
    pub fn new() -> Self {
        Self::default()
    }
}

impl Clock for RealClock {
    fn wait_for(&mut self, cycle: u64, period: f64) {
        let now = Instant::now();
        let start = *self.start.get_or_insert_with(|| now.checked_sub(since_start(cycle, period)).unwrap_or(now));
        let Some(deadline) = start.checked_add(since_start(cycle, period)) else { return };
        match deadline.checked_duration_since(now) {
            Some(early) if !early.is_zero() => std::thread::sleep(early),
            _ => {
                if now.duration_since(deadline).as_secs_f64() > period {
                    self.overruns += 1;
                }
            }
        }
    }

    fn due(&self, cycle: u64, period: f64) -> Option<Instant> {
        self.start?.checked_add(since_start(cycle + 1, period))
    }

    fn overruns(&self) -> u64 {
        self.overruns
    }
}

/// How long after the first cycle this one begins.
fn since_start(cycle: u64, period: f64) -> Duration {
    Duration::from_secs_f64(cycle as f64 * period)
}
