//! Global variables by their names, for programs that were compiled with them.

use std::fmt;

use crate::context::program::Program;
use crate::storage::data::DataVar;
use crate::values::{Onto, teach_text};
use arl_robot::settings::hint_of_many;

/// Another first value for a global variable.
pub(crate) struct Named {
    name: String,
    literal: String,
}

impl Named {
    pub(crate) fn new(name: String, literal: String) -> Self {
        Self { name, literal }
    }

    /// Sets the variable to the value, in each program that has the variable.
    ///
    /// # Errors
    /// No program has a variable of this name, several files have one, or the value does not fit.
    pub(crate) fn put(&self, programs: &[&dyn Program]) -> Result<(), GlobalError> {
        let Self { name, literal } = self;
        let put = |variable: &DataVar<'_>| teach_text(variable.slot, Onto::Value, variable.sizes, literal);
        let mut found = false;
        for program in programs {
            let done = with_variable(*program, name, put)?.transpose();
            let wrong = |problem| GlobalError::Value { name: name.clone(), literal: literal.clone(), problem };
            found |= done.map_err(wrong)?.is_some();
        }
        if found { Ok(()) } else { Err(unknown(name, programs)) }
    }
}

/// Calls `act` with the variable of this name; returns `None` where it does not exist.
///
/// # Errors
/// Several files have a variable of this name.
pub(crate) fn with_variable<T>(
    program: &dyn Program,
    name: &str,
    act: impl FnOnce(&DataVar<'_>) -> T,
) -> Result<Option<T>, GlobalError> {
    let (file, own) = name.rsplit_once("::").map_or((None, name), |(file, own)| (Some(file), own));
    let files = program.variables();
    let files = files.iter().filter(|it| file.is_none_or(|file| stem(it.file).eq_ignore_ascii_case(file)));
    let all = files.flat_map(|it| it.vars.iter().map(|variable| (it.file, variable)));
    let mut found = all.filter(|(_, variable)| variable.name.eq_ignore_ascii_case(own));
    match (found.next(), found.next()) {
        (None, _) => Ok(None),
        (Some((_, variable)), None) => Ok(Some(act(variable))),
        (Some((one, _)), Some((other, _))) => Err(GlobalError::Ambiguous {
            name: name.to_owned(),
            files: [one.to_owned(), other.to_owned()],
            meant: format!("{}::{own}", stem(one)),
        }),
    }
}

/// A file without its folder and ending.
fn stem(file: &str) -> &str {
    let name = file.rsplit(['/', '\\']).next().unwrap_or(file);
    name.rsplit_once('.').map_or(name, |(stem, _)| stem)
}

/// The error for a name that no program has.
pub(crate) fn unknown(name: &str, programs: &[&dyn Program]) -> GlobalError {
    let files: Vec<_> = programs.iter().flat_map(|program| program.variables()).collect();
    let known: Vec<&str> = files.iter().flat_map(|file| file.vars.iter().map(|variable| variable.name)).collect();
    let name = name.to_owned();
    if known.is_empty() {
        return GlobalError::NoNames { name };
    }
    GlobalError::Unknown { there: hint_of_many(&name, &known), name }
}

/// The reason why a global variable cannot be accessed, or cannot take a value.
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum GlobalError {
    /// The program has no global variables, or was compiled without their names.
    #[non_exhaustive]
    NoNames {
        /// The requested name.
        name: String,
    },
    /// There is no variable of this name.
    #[non_exhaustive]
    Unknown {
        /// The requested name.
        name: String,
        /// The variables that exist, in words.
        there: String,
    },
    /// Several files have a variable of this name.
    #[non_exhaustive]
    Ambiguous {
        /// The requested name.
        name: String,
        /// Two of the files.
        files: [String; 2],
        /// The full name of the variable in the first file.
        meant: String,
    },
    /// The value does not fit.
    #[non_exhaustive]
    Value {
        /// The variable.
        name: String,
        /// The value, as a literal of ARL.
        literal: String,
        /// The reason.
        problem: String,
    },
}

impl fmt::Display for GlobalError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            GlobalError::NoNames { name } => write!(
                f,
                "global variable `{name}`: the program has no globals, or was compiled without their names: `arl2rs run --set`, \
                 `arl2rs sweep` and `arl2rs build --library` make programs with them"
            ),
            GlobalError::Unknown { name, there } => write!(f, "there is no global variable `{name}`; {there}"),
            GlobalError::Ambiguous { name, files: [one, other], meant } => write!(
                f,
                "global variable `{name}`: there is one in {one} and one in {other}; `{meant}` is the one in {one}"
            ),
            GlobalError::Value { name, literal, problem } => {
                write!(f, "global variable `{name}` = {literal}: {problem}")
            }
        }
    }
}

impl std::error::Error for GlobalError {}
