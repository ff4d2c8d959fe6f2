//! Literal values from a `_data.arl` file, put into the variables of an already compiled program.
//!
//! The rules of a declaration apply: the same conversions, braces by name or by position, start values for components
//! that are left out.

use super::{Array, Cells, Literal, Shared, Store, Str, TeachError, TeachProblem, Watched};
use crate::values::text::{Print, Style};
use arl_lang::ast::{Expr, ExprKind, TypeRef, Var};
use arl_lang::catalog::base_type;
use arl_lang::span::Span;
use arl_lang::symbol::Interner;
use std::cell::Cell;

/// The value that supplies what a literal leaves out.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Onto {
    /// The start value.
    Start,
    /// The current value of the variable.
    Value,
}

/// A variable that takes a literal value.
pub trait Teach {
    /// Sets the variable; it keeps its value if the new one does not fit.
    ///
    /// # Errors
    /// Returns what does not fit, and in which component.
    fn teach(&self, value: &Expr, names: &Interner) -> Result<(), TeachError> {
        self.teach_nested(value, &[], names)
    }

    /// Like `teach`, for an array of these sizes, outermost first. Without sizes, nested rows have to be full.
    ///
    /// # Errors
    /// Returns what does not fit, and in which component.
    fn teach_nested(&self, value: &Expr, sizes: &[usize], names: &Interner) -> Result<(), TeachError> {
        self.teach_onto(Onto::Start, value, sizes, names)
    }

    /// Like `teach_nested`, but components and elements that the literal leaves out come from `onto`.
    ///
    /// # Errors
    /// Returns what does not fit, and in which component.
    fn teach_onto(&self, onto: Onto, value: &Expr, sizes: &[usize], names: &Interner) -> Result<(), TeachError>;

    /// Gives the variable its start value.
    ///
    /// # Errors
    /// [`TeachProblem::Constant`] if the value is fixed. The error has no source position.
    fn restart(&self) -> Result<(), TeachError>;

    /// The name of the variable's type: `pose`, `int[6]`.
    fn type_name(&self) -> String;

    /// The value as a literal that [`teach`](Teach::teach) takes; components that are not set are left out.
    fn written(&self) -> String;
}

fn written(value: &impl Literal) -> String {
    let mut text = String::new();
    value.write(&mut text);
    text
}

/// Gives a variable the value of a literal in ARL source text; `sizes` are those of an array of several dimensions.
///
/// # Errors
/// Returns a message if the text is not a literal or does not fit.
pub(crate) fn teach_text(variable: &dyn Teach, onto: Onto, sizes: &[usize], literal: &str) -> Result<(), String> {
    let mut names = Interner::default();
    let parsed = arl_lang::parse_expression(literal, &mut names, arl_lang::ParseOptions::default());
    if let Some(error) = parsed.errors.first() {
        return Err(error.kind.message());
    }
    variable.teach_onto(onto, &parsed.expr, sizes, &names).map_err(|error| error.to_string())
}

/// Gives a variable the value of a declaration, which must have the type that the variable was compiled with; `sizes`
/// are those of an array of several dimensions. Without a value the variable gets its start value.
///
/// # Errors
/// The type is another one, or the value does not fit.
pub fn teach_variable(
    slot: &dyn Teach,
    sizes: &[usize],
    ty: &TypeRef,
    var: &Var,
    names: &Interner,
) -> Result<(), TeachError> {
    let expected = slot.type_name();
    let (base, length) = expected.split_once('[').unwrap_or((&expected, ""));
    let length = length.trim_end_matches(']').parse().ok();
    let sizes_known = if sizes.is_empty() { length.as_slice() } else { sizes };
    let literal = |size: &Expr| match size.kind {
        ExprKind::Int(size, _) => Some(size as usize),
        _ => None,
    };
    let same_sizes = var.dims.len() == sizes_known.len()
        && var.dims.iter().zip(sizes_known).all(|(size, known)| literal(size).is_none_or(|size| size == *known));
    let name = names.name(ty.name);
    if !same_sizes || base_type(name) != base_type(base.trim_start_matches('$')) {
        let size = |size: &Expr| literal(size).map_or("[..]".to_owned(), |size| format!("[{size}]"));
        let found = format!("{name}{}", var.dims.iter().map(size).collect::<String>());
        let sizes_text: String = sizes_known.iter().map(|size| format!("[{size}]")).collect();
        let problem = TeachProblem::Declared { expected: format!("{base}{sizes_text}"), found };
        return Err(TeachError { path: String::new(), problem, span: ty.span });
    }
    match &var.init {
        Some(value) => slot.teach_nested(value, sizes, names),
        None => slot.restart().map_err(|error| TeachError { span: var.name.span, ..error }),
    }
}

impl<T: Literal + Default + Copy> Teach for Cell<T> {
    fn teach_onto(&self, onto: Onto, value: &Expr, sizes: &[usize], names: &Interner) -> Result<(), TeachError> {
        let mut taught = match onto {
            Onto::Start => T::default(),
            Onto::Value => self.get(),
        };
        taught.put_nested(value, sizes, names)?;
        self.set(taught);
        Ok(())
    }

    fn restart(&self) -> Result<(), TeachError> {
        self.set(T::default());
        Ok(())
    }

    fn type_name(&self) -> String {
        T::default().type_name()
    }

    fn written(&self) -> String {
        written(&self.get())
    }
}

macro_rules! teaches_shared {
    ($($Variable:ident)*) => { $(
        impl<T: Literal + Default + Clone> Teach for $Variable<T> {
            fn teach_onto(&self, onto: Onto, value: &Expr, sizes: &[usize], names: &Interner) -> Result<(), TeachError> {
                let mut taught = match onto {
                    Onto::Start => T::default(),
                    Onto::Value => self.get(),
                };
                taught.put_nested(value, sizes, names)?;
                self.set(taught);
                Ok(())
            }

            fn restart(&self) -> Result<(), TeachError> {
                self.set(T::default());
                Ok(())
            }

            fn type_name(&self) -> String {
                self.with(Print::type_name)
            }

            fn written(&self) -> String {
                self.with(written)
            }
        }
    )* };
}

teaches_shared! { Shared Watched }

impl<T: Copy + Default, const N: usize, S: Store<T, N>> Teach for Cells<T, N, S>
where
    Array<T, N, S>: Literal,
{
    fn teach_onto(&self, onto: Onto, value: &Expr, sizes: &[usize], names: &Interner) -> Result<(), TeachError> {
        let mut taught = match onto {
            Onto::Start => Array::start(),
            Onto::Value => self.get(),
        };
        taught.put_nested(value, sizes, names)?;
        self.set(taught);
        Ok(())
    }

    fn restart(&self) -> Result<(), TeachError> {
        self.set(Array::start());
        Ok(())
    }

    fn type_name(&self) -> String {
        self.get().type_name()
    }

    fn written(&self) -> String {
        written(&self.get())
    }
}

/// A constant, whose value is part of the compiled program: it takes that value only.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Fixed<T>(pub T);

impl<T: Literal + Default + PartialEq> Teach for Fixed<T> {
    fn teach_onto(&self, _onto: Onto, value: &Expr, sizes: &[usize], names: &Interner) -> Result<(), TeachError> {
        let mut fresh = T::default();
        fresh.put_nested(value, sizes, names)?;
        if fresh == self.0 { Ok(()) } else { Err(TeachError::new(constant(&self.0), value)) }
    }

    fn restart(&self) -> Result<(), TeachError> {
        Err(TeachError { path: String::new(), problem: constant(&self.0), span: Span::default() })
    }

    fn type_name(&self) -> String {
        self.0.type_name()
    }

    fn written(&self) -> String {
        written(&self.0)
    }
}

impl Teach for Fixed<&'static str> {
    fn teach_onto(&self, onto: Onto, value: &Expr, sizes: &[usize], names: &Interner) -> Result<(), TeachError> {
        Fixed(Str::literal(self.0)).teach_onto(onto, value, sizes, names)
    }

    fn restart(&self) -> Result<(), TeachError> {
        Fixed(Str::literal(self.0)).restart()
    }

    fn type_name(&self) -> String {
        self.0.type_name()
    }

    fn written(&self) -> String {
        written(&Str::literal(self.0))
    }
}

fn constant(value: &dyn Print) -> TeachProblem {
    TeachProblem::Constant(value.printed(&Style::START).to_string())
}
