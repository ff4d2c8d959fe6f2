// Trees as short texts, for tests.

use arl_lang::ast::*;
use arl_lang::symbol::Interner;
use arl_lang::{ParseOptions, parse, parse_statements};

/// The statements of `source`, one a line, inner blocks indented; panics at mistakes.
pub(crate) fn statements(source: &str) -> String {
    let mut interner = Interner::new();
    let parsed = parse_statements(source, &mut interner, ParseOptions { splices: true });
    assert!(parsed.errors.is_empty(), "{source}: {:?}", parsed.errors);
    let mut text = String::new();
    Show { interner: &interner }.block(&parsed.block, 0, &mut text);
    text.trim_end().into()
}

/// The items of `source`, one a line, statements indented; panics at mistakes.
#[allow(dead_code, reason = "not every test file shows whole files")]
pub(crate) fn items(source: &str) -> String {
    let mut interner = Interner::new();
    let parsed = parse(source, &mut interner, ParseOptions::default());
    assert!(parsed.errors.is_empty(), "{source}: {:?}", parsed.errors);
    let show = Show { interner: &interner };
    let mut text = String::new();
    for item in &parsed.file.items {
        match item {
            Item::Import(import) => text += &format!("import {:?}\n", import.path),
            Item::Global(decl) => text += &format!("{}\n", show.decl(decl)),
            Item::Func(func) => {
                let params = func.params.iter().map(|param| {
                    format!("{} {}{}", show.ty(&param.ty), show.ident(&param.name), show.dims(&param.dims))
                });
                let params: Vec<String> = params.collect();
                text += &format!("func {} {}({})\n", show.ty(&func.result), show.ident(&func.name), params.join(", "));
                show.block(&func.body, 1, &mut text);
            }
        }
    }
    text.trim_end().into()
}

struct Show<'a> {
    interner: &'a Interner,
}

impl Show<'_> {
    fn ident(&self, ident: &Ident) -> String {
        self.interner.name(ident.symbol).into()
    }

    fn ty(&self, ty: &TypeRef) -> String {
        format!("{}{}", if ty.system { "$" } else { "" }, self.interner.name(ty.name))
    }

    fn dims(&self, dims: &[Expr]) -> String {
        dims.iter().map(|size| format!("[{}]", self.expr(size))).collect()
    }

    fn decl(&self, decl: &Decl) -> String {
        let vars: Vec<String> = decl
            .vars
            .iter()
            .map(|var| {
                let init = var.init.as_ref().map_or(String::new(), |init| format!(" = {}", self.expr(init)));
                format!("{}{}{init}", self.ident(&var.name), self.dims(&var.dims))
            })
            .collect();
        let constant = if decl.constant.is_some() { "const " } else { "" };
        format!("{constant}{} {}", self.ty(&decl.ty), vars.join(", "))
    }

    fn block(&self, block: &[Stmt], depth: usize, text: &mut String) {
        for stmt in block {
            self.stmt(stmt, depth, text);
        }
    }

    fn stmt(&self, stmt: &Stmt, depth: usize, text: &mut String) {
        let indent = "  ".repeat(depth);
        let mut line = |words: String| *text += &format!("{indent}{words}\n");
        match &stmt.kind {
            StmtKind::Decl(decl) => line(self.decl(decl)),
            StmtKind::Expr(expr) => line(self.expr(expr)),
            StmtKind::Instr(instr) => {
                let events: String = instr
                    .events
                    .iter()
                    .map(|(event, action)| format!(" ; {} -> {}", self.expr(event), self.expr(action)))
                    .collect();
                line(format!("@{} {}{events}", self.ident(&instr.name), self.args(&instr.args)).trim_end().into());
            }
            StmtKind::If(branches) => {
                for (at, (condition, body)) in branches.arms.iter().enumerate() {
                    *text += &format!("{indent}{} {}\n", if at == 0 { "if" } else { "elseif" }, self.expr(condition));
                    self.block(body, depth + 1, text);
                }
                if let Some(body) = &branches.otherwise {
                    *text += &format!("{indent}else\n");
                    self.block(body, depth + 1, text);
                }
            }
            StmtKind::CompactIf(parts) => {
                line(format!("when {}", self.expr(&parts.0)));
                self.stmt(&parts.1, depth + 1, text);
            }
            StmtKind::While(condition, body) => {
                line(format!("while {}", self.expr(condition)));
                self.block(body, depth + 1, text);
            }
            StmtKind::Repeat(body, condition) => {
                line(format!("repeat {}", condition.as_ref().map_or("?".into(), |condition| self.expr(condition))));
                self.block(body, depth + 1, text);
            }
            StmtKind::Loop(body) => {
                line("loop".into());
                self.block(body, depth + 1, text);
            }
            StmtKind::For(parts) => {
                let mut init = String::new();
                if let Some(stmt) = &parts.init {
                    self.stmt(stmt, 0, &mut init);
                }
                let or_none = |expr: &Option<Expr>| expr.as_ref().map_or(String::new(), |expr| self.expr(expr));
                line(format!("for {}; {}; {}", init.trim_end(), or_none(&parts.condition), or_none(&parts.step)));
                self.block(&parts.body, depth + 1, text);
            }
            StmtKind::Switch(parts) => {
                line(format!("switch {}", self.expr(&parts.subject)));
                for arm in &parts.arms {
                    let value = arm.value.as_ref().map_or("default".into(), |value| self.expr(value));
                    *text += &format!("{indent}  case {value}\n");
                    self.block(&arm.body, depth + 2, text);
                }
            }
            StmtKind::Break => line("break".into()),
            StmtKind::Continue => line("continue".into()),
            StmtKind::Goto(label) => line(format!("goto {}", self.ident(label))),
            StmtKind::Label(label) => line(format!("{}:", self.ident(label))),
            StmtKind::Return(value) => {
                line(
                    format!("return {}", value.as_ref().map_or(String::new(), |value| self.expr(value)))
                        .trim_end()
                        .into(),
                );
            }
        }
    }

    fn args(&self, args: &[Arg]) -> String {
        let args: Vec<String> = args
            .iter()
            .map(|arg| {
                let label = arg.label.as_ref().map_or(String::new(), |label| format!("{}:", self.ident(label)));
                let unit = arg.unit.map_or(String::new(), |(unit, _)| format!("<{}>", unit.text()));
                format!("{label}{}{unit}", self.expr(&arg.value))
            })
            .collect();
        args.join(", ")
    }

    fn expr(&self, expr: &Expr) -> String {
        match &expr.kind {
            ExprKind::Int(value, Radix::Decimal) => format!("{value}"),
            ExprKind::Int(value, Radix::Binary) => format!("{value:b}b"),
            ExprKind::Int(value, Radix::Hexadecimal) => format!("{value:x}h"),
            ExprKind::Double(value) => format!("{value:?}"),
            ExprKind::String(text) => format!("{text:?}"),
            ExprKind::Bool(value) => format!("{value}"),
            ExprKind::Name(name) => self.interner.name(*name).into(),
            ExprKind::Path { scope, system, name } => {
                format!("{}{}::{}", if *system { "$" } else { "" }, self.ident(scope), self.ident(name))
            }
            ExprKind::System(name) => format!("${}", self.interner.name(*name)),
            ExprKind::Index(parts) => format!("{}[{}]", self.expr(&parts.0), self.expr(&parts.1)),
            ExprKind::Field(base, name) => format!("{}.{}", self.expr(base), self.ident(name)),
            ExprKind::Call(call) => {
                let module = call.module.as_ref().map_or(String::new(), |module| format!("{}::", self.ident(module)));
                format!("{module}{}({})", self.ident(&call.name), self.args(&call.args))
            }
            ExprKind::Unary(op, value) => format!("({}{})", op.text(), self.expr(value)),
            ExprKind::Binary(op, parts) => format!("({} {} {})", self.expr(&parts.0), op.text(), self.expr(&parts.1)),
            ExprKind::Assign(op, parts) => {
                let op = op.map_or("", BinaryOp::text);
                format!("({} {op}= {})", self.expr(&parts.0), self.expr(&parts.1))
            }
            ExprKind::Step(step, value) => {
                let op = if step.up { "++" } else { "--" };
                let value = self.expr(value);
                if step.prefix { format!("({op}{value})") } else { format!("({value}{op})") }
            }
            ExprKind::Brace(items) => {
                let items: Vec<String> = items
                    .iter()
                    .map(|item| {
                        let name = item.name.as_ref().map_or(String::new(), |name| format!("{} ", self.ident(name)));
                        format!("{name}{}", self.expr(&item.value))
                    })
                    .collect();
                format!("{{{}}}", items.join(", "))
            }
            ExprKind::Splice(number) => format!("#{number}"),
            ExprKind::Error => "?".into(),
        }
    }
}
