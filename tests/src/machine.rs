//! Executes programs: an interpreter that walks over the tree's expressions; statements are laid out flat first, so
//! that jumps are simple.

use crate::builtins::{BUILTINS, Param};
use crate::operators::{binary, unary};
use crate::tree::{Expr, Kind, Op, Printed, Program, Stmt, StmtKind, Var};
use crate::value::{Base, PLAIN, Type, Value, components, convert, print, start, type_name};

/// The number of an alarm.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Alarm(pub u32);

impl Alarm {
    /// Division by zero.
    pub const DIVISION: Alarm = Alarm(20001);
    /// A shift count out of range.
    pub const SHIFT: Alarm = Alarm(20002);
    /// An index out of range.
    pub const INDEX: Alarm = Alarm(20003);
    /// An argument out of range.
    pub const DOMAIN: Alarm = Alarm(20004);
}

/// Why a program ends early.
#[derive(Clone, PartialEq, Eq, Debug)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Stop {
    Alarm {
        number: u32,
        module: usize,
        line: u32,
    },
    Exit,
    /// It takes too many steps to be of use.
    Tired,
}

/// The variables of a running function.
#[derive(Clone, Debug)]
#[expect(missing_docs, reason = "the names say it")]
pub struct Frame {
    pub locals: Vec<Value>,
    pub module: usize,
}

/// What a running program has.
#[derive(Clone, Debug)]
#[expect(missing_docs, reason = "the names say it")]
pub struct Machine<'p> {
    program: &'p Program,
    codes: Vec<Option<std::rc::Rc<Code<'p>>>>,
    pub globals: Vec<Value>,
    pub out: Vec<u8>,
    /// The steps that are left.
    pub steps: u64,
    line: u32,
}

/// Bytes of a string beyond which a program is of no use.
const LONGEST: usize = 1000;

/// A place in a variable: the variable, and the numbers of components and elements.
type Place = (Var, Vec<usize>);

impl<'p> Machine<'p> {
    /// A machine whose globals have their first values.
    pub fn new(program: &'p Program, steps: u64) -> Result<Self, Stop> {
        let globals = program.globals.iter().map(|global| start(global.variable.ty)).collect();
        let codes = vec![None; program.funcs.len()];
        let mut machine = Self { program, codes, globals, out: Vec::new(), steps, line: 0 };
        for (at, global) in program.globals.iter().enumerate() {
            machine.line = global.line;
            if let Some(first) = &global.first {
                let mut frame = Frame { locals: Vec::new(), module: global.module };
                let value = machine.eval(first, &mut frame)?;
                machine.globals[at] = convert(value, global.variable.ty.base);
            }
        }
        Ok(machine)
    }

    /// Runs `main`, the last function of the program.
    pub fn main(&mut self) -> Result<(), Stop> {
        match self.call(self.program.funcs.len() - 1, Vec::new()) {
            Ok(_) | Err(Stop::Exit) => Ok(()),
            Err(stop) => Err(stop),
        }
    }

    fn call(&mut self, func: usize, args: Vec<Value>) -> Result<Value, Stop> {
        let code = match &self.codes[func] {
            Some(code) => code.clone(),
            None => {
                let code = std::rc::Rc::new(Code::new(&self.program.funcs[func].body));
                self.codes[func] = Some(code.clone());
                code
            }
        };
        let func = &self.program.funcs[func];
        let mut locals = args;
        for variable in &func.locals[locals.len()..] {
            locals.push(variable.value.clone().unwrap_or_else(|| start(variable.ty)));
        }
        let line = self.line;
        let value = self.run(&code, &mut Frame { locals, module: func.module }, func.result)?;
        self.line = line;
        Ok(value)
    }

    fn run(&mut self, code: &Code<'p>, frame: &mut Frame, result: Base) -> Result<Value, Stop> {
        let mut at = 0;
        while let Some(step) = code.steps.get(at) {
            self.tire()?;
            at += 1;
            match step {
                Step::Do(stmt) => self.execute(stmt, frame)?,
                Step::Jump(mark) => at = code.marks[*mark],
                Step::Test(condition, line, wanted, mark) => {
                    self.line = *line;
                    if self.truth(condition, frame)? == *wanted {
                        at = code.marks[*mark];
                    }
                }
                Step::Goto(mark, fresh) => {
                    for (local, ty) in fresh {
                        frame.locals[*local] = start(*ty);
                    }
                    at = code.marks[*mark];
                }
                Step::Switch(value, line, cases, end) => {
                    self.line = *line;
                    let base = value.ty.base;
                    let value = self.eval(value, frame)?;
                    let mut target = *end;
                    for (case, mark) in cases {
                        match case {
                            Some(case) if convert(case.constant.clone().unwrap(), base) == value => {
                                target = *mark;
                                break;
                            }
                            Some(_) => {}
                            None => target = *mark,
                        }
                    }
                    at = code.marks[target];
                }
                Step::Return(value, line) => {
                    self.line = *line;
                    return Ok(match value {
                        Some(value) => convert(self.eval(value, frame)?, result),
                        None => Value::Void,
                    });
                }
            }
        }
        Ok(start(Type::one(result)))
    }

    fn tire(&mut self) -> Result<(), Stop> {
        self.steps = self.steps.checked_sub(1).ok_or(Stop::Tired)?;
        Ok(())
    }

    /// Executes a statement that has no statements inside.
    pub fn execute(&mut self, stmt: &Stmt, frame: &mut Frame) -> Result<(), Stop> {
        self.line = stmt.line;
        match &stmt.kind {
            StmtKind::Declare(variables) => {
                for variable in variables {
                    let value = match &variable.first {
                        Some(first) => convert(self.eval(first, frame)?, variable.ty.base),
                        None => start(variable.ty),
                    };
                    if frame.locals.len() <= variable.local {
                        frame.locals.resize(variable.local + 1, Value::Void);
                    }
                    frame.locals[variable.local] = value;
                }
            }
            StmtKind::Expr(expr) => {
                self.eval(expr, frame)?;
            }
            StmtKind::Print(args) => self.print(args, frame)?,
            StmtKind::Wait(seconds) => {
                self.eval(seconds, frame)?;
            }
            StmtKind::WaitUntil(condition) => {
                assert!(self.truth(condition, frame)?, "a program waits for ever");
            }
            StmtKind::Exit => return Err(Stop::Exit),
            other => panic!("{other:?} is not simple"),
        }
        Ok(())
    }

    fn print(&mut self, args: &[Printed], frame: &mut Frame) -> Result<(), Stop> {
        let mut out = Vec::new();
        let mut style = PLAIN;
        for arg in args {
            match arg {
                Printed::Value(expr) => print(&self.eval(expr, frame)?, style, &mut out),
                Printed::Hex => style.hex = Some(true),
                Printed::Dec => style.hex = Some(false),
                Printed::Endl => out.push(b'\n'),
                Printed::Precision(digits) => match self.eval(digits, frame)? {
                    Value::Int(digits) if digits > 0 => style.digits = digits as usize,
                    other => panic!("no precision: {other:?}"),
                },
            }
        }
        if out.last() != Some(&b'\n') {
            out.push(b'\n');
        }
        self.out.extend(out);
        Ok(())
    }

    fn truth(&mut self, expr: &Expr, frame: &mut Frame) -> Result<bool, Stop> {
        let value = self.eval(expr, frame)?;
        Ok(convert(value, Base::Bool) == Value::Bool(true))
    }

    fn number(&mut self, expr: &Expr, frame: &mut Frame) -> Result<i32, Stop> {
        match convert(self.eval(expr, frame)?, Base::Int) {
            Value::Int(number) => Ok(number),
            other => panic!("{other:?} is not an int"),
        }
    }

    fn alarm(&self, alarm: Alarm, frame: &Frame) -> Stop {
        Stop::Alarm { number: alarm.0, module: frame.module, line: self.line }
    }

    fn value(&self, var: Var, frame: &Frame) -> Value {
        match var {
            Var::Local(local) => frame.locals[local].clone(),
            Var::Global(global) => self.globals[global].clone(),
        }
    }

    fn is_place(expr: &Expr) -> bool {
        match &expr.kind {
            Kind::Var { .. } => true,
            Kind::Index(inner, _) | Kind::Component(inner, _) => Self::is_place(inner),
            _ => false,
        }
    }

    fn place(&mut self, expr: &Expr, frame: &mut Frame) -> Result<Place, Stop> {
        match &expr.kind {
            Kind::Var { var, .. } => Ok((*var, Vec::new())),
            Kind::Component(inner, number) => {
                let (var, mut path) = self.place(inner, frame)?;
                path.push(*number);
                Ok((var, path))
            }
            Kind::Index(inner, indices) => {
                let (var, mut path) = self.place(inner, frame)?;
                let mut numbers = Vec::new();
                for index in indices {
                    numbers.push(self.number(index, frame)?);
                }
                let mut flat = 0;
                for (number, size) in numbers.into_iter().zip(inner.ty.sizes) {
                    if number < 0 || number as usize >= size {
                        return Err(self.alarm(Alarm::INDEX, frame));
                    }
                    flat = flat * size + number as usize;
                }
                path.push(flat);
                Ok((var, path))
            }
            other => panic!("{other:?} is no place"),
        }
    }

    fn at<'a>(&'a mut self, place: &Place, frame: &'a mut Frame) -> &'a mut Value {
        let mut value = match place.0 {
            Var::Local(local) => &mut frame.locals[local],
            Var::Global(global) => &mut self.globals[global],
        };
        for number in &place.1 {
            value = match value {
                Value::Struct(_, parts) => &mut parts[*number],
                Value::Array(elements, _) => &mut elements[*number],
                other => panic!("{other:?} has no parts"),
            };
        }
        value
    }

    /// The value of an expression, of the expression's own type.
    pub fn eval(&mut self, expr: &Expr, frame: &mut Frame) -> Result<Value, Stop> {
        match &expr.kind {
            Kind::Literal(value, _) => Ok(value.clone()),
            Kind::Constant { number, at, .. } => Ok(Value::Enum(*number, *at)),
            Kind::Var { var, .. } => Ok(self.value(*var, frame)),
            Kind::Index(..) | Kind::Component(..) if Self::is_place(expr) => {
                let place = self.place(expr, frame)?;
                Ok(self.at(&place, frame).clone())
            }
            Kind::Component(inner, number) => match self.eval(inner, frame)? {
                Value::Struct(_, mut parts) => Ok(parts.swap_remove(*number)),
                other => panic!("{other:?} has no components"),
            },
            Kind::Index(..) => panic!("only variables have elements"),
            Kind::Paren(inner) => self.eval(inner, frame),
            Kind::Unary(op, inner) => {
                let (_, base) = crate::operators::typed_unary(*op, inner).unwrap();
                Ok(unary(*op, convert(self.eval(inner, frame)?, base)))
            }
            Kind::Binary { op: Op::And, sides, .. } => {
                Ok(Value::Bool(self.truth(&sides.0, frame)? && self.truth(&sides.1, frame)?))
            }
            Kind::Binary { op: Op::Or, sides, .. } => {
                Ok(Value::Bool(self.truth(&sides.0, frame)? || self.truth(&sides.1, frame)?))
            }
            Kind::Binary { op, sides, common } => {
                let left = self.eval(&sides.0, frame)?;
                let right = self.eval(&sides.1, frame)?;
                self.operate(*op, left, right, *common, frame)
            }
            Kind::Assign { op, sides } => self.assign(*op, sides, frame),
            Kind::Step { place, up, before } => {
                let place = self.place(place, frame)?;
                let old = self.at(&place, frame).clone();
                let step = if *up { 1 } else { -1 };
                let new = match old {
                    Value::Int(x) => Value::Int(x.wrapping_add(step)),
                    Value::Uint(x) => Value::Uint(x.wrapping_add_signed(step)),
                    Value::Byte(x) => Value::Byte(x.wrapping_add_signed(step as i8)),
                    ref other => panic!("{other:?} does not count"),
                };
                *self.at(&place, frame) = new.clone();
                Ok(if *before { new } else { old })
            }
            Kind::Call(func, args) => {
                let called = &self.program.funcs[*func];
                let mut values = Vec::new();
                for (arg, param) in args.iter().zip(&called.locals) {
                    let value = self.eval(arg, frame)?;
                    values.push(convert(value, param.ty.base));
                }
                self.tire()?;
                self.call(*func, values)
            }
            Kind::Builtin(number, args) => self.builtin(*number, args, frame),
            Kind::List(parts) => self.list(expr.ty, parts, frame),
            Kind::Named(parts) => {
                let Base::Struct(number) = expr.ty.base else { panic!("only structures have components") };
                let Value::Struct(_, mut values) = start(expr.ty) else { panic!("a structure") };
                for (at, part) in parts {
                    values[*at] = convert(self.eval(part, frame)?, components(number)[*at].1);
                }
                Ok(Value::Struct(number, values))
            }
        }
    }

    fn operate(&mut self, op: Op, left: Value, right: Value, common: Base, frame: &Frame) -> Result<Value, Stop> {
        let (left, right) = match op {
            Op::Shl | Op::Shr => (convert(left, common), right),
            _ => (convert(left, common), convert(right, common)),
        };
        let value = binary(op, left, right).map_err(|alarm| self.alarm(alarm, frame))?;
        match value {
            // It doubles in every turn of some loop.
            Value::Str(text) if text.len() > LONGEST => Err(Stop::Tired),
            value => Ok(value),
        }
    }

    fn assign(&mut self, op: Option<(Op, Base)>, sides: &(Expr, Expr), frame: &mut Frame) -> Result<Value, Stop> {
        let place = self.place(&sides.0, frame)?;
        let value = match op {
            None => self.eval(&sides.1, frame)?,
            Some((op, common)) => {
                let old = self.at(&place, frame).clone();
                let right = self.eval(&sides.1, frame)?;
                self.operate(op, old, right, common, frame)?
            }
        };
        let value = convert(value, sides.0.ty.base);
        *self.at(&place, frame) = value.clone();
        Ok(value)
    }

    fn builtin(&mut self, number: usize, args: &[Expr], frame: &mut Frame) -> Result<Value, Stop> {
        let builtin = &BUILTINS[number];
        let mut values = Vec::new();
        let mut written = None;
        for (at, (arg, param)) in args.iter().zip(builtin.params).enumerate() {
            values.push(match param {
                Param::Like(base) | Param::Exactly(base) => convert(self.eval(arg, frame)?, *base),
                Param::Near(..) => convert(self.eval(arg, frame)?, Base::Int),
                // It is known beforehand, and nothing is evaluated.
                Param::Any if builtin.name == "typeof" => Value::Str(type_name(arg.ty).into_bytes()),
                Param::Any => self.eval(arg, frame)?,
                Param::Word(_) => Value::Void,
                Param::Out(_) => {
                    let place = self.place(arg, frame)?;
                    written = Some((at, place));
                    Value::Void
                }
            });
        }
        // What is written is a place: its value is read when all the others are known.
        if let Some((at, place)) = &written {
            values[*at] = self.at(place, frame).clone();
        }
        let result = (builtin.run)(&mut values).map_err(|alarm| self.alarm(alarm, frame))?;
        if matches!(&result, Value::Str(text) if text.len() > LONGEST) {
            return Err(Stop::Tired);
        }
        if let Some((at, place)) = written {
            *self.at(&place, frame) = values.swap_remove(at);
        }
        Ok(result)
    }

    /// A structure or array by position.
    fn list(&mut self, ty: Type, parts: &[Expr], frame: &mut Frame) -> Result<Value, Stop> {
        match start(ty) {
            Value::Struct(number, mut values) => {
                for (at, part) in parts.iter().enumerate() {
                    values[at] = convert(self.eval(part, frame)?, components(number)[at].1);
                }
                Ok(Value::Struct(number, values))
            }
            Value::Array(mut values, sizes) => {
                let mut at = 0;
                for part in parts {
                    match self.eval(part, frame)? {
                        Value::Array(row, _) => {
                            at = at / sizes[1] * sizes[1];
                            let count = row.len();
                            values.splice(at..at + count, row);
                            at += count;
                        }
                        value => {
                            values[at] = convert(value, ty.base);
                            at += 1;
                        }
                    }
                }
                Ok(Value::Array(values, sizes))
            }
            other => panic!("{other:?} has no parts"),
        }
    }
}

/// A function laid out flat.
#[derive(Debug)]
struct Code<'p> {
    steps: Vec<Step<'p>>,
    /// Where the marks stand.
    marks: Vec<usize>,
}

#[derive(Debug)]
enum Step<'p> {
    Do(&'p Stmt),
    Jump(usize),
    /// Goes to the mark where the condition is so.
    Test(&'p Expr, u32, bool, usize),
    /// Goes to the mark; these variables come into being by it.
    Goto(usize, Vec<(usize, Type)>),
    Switch(&'p Expr, u32, Vec<(Option<&'p Expr>, usize)>, usize),
    Return(Option<&'p Expr>, u32),
}

/// The variables that exist at a place.
type Live = Vec<(usize, Type)>;

/// Lays a body out.
struct Layout<'p> {
    code: Code<'p>,
    live: Live,
    /// Marks of `continue` and `break` of the loops around.
    loops: Vec<(usize, usize)>,
    labels: Vec<(usize, usize, Live)>,
    gotos: Vec<(usize, usize, Live)>,
}

impl<'p> Code<'p> {
    fn new(body: &'p [Stmt]) -> Self {
        let code = Code { steps: Vec::new(), marks: Vec::new() };
        let mut layout = Layout { code, live: Vec::new(), loops: Vec::new(), labels: Vec::new(), gotos: Vec::new() };
        layout.block(body);
        for (step, label, live) in &layout.gotos {
            let (_, mark, there) = layout.labels.iter().find(|(name, ..)| name == label).unwrap();
            let fresh = there.iter().filter(|local| !live.contains(local)).copied().collect();
            layout.code.steps[*step] = Step::Goto(*mark, fresh);
        }
        layout.code
    }
}

impl<'p> Layout<'p> {
    fn mark(&mut self) -> usize {
        self.code.marks.push(usize::MAX);
        self.code.marks.len() - 1
    }

    fn set(&mut self, mark: usize) {
        self.code.marks[mark] = self.code.steps.len();
    }

    fn set_here(&mut self) -> usize {
        let mark = self.mark();
        self.set(mark);
        mark
    }

    fn block(&mut self, body: &'p [Stmt]) {
        let outer = self.live.len();
        body.iter().for_each(|stmt| self.stmt(stmt));
        self.live.truncate(outer);
    }

    fn looped(&mut self, next: usize, end: usize, body: &'p [Stmt]) {
        self.loops.push((next, end));
        self.block(body);
        self.loops.pop();
    }

    #[expect(clippy::too_many_lines, reason = "one arm for each statement")]
    fn stmt(&mut self, stmt: &'p Stmt) {
        let line = stmt.line;
        match &stmt.kind {
            StmtKind::Declare(variables) => {
                self.code.steps.push(Step::Do(stmt));
                let changing = variables.iter().filter(|variable| !variable.fixed);
                self.live.extend(changing.map(|variable| (variable.local, variable.ty)));
            }
            StmtKind::If(branches) => {
                let end = self.mark();
                for branch in branches {
                    let next = self.mark();
                    if let Some(condition) = &branch.value {
                        self.code.steps.push(Step::Test(condition, branch.line, false, next));
                    }
                    self.block(&branch.body);
                    self.code.steps.push(Step::Jump(end));
                    self.set(next);
                }
                self.set(end);
            }
            StmtKind::CompactIf(condition, inner) => {
                let end = self.mark();
                self.code.steps.push(Step::Test(condition, line, false, end));
                self.stmt(inner);
                self.set(end);
            }
            StmtKind::While(condition, body) => {
                let next = self.set_here();
                let end = self.mark();
                self.code.steps.push(Step::Test(condition, line, false, end));
                self.looped(next, end, body);
                self.code.steps.push(Step::Jump(next));
                self.set(end);
            }
            StmtKind::Repeat(body, condition, until) => {
                let again = self.set_here();
                let (next, end) = (self.mark(), self.mark());
                self.looped(next, end, body);
                self.set(next);
                self.code.steps.push(Step::Test(condition, *until, false, again));
                self.set(end);
            }
            StmtKind::Loop(body) => {
                let next = self.set_here();
                let end = self.mark();
                self.looped(next, end, body);
                self.code.steps.push(Step::Jump(next));
                self.set(end);
            }
            StmtKind::For { first, condition, step, body } => {
                let outer = self.live.len();
                self.stmt(first);
                let again = self.set_here();
                let (next, end) = (self.mark(), self.mark());
                self.code.steps.push(Step::Test(condition, line, false, end));
                self.looped(next, end, body);
                self.set(next);
                // Only its value is of no use: a test that goes on either way.
                let after = self.mark();
                self.code.steps.push(Step::Test(step, line, true, after));
                self.set(after);
                self.code.steps.push(Step::Jump(again));
                self.set(end);
                self.live.truncate(outer);
            }
            StmtKind::Switch(value, cases) => {
                let end = self.mark();
                let targets: Vec<_> = cases.iter().map(|case| (case.value.as_ref(), self.mark())).collect();
                self.code.steps.push(Step::Switch(value, line, targets.clone(), end));
                for (case, (_, mark)) in cases.iter().zip(targets) {
                    self.set(mark);
                    self.block(&case.body);
                    self.code.steps.push(Step::Jump(end));
                }
                self.set(end);
            }
            StmtKind::Break => self.code.steps.push(Step::Jump(self.loops.last().unwrap().1)),
            StmtKind::Continue => self.code.steps.push(Step::Jump(self.loops.last().unwrap().0)),
            StmtKind::Goto(label) => {
                self.gotos.push((self.code.steps.len(), *label, self.live.clone()));
                self.code.steps.push(Step::Goto(usize::MAX, Vec::new()));
            }
            StmtKind::Label(label) => {
                let mark = self.set_here();
                self.labels.push((*label, mark, self.live.clone()));
            }
            StmtKind::Return(value) => self.code.steps.push(Step::Return(value.as_ref(), line)),
            _ => self.code.steps.push(Step::Do(stmt)),
        }
    }
}
