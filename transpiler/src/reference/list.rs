//! All pages, by area.

use crate::reference::topics::AREAS;
use arl_lang::catalog::{self, Base};
use std::fmt::Write;

/// The width of the list, in characters.
const WIDTH: usize = 100;

/// All names that have a page, by area: those of the language with their summaries.
pub fn list() -> String {
    let mut text = String::from("`arl2rs doc NAME` shows a page; `arl2rs doc --search WORDS` searches all of them.\n");
    for area in AREAS {
        heading(&mut text, area.title);
        for topic in area.topics {
            let _ = writeln!(text, "  {:<20} {}", topic.name, topic.summary());
        }
    }
    for chapter in catalog::CHAPTERS {
        heading(&mut text, &format!("Built in: {}", chapter.title));
        let mut names: Vec<&str> = chapter.entries.iter().map(|entry| entry.name).collect();
        names.dedup();
        wrapped(&mut text, names.into_iter());
    }
    heading(&mut text, "Built in: types");
    let is_built_in = |base: &Base| matches!(base, Base::Struct(_) | Base::Enum(_) | Base::Handle(_));
    wrapped(&mut text, catalog::type_names().filter(|(_, base)| is_built_in(base)).map(|(name, _)| name));
    heading(&mut text, "Built in: system variables");
    let variables: Vec<String> = catalog::system_variables().map(|variable| format!("${}", variable.name)).collect();
    wrapped(&mut text, variables.iter().map(String::as_str));
    text
}

fn heading(text: &mut String, title: &str) {
    let _ = writeln!(text, "\n{title}");
}

/// Names in lines of at most `WIDTH` characters.
fn wrapped<'a>(text: &mut String, names: impl Iterator<Item = &'a str>) {
    let mut line = String::new();
    for name in names {
        if line.len() + name.len() + 4 > WIDTH {
            let _ = writeln!(text, "  {line}");
            line.clear();
        }
        line.push_str(if line.is_empty() { "" } else { "  " });
        line.push_str(name);
    }
    if !line.is_empty() {
        let _ = writeln!(text, "  {line}");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn everything_is_listed_in_lines_that_fit() {
        let text = list();
        for name in ["while", "blending", "movej", "pose", "$PI", "socket", "setdoimv"] {
            assert!(text.split_whitespace().any(|word| word == name), "{name}");
        }
        assert!(text.lines().all(|line| line.chars().count() <= 115), "{text}");
    }
}
