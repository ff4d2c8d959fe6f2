//! Text that bypasses the printer: the lines of the ARL program as comments, and the rows of tables.
//!
//! prettyplease drops comments and is slow for long tables. Markers therefore replace both until the text is printed:
//! macro calls whose name cannot be an ARL name, as those are lower case.

use super::names::ident;
use proc_macro2::{Group, Literal, TokenStream, TokenTree};
use quote::quote;
use std::cell::RefCell;

const COMMENT: &str = "ARL__";
const ROWS: &str = "ARL_ROWS__";
const COMMENT_CALL: &str = "ARL__!(";
const ROWS_CALL: &str = "= ARL_ROWS__!(";

/// The texts that the markers stand for.
#[derive(Default, Debug)]
pub(super) struct Marks {
    texts: RefCell<Vec<String>>,
}

impl Marks {
    /// A marker for these lines, as a statement or an item.
    pub(super) fn comment(&self, text: String) -> TokenStream {
        let (name, number) = (ident(COMMENT), self.number(text));
        quote!(#name!(#number);)
    }

    /// A marker before a `match` arm.
    pub(super) fn comment_of_arm(&self, text: String) -> TokenStream {
        let (name, number) = (ident(COMMENT), self.number(text));
        quote!(#name!(#number) => {})
    }

    /// A marker for an array of these rows, one per line and each with its comma: the value of a `static`.
    pub(super) fn rows(&self, rows: String) -> TokenStream {
        let (name, number) = (ident(ROWS), self.number(rows));
        quote!(#name!(#number))
    }

    fn number(&self, text: String) -> Literal {
        let mut texts = self.texts.borrow_mut();
        texts.push(text);
        Literal::usize_unsuffixed(texts.len() - 1)
    }

    /// Inserts the comments and the rows into the printed text.
    pub(super) fn fill(&self, printed: &str) -> String {
        let texts = self.texts.borrow();
        let text_of =
            |rest: &str| rest.split_once(')').and_then(|(number, _)| texts.get(number.parse::<usize>().ok()?));
        let mut out = String::with_capacity(printed.len() * 2);
        let mut lines = printed.lines();
        while let Some(line) = lines.next() {
            let code = line.trim_start();
            let indent = line.get(..line.len() - code.len()).unwrap_or("");
            if let Some(text) = code.strip_prefix(COMMENT_CALL).and_then(text_of) {
                put_comment(&mut out, indent, text);
            } else if let Some((front, rest)) = rows_call(code) {
                // A long line is broken after the parenthesis.
                let broken = rest.is_empty().then(|| lines.by_ref().take(2).map(str::trim).collect::<String>());
                let rows = text_of(broken.as_deref().unwrap_or(rest));
                put_rows(&mut out, indent, front, rows.map_or("", String::as_str));
            } else {
                out.push_str(line);
                out.push('\n');
            }
        }
        out
    }

    /// The code with the rows in place of their markers, and without comments.
    pub(super) fn without_comments(&self, code: TokenStream) -> TokenStream {
        let mut out = TokenStream::new();
        let mut tokens = code.into_iter().peekable();
        while let Some(token) = tokens.next() {
            match token {
                TokenTree::Ident(word) if word == COMMENT => {
                    // `!`, the number, and `;` or `=> {}`.
                    let rest = [tokens.next(), tokens.next(), tokens.next()];
                    if matches!(rest.last(), Some(Some(TokenTree::Punct(sign))) if sign.as_char() == '=') {
                        tokens.next();
                        tokens.next();
                    }
                }
                TokenTree::Ident(word) if word == ROWS => {
                    // `!`, the number.
                    tokens.next();
                    let number = tokens.next().map(|number| number.to_string()).unwrap_or_default();
                    let number = number.trim_matches(['(', ')']).trim().parse::<usize>().ok();
                    let rows = number.and_then(|number| self.texts.borrow().get(number)?.parse::<TokenStream>().ok());
                    out.extend(quote!([#rows]));
                }
                TokenTree::Group(group) => {
                    let mut inner = Group::new(group.delimiter(), self.without_comments(group.stream()));
                    inner.set_span(group.span());
                    out.extend([TokenTree::Group(inner)]);
                }
                token => out.extend([token]),
            }
        }
        out
    }
}

/// The start of a line that sets a `static` to rows, and the text after the marker's parenthesis. No line of a string
/// can begin like this, as strings are escaped.
fn rows_call(code: &str) -> Option<(&str, &str)> {
    let (front, rest) = code.split_once(ROWS_CALL)?;
    code.starts_with("static ").then_some((front, rest))
}

fn put_comment(out: &mut String, indent: &str, text: &str) {
    if text.is_empty() {
        // No blank line at the start of a block.
        if !out.ends_with("{\n") {
            out.push('\n');
        }
        return;
    }
    for comment in text.lines() {
        out.extend([indent, "// ", comment, "\n"]);
    }
}

fn put_rows(out: &mut String, indent: &str, front: &str, rows: &str) {
    out.extend([indent, front, "= [\n"]);
    for row in rows.lines() {
        out.extend([indent, "    ", row, "\n"]);
    }
    out.extend([indent, "];\n"]);
}

/// A line of a program as the text of a comment: long lines are cut, control characters and those that change the
/// direction of text become `?`.
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
        let marks = Marks::default();
        marks.comment("3: x = 1\n4: y".into());
        marks.comment(String::new());
        let printed = "fn f() {\n    ARL__!(0);\n    x = 1;\n}\nARL__!(1);\nlet s = \"ARL__!(0);\";\nARL__!(7);\n";
        let expected = "fn f() {\n    // 3: x = 1\n    // 4: y\n    x = 1;\n}\n\nlet s = \"ARL__!(0);\";\nARL__!(7);\n";
        assert_eq!(marks.fill(printed), expected);
    }

    #[test]
    fn markers_become_rows() {
        let marks = Marks::default();
        let rows = marks.rows("(1, -2.5),\n(2, 3.0)".into());
        let printed = "    static ROWS: [(u32, f64); 2] = ARL_ROWS__!(0);\nlet s = \"= ARL_ROWS__!(0);\";\n";
        let expected = "    static ROWS: [(u32, f64); 2] = [\n        (1, -2.5),\n        (2, 3.0)\n    ];\n\
                        let s = \"= ARL_ROWS__!(0);\";\n";
        assert_eq!(marks.fill(printed), expected);
        let broken = "static ROWS: [(u32, f64); 2] = ARL_ROWS__!(\n    0\n);\nlet x = 1;\n";
        let expected = "static ROWS: [(u32, f64); 2] = [\n    (1, -2.5),\n    (2, 3.0)\n];\nlet x = 1;\n";
        assert_eq!(marks.fill(broken), expected);
        let comment = marks.comment("1: lin".into());
        let code = marks.without_comments(quote!(#comment static ROWS: [(u32, f64); 2] = #rows;));
        let expected = quote!(
            static ROWS: [(u32, f64); 2] = [(1, -2.5), (2, 3.0)];
        );
        assert_eq!(code.to_string(), expected.to_string());
    }

    #[test]
    fn odd_characters_do_not_get_into_comments() {
        assert_eq!(clean("\ta\u{202e}b\tc\u{7}\r\n"), "a?b c?");
    }
}
