//! Pieces of Rust code with the information needed to combine them: precedence and preceding statements.

use proc_macro2::TokenStream;
use quote::quote;

/// How tightly an expression binds; a piece that binds less tightly than its place requires is put in parentheses.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) enum Precedence {
    Or,
    And,
    Compare,
    BitOr,
    BitXor,
    BitAnd,
    Shift,
    Sum,
    Product,
    Cast,
    Unary,
    Postfix,
}

impl Precedence {
    /// The next tighter precedence.
    pub(super) fn tighter(self) -> Self {
        use Precedence::*;
        match self {
            Or => And,
            And => Compare,
            Compare => BitOr,
            BitOr => BitXor,
            BitXor => BitAnd,
            BitAnd => Shift,
            Shift => Sum,
            Sum => Product,
            Product => Cast,
            Cast => Unary,
            Unary | Postfix => Postfix,
        }
    }
}

/// An expression in Rust.
#[derive(Clone, Debug)]
pub(super) struct Fragment {
    /// Statements that have to run first.
    pub(super) before: TokenStream,
    /// The expression.
    pub(super) tokens: TokenStream,
    /// How tightly it binds.
    pub(super) precedence: Precedence,
    /// Whether it is a constant or a temporary, so that it may be evaluated later with the same result.
    pub(super) settled: bool,
}

impl Fragment {
    /// A piece with this precedence.
    pub(super) fn new(tokens: TokenStream, precedence: Precedence) -> Self {
        Self { before: TokenStream::new(), tokens, precedence, settled: false }
    }

    /// A path, a call, a literal.
    pub(super) fn postfix(tokens: TokenStream) -> Self {
        Self::new(tokens, Precedence::Postfix)
    }

    /// A constant or temporary.
    pub(super) fn settled(tokens: TokenStream) -> Self {
        Self { settled: true, ..Self::postfix(tokens) }
    }

    /// The same expression, with statements before the existing ones.
    pub(super) fn after(mut self, before: TokenStream) -> Self {
        let own = std::mem::take(&mut self.before);
        self.before = quote!(#before #own);
        self
    }

    /// The expression at a place that requires at least the precedence `least`, in parentheses if necessary. The caller
    /// handles the statements before it.
    pub(super) fn at(&self, least: Precedence) -> TokenStream {
        let tokens = &self.tokens;
        if self.precedence < least { quote!((#tokens)) } else { tokens.clone() }
    }

    /// The expression as the receiver of a method or the base of a field.
    pub(super) fn receiver(&self) -> TokenStream {
        self.at(Precedence::Postfix)
    }

    /// A piece that contains its statements, as a block.
    pub(super) fn inline(self) -> Fragment {
        if self.before.is_empty() {
            return self;
        }
        let (before, tokens) = (&self.before, &self.tokens);
        Fragment::postfix(quote!({ #before #tokens }))
    }

    /// The changed expression, with the statements kept.
    pub(super) fn map(self, precedence: Precedence, change: impl FnOnce(&Fragment) -> TokenStream) -> Fragment {
        let tokens = change(&self);
        Fragment { before: self.before, tokens, precedence, settled: self.settled }
    }
}
