//! How a built-in is declared.

use super::facts::{Accepted, Form, Motion, PoseShift, Range, Relation, Role, Space};
use super::types::{Base, Family};
use crate::ast::Unit;

/// An instruction or a function.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Kind {
    /// Called as `name(arguments)`.
    Function,
    /// Written as `name label:value, ...`.
    Instruction,
}

/// What an entry does to the program that uses it.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Effect {
    /// A function of its arguments alone: the runtime's function takes no context.
    Pure,
    /// Looks at or changes the controller at once: the runtime's function takes the context and does not wait.
    Acts,
    /// Plans motion: waits only while the look-ahead is full.
    Plans,
    /// Takes the cycles that its work takes, whatever the robot does meanwhile.
    Lasts,
    /// Waits until all earlier motion has ended, and maybe longer. Stops the look-ahead.
    Waits,
    /// Ends the program or starts it again.
    Ends,
}

impl Effect {
    /// Whether the call may take longer than its cycle: the runtime's function is `async`.
    pub fn takes_time(self) -> bool {
        matches!(self, Self::Plans | Self::Lasts | Self::Waits)
    }
}

/// The values a parameter takes.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum ParamType {
    /// A value of this type (or one that converts to it).
    One(Base),
    /// An array of this type, of any length and one dimension.
    Array(Base),
    /// A value of any of these types, without conversion.
    AnyOf(&'static [Base]),
    /// A value of any type but a handle: `tostr`, `typeof`, `print`.
    Any,
}

/// How a parameter is passed.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Mode {
    /// The value.
    In,
    /// A variable that is written (and maybe read).
    Out,
    /// An expression that is evaluated again and again: `waituntil`, `when:`.
    Condition,
    /// An expression that is evaluated when an event occurs: `do:`.
    Action,
}

/// Whether a parameter must be given.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Presence {
    /// Once.
    Required,
    /// At most once; the runtime gets an `Option` (functions) or does not get the call (instructions).
    Optional,
    /// At most once; this ARL text takes its place where it is missing.
    Default(&'static str),
    /// Several times, in order (`print`'s values).
    Repeat {
        /// The least number of values.
        min: u8,
        /// The greatest number of values.
        max: u8,
    },
}

/// A parameter.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Param {
    /// Its label in the manual's spelling.
    pub name: &'static str,
    /// Other labels that are accepted.
    pub aliases: &'static [&'static str],
    /// The name of the builder's method for it (instructions); the folded name as a rule.
    pub rust: &'static str,
    /// What it takes.
    pub ty: ParamType,
    /// How it is passed.
    pub mode: Mode,
    /// Whether it must be given.
    pub presence: Presence,
    /// Whether it may be given without its label.
    pub bare: bool,
    /// The only family whose robots have it, where not all do.
    pub family: Option<Family>,
    /// Units that may follow a number here; the value itself is in the first one.
    pub units: &'static [Unit],
    /// The constants that make sense; others are an error where known.
    pub range: Option<Range>,
    /// Whether a bare number far below the usual values is most often meant in another unit.
    pub doubted: bool,
    /// Whether 9e+09, which means "not set", is an error where known.
    pub set: bool,
    /// Whether it names a system variable that can be saved; other constants are an error.
    pub keeps: bool,
    /// The number of bits of each counted item in the array that is passed with it.
    pub counts: Option<u32>,
    /// What it addresses; the first parameter of a call that addresses something determines what the call is about.
    pub addresses: Option<Space>,
    /// How it is related to the parameter that addresses something.
    pub relation: Option<Relation>,
    /// What a connection accepts; constants are checked against it where the cell is known.
    pub accepts: Option<Accepted>,
    /// Whether it is a time for which the call waits.
    pub delays: bool,
    /// Whether it is the longest time for which the call waits.
    pub limits: bool,
    /// What it means, with its unit and what happens without it.
    pub doc: &'static str,
}

impl Param {
    /// Whether robots of this family have it.
    pub fn is_of(&self, family: Family) -> bool {
        self.family.is_none_or(|only| only == family)
    }
}

/// A built-in instruction or function. Overloads of a name follow each other.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Entry {
    /// Its name in the manual's spelling.
    pub name: &'static str,
    /// Other spellings that are accepted.
    pub aliases: &'static [&'static str],
    /// Instruction or function.
    pub kind: Kind,
    /// The parameters in the order of the manual's format line.
    pub params: &'static [Param],
    /// Groups of parameters of which at most one may be given.
    pub exclusive: &'static [&'static [&'static str]],
    /// The type of the result.
    pub result: Base,
    /// The family, where it exists for one family only.
    pub family: Option<Family>,
    /// What it does to the program.
    pub effect: Effect,
    /// Whether the runtime's function returns a `Result` (an alarm is possible).
    pub fails: bool,
    /// Whether it may run in a background channel.
    pub background: bool,
    /// How the compiler translates its use.
    pub form: Form,
    /// Which motion it plans; present where the effect is [`Effect::Plans`].
    pub motion: Option<Motion>,
    /// How it shifts the pose `p`, where it does.
    pub shift: Option<PoseShift>,
    /// Which of the things that motion depends on it changes.
    pub changes: Option<Role>,
    /// The instruction that ends what it begins, by name.
    pub ended_by: Option<&'static str>,
    /// Whether it opens a connection.
    pub connects: bool,
    /// Whether it waits for the disk.
    pub uses_disk: bool,
    /// Whether it writes points of a program while the program runs.
    pub teaches: bool,
    /// Whether it stops the robot until the program lets it continue.
    pub halts: bool,
    /// Whether it changes nothing although it takes the context: it only reads.
    pub looks: bool,
    /// The runtime's function, below `arl_rt`: `math::sqrt`.
    pub path: &'static str,
    /// One sentence or two.
    pub doc: &'static str,
    /// Section of the manual.
    pub section: &'static str,
    /// A program fragment (statements of a `main`) that uses it.
    pub example: &'static str,
}

impl Entry {
    /// What a call is about: the space of its first parameter that addresses something.
    pub fn space(&self) -> Option<Space> {
        self.params.iter().find_map(|param| param.addresses)
    }
}

/// Who may write a system variable.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Access {
    /// Programs may.
    ReadWrite,
    /// The controller only: writing it is a compile error.
    ReadOnly,
}

/// When a system variable goes back to its default.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Restore {
    /// At a program reset (and at start-up): section 10.2.
    Reset,
    /// At start-up, to what `savesv` saved last: section 10.1.
    Saved,
    /// Never: every change is kept.
    Permanent,
    /// At start-up only.
    Startup,
}

/// Which of the values of its type a system variable accepts.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Takes {
    /// All of them.
    All,
    /// Numbers from the least to the greatest.
    Range(f64, f64),
    /// These texts, as they are spelled here.
    Words(&'static [&'static str]),
}

/// A system variable or constant, used as `$NAME`.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct SystemVariable {
    /// Its name without `$`, in the manual's spelling.
    pub name: &'static str,
    /// Other spellings that are accepted.
    pub aliases: &'static [&'static str],
    /// The default name of its elements, without the number after it: `tool` for `$tool0`, `$tool1` and so on.
    pub elements: Option<&'static str>,
    /// The type of the elements.
    pub ty: Base,
    /// Array sizes; empty for a scalar.
    pub dims: &'static [u32],
    /// Who may write it.
    pub access: Access,
    /// What it accepts; anything else is an alarm.
    pub takes: Takes,
    /// When it goes back to its default.
    pub restore: Restore,
    /// Its default, as ARL text.
    pub default: &'static str,
    /// Its role for motion.
    pub role: Option<Role>,
    /// The field of the runtime's system variables (`cx.system().field`).
    pub field: &'static str,
    /// What it means, with its unit.
    pub doc: &'static str,
    /// Section of the manual.
    pub section: &'static str,
    /// A program fragment (statements of a `main`) that uses it.
    pub example: &'static str,
}

/// A constant with a plain name: `PI`, `endl`.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Constant {
    /// Its name.
    pub name: &'static str,
    /// Its value.
    pub value: ConstantValue,
    /// What it means.
    pub doc: &'static str,
    /// Section of the manual.
    pub section: &'static str,
}

/// The value of a constant.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum ConstantValue {
    /// A number.
    Double(f64),
    /// A text.
    String(&'static str),
}
