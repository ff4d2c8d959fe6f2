//! The operations.

use arl_lang::catalog;
use serde::{Deserialize, Serialize};

/// The number of a register of the frame.
pub type Reg = u8;

/// The index of an operation in [`Code::ops`](crate::Code::ops).
pub type Address = u32;

/// One operation. `to`, `left`, `right`, `from`, `at` name registers, words or strings by number; `line` is the line of
/// an alarm.
#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the fields are operands, which are named alike everywhere")]
#[rustfmt::skip]
pub enum Op {
    // Registers.
    /// Copies a register.
    Copy { to: Reg, from: Reg },
    /// A number that fits into 32 bits.
    Small { to: Reg, value: i32 },
    /// A word of [`Code::words`](crate::Code::words).
    Word { to: Reg, at: u32 },

    // Whole numbers of 32 bits; they wrap.
    AddInt { to: Reg, left: Reg, right: Reg },
    SubInt { to: Reg, left: Reg, right: Reg },
    MulInt { to: Reg, left: Reg, right: Reg },
    AddSmall { to: Reg, left: Reg, value: i32 },
    MulSmall { to: Reg, left: Reg, value: i32 },
    /// A product with a constant, and a sum: the number of an element.
    MulAdd { to: Reg, left: Reg, right: Reg, value: i32 },
    DivInt { to: Reg, left: Reg, right: Reg, line: u32 },
    RemInt { to: Reg, left: Reg, right: Reg, line: u32 },
    /// The divisor is not 0.
    DivSmall { to: Reg, left: Reg, value: i32 },
    /// The divisor is not 0.
    RemSmall { to: Reg, left: Reg, value: i32 },
    DivUint { to: Reg, left: Reg, right: Reg, line: u32 },
    RemUint { to: Reg, left: Reg, right: Reg, line: u32 },
    And { to: Reg, left: Reg, right: Reg },
    Or { to: Reg, left: Reg, right: Reg },
    Xor { to: Reg, left: Reg, right: Reg },
    AndSmall { to: Reg, left: Reg, value: i32 },
    OrSmall { to: Reg, left: Reg, value: i32 },
    XorSmall { to: Reg, left: Reg, value: i32 },
    /// Shifts; the alarm names the width of the type.
    ShiftLeft { to: Reg, left: Reg, right: Reg, of: Shifted, line: u32 },
    ShiftRight { to: Reg, left: Reg, right: Reg, of: Shifted, line: u32 },
    /// A count within 0 to 31.
    ShiftLeftSmall { to: Reg, left: Reg, count: u8 },
    /// A count within 0 to 31; keeps the sign.
    ShiftRightSmall { to: Reg, left: Reg, count: u8 },
    NegInt { to: Reg, from: Reg },
    NotInt { to: Reg, from: Reg },
    /// The lowest 8 bits.
    ToByte { to: Reg, from: Reg },

    // Doubles.
    AddDouble { to: Reg, left: Reg, right: Reg },
    SubDouble { to: Reg, left: Reg, right: Reg },
    MulDouble { to: Reg, left: Reg, right: Reg },
    DivDouble { to: Reg, left: Reg, right: Reg },
    RemDouble { to: Reg, left: Reg, right: Reg, line: u32 },
    NegDouble { to: Reg, from: Reg },
    IntToDouble { to: Reg, from: Reg },
    UintToDouble { to: Reg, from: Reg },

    // Bools.
    NotBool { to: Reg, from: Reg },
    /// Whether a whole number is not 0.
    IsSet { to: Reg, from: Reg },
    /// Whether a double is not 0.
    IsSetDouble { to: Reg, from: Reg },
    Compare { to: Reg, left: Reg, right: Reg, by: Comparison },

    // Jumps.
    Jump { to: Address },
    JumpIf { from: Reg, to: Address },
    JumpUnless { from: Reg, to: Address },
    JumpLess { left: Reg, right: Reg, to: Address },
    JumpLessEqual { left: Reg, right: Reg, to: Address },
    JumpEqual { left: Reg, right: Reg, to: Address },
    JumpNotEqual { left: Reg, right: Reg, to: Address },
    JumpLessSmall { left: Reg, value: i32, to: Address },
    JumpNotLessSmall { left: Reg, value: i32, to: Address },
    JumpEqualSmall { left: Reg, value: i32, to: Address },
    JumpNotEqualSmall { left: Reg, value: i32, to: Address },
    /// The end of a round: adds to a register and jumps if it is less.
    StepLess { left: Reg, right: Reg, by: i16, to: Address },
    StepLessSmall { left: Reg, by: i16, value: i32, to: Address },
    /// Jumps if the result of the comparison is `wanted`.
    JumpCompare { left: Reg, right: Reg, by: Comparison, wanted: bool, to: Address },

    // Words of the frame.
    Load { to: Reg, at: u32 },
    Store { from: Reg, at: u32 },
    /// The element of an array of single words; the number has been checked.
    LoadElement { to: Reg, index: Reg, at: u32 },
    StoreElement { from: Reg, index: Reg, at: u32 },
    /// The same; the number is checked.
    LoadChecked { to: Reg, index: Reg, size: u16, at: u32, line: u16 },
    StoreChecked { from: Reg, index: Reg, size: u16, at: u32, line: u16 },
    // Words of the global variables.
    LoadGlobal { to: Reg, at: u32 },
    StoreGlobal { from: Reg, at: u32 },
    LoadGlobalElement { to: Reg, index: Reg, at: u32 },
    StoreGlobalElement { from: Reg, index: Reg, at: u32 },
    LoadGlobalChecked { to: Reg, index: Reg, size: u16, at: u32, line: u16 },
    StoreGlobalChecked { from: Reg, index: Reg, size: u16, at: u32, line: u16 },
    // Words of a box.
    LoadBoxed { to: Reg, from: u16, at: u32 },
    StoreBoxed { to: u16, from: Reg, at: u32 },
    /// Checks the number of an element in one dimension.
    Index { to: Reg, index: Reg, size: u16, line: u32 },
    /// Checks the numbers of an element in two dimensions, and makes one of them.
    Index2 { to: Reg, row: Reg, column: Reg, rows: u16, columns: u16, line: u32 },

    // Several words.
    CopyWords { to: u32, from: u32, count: u16 },
    /// From global variables to the frame.
    CopyFromGlobal { to: u32, from: u32, count: u16 },
    CopyToGlobal { to: u32, from: u32, count: u16 },
    /// From a word of the frame that a register counts on from.
    CopyElement { to: u32, index: Reg, from: u32, count: u16 },
    CopyToElement { to: u32, index: Reg, from: u32, count: u16 },
    CopyGlobalElement { to: u32, index: Reg, from: u32, count: u16 },
    CopyToGlobalElement { to: u32, index: Reg, from: u32, count: u16 },
    /// Words of [`Code::words`](crate::Code::words) into the frame.
    CopyConstants { to: u32, from: u32, count: u16 },
    /// Zeros into the frame.
    Clear { at: u32, count: u32 },
    /// Copies a value from place to place: [`Code::transfers`](crate::Code::transfers).
    Transfer { transfer: u32 },

    // Strings.
    /// A string of [`Code::texts`](crate::Code::texts).
    Text { to: u16, at: u32 },
    CopyText { to: u16, from: u16 },
    /// The element of an array of strings; the number has been checked.
    LoadText { to: u16, index: Reg, at: u32 },
    StoreText { from: u16, index: Reg, at: u32 },
    LoadGlobalText { to: u16, at: u32 },
    StoreGlobalText { from: u16, at: u32 },
    /// Joins two strings; the left one is used up.
    Join { to: u16, right: u16 },
    /// An alarm if a string is too long.
    CheckLength { of: u16, line: u32 },
    Append { to: u16, more: u16, line: u32 },
    AppendGlobal { to: u32, more: u16, line: u32 },
    CompareTexts { to: Reg, left: u16, right: u16, by: Comparison },
    /// Empties strings of the frame.
    ClearTexts { at: u32, count: u32 },

    // Handles and boxes.
    /// New clocks or connections.
    NewHandles { at: u32, count: u16, kind: HandleKind },
    /// The end of the block of local clocks and connections.
    DropHandles { at: u32, count: u32 },
    /// A new box: [`Code::boxes`](crate::Code::boxes) has its extent.
    NewBox { to: u16, extent: u32 },

    // Functions and built-ins.
    Call { call: u32 },
    Return,
    ReturnWord { from: Reg },
    ReturnText { from: u16 },
    /// Sets the program pointer.
    Line { line: u32 },
    /// A built-in that takes no time: [`Code::sites`](crate::Code::sites).
    BuiltIn { site: u32 },
    /// A built-in that may take longer than its cycle.
    Await { site: u32 },
    /// A `jump` that stops above its target: [`Code::sites`](crate::Code::sites); then `Sink` ends it.
    Above { site: u32 },
    Sink { line: u32 },
    /// The robot stays there.
    StayAbove,
    /// The declaration of an event: [`Code::events`](crate::Code::events).
    Event { event: u32 },
    /// `waituntil` waits for motion to end; the register gets the cycle at which its time is over.
    Wait { to: Reg, limit: Option<Reg>, line: u32 },
    /// Whether that cycle has come.
    IsLate { to: Reg, wait: Reg },
    /// The condition of an event changes something each time: it is no mere waiting.
    GoesOn,

    // The cycle.
    NextCycle,
    /// The next cycle, where the program only waits for a change.
    Change,
    /// Counts rounds, and gives the cycle back where none are left.
    Spend { rounds: i32 },
    /// Takes a round for a loop that counts alone; where none is left, waits and goes on at `again`.
    Take { again: Address },
    /// The end of a loop that counts alone: where more was counted than there was, waits and goes on at `again`.
    Leave { again: Address },
    /// Counts the rounds of a loop after it: its variable went from `first` to `last` in steps of `step`.
    Charge { first: Reg, last: Reg, step: ChargeStep, how: Charging, rounds: i32 },
    /// Where a function that may call itself is entered: [`Code::entries`](crate::Code::entries).
    Enter { entry: u32, line: u32 },
    /// `exit`
    Exit,
    /// `restart`
    Restart,

    // For a debugger, in code that was made for one.
    /// A function begins, or the action of an event.
    Open { line: u32, is_action: bool },
    /// A statement begins: the program may be halted here.
    Halt { line: u32 },
    /// A local variable is there from now on: [`Code::locals`](crate::Code::locals).
    Show { local: u32 },
    /// The end of the block of a local variable that is in a box.
    DropBox { at: u16 },
}

/// How two values are compared.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Comparison {
    LessInt,
    LessEqualInt,
    LessUint,
    LessEqualUint,
    LessDouble,
    LessEqualDouble,
    EqualDouble,
    /// Of words, and of strings.
    Equal,
}

/// The type of what is shifted.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Shifted {
    Int,
    Uint,
    Byte,
    /// The same, where the count is a uint.
    IntByUint,
    UintByUint,
    ByteByUint,
}

/// The kind of a clock or connection.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names say it")]
pub enum HandleKind {
    Clock,
    Socket,
    Iodev,
    ModbusDev,
    MelsecDev,
}

impl From<catalog::Handle> for HandleKind {
    fn from(handle: catalog::Handle) -> Self {
        match handle {
            catalog::Handle::Clock => Self::Clock,
            catalog::Handle::Socket => Self::Socket,
            catalog::Handle::Iodev => Self::Iodev,
            catalog::Handle::ModbusDev => Self::ModbusDev,
            catalog::Handle::MelsecDev => Self::MelsecDev,
        }
    }
}

/// The step of a loop whose rounds are counted after it.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize)]
pub enum ChargeStep {
    /// One up.
    Up,
    /// One down.
    Down,
    /// In this register.
    By(Reg),
    /// In this register, downwards.
    DownBy(Reg),
}

/// Where rounds are counted after a loop.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize)]
pub enum Charging {
    /// For the loop around it, which counts alone.
    Counter,
    /// In the context; the cycle may be given back.
    Spend,
    /// In the context, without waiting.
    Charge,
}

const _: () = assert!(size_of::<Op>() == 12, "operations are read in each step of the engine");
