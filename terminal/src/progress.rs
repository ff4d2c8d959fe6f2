//! A progress indicator on the terminal for long operations.

use crate::show;
use indicatif::{ProgressBar, ProgressStyle};
use std::time::Duration;

/// A spinner with a text; removed when dropped. Nothing is shown unless standard error is a terminal.
pub struct Progress(Option<ProgressBar>);

impl Progress {
    /// Shows the spinner.
    pub fn start(words: &str) -> Self {
        if !show::is_watched() {
            return Self(None);
        }
        let bar = ProgressBar::new_spinner().with_message(words.to_string());
        if let Ok(style) = ProgressStyle::with_template("{spinner} {msg} {elapsed:.dim}") {
            bar.set_style(style);
        }
        bar.enable_steady_tick(Duration::from_millis(100));
        Self(Some(bar))
    }

    /// Changes the text.
    pub fn say(&self, words: &str) {
        if let Some(bar) = &self.0 {
            bar.set_message(words.to_string());
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(bar) = &self.0 {
            bar.finish_and_clear();
        }
    }
}
