//! Searches all pages for words.

use crate::alarms;
use crate::diagnostics::registry;
use crate::reference::topics::{AREAS, first_sentence, summary_of};
use arl_lang::catalog;
use std::fmt::Write;

/// The maximum number of pages shown.
const MOST_FOUND: usize = 15;

/// A page that can be found.
struct Candidate {
    /// Its name as shown.
    name: String,
    /// The names that count most.
    names: String,
    /// Its summary.
    summary: String,
    /// Its whole text.
    text: String,
}

/// The pages that contain all words, best first, one per line. `None` if there are none.
pub fn search(words: &[String]) -> Option<String> {
    let words: Vec<String> =
        words.iter().flat_map(|words| words.split_whitespace()).map(str::to_ascii_lowercase).collect();
    let mut found: Vec<(usize, Candidate)> = candidates()
        .into_iter()
        .filter_map(|page| {
            let scores = words.iter().map(|word| score(&page, word));
            Some((scores.sum::<Option<usize>>()?, page))
        })
        .collect();
    found.sort_by_key(|(score, _)| std::cmp::Reverse(*score));
    let rest = found.len().saturating_sub(MOST_FOUND);
    found.truncate(MOST_FOUND);
    let width = found.iter().map(|(_, page)| page.name.chars().count()).max()?;
    let mut text = String::new();
    for (_, page) in found {
        let _ = writeln!(text, "{:<width$}  {}", page.name, page.summary);
    }
    if rest > 0 {
        let _ = writeln!(text, "and {rest} more: add words to narrow the search");
    }
    Some(text)
}

/// How well a page fits a word: best in its names, then in its summary, then anywhere; `None` if the page does not
/// contain it.
fn score(page: &Candidate, word: &str) -> Option<usize> {
    let is_name = page.names.split('\n').any(|name| name == word);
    let stands_in = |text: &str| text.to_ascii_lowercase().contains(word);
    [(is_name, 100), (stands_in(&page.names), 40), (stands_in(&page.summary), 20), (stands_in(&page.text), 5)]
        .into_iter()
        .find_map(|(fits, score)| fits.then_some(score))
}

fn candidates() -> Vec<Candidate> {
    let mut all = Vec::new();
    for topic in AREAS.iter().flat_map(|area| area.topics) {
        let words: Vec<String> = topic.words().map(str::to_ascii_lowercase).collect();
        all.push(Candidate {
            name: format!("doc {}", topic.name),
            names: words.join("\n"),
            summary: topic.summary(),
            text: format!("{}\n{}", topic.title(), topic.text),
        });
    }
    let mut entries: Vec<&catalog::Entry> = catalog::all_entries().iter().collect();
    entries.dedup_by_key(|entry| entry.name);
    for entry in entries {
        all.push(Candidate {
            name: format!("doc {}", entry.name),
            names: entry.name.to_ascii_lowercase(),
            summary: summary_of(entry).to_owned(),
            text: catalog::reference::entry(entry),
        });
    }
    for variable in catalog::system_variables() {
        all.push(Candidate {
            name: format!("doc ${}", variable.name),
            names: format!("{0}\n${0}", variable.name.to_ascii_lowercase()),
            summary: first_sentence(variable.doc).to_owned(),
            text: catalog::reference::system_variable(variable),
        });
    }
    for (name, base) in catalog::type_names() {
        let text = match base {
            catalog::Base::Struct(id) => catalog::reference::structure(id),
            catalog::Base::Enum(id) => catalog::reference::enumeration(id),
            catalog::Base::Handle(id) => catalog::reference::handle(id),
            _ => continue,
        };
        let doc = text.split("\n\n").nth(1).unwrap_or_default().replace('\n', " ");
        let summary = first_sentence(&doc).to_owned();
        all.push(Candidate { name: format!("doc {name}"), names: name.to_ascii_lowercase(), summary, text });
    }
    for info in registry() {
        let (name, names) = (format!("explain {}", info.code), info.code.to_string().to_ascii_lowercase());
        all.push(Candidate { name, names, summary: info.title.to_owned(), text: info.page.to_owned() });
    }
    for alarm in alarms::all() {
        let summary = format!("Alarm: {}", alarm.title);
        let (name, names) = (format!("explain {}", alarm.number), alarm.number.to_owned());
        all.push(Candidate { name, names, summary, text: alarm.page() });
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    fn first(words: &str) -> String {
        let found = search(&[words.to_owned()]).unwrap_or_default();
        found.split("  ").next().unwrap_or_default().trim().to_owned()
    }

    #[test]
    fn the_best_page_stands_first() {
        assert_eq!(first("zone"), "doc blending");
        assert_eq!(first("getdi"), "doc getdi");
        assert_eq!(first("inputs"), "doc io");
        assert_eq!(first("20001"), "explain 20001");
        assert_eq!(first("0203"), "explain ARL0203");
        assert_eq!(search(&["xyzzy".to_owned()]), None);
    }
}
