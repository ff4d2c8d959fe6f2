//! Replaces the values of variables in data files; nothing else in the text changes.

use std::ops::Range;

use crate::ast::{Item, Var};
use crate::symbol::Interner;
use crate::{ParseOptions, parse, text};

/// Returns the bytes of a file with the global variable `variable` of type `ty` set to `value`, a literal; comments,
/// layout and encoding stay (manual 5.11.5, `savefilepose`).
///
/// ```
/// let file = b"// points\npose p1 = {x 1} // above the tray\n";
/// let changed = arl_lang::with_value(file, "pose", "p1", "{x 2}").unwrap();
/// assert_eq!(changed, b"// points\npose p1 = {x 2} // above the tray\n");
/// assert_eq!(arl_lang::with_value(file, "pose", "p2", "{x 2}").unwrap_err(), "has no pose p2");
/// ```
///
/// # Errors
/// If the file has mistakes or no such variable, or its encoding cannot express the value. The message continues a
/// sentence that begins with the name of the file.
pub fn with_value(bytes: &[u8], ty: &str, variable: &str, value: &str) -> Result<Vec<u8>, String> {
    let text = text::decode(bytes).map_err(|error| format!("cannot be read: {error}"))?;
    let (place, value) = match place(&text, ty, variable)? {
        Place::Value(place) => (place, value.to_owned()),
        Place::Behind(at) => (at..at, format!(" = {value}")),
    };
    text::splice(bytes, place, &value).ok_or_else(|| "has an encoding that this value cannot be written in".to_owned())
}

/// Where a value goes in a text.
enum Place {
    /// In place of the present value.
    Value(Range<usize>),
    /// After the name: the variable has no value yet.
    Behind(usize),
}

/// The place of a variable's value, or what is wrong with the file.
fn place(text: &str, ty: &str, variable: &str) -> Result<Place, String> {
    let mut names = Interner::default();
    let parsed = parse(text, &mut names, ParseOptions::default());
    if !parsed.errors.is_empty() {
        return Err("has mistakes".into());
    }
    let globals = parsed.file.items.iter().filter_map(|item| match item {
        Item::Global(decl) if !decl.ty.system && names.name(decl.ty.name).eq_ignore_ascii_case(ty) => Some(&decl.vars),
        _ => None,
    });
    let named = |var: &&Var| var.dims.is_empty() && names.name(var.name.symbol).eq_ignore_ascii_case(variable);
    let var = globals.flatten().find(named).ok_or_else(|| format!("has no {ty} {variable}"))?;
    Ok(match &var.init {
        Some(init) => Place::Value(init.span.start as usize..init.span.end as usize),
        None => Place::Behind(var.name.span.end as usize),
    })
}
