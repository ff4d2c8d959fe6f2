//! Work with the disk, beside the cycle: a write that has reached the disk takes longer than a cycle has.

use std::cell::{Cell, RefCell};
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel, sync_channel};
use std::thread::JoinHandle;

type Job = Box<dyn FnOnce() + Send>;

/// Does work on a thread of its own, one piece after the other in the order in which they come.
#[derive(Default)]
pub(crate) struct Disk {
    thread: RefCell<Option<Thread>>,
    /// Whether a program may wait for something that was begun since the last [`Disk::settle`].
    waited_for: Cell<bool>,
}

struct Thread {
    /// None when it is to end.
    jobs: Option<Sender<Job>>,
    handle: Option<JoinHandle<()>>,
}

/// Work that was begun.
pub(crate) struct Work<T>(Receiver<T>);

/// How far work has come.
pub(crate) enum Stage<T> {
    UnderWay,
    Done(T),
    /// It has panicked.
    Lost,
}

impl Disk {
    /// Starts the thread, which the first piece of work does otherwise.
    ///
    /// # Errors
    /// The system gives none.
    pub(crate) fn start(&self) -> std::io::Result<()> {
        let mut thread = self.thread.borrow_mut();
        if thread.as_ref().is_none_or(Thread::has_ended) {
            *thread = Some(Thread::start()?);
        }
        Ok(())
    }

    /// Begins a piece of work. Where the system gives no thread, it is done at once.
    pub(crate) fn begin<T: Send + 'static>(&self, work: impl FnOnce() -> T + Send + 'static) -> Work<T> {
        let (sender, receiver) = sync_channel(1);
        let job: Job = Box::new(move || {
            // Who has begun it may be gone.
            let _ = sender.send(work());
        });
        let started = self.start().is_ok();
        let thread = self.thread.borrow();
        match thread.as_ref().filter(|_| started).and_then(|thread| thread.jobs.as_ref()) {
            // A thread that has panicked just now drops the job, which is lost with it.
            Some(jobs) => drop(jobs.send(job)),
            None => job(),
        }
        Work(receiver)
    }

    /// Notes that a program waits for work.
    pub(crate) fn wait_for(&self) {
        self.waited_for.set(true);
    }

    /// Whether a program may wait for work.
    #[inline]
    pub(crate) fn is_waited_for(&self) -> bool {
        self.waited_for.get()
    }

    /// Waits until everything is done that has been begun.
    pub(crate) fn settle(&self) {
        self.waited_for.set(false);
        if self.thread.borrow().is_some() {
            // It is the last one. Nothing comes back where the thread has panicked.
            let _ = self.begin(|| ()).0.recv();
        }
    }
}

impl Thread {
    fn start() -> std::io::Result<Self> {
        let (sender, receiver) = channel::<Job>();
        let thread = std::thread::Builder::new().name("arl-disk".into());
        let handle = thread.spawn(move || receiver.iter().for_each(|job| job()))?;
        Ok(Self { jobs: Some(sender), handle: Some(handle) })
    }

    fn has_ended(&self) -> bool {
        self.handle.as_ref().is_none_or(JoinHandle::is_finished)
    }
}

impl Drop for Thread {
    /// Waits until everything is done that has been begun.
    fn drop(&mut self) {
        self.jobs = None;
        if let Some(handle) = self.handle.take() {
            // A panic there has been reported.
            let _ = handle.join();
        }
    }
}

impl<T> Work<T> {
    /// How far it has come; never waits. What is done is given once.
    pub(crate) fn stage(&self) -> Stage<T> {
        match self.0.try_recv() {
            Ok(value) => Stage::Done(value),
            Err(TryRecvError::Empty) => Stage::UnderWay,
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
        assert!(matches!(held.stage(), Stage::UnderWay), "nobody waits for it");
        gate.send(()).unwrap();
        disk.settle();
        assert!(matches!(held.stage(), Stage::Done(true)) && matches!(first.stage(), Stage::Done(())));
        drop(disk.begin(note(2)));
        drop(disk);
        assert_eq!(*order.lock().unwrap(), [1, 2], "dropping waits for what nobody asks for any more");
    }

    #[test]
    fn a_panic_loses_its_work_only() {
        let disk = Disk::default();
        let lost = disk.begin(|| std::panic::panic_any("meant to be"));
        disk.settle();
        assert!(matches!(lost.stage(), Stage::Lost));
        let next = disk.begin(|| 7);
        disk.settle();
        // The thread may just have been on its way out.
        let next = if let Stage::Done(seven) = next.stage() { seven } else { disk.begin(|| 7).0.recv().unwrap() };
        assert_eq!(next, 7);
    }
}
