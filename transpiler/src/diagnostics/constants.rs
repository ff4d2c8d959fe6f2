//! Constant expressions that cannot be computed, and code that goes beyond the manual.

use super::Problem;
use super::declare::problems;

problems! {
    /// What is wrong with a constant.
    pub(crate) enum ConstantProblem {
        error 801 "A constant division by zero" => {
            /// Division by a constant zero.
            DivideByZero,
        }
        error 802 "A constant shift out of range" => {
            /// A constant shift count outside the width.
            ShiftCount { count: i64, most: u32 },
        }
        error 803 "A constant index out of range" => {
            /// A constant index outside the array.
            Index { index: i64, size: u32 },
        }
        error 804 "A constant that depends on itself" => {
            /// A constant that depends on itself.
            Circular { name: String },
        }
        warning 851 "A constant expression that wraps" => {
            /// A constant expression that wraps.
            Overflow { ty: &'static str, value: String },
        }
        warning 852 "A double divided by zero" => {
            /// A double divided by a literal zero.
            DoubleByZero,
        }
        warning 951 "A name written in another case than declared" => {
            /// A name written in another case than declared.
            OtherCase { declared: String },
        }
        warning 952 "A conversion that is not in the manual" => {
            /// A conversion that the controller does not support.
            ExtendedConversion { from: String, to: String },
        }
        warning 953 "A form that is not in the manual" => {
            /// A spelling or form that the manual does not describe.
            Extended { what: String },
        }
    }
}

impl Problem for ConstantProblem {
    fn message(&self) -> String {
        match self {
            ConstantProblem::DivideByZero => "division by zero".into(),
            ConstantProblem::ShiftCount { count, .. } => format!("a shift by {count} is out of range"),
            ConstantProblem::Index { index, size } => format!("index {index} is outside the array of {size} elements"),
            ConstantProblem::Circular { name } => format!("the value of `{name}` depends on itself"),
            ConstantProblem::Overflow { ty, value } => format!("this is beyond {ty} and wraps to {value}"),
            ConstantProblem::DoubleByZero => "division by zero gives inf or nan".into(),
            ConstantProblem::OtherCase { declared } => format!("this is declared as `{declared}`"),
            ConstantProblem::ExtendedConversion { from, to } => {
                format!("the controller does not convert {from} to {to} by itself")
            }
            ConstantProblem::Extended { what } => format!("the manual does not mention {what}"),
        }
    }

    fn label(&self) -> String {
        String::new()
    }

    fn help(&self) -> Option<String> {
        match self {
            ConstantProblem::ShiftCount { most, .. } => Some(format!("0 to {most} is possible here")),
            ConstantProblem::Index { size, .. } => {
                Some(format!("indices begin with 0, so 0 to {} are valid", size.saturating_sub(1)))
            }
            _ => None,
        }
    }

    fn fix(&self) -> Option<String> {
        match self {
            ConstantProblem::OtherCase { declared } => Some(declared.clone()),
            _ => None,
        }
    }
}
