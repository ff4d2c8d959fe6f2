//! Statements without statements inside.

use super::Grower;
use super::constant::int;
use crate::tree::{Declared, Expr, Kind, Printed, Stmt, StmtKind};
use crate::value::{Base, Type, convert};

impl Grower {
    /// A simple statement that may stand anywhere, behind a compact if, too.
    pub(super) fn simple(&mut self) -> Stmt {
        let depth = 1 + self.random.below(3);
        let kind = match self.random.below(12) {
            0..=3 => StmtKind::Print(self.print_args()),
            4 => self.call_stmt(depth),
            5 if self.waits => self.wait(),
            6 => match self.builtin(Base::Void, depth) {
                Some(call) => StmtKind::Expr(call),
                None => StmtKind::Print(self.print_args()),
            },
            _ => match self.assign_stmt(depth) {
                Some(expr) => StmtKind::Expr(expr),
                None => StmtKind::Print(self.print_args()),
            },
        };
        kind.into()
    }

    fn wait(&mut self) -> StmtKind {
        match self.random.below(5) {
            0 => StmtKind::Wait(super::constant::literal(
                crate::value::Value::Double(0.002),
                "0.002".into(),
                Base::Double,
            )),
            1 => {
                let truth = super::constant::literal(crate::value::Value::Bool(true), "true".into(), Base::Bool);
                // What a condition calls must not wait.
                let either = self.expr(Base::Bool, 1);
                let either = if either.calls() { truth.clone() } else { either };
                let condition = self.binary(crate::tree::Op::Or, either, truth).expect("bools");
                StmtKind::WaitUntil(condition)
            }
            _ => StmtKind::Wait(int(0)),
        }
    }

    /// `x = ..`, `x += ..`, `x++` as a statement, of any type.
    pub(super) fn assign_stmt(&mut self, depth: usize) -> Option<Expr> {
        if self.random.chance(15) {
            let base = [Base::Int, Base::Uint, Base::Byte][self.random.below(3)];
            let place = Box::new(self.place(Type::one(base), true, depth)?);
            let (up, before) = (self.random.chance(50), self.random.chance(30));
            return Some(Expr::one(Kind::Step { place, up, before }, base));
        }
        if self.random.chance(12) {
            let arrays: Vec<_> = self.visible().into_iter().filter(|(var, _)| self.may_write(*var)).collect();
            let arrays: Vec<_> = arrays.into_iter().filter(|(var, _)| self.variable(*var).ty.is_array()).collect();
            if !arrays.is_empty() {
                let (var, hidden) = *self.random.pick(&arrays);
                let place = self.var(var, hidden);
                let ty = place.ty;
                let value = self.of_type(ty, depth);
                return Some(Expr::new(Kind::Assign { op: None, sides: Box::new((place, value)) }, ty));
            }
        }
        let base = self.any_base();
        self.assignment(base, depth)
    }

    /// A call as a statement.
    fn call_stmt(&mut self, depth: usize) -> StmtKind {
        if self.program.funcs.is_empty() {
            return StmtKind::Print(self.print_args());
        }
        let func = self.random.below(self.program.funcs.len());
        StmtKind::Expr(self.call_of(func, depth))
    }

    pub(super) fn print_args(&mut self) -> Vec<Printed> {
        let mut args = Vec::new();
        for _ in 0..1 + self.random.below(3) {
            let arg = match self.random.below(30) {
                0 => Printed::Hex,
                1 => Printed::Dec,
                2 => Printed::Endl,
                3 => Printed::Precision(int(1 + self.random.below(15) as i32)),
                _ => {
                    let depth = self.random.below(4);
                    Printed::Value(self.any_printable(depth))
                }
            };
            args.push(arg);
            if self.random.chance(40) {
                let blank =
                    super::constant::literal(crate::value::Value::Str(b" ".to_vec()), "\" \"".into(), Base::Str);
                args.push(Printed::Value(blank));
            }
        }
        if !args.iter().any(|arg| matches!(arg, Printed::Value(_))) {
            args.push(Printed::Value(self.any_printable(1)));
        }
        args
    }

    /// A declaration of one or more variables of a type.
    pub(super) fn declaration(&mut self) -> Stmt {
        let base = self.any_base();
        let constant = self.random.chance(10);
        let mut variables = Vec::new();
        for _ in 0..if self.random.chance(15) { 2 } else { 1 } {
            let ty = if self.random.chance(12) { Type { base, ..self.any_type() } } else { Type::one(base) };
            let name = self.local_name();
            let visible = self.visible();
            let hides = visible.iter().any(|(var, _)| self.variable(*var).name.eq_ignore_ascii_case(&name));
            let first = (constant || self.random.chance(75)).then(|| self.first(ty, hides));
            let first = first.flatten().or_else(|| constant.then(|| self.fixed_braces(ty)));
            let local = self.declare(name, ty);
            let value = first.as_ref().filter(|_| constant).and_then(|first| first.constant.clone());
            let variable = &mut self.locals[local];
            variable.constant = constant;
            variable.value = value.map(|value| convert(value, base)).filter(|_| !ty.is_array());
            let fixed = variable.value.is_some();
            variables.push(Declared { local, ty, first, fixed });
        }
        StmtKind::Declare(variables).into()
    }

    /// A first value; only a constant one where the name hides another, which it could mean.
    fn first(&mut self, ty: Type, hides: bool) -> Option<Expr> {
        match hides {
            true if ty.is_array() => None,
            true => match ty.base {
                Base::Uint | Base::Byte => {
                    self.fitting(ty.base).filter(|first| matches!(first.kind, Kind::Literal(..)))
                }
                base => self.literal(base),
            },
            false => {
                let depth = 1 + self.random.below(3);
                Some(self.of_type(ty, depth))
            }
        }
    }

    /// A value for a const that must not name anything.
    fn fixed_braces(&mut self, ty: Type) -> Expr {
        if !ty.is_array() {
            match ty.base {
                Base::Struct(_) => {}
                Base::Uint | Base::Byte => return self.small(200),
                base => return self.literal(base).expect("a type with literals"),
            }
        }
        Expr::new(Kind::List(vec![]), ty)
    }
}
