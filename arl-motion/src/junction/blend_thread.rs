//! Finds junctions in parallel with the cycle, on a thread of its own.
//!
//! When a motion is laid is decided by the cycle alone, whatever the thread has done until then. A junction that the
//! thread has found by then is used; one that it is finding is waited for; otherwise the cycle finds it. All three give
//! the same result, so a run does not depend on the thread. In real time the motion waits instead until the thread is
//! ready.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Arc, OnceLock};
use std::thread;

use crate::beside;
use crate::junction::junction_memory::JunctionMemory;
use crate::junction::{Before, Junction, MotionPair};
use crate::plan::motion::Motion;
use arl_robot::robot::Robot;

/// Maximum number of junctions that are waiting, being found or finished; those beyond are found when they are needed.
const MOST_JUNCTIONS: usize = 1024;

/// A junction that is being found.
#[derive(Clone, Debug, Default)]
pub(crate) struct Prepared(Arc<Preparation>);

#[derive(Debug, Default)]
struct Preparation {
    junction: OnceLock<Junction>,
    /// Whether the thread has given up the search, or never had it.
    is_abandoned: AtomicBool,
}

/// What is known about the junction before a motion.
#[derive(Debug)]
pub(crate) enum Joining {
    /// The junction as it lies on the path.
    Known(Before),
    /// What this junction, which comes first, passes on.
    Behind(Prepared),
}

struct Task {
    robot: Arc<Robot>,
    joining: Joining,
    from: Arc<Motion>,
    to: Arc<Motion>,
    result: Prepared,
    /// A junction that the thread has forgotten in exchange.
    forgotten: Option<Prepared>,
}

/// The thread; it starts with the first junction.
#[derive(Debug, Default)]
pub(crate) struct BlendThread {
    channels: Option<Channels>,
}

#[derive(Debug)]
struct Channels {
    tasks: SyncSender<Task>,
    /// Finished tasks come back, so that memory is freed where it was allocated.
    done: Receiver<Task>,
}

impl Clone for BlendThread {
    /// Creates another thread handle, with a thread of its own.
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl BlendThread {
    /// Starts the search for a junction.
    pub(crate) fn prepare(&mut self, robot: &Arc<Robot>, joining: Joining, [from, to]: [&Arc<Motion>; 2]) -> Prepared {
        let result = Prepared::default();
        let (from, to) = (Arc::clone(from), Arc::clone(to));
        let task = Task { robot: Arc::clone(robot), joining, from, to, result: result.clone(), forgotten: None };
        if self.channels.is_none() {
            self.channels = begin();
        }
        let is_sent = self.channels.as_ref().is_some_and(|channels| {
            channels.done.try_iter().for_each(drop);
            channels.tasks.try_send(task).is_ok()
        });
        if !is_sent {
            // The junction is found when it is needed.
            result.leave();
        }
        result
    }
}

#[cfg(test)]
impl BlendThread {
    /// A thread handle whose thread never does anything.
    pub(crate) fn stuck() -> Self {
        let (tasks, asked) = sync_channel(MOST_JUNCTIONS);
        let (_, done) = sync_channel(0);
        std::mem::forget(asked);
        Self { channels: Some(Channels { tasks, done }) }
    }
}

impl From<Junction> for Prepared {
    /// A junction that is already found.
    fn from(junction: Junction) -> Self {
        Self(Arc::new(Preparation { junction: junction.into(), is_abandoned: false.into() }))
    }
}

impl Prepared {
    /// Waits until the thread has found it.
    #[cfg(test)]
    pub(crate) fn wait(&self) {
        self.0.junction.wait();
    }

    /// Whether there is no need to wait for the thread.
    pub(crate) fn is_ready(&self) -> bool {
        self.junction().is_some() || self.0.is_abandoned.load(Ordering::Acquire)
    }

    /// The junction, if it has been found.
    pub(crate) fn junction(&self) -> Option<&Junction> {
        self.0.junction.get()
    }

    fn leave(&self) {
        self.0.is_abandoned.store(true, Ordering::Release);
    }

    /// The junction that has been found, or that is found now for `pair`.
    pub(crate) fn take(&self, robot: &Robot, pair: impl FnOnce() -> MotionPair) -> &Junction {
        self.0.junction.get_or_init(|| Junction::find(robot, pair()))
    }
}

/// Starts the thread; it ends when no more tasks can be sent to it.
fn begin() -> Option<Channels> {
    let (tasks, asked) = sync_channel::<Task>(MOST_JUNCTIONS);
    let (does, done) = sync_channel(MOST_JUNCTIONS);
    let work = move || {
        let mut memory = JunctionMemory::default();
        for mut task in asked {
            task.run(&mut memory);
            // Where the channel is full, the task is simply dropped here.
            let _ = does.try_send(task);
        }
    };
    beside::spawn(thread::Builder::new().name("blends".into()), work).ok().map(|_| Channels { tasks, done })
}

impl Task {
    fn run(&mut self, memory: &mut JunctionMemory) {
        let pair = || {
            let before = match &self.joining {
                Joining::Known(before) => before.clone(),
                Joining::Behind(first) => first.junction().and_then(Junction::leaves),
            };
            MotionPair { before, from: Arc::clone(&self.from), to: Arc::clone(&self.to) }
        };
        // A panic here happens again in the cycle, where it is noticed.
        let find = || self.result.0.junction.get_or_init(|| memory.recall(&self.robot, pair()));
        match catch_unwind(AssertUnwindSafe(find)) {
            Ok(_) => self.forgotten = memory.remember(&self.robot, &self.result),
            Err(_) => self.result.leave(),
        }
    }
}
