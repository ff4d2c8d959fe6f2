//! Places: variables, their components and elements; reading and writing what is there.

use super::body::FunctionCode;
use crate::hir::{Expr, ExprKind, LocalId, Place as HirPlace, Projection, Root, Type, Value};
use arl_code::{Extent, Op, Place, Reg, Space};
use arl_lang::catalog::system_variables;

/// A place whose indices have been evaluated.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spot {
    pub(super) place: Place,
    /// The type of the value.
    pub(super) ty: Type,
    /// The size that the number of the element is checked against when the place is used; 0: it has been checked.
    check: u16,
}

impl Spot {
    /// A place that needs no check.
    pub(super) fn new(place: Place, ty: Type) -> Self {
        Self { place, ty, check: 0 }
    }

    /// The register that the value is in.
    pub(super) fn register(&self) -> Option<Reg> {
        match self.place.space {
            Space::Register(register) => Some(register),
            _ => None,
        }
    }

    /// The string of the frame that the value is.
    pub(super) fn frame_text(&self) -> Option<u32> {
        (self.place.space == Space::Frame && self.place.element.is_none()).then_some(self.place.text)
    }

    /// Whether the value lies in the frame at a fixed place.
    pub(super) fn is_in_frame(&self) -> bool {
        self.place.space == Space::Frame && self.place.element.is_none()
    }
}

/// The most words that one operation copies.
const MOST_WORDS: u32 = u16::MAX as u32;

impl<'p> FunctionCode<'p, '_> {
    /// Where a variable is.
    pub(super) fn variable(&mut self, root: Root) -> Place {
        match root {
            Root::Local(id) => match self.locals.get(&id).copied() {
                Some(place) => place,
                // A variable of a constant, or one whose declaration is jumped over.
                None => self.declare(id),
            },
            Root::Global(id) => self.lowering.globals.get(id.0 as usize).copied().unwrap_or(Place::NOWHERE),
            Root::System(variable) => {
                let number = system_variables().position(|other| other.name == variable.name);
                Place::start(Space::System(number.and_then(|at| u16::try_from(at).ok()).unwrap_or(u16::MAX)))
            }
        }
    }

    /// Evaluates the indices of a place.
    pub(super) fn spot(&mut self, place: &'p HirPlace) -> Spot {
        self.spot_before(place, &[])
    }

    /// Evaluates the indices of a place, which is used after the evaluation of other expressions.
    pub(super) fn spot_before(&mut self, place: &'p HirPlace, later: &[&'p Expr]) -> Spot {
        let mut at = self.variable(place.root);
        let mut check = 0;
        for step in &place.path {
            match step {
                Projection::Field(id, index) => {
                    at = at.after(Extent::before(*id, *index, self.family()));
                    check = self.checked_now(&mut at, check);
                }
                Projection::Index(indices, array) => {
                    (at, check) = self.element(at, indices, *array, place, later);
                }
            }
        }
        Spot { place: at, ty: place.ty, check }
    }

    /// The element of an array with these indices.
    fn element(
        &mut self,
        array_at: Place,
        indices: &'p [Expr],
        array: Type,
        place: &'p HirPlace,
        later: &[&'p Expr],
    ) -> (Place, u16) {
        let one = Extent::of(array.base, self.family());
        if let Some(known) = self.known_index(indices, array) {
            return (array_at.after(one.times(known)), 0);
        }
        let sure = self.ranges.are_inside(indices, array);
        let line = self.line;
        let mut registers = Vec::new();
        for (at, index) in indices.iter().enumerate() {
            let rest: Vec<&Expr> = indices.iter().skip(at + 1).chain(later.iter().copied()).collect();
            registers.push(self.steady_number(index, &rest));
        }
        let element = |register| Place { element: Some((register, one)), ..array_at };
        if let ([register], [size]) = (registers.as_slice(), array.dims()) {
            if sure {
                return (element(*register), 0);
            }
            // Checked where it is used, if one operation does both, and if nothing comes in between.
            let fuses = one == (Extent { words: 1, ..Extent::default() })
                && place.path.len() == 1
                && matches!(array_at.space, Space::Frame | Space::Global)
                && line <= u32::from(u16::MAX)
                && later.is_empty();
            if fuses {
                return (element(*register), *size);
            }
            let to = self.register();
            self.op(Op::Index { to, index: *register, size: *size, line });
            return (element(to), 0);
        }
        let register = match (registers.as_slice(), array.dims()) {
            ([row, column], [rows, columns]) if !sure => {
                let to = self.register();
                self.op(Op::Index2 { to, row: *row, column: *column, rows: *rows, columns: *columns, line });
                to
            }
            (registers, sizes) => self.joined_index(registers, sizes, sure),
        };
        (element(register), 0)
    }

    /// One number from the numbers of several dimensions.
    fn joined_index(&mut self, registers: &[Reg], sizes: &[u16], sure: bool) -> Reg {
        let line = self.line;
        let mut joined = None;
        for (register, size) in registers.iter().zip(sizes) {
            let mut right = *register;
            if !sure {
                right = self.register();
                self.op(Op::Index { to: right, index: *register, size: *size, line });
            }
            joined = Some(match joined {
                None => right,
                Some(left) => {
                    let to = self.register();
                    self.op(Op::MulAdd { to, left, right, value: i32::from(*size) });
                    to
                }
            });
        }
        joined.unwrap_or_default()
    }

    fn known_index(&self, indices: &'p [Expr], array: Type) -> Option<u32> {
        let mut at = 0;
        for (index, size) in indices.iter().zip(array.dims()) {
            let Value::Int(index) = self.constant(index)? else { return None };
            at = at * u32::from(*size) + u32::try_from(*index).ok().filter(|index| *index < u32::from(*size))?;
        }
        Some(at)
    }

    /// Checks the number of an element now, if that is still to be done.
    fn checked_now(&mut self, place: &mut Place, check: u16) -> u16 {
        if let (Some((index, one)), 1..) = (place.element, check) {
            let (to, line) = (self.register(), self.line);
            self.op(Op::Index { to, index, size: check, line });
            place.element = Some((to, one));
        }
        0
    }

    /// The spot with its check done.
    pub(super) fn settled(&mut self, mut spot: Spot) -> Spot {
        spot.check = self.checked_now(&mut spot.place, spot.check);
        spot
    }

    /// The register that counts words of an element.
    fn word_index(&mut self, element: (Reg, Extent)) -> Reg {
        let (index, one) = element;
        if one.words == 1 {
            return index;
        }
        let to = self.register();
        self.op(Op::MulSmall { to, left: index, value: one.words as i32 });
        to
    }

    // Numbers.

    /// A number in a register: that of the variable, if it has one and none is wanted.
    pub(super) fn load(&mut self, spot: Spot, wanted: Option<Reg>) -> Reg {
        if let Some(from) = spot.register() {
            return match wanted {
                Some(to) if to != from => {
                    self.op(Op::Copy { to, from });
                    to
                }
                _ => from,
            };
        }
        let to = self.register_or(wanted);
        let (at, line) = (spot.place.word, self.line as u16);
        match (spot.place.space, spot.place.element) {
            (Space::Frame, None) => self.op(Op::Load { to, at }),
            (Space::Global, None) => self.op(Op::LoadGlobal { to, at }),
            (Space::Boxed(from), None) => self.op(Op::LoadBoxed { to, from, at }),
            (Space::Frame, Some((index, _))) if spot.check > 0 => {
                self.op(Op::LoadChecked { to, index, size: spot.check, at, line })
            }
            (Space::Global, Some((index, _))) if spot.check > 0 => {
                self.op(Op::LoadGlobalChecked { to, index, size: spot.check, at, line })
            }
            (Space::Frame, Some(element)) => {
                let index = self.word_index(element);
                self.op(Op::LoadElement { to, index, at })
            }
            (Space::Global, Some(element)) => {
                let index = self.word_index(element);
                self.op(Op::LoadGlobalElement { to, index, at })
            }
            _ => self.transfer(spot.place, Place::start(Space::Register(to)), Extent { words: 1, ..Extent::default() }),
        };
        to
    }

    /// Writes a number from a register.
    pub(super) fn store(&mut self, spot: Spot, from: Reg) {
        let (at, line) = (spot.place.word, self.line as u16);
        match (spot.place.space, spot.place.element) {
            (Space::Register(to), _) if to == from => return,
            (Space::Register(to), _) => self.op(Op::Copy { to, from }),
            (Space::Frame, None) => self.op(Op::Store { from, at }),
            (Space::Global, None) => self.op(Op::StoreGlobal { from, at }),
            (Space::Boxed(to), None) => self.op(Op::StoreBoxed { to, from, at }),
            (Space::Frame, Some((index, _))) if spot.check > 0 => {
                self.op(Op::StoreChecked { from, index, size: spot.check, at, line })
            }
            (Space::Global, Some((index, _))) if spot.check > 0 => {
                self.op(Op::StoreGlobalChecked { from, index, size: spot.check, at, line })
            }
            (Space::Frame, Some(element)) => {
                let index = self.word_index(element);
                self.op(Op::StoreElement { from, index, at })
            }
            (Space::Global, Some(element)) => {
                let index = self.word_index(element);
                self.op(Op::StoreGlobalElement { from, index, at })
            }
            _ => {
                self.transfer(Place::start(Space::Register(from)), spot.place, Extent { words: 1, ..Extent::default() })
            }
        };
    }

    // Whole values.

    /// Copies a value from place to place.
    pub(super) fn copy(&mut self, from: Place, to: Place, extent: Extent) {
        if from == to {
            return;
        }
        let words_only = extent.texts == 0 && extent.handles == 0;
        if !words_only || extent.words == 0 {
            self.transfer(from, to, extent);
            return;
        }
        let mut done = 0;
        while done < extent.words {
            let count = (extent.words - done).min(MOST_WORDS);
            let moved = Extent { words: done, ..Extent::default() };
            self.copy_words(from.after(moved), to.after(moved), count);
            done += count;
        }
    }

    fn copy_words(&mut self, from: Place, to: Place, count: u32) {
        let short = count as u16;
        match (from.space, from.element, to.space, to.element) {
            (Space::Frame, None, Space::Frame, None) => {
                self.op(Op::CopyWords { to: to.word, from: from.word, count: short })
            }
            (Space::Constant, None, Space::Frame, None) => {
                self.op(Op::CopyConstants { to: to.word, from: from.word, count: short })
            }
            (Space::Global, None, Space::Frame, None) => {
                self.op(Op::CopyFromGlobal { to: to.word, from: from.word, count: short })
            }
            (Space::Frame, None, Space::Global, None) => {
                self.op(Op::CopyToGlobal { to: to.word, from: from.word, count: short })
            }
            (Space::Frame, Some(element), Space::Frame, None) => {
                let index = self.word_index(element);
                self.op(Op::CopyElement { to: to.word, index, from: from.word, count: short })
            }
            (Space::Frame, None, Space::Frame, Some(element)) => {
                let index = self.word_index(element);
                self.op(Op::CopyToElement { to: to.word, index, from: from.word, count: short })
            }
            (Space::Global, Some(element), Space::Frame, None) => {
                let index = self.word_index(element);
                self.op(Op::CopyGlobalElement { to: to.word, index, from: from.word, count: short })
            }
            (Space::Frame, None, Space::Global, Some(element)) => {
                let index = self.word_index(element);
                self.op(Op::CopyToGlobalElement { to: to.word, index, from: from.word, count: short })
            }
            _ => self.transfer(from, to, Extent { words: count, ..Extent::default() }),
        };
    }

    /// A copy that has no operation of its own.
    pub(super) fn transfer(&mut self, from: Place, to: Place, extent: Extent) -> u32 {
        let transfers = &mut self.lowering.code.transfers;
        transfers.push(arl_code::Transfer { from, to, extent, line: self.line });
        let transfer = transfers.len() as u32 - 1;
        self.op(Op::Transfer { transfer })
    }

    // What later expressions do to a place.

    /// Whether one of these expressions writes a local variable.
    pub(super) fn write(&self, later: &[&'p Expr], id: LocalId) -> bool {
        later.iter().any(|expr| self.facts(expr).writes.contains(&id))
    }

    /// The local variable that an expression stands for, where its value is not copied: `a`, `a.x`, `a = 3`, `++a`.
    pub(super) fn aliased(&self, expr: &'p Expr) -> Option<LocalId> {
        let place = match &expr.kind {
            ExprKind::Place(place) | ExprKind::Step(_, place) => place,
            ExprKind::Assign(sides) | ExprKind::AssignOp(_, sides) => &sides.0,
            ExprKind::Convert(inner) => return self.aliased(inner),
            _ => return None,
        };
        match place.root {
            Root::Local(id) if !self.is_shared(id) => Some(id),
            _ => None,
        }
    }

    /// Whether the value of an expression may be changed by later ones before it is used.
    pub(super) fn is_disturbed(&self, expr: &'p Expr, later: &[&'p Expr]) -> bool {
        self.aliased(expr).is_some_and(|id| self.write(later, id))
    }
}
