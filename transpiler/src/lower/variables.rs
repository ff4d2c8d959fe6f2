//! Declarations, start values, and the first values of global variables.

use super::body::FunctionCode;
use super::places::Spot;
use crate::hir::{Expr, Global, GlobalId, LocalId, Place as HirPlace, Root, Type};
use arl_code::{Extent, Op, Place, Space};
use arl_lang::catalog::Base;

/// Whether a value of the type is a number: it fits into a register.
pub(super) fn is_number(ty: Type) -> bool {
    !ty.is_array() && !matches!(ty.base, Base::String | Base::Struct(_) | Base::Handle(_) | Base::Void)
}

/// Whether the type is a single string.
pub(super) fn is_text(ty: Type) -> bool {
    !ty.is_array() && ty.base == Base::String
}

impl<'p> FunctionCode<'p, '_> {
    /// Gives a local variable its place.
    pub(super) fn declare(&mut self, id: LocalId) -> Place {
        // In a function with `goto` a variable keeps its place, whatever is jumped over.
        if let Some(place) = self.locals.get(&id).copied()
            && self.keeps_places()
        {
            return place;
        }
        let ty = self.local_type(id);
        let place = if self.is_shared(id) && !matches!(ty.base, Base::Handle(_)) {
            Place::start(Space::Boxed(self.new_box()))
        } else if is_number(ty) && self.has_registers_for_locals() {
            Place::start(Space::Register(self.register()))
        } else {
            self.space_of(ty)
        };
        self.locals.insert(id, place);
        place
    }

    /// Whether local variables keep their places outside their blocks.
    pub(super) fn keeps_places(&self) -> bool {
        self.is_watched() || self.func.is_some_and(|func| func.has_goto)
    }

    /// `int a = value`, or without a value.
    pub(super) fn let_statement(&mut self, id: LocalId, value: Option<&'p Expr>) {
        let Some(local) = self.func.and_then(|func| func.locals.get(id.0 as usize)) else { return };
        if local.constant && local.value.is_some() {
            return;
        }
        let ty = local.ty;
        if let Some(value) = value {
            self.pointer(value);
        }
        let place = self.declare(id);
        self.flow.visible.push(id);
        if let Space::Boxed(to) = place.space {
            self.shared_declaration(to, ty, value);
        } else {
            self.passing(|body| match value {
                Some(value) => body.set_new(Spot::new(place, ty), value),
                None => body.start_value(Spot::new(place, ty)),
            });
        }
        self.show(id);
    }

    /// A variable that events see: a new box each time.
    fn shared_declaration(&mut self, to: u16, ty: Type, value: Option<&'p Expr>) {
        self.passing(|body| {
            let fresh = body.space_of(ty);
            match value {
                Some(value) if is_number(ty) => {
                    let register = body.number(value, None);
                    body.store(Spot::new(fresh, ty), register);
                }
                Some(value) => body.set_new(Spot::new(fresh, ty), value),
                None => body.start_value(Spot::new(fresh, ty)),
            }
            body.box_of(to, ty, fresh);
        });
    }

    /// A new box with a value of the frame.
    pub(super) fn box_of(&mut self, to: u16, ty: Type, value: Place) {
        let extent = self.extent(ty);
        self.lowering.code.boxes.push(extent);
        let number = self.lowering.code.boxes.len() as u32 - 1;
        self.op(Op::NewBox { to, extent: number });
        self.transfer(value, Place::start(Space::Boxed(to)), extent);
    }

    /// Gives a variable its start value.
    pub(super) fn start_value(&mut self, spot: Spot) {
        let (place, ty) = (spot.place, spot.ty);
        if let Space::Register(to) = place.space {
            self.op(Op::Small { to, value: 0 });
            return;
        }
        if let Base::Handle(handle) = ty.base {
            let count = ty.len() as u16;
            self.op(Op::NewHandles { at: place.handle, count, kind: handle.into() });
            return;
        }
        if !spot.is_in_frame() {
            // By way of the frame.
            self.passing(|body| {
                let fresh = body.space_of(ty);
                body.start_value(Spot::new(fresh, ty));
                let extent = body.extent(ty);
                body.copy(fresh, place, extent);
            });
            return;
        }
        let extent = self.extent(ty);
        if extent.texts > 0 {
            self.op(Op::ClearTexts { at: place.text, count: extent.texts });
        }
        if !matches!(ty.base, Base::Struct(_)) {
            if extent.words > 0 {
                self.op(Op::Clear { at: place.word, count: extent.words });
            }
            return;
        }
        let one = Extent::of(ty.base, self.family());
        let from = self.lowering.start_words(ty.base);
        for number in 0..ty.len() as u32 {
            let to = place.word + number * one.words;
            self.op(Op::CopyConstants { to, from, count: one.words as u16 });
        }
    }

    /// The first value of a global variable.
    pub(super) fn first_value(&mut self, id: GlobalId, global: &'p Global) {
        if global.value.is_some() || matches!(global.ty.base, Base::Handle(_)) {
            return;
        }
        self.stand_at(global.span);
        let place = self.variable(Root::Global(id));
        let spot = Spot::new(place, global.ty);
        if let Some(init) = &global.init {
            self.pointer(init);
        }
        self.passing(|body| match &global.init {
            Some(init) => body.set(spot, init),
            None => body.start_value(spot),
        });
    }

    /// The start values of the variables that a jump to a label skips.
    pub(super) fn reset(&mut self, id: LocalId) {
        let ty = self.local_type(id);
        let place = self.declare(id);
        match place.space {
            Space::Boxed(to) => self.shared_declaration(to, ty, None),
            _ => self.start_value(Spot::new(place, ty)),
        }
        self.show(id);
    }

    /// Whether an expression reads or writes the variable of a place.
    pub(super) fn mentions(&self, expr: &'p Expr, place: &'p HirPlace) -> bool {
        let facts = self.facts(expr);
        match place.root {
            Root::Local(id) if !self.is_shared(id) => facts.reads.contains(&id) || facts.writes.contains(&id),
            _ => facts.world || facts.acts || facts.waits || facts.globals || facts.context,
        }
    }
}
