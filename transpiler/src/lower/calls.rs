//! Functions of the program: their frames, their bodies, their calls.

use super::body::{FunctionCode, Used};
use super::places::Spot;
use super::variables::{is_number, is_text};
use crate::effects::{flow, recursion};
use crate::hir::{Expr, ExprKind, Func, FuncId, Type};
use arl_code::{Call, Entry, Extent, Op, Place, Space};
use arl_lang::catalog::Base;

/// The most parameters that are handed over in registers.
const MOST_IN_REGISTERS: u32 = 64;

impl<'p> FunctionCode<'p, '_> {
    /// Where the parameters of a function are, counted from the start of its frame, and how much of it they take.
    fn parameters(&self, func: &Func) -> (Vec<Place>, Used) {
        let mut used = Used::default();
        let mut places = Vec::new();
        for id in &func.params {
            let Some(local) = func.locals.get(id.0 as usize) else { continue };
            if is_number(local.ty) && used.registers < MOST_IN_REGISTERS {
                places.push(Place::start(Space::Register(used.registers as u8)));
                used.registers += 1;
            } else {
                places.push(Place::start(Space::Frame).after(used.frame));
                used.frame = used.frame.plus(self.extent(local.ty));
            }
        }
        (places, used)
    }

    /// The whole function.
    pub(super) fn function(&mut self, func: &'p Func) {
        self.stand_at(func.span);
        let (places, mut used) = self.parameters(func);
        let result = Extent::of(func.result, self.family());
        self.used = Used { frame: result, registers: 1, boxes: 0 };
        self.note_used();
        used.registers = used.registers.max(1);
        used.frame = used.frame.max(result);
        self.used = used;
        self.note_used();
        self.open(false);
        for (id, place) in func.params.iter().zip(&places) {
            let ty = self.local_type(*id);
            let mut place = *place;
            if self.is_shared(*id) && !matches!(ty.base, Base::Handle(_)) {
                let to = self.new_box();
                self.box_of(to, ty, place);
                place = Place::start(Space::Boxed(to));
            }
            self.locals.insert(*id, place);
            self.flow.visible.push(*id);
            self.show(*id);
        }
        if self.keeps_places() {
            self.lay_out_all(func);
        }
        if func.has_goto {
            if func.effects.recursive {
                self.enter(func, &places);
            }
            self.states(&func.body);
            self.complete_gotos();
        } else {
            let mut guard = func.effects.recursive;
            for stmt in flow::reachable(&func.body) {
                if guard && recursion::leads_back(self.scope(), stmt) {
                    self.stand_at(func.span);
                    self.enter(func, &places);
                    guard = false;
                }
                self.statement(stmt);
            }
        }
        self.end(func.result);
        self.end_scopes();
    }

    /// Looks whether there is room for another call.
    fn enter(&mut self, func: &'p Func, places: &[Place]) {
        let mut entry = Entry { weight: recursion::weight(func, self.family()), ..Entry::default() };
        for (id, place) in func.params.iter().zip(places) {
            let Some(local) = func.locals.get(id.0 as usize) else { continue };
            if local.ty.is_array() {
                let bytes = local.ty.bytes(self.family());
                entry.bytes = entry.bytes.saturating_add(u32::try_from(bytes).unwrap_or(u32::MAX));
            } else if is_text(local.ty) && local.read {
                // Events may see it in its box.
                let here = self.locals.get(id).copied();
                entry.texts.push(here.unwrap_or(*place));
            }
        }
        self.lowering.code.entries.push(entry);
        let (entry, line) = (self.lowering.code.entries.len() as u32 - 1, self.line);
        self.op(Op::Enter { entry, line });
    }

    /// What the function gives if its end is reached.
    fn end(&mut self, result: Base) {
        let ty = Type::scalar(result);
        match result {
            Base::Void => self.op(Op::Return),
            _ if is_number(ty) => {
                self.op(Op::Small { to: 0, value: 0 });
                self.op(Op::ReturnWord { from: 0 })
            }
            _ => {
                let place = Place::start(Space::Frame);
                self.start_value(Spot::new(place, ty));
                self.op(Op::Return)
            }
        };
    }

    /// `return`
    pub(super) fn return_statement(&mut self, value: Option<&'p Expr>) {
        let Some(value) = value else {
            self.op(Op::Return);
            return;
        };
        self.pointer(value);
        if value.ty.base == Base::Void {
            self.effect_of(value);
            self.op(Op::Return);
        } else if is_number(value.ty) {
            let from = self.number(value, None);
            self.op(Op::ReturnWord { from });
        } else if is_text(value.ty) {
            let from = self.text(value);
            self.op(Op::ReturnText { from });
        } else {
            let from = self.whole(value);
            let extent = self.extent(value.ty);
            self.copy(from, Place::start(Space::Frame), extent);
            self.op(Op::Return);
        }
    }

    /// A call; returns where the result is.
    pub(super) fn call(&mut self, id: FuncId, args: &'p [Expr], ty: Type) -> Place {
        let program = self.lowering.program;
        let Some(func) = program.funcs.get(id.0 as usize) else { return Place::NOWHERE };
        let start = self.used;
        let (places, taken) = self.parameters(func);
        let result = Extent::of(func.result, self.family());
        self.used = Used {
            registers: start.registers + taken.registers.max(1),
            frame: start.frame.plus(taken.frame.max(result)),
            boxes: start.boxes,
        };
        self.note_used();
        for (arg, place) in args.iter().zip(places) {
            let place = match place.space {
                Space::Register(register) => {
                    let register = u8::try_from(start.registers + u32::from(register)).unwrap_or_else(|_| {
                        self.refuse("the expression is too large for the engine");
                        u8::MAX
                    });
                    Place::start(Space::Register(register))
                }
                _ => place.after(start.frame),
            };
            self.passing(|body| body.pass(arg, place));
        }
        let register = u8::try_from(start.registers).unwrap_or_else(|_| {
            self.refuse("the expression is too large for the engine");
            u8::MAX
        });
        let boxes = u16::try_from(start.boxes).unwrap_or(u16::MAX);
        let call = Call { function: id.0, register, at: start.frame, boxes, line: self.line };
        self.lowering.code.calls.push(call);
        let call = self.lowering.code.calls.len() as u32 - 1;
        self.op(Op::Call { call });
        self.used = Used {
            registers: start.registers + u32::from(is_number(ty)),
            frame: start.frame.plus(result),
            boxes: start.boxes,
        };
        if is_number(ty) {
            Place::start(Space::Register(register))
        } else {
            Place::start(Space::Frame).after(start.frame)
        }
    }

    /// Hands an argument to a function.
    fn pass(&mut self, arg: &'p Expr, place: Place) {
        if let Base::Handle(_) = arg.ty.base {
            if let ExprKind::Place(handle) = &arg.kind {
                let spot = self.spot(handle);
                let spot = self.settled(spot);
                let extent = self.extent(arg.ty);
                self.transfer(spot.place, place, extent);
            }
            return;
        }
        self.set_new(Spot::new(place, arg.ty), arg);
    }
}
