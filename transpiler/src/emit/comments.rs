//! The lines of the ARL program as comments.
//!
//! prettyplease drops comments, so markers stand in for them until the text is printed: macro calls whose name no ARL
//! name can take, as those are lower case.

use proc_macro2::{Group, Literal, TokenStream, TokenTree};
use quote::quote;
use std::cell::RefCell;

const NAME: &str = "ARL__";
const MARK: &str = "ARL__!(";

/// The texts that the markers stand for.
#[derive(Default, Debug)]
pub(super) struct Comments {
    texts: RefCell<Vec<String>>,
}

impl Comments {
    /// A marker for these lines, as a statement or an item.
    pub(super) fn mark(&self, text: String) -> TokenStream {
        let number = self.number(text);
        quote!(ARL__!(#number);)
    }

    /// A marker in front of a `match` arm.
    pub(super) fn mark_arm(&self, text: String) -> TokenStream {
        let number = self.number(text);
        quote!(ARL__!(#number) => {})
    }

    fn number(&self, text: String) -> Literal {
        let mut texts = self.texts.borrow_mut();
        texts.push(text);
        Literal::usize_unsuffixed(texts.len() - 1)
    }

    /// Puts the comments into the printed text.
    pub(super) fn fill(&self, printed: &str) -> String {
        let texts = self.texts.borrow();
        let mut out = String::with_capacity(printed.len() * 2);
        for line in printed.lines() {
            let code = line.trim_start();
            let marked = code.strip_prefix(MARK).and_then(|rest| rest.split_once(')')).map(|(number, _)| number);
            match marked.and_then(|number| number.parse().ok()).and_then(|number: usize| texts.get(number)) {
                Some(text) if text.is_empty() => {
                    // No blank line at the start of a block.
                    if !out.ends_with("{\n") {
                        out.push('\n');
                    }
                }
                Some(text) => {
                    let indent = line.get(..line.len() - code.len()).unwrap_or("");
                    for comment in text.lines() {
                        out.push_str(indent);
                        out.push_str("// ");
                        out.push_str(comment);
                        out.push('\n');
                    }
                }
                None => {
                    out.push_str(line);
                    out.push('\n');
                }
            }
        }
        out
    }
}

/// The code without markers.
pub(super) fn without_marks(code: TokenStream) -> TokenStream {
    let mut out = TokenStream::new();
    let mut tokens = code.into_iter().peekable();
    while let Some(token) = tokens.next() {
        match token {
            TokenTree::Ident(word) if word == NAME => {
                // `!`, the number, and `;` or `=> {}`.
                let rest = [tokens.next(), tokens.next(), tokens.next()];
                if matches!(rest.last(), Some(Some(TokenTree::Punct(sign))) if sign.as_char() == '=') {
                    tokens.next();
                    tokens.next();
                }
            }
            TokenTree::Group(group) => {
                let mut inner = Group::new(group.delimiter(), without_marks(group.stream()));
                inner.set_span(group.span());
                out.extend([TokenTree::Group(inner)]);
            }
            token => out.extend([token]),
        }
    }
    out
}

/// A line of a program, fit for a comment: long ones are cut, control characters and those that turn the direction of text become `?`.
pub(super) fn clean(line: &str) -> String {
    let unfit = |c: char| {
        c.is_control() || matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{200e}' | '\u{200f}')
    };
    const MOST: usize = 140;
    let line = line.trim();
    let long = line.chars().count() > MOST;
    let shown = line.chars().take(if long { MOST } else { usize::MAX });
    let fit: String = shown.map(|c| if c == '\t' { ' ' } else { c }).map(|c| if unfit(c) { '?' } else { c }).collect();
    if long { format!("{fit} ...") } else { fit }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markers_become_comments() {
        let comments = Comments::default();
        comments.mark("3: x = 1\n4: y".into());
        comments.mark(String::new());
        let printed = "fn f() {\n    ARL__!(0);\n    x = 1;\n}\nARL__!(1);\nlet s = \"ARL__!(0);\";\nARL__!(7);\n";
        let expected = "fn f() {\n    // 3: x = 1\n    // 4: y\n    x = 1;\n}\n\nlet s = \"ARL__!(0);\";\nARL__!(7);\n";
        assert_eq!(comments.fill(printed), expected);
    }

    #[test]
    fn odd_characters_do_not_get_into_comments() {
        assert_eq!(clean("\ta\u{202e}b\tc\u{7}\r\n"), "a?b c?");
    }
}
