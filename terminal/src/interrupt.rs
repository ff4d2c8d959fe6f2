//! Handling of interrupts: Ctrl-C, and on Unix a request to end and a terminal that closes.

use std::process::Child;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Mutex, PoisonError};

use crate::exit::Exit;
use crate::{private_folder, show};

/// Whether interrupts are left to the program that runs in the foreground.
static LEFT_TO_PROGRAM: AtomicBool = AtomicBool::new(false);
/// The interrupts since then.
static COUNT: AtomicU32 = AtomicU32::new(0);
/// The process that an interrupt is passed on to; 0 if there is none.
static PROGRAM: AtomicU32 = AtomicU32::new(0);

/// What an interrupt says before it ends the command.
static LAST_WORDS: Mutex<Option<&str>> = Mutex::new(None);

/// Makes an interrupt end the command with its exit code; folders of this process alone are removed. cargo is in the
/// same process group, and ends by itself. `minds_hang_up`: a terminal that closes is an interrupt, too; not where the
/// command was started to outlive its terminal.
pub fn end_the_command(minds_hang_up: bool) {
    // Without a handler the process still ends, only with another code.
    let _ = watch(minds_hang_up);
}

#[cfg(unix)]
fn watch(minds_hang_up: bool) -> std::io::Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    let mut signals = Signals::new([SIGINT, SIGTERM])?;
    if minds_hang_up {
        signals.add_signal(SIGHUP)?;
    }
    let watch = move || signals.forever().for_each(|_| interrupted());
    std::thread::Builder::new().name("interrupts".into()).spawn(watch).map(drop)
}

/// An interrupt of the console is the only one.
#[cfg(not(unix))]
fn watch(_minds_hang_up: bool) -> Result<(), ctrlc::Error> {
    ctrlc::set_handler(interrupted)
}

fn interrupted() {
    if LEFT_TO_PROGRAM.load(Ordering::Relaxed) {
        return pass_on(COUNT.fetch_add(1, Ordering::Relaxed) > 0);
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

/// From now on interrupts are left to the running program.
pub fn leave_to_the_program() {
    LEFT_TO_PROGRAM.store(true, Ordering::Relaxed);
}

/// How many interrupts came while they were left to the program.
pub fn count() -> u32 {
    COUNT.load(Ordering::Relaxed)
}

/// Whether an interrupt came while they were left to the program.
pub fn was_pressed() -> bool {
    count() > 0
}

/// While this value exists, interrupts of the command are passed on to a program.
#[derive(Debug)]
#[must_use]
pub struct PassedOn(());

/// Passes interrupts on to this program. Those of a terminal reach it anyway, those of `kill` or of an editor do not.
pub fn pass_on_to(program: &Child) -> PassedOn {
    PROGRAM.store(program.id(), Ordering::Relaxed);
    if was_pressed() {
        pass_on(false);
    }
    PassedOn(())
}

impl Drop for PassedOn {
    fn drop(&mut self) {
        PROGRAM.store(0, Ordering::Relaxed);
    }
}

/// The first interrupt asks the program to stop its robot, which changes nothing for one that had it, too; another one
/// ends the program.
#[cfg(unix)]
fn pass_on(again: bool) {
    use rustix::process::{Pid, Signal, kill_process};
    let program = i32::try_from(PROGRAM.load(Ordering::Relaxed)).ok().and_then(Pid::from_raw);
    if let Some(program) = program {
        // It may have ended.
        let _ = kill_process(program, if again { Signal::KILL } else { Signal::USR1 });
    }
}

/// An interrupt is always for all processes of the console.
#[cfg(not(unix))]
fn pass_on(_again: bool) {}
