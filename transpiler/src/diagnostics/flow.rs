//! Functions, statements and their order.

use super::Problem;
use super::declare::problems;

problems! {
    /// What is wrong with a function or statement.
    pub(crate) enum FlowProblem {
        error 501 "A program without main" => {
            /// A program without `main`.
            NoMain,
        }
        error 502 "A main with parameters or a result" => {
            /// `main` with parameters or a result.
            MainSignature { what: &'static str },
        }
        error 503 "A function defined twice" => {
            /// Two functions with the same name.
            FunctionTwice { name: String },
        }
        error 504 "A return without a value" => {
            /// `return` without a value in a function that has a result.
            ReturnWithoutValue { result: String },
        }
        error 505 "A return with a value in a void function" => {
            /// `return` with a value in a void function.
            ReturnWithValue,
        }
        error 506 "A break outside of loops" => {
            /// `break` outside loops.
            BreakOutside { in_switch: bool },
        }
        error 507 "A continue outside of loops" => {
            /// `continue` outside loops.
            ContinueOutside,
        }
        error 508 "A case value that appears twice" => {
            /// Two cases with the same value.
            CaseTwice { value: String },
        }
        error 509 "A case value that is not constant" => {
            /// A case that is not constant.
            CaseNotConstant,
        }
        error 511 "A switch on a type that it cannot compare" => {
            /// A switch on a type that cannot be compared with constants.
            SwitchType { ty: String },
        }
        error 512 "A condition that waits or moves" => {
            /// A condition that waits or moves.
            ConditionWaits { culprit: String },
        }
        error 513 "A first motion whose target is not fully set" => {
            /// A first motion that does not fully determine its target.
            FirstMotion { instruction: String, missing: String },
        }
        warning 901 "Statements that are never reached" => {
            /// Statements that cannot be reached.
            Unreachable,
        }
        warning 902 "A variable that is never read" => {
            /// A variable that is never read.
            UnusedVariable { name: String },
        }
        warning 903 "A label that is never used" => {
            /// A label that no goto names.
            UnusedLabel { name: String },
        }
        warning 904 "An import that is never used" => {
            /// An imported module that is not used.
            UnusedImport { module: String },
        }
        warning 905 "The end of a function reached without return" => {
            /// The end of a function with a result can be reached.
            MissingReturn { name: String, result: String },
        }
        warning 906 "A value that is not used" => {
            /// An expression that has no effect and whose value is discarded.
            NoEffect,
        }
    }
}

impl Problem for FlowProblem {
    fn message(&self) -> String {
        match self {
            FlowProblem::NoMain => "the program has no function `main`".into(),
            FlowProblem::MainSignature { what } => format!("`main` cannot have {what}"),
            FlowProblem::FunctionTwice { name } => format!("the function `{name}` is defined twice"),
            FlowProblem::ReturnWithoutValue { result } => {
                format!("this function returns a value of type {result}, but none is given here")
            }
            FlowProblem::ReturnWithValue => "this function is void and returns no value".into(),
            FlowProblem::BreakOutside { .. } => "`break` is outside any loop".into(),
            FlowProblem::ContinueOutside => "`continue` is outside any loop".into(),
            FlowProblem::CaseTwice { value } => format!("the case {value} appears twice in this switch"),
            FlowProblem::CaseNotConstant => "the value of a case must be constant".into(),
            FlowProblem::SwitchType { ty } => format!("a switch cannot compare values of type {ty}"),
            FlowProblem::ConditionWaits { culprit } => {
                format!("a condition may not wait or move, but `{culprit}` does")
            }
            FlowProblem::FirstMotion { instruction, missing } => {
                format!("the first motion of the program, this `{instruction}`, does not set {missing}")
            }
            FlowProblem::Unreachable => "this is never reached".into(),
            FlowProblem::UnusedVariable { name } => format!("the variable `{name}` is never read"),
            FlowProblem::UnusedLabel { name } => format!("no `goto` names the label `{name}`"),
            FlowProblem::UnusedImport { module } => format!("nothing of the module `{module}` is used"),
            FlowProblem::MissingReturn { name, .. } => {
                format!("the end of `{name}` can be reached without a `return`")
            }
            FlowProblem::NoEffect => "this value is not used for anything".into(),
        }
    }

    fn label(&self) -> String {
        match self {
            FlowProblem::FunctionTwice { .. } => "defined again here".into(),
            _ => String::new(),
        }
    }

    fn help(&self) -> Option<String> {
        match self {
            FlowProblem::NoMain => Some("a program starts at `func void main()`".into()),
            FlowProblem::MainSignature { .. } => Some("write `func void main()`".into()),
            FlowProblem::FunctionTwice { .. } => {
                Some("functions cannot be overloaded: give one of them another name".into())
            }
            FlowProblem::ReturnWithoutValue { .. } => Some("write `return value`".into()),
            FlowProblem::BreakOutside { in_switch: true } => {
                Some("a case ends by itself at the next one: no `break` is needed".into())
            }
            FlowProblem::SwitchType { .. } => {
                Some("int, byte, uint, bool, string and enumerations can be compared".into())
            }
            FlowProblem::ConditionWaits { .. } => Some("a condition may read inputs and compute".into()),
            FlowProblem::FirstMotion { .. } => Some(
                "a component that is not set keeps its start value, and before the first motion none is known: set all of them".into(),
            ),
            FlowProblem::MissingReturn { result, .. } => {
                Some(format!("it then returns the start value of {result}; write a `return` to say so"))
            }
            _ => None,
        }
    }
}
