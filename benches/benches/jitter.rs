//! How late control cycles of 1 ms begin, beside a bare loop that sleeps to points of the clock.
//!
//! `cargo bench -p arl-benches --bench jitter [-- SECONDS]`. The two take turns, each in a thread of its own: as any
//! program, and with what `Realtime` asks the system for (which needs the right to it); on a machine that does nothing
//! else, and beside as many threads that calculate as there are cores.

use std::error::Error;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{available_parallelism, scope};
use std::time::{Duration, Instant};

use arl_benches::cell::Robot;
use arl_rt::Controller;
use arl_rt::clock::Realtime;
use arl_rt::clock::{Clock, RealClock};
use rustix::thread::{ClockId, clock_nanosleep_absolute};
use rustix::time::{Timespec, clock_gettime};

const PERIOD: Duration = Duration::from_millis(1);
/// How often the two take turns.
const TURNS: usize = 5;
/// Cycles before what is measured: the first plans, memory that is touched for the first time.
const FIRST: usize = 200;

fn main() -> Result<(), Box<dyn Error>> {
    let seconds: usize = std::env::args().skip(1).find_map(|word| word.parse().ok()).unwrap_or(30);
    let cycles = (seconds * 1000 / TURNS).max(1);
    println!("us after its point at which a cycle of 1 ms begins, {} cycles each", cycles * TURNS);
    println!("machine   realtime   who             p50     p99   p99.9      most   lost");
    for realtime in [false, true] {
        for busy in [false, true] {
            measure(cycles, realtime, busy)?;
        }
    }
    Ok(())
}

/// Both, in turns.
fn measure(cycles: usize, realtime: bool, busy: bool) -> Result<(), Box<dyn Error>> {
    let ended = Arc::new(AtomicBool::new(false));
    let cores = if busy { available_parallelism()?.get() } else { 0 };
    let (mut bare, mut controller) = (Vec::new(), Vec::new());
    let mut lost = 0;
    scope(|scope| {
        for _ in 0..cores {
            let ended = Arc::clone(&ended);
            scope.spawn(move || {
                let mut value = 1_u64;
                while !ended.load(Ordering::Relaxed) {
                    value = std::hint::black_box(value.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1));
                }
            });
        }
        for _ in 0..TURNS {
            let of = |work: fn(usize) -> (Vec<f64>, u64)| {
                let thread = scope.spawn(move || {
                    if realtime {
                        Realtime::new().begin().iter().for_each(|problem| println!("not as asked: {problem}"));
                    }
                    work(FIRST + cycles)
                });
                thread.join().unwrap_or_default()
            };
            bare.extend(of(bare_loop).0.into_iter().skip(FIRST));
            let (times, without) = of(controlled);
            controller.extend(times.into_iter().skip(FIRST));
            lost += without;
        }
        ended.store(true, Ordering::Relaxed);
    });
    let machine = if busy { "busy" } else { "idle" };
    let asked = if realtime { "yes" } else { "no" };
    for (who, times, lost) in [("bare loop", &mut bare, None), ("controller", &mut controller, Some(lost))] {
        times.sort_by(f64::total_cmp);
        let [half, most_of, nearly_all, all] = [0.5, 0.99, 0.999, 1.0].map(|share| at(times, share));
        let lost = lost.map(|lost| lost.to_string()).unwrap_or_default();
        println!(
            "{machine:<9} {asked:<10} {who:<11} {half:>7.1} {most_of:>7.1} {nearly_all:>7.1} {all:>9.1} {lost:>6}"
        );
    }
    println!("{:>29} p99.9 {:.2} times that of the loop", "", at(&controller, 0.999) / at(&bare, 0.999));
    Ok(())
}

fn at(times: &[f64], share: f64) -> f64 {
    let last = times.len().saturating_sub(1);
    times.get(((last as f64) * share) as usize).copied().unwrap_or(f64::NAN)
}

/// A loop that does nothing but sleep to points of the clock.
fn bare_loop(cycles: usize) -> (Vec<f64>, u64) {
    let mut late = Vec::with_capacity(cycles);
    let start = clock_gettime(ClockId::Monotonic);
    let period = Timespec { tv_sec: 0, tv_nsec: PERIOD.as_nanos() as _ };
    let mut point = start;
    for _ in 0..cycles {
        point = point.checked_add(period).unwrap_or(point);
        let _ = clock_nanosleep_absolute(ClockId::Monotonic, &point);
        let behind =
            clock_gettime(ClockId::Monotonic).checked_sub(point).and_then(|behind| Duration::try_from(behind).ok());
        late.push(behind.unwrap_or_default().as_secs_f64() * 1e6);
    }
    (late, 0)
}

/// The clock of the controller, looked at when it lets a cycle begin.
struct Watched {
    clock: RealClock,
    late: Arc<std::sync::Mutex<Vec<f64>>>,
}

impl Clock for Watched {
    fn wait_for(&mut self, cycle: u64, period: f64) {
        let point = cycle.checked_sub(1).and_then(|before| self.clock.due(before, period));
        self.clock.wait_for(cycle, period);
        let behind = point.map_or(Duration::ZERO, |point| Instant::now().saturating_duration_since(point));
        if let Ok(mut late) = self.late.lock() {
            late.push(behind.as_secs_f64() * 1e6);
        }
    }

    fn due(&self, cycle: u64, period: f64) -> Option<Instant> {
        self.clock.due(cycle, period)
    }

    fn lateness(&self) -> Option<&arl_rt::clock::Lateness> {
        self.clock.lateness()
    }
}

/// A robot that goes to and fro and watches 64 interrupts.
fn controlled(cycles: usize) -> (Vec<f64>, u64) {
    let late = Arc::new(std::sync::Mutex::new(Vec::with_capacity(cycles)));
    let clock = Watched { clock: RealClock::new(), late: Arc::clone(&late) };
    let Ok(mut controller) = Controller::builder().clock(clock).build(Box::new(Robot::new(0, 64, 1_000_000, 30.0)))
    else {
        return Default::default();
    };
    let lost_after = |controller: &mut Controller, cycles: usize| {
        (0..cycles).for_each(|_| {
            controller.step();
        });
        controller.lateness().map_or(0, |lateness| lateness.lost())
    };
    let at_first = lost_after(&mut controller, FIRST);
    let lost = lost_after(&mut controller, cycles - FIRST) - at_first;
    drop(controller);
    let late = late.lock().map(|late| late.clone()).unwrap_or_default();
    (late, lost)
}
