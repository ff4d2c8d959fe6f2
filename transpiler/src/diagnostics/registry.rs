//! The table of all diagnostics: code, severity, title and page of each kind.
//!
//! Each area declares its own with `problems!`. The mistakes of the syntax are declared in `arl-lang`. This file only
//! joins them. The page of a code is `docs/diagnostics/ARLnnnn.md`. The compiler embeds it for `arl2rs explain`, so a
//! code without a page does not compile: "couldn't read ... ARLnnnn.md" asks for that file. Its parts are
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
//! and `cargo test -p arl2rs --test pages` runs both programs.

use super::{Code, Severity};
use std::sync::LazyLock;

/// What is known of a code without a program.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct CodeInfo {
    /// The number.
    pub code: Code,
    /// Error or warning.
    pub severity: Severity,
    /// A few words, the page's title.
    pub title: &'static str,
    /// The text of the page.
    #[cfg(feature = "cli")]
    pub page: &'static str,
}

/// The [`CodeInfo`] of a code: `error 201 "title"`.
macro_rules! code_info {
    (error $number:literal $title:literal) => {
        $crate::diagnostics::registry::code_info!(@Error $number $title)
    };
    (warning $number:literal $title:literal) => {
        $crate::diagnostics::registry::code_info!(@Warning $number $title)
    };
    (@$severity:ident $number:literal $title:literal) => {
        $crate::diagnostics::CodeInfo {
            code: $crate::diagnostics::Code($number),
            severity: $crate::diagnostics::Severity::$severity,
            title: $title,
            #[cfg(feature = "cli")]
            page: include_str!(concat!("../../../docs/diagnostics/ARL0", $number, ".md")),
        }
    };
}

/// Declares the problems of an area: an enum whose variants stand under their codes, or a struct with one code.
///
/// ```text
/// problems! {
///     /// What is wrong with a file.
///     pub(crate) enum ModuleProblem {
///         error 601 "A file that is not there" => {
///             /// No such file.
///             Missing { path: String },
///         }
///     }
/// }
/// ```
///
/// A number that was given once is never given again. The words (message, label, help) follow in `impl Problem`.
macro_rules! problems {
    (
        $(#[doc = $doc:literal])+
        $vis:vis enum $name:ident {
            $($severity:ident $number:literal $title:literal => {
                $($(#[doc = $about:literal])+ $variant:ident $({ $($fields:tt)* })?,)+
            })+
        }
    ) => {
        $(#[doc = $doc])+
        #[derive(Clone, PartialEq, Debug)]
        $vis enum $name {
            $($($(#[doc = $about])+ $variant $({ $($fields)* })?,)+)+
        }

        /// The codes of this area.
        pub(super) const CODES: &[$crate::diagnostics::CodeInfo] =
            &[$($crate::diagnostics::registry::code_info!($severity $number $title)),+];

        impl $crate::diagnostics::Coded for $name {
            fn code(&self) -> $crate::diagnostics::Code {
                $crate::diagnostics::Code(match self {
                    $($(Self::$variant { .. })|+ => $number,)+
                })
            }
        }
    };
    (
        $severity:ident $number:literal $title:literal =>
        $(#[doc = $doc:literal])+
        $vis:vis struct $name:ident { $($fields:tt)* }
    ) => {
        $(#[doc = $doc])+
        #[derive(Clone, PartialEq, Debug)]
        $vis struct $name { $($fields)* }

        /// The codes of this area.
        pub(super) const CODES: &[$crate::diagnostics::CodeInfo] =
            &[$crate::diagnostics::registry::code_info!($severity $number $title)];

        impl $crate::diagnostics::Coded for $name {
            fn code(&self) -> $crate::diagnostics::Code {
                $crate::diagnostics::Code($number)
            }
        }
    };
}

pub(super) use {code_info, problems};

/// The mistakes of the syntax, all of them errors.
macro_rules! syntax {
    ($($number:literal $title:literal)+) => {
        &[$(code_info!(error $number $title)),+]
    };
}

/// The areas. Those behind the feature `cli` need a robot or a cell, which only the command knows.
const AREAS: &[&[CodeInfo]] = &[
    arl_lang::each_syntax_code!(syntax),
    super::names::CODES,
    super::types::CODES,
    super::arguments::CODES,
    super::flow::CODES,
    super::modules::CODES,
    super::support::CODES,
    super::constants::CODES,
    super::components::CODES,
    super::system::CODES,
    #[cfg(feature = "cli")]
    super::channels::CODES,
    #[cfg(feature = "cli")]
    super::connections::CODES,
    #[cfg(feature = "cli")]
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

/// What is known of this code.
pub fn info(code: Code) -> Option<&'static CodeInfo> {
    let at = ALL.binary_search_by_key(&code, |info| info.code).ok()?;
    ALL.get(at)
}
