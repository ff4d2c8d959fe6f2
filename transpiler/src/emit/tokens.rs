//! Searches emitted code.

use proc_macro2::{Ident, Spacing, TokenStream, TokenTree};

/// Whether a name occurs in the code.
pub(super) fn mentions(code: &TokenStream, name: &str) -> bool {
    code.clone().into_iter().any(|token| match token {
        TokenTree::Ident(word) => word == name,
        TokenTree::Group(group) => mentions(&group.stream(), name),
        _ => false,
    })
}

/// Whether a variable of this name occurs in the code: not a field, a method or a part of a path.
pub(super) fn uses_variable(code: &TokenStream, name: &str) -> bool {
    // `.` before a name makes it a field, `..` does not; `::` makes it a part of a path, `:` does not.
    let (mut inside, mut joined) = (false, None);
    code.clone().into_iter().any(|token| match token {
        TokenTree::Punct(sign) => {
            let double = joined == Some(sign.as_char());
            inside = match sign.as_char() {
                '.' => !double,
                ':' => double,
                _ => false,
            };
            joined = (sign.spacing() == Spacing::Joint).then(|| sign.as_char());
            false
        }
        TokenTree::Ident(word) => {
            joined = None;
            !std::mem::take(&mut inside) && word == name
        }
        TokenTree::Group(group) => {
            (inside, joined) = (false, None);
            uses_variable(&group.stream(), name)
        }
        TokenTree::Literal(_) => {
            (inside, joined) = (false, None);
            false
        }
    })
}

/// Whether the code names the machine's label.
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

/// Calls `found` for each word of the code.
pub(super) fn each_word(code: &TokenStream, found: &mut dyn FnMut(&Ident)) {
    for token in code.clone() {
        match token {
            TokenTree::Ident(word) => found(&word),
            TokenTree::Group(group) => each_word(&group.stream(), found),
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use quote::quote;

    #[test]
    fn fields_methods_and_paths_are_no_variables() {
        let uses = |code: TokenStream| uses_variable(&code, "line");
        assert!(uses(quote!(cx.line(FILE, line))));
        assert!(uses(quote!(Pose { x: line, y })) && uses(quote!(for i in 0..line {})) && uses(quote!(line.x)));
        assert!(!uses(quote!(cx.line(FILE, 3))) && !uses(quote!(super::line(cx))) && !uses(quote!(g.prog.line.get())));
    }
}
