//! The program's side of the interface.

use std::ffi::{CStr, OsString, c_char, c_void};
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::thread::{self, ThreadId};

use arl_rt::Program;
use arl_rt::emit::in_process::{Outside, Run};
use arl_rt::program::Other;

use crate::interface::{BROKEN, INTERFACE, Interface, RUNS, Take, WRONG_THREAD};

/// What a library was made of.
#[doc(hidden)]
#[derive(Clone, Copy, Debug)]
pub struct Made<'a> {
    pub program: fn() -> Box<dyn Program>,
    pub others: &'a [Other],
    pub script_dir: &'a str,
}

/// A run, as a host has it: `ArlRun`.
pub struct Served {
    run: Run,
    thread: ThreadId,
    is_broken: bool,
}

impl fmt::Debug for Served {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.run.fmt(f)
    }
}

impl Served {
    /// Does something with the run on its own thread; a panic breaks it.
    fn with<T>(&mut self, act: impl FnOnce(&mut Run) -> T) -> Result<T, i32> {
        if thread::current().id() != self.thread {
            return Err(WRONG_THREAD);
        }
        if self.is_broken {
            return Err(BROKEN);
        }
        let done = catch_unwind(AssertUnwindSafe(|| act(&mut self.run)));
        self.is_broken = done.is_err();
        done.map_err(|_| BROKEN)
    }
}

/// The interface of a library whose runs begin like that.
#[doc(hidden)]
pub const fn interface(
    begin: unsafe extern "C" fn(*const *const c_char, usize, i32, Take, *mut c_void) -> *mut Served,
) -> Interface {
    Interface {
        version: INTERFACE,
        columns: Run::COLUMNS as u32,
        begin,
        go_on,
        stop,
        order,
        said,
        state,
        rows,
        time,
        end,
        header,
    }
}

/// Begins a run.
///
/// # Safety
/// `arguments` points to `count` strings, each ended by 0; `why` may be called with `context`.
#[doc(hidden)]
pub unsafe fn begin(
    made: Made<'_>,
    (arguments, count): (*const *const c_char, usize),
    traced: i32,
    (why, context): (Take, *mut c_void),
) -> *mut Served {
    let words = (0..count).map(|at| {
        // SAFETY: there are `count` pointers to strings, by this function's contract.
        let word = unsafe { CStr::from_ptr(*arguments.add(at)) };
        OsString::from(word.to_string_lossy().into_owned())
    });
    let words: Vec<OsString> = words.collect();
    let begun = catch_unwind(AssertUnwindSafe(|| {
        Run::begin((made.program)(), made.others, made.script_dir, words, traced != 0)
    }));
    let problem = match begun {
        Ok(Ok(run)) => {
            let served = Served { run, thread: thread::current().id(), is_broken: false };
            return Box::into_raw(Box::new(served));
        }
        Ok(Err(problem)) => problem,
        Err(_) => "the program panicked: the standard error says why".into(),
    };
    // SAFETY: `why` takes `context`, by this function's contract.
    unsafe { give(why, context, problem.as_bytes()) };
    std::ptr::null_mut()
}

/// Hands bytes to the host.
///
/// # Safety
/// `take` may be called with `context`.
unsafe fn give(take: Take, context: *mut c_void, bytes: &[u8]) {
    // SAFETY: by this function's contract; the bytes are there as long as the call lasts.
    unsafe { take(context, bytes.as_ptr().cast(), bytes.len()) }
}

unsafe extern "C" fn go_on(run: *mut Served, cycles: u64, alone: i32) -> i32 {
    let outside = if alone != 0 { Outside::Nobody } else { Outside::Somebody };
    // SAFETY: the host gives what `begin` gave and `end` has not taken, and nobody else has it now.
    let served = unsafe { &mut *run };
    served.with(|run| run.go_on(cycles, outside)).map_or_else(|problem| problem, |code| code.map_or(RUNS, i32::from))
}

unsafe extern "C" fn stop(run: *mut Served) {
    // SAFETY: as in `go_on`.
    let _ = unsafe { &mut *run }.with(Run::stop);
}

unsafe extern "C" fn order(run: *mut Served, text: *const c_char, why: Take, context: *mut c_void) -> i32 {
    // SAFETY: the host gives a string that is ended by 0.
    let text = unsafe { CStr::from_ptr(text) }.to_string_lossy();
    // SAFETY: as in `go_on`.
    match unsafe { &mut *run }.with(|run| run.order(&text)) {
        Ok(Ok(())) => 0,
        Ok(Err(problem)) => {
            // SAFETY: the host gives a function that takes its context.
            unsafe { give(why, context, problem.as_bytes()) };
            1
        }
        Err(problem) => problem,
    }
}

unsafe extern "C" fn said(run: *mut Served, take: Take, context: *mut c_void) {
    // SAFETY: as in `go_on`.
    if let Ok(text) = unsafe { &mut *run }.with(Run::take_said) {
        // SAFETY: the host gives a function that takes its context.
        unsafe { give(take, context, text.as_bytes()) };
    }
}

unsafe extern "C" fn state(run: *mut Served, take: Take, context: *mut c_void) {
    // SAFETY: as in `go_on`.
    if let Ok(text) = unsafe { &mut *run }.with(|run| run.state()) {
        // SAFETY: the host gives a function that takes its context.
        unsafe { give(take, context, text.as_bytes()) };
    }
}

unsafe extern "C" fn rows(run: *mut Served, take: Take, context: *mut c_void) {
    // SAFETY: as in `go_on`.
    if let Ok(rows) = unsafe { &mut *run }.with(Run::take_rows) {
        // SAFETY: doubles are bytes without gaps, and they are there as long as the call lasts.
        unsafe { take(context, rows.as_ptr().cast(), size_of_val(&*rows)) };
    }
}

unsafe extern "C" fn time(run: *const Served) -> f64 {
    // SAFETY: as in `go_on`, but for changing it.
    let served = unsafe { &*run };
    if thread::current().id() == served.thread { served.run.time() } else { f64::NAN }
}

unsafe extern "C" fn end(run: *mut Served) {
    // SAFETY: as in `go_on`.
    if thread::current().id() != unsafe { &*run }.thread {
        return;
    }
    // SAFETY: it came from a box in `begin`, and the host gives it away.
    let served = unsafe { Box::from_raw(run) };
    let _ = catch_unwind(AssertUnwindSafe(|| drop(served)));
}

unsafe extern "C" fn header(take: Take, context: *mut c_void) {
    // SAFETY: the host gives a function that takes its context.
    unsafe { give(take, context, Run::HEADER.as_bytes()) };
}
