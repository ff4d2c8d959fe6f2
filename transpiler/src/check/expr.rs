//! Expressions.

use super::context::{CheckedBody, Checker};
use super::convert::Typed;
use super::name::constant;
use super::place::PlaceOrValue;
use crate::diagnostics::constants::ConstantProblem;
use crate::diagnostics::system::NotTaken;
use crate::diagnostics::types::TypeProblem;
use crate::effects::facts::limit;
use crate::hir::{Expr, ExprKind, Place, Projection, Root, Type, Value};
use crate::operators::Literal;
use arl_lang::ast::{self, BinaryOp, Radix};
use arl_lang::catalog::Base;
use arl_lang::span::Span;
use std::fmt::Display;

impl Checker<'_> {
    /// Checks an expression. `want` is the type expected at its place: braces, enumeration constants and spliced values
    /// need it. The caller still has to [`coerce`](Checker::coerce) the result.
    pub(crate) fn expr(&mut self, body: &mut CheckedBody, expr: &ast::Expr, want: Option<Type>) -> Option<Typed> {
        let span = expr.span;
        match &expr.kind {
            ast::ExprKind::Int(number, radix) => Some(integer_literal(*number, *radix, span)),
            ast::ExprKind::Double(number) => {
                if self.options.strict {
                    let text = self.text(body.module, span);
                    if text.starts_with('.') || text.ends_with('.') {
                        self.strict_form(body, span, "numbers that lack a digit on one side of the point");
                    }
                }
                Some(constant(Value::Double(*number), span))
            }
            ast::ExprKind::String(text) => Some(constant(Value::String((&**text).into()), span)),
            ast::ExprKind::Bool(value) => Some(constant(Value::Bool(*value), span)),
            ast::ExprKind::Name(symbol) => {
                let found = self.name(body, *symbol, span, want)?;
                Some(self.value_of(body, found))
            }
            ast::ExprKind::Path { .. }
            | ast::ExprKind::System(_)
            | ast::ExprKind::Index(_)
            | ast::ExprKind::Field(..) => {
                let found = self.place_or_value(body, expr)?;
                Some(self.value_of(body, found))
            }
            ast::ExprKind::Call(call) => self.call(body, call, span).map(Typed::plain),
            ast::ExprKind::Unary(op, operand) => {
                let operand = self.expr(body, operand, None)?;
                self.unary(body, *op, operand, span)
            }
            ast::ExprKind::Binary(op, both) => {
                let (left, right) = if is_splice(&both.0) {
                    let right = self.expr(body, &both.1, None);
                    let ty = right.as_ref()?.expr.ty;
                    (self.expr(body, &both.0, Some(ty)), right)
                } else {
                    let left = self.expr(body, &both.0, None);
                    let ty = if is_splice(&both.1) { Some(left.as_ref()?.expr.ty) } else { None };
                    (left, self.expr(body, &both.1, ty))
                };
                self.binary(body, *op, left?, right?, span)
            }
            ast::ExprKind::Assign(None, both) => self.assign(body, &both.0, &both.1, span).map(Typed::plain),
            ast::ExprKind::Assign(Some(op), both) => {
                self.assign_op(body, *op, &both.0, &both.1, span).map(Typed::plain)
            }
            ast::ExprKind::Step(step, operand) => self.step(body, *step, operand, span),
            ast::ExprKind::Brace(items) => match want {
                Some(want) => self.brace(body, items, want, span).map(Typed::plain),
                None => self.report(body, span, TypeProblem::BraceWithoutType),
            },
            ast::ExprKind::Splice(number) => {
                let known = self.splices.get(*number as usize).copied().flatten();
                match known.or(want) {
                    Some(ty) => Some(Typed::plain(Expr { ty, kind: ExprKind::Splice(*number), span })),
                    None => self.report(body, span, TypeProblem::SpliceType),
                }
            }
            ast::ExprKind::Error => None,
        }
    }

    /// `++` and `--`, before or after a variable.
    fn step(&mut self, body: &mut CheckedBody, step: ast::Step, operand: &ast::Expr, span: Span) -> Option<Typed> {
        let place = self.written_place(body, operand, true)?;
        let steps = matches!(place.ty.base, Base::Int | Base::Uint | Base::Byte) && !place.ty.is_array();
        if !steps {
            let operator = if step.up { "++" } else { "--" };
            let left = self.type_name(place.ty);
            let hint = Some("only int, uint and byte variables have `++` and `--`".into());
            let problem = TypeProblem::Operator { operator: operator.into(), left, right: None, hint };
            return self.report(body, span, problem);
        }
        let ty = place.ty;
        Some(Typed::plain(Expr { ty, kind: ExprKind::Step(step, Box::new(place)), span }))
    }

    /// Whether it is a Rust value whose type is not given.
    pub(crate) fn is_untyped_splice(&self, expr: &ast::Expr) -> bool {
        let ast::ExprKind::Splice(number) = expr.kind else { return false };
        self.splices.get(number as usize).is_none_or(Option::is_none)
    }

    /// Checks an expression and converts it to the type expected at its place.
    pub(crate) fn expr_as(
        &mut self,
        body: &mut CheckedBody,
        expr: &ast::Expr,
        to: Type,
        what: impl Display,
    ) -> Option<Expr> {
        let typed = self.expr(body, expr, Some(to))?;
        self.coerce(body, typed, to, what)
    }

    /// Checks a condition.
    pub(crate) fn condition(&mut self, body: &mut CheckedBody, expr: &ast::Expr) -> Option<Expr> {
        self.doubt_condition(body, expr);
        self.expr_as(body, expr, Type::scalar(Base::Bool), "a condition")
    }

    fn value_of(&mut self, body: &mut CheckedBody, found: PlaceOrValue) -> Typed {
        match found {
            PlaceOrValue::Place(place) => self.read(body, place),
            PlaceOrValue::Value(typed) => typed,
        }
    }

    fn assign(&mut self, body: &mut CheckedBody, target: &ast::Expr, value: &ast::Expr, span: Span) -> Option<Expr> {
        let place = self.written_place(body, target, false);
        let want = place.as_ref().map(|place| place.ty);
        let value = match (&place, &value.kind) {
            // Without a type braces cannot be checked; the target has been reported already.
            (None, ast::ExprKind::Brace(_)) => None,
            _ => self.expr(body, value, want),
        };
        let (place, value) = (place?, value?);
        let ty = place.ty;
        let value = self.coerce(body, value, ty, "the value")?;
        if let Some(Projection::Field(id, index)) = place.path.last() {
            self.check_component(body, *id, *index, &value);
        }
        self.check_taken(body, &place, &value);
        Some(Expr { ty, kind: ExprKind::Assign(Box::new((place, value))), span })
    }

    /// Warns about a constant that a system variable does not accept.
    fn check_taken(&mut self, body: &CheckedBody, place: &Place, value: &Expr) {
        let (Root::System(variable), ExprKind::Const(_)) = (&place.root, &value.kind) else { return };
        if let Some(takes) = limit(place, Some(value)) {
            let value_text = self.excerpt(body.module, value.span);
            let problem = NotTaken { variable: variable.name, value: value_text, takes };
            let _: Option<()> = self.report(body, value.span, problem);
        }
    }

    fn assign_op(
        &mut self,
        body: &mut CheckedBody,
        op: BinaryOp,
        target: &ast::Expr,
        value: &ast::Expr,
        span: Span,
    ) -> Option<Expr> {
        let place = self.written_place(body, target, true);
        let ty = place.as_ref().filter(|_| is_splice(value)).map(|place| place.ty);
        let value = self.expr(body, value, ty);
        let (place, value) = (place?, value?);
        let ty = place.ty;
        // The types are those of `place op value`; a stand-in for the place suffices to find them.
        let stand_in = Place { root: place.root, path: Vec::new(), ty, span: place.span };
        let left = Typed::plain(Expr { ty, kind: ExprKind::Place(Box::new(stand_in)), span: place.span });
        let combined = self.binary(body, op, left, value, span)?.expr;
        let ExprKind::Binary(_, operands) = combined.kind else { return None };
        if combined.ty != ty {
            let problem = TypeProblem::Mismatch {
                found: self.type_name(combined.ty),
                wanted: self.type_name(ty),
                what: format!("the result of `{}=`", op.text()),
                use_instead: super::convert::instead(combined.ty.base, ty.base),
            };
            return self.report(body, span, problem);
        }
        Some(Expr { ty, kind: ExprKind::AssignOp(op, Box::new((place, operands.1))), span })
    }

    /// Reports a decimal beyond int, for an index or another value that is not converted.
    pub(crate) fn refuse_wide(&mut self, body: &CheckedBody, typed: &Typed) -> Option<()> {
        if typed.literal == Literal::Wide {
            let text = self.text(body.module, typed.expr.span).to_string();
            return self.report(body, typed.expr.span, TypeProblem::WideLiteral { text });
        }
        Some(())
    }

    /// Reports a constant or a variable whose value depends on itself.
    pub(crate) fn report_circular(&mut self, module: crate::hir::ModuleId, span: Span, name: &str) {
        let problem = ConstantProblem::Circular { name: name.into() };
        self.report_in::<()>(module, span, problem, &[]);
    }
}

fn integer_literal(number: u32, radix: Radix, span: Span) -> Typed {
    match (i32::try_from(number), radix) {
        (Ok(number), Radix::Decimal) => constant(Value::Int(number), span),
        (Err(_), Radix::Decimal) => {
            let expr = Expr { ty: Type::scalar(Base::Uint), kind: ExprKind::Const(Value::Uint(number)), span };
            Typed { expr, literal: Literal::Wide }
        }
        _ => {
            let kind = ExprKind::Const(Value::Int(number as i32));
            Typed { expr: Expr { ty: Type::scalar(Base::Int), kind, span }, literal: Literal::Pattern }
        }
    }
}

/// Whether it is a Rust value, which takes the type of the other operand.
fn is_splice(expr: &ast::Expr) -> bool {
    matches!(expr.kind, ast::ExprKind::Splice(_))
}
