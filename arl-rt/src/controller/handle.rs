//! Access for other threads: a controller stays on its own thread, and carries out their requests between two cycles.

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

/// How long a thread waits by default for a controller that is not stepped.
const PATIENCE: Duration = Duration::from_secs(1);

/// A request to be carried out between two cycles.
type Call = Box<dyn FnOnce(&mut Controller) + Send>;

/// Access to a controller for other threads: buttons, inputs and outputs, status, events.
///
/// It can be cloned and sent. All requests are carried out by the thread of the controller, at the beginning of its
/// next cycle, in the order in which they were made. So two threads never disturb each other, and a program sees inputs
/// change between its cycles only. As long as a handle exists, a program that waits is not a
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
    /// The controller's desk, dropped with it.
    desk: Weak<Desk>,
    thread: ThreadId,
    patience: Duration,
}

impl Handle {
    /// The same handle, with another time to wait for a controller that is not stepped; the default is 1 s.
    pub fn patience(mut self, patience: Duration) -> Self {
        self.patience = patience;
        self
    }

    /// Lets the controller's thread call `question` between two cycles, and waits for the result. The cycle waits, too,
    /// so `question` has to be quick. A panic in it affects this thread's call only.
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
        // Whichever thread sets it first decides: the call is made, or it is no longer waited for.
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
            // The call is being made right now.
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

    /// Detaches this handle from the controller.
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

    /// Carries out the words of a scenario's event, as [`Controller::order`]: `di.5 = true`, `pendant = "pause"`.
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

    /// The status of the controller.
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
    /// As [`ask`](Handle::ask): then the power was not cut. A real cell has a button for this that needs no program.
    pub fn emergency_stop(&self) -> Result<(), HandleError> {
        self.ask(Controller::emergency_stop)
    }

    /// Events from now on: messages, warnings, alarms, and each change of the state. They are kept until they are
    /// received; dropping the receiver ends this. [`Builder::events`](super::Builder::events) delivers all from the
    /// start.
    ///
    /// # Errors
    /// As [`ask`](Handle::ask).
    pub fn events(&self) -> Result<Receiver<Event>, HandleError> {
        let (sender, events) = mpsc::channel();
        self.ask(move |controller| controller.shared.subscribers.add(sender))?;
        Ok(events)
    }
}

impl fmt::Debug for Handle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Handle").field("patience", &self.patience).finish_non_exhaustive()
    }
}

/// The reason why a [`Handle`] could not do something.
#[derive(Clone, PartialEq, Debug)]
#[non_exhaustive]
pub enum HandleError {
    /// The controller does not exist any more.
    Gone,
    /// This is the controller's own thread, which would wait for itself.
    OwnThread,
    /// The requested closure has panicked.
    Panicked,
    /// The controller was not stepped in time. Nothing was done, nor will it be.
    NotStepped,
    /// The text is not an order, or the order cannot be carried out.
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

/// Where requests wait for the next cycle. Requests that are not carried out any more are dropped with it, which ends
/// the wait of their threads.
#[derive(Default)]
struct Desk {
    /// Locked for moving a pointer only; `any` changes under the lock.
    calls: Mutex<Vec<Call>>,
    /// Whether there are requests: this is what the cycle checks.
    any: AtomicBool,
}

impl Desk {
    fn add(&self, call: Call) {
        let mut calls = self.calls.lock().unwrap_or_else(PoisonError::into_inner);
        calls.push(call);
        self.any.store(true, Ordering::Release);
    }
}

/// The requests of a controller's handles.
#[derive(Default)]
pub(super) struct HandleCalls(Arc<Desk>);

impl HandleCalls {
    /// Whether any handle exists.
    pub(super) fn is_open(&self) -> bool {
        Arc::weak_count(&self.0) > 0
    }

    /// All requests made so far.
    fn take(&self) -> Vec<Call> {
        if !self.0.any.load(Ordering::Acquire) {
            return Vec::new();
        }
        // Where the lock is held right now, the next cycle takes the requests.
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

    /// Carries out the requests of handles made so far. What a thread requests next, after its answer, waits for the
    /// next cycle: a thread that makes requests without end does not hold up this one.
    pub(super) fn answer_handles(&mut self) {
        self.calls.take().into_iter().for_each(|call| call(self));
    }
}
