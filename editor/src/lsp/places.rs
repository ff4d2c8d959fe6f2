//! Converts places of the protocol to places of a program, and back.

use super::programs::Program;
use super::server::Server;
use super::text::Text;
use super::uri::path_of;
use arl2rs::diagnostics::{FileId, Location};
use arl2rs::index::{Index, Mention};
use gen_lsp_types::{Position, TextDocumentIdentifier, TextDocumentPositionParams, Uri};
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// A file of a checked program.
pub(super) struct File {
    pub(super) program: Rc<Program>,
    pub(super) id: FileId,
}

impl File {
    pub(super) fn index(&self) -> &Index {
        self.program.index()
    }

    pub(super) fn text(&self, server: &Server) -> Option<Text<'_>> {
        self.program.text(self.id, server.encoding)
    }
}

/// A byte in a file of a checked program.
pub(super) struct FilePlace {
    pub(super) file: File,
    pub(super) offset: u32,
}

impl FilePlace {
    /// The name at the place.
    pub(super) fn mention(&self) -> Option<&Mention> {
        self.file.index().at(self.file.id, self.offset)
    }
}

impl Server {
    /// The file with this path, in the program that it is checked with.
    pub(super) fn file(&self, path: &Path) -> Option<File> {
        let program = self.program(path)?;
        let id = program.file(path)?;
        Some(File { program, id })
    }

    /// The file that a request is about.
    pub(super) fn document(&self, document: &TextDocumentIdentifier) -> Option<File> {
        self.file(&path_of(&document.uri))
    }

    /// The place that a request is about.
    pub(super) fn place(&self, at: &TextDocumentPositionParams) -> Option<FilePlace> {
        self.place_at(&at.text_document.uri, at.position)
    }

    /// The place with this address.
    pub(super) fn place_at(&self, uri: &Uri, position: Position) -> Option<FilePlace> {
        let file = self.file(&path_of(uri))?;
        let offset = file.text(self)?.offset(position);
        Some(FilePlace { file, offset })
    }

    /// A place of a program in the form of the protocol.
    pub(super) fn location(&self, program: &Program, at: Location) -> Option<gen_lsp_types::Location> {
        let uri = self.documents.uri(program.path(at.file)?);
        let range = program.text(at.file, self.encoding)?.range(at.span);
        Some(gen_lsp_types::Location { uri, range })
    }
}

/// A place that means the same in every program: where something is declared.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) struct Declared {
    pub(super) path: PathBuf,
    pub(super) start: u32,
}

impl Declared {
    pub(super) fn new(program: &Program, at: Location) -> Option<Self> {
        Some(Self { path: program.path(at.file)?.to_path_buf(), start: at.span.start })
    }
}
