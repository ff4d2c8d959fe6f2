//! Expressions.

use super::Grower;
use super::constant::int;
use crate::builtins::{BUILTINS, Param};
use crate::operators::{self, converts, typed};
use crate::tree::{Expr, Kind, Op, Unary};
use crate::value::{Base, JOINT, STRUCTS, Type, Value, components, convert, positional};

const WHOLE: [Op; 10] =
    [Op::Add, Op::Sub, Op::Mul, Op::Div, Op::Rem, Op::Shl, Op::Shr, Op::BitAnd, Op::BitOr, Op::BitXor];
const REAL: [Op; 5] = [Op::Add, Op::Sub, Op::Mul, Op::Div, Op::Rem];
const TESTS: [Op; 6] = [Op::Less, Op::LessEqual, Op::Greater, Op::GreaterEqual, Op::Equal, Op::NotEqual];
const ASSIGNS: [Op; 10] = WHOLE;

impl Grower {
    /// An expression of exactly this type.
    pub(super) fn expr(&mut self, base: Base, depth: usize) -> Expr {
        for _ in 0..8 {
            if depth == 0 {
                break;
            }
            if let Some(found) = self.try_expr(base, depth).filter(|found| found.ty == Type::one(base)) {
                return self.perhaps_parentheses(found);
            }
        }
        self.leaf(base)
    }

    /// An expression that converts to this type.
    pub(super) fn like(&mut self, base: Base, depth: usize) -> Expr {
        for _ in 0..4 {
            let found = match self.random.below(10) {
                0 => self.fitting(base),
                1 => {
                    let sources: &[Base] = match base {
                        Base::Int => &[Base::Byte, Base::Enum(2)],
                        Base::Uint => &[Base::Byte],
                        Base::Double => &[Base::Int, Base::Byte, Base::Uint],
                        Base::Bool => &[Base::Int, Base::Byte, Base::Uint, Base::Double],
                        _ => &[base],
                    };
                    let source = *self.random.pick(sources);
                    Some(self.expr(source, depth))
                }
                _ => break,
            };
            let sign = |found: &Expr| base == Base::Double && found.pattern;
            if let Some(found) = found.filter(|found| converts(found, base) && !sign(found)) {
                return found;
            }
        }
        self.expr(base, depth)
    }

    /// A value of any type, arrays included, as a variable would be given it.
    pub(super) fn of_type(&mut self, ty: Type, depth: usize) -> Expr {
        if !ty.is_array() {
            return match ty.base {
                Base::Struct(_) if self.random.chance(40) => self.braces(ty, depth),
                base => self.like(base, depth),
            };
        }
        match self.place(ty, false, 0) {
            Some(place) if self.random.chance(60) => place,
            _ => self.braces(ty, depth),
        }
    }

    /// Braces for a structure or an array.
    pub(super) fn braces(&mut self, ty: Type, depth: usize) -> Expr {
        let depth = depth.saturating_sub(1);
        if !ty.is_array() {
            let Base::Struct(number) = ty.base else { panic!("only structures and arrays have braces") };
            if self.random.chance(50) {
                let count = self.random.below(positional(number) + 1).max(1);
                let parts = (0..count).map(|at| self.of_type(Type::one(components(number)[at].1), depth)).collect();
                return Expr::new(Kind::List(parts), ty);
            }
            let mut parts: Vec<(usize, Expr)> = Vec::new();
            for _ in 0..self.random.below(4) + 1 {
                let at = self.random.below(components(number).len());
                if parts.iter().all(|(other, _)| *other != at) {
                    parts.push((at, self.of_type(Type::one(components(number)[at].1), depth)));
                }
            }
            return Expr::new(Kind::Named(parts), ty);
        }
        let [rows, columns] = ty.sizes;
        let element = Type::one(ty.base);
        if columns > 0 && self.random.chance(60) {
            let row = Type { base: ty.base, sizes: [columns, 0] };
            let count = self.random.below(rows) + 1;
            let rows = (0..count).map(|_| self.braces(row, depth)).collect();
            return Expr::new(Kind::List(rows), ty);
        }
        let count = self.random.below(ty.elements()) + 1;
        let parts = (0..count).map(|_| self.of_type(element, depth)).collect();
        Expr::new(Kind::List(parts), ty)
    }

    fn leaf(&mut self, base: Base) -> Expr {
        if self.random.chance(30)
            && let Some(literal) = self.literal(base)
        {
            return literal;
        }
        if let Some(place) = self.place(Type::one(base), false, 1) {
            return place;
        }
        self.literal(base).expect("a variable of every type, or literals")
    }

    fn try_expr(&mut self, base: Base, depth: usize) -> Option<Expr> {
        let inner = depth - 1;
        if self.random.chance(self.effects) {
            return match self.random.below(3) {
                0 => self.step(base, inner),
                1 => self.assignment(base, inner),
                _ => self.call(base, inner),
            };
        }
        match self.random.below(10) {
            0 => return self.place(Type::one(base), false, inner),
            1 => return self.builtin(base, inner),
            2 => return Some(self.leaf(base)),
            _ => {}
        }
        match base {
            Base::Int if self.random.chance(15) => {
                let op = if self.random.chance(60) { Unary::Negate } else { Unary::Complement };
                let of = if self.random.chance(20) { Base::Byte } else { Base::Int };
                let operand = self.expr(of, inner);
                self.unary(op, operand)
            }
            Base::Uint | Base::Byte if self.random.chance(10) => {
                let operand = self.expr(base, inner);
                self.unary(Unary::Complement, operand)
            }
            Base::Double if self.random.chance(10) => {
                let operand = self.expr(base, inner);
                self.unary(Unary::Negate, operand)
            }
            Base::Int | Base::Uint | Base::Byte => {
                let op = *self.random.pick(&WHOLE);
                self.arithmetic(op, base, inner)
            }
            Base::Double => {
                let op = *self.random.pick(&REAL);
                self.arithmetic(op, base, inner)
            }
            Base::Bool => self.test(inner),
            Base::Str => {
                let (left, right) = (self.expr(base, inner), self.expr(base, inner));
                self.binary(Op::Add, left, right)
            }
            Base::Struct(JOINT) => {
                if self.random.chance(20) {
                    let operand = self.expr(base, inner);
                    return self.unary(Unary::Negate, operand);
                }
                let op = if self.random.chance(50) { Op::Add } else { Op::Sub };
                let (left, right) = (self.expr(base, inner), self.expr(base, inner));
                self.binary(op, left, right)
            }
            _ => Some(self.leaf(base)),
        }
    }

    /// The operator applied, where it can be; computed where both sides are constant.
    pub(super) fn binary(&mut self, op: Op, left: Expr, right: Expr) -> Option<Expr> {
        // A literal that is too large for int stands only where a uint is wanted.
        let lost = |wide: &Expr, other: &Expr| {
            let literal = matches!(wide.kind, Kind::Literal(Value::Uint(_), _));
            literal && (other.ty != Type::one(Base::Uint) || other.constant.is_some())
        };
        if lost(&left, &right) || lost(&right, &left) {
            return None;
        }
        let (result, common) = typed(op, &left, &right)?;
        let value = match (&left.constant, &right.constant) {
            (Some(a), Some(b)) => {
                let a = convert(a.clone(), common);
                let b = if matches!(op, Op::Shl | Op::Shr) { b.clone() } else { convert(b.clone(), common) };
                match (op, &a, &b) {
                    (Op::And, Value::Bool(a), Value::Bool(b)) => Some(Value::Bool(*a && *b)),
                    (Op::Or, Value::Bool(a), Value::Bool(b)) => Some(Value::Bool(*a || *b)),
                    _ => Some(operators::binary(op, a, b).ok()?),
                }
            }
            _ => None,
        };
        let kind = Kind::Binary { op, sides: Box::new((left, right)), common };
        Some(Expr { kind, ty: Type::one(result), constant: value, pattern: false })
    }

    fn arithmetic(&mut self, op: Op, base: Base, depth: usize) -> Option<Expr> {
        if matches!(op, Op::Shl | Op::Shr) {
            let left = self.expr(base, depth);
            let count = self.count(if base == Base::Byte { 8 } else { 32 }, depth);
            return self.binary(op, left, count);
        }
        let (mut left, mut right) = (self.like(base, depth), self.like(base, depth));
        if self.random.chance(50) {
            std::mem::swap(&mut left, &mut right);
        }
        if matches!(op, Op::Div | Op::Rem) {
            right = self.divisor(right)?;
        }
        self.binary(op, left, right)
    }

    /// A divisor that is not zero, as a rule.
    fn divisor(&mut self, divisor: Expr) -> Option<Expr> {
        if divisor.constant.is_some() || self.random.chance(self.risk) {
            return Some(divisor);
        }
        match divisor.ty.base {
            Base::Double if self.random.chance(70) => {
                let square = self.binary(
                    Op::Mul,
                    divisor,
                    super::constant::literal(Value::Double(0.5), "0.5".into(), Base::Double),
                )?;
                let abs = BUILTINS.iter().position(|b| b.name == "abs" && b.result == Base::Double)?;
                let abs = Expr::one(Kind::Builtin(abs, vec![square]), Base::Double);
                self.binary(Op::Add, abs, int(1))
            }
            Base::Double => Some(divisor),
            _ => self.binary(Op::BitOr, divisor, int(1)),
        }
    }

    /// A shift count.
    fn count(&mut self, width: usize, depth: usize) -> Expr {
        if self.random.chance(50) {
            return self.small(width);
        }
        let base = if self.random.chance(20) { Base::Uint } else { Base::Int };
        let count = self.like(base, depth);
        if matches!(count.ty.base, Base::Enum(_)) {
            return self.small(width);
        }
        if self.random.chance(self.risk) && count.constant.is_none() {
            return count;
        }
        self.binary(Op::BitAnd, count, int(width as i32 - 1)).unwrap_or_else(|| int(1))
    }

    fn test(&mut self, depth: usize) -> Option<Expr> {
        match self.random.below(10) {
            0 => {
                let operand = self.like(Base::Bool, depth);
                self.unary(Unary::Not, operand)
            }
            1..=3 => {
                let op = if self.random.chance(50) { Op::And } else { Op::Or };
                let (left, right) = (self.like(Base::Bool, depth), self.like(Base::Bool, depth));
                self.binary(op, left, right)
            }
            4 => {
                let op = if self.random.chance(50) { Op::Equal } else { Op::NotEqual };
                let other = [Base::Bool, Base::Int, Base::Byte][self.random.below(3)];
                let (mut left, mut right) = (self.expr(Base::Bool, depth), self.expr(other, depth));
                if self.random.chance(50) {
                    std::mem::swap(&mut left, &mut right);
                }
                self.binary(op, left, right)
            }
            5 => {
                let op = *self.random.pick(&TESTS);
                let (left, right) = (self.expr(Base::Str, depth), self.expr(Base::Str, depth));
                self.binary(op, left, right)
            }
            6 => {
                let op = *self.random.pick(&TESTS);
                let number = self.random.below(crate::value::ENUMS.len());
                let (left, right) = (self.expr(Base::Enum(number), depth), self.expr(Base::Enum(number), depth));
                self.binary(op, left, right)
            }
            _ => {
                let op = *self.random.pick(&TESTS);
                let base = [Base::Int, Base::Uint, Base::Byte, Base::Double][self.random.below(4)];
                let (left, right) = (self.like(base, depth), self.like(base, depth));
                self.binary(op, left, right)
            }
        }
    }

    fn step(&mut self, base: Base, depth: usize) -> Option<Expr> {
        if !matches!(base, Base::Int | Base::Uint | Base::Byte) {
            return None;
        }
        let place = Box::new(self.place(Type::one(base), true, depth)?);
        let (up, before) = (self.random.chance(50), self.random.chance(50));
        Some(Expr::one(Kind::Step { place, up, before }, base))
    }

    /// An assignment whose value has this type.
    pub(super) fn assignment(&mut self, base: Base, depth: usize) -> Option<Expr> {
        let place = self.place(Type::one(base), true, depth)?;
        let compound = self.random.chance(50);
        if compound {
            let op = match base {
                Base::Str | Base::Struct(JOINT) => Op::Add,
                Base::Double => *self.random.pick(&REAL),
                Base::Int | Base::Uint | Base::Byte => *self.random.pick(&ASSIGNS),
                _ => return None,
            };
            let value = match op {
                Op::Shl | Op::Shr => self.count(if base == Base::Byte { 8 } else { 32 }, depth),
                _ => self.like(base, depth),
            };
            let value = if matches!(op, Op::Div | Op::Rem) { self.divisor(value)? } else { value };
            let (result, common) = typed(op, &place, &value)?;
            if result != base {
                return None;
            }
            let kind = Kind::Assign { op: Some((op, common)), sides: Box::new((place, value)) };
            return Some(Expr::one(kind, base));
        }
        let value = self.of_type(Type::one(base), depth);
        Some(Expr::one(Kind::Assign { op: None, sides: Box::new((place, value)) }, base))
    }

    /// A call of a function of the program.
    pub(super) fn call(&mut self, base: Base, depth: usize) -> Option<Expr> {
        let good: Vec<usize> =
            (0..self.program.funcs.len()).filter(|func| self.program.funcs[*func].result == base).collect();
        if good.is_empty() {
            return None;
        }
        let func = *self.random.pick(&good);
        Some(self.call_of(func, depth))
    }

    pub(super) fn call_of(&mut self, func: usize, depth: usize) -> Expr {
        let called = &self.program.funcs[func];
        let result = called.result;
        let counted = called.counted;
        let params: Vec<Type> = called.locals[..called.params].iter().map(|param| param.ty).collect();
        let mut args = Vec::new();
        for (at, ty) in params.into_iter().enumerate() {
            args.push(match at {
                0 if counted => self.small(4),
                _ if ty.is_array() => {
                    self.place(ty, false, 0).expect("arrays are params only where there is a global one")
                }
                _ => self.like(ty.base, depth),
            });
        }
        Expr::one(Kind::Call(func, args), result)
    }

    /// A call of something built in.
    pub(super) fn builtin(&mut self, base: Base, depth: usize) -> Option<Expr> {
        let good: Vec<usize> = (0..BUILTINS.len()).filter(|at| BUILTINS[*at].result == base).collect();
        if good.is_empty() {
            return None;
        }
        let number = *self.random.pick(&good);
        let builtin = &BUILTINS[number];
        let mut args = Vec::new();
        for (at, param) in builtin.params.iter().enumerate() {
            args.push(match *param {
                Param::Exactly(base) => self.expr(base, depth),
                Param::Like(base) => self.like(base, depth),
                Param::Out(base) => {
                    if !self.random.chance(self.effects) && builtin.result != Base::Void {
                        return None;
                    }
                    self.place(Type::one(base), true, depth)?
                }
                Param::Any => self.any_printable(depth),
                Param::Near(from, to) => {
                    if self.random.chance(self.risk) {
                        self.expr(Base::Int, depth)
                    } else {
                        let number = from + self.random.below((to - from + 1) as usize) as i32;
                        if number < 0 { self.unary(Unary::Negate, int(-number))? } else { int(number) }
                    }
                }
                Param::Word(_) => int(0),
            });
            // Overloads tell constants apart by type, and a constant that fits has several.
            if at == 0 && builtin.params.len() > 1 && args[0].constant.is_some() && builtin.name.starts_with("bit") {
                return None;
            }
        }
        // Arguments that are out of range, unless that is wanted.
        if self.risk == 0
            && matches!(builtin.name, "sqrt" | "log" | "log10" | "asin" | "toascii" | "substr" | "toint" | "modf")
        {
            self.tame(builtin.name, &mut args)?;
        }
        Some(Expr::one(Kind::Builtin(number, args), builtin.result))
    }

    /// Brings arguments into the range that a function takes.
    fn tame(&mut self, name: &str, args: &mut [Expr]) -> Option<()> {
        let named = |name: &str, result: Base| BUILTINS.iter().position(|b| b.name == name && b.result == result);
        let first = args.first()?.clone();
        let wrapped = match name {
            "sqrt" => Expr::one(Kind::Builtin(named("atan", Base::Double)?, vec![first]), Base::Double),
            "asin" | "toint" | "modf" => {
                Expr::one(Kind::Builtin(named("tanh", Base::Double)?, vec![first]), Base::Double)
            }
            "log" | "log10" => {
                let bounded = Expr::one(Kind::Builtin(named("atan", Base::Double)?, vec![first]), Base::Double);
                self.binary(Op::Add, bounded, int(2))?
            }
            "substr" | "toascii" => {
                let tail = super::constant::literal(Value::Str("tail".into()), "\"tail\"".into(), Base::Str);
                self.binary(Op::Add, first, tail)?
            }
            _ => return None,
        };
        args[0] = match name {
            "sqrt" => {
                let kind =
                    Kind::Binary { op: Op::Mul, sides: Box::new((wrapped.clone(), wrapped)), common: Base::Double };
                Expr::one(kind, Base::Double)
            }
            "toint" => self.binary(Op::Mul, wrapped, int(1000))?,
            "toascii" => {
                let substr = BUILTINS.iter().position(|b| b.name == "substr" && b.params.len() == 3)?;
                Expr::one(Kind::Builtin(substr, vec![wrapped, self.small(4), int(1)]), Base::Str)
            }
            _ => wrapped,
        };
        Some(())
    }

    /// Something that can be printed: anything but words of print itself.
    pub(super) fn any_printable(&mut self, depth: usize) -> Expr {
        if self.random.chance(8) {
            let arrays: Vec<_> =
                self.visible().into_iter().filter(|(var, _)| self.variable(*var).ty.is_array()).collect();
            if !arrays.is_empty() {
                let (var, hidden) = *self.random.pick(&arrays);
                return self.var(var, hidden);
            }
        }
        let base = match self.random.below(12) {
            0 => Base::Struct(self.random.below(STRUCTS.len())),
            _ => self.any_base(),
        };
        match base {
            // There may not be a variable of it.
            Base::Struct(_) => match self.place(Type::one(base), false, depth.min(1)) {
                Some(_) => self.expr(base, depth),
                None => self.expr(Base::Int, depth),
            },
            base => self.expr(base, depth),
        }
    }
}
