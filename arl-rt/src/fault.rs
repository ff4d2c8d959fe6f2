//! What goes wrong while a program runs: faults, and the alarms that they become.

use std::cell::RefCell;
use std::fmt;
use std::marker::PhantomData;
use std::rc::Rc;

use crate::cycle::channel_id::ChannelId;

/// A fault without its place; [`At::at`] makes an alarm of it.
#[derive(Clone, PartialEq, Debug)]
#[non_exhaustive]
pub enum Fault {
    /// `/` or `%` by an integer zero, `%` by a double zero.
    DivideByZero,
    /// A shift count outside the width.
    ShiftCount {
        /// The count.
        count: i64,
        /// The width of the value in bits.
        width: u8,
    },
    /// An index outside its dimension.
    Index {
        /// The index.
        index: i32,
        /// The size of the dimension.
        size: u32,
    },
    /// An argument outside what the function is defined for.
    Domain {
        /// The function or instruction.
        function: &'static str,
        /// What it was given and what it takes, as a part of a sentence.
        problem: Box<str>,
    },
    /// A text that is not of the wanted type.
    Text {
        /// The text.
        text: Box<str>,
        /// The type.
        wanted: &'static str,
    },
    /// A value outside the range of a system variable.
    Range {
        /// The value.
        value: f64,
        /// The least allowed.
        low: f64,
        /// The greatest allowed.
        high: f64,
    },
    /// A text that a system variable does not take.
    Word {
        /// The text.
        text: Box<str>,
        /// The texts that it takes.
        taken: &'static [&'static str],
    },
    /// Function calls are nested too deep.
    Depth,
    /// The strings and arrays of nested function calls take too many bytes.
    DepthBytes {
        /// How many bytes they may take in total.
        most: usize,
    },
    /// An `assert` whose condition is false.
    Assertion,
    /// A string that is too long.
    TooLong {
        /// How many bytes it would have.
        length: usize,
        /// How many it may have.
        most: usize,
    },
    /// A file that is missing, not readable or outside the folders that programs may use.
    File {
        /// The path as the program wrote it.
        path: Box<str>,
        /// What went wrong.
        problem: Box<str>,
    },
    /// `gettextstr`: no such file (manual 5.12.7).
    NoSuchFile(Box<str>),
    /// `gettextstr`: a line beyond the last (manual 5.12.7).
    NoSuchLine {
        /// The requested line.
        line: i32,
        /// How many lines there are.
        count: u32,
    },
    /// An io channel that does not exist, or a reversed range of channels.
    Channel(Box<str>),
    /// `ccir`: points that do not define an arc.
    ArcPlane(Box<str>),
    /// `jump`: a start or target above the highest allowed position (manual 3.3.6).
    GateHeight(Box<str>),
    /// A motion that cannot be planned or run.
    Motion(Box<str>),
    /// The robot hit something unexpected.
    Collision(Box<str>),
    /// The robot is not where it should be.
    NotFollowing(Box<str>),
    /// The robot does not report its position.
    NoFeedback(Box<str>),
    /// The drives of the robot are off, or have a fault.
    Drives(Box<str>),
    /// The robot does not come to rest where it should.
    NotSettling(Box<str>),
    /// Too many control cycles were lost.
    Late(Box<str>),
    /// Torques or forces of a robot whose file has no masses.
    NoMasses {
        /// The function or instruction.
        function: &'static str,
        /// The robot.
        robot: Box<str>,
    },
    /// An instruction or function that needs a robot, in a background channel.
    Background {
        /// The instruction or function.
        function: &'static str,
    },
    /// A `_data.arl` file that cannot be read back.
    Data(Box<str>),
    /// An interrupt, timer or trigger that cannot be watched or handled.
    Event(Box<str>),
    /// A connection that is not open, or lost.
    Connection(Box<str>),
    /// Inputs and outputs are lost without which no robot may move.
    IoLost(Box<str>),
    /// The value that a PLC gives as a program number is not one.
    ProgramNumber(Box<str>),
    /// A fault in the condition of an interrupt or a trigger.
    Condition {
        /// The interrupt or trigger.
        event: Box<str>,
        /// What went wrong.
        fault: Box<Fault>,
    },
    /// Any other fault that has a number of its own.
    Other {
        /// The alarm's number.
        number: u32,
        /// Its text.
        text: Box<str>,
    },
}

impl Fault {
    /// The alarm's number. 10064, 10065, 12002 and 12042 are the manual's; ours begin at 20000.
    pub fn number(&self) -> u32 {
        match self {
            Fault::NoSuchFile(_) => 10064,
            Fault::NoSuchLine { .. } => 10065,
            Fault::ArcPlane(_) => 12002,
            Fault::GateHeight(_) => 12042,
            Fault::DivideByZero => 20001,
            Fault::ShiftCount { .. } => 20002,
            Fault::Index { .. } => 20003,
            Fault::Domain { .. } => 20004,
            Fault::Text { .. } => 20005,
            Fault::Range { .. } | Fault::Word { .. } => 20006,
            Fault::Depth | Fault::DepthBytes { .. } => 20007,
            Fault::Assertion => 20008,
            Fault::File { .. } => 20009,
            Fault::TooLong { .. } => 20011,
            Fault::Channel(_) => 20010,
            Fault::Motion(_) => 20020,
            Fault::Collision(_) => 20021,
            Fault::NoMasses { .. } => 20022,
            Fault::Background { .. } => 20023,
            Fault::Data(_) => 20030,
            Fault::Event(_) => 20040,
            Fault::Connection(_) => 20050,
            Fault::IoLost(_) => 20051,
            Fault::ProgramNumber(_) => 20060,
            Fault::NotFollowing(_) => 20070,
            Fault::NoFeedback(_) => 20071,
            Fault::Drives(_) => 20072,
            Fault::NotSettling(_) => 20073,
            Fault::Late(_) => 20074,
            Fault::Condition { fault, .. } => fault.number(),
            Fault::Other { number, .. } => *number,
        }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Fault::DivideByZero => write!(f, "division by zero"),
            Fault::ShiftCount { count, width } => {
                write!(f, "shift by {count}: a value of {width} bits can be shifted by 0 to {}", width - 1)
            }
            Fault::Index { index, size } => {
                write!(f, "index {index} is outside the array: its size is {size}, so 0 to {} are valid", size - 1)
            }
            Fault::Domain { function, problem } => write!(f, "{function}: {problem}"),
            Fault::Text { text, wanted } => write!(f, "\"{text}\" is not a value of type {wanted}"),
            Fault::Range { value, low, high } => write!(f, "{value} is outside the allowed range {low} to {high}"),
            Fault::Word { text, taken } => {
                write!(f, "\"{text}\" is not among the allowed values: ")?;
                for (at, word) in taken.iter().enumerate() {
                    write!(f, "{}\"{word}\"", if at == 0 { "" } else { " or " })?;
                }
                Ok(())
            }
            Fault::Depth => write!(f, "function calls are nested too deep"),
            Fault::DepthBytes { most } => write!(
                f,
                "function calls are nested too deep: the strings and arrays passed to them have more than \
                 {most} bytes in total"
            ),
            Fault::Assertion => write!(f, "assertion failed"),
            Fault::File { path, problem } => write!(f, "file \"{path}\": {problem}"),
            Fault::TooLong { length, most } => {
                write!(f, "a string of {length} bytes is too long: at most {most} are allowed")
            }
            Fault::NoSuchFile(path) => write!(f, "the file \"{path}\" does not exist or is damaged"),
            Fault::NoSuchLine { line, count } => {
                write!(f, "line {line} was asked for, but the file has {count} lines")
            }
            Fault::Channel(text)
            | Fault::ArcPlane(text)
            | Fault::GateHeight(text)
            | Fault::Motion(text)
            | Fault::Collision(text)
            | Fault::NotFollowing(text)
            | Fault::NoFeedback(text)
            | Fault::Drives(text)
            | Fault::NotSettling(text)
            | Fault::Late(text)
            | Fault::Data(text)
            | Fault::Event(text)
            | Fault::Connection(text)
            | Fault::IoLost(text)
            | Fault::ProgramNumber(text) => {
                write!(f, "{text}")
            }
            Fault::NoMasses { function, robot } => write!(
                f,
                "{function}: the file of robot {robot} gives no masses, so torques and forces are not known; it needs a \
                 [[link]] for each axis"
            ),
            Fault::Background { function } => {
                write!(f, "{function} needs a robot, which a background channel does not have")
            }
            Fault::Condition { event, fault } => write!(f, "{fault}, in the condition of {event}"),
            Fault::Other { text, .. } => write!(f, "{text}"),
        }
    }
}

impl std::error::Error for Fault {}

/// The name of a source file, as alarms show it.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct File(&'static str);

impl File {
    /// A file by its name.
    pub const fn new(name: &'static str) -> Self {
        Self(name)
    }

    /// The name.
    pub const fn name(self) -> &'static str {
        self.0
    }
}

/// A fault and its place in the program.
#[derive(Clone, PartialEq, Debug)]
pub struct Alarm {
    /// What went wrong.
    pub fault: Fault,
    /// The source file.
    pub file: File,
    /// The line, from 1; 0 where the fault belongs to no line.
    pub line: u32,
    /// The channel whose program it is.
    pub channel: ChannelId,
    /// The function calls that led there, the innermost first.
    pub calls: Calls,
}

impl Alarm {
    /// An alarm at a place in the program; the controller that runs the program sets the channel.
    pub fn new(fault: Fault, file: File, line: u32) -> Self {
        Self { fault, file, line, channel: ChannelId::FIRST, calls: Calls::default() }
    }
}

/// The nested function calls of a program that led to some place.
#[derive(Clone, PartialEq, Eq, Default, Debug)]
pub struct Calls {
    /// The places of the calls, the innermost first; at most the first 20.
    pub places: Vec<(File, u32)>,
    /// How many more calls there were.
    pub more: usize,
}

/// How many calls keep their places: functions may call themselves many thousand times.
const MOST_CALLS: usize = 20;

impl Calls {
    fn add(&mut self, file: File, line: u32) {
        if self.places.len() < MOST_CALLS {
            self.places.push((file, line));
        } else {
            self.more += 1;
        }
    }
}

impl fmt::Display for Alarm {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "alarm {}: {} ({}:{}", self.fault.number(), self.fault, self.file.name(), self.line)?;
        match self.channel {
            ChannelId::FIRST => write!(f, ")"),
            channel => write!(f, ", {channel})"),
        }
    }
}

impl std::error::Error for Alarm {}

/// The program does not go on. The type has no size, so that results are returned in registers: the reason is kept in a
/// thread-local for the controller that runs the program.
#[must_use = "the program has to end"]
pub struct Stop(PhantomData<*const ()>);

/// The reason why a program does not go on.
#[derive(Clone, PartialEq, Debug)]
#[non_exhaustive]
pub enum Reason {
    /// An alarm.
    Alarm(Alarm),
    /// The `exit` instruction.
    Exit,
    /// The `restart` instruction.
    Restart,
}

thread_local! {
    /// The reason of the last [`Stop`].
    static REASON: RefCell<Reason> = const { RefCell::new(Reason::Exit) };
}

/// Is called with each alarm where it is raised.
type Listener = Rc<dyn Fn(&Alarm)>;

thread_local! {
    static LISTENER: RefCell<Option<Listener>> = const { RefCell::new(None) };
}

/// Sets a debugger's listener for the alarms of this thread. It is called where they are raised: all functions that led
/// there are still running.
pub(crate) fn listen(listener: Listener) {
    LISTENER.set(Some(listener));
}

impl Stop {
    /// Ends the program with an alarm.
    pub fn alarm(alarm: Alarm) -> Self {
        let listener = LISTENER.with_borrow(Option::clone);
        if let Some(listener) = listener {
            listener(&alarm);
        }
        Self::new(Reason::Alarm(alarm))
    }

    /// The `exit` instruction.
    pub fn exit() -> Self {
        Self::new(Reason::Exit)
    }

    /// The `restart` instruction.
    pub fn restart() -> Self {
        Self::new(Reason::Restart)
    }

    #[cold]
    #[inline(never)]
    fn new(reason: Reason) -> Self {
        REASON.set(reason);
        Self(PhantomData)
    }

    /// The reason why the program does not go on. Of several stops on a thread whose reason was not taken, the last one
    /// counts.
    pub fn reason(self) -> Reason {
        REASON.replace(Reason::Exit)
    }
}

/// Shows the last reason on this thread: take [`reason`](Stop::reason) at once where it is to be kept.
impl fmt::Display for Stop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        REASON.with_borrow(|reason| match reason {
            Reason::Alarm(alarm) => write!(f, "{alarm}"),
            Reason::Exit => write!(f, "the program exits"),
            Reason::Restart => write!(f, "the program starts again"),
        })
    }
}

impl std::error::Error for Stop {}

impl fmt::Debug for Stop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        REASON.with_borrow(|reason| write!(f, "Stop({reason:?})"))
    }
}

/// The result of anything that may stop the program.
pub type Done<T> = Result<T, Stop>;

/// Gives a fault its place.
pub trait At<T> {
    /// The same result, with the fault turned into an alarm at `line` of `file`.
    ///
    /// # Errors
    /// The alarm, where there was a fault.
    fn at(self, file: File, line: u32) -> Done<T>;
}

impl<T> At<T> for Result<T, Fault> {
    #[inline]
    fn at(self, file: File, line: u32) -> Done<T> {
        match self {
            Ok(value) => Ok(value),
            Err(fault) => Err(raise(fault, file, line)),
        }
    }
}

/// Adds to an alarm the calls that led there.
pub trait Called {
    /// The same result, of a function of the program that was called at `line` of `file`.
    #[must_use]
    fn called(self, file: File, line: u32) -> Self;
}

impl<T> Called for Done<T> {
    #[inline]
    fn called(self, file: File, line: u32) -> Self {
        self.inspect_err(|_| note_call(file, line))
    }
}

#[cold]
#[inline(never)]
fn note_call(file: File, line: u32) {
    REASON.with_borrow_mut(|reason| {
        if let Reason::Alarm(alarm) = reason {
            alarm.calls.add(file, line);
        }
    });
}

#[cold]
#[inline(never)]
fn raise(fault: Fault, file: File, line: u32) -> Stop {
    Stop::alarm(Alarm::new(fault, file, line))
}
