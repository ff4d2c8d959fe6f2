//! `switch`: a `match` if Rust has patterns for the values, a chain of comparisons for strings.

use super::body::Body;
use super::consts::constant;
use super::control_flow::Tail;
use super::fragment::Fragment;
use super::sequence::Mode;
use crate::effects::flow;
use crate::hir::{Arm, Expr, ExprKind, Stmt, StmtKind, Value};
use arl_lang::catalog::Base;
use proc_macro2::TokenStream;
use quote::quote;

impl<'p> Body<'p, '_> {
    /// `switch(subject)` with its arms; the arm without a value goes last, wherever it stands.
    pub(super) fn switch(&mut self, subject: &'p Expr, arms: &'p [Arm], tail: Tail) -> TokenStream {
        self.stand_at(subject.span);
        if is_chain(subject) {
            return self.chain(subject, arms, tail);
        }
        let value = self.value(subject);
        let pointer = self.pointer();
        let mut out = TokenStream::new();
        for arm in arms.iter().filter(|arm| arm.value.is_some()) {
            let Some(value) = &arm.value else { continue };
            let pattern = constant(value).tokens;
            let comment = self.arm_comment(arm);
            let block = self.arm(arm, tail);
            out.extend(quote!(#comment #pattern => { #block }));
        }
        let values = arms.iter().map(|arm| arm.value.as_ref()).filter(Option::is_some);
        if !flow::exhaustive(subject, values) {
            match arms.iter().find(|arm| arm.value.is_none()) {
                Some(arm) => {
                    let comment = self.arm_comment(arm);
                    let block = self.arm(arm, tail);
                    out.extend(quote!(#comment _ => { #block }));
                }
                None => out.extend(quote!(_ => {})),
            }
        }
        let (before, subject) = (&value.before, &value.tokens);
        quote!(#pointer #before match #subject { #out })
    }

    fn chain(&mut self, subject: &'p Expr, arms: &'p [Arm], tail: Tail) -> TokenStream {
        let compares = arms.iter().any(|arm| arm.value.is_some());
        let value = if compares { self.chain_subject(subject) } else { self.only_evaluated(subject) };
        let (before, subject) = (value.before.clone(), value.receiver());
        let pointer = self.pointer();
        let mut out = quote!(#pointer #before);
        let mut first = true;
        for arm in arms {
            let Some(Value::String(text)) = &arm.value else { continue };
            let block = self.commented_arm(arm, tail);
            let otherwise = (!first).then(|| quote!(else));
            first = false;
            out.extend(quote!(#otherwise if #subject == #text { #block }));
        }
        if let Some(arm) = arms.iter().find(|arm| arm.value.is_none()) {
            let block = self.commented_arm(arm, tail);
            out.extend(if first { quote!({ #block }) } else { quote!(else { #block }) });
        }
        out
    }

    /// The subject that a chain compares repeatedly: a local variable is used directly, since the arm is chosen before
    /// any of them runs.
    fn chain_subject(&mut self, subject: &'p Expr) -> Fragment {
        match &subject.kind {
            ExprKind::Place(place) if self.plain_local(place.root).is_some() && place.path.is_empty() => {
                self.expression(subject, Mode::Compared)
            }
            _ => {
                let value = self.value(subject);
                self.settle(value, "subject")
            }
        }
    }

    /// A subject that is not compared with anything: it is only evaluated.
    fn only_evaluated(&mut self, subject: &'p Expr) -> Fragment {
        let value = self.expression(subject, Mode::Compared);
        let (before, tokens) = (&value.before, &value.tokens);
        let before = if value.settled { before.clone() } else { quote!(#before let _ = #tokens;) };
        Fragment::settled(TokenStream::new()).after(before)
    }

    fn arm(&mut self, arm: &'p Arm, tail: Tail) -> TokenStream {
        self.block(&arm.body, tail)
    }

    fn commented_arm(&mut self, arm: &'p Arm, tail: Tail) -> TokenStream {
        let comment = self.comment(arm.span);
        let block = self.arm(arm, tail);
        quote!(#comment #block)
    }

    fn arm_comment(&mut self, arm: &Arm) -> TokenStream {
        let line = self.unit.line(self.module, arm.span);
        if line == self.position.commented {
            return TokenStream::new();
        }
        self.position.commented = line;
        self.unit.marks.comment_of_arm(self.unit.text(self.module, arm.span))
    }

    /// The statement that chooses the arm of a decomposed switch: the code of each arm replaces its body.
    pub(super) fn chosen(
        &mut self,
        subject: &'p Expr,
        arms: Vec<(Option<&'p Value>, TokenStream)>,
        otherwise: TokenStream,
    ) -> TokenStream {
        self.stand_at(subject.span);
        let compares = arms.iter().any(|(value, _)| value.is_some());
        let value = match is_chain(subject) {
            true if compares => self.chain_subject(subject),
            true => self.only_evaluated(subject),
            false => self.value(subject),
        };
        let pointer = self.pointer();
        let Fragment { before, tokens, .. } = value;
        let exhaustive = flow::exhaustive(subject, arms.iter().map(|(value, _)| *value).filter(Option::is_some));
        let default = arms.iter().find(|(value, _)| value.is_none()).map_or(otherwise, |(_, code)| code.clone());
        let given = arms.into_iter().filter_map(|(value, code)| Some((value?, code)));
        if is_chain(subject) {
            let mut chain = TokenStream::new();
            for (value, code) in given {
                let Value::String(text) = value else { continue };
                chain.extend(quote!(if #tokens == #text { #code } else));
            }
            return quote!(#pointer #before #chain { #default });
        }
        let given = given.map(|(value, code)| {
            let pattern = constant(value).tokens;
            quote!(#pattern => { #code })
        });
        let default = (!exhaustive).then(|| quote!(_ => { #default }));
        quote!(#pointer #before match #tokens { #(#given)* #default })
    }
}

/// Whether Rust has no patterns for the subject.
fn is_chain(subject: &Expr) -> bool {
    matches!(subject.ty.base, Base::String | Base::Double)
}

/// Whether a statement may be the function's result: all its branches exist in Rust, too.
pub(super) fn is_plain(stmt: &Stmt) -> bool {
    matches!(stmt.kind, StmtKind::If(..) | StmtKind::Switch(..))
}

impl quote::ToTokens for Fragment {
    fn to_tokens(&self, tokens: &mut TokenStream) {
        tokens.extend(self.before.clone());
        tokens.extend(self.tokens.clone());
    }
}
