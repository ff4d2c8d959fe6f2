//! Handling of Ctrl-C.

use crate::exit::Exit;
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether Ctrl-C is left to the program that runs in the foreground.
static LEFT_TO_PROGRAM: AtomicBool = AtomicBool::new(false);
/// Whether Ctrl-C has been pressed since then.
static WAS_PRESSED: AtomicBool = AtomicBool::new(false);

/// Makes Ctrl-C end the command with its exit code. cargo is in the same process group, and ends by itself.
pub fn end_the_command() {
    // Without a handler the process still ends, only with another code.
    let _ = ctrlc::set_handler(|| {
        if !LEFT_TO_PROGRAM.load(Ordering::Relaxed) {
            std::process::exit(i32::from(Exit::INTERRUPTED.0));
        }
        WAS_PRESSED.store(true, Ordering::Relaxed);
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
