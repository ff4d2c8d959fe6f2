//! The table of all diagnostics: code, severity, title and page of each kind.
//!
//! Each area declares its own diagnostics with `problems!`. Syntax errors are declared in `arl-lang`. This file only
//! joins them. The page of a code is `transpiler/docs/diagnostics/ARLnnnn.md`. The compiler embeds it for
//! `arl2rs explain`, so a code without a page does not compile: "couldn't read ... ARLnnnn.md" asks for that file. Its
//! parts are
//!
//! ```text
//! # ARLnnnn: the title as it is declared
//!
//! What is wrong, why, and what to do: 20 words or more.
//!
//! ## Wrong
//!
//! (a block ```arl with a program that raises this code and nothing else)
//!
//! ## Right
//!
//! (a block ```arl with a program that raises nothing)
//! ```
//!
//! and `cargo test --workspace --test pages` runs both programs.

use super::Code;
use super::declare::{CodeInfo, code_info};
use std::sync::LazyLock;

/// The syntax errors; none of them is a warning.
macro_rules! syntax {
    ($($number:literal $title:literal)+) => {
        &[$(code_info!(error $number $title)),+]
    };
}

/// The areas. Those behind the feature `tools` need a robot or a cell, which are available only to the command and to
/// editors.
const AREAS: &[&[CodeInfo]] = &[
    arl_lang::each_syntax_code!(syntax),
    super::names::CODES,
    super::types::CODES,
    super::arguments::CODES,
    super::flow::CODES,
    super::doubts::CODES,
    super::modules::CODES,
    super::support::CODES,
    super::constants::CODES,
    super::components::CODES,
    super::system::CODES,
    #[cfg(feature = "tools")]
    super::channels::CODES,
    #[cfg(feature = "tools")]
    super::connections::CODES,
    #[cfg(feature = "tools")]
    super::targets::CODES,
];

static ALL: LazyLock<Vec<CodeInfo>> = LazyLock::new(|| {
    let mut all = AREAS.concat();
    all.sort_unstable_by_key(|info| info.code);
    all
});

/// All codes in ascending order.
pub fn registry() -> &'static [CodeInfo] {
    &ALL
}

/// The information about a code.
pub fn info(code: Code) -> Option<&'static CodeInfo> {
    let at = ALL.binary_search_by_key(&code, |info| info.code).ok()?;
    ALL.get(at)
}
