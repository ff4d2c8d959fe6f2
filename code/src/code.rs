//! A program as a whole.

use crate::layout::Extent;
use crate::op::{Address, HandleKind, Op, Reg};
use crate::place::{Place, ValueType};
use arl_lang::catalog::Family;
use serde::{Deserialize, Serialize};

/// A checked program, ready to run.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct Code {
    /// The robot family that the program was checked for.
    #[serde(with = "crate::numbers::family")]
    pub family: Family,
    /// The names of the program's files, the main file first.
    pub files: Vec<Box<str>>,
    /// The operations of all functions.
    pub ops: Vec<Op>,
    /// The functions: those of the program, then the pieces of events, then the first values of global variables.
    pub functions: Vec<Function>,
    /// The function `main`.
    pub main: u32,
    /// The functions that give the global variables their first values, in order.
    pub first_values: Vec<u32>,
    /// The calls of functions.
    pub calls: Vec<Call>,
    /// The uses of built-ins.
    pub sites: Vec<Site>,
    /// The declarations of events.
    pub events: Vec<Event>,
    /// Copies of values that have no operation of their own.
    pub transfers: Vec<Transfer>,
    /// The extents of boxes.
    pub boxes: Vec<Extent>,
    /// What calls of functions that may call themselves weigh and hold.
    pub entries: Vec<Entry>,
    /// The types of arguments.
    pub types: Vec<ValueType>,
    /// Constant words.
    pub words: Vec<u64>,
    /// Constant strings.
    pub texts: Vec<Box<str>>,
    /// The space of all global variables.
    pub globals: Extent,
    /// The kinds of the global handles, in their order.
    pub handles: Vec<HandleKind>,
    /// The global variables by name.
    pub variables: Vec<Variable>,
    /// Whether the code was made for a debugger.
    pub watched: bool,
    /// The local variables that it sees.
    pub locals: Vec<Local>,
    /// Whether the program opens connections.
    pub connects: bool,
    /// Whether it uses registers or coils of the controller's Modbus TCP server.
    pub serves_modbus: bool,
}

/// A function.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct Function {
    /// Its name.
    pub name: Box<str>,
    /// Its file, an index into [`Code::files`].
    pub file: u16,
    /// Its first operation.
    pub start: Address,
    /// The space of its frame.
    pub frame: Extent,
    /// How many boxes it has.
    pub boxes: u16,
}

/// A call of a function: where the frame of the callee starts in that of the caller. The arguments are there already,
/// and the result is there afterwards.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct Call {
    /// The function.
    pub function: u32,
    /// The first register.
    pub register: Reg,
    /// The first word, string and handle.
    pub at: Extent,
    /// The first box.
    pub boxes: u16,
    /// The line of the call.
    pub line: u32,
}

/// A use of a built-in, of a system variable, or of an operator on structures.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct Site {
    /// What it does.
    pub target: Target,
    /// The arguments in the order of the program.
    pub args: Vec<Arg>,
    /// Where the result goes.
    pub result: Place,
    /// The line of its alarms.
    pub line: u32,
}

/// What a site uses.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize)]
pub enum Target {
    /// The entry of the catalog with this number, in the order of `arl_lang::catalog::all_entries`.
    Entry(u16),
    /// An operator on structures.
    Operator(StructureOperator),
}

/// The operators on structures.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names say it")]
pub enum StructureOperator {
    AddJoints,
    SubtractJoints,
    NegateJoint,
    FrameByFrame,
    FrameByPose,
    PoseByFrame,
    PoseByPose,
}

/// An argument.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct Arg {
    /// The number of the parameter.
    pub param: u8,
    /// The type of the value, an index into [`Code::types`].
    pub ty: u16,
    /// Where it is.
    pub place: Place,
}

/// The declaration of an interrupt, a timer or a trigger.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct Event {
    /// The entry of the catalog, and the arguments that are evaluated where it is declared.
    pub site: Site,
    /// The function that evaluates the condition, if there is one.
    pub condition: Option<Piece>,
    /// The function that does what is to be done.
    pub action: Piece,
}

/// A piece of an event: a function that is given what it uses of the frame where the event is declared.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct Piece {
    /// The function.
    pub function: u32,
    /// What is taken along: from where in the frame, and to where in the frame of the function.
    pub taken: Vec<Taken>,
}

/// Something that an event takes along.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub enum Taken {
    /// A copy of a value.
    Value(Transfer),
    /// A box, which both sides see.
    Boxed {
        /// The box of the frame.
        from: u16,
        /// The box of the function.
        to: u16,
    },
    /// A handle.
    Handle {
        /// The handle of the frame.
        from: u32,
        /// The handle of the function.
        to: u32,
        /// How many.
        count: u32,
    },
}

/// A copy of a value.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct Transfer {
    /// From where.
    pub from: Place,
    /// To where.
    pub to: Place,
    /// How much.
    pub extent: Extent,
    /// The line of an alarm, where the variable does not take the value.
    pub line: u32,
}

/// What is counted where a function that may call itself is entered.
#[derive(Clone, PartialEq, Default, Debug, Serialize, Deserialize)]
pub struct Entry {
    /// What a call weighs among those that are nested.
    pub weight: u32,
    /// Bytes of the arrays that it was handed.
    pub bytes: u32,
    /// The strings that it was handed, by place in its frame.
    pub texts: Vec<Place>,
}

/// A global variable.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct Variable {
    /// Its name.
    pub name: Box<str>,
    /// Its file, an index into [`Code::files`].
    pub file: u16,
    /// Its type.
    pub ty: ValueType,
    /// Where it is; nowhere for a constant.
    pub place: Place,
    /// The value of a constant.
    pub value: Option<ConstantValue>,
    /// Whether its value is read again from its data file at load.
    pub teachable: bool,
}

/// A local variable, as a debugger sees it.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct Local {
    /// Its name.
    pub name: Box<str>,
    /// The number of its declaration in its function.
    pub number: u32,
    /// Its type.
    pub ty: ValueType,
    /// Where it is: in a box, or among the handles of the frame.
    pub place: Place,
    /// The operations among which it is visible.
    pub scope: std::ops::Range<Address>,
}

/// The value of a constant.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub enum ConstantValue {
    /// Anything but a string.
    Word(u64),
    /// A string.
    Text(Box<str>),
}
