//! Literals and constant expressions.

use super::Grower;
use crate::operators::fits;
use crate::tree::{Expr, Kind, Var};
use crate::value::{Base, ENUMS, Type, Value};

const STRINGS: &[&str] = &[
    "",
    "a",
    "b",
    "abc",
    "A",
    "x y",
    "say \"hi\"",
    "back\\slash",
    "tab\there",
    "gr\u{fc}n",
    "\u{65e5}\u{672c}",
    "0",
    "{}",
    "//no",
    "/*",
    "abd",
    "%d",
    "{0}",
    "r\rn",
    "7",
    "longer than sixteen bytes of text",
    "'",
];

const DOUBLES: &[&str] = &[
    "0.0",
    "1.0",
    "0.5",
    "2.5",
    "3.25",
    "0.1",
    "1e3",
    "1.5e-3",
    "100.0",
    "123456.789",
    "1e10",
    "9e+09",
    "0.333333",
    ".5",
    "7.",
    "1e300",
    "1e-300",
    "2147483648.0",
    "0.15E2",
    "3.141592653589793",
];

const INTS: &[u32] =
    &[0, 0, 1, 1, 2, 3, 5, 7, 8, 10, 31, 32, 100, 127, 128, 255, 256, 1000, 65535, 65536, 0x7fff_fffe, 0x7fff_ffff];

impl Grower {
    /// A literal of exactly the type, where it has some.
    pub(super) fn literal(&mut self, base: Base) -> Option<Expr> {
        Some(match base {
            Base::Int => return Some(self.int_literal()),
            Base::Double => {
                let text = *self.random.pick(DOUBLES);
                literal(Value::Double(text.parse().unwrap()), text.to_owned(), base)
            }
            Base::Bool => {
                let value = self.random.chance(50);
                literal(Value::Bool(value), value.to_string(), base)
            }
            Base::Str => self.string_literal(),
            Base::Enum(number) => {
                let (_, constants) = ENUMS[number];
                let at = self.random.below(constants.len());
                let qualified = self.is_variable(constants[at]) || self.random.chance(30);
                let kind = Kind::Constant { number, at, qualified };
                Expr { kind, ty: Type::one(base), constant: Some(Value::Enum(number, at)), pattern: false }
            }
            _ => return None,
        })
    }

    fn int_literal(&mut self) -> Expr {
        let value = match self.random.below(4) {
            0 => self.random.below(10) as u32,
            1 => self.random.below(300) as u32,
            _ => *self.random.pick(INTS),
        };
        match self.random.below(12) {
            0 => {
                let value = if self.random.chance(25) { self.random.next() as u32 } else { value };
                let text = if self.random.chance(50) { format!("0{value:x}h") } else { format!("0{value:X}H") };
                Expr { pattern: true, ..literal(Value::Int(value as i32), text, Base::Int) }
            }
            1 => Expr { pattern: true, ..literal(Value::Int(value as i32), format!("{value:b}b"), Base::Int) },
            2 if self.random.chance(30) => literal(Value::Int(i32::MIN), "-2147483648".into(), Base::Int),
            _ => literal(Value::Int(value as i32), value.to_string(), Base::Int),
        }
    }

    fn string_literal(&mut self) -> Expr {
        let text = *self.random.pick(STRINGS);
        let mut written = String::from("\"");
        for c in text.chars() {
            match c {
                '"' => written += "\\\"",
                '\\' => written += "\\\\",
                '\t' => written += "\\t",
                '\r' => written += "\\r",
                c => written.push(c),
            }
        }
        literal(Value::Str(text.into()), written + "\"", Base::Str)
    }

    /// A small int.
    pub(super) fn small(&mut self, end: usize) -> Expr {
        int(self.random.below(end) as i32)
    }

    /// A constant that fits the type: for uint and byte a literal of int, or of uint where it is too large for int.
    pub(super) fn fitting(&mut self, base: Base) -> Option<Expr> {
        let constants: Vec<(Var, bool)> =
            self.visible().into_iter().filter(|(var, _)| self.variable(*var).value.is_some()).collect();
        for _ in 0..4 {
            let found = match self.random.below(4) {
                0 if !constants.is_empty() => {
                    let (var, hidden) = *self.random.pick(&constants);
                    self.var(var, hidden)
                }
                1 if base == Base::Uint => {
                    let value = 0x8000_0000 | self.random.next() as u32;
                    literal(Value::Uint(value), value.to_string(), Base::Uint)
                }
                2 => self.constant(Base::Int, 2),
                _ => self.int_literal(),
            };
            let sign = base == Base::Double && found.pattern;
            if !found.ty.is_array() && fits(&found, base) && !sign {
                return Some(found);
            }
        }
        None
    }

    /// A constant expression of exactly this type.
    pub(super) fn constant(&mut self, base: Base, depth: usize) -> Expr {
        use crate::tree::{Op, Unary};
        const OPS: [Op; 10] =
            [Op::Add, Op::Sub, Op::Mul, Op::Div, Op::Rem, Op::Shl, Op::Shr, Op::BitAnd, Op::BitOr, Op::BitXor];
        for _ in 0..6 {
            if depth == 0 {
                break;
            }
            let found = match base {
                Base::Int if self.random.chance(20) => {
                    let op = if self.random.chance(50) { Unary::Negate } else { Unary::Complement };
                    let inner = self.constant(base, depth - 1);
                    self.unary(op, inner)
                }
                Base::Int | Base::Double | Base::Str => {
                    let op = if base == Base::Str { Op::Add } else { *self.random.pick(&OPS) };
                    let (left, right) = (self.constant(base, depth - 1), self.constant(base, depth - 1));
                    self.binary(op, left, right)
                }
                Base::Bool => {
                    let op = [Op::Less, Op::Equal, Op::NotEqual, Op::GreaterEqual][self.random.below(4)];
                    let of = [Base::Int, Base::Double, Base::Str][self.random.below(3)];
                    let (left, right) = (self.constant(of, depth - 1), self.constant(of, depth - 1));
                    self.binary(op, left, right)
                }
                _ => None,
            };
            if let Some(found) = found.filter(|found| found.ty == Type::one(base) && found.constant.is_some()) {
                return found;
            }
        }
        self.literal(base).expect("a type with literals")
    }
}

/// A literal.
pub(super) fn literal(value: Value, text: String, base: Base) -> Expr {
    Expr { kind: Kind::Literal(value.clone(), text), ty: Type::one(base), constant: Some(value), pattern: false }
}

/// An int that is not negative.
pub(super) fn int(value: i32) -> Expr {
    literal(Value::Int(value), value.to_string(), Base::Int)
}
