//! The program pointer and the motion pointer of the foreground channels, which are kept when the controller is
//! switched off (manual 5.12.8 to 5.12.11).

use std::fmt::Write;

use crate::cycle::channel_id::MOST_FOREGROUND;
use crate::fault::File;
use crate::storage::state_format::StateFormat;
use crate::values::Str;

/// The name under which the pointers are stored.
pub(crate) const STORED: &str = "POINTERS";

/// A line in a file of a program; the program need not exist any more.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) struct CodePosition {
    pub(crate) file: Str,
    pub(crate) line: u32,
}

/// The stored pointers of a channel.
#[derive(Clone, PartialEq, Eq, Default, Debug)]
pub(crate) struct StoredPointers {
    /// The position of the program.
    pub(crate) program: Option<CodePosition>,
    /// The motion that was executed last.
    pub(crate) motion: Option<CodePosition>,
}

/// The stored pointers of all foreground channels; the first is that of channel 1.
pub(crate) type PointerTable = [StoredPointers; MOST_FOREGROUND];

/// The current pointers of a channel; `None` as long as a pointer still is the stored one.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub(crate) struct CurrentPointers {
    /// The position of the program.
    pub(crate) program: Option<(File, u32)>,
    /// The current motion, or else the last one.
    pub(crate) motion: Option<(File, u32)>,
}

impl From<(File, u32)> for CodePosition {
    fn from((file, line): (File, u32)) -> Self {
        Self { file: file.name().into(), line }
    }
}

impl StoredPointers {
    /// The pointers to store now.
    pub(crate) fn renewed(&self, now: &CurrentPointers) -> Self {
        Self {
            program: now.program.map(CodePosition::from).or_else(|| self.program.clone()),
            motion: now.motion.map(CodePosition::from).or_else(|| self.motion.clone()),
        }
    }
}

/// The word before a pointer in its line of text.
const PROGRAM: &str = "program";
const MOTION: &str = "motion";

/// The table as text, with a line for each pointer.
pub(crate) fn written(table: &PointerTable) -> String {
    let mut text = String::new();
    for (number, kept) in (1..).zip(table) {
        for (word, spot) in [(PROGRAM, &kept.program), (MOTION, &kept.motion)] {
            let Some(CodePosition { file, line }) = spot else { continue };
            // Writing to a string does not fail.
            let _ = write!(text, "{word} {number} ");
            file.write(&mut text);
            let _ = writeln!(text, "{line}");
        }
    }
    text
}

/// Reads a table from text; `None` if the text is not a written table.
pub(crate) fn read(text: &str) -> Option<PointerTable> {
    let mut table = PointerTable::default();
    for line in text.lines() {
        let mut words = line.split_ascii_whitespace();
        let word = words.next()?;
        let number: usize = words.next()?.parse().ok()?;
        let spot = CodePosition { file: Str::read(&mut words)?, line: words.next()?.parse().ok()? };
        let kept = table.get_mut(number.checked_sub(1)?)?;
        let place = match word {
            PROGRAM => &mut kept.program,
            MOTION => &mut kept.motion,
            _ => return None,
        };
        if words.next().is_some() || place.replace(spot).is_some() {
            return None;
        }
    }
    Some(table)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_gives_the_pointers_back() {
        let mut table = PointerTable::default();
        table[0] = StoredPointers { program: Some((File::new("a b \u{e4}.arl"), 12).into()), motion: None };
        table[5] = StoredPointers::default()
            .renewed(&CurrentPointers { program: None, motion: Some((File::new("c.arl"), 0)) });
        let text = written(&table);
        assert_eq!(read(&text), Some(table), "{text}");
        assert_eq!(read(""), Some(PointerTable::default()));
    }

    #[test]
    fn what_is_known_by_now_takes_the_place_of_what_was_kept() {
        let spot = |file, line| Some(CodePosition::from((File::new(file), line)));
        let kept = StoredPointers { program: spot("old.arl", 3), motion: spot("old.arl", 2) };
        let now = CurrentPointers { program: Some((File::new("new.arl"), 1)), motion: None };
        assert_eq!(kept.renewed(&now), StoredPointers { program: spot("new.arl", 1), motion: spot("old.arl", 2) });
        assert_eq!(kept.renewed(&CurrentPointers::default()), kept);
    }

    #[test]
    fn other_text_is_noticed() {
        for text in [
            "program 1 \"a.arl\"",
            "program 1 \"a.arl\" 2 3",
            "program 1 \"a.arl\" -2",
            "program 1 a.arl 2",
            "program 0 \"a.arl\" 2",
            "program 7 \"a.arl\" 2",
            "program one \"a.arl\" 2",
            "robot 1 \"a.arl\" 2",
            "motion 1 \"a.arl\" 2\nmotion 1 \"a.arl\" 2",
            "\n",
        ] {
            assert_eq!(read(text), None, "{text}");
        }
    }
}
