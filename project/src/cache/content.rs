//! What a file of the cache held when it was made: disks fill up, processes are killed, bits flip.

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
    /// Of these bytes.
    pub fn of(bytes: &[u8]) -> Self {
        Self { length: bytes.len() as u64, hash: XxHash3_64::oneshot(bytes) }
    }

    /// Of a file.
    ///
    /// # Errors
    /// It cannot be read.
    pub fn of_file(path: &Path) -> io::Result<Self> {
        Ok(Self::of(&regular_file::read(path)?))
    }

    /// Whether a file holds this.
    pub fn is_in(self, path: &Path) -> bool {
        // Most damage shows without reading.
        let is_long_enough = path.metadata().is_ok_and(|about| about.len() == self.length);
        is_long_enough && Self::of_file(path).is_ok_and(|now| now == self)
    }

    /// As [`parse`](Self::parse) reads it.
    pub fn text(self) -> String {
        format!("{}:{:016x}", self.length, self.hash)
    }

    /// What [`text`](Self::text) wrote.
    pub fn parse(text: &str) -> Option<Self> {
        let (length, hash) = text.split_once(':')?;
        Some(Self { length: length.parse().ok()?, hash: u64::from_str_radix(hash, 16).ok()? })
    }
}

/// What the last line of a sealed text begins with.
const SEAL: &str = "whole ";

/// A text with a line behind it that tells whether it is whole.
pub fn sealed(text: &str) -> String {
    format!("{text}{SEAL}{}\n", Content::of(text.as_bytes()).text())
}

/// The text of a file that was [`sealed`]; nothing where there is none, or it is damaged.
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
            // What stands in a line end's place belongs to no line.
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
