//! Loops.
//!
//! A loop that has to yield the cycle does so after its last statement, or at the start of the round if a `continue`
//! would jump over that. `continue` of a loop with something to do after its body (a step, an `until`) leaves a
//! labelled block around the body.
//!
//! Values that live across an `.await` are in the memory of the future, and the compiler cannot keep them in registers
//! in between. Numbers that a loop changes are therefore passed to the wait and returned from it. If nothing inside a
//! loop counts rounds or waits, the wait is moved out of it altogether: an inner loop runs as long as there are rounds
//! left.

use super::body::Body;
use super::control_flow::{Exit, Loop, Tail, label};
use super::fragment::{Fragment, Precedence};
use super::tokens::uses_variable;
use crate::effects::{facts, flow, loops, visibility};
use crate::hir::{Counting, Expr, ExprKind, For, LocalId, LoopInfo, Root, Stmt, StmtKind, Walk};
use crate::visit;
use arl_lang::ast::BinaryOp;
use arl_lang::catalog::Base;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;
use std::collections::HashSet;

/// The parts of a loop in the checked program.
struct Parts<'a, 'p> {
    blocks: &'a [&'p [Stmt]],
    exprs: &'a [&'p Expr],
}

/// Variables in memory that a loop copies into registers as long as nothing waits.
struct Copies {
    read: Vec<Ident>,
    /// The copies that are written back.
    written: Vec<Ident>,
}

/// The emitted pieces of a loop.
struct Turns {
    /// `'name:`, if anything jumps to it.
    label: TokenStream,
    /// The condition that is evaluated before each round.
    condition: Option<TokenStream>,
    /// The code that runs in each round.
    round: TokenStream,
}

impl<'p> Body<'p, '_> {
    /// `while(c)`
    pub(super) fn while_loop(&mut self, condition: &'p Expr, body: &'p [Stmt], info: LoopInfo) -> TokenStream {
        if flow::always(condition) {
            return self.endless_loop(body, info);
        }
        let turns = self.turns(info, true, Parts { blocks: &[body], exprs: &[condition] }, |emitter| {
            let (head, condition) = emitter.head(condition, info);
            let rounds = emitter.rounds(body, info);
            Turns { label: TokenStream::new(), condition, round: quote!(#head #rounds) }
        });
        let Counting::Walking(Walk { local, step }) = info.counting else { return turns };
        let name = self.counted(local);
        let first = self.fresh("first");
        let distance = if step > 0 { quote!(#name - #first) } else { quote!(#first - #name) };
        let step = Some(step.unsigned_abs()).filter(|step| *step != 1).map(Literal::u32_unsuffixed);
        let charged = self.charged(distance, step.map(|step| quote!(#step)), info);
        quote!(let #first = #name; #turns #charged)
    }

    /// A condition at the start of each round: for a `while`, or as statements that break out if it does not fit into
    /// one.
    fn head(&mut self, condition: &'p Expr, info: LoopInfo) -> (TokenStream, Option<TokenStream>) {
        let value = self.on_trial(|body| body.value_alone(condition));
        let pointer = self.pointer();
        let once = info.counts_alone() && loops::takes_first(self.scope(), condition);
        // One that counts alone takes its round after the condition, whatever statements the condition needs.
        let inside = info.counts_alone() && !once;
        let value = if inside { value.inline() } else { value };
        if pointer.is_empty() && value.before.is_empty() && !once {
            let tokens = if info.counts_alone() { value.at(Precedence::And) } else { value.tokens };
            return (TokenStream::new(), Some(tokens));
        }
        let Fragment { before, tokens: unmet, .. } = self.negated(condition);
        (quote!(#pointer #before if #unmet { break; }), None)
    }

    /// `loop`
    pub(super) fn endless_loop(&mut self, body: &'p [Stmt], info: LoopInfo) -> TokenStream {
        self.turns(info, flow::breaks(body), Parts { blocks: &[body], exprs: &[] }, |emitter| {
            let round = emitter.rounds(body, info);
            Turns { label: TokenStream::new(), condition: None, round }
        })
    }

    /// The body of a loop if nothing comes after it.
    fn rounds(&mut self, body: &'p [Stmt], info: LoopInfo) -> TokenStream {
        let spend = self.spend(info);
        let continued = flow::continues(body);
        self.flow.loops.push(Loop { on_break: Exit::Plain, on_continue: Exit::Plain });
        let mut statements = self.block(body, Tail::Inner);
        self.flow.loops.pop();
        if info.spends && !continued && self.hides(body, self.locals.usage.kept(info)) {
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
        let parts = Parts { blocks: &[body], exprs: &[until] };
        self.turns(info, true, parts, |emitter| emitter.repeat_until(body, until, info))
    }

    fn repeat_until(&mut self, body: &'p [Stmt], until: &'p Expr, info: LoopInfo) -> Turns {
        let (label, statements) = self.round_with_rest(body, Some(until), info);
        if !flow::goes_round(body) {
            return Turns { label, condition: None, round: statements };
        }
        self.stand_at(until.span);
        let comment = self.comment(until.span);
        let condition = self.value_alone(until);
        let pointer = self.pointer();
        let (before, met) = (&condition.before, &condition.tokens);
        let spend = self.spend(info);
        let round = quote!(#statements #comment #pointer #before if #met { break; } #spend);
        Turns { label, condition: None, round }
    }

    /// The body of a loop with something after it, and the label that the loop needs.
    fn round_with_rest(
        &mut self,
        body: &'p [Stmt],
        rest: Option<&'p Expr>,
        info: LoopInfo,
    ) -> (TokenStream, TokenStream) {
        if !flow::continues(body) {
            self.flow.loops.push(Loop { on_break: Exit::Plain, on_continue: Exit::Plain });
            let mut statements = self.block(body, Tail::Inner);
            self.flow.loops.pop();
            let mut meant = self.locals.usage.kept(info).to_vec();
            if let Some(rest) = rest {
                let facts = self.facts(rest);
                meant.extend(facts.reads.iter().chain(&facts.writes));
            }
            // Connections are closed before what comes after the body.
            let ends = rest.is_some() && !visibility::handles(body, self.func).is_empty();
            if ends || self.hides(body, &meant) {
                statements = quote!({ #statements });
            }
            return (TokenStream::new(), statements);
        }
        let number = self.flow.label_number();
        let round = label("round", number);
        let outer = flow::breaks(body).then(|| label("rounds", number));
        let on_break = match &outer {
            Some(outer) => Exit::Labelled(quote!(break #outer)),
            None => Exit::Plain,
        };
        self.flow.loops.push(Loop { on_break, on_continue: Exit::Labelled(quote!(break #round)) });
        let statements = self.block(body, Tail::Inner);
        self.flow.loops.pop();
        let label = outer.map(|outer| quote!(#outer:));
        (quote!(#label), quote!(#round: { #statements }))
    }

    /// Whether variables of a body would hide those that are meant after it.
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
        let visible = self.locals.visible.len();
        let code = match loops::emitted_range(each) {
            Some(range) => self.range_loop(each, &range),
            None => self.general_for(each),
        };
        self.locals.visible.truncate(visible);
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
        self.locals.visible.push(range.local);
        let rounds = self.rounds(&each.body, each.info);
        quote!(#pointer #from_before for #name in #from #to { #rounds })
    }

    /// A `for` that is not a range: its variables live in the surrounding block, or in a block of their own if an outer
    /// variable has the same name.
    fn general_for(&mut self, each: &'p For) -> TokenStream {
        let outer: Vec<String> = self.locals.visible.iter().map(|id| self.local(*id).to_string()).collect();
        let mut init = TokenStream::new();
        let before = self.locals.visible.len();
        for stmt in &each.init {
            init.extend(self.with_own_temporaries(|body| body.statement(stmt, Tail::Inner)));
        }
        let hides = self.locals.visible.iter().skip(before).any(|id| outer.contains(&self.local(*id).to_string()));
        let ends = !each.condition.as_ref().is_none_or(flow::always) || flow::breaks(&each.body);
        let exprs: Vec<&Expr> = each.condition.iter().chain(&each.step).collect();
        let parts = Parts { blocks: &[&each.body], exprs: &exprs };
        let turns = self.turns(each.info, ends, parts, |emitter| emitter.turns_of_for(each));
        let code = match self.rounds_behind(each) {
            Some((first, count)) => quote!(#init #first #turns #count),
            None => quote!(#init #turns),
        };
        if hides { quote!({ #code }) } else { code }
    }

    /// The condition, body and step of a `for`.
    fn turns_of_for(&mut self, each: &'p For) -> Turns {
        let line = self.position.line;
        let (head, condition) = match &each.condition {
            Some(condition) if !flow::always(condition) => self.head(condition, each.info),
            _ => (TokenStream::new(), None),
        };
        let condition = condition.map(|condition| self.climbs_from_zero(each).unwrap_or(condition));
        let (label, statements) = self.round_with_rest(&each.body, each.step.as_ref(), each.info);
        self.position.line = line;
        let rest = if flow::goes_round(&each.body) {
            let step = each.step.as_ref().map(|step| self.with_own_temporaries(|body| body.effect(step, Tail::Inner)));
            let spend = self.spend(each.info);
            // At the very end, so that waiting ends where the next round begins: rustc compiles this to a better loop.
            quote!(#step #spend)
        } else {
            TokenStream::new()
        };
        Turns { label, condition, round: quote!(#head #statements #rest) }
    }

    /// The condition of a loop whose variable rises from 0 or more, written such that rustc knows this, too, and omits
    /// its own check of an index. With constants rustc finds out by itself.
    fn climbs_from_zero(&self, each: &For) -> Option<TokenStream> {
        let head = loops::Head::of(each)?;
        let (least, _) = self.locals.ranges.of_local(head.local)?;
        let known = |expr| loops::whole_number(expr).is_some();
        let waits = each.info.spends || each.info.counting == Counting::Inside;
        let obvious = known(head.from) && head.step.is_none_or(known) && !waits;
        if obvious || least < 0 || head.from.ty.base != Base::Int {
            return None;
        }
        let to = Literal::u32_unsuffixed(u32::try_from(loops::whole_number(head.to)?).ok()?);
        let name = self.local(head.local);
        match head.op {
            BinaryOp::Less => Some(quote!((#name as u32) < #to)),
            BinaryOp::LessEqual => Some(quote!(#name as u32 <= #to)),
            _ => None,
        }
    }

    /// For a loop whose rounds are counted after it: the code before and after the loop.
    fn rounds_behind(&mut self, each: &'p For) -> Option<(TokenStream, TokenStream)> {
        if each.info.counting != Counting::Behind {
            return None;
        }
        let head = loops::Head::of_any(each)?;
        let name = self.counted(head.local);
        let first = self.fresh("first");
        let distance = quote!(#name - #first);
        let step = head.step.filter(|step| loops::whole_number(step) != Some(1));
        let step = step.map(|step| self.value_alone(step).tokens);
        let charged = self.charged(distance, step, each.info);
        Some((quote!(let #first = #name;), charged))
    }

    /// The value of the variable that a loop counts.
    fn counted(&self, id: LocalId) -> TokenStream {
        let name = self.local(id);
        if self.is_shared(id) { quote!(#name.get()) } else { quote!(#name) }
    }

    /// The statement that counts the rounds of a loop after it: its variable has changed by `distance` in steps of
    /// `step`, or of 1.
    fn charged(&self, distance: TokenStream, step: Option<TokenStream>, info: LoopInfo) -> TokenStream {
        let count = step.map_or_else(|| distance.clone(), |step| quote!(steps(#distance, #step)));
        let count = match info.rounds {
            1 => quote!(#count + 1),
            rounds => {
                let rounds = Literal::i32_unsuffixed(rounds);
                quote!((#count + 1) * #rounds)
            }
        };
        match &self.flow.counter {
            Some(counter) => quote!(#counter.charge(#count);),
            None if info.spends => {
                let wait = self.wait_for_cycle(info);
                quote!(if cx.spend_rounds(#count) { #wait })
            }
            None => quote!(cx.charge(#count);),
        }
    }

    /// A loop, which may be endless.
    fn turns(
        &mut self,
        info: LoopInfo,
        ends: bool,
        parts: Parts<'_, 'p>,
        emit: impl FnOnce(&mut Self) -> Turns,
    ) -> TokenStream {
        if !info.counts_alone() {
            return self.turns_in_context(info, &parts, emit);
        }
        let counter = self.reserve("rounds");
        let outer = self.flow.counter.replace(counter.clone());
        let before = self.locals.looked_up.len();
        let elements = self.look_up(parts.blocks, parts.exprs);
        let Copies { mut read, mut written } = self.copies(info, &parts);
        let Turns { label, condition, round } = emit(self);
        self.flow.counter = outer;
        self.forget_looked_up(before);
        self.release(&counter);
        let taken = quote!(#counter.take());
        let condition = condition.map(|condition| quote!(#condition &&));
        let wait = self.wait_for_cycle(info);
        // Code that changes nothing has been omitted.
        let turns = quote!(#condition #round);
        let is_used = |name: &Ident| uses_variable(&turns, &name.to_string());
        read.retain(is_used);
        written.retain(is_used);
        let elements = elements.into_iter().filter(|(name, _)| is_used(name)).map(|(_, statement)| statement);
        let rounds = quote!(
            let mut #counter = cx.rounds();
            #(#elements)*
            #(let #read = #read;)*
        );
        if written.is_empty() {
            let done = ends.then(|| quote!(if !#counter.are_spent() { break; }));
            return quote!(loop {
                {
                    #rounds
                    #label while #condition #taken { #round }
                    #done
                }
                #wait
            });
        }
        let spent = self.fresh("spent");
        let (let_spent, target, value, done) = if ends {
            (
                quote!(let #spent;),
                quote!((#(#written,)* #spent)),
                quote!((#(#written,)* #counter.are_spent())),
                quote!(if !#spent { break; }),
            )
        } else {
            let tuple_of = |written: &[Ident]| match written {
                [one] => quote!(#one),
                many => quote!((#(#many),*)),
            };
            (TokenStream::new(), tuple_of(&written), tuple_of(&written), TokenStream::new())
        };
        quote!(loop {
            #let_spent
            #target = {
                #rounds
                #(let mut #written = #written;)*
                #label while #condition #taken { #round }
                #value
            };
            #done
            #wait
        })
    }

    /// A loop whose rounds are counted in the context.
    fn turns_in_context(
        &mut self,
        info: LoopInfo,
        parts: &Parts<'_, 'p>,
        emit: impl FnOnce(&mut Self) -> Turns,
    ) -> TokenStream {
        let before = self.locals.looked_up.len();
        let behind = info.counting.is_behind() && self.flow.counter.is_none();
        let elements = if behind { self.look_up(parts.blocks, parts.exprs) } else { Vec::new() };
        let Turns { label, condition, round } = emit(self);
        self.forget_looked_up(before);
        let turns = match condition {
            Some(condition) => quote!(#label while #condition { #round }),
            None => quote!(#label loop { #round }),
        };
        let used = elements.into_iter().filter(|(name, _)| uses_variable(&turns, &name.to_string()));
        let elements: TokenStream = used.map(|(_, statement)| statement).collect();
        if elements.is_empty() { turns } else { quote!({ #elements #turns }) }
    }

    /// The variables in memory that a loop uses.
    fn copies(&self, info: LoopInfo, parts: &Parts<'_, 'p>) -> Copies {
        let (mut read, mut written) = (HashSet::new(), HashSet::new());
        let mut see = |expr: &'p Expr| {
            let (place, writes) = match &expr.kind {
                ExprKind::Place(place) => (&**place, false),
                ExprKind::Step(_, place) => (&**place, true),
                ExprKind::Assign(both) | ExprKind::AssignOp(_, both) => (&both.0, true),
                _ => return,
            };
            // An assignment that changes nothing is not a write.
            let writes = writes && facts::same_anyway(expr).is_none();
            if let Root::Local(id) = place.root {
                if writes { &mut written } else { &mut read }.insert(id);
            }
        };
        parts.blocks.iter().copied().flatten().for_each(|stmt| visit::exprs_in_stmt(stmt, &mut see));
        parts.exprs.iter().for_each(|expr| visit::exprs(expr, &mut see));
        let in_memory = self.locals.usage.in_memory(info).iter().copied().filter(|id| self.is_seen(*id));
        let (written, others): (Vec<_>, Vec<_>) = in_memory.partition(|id| written.contains(id));
        let named = |ids: Vec<LocalId>| ids.into_iter().map(|id| self.local(id)).collect();
        Copies { read: named(others.into_iter().filter(|id| read.contains(id)).collect()), written: named(written) }
    }

    /// For a loop that has to yield the cycle by itself: counts a round and waits when none is left.
    pub(super) fn spend(&self, info: LoopInfo) -> TokenStream {
        if !info.counts_in_context() {
            return TokenStream::new();
        }
        let wait = self.wait_for_cycle(info);
        if info.rounds == 1 {
            return quote!(if cx.spend() { #wait });
        }
        let rounds = Literal::i32_unsuffixed(info.rounds);
        quote!(if cx.spend_rounds(#rounds) { #wait })
    }

    /// Whether a variable is not hidden by another one of the same name. A hidden one stays in memory.
    fn is_seen(&self, id: LocalId) -> bool {
        let name = self.local(id);
        self.locals.visible.iter().rfind(|other| self.local(**other) == name) == Some(&id)
    }

    /// Waits for the next cycle and keeps the variables that the loop needs.
    fn wait_for_cycle(&self, info: LoopInfo) -> TokenStream {
        let kept = self.locals.usage.kept(info).iter().copied().filter(|id| self.is_seen(*id));
        let kept: Vec<_> = kept.map(|id| self.local(id)).collect();
        match kept.as_slice() {
            [] => quote!(cx.next_cycle().await;),
            [kept] => quote!(#kept = cx.next_cycle().keeping(#kept).await;),
            kept => quote!((#(#kept),*) = cx.next_cycle().keeping((#(#kept),*)).await;),
        }
    }
}

/// Yields the cycle once the budget of rounds is used up.
pub(super) fn give_back() -> TokenStream {
    quote!(if cx.spend() {
        cx.next_cycle().await;
    })
}
