//! What is known but does not run on this robot, or in the background.

use super::{Code, Problem};

/// What is not supported.
#[derive(Clone, PartialEq, Debug)]
pub(crate) enum SupportProblem {
    /// Something that the checker gave up on without a reason: a mistake of the compiler.
    Lost,
    /// Exists for the other robot family only.
    OtherFamily { name: String, family: &'static str },
    /// Needs a robot, in a program for a background channel.
    Background { name: String },
}

impl Problem for SupportProblem {
    fn code(&self) -> Code {
        Code(match self {
            SupportProblem::OtherFamily { .. } => 702,
            SupportProblem::Lost => 703,
            SupportProblem::Background { .. } => 704,
        })
    }

    fn message(&self) -> String {
        match self {
            SupportProblem::Lost => "arl2rs could not make sense of this, and cannot say why".into(),
            SupportProblem::Background { name } => {
                format!("`{name}` needs a robot, which a background channel does not have")
            }
            SupportProblem::OtherFamily { name, family } => format!("`{name}` exists for {family} robots only"),
        }
    }

    fn label(&self) -> String {
        String::new()
    }

    fn help(&self) -> Option<String> {
        match self {
            SupportProblem::Lost => Some(
                "this is a mistake of arl2rs, not of the program: please report it together with the program".into(),
            ),
            SupportProblem::Background { .. } => {
                Some("let a foreground channel do it, and tell it by io, `$I` or `$B`".into())
            }
            SupportProblem::OtherFamily { .. } => Some("name the robot that the program is for with `--robot`".into()),
        }
    }
}
