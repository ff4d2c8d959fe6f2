//! The alarms, as `transpiler/docs/alarms.md` lists them.

const PAGE: &str = include_str!("../docs/alarms.md");

/// An alarm of the list.
#[derive(Clone, Copy, Debug)]
pub struct Alarm {
    /// Its number.
    pub number: &'static str,
    /// What it is, in a few words.
    pub title: &'static str,
    /// What leads to it.
    cause: &'static str,
    /// What to do.
    remedy: &'static str,
}

/// All alarms, in the order of their numbers.
pub fn all() -> impl Iterator<Item = Alarm> {
    PAGE.lines().filter_map(|line| {
        let mut cells = line.strip_prefix("| ")?.strip_suffix(" |")?.split(" | ");
        let alarm = Alarm { number: cells.next()?, title: cells.next()?, cause: cells.next()?, remedy: cells.next()? };
        alarm.number.bytes().all(|digit| digit.is_ascii_digit()).then_some(alarm)
    })
}

impl Alarm {
    /// Its page, in Markdown.
    pub fn page(&self) -> String {
        let Self { number, title, cause, remedy } = self;
        format!("# Alarm {number}: {title}\n\n{cause}\n\n## What to do\n\n{remedy}\n")
    }
}
