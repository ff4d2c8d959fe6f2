//! Conditions as jumps.

use super::body::FunctionCode;
use super::operators::{comparison, small};
use super::variables::is_number;
use crate::hir::{Expr, ExprKind, Value};
use arl_code::{Address, Op, Reg};
use arl_lang::ast::{BinaryOp, UnaryOp};
use arl_lang::catalog::Base;

impl<'p> FunctionCode<'p, '_> {
    /// Jumps that are taken if the condition is `wanted`; where they lead is yet to be said.
    pub(super) fn jump_if(&mut self, condition: &'p Expr, wanted: bool) -> Vec<Address> {
        self.passing(|body| body.jumps(condition, wanted))
    }

    fn jumps(&mut self, condition: &'p Expr, wanted: bool) -> Vec<Address> {
        if let Some(Value::Bool(value)) = self.constant(condition) {
            return if *value == wanted { vec![self.op(Op::Jump { to: 0 })] } else { Vec::new() };
        }
        match &condition.kind {
            ExprKind::Unary(UnaryOp::Not, inner) => self.jump_if(inner, !wanted),
            ExprKind::Binary(op @ (BinaryOp::And | BinaryOp::Or), sides) => {
                if (*op == BinaryOp::And) == wanted {
                    // Both decide together: the right one is looked at only after the left one.
                    let past = self.jump_if(&sides.0, !wanted);
                    let jumps = self.jump_if(&sides.1, wanted);
                    self.lead_here(past);
                    return jumps;
                }
                let mut jumps = self.jump_if(&sides.0, wanted);
                jumps.extend(self.jump_if(&sides.1, wanted));
                jumps
            }
            ExprKind::Binary(op, sides) if is_number(sides.0.ty) => {
                self.jump_compared(*op, &sides.0, &sides.1, condition, wanted)
            }
            _ => self.jump_by_value(condition, wanted),
        }
    }

    fn jump_by_value(&mut self, condition: &'p Expr, wanted: bool) -> Vec<Address> {
        let from = self.number(condition, None);
        vec![self.op(if wanted { Op::JumpIf { from, to: 0 } } else { Op::JumpUnless { from, to: 0 } })]
    }

    fn jump_compared(
        &mut self,
        op: BinaryOp,
        left: &'p Expr,
        right: &'p Expr,
        whole: &'p Expr,
        wanted: bool,
    ) -> Vec<Address> {
        let base = left.ty.base;
        let Some(compared) = comparison(op, base) else { return self.jump_by_value(whole, wanted) };
        if let (Base::Int, Some(value)) = (base, small(self.constant(right))) {
            let (op, value) = match op {
                BinaryOp::LessEqual if value < i32::MAX => (BinaryOp::Less, value + 1),
                BinaryOp::Greater if value < i32::MAX => (BinaryOp::GreaterEqual, value + 1),
                op => (op, value),
            };
            let left_register = |body: &mut Self| body.number(left, None);
            let jump: Option<fn(Reg, i32) -> Op> = match (op, wanted) {
                (BinaryOp::Less, true) | (BinaryOp::GreaterEqual, false) => {
                    Some(|left, value| Op::JumpLessSmall { left, value, to: 0 })
                }
                (BinaryOp::GreaterEqual, true) | (BinaryOp::Less, false) => {
                    Some(|left, value| Op::JumpNotLessSmall { left, value, to: 0 })
                }
                (BinaryOp::Equal, true) | (BinaryOp::NotEqual, false) => {
                    Some(|left, value| Op::JumpEqualSmall { left, value, to: 0 })
                }
                (BinaryOp::NotEqual, true) | (BinaryOp::Equal, false) => {
                    Some(|left, value| Op::JumpNotEqualSmall { left, value, to: 0 })
                }
                _ => None,
            };
            if let Some(jump) = jump {
                let left = left_register(self);
                return vec![self.op(jump(left, value))];
            }
        }
        let (left, right) = self.operands(left, right);
        if base != Base::Int {
            let (left, right) = if compared.swapped { (right, left) } else { (left, right) };
            let wanted = wanted != compared.negated;
            return vec![self.op(Op::JumpCompare { left, right, by: compared.by, wanted, to: 0 })];
        }
        let to = 0;
        vec![self.op(match (op, wanted) {
            (BinaryOp::Less, true) | (BinaryOp::GreaterEqual, false) => Op::JumpLess { left, right, to },
            (BinaryOp::LessEqual, true) | (BinaryOp::Greater, false) => Op::JumpLessEqual { left, right, to },
            (BinaryOp::Greater, true) | (BinaryOp::LessEqual, false) => Op::JumpLess { left: right, right: left, to },
            (BinaryOp::GreaterEqual, true) | (BinaryOp::Less, false) => {
                Op::JumpLessEqual { left: right, right: left, to }
            }
            (BinaryOp::Equal, true) | (BinaryOp::NotEqual, false) => Op::JumpEqual { left, right, to },
            _ => Op::JumpNotEqual { left, right, to },
        })]
    }

    /// A condition as a bool. The register is written last: the condition may read the variable that it is.
    pub(super) fn truth(&mut self, condition: &'p Expr, wanted: Option<Reg>) -> Reg {
        let to = self.register_or(wanted);
        let unmet = self.jump_if(condition, false);
        self.op(Op::Small { to, value: 1 });
        let over = self.op(Op::Jump { to: 0 });
        self.lead_here(unmet);
        self.op(Op::Small { to, value: 0 });
        self.lead_here([over]);
        to
    }
}
