//! Facts about evaluating expressions and running statements.

use super::ranges::Ranges;
use super::{captures, flow, growth};
use crate::hir::{
    Effects, Expr, ExprKind, Func, FuncId, LocalId, Passed, Place, Program, Projection, Root, Stmt, StmtKind, Type,
    Value,
};
use arl_lang::ast::{BinaryOp, UnaryOp};
use arl_lang::catalog::{Base, Effect, Mode, Takes};

/// What one or more expressions do.
#[derive(Default, Debug)]
pub(crate) struct Facts {
    /// The locals that are read.
    pub(crate) reads: Vec<LocalId>,
    /// The locals that are written.
    pub(crate) writes: Vec<LocalId>,
    /// Whether variables are read that other code may write: global and system variables.
    pub(crate) world: bool,
    /// Whether anything visible outside is read or changed, or the program may be ended on purpose.
    pub(crate) acts: bool,
    /// Whether anything visible outside is changed.
    pub(crate) changes: bool,
    /// Whether an alarm is possible.
    pub(crate) fails: bool,
    /// Whether the cycle may be yielded.
    pub(crate) waits: bool,
    /// Whether the context is needed.
    pub(crate) context: bool,
    /// Whether a built-in that looks at the program pointer is used.
    pub(crate) points: bool,
    /// Whether global variables are needed.
    pub(crate) globals: bool,
    /// The functions that are called.
    pub(crate) calls: Vec<FuncId>,
    /// The functions that the conditions and actions of events call.
    pub(crate) later_calls: Vec<FuncId>,
}

impl Facts {
    /// Whether evaluating the expression changes nothing and cannot fail.
    pub(crate) fn quiet(&self) -> bool {
        self.writes.is_empty() && !self.acts && !self.fails && !self.waits
    }

    /// Whether evaluating the expression after the one described by `later` makes a difference.
    pub(crate) fn disturbed_by(&self, later: &Facts) -> bool {
        self.reads.iter().any(|read| later.writes.contains(read))
            || self.writes.iter().any(|write| later.reads.contains(write) || later.writes.contains(write))
            || (self.world && (later.acts || later.waits))
            || (self.fails && (later.acts || later.fails || later.waits))
            || ((self.acts || self.waits) && (later.acts || later.world || later.fails || later.waits))
    }
}

/// The context for determining facts.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FactScope<'a> {
    pub(crate) program: &'a Program,
    /// The function that contains the expression.
    pub(crate) func: Option<&'a Func>,
    /// The values of that function's counting variables.
    pub(crate) ranges: &'a Ranges,
}

/// The facts about what a function does itself; the functions that it calls are only listed.
pub(crate) fn of_function(program: &Program, func: &Func) -> Facts {
    let ranges = Ranges::of_function(func);
    let scope = FactScope { program, func: Some(func), ranges: &ranges };
    let mut collector = Collector { scope, callees: false, facts: Facts::default() };
    collector.block(&func.body);
    collector.facts
}

/// The facts about an expression, once the effects of the functions are known.
pub(crate) fn of_expr(scope: FactScope<'_>, expr: &Expr) -> Facts {
    let mut collector = Collector { scope, callees: true, facts: Facts::default() };
    collector.expr(expr);
    collector.facts
}

/// The facts about reading a place.
pub(crate) fn of_place(scope: FactScope<'_>, place: &Place) -> Facts {
    let mut collector = Collector { scope, callees: true, facts: Facts::default() };
    collector.read(place);
    collector.facts
}

/// The facts about the indices of a projection.
pub(crate) fn of_indices(scope: FactScope<'_>, indices: &[Expr], array: Type) -> Facts {
    let mut collector = Collector { scope, callees: true, facts: Facts::default() };
    collector.indices(indices, array);
    collector.facts
}

/// For an assignment to a local variable that does no more than compute its value: that value. Examples are `a = a` and
/// the outer assignment of `a = (a = b)`.
pub(crate) fn same_anyway(expr: &Expr) -> Option<&Expr> {
    let ExprKind::Assign(sides) = &expr.kind else { return None };
    let place = &sides.0;
    let value = plain_truth(&sides.1, true).unwrap_or(&sides.1);
    let known = match &value.kind {
        ExprKind::Place(from) => from,
        ExprKind::Assign(sides) | ExprKind::AssignOp(_, sides) if place.path.is_empty() => &sides.0,
        ExprKind::Step(step, from) if step.prefix && place.path.is_empty() => from,
        _ => return None,
    };
    let (Root::Local(a), Root::Local(b)) = (place.root, known.root) else { return None };
    let same_path = place.path.len() == known.path.len()
        && place.path.iter().zip(&known.path).all(|steps| match steps {
            (Projection::Field(_, a), Projection::Field(_, b)) => a == b,
            _ => false,
        });
    (a == b && same_path).then_some(value)
}

/// The other side of a comparison with a bool constant, and whether the comparison is true if that side is.
pub(crate) fn compared_with_bool<'p>(op: BinaryOp, left: &'p Expr, right: &'p Expr) -> Option<(&'p Expr, bool)> {
    let (other, value) = match (&left.kind, &right.kind) {
        (_, ExprKind::Const(Value::Bool(value))) => (left, *value),
        (ExprKind::Const(Value::Bool(value)), _) => (right, *value),
        _ => return None,
    };
    match op {
        BinaryOp::Equal => Some((other, value)),
        BinaryOp::NotEqual => Some((other, !value)),
        _ => None,
    }
}

/// A bool expression without negations and comparisons that cancel out: `!!b`, `b == true`; with `wanted` false, the
/// expression of which it is the opposite.
fn plain_truth(expr: &Expr, wanted: bool) -> Option<&Expr> {
    match &expr.kind {
        _ if expr.ty.base != Base::Bool => None,
        ExprKind::Unary(UnaryOp::Not, inner) => plain_truth(inner, !wanted),
        ExprKind::Binary(op, sides) => {
            let (other, same) = compared_with_bool(*op, &sides.0, &sides.1)?;
            plain_truth(other, same == wanted)
        }
        _ => wanted.then_some(expr),
    }
}

struct Collector<'a> {
    scope: FactScope<'a>,
    /// Whether the effects of called functions count.
    callees: bool,
    facts: Facts,
}

impl Collector<'_> {
    fn block(&mut self, block: &[Stmt]) {
        for stmt in flow::reachable(block) {
            self.stmt(stmt);
        }
    }

    fn stmt(&mut self, stmt: &Stmt) {
        for expr in flow::expressions(stmt) {
            self.expr(expr);
        }
        for block in flow::blocks(stmt) {
            self.block(block);
        }
        let gives_back = match &stmt.kind {
            StmtKind::While(_, _, info) | StmtKind::Repeat(_, _, info) | StmtKind::Loop(_, info) => info.spends,
            StmtKind::For(each) => each.info.spends,
            StmtKind::Goto(label) => self.scope.func.is_some_and(|func| {
                func.labels.get(label.0 as usize).is_some_and(|label| label.span.start <= stmt.span.start)
            }),
            _ => false,
        };
        let info = match &stmt.kind {
            StmtKind::For(each) => Some(each.info),
            StmtKind::While(_, _, info) => Some(*info),
            _ => None,
        };
        self.facts.context |= info.is_some_and(|info| info.counting.is_behind());
        if gives_back {
            self.facts.waits = true;
            self.facts.context = true;
        }
    }

    fn expr(&mut self, expr: &Expr) {
        match &expr.kind {
            ExprKind::Const(_) | ExprKind::Splice(_) => {}
            ExprKind::Place(place) => self.read(place),
            ExprKind::FieldOf(inner, ..) | ExprKind::Convert(inner) | ExprKind::Unary(_, inner) => self.expr(inner),
            ExprKind::Grown(inner) => {
                self.expr(inner);
                self.facts.fails = true;
            }
            ExprKind::Binary(op, sides) => {
                self.expr(&sides.0);
                self.expr(&sides.1);
                self.facts.fails |= self.operator_fails(*op, sides.0.ty, &sides.1);
            }
            ExprKind::Assign(sides) => {
                self.path(&sides.0);
                self.expr(&sides.1);
                self.write(&sides.0, Some(&sides.1));
            }
            ExprKind::AssignOp(op, sides) => {
                self.read(&sides.0);
                self.expr(&sides.1);
                self.facts.fails |= self.operator_fails(*op, sides.0.ty, &sides.1) || growth::appends(*op, &sides.0);
                self.write(&sides.0, None);
            }
            ExprKind::Step(_, place) => {
                self.read(place);
                self.write(place, None);
            }
            ExprKind::Call(id, args) => {
                args.iter().for_each(|arg| self.expr(arg));
                self.call(*id);
            }
            ExprKind::Builtin(builtin) => {
                for arg in &builtin.args {
                    match &arg.value {
                        Passed::Value(value) if captures::is_later(builtin.entry, arg) => self.later(value),
                        Passed::Value(value) => self.expr(value),
                        Passed::Out(place) => {
                            self.read(place);
                            let handle = matches!(place.ty.base, Base::Handle(_));
                            if !handle {
                                self.write(place, None);
                            }
                        }
                    }
                }
                let entry = builtin.entry;
                let conditions = entry.params.iter().any(|param| matches!(param.mode, Mode::Condition | Mode::Action));
                let pure = entry.effect == Effect::Pure;
                self.facts.acts |= !pure;
                self.facts.changes |= !pure && !entry.looks;
                let context = (!pure && entry.effect != Effect::Ends) || conditions;
                self.facts.context |= context;
                self.facts.points |= context;
                self.facts.waits |= entry.effect.takes_time();
                self.facts.fails |= entry.fails || entry.effect == Effect::Ends;
            }
            ExprKind::Struct(_, values) => values.iter().flatten().for_each(|value| self.expr(value)),
            ExprKind::Array(values) => values.iter().for_each(|value| self.expr(value)),
        }
    }

    /// What an event does later: here it only captures the locals that it needs.
    fn later(&mut self, expr: &Expr) {
        let mut own = Collector { scope: self.scope, callees: false, facts: Facts::default() };
        own.expr(expr);
        self.facts.later_calls.extend(own.facts.calls.into_iter().chain(own.facts.later_calls));
        self.facts.reads.extend(captures::mentioned(expr));
    }

    fn call(&mut self, id: FuncId) {
        self.facts.calls.push(id);
        let effects = match self.scope.program.funcs.get(id.0 as usize) {
            Some(func) if self.callees => func.effects,
            _ => Effects::default(),
        };
        self.facts.waits |= effects.waits;
        self.facts.fails |= effects.fails;
        self.facts.context |= effects.context;
        self.facts.globals |= effects.globals;
        self.facts.world |= effects.globals || effects.context;
        self.facts.acts |= effects.globals || effects.context;
        self.facts.changes |= effects.changes;
    }

    fn read(&mut self, place: &Place) {
        self.path(place);
        self.root(place);
        match place.root {
            Root::Local(id) => {
                self.facts.reads.push(id);
                self.facts.world |= self.is_shared(id);
            }
            Root::Global(id) => {
                let folded = self.scope.program.globals.get(id.0 as usize).is_some_and(|global| global.value.is_some());
                self.facts.world |= !folded;
            }
            Root::System(_) => self.facts.world = true,
        }
    }

    fn is_shared(&self, id: LocalId) -> bool {
        self.scope.func.is_some_and(|func| func.locals.get(id.0 as usize).is_some_and(|local| local.shared))
    }

    fn write(&mut self, place: &Place, value: Option<&Expr>) {
        self.root(place);
        match place.root {
            Root::Local(id) => {
                self.facts.writes.push(id);
                self.facts.acts |= self.is_shared(id);
                self.facts.changes |= self.is_shared(id);
            }
            Root::Global(_) | Root::System(_) => (self.facts.acts, self.facts.changes) = (true, true),
        }
        self.facts.fails |= limit(place, value).is_some();
    }

    fn root(&mut self, place: &Place) {
        match place.root {
            Root::Local(_) => {}
            Root::Global(id) => {
                let folded = self.scope.program.globals.get(id.0 as usize).is_some_and(|global| global.value.is_some());
                self.facts.globals |= !folded;
            }
            Root::System(_) => self.facts.context = true,
        }
    }

    fn path(&mut self, place: &Place) {
        for step in &place.path {
            if let Projection::Index(indices, array) = step {
                self.indices(indices, *array);
            }
        }
    }

    fn indices(&mut self, indices: &[Expr], array: Type) {
        indices.iter().for_each(|index| self.expr(index));
        if self.scope.ranges.are_inside(indices, array) {
            return;
        }
        for index in indices {
            self.facts.fails |= constant(self.scope.program, self.scope.func, index).is_none();
        }
    }

    fn operator_fails(&self, op: BinaryOp, left: Type, right: &Expr) -> bool {
        let checked = match op {
            BinaryOp::Divide => left.base != Base::Double,
            BinaryOp::Remainder | BinaryOp::ShiftLeft | BinaryOp::ShiftRight => true,
            _ => false,
        };
        checked && constant(self.scope.program, self.scope.func, right).is_none_or(is_zero_divisor(op))
    }
}

/// A constant divisor that must still cause an alarm (the checker refuses it, so this case does not occur).
fn is_zero_divisor(op: BinaryOp) -> impl Fn(&Value) -> bool {
    move |value| {
        let divides = matches!(op, BinaryOp::Divide | BinaryOp::Remainder);
        divides && matches!(value, Value::Int(0) | Value::Uint(0) | Value::Byte(0))
    }
}

/// The value of an expression that is a constant, or a `const` variable with a known value.
pub(crate) fn constant<'a>(program: &'a Program, func: Option<&'a Func>, expr: &'a Expr) -> Option<&'a Value> {
    match &expr.kind {
        ExprKind::Const(value) => Some(value),
        ExprKind::Place(place) if place.path.is_empty() => match place.root {
            Root::Local(id) => func?.locals.get(id.0 as usize)?.value.as_ref(),
            Root::Global(id) => program.globals.get(id.0 as usize)?.value.as_ref(),
            Root::System(_) => None,
        },
        _ => None,
    }
}

/// The values that a system variable accepts, if writing this value to this place must be checked.
pub(crate) fn limit(place: &Place, value: Option<&Expr>) -> Option<Takes> {
    let Root::System(variable) = place.root else { return None };
    let known = match value.map(|value| &value.kind) {
        Some(ExprKind::Const(value)) => Some(value),
        _ => None,
    };
    let fits = match variable.takes {
        Takes::All => true,
        Takes::Range(low, high) if is_number(place.ty.base) => {
            let inside = |value: f64| value >= low && value <= high;
            match known {
                Some(Value::Int(value)) => inside(f64::from(*value)),
                Some(Value::Uint(value)) => inside(f64::from(*value)),
                Some(Value::Byte(value)) => inside(f64::from(*value)),
                Some(Value::Double(value)) => inside(*value),
                _ => false,
            }
        }
        Takes::Words(words) if place.ty.base == Base::String => {
            matches!(known, Some(Value::String(text)) if words.contains(&&**text))
        }
        Takes::Range(..) | Takes::Words(_) => true,
    };
    (!fits).then_some(variable.takes)
}

fn is_number(base: Base) -> bool {
    matches!(base, Base::Int | Base::Uint | Base::Byte | Base::Double)
}
