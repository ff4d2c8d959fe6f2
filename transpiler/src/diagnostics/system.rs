//! Values of system variables.

use super::{Code, Problem};
use arl_lang::catalog::Takes;

/// A constant that a system variable does not take.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct NotTaken {
    /// The variable's name, without `$`.
    pub(crate) variable: &'static str,
    /// The constant as it is written.
    pub(crate) value: String,
    /// What it takes.
    pub(crate) takes: Takes,
}

impl Problem for NotTaken {
    fn code(&self) -> Code {
        Code(912)
    }

    fn message(&self) -> String {
        format!("`${}` does not take {}: an alarm when it is assigned", self.variable, self.value)
    }

    fn label(&self) -> String {
        String::new()
    }

    fn help(&self) -> Option<String> {
        match self.takes {
            Takes::All => None,
            Takes::Range(low, high) => Some(format!("it takes {low} to {high}")),
            Takes::Words(words) => {
                let words: Vec<String> = words.iter().map(|word| format!("\"{word}\"")).collect();
                Some(format!("it takes {}", words.join(", ")))
            }
        }
    }
}
