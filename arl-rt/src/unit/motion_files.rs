//! The places of motions in the program.

use std::collections::VecDeque;

use crate::fault::File;

/// The files of motions, each from a running number on.
#[derive(Debug)]
pub(super) struct MotionFiles {
    /// The files of motions that have not ended, that of the motion executed last first.
    files: VecDeque<(u64, File)>,
    /// The files of recorded motions.
    recorded: Vec<(u64, File)>,
    /// The file of the motion planned last.
    pub(super) last: File,
    /// The file of the statement that last started the motion again.
    pub(super) start: File,
    /// The file and line of the motion that is being executed, or was executed last.
    pub(super) pointer: Option<(File, u32)>,
}

impl MotionFiles {
    /// No motion was planned yet.
    pub(super) fn new() -> Self {
        let (last, start) = (File::new(""), File::new(""));
        Self { files: VecDeque::new(), recorded: Vec::new(), last, start, pointer: None }
    }

    /// The file of a motion that has not ended.
    pub(super) fn of(&self, number: u64) -> File {
        let known = self.files.iter().rev().find(|(first, _)| *first <= number);
        known.map_or(self.last, |(_, file)| *file)
    }

    /// The file of a motion that was recorded.
    pub(super) fn of_recorded(&self, number: u64) -> Option<File> {
        let behind = self.recorded.partition_point(|(from, _)| *from <= number);
        let (_, file) = self.recorded.get(behind.checked_sub(1)?)?;
        Some(*file)
    }

    /// Notes the file of a motion that was planned.
    pub(super) fn note(&mut self, number: u64, file: File) {
        if self.files.back().is_none_or(|(_, last)| *last != file) {
            self.files.push_back((number, file));
        }
    }

    /// Notes the file of a motion that is recorded.
    pub(super) fn note_recorded(&mut self, number: u64, file: File) {
        if self.recorded.last().is_none_or(|(_, last)| *last != file) {
            self.recorded.push((number, file));
        }
    }

    /// Sets the motion pointer to the motion of a program that was executed, if any. All motions before `oldest` have
    /// ended.
    pub(super) fn point_at(&mut self, motion: u64, line: u32, oldest: u64) {
        let oldest = oldest.min(motion);
        while self.files.get(1).is_some_and(|(from, _)| *from <= oldest) {
            self.files.pop_front();
        }
        let files = self.files.partition_point(|(from, _)| *from <= motion);
        if let Some((_, file)) = self.files.get(files.saturating_sub(1))
            && motion != 0
            && line != 0
        {
            self.pointer = Some((*file, line));
        }
    }

    /// Forgets the motions that were planned.
    pub(super) fn clear(&mut self) {
        self.files.clear();
    }
}
