//! A thread for disk access outside the cycle: a write that reaches the disk takes longer than a cycle.

use std::cell::{Cell, RefCell};
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel, sync_channel};
use std::thread::JoinHandle;

use arl_motion::beside;

use crate::cycle::catch_panic::catch_panic;

type Job = Box<dyn FnOnce() + Send>;

/// Runs jobs on a thread of its own, one after the other in the order in which they arrive.
#[derive(Default)]
pub(crate) struct Disk {
    thread: RefCell<Option<Thread>>,
    /// Whether a program may wait for a job that was begun since the last [`Disk::settle`].
    waited_for: Cell<bool>,
}

struct Thread {
    /// `None` once the thread is to end.
    jobs: Option<Sender<Job>>,
    handle: Option<JoinHandle<()>>,
}

/// A job that was begun.
pub(crate) struct Work<T>(Receiver<T>);

/// The state of a job.
pub(crate) enum Stage<T> {
    InProgress,
    Done(T),
    /// The job has panicked.
    Lost,
}

impl Disk {
    /// Starts the thread; otherwise the first job starts it.
    ///
    /// # Errors
    /// The system provides no thread.
    pub(crate) fn start(&self) -> std::io::Result<()> {
        let mut thread = self.thread.borrow_mut();
        if thread.is_none() {
            *thread = Some(Thread::start()?);
        }
        Ok(())
    }

    /// Begins a job. If the system provides no thread, the job is done at once.
    pub(crate) fn begin<T: Send + 'static>(&self, work: impl FnOnce() -> T + Send + 'static) -> Work<T> {
        let (sender, receiver) = sync_channel(1);
        let job: Job = Box::new(move || {
            // The receiver may be gone. A panic drops the sender, which marks the job as lost.
            let _ = catch_panic(work).map(|done| sender.send(done));
        });
        let started = self.start().is_ok();
        let thread = self.thread.borrow();
        match thread.as_ref().filter(|_| started).and_then(|thread| thread.jobs.as_ref()) {
            // The thread receives until this sender is dropped.
            Some(jobs) => drop(jobs.send(job)),
            None => job(),
        }
        Work(receiver)
    }

    /// Notes that a program waits for a job.
    pub(crate) fn wait_for(&self) {
        self.waited_for.set(true);
    }

    /// Whether a program may wait for a job.
    #[inline]
    pub(crate) fn is_waited_for(&self) -> bool {
        self.waited_for.get()
    }

    /// Waits until all jobs that have been begun are done.
    pub(crate) fn settle(&self) {
        self.waited_for.set(false);
        if self.thread.borrow().is_some() {
            // This job is the last one, so it is done after all that were begun before it.
            let _ = self.begin(|| ()).0.recv();
        }
    }
}

impl Thread {
    fn start() -> std::io::Result<Self> {
        let (sender, receiver) = channel::<Job>();
        let thread = std::thread::Builder::new().name("arl-disk".into());
        let handle = beside::spawn(thread, move || receiver.iter().for_each(|job| job()))?;
        Ok(Self { jobs: Some(sender), handle: Some(handle) })
    }
}

impl Drop for Thread {
    /// Waits until all jobs that have been begun are done.
    fn drop(&mut self) {
        self.jobs = None;
        if let Some(handle) = self.handle.take() {
            // The thread never ends by a panic of a job.
            let _ = handle.join();
        }
    }
}

impl<T> Work<T> {
    /// The state of the job; never waits. The result is returned once.
    pub(crate) fn stage(&self) -> Stage<T> {
        match self.0.try_recv() {
            Ok(value) => Stage::Done(value),
            Err(TryRecvError::Empty) => Stage::InProgress,
            Err(TryRecvError::Disconnected) => Stage::Lost,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::{Arc, Mutex};

    #[test]
    fn work_is_done_in_order_and_beside() {
        let disk = Disk::default();
        let (gate, wait) = channel::<()>();
        let order = Arc::new(Mutex::new(Vec::new()));
        let note = |number: i32| {
            let order = Arc::clone(&order);
            move || order.lock().unwrap().push(number)
        };
        let (first, held) = (note(1), disk.begin(move || wait.recv().is_ok()));
        let first = disk.begin(first);
        assert!(matches!(held.stage(), Stage::InProgress), "nobody waits for it");
        gate.send(()).unwrap();
        disk.settle();
        assert!(matches!(held.stage(), Stage::Done(true)) && matches!(first.stage(), Stage::Done(())));
        drop(disk.begin(note(2)));
        drop(disk);
        assert_eq!(*order.lock().unwrap(), [1, 2], "dropping waits for what nobody asks for any more");
    }

    /// Holds a panic in progress: signals that it has begun, and waits until it may continue.
    struct Unwinding {
        begun: Sender<()>,
        go_on: Receiver<()>,
    }

    impl Drop for Unwinding {
        fn drop(&mut self) {
            self.begun.send(()).unwrap();
            self.go_on.recv().unwrap();
        }
    }

    #[test]
    fn a_panic_loses_its_work_only() {
        let disk = Disk::default();
        let ((begun, has_begun), (gate, go_on)) = (channel(), channel());
        let before = disk.begin(|| 5);
        let lost = disk.begin(|| {
            let _held = Unwinding { begun, go_on };
            std::panic::panic_any("meant to be")
        });
        has_begun.recv().unwrap();
        let during = disk.begin(|| 6);
        gate.send(()).unwrap();
        disk.settle();
        assert!(matches!(lost.stage(), Stage::Lost));
        let after = disk.begin(|| 7);
        disk.settle();
        for (work, number) in [(before, 5), (during, 6), (after, 7)] {
            assert!(matches!(work.stage(), Stage::Done(done) if done == number), "{number}");
        }
    }
}
