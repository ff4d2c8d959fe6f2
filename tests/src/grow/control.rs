//! Statements with statements inside, and jumps.

use super::Grower;
use super::constant::{int, literal};
use crate::tree::{Branch, Declared, Expr, Kind, Op, Stmt, StmtKind, Unary};
use crate::value::{Base, Type, Value};

impl Grower {
    /// A block with a scope of its own.
    pub(super) fn block(&mut self, depth: usize) -> Vec<Stmt> {
        self.scopes.push(Vec::new());
        let body = self.stmts(depth);
        self.scopes.pop();
        body
    }

    /// The statements of a block.
    pub(super) fn stmts(&mut self, depth: usize) -> Vec<Stmt> {
        let mut body = Vec::new();
        for _ in 0..1 + self.random.below(5) {
            if self.room == 0 {
                break;
            }
            self.room -= 1;
            self.stmt(depth, &mut body);
        }
        if depth < 4 && self.random.chance(8) {
            self.leave(&mut body);
        }
        body
    }

    fn stmt(&mut self, depth: usize, body: &mut Vec<Stmt>) {
        let deeper = depth < 4;
        match self.random.below(20) {
            0..=2 => body.push(self.declaration()),
            3 | 4 if deeper => self.branches(depth, body),
            5 => {
                let condition = self.like(Base::Bool, 2);
                let inner = self.compact();
                body.push(StmtKind::CompactIf(condition, Box::new(inner)).into());
            }
            6..=8 if deeper && self.loops < 2 => self.looped(depth, body),
            9 if deeper => self.switch(depth, body),
            10 | 11 if self.jumps => self.jump(body),
            _ => body.push(self.simple()),
        }
    }

    /// The statement behind a compact if.
    fn compact(&mut self) -> Stmt {
        match self.random.below(8) {
            0 if self.loops > 0 => StmtKind::Break.into(),
            1 if self.loops > 0 => StmtKind::Continue.into(),
            2 => self.returned(),
            3 if self.jumps => StmtKind::Goto(self.promise()).into(),
            _ => self.simple(),
        }
    }

    pub(super) fn returned(&mut self) -> Stmt {
        let value = (self.result != Base::Void).then(|| self.like(self.result, 2));
        StmtKind::Return(value).into()
    }

    /// The end of a block that goes elsewhere.
    fn leave(&mut self, body: &mut Vec<Stmt>) {
        let stmt = match self.random.below(4) {
            0 if self.loops > 0 => StmtKind::Break.into(),
            1 if self.loops > 0 => StmtKind::Continue.into(),
            2 if self.jumps => StmtKind::Goto(self.promise()).into(),
            _ if self.scopes.len() > 1 => self.returned(),
            _ => return,
        };
        body.push(stmt);
    }

    fn branches(&mut self, depth: usize, body: &mut Vec<Stmt>) {
        let mut branches = Vec::new();
        for _ in 0..1 + self.random.below(3) {
            let value = Some(self.like(Base::Bool, 2));
            branches.push(Branch { value, body: self.block(depth + 1), line: 0 });
        }
        if self.random.chance(50) {
            branches.push(Branch { value: None, body: self.block(depth + 1), line: 0 });
        }
        body.push(StmtKind::If(branches).into());
    }

    /// A counter that nothing else writes, declared in front of what counts with it.
    fn guard(&mut self, body: &mut Vec<Stmt>) -> Expr {
        let name = self.local_name();
        let local = self.declare(name, Type::one(Base::Int));
        self.guards.push(local);
        let first = self.random.chance(50).then(|| int(0));
        let declared = Declared { local, ty: Type::one(Base::Int), first, fixed: false };
        body.push(StmtKind::Declare(vec![declared]).into());
        self.local(local)
    }

    /// `guard++ < turns`
    fn turns_left(&mut self, guard: &Expr) -> Expr {
        let before = self.random.chance(30);
        let counted = Expr::one(Kind::Step { place: Box::new(guard.clone()), up: true, before }, Base::Int);
        let turns = int(1 + self.random.below(4) as i32);
        self.binary(Op::Less, counted, turns).expect("ints")
    }

    fn looped(&mut self, depth: usize, body: &mut Vec<Stmt>) {
        self.loops += 1;
        match self.random.below(6) {
            0 | 1 => self.for_loop(depth, body),
            2 => {
                let guard = self.guard(body);
                let mut condition = self.turns_left(&guard);
                if self.random.chance(40) {
                    let more = self.like(Base::Bool, 2);
                    condition = self.binary(Op::And, condition, more).expect("bools");
                }
                let inner = self.block(depth + 1);
                body.push(StmtKind::While(condition, inner).into());
            }
            3 => {
                let guard = self.guard(body);
                let left = self.turns_left(&guard);
                let mut condition = self.unary(Unary::Not, left).expect("a bool");
                if self.random.chance(40) {
                    let more = self.like(Base::Bool, 2);
                    condition = self.binary(Op::Or, more, condition).expect("bools");
                    let Kind::Binary { sides, .. } = &mut condition.kind else { return };
                    // The counter is looked at in every turn.
                    std::mem::swap(&mut sides.0, &mut sides.1);
                }
                let inner = self.block(depth + 1);
                body.push(StmtKind::Repeat(inner, condition, 0).into());
            }
            _ => {
                let guard = self.guard(body);
                let left = self.turns_left(&guard);
                let over = self.unary(Unary::Not, left).expect("a bool");
                self.scopes.push(Vec::new());
                let mut inner = vec![StmtKind::CompactIf(over, Box::new(StmtKind::Break.into())).into()];
                inner.extend(self.stmts(depth + 1));
                self.scopes.pop();
                body.push(StmtKind::Loop(inner).into());
            }
        }
        self.loops -= 1;
    }

    fn for_loop(&mut self, depth: usize, body: &mut Vec<Stmt>) {
        let base = [Base::Int, Base::Int, Base::Int, Base::Byte, Base::Uint, Base::Double][self.random.below(6)];
        self.scopes.push(Vec::new());
        let outer = self.random.chance(15);
        let place = if outer { self.place_to_count(base) } else { None };
        let turns = self.random.below(4) as i32;
        let down = base == Base::Int && self.random.chance(25);
        let (from, to) = if down { (turns, 0) } else { (0, turns) };
        let (first, variable): (Stmt, Expr) = match place {
            Some(variable) => {
                let kind = Kind::Assign { op: None, sides: Box::new((variable.clone(), int(from))) };
                (StmtKind::Expr(Expr::one(kind, base)).into(), variable)
            }
            None => {
                let name = self.local_name();
                let local = self.declare(name, Type::one(base));
                self.guards.push(local);
                let declared = Declared { local, ty: Type::one(base), first: Some(int(from)), fixed: false };
                (StmtKind::Declare(vec![declared]).into(), self.local(local))
            }
        };
        if let Kind::Var { var: crate::tree::Var::Local(local), .. } = variable.kind {
            self.guards.push(local);
        }
        let op = if down { Op::Greater } else { Op::Less };
        let mut condition = self.binary(op, variable.clone(), int(to)).expect("numbers");
        if self.random.chance(15) {
            let more = self.like(Base::Bool, 1);
            condition = self.binary(Op::And, condition, more).expect("bools");
        }
        let steps = matches!(base, Base::Int | Base::Uint | Base::Byte) && self.random.chance(60);
        let step = if steps {
            let before = self.random.chance(30);
            Expr::one(Kind::Step { place: Box::new(variable.clone()), up: !down, before }, base)
        } else {
            let op = if down { Op::Sub } else { Op::Add };
            Expr::one(Kind::Assign { op: Some((op, base)), sides: Box::new((variable.clone(), int(1))) }, base)
        };
        let body_of = self.block(depth + 1);
        self.guards.pop();
        self.scopes.pop();
        body.push(StmtKind::For { first: Box::new(first), condition, step, body: body_of }.into());
    }

    /// A local from outside that a `for` may count with.
    fn place_to_count(&mut self, base: Base) -> Option<Expr> {
        let visible = self.visible();
        let found = visible.into_iter().find(|(var, _)| {
            matches!(var, crate::tree::Var::Local(_))
                && self.may_write(*var)
                && self.variable(*var).ty == Type::one(base)
        });
        found.map(|(var, _)| self.var(var, false))
    }

    fn switch(&mut self, depth: usize, body: &mut Vec<Stmt>) {
        let base = [Base::Int, Base::Int, Base::Byte, Base::Uint, Base::Bool, Base::Str, Base::Enum(2), Base::Enum(1)]
            [self.random.below(8)];
        let mut value = self.expr(base, 2);
        if self.random.chance(60)
            && let Some(place) = self.place(Type::one(base), false, 1)
        {
            value = place;
        }
        // A constant is of whatever type it is written as.
        if value.constant.is_some() {
            return body.push(self.simple());
        }
        let mut cases: Vec<Branch> = Vec::new();
        let mut known: Vec<Value> = Vec::new();
        let default = self.random.chance(60).then(|| self.random.below(4));
        for at in 0..self.random.below(5) {
            if default == Some(at) {
                cases.push(Branch { value: None, body: self.block(depth + 1), line: 0 });
            }
            let constant = match base {
                Base::Uint | Base::Byte => self.small(4),
                Base::Int if self.random.chance(50) => self.small(4),
                base => self.constant(base, 1),
            };
            let found = crate::value::convert(constant.constant.clone().expect("a constant"), base);
            if !known.contains(&found) {
                known.push(found);
                cases.push(Branch { value: Some(constant), body: self.block(depth + 1), line: 0 });
            }
        }
        body.push(StmtKind::Switch(value, cases).into());
    }

    /// A label, or a jump.
    fn jump(&mut self, body: &mut Vec<Stmt>) {
        match self.random.below(3) {
            0 => {
                let label = match self.promised.is_empty() || self.random.chance(30) {
                    true => self.label(),
                    false => self.promised.swap_remove(self.random.below(self.promised.len())),
                };
                body.push(StmtKind::Label(label).into());
            }
            1 => {
                let condition = self.like(Base::Bool, 2);
                let goto = StmtKind::Goto(self.promise());
                body.push(StmtKind::CompactIf(condition, Box::new(goto.into())).into());
            }
            _ => {
                // Backwards, or wherever the label is: a counter of the whole function ends it.
                let placed: Vec<usize> =
                    (0..self.labels.len()).filter(|label| !self.promised.contains(label)).collect();
                if placed.is_empty() {
                    return body.push(self.simple());
                }
                let label = *self.random.pick(&placed);
                let guard = self.local(self.guards[0]);
                let counted = Expr::one(Kind::Step { place: Box::new(guard), up: true, before: false }, Base::Int);
                let condition = self.binary(Op::Less, counted, int(3)).expect("ints");
                body.push(StmtKind::CompactIf(condition, Box::new(StmtKind::Goto(label).into())).into());
            }
        }
    }

    fn label(&mut self) -> usize {
        let name = self.label_name();
        self.labels.push(name);
        self.labels.len() - 1
    }

    /// A label that stands further below.
    fn promise(&mut self) -> usize {
        if !self.promised.is_empty() && self.random.chance(60) {
            return *self.random.pick(&self.promised);
        }
        let label = self.label();
        self.promised.push(label);
        label
    }

    /// The labels that are still missing.
    pub(super) fn keep_promises(&mut self, body: &mut Vec<Stmt>) {
        for label in std::mem::take(&mut self.promised) {
            body.push(StmtKind::Label(label).into());
            if self.random.chance(60) {
                let text = self.labels[label].clone();
                let arg = literal(Value::Str(text.clone().into()), format!("\"{text}\""), Base::Str);
                body.push(StmtKind::Print(vec![crate::tree::Printed::Value(arg)]).into());
            }
        }
    }
}
