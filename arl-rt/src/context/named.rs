//! Global variables by their names, for programs that were compiled with them.

use crate::context::program::Program;
use crate::storage::data::DataVar;
use crate::values::{Onto, teach_text};
use arl_robot::settings::nearest;

/// Another first value for a global variable.
pub(crate) struct Named {
    name: String,
    literal: String,
}

impl Named {
    pub(crate) fn new(name: String, literal: String) -> Self {
        Self { name, literal }
    }

    /// Puts the value into the variable, in each program that has one.
    ///
    /// # Errors
    /// No program has a variable of this name, several files of one have, or the value does not fit.
    pub(crate) fn put(&self, programs: &[&dyn Program]) -> Result<(), String> {
        let Self { name, literal } = self;
        let put = |variable: &DataVar<'_>| teach_text(variable.slot, Onto::Value, variable.sizes, literal);
        let mut found = false;
        for program in programs {
            let done = with_variable(*program, name, put)?.transpose();
            found |= done.map_err(|problem| format!("global variable `{name}` = {literal}: {problem}"))?.is_some();
        }
        if found { Ok(()) } else { Err(unknown(name, programs)) }
    }
}

/// Does something with the variable of this name; nothing where there is none.
///
/// # Errors
/// Several files have one.
pub(crate) fn with_variable<T>(
    program: &dyn Program,
    name: &str,
    act: impl FnOnce(&DataVar<'_>) -> T,
) -> Result<Option<T>, String> {
    let (file, own) = name.rsplit_once("::").map_or((None, name), |(file, own)| (Some(file), own));
    let files = program.variables();
    let files = files.iter().filter(|it| file.is_none_or(|file| stem(it.file).eq_ignore_ascii_case(file)));
    let all = files.flat_map(|it| it.vars.iter().map(|variable| (it.file, variable)));
    let mut found = all.filter(|(_, variable)| variable.name.eq_ignore_ascii_case(own));
    match (found.next(), found.next()) {
        (None, _) => Ok(None),
        (Some((_, variable)), None) => Ok(Some(act(variable))),
        (Some((one, _)), Some((other, _))) => Err(format!(
            "global variable `{name}`: there is one in {one} and one in {other}; `{}::{own}` is that of the first",
            stem(one)
        )),
    }
}

/// A file without its folder and ending.
fn stem(file: &str) -> &str {
    let name = file.rsplit(['/', '\\']).next().unwrap_or(file);
    name.rsplit_once('.').map_or(name, |(stem, _)| stem)
}

/// What is said of a name that no program has.
pub(crate) fn unknown(name: &str, programs: &[&dyn Program]) -> String {
    let files: Vec<_> = programs.iter().flat_map(|program| program.variables()).collect();
    let known: Vec<&str> = files.iter().flat_map(|file| file.vars.iter().map(|variable| variable.name)).collect();
    match known.is_empty() {
        true => format!(
            "global variable `{name}`: the program has none, or was compiled without their names: `arl2rs run --set`, \
             `arl2rs sweep` and `arl2rs build --library` make programs with them"
        ),
        false => format!("there is no global variable `{name}`; {}", near(name, &known)),
    }
}

/// So many names are listed where none is like it.
const LISTED: usize = 8;

fn near(name: &str, known: &[&str]) -> String {
    match (nearest(name, known), known.get(..LISTED)) {
        (Some(near), _) => format!("did you mean `{near}`?"),
        (None, Some(first)) => format!("there are {}, like {}", known.len(), first.join(", ")),
        (None, None) => format!("there are {}", known.join(", ")),
    }
}
