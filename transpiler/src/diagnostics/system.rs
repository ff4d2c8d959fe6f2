//! Values of system variables.

use super::Problem;
use super::declare::problems;
use arl_lang::catalog::Takes;

problems! {
    warning 912 "A value that a system variable does not take" =>
    /// A constant that a system variable does not accept.
    pub(crate) struct NotTaken {
        /// The variable's name, without `$`.
        pub(crate) variable: &'static str,
        /// The constant as written.
        pub(crate) value: String,
        /// The values that it accepts.
        pub(crate) takes: Takes,
    }
}

impl Problem for NotTaken {
    fn message(&self) -> String {
        format!("`${}` does not take {}: assigning it raises an alarm", self.variable, self.value)
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
