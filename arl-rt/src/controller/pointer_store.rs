//! Stores the program and motion pointers, in a thread beside the cycle.

use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

use arl_motion::beside;

use crate::cycle::catch_panic::catch_panic;
use crate::cycle::channel_id::MOST_FOREGROUND;
use crate::cycle::try_lock::try_lock;
use crate::storage::pointers::{self, CurrentPointers, PointerTable};
use crate::storage::state::{self, Storage};

/// How long the thread waits before it stores what has changed, unless the programs have ended: what a kill of the
/// process may lose.
const STORE_INTERVAL: Duration = Duration::from_secs(1);

/// How often a caller that waits for the thread checks that it still exists.
const THREAD_CHECK_INTERVAL: Duration = Duration::from_millis(50);

/// Stores the pointers of the foreground channels on a thread of its own. The cycle leaves their values there and goes
/// on.
pub(super) struct PointerStore {
    exchange: Arc<Exchange>,
    thread: Option<JoinHandle<()>>,
    /// The pointers of the last cycle.
    noted: [CurrentPointers; MOST_FOREGROUND],
    /// Whether the thread has not got them yet.
    news: bool,
    /// Whether the thread was notified that the programs have ended.
    hurried: bool,
}

/// What the cycle and the thread share: a lock that both hold for copying only, and that the cycle does not wait for.
struct Exchange {
    pending: Mutex<Pending>,
    /// Notified when the thread should not wait, and when it has stored something.
    changed: Condvar,
}

#[derive(Default)]
struct Pending {
    now: [CurrentPointers; MOST_FOREGROUND],
    /// Whether the thread should store this without waiting.
    hurry: bool,
    /// Whether the thread should end after that.
    last: bool,
    /// An error that has not been reported yet.
    problem: Option<String>,
}

impl Exchange {
    fn lock(&self) -> MutexGuard<'_, Pending> {
        self.pending.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Runs the thread: stores what has changed since `kept`, which is stored already.
    fn run(&self, storage: &mut dyn Storage, kept: &PointerTable) {
        let mut stored = pointers::written(kept);
        let mut reported = None;
        let mut pending = self.lock();
        loop {
            (pending, _) = self
                .changed
                .wait_timeout_while(pending, STORE_INTERVAL, |pending| !pending.hurry)
                .unwrap_or_else(PoisonError::into_inner);
            let (now, last) = (pending.now, pending.last);
            drop(pending);
            let mut table = kept.clone();
            table.iter_mut().zip(&now).for_each(|(kept, now)| *kept = kept.renewed(now));
            let text = pointers::written(&table);
            let store = || state::store(storage, pointers::STORED, &text);
            let done = if text == stored {
                Ok(())
            } else {
                catch_panic(store).unwrap_or_else(|| Err(state::panicked(pointers::STORED)))
            };
            pending = self.lock();
            match done {
                Ok(()) => (stored, reported) = (text, None),
                // An error is reported once, however often storing is tried.
                Err(error) if reported.as_ref() != Some(&error) => {
                    pending.problem = Some(format!("the program pointers cannot be saved: {error}"));
                    reported = Some(error);
                }
                Err(_) => {}
            }
            if pending.now == now && pending.last == last {
                pending.hurry = false;
                self.changed.notify_all();
            }
            if last {
                return;
            }
        }
    }
}

impl PointerStore {
    /// Starts the thread. `kept` is the content of this storage.
    ///
    /// # Errors
    /// The system cannot start a thread.
    pub(super) fn start(mut storage: Box<dyn Storage + Send>, kept: PointerTable) -> std::io::Result<Self> {
        let exchange = Arc::new(Exchange { pending: Mutex::default(), changed: Condvar::new() });
        let shared = Arc::clone(&exchange);
        let thread = std::thread::Builder::new().name("arl-pointers".into());
        let thread = beside::spawn(thread, move || shared.run(&mut *storage, &kept))?;
        let noted = Default::default();
        Ok(Self { exchange, thread: Some(thread), noted, news: false, hurried: false })
    }

    /// Notes the pointers as they are at the end of a cycle, of each channel from the first; `ended`: no program with a
    /// robot runs. Never waits. Returns the error since the last call, if any.
    #[inline]
    pub(super) fn note(&mut self, now: impl Iterator<Item = CurrentPointers>, ended: bool) -> Option<String> {
        for (noted, now) in self.noted.iter_mut().zip(now) {
            if *noted != now {
                *noted = now;
                self.news = true;
            }
        }
        self.hurried &= ended;
        if !self.news && self.hurried == ended {
            return None;
        }
        let mut pending = try_lock(&self.exchange.pending)?;
        pending.now = self.noted;
        self.news = false;
        if ended && !self.hurried {
            pending.hurry = true;
            self.hurried = true;
            self.exchange.changed.notify_all();
        }
        pending.problem.take()
    }

    /// Whether the thread has not got the noted pointers yet.
    pub(super) fn has_news(&self) -> bool {
        self.news
    }

    /// Waits until everything is stored. Returns the error since the last call, if any.
    pub(super) fn settle(&mut self) -> Option<String> {
        self.hurry(false);
        self.exchange.lock().problem.take()
    }

    /// Has the thread store what was noted, and waits until it has.
    fn hurry(&mut self, last: bool) {
        self.news = false;
        let mut pending = self.exchange.lock();
        (pending.now, pending.hurry, pending.last) = (self.noted, true, last);
        self.exchange.changed.notify_all();
        // A thread that has ended would never answer.
        while pending.hurry && self.thread.as_ref().is_some_and(|thread| !thread.is_finished()) {
            (pending, _) = self
                .exchange
                .changed
                .wait_timeout(pending, THREAD_CHECK_INTERVAL)
                .unwrap_or_else(PoisonError::into_inner);
        }
    }
}

impl Drop for PointerStore {
    fn drop(&mut self) {
        self.hurry(true);
        if let Some(thread) = self.thread.take() {
            // A panic of the storage does not end the thread.
            let _ = thread.join();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fault::File;
    use std::sync::mpsc::{Sender, channel};

    /// Panics at the first call of `store`; sends what is stored later.
    struct PanicsOnce(bool, Sender<String>);

    impl Storage for PanicsOnce {
        fn load(&self, _: &str) -> std::io::Result<Option<Vec<u8>>> {
            Ok(None)
        }

        fn store(&mut self, _: &str, content: &[u8]) -> std::io::Result<()> {
            if !std::mem::replace(&mut self.0, true) {
                std::panic::panic_any("meant to be");
            }
            self.1.send(String::from_utf8_lossy(content).into_owned()).map_err(std::io::Error::other)
        }
    }

    #[test]
    fn a_storage_that_panics_is_reported_and_tried_again() {
        let (sender, stored) = channel();
        let mut pointer_store =
            PointerStore::start(Box::new(PanicsOnce(false, sender)), PointerTable::default()).unwrap();
        let now = CurrentPointers { program: Some((File::new("a.arl"), 3)), motion: None };
        assert_eq!(pointer_store.note([now].into_iter(), false), None);
        let warning = pointer_store.settle().unwrap();
        assert!(warning.contains("the storage has panicked"), "{warning}");
        assert_eq!(pointer_store.settle(), None);
        let text = stored.try_recv().unwrap();
        assert!(text.contains("a.arl"), "{text}");
    }
}
