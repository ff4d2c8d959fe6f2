//! Why a literal is not taken as the value of a variable.

use std::fmt;

use arl_lang::ast::Expr;
use arl_lang::span::Span;

/// Why a literal was not taken.
#[derive(Clone, PartialEq, Debug)]
pub struct TeachError {
    /// The component or element: `t_frame.x`, `[3].cfg`; empty where the value as a whole does not fit.
    pub path: String,
    /// What does not fit.
    pub problem: TeachProblem,
    /// Where the value stands in its file.
    pub span: Span,
}

/// What does not fit about a literal.
#[derive(Clone, PartialEq, Debug)]
pub enum TeachProblem {
    /// The declaration is of another type than the one that was compiled.
    Declared {
        /// The type that was compiled.
        expected: String,
        /// The type that stands there.
        found: String,
    },
    /// A constant, whose compiled value this is, has another value or none.
    Constant(String),
    /// The value is of another type.
    Type {
        /// The type of the variable or component.
        expected: String,
        /// What stands there.
        found: &'static str,
    },
    /// A number that the type does not hold.
    Range {
        /// The type of the variable or component.
        expected: String,
    },
    /// A component that the structure does not have.
    Component {
        /// The structure.
        structure: &'static str,
        /// The name that stands there.
        name: String,
        /// The names that it has.
        known: &'static [&'static str],
    },
    /// A component that is set twice.
    Twice(String),
    /// Values with and without names in the same braces, or rows beside elements.
    Mixed,
    /// More values than there are components or elements.
    TooMany {
        /// The structure or array.
        expected: String,
        /// How many values it takes.
        most: usize,
    },
}

impl TeachError {
    pub(super) fn new(problem: TeachProblem, value: &Expr) -> Self {
        Self { path: String::new(), problem, span: value.span }
    }

    /// The same error, seen from what holds the component.
    pub(super) fn inside(mut self, outer: &str) -> Self {
        let joint = if self.path.is_empty() || self.path.starts_with('[') { "" } else { "." };
        self.path = format!("{outer}{joint}{}", self.path);
        self
    }
}

impl fmt::Display for TeachError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.path.is_empty() {
            write!(f, "{}: ", self.path)?;
        }
        match &self.problem {
            TeachProblem::Declared { expected, found } => {
                write!(
                    f,
                    "the program was compiled with type {expected}, and the type is {found} now: compile it again"
                )
            }
            TeachProblem::Constant(value) => {
                write!(f, "the program was compiled with the constant {value}: compile it again to change it")
            }
            TeachProblem::Type { expected, found } => write!(f, "expected a value of type {expected}, found {found}"),
            TeachProblem::Range { expected } => write!(f, "the number is outside the range of {expected}"),
            TeachProblem::Component { structure, name, known } => {
                write!(f, "{structure} has no component {name}; it has {}", known.join(", "))
            }
            TeachProblem::Twice(name) => write!(f, "component {name} is set twice"),
            TeachProblem::Mixed => {
                write!(f, "the braces mix values with and without names, or rows and elements")
            }
            TeachProblem::TooMany { expected, most } => write!(f, "{expected} takes at most {most} values"),
        }
    }
}

impl std::error::Error for TeachError {}
