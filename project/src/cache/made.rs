//! Records the files that cargo made: cargo itself compares only times and accepts damaged files.

use super::content::{Content, read_sealed, sealed};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The file with the record, in the folder of a program or a runtime.
pub const RECORD: &str = "made";

/// The files that cargo made for a program or a runtime.
#[derive(Default, Debug)]
pub struct Made {
    record: PathBuf,
    files: BTreeMap<PathBuf, Content>,
    is_changed: bool,
}

impl Made {
    /// Reads the record of a folder. If it does not exist or is damaged, no files are known.
    pub fn read(folder: &Path) -> Self {
        let record = folder.join(RECORD);
        let text = read_sealed(&record).unwrap_or_default();
        let entry = |line: &str| {
            let (content, path) = line.split_once(' ')?;
            Some((PathBuf::from(path), Content::parse(content)?))
        };
        Self { record, files: text.lines().filter_map(entry).collect(), is_changed: false }
    }

    /// Returns the files that have changed since they were made and removes them from the record. Missing files are
    /// made again by cargo itself.
    pub fn take_damaged(&mut self) -> Vec<PathBuf> {
        let is_damaged =
            |(path, content): (&PathBuf, &Content)| (path.exists() && !content.is_in(path)).then(|| path.clone());
        let damaged: Vec<PathBuf> = self.files.iter().filter_map(is_damaged).collect();
        for path in &damaged {
            self.files.remove(path);
            self.is_changed = true;
        }
        damaged
    }

    /// Removes the record from the disk until it is [written](Self::write) again.
    pub fn forget(&mut self) {
        self.is_changed |= std::fs::remove_file(&self.record).is_ok();
    }

    /// Records a file that was made now or is not known yet.
    pub fn add(&mut self, path: &Path, is_new: bool) {
        let is_line = path.to_str().is_some_and(|path| !path.contains(['\n', '\r']));
        if !is_line || (!is_new && self.files.contains_key(path)) {
            return;
        }
        if let Ok(content) = Content::of_file(path) {
            self.is_changed |= self.files.insert(path.to_path_buf(), content) != Some(content);
        }
    }

    /// Writes the record. Without a record no files are known the next time, which is not an error.
    pub fn write(mut self) {
        let before = self.files.len();
        self.files.retain(|path, _| path.exists());
        if self.is_changed || self.files.len() < before {
            let line = |(path, content): (&PathBuf, &Content)| format!("{} {}\n", content.text(), path.display());
            let text: String = self.files.iter().map(line).collect();
            let _ = arl_robot::atomic_file::write(&self.record, sealed(&text).as_bytes());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_changed_since_is_damaged_and_what_is_gone_is_not() {
        let folder = std::env::temp_dir().join(format!("arl2rs-made-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let files = ["a", "b", "c"].map(|name| folder.join(name));
        let mut made = Made::read(&folder);
        for file in &files {
            std::fs::write(file, "as made").expect("written");
            made.add(file, true);
        }
        made.write();
        std::fs::write(&files[0], "").expect("written");
        std::fs::remove_file(&files[1]).expect("removed");
        let mut made = Made::read(&folder);
        assert_eq!(made.take_damaged(), [files[0].clone()]);
        // Made again.
        made.add(&files[0], true);
        made.write();
        assert_eq!(Made::read(&folder).take_damaged(), Vec::<PathBuf>::new());
        std::fs::remove_dir_all(&folder).expect("removed");
    }
}
