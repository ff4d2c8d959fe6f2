//! Handling of interrupts: Ctrl-C, and on Unix a request to end; on Linux a terminal that closes, too.

use std::process::Child;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use crate::exit::Exit;
use crate::{private_folder, show};

/// Whether the first interrupt is left to a program that runs, as after [`leave_to_the_program`].
static LEFT_TO_PROGRAM: AtomicBool = AtomicBool::new(false);
/// Whether there is a screen, as after [`leave_to_the_screen`].
static HAS_SCREEN: AtomicBool = AtomicBool::new(false);
/// The interrupts that did not end the command.
static COUNT: AtomicU32 = AtomicU32::new(0);
/// The process that an interrupt is passed on to; 0 if there is none.
static PROGRAM: AtomicU32 = AtomicU32::new(0);

/// How long a screen may take to be left.
const LONGEST_LEAVING: Duration = Duration::from_secs(2);

/// What an interrupt says before it ends the command.
static LAST_WORDS: Mutex<Option<&str>> = Mutex::new(None);

/// Makes an interrupt end the command with its exit code; folders of this process alone are removed. A Ctrl-C reaches a
/// cargo that was started, too. `minds_hang_up`: a terminal that closes is an interrupt, too; not where the command was
/// started to outlive its terminal. `take` gets each signal, with whether a terminal closed, and returns how many
/// interrupts there are with it; `None` if the signal is part of an earlier interrupt.
pub fn end_the_command(minds_hang_up: bool, take: impl FnMut(bool) -> Option<u32> + Send + 'static) {
    // Without a handler the process still ends, only with another code.
    let _ = watch(minds_hang_up, take);
}

#[cfg(unix)]
fn watch(minds_hang_up: bool, mut take: impl FnMut(bool) -> Option<u32> + Send + 'static) -> std::io::Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    let mut signals = Signals::new([SIGINT, SIGTERM])?;
    if minds_hang_up {
        signals.add_signal(SIGHUP)?;
    }
    let watch = move || signals.forever().filter_map(|signal| take(signal == SIGHUP)).for_each(interrupted);
    std::thread::Builder::new().name("interrupts".into()).spawn(watch).map(drop)
}

/// An interrupt of the console is the only one.
#[cfg(not(unix))]
fn watch(_minds_hang_up: bool, mut take: impl FnMut(bool) -> Option<u32> + Send + 'static) -> Result<(), ctrlc::Error> {
    ctrlc::set_handler(move || take(false).into_iter().for_each(interrupted))
}

/// Takes the first interrupt, or a later one.
fn interrupted(number: u32) {
    let (has_screen, is_left) = (HAS_SCREEN.load(Ordering::SeqCst), LEFT_TO_PROGRAM.load(Ordering::SeqCst));
    if has_screen || is_left {
        COUNT.fetch_add(1, Ordering::SeqCst);
        let is_passed_on = pass_on(number > 1);
        if number == 1 || (is_passed_on && !has_screen) {
            return;
        }
    }
    if has_screen {
        // It is left in good order, unless its terminal takes nothing any more.
        std::thread::sleep(LONGEST_LEAVING);
    }
    if let Some(words) = *LAST_WORDS.lock().unwrap_or_else(PoisonError::into_inner) {
        show::warning(words);
    }
    private_folder::remove_all();
    std::process::exit(i32::from(Exit::INTERRUPTED.0));
}

/// From now on an interrupt that ends the command says this.
pub fn last_words(words: &'static str) {
    *LAST_WORDS.lock().unwrap_or_else(PoisonError::into_inner) = Some(words);
}

/// While this value exists, an interrupt does not end the command.
#[derive(Debug)]
#[must_use]
pub struct Left(());

/// While the value exists, the first interrupt is left to whoever asks for it or gets it passed on. Another one ends a
/// program that it is passed on to; where there is none, the command.
pub fn leave_to_the_program() -> Left {
    LEFT_TO_PROGRAM.store(true, Ordering::SeqCst);
    Left(())
}

/// As [`leave_to_the_program`], for a command that shows a screen: it has a while to leave it in good order after
/// another interrupt.
pub fn leave_to_the_screen() -> Left {
    HAS_SCREEN.store(true, Ordering::SeqCst);
    Left(())
}

/// How many interrupts came that did not end the command.
pub fn count() -> u32 {
    COUNT.load(Ordering::SeqCst)
}

/// Whether an interrupt came that did not end the command.
pub fn was_pressed() -> bool {
    count() > 0
}

impl Left {
    /// Passes interrupts on to this program. Those of a terminal reach it anyway, those of `kill` or of an editor do
    /// not.
    pub fn pass_on_to(&self, program: &Child) {
        PROGRAM.store(program.id(), Ordering::SeqCst);
        if was_pressed() {
            pass_on(false);
        }
    }
}

impl Drop for Left {
    fn drop(&mut self) {
        LEFT_TO_PROGRAM.store(false, Ordering::SeqCst);
        HAS_SCREEN.store(false, Ordering::SeqCst);
        PROGRAM.store(0, Ordering::SeqCst);
    }
}

/// The first interrupt asks the program to stop its robot, which changes nothing for one that had it, too; another one
/// ends the program. Returns whether there is one.
#[cfg(unix)]
fn pass_on(again: bool) -> bool {
    use rustix::process::{Pid, Signal, kill_process};
    let program = i32::try_from(PROGRAM.load(Ordering::SeqCst)).ok().and_then(Pid::from_raw);
    // It may have ended.
    program.is_some_and(|program| kill_process(program, if again { Signal::KILL } else { Signal::USR1 }).is_ok())
}

/// An interrupt is always for all processes of the console.
#[cfg(not(unix))]
fn pass_on(_again: bool) -> bool {
    PROGRAM.load(Ordering::SeqCst) != 0
}
