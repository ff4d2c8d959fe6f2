//! Arguments that do not fit their instruction or function.

use super::Problem;
use super::declare::problems;
use arl_lang::catalog::Range;

problems! {
    /// What is wrong with an argument.
    pub(crate) enum ArgumentProblem {
        error 401 "Too many arguments" => {
            /// More arguments than parameters.
            TooMany { callee: String, most: usize },
        }
        error 402 "A mandatory argument is missing" => {
            /// A parameter that must be there.
            /// `instead`: what was written in its place, if known.
            Missing { callee: String, parameter: String, signature: String, instead: Option<String> },
        }
        error 403 "A label that is not known" => {
            /// A label that the callee does not have.
            /// `meant`: the labels that correspond to this label of another language.
            UnknownLabel { callee: String, label: String, labels: String, near: Option<String>, meant: String },
        }
        error 404 "An argument given twice" => {
            /// A parameter with two values.
            Twice { parameter: String },
        }
        error 405 "Arguments that exclude each other" => {
            /// Two parameters that exclude each other.
            Exclusive { first: String, second: String },
        }
        error 406 "An argument that no parameter takes" => {
            /// A bare value that no free parameter accepts. `other`: something similar to the callee that accepts a
            /// value of this type, if there is one.
            NoParameter { callee: String, ty: String, labels: String, other: Option<String> },
        }
        error 407 "Braces without a label" => {
            /// Bare braces.
            BareBrace { callee: String, labels: String },
        }
        error 408 "A value where a variable is needed" => {
            /// A value where a variable is needed.
            NotAVariable { callee: String, parameter: String },
        }
        error 409 "A wrong unit" => {
            /// A unit that the parameter does not have.
            WrongUnit { parameter: String, unit: &'static str, units: String },
        }
        error 410 "A unit after something that is not a number" => {
            /// A unit after something that is not a number.
            UnitOfNoNumber,
        }
        error 411 "A constant argument out of range" => {
            /// A constant outside the parameter's range.
            Range { parameter: String, value: String, range: Range },
            /// 9e+09 for a parameter that accepts only numbers that are set.
            NotSet { parameter: String },
        }
        error 412 "Argument types that the function does not take" => {
            /// No overload accepts these types.
            NoOverload { callee: String, types: String, signatures: String },
        }
        error 413 "Events after something that is not a motion" => {
            /// Events after an instruction that is not a motion.
            Events { callee: String },
        }
        error 414 "A length that does not fit the array" => {
            /// A constant length that does not fit the given array, whose size is `bytes`.
            Length { parameter: String, value: i64, bytes: usize, most: i64 },
        }
        error 415 "A system variable that cannot be saved" => {
            /// A name that does not belong to a system variable that can be saved.
            NotKept { name: String, near: Option<String> },
        }
        error 416 "A label with an equals sign" => {
            /// `=` instead of a colon after a label.
            EqualsBehindLabel { label: String, value: String },
        }
    }
}

impl Problem for ArgumentProblem {
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
            ArgumentProblem::EqualsBehindLabel { label, .. } => {
                format!("`:` follows the label `{label}`, not `=`")
            }
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
                format!("`{callee}` writes to its `{parameter}`, so it must be a variable")
            }
            ArgumentProblem::WrongUnit { parameter, unit, .. } => {
                format!("`{parameter}` is not given in {unit}")
            }
            ArgumentProblem::UnitOfNoNumber => "a unit can only follow a number".into(),
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
            ArgumentProblem::NotKept { name, .. } => format!("\"{name}\" is not a system variable that can be saved"),
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
            ArgumentProblem::Missing { instead: Some(instead), .. } => Some(instead.clone()),
            ArgumentProblem::EqualsBehindLabel { label, value } => Some(format!("write `{label}:{value}`")),
            ArgumentProblem::UnknownLabel { meant, .. } if !meant.is_empty() => Some(format!("did you mean {meant}?")),
            ArgumentProblem::Missing { signature, .. } => Some(format!("it is written `{signature}`")),
            ArgumentProblem::UnknownLabel { near: Some(near), .. } => Some(format!("did you mean `{near}`?")),
            ArgumentProblem::UnknownLabel { labels, .. } if labels.is_empty() => Some("it takes no arguments".into()),
            ArgumentProblem::UnknownLabel { labels, .. } => Some(format!("its parameters are {labels}")),
            ArgumentProblem::NoParameter { other: Some(other), .. } => Some(other.clone()),
            ArgumentProblem::NoParameter { labels, .. } if labels.is_empty() => None,
            ArgumentProblem::NoParameter { labels, .. } => Some(format!("parameters still free: {labels}")),
            ArgumentProblem::BareBrace { labels, .. } => Some(format!("write the label first: {labels}")),
            ArgumentProblem::WrongUnit { units, .. } if units.is_empty() => Some("it has no unit".into()),
            ArgumentProblem::WrongUnit { units, .. } => Some(format!("write {units}, or no unit")),
            ArgumentProblem::NoOverload { signatures, .. } => Some(format!("it takes {signatures}")),
            ArgumentProblem::Length { most: 0, .. } => Some("only 0 is possible".into()),
            ArgumentProblem::Length { most, .. } => Some(format!("0 to {most} are possible")),
            ArgumentProblem::Exclusive { .. } => Some("give one of them".into()),
            ArgumentProblem::NotKept { near: Some(near), .. } => Some(format!("did you mean \"{near}\"?")),
            ArgumentProblem::NotKept { near: None, .. } => Some(
                "the variables of chapter 10.1 of the manual can be saved, such as \"I\" and \"TOOLS\", and the settings of chapter 9".into(),
            ),
            ArgumentProblem::NotSet { parameter } => Some(format!("give a number, or leave `{parameter}` out")),
            _ => None,
        }
    }

    fn fix(&self) -> Option<String> {
        match self {
            ArgumentProblem::UnknownLabel { near: Some(near), .. } => Some(near.clone()),
            ArgumentProblem::EqualsBehindLabel { label, value } => Some(format!("{label}:{value}")),
            _ => None,
        }
    }
}
