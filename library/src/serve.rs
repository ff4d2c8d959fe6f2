//! The program's side of the interface.

use std::cell::UnsafeCell;
use std::ffi::{CStr, OsString, c_char, c_void};
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, ThreadId};

use arl_rt::Program;
use arl_rt::emit::in_process::{Outside, Run, Stack};
use arl_rt::program::Other;

use crate::interface::{BROKEN, INTERFACE, Interface, RUNS, Take, WRONG_THREAD};
use crate::room::Room;

/// The parts from which a library was made.
#[doc(hidden)]
#[derive(Clone, Copy)]
pub struct Made<'a> {
    pub program: &'a (dyn Fn() -> Box<dyn Program> + Sync),
    pub others: &'a [Other],
    pub script_dir: &'a str,
}

/// A run as the host sees it: `ArlRun`. Calls from other threads with a pointer to it are refused.
pub struct Served {
    thread: ThreadId,
    stops: Arc<AtomicBool>,
    place: Place,
}

/// Where a run is.
enum Place {
    /// On the thread that began it, which alone uses it.
    Here(Box<UnsafeCell<Own>>),
    /// On a thread with a stack for deep calls.
    Room(Room<Own>),
}

struct Own {
    run: Run,
    is_broken: bool,
}

impl Own {
    /// Calls `act` with the run. A panic breaks the run.
    fn unless_it_panics<T>(&mut self, act: impl FnOnce(&mut Self) -> T) -> Result<T, ()> {
        let done = catch_unwind(AssertUnwindSafe(|| act(self)));
        if done.is_err() {
            self.is_broken = true;
        }
        done.map_err(drop)
    }
}

impl fmt::Debug for Served {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Served").field("thread", &self.thread).finish_non_exhaustive()
    }
}

impl Served {
    /// Calls `act` with the run on its own thread, even if the run is broken. A panic breaks the run.
    ///
    /// # Safety
    /// No other call is in progress on this thread: `arl.h` requires that functions that receive a text call nothing.
    unsafe fn with_any<T>(&self, act: impl FnOnce(&mut Own) -> T) -> Result<T, i32> {
        if thread::current().id() != self.thread {
            return Err(WRONG_THREAD);
        }
        match &self.place {
            Place::Here(own) => {
                // SAFETY: this is its thread, and no other call is in progress there.
                let own = unsafe { &mut *own.get() };
                own.unless_it_panics(act).map_err(|()| BROKEN)
            }
            Place::Room(room) => match room.call(|own| own.as_mut().map(|own| own.unless_it_panics(act))) {
                Some(Ok(Some(done))) => done.map_err(|()| BROKEN),
                Some(_) => Err(BROKEN),
                // After a fork.
                None => Err(WRONG_THREAD),
            },
        }
    }

    /// Calls `act` with the run if it is not broken.
    ///
    /// # Safety
    /// As for `with_any`.
    unsafe fn with<T>(&self, act: impl FnOnce(&mut Run) -> T) -> Result<T, i32> {
        // SAFETY: as for this function.
        let done = unsafe { self.with_any(|own| if own.is_broken { Err(BROKEN) } else { Ok(act(&mut own.run)) }) };
        done.flatten()
    }
}

/// The interface of a library whose runs begin with `begin`.
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
        summary,
        report,
        watch,
        observe,
        global,
        set_global,
        files,
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
    match serve(made, words.collect(), traced != 0) {
        Ok(served) => Box::into_raw(served),
        Err(problem) => {
            // SAFETY: `why` takes `context`, by this function's contract.
            unsafe { give(why, context, problem.as_bytes()) };
            std::ptr::null_mut()
        }
    }
}

/// Begins a run for this thread.
///
/// # Errors
/// The reason why it cannot be begun.
pub(crate) fn serve(made: Made<'_>, words: Vec<OsString>, traced: bool) -> Result<Box<Served>, String> {
    let panicked = |_| "the program panicked: standard error says why".to_owned();
    let begin = |program, stack| {
        let run = Run::begin(program, made.others, made.script_dir, words, traced, stack)?;
        Ok((run.stops(), Own { run, is_broken: false }))
    };
    let asked = catch_unwind(AssertUnwindSafe(|| {
        let program = (made.program)();
        let recurs = program.recurs() || made.others.iter().any(|other| (other.make)().recurs());
        (program, recurs)
    }));
    let (program, recurs) = asked.map_err(panicked)?;
    let (stops, place) = if recurs {
        let room = Room::new(Stack::WHOLE_BYTES);
        let room = room.map_err(|error| format!("the program's thread cannot be started: {error}"))?;
        let begun = room.call(|own| {
            let (stops, begun) = begin((made.program)(), Stack::Whole)?;
            *own = Some(begun);
            Ok(stops)
        });
        let begun = begun.ok_or("the program's thread has ended")?;
        (begun.map_err(panicked).flatten()?, Place::Room(room))
    } else {
        let begun = catch_unwind(AssertUnwindSafe(|| begin(program, Stack::OfHost)));
        let (stops, own) = begun.map_err(panicked).flatten()?;
        (stops, Place::Here(Box::new(UnsafeCell::new(own))))
    };
    Ok(Box::new(Served { thread: thread::current().id(), stops, place }))
}

/// Passes bytes to the host.
///
/// # Safety
/// `take` may be called with `context`.
unsafe fn give(take: Take, context: *mut c_void, bytes: &[u8]) {
    // SAFETY: by this function's contract; the bytes are valid as long as the call lasts.
    unsafe { take(context, bytes.as_ptr().cast(), bytes.len()) }
}

unsafe extern "C" fn go_on(run: *mut Served, cycles: u64, alone: i32) -> i32 {
    let outside = if alone != 0 { Outside::Nobody } else { Outside::Somebody };
    // SAFETY: the host passes a pointer that `begin` returned and `end` has not taken, as `arl.h` requires; no other
    // call is in progress.
    let gone_on = unsafe { (*run).with(|run| run.go_on(cycles, outside)) };
    gone_on.map_or_else(|problem| problem, |code| code.map_or(RUNS, i32::from))
}

unsafe extern "C" fn stop(run: *const Served) {
    // SAFETY: as in `go_on`, except for other calls: this reads nothing that they change.
    unsafe { &*run }.stops.store(true, Ordering::Relaxed);
}

unsafe extern "C" fn order(run: *mut Served, text: *const c_char, why: Take, context: *mut c_void) -> i32 {
    // SAFETY: the host passes what `arl.h` requires.
    unsafe { tried(run, (why, context), |run| run.order(&words(text))) }
}

unsafe extern "C" fn watch(run: *mut Served, names: *const c_char, why: Take, context: *mut c_void) -> i32 {
    // SAFETY: the host passes what `arl.h` requires.
    unsafe { tried(run, (why, context), |run| run.watch(&words(names))) }
}

unsafe extern "C" fn set_global(
    run: *mut Served,
    name: *const c_char,
    literal: *const c_char,
    why: Take,
    context: *mut c_void,
) -> i32 {
    // SAFETY: the host passes what `arl.h` requires.
    unsafe { tried(run, (why, context), |run| run.set_global(&words(name), &words(literal))) }
}

unsafe extern "C" fn global(run: *mut Served, name: *const c_char, take: Take, context: *mut c_void) -> i32 {
    // SAFETY: the host passes what `arl.h` requires.
    unsafe {
        let mut value = String::new();
        let done = tried(run, (take, context), |run| run.global(&words(name)).map(|found| value = found));
        if done == 0 {
            give(take, context, value.as_bytes());
        }
        done
    }
}

/// Calls a function that can refuse; if it does, `why` receives the reason, and 1 is returned.
///
/// # Safety
/// As for `Served::with`, and `why` may be called with `context`.
unsafe fn tried(
    run: *mut Served,
    (why, context): (Take, *mut c_void),
    act: impl FnOnce(&mut Run) -> Result<(), String>,
) -> i32 {
    // SAFETY: by this function's contract.
    match unsafe { (*run).with(act) } {
        Ok(Ok(())) => 0,
        Ok(Err(problem)) => {
            // SAFETY: by this function's contract.
            unsafe { give(why, context, problem.as_bytes()) };
            1
        }
        Err(problem) => problem,
    }
}

/// A string of the host.
///
/// # Safety
/// The string is terminated by 0.
unsafe fn words(text: *const c_char) -> String {
    // SAFETY: by this function's contract.
    unsafe { CStr::from_ptr(text) }.to_string_lossy().into_owned()
}

unsafe extern "C" fn said(run: *mut Served, take: Take, context: *mut c_void) {
    // SAFETY: as in `go_on`. After a panic, too, so that its cause is reported.
    if let Ok(text) = unsafe { (*run).with_any(|own| own.run.take_said()) } {
        // SAFETY: the host passes a function that takes its context.
        unsafe { give(take, context, text.as_bytes()) };
    }
}

unsafe extern "C" fn state(run: *mut Served, take: Take, context: *mut c_void) {
    // SAFETY: as in `go_on`.
    if let Ok(text) = unsafe { (*run).with(|run| run.state()) } {
        // SAFETY: the host passes a function that takes its context.
        unsafe { give(take, context, text.as_bytes()) };
    }
}

unsafe extern "C" fn summary(run: *mut Served, take: Take, context: *mut c_void) {
    // SAFETY: as in `go_on`.
    if let Ok(text) = unsafe { (*run).with(|run| run.summary()) } {
        // SAFETY: the host passes a function that takes its context.
        unsafe { give(take, context, text.as_bytes()) };
    }
}

unsafe extern "C" fn report(run: *mut Served, take: Take, context: *mut c_void) {
    // SAFETY: as in `go_on`.
    if let Ok(text) = unsafe { (*run).with(|run| run.report()) } {
        // SAFETY: the host passes a function that takes its context.
        unsafe { give(take, context, text.as_bytes()) };
    }
}

unsafe extern "C" fn observe(run: *mut Served, numbers: *mut f64, count: usize) -> usize {
    let room: &mut [f64] = match count {
        0 => &mut [],
        // SAFETY: the host provides room for `count` numbers.
        count => unsafe { std::slice::from_raw_parts_mut(numbers, count) },
    };
    // SAFETY: as in `go_on`.
    let observed = unsafe {
        (*run).with(|run| {
            run.observe(room);
            run.observed()
        })
    };
    observed.unwrap_or(0)
}

unsafe extern "C" fn rows(run: *mut Served, take: Take, context: *mut c_void) {
    // SAFETY: as in `go_on`. After a panic, too, so that its cause is reported.
    if let Ok(rows) = unsafe { (*run).with_any(|own| own.run.take_rows()) } {
        // SAFETY: doubles are bytes without gaps, and they are valid as long as the call lasts.
        unsafe { take(context, rows.as_ptr().cast(), size_of_val(&*rows)) };
    }
}

unsafe extern "C" fn files(run: *mut Served, take: Take, context: *mut c_void) {
    // SAFETY: as in `go_on`. After a panic, too, so that its cause is reported.
    if let Ok(text) = unsafe { (*run).with_any(|own| own.run.files().join("\n")) } {
        // SAFETY: the host passes a function that takes its context.
        unsafe { give(take, context, text.as_bytes()) };
    }
}

unsafe extern "C" fn time(run: *const Served) -> f64 {
    // SAFETY: as in `go_on`.
    unsafe { (*run).with_any(|own| own.run.time()) }.unwrap_or(f64::NAN)
}

unsafe extern "C" fn end(run: *mut Served) {
    // SAFETY: as in `go_on`.
    if thread::current().id() != unsafe { &*run }.thread {
        return;
    }
    // SAFETY: it came from a box in `begin`, and the host gives up ownership.
    let served = unsafe { Box::from_raw(run) };
    let _ = catch_unwind(AssertUnwindSafe(|| drop(served)));
}

unsafe extern "C" fn header(take: Take, context: *mut c_void) {
    // SAFETY: the host passes a function that takes its context.
    unsafe { give(take, context, Run::HEADER.as_bytes()) };
}
