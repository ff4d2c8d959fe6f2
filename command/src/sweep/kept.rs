//! Results of earlier runs: a file for each bundle, a line for each run.

use super::result::RunResult;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::fs::{File, OpenOptions};
use std::io::{self, BufRead, BufReader, Write};
use std::path::Path;
use std::time::SystemTime;
use twox_hash::XxHash3_64;

/// The known results of a bundle.
#[derive(Debug)]
pub struct Kept {
    known: HashMap<Vec<String>, RunResult>,
    file: Option<File>,
}

#[derive(Deserialize, Serialize)]
struct Line {
    words: Vec<String>,
    result: RunResult,
    /// A hash of the rest of the line, by which damaged lines are recognised.
    check: u64,
}

fn check(words: &[String], result: &RunResult) -> u64 {
    XxHash3_64::oneshot(&serde_json::to_vec(&(words, result)).unwrap_or_default())
}

impl Kept {
    /// Reads the known results. Damaged lines, as after a full disk, are left out.
    ///
    /// # Errors
    /// The file cannot be created.
    pub fn open(path: &Path) -> io::Result<Self> {
        path.parent().map_or(Ok(()), std::fs::create_dir_all)?;
        let mut file = OpenOptions::new().read(true).append(true).create(true).open(path)?;
        // A file in use stays; if its time cannot be set, it stays for less long.
        let _ = file.set_modified(SystemTime::now());
        let (mut known, mut is_whole) = (HashMap::new(), true);
        let mut reader = BufReader::new(&file);
        let mut line = Vec::new();
        while reader.read_until(b'\n', &mut line)? > 0 {
            is_whole = line.ends_with(b"\n");
            if let Ok(Line { words, result, check }) = serde_json::from_slice(&line)
                && check == self::check(&words, &result)
            {
                known.insert(words, result);
            }
            line.clear();
        }
        if !is_whole {
            file.write_all(b"\n")?;
        }
        Ok(Self { known, file: Some(file) })
    }

    /// Without a file: nothing is known.
    pub(super) fn nothing() -> Self {
        Self { known: HashMap::new(), file: None }
    }

    /// The result of the run of these words.
    pub fn find(&self, words: &[String]) -> Option<&RunResult> {
        self.known.get(words)
    }

    /// Keeps a result.
    ///
    /// # Errors
    /// The result cannot be written. No more are written then.
    pub fn keep(&mut self, words: &[String], result: &RunResult) -> io::Result<()> {
        let Some(file) = &mut self.file else { return Ok(()) };
        let line = Line { words: words.to_vec(), result: result.clone(), check: check(words, result) };
        let mut text = serde_json::to_vec(&line).map_err(io::Error::other)?;
        text.push(b'\n');
        let written = file.write_all(&text);
        if written.is_err() {
            self.file = None;
        }
        written
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_come_back_and_damaged_ones_do_not() {
        let path = std::env::temp_dir().join(format!("arl2rs-kept-{}/a.jsonl", std::process::id()));
        let result = |time| RunResult { outcome: "ended".into(), cycle_time: Some(time), ..RunResult::default() };
        let words = |word: &str| vec![word.to_owned()];
        let mut kept = Kept::open(&path).unwrap();
        kept.keep(&words("a"), &result(1.25)).unwrap();
        drop(kept);
        let long_ago = SystemTime::UNIX_EPOCH;
        File::options().write(true).open(&path).unwrap().set_modified(long_ago).unwrap();
        Kept::open(&path).unwrap();
        assert_ne!(path.metadata().unwrap().modified().unwrap(), long_ago, "what is looked up is in use");
        let mut text = std::fs::read(&path).unwrap();
        text.extend_from_slice(b"{\"words\":[\"b\"],\"resu");
        std::fs::write(&path, text).unwrap();
        Kept::open(&path).unwrap().keep(&words("c"), &result(0.1)).unwrap();
        let kept = Kept::open(&path).unwrap();
        assert_eq!(kept.find(&words("a")), Some(&result(1.25)));
        assert_eq!(kept.find(&words("b")), None);
        let text = std::fs::read_to_string(&path).unwrap();
        std::fs::write(&path, text.replacen("1.25", "1.35", 1)).unwrap();
        assert_eq!(Kept::open(&path).unwrap().find(&words("a")), None, "a digit has changed");
        assert_eq!(kept.find(&words("c")), Some(&result(0.1)));
        std::fs::remove_dir_all(path.parent().unwrap()).unwrap();
    }
}
