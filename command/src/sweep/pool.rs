//! Makes runs on several processes of this computer, with their results in the order of the table.

use super::bundle::Bundle;
use super::folder::Spread;
use super::kept::Kept;
use super::result::{Row, RunResult};
use super::worker::Worker;
use crate::parameters::Parameters;
use std::collections::BTreeMap;
use std::io;
use std::ops::ControlFlow;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::channel;

/// The work of a pool.
pub(super) struct Work<'a> {
    pub(super) bundle: &'a Bundle,
    /// The numbers of runs, from 1, and their parameters.
    pub(super) rows: &'a [(usize, &'a Parameters)],
    pub(super) processes: usize,
    pub(super) timeout: Option<f64>,
    pub(super) kept: Kept,
    /// Whether the rest is no longer wanted.
    pub(super) is_enough: &'a (dyn Fn() -> bool + Sync),
}

/// A result as it arrives: which row, its words, and whether it is new and worth keeping.
struct Came {
    at: usize,
    words: Vec<String>,
    result: RunResult,
    keeps: bool,
}

/// Makes all runs and passes on their rows in order, until no more are wanted. Results that cannot be kept are reported
/// once.
///
/// # Errors
/// The program cannot be written to the disk.
pub(super) fn run(
    work: Work<'_>,
    mut warn: impl FnMut(&str),
    mut take: impl FnMut(Row) -> ControlFlow<()>,
) -> io::Result<()> {
    let Work { bundle, rows, processes, timeout, kept, is_enough } = work;
    let spread = Spread::new(bundle)?;
    let (next, enough) = (AtomicUsize::new(0), AtomicBool::new(false));
    let is_enough = || enough.load(Ordering::Relaxed) || is_enough();
    let kept = Mutex::new(kept);
    std::thread::scope(|scope| {
        let (tell, results) = channel();
        for _ in 0..processes.clamp(1, rows.len().max(1)) {
            let (tell, next, is_enough, kept, spread) = (tell.clone(), &next, &is_enough, &kept, &spread);
            scope.spawn(move || {
                let mut worker = None;
                while !is_enough() {
                    let at = next.fetch_add(1, Ordering::Relaxed);
                    let Some((_, parameters)) = rows.get(at) else { break };
                    let begin = || Worker::new(spread, timeout, bundle.clearance);
                    let came = one(at, bundle.words(parameters), kept, (&mut worker, &begin), is_enough);
                    if came.is_none_or(|came| tell.send(came).is_err()) {
                        break;
                    }
                }
            });
        }
        drop(tell);
        let (mut waiting, mut expected) = (BTreeMap::new(), 0);
        'all: for Came { at, words, result, keeps } in results {
            if keeps && let Err(error) = lock(&kept).keep(&words, &result) {
                warn(&format!("results cannot be kept for the next sweep: {error}"));
            }
            waiting.insert(at, result);
            while let Some(result) = waiting.remove(&expected) {
                let Some((run, parameters)) = rows.get(expected) else { break };
                let row = Row { run: *run, parameters: (*parameters).clone(), result: bundle.in_own_names(result) };
                expected += 1;
                if take(row).is_break() {
                    break 'all;
                }
            }
        }
        enough.store(true, Ordering::Relaxed);
    });
    Ok(())
}

fn one(
    at: usize,
    words: Result<Vec<String>, String>,
    kept: &Mutex<Kept>,
    (worker, begin): (&mut Option<Worker>, &dyn Fn() -> Result<Worker, String>),
    is_enough: &dyn Fn() -> bool,
) -> Option<Came> {
    let words = match words {
        Ok(words) => words,
        Err(problem) => {
            return Some(Came { at, words: Vec::new(), result: RunResult::lost("refused", problem), keeps: false });
        }
    };
    if let Some(result) = lock(kept).find(&words).cloned() {
        return Some(Came { at, words, result, keeps: false });
    }
    let begun = worker.take().map_or_else(begin, Ok);
    let (result, keeps) = match begun {
        Ok(begun) => worker.insert(begun).run(&words, is_enough)?,
        Err(problem) => (RunResult::lost("crashed", problem), false),
    };
    Some(Came { at, words, result, keeps })
}

/// A panic elsewhere leaves the known results valid.
fn lock(kept: &Mutex<Kept>) -> std::sync::MutexGuard<'_, Kept> {
    kept.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}
