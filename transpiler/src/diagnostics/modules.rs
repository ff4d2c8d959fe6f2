//! Files and modules.

use super::{Code, Problem};

/// What is wrong with a file.
#[derive(Clone, PartialEq, Debug)]
pub(crate) enum ModuleProblem {
    /// No such file.
    Missing { path: String },
    /// A file that cannot be read.
    Unreadable { path: String, reason: String },
    /// A file that is neither UTF-8 nor GB18030.
    Encoding { path: String, offset: usize, utf16: bool },
    /// A file name that cannot be used in front of `::`.
    ModuleName { path: String },
    /// Two imported files of one name.
    SameName { name: String, first: String },
    /// A function in a data file.
    FunctionInData,
}

impl Problem for ModuleProblem {
    fn code(&self) -> Code {
        Code(match self {
            ModuleProblem::Missing { .. } => 601,
            ModuleProblem::Unreadable { .. } => 602,
            ModuleProblem::Encoding { .. } => 603,
            ModuleProblem::ModuleName { .. } => 604,
            ModuleProblem::SameName { .. } => 605,
            ModuleProblem::FunctionInData => 606,
        })
    }

    fn message(&self) -> String {
        match self {
            ModuleProblem::Missing { path } => format!("there is no file \"{path}\""),
            ModuleProblem::Unreadable { path, reason } => format!("the file \"{path}\" cannot be read: {reason}"),
            ModuleProblem::Encoding { path, utf16: true, .. } => format!("the file \"{path}\" is UTF-16"),
            ModuleProblem::Encoding { path, offset, .. } => {
                format!("the file \"{path}\" is neither UTF-8 nor GB18030 (byte {offset})")
            }
            ModuleProblem::ModuleName { path } => format!("the file name of \"{path}\" cannot name a module"),
            ModuleProblem::SameName { name, .. } => format!("two imported files have the module name `{name}`"),
            ModuleProblem::FunctionInData => "a data file holds variables only, no functions".into(),
        }
    }

    fn label(&self) -> String {
        String::new()
    }

    fn help(&self) -> Option<String> {
        match self {
            ModuleProblem::Missing { .. } => Some(
                "a path is relative to the file that imports, or absolute; /home/ae/script/ is the script folder"
                    .into(),
            ),
            ModuleProblem::Encoding { .. } => Some("save the file as UTF-8".into()),
            ModuleProblem::ModuleName { .. } => {
                Some("use letters, digits and underscores, not beginning with a digit".into())
            }
            ModuleProblem::SameName { first, .. } => Some(format!("the other one is \"{first}\"; rename one of them")),
            _ => None,
        }
    }
}
