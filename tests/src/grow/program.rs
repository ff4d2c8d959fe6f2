//! Whole programs.

use super::constant::{int, literal};
use super::{BASES, Grower};
use crate::machine::{Frame, Machine, Stop};
use crate::tree::{Declared, Expr, Func, Global, Kind, Op, Printed, Program, Stmt, StmtKind, Variable};
use crate::value::{Base, STRUCTS, Type, Value, convert};

/// Steps after which a program is of no use.
const STEPS: u64 = 30_000;

/// What kind of programs to grow.
#[derive(Clone, Copy, Debug)]
pub struct Shape {
    /// Percent of divisors, indices and so on that nothing keeps in range.
    pub risk: usize,
    /// Whether functions jump.
    pub jumps: bool,
    /// Whether functions wait.
    pub waits: bool,
}

/// A program with everything; nothing where it would take too long.
pub fn program(seed: u64, shape: Shape) -> Option<Program> {
    let mut grower = Grower::new(seed);
    grower.risk = shape.risk;
    for _ in 0..1 + grower.random.below(3) {
        let name = grower.module_name();
        grower.program.modules.push(name);
    }
    grower.globals();
    for _ in 0..1 + grower.random.below(5) {
        grower.module = grower.random.below(grower.program.modules.len());
        grower.jumps = shape.jumps && grower.random.chance(50);
        grower.waits = shape.waits && grower.random.chance(30);
        grower.func();
    }
    grower.module = 0;
    grower.jumps = shape.jumps && grower.random.chance(50);
    grower.waits = shape.waits && grower.random.chance(50);
    grower.main();
    let program = grower.program;
    let tired = Machine::new(&program, STEPS).and_then(|mut machine| machine.main()) == Err(Stop::Tired);
    (!tired).then_some(program)
}

/// A program that prints many expressions and does not alarm, and small programs that do.
pub fn linear(seed: u64, prints: usize) -> (Program, Vec<Program>) {
    let mut grower = Grower::new(seed);
    grower.program.modules.push("expressions".into());
    grower.globals();
    grower.effects = 25;
    for _ in 0..8 {
        grower.helper();
    }
    let library = grower.program.clone();
    let mut machine = Machine::new(&library, u64::MAX).expect("first values are constants");
    let mut alarms = Vec::new();
    let mut parts = Vec::new();
    let mut printed = 0;
    while printed < prints {
        grower.begin(0, Base::Void);
        let mut frame = Frame { locals: Vec::new(), module: 0 };
        let mut body: Vec<Stmt> = Vec::new();
        for _ in 0..40 {
            let before = (grower.locals.clone(), grower.scopes.clone());
            let (trial_machine, trial_frame) = (machine.clone(), frame.clone());
            grower.risk = if grower.random.chance(20) { 20 } else { 0 };
            let stmt = match grower.random.below(10) {
                0 => grower.declaration(),
                1 => grower.simple(),
                _ => grower.printed_expr(),
            };
            match machine.execute(&stmt, &mut frame) {
                Ok(()) => {
                    printed += usize::from(matches!(stmt.kind, StmtKind::Print(_)));
                    body.push(stmt);
                }
                Err(stop) => {
                    // It becomes the end of a program of its own.
                    let mut wrong = body.clone();
                    if wrong.len() > 5 {
                        wrong.retain(|stmt| matches!(stmt.kind, StmtKind::Declare(_)));
                    }
                    wrong.push(stmt);
                    wrong.push(StmtKind::Print(vec![Printed::Value(int(0))]).into());
                    if stop != Stop::Tired {
                        let mut program = library.clone();
                        program.funcs.push(grower.finished("main".into(), wrong));
                        alarms.push(program);
                    }
                    (grower.locals, grower.scopes) = before;
                    (machine, frame) = (trial_machine, trial_frame);
                }
            }
        }
        let name = format!("part{}", parts.len());
        parts.push(grower.finished(name, body));
    }
    let mut program = library.clone();
    let mut calls: Vec<Stmt> = Vec::new();
    for part in parts {
        calls.push(StmtKind::Expr(Expr::one(Kind::Call(program.funcs.len(), Vec::new()), Base::Void)).into());
        program.funcs.push(part);
    }
    grower.begin(0, Base::Void);
    program.funcs.push(grower.finished("main".into(), calls));
    (program, alarms)
}

impl Grower {
    /// Global variables: one of every type at least.
    fn globals(&mut self) {
        let structs = (0..STRUCTS.len()).map(Base::Struct);
        let bases: Vec<Base> = BASES.into_iter().chain(structs).chain([Base::Enum(2)]).collect();
        for base in bases {
            self.global(Type::one(base), false);
        }
        for base in BASES {
            let sizes = [[4, 0], [8, 0], [2, 4], [3, 0]][self.random.below(4)];
            self.global(Type { base, sizes }, false);
        }
        self.global(Type { base: Base::Struct(0), sizes: [4, 0] }, false);
        for _ in 0..3 {
            let base = *self.random.pick(&BASES);
            self.global(Type::one(base), true);
        }
    }

    fn global(&mut self, ty: Type, constant: bool) {
        let module = self.random.below(self.program.modules.len());
        let name = self.global_name(module);
        let first = (constant || self.random.chance(70)).then(|| self.constant_of(ty));
        let value = first.as_ref().filter(|_| constant).and_then(|first| first.constant.clone());
        let value = value.map(|value| convert(value, ty.base));
        let variable = Variable { name, ty, constant, value };
        self.program.globals.push(Global { module, variable, first, line: 0 });
    }

    /// A first value that names nothing.
    fn constant_of(&mut self, ty: Type) -> Expr {
        if ty.is_array() {
            let count = 1 + self.random.below(ty.elements());
            let parts = (0..count).map(|_| self.constant_of(Type::one(ty.base))).collect();
            return Expr::new(Kind::List(parts), ty);
        }
        match ty.base {
            Base::Struct(number) => {
                let components = crate::value::components(number);
                let count = 1 + self.random.below(crate::value::positional(number));
                let parts = components[..count].iter().map(|part| self.constant_of(Type::one(part.1))).collect();
                Expr::new(Kind::List(parts), ty)
            }
            Base::Uint | Base::Byte => self.small(256),
            base => self.constant(base, 2),
        }
    }

    /// Begins a function.
    fn begin(&mut self, module: usize, result: Base) {
        self.module = module;
        self.result = result;
        self.locals.clear();
        self.scopes = vec![Vec::new()];
        self.labels.clear();
        self.promised.clear();
        self.guards.clear();
        self.loops = 0;
        self.depth = None;
    }

    fn finished(&mut self, name: String, body: Vec<Stmt>) -> Func {
        Func {
            name,
            module: self.module,
            result: self.result,
            params: 0,
            counted: false,
            locals: self.locals.clone(),
            labels: self.labels.clone(),
            body,
            line: 0,
        }
    }

    /// A small function without control flow but with side effects.
    fn helper(&mut self) {
        let result = match self.random.below(8) {
            0 => Base::Struct(self.random.below(STRUCTS.len())),
            _ => *self.random.pick(&BASES),
        };
        self.begin(0, result);
        let params = self.params();
        let mut body = vec![self.announced()];
        for _ in 0..self.random.below(3) {
            body.push(self.simple());
        }
        body.push(self.returned());
        let name = self.func_name(0);
        let func = Func { params, ..self.finished(name, body) };
        self.program.funcs.push(func);
    }

    /// Prints that the function is here, so that orders show.
    fn announced(&mut self) -> Stmt {
        let text = format!("f{}", self.program.funcs.len());
        let name = literal(Value::Str(text.clone().into()), format!("\"{text}\""), Base::Str);
        let mut args = vec![Printed::Value(name)];
        if self.random.chance(50) && !self.locals.is_empty() {
            args.push(Printed::Value(self.local(0)));
        }
        StmtKind::Print(args).into()
    }

    fn params(&mut self) -> usize {
        let count = self.random.below(4);
        for _ in 0..count {
            let name = self.local_name();
            let ty = match self.random.below(10) {
                0 => {
                    // Somewhere there is an array to pass.
                    let globals = self.program.globals.iter().map(|global| global.variable.ty);
                    let arrays: Vec<Type> = globals.filter(|ty| ty.is_array()).collect();
                    *self.random.pick(&arrays)
                }
                1 => Type::one(self.any_base()),
                _ => Type::one(*self.random.pick(&BASES)),
            };
            self.declare(name, ty);
        }
        count
    }

    /// `print expression`, perhaps with its type.
    fn printed_expr(&mut self) -> Stmt {
        let depth = 1 + self.random.below(4);
        let mut args = vec![Printed::Value(self.any_printable(depth))];
        if self.random.chance(30) {
            let typeof_ = crate::builtins::BUILTINS.iter().position(|builtin| builtin.name == "typeof").expect("there");
            let arg = self.any_printable(2);
            args.push(Printed::Value(Expr::one(Kind::Builtin(typeof_, vec![arg]), Base::Str)));
        }
        StmtKind::Print(args).into()
    }

    /// A function with everything.
    fn func(&mut self) {
        let module = self.module;
        let result = match self.random.below(6) {
            0 => Base::Void,
            1 => Base::Struct(self.random.below(STRUCTS.len())),
            _ => *self.random.pick(&BASES),
        };
        self.begin(module, result);
        let counted = self.random.chance(25);
        if counted {
            let name = self.local_name();
            let local = self.declare(name, Type::one(Base::Int));
            self.guards.push(local);
        }
        let params = self.params() + usize::from(counted);
        let mut body = Vec::new();
        if counted {
            let depth = self.local(0);
            let over = self.binary(Op::LessEqual, depth, int(0)).expect("ints");
            let back = self.returned();
            body.push(StmtKind::CompactIf(over, Box::new(back)).into());
        }
        if self.random.chance(70) {
            body.push(self.announced());
        }
        self.body(&mut body);
        if counted {
            self.recursion(params, &mut body);
        }
        if result != Base::Void && self.random.chance(90) {
            body.push(self.returned());
        }
        let name = self.func_name(module);
        let func = Func { params, counted, ..self.finished(name, body) };
        self.program.funcs.push(func);
    }

    /// A call of the function itself, with one less.
    fn recursion(&mut self, params: usize, body: &mut Vec<Stmt>) {
        let depth = self.local(0);
        let less = self.binary(Op::Sub, depth, int(1)).expect("ints");
        let mut args = vec![less];
        for local in 1..params {
            let ty = self.locals[local].ty;
            args.push(if ty.is_array() { self.local(local) } else { self.like(ty.base, 1) });
        }
        let result = self.result;
        let call = Expr::one(Kind::Call(self.program.funcs.len(), args), result);
        let stmt = match self.place(Type::one(result), true, 0) {
            Some(place) if result != Base::Void => {
                let name = self.local_name();
                let first = call;
                let local = self.declare(name, Type::one(result));
                let declared = Declared { local, ty: Type::one(result), first: Some(first), fixed: false };
                body.push(StmtKind::Declare(vec![declared]).into());
                let kind = Kind::Assign { op: None, sides: Box::new((place, self.local(local))) };
                StmtKind::Expr(Expr::one(kind, result))
            }
            _ => StmtKind::Expr(call),
        };
        body.push(stmt.into());
    }

    fn body(&mut self, body: &mut Vec<Stmt>) {
        if self.jumps {
            // A name that nothing else has, so that it can be named in every block.
            let local = self.declare("jumps".into(), Type::one(Base::Int));
            self.guards.insert(0, local);
            let declared = Declared { local, ty: Type::one(Base::Int), first: Some(int(0)), fixed: false };
            body.insert(0, StmtKind::Declare(vec![declared]).into());
        }
        self.room = 6 + self.random.below(30);
        for _ in 0..3 {
            body.extend(self.stmts(0));
        }
        self.keep_promises(body);
    }

    fn main(&mut self) {
        self.begin(0, Base::Void);
        let mut body = Vec::new();
        self.body(&mut body);
        // Whatever was not called yet, and what all variables have become.
        for func in 0..self.program.funcs.len() {
            if self.random.chance(60) {
                let call = self.call_of(func, 1);
                body.push(StmtKind::Expr(call).into());
            }
        }
        for global in 0..self.program.globals.len() {
            let hidden = self.visible().iter().any(|(var, hidden)| *var == crate::tree::Var::Global(global) && *hidden);
            let value = self.var(crate::tree::Var::Global(global), hidden);
            body.push(StmtKind::Print(vec![Printed::Value(value)]).into());
        }
        let main = self.finished("main".into(), body);
        self.program.funcs.push(main);
    }
}
