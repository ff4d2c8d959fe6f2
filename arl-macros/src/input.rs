//! The parts of an invocation.

use proc_macro::{Delimiter, Literal, Spacing, TokenStream, TokenTree};

/// The forms of `arl!`.
pub(crate) enum Form {
    /// `arl! { program }`
    Program(Vec<TokenTree>),
    /// `arl!(cx, { statements })`
    Statements {
        /// The Rust expression for the context.
        context: TokenStream,
        /// The statements.
        statements: Vec<TokenTree>,
    },
    /// `arl!(r#"program"#)`
    ProgramText(Literal),
    /// `arl!(cx, r#"statements"#)`
    StatementsText {
        /// The Rust expression for the context.
        context: TokenStream,
        /// The statements.
        text: Literal,
    },
}

impl Form {
    /// Distinguishes the forms: a lone string literal is a program; a comma followed by a last group in braces (or a
    /// string literal) means statements.
    pub(crate) fn of(input: TokenStream) -> Self {
        let mut tokens: Vec<TokenTree> = input.into_iter().collect();
        if tokens.len() == 1
            && let Some(text) = tokens.first().and_then(as_text)
        {
            return Form::ProgramText(text);
        }
        let comma = tokens.len().checked_sub(2).filter(|comma| is_comma(tokens.get(*comma)) && *comma > 0);
        let Some(comma) = comma else { return Form::Program(tokens) };
        let Some(last) = tokens.pop() else { return Form::Program(tokens) };
        let context = || tokens.iter().take(comma).cloned().collect();
        if let Some(text) = as_text(&last) {
            return Form::StatementsText { context: context(), text };
        }
        match &last {
            TokenTree::Group(group) if group.delimiter() == Delimiter::Brace => {
                Form::Statements { context: context(), statements: group.stream().into_iter().collect() }
            }
            _ => {
                tokens.push(last);
                Form::Program(tokens)
            }
        }
    }
}

fn is_comma(token: Option<&TokenTree>) -> bool {
    matches!(token, Some(TokenTree::Punct(punct)) if punct.as_char() == ',')
}

/// A string literal, also if passed as `$text:literal`.
pub(crate) fn as_text(token: &TokenTree) -> Option<Literal> {
    match token {
        TokenTree::Literal(literal) => {
            let text = literal.to_string();
            (text.starts_with('"') || text.starts_with("r\"") || text.starts_with("r#")).then(|| literal.clone())
        }
        TokenTree::Group(group) if group.delimiter() == Delimiter::None => {
            let mut inside = group.stream().into_iter();
            match (inside.next(), inside.next()) {
                (Some(token), None) => as_text(&token),
                _ => None,
            }
        }
        _ => None,
    }
}

/// `#![scara]` at the beginning: the number of its leaves, and the word. `[` and `]` are leaves, too.
pub(crate) fn attribute(tokens: &[TokenTree]) -> Option<(usize, proc_macro::Ident)> {
    match tokens {
        [TokenTree::Punct(hash), TokenTree::Punct(bang), TokenTree::Group(group), ..]
            if hash.as_char() == '#'
                && bang.as_char() == '!'
                && bang.spacing() == Spacing::Alone
                && group.delimiter() == Delimiter::Bracket =>
        {
            let mut inside = group.stream().into_iter();
            match (inside.next(), inside.next()) {
                (Some(TokenTree::Ident(word)), None) => Some((5, word)),
                _ => None,
            }
        }
        _ => None,
    }
}
