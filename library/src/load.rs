//! The host's side of the interface.

use std::ffi::{CString, OsString, c_char, c_void};
use std::fmt;
use std::path::Path;
use std::ptr::NonNull;
use std::sync::Arc;

use arl_rt::Program;
use arl_rt::program::Other;

use crate::Served;
use crate::interface::{BROKEN, INTERFACE, Interface, RUNS, Take, WRONG_THREAD};
use crate::serve::{self, Made};

/// A program in this process: a library that was loaded, which stays loaded until the process ends, or one that this
/// process can make itself.
#[derive(Clone, Debug)]
pub struct Library {
    interface: &'static Interface,
    /// The program, if it is not that of a loaded library.
    own: Option<Arc<OwnProgram>>,
}

/// A program that this process makes.
struct OwnProgram {
    make: Box<dyn Fn() -> Box<dyn Program> + Send + Sync>,
    others: Vec<Other>,
    script_dir: String,
}

impl fmt::Debug for OwnProgram {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("OwnProgram").field("script_dir", &self.script_dir).finish_non_exhaustive()
    }
}

/// The interface to runs of programs that this process makes. They begin without it.
static OWN: Interface = serve::interface(begins_nothing);

unsafe extern "C" fn begins_nothing(_: *const *const c_char, _: usize, _: i32, _: Take, _: *mut c_void) -> *mut Served {
    std::ptr::null_mut()
}

/// The reason why a library cannot be loaded, or a run cannot be begun or continued.
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum LoadError {
    /// The file cannot be opened, with the reason.
    Open(String),
    /// The file is not a library of a program.
    NotOurs,
    /// The library was made by another version of arl2rs; this is the version of its interface.
    Version(u32),
    /// A run cannot be begun with these arguments, or an order cannot be carried out; with the reason.
    Refused(String),
    /// The run has panicked.
    Broken,
    /// This is not the thread that began the run.
    WrongThread,
}

impl fmt::Display for LoadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            LoadError::Open(why) => write!(f, "{why}"),
            LoadError::NotOurs => {
                write!(f, "this is not a library of an ARL program: `arl2rs build --library` makes such libraries")
            }
            LoadError::Version(version) => write!(
                f,
                "the library has version {version} of the interface, but this is version {INTERFACE}: build it again with this \
                 version of arl2rs"
            ),
            LoadError::Refused(why) => write!(f, "{why}"),
            LoadError::WrongThread => write!(f, "a run stays on the thread that began it"),
            LoadError::Broken => write!(f, "the run has panicked: standard error says why"),
        }
    }
}

impl std::error::Error for LoadError {}

impl Library {
    /// Loads a library that `arl2rs build --library` made.
    ///
    /// # Errors
    /// The file is not such a library, or one of another version.
    ///
    /// # Safety
    /// Loading a library runs its code: the file must be what it claims to be.
    pub unsafe fn open(path: &Path) -> Result<Self, LoadError> {
        // SAFETY: by this function's contract.
        let library = unsafe { libloading::Library::new(path) }.map_err(|error| LoadError::Open(error.to_string()))?;
        // SAFETY: a library with this symbol has it with this type, in all versions.
        let symbol = unsafe { library.get::<unsafe extern "C" fn() -> *const Interface>(b"arl_interface\0") };
        let ask = symbol.map_err(|_| LoadError::NotOurs)?;
        // SAFETY: it may always be called, and returns what `of` takes: the library is not unloaded.
        let opened = unsafe { Self::of(ask()) };
        // Its threads may still run, and threads of this process have its variables.
        std::mem::forget(library);
        opened
    }

    /// The library whose `arl_interface` returned this pointer, which is already loaded.
    ///
    /// # Errors
    /// The library has another version.
    ///
    /// # Safety
    /// The pointer was returned by such a function, and is valid as long as this process lives.
    pub unsafe fn of(interface: *const Interface) -> Result<Self, LoadError> {
        // SAFETY: the version comes first, in all versions.
        let version = unsafe { *interface.cast::<u32>() };
        if version != INTERFACE {
            return Err(LoadError::Version(version));
        }
        // SAFETY: this version has this shape, and lives as long as the process.
        Ok(Self { interface: unsafe { &*interface }, own: None })
    }

    /// The program that `make` makes for each run, with those that its cells may name, and the folder of its files.
    pub fn in_process(
        make: impl Fn() -> Box<dyn Program> + Send + Sync + 'static,
        others: Vec<Other>,
        script_dir: String,
    ) -> Self {
        let own = OwnProgram { make: Box::new(make), others, script_dir };
        Self { interface: &OWN, own: Some(Arc::new(own)) }
    }

    /// A run at the start of its first cycle, with arguments as on a command line. With `traced` it records the trace
    /// of the first robot.
    ///
    /// # Errors
    /// The error in the arguments, or the reason why the controller cannot be built.
    pub fn begin(&self, arguments: &[&str], traced: bool) -> Result<Session, LoadError> {
        if let Some(own) = &self.own {
            let made = Made { program: &*own.make, others: &own.others, script_dir: &own.script_dir };
            let words = arguments.iter().map(OsString::from).collect();
            let served = serve::serve(made, words, traced).map_err(LoadError::Refused)?;
            return Ok(Session { run: NonNull::from(Box::leak(served)), interface: self.interface });
        }
        let words: Result<Vec<CString>, _> = arguments.iter().map(|word| CString::new(*word)).collect();
        let words = words.map_err(|_| LoadError::Refused("an argument contains a NUL character".into()))?;
        let pointers: Vec<*const c_char> = words.iter().map(|word| word.as_ptr()).collect();
        let mut why = Vec::new();
        // SAFETY: the words outlive the call, and `take_bytes` takes a vector of bytes.
        let run = unsafe {
            (self.interface.begin)(pointers.as_ptr(), pointers.len(), i32::from(traced), take_bytes, context(&mut why))
        };
        match NonNull::new(run) {
            Some(run) => Ok(Session { run, interface: self.interface }),
            None => Err(LoadError::Refused(text(why))),
        }
    }

    /// The names of the columns of a trace.
    pub fn columns(&self) -> Vec<String> {
        let mut names = Vec::new();
        // SAFETY: `take_bytes` takes a vector of bytes.
        unsafe { (self.interface.header)(take_bytes, context(&mut names)) };
        text(names).split(',').map(str::to_owned).collect()
    }
}

/// A run of a program. It only continues on the thread that began it: on others everything is refused except
/// [`stop`](Self::stop), texts are empty, and a run that is dropped there stays in memory.
#[derive(Debug)]
pub struct Session {
    run: NonNull<Served>,
    interface: &'static Interface,
}

// SAFETY: the other side of the interface checks which thread calls, and does nothing on another one than that of the
// run.
unsafe impl Send for Session {}
// SAFETY: as for `Send`; functions that take `&self` may be called while another call is in progress.
unsafe impl Sync for Session {}

impl Session {
    /// Continues for `cycles` cycles, or until the run is over; then returns its exit code. `alone`: nothing outside
    /// changes anything, so that the run ends if all programs wait in vain.
    ///
    /// # Errors
    /// The run has panicked.
    pub fn go_on(&mut self, cycles: u64, alone: bool) -> Result<Option<u8>, LoadError> {
        // SAFETY: this session owns the run until it is dropped, on its own thread.
        match unsafe { (self.interface.go_on)(self.run.as_ptr(), cycles, i32::from(alone)) } {
            RUNS => Ok(None),
            WRONG_THREAD => Err(LoadError::WrongThread),
            code => u8::try_from(code).map(Some).map_err(|_| LoadError::Broken),
        }
    }

    /// Ends the programs: robots stop on their paths within the cycles that follow.
    pub fn stop(&self) {
        // SAFETY: as in `go_on`.
        unsafe { (self.interface.stop)(self.run.as_ptr()) }
    }

    /// Carries out an order, as an event of a scenario does: `di.5 = true`.
    ///
    /// # Errors
    /// The text is not an order, or the run has panicked.
    pub fn order(&mut self, order: &str) -> Result<(), LoadError> {
        let order = string(order)?;
        // SAFETY: as in `go_on`; `take_bytes` takes a vector of bytes.
        self.tried(|run, why| unsafe { (self.interface.order)(run, order.as_ptr(), take_bytes, why) }).map(drop)
    }

    /// Selects the signals and global variables that [`observe`](Self::observe) returns after the row of the trace:
    /// `["do.1", "global.placed"]`.
    ///
    /// # Errors
    /// A name does not exist or is not a number; then nothing changes.
    pub fn watch(&mut self, names: &[&str]) -> Result<(), LoadError> {
        let names = string(&names.join("\n"))?;
        // SAFETY: as in `go_on`; `take_bytes` takes a vector of bytes.
        self.tried(|run, why| unsafe { (self.interface.watch)(run, names.as_ptr(), take_bytes, why) }).map(drop)
    }

    /// Fills in the last cycle's row of the trace, then the watched values, as far as there is room; returns how many
    /// numbers there are.
    pub fn observe(&mut self, numbers: &mut [f64]) -> usize {
        // SAFETY: as in `go_on`; there is room for this many.
        unsafe { (self.interface.observe)(self.run.as_ptr(), numbers.as_mut_ptr(), numbers.len()) }
    }

    /// The value of a global variable, as a literal of ARL.
    ///
    /// # Errors
    /// The variable does not exist, or the run has panicked.
    pub fn global(&mut self, name: &str) -> Result<String, LoadError> {
        let name = string(name)?;
        // SAFETY: as in `go_on`; `take_bytes` takes a vector of bytes.
        self.tried(|run, value| unsafe { (self.interface.global)(run, name.as_ptr(), take_bytes, value) })
    }

    /// Gives a global variable a value, between two cycles; components that the literal leaves out keep theirs.
    ///
    /// # Errors
    /// The variable does not exist, the value does not fit, or the run has panicked.
    pub fn set_global(&mut self, name: &str, literal: &str) -> Result<(), LoadError> {
        let (name, literal) = (string(name)?, string(literal)?);
        let set = self.interface.set_global;
        // SAFETY: as in `go_on`; `take_bytes` takes a vector of bytes.
        self.tried(|run, why| unsafe { set(run, name.as_ptr(), literal.as_ptr(), take_bytes, why) }).map(drop)
    }

    /// Calls a function that can refuse; returns the text that it gave.
    fn tried(&self, act: impl FnOnce(*mut Served, *mut c_void) -> i32) -> Result<String, LoadError> {
        let mut answer = Vec::new();
        match act(self.run.as_ptr(), context(&mut answer)) {
            0 => Ok(text(answer)),
            BROKEN => Err(LoadError::Broken),
            WRONG_THREAD => Err(LoadError::WrongThread),
            _ => Err(LoadError::Refused(text(answer))),
        }
    }

    /// The result of the run, or its state so far: a JSON object with the outcome, the exit code, the cycle time in s
    /// and the alarms; with `--report` also a summary of the motions of the first robot.
    pub fn summary(&mut self) -> String {
        text(self.taken(self.interface.summary))
    }

    /// The reports of the motions, one JSON object per line, if `--report` was given.
    pub fn report(&mut self) -> String {
        text(self.taken(self.interface.report))
    }

    /// The output since the last call: one JSON object per line.
    pub fn take_said(&mut self) -> String {
        text(self.taken(self.interface.said))
    }

    /// The current state, a JSON object.
    pub fn state(&mut self) -> String {
        text(self.taken(self.interface.state))
    }

    /// The rows of the trace since the last call, one after the other. With `--trace-columns file` among its arguments
    /// each has one more number at its end: the index in [`files`](Self::files) of the file of its line, from 0; not a
    /// number if no motion is executed.
    pub fn take_rows(&mut self) -> Vec<f64> {
        let bytes = self.taken(self.interface.rows);
        bytes.chunks_exact(8).map(|double| f64::from_ne_bytes(double.try_into().unwrap_or_default())).collect()
    }

    /// The names of the files that rows of the trace have referred to so far.
    pub fn files(&mut self) -> Vec<String> {
        text(self.taken(self.interface.files)).lines().map(str::to_owned).collect()
    }

    /// Controller time in s.
    pub fn time(&self) -> f64 {
        // SAFETY: as in `go_on`.
        unsafe { (self.interface.time)(self.run.as_ptr()) }
    }

    fn taken(&mut self, ask: unsafe extern "C" fn(*mut Served, crate::Take, *mut c_void)) -> Vec<u8> {
        let mut bytes = Vec::new();
        // SAFETY: as in `go_on`; `take_bytes` takes a vector of bytes.
        unsafe { ask(self.run.as_ptr(), take_bytes, context(&mut bytes)) };
        bytes
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        // SAFETY: as in `go_on`; there are no other users any more.
        unsafe { (self.interface.end)(self.run.as_ptr()) }
    }
}

fn string(text: &str) -> Result<CString, LoadError> {
    CString::new(text).map_err(|_| LoadError::Refused("a text contains a NUL character".into()))
}

fn context(bytes: &mut Vec<u8>) -> *mut c_void {
    std::ptr::from_mut(bytes).cast()
}

fn text(bytes: Vec<u8>) -> String {
    String::from_utf8_lossy(&bytes).into_owned()
}

/// Adds the bytes to the vector that is its context.
unsafe extern "C" fn take_bytes(context: *mut c_void, bytes: *const c_char, length: usize) {
    // SAFETY: the context is that of `context`, and the vector is not used elsewhere during the call.
    let all = unsafe { &mut *context.cast::<Vec<u8>>() };
    if length > 0 {
        // SAFETY: there are `length` bytes, as long as the call lasts.
        all.extend_from_slice(unsafe { std::slice::from_raw_parts(bytes.cast(), length) });
    }
}
