//! Literal values from a `_data.arl` file, put into the variables of a program that is compiled already.
//!
//! The rules are those of a declaration: the same conversions, braces by name or by position, start values for what
//! is left out.

use super::{Literal, Shared};
use crate::text::Print;
use arl_lang::ast::Expr;
use arl_lang::span::Span;
use arl_lang::symbol::Interner;
use std::cell::Cell;
use std::fmt;

/// A variable that takes a literal value.
pub trait Teach {
    /// Puts the value in; the variable stays as it was where the value does not fit.
    ///
    /// # Errors
    /// What does not fit, and in which component.
    fn teach(&self, value: &Expr, names: &Interner) -> Result<(), TeachError> {
        self.teach_nested(value, &[], names)
    }

    /// The same for an array of these sizes, outermost first. Without sizes, nested rows have to be full.
    ///
    /// # Errors
    /// What does not fit, and in which component.
    fn teach_nested(&self, value: &Expr, sizes: &[usize], names: &Interner) -> Result<(), TeachError>;

    /// The name of the variable's type: `pose`, `int[6]`.
    fn type_name(&self) -> String;
}

impl<T: Literal + Default + Copy> Teach for Cell<T> {
    fn teach_nested(&self, value: &Expr, sizes: &[usize], names: &Interner) -> Result<(), TeachError> {
        let mut fresh = T::default();
        fresh.put_nested(value, sizes, names)?;
        self.set(fresh);
        Ok(())
    }

    fn type_name(&self) -> String {
        T::default().type_name()
    }
}

impl<T: Literal + Default> Teach for Shared<T> {
    fn teach_nested(&self, value: &Expr, sizes: &[usize], names: &Interner) -> Result<(), TeachError> {
        let mut fresh = T::default();
        fresh.put_nested(value, sizes, names)?;
        self.set(fresh);
        Ok(())
    }

    fn type_name(&self) -> String {
        self.with(Print::type_name)
    }
}

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
            TeachProblem::Type { expected, found } => write!(f, "expected a value of type {expected}, found {found}"),
            TeachProblem::Range { expected } => write!(f, "the number is outside the range of {expected}"),
            TeachProblem::Component { structure, name, known } => {
                write!(f, "{structure} has no component {name}; it has {}", known.join(", "))
            }
            TeachProblem::Twice(name) => write!(f, "component {name} is set twice"),
            TeachProblem::Mixed => {
                write!(f, "values with and without names, or rows and elements, stand side by side in braces")
            }
            TeachProblem::TooMany { expected, most } => write!(f, "{expected} takes at most {most} values"),
        }
    }
}

impl std::error::Error for TeachError {}
