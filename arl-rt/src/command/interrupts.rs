//! Interrupts: Ctrl-C, requests to end, terminals that close. The first one stops robots on their path; another one
//! ends the process, should the program not come to an end.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// How soon after the first interrupt further ones belong to it. Whoever ends a process often sends several at once:
/// `timeout` to the process and to its group, service managers SIGTERM and SIGHUP, shells that close what the system
/// sends, too.
const SAME_INTERRUPT: Duration = Duration::from_millis(300);

/// Counts interrupts by whoever presses or sends them.
#[derive(Clone, Copy, Default, Debug)]
pub struct Interrupts {
    first: Option<Instant>,
    count: u32,
}

impl Interrupts {
    /// Takes a signal that came at this moment. Returns how many interrupts there are with it; `None` if it belongs to
    /// the first one: if it came at once after it, or because the terminal closed, which is no impatience.
    ///
    /// ```
    /// use std::time::{Duration, Instant};
    /// let mut interrupts = arl_rt::emit::interrupts::Interrupts::default();
    /// let first = Instant::now();
    /// assert_eq!(interrupts.take(false, first), Some(1));
    /// assert_eq!(interrupts.take(false, first + Duration::from_millis(20)), None);
    /// assert_eq!(interrupts.take(true, first + Duration::from_secs(2)), None);
    /// assert_eq!(interrupts.take(false, first + Duration::from_secs(2)), Some(2));
    /// ```
    pub fn take(&mut self, is_hang_up: bool, now: Instant) -> Option<u32> {
        if let Some(first) = self.first
            && (is_hang_up || now.duration_since(first) < SAME_INTERRUPT)
        {
            return None;
        }
        self.first.get_or_insert(now);
        self.count += 1;
        Some(self.count)
    }
}

/// Whether a run was interrupted.
#[derive(Clone, Debug)]
pub(super) struct Interrupted {
    flag: Arc<AtomicBool>,
    /// Whether the process got an interrupt, perhaps before it was watched for here.
    beside: fn() -> bool,
}

impl Interrupted {
    /// From now on the first interrupt counts, and another one ends the process with this exit code. `beside` is asked,
    /// too.
    pub(super) fn watch(beside: fn() -> bool, exit_code: u8) -> (Self, io::Result<()>) {
        let interrupted = Self { flag: Arc::default(), beside };
        let watched = watch(&interrupted.flag, exit_code);
        (interrupted, watched)
    }

    /// Whether there was an interrupt.
    pub(super) fn is_set(&self) -> bool {
        self.flag.load(Ordering::Relaxed) || (self.beside)()
    }
}

fn watch(flag: &Arc<AtomicBool>, exit_code: u8) -> io::Result<()> {
    for signal in signals() {
        signal_hook::flag::register(signal, Arc::clone(flag))?;
    }
    // The command that started the program passes on what it got itself, and must not end a program that got it, too.
    #[cfg(unix)]
    signal_hook::flag::register(signal_hook::consts::SIGUSR1, Arc::clone(flag))?;
    end_when_there_is_another(i32::from(exit_code))
}

fn signals() -> Vec<i32> {
    use signal_hook::consts::{SIGINT, SIGTERM};
    #[cfg(unix)]
    if minds_hang_up() {
        return vec![SIGINT, SIGTERM, signal_hook::consts::SIGHUP];
    }
    vec![SIGINT, SIGTERM]
}

#[cfg(unix)]
fn end_when_there_is_another(exit_code: i32) -> io::Result<()> {
    use signal_hook::consts::SIGHUP;
    let mut signals = signal_hook::iterator::Signals::new(signals())?;
    let mut interrupts = Interrupts::default();
    let watch = move || {
        for signal in signals.forever() {
            if interrupts.take(signal == SIGHUP, Instant::now()).is_some_and(|count| count > 1) {
                signal_hook::low_level::exit(exit_code);
            }
        }
    };
    std::thread::Builder::new().name("interrupts".into()).spawn(watch).map(drop)
}

/// Elsewhere the console is the only one who interrupts, once each time.
#[cfg(not(unix))]
fn end_when_there_is_another(exit_code: i32) -> io::Result<()> {
    use signal_hook::consts::SIGINT;
    use signal_hook::flag;
    let pressed = Arc::new(AtomicBool::new(false));
    flag::register_conditional_shutdown(SIGINT, exit_code, Arc::clone(&pressed))?;
    flag::register(SIGINT, pressed).map(drop)
}

/// Whether the end of its terminal concerns this process: not if it was started to outlive it, as by `nohup`, which is
/// known on Linux; on other systems it then ends as it does everywhere without a handler.
pub fn minds_hang_up() -> bool {
    const HANG_UP: u64 = 1;
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let ignored = ignored.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    ignored.is_some_and(|mask| mask & HANG_UP == 0)
}
