//! The syntax tree of one file, as the parser makes it: names are symbols, nothing is resolved yet.
//!
//! Every node carries the bytes it was read from. Blocks are nested already (see `blocks`).

use crate::span::Span;
use crate::symbol::Symbol;

/// A name and its place.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Ident {
    /// The name, folded.
    pub symbol: Symbol,
    /// Where it is in the source.
    pub span: Span,
}

/// One source file.
#[derive(Clone, Debug, Default)]
pub struct File {
    /// Imports, global declarations and functions in the order of the file.
    pub items: Vec<Item>,
}

/// An item outside functions.
#[derive(Clone, Debug)]
pub enum Item {
    /// `import "path"`
    Import(Import),
    /// A declaration of global variables.
    Global(Decl),
    /// A function with its body.
    Func(Func),
}

/// `import "path"`
#[derive(Clone, Debug)]
pub struct Import {
    /// The path as written, escapes resolved.
    pub path: Box<str>,
    /// The whole line.
    pub span: Span,
    /// The path's token.
    pub path_span: Span,
}

/// `func type name(parameters)` to `endfunc`.
#[derive(Clone, Debug)]
pub struct Func {
    /// The type of the result; `void` is the name of a type, too.
    pub result: TypeRef,
    /// The function's name.
    pub name: Ident,
    /// The parameters in order.
    pub params: Vec<FuncParam>,
    /// The statements up to `endfunc`.
    pub body: Block,
    /// The header line.
    pub span: Span,
    /// The `endfunc` line (the end of the file where it is missing).
    pub end: Span,
}

/// A parameter of a function.
#[derive(Clone, Debug)]
pub struct FuncParam {
    /// The type of the element.
    pub ty: TypeRef,
    /// The parameter's name.
    pub name: Ident,
    /// Sizes of the dimensions; empty for a scalar.
    pub dims: Vec<Expr>,
    /// Type, name and sizes.
    pub span: Span,
}

/// The name of a type. `system` is true for `$VEL_PROFILE`, whose symbol is the name without `$`.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct TypeRef {
    /// The name, folded.
    pub name: Symbol,
    /// Whether it was written with `$`.
    pub system: bool,
    /// Where it is in the source.
    pub span: Span,
}

/// `[const] type name[dims] = value, ...`
#[derive(Clone, Debug)]
pub struct Decl {
    /// The span of `const` if it is there.
    pub constant: Option<Span>,
    /// The type of the elements.
    pub ty: TypeRef,
    /// The variables, at least one.
    pub vars: Vec<Var>,
    /// The whole declaration.
    pub span: Span,
}

/// One declared variable.
#[derive(Clone, Debug)]
pub struct Var {
    /// Its name.
    pub name: Ident,
    /// Sizes of the dimensions; empty for a scalar.
    pub dims: Vec<Expr>,
    /// The value after `=`.
    pub init: Option<Expr>,
}

/// Statements in order.
pub type Block = Vec<Stmt>;

/// A statement and the line (or block) it was read from. For a block statement the span is that of its opening line.
#[derive(Clone, Debug)]
pub struct Stmt {
    /// What it does.
    pub kind: StmtKind,
    /// Where it is in the source.
    pub span: Span,
}

/// The kinds of statements.
#[derive(Clone, Debug)]
pub enum StmtKind {
    /// A declaration of local variables.
    Decl(Box<Decl>),
    /// An assignment, `++`/`--`, a call: any expression as a statement.
    Expr(Box<Expr>),
    /// An instruction with labelled or bare arguments.
    Instr(Box<Instr>),
    /// `if` ... `elseif` ... `else` ... `endif`
    If(Box<If>),
    /// `if(c) statement` on one line.
    CompactIf(Box<(Expr, Stmt)>),
    /// `while(c)` ... `endwhile`
    While(Box<Expr>, Block),
    /// `repeat` ... `until(c)`; `None` where the `until` was missing.
    Repeat(Block, Option<Box<Expr>>),
    /// `loop` ... `endloop`
    Loop(Block),
    /// `for(init; c; step)` ... `endfor`
    For(Box<For>),
    /// `switch(e)` ... `endswitch`
    Switch(Box<Switch>),
    /// `break`
    Break,
    /// `continue`
    Continue,
    /// `goto label`
    Goto(Ident),
    /// `label:`
    Label(Ident),
    /// `return`, `return e`
    Return(Option<Box<Expr>>),
}

/// `if` with its branches.
#[derive(Clone, Debug)]
pub struct If {
    /// Conditions and what they guard: `if`, then each `elseif`.
    pub arms: Vec<(Expr, Block)>,
    /// The `else` branch.
    pub otherwise: Option<Block>,
}

/// `for(init; condition; step)`; each of the three may be missing.
#[derive(Clone, Debug)]
pub struct For {
    /// A declaration or an expression.
    pub init: Option<Stmt>,
    /// Tested before each round; missing means true.
    pub condition: Option<Expr>,
    /// Evaluated after each round.
    pub step: Option<Expr>,
    /// The statements of a round.
    pub body: Block,
}

/// `switch(subject)` with its cases.
#[derive(Clone, Debug)]
pub struct Switch {
    /// The value that is compared.
    pub subject: Expr,
    /// The cases in order, `default` among them.
    pub arms: Vec<Arm>,
}

/// `case value:` or `default:` with its statements.
#[derive(Clone, Debug)]
pub struct Arm {
    /// The value; `None` for `default`.
    pub value: Option<Expr>,
    /// The line of the case.
    pub span: Span,
    /// The statements.
    pub body: Block,
}

/// An instruction: `lin p1,vl:100mm/s;T(1),setdo(1,true)`.
#[derive(Clone, Debug)]
pub struct Instr {
    /// Its name.
    pub name: Ident,
    /// The arguments as written.
    pub args: Vec<Arg>,
    /// Events after `;`: (event, action).
    pub events: Vec<(Expr, Expr)>,
}

/// An argument of a call or an instruction: `label:value unit`, or a bare value.
#[derive(Clone, Debug)]
pub struct Arg {
    /// The label, without its colon.
    pub label: Option<Ident>,
    /// The value.
    pub value: Expr,
    /// The unit after a number.
    pub unit: Option<(Unit, Span)>,
}

impl Arg {
    /// Label, value and unit.
    pub fn span(&self) -> Span {
        let start = self.label.map_or(self.value.span, |label| label.span.to(self.value.span));
        self.unit.map_or(start, |(_, unit)| start.to(unit))
    }
}

/// The units that may follow a number in an argument.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Unit {
    /// `%`
    Percent,
    /// `mm`
    Millimetre,
    /// `mm/s`
    MillimetrePerSecond,
    /// `deg`
    Degree,
    /// `deg/s`
    DegreePerSecond,
    /// `s`
    Second,
}

impl Unit {
    /// The unit as it is written.
    pub const fn text(self) -> &'static str {
        match self {
            Unit::Percent => "%",
            Unit::Millimetre => "mm",
            Unit::MillimetrePerSecond => "mm/s",
            Unit::Degree => "deg",
            Unit::DegreePerSecond => "deg/s",
            Unit::Second => "s",
        }
    }
}

/// An expression.
#[derive(Clone, Debug)]
pub struct Expr {
    /// What it is.
    pub kind: ExprKind,
    /// Where it is in the source (parentheses included).
    pub span: Span,
}

/// How an int literal was written.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Radix {
    /// `12`
    Decimal,
    /// `1100b`: a bit pattern
    Binary,
    /// `3eh`: a bit pattern
    Hexadecimal,
}

/// The kinds of expressions.
#[derive(Clone, Debug)]
pub enum ExprKind {
    /// An int literal, up to 32 bits.
    Int(u32, Radix),
    /// A literal with point or exponent.
    Double(f64),
    /// A string literal, escapes resolved.
    String(Box<str>),
    /// `true`, `false`
    Bool(bool),
    /// A variable, a bare enum constant, `PI`, `endl`, or a word like `ffh` that may be a number.
    Name(Symbol),
    /// `module::name`, `type::constant`; `system` where the type was written with `$`.
    Path {
        /// The module or type.
        scope: Ident,
        /// Whether the scope was written with `$`.
        system: bool,
        /// The name after `::`.
        name: Ident,
    },
    /// `$NAME`, the symbol is the name without `$`.
    System(Symbol),
    /// `base[index]`, one index each.
    Index(Box<(Expr, Expr)>),
    /// `base.component`
    Field(Box<Expr>, Ident),
    /// `name(arguments)` or `module::name(arguments)`
    Call(Box<Call>),
    /// `-e`, `!e`, `~e`
    Unary(UnaryOp, Box<Expr>),
    /// `a + b` and so on.
    Binary(BinaryOp, Box<(Expr, Expr)>),
    /// `target = value`, `target += value`.
    Assign(Option<BinaryOp>, Box<(Expr, Expr)>),
    /// `++e`, `e--`
    Step(Step, Box<Expr>),
    /// `{1, 2}`, `{x 1, y 2}`
    Brace(Vec<BraceItem>),
    /// A Rust value spliced in by the macro: its number.
    Splice(u32),
    /// A part that could not be read; the error is already reported.
    Error,
}

/// A call.
#[derive(Clone, Debug)]
pub struct Call {
    /// The module in front of `::`.
    pub module: Option<Ident>,
    /// The function.
    pub name: Ident,
    /// The arguments as written.
    pub args: Vec<Arg>,
}

/// `++` or `--`, before or after its variable.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Step {
    /// `++`
    pub up: bool,
    /// Before the variable: the value is the new one.
    pub prefix: bool,
}

/// One element between braces.
#[derive(Clone, Debug)]
pub struct BraceItem {
    /// A name directly before the value: `{x 1}`.
    pub name: Option<Ident>,
    /// The value.
    pub value: Expr,
}

/// Operators with one operand.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum UnaryOp {
    /// `-`
    Negate,
    /// `!`
    Not,
    /// `~`
    Complement,
}

/// Operators with two operands.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[expect(missing_docs, reason = "the operators' names say it all")]
pub enum BinaryOp {
    Add,
    Subtract,
    Multiply,
    Divide,
    Remainder,
    ShiftLeft,
    ShiftRight,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    Equal,
    NotEqual,
    BitAnd,
    BitXor,
    BitOr,
    And,
    Or,
}

impl BinaryOp {
    /// The operator as it is written.
    pub const fn text(self) -> &'static str {
        match self {
            BinaryOp::Add => "+",
            BinaryOp::Subtract => "-",
            BinaryOp::Multiply => "*",
            BinaryOp::Divide => "/",
            BinaryOp::Remainder => "%",
            BinaryOp::ShiftLeft => "<<",
            BinaryOp::ShiftRight => ">>",
            BinaryOp::Less => "<",
            BinaryOp::LessEqual => "<=",
            BinaryOp::Greater => ">",
            BinaryOp::GreaterEqual => ">=",
            BinaryOp::Equal => "==",
            BinaryOp::NotEqual => "!=",
            BinaryOp::BitAnd => "&",
            BinaryOp::BitXor => "^",
            BinaryOp::BitOr => "|",
            BinaryOp::And => "&&",
            BinaryOp::Or => "||",
        }
    }

    /// Whether it compares its operands; `&&` and `||` do not.
    pub const fn compares(self) -> bool {
        matches!(
            self,
            BinaryOp::Less
                | BinaryOp::LessEqual
                | BinaryOp::Greater
                | BinaryOp::GreaterEqual
                | BinaryOp::Equal
                | BinaryOp::NotEqual
        )
    }
}

impl UnaryOp {
    /// The operator as it is written.
    pub const fn text(self) -> &'static str {
        match self {
            UnaryOp::Negate => "-",
            UnaryOp::Not => "!",
            UnaryOp::Complement => "~",
        }
    }
}
