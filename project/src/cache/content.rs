//! Records what a file of the cache contained when it was made: disks fill up, processes are killed, bits flip.

use arl_robot::regular_file;
use std::io;
use std::path::Path;
use twox_hash::XxHash3_64;

/// The length and the hash of a file's bytes.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Content {
    length: u64,
    hash: u64,
}

impl Content {
    /// The content of these bytes.
    pub fn of(bytes: &[u8]) -> Self {
        Self { length: bytes.len() as u64, hash: XxHash3_64::oneshot(bytes) }
    }

    /// The content of a file.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn of_file(path: &Path) -> io::Result<Self> {
        Ok(Self::of(&regular_file::read(path)?))
    }

    /// Whether a file has this content.
    pub fn is_in(self, path: &Path) -> bool {
        // Most damage is detected without reading the file.
        let is_long_enough = path.metadata().is_ok_and(|about| about.len() == self.length);
        is_long_enough && Self::of_file(path).is_ok_and(|now| now == self)
    }

    /// The text form that [`parse`](Self::parse) reads.
    pub fn text(self) -> String {
        format!("{}:{:016x}", self.length, self.hash)
    }

    /// Parses the output of [`text`](Self::text).
    pub fn parse(text: &str) -> Option<Self> {
        let (length, hash) = text.split_once(':')?;
        Some(Self { length: length.parse().ok()?, hash: u64::from_str_radix(hash, 16).ok()? })
    }
}

/// The beginning of the last line of a sealed text.
const SEAL: &str = "whole ";

/// A text followed by a line that shows whether it is complete.
pub fn sealed(text: &str) -> String {
    format!("{text}{SEAL}{}\n", Content::of(text.as_bytes()).text())
}

/// The text of a file that was [`sealed`]; `None` if the file does not exist or is damaged.
pub fn read_sealed(path: &Path) -> Option<String> {
    let mut text = regular_file::read_text(path).ok()?;
    let seal = text.trim_end().rfind('\n')? + 1;
    let content = Content::parse(text.get(seal..)?.trim_end().strip_prefix(SEAL)?)?;
    text.truncate(seal);
    (Content::of(text.as_bytes()) == content).then_some(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_cut_or_changed_is_seen() {
        let path = std::env::temp_dir().join(format!("arl2rs-content-{}", std::process::id()));
        let content = Content::of(b"some bytes");
        assert_eq!(Content::parse(&content.text()), Some(content));
        for (bytes, is_whole) in [("some bytes", true), ("some byte", false), ("same bytes", false), ("", false)] {
            std::fs::write(&path, bytes).expect("written");
            assert_eq!(content.is_in(&path), is_whole, "{bytes}");
        }
        let text = sealed("one\ntwo\n");
        for at in 0..text.len() {
            let mut changed = text.clone().into_bytes();
            changed[at] ^= 1;
            std::fs::write(&path, &changed).expect("written");
            // The byte in place of the line end belongs to no line.
            let is_end = at + 1 == text.len();
            assert!(read_sealed(&path).is_none() || is_end, "{at}");
            std::fs::write(&path, text.get(..at).expect("ASCII")).expect("written");
            assert!(read_sealed(&path).is_none() || is_end, "{at}");
        }
        std::fs::write(&path, &text).expect("written");
        assert_eq!(read_sealed(&path).as_deref(), Some("one\ntwo\n"));
        std::fs::remove_file(&path).expect("removed");
        assert!(!content.is_in(&path) && read_sealed(&path).is_none());
    }
}
