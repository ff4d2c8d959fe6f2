//! Reads literals of the syntax tree into values.

use super::{Array, Enumeration, Store, Str, Structure, TeachError, TeachProblem};
use crate::values::text::{Print, Typed};
use arl_lang::ast::{BraceItem, Expr, ExprKind, Radix, UnaryOp};
use arl_lang::catalog::{Base, base_type, enum_constant};
use arl_lang::span::Span;
use arl_lang::symbol::Interner;
use std::fmt::Write;

/// A value that a literal can be read into.
pub trait Literal: Print {
    /// Reads the literal; components and elements that it leaves out keep their value.
    ///
    /// # Errors
    /// Returns what does not fit, and in which component.
    fn put(&mut self, value: &Expr, names: &Interner) -> Result<(), TeachError>;

    /// Like `put`, for an array of these sizes.
    ///
    /// # Errors
    /// Returns what does not fit, and in which component.
    fn put_nested(&mut self, value: &Expr, _sizes: &[usize], names: &Interner) -> Result<(), TeachError> {
        self.put(value, names)
    }

    /// Appends the value as a literal that can be read back. Bytes of a string that are not text are replaced.
    fn write(&self, out: &mut String);
}

/// A literal that has been read.
enum Read<'a> {
    Int(Number),
    Double(f64),
    Bool(bool),
    Text(&'a str),
    /// A name, with its number if it is the constant of an enumeration.
    Name(Option<i32>),
    Brace(&'a [BraceItem]),
    Other,
}

/// An integer literal; one that was written in binary or hexadecimal is a bit pattern.
#[derive(Clone, Copy)]
struct Number {
    value: i64,
    pattern: bool,
}

impl Number {
    fn int(self) -> Option<i32> {
        if self.pattern {
            u32::try_from(self.value).ok().map(|bits| bits as i32)
        } else {
            i32::try_from(self.value).ok()
        }
    }
}

impl<'a> Read<'a> {
    fn new(value: &'a Expr, names: &'a Interner) -> Self {
        match &value.kind {
            ExprKind::Int(number, radix) => {
                Read::Int(Number { value: i64::from(*number), pattern: *radix != Radix::Decimal })
            }
            ExprKind::Double(number) => Read::Double(*number),
            ExprKind::Bool(truth) => Read::Bool(*truth),
            ExprKind::String(text) => Read::Text(text),
            ExprKind::Name(name) => Read::word(names.name(*name)),
            ExprKind::System(name) => Read::word(names.name(*name)),
            ExprKind::Path { scope, name, .. } => {
                let number = match base_type(names.name(scope.symbol)) {
                    Some(Base::Enum(id)) => id.def().constant(names.name(name.symbol)),
                    _ => None,
                };
                Read::Name(number.map(i32::from))
            }
            ExprKind::Brace(items) => Read::Brace(items),
            ExprKind::Unary(UnaryOp::Negate, inner) => match Read::new(inner, names) {
                Read::Double(number) => Read::Double(-number),
                Read::Int(number) if number.pattern => match number.int() {
                    Some(value) => Read::Int(Number { value: value.wrapping_neg().into(), pattern: false }),
                    None => Read::Other,
                },
                Read::Int(number) => Read::Int(Number { value: -number.value, pattern: false }),
                _ => Read::Other,
            },
            ExprKind::Unary(UnaryOp::Complement, inner) => match Read::new(inner, names) {
                Read::Int(Number { value, pattern: true }) => {
                    Read::Int(Number { value: i64::from(!(value as u32)), pattern: true })
                }
                Read::Int(number) => match number.int() {
                    Some(value) => Read::Int(Number { value: i64::from(!value), pattern: false }),
                    None => Read::Other,
                },
                _ => Read::Other,
            },
            _ => Read::Other,
        }
    }

    /// A word: a built-in constant, a hexadecimal number, or else the name of a constant.
    fn word(word: &'a str) -> Self {
        match word {
            "pi" => return Read::Double(std::f64::consts::PI),
            "endl" => return Read::Text("\n"),
            _ => {}
        }
        let bits = word.strip_suffix('h').and_then(|digits| u32::from_str_radix(digits, 16).ok());
        let constant = || enum_constant(word).map(|(_, number)| i32::from(number));
        bits.map_or_else(|| Read::Name(constant()), |bits| Read::Int(Number { value: i64::from(bits), pattern: true }))
    }

    fn what(&self) -> &'static str {
        match self {
            Read::Int(_) => "an integer",
            Read::Double(_) => "a double",
            Read::Bool(_) => "a bool",
            Read::Text(_) => "a string",
            Read::Name(_) => "a name",
            Read::Brace(_) => "braces",
            Read::Other => "an expression that is not a literal",
        }
    }

    fn mismatch(&self, expected: String, value: &Expr) -> TeachError {
        TeachError::new(TeachProblem::Type { expected, found: self.what() }, value)
    }
}

macro_rules! scalars {
    ($($ty:ty { $($pattern:pat => $how:expr),* $(,)? } written $write:expr;)*) => { $(
        impl Literal for $ty {
            fn write(&self, out: &mut String) {
                let write: fn(&$ty, &mut String) = $write;
                write(self, out);
            }

            fn put(&mut self, value: &Expr, names: &Interner) -> Result<(), TeachError> {
                let read = Read::new(value, names);
                let taken: Option<$ty> = match read {
                    $($pattern => $how,)*
                    _ => return Err(read.mismatch(self.type_name(), value)),
                };
                let beyond = || TeachError::new(TeachProblem::Range { expected: self.type_name() }, value);
                *self = taken.ok_or_else(beyond)?;
                Ok(())
            }
        }
    )* };
}

scalars! {
    i32 {
        Read::Int(number) => number.int(),
        Read::Name(Some(number)) => Some(number),
    } written push;
    u32 { Read::Int(number) => u32::try_from(number.value).ok() } written push;
    u8 { Read::Int(number) => u8::try_from(number.value).ok() } written push;
    f64 {
        Read::Int(number) => number.int().map(f64::from),
        Read::Double(number) => Some(number),
    } written |value, out| arl_lang::written::double(*value, out);
    bool {
        Read::Bool(truth) => Some(truth),
        Read::Int(number) => Some(number.value != 0),
        Read::Double(number) => Some(number != 0.0),
    } written push;
    Str { Read::Text(text) => Some(Str::from(text)) } written |value, out| arl_lang::written::string(&String::from_utf8_lossy(value.as_bytes()), out);
}

fn push<T: std::fmt::Display>(value: &T, out: &mut String) {
    // Writing to a string does not fail.
    let _ = write!(out, "{value}");
}

/// Reads the name or the number of an enumeration's constant.
fn put_constant<E: Enumeration + Typed>(place: &mut E, value: &Expr, names: &Interner) -> Result<(), TeachError> {
    let is_type = |scope: &str| {
        let spellings = std::iter::once(&E::NAME).chain(E::ALIASES);
        spellings.map(|known| known.trim_start_matches('$')).any(|known| known.eq_ignore_ascii_case(scope))
    };
    let by_name = match &value.kind {
        ExprKind::Name(name) => E::from_name(names.name(*name)),
        ExprKind::Path { scope, name, .. } if is_type(names.name(scope.symbol)) => {
            E::from_name(names.name(name.symbol))
        }
        _ => None,
    };
    let read = Read::new(value, names);
    *place = match (by_name, &read) {
        (Some(constant), _) => constant,
        (None, Read::Int(number)) => number
            .int()
            .and_then(E::from_index)
            .ok_or_else(|| TeachError::new(TeachProblem::Range { expected: E::NAME.to_owned() }, value))?,
        _ => return Err(read.mismatch(E::NAME.to_owned(), value)),
    };
    Ok(())
}

/// Reads the braces of a structure.
fn put_structure<S: Structure + Typed>(place: &mut S, value: &Expr, names: &Interner) -> Result<(), TeachError> {
    let shape = Shape {
        name: S::NAME,
        components: S::COMPONENTS,
        positional: S::POSITIONAL,
        component_index: S::component_index,
    };
    shape.read(value, names, &mut |index, value| match place.component_mut(index) {
        Some(component) => component.put(value, names),
        None => Ok(()),
    })
}

/// What is needed of a structure's type to read it, so that reading is compiled once and not for each structure.
struct Shape {
    name: &'static str,
    components: &'static [&'static str],
    positional: usize,
    component_index: fn(&str) -> Option<usize>,
}

impl Shape {
    /// Reads braces and passes each value with the number of its component to `put`.
    fn read(
        &self,
        value: &Expr,
        names: &Interner,
        put: &mut dyn FnMut(usize, &Expr) -> Result<(), TeachError>,
    ) -> Result<(), TeachError> {
        let read = Read::new(value, names);
        let Read::Brace(items) = read else {
            return Err(read.mismatch(self.name.to_owned(), value));
        };
        let named = items.first().is_some_and(|item| item.name.is_some());
        if items.iter().any(|item| item.name.is_some() != named) {
            return Err(TeachError::new(TeachProblem::Mixed, value));
        }
        if !named && items.len() > self.positional {
            let problem = TeachProblem::TooMany { expected: self.name.to_owned(), most: self.positional };
            return Err(TeachError::new(problem, value));
        }
        let mut seen = 0_u32;
        for (at, item) in items.iter().enumerate() {
            let index = match item.name {
                None => at,
                Some(ident) => self.index(names.name(ident.symbol), ident.span)?,
            };
            let name = self.components.get(index).copied().unwrap_or_default();
            if seen & (1 << index) != 0 {
                return Err(TeachError::new(TeachProblem::Twice(name.to_owned()), &item.value));
            }
            seen |= 1 << index;
            put(index, &item.value).map_err(|error| error.inside(name))?;
        }
        Ok(())
    }

    /// The number of the component with this name.
    fn index(&self, name: &str, span: Span) -> Result<usize, TeachError> {
        (self.component_index)(name).ok_or_else(|| TeachError {
            path: String::new(),
            problem: TeachProblem::Component { structure: self.name, name: name.to_owned(), known: self.components },
            span,
        })
    }
}

fn write_constant<E: Enumeration>(constant: &E, out: &mut String) {
    let name = usize::try_from(constant.index()).ok().and_then(|at| E::CONSTANTS.get(at));
    out.push_str(name.copied().unwrap_or_default());
}

/// Writes the components by name, except those that are not set.
fn write_structure<S: Structure>(structure: &S, out: &mut String) {
    out.push('{');
    for (at, name) in S::COMPONENTS.iter().enumerate() {
        let mut value = String::new();
        structure.component(at).into_iter().for_each(|component| component.write(&mut value));
        if value != UNSET_TEXT {
            let comma = if out.ends_with('{') { "" } else { "," };
            let _ = write!(out, "{comma}{name} {value}");
        }
    }
    out.push('}');
}

/// The text of the number that marks a component as not set.
const UNSET_TEXT: &str = "9e9";

macro_rules! literals {
    ($how:ident $write:ident: $($ty:ident)*) => { $(
        impl Literal for super::$ty {
            fn write(&self, out: &mut String) {
                $write(self, out)
            }

            fn put(&mut self, value: &Expr, names: &Interner) -> Result<(), TeachError> {
                $how(self, value, names)
            }
        }
    )* };
}

literals! { put_constant write_constant:
    VelProfile Printto NumBase Stoptype Controlmode Stopbits Parity Weaveshape Weaverotaxis CompenType
}

literals! { put_structure write_structure:
    Pos Frame Pose Joint JointScara Tool Wobj Weavedata Speed Slip SlipScara Jvel JvelScara CentroidPos InertiaTensor
    ToolInertiaPara Control Compendata Jttq Jtci Tcpforce
}

impl<T: Literal + Typed + Clone, const N: usize, S: Store<T, N>> Literal for Array<T, N, S> {
    fn write(&self, out: &mut String) {
        write_array(self, out);
    }

    fn put(&mut self, value: &Expr, names: &Interner) -> Result<(), TeachError> {
        put_array(self, &[], value, names)
    }

    fn put_nested(&mut self, value: &Expr, sizes: &[usize], names: &Interner) -> Result<(), TeachError> {
        put_array(self, sizes, value, names)
    }
}

/// Writes the elements of an array as a literal that can be read back.
pub fn write_array<T: Literal>(elements: &[T], out: &mut String) {
    out.push('{');
    for (at, element) in elements.iter().enumerate() {
        if at > 0 {
            out.push(',');
        }
        element.write(out);
    }
    out.push('}');
}

/// Reads the literal of an array of these sizes, outermost first; without sizes, nested rows have to be full. Elements
/// that it leaves out keep their value.
///
/// # Errors
/// Returns what does not fit, and in which component.
pub fn put_array<T: Literal + Typed + Clone>(
    elements: &mut [T],
    sizes: &[usize],
    value: &Expr,
    names: &Interner,
) -> Result<(), TeachError> {
    if !sizes.is_empty() {
        return put_elements(elements, sizes, value, names);
    }
    let length = elements.len();
    let Err(error) = put_elements(elements, &[length], value, names) else {
        return Ok(());
    };
    // The sizes are not known here; full rows are unambiguous without them.
    let mut rows: Vec<&BraceItem> = braces::<T>(elements, value, names)?.iter().collect();
    while !rows.is_empty() && rows.len() < length {
        let Some(inner) = rows.iter().map(|row| row_of(row)).collect::<Option<Vec<_>>>() else {
            break;
        };
        rows = inner.into_iter().flatten().collect();
    }
    if rows.len() != length {
        return Err(error);
    }
    for (at, (place, item)) in elements.iter_mut().zip(rows).enumerate() {
        place.put(&item.value, names).map_err(|error| error.inside(&format!("[{at}]")))?;
    }
    Ok(())
}

/// The values of braces that may be a row.
fn row_of(item: &BraceItem) -> Option<&[BraceItem]> {
    match &item.value.kind {
        ExprKind::Brace(items) if item.name.is_none() => Some(items),
        _ => None,
    }
}

/// The values between the braces of an array.
fn braces<'a, T: Typed>(elements: &[T], value: &'a Expr, names: &'a Interner) -> Result<&'a [BraceItem], TeachError> {
    match Read::new(value, names) {
        Read::Brace(items) if items.iter().all(|item| item.name.is_none()) => Ok(items),
        Read::Brace(_) => Err(TeachError::new(TeachProblem::Mixed, value)),
        other => Err(other.mismatch(format!("{}[{}]", T::NAME, elements.len()), value)),
    }
}

/// Reads the braces of an array, nested or flat. The elements of structures are braces, too, so rows are tried first.
fn put_elements<T: Literal + Typed + Clone>(
    elements: &mut [T],
    sizes: &[usize],
    value: &Expr,
    names: &Interner,
) -> Result<(), TeachError> {
    let items = braces(elements, value, names)?;
    let mut rows_error = None;
    if let [_, inner @ ..] = sizes
        && !inner.is_empty()
        && items.iter().all(|item| row_of(item).is_some())
    {
        let mut copy = elements.to_vec();
        match put_rows(&mut copy, inner, items, value, names) {
            Ok(()) => {
                elements.clone_from_slice(&copy);
                return Ok(());
            }
            Err(error) => rows_error = Some(error),
        }
    }
    let flat = put_flat(elements, items, value, names);
    // If neither works, the deeper braces show what was meant.
    let nested = items.iter().filter_map(row_of).flatten().any(|item| row_of(item).is_some());
    match (flat, rows_error) {
        (Err(flat), Some(rows)) => Err(if nested || flat.path.starts_with('[') { rows } else { flat }),
        (flat, _) => flat,
    }
}

fn put_rows<T: Literal + Typed + Clone>(
    elements: &mut [T],
    inner: &[usize],
    items: &[BraceItem],
    value: &Expr,
    names: &Interner,
) -> Result<(), TeachError> {
    let row = inner.iter().product::<usize>().max(1);
    limit::<T>(items.len(), elements.len() / row, value)?;
    for (at, (place, item)) in elements.chunks_mut(row).zip(items).enumerate() {
        put_elements(place, inner, &item.value, names).map_err(|error| error.inside(&format!("[{at}]")))?;
    }
    Ok(())
}

fn put_flat<T: Literal + Typed>(
    elements: &mut [T],
    items: &[BraceItem],
    value: &Expr,
    names: &Interner,
) -> Result<(), TeachError> {
    limit::<T>(items.len(), elements.len(), value)?;
    for (at, (place, item)) in elements.iter_mut().zip(items).enumerate() {
        place.put(&item.value, names).map_err(|error| error.inside(&format!("[{at}]")))?;
    }
    Ok(())
}

fn limit<T: Typed>(count: usize, most: usize, value: &Expr) -> Result<(), TeachError> {
    if count <= most {
        return Ok(());
    }
    Err(TeachError::new(TeachProblem::TooMany { expected: format!("an array of {}", T::NAME), most }, value))
}

#[cfg(test)]
mod tests;
