//! A thread with a large stack, for runs whose functions may call each other deeply: a host's thread may have little.

use std::any::Any;
use std::fmt;
use std::mem::transmute;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::{Builder, JoinHandle};

type Job<'a, T> = Box<dyn FnOnce(&mut Option<T>) + Send + 'a>;

/// A thread that owns a value and works for one other thread, which waits meanwhile.
pub(crate) struct Room<T> {
    jobs: Option<Sender<Job<'static, T>>>,
    done: Receiver<()>,
    thread: Option<JoinHandle<()>>,
    /// After a fork the other process has no such thread.
    process: u32,
}

impl<T> fmt::Debug for Room<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Room").field("thread", &self.thread).finish_non_exhaustive()
    }
}

/// What crosses to the thread of a room although its type does not say that it may.
struct Crossing<T>(T);

// SAFETY: only one of the two threads goes on at any time, and each waits for the other with a channel, so that neither
// sees a value half-written.
unsafe impl<T> Send for Crossing<T> {}

impl<T> Crossing<T> {
    fn get(self) -> T {
        self.0
    }
}

impl<T: 'static> Room<T> {
    /// Starts the thread, without a value.
    ///
    /// # Errors
    /// There is no memory for it.
    pub(crate) fn new(stack: usize) -> std::io::Result<Self> {
        let (jobs, inbox) = channel::<Job<'static, T>>();
        let (tell, done) = channel();
        let work = move || {
            let mut value = None;
            for job in inbox {
                job(&mut value);
                if tell.send(()).is_err() {
                    break;
                }
            }
            // What fails now is of no use to anybody.
            let _ = catch_unwind(AssertUnwindSafe(|| drop(value)));
        };
        let thread = Builder::new().name("arl program".into()).stack_size(stack).spawn(work)?;
        Ok(Self { jobs: Some(jobs), done, thread: Some(thread), process: std::process::id() })
    }

    /// Has the thread call `act`, and waits for the result. A panic is returned; `None` in another process than that of
    /// the thread.
    pub(crate) fn call<R>(
        &self,
        act: impl FnOnce(&mut Option<T>) -> R,
    ) -> Option<Result<R, Box<dyn Any + Send + 'static>>> {
        if std::process::id() != self.process {
            return None;
        }
        let mut result = None;
        let crossing = Crossing((act, &raw mut result));
        let job: Job<'_, T> = Box::new(move |value| {
            let (act, result) = crossing.get();
            let done = catch_unwind(AssertUnwindSafe(|| act(value)));
            // SAFETY: the caller waits, and keeps the place of the result until it was told that the job is done.
            unsafe { *result = Some(done) };
        });
        // SAFETY: what the job borrows outlives it: this function waits until it was called, or was dropped with the
        // thread's end.
        let job = unsafe { transmute::<Job<'_, T>, Job<'static, T>>(job) };
        self.jobs.as_ref()?.send(job).ok()?;
        self.done.recv().ok()?;
        result
    }
}

impl<T> Drop for Room<T> {
    fn drop(&mut self) {
        // The thread ends with its last job; what it owns has ended when this returns.
        self.jobs = None;
        if let Some(thread) = self.thread.take().filter(|_| std::process::id() == self.process) {
            let _ = thread.join();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::rc::Rc;

    #[test]
    fn a_value_stays_in_its_room_until_the_end() {
        let room = Room::<Rc<String>>::new(1 << 20).unwrap();
        let name = String::from("robot");
        let begun = room.call(|value| *value = Some(Rc::new(name.clone())));
        assert!(matches!(begun, Some(Ok(()))));
        let length = room.call(|value| value.as_ref().map_or(0, |name| name.len()));
        assert!(matches!(length, Some(Ok(5))));
        let panicked = room.call(|_| panic!("on purpose"));
        assert!(matches!(panicked, Some(Err(_))), "a panic comes back");
        assert!(matches!(room.call(|value| value.is_some()), Some(Ok(true))));
    }

    #[test]
    fn its_stack_is_as_deep_as_asked_for() {
        fn deep(depth: usize) -> usize {
            let room = std::hint::black_box([depth; 128]);
            if depth == 0 { 0 } else { 1 + deep(depth - 1) + room[1].saturating_sub(depth) }
        }
        let room = Room::<()>::new(64 << 20).unwrap();
        assert!(matches!(room.call(|_| deep(20_000)), Some(Ok(20_000))));
    }
}
