//! What may stand at the position where the user is typing.
//!
//! An editor appends the word [`HERE`] to what was typed so far and has the text checked. Where the checker meets this
//! word, it records what it looked for and what it knew.

use super::Callee;
use crate::diagnostics::Location;
use crate::hir::{ModuleId, Type};
use arl_lang::catalog::{Enum, Struct};

/// The word that stands for text that is not typed yet. It may end a name: `fee` and this word are one name.
pub const HERE: &str = "__ARL2RS_HERE__";

/// [`HERE`], folded as names are.
pub(crate) const MARKER: &str = "__arl2rs_here__";

/// The kind of name that is looked for.
#[derive(Clone, PartialEq, Debug)]
pub enum Wanted {
    /// A value, with its type if only one is possible.
    Value(Option<Type>),
    /// A function whose arguments are there already.
    Function,
    /// An instruction whose arguments are there already.
    Instruction,
    /// A variable or function of a module, after `module::`.
    Member(ModuleId),
    /// A component, after a `.` or before a value in braces.
    Component(Struct),
    /// The name of a component, in braces whose other values have names.
    ComponentName(Struct),
    /// The action of an event: a call or an assignment.
    Action,
    /// A constant, after `type::`.
    EnumConstant(Enum),
    /// A system variable, after a `$`.
    System,
    /// A label of `goto`, with the existing labels.
    Label(Vec<String>),
    /// The label of an argument, whose value is there already.
    ArgumentLabel,
    /// A type.
    Type,
    /// Nothing: the call has all its arguments.
    Nothing,
}

/// The arguments around a position.
#[derive(Clone, PartialEq, Debug)]
pub struct ArgumentList {
    /// The callee that receives them.
    pub callee: Callee,
    /// The position of the callee's name.
    pub of: Location,
    /// How many arguments each parameter already has, not counting this one.
    pub taken: Vec<usize>,
    /// The parameter that a value here would go to, if known.
    pub parameter: Option<usize>,
    /// Whether the word is the whole of an argument without a label, so that it may become a label.
    pub may_be_label: bool,
}

/// What the checker looked for at the position of [`HERE`], and what it knew there.
#[derive(Clone, PartialEq, Debug)]
pub struct Expectation {
    /// The position of the word.
    pub at: Location,
    /// What the checker looked for.
    pub wanted: Wanted,
    /// The module.
    pub module: ModuleId,
    /// The number of the item in the file: globals and functions with smaller numbers are visible.
    pub item: u32,
    /// The visible local variables, with their types and the positions of their declarations.
    pub locals: Vec<(String, Option<Type>, Location)>,
    /// The list of arguments that it would belong to.
    pub arguments: Option<ArgumentList>,
    /// The structure whose braces would contain it, and which of its components are there already.
    pub braces: Option<(Struct, Vec<bool>)>,
}
