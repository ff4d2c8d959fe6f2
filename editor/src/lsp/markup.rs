//! Texts for people, as the client can show them: Markdown, or plain text.

use gen_lsp_types::*;

/// For which texts a client shows Markdown, as far as it says so.
#[derive(Clone, Copy, Default, Debug)]
pub(super) struct Formats {
    pub(super) hover: Format,
    pub(super) completion: Format,
    pub(super) signature: Format,
}

/// How a text is written.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub(super) enum Format {
    Markdown,
    #[default]
    Plain,
}

impl Formats {
    /// Reads the capabilities of a client.
    pub(super) fn of(text: Option<&TextDocumentClientCapabilities>) -> Self {
        let hover = || text?.hover.as_ref()?.content_format.as_deref();
        let item = || text?.completion.as_ref()?.completion_item.as_ref()?.documentation_format.as_deref();
        let signature =
            || text?.signature_help.as_ref()?.signature_information.as_ref()?.documentation_format.as_deref();
        Self { hover: Format::of(hover()), completion: Format::of(item()), signature: Format::of(signature()) }
    }
}

impl Format {
    fn of(shown: Option<&[MarkupKind]>) -> Self {
        match shown {
            Some(kinds) if kinds.contains(&MarkupKind::Markdown) => Self::Markdown,
            _ => Self::Plain,
        }
    }

    /// A text that is written in Markdown, in this format.
    pub(super) fn content(self, markdown: String) -> MarkupContent {
        match self {
            Self::Markdown => MarkupContent { kind: MarkupKind::Markdown, value: markdown },
            Self::Plain => MarkupContent { kind: MarkupKind::PlainText, value: plain(&markdown) },
        }
    }

    /// The same for the documentation of an item. A text without a kind is one that all clients show.
    pub(super) fn documentation(self, markdown: String) -> Documentation {
        match self {
            Self::Markdown => Documentation::MarkupContent(self.content(markdown)),
            Self::Plain => Documentation::String(plain(&markdown)),
        }
    }
}

/// The text without its marks: fences, backticks, bold, the targets of links, escapes.
fn plain(markdown: &str) -> String {
    let mut out = String::new();
    let mut fenced = false;
    for line in markdown.lines() {
        if line.trim_start().starts_with("```") {
            fenced = !fenced;
            continue;
        }
        if fenced {
            out.push_str(line)
        } else {
            unmarked(line.trim_start_matches('#').trim_start(), &mut out)
        }
        out.push('\n');
    }
    out.trim_end().to_owned()
}

/// A line of prose; text in backticks stays as it is.
fn unmarked(line: &str, out: &mut String) {
    for (at, part) in line.split('`').enumerate() {
        if at % 2 == 1 {
            out.push_str(part);
            continue;
        }
        let mut rest = part;
        while let Some(start) = rest.find(['*', '[', '\\']) {
            let (before, mark) = rest.split_at(start);
            out.push_str(before);
            rest = if let Some(after) = mark.strip_prefix("**") {
                after
            } else if let Some(after) = mark.strip_prefix('\\') {
                let letter = after.chars().next().map_or(0, char::len_utf8);
                let (letter, after) = after.split_at(letter);
                out.push_str(letter);
                after
            } else if let Some((words, after)) = link(mark) {
                out.push_str(words);
                after
            } else {
                let (letter, after) = mark.split_at(1);
                out.push_str(letter);
                after
            };
        }
        out.push_str(rest);
    }
}

/// The words of a link at the start of a text, and what follows it.
fn link(text: &str) -> Option<(&str, &str)> {
    let (words, rest) = text.strip_prefix('[')?.split_once(']')?;
    let (_, rest) = rest.strip_prefix('(')?.split_once(')')?;
    Some((words, rest))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plain_texts_have_no_marks() {
        for (markdown, text) in [
            (
                "```arl\nmovej home, vp:5%\n```\n\nMoves **all** axes, see [lin](lin.md).",
                "movej home, vp:5%\n\nMoves all axes, see lin.",
            ),
            ("## Title\nuse `a * b[0]` here", "Title\nuse a * b[0] here"),
            ("2 * 3, a[1] and \\*", "2 * 3, a[1] and *"),
        ] {
            assert_eq!(plain(markdown), text, "{markdown}");
        }
    }
}
