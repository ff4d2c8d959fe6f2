//! Writes programs as ARL, and notes on which line everything stands.

use crate::builtins::{BUILTINS, Param};
use crate::random::Random;
use crate::tree::{Branch, Declared, Expr, Func, Kind, Printed, Program, Stmt, StmtKind, Unary, Var, Variable};
use crate::value::{Base, ENUMS, base_name, components};

/// The files of a program: name and text, the main file first.
pub fn write(program: &mut Program, random: &mut Random) -> Vec<(String, String)> {
    let mut globals = std::mem::take(&mut program.globals);
    let mut funcs = std::mem::take(&mut program.funcs);
    let mut files = Vec::new();
    let names = Names {
        modules: program.modules.clone(),
        globals: globals.iter().map(|global| (global.module, global.variable.name.clone())).collect(),
        funcs: funcs.iter().map(|func| (func.module, func.name.clone())).collect(),
    };
    for (module, name) in program.modules.iter().enumerate() {
        let mut writer =
            Writer { names: &names, random, module, locals: Vec::new(), labels: Vec::new(), lines: vec![] };
        for other in 0..names.modules.len() {
            if other != module && writer.random.chance(30) {
                writer.line(0, format!("import \"{}.arl\"", names.modules[other]));
            }
        }
        for global in globals.iter_mut().filter(|global| global.module == module) {
            let mut text = writer.declaration(&global.variable);
            if let Some(first) = &global.first {
                text += " = ";
                text += &writer.value(first);
            }
            global.line = writer.line(0, text);
        }
        for func in funcs.iter_mut().filter(|func| func.module == module) {
            writer.func(func);
        }
        files.push((format!("{name}.arl"), writer.lines.join("\n") + "\n"));
    }
    (program.globals, program.funcs) = (globals, funcs);
    files
}

struct Names {
    modules: Vec<String>,
    globals: Vec<(usize, String)>,
    funcs: Vec<(usize, String)>,
}

struct Writer<'a> {
    names: &'a Names,
    random: &'a mut Random,
    module: usize,
    locals: Vec<Variable>,
    labels: Vec<String>,
    lines: Vec<String>,
}

impl Writer<'_> {
    /// Adds a line; its number.
    fn line(&mut self, depth: usize, text: String) -> u32 {
        const REMARKS: [&str; 4] = [" // a remark", " /* here */", "   // \"quoted\" { ( \\n */", "\t"];
        let remark = if self.random.chance(4) { *self.random.pick(&REMARKS) } else { "" };
        if self.random.chance(2) {
            self.lines.push(if self.random.chance(50) { String::new() } else { "// if(x) /* \"".into() });
        }
        self.lines.push(format!("{}{text}{remark}", "    ".repeat(depth)));
        self.lines.len() as u32
    }

    /// A word, now and then in another case.
    fn word(&mut self, word: &str) -> String {
        match self.random.below(60) {
            0 => word.to_ascii_uppercase(),
            1 => word.to_ascii_lowercase(),
            2 => word.chars().take(1).map(|c| c.to_ascii_uppercase()).chain(word.chars().skip(1)).collect(),
            _ => word.to_owned(),
        }
    }

    fn declaration(&mut self, variable: &Variable) -> String {
        let constant = if variable.constant { self.word("const") + " " } else { String::new() };
        let ty = self.word(base_name(variable.ty.base));
        format!("{constant}{ty} {}", self.declared(variable))
    }

    fn declared(&mut self, variable: &Variable) -> String {
        let sizes = variable.ty.sizes.into_iter().filter(|size| *size > 0);
        variable.name.clone() + &sizes.map(|size| format!("[{size}]")).collect::<String>()
    }

    fn func(&mut self, func: &mut Func) {
        self.locals = func.locals.clone();
        self.labels = func.labels.clone();
        let params: Vec<Variable> = func.locals[..func.params].to_vec();
        let params: Vec<String> = params.iter().map(|param| self.declaration(param)).collect();
        let keyword = self.word("func");
        let result = self.word(base_name(func.result));
        func.line = self.line(0, format!("{keyword} {result} {}({})", func.name, params.join(", ")));
        self.block(1, &mut func.body);
        let end = self.word("endfunc");
        self.line(0, end);
        self.lines.push(String::new());
    }

    fn block(&mut self, depth: usize, body: &mut [Stmt]) {
        for stmt in body {
            self.stmt(depth, stmt);
        }
    }

    fn words(&mut self, depth: usize, words: &str) -> u32 {
        let text = self.word(words);
        self.line(depth, text)
    }

    fn stmt(&mut self, depth: usize, stmt: &mut Stmt) {
        if let Some(text) = self.simple(&stmt.kind) {
            stmt.line = self.line(depth, text);
            return;
        }
        match &mut stmt.kind {
            StmtKind::If(branches) => {
                for (at, branch) in branches.iter_mut().enumerate() {
                    let keyword = match (&branch.value, at) {
                        (Some(_), 0) => "if",
                        (Some(_), _) => "elseif",
                        (None, _) => "else",
                    };
                    let condition = branch.value.as_ref().map(|value| format!("({})", self.expr(value, 13)));
                    let text = self.word(keyword) + &condition.unwrap_or_default();
                    branch.line = self.line(depth, text);
                    self.block(depth + 1, &mut branch.body);
                }
                self.words(depth, "endif");
            }
            StmtKind::CompactIf(condition, inner) => {
                let condition = self.expr(condition, 13);
                let text = self.simple(&inner.kind).expect("only simple statements are compact");
                stmt.line = self.line(depth, format!("if({condition}) {text}"));
                inner.line = stmt.line;
            }
            StmtKind::While(condition, body) => {
                let text = format!("{}({})", self.word("while"), self.expr(condition, 13));
                stmt.line = self.line(depth, text);
                self.block(depth + 1, body);
                self.words(depth, "endwhile");
            }
            StmtKind::Repeat(body, condition, until) => {
                stmt.line = self.words(depth, "repeat");
                self.block(depth + 1, body);
                let text = format!("{}({})", self.word("until"), self.expr(condition, 13));
                *until = self.line(depth, text);
            }
            StmtKind::Loop(body) => {
                stmt.line = self.words(depth, "loop");
                self.block(depth + 1, body);
                self.words(depth, "endloop");
            }
            StmtKind::For { first, condition, step, body } => {
                let text = self.simple(&first.kind).expect("a for begins simply");
                let text = format!("for({text}; {}; {})", self.expr(condition, 13), self.expr(step, 13));
                stmt.line = self.line(depth, text);
                first.line = stmt.line;
                self.block(depth + 1, body);
                self.words(depth, "endfor");
            }
            StmtKind::Switch(value, cases) => {
                let text = format!("{}({})", self.word("switch"), self.expr(value, 13));
                stmt.line = self.line(depth, text);
                for Branch { value, body, line } in cases {
                    let text = match value {
                        Some(value) => format!("{} {}:", self.word("case"), self.expr(value, 12)),
                        None => self.word("default") + ":",
                    };
                    *line = self.line(depth, text);
                    self.block(depth + 1, body);
                }
                self.words(depth, "endswitch");
            }
            other => panic!("{other:?} has been written"),
        }
    }

    /// A statement of one line.
    fn simple(&mut self, stmt: &StmtKind) -> Option<String> {
        Some(match stmt {
            StmtKind::Declare(variables) => self.declare(variables),
            StmtKind::Expr(expr) => self.expr(expr, 13),
            StmtKind::Print(args) => {
                let args: Vec<String> = args.iter().map(|arg| self.printed(arg)).collect();
                let comma = if self.random.chance(50) { "," } else { ", " };
                format!("{} {}", self.word("print"), args.join(comma))
            }
            StmtKind::Break => self.word("break"),
            StmtKind::Continue => self.word("continue"),
            StmtKind::Goto(label) => format!("{} {}", self.word("goto"), self.labels[*label]),
            StmtKind::Label(label) => format!("{}:", self.labels[*label]),
            StmtKind::Return(Some(value)) => format!("{} {}", self.word("return"), self.expr(value, 13)),
            StmtKind::Return(None) => self.word("return"),
            StmtKind::Wait(seconds) => format!("{} {}", self.word("waittime"), self.expr(seconds, 12)),
            StmtKind::WaitUntil(condition) => format!("{} {}", self.word("waituntil"), self.expr(condition, 12)),
            StmtKind::Exit => self.word("exit"),
            _ => return None,
        })
    }

    fn declare(&mut self, variables: &[Declared]) -> String {
        let mut text = String::new();
        for (at, variable) in variables.iter().enumerate() {
            let local = self.locals[variable.local].clone();
            let (comma, name) = if at == 0 { ("", self.declaration(&local)) } else { (", ", self.declared(&local)) };
            text += comma;
            text += &name;
            if let Some(first) = &variable.first {
                text += " = ";
                text += &self.value(first);
            }
        }
        text
    }

    fn printed(&mut self, arg: &Printed) -> String {
        match arg {
            Printed::Value(expr) => self.expr(expr, 12),
            Printed::Hex => self.word("hex"),
            Printed::Dec => self.word("dec"),
            Printed::Endl => self.word("endl"),
            Printed::Precision(digits) => format!("{}:{}", self.word("precision"), self.expr(digits, 12)),
        }
    }

    /// A first value or a value that is assigned: braces may be among them.
    fn value(&mut self, expr: &Expr) -> String {
        self.expr(expr, 13)
    }

    fn module(&mut self, module: usize, qualified: bool) -> String {
        if module == self.module && !qualified { String::new() } else { self.names.modules[module].clone() + "::" }
    }

    /// An expression, in parentheses if it binds less than `most`.
    fn expr(&mut self, expr: &Expr, most: u8) -> String {
        let text = self.bare(expr);
        if expr.level() > most { format!("({text})") } else { text }
    }

    #[expect(clippy::too_many_lines, reason = "one arm for each expression")]
    fn bare(&mut self, expr: &Expr) -> String {
        match &expr.kind {
            Kind::Literal(_, text) => text.clone(),
            Kind::Constant { number, at, qualified } => {
                let (name, constants) = ENUMS[*number];
                let constant = self.word(constants[*at]);
                if *qualified { format!("{}::{constant}", self.word(name)) } else { constant }
            }
            Kind::Var { var: Var::Local(local), .. } => {
                let name = self.locals[*local].name.clone();
                self.word(&name)
            }
            Kind::Var { var: Var::Global(global), qualified } => {
                let (module, name) = self.names.globals[*global].clone();
                self.module(module, *qualified) + &self.word(&name)
            }
            Kind::Index(inner, indices) => {
                let inner = self.expr(inner, 1);
                let indices: Vec<String> = indices.iter().map(|index| format!("[{}]", self.expr(index, 13))).collect();
                inner + &indices.concat()
            }
            Kind::Component(inner, number) => {
                let Base::Struct(of) = inner.ty.base else { panic!("only structures have components") };
                format!("{}.{}", self.expr(inner, 1), self.word(components(of)[*number].0))
            }
            Kind::Paren(inner) => format!("({})", self.expr(inner, 13)),
            Kind::Unary(op, inner) => {
                let sign = match op {
                    Unary::Negate => "-",
                    Unary::Complement => "~",
                    Unary::Not => "!",
                };
                let inner = self.expr(inner, 2);
                let blank = if sign == "-" && inner.starts_with('-') { " " } else { "" };
                format!("{sign}{blank}{inner}")
            }
            Kind::Binary { op, sides, .. } => {
                let (sign, level) = op.written();
                let left = self.expr(&sides.0, level);
                let right = self.expr(&sides.1, level - 1);
                let touching = left.ends_with(['+', '-']) || right.starts_with(['+', '-']);
                let blank = if !touching && self.random.chance(20) { "" } else { " " };
                format!("{left}{blank}{sign}{blank}{right}")
            }
            Kind::Assign { op, sides } => {
                let place = self.expr(&sides.0, 1);
                let value = self.expr(&sides.1, 13);
                format!("{place} {}= {value}", op.map_or("", |(op, _)| op.written().0))
            }
            Kind::Step { place, up, before } => {
                let place = self.expr(place, 1);
                let sign = if *up { "++" } else { "--" };
                if *before { format!("{sign}{place}") } else { format!("{place}{sign}") }
            }
            Kind::Call(func, args) => {
                let (module, name) = self.names.funcs[*func].clone();
                let args: Vec<String> = args.iter().map(|arg| self.expr(arg, 12)).collect();
                self.module(module, false) + &self.word(&name) + "(" + &args.join(", ") + ")"
            }
            Kind::Builtin(number, args) => {
                let builtin = &BUILTINS[*number];
                let mut texts = Vec::new();
                for (arg, param) in args.iter().zip(builtin.params) {
                    texts.push(match param {
                        Param::Word(word) => self.word(word),
                        _ => self.expr(arg, 12),
                    });
                }
                format!("{}({})", self.word(builtin.name), texts.join(","))
            }
            Kind::List(parts) => {
                let parts: Vec<String> = parts.iter().map(|part| self.part(part)).collect();
                format!("{{{}}}", parts.join(","))
            }
            Kind::Named(parts) => {
                let Base::Struct(of) = expr.ty.base else { panic!("only structures have components") };
                let mut texts = Vec::new();
                for (at, part) in parts {
                    texts.push(format!("{} {}", self.word(components(of)[*at].0), self.part(part)));
                }
                format!("{{{}}}", texts.join(", "))
            }
        }
    }

    /// A value between braces: whatever could be taken for a component and its value stands in parentheses.
    fn part(&mut self, expr: &Expr) -> String {
        let text = self.bare(expr);
        match &expr.kind {
            Kind::Literal(..) | Kind::Var { .. } | Kind::List(_) | Kind::Named(_) => text,
            Kind::Unary(Unary::Negate, inner) if matches!(inner.kind, Kind::Literal(..)) => text,
            _ => format!("({text})"),
        }
    }
}
