//! Arguments that do not fit their instruction or function.

use super::{Code, Problem};
use arl_lang::catalog::Range;

/// What is wrong with an argument.
#[derive(Clone, PartialEq, Debug)]
pub(crate) enum ArgumentProblem {
    /// More arguments than parameters.
    TooMany { callee: String, most: usize },
    /// A parameter that must be there.
    Missing { callee: String, parameter: String, signature: String },
    /// A label that the callee does not have.
    UnknownLabel { callee: String, label: String, labels: String, near: Option<String> },
    /// A parameter that got two values.
    Twice { parameter: String },
    /// Two parameters that exclude each other.
    Exclusive { first: String, second: String },
    /// A bare value that no free parameter takes.
    NoParameter { callee: String, ty: String, labels: String },
    /// Bare braces.
    BareBrace { callee: String, labels: String },
    /// A value where a variable is written.
    NotAVariable { callee: String, parameter: String },
    /// A unit that the parameter does not have.
    WrongUnit { parameter: String, unit: &'static str, units: String },
    /// A unit behind something that is not a number.
    UnitOfNoNumber,
    /// A constant outside the parameter's range.
    Range { parameter: String, value: String, range: Range },
    /// 9e+09 for a parameter that takes numbers that are set.
    NotSet { parameter: String },
    /// A constant length that the array beside it does not have, which has so many bytes.
    Length { parameter: String, value: i64, bytes: usize, most: i64 },
    /// A name that is none of a system variable that can be saved.
    NotKept { name: String, near: Option<String> },
    /// No overload takes these types.
    NoOverload { callee: String, types: String, signatures: String },
    /// Events behind an instruction that is not a motion.
    Events { callee: String },
}

impl Problem for ArgumentProblem {
    fn code(&self) -> Code {
        Code(match self {
            ArgumentProblem::TooMany { .. } => 401,
            ArgumentProblem::Missing { .. } => 402,
            ArgumentProblem::UnknownLabel { .. } => 403,
            ArgumentProblem::Twice { .. } => 404,
            ArgumentProblem::Exclusive { .. } => 405,
            ArgumentProblem::NoParameter { .. } => 406,
            ArgumentProblem::BareBrace { .. } => 407,
            ArgumentProblem::NotAVariable { .. } => 408,
            ArgumentProblem::WrongUnit { .. } => 409,
            ArgumentProblem::UnitOfNoNumber => 410,
            ArgumentProblem::Range { .. } | ArgumentProblem::NotSet { .. } => 411,
            ArgumentProblem::NoOverload { .. } => 412,
            ArgumentProblem::Events { .. } => 413,
            ArgumentProblem::Length { .. } => 414,
            ArgumentProblem::NotKept { .. } => 415,
        })
    }

    fn message(&self) -> String {
        match self {
            ArgumentProblem::TooMany { callee, most } => {
                format!(
                    "too many arguments: `{callee}` takes {}",
                    match most {
                        0 => "none".into(),
                        most => format!("at most {most}"),
                    }
                )
            }
            ArgumentProblem::Missing { callee, parameter, .. } => format!("`{callee}` needs its `{parameter}`"),
            ArgumentProblem::UnknownLabel { callee, label, .. } => {
                format!("`{callee}` has no parameter `{label}`")
            }
            ArgumentProblem::Twice { parameter } => format!("`{parameter}` is given twice"),
            ArgumentProblem::Exclusive { first, second } => {
                format!("`{first}` and `{second}` exclude each other")
            }
            ArgumentProblem::NoParameter { callee, ty, .. } => {
                format!("no free parameter of `{callee}` takes a value of type {ty}")
            }
            ArgumentProblem::BareBrace { callee, .. } => {
                format!("braces need the label of the parameter of `{callee}` that they are for")
            }
            ArgumentProblem::NotAVariable { callee, parameter } => {
                format!("`{callee}` writes to its `{parameter}`, so that must be a variable")
            }
            ArgumentProblem::WrongUnit { parameter, unit, .. } => {
                format!("`{parameter}` is not given in {unit}")
            }
            ArgumentProblem::UnitOfNoNumber => "a unit may follow a number only".into(),
            ArgumentProblem::Range { parameter, value, range } => {
                format!("`{parameter}` is {value}, but must be {range}")
            }
            ArgumentProblem::NotSet { parameter } => {
                format!("`{parameter}` is 9e+09, which stands for a value that was not set")
            }
            ArgumentProblem::Length { parameter, value, bytes: 1, .. } => {
                format!("`{parameter}` is {value}, but the array has 1 byte")
            }
            ArgumentProblem::Length { parameter, value, bytes, .. } => {
                format!("`{parameter}` is {value}, but the array has {bytes} bytes")
            }
            ArgumentProblem::NotKept { name, .. } => format!("\"{name}\" is no system variable that can be saved"),
            ArgumentProblem::NoOverload { callee, types, .. } => {
                format!("`{callee}` does not take ({types})")
            }
            ArgumentProblem::Events { callee } => format!("`{callee}` is not a motion, so no events can follow it"),
        }
    }

    fn label(&self) -> String {
        match self {
            ArgumentProblem::NoParameter { ty, .. } => format!("this is {ty}"),
            _ => String::new(),
        }
    }

    fn help(&self) -> Option<String> {
        match self {
            ArgumentProblem::Missing { signature, .. } => Some(format!("it is written `{signature}`")),
            ArgumentProblem::UnknownLabel { near: Some(near), .. } => Some(format!("did you mean `{near}`?")),
            ArgumentProblem::UnknownLabel { labels, .. } if labels.is_empty() => Some("it takes no arguments".into()),
            ArgumentProblem::UnknownLabel { labels, .. } => Some(format!("its parameters are {labels}")),
            ArgumentProblem::NoParameter { labels, .. } if labels.is_empty() => None,
            ArgumentProblem::NoParameter { labels, .. } => Some(format!("still free are {labels}")),
            ArgumentProblem::BareBrace { labels, .. } => Some(format!("write the label first: {labels}")),
            ArgumentProblem::WrongUnit { units, .. } if units.is_empty() => Some("it has no unit".into()),
            ArgumentProblem::WrongUnit { units, .. } => Some(format!("write {units}, or no unit")),
            ArgumentProblem::NoOverload { signatures, .. } => Some(format!("it takes {signatures}")),
            ArgumentProblem::Length { most: 0, .. } => Some("only 0 is possible".into()),
            ArgumentProblem::Length { most, .. } => Some(format!("0 to {most} are possible")),
            ArgumentProblem::Exclusive { .. } => Some("give one of them".into()),
            ArgumentProblem::NotKept { near: Some(near), .. } => Some(format!("did you mean \"{near}\"?")),
            ArgumentProblem::NotKept { near: None, .. } => Some(
                "those of chapter 10.1 can be saved, such as \"I\" and \"TOOLS\", and the settings of chapter 9".into(),
            ),
            ArgumentProblem::NotSet { parameter } => Some(format!("give a number, or leave `{parameter}` out")),
            _ => None,
        }
    }
}
