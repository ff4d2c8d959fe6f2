//! A controller in a thread of its own.

use std::panic::resume_unwind;
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};
use std::sync::mpsc;
use std::thread::{self, JoinHandle};
use std::time::Duration;

use super::{Controller, Handle, Outcome, SetupError};

/// Commands for the thread. Go on: programs that have ended can begin again.
const GO_ON: u8 = 0;
/// End once the programs have ended.
const END_WITH_PROGRAMS: u8 = 1;
/// Stop the programs.
const STOP: u8 = 2;

/// How long the thread waits between two cycles where the programs have ended and cycles do not take real time.
const IDLE: Duration = Duration::from_millis(1);

/// A controller that runs in a thread of its own, from [`Controller::spawn`].
///
/// It holds its robots when the programs have ended, until a thread [joins](Running::join) it: a handle can let them
/// begin again. Dropping it stops the programs, and waits until the robots have come to rest on their paths.
#[derive(Debug)]
pub struct Running {
    handle: Handle,
    command: Arc<AtomicU8>,
    thread: Option<JoinHandle<Outcome>>,
}

impl Running {
    /// A handle to the controller.
    pub fn handle(&self) -> Handle {
        self.handle.clone()
    }

    /// Waits until the programs have ended, or, where no handle is left, can never go on.
    ///
    /// # Panics
    /// What the controller runs has panicked: this panics with the same payload.
    pub fn join(mut self) -> Outcome {
        self.wait(END_WITH_PROGRAMS).unwrap_or_else(|panic| resume_unwind(panic))
    }

    /// Stops the programs, and waits until the robots have come to rest on their paths.
    ///
    /// # Panics
    /// As [`join`](Running::join).
    pub fn stop(mut self) -> Outcome {
        self.wait(STOP).unwrap_or_else(|panic| resume_unwind(panic))
    }

    /// Tells the thread how to end, and waits for it, unless this is that thread.
    fn wait(&mut self, how: u8) -> thread::Result<Outcome> {
        self.command.store(how, Ordering::Relaxed);
        // The caller makes no more requests while it waits for the end: programs that wait for other threads then wait
        // in vain.
        self.handle.forget();
        match self.thread.take() {
            Some(thread) if !self.handle.is_own_thread() => thread.join(),
            _ => Ok(Outcome::Stopped),
        }
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        if self.thread.is_some() {
            let _ = self.wait(STOP);
        }
    }
}

impl Controller {
    /// Makes a controller in a thread of its own, and runs it there: as a rule on the real clock, since on the virtual
    /// one cycles follow each other as fast as they can. [`Handle`] has an example.
    ///
    /// The thread has the usual stack of 2 MiB, which is too small for a larger
    /// [`Builder::stack`](super::Builder::stack) than the default.
    ///
    /// # Errors
    /// The controller cannot be made, or the thread cannot be started.
    pub fn spawn(
        make: impl FnOnce() -> Result<Controller, SetupError> + Send + 'static,
    ) -> Result<Running, SetupError> {
        let (tell, made) = mpsc::sync_channel(1);
        let command = Arc::new(AtomicU8::new(GO_ON));
        let received = Arc::clone(&command);
        let run = move || match make() {
            Ok(mut controller) => {
                let _ = tell.send(Ok(controller.handle()));
                // The handle in the channel would count as one in use.
                drop(tell);
                controller.run_until_commanded(&received)
            }
            Err(error) => {
                let _ = tell.send(Err(error));
                Outcome::Stopped
            }
        };
        let spawned = thread::Builder::new().name("arl-controller".into()).spawn(run);
        let thread = spawned
            .map_err(|error| SetupError::Other(format!("the controller's thread cannot be started: {error}")))?;
        match made.recv() {
            Ok(handle) => Ok(Running { handle: handle?, command, thread: Some(thread) }),
            // The thread has sent neither a handle nor an error.
            Err(_) => match thread.join() {
                Err(panic) => resume_unwind(panic),
                Ok(outcome) => Err(SetupError::Other(format!("there is no controller: {outcome}"))),
            },
        }
    }

    fn run_until_commanded(&mut self, command: &AtomicU8) -> Outcome {
        let mut how = GO_ON;
        while how == GO_ON {
            if self.is_over() && !self.clock.is_real() {
                thread::sleep(IDLE);
            }
            self.step();
            how = command.load(Ordering::Relaxed);
        }
        let outcome = if how == STOP { self.stop_to_end() } else { self.step_to_end() };
        self.close_robots();
        self.settle_state();
        outcome
    }

    fn stop_to_end(&mut self) -> Outcome {
        loop {
            if let Some(outcome) = self.outcome() {
                return outcome.clone();
            }
            // Stopped again each cycle: a scenario, a PLC or another thread may let a program begin again.
            self.stop();
            self.step();
        }
    }
}
