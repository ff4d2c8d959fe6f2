//! What may stand at a place where somebody types.
//!
//! An editor puts the word [`HERE`] behind what was typed so far and has the text checked. Where the checker meets that
//! word, it notes what it looked for and what it knew.

use super::Callee;
use crate::diagnostics::Location;
use crate::hir::{ModuleId, Type};
use arl_lang::catalog::{Enum, Struct};

/// The word that stands for what is not typed yet. It may end a name: `fee` and this word are one name.
pub const HERE: &str = "__ARL2RS_HERE__";

/// [`HERE`], folded as names are.
pub(crate) const MARKER: &str = "__arl2rs_here__";

/// What kind of name is looked for.
#[derive(Clone, PartialEq, Debug)]
pub enum Wanted {
    /// A value; its type, where only one will do.
    Value(Option<Type>),
    /// A function whose arguments are there already.
    Function,
    /// An instruction whose arguments are there already.
    Instruction,
    /// A variable or function of a module, behind `module::`.
    Member(ModuleId),
    /// A component, behind a `.`, or in front of a value in braces.
    Component(Struct),
    /// The name of a component, in braces whose other values have names.
    ComponentName(Struct),
    /// What is done at an event: a call or an assignment.
    Action,
    /// A constant, behind `type::`.
    EnumConstant(Enum),
    /// A system variable, behind a `$`.
    System,
    /// A label of `goto`; the labels that there are.
    Label(Vec<String>),
    /// The label of an argument, whose value is there already.
    ArgumentLabel,
    /// A type.
    Type,
    /// Nothing: the call has all its arguments.
    Nothing,
}

/// The arguments around a place.
#[derive(Clone, PartialEq, Debug)]
pub struct ArgumentList {
    /// Who gets them.
    pub callee: Callee,
    /// Where the callee's name stands.
    pub of: Location,
    /// How many arguments each parameter has already, this one not counted.
    pub taken: Vec<usize>,
    /// The parameter that a value here would go to, where that is known.
    pub parameter: Option<usize>,
    /// Whether it is all of an argument without a label, so that it may become one.
    pub may_be_label: bool,
}

/// What the checker looked for where [`HERE`] stood, and what it knew there.
#[derive(Clone, PartialEq, Debug)]
pub struct Expectation {
    /// Where the word stands.
    pub at: Location,
    /// What it looked for.
    pub wanted: Wanted,
    /// The module.
    pub module: ModuleId,
    /// The number of the item in the file: globals and functions of smaller numbers are known.
    pub item: u32,
    /// The local variables that are known, with their types and the places of their declarations.
    pub locals: Vec<(String, Option<Type>, Location)>,
    /// The arguments that it would be one of.
    pub arguments: Option<ArgumentList>,
    /// The structure whose braces it would stand in, and which of its components are there already.
    pub braces: Option<(Struct, Vec<bool>)>,
}
