//! Functions, statements and their order.

use super::{Code, Problem};

/// What is wrong with a function or statement.
#[derive(Clone, PartialEq, Debug)]
pub(crate) enum FlowProblem {
    /// A program without `main`.
    NoMain,
    /// `main` with parameters or a result.
    MainSignature { what: &'static str },
    /// Two functions of one name.
    FunctionTwice { name: String },
    /// `return` without a value in a function that has a result.
    ReturnWithoutValue { result: String },
    /// `return` with a value in a void function.
    ReturnWithValue,
    /// `break` outside loops.
    BreakOutside { in_switch: bool },
    /// `continue` outside loops.
    ContinueOutside,
    /// Two cases with one value.
    CaseTwice { value: String },
    /// A case that is not constant.
    CaseNotConstant,
    /// A switch on a type that cannot be compared with constants.
    SwitchType { ty: String },
    /// A condition that waits or moves.
    ConditionWaits { culprit: String },
    /// A first motion that leaves open where it begins.
    FirstMotion { instruction: String, missing: String },
    /// Statements that cannot be reached.
    Unreachable,
    /// A variable that is never read.
    UnusedVariable { name: String },
    /// A label that no goto names.
    UnusedLabel { name: String },
    /// An imported module that is not used.
    UnusedImport { module: String },
    /// The end of a function with a result can be reached.
    MissingReturn { name: String, result: String },
    /// An expression whose value is thrown away and which does nothing.
    NoEffect,
}

impl Problem for FlowProblem {
    fn code(&self) -> Code {
        Code(match self {
            FlowProblem::NoMain => 501,
            FlowProblem::MainSignature { .. } => 502,
            FlowProblem::FunctionTwice { .. } => 503,
            FlowProblem::ReturnWithoutValue { .. } => 504,
            FlowProblem::ReturnWithValue => 505,
            FlowProblem::BreakOutside { .. } => 506,
            FlowProblem::ContinueOutside => 507,
            FlowProblem::CaseTwice { .. } => 508,
            FlowProblem::CaseNotConstant => 509,
            FlowProblem::SwitchType { .. } => 511,
            FlowProblem::ConditionWaits { .. } => 512,
            FlowProblem::FirstMotion { .. } => 513,
            FlowProblem::Unreachable => 901,
            FlowProblem::UnusedVariable { .. } => 902,
            FlowProblem::UnusedLabel { .. } => 903,
            FlowProblem::UnusedImport { .. } => 904,
            FlowProblem::MissingReturn { .. } => 905,
            FlowProblem::NoEffect => 906,
        })
    }

    fn message(&self) -> String {
        match self {
            FlowProblem::NoMain => "the program has no function `main`".into(),
            FlowProblem::MainSignature { what } => format!("`main` cannot have {what}"),
            FlowProblem::FunctionTwice { name } => format!("the function `{name}` is defined twice"),
            FlowProblem::ReturnWithoutValue { result } => {
                format!("this function returns a value of type {result}, but here is none")
            }
            FlowProblem::ReturnWithValue => "this function is void and returns no value".into(),
            FlowProblem::BreakOutside { .. } => "`break` stands outside any loop".into(),
            FlowProblem::ContinueOutside => "`continue` stands outside any loop".into(),
            FlowProblem::CaseTwice { value } => format!("the case {value} stands twice in this switch"),
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
                "what is not set keeps its start, and before the first motion no start is known: set all axes".into(),
            ),
            FlowProblem::MissingReturn { result, .. } => {
                Some(format!("it then returns the start value of {result}; write a `return` to say so"))
            }
            _ => None,
        }
    }
}
