//! Finds the names before `::`, so that the files they refer to can be read before anything is checked.

use arl_lang::ast::{Arg, Block, Decl, Expr, ExprKind, File, Ident, Item, Stmt, StmtKind};

/// The first use of each scope name, in source order.
pub(crate) fn scopes(file: &File) -> Vec<Ident> {
    let mut found = Scopes::default();
    for item in &file.items {
        match item {
            Item::Import(_) => {}
            Item::Global(decl) => found.decl(decl),
            Item::Func(func) => {
                func.params.iter().flat_map(|param| &param.dims).for_each(|dim| found.expr(dim));
                found.block(&func.body);
            }
        }
    }
    found.0
}

#[derive(Default)]
struct Scopes(Vec<Ident>);

impl Scopes {
    fn add(&mut self, scope: Ident) {
        if !self.0.iter().any(|known| known.symbol == scope.symbol) {
            self.0.push(scope);
        }
    }

    fn decl(&mut self, decl: &Decl) {
        for var in &decl.vars {
            var.dims.iter().chain(&var.init).for_each(|expr| self.expr(expr));
        }
    }

    fn block(&mut self, block: &Block) {
        block.iter().for_each(|stmt| self.stmt(stmt));
    }

    fn stmt(&mut self, stmt: &Stmt) {
        match &stmt.kind {
            StmtKind::Decl(decl) => self.decl(decl),
            StmtKind::Expr(expr) => self.expr(expr),
            StmtKind::Instr(instr) => {
                self.args(&instr.args);
                instr.events.iter().for_each(|(event, action)| {
                    self.expr(event);
                    self.expr(action);
                });
            }
            StmtKind::If(branches) => {
                for (condition, block) in &branches.arms {
                    self.expr(condition);
                    self.block(block);
                }
                branches.otherwise.iter().for_each(|block| self.block(block));
            }
            StmtKind::CompactIf(both) => {
                self.expr(&both.0);
                self.stmt(&both.1);
            }
            StmtKind::While(condition, body) => {
                self.expr(condition);
                self.block(body);
            }
            StmtKind::Repeat(body, until) => {
                self.block(body);
                until.iter().for_each(|until| self.expr(until));
            }
            StmtKind::Loop(body) => self.block(body),
            StmtKind::For(each) => {
                each.init.iter().for_each(|init| self.stmt(init));
                each.condition.iter().chain(&each.step).for_each(|expr| self.expr(expr));
                self.block(&each.body);
            }
            StmtKind::Switch(switch) => {
                self.expr(&switch.subject);
                for arm in &switch.arms {
                    arm.value.iter().for_each(|value| self.expr(value));
                    self.block(&arm.body);
                }
            }
            StmtKind::Return(value) => value.iter().for_each(|value| self.expr(value)),
            StmtKind::Break | StmtKind::Continue | StmtKind::Goto(_) | StmtKind::Label(_) => {}
        }
    }

    fn args(&mut self, args: &[Arg]) {
        args.iter().for_each(|arg| self.expr(&arg.value));
    }

    fn expr(&mut self, expr: &Expr) {
        match &expr.kind {
            ExprKind::Path { scope, .. } => self.add(*scope),
            ExprKind::Index(both) | ExprKind::Binary(_, both) | ExprKind::Assign(_, both) => {
                self.expr(&both.0);
                self.expr(&both.1);
            }
            ExprKind::Field(inner, _) | ExprKind::Unary(_, inner) | ExprKind::Step(_, inner) => self.expr(inner),
            ExprKind::Call(call) => {
                call.module.iter().for_each(|module| self.add(*module));
                self.args(&call.args);
            }
            ExprKind::Brace(items) => items.iter().for_each(|item| self.expr(&item.value)),
            ExprKind::Int(..)
            | ExprKind::Double(_)
            | ExprKind::String(_)
            | ExprKind::Bool(_)
            | ExprKind::Name(_)
            | ExprKind::System(_)
            | ExprKind::Splice(_)
            | ExprKind::Error => {}
        }
    }
}
