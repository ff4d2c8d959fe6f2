//! `while` loops that end soon because a variable changes in equal steps: up or down to a constant, or along an array
//! as the index of an element that the condition reads. Beyond the ends of the array the condition causes an alarm.

use super::{flow, loops, parts};
use crate::hir::{Expr, ExprKind, Func, LocalId, Place, Projection, Root, Stmt, StmtKind, Type, Walk};
use arl_lang::ast::BinaryOp;
use arl_lang::catalog::Base;
use std::collections::HashMap;

/// What a function writes to a local variable.
#[derive(Clone, Copy, Debug)]
struct Writes {
    /// The least and the greatest constant that is written.
    constants: Option<(i64, i64)>,
    /// The number of other writes.
    others: usize,
}

/// The writes to the plain integer variables of a function.
#[derive(Debug)]
pub(super) struct Walks(HashMap<LocalId, Writes>);

impl Walks {
    pub(super) fn of_function(func: &Func) -> Self {
        let mut walks = Self(HashMap::new());
        for (id, local) in (0..).map(LocalId).zip(&func.locals) {
            if local.ty == Type::scalar(Base::Int) && !local.shared {
                // The initial value of a parameter is unknown.
                let others = usize::from(func.params.contains(&id));
                walks.0.insert(id, Writes { constants: None, others });
            }
        }
        func.body.iter().for_each(|stmt| walks.stmt(stmt));
        walks
    }

    fn stmt(&mut self, stmt: &Stmt) {
        match &stmt.kind {
            StmtKind::Let(id, None) => self.write(*id, Some(0)),
            StmtKind::Let(id, Some(value)) => {
                self.expr(value);
                self.write(*id, loops::whole_number(value));
            }
            StmtKind::Eval(Expr { kind: ExprKind::Assign(sides), .. }) if plain_local(&sides.0).is_some() => {
                self.expr(&sides.1);
                if let Some(id) = plain_local(&sides.0) {
                    self.write(id, loops::whole_number(&sides.1));
                }
            }
            _ => flow::expressions(stmt).for_each(|expr| self.expr(expr)),
        }
        flow::blocks(stmt).flatten().for_each(|stmt| self.stmt(stmt));
    }

    fn expr(&mut self, expr: &Expr) {
        let mut written = Vec::new();
        parts::local_writes(expr, &mut written);
        written.into_iter().for_each(|id| self.write(id, None));
    }

    fn write(&mut self, id: LocalId, constant: Option<i64>) {
        if let Some(writes) = self.0.get_mut(&id) {
            match constant {
                Some(value) => {
                    let (least, greatest) = writes.constants.unwrap_or((value, value));
                    writes.constants = Some((least.min(value), greatest.max(value)));
                }
                None => writes.others += 1,
            }
        }
    }

    /// The variable that ends a `while`, and the maximum number of rounds.
    pub(super) fn of_while(&self, condition: &Expr, body: &[Stmt]) -> Option<(Walk, u64)> {
        if flow::continues(body) || body.iter().any(flow::has_label) {
            return None;
        }
        body.iter().filter_map(step).find_map(|walk| {
            let writes = self.0.get(&walk.local)?;
            // Its step is the only write in the loop.
            let in_loop = body.iter().map(|stmt| loops::writes_in(stmt, walk.local)).sum::<usize>();
            if in_loop != 1 || loops::expr_writes(condition, walk.local) {
                return None;
            }
            let mut shortest: Option<u64> = None;
            conjuncts(condition, &mut |part| {
                let distance = to_constant(part, walk, *writes).or_else(|| along_array(part, walk.local));
                shortest = shortest.into_iter().chain(distance).min();
            });
            Some((walk, shortest? / u64::from(walk.step.unsigned_abs()) + 1))
        })
    }
}

/// A local variable as a whole.
fn plain_local(place: &Place) -> Option<LocalId> {
    match place.root {
        Root::Local(id) if place.path.is_empty() => Some(id),
        _ => None,
    }
}

fn is_variable(expr: &Expr, id: LocalId) -> bool {
    matches!(&expr.kind, ExprKind::Place(place) if plain_local(place) == Some(id))
}

/// `v++`, `v--`, `v = v + 3`, `v += 3` and similar statements.
fn step(stmt: &Stmt) -> Option<Walk> {
    let StmtKind::Eval(expr) = &stmt.kind else { return None };
    let (place, op, by) = match &expr.kind {
        ExprKind::Step(step, place) => {
            let local = plain_local(place)?;
            return Some(Walk { local, step: if step.up { 1 } else { -1 } });
        }
        ExprKind::AssignOp(op, sides) => (&sides.0, *op, &sides.1),
        ExprKind::Assign(sides) => match &sides.1.kind {
            ExprKind::Binary(op, sum) if is_variable(&sum.0, plain_local(&sides.0)?) => (&sides.0, *op, &sum.1),
            _ => return None,
        },
        _ => return None,
    };
    let by = i32::try_from(loops::whole_number(by)?).ok()?;
    let step = match op {
        BinaryOp::Add => by,
        BinaryOp::Subtract => by.checked_neg()?,
        _ => return None,
    };
    let local = plain_local(place)?;
    (step != 0 && place.ty == Type::scalar(Base::Int)).then_some(Walk { local, step })
}

/// Calls `see` for each condition that must hold for another round.
fn conjuncts<'p>(condition: &'p Expr, see: &mut dyn FnMut(&'p Expr)) {
    match &condition.kind {
        ExprKind::Binary(BinaryOp::And, sides) => {
            conjuncts(&sides.0, see);
            conjuncts(&sides.1, see);
        }
        _ => see(condition),
    }
}

/// The maximum distance to a constant that the variable is compared with; `None` if the variable may start anywhere.
fn to_constant(part: &Expr, walk: Walk, writes: Writes) -> Option<u64> {
    let ExprKind::Binary(op, sides) = &part.kind else { return None };
    let (least, greatest) = writes.constants.filter(|_| writes.others == 1)?;
    if !is_variable(&sides.0, walk.local) {
        return None;
    }
    let to = loops::whole_number(&sides.1)?;
    // The variable must not wrap beyond the constant.
    let room = i64::from(i32::MAX) - i64::from(walk.step).abs();
    let distance = match op {
        BinaryOp::Less | BinaryOp::LessEqual if walk.step > 0 && to < room => to.saturating_sub(least),
        BinaryOp::Greater | BinaryOp::GreaterEqual if walk.step < 0 && to > -room => greatest.saturating_sub(to),
        _ => return None,
    };
    Some(distance.max(0).unsigned_abs() + 1)
}

/// The length of an array if the condition reads an element of it whose index is the variable, with or without a
/// constant added.
fn along_array(part: &Expr, local: LocalId) -> Option<u64> {
    // The right side of an `or` and the effects of a call of the program may be skipped.
    let always = match &part.kind {
        ExprKind::Binary(BinaryOp::And | BinaryOp::Or, sides) => return along_array(&sides.0, local),
        ExprKind::Place(place) => {
            let found = place.path.iter().find_map(|step| match step {
                Projection::Index(indices, array) => match indices.as_slice() {
                    [index] if follows(index, local) => Some(array.len() as u64),
                    _ => None,
                },
                Projection::Field(..) => None,
            });
            if found.is_some() {
                return found;
            }
            parts::children(part)
        }
        ExprKind::Call(..) => Vec::new(),
        _ => parts::children(part),
    };
    always.into_iter().find_map(|part| along_array(part, local))
}

/// `v`, `v + 1`, `v - 1`
fn follows(index: &Expr, local: LocalId) -> bool {
    match &index.kind {
        ExprKind::Binary(BinaryOp::Add | BinaryOp::Subtract, sides) => {
            is_variable(&sides.0, local) && loops::whole_number(&sides.1).is_some()
        }
        _ => is_variable(index, local),
    }
}
