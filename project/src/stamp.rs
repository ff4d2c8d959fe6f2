//! Records what a compiled program was made from, so that an unchanged one starts without compiling.

use crate::cache::{Content, read_sealed, sealed};
use arl_robot::regular_file;
use arl2rs::compile::Compiled;
use arl2rs::hir::Program;
use arl2rs::{SourceError, Sources};
use std::cell::RefCell;
use std::fmt::Write;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};

/// The first line of a stamp file; a stamp of another version is ignored.
const VERSION: &str = "arl2rs stamp 2";

/// A compiled program and the messages shown when it was compiled.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Kept {
    /// The program's file name in its place.
    pub name: String,
    /// The content of the program's file.
    pub program: Content,
    /// The content of the file with the warnings.
    pub messages: Content,
}

/// Everything that a compiled program depends on.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Stamp {
    /// The compiler, its runtime and its options.
    pub identity: u64,
    /// What is stored in the program's place.
    pub kept: Kept,
    /// The files that were read.
    pub files: Vec<Stamped>,
    /// The files that were looked for but did not exist.
    pub missing: Vec<PathBuf>,
}

/// A file that was read.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Stamped {
    /// The path of the file.
    pub path: PathBuf,
    /// Hash of the bytes.
    pub content: u64,
    /// For a data file: the hash of everything except the values that the runtime reads again.
    pub shape: Option<u64>,
}

/// The state of a compiled program relative to its sources.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Freshness {
    /// Nothing changed.
    Fresh,
    /// Only data files have changed, possibly only in their values.
    DataChanged,
    /// The program must be compiled.
    Stale,
}

/// Sources that record what was read, so that a stamp describes what was compiled and not what is there later.
pub struct Recording<'a> {
    sources: &'a dyn Sources,
    seen: RefCell<Vec<(PathBuf, Option<u64>)>>,
}

impl<'a> Recording<'a> {
    /// Records what is read from `sources`.
    pub fn new(sources: &'a dyn Sources) -> Self {
        Self { sources, seen: RefCell::default() }
    }
}

impl Sources for Recording<'_> {
    fn read(&self, path: &Path) -> Result<Vec<u8>, SourceError> {
        let outcome = self.sources.read(path);
        self.seen.borrow_mut().push((path.to_path_buf(), outcome.as_ref().ok().map(|bytes| hash(bytes))));
        outcome
    }
}

impl Stamp {
    /// The stamp of programs compiled together. `None` if a path cannot be written to a stamp.
    pub fn of(compiled: &[Compiled], read: &Recording<'_>, identity: u64, kept: Kept) -> Option<Self> {
        let mut stamp = Self { identity, kept, files: Vec::new(), missing: Vec::new() };
        for (path, content) in read.seen.borrow().iter() {
            let path = std::path::absolute(path).ok()?;
            if path.to_str()?.contains(['\n', '\r']) {
                return None;
            }
            match content {
                Some(content) => stamp.files.push(Stamped { path, content: *content, shape: None }),
                None => stamp.missing.push(path),
            }
        }
        for (compiled, program) in compiled.iter().filter_map(|it| Some((it, it.checked.program.as_ref()?))) {
            for (name, shape) in shapes(program) {
                let path = std::path::absolute(compiled.folder.join(name)).ok()?;
                // A file that several programs use was read several times.
                stamp.files.iter_mut().filter(|file| file.path == path).for_each(|file| file.shape = Some(shape));
            }
        }
        Some(stamp)
    }

    /// Reads a stamp; `None` if it does not exist, is damaged, or has another version.
    pub fn read(path: &Path) -> Option<Self> {
        let text = read_sealed(path)?;
        let mut lines = text.lines();
        if lines.next()? != VERSION {
            return None;
        }
        let identity = u64::from_str_radix(lines.next()?, 16).ok()?;
        let (name, program, messages) = (lines.next()?.into(), lines.next()?, lines.next()?);
        let kept = Kept { name, program: Content::parse(program)?, messages: Content::parse(messages)? };
        let mut stamp = Self { identity, kept, files: Vec::new(), missing: Vec::new() };
        for line in lines {
            let mut words = line.splitn(4, ' ');
            let (kind, content, shape, path) = (words.next()?, words.next()?, words.next()?, words.next()?);
            if kind == "missing" {
                stamp.missing.push(path.into());
                continue;
            }
            let content = u64::from_str_radix(content, 16).ok()?;
            let shape = (shape != "-").then(|| u64::from_str_radix(shape, 16)).transpose().ok()?;
            stamp.files.push(Stamped { path: path.into(), content, shape });
        }
        Some(stamp)
    }

    /// Whether a file is a damaged stamp.
    pub fn is_damaged(path: &Path) -> bool {
        let begins = |bytes: Vec<u8>| bytes.starts_with(VERSION.as_bytes());
        regular_file::read(path).is_ok_and(begins) && Self::read(path).is_none()
    }

    /// The text of a stamp file.
    pub fn text(&self) -> String {
        let Kept { name, program, messages } = &self.kept;
        let mut text = format!("{VERSION}\n{:x}\n{name}\n{}\n{}\n", self.identity, program.text(), messages.text());
        for file in &self.files {
            let shape = file.shape.map_or_else(|| "-".to_string(), |shape| format!("{shape:x}"));
            // Writing to a string cannot fail.
            let _ = writeln!(text, "file {:x} {shape} {}", file.content, file.path.display());
        }
        for path in &self.missing {
            let _ = writeln!(text, "missing - - {}", path.display());
        }
        sealed(&text)
    }

    /// The present state of the program relative to its sources.
    pub fn freshness(&self, identity: u64) -> Freshness {
        if self.identity != identity || self.missing.iter().any(|path| path.exists()) {
            return Freshness::Stale;
        }
        let mut freshness = Freshness::Fresh;
        for file in &self.files {
            match regular_file::read(&file.path) {
                Ok(bytes) if hash(&bytes) == file.content => {}
                Ok(_) if file.shape.is_some() => freshness = Freshness::DataChanged,
                _ => return Freshness::Stale,
            }
        }
        freshness
    }

    /// Whether `now` differs from `self` at most in values that the runtime reads again.
    pub fn same_but_values(&self, now: &Stamp) -> bool {
        let same = |(old, new): (&Stamped, &Stamped)| {
            old.path == new.path && (old.content == new.content || (old.shape.is_some() && old.shape == new.shape))
        };
        self.identity == now.identity
            && self.missing == now.missing
            && self.files.len() == now.files.len()
            && self.files.iter().zip(&now.files).all(same)
    }
}

/// The hash of some bytes.
pub fn hash(bytes: &[u8]) -> u64 {
    let mut hasher = DefaultHasher::new();
    bytes.hash(&mut hasher);
    hasher.finish()
}

/// The data files of a program, each with the hash of its text without the values that can be re-taught.
fn shapes(program: &Program) -> Vec<(String, u64)> {
    let data = program.modules.iter().enumerate().filter(|(_, module)| module.data);
    data.map(|(at, module)| {
        let mut values: Vec<_> = program
            .globals
            .iter()
            .filter(|global| global.module.0 as usize == at && global.teachable && !global.constant)
            .filter_map(|global| global.init.as_ref().map(|init| init.span))
            .collect();
        values.sort();
        (module.file.clone(), shape(&module.source, values.iter().map(|span| span.start..span.end)))
    })
    .collect()
}

/// The hash of a text without the bytes in `values`, which are ascending.
fn shape(text: &str, values: impl Iterator<Item = std::ops::Range<u32>>) -> u64 {
    let mut hasher = DefaultHasher::new();
    let mut from = 0;
    for value in values {
        text.get(from..value.start as usize).hash(&mut hasher);
        from = value.end as usize;
    }
    text.get(from..).hash(&mut hasher);
    hasher.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A folder that is removed at the end.
    struct Folder(PathBuf);

    impl Folder {
        fn new(name: &str) -> Self {
            let path = std::env::temp_dir().join(format!("arl2rs-stamp-{name}-{}", std::process::id()));
            std::fs::create_dir_all(&path).expect("a folder");
            Self(path)
        }

        fn write(&self, name: &str, text: &str) -> PathBuf {
            let path = self.0.join(name);
            std::fs::write(&path, text).expect("a file");
            path
        }
    }

    impl Drop for Folder {
        fn drop(&mut self) {
            let _ = std::fs::remove_dir_all(&self.0);
        }
    }

    fn stamp(folder: &Folder) -> Stamp {
        let main = folder.write("pick.arl", "main");
        let data = folder.write("pick_data.arl", "int a = 1\n");
        let shape = shape("int a = 1\n", std::iter::once(8..9));
        let file = |path, text: &str, shape| Stamped { path, content: hash(text.as_bytes()), shape };
        Stamp {
            identity: 7,
            kept: Kept { name: "pick-1".into(), program: Content::of(b"ELF"), messages: Content::of(b"") },
            files: vec![file(main, "main", None), file(data, "int a = 1\n", Some(shape))],
            missing: vec![folder.0.join("other.arl")],
        }
    }

    #[test]
    fn text_and_back() {
        let folder = Folder::new("text");
        let stamp = stamp(&folder);
        let path = folder.write("stamp", &stamp.text());
        assert_eq!(Stamp::read(&path), Some(stamp));
        folder.write("stamp", "arl2rs stamp 0\n");
        assert_eq!(Stamp::read(&path), None);
    }

    #[test]
    fn changes_of_sources_identity_and_missing_files_are_seen() {
        let folder = Folder::new("changes");
        let stamp = stamp(&folder);
        assert_eq!(stamp.freshness(7), Freshness::Fresh);
        assert_eq!(stamp.freshness(8), Freshness::Stale);
        folder.write("pick_data.arl", "int a = 2\n");
        assert_eq!(stamp.freshness(7), Freshness::DataChanged);
        folder.write("pick.arl", "other");
        assert_eq!(stamp.freshness(7), Freshness::Stale);
        folder.write("pick.arl", "main");
        folder.write("pick_data.arl", "int a = 1\n");
        assert_eq!(stamp.freshness(7), Freshness::Fresh);
        folder.write("other.arl", "");
        assert_eq!(stamp.freshness(7), Freshness::Stale);
    }

    #[test]
    fn a_removed_file_is_a_change() {
        let folder = Folder::new("removed");
        let stamp = stamp(&folder);
        std::fs::remove_file(folder.0.join("pick_data.arl")).expect("removed");
        assert_eq!(stamp.freshness(7), Freshness::Stale);
    }

    #[test]
    fn values_do_not_count_but_names_and_types_do() {
        let folder = Folder::new("values");
        let old = stamp(&folder);
        let mut new = old.clone();
        let data = |text: &str, value: std::ops::Range<u32>| Stamped {
            path: folder.0.join("pick_data.arl"),
            content: hash(text.as_bytes()),
            shape: Some(shape(text, std::iter::once(value))),
        };
        new.files[1] = data("int a = 25\n", 8..10);
        assert!(old.same_but_values(&new));
        new.files[1] = data("int b = 25\n", 8..10);
        assert!(!old.same_but_values(&new));
    }
}
