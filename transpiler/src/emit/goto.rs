//! Functions with `goto` become machines: a loop around a `match` over states.
//!
//! Invariants:
//! - A state begins at the start of the function, at each label, and where a decomposed statement continues. Only
//!   statements that contain a label are decomposed; any other one stays whole inside a state, so that jumps lead only
//!   into states.
//! - The code of a state ends by setting the next state or by returning. A jump from inside a whole statement sets the
//!   state and continues the machine's loop.
//! - A variable that more than one state mentions lives outside the loop (it is hoisted), with its default value; its
//!   declaration becomes an assignment. A jump to a label resets to its default value every hoisted variable that is
//!   visible at the label but not at the jump, because the jump skips its declaration.
//! - Clocks and connections are always hoisted. A state begins by resetting those that are not visible there, which
//!   closes the connections of the blocks that control has left.
//! - The names of locals are distinct in such functions, as all hoisted ones share a scope.
//! - Each backward jump yields the cycle when the budget is used up, as each round of a loop does.

use super::body::Body;
use super::control_flow::{Exit, Loop, Tail};
use super::loops::give_back;
use super::machine::{Machine, MachineState};
use super::names::{camel_case, ident};
use super::parts::Leave;
use super::rows::Group;
use super::tokens::jumps;
use super::types::{rust_type, shared_type, shared_value, start_value};
use crate::effects::flow;
use crate::effects::visibility::{self, Visibility};
use crate::hir::{Arm, Expr, For, Func, LabelId, Local, LocalId, LoopInfo, Stmt, StmtKind};
use arl_lang::span::Span;
use proc_macro2::{Ident, TokenStream};
use quote::quote;
use std::collections::{HashMap, HashSet};

impl<'p> Body<'p, '_> {
    /// The body of a function with `goto`.
    pub(super) fn machine(&mut self, func: &'p Func) -> TokenStream {
        let variable = self.reserve("state");
        let (commented, visible) = (self.position.commented, self.locals.visible.clone());
        // A first run finds out which variables are used by more than one state.
        self.run(func, variable.clone(), declared(&func.body), true);
        let all = declared(&func.body);
        let hoisted = match &self.flow.machine {
            Some(machine) => {
                let handles = visibility::handles(&func.body, self.func);
                let is_hoisted = |id: &LocalId| handles.contains(id) || machine.is_shared(*id, &self.local(*id));
                all.into_iter().filter(is_hoisted).collect()
            }
            None => HashSet::new(),
        };
        (self.position.commented, self.locals.visible) = (commented, visible);
        self.run(func, variable, hoisted, false);
        self.finish()
    }

    fn run(&mut self, func: &'p Func, variable: Ident, hoisted: HashSet<LocalId>, trial: bool) {
        self.flow.machine = Some(Machine {
            variable,
            label: syn::Lifetime::new("'machine", proc_macro2::Span::call_site()),
            states: Vec::new(),
            named: HashSet::new(),
            of_label: HashMap::new(),
            visibility: Visibility::of(func),
            hoisted,
            declared_in: HashMap::new(),
            trial,
            current: 0,
            open: true,
        });
        self.new_state("Start");
        self.states(&func.body);
        if self.is_open() {
            let end = self.end_result();
            self.append(quote!(return #end;));
        }
    }

    /// The loop around the reachable states, and the variables outside it.
    fn finish(&mut self) -> TokenStream {
        let Some(machine) = self.flow.machine.take() else { return TokenStream::new() };
        let reached = machine.reached();
        self.locals.usage.drops = reached.contains(&false);
        let states: Vec<&MachineState> =
            machine.states.iter().zip(&reached).filter(|(_, reached)| **reached).map(|(state, _)| state).collect();
        let mut hoisted: Vec<LocalId> = machine.hoisted.iter().copied().collect();
        hoisted.sort_unstable();
        let variables = hoisted.into_iter().map(|id| self.hoisted_variable(id));
        let names = states.iter().map(|state| &state.name);
        let arms = states.iter().map(|state| {
            let (name, code) = (&state.name, &state.code);
            quote!(State::#name => { #code })
        });
        let (variable, label) = (&machine.variable, &machine.label);
        let first = machine.states.first().map(|state| &state.name);
        let labelled = states.iter().any(|state| jumps(&state.code)).then(|| quote!(#label:));
        quote! {
            enum State { #(#names),* }
            #(#variables)*
            let mut #variable = State::#first;
            #labelled loop {
                match #variable { #(#arms)* }
            }
        }
    }

    /// A variable that lives before its declaration, with its default value.
    pub(super) fn hoisted_variable(&self, id: LocalId) -> Option<TokenStream> {
        let (local, family) = (self.func?.locals.get(id.0 as usize)?, self.family());
        let (name, start) = (self.local(id), self.first_value(local));
        let ty = match local.shared {
            true => Some(shared_type(local.ty, family)),
            false => (!local.ty.is_array()).then(|| rust_type(local.ty, family)),
        };
        let ty = ty.map(|ty| quote!(: #ty));
        Some(quote!(let mut #name #ty = #start;))
    }

    /// The value of a variable before its declaration.
    fn first_value(&self, local: &Local) -> TokenStream {
        let start = start_value(local.ty, self.family());
        if local.shared { shared_value(local.ty, start) } else { start }
    }

    /// Whether the declaration of a local is an assignment to a variable outside the machine or before the parts of a
    /// block.
    pub(super) fn is_hoisted(&self, id: LocalId) -> bool {
        self.locals.hoisted.contains(&id)
            || self.flow.machine.as_ref().is_some_and(|machine| machine.hoisted.contains(&id))
    }

    /// Records the state that contains a declaration.
    pub(super) fn note_declaration(&mut self, id: LocalId) {
        if let Some(machine) = &mut self.flow.machine {
            machine.declared_in.insert(id, machine.current);
        }
    }

    /// `goto label`
    pub(super) fn goto(&mut self, label: LabelId, span: Span) -> TokenStream {
        let (before, state) = self.departure(label, span);
        let jump = self.jump(state);
        quote!(#before #jump)
    }

    /// The code before a jump to a label, and the label's state.
    fn departure(&mut self, label: LabelId, span: Span) -> (TokenStream, usize) {
        let state = self.label_state(label);
        let Some(machine) = &self.flow.machine else { return (TokenStream::new(), state) };
        let resets = self.resets(&machine.visibility.skipped(label, span));
        let backwards = self
            .func
            .and_then(|func| func.labels.get(label.0 as usize))
            .is_some_and(|label| label.span.start <= span.start);
        let spend = backwards.then(give_back);
        (quote!(#resets #spend), state)
    }

    /// Gives the hoisted ones of these variables their start values.
    fn resets(&self, ids: &[LocalId]) -> TokenStream {
        let Some(machine) = self.flow.machine.as_ref().filter(|machine| !machine.trial) else {
            return TokenStream::new();
        };
        let reset = |id: &LocalId| {
            let local = self.func?.locals.get(id.0 as usize)?;
            let (name, start) = (self.local(*id), self.first_value(local));
            Some(quote!(#name = #start;))
        };
        ids.iter().filter(|id| machine.hoisted.contains(id)).filter_map(reset).collect()
    }

    /// A jump from inside a statement to a state.
    pub(super) fn jump(&mut self, state: usize) -> TokenStream {
        let set = self.set_state(state);
        let go_on = self.go_on();
        quote!(#set #go_on)
    }

    /// Continues with the next round of the machine's loop.
    pub(super) fn go_on(&mut self) -> TokenStream {
        if let Some(leave) = self.leave_part(Leave::Jump, None) {
            return leave;
        }
        let inside = self.flow.loops.iter().any(|outer| !matches!(outer.on_continue, Exit::State(_)));
        match &self.flow.machine {
            Some(machine) if inside => {
                let label = &machine.label;
                quote!(continue #label;)
            }
            _ => quote!(continue;),
        }
    }

    fn set_state(&self, state: usize) -> TokenStream {
        match &self.flow.machine {
            Some(machine) => match machine.states.get(state) {
                Some(MachineState { name, .. }) => {
                    let variable = &machine.variable;
                    quote!(#variable = State::#name;)
                }
                None => TokenStream::new(),
            },
            None => TokenStream::new(),
        }
    }

    fn new_state(&mut self, wanted: &str) -> usize {
        let Some(machine) = &mut self.flow.machine else { return 0 };
        let mut name = if wanted == "Self" { "SelfLabel".to_owned() } else { wanted.to_owned() };
        let mut number = 2;
        while !machine.named.insert(name.clone()) {
            name = format!("{wanted}{number}");
            number += 1;
        }
        machine.states.push(MachineState { name: ident(&name), code: TokenStream::new() });
        machine.states.len() - 1
    }

    /// A new state named after the current line.
    fn state_here(&mut self, what: &str) -> usize {
        let name = format!("{what}{}", self.position.line);
        self.new_state(&name)
    }

    fn label_state(&mut self, label: LabelId) -> usize {
        if let Some(state) = self.flow.machine.as_ref().and_then(|machine| machine.of_label.get(&label)) {
            return *state;
        }
        let name = self.func.and_then(|func| func.labels.get(label.0 as usize)).map_or("", |label| label.name.as_str());
        let state = self.new_state(&camel_case(name));
        if let Some(machine) = &mut self.flow.machine {
            machine.of_label.insert(label, state);
        }
        state
    }

    fn append(&mut self, code: TokenStream) {
        if let Some(machine) = &mut self.flow.machine
            && let Some(state) = machine.states.get_mut(machine.current)
        {
            state.code.extend(code);
        }
    }

    fn is_open(&self) -> bool {
        self.flow.machine.as_ref().is_some_and(|machine| machine.open)
    }

    /// Ends the current state with a jump, if its end can be reached.
    fn close(&mut self, next: usize) {
        if self.is_open() {
            let set = self.set_state(next);
            self.append(set);
        }
        self.shut();
    }

    fn shut(&mut self) {
        if let Some(machine) = &mut self.flow.machine {
            machine.open = false;
        }
    }

    fn open(&mut self, state: usize) {
        if let Some(machine) = &mut self.flow.machine {
            machine.current = state;
            machine.open = true;
        }
        let ended = visibility::ended_handles(self.func, &self.locals.visible);
        let resets = self.resets(&ended);
        self.append(resets);
    }

    /// The statements of a block whose labels are states.
    fn states(&mut self, block: &'p [Stmt]) {
        let visible = self.locals.visible.len();
        let mut whole = Vec::new();
        for group in self.groups(flow::reachable(block)) {
            let stmt = match group {
                Group::Alone(stmt) if is_state(stmt) => stmt,
                group => {
                    whole.push(group);
                    continue;
                }
            };
            self.whole(std::mem::take(&mut whole));
            self.stand_at(stmt.span);
            match &stmt.kind {
                StmtKind::Label(label) => {
                    let state = self.label_state(*label);
                    self.close(state);
                    self.open(state);
                    let comment = self.comment(stmt.span);
                    self.append(comment);
                }
                StmtKind::Goto(label) => {
                    let comment = self.comment(stmt.span);
                    let (before, state) = self.departure(*label, stmt.span);
                    self.append(quote!(#comment #before));
                    self.close(state);
                }
                StmtKind::Break | StmtKind::Continue => self.state_exit(stmt),
                _ if flow::has_label(stmt) => {
                    if !self.is_open() {
                        // Only its labels can be reached; the code before them goes into a state that is dropped.
                        let aside = self.state_here("Aside");
                        self.open(aside);
                    }
                    let comment = self.comment(stmt.span);
                    self.append(quote!(#comment));
                    self.decompose(stmt);
                }
                _ => {}
            }
        }
        self.whole(whole);
        self.locals.visible.truncate(visible);
    }

    /// Statements that stay whole inside a state.
    fn whole(&mut self, groups: Vec<Group<'p>>) {
        let diverges = groups.last().is_some_and(|group| matches!(group, Group::Alone(stmt) if flow::diverges(stmt)));
        let code = self.grouped(groups, Tail::Inner);
        self.append(code);
        if diverges {
            self.shut();
        }
    }

    /// `break` or `continue` of a decomposed loop.
    fn state_exit(&mut self, stmt: &Stmt) {
        let comment = self.comment(stmt.span);
        self.append(comment);
        let breaks = matches!(stmt.kind, StmtKind::Break);
        let exit = self.flow.loops.last().map(|outer| if breaks { &outer.on_break } else { &outer.on_continue });
        if let Some(Exit::State(state)) = exit {
            let state = *state;
            self.close(state);
        }
    }

    fn decompose(&mut self, stmt: &'p Stmt) {
        match &stmt.kind {
            StmtKind::If(arms, otherwise) => self.split_if(arms, otherwise.as_deref()),
            StmtKind::Switch(subject, arms) => self.split_switch(subject, arms),
            StmtKind::While(condition, body, info) => self.split_while(Some(condition), body, *info),
            StmtKind::Loop(body, info) => self.split_while(None, body, *info),
            StmtKind::Repeat(body, until, info) => self.split_repeat(body, until, *info),
            StmtKind::For(each) => self.split_for(each),
            _ => {}
        }
    }

    /// A branch: inside its state if it has no label, otherwise a state of its own that is filled later.
    fn branch(&mut self, block: &'p [Stmt], after: usize, later: &mut Vec<(Option<usize>, &'p [Stmt])>) -> TokenStream {
        if let Some(Stmt { kind: StmtKind::Label(label), .. }) = flow::reachable(block).first() {
            let state = self.label_state(*label);
            later.push((None, block));
            return self.set_state(state);
        }
        if block.iter().any(flow::has_label) {
            let state = self.state_here("Branch");
            later.push((Some(state), block));
            return self.set_state(state);
        }
        let code = self.block(block, Tail::Inner);
        let set = if flow::block_diverges(block) { TokenStream::new() } else { self.set_state(after) };
        quote!(#code #set)
    }

    fn fill(&mut self, later: Vec<(Option<usize>, &'p [Stmt])>, after: usize) {
        for (state, block) in later {
            match state {
                Some(state) => self.open(state),
                // The label at the start of the block opens a state.
                None => self.shut(),
            }
            self.states(block);
            self.close(after);
        }
        self.open(after);
    }

    fn split_if(&mut self, arms: &'p [(Expr, Vec<Stmt>)], otherwise: Option<&'p [Stmt]>) {
        let after = self.state_here("After");
        let mut later = Vec::new();
        for (at, (condition, block)) in arms.iter().enumerate() {
            self.stand_at(condition.span);
            let mut value = self.value_alone(condition);
            if at == 0 {
                let pointer = self.pointer();
                let before = std::mem::take(&mut value.before);
                self.append(quote!(#pointer #before));
            }
            let value = value.inline().tokens;
            let code = self.branch(block, after, &mut later);
            self.append(quote!(if #value { #code } else));
        }
        let code = match otherwise {
            Some(block) => self.branch(block, after, &mut later),
            None => self.set_state(after),
        };
        self.append(quote!({ #code }));
        self.fill(later, after);
    }

    fn split_switch(&mut self, subject: &'p Expr, arms: &'p [Arm]) {
        let after = self.state_here("After");
        let mut later = Vec::new();
        let mut codes = Vec::new();
        for arm in arms {
            self.stand_at(arm.span);
            codes.push((arm.value.as_ref(), self.branch(&arm.body, after, &mut later)));
        }
        let otherwise = self.set_state(after);
        let code = self.chosen(subject, codes, otherwise);
        self.append(code);
        self.fill(later, after);
    }

    /// The body of a decomposed loop, starting in the current state.
    fn split_body(&mut self, body: &'p [Stmt], continues: usize, after: usize) {
        self.flow.loops.push(Loop { on_break: Exit::State(after), on_continue: Exit::State(continues) });
        self.states(body);
        self.flow.loops.pop();
    }

    /// Code that leaves the current state for `after` unless the condition holds.
    fn unless(&mut self, condition: &'p Expr, after: usize) -> TokenStream {
        self.position.acts = false;
        let value = self.negated(condition);
        let pointer = self.pointer();
        let (before, unmet) = (&value.before, &value.tokens);
        let jump = self.jump(after);
        quote!(#pointer #before if #unmet { #jump })
    }

    fn split_while(&mut self, condition: Option<&'p Expr>, body: &'p [Stmt], info: LoopInfo) {
        let (head, after) = (self.state_here("Loop"), self.state_here("After"));
        self.close(head);
        self.open(head);
        let spend = self.spend(info);
        let condition = condition.filter(|condition| !flow::always(condition));
        let unless = condition.map(|condition| self.unless(condition, after));
        self.append(quote!(#spend #unless));
        self.split_body(body, head, after);
        self.close(head);
        self.open(after);
    }

    fn split_repeat(&mut self, body: &'p [Stmt], until: &'p Expr, info: LoopInfo) {
        let (head, test, after) = (self.state_here("Repeat"), self.state_here("Until"), self.state_here("After"));
        self.close(head);
        self.open(head);
        self.split_body(body, test, after);
        self.close(test);
        self.open(test);
        self.stand_at(until.span);
        let comment = self.comment(until.span);
        let value = self.value_alone(until);
        let pointer = self.pointer();
        let (before, met) = (&value.before, &value.tokens);
        let (done, again, spend) = (self.set_state(after), self.set_state(head), self.spend(info));
        self.append(quote!(#comment #pointer #before if #met { #done } else { #spend #again }));
        self.open(after);
    }

    fn split_for(&mut self, each: &'p For) {
        let visible = self.locals.visible.len();
        let line = self.position.line;
        for stmt in &each.init {
            let code = self.statement(stmt, Tail::Inner);
            self.append(code);
        }
        let (head, next, after) = (self.state_here("For"), self.state_here("Next"), self.state_here("After"));
        self.close(head);
        self.open(head);
        if let Some(condition) = each.condition.as_ref().filter(|condition| !flow::always(condition)) {
            let unless = self.unless(condition, after);
            self.append(unless);
        }
        self.split_body(&each.body, next, after);
        self.close(next);
        self.open(next);
        self.position.line = line;
        let spend = self.spend(each.info);
        let step = each.step.as_ref().map(|step| self.with_own_temporaries(|body| body.effect(step, Tail::Inner)));
        self.append(quote!(#spend #step));
        self.close(head);
        self.locals.visible.truncate(visible);
        self.open(after);
    }
}

/// Whether a statement of a block with labels begins a state, ends one, or is decomposed.
fn is_state(stmt: &Stmt) -> bool {
    matches!(stmt.kind, StmtKind::Label(_) | StmtKind::Goto(_) | StmtKind::Break | StmtKind::Continue)
        || flow::has_label(stmt)
}

/// The locals that are declared at the top level and in statements with labels.
fn declared(block: &[Stmt]) -> HashSet<LocalId> {
    let mut found = HashSet::new();
    for stmt in block {
        match &stmt.kind {
            StmtKind::Let(id, _) => {
                found.insert(*id);
            }
            _ if flow::has_label(stmt) => {
                for inner in flow::blocks(stmt) {
                    found.extend(declared(inner));
                }
            }
            _ => {}
        }
    }
    found
}
