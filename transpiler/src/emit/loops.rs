//! Loops.
//!
//! A loop that has to give the cycle back does so behind its last statement; where a `continue` would jump over that,
//! at the start of the round. `continue` of a loop with something to do behind its body (a step, an `until`) leaves a
//! labelled block around the body.
//!
//! What lives across an `.await` lies in the memory of the future, and the compiler cannot keep it in a register in
//! between. Numbers that a loop changes are therefore handed to the wait and come back from it.

use super::body::{Body, Exit, Loop, Tail, label};
use super::fragment::{Fragment, Precedence};
use crate::effects::{flow, loops};
use crate::hir::{Expr, For, LocalId, LoopInfo, Stmt, StmtKind};
use proc_macro2::{Literal, TokenStream};
use quote::quote;

impl<'p> Body<'p, '_> {
    /// `while(c)`
    pub(super) fn while_loop(&mut self, condition: &'p Expr, body: &'p [Stmt], info: LoopInfo) -> TokenStream {
        if flow::always(condition) {
            return self.endless_loop(body, info);
        }
        let (head, condition) = self.head(condition);
        let rounds = self.rounds(body, info);
        match head {
            Some(head) => quote!(loop { #head #rounds }),
            None => quote!(while #condition { #rounds }),
        }
    }

    /// A condition at the start of each round: statements that break out, where it does not fit into a `while`.
    fn head(&mut self, condition: &'p Expr) -> (Option<TokenStream>, TokenStream) {
        let value = self.on_trial(|body| body.value_alone(condition));
        let pointer = self.pointer();
        if pointer.is_empty() && value.before.is_empty() {
            return (None, value.tokens);
        }
        let Fragment { before, tokens: unmet, .. } = self.negated(condition);
        (Some(quote!(#pointer #before if #unmet { break; })), TokenStream::new())
    }

    /// `loop`
    pub(super) fn endless_loop(&mut self, body: &'p [Stmt], info: LoopInfo) -> TokenStream {
        let rounds = self.rounds(body, info);
        quote!(loop { #rounds })
    }

    /// A loop's body where nothing comes behind it.
    fn rounds(&mut self, body: &'p [Stmt], info: LoopInfo) -> TokenStream {
        let spend = self.spend(info);
        let continued = flow::continues(body);
        self.loops.push(Loop { on_break: Exit::Plain, on_continue: Exit::Plain });
        let mut statements = self.block(body, Tail::Inner);
        self.loops.pop();
        if info.spends && !continued && self.hides(body, self.usage.kept(info)) {
            statements = quote!({ #statements });
        }
        if continued {
            quote!(#spend #statements)
        } else if flow::block_diverges(body) {
            statements
        } else {
            quote!(#statements #spend)
        }
    }

    /// `repeat` ... `until(c)`
    pub(super) fn repeat_loop(&mut self, body: &'p [Stmt], until: &'p Expr, info: LoopInfo) -> TokenStream {
        let (label, statements) = self.round_with_rest(body, Some(until), info);
        if !flow::goes_round(body) {
            return quote!(#label loop { #statements });
        }
        self.stand_at(until.span);
        let comment = self.comment(until.span);
        let condition = self.value_alone(until);
        let pointer = self.pointer();
        let (before, met) = (&condition.before, &condition.tokens);
        let spend = self.spend(info);
        quote!(#label loop { #statements #comment #pointer #before if #met { break; } #spend })
    }

    /// The body of a loop with something behind it, and the label that the loop needs.
    fn round_with_rest(
        &mut self,
        body: &'p [Stmt],
        rest: Option<&'p Expr>,
        info: LoopInfo,
    ) -> (TokenStream, TokenStream) {
        if !flow::continues(body) {
            self.loops.push(Loop { on_break: Exit::Plain, on_continue: Exit::Plain });
            let mut statements = self.block(body, Tail::Inner);
            self.loops.pop();
            let mut meant = self.usage.kept(info).to_vec();
            if let Some(rest) = rest {
                let facts = self.facts(rest);
                meant.extend(facts.reads.iter().chain(&facts.writes));
            }
            if self.hides(body, &meant) {
                statements = quote!({ #statements });
            }
            return (TokenStream::new(), statements);
        }
        let number = self.label_number();
        let round = label("round", number);
        let outer = flow::breaks(body).then(|| label("rounds", number));
        let on_break = match &outer {
            Some(outer) => Exit::Labelled(quote!(break #outer)),
            None => Exit::Plain,
        };
        self.loops.push(Loop { on_break, on_continue: Exit::Labelled(quote!(break #round)) });
        let statements = self.block(body, Tail::Inner);
        self.loops.pop();
        let label = outer.map(|outer| quote!(#outer:));
        (quote!(#label), quote!(#round: { #statements }))
    }

    /// Whether variables of a body would hide those that are meant behind it.
    fn hides(&self, body: &[Stmt], meant: &[LocalId]) -> bool {
        if meant.is_empty() {
            return false;
        }
        let meant: Vec<String> = meant.iter().map(|id| self.local(*id).to_string()).collect();
        let declares = |stmt: &Stmt| match stmt.kind {
            StmtKind::Let(id, _) => meant.contains(&self.local(id).to_string()),
            _ => false,
        };
        body.iter().any(|stmt| match &stmt.kind {
            StmtKind::For(each) => each.init.iter().any(declares),
            _ => declares(stmt),
        })
    }

    /// `for(init; condition; step)`
    pub(super) fn for_loop(&mut self, each: &'p For) -> TokenStream {
        let visible = self.visible.len();
        let code = match loops::range(each) {
            Some(range) => self.range_loop(each, &range),
            None => self.general_for(each),
        };
        self.visible.truncate(visible);
        code
    }

    /// `for i in 0..10`
    fn range_loop(&mut self, each: &'p For, range: &loops::Range<'p>) -> TokenStream {
        let name = self.local(range.local);
        let from = self.value(range.from);
        let constant = loops::whole_number(range.from).is_some();
        let to = if constant { self.typed_value(range.to) } else { self.value(range.to) };
        let (from_before, from) = (from.before.clone(), from.at(Precedence::Or));
        let to = to.at(Precedence::Or);
        let to = if range.beyond { quote!(..=#to) } else { quote!(..#to) };
        let pointer = self.pointer();
        self.visible.push(range.local);
        let rounds = self.rounds(&each.body, each.info);
        quote!(#pointer #from_before for #name in #from #to { #rounds })
    }

    /// A `for` that is no range: its variables live in the block around it, or in one of their own where an outer
    /// variable has the same name.
    fn general_for(&mut self, each: &'p For) -> TokenStream {
        let outer: Vec<String> = self.visible.iter().map(|id| self.local(*id).to_string()).collect();
        let mut init = TokenStream::new();
        let before = self.visible.len();
        for stmt in &each.init {
            init.extend(self.with_own_temporaries(|body| body.statement(stmt, Tail::Inner)));
        }
        let hides = self.visible.iter().skip(before).any(|id| outer.contains(&self.local(*id).to_string()));
        let line = self.line;
        let (head, condition) = match &each.condition {
            Some(condition) if !flow::always(condition) => self.head(condition),
            _ => (Some(TokenStream::new()), TokenStream::new()),
        };
        let (label, statements) = self.round_with_rest(&each.body, each.step.as_ref(), each.info);
        self.line = line;
        let rest = if flow::goes_round(&each.body) {
            let step = each.step.as_ref().map(|step| self.with_own_temporaries(|body| body.effect(step, Tail::Inner)));
            let spend = self.spend(each.info);
            // At the very end, so that waiting ends where the next round begins: rustc makes a better loop of it.
            quote!(#step #spend)
        } else {
            TokenStream::new()
        };
        let code = match head {
            Some(head) => quote!(#init #label loop { #head #statements #rest }),
            None => quote!(#init #label while #condition { #statements #rest }),
        };
        if hides { quote!({ #code }) } else { code }
    }

    /// `if cx.spend() { .. }`, where a loop has to give the cycle back by itself.
    pub(super) fn spend(&self, info: LoopInfo) -> TokenStream {
        if !info.spends {
            return TokenStream::new();
        }
        let rounds = Literal::u32_unsuffixed(info.rounds);
        let spent = if info.rounds == 1 { quote!(cx.spend()) } else { quote!(cx.spend_rounds(#rounds)) };
        // A variable that another one of the same name hides stays in memory.
        let is_seen = |id: &&LocalId| {
            let name = self.local(**id);
            self.visible.iter().rfind(|other| self.local(**other) == name) == Some(*id)
        };
        let kept: Vec<_> = self.usage.kept(info).iter().filter(is_seen).map(|id| self.local(*id)).collect();
        let wait = match kept.as_slice() {
            [] => quote!(cx.next_cycle().await;),
            [kept] => quote!(#kept = cx.next_cycle().keeping(#kept).await;),
            kept => quote!((#(#kept),*) = cx.next_cycle().keeping((#(#kept),*)).await;),
        };
        quote!(if #spent { #wait })
    }
}

/// Gives the cycle back once the budget of rounds is used up.
pub(super) fn give_back() -> TokenStream {
    quote!(if cx.spend() {
        cx.next_cycle().await;
    })
}
