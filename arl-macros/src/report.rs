//! Errors and warnings as Rust code that makes rustc show them on the right tokens.

use arl2rs::diagnostics::{Diagnostic, Severity};
use proc_macro::Span;
use proc_macro2::{Group, Ident, Literal, Punct, Spacing, TokenStream, TokenTree};

/// The range that rustc underlines: from the first token to the last.
#[derive(Clone, Copy)]
pub(crate) struct Place {
    /// The first token.
    pub(crate) first: Span,
    /// The last token.
    pub(crate) last: Span,
}

impl Place {
    /// One token.
    pub(crate) fn one(span: Span) -> Self {
        Self { first: span, last: span }
    }
}

/// The text for rustc: what is wrong, other positions, what would be correct.
pub(crate) fn words(diagnostic: &Diagnostic, line: impl Fn(&arl2rs::diagnostics::Label) -> String) -> String {
    let mut text = format!("{}: {}", diagnostic.code, diagnostic.message);
    for label in &diagnostic.labels {
        text += &format!("\nnote: {}: {}", line(label), label.text);
    }
    if let Some(help) = &diagnostic.help {
        text += &format!("\nhelp: {help}");
    }
    text
}

/// The Rust code that shows the diagnostic: `compile_error!` or the use of a deprecated constant.
pub(crate) fn shown(diagnostic: &Diagnostic, text: &str, place: Place) -> TokenStream {
    match diagnostic.severity {
        Severity::Error => error(text, place),
        Severity::Warning => warning(&diagnostic.code.to_string(), text, place),
    }
}

/// `::core::compile_error!{"text"}`: rustc underlines from the first token of the path to the group.
pub(crate) fn error(text: &str, place: Place) -> TokenStream {
    let (first, last) = (place.first.into(), place.last.into());
    let mut message = TokenTree::Literal(Literal::string(text));
    message.set_span(last);
    let mut group = Group::new(proc_macro2::Delimiter::Brace, message.into());
    group.set_span(last);
    let mut tokens = TokenStream::new();
    for name in ["core", "compile_error"] {
        for spacing in [Spacing::Joint, Spacing::Alone] {
            let mut colon = Punct::new(':', spacing);
            colon.set_span(first);
            tokens.extend([TokenTree::Punct(colon)]);
        }
        tokens.extend([TokenTree::Ident(Ident::new(name, first))]);
    }
    let mut bang = Punct::new('!', Spacing::Alone);
    bang.set_span(last);
    tokens.extend([TokenTree::Punct(bang), TokenTree::Group(group)]);
    tokens
}

/// The use of a constant whose deprecation note is the text. Its name is the code.
fn warning(code: &str, text: &str, place: Place) -> TokenStream {
    let name = Ident::new(code, place.first.into());
    let declared = Ident::new(code, proc_macro2::Span::call_site());
    quote::quote! {
        const _: () = {
            #[deprecated(note = #text)]
            #[allow(non_upper_case_globals)]
            const #declared: () = ();
            #name
        };
    }
}
