//! The diagnostics of the compiler: codes, positions, texts.

pub(crate) mod arguments;
#[cfg(feature = "tools")]
pub(crate) mod channels;
pub(crate) mod components;
#[cfg(feature = "tools")]
pub(crate) mod connections;
pub(crate) mod constants;
mod declare;
pub(crate) mod doubts;
pub(crate) mod flow;
pub(crate) mod modules;
pub(crate) mod names;
mod registry;
pub(crate) mod support;
pub(crate) mod system;
#[cfg(feature = "tools")]
pub(crate) mod targets;
pub(crate) mod types;

pub use declare::CodeInfo;
pub use registry::{info, registry};

use arl_lang::span::{LineIndex, Span};

/// Index of a file in [`Files`].
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct FileId(pub u32);

/// A span in a file.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct Location {
    /// The file.
    pub file: FileId,
    /// The byte range in the file.
    pub span: Span,
}

/// A source file of a compilation.
#[derive(Debug)]
pub struct SourceFile {
    /// The path as shown: as the user gave it, or relative to the main file's folder.
    pub name: String,
    /// The decoded text.
    pub text: String,
    /// The positions of its lines.
    pub lines: LineIndex,
}

/// All files of a compilation in the order in which they were read; the main file is the first.
#[derive(Default, Debug)]
pub struct Files {
    files: Vec<SourceFile>,
}

impl Files {
    /// Adds a file.
    pub fn add(&mut self, name: String, text: String) -> FileId {
        let lines = LineIndex::new(&text);
        self.files.push(SourceFile { name, text, lines });
        FileId(self.files.len() as u32 - 1)
    }

    /// The file with this number.
    pub fn get(&self, id: FileId) -> Option<&SourceFile> {
        self.files.get(id.0 as usize)
    }

    /// All files with their numbers.
    pub fn iter(&self) -> impl Iterator<Item = (FileId, &SourceFile)> {
        self.files.iter().enumerate().map(|(at, file)| (FileId(at as u32), file))
    }

    /// The 1-based line of the start of a location.
    pub fn line(&self, location: Location) -> u32 {
        self.get(location.file).map_or(0, |file| file.lines.line(location.span.start))
    }
}

/// The maximum number of names that a message lists.
const MOST_LISTED: usize = 20;

/// Names for a message; if there are many, only the number of the last ones is given.
pub(crate) fn listed(names: impl ExactSizeIterator<Item = impl Into<String>>) -> String {
    let more = names.len().saturating_sub(MOST_LISTED);
    let shown: Vec<String> = names.take(MOST_LISTED).map(Into::into).collect();
    let rest = if more > 0 { format!(" and {more} more") } else { String::new() };
    shown.join(", ") + &rest
}

/// How severe a diagnostic is.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Severity {
    /// The program runs, but not as its author may think.
    Warning,
    /// The program is refused.
    Error,
}

/// The number of a kind of diagnostic, shown as `ARL0203`.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Code(pub u16);

impl Code {
    /// Whether it is a syntax error: something could not be read.
    pub(crate) fn is_of_syntax(self) -> bool {
        (100..200).contains(&self.0)
    }
}

impl std::fmt::Display for Code {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "ARL{:04}", self.0)
    }
}

/// A position with a short text.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Label {
    /// The position.
    pub at: Location,
    /// The text; may be empty.
    pub text: String,
}

/// A change of the text that would correct the error.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Fix {
    /// What to replace.
    pub at: Location,
    /// The replacement.
    pub text: String,
}

/// An error or a warning.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Diagnostic {
    /// Its kind.
    pub code: Code,
    /// Error or warning.
    pub severity: Severity,
    /// What is wrong, in the terms of the program.
    pub message: String,
    /// The position of the problem.
    pub primary: Label,
    /// Other positions that explain it.
    pub labels: Vec<Label>,
    /// What would be correct.
    pub help: Option<String>,
    /// A change that would correct it.
    pub fix: Option<Fix>,
}

/// A problem with a code. The `problems!` macro implements this for the problems that it declares.
pub(crate) trait Coded {
    /// The code; the severity is in the registry.
    fn code(&self) -> Code;
}

/// A typed problem: its data come from where the error is found, its texts are defined here.
pub(crate) trait Problem: Coded {
    /// What is wrong, in the terms of the program.
    fn message(&self) -> String;
    /// A short text at the position; may be empty.
    fn label(&self) -> String;
    /// What would be correct.
    fn help(&self) -> Option<String>;

    /// The replacement for the marked text, if it certainly corrects the error.
    fn fix(&self) -> Option<String> {
        None
    }

    /// The diagnostic at a position.
    fn at(&self, at: Location) -> Diagnostic {
        let code = self.code();
        Diagnostic {
            code,
            severity: info(code).map_or(Severity::Error, |info| info.severity),
            message: self.message(),
            primary: Label { at, text: self.label() },
            labels: Vec::new(),
            help: self.help(),
            fix: self.fix().map(|text| Fix { at, text }),
        }
    }
}
