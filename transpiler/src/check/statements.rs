//! Statements and function bodies.

use super::arguments::{CheckedCallee, does_something};
use super::context::{CheckState, CheckedBody, Checker};
use super::convert::Typed;
use super::doubts::is_comparison;
use crate::diagnostics::arguments::ArgumentProblem;
use crate::diagnostics::doubts::Doubt;
use crate::diagnostics::flow::FlowProblem;
use crate::diagnostics::names::NameProblem;
use crate::diagnostics::types::TypeProblem;
use crate::hir::{
    self, Arm, Block, Bound, Expr, ExprKind, For, FuncId, LabelId, LoopInfo, Passed, Stmt, StmtKind, Type, Value,
};
use crate::index::{Meaning, Role, Wanted};
use crate::operators::integer;
use arl_lang::ast;
use arl_lang::catalog::{self, Base, Effect, Kind, Mode, Presence};
use arl_lang::elsewhere;
use arl_lang::span::Span;
use arl_lang::symbol::Symbol;
use std::collections::HashMap;

impl Checker<'_> {
    /// Checks the body of a function whose signature is known.
    pub(crate) fn check_func(&mut self, id: FuncId) {
        self.check_signature(id);
        let Some(slot) = self.funcs.get(id.0 as usize) else { return };
        debug_assert!(slot.state == CheckState::Done);
        let (module, func, item) = (slot.module, slot.ast, slot.item);
        let (types, result) = (slot.params.clone(), slot.result);
        let mut body = CheckedBody::new(module, item);
        body.func = Some(id);
        body.result = result;
        let scope = body.enter();
        let mut params = Vec::new();
        for (param, ty) in func.params.iter().zip(types) {
            params.push(self.declare_local(&mut body, param.name, ty, false, None));
        }
        self.collect_labels(&mut body, &func.body);
        // The body is a scope of its own, but a local may not hide a parameter: they share one scope.
        let block = self.block_in_scope(&mut body, &func.body);
        body.leave(scope);
        let checked = hir::Func {
            name: self.names.name(func.name.symbol).to_string(),
            module,
            params,
            locals: std::mem::take(&mut body.locals),
            labels: std::mem::take(&mut body.labels),
            result: result.unwrap_or(Base::Void),
            body: block,
            span: func.span,
            end: func.end,
            effects: hir::Effects::default(),
            has_goto: body.has_goto,
        };
        self.check_flow(&checked);
        if let Some(slot) = self.funcs.get_mut(id.0 as usize) {
            slot.checked = Some(checked);
        }
    }

    fn collect_labels(&mut self, body: &mut CheckedBody, block: &ast::Block) {
        for stmt in block {
            match &stmt.kind {
                ast::StmtKind::Label(name) => self.add_label(body, *name),
                ast::StmtKind::If(branches) => {
                    branches.arms.iter().for_each(|(_, block)| self.collect_labels(body, block));
                    branches.otherwise.iter().for_each(|block| self.collect_labels(body, block));
                }
                ast::StmtKind::While(_, block) | ast::StmtKind::Repeat(block, _) | ast::StmtKind::Loop(block) => {
                    self.collect_labels(body, block);
                }
                ast::StmtKind::For(each) => self.collect_labels(body, &each.body),
                ast::StmtKind::Switch(switch) => {
                    switch.arms.iter().for_each(|arm| self.collect_labels(body, &arm.body));
                }
                _ => {}
            }
        }
    }

    fn add_label(&mut self, body: &mut CheckedBody, name: ast::Ident) {
        if let Some(earlier) = body.label_names.get(&name.symbol) {
            let first = body.labels.get(earlier.0 as usize).map_or(name.span, |label| label.span);
            let text = self.text(body.module, name.span).to_string();
            let labels = [(body.module, first, "first declared here")];
            let problem = NameProblem::Duplicate { name: text, what: "label" };
            self.report_in::<()>(body.module, name.span, problem, &labels);
            return;
        }
        let at = self.location(body.module, name.span);
        self.mention_in(body.module, name.span, Meaning::Label(at), Role::Declares);
        let id = LabelId(body.labels.len() as u32);
        let text = self.names.name(name.symbol).to_string();
        body.labels.push(hir::GotoLabel { name: text, span: name.span, used: false });
        body.label_names.insert(name.symbol, id);
    }

    /// Checks statements in a scope of their own.
    fn block(&mut self, body: &mut CheckedBody, block: &ast::Block) -> Block {
        let scope = body.enter();
        let checked = self.block_in_scope(body, block);
        body.leave(scope);
        checked
    }

    /// Checks statements in the current scope.
    pub(crate) fn block_in_scope(&mut self, body: &mut CheckedBody, block: &ast::Block) -> Block {
        let mut out = Vec::with_capacity(block.len());
        block.iter().for_each(|stmt| self.statement(body, stmt, &mut out));
        out
    }

    fn statement(&mut self, body: &mut CheckedBody, stmt: &ast::Stmt, out: &mut Vec<Stmt>) {
        let kind = match &stmt.kind {
            ast::StmtKind::Decl(decl) => {
                self.local_decl(body, decl, out);
                None
            }
            ast::StmtKind::Expr(expr) => self.expression_statement(body, expr),
            ast::StmtKind::Instr(instr) => self.instruction(body, instr, stmt, out).map(StmtKind::Eval),
            ast::StmtKind::If(branches) => self.if_statement(body, branches),
            ast::StmtKind::CompactIf(both) => {
                let condition = self.condition(body, &both.0);
                let mut inner = Vec::new();
                let scope = body.enter();
                self.statement(body, &both.1, &mut inner);
                body.leave(scope);
                condition.map(|condition| StmtKind::If(vec![(condition, inner)], None))
            }
            ast::StmtKind::While(condition, block) => {
                let condition = self.condition(body, condition);
                let block = self.looped(body, block);
                condition.map(|condition| StmtKind::While(condition, block, LoopInfo::default()))
            }
            ast::StmtKind::Repeat(block, until) => {
                let block = self.looped(body, block);
                let until = until.as_ref().and_then(|until| self.condition(body, until));
                until.map(|until| StmtKind::Repeat(block, until, LoopInfo::default()))
            }
            ast::StmtKind::Loop(block) => Some(StmtKind::Loop(self.looped(body, block), LoopInfo::default())),
            ast::StmtKind::For(each) => self.for_statement(body, each),
            ast::StmtKind::Switch(switch) => self.switch(body, switch),
            ast::StmtKind::Break => self.jump(body, stmt, StmtKind::Break),
            ast::StmtKind::Continue => self.jump(body, stmt, StmtKind::Continue),
            ast::StmtKind::Goto(name) => self.goto(body, *name),
            ast::StmtKind::Label(name) => body.label_names.get(&name.symbol).copied().map(StmtKind::Label),
            ast::StmtKind::Return(value) => self.return_statement(body, value.as_deref(), stmt),
        };
        if kind.is_none() && !matches!(stmt.kind, ast::StmtKind::Decl(_)) {
            self.must_be_reported(body.module, stmt.span);
        }
        out.extend(kind.map(|kind| Stmt { kind, span: stmt.span }));
    }

    fn expression_statement(&mut self, body: &mut CheckedBody, expr: &ast::Expr) -> Option<StmtKind> {
        if let ast::ExprKind::Name(symbol) = expr.kind
            && let Some(problem) = self.lone_word(body, symbol, expr.span)
        {
            return self.report(body, expr.span, problem);
        }
        let typed = self.expr(body, expr, None)?;
        self.doubt_effect(body, expr);
        Some(StmtKind::Eval(typed.expr))
    }

    /// Warns about an expression whose value is not used and which has no other effect.
    fn doubt_effect(&mut self, body: &CheckedBody, expr: &ast::Expr) {
        if is_comparison(expr) {
            self.report::<()>(body, expr.span, Doubt::ComparedStatement);
        } else if !does_something(expr) {
            self.report::<()>(body, expr.span, FlowProblem::NoEffect);
        }
    }

    /// The problem with an unknown name that stands alone on its line: a word of another language or a misspelled word
    /// of ARL.
    fn lone_word(&mut self, body: &CheckedBody, symbol: Symbol, span: Span) -> Option<NameProblem> {
        let name = self.names.name(symbol);
        let known = body.find(symbol).is_some() || self.find_global(body, symbol).is_some();
        if known || self.names_function(body, symbol) || catalog::constant(name).is_some() {
            return None;
        }
        let words = || arl_lang::control_words().chain(instructions());
        let near = self.hints.nearest(name, words().count(), words).map(String::from);
        if near.is_none() && elsewhere::word(name).is_none() {
            return None;
        }
        let name = self.text(body.module, span).to_string();
        Some(NameProblem::UnknownInstruction { name, near, is_function: false })
    }

    /// Checks an instruction; the events of a motion are emitted before it, as triggers.
    fn instruction(
        &mut self,
        body: &mut CheckedBody,
        instr: &ast::Instr,
        stmt: &ast::Stmt,
        before: &mut Vec<Stmt>,
    ) -> Option<Expr> {
        let name = self.names.name(instr.name.symbol);
        let all = catalog::instructions(name);
        let family = self.family();
        let entry = all.iter().find(|entry| entry.family.is_none_or(|only| only == family));
        let entry = match (entry, all.first()) {
            (Some(entry), _) => entry,
            (None, Some(other)) => return self.report_family(body, instr.name.span, other),
            (None, None) => return self.unknown_instruction(body, instr),
        };
        self.strict_case(body, instr.name.span, entry.name);
        self.mention(body, instr.name.span, Meaning::Builtin(entry));
        let args = self.bind(body, &CheckedCallee::Builtin(entry), &instr.args, instr.name.span);
        let triggers: Vec<Option<Expr>> =
            instr.events.iter().map(|(event, action)| self.trigger(body, event, action)).collect();
        if let Some((event, _)) = instr.events.first()
            && entry.effect != Effect::Plans
        {
            let callee = entry.name.to_string();
            return self.report(body, event.span, ArgumentProblem::Events { callee });
        }
        let triggers = triggers.into_iter().collect::<Option<Vec<Expr>>>()?;
        let motion = self.builtin(body, entry, args?, instr.name.span, stmt.span)?;
        before.extend(triggers.into_iter().map(|trigger| Stmt { kind: StmtKind::Eval(trigger), span: stmt.span }));
        Some(motion)
    }

    /// The trigger for which an event after a motion is shorthand.
    fn trigger(&mut self, body: &mut CheckedBody, event: &ast::Expr, action: &ast::Expr) -> Option<Expr> {
        let condition = self.condition(body, event);
        let action = self.action(body, action, None);
        self.has_conditions = true;
        let entry = catalog::trigger()?;
        let mut args = Vec::new();
        for (at, param) in entry.params.iter().enumerate() {
            if let Presence::Default(text) = param.presence {
                let priority = Expr {
                    ty: Type::scalar(Base::Int),
                    kind: ExprKind::Const(Value::Int(text.parse().ok()?)),
                    span: event.span,
                };
                args.push(Bound { param: at, value: Passed::Value(priority) });
            }
        }
        let mut pass = |mode: Mode, value: Expr| {
            let param = entry.params.iter().position(|param| param.mode == mode)?;
            args.push(Bound { param, value: Passed::Value(value) });
            Some(())
        };
        pass(Mode::Condition, condition?)?;
        pass(Mode::Action, action?)?;
        self.builtin(body, entry, args, event.span, event.span)
    }

    /// Checks the action of an event; `typed` is the checked action if its type is known already.
    pub(crate) fn action(&mut self, body: &mut CheckedBody, expr: &ast::Expr, typed: Option<Typed>) -> Option<Expr> {
        self.expect_action(body, expr);
        let typed = match typed {
            Some(typed) => typed,
            None => self.expr(body, expr, None)?,
        };
        if !does_something(expr) {
            self.report::<()>(body, expr.span, FlowProblem::NoEffect);
        }
        Some(typed.expr)
    }

    fn unknown_instruction<T>(&mut self, body: &mut CheckedBody, instr: &ast::Instr) -> Option<T> {
        for arg in &instr.args {
            if !matches!(arg.value.kind, ast::ExprKind::Brace(_)) {
                self.expr(body, &arg.value, None);
            }
        }
        self.report_unknown_instruction(body, instr.name.symbol, instr.name.span)
    }

    pub(crate) fn report_unknown_instruction<T>(
        &mut self,
        body: &CheckedBody,
        symbol: Symbol,
        span: Span,
    ) -> Option<T> {
        self.expect(body, symbol, span, Wanted::Instruction);
        let is_function = self.names_function(body, symbol);
        let near = self.hints.nearest(self.names.name(symbol), instructions().count(), instructions).map(Into::into);
        let name = self.text(body.module, span).to_string();
        self.report(body, span, NameProblem::UnknownInstruction { name, near, is_function })
    }

    /// Whether a function of this module or a built-in function has this name.
    pub(crate) fn names_function(&self, body: &CheckedBody, symbol: Symbol) -> bool {
        let own = self.scopes.get(body.module.0 as usize).is_some_and(|scope| scope.funcs.contains_key(&symbol));
        own || !catalog::functions(self.names.name(symbol)).is_empty()
    }

    fn if_statement(&mut self, body: &mut CheckedBody, branches: &ast::If) -> Option<StmtKind> {
        let mut arms = Vec::new();
        let mut good = true;
        for (condition, block) in &branches.arms {
            let condition = self.condition(body, condition);
            let block = self.block(body, block);
            match condition {
                Some(condition) => arms.push((condition, block)),
                None => good = false,
            }
        }
        let otherwise = branches.otherwise.as_ref().map(|block| self.block(body, block));
        good.then_some(StmtKind::If(arms, otherwise))
    }

    /// The body of a loop.
    fn looped(&mut self, body: &mut CheckedBody, block: &ast::Block) -> Block {
        body.loops += 1;
        let switches = std::mem::take(&mut body.switches);
        let checked = self.block(body, block);
        body.switches = switches;
        body.loops -= 1;
        checked
    }

    fn for_statement(&mut self, body: &mut CheckedBody, each: &ast::For) -> Option<StmtKind> {
        let scope = body.enter();
        let mut init = Vec::new();
        if let Some(first) = &each.init {
            self.statement(body, first, &mut init);
        }
        let condition = each.condition.as_ref().map(|condition| self.condition(body, condition));
        let step = each.step.as_ref().map(|step| {
            let typed = self.expr(body, step, None)?;
            self.doubt_effect(body, step);
            Some(typed)
        });
        let block = self.looped(body, &each.body);
        body.leave(scope);
        let condition = match condition {
            Some(condition) => Some(condition?),
            None => None,
        };
        let step = match step {
            Some(step) => Some(step?.expr),
            None => None,
        };
        let info = LoopInfo::default();
        Some(StmtKind::For(Box::new(For { init, condition, step, body: block, info, shared: false })))
    }

    fn switch(&mut self, body: &mut CheckedBody, switch: &ast::Switch) -> Option<StmtKind> {
        let subject = self.expr(body, &switch.subject, None);
        let subject = subject.and_then(|subject| {
            let ty = subject.expr.ty;
            if ty.base == Base::Void {
                return self.report_no_value(body, &subject.expr);
            }
            let comparable =
                matches!(ty.base, Base::Int | Base::Byte | Base::Uint | Base::Bool | Base::String | Base::Enum(_));
            if comparable && !ty.is_array() {
                return Some(subject.expr);
            }
            let ty = self.type_name(ty);
            self.report(body, switch.subject.span, FlowProblem::SwitchType { ty })
        });
        let ty = subject.as_ref().map(|subject| subject.ty);
        let mut arms = Vec::new();
        let mut seen = HashMap::new();
        let mut default = false;
        for arm in &switch.arms {
            let value = match &arm.value {
                Some(value) => self.case_value(body, value, ty, &mut seen).map(Some),
                // The parser has reported it.
                None if std::mem::replace(&mut default, true) => None,
                None => Some(None),
            };
            body.switches += 1;
            let block = self.block(body, &arm.body);
            body.switches -= 1;
            if let Some(value) = value {
                arms.push(Arm { value, body: block, span: arm.span });
            }
        }
        Some(StmtKind::Switch(subject?, arms))
    }

    fn case_value(
        &mut self,
        body: &mut CheckedBody,
        value: &ast::Expr,
        ty: Option<Type>,
        seen: &mut HashMap<String, Span>,
    ) -> Option<Value> {
        let typed = self.expr(body, value, ty)?;
        let checked = self.coerce(body, typed, ty?, "a case of this switch")?;
        let ExprKind::Const(constant) = checked.kind else {
            return self.report(body, value.span, FlowProblem::CaseNotConstant);
        };
        if let Some(first) = seen.insert(case_key(&constant), value.span) {
            let problem = FlowProblem::CaseTwice { value: self.excerpt(body.module, value.span) };
            return self.report_in(body.module, value.span, problem, &[(body.module, first, "first used here")]);
        }
        Some(constant)
    }

    fn jump(&mut self, body: &CheckedBody, stmt: &ast::Stmt, kind: StmtKind) -> Option<StmtKind> {
        if body.loops > 0 {
            return Some(kind);
        }
        match kind {
            StmtKind::Break => self.report(body, stmt.span, FlowProblem::BreakOutside { in_switch: body.switches > 0 }),
            _ => self.report(body, stmt.span, FlowProblem::ContinueOutside),
        }
    }

    fn goto(&mut self, body: &mut CheckedBody, name: ast::Ident) -> Option<StmtKind> {
        body.has_goto = true;
        if let Some(id) = body.label_names.get(&name.symbol).copied() {
            let declared = body.labels.get_mut(id.0 as usize).map(|label| {
                label.used = true;
                label.span
            });
            self.strict_case(body, name.span, self.text(body.module, declared.unwrap_or(name.span)));
            let at = self.location(body.module, declared.unwrap_or(name.span));
            self.mention(body, name.span, Meaning::Label(at));
            return Some(StmtKind::Goto(id));
        }
        let there = body.labels.iter().map(|label| self.text(body.module, label.span).to_string()).collect();
        self.expect(body, name.symbol, name.span, Wanted::Label(there));
        let wanted = self.names.name(name.symbol);
        let labels = || body.labels.iter().map(|label| label.name.as_str());
        let near = self.hints.nearest(wanted, body.labels.len(), labels).map(Into::into);
        let name_text = self.text(body.module, name.span).to_string();
        self.report(body, name.span, NameProblem::UnknownLabel { name: name_text, near })
    }

    fn return_statement(
        &mut self,
        body: &mut CheckedBody,
        value: Option<&ast::Expr>,
        stmt: &ast::Stmt,
    ) -> Option<StmtKind> {
        let Some(base) = body.result else {
            value.map(|value| self.expr(body, value, None));
            return None;
        };
        let result = Type::scalar(base);
        match value {
            None if base == Base::Void => Some(StmtKind::Return(None)),
            None => {
                let result = self.type_name(result);
                self.report(body, stmt.span, FlowProblem::ReturnWithoutValue { result })
            }
            Some(value) if base == Base::Void => {
                self.expr(body, value, None);
                self.report(body, value.span, FlowProblem::ReturnWithValue)
            }
            Some(value) => {
                let typed = self.expr(body, value, Some(result))?;
                if typed.expr.ty.is_array() {
                    let ty = self.type_name(typed.expr.ty);
                    return self.report(body, value.span, TypeProblem::ResultType { ty });
                }
                let value = self.coerce(body, typed, result, "the result")?;
                Some(StmtKind::Return(Some(value)))
            }
        }
    }
}

/// The names of all instructions.
fn instructions() -> impl Iterator<Item = &'static str> {
    catalog::all_entries().iter().filter(|entry| entry.kind == Kind::Instruction).map(|entry| entry.name)
}

/// The instruction with the most similar name.
pub(crate) fn near_instruction(name: &str) -> Option<&'static str> {
    crate::near::nearest(name, instructions())
}

/// A string that is equal for equal constants of one type.
fn case_key(value: &Value) -> String {
    match (value, integer(value)) {
        (_, Some(number)) => number.to_string(),
        (Value::String(text), _) => text.to_string(),
        (Value::Enum(_, index), _) => index.to_string(),
        (Value::Bool(value), _) => value.to_string(),
        (other, _) => format!("{other:?}"),
    }
}
