//! The alarms listed in `transpiler/docs/alarms.md`.

const PAGE: &str = include_str!("../docs/alarms.md");

/// An alarm from the list.
#[derive(Clone, Copy, Debug)]
pub struct Alarm {
    /// Its number.
    pub number: &'static str,
    /// A short description.
    pub title: &'static str,
    /// The cause.
    cause: &'static str,
    /// The remedy.
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
    /// The alarm's page, in Markdown.
    pub fn page(&self) -> String {
        let Self { number, title, cause, remedy } = self;
        format!("# Alarm {number}: {title}\n\n{cause}\n\n## What to do\n\n{remedy}\n")
    }
}
