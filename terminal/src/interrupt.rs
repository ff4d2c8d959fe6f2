//! Handling of Ctrl-C.

use std::process::Child;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};

use crate::exit::Exit;

/// Whether Ctrl-C is left to the program that runs in the foreground.
static LEFT_TO_PROGRAM: AtomicBool = AtomicBool::new(false);
/// Whether Ctrl-C has been pressed since then.
static WAS_PRESSED: AtomicBool = AtomicBool::new(false);
/// The process that an interrupt is passed on to; 0 if there is none.
static PROGRAM: AtomicU32 = AtomicU32::new(0);

/// Makes Ctrl-C end the command with its exit code. cargo is in the same process group, and ends by itself.
pub fn end_the_command() {
    // Without a handler the process still ends, only with another code.
    let _ = ctrlc::set_handler(|| {
        if !LEFT_TO_PROGRAM.load(Ordering::Relaxed) {
            std::process::exit(i32::from(Exit::INTERRUPTED.0));
        }
        pass_on(WAS_PRESSED.swap(true, Ordering::Relaxed));
    });
}

/// From now on Ctrl-C is left to the running program.
pub fn leave_to_the_program() {
    LEFT_TO_PROGRAM.store(true, Ordering::Relaxed);
}

/// Whether Ctrl-C was pressed while it was left to the program.
pub fn was_pressed() -> bool {
    WAS_PRESSED.load(Ordering::Relaxed)
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
        let _ = kill_process(program, if again { Signal::TERM } else { Signal::USR1 });
    }
}

/// An interrupt is always for all processes of the console.
#[cfg(not(unix))]
fn pass_on(_again: bool) {}
