//! Interrupts, timers and triggers: their conditions and actions are functions of their own, since they may run after
//! the function that declares them has ended.

use super::body::FunctionCode;
use super::variables::is_number;
use super::{Lowering, tables};
use crate::effects::captures;
use crate::hir::{Builtin, Expr, Func, LocalId, ModuleId, Passed, Root};
use arl_code::{Event, Extent, Function, Op, Piece, Place, Space, Taken, Transfer};
use arl_lang::catalog::{Base, Mode};

/// A piece of an event that is yet to be lowered.
pub(super) struct PendingPiece<'p> {
    /// The number of its function.
    number: u32,
    func: Option<&'p Func>,
    module: ModuleId,
    expr: &'p Expr,
    is_condition: bool,
    line: u32,
}

impl<'p> FunctionCode<'p, '_> {
    /// The declaration of an event.
    pub(super) fn event(&mut self, builtin: &'p Builtin) {
        let site = self.use_of(builtin, Place::NOWHERE);
        let (mut condition, mut action) = (None, None);
        for arg in builtin.args.iter().filter(|arg| captures::is_later(builtin.entry, arg)) {
            let Passed::Value(expr) = &arg.value else { continue };
            let is_action = builtin.entry.params.get(arg.param).map(|param| param.mode) == Some(Mode::Action);
            let piece = self.piece(expr, !is_action);
            if is_action { action = Some(piece) } else { condition = Some(piece) }
        }
        let Some(action) = action else { return };
        self.lowering.code.events.push(Event { site, condition, action });
        let event = self.lowering.code.events.len() as u32 - 1;
        self.op(Op::Event { event });
    }

    /// A condition or an action, with what it takes along.
    fn piece(&mut self, expr: &'p Expr, is_condition: bool) -> Piece {
        let name = if is_condition { "condition" } else { "action" };
        let file = u16::try_from(self.module.0).unwrap_or(u16::MAX);
        let functions = &mut self.lowering.code.functions;
        let number = functions.len() as u32;
        functions.push(Function {
            name: name.into(),
            file,
            start: super::NOT_LOWERED,
            frame: Extent::default(),
            boxes: 0,
        });
        let mut taken = Vec::new();
        for (id, to) in captured(self.lowering, self.func, expr) {
            let from = self.variable(Root::Local(id));
            let extent = self.extent(self.local_type(id));
            taken.push(match (from.space, to.space) {
                (Space::Boxed(from), Space::Boxed(to)) => Taken::Boxed { from, to },
                _ if extent.handles > 0 => Taken::Handle { from: from.handle, to: to.handle, count: extent.handles },
                _ => Taken::Value(Transfer { from, to, extent, line: self.line }),
            });
        }
        let (func, module, line) = (self.func, self.module, self.line);
        self.lowering.pending.push(PendingPiece { number, func, module, expr, is_condition, line });
        Piece { function: number, taken }
    }

    /// The statements of a piece.
    fn piece_body(&mut self, piece: &PendingPiece<'p>) {
        self.line = piece.line;
        self.used.registers = 1;
        for (id, place) in captured(self.lowering, self.func, piece.expr) {
            let extent = self.extent(self.local_type(id));
            match place.space {
                Space::Register(register) => self.used.registers = u32::from(register) + 1,
                Space::Boxed(number) => self.used.boxes = u32::from(number) + 1,
                _ => self.used.frame = self.used.frame.plus(extent),
            }
            self.locals.insert(id, place);
        }
        self.note_used();
        if !piece.is_condition {
            self.open(true);
            self.halt();
            self.pointer(piece.expr);
            self.effect_of(piece.expr);
            self.op(Op::Return);
            return;
        }
        // A condition that changes something by being evaluated may never come to rest.
        let facts = self.facts(piece.expr);
        if facts.changes || !facts.writes.is_empty() {
            self.op(Op::GoesOn);
        }
        let from = self.number(piece.expr, None);
        self.op(Op::ReturnWord { from });
    }
}

impl<'p> Lowering<'p> {
    /// Lowers the pieces of the events of the functions so far.
    pub(super) fn pieces(&mut self) {
        while let Some(piece) = self.pending.pop() {
            let start = self.code.ops.len() as u32;
            let mut body = match piece.func {
                Some(func) => FunctionCode::of_function(self, func),
                None => FunctionCode::outside(self, piece.module),
            };
            body.piece_body(&piece);
            let (frame, boxes) = body.space();
            if let Some(function) = self.code.functions.get_mut(piece.number as usize) {
                (function.start, function.frame, function.boxes) = (start, frame, boxes);
            }
        }
    }
}

/// The local variables that a piece takes along, and where they are in its frame.
fn captured(lowering: &Lowering<'_>, func: Option<&Func>, expr: &Expr) -> Vec<(LocalId, Place)> {
    let family = lowering.program.family;
    let (mut registers, mut boxes, mut frame) = (0_u8, 0_u16, Extent::default());
    let mut places = Vec::new();
    for id in captures::mentioned(expr) {
        let Some(local) = func.and_then(|func| func.locals.get(id.0 as usize)) else { continue };
        if local.constant && local.value.is_some() {
            continue;
        }
        let extent = Extent::of(local.ty.base, family).times(local.ty.len() as u32);
        let place = if local.shared && !matches!(local.ty.base, Base::Handle(_)) {
            let place = Place::start(Space::Boxed(boxes));
            // More than the function can have: it is refused.
            boxes = boxes.saturating_add(1);
            place
        } else if is_number(local.ty) && registers < tables::MOST_CAPTURED {
            registers += 1;
            Place::start(Space::Register(registers - 1))
        } else {
            let place = Place::start(Space::Frame).after(frame);
            frame = frame.plus(extent);
            place
        };
        places.push((id, place));
    }
    places
}
