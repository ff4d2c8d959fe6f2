//! Structures, arrays, and values of any type.

use super::body::FunctionCode;
use super::places::Spot;
use super::tables::{constant_place, constant_word};
use super::texts::text_place;
use super::variables::{is_number, is_text};
use crate::effects::growth;
use crate::hir::{Expr, ExprKind, Place as HirPlace, Type, Value};
use arl_code::{Arg, Extent, Op, Place, Site, StructureOperator, Target};
use arl_lang::ast::{BinaryOp, UnaryOp};
use arl_lang::catalog::{Base, Struct};

impl<'p> FunctionCode<'p, '_> {
    /// Writes the value of an expression to a place. The expression may read what is there.
    pub(super) fn set(&mut self, spot: Spot, value: &'p Expr) {
        if is_number(spot.ty) {
            self.set_new(spot, value);
            return;
        }
        self.passing(|body| {
            let fresh = body.space_of(spot.ty);
            body.set_new(Spot::new(fresh, spot.ty), value);
            let extent = body.extent(spot.ty);
            body.copy(fresh, spot.place, extent);
        });
    }

    /// Writes the value of an expression to a place that the expression does not read.
    pub(super) fn set_new(&mut self, spot: Spot, value: &'p Expr) {
        if is_number(spot.ty) {
            let from = self.number(value, spot.register());
            self.store(spot, from);
            return;
        }
        if is_text(spot.ty) {
            match spot.frame_text() {
                Some(text) => {
                    let to = self.slot_number(text);
                    self.text_to(value, to);
                }
                None => {
                    let from = self.text(value);
                    self.store_text(spot, from);
                }
            }
            return;
        }
        if !spot.is_in_frame() {
            let extent = self.extent(spot.ty);
            match self.unchanging(value) {
                Some(constant) => {
                    let fresh = self.space_of(spot.ty);
                    self.copy(constant, fresh, extent);
                    self.copy(fresh, spot.place, extent);
                }
                None => {
                    let from = self.whole(value);
                    self.copy(from, spot.place, extent);
                }
            }
            return;
        }
        self.whole_to(value, spot.place);
    }

    /// A structure or an array: where it is, if the expression is a variable of the frame, otherwise new space.
    pub(super) fn whole(&mut self, value: &'p Expr) -> Place {
        if let ExprKind::Place(place) = &value.kind {
            let spot = self.spot(place);
            let spot = self.settled(spot);
            if spot.is_in_frame() {
                return spot.place;
            }
            let fresh = self.space_of(value.ty);
            let extent = self.extent(value.ty);
            self.copy(spot.place, fresh, extent);
            return fresh;
        }
        let fresh = self.space_of(value.ty);
        self.whole_to(value, fresh);
        fresh
    }

    /// Puts a structure or an array into the frame, where nothing of it is read.
    fn whole_to(&mut self, value: &'p Expr, to: Place) {
        let extent = self.extent(value.ty);
        match &value.kind {
            ExprKind::Place(place) => self.passing(|body| {
                let spot = body.spot(place);
                let spot = body.settled(spot);
                body.copy(spot.place, to, extent);
            }),
            ExprKind::Struct(id, values) => self.structure_to(*id, values, to),
            ExprKind::Array(values) => self.array_to(value.ty, values, to),
            ExprKind::Call(id, args) => self.passing(|body| {
                let result = body.call(*id, args, value.ty);
                body.copy(result, to, extent);
            }),
            ExprKind::Builtin(builtin) => self.passing(|body| body.builtin(builtin, to)),
            ExprKind::Binary(op, sides) => self.structure_operator(*op, &sides.0, Some(&sides.1), to),
            ExprKind::Unary(UnaryOp::Negate, inner) => {
                self.structure_operator(BinaryOp::Subtract, inner, None, to);
            }
            ExprKind::FieldOf(inner, id, index) => self.passing(|body| {
                let whole = body.whole(inner);
                let component = whole.after(Extent::before(*id, *index, body.family()));
                body.copy(component, to, extent);
            }),
            ExprKind::Assign(sides) => self.passing(|body| {
                let spot = body.assign(&sides.0, &sides.1);
                body.copy(spot.place, to, extent);
            }),
            ExprKind::AssignOp(op, sides) => self.passing(|body| {
                let spot = body.assign_op(*op, &sides.0, &sides.1);
                body.copy(spot.place, to, extent);
            }),
            ExprKind::Convert(inner) => self.whole_to(inner, to),
            _ => debug_assert!(false, "no structure or array: {value:?}"),
        }
    }

    /// The words of a structure whose components are constants, as a place among the constants.
    pub(super) fn unchanging(&mut self, value: &'p Expr) -> Option<Place> {
        let ExprKind::Struct(id, values) = &value.kind else { return None };
        let mut words = Vec::new();
        self.constant_words(*id, values, &mut words)?;
        let at = self.lowering.words(&words);
        Some(constant_place(at, 0))
    }

    /// Appends the words of a structure, if all its components are constants.
    fn constant_words(&self, id: Struct, values: &'p [Option<Expr>], out: &mut Vec<u64>) -> Option<()> {
        let family = self.family();
        let first = out.len();
        arl_code::start_words(Base::Struct(id), family, out);
        for (at, (component, value)) in id.def(family).components.iter().zip(values).enumerate() {
            let Some(value) = value else { continue };
            let offset = first + Extent::before(id, at, family).words as usize;
            match &value.kind {
                ExprKind::Struct(inner, values) => {
                    let mut words = Vec::new();
                    self.constant_words(*inner, values, &mut words)?;
                    out.get_mut(offset..offset + words.len())?.copy_from_slice(&words);
                }
                _ if component.ty == Base::String => match self.constant(value)? {
                    Value::String(text) if text.is_empty() => {}
                    _ => return None,
                },
                _ => *out.get_mut(offset)? = constant_word(self.constant(value)?)?,
            }
        }
        // A string of a constant structure would need a place of its own.
        (Extent::of(Base::Struct(id), family).texts == 0).then_some(())
    }

    /// A structure from braces; its components are evaluated in the order of the program.
    fn structure_to(&mut self, id: Struct, values: &'p [Option<Expr>], to: Place) {
        let family = self.family();
        let mut words = Vec::new();
        arl_code::start_words(Base::Struct(id), family, &mut words);
        let mut given: Vec<(usize, &'p Expr)> = Vec::new();
        for (at, value) in values.iter().enumerate() {
            let Some(value) = value else { continue };
            let offset = Extent::before(id, at, family).words as usize;
            match (self.constant(value).and_then(constant_word), words.get_mut(offset)) {
                (Some(word), Some(place)) => *place = word,
                _ => given.push((at, value)),
            }
        }
        let from = self.lowering.words(&words);
        let extent = Extent::of(Base::Struct(id), family);
        if extent.texts > 0 {
            self.op(Op::ClearTexts { at: to.text, count: extent.texts });
        }
        self.op(Op::CopyConstants { to: to.word, from, count: words.len() as u16 });
        given.sort_by_key(|(_, value)| value.span.start);
        for (at, value) in given {
            let place = to.after(Extent::before(id, at, family));
            self.passing(|body| body.set_new(Spot::new(place, value.ty), value));
        }
    }

    /// An array from braces.
    fn array_to(&mut self, ty: Type, values: &'p [Expr], to: Place) {
        if values.len() < ty.len() || ty.base == Base::String {
            self.start_value(Spot::new(to, ty));
        }
        let one = Extent::of(ty.base, self.family());
        // Runs of constants are copied at once.
        let mut run: Vec<u64> = Vec::new();
        let mut first = 0;
        for (at, value) in values.iter().enumerate() {
            if let Some(word) = self.constant(value).and_then(constant_word).filter(|_| one.words == 1) {
                if run.is_empty() {
                    first = at;
                }
                run.push(word);
                continue;
            }
            self.constants_to(to.after(one.times(first as u32)), &mut run);
            let place = to.after(one.times(at as u32));
            self.passing(|body| body.set_new(Spot::new(place, value.ty), value));
        }
        self.constants_to(to.after(one.times(first as u32)), &mut run);
    }

    fn constants_to(&mut self, to: Place, run: &mut Vec<u64>) {
        if run.is_empty() {
            return;
        }
        let from = self.lowering.words(run);
        self.copy(constant_place(from, 0), to, Extent { words: run.len() as u32, ..Extent::default() });
        run.clear();
    }

    /// Sums, differences and products of structures.
    fn structure_operator(&mut self, op: BinaryOp, left: &'p Expr, right: Option<&'p Expr>, to: Place) {
        self.passing(|body| {
            let later: Vec<&Expr> = right.into_iter().collect();
            let mut places = vec![(left.ty, body.steady_whole(left, &later))];
            if let Some(right) = right {
                places.push((right.ty, body.whole(right)));
            }
            body.structure_site(op, &places, to);
        });
    }

    /// A structure or an array that later expressions do not change.
    pub(super) fn steady_whole(&mut self, value: &'p Expr, later: &[&'p Expr]) -> Place {
        let from = self.whole(value);
        if !self.is_disturbed(value, later) {
            return from;
        }
        let fresh = self.space_of(value.ty);
        let extent = self.extent(value.ty);
        self.copy(from, fresh, extent);
        fresh
    }

    fn structure_site(&mut self, op: BinaryOp, operands: &[(Type, Place)], to: Place) {
        use StructureOperator::*;
        let structure = |at: usize| match operands.get(at).map(|(ty, _)| ty.base) {
            Some(Base::Struct(id)) => Some(id),
            _ => None,
        };
        let target = match (op, structure(0), structure(1)) {
            (BinaryOp::Add, Some(Struct::Joint), _) => AddJoints,
            (BinaryOp::Subtract, Some(Struct::Joint), Some(_)) => SubtractJoints,
            (BinaryOp::Subtract, Some(Struct::Joint), None) => NegateJoint,
            (_, Some(Struct::Frame), Some(Struct::Frame)) => FrameByFrame,
            (_, Some(Struct::Frame), _) => FrameByPose,
            (_, Some(Struct::Pose), Some(Struct::Frame)) => PoseByFrame,
            _ => PoseByPose,
        };
        let args = operands.iter().enumerate().map(|(at, (ty, place))| Arg {
            param: at as u8,
            ty: self.lowering.type_number(*ty),
            place: *place,
        });
        let args = args.collect();
        self.site(Site { target: Target::Operator(target), args, result: to, line: self.line }, |site| Op::BuiltIn {
            site,
        });
    }

    /// `place op= value` of strings and structures.
    pub(super) fn assign_op_of_whole(&mut self, op: BinaryOp, place: &'p HirPlace, value: &'p Expr) -> Spot {
        let spot = self.spot_before(place, &[value]);
        let spot = self.settled(spot);
        self.passing(|body| {
            if is_text(place.ty) {
                let parts = growth::parts(value);
                if growth::may_append(body.scope(), place, &parts) {
                    parts.into_iter().for_each(|part| body.passing(|body| body.append(spot, part)));
                    return;
                }
                if body.mentions(value, place) {
                    // The old text is read before the value is evaluated.
                    let old = body.text_slot();
                    body.load_text(spot, old);
                    let line = body.line;
                    let right = body.text(value);
                    body.op(Op::Join { to: old, right });
                    body.op(Op::CheckLength { of: old, line });
                    body.store_text(spot, old);
                    return;
                }
                body.append(spot, value);
                return;
            }
            let extent = body.extent(place.ty);
            let (old, new) = (body.space_of(place.ty), body.space_of(place.ty));
            body.copy(spot.place, old, extent);
            let right = body.whole(value);
            body.structure_site(op, &[(place.ty, old), (value.ty, right)], new);
            body.copy(new, spot.place, extent);
        });
        spot
    }

    /// Where the value of an argument is: constants where they are, variables of the frame where they are, unless later
    /// expressions change them.
    pub(super) fn argument(&mut self, value: &'p Expr, later: &[&'p Expr]) -> Place {
        if is_number(value.ty) {
            if let Some(word) = self.constant(value).and_then(constant_word) {
                let at = self.lowering.word(word);
                return constant_place(at, 0);
            }
            let register = self.steady_number(value, later);
            return Place::start(arl_code::Space::Register(register));
        }
        if is_text(value.ty) {
            if let Some(Value::String(text)) = self.constant(value) {
                let at = self.lowering.text(text);
                return constant_place(0, at);
            }
            let slot = self.steady_text(value, later);
            return text_place(slot);
        }
        if let Base::Handle(_) = value.ty.base {
            return match &value.kind {
                ExprKind::Place(place) => {
                    let spot = self.spot_before(place, later);
                    self.settled(spot).place
                }
                _ => Place::NOWHERE,
            };
        }
        match self.unchanging(value) {
            Some(constant) => constant,
            None => self.steady_whole(value, later),
        }
    }
}
