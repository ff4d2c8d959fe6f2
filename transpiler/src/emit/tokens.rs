//! What stands in emitted code.

use proc_macro2::{Ident, TokenStream, TokenTree};

/// Whether a name occurs in the code.
pub(super) fn mentions(code: &TokenStream, name: &str) -> bool {
    code.clone().into_iter().any(|token| match token {
        TokenTree::Ident(word) => word == name,
        TokenTree::Group(group) => mentions(&group.stream(), name),
        _ => false,
    })
}

/// Whether the machine's label is named.
pub(super) fn jumps(code: &TokenStream) -> bool {
    let mut quoted = false;
    code.clone().into_iter().any(|token| match token {
        TokenTree::Ident(word) => std::mem::take(&mut quoted) && word == "machine",
        TokenTree::Group(group) => jumps(&group.stream()),
        TokenTree::Punct(sign) => {
            quoted = sign.as_char() == '\'';
            false
        }
        TokenTree::Literal(_) => false,
    })
}

/// Shows each word of the code.
pub(super) fn each_word(code: &TokenStream, found: &mut dyn FnMut(&Ident)) {
    for token in code.clone() {
        match token {
            TokenTree::Ident(word) => found(&word),
            TokenTree::Group(group) => each_word(&group.stream(), found),
            _ => {}
        }
    }
}
