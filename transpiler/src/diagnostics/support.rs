//! Features that are known but do not run on this robot or in the background.

use super::Problem;
use super::declare::problems;

problems! {
    /// A feature that is not supported.
    pub(crate) enum SupportProblem {
        error 702 "Something for the other kind of robot" => {
            /// Exists for the other robot family only.
            OtherFamily { name: String, family: &'static str },
            /// A parameter that exists for the other robot family only.
            ParameterOfOtherFamily { callee: String, parameter: String, family: &'static str },
        }
        error 703 "Something that arl2rs cannot make sense of" => {
            /// Something that the checker gave up on without a reason: a bug in the compiler.
            Lost,
        }
        error 704 "Something that needs a robot, in the background" => {
            /// Something that needs a robot, in a program for a background channel.
            Background { name: String },
        }
    }
}

impl Problem for SupportProblem {
    fn message(&self) -> String {
        match self {
            SupportProblem::Lost => "arl2rs could not make sense of this, and cannot say why".into(),
            SupportProblem::Background { name } => {
                format!("`{name}` needs a robot, which a background channel does not have")
            }
            SupportProblem::OtherFamily { name, family } => format!("`{name}` exists for {family} robots only"),
            SupportProblem::ParameterOfOtherFamily { callee, parameter, family } => {
                format!("`{callee}` has the parameter `{parameter}` for {family} robots only")
            }
        }
    }

    fn label(&self) -> String {
        String::new()
    }

    fn help(&self) -> Option<String> {
        match self {
            SupportProblem::Lost => {
                Some("this is a bug in arl2rs, not in the program: please report it together with the program".into())
            }
            SupportProblem::Background { .. } => {
                Some("let a foreground channel do it, and signal it through io, `$I` or `$B`".into())
            }
            SupportProblem::OtherFamily { .. } => Some("name the robot that the program is for with `--robot`".into()),
            SupportProblem::ParameterOfOtherFamily { .. } => {
                Some("leave it out, or name the robot that the program is for with `--robot`".into())
            }
        }
    }
}
