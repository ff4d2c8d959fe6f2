//! The tokens of an invocation as a flat list, with their positions in the Rust file.

use proc_macro::{Delimiter, Group, Span, TokenStream, TokenTree};

/// A token that is not a group, or a delimiter of a group.
#[derive(Clone, Debug)]
pub(crate) struct Leaf<S> {
    /// Its text.
    pub(crate) text: String,
    /// Line and column, both from 1, in characters.
    pub(crate) start: (usize, usize),
    /// The position after its last character.
    pub(crate) end: (usize, usize),
    /// The span that rustc underlines.
    pub(crate) span: S,
}

/// All leaves in the order of the text.
pub(crate) fn leaves(tokens: TokenStream) -> Vec<Leaf<Span>> {
    let mut all = Vec::new();
    add(tokens, &mut all);
    all
}

fn add(tokens: TokenStream, all: &mut Vec<Leaf<Span>>) {
    for token in tokens {
        match token {
            TokenTree::Group(group) => {
                let (open, close) = delimiters(&group);
                all.extend(open.map(|text| leaf(text, group.span_open())));
                add(group.stream(), all);
                all.extend(close.map(|text| leaf(text, group.span_close())));
            }
            other => all.push(leaf(&other.to_string(), other.span())),
        }
    }
}

fn delimiters(group: &Group) -> (Option<&'static str>, Option<&'static str>) {
    match group.delimiter() {
        Delimiter::Parenthesis => (Some("("), Some(")")),
        Delimiter::Brace => (Some("{"), Some("}")),
        Delimiter::Bracket => (Some("["), Some("]")),
        Delimiter::None => (None, None),
    }
}

fn leaf(text: &str, span: Span) -> Leaf<Span> {
    let (start, end) = (span.start(), span.end());
    Leaf { text: text.into(), start: (start.line(), start.column()), end: (end.line(), end.column()), span }
}
