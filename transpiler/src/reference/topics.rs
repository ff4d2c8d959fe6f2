//! The pages about the language: statements, types, operators, and general rules.

use arl_lang::catalog;

/// A page about the language.
#[derive(Clone, Copy, Debug)]
pub struct Topic {
    /// The name of its file, without `.md`.
    pub name: &'static str,
    /// The page, in Markdown.
    pub text: &'static str,
}

/// Pages that have something in common.
pub(super) struct Area {
    pub(super) title: &'static str,
    pub(super) topics: &'static [Topic],
}

macro_rules! areas {
    ($($title:literal $folder:literal: $($name:literal)+;)+) => {
        /// All pages, in the order in which they are listed.
        pub(super) const AREAS: &[Area] = &[$(Area {
            title: $title,
            topics: &[$(Topic {
                name: $name,
                text: include_str!(concat!("../../docs/reference/", $folder, "/", $name, ".md")),
            }),+],
        }),+];
    };
}

areas! {
    "Statements" "statements":
        "program" "comments" "variables" "assignment" "func" "return" "if" "switch" "while" "for" "repeat" "loop"
        "break" "continue" "goto" "import";
    "Types" "types":
        "bool" "byte" "int" "uint" "double" "string" "void" "enumeration" "structure" "array" "handle" "conversions";
    "Operators" "operators":
        "arithmetic" "comparison" "logic" "bits" "precedence" "access" "arguments" "braces";
    "Text of a program" "rules":
        "names" "numbers" "text" "units" "unset" "scope" "modules" "data-files";
    "Motion" "rules":
        "motion" "first-motion" "targets" "orientation" "configuration" "frames" "speed" "blending" "modal" "waiting"
        "motion-events";
    "Running" "rules":
        "io" "conditions" "interrupts" "channels" "system-variables" "files" "alarms" "projects" "robot-file" "cell-file"
        "scenarios" "tests" "randomness-and-time";
}

/// All pages.
pub(super) fn all() -> impl Iterator<Item = &'static Topic> {
    AREAS.iter().flat_map(|area| area.topics)
}

impl Topic {
    /// The page about a word of a control structure.
    pub fn of_keyword(word: &str) -> Option<&'static Topic> {
        arl_lang::control_word(word)?;
        all().find(|topic| topic.words().any(|other| other == word))
    }

    /// The title.
    pub(super) fn title(&self) -> &'static str {
        self.text.lines().next().unwrap_or_default().trim_start_matches("# ")
    }

    /// The first sentence.
    pub(super) fn summary(&self) -> String {
        let paragraph = self.text.split("\n\n").nth(1).unwrap_or_default().replace('\n', " ");
        first_sentence(&paragraph).to_owned()
    }

    /// The names by which the page is found, including the name of its file.
    pub(super) fn words(&self) -> impl Iterator<Item = &'static str> {
        let line = self.text.lines().find_map(|line| line.strip_prefix("Words: ")).unwrap_or_default();
        let words = line.split('`').skip(1).step_by(2);
        std::iter::once(self.name).chain(words.filter(|word| *word != self.name))
    }

    /// Whether the page is found by this name.
    pub(super) fn is_called(&self, name: &str) -> bool {
        self.words().any(|word| word.eq_ignore_ascii_case(name))
    }

    /// The page as shown: without the parts that only the test of its examples needs.
    pub fn shown(&self) -> String {
        let mut text = String::with_capacity(self.text.len());
        for line in self.text.lines().filter(|line| !line.starts_with("Words: ")) {
            let fence = line.strip_prefix("```").and_then(|info| info.split_once(' '));
            match fence {
                Some((language, _)) => text.push_str(&format!("```{language}")),
                None => text.push_str(line),
            }
            text.push('\n');
        }
        text
    }
}

/// A text up to the end of its first sentence.
pub(super) fn first_sentence(text: &str) -> &str {
    let end = text.match_indices(". ").map(|(at, _)| at + 1).next();
    text.get(..end.unwrap_or(text.len())).unwrap_or(text)
}

/// The first sentence about an entry of the catalog.
pub(super) fn summary_of(entry: &catalog::Entry) -> &'static str {
    first_sentence(entry.doc)
}
