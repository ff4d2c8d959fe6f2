//! Declares the diagnostics of an area: `problems!` takes variant, code, severity and title together, and embeds the
//! page.

use super::{Code, Severity};

/// The information about a code that is independent of a program.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct CodeInfo {
    /// The number.
    pub code: Code,
    /// Error or warning.
    pub severity: Severity,
    /// A short text, the title of the page.
    pub title: &'static str,
    /// The text of the page.
    #[cfg(feature = "tools")]
    pub page: &'static str,
}

/// The [`CodeInfo`] of a code: `error 201 "title"`.
macro_rules! code_info {
    (error $number:literal $title:literal) => {
        $crate::diagnostics::declare::code_info!(@Error $number $title)
    };
    (warning $number:literal $title:literal) => {
        $crate::diagnostics::declare::code_info!(@Warning $number $title)
    };
    (@$severity:ident $number:literal $title:literal) => {
        $crate::diagnostics::CodeInfo {
            code: $crate::diagnostics::Code($number),
            severity: $crate::diagnostics::Severity::$severity,
            title: $title,
            #[cfg(feature = "tools")]
            page: include_str!(concat!("../../docs/diagnostics/ARL0", $number, ".md")),
        }
    };
}

/// Declares the problems of an area: an enum whose variants are listed under their codes, or a struct with one code.
///
/// ```text
/// problems! {
///     /// What is wrong with a file.
///     pub(crate) enum ModuleProblem {
///         error 601 "A file that does not exist" => {
///             /// No such file.
///             Missing { path: String },
///         }
///     }
/// }
/// ```
///
/// A number is never reused. The texts (message, label, help) follow in `impl Problem`.
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
            &[$($crate::diagnostics::declare::code_info!($severity $number $title)),+];

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
            &[$crate::diagnostics::declare::code_info!($severity $number $title)];

        impl $crate::diagnostics::Coded for $name {
            fn code(&self) -> $crate::diagnostics::Code {
                $crate::diagnostics::Code($number)
            }
        }
    };
}

pub(super) use {code_info, problems};
