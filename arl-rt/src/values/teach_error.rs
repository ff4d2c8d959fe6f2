//! Errors of a literal that cannot be the value of a variable.

use std::fmt;

use arl_lang::ast::Expr;
use arl_lang::span::Span;

/// The error of a literal that was not accepted.
#[derive(Clone, PartialEq, Debug)]
pub struct TeachError {
    /// The component or element: `t_frame.x`, `[3].cfg`; empty if the value as a whole does not fit.
    pub path: String,
    /// What does not fit.
    pub problem: TeachProblem,
    /// The position of the value in its file.
    pub span: Span,
}

/// What does not fit about a literal.
#[derive(Clone, PartialEq, Debug)]
pub enum TeachProblem {
    /// The declaration has another type than the compiled one.
    Declared {
        /// The compiled type.
        expected: String,
        /// The type of the declaration.
        found: String,
    },
    /// A constant whose compiled value is this one has another value, or none.
    Constant(String),
    /// The value is of another type.
    Type {
        /// The type of the variable or component.
        expected: String,
        /// What was found.
        found: &'static str,
    },
    /// A number outside the range of the type.
    Range {
        /// The type of the variable or component.
        expected: String,
    },
    /// A component that the structure does not have.
    Component {
        /// The structure.
        structure: &'static str,
        /// The name that was found.
        name: String,
        /// The names of its components.
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
        /// The most values it takes.
        most: usize,
    },
}

impl TeachError {
    pub(super) fn new(problem: TeachProblem, value: &Expr) -> Self {
        Self { path: String::new(), problem, span: value.span }
    }

    /// The same error with the path seen from the value that contains the component.
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
                write!(f, "it is a constant, {value} in this program: only the text of the program changes it")
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
