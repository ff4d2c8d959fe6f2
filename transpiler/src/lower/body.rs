//! The state while one function is lowered: its registers and frame, and the operations that are yet to be completed.

use super::control_flow::Surroundings;
use super::{Lowering, TooLarge};
use crate::effects::facts::{self, FactScope, Facts};
use crate::effects::ranges::Ranges;
use crate::hir::{Expr, Func, LocalId, ModuleId, Type, Value};
use arl_code::{Address, Extent, Op, Place, Reg, Space};
use arl_lang::catalog::Family;
use arl_lang::span::Span;
use std::collections::HashMap;

/// From this register on, numbers that a local variable or a temporary would keep for long go to the frame.
const LAST_FOR_LOCALS: u32 = 160;

/// How much of a frame is in use.
#[derive(Clone, Copy, PartialEq, Default, Debug)]
pub(super) struct Used {
    pub(super) registers: u32,
    pub(super) frame: Extent,
    pub(super) boxes: u32,
}

/// Lowers the statements of one function, a piece of an event, or first values.
pub(super) struct FunctionCode<'p, 'l> {
    pub(super) lowering: &'l mut Lowering<'p>,
    pub(super) func: Option<&'p Func>,
    pub(super) module: ModuleId,
    /// The values of the variables that loops count.
    pub(super) ranges: Ranges,
    /// Where the local variables are.
    pub(super) locals: HashMap<LocalId, Place>,
    /// The numbers of the variables that a debugger sees.
    pub(super) shown: HashMap<LocalId, u32>,
    pub(super) used: Used,
    most: Used,
    pub(super) flow: Surroundings,
    /// The line that alarms are reported on.
    pub(super) line: u32,
}

impl<'p, 'l> FunctionCode<'p, 'l> {
    /// For a function.
    pub(super) fn of_function(lowering: &'l mut Lowering<'p>, func: &'p Func) -> Self {
        let mut body = Self::outside(lowering, func.module);
        body.func = Some(func);
        body.ranges = Ranges::of_function(func);
        body
    }

    /// For expressions outside functions.
    pub(super) fn outside(lowering: &'l mut Lowering<'p>, module: ModuleId) -> Self {
        Self {
            lowering,
            func: None,
            module,
            ranges: Ranges::default(),
            locals: HashMap::new(),
            shown: HashMap::new(),
            used: Used::default(),
            most: Used::default(),
            flow: Surroundings::default(),
            line: 0,
        }
    }

    /// The space that the frame needs.
    pub(super) fn space(&self) -> (Extent, u16) {
        (self.most.frame, u16::try_from(self.most.boxes).unwrap_or(u16::MAX))
    }

    /// How many clocks and connections the frame has had at most so far.
    pub(super) fn most_handles(&self) -> u32 {
        self.most.frame.handles
    }

    pub(super) fn family(&self) -> Family {
        self.lowering.program.family
    }

    /// Notes that the program is too large for the engine; the code that is made from here on is not used.
    pub(super) fn refuse(&mut self, what: &'static str) {
        if self.lowering.problem.is_none() {
            let modules = &self.lowering.program.modules;
            let file = modules.get(self.module.0 as usize).map_or_else(String::new, |module| module.file.clone());
            self.lowering.problem = Some(TooLarge { what, file, line: self.line });
        }
    }

    // Operations.

    /// Appends an operation; returns its address.
    pub(super) fn op(&mut self, op: Op) -> Address {
        self.lowering.code.ops.push(op);
        self.here() - 1
    }

    /// The address of the next operation.
    pub(super) fn here(&self) -> Address {
        self.lowering.code.ops.len() as Address
    }

    /// Makes a jump lead to an address.
    pub(super) fn lead(&mut self, jump: Address, target: Address) {
        use Op::*;
        match self.lowering.code.ops.get_mut(jump as usize) {
            Some(
                Jump { to }
                | JumpIf { to, .. }
                | JumpUnless { to, .. }
                | JumpLess { to, .. }
                | JumpLessEqual { to, .. }
                | JumpEqual { to, .. }
                | JumpNotEqual { to, .. }
                | JumpLessSmall { to, .. }
                | JumpNotLessSmall { to, .. }
                | JumpEqualSmall { to, .. }
                | JumpNotEqualSmall { to, .. }
                | StepLess { to, .. }
                | StepLessSmall { to, .. }
                | JumpCompare { to, .. },
            ) => *to = target,
            other => debug_assert!(false, "no jump at {jump}: {other:?}"),
        }
    }

    /// Makes jumps lead here.
    pub(super) fn lead_here(&mut self, jumps: impl IntoIterator<Item = Address>) {
        let here = self.here();
        jumps.into_iter().for_each(|jump| self.lead(jump, here));
    }

    // Registers and frame.

    /// A new register.
    pub(super) fn register(&mut self) -> Reg {
        let register = self.used.registers;
        self.used.registers += 1;
        self.note_used();
        Reg::try_from(register).unwrap_or_else(|_| {
            self.refuse("the expression or the function is too large for the engine");
            Reg::MAX
        })
    }

    /// The wanted register, or a new one.
    pub(super) fn register_or(&mut self, wanted: Option<Reg>) -> Reg {
        wanted.unwrap_or_else(|| self.register())
    }

    /// New space in the frame.
    pub(super) fn space_for(&mut self, extent: Extent) -> Place {
        let place = Place::start(Space::Frame).after(self.used.frame);
        self.used.frame = self.used.frame.plus(extent);
        self.note_used();
        place
    }

    /// New space in the frame for a value of a type.
    pub(super) fn space_of(&mut self, ty: Type) -> Place {
        self.space_for(self.extent(ty))
    }

    /// A new string of the frame.
    pub(super) fn text_slot(&mut self) -> u16 {
        let at = self.space_for(Extent { texts: 1, ..Extent::default() }).text;
        self.slot_number(at)
    }

    pub(super) fn slot_number(&mut self, at: u32) -> u16 {
        u16::try_from(at).unwrap_or_else(|_| {
            self.refuse("the function has more strings than the engine can name");
            u16::MAX
        })
    }

    /// A new box.
    pub(super) fn new_box(&mut self) -> u16 {
        let number = self.used.boxes;
        self.used.boxes += 1;
        self.note_used();
        u16::try_from(number).unwrap_or_else(|_| {
            self.refuse("the function has more variables that events or a debugger see than the engine can name");
            u16::MAX
        })
    }

    pub(super) fn note_used(&mut self) {
        self.most = Used {
            registers: self.most.registers.max(self.used.registers),
            frame: self.most.frame.max(self.used.frame),
            boxes: self.most.boxes.max(self.used.boxes),
        };
    }

    /// Whether there are registers for local variables left.
    pub(super) fn has_registers_for_locals(&self) -> bool {
        self.used.registers < LAST_FOR_LOCALS
    }

    /// Runs `work`, then gives back the registers and the space that it took.
    pub(super) fn passing<T>(&mut self, work: impl FnOnce(&mut Self) -> T) -> T {
        let used = self.used;
        let result = work(self);
        self.used = used;
        result
    }

    /// The extent of a value of a type.
    pub(super) fn extent(&self, ty: Type) -> Extent {
        let count = u32::try_from(ty.len()).unwrap_or(u32::MAX);
        Extent::of(ty.base, self.family()).times(count)
    }

    // Facts.

    /// The scope used to determine facts.
    pub(super) fn scope(&self) -> FactScope<'_> {
        FactScope { program: self.lowering.program, func: self.func, ranges: &self.ranges }
    }

    pub(super) fn facts(&self, expr: &Expr) -> Facts {
        facts::of_expr(self.scope(), expr)
    }

    /// The value of a constant expression.
    pub(super) fn constant(&self, expr: &'p Expr) -> Option<&'p Value> {
        facts::constant(self.lowering.program, self.func, expr)
    }

    /// The type of a local variable.
    pub(super) fn local_type(&self, id: LocalId) -> Type {
        let local = self.func.and_then(|func| func.locals.get(id.0 as usize));
        local.map_or(Type::scalar(arl_lang::catalog::Base::Void), |local| local.ty)
    }

    /// Whether events see a local variable.
    pub(super) fn is_shared(&self, id: LocalId) -> bool {
        self.func.and_then(|func| func.locals.get(id.0 as usize)).is_some_and(|local| local.shared)
    }

    // Lines.

    /// The line of a position.
    pub(super) fn line_of(&self, span: Span) -> u32 {
        self.lowering.lines.get(self.module.0 as usize).map_or(0, |lines| lines.line(span.start))
    }

    /// Sets the line of the alarms.
    pub(super) fn stand_at(&mut self, span: Span) {
        self.line = self.line_of(span);
    }

    /// Sets the program pointer if evaluating the expression needs it.
    pub(super) fn pointer(&mut self, expr: &Expr) {
        if crate::effects::pointer::is_needed(self.scope(), &self.lowering.movers, expr) {
            let line = self.line;
            self.op(Op::Line { line });
        }
    }
}
