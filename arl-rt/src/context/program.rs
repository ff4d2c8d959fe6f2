//! The program that the controller runs, as the emitted code describes it.

use std::any::Any;
use std::fmt;
use std::path::{Path, PathBuf};
use std::pin::Pin;

use crate::context::cx::Cx;
use crate::context::shown::ShownHandle;
use crate::fault::{Done, File};
use crate::storage::data::DataFile;
use arl_robot::robot::Family;

/// A piece of program that the controller polls once a cycle.
pub type BoxFuture<'a, T = ()> = Pin<Box<dyn Future<Output = Done<T>> + 'a>>;

/// A piece of program that owns what it borrows from.
pub(crate) type RunningProgram = BoxFuture<'static>;

/// A value whose type can be determined at run time.
pub trait AsAny: Any {
    /// The same value, as an `Any`.
    fn as_any(&self) -> &dyn Any;
}

impl<T: Any> AsAny for T {
    fn as_any(&self) -> &dyn Any {
        self
    }
}

/// A program: its global variables and its `main`.
pub trait Program: AsAny {
    /// The file that has `main`.
    fn file(&self) -> File;

    /// The family of robot that the program was checked for.
    fn family(&self) -> Family;

    /// Sets every global variable to its start value, then runs the initialisers in file order. By default there are no
    /// variables, and this does nothing.
    fn init<'a>(&'a self, cx: &'a Cx) -> BoxFuture<'a> {
        let _ = cx;
        Box::pin(async { Ok(()) })
    }

    /// Runs `main` once.
    fn main<'a>(&'a self, cx: &'a Cx) -> BoxFuture<'a>;

    /// The global variables, which the conditions and actions of interrupts use: the program itself, unless it wraps
    /// another one.
    fn globals(&self) -> &dyn Any {
        self.as_any()
    }

    /// The variables of `_data.arl` files, which are read again before `main` starts.
    fn data(&self) -> Vec<DataFile<'_>> {
        Vec::new()
    }

    /// All global variables, file by file: emitted where they can be set from outside.
    fn variables(&self) -> Vec<DataFile<'_>> {
        Vec::new()
    }

    /// All global clocks and connections, for a debugger. Emitted code does not have them.
    fn handles(&self) -> Vec<ShownHandle<'_>> {
        Vec::new()
    }

    /// The folder of these files, relative to the script directory; by default that directory itself.
    fn folder(&self) -> &Path {
        Path::new("")
    }

    /// The services beside the cycle that the program uses: they are started before the program.
    fn beside(&self) -> Beside {
        Beside::default()
    }

    /// Whether functions of the program call themselves, or each other in a circle, and need the stack of the thread
    /// for that. By default they do not.
    fn recurs(&self) -> bool {
        false
    }
}

/// Lets a boxed program be used where a program is expected.
impl<P: Program + ?Sized> Program for Box<P> {
    fn file(&self) -> File {
        (**self).file()
    }

    fn family(&self) -> Family {
        (**self).family()
    }

    fn init<'a>(&'a self, cx: &'a Cx) -> BoxFuture<'a> {
        (**self).init(cx)
    }

    fn main<'a>(&'a self, cx: &'a Cx) -> BoxFuture<'a> {
        (**self).main(cx)
    }

    fn globals(&self) -> &dyn Any {
        (**self).globals()
    }

    fn data(&self) -> Vec<DataFile<'_>> {
        (**self).data()
    }

    fn variables(&self) -> Vec<DataFile<'_>> {
        (**self).variables()
    }

    fn handles(&self) -> Vec<ShownHandle<'_>> {
        (**self).handles()
    }

    fn folder(&self) -> &Path {
        (**self).folder()
    }

    fn beside(&self) -> Beside {
        (**self).beside()
    }

    fn recurs(&self) -> bool {
        (**self).recurs()
    }
}

/// A program whose data files are in another folder than the script directory: one of several that one controller runs.
pub struct Elsewhere<P> {
    /// The program.
    pub program: P,
    /// The folder, relative to the script directory.
    pub folder: PathBuf,
}

impl<P: Program + 'static> Program for Elsewhere<P> {
    fn file(&self) -> File {
        self.program.file()
    }

    fn family(&self) -> Family {
        self.program.family()
    }

    fn init<'a>(&'a self, cx: &'a Cx) -> BoxFuture<'a> {
        self.program.init(cx)
    }

    fn main<'a>(&'a self, cx: &'a Cx) -> BoxFuture<'a> {
        self.program.main(cx)
    }

    fn globals(&self) -> &dyn Any {
        self.program.globals()
    }

    fn data(&self) -> Vec<DataFile<'_>> {
        self.program.data()
    }

    fn variables(&self) -> Vec<DataFile<'_>> {
        self.program.variables()
    }

    fn handles(&self) -> Vec<ShownHandle<'_>> {
        self.program.handles()
    }

    fn folder(&self) -> &Path {
        &self.folder
    }

    fn beside(&self) -> Beside {
        self.program.beside()
    }

    fn recurs(&self) -> bool {
        self.program.recurs()
    }
}

impl<P: Program> fmt::Debug for Elsewhere<P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let file = self.program.file();
        f.debug_struct("Elsewhere").field("program", &file.name()).field("folder", &self.folder).finish()
    }
}

/// The services beside the cycle that programs use.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub struct Beside {
    /// Sockets, serial lines, Modbus RTU or Melsec: the thread that opens connections. Where this is not set, that
    /// thread is started when the first connection is opened.
    pub connections: bool,
    /// Registers and coils of the controller's Modbus TCP server. Where this is not set and the cell has no server
    /// either, they exist, but are not accessible from outside.
    pub modbus_tcp: bool,
}

impl std::ops::BitOr for Beside {
    type Output = Self;

    /// The services that either of them uses.
    fn bitor(self, other: Self) -> Self {
        Self { connections: self.connections | other.connections, modbus_tcp: self.modbus_tcp | other.modbus_tcp }
    }
}

/// Makes a program.
pub type Make = &'static (dyn Fn() -> Box<dyn Program> + Sync);

/// A program in addition to the first one, for the channels of a cell file.
#[derive(Clone, Copy)]
pub struct Other {
    /// Its file, by the name in the cell file.
    pub file: &'static str,
    /// The folder of its data files, relative to the script directory.
    pub folder: &'static str,
    /// The function that makes it.
    pub make: Make,
}

impl fmt::Debug for Other {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Other").field("file", &self.file).field("folder", &self.folder).finish_non_exhaustive()
    }
}
