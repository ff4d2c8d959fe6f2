//! The files that are open in the editor, whose text takes precedence over that of the disk.

use super::text::{Encoding, Text};
use super::uri::{beside, path_of, uri_of};
use arl_lang::span::LineIndex;
use arl2rs::check::clean;
use arl2rs::sources::FileSystem;
use arl2rs::{SourceError, Sources};
use gen_lsp_types::{TextDocumentContentChangeEvent as Change, Uri};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// An open file.
#[derive(Debug)]
pub(super) struct Document {
    pub(super) text: String,
    pub(super) lines: LineIndex,
    /// The editor's number for this state of the text.
    pub(super) version: i32,
}

impl Document {
    pub(super) fn new(mut text: String, version: i32) -> Self {
        // A byte order mark is not part of the program.
        if text.starts_with('\u{feff}') {
            text.remove(0);
        }
        let lines = LineIndex::new(&text);
        Self { text, lines, version }
    }

    pub(super) fn as_text(&self, encoding: Encoding) -> Text<'_> {
        Text { text: &self.text, lines: &self.lines, encoding }
    }

    /// Changes the text, change after change.
    pub(super) fn change(&mut self, changes: Vec<Change>, version: i32, encoding: Encoding) {
        for change in changes {
            match change {
                Change::TextDocumentContentChangeWholeDocument(whole) => self.text = whole.text,
                Change::TextDocumentContentChangePartial(part) => {
                    let span = self.as_text(encoding).span(part.range);
                    self.text.replace_range(span.start as usize..span.end as usize, &part.text);
                }
            }
            self.lines = LineIndex::new(&self.text);
        }
        self.version = version;
    }
}

/// All open files, by their paths.
#[derive(Debug, Default)]
pub(super) struct Documents {
    open: BTreeMap<PathBuf, Document>,
    /// How the client spells the addresses of files that it has opened, also of those that it has closed again: an
    /// address can be spelled in many ways, and clients compare them letter by letter.
    spelled: BTreeMap<PathBuf, Uri>,
}

impl Documents {
    /// Adds an open file; returns its path.
    pub(super) fn open(&mut self, uri: &Uri, document: Document) -> PathBuf {
        let path = path_of(uri);
        self.open.insert(path.clone(), document);
        self.spelled.insert(path.clone(), uri.clone());
        path
    }

    /// The address of a file, in the client's spelling if that is known for the file or for another one in its folder.
    pub(super) fn uri(&self, path: &Path) -> Uri {
        let own = || self.spelled.get(path).cloned();
        let beside = || {
            let (other, uri) = self.spelled.iter().find(|(other, _)| other.parent() == path.parent())?;
            beside(uri, other, path)
        };
        own().or_else(beside).unwrap_or_else(|| uri_of(path))
    }

    pub(super) fn close(&mut self, path: &Path) {
        self.open.remove(path);
    }

    pub(super) fn get(&self, path: &Path) -> Option<&Document> {
        self.open.get(path)
    }

    pub(super) fn get_mut(&mut self, path: &Path) -> Option<&mut Document> {
        self.open.get_mut(path)
    }

    pub(super) fn paths(&self) -> impl Iterator<Item = &PathBuf> {
        self.open.keys()
    }

    /// Whether there is such a file, in the editor or on the disk.
    pub(super) fn exists(&self, path: &Path) -> bool {
        self.open.contains_key(path) || path.is_file()
    }
}

impl Sources for Documents {
    fn read(&self, path: &Path) -> Result<Vec<u8>, SourceError> {
        // An import may say `../rack.arl`; open files are known by their plain paths.
        match self.open.get(&clean(path)) {
            Some(document) => Ok(document.text.clone().into_bytes()),
            None => FileSystem.read(path),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gen_lsp_types::{Position, Range, TextDocumentContentChangePartial};

    #[expect(deprecated, reason = "the field is there, and has to be left empty")]
    fn part(line: u32, from: u32, to: u32, text: &str) -> Change {
        let range = Range { start: Position { line, character: from }, end: Position { line, character: to } };
        Change::TextDocumentContentChangePartial(TextDocumentContentChangePartial {
            range,
            range_length: None,
            text: text.into(),
        })
    }

    #[test]
    fn changes_apply_one_after_the_other() {
        let mut document = Document::new("int a\nint b\n".into(), 1);
        document.change(vec![part(1, 4, 5, "\u{1f916}c"), part(1, 6, 7, "d\ne")], 2, Encoding::Utf16);
        assert_eq!((document.text.as_str(), document.version), ("int a\nint \u{1f916}d\ne\n", 2));
    }
}
