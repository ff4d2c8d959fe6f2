//! Files and modules.

use super::Problem;
use super::declare::problems;
use arl_lang::text::Mixed;

problems! {
    /// What is wrong with a file.
    pub(crate) enum ModuleProblem {
        error 601 "A file that does not exist" => {
            /// No such file.
            Missing { path: String },
        }
        error 602 "A file that cannot be read" => {
            /// A file that cannot be read.
            Unreadable { path: String, reason: String },
        }
        error 603 "A file of unknown encoding" => {
            /// A file that is neither UTF-8 nor GB18030.
            Encoding { path: String, offset: usize, utf16: bool },
            /// A file in which some lines are in one encoding and others in the other, and which cannot be read for
            /// that reason.
            UnreadableMixture { path: String, mixed: Mixed },
        }
        warning 923 "A file in two encodings" => {
            /// Lines in UTF-8 in a file that is read as GB18030.
            Mixture { mixed: Mixed },
        }
        error 604 "A file name that cannot name a module" => {
            /// A file name that cannot be used before `::`.
            ModuleName { path: String },
        }
        error 605 "Two modules of the same name" => {
            /// Two imported files with the same name.
            SameName { name: String, first: String },
        }
        error 606 "A function in a data file" => {
            /// A function in a data file.
            FunctionInData,
        }
    }
}

impl Problem for ModuleProblem {
    fn message(&self) -> String {
        match self {
            ModuleProblem::Missing { path } => format!("there is no file \"{path}\""),
            ModuleProblem::Unreadable { path, reason } => format!("the file \"{path}\" cannot be read: {reason}"),
            ModuleProblem::Encoding { path, utf16: true, .. } => format!("the file \"{path}\" is UTF-16"),
            ModuleProblem::Encoding { path, offset, .. } => {
                format!("the file \"{path}\" is neither UTF-8 nor GB18030 (byte {offset})")
            }
            ModuleProblem::UnreadableMixture { path, mixed } => {
                let Mixed { utf8, other } = mixed;
                format!("the file \"{path}\" is in two encodings: line {utf8} is UTF-8, line {other} is GBK (GB18030)")
            }
            ModuleProblem::Mixture { mixed } => {
                let Mixed { utf8, other } = mixed;
                format!("line {utf8} is UTF-8, but line {other} is GBK (GB18030): this text is read wrongly")
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
            ModuleProblem::Mixture { .. } | ModuleProblem::UnreadableMixture { .. } => Some(
                "a file has one encoding: retype these lines in an editor that is set to one, \
                 preferably to UTF-8, and save"
                    .into(),
            ),
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
