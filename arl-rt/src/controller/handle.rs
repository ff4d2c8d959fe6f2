//! The door for other threads: a controller stays on its own, and does between two cycles what they ask.

use std::fmt;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::sync::{Arc, Mutex, PoisonError, Weak};
use std::thread::{self, ThreadId};
use std::time::Duration;

use super::{Controller, OrderError, Status};
use crate::context::subscribers::Event;
use crate::cycle::catch_panic::catch_panic;
use crate::cycle::try_lock::try_lock;
use crate::fault::Fault;
use crate::io::Pendant;

/// How long a thread waits for a controller that nobody steps, where it does not say otherwise.
const PATIENCE: Duration = Duration::from_secs(1);

/// What somebody wants done between two cycles.
type Call = Box<dyn FnOnce(&mut Controller) + Send>;

/// A controller as other threads have it: buttons, inputs and outputs, how everything stands, what happens.
///
/// It can be cloned and sent. All that it does is done by the thread of the controller, at the beginning of its next
/// cycle, in the order in which it was asked. So two threads never disturb each other, and a program sees inputs change
/// between its cycles only. As long as a handle is there, a program that waits is no
/// [standstill](Controller::standstill).
///
/// ```
/// use arl_rt::clock::RealClock;
/// use arl_rt::{Controller, Outcome};
/// # use arl_rt::emit::*;
/// # struct Fill;
/// # impl arl_rt::Program for Fill {
/// #     fn file(&self) -> File { File::new("fill.arl") }
/// #     fn family(&self) -> Family { Family::SixAxis }
/// #     fn main<'a>(&'a self, cx: &'a Cx) -> BoxFuture<'a> {
/// #         Box::pin(async move {
/// #             while !io::getdi(cx, 1).await.at(self.file(), 2)? {
/// #                 flow::waittime(0.001).run(cx).await.at(self.file(), 2)?;
/// #             }
/// #             io::setdo(cx, 1, true).await.at(self.file(), 3)
/// #         })
/// #     }
/// # }
///
/// // A controller in a thread of its own, which waits for input 1.
/// let running = Controller::spawn(|| Controller::builder().clock(RealClock::new()).build(Box::new(Fill)))?;
/// let handle = running.handle();
/// assert!(!handle.digital_output(1)?);
/// handle.set_digital_input(1, true)?;
/// assert_eq!(running.join(), Outcome::Ended);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct Handle {
    /// The controller's: gone when that is.
    desk: Weak<Desk>,
    thread: ThreadId,
    patience: Duration,
}

impl Handle {
    /// The same handle, which waits so long for a controller that nobody steps; without it 1 s.
    pub fn patience(mut self, patience: Duration) -> Self {
        self.patience = patience;
        self
    }

    /// Lets the controller's thread do something between two cycles, and waits for what comes of it. The cycle waits,
    /// too, so it has to be quick. A panic in it is this thread's loss only.
    ///
    /// # Errors
    /// The controller is gone, or was not stepped in time; or this is its own thread, as in a closure that it calls.
    /// Then nothing was done. Or the question panicked.
    pub fn ask<R: Send + 'static>(
        &self,
        question: impl FnOnce(&mut Controller) -> R + Send + 'static,
    ) -> Result<R, HandleError> {
        if self.is_own_thread() {
            return Err(HandleError::OwnThread);
        }
        let (answer, answered) = mpsc::sync_channel(1);
        // Whoever sets it first decides: it is done, or nobody waits for it any more.
        let decided = Arc::new(AtomicBool::new(false));
        let in_time = Arc::clone(&decided);
        let call = Box::new(move |controller: &mut Controller| {
            if !in_time.swap(true, Ordering::AcqRel) {
                let _ = answer.send(catch_panic(|| question(controller)));
            }
        });
        self.desk.upgrade().ok_or(HandleError::Gone)?.add(call);
        let answer = match answered.recv_timeout(self.patience) {
            Err(RecvTimeoutError::Timeout) if !decided.swap(true, Ordering::AcqRel) => {
                return Err(HandleError::NotStepped);
            }
            // It is being done right now.
            Err(RecvTimeoutError::Timeout) => answered.recv().map_err(|_| HandleError::Gone)?,
            Err(RecvTimeoutError::Disconnected) => return Err(HandleError::Gone),
            Ok(answer) => answer,
        };
        answer.ok_or(HandleError::Panicked)
    }

    /// Whether this is the thread of the controller itself.
    pub(super) fn is_own_thread(&self) -> bool {
        thread::current().id() == self.thread
    }

    /// It is nobody's any more.
    pub(super) fn forget(&mut self) {
        self.desk = Weak::new();
    }

    /// Presses a button.
    ///
    /// # Errors
    /// As [`ask`](Handle::ask).
    pub fn press(&self, button: Pendant) -> Result<(), HandleError> {
        self.ask(move |controller| controller.press(button))
    }

    /// Does what an event of a scenario does, as [`Controller::order`]: `di.5 = true`, `pendant = "pause"`.
    ///
    /// # Errors
    /// As [`ask`](Handle::ask); or the text is not an order, and nothing was done.
    pub fn order(&self, text: impl Into<String>) -> Result<(), HandleError> {
        let text = text.into();
        self.ask(move |controller| controller.order(&text))?.map_err(HandleError::Order)
    }

    /// Sets a digital input, from 1.
    ///
    /// # Errors
    /// As [`ask`](Handle::ask); or there is no such channel.
    pub fn set_digital_input(&self, channel: i32, level: bool) -> Result<(), HandleError> {
        Ok(self.ask(move |controller| controller.set_digital_input(channel, level))??)
    }

    /// Sets an analog input, from 1, in V or mA.
    ///
    /// # Errors
    /// As [`ask`](Handle::ask); or there is no such channel, or its type cannot carry the value.
    pub fn set_analog_input(&self, channel: i32, value: f64) -> Result<(), HandleError> {
        Ok(self.ask(move |controller| controller.set_analog_input(channel, value))??)
    }

    /// The level of a digital output, from 1.
    ///
    /// # Errors
    /// As [`ask`](Handle::ask); or there is no such channel.
    pub fn digital_output(&self, channel: i32) -> Result<bool, HandleError> {
        Ok(self.ask(move |controller| controller.digital_output(channel))??)
    }

    /// The value of an analog output, from 1, in V or mA.
    ///
    /// # Errors
    /// As [`ask`](Handle::ask); or there is no such channel.
    pub fn analog_output(&self, channel: i32) -> Result<f64, HandleError> {
        Ok(self.ask(move |controller| controller.analog_output(channel))??)
    }

    /// How everything stands.
    ///
    /// # Errors
    /// As [`ask`](Handle::ask).
    pub fn status(&self) -> Result<Status, HandleError> {
        self.ask(|controller| controller.status())
    }

    /// Ends the programs; the robots stop on their paths.
    ///
    /// # Errors
    /// As [`ask`](Handle::ask).
    pub fn stop(&self) -> Result<(), HandleError> {
        self.ask(Controller::stop)
    }

    /// Cuts the power of all robots, as [`Controller::emergency_stop`].
    ///
    /// # Errors
    /// As [`ask`](Handle::ask): then nothing was cut. A real cell has a button for this that needs no program.
    pub fn emergency_stop(&self) -> Result<(), HandleError> {
        self.ask(Controller::emergency_stop)
    }

    /// What happens from now on: messages, warnings, alarms, and each change of the state. They are kept until somebody
    /// takes them; dropping the receiver ends it. [`Builder::events`](super::Builder::events) has all from the start.
    ///
    /// # Errors
    /// As [`ask`](Handle::ask).
    pub fn events(&self) -> Result<Receiver<Event>, HandleError> {
        let (tell, told) = mpsc::channel();
        self.ask(move |controller| controller.shared.subscribers.add(tell))?;
        Ok(told)
    }
}

impl fmt::Debug for Handle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Handle").field("patience", &self.patience).finish_non_exhaustive()
    }
}

/// Why a [`Handle`] could not do something.
#[derive(Clone, PartialEq, Debug)]
#[non_exhaustive]
pub enum HandleError {
    /// There is no controller any more.
    Gone,
    /// This is the thread of the controller itself, which would wait for itself.
    OwnThread,
    /// What was asked has panicked.
    Panicked,
    /// Nobody stepped the controller in time. Nothing was done, and nothing of it will be.
    NotStepped,
    /// It is not an order, or cannot be carried out.
    Order(OrderError),
    /// There is no such input or output, or it cannot carry the value.
    Fault(Fault),
}

impl fmt::Display for HandleError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            HandleError::Gone => write!(f, "the controller is gone"),
            HandleError::OwnThread => write!(f, "a handle is for threads other than that of its controller"),
            HandleError::Panicked => write!(f, "what the controller was asked to do has panicked"),
            HandleError::NotStepped => write!(f, "nobody steps the controller: nothing was done"),
            HandleError::Order(why) => write!(f, "{why}"),
            HandleError::Fault(fault) => write!(f, "{fault}"),
        }
    }
}

impl std::error::Error for HandleError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            HandleError::Order(error) => Some(error),
            HandleError::Fault(fault) => Some(fault),
            _ => None,
        }
    }
}

impl From<Fault> for HandleError {
    fn from(fault: Fault) -> Self {
        HandleError::Fault(fault)
    }
}

/// Where questions wait for the next cycle. What nobody answers any more goes with it, and then whoever waits knows.
#[derive(Default)]
struct Desk {
    /// Locked for moving a pointer only; `any` changes under the lock.
    calls: Mutex<Vec<Call>>,
    /// Whether there are some: what the cycle looks at.
    any: AtomicBool,
}

impl Desk {
    fn add(&self, call: Call) {
        let mut calls = self.calls.lock().unwrap_or_else(PoisonError::into_inner);
        calls.push(call);
        self.any.store(true, Ordering::Release);
    }
}

/// What the handles of a controller ask of it.
#[derive(Default)]
pub(super) struct HandleCalls(Arc<Desk>);

impl HandleCalls {
    /// Whether anybody can ask.
    pub(super) fn is_open(&self) -> bool {
        Arc::weak_count(&self.0) > 0
    }

    /// All that was asked until now.
    fn take(&self) -> Vec<Call> {
        if !self.0.any.load(Ordering::Acquire) {
            return Vec::new();
        }
        // Where the lock is held just now, it is the next cycle's business.
        let Some(mut calls) = try_lock(&self.0.calls) else { return Vec::new() };
        self.0.any.store(false, Ordering::Relaxed);
        std::mem::take(&mut calls)
    }
}

impl Controller {
    /// A handle for other threads.
    pub fn handle(&self) -> Handle {
        Handle { desk: Arc::downgrade(&self.calls.0), thread: thread::current().id(), patience: PATIENCE }
    }

    /// Does what handles have asked for until now. What they ask next, having an answer, waits for the next cycle: a
    /// thread that asks without end does not hold up this one.
    pub(super) fn answer_handles(&mut self) {
        self.calls.take().into_iter().for_each(|call| call(self));
    }
}
