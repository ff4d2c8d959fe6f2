//! `arl2rs clean`

use arl_project::cache::{Cache, Removed};
use arl_terminal::answer;
use arl_terminal::failure::Failure;
use arl_terminal::show;
use indicatif::DecimalBytes;
use std::time::Duration;

/// Removes from the cache what was not used for this many days; everything without a number.
pub(crate) fn clean(days: Option<u32>) -> Result<(), Failure> {
    let cache = Cache::find()?;
    let removed = cache.clean(Duration::from_secs(u64::from(days.unwrap_or(0)) * 24 * 3600));
    for folder in &removed.kept {
        show::warning(&format!(
            "{} was not removed: another process is using it, or removing it failed",
            folder.display()
        ));
    }
    answer::write(&summary(&removed, &cache.root().display().to_string()))
}

fn summary(removed: &Removed, cache: &str) -> String {
    let counts = [(removed.programs, "program"), (removed.runtimes, "compiled runtime"), (removed.results, "sweep")];
    let count = |(count, word): (usize, &str)| format!("{count} {word}{}", if count == 1 { "" } else { "s" });
    let what: Vec<String> = counts.into_iter().filter(|(count, _)| *count > 0).map(count).collect();
    match what.is_empty() {
        true => format!("nothing to remove from {cache}\n"),
        false => format!("removed {} from {cache}: {}\n", what.join(" and "), DecimalBytes(removed.bytes)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_answer_counts() {
        let removed = Removed { programs: 12, runtimes: 1, results: 0, bytes: 1_300_000_000, kept: Vec::new() };
        assert_eq!(summary(&removed, "/c"), "removed 12 programs and 1 compiled runtime from /c: 1.30 GB\n");
        assert_eq!(summary(&Removed::default(), "/c"), "nothing to remove from /c\n");
    }
}
