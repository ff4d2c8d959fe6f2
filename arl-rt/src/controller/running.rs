//! A controller in a thread of its own.

use std::panic::resume_unwind;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc;
use std::thread::{self, JoinHandle};

use super::{Controller, Handle, Outcome, SetupError};

/// A controller that runs in a thread of its own, from [`Controller::spawn`].
///
/// Dropping it stops the programs, and waits until the robots have come to rest on their paths.
#[derive(Debug)]
pub struct Running {
    handle: Handle,
    stops: Arc<AtomicBool>,
    /// `None` once somebody waits for its end.
    thread: Option<JoinHandle<Outcome>>,
}

impl Running {
    /// A handle of the controller.
    pub fn handle(&self) -> Handle {
        self.handle.clone()
    }

    /// Waits until the programs have ended.
    ///
    /// # Panics
    /// What the controller runs has panicked: with the same words.
    pub fn join(mut self) -> Outcome {
        let outcome = self.thread.take().map(JoinHandle::join);
        match outcome {
            Some(Ok(outcome)) => outcome,
            Some(Err(panic)) => resume_unwind(panic),
            None => Outcome::Stopped,
        }
    }

    /// Stops the programs, and waits until the robots have come to rest on their paths.
    ///
    /// # Panics
    /// As [`join`](Running::join).
    pub fn stop(self) -> Outcome {
        self.stops.store(true, Ordering::Relaxed);
        self.join()
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        self.stops.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

impl Controller {
    /// Makes a controller in a thread of its own, and runs it there: on the real clock as a rule, since on the virtual one
    /// cycles follow each other as fast as they can. Ends when the programs have ended, like [`run`](Controller::run). A program
    /// that waits does not end it, as somebody has a [`Handle`].
    ///
    /// The thread has the usual stack, of 2 MiB. [`Handle`] has an example.
    ///
    /// # Errors
    /// The controller cannot be made, or there is no thread for it.
    pub fn spawn(
        make: impl FnOnce() -> Result<Controller, SetupError> + Send + 'static,
    ) -> Result<Running, SetupError> {
        let (tell, told) = mpsc::sync_channel(1);
        let stops = Arc::new(AtomicBool::new(false));
        let stopped = Arc::clone(&stops);
        let run = move || match make() {
            Ok(mut controller) => {
                let _ = tell.send(Ok(controller.handle()));
                controller.run_until_told(&stopped)
            }
            Err(error) => {
                let _ = tell.send(Err(error));
                Outcome::Stopped
            }
        };
        let spawned = thread::Builder::new().name("arl-controller".into()).spawn(run);
        let thread = spawned.map_err(|error| SetupError::Outside(format!("there is no thread for it: {error}")))?;
        match told.recv() {
            Ok(handle) => Ok(Running { handle: handle?, stops, thread: Some(thread) }),
            Err(_) => match thread.join() {
                Err(panic) => resume_unwind(panic),
                // It always says one or the other.
                Ok(_) => Err(SetupError::Outside("the thread of the controller ended".into())),
            },
        }
    }

    fn run_until_told(&mut self, stops: &AtomicBool) -> Outcome {
        while !stops.load(Ordering::Relaxed) {
            if self.is_over() {
                return self.concluded();
            }
            self.step();
        }
        self.stop();
        while self.outcome().is_none() {
            self.step();
        }
        self.concluded()
    }

    /// The outcome of programs that have ended, with all stored.
    fn concluded(&mut self) -> Outcome {
        self.close_robots();
        self.settle_state();
        self.outcome().cloned().unwrap_or(Outcome::Stopped)
    }
}
