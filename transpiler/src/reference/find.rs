//! Finds pages by name.

use crate::near::nearest;
use crate::reference::topics::all;
use arl_lang::catalog;

/// All pages for a name: those of built-ins and those about the language.
pub fn page(name: &str) -> Option<String> {
    let name = name.trim();
    let mut parts: Vec<String> = catalog::reference::page(name).into_iter().collect();
    // `$IN` is a word of another language that leads to a page.
    parts.extend(all().filter(|topic| topic.is_called(name)).map(|topic| topic.shown()));
    (!parts.is_empty()).then(|| parts.join("\n"))
}

/// The name that was probably meant.
pub fn suggestion(name: &str) -> Option<String> {
    let entries = catalog::all_entries().iter().map(|entry| entry.name);
    let types = catalog::type_names().map(|(name, _)| name);
    let topics = all().flat_map(|topic| topic.words());
    let bare = name.trim_start_matches('$');
    let plain = nearest(name, entries.chain(types)).or_else(|| nearest(name, topics)).map(String::from);
    let variable = || nearest(bare, catalog::system_variables().map(|variable| variable.name));
    let system = if name.starts_with('$') || plain.is_none() { variable() } else { None };
    system.map(|name| format!("${name}")).or(plain)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_word_of_the_language_has_a_page() {
        let types = catalog::type_names().map(|(name, _)| name);
        let operators = "+ - * / % == != < <= > >= && || ! & | ^ ~ << >> = += -= *= /= %= &= |= ^= <<= >>= ++ -- \
             . :: [ ] ( ) { } : ; \\ // /* $";
        for word in arl_lang::control_words().chain(types).chain(operators.split(' ').filter(|sign| !sign.is_empty())) {
            assert!(page(word).is_some(), "{word}");
        }
    }

    #[test]
    fn names_of_built_in_things_go_first() {
        let text = page("WHILE").unwrap();
        assert!(text.starts_with("# while\n") && !text.contains("Words:"), "{text}");
        assert!(page("lin").unwrap().starts_with("### `lin`"));
        assert_eq!(page("nonsense"), None);
    }

    #[test]
    fn what_was_probably_meant() {
        assert_eq!(suggestion("whille").as_deref(), Some("while"));
        assert_eq!(suggestion("$TRAJ_LEFT_DIST").as_deref(), Some("$TRAJ_LEFT_DIS"));
        assert_eq!(suggestion("traj_left_dist").as_deref(), Some("$TRAJ_LEFT_DIS"));
        assert_eq!(suggestion("xyzzyxyzzy"), None);
    }
}
