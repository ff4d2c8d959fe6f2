//! From the checked program to the code that the engine runs.
//!
//! Lowering and the emitter are two readers of one checked program. What decides when a program waits, which line an
//! alarm has or where the program pointer stands is no choice of theirs: it is a fact of `hir` and `effects`.
//!
//! Operands are evaluated from left to right. The number of a local variable is its register, so reading one copies
//! nothing; only where something to its right writes the variable, it is copied first.

mod aggregates;
mod body;
mod builtins;
mod calls;
mod conditions;
mod control_flow;
mod events;
mod goto;
mod loops;
mod numbers;
mod operators;
mod places;
mod statements;
mod tables;
mod texts;
mod variables;
mod waiting;
mod watching;

use crate::effects::{self, watched};
use crate::hir::{ExprKind, FuncId, GlobalId, ModuleId, Program};
use crate::visit;
use arl_code::{Code, ConstantValue, Extent, Function, HandleKind, Op, Place, Variable};
use arl_lang::catalog::Base;
use arl_lang::span::LineIndex;
use body::FunctionCode;
use events::PendingPiece;
use std::fmt;
use tables::{Tables, constant_word};

/// A program that needs more than the engine has.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct TooLarge {
    /// What is too large, as a part of a sentence.
    pub what: &'static str,
    /// The file.
    pub file: String,
    /// The line.
    pub line: u32,
}

impl fmt::Display for TooLarge {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}: {}", self.file, self.line, self.what)
    }
}

impl std::error::Error for TooLarge {}

/// The first operation of a function that nothing needs.
const NOT_LOWERED: u32 = u32::MAX;

/// What all functions of one lowering share.
struct Lowering<'p> {
    program: &'p Program,
    /// The positions of the lines of each module.
    lines: Vec<LineIndex>,
    /// For each function, whether it moves the program pointer.
    movers: Vec<bool>,
    /// Where the global variables are.
    globals: Vec<Place>,
    code: Code,
    tables: Tables,
    /// The conditions and actions of events that are yet to be lowered.
    pending: Vec<PendingPiece<'p>>,
    /// The first problem that was found.
    problem: Option<TooLarge>,
}

/// Makes the code of a program that has a `main`.
///
/// # Errors
/// [`TooLarge`]: a function has more variables than the engine's operations can name.
pub fn lower(program: &Program) -> Result<Code, TooLarge> {
    lowered(program, false)
}

/// As [`lower`], for a debugger: the code can be halted before each statement, and its variables are seen.
///
/// # Errors
/// As for [`lower`].
pub fn lower_watched(program: &mut Program) -> Result<Code, TooLarge> {
    watched::mark(program);
    lowered(program, true)
}

fn lowered(program: &Program, watched: bool) -> Result<Code, TooLarge> {
    let main = program.main.map_or(0, |FuncId(main)| main);
    let mut lowering = Lowering::new(program, main);
    lowering.code.watched = watched;
    lowering.place_globals();
    for func in &program.funcs {
        let file = u16::try_from(func.module.0).unwrap_or(u16::MAX);
        let name = func.name.as_str().into();
        let function = Function { name, file, start: NOT_LOWERED, frame: Extent::default(), boxes: 0 };
        lowering.code.functions.push(function);
    }
    let reached = effects::reached(program);
    for (at, func) in program.funcs.iter().enumerate() {
        if reached.get(at) == Some(&true) || at == main as usize {
            lowering.function(at, func);
            lowering.pieces();
        }
    }
    lowering.first_values();
    lowering.pieces();
    lowering.end_of_unused();
    match lowering.problem {
        Some(problem) => Err(problem),
        None => Ok(lowering.code),
    }
}

impl<'p> Lowering<'p> {
    fn new(program: &'p Program, main: u32) -> Self {
        let code = Code {
            family: program.family,
            files: program.modules.iter().map(|module| module.file.as_str().into()).collect(),
            ops: Vec::new(),
            functions: Vec::new(),
            main,
            first_values: Vec::new(),
            calls: Vec::new(),
            sites: Vec::new(),
            events: Vec::new(),
            transfers: Vec::new(),
            boxes: Vec::new(),
            entries: Vec::new(),
            types: Vec::new(),
            words: Vec::new(),
            texts: Vec::new(),
            globals: Extent::default(),
            handles: Vec::new(),
            variables: Vec::new(),
            watched: false,
            locals: Vec::new(),
            connects: false,
            serves_modbus: false,
        };
        Self {
            program,
            lines: program.modules.iter().map(|module| LineIndex::new(&module.source)).collect(),
            movers: effects::pointer_movers(program),
            globals: Vec::new(),
            code,
            tables: Tables::default(),
            pending: Vec::new(),
            problem: None,
        }
    }

    /// Gives each global variable its place. Constants with a known value have none: they are written out where they
    /// are used.
    fn place_globals(&mut self) {
        let family = self.program.family;
        for global in &self.program.globals {
            let mut place = Place::NOWHERE;
            if global.value.is_none() {
                place = Place::start(arl_code::Space::Global).after(self.code.globals);
                let count = u32::try_from(global.ty.len()).unwrap_or(u32::MAX);
                self.code.globals = self.code.globals.plus(Extent::of(global.ty.base, family).times(count));
                if let Base::Handle(handle) = global.ty.base {
                    self.code.handles.extend(std::iter::repeat_n(HandleKind::from(handle), count as usize));
                }
            }
            self.globals.push(place);
            let value = global.value.as_ref().map(|value| match value {
                crate::hir::Value::String(text) => ConstantValue::Text((**text).into()),
                value => ConstantValue::Word(constant_word(value).unwrap_or_default()),
            });
            self.code.variables.push(Variable {
                name: global.name.as_str().into(),
                file: u16::try_from(global.module.0).unwrap_or(u16::MAX),
                ty: tables::value_type(global.ty),
                place,
                value,
                teachable: global.teachable,
            });
        }
    }

    fn function(&mut self, at: usize, func: &'p crate::hir::Func) {
        let start = self.code.ops.len() as u32;
        let mut body = FunctionCode::of_function(self, func);
        body.function(func);
        let (frame, boxes) = body.space();
        if let Some(function) = self.code.functions.get_mut(at) {
            (function.start, function.frame, function.boxes) = (start, frame, boxes);
        }
        let mut see = |expr: &crate::hir::Expr| {
            if let ExprKind::Builtin(builtin) = &expr.kind {
                self.code.connects |= builtin.entry.connects;
                self.code.serves_modbus |= builtin.is_served();
            }
        };
        func.body.iter().for_each(|stmt| visit::exprs_in_stmt(stmt, &mut see));
    }

    /// Functions that nothing needs only return.
    fn end_of_unused(&mut self) {
        let end = self.code.ops.len() as u32;
        self.code.ops.push(Op::Return);
        let unused = self.code.functions.iter_mut().filter(|function| function.start == NOT_LOWERED);
        unused.for_each(|function| function.start = end);
    }

    /// The functions that give the global variables their first values, module by module, each in the order of its
    /// declarations.
    fn first_values(&mut self) {
        let program = self.program;
        let mut modules: Vec<ModuleId> = Vec::new();
        for global in &program.globals {
            if !modules.contains(&global.module) {
                modules.push(global.module);
            }
        }
        for module in modules {
            let start = self.code.ops.len() as u32;
            let mut body = FunctionCode::outside(self, module);
            for (at, global) in program.globals.iter().enumerate().filter(|(_, global)| global.module == module) {
                body.first_value(GlobalId(at as u32), global);
            }
            body.op(Op::Return);
            let (frame, boxes) = body.space();
            let file = u16::try_from(module.0).unwrap_or(u16::MAX);
            self.code.first_values.push(self.code.functions.len() as u32);
            self.code.functions.push(Function { name: "".into(), file, start, frame, boxes });
        }
        let inits = program.globals.iter().filter_map(|global| global.init.as_ref());
        inits.for_each(|init| {
            visit::exprs(init, &mut |expr| {
                if let ExprKind::Builtin(builtin) = &expr.kind {
                    self.code.connects |= builtin.entry.connects;
                    self.code.serves_modbus |= builtin.is_served();
                }
            });
        });
    }
}
