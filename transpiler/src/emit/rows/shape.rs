//! What statements that differ only in constants have in common.

use crate::effects::captures;
use crate::emit::slots::Slots;
use crate::hir::{
    Builtin, Expr, ExprKind, Func, GlobalId, LocalId, Passed, Place, Projection, Root, Stmt, StmtKind, Value,
};
use arl_lang::catalog::{Family, Presence, Struct};

/// A statement without the constants that may differ between the rows of a table.
#[derive(Clone, PartialEq, Eq, Hash, Default, Debug)]
pub(in crate::emit) struct Shape(Vec<u8>);

/// A part that may differ: the surrounding code is the same for any filling.
#[derive(Clone, Copy, Debug)]
pub(in crate::emit) struct Hole<'p> {
    pub(in crate::emit) filling: Filling<'p>,
    /// Its purpose: the label of the parameter, or the component.
    pub(in crate::emit) name: &'p str,
}

/// The content of a hole.
#[derive(Clone, Copy, Debug)]
pub(in crate::emit) enum Filling<'p> {
    /// A constant that is an argument, a component of an argument, or the value assigned to a global variable.
    Constant(&'p Expr, &'p Value),
    /// A variable stored in an array.
    Variable(&'p Place, GlobalId),
}

/// A statement as a row of a table.
#[derive(Debug)]
pub(in crate::emit) struct StatementRow<'p> {
    pub(in crate::emit) stmt: &'p Stmt,
    /// The expression of the statement.
    pub(in crate::emit) expr: &'p Expr,
    pub(in crate::emit) shape: Shape,
    pub(super) holes: Vec<Hole<'p>>,
}

impl<'p> StatementRow<'p> {
    /// The statement as a row, if it is an expression. Does not check whether it may be in a table.
    pub(super) fn of(stmt: &'p Stmt, family: Family, slots: &Slots) -> Option<Self> {
        let StmtKind::Eval(expr) = &stmt.kind else { return None };
        let mut walk = Walk { slots: Some(slots), ..Walk::new(family) };
        walk.expr(expr, None);
        Some(Self { stmt, expr, shape: Shape(walk.shape), holes: walk.holes })
    }
}

/// The shape and the holes of a value; a lone constant is a hole.
pub(in crate::emit) fn of_value<'p>(value: &'p Expr, family: Family) -> (Shape, Vec<Hole<'p>>) {
    let mut walk = Walk::new(family);
    walk.expr(value, Some("value"));
    (Shape(walk.shape), walk.holes)
}

/// The shape, the holes and the local variables of a call in a function, regardless of the names of the variables.
pub(in crate::emit) fn of_call<'p>(
    call: &'p Expr,
    func: &'p Func,
    family: Family,
    slots: &Slots,
) -> (Shape, Vec<Hole<'p>>, Vec<LocalId>) {
    let mut walk = Walk { slots: Some(slots), func: Some(func), ..Walk::new(family) };
    walk.expr(call, None);
    (Shape(walk.shape), walk.holes, walk.locals)
}

struct Walk<'p, 's> {
    family: Family,
    /// The variables stored in arrays.
    slots: Option<&'s Slots>,
    /// The function, if local variables are distinguished only by their order and types.
    func: Option<&'p Func>,
    shape: Vec<u8>,
    holes: Vec<Hole<'p>>,
    locals: Vec<LocalId>,
}

impl<'p> Walk<'p, '_> {
    fn new(family: Family) -> Self {
        Self { family, slots: None, func: None, shape: Vec::new(), holes: Vec::new(), locals: Vec::new() }
    }

    fn word(&mut self, word: impl std::fmt::Debug) {
        use std::io::Write;
        // Writing to a vector cannot fail.
        let _ = write!(self.shape, "{word:?};");
    }

    /// An expression; a constant may differ if it is `open` and has a name.
    fn expr(&mut self, expr: &'p Expr, open: Option<&'p str>) {
        self.word(std::mem::discriminant(&expr.kind));
        match &expr.kind {
            ExprKind::Const(value) => match open {
                Some(name) => {
                    self.word(value.base());
                    self.holes.push(Hole { filling: Filling::Constant(expr, value), name });
                }
                None => self.constant(value),
            },
            ExprKind::Place(place) => self.place(place, open),
            ExprKind::FieldOf(inner, id, index) => {
                self.word((id, index));
                self.expr(inner, None);
            }
            ExprKind::Convert(inner) => {
                self.word(expr.ty);
                self.expr(inner, None);
            }
            ExprKind::Grown(inner) => self.expr(inner, None),
            ExprKind::Unary(op, inner) => {
                self.word(op);
                self.expr(inner, None);
            }
            ExprKind::Binary(op, sides) => {
                self.word(op);
                self.expr(&sides.0, None);
                self.expr(&sides.1, None);
            }
            ExprKind::Assign(sides) => {
                // The range of a system variable is checked at compile time, where the value is known.
                let open = matches!(sides.0.root, Root::Global(_)).then_some("value");
                self.place(&sides.0, None);
                self.expr(&sides.1, open);
            }
            ExprKind::AssignOp(op, sides) => {
                self.word(op);
                self.place(&sides.0, None);
                self.expr(&sides.1, None);
            }
            ExprKind::Step(step, place) => {
                self.word(step);
                self.place(place, None);
            }
            ExprKind::Call(id, args) => {
                self.word((id, args.len()));
                args.iter().for_each(|arg| self.expr(arg, Some("value")));
            }
            ExprKind::Builtin(builtin) => self.builtin(builtin),
            ExprKind::Struct(id, values) => self.structure(*id, values, open.is_some()),
            ExprKind::Array(values) => {
                self.word((expr.ty, values.len()));
                values.iter().for_each(|value| self.expr(value, None));
            }
            ExprKind::Splice(number) => self.word(number),
        }
    }

    fn builtin(&mut self, builtin: &'p Builtin) {
        let entry = builtin.entry;
        self.word((std::ptr::from_ref(entry), builtin.args.len()));
        for arg in &builtin.args {
            self.word(arg.param);
            let name = entry.params.get(arg.param).map(|param| match param.presence {
                Presence::Repeat { .. } => "value",
                _ => param.rust,
            });
            match &arg.value {
                Passed::Value(value) if captures::is_later(entry, arg) => self.expr(value, None),
                Passed::Value(value) => self.expr(value, name),
                Passed::Out(place) => self.place(place, None),
            }
        }
    }

    /// The components that have values; constants may differ if `open` is set.
    fn structure(&mut self, id: Struct, values: &'p [Option<Expr>], open: bool) {
        let components = id.def(self.family).components;
        let mut given: Vec<usize> = (0..values.len()).filter(|at| matches!(values.get(*at), Some(Some(_)))).collect();
        // They are evaluated in the order of the program.
        given.sort_by_key(|at| values.get(*at).and_then(Option::as_ref).map(|value| value.span.start));
        self.word((id, &given));
        for at in given {
            let name = components.get(at).filter(|_| open).map(|component| component.name);
            values.get(at).into_iter().flatten().for_each(|value| self.expr(value, name));
        }
    }

    /// A constant that must be the same in all rows.
    fn constant(&mut self, value: &Value) {
        match value {
            // Compared by bits, as -0 equals 0 and NaN does not equal itself.
            Value::Double(value) => self.word(value.to_bits()),
            value => self.word(value),
        }
    }

    /// A place; a variable stored in an array may differ if it is `open` and has a name.
    fn place(&mut self, place: &'p Place, open: Option<&'p str>) {
        let slots = self.slots;
        match (place.root, open) {
            (Root::System(variable), _) => self.word(std::ptr::from_ref(variable)),
            (Root::Global(id), Some(name)) => match slots.and_then(|slots| slots.of(id)) {
                Some((array, _)) => {
                    self.word((array.module, array.field.to_string()));
                    self.holes.push(Hole { filling: Filling::Variable(place, id), name });
                }
                None => self.word(place.root),
            },
            (Root::Local(id), _) if self.func.is_some() => {
                let known = self.locals.iter().position(|known| *known == id);
                let at = known.unwrap_or_else(|| {
                    self.locals.push(id);
                    self.locals.len() - 1
                });
                self.word((at, self.func.and_then(|func| func.locals.get(id.0 as usize)).map(|local| local.ty)));
            }
            (root, _) => self.word(root),
        }
        for step in &place.path {
            match step {
                Projection::Field(id, index) => self.word((id, index)),
                Projection::Index(indices, array) => {
                    self.word((array, indices.len()));
                    indices.iter().for_each(|index| self.expr(index, None));
                }
            }
        }
    }
}
