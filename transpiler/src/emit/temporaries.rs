//! The temporaries of a statement, each with its own name.

use std::collections::{HashMap, HashSet};

/// From this number of temporaries in a statement on, the search for a new name does not start from the beginning.
const MANY: usize = 32;

/// The names of a statement's temporaries, in the order in which they were assigned.
#[derive(Default, Debug)]
pub(super) struct Temporaries {
    given: Vec<Given>,
    names: HashSet<String>,
    /// For each word, the number at which the search for a free name starts.
    next: HashMap<String, usize>,
}

#[derive(Debug)]
struct Given {
    name: String,
    word: String,
    /// The previous `next` of the word.
    before: Option<usize>,
}

impl Temporaries {
    /// Assigns a name: the word itself, or the word followed by a number, such that it is unused and not `is_taken`.
    pub(super) fn give(&mut self, word: &str, is_taken: impl Fn(&str) -> bool) -> String {
        let before = self.next.get(word).copied();
        let mut number = before.filter(|_| self.given.len() >= MANY).unwrap_or(1);
        let mut name = numbered(word, number);
        while self.names.contains(&name) || is_taken(&name) {
            number += 1;
            name = numbered(word, number);
        }
        self.next.insert(word.to_owned(), number + 1);
        self.names.insert(name.clone());
        self.given.push(Given { name: name.clone(), word: word.to_owned(), before });
        name
    }

    /// The number of temporaries.
    pub(super) fn len(&self) -> usize {
        self.given.len()
    }

    /// Releases all temporaries but the first `len`.
    pub(super) fn truncate(&mut self, len: usize) {
        while self.given.len() > len
            && let Some(Given { name, word, before }) = self.given.pop()
        {
            self.names.remove(&name);
            match before {
                Some(before) => self.next.insert(word, before),
                None => self.next.remove(&word),
            };
        }
    }
}

fn numbered(word: &str, number: usize) -> String {
    if number == 1 { word.to_owned() } else { format!("{word}{number}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_given_once_and_taken_back() {
        let mut temporaries = Temporaries::default();
        let is_taken = |name: &str| name == "out2";
        let names: Vec<String> = (0..MANY + 3).map(|_| temporaries.give("out", is_taken)).collect();
        assert_eq!(names[..3], ["out", "out3", "out4"]);
        assert_eq!(names.iter().collect::<HashSet<_>>().len(), names.len());
        temporaries.truncate(1);
        assert_eq!(temporaries.len(), 1);
        assert_eq!(temporaries.give("out", is_taken), "out3");
    }
}
