//! Programs as trees. Every expression knows its type, and its value where it is a constant expression.

use crate::value::{Base, Type, Value};

/// An operator with two operands.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Op {
    Mul,
    Div,
    Rem,
    Add,
    Sub,
    Shl,
    Shr,
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

impl Op {
    /// How it is written, and how close it binds (Table 2-40: less binds closer).
    pub fn written(self) -> (&'static str, u8) {
        match self {
            Op::Mul => ("*", 3),
            Op::Div => ("/", 3),
            Op::Rem => ("%", 3),
            Op::Add => ("+", 4),
            Op::Sub => ("-", 4),
            Op::Shl => ("<<", 5),
            Op::Shr => (">>", 5),
            Op::Less => ("<", 6),
            Op::LessEqual => ("<=", 6),
            Op::Greater => (">", 6),
            Op::GreaterEqual => (">=", 6),
            Op::Equal => ("==", 7),
            Op::NotEqual => ("!=", 7),
            Op::BitAnd => ("&", 8),
            Op::BitXor => ("^", 9),
            Op::BitOr => ("|", 10),
            Op::And => ("&&", 11),
            Op::Or => ("||", 12),
        }
    }

    /// Whether it compares.
    pub fn compares(self) -> bool {
        matches!(self.written().1, 6 | 7)
    }
}

/// An operator with one operand.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Unary {
    Negate,
    Complement,
    Not,
}

/// A variable.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Var {
    /// One of the function's own, by its number.
    Local(usize),
    /// A global one, by its number.
    Global(usize),
}

/// An expression.
#[derive(Clone, Debug)]
pub struct Expr {
    /// What it is.
    pub kind: Kind,
    /// Its type.
    pub ty: Type,
    /// Its value, where it is a constant expression.
    pub constant: Option<Value>,
    /// Written in binary or hexadecimal, or the complement of such: its bits fit a uint, too.
    pub pattern: bool,
}

/// What an expression is.
#[derive(Clone, Debug)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Kind {
    /// A literal as it is written.
    Literal(Value, String),
    /// The constant of an enumeration, bare or with its type.
    Constant {
        number: usize,
        at: usize,
        qualified: bool,
    },
    /// A variable; a global one perhaps with the name of its module.
    Var {
        var: Var,
        qualified: bool,
    },
    Index(Box<Expr>, Vec<Expr>),
    Component(Box<Expr>, usize),
    Paren(Box<Expr>),
    Unary(Unary, Box<Expr>),
    /// Both operands are brought to `common` first.
    Binary {
        op: Op,
        sides: Box<(Expr, Expr)>,
        common: Base,
    },
    /// `place = value`, or `place op= value`, where both are brought to `common` first.
    Assign {
        op: Option<(Op, Base)>,
        sides: Box<(Expr, Expr)>,
    },
    /// `++place`, `place--` and so on.
    Step {
        place: Box<Expr>,
        up: bool,
        before: bool,
    },
    /// A call of a function of the program.
    Call(usize, Vec<Expr>),
    /// A call of something built in, by its number in [`crate::builtins::BUILTINS`].
    Builtin(usize, Vec<Expr>),
    /// A structure or array by position; nested for rows where the first says so.
    List(Vec<Expr>),
    /// A structure by names: the numbers of the components.
    Named(Vec<(usize, Expr)>),
}

/// An argument of a print.
#[derive(Clone, Debug)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Printed {
    Value(Expr),
    Hex,
    Dec,
    Endl,
    Precision(Expr),
}

/// A statement with the line it stands on, which [`crate::write::write`] fills in.
#[derive(Clone, Debug)]
pub struct Stmt {
    /// What it is.
    pub kind: StmtKind,
    /// The line, from 1.
    pub line: u32,
}

impl From<StmtKind> for Stmt {
    fn from(kind: StmtKind) -> Self {
        Self { kind, line: 0 }
    }
}

/// A branch of an `if` or a `case`: condition or value (none: `else`, `default`), body, line.
#[derive(Clone, Debug)]
#[expect(missing_docs, reason = "the names say it")]
pub struct Branch {
    pub value: Option<Expr>,
    pub body: Vec<Stmt>,
    pub line: u32,
}

/// A variable where it is declared.
#[derive(Clone, Debug)]
pub struct Declared {
    /// Its number among the function's locals.
    pub local: usize,
    /// Its type.
    pub ty: Type,
    /// Its first value.
    pub first: Option<Expr>,
    /// A const whose value is constant: it has it everywhere.
    pub fixed: bool,
}

/// What a statement is.
#[derive(Clone, Debug)]
#[expect(missing_docs, reason = "the names say it")]
pub enum StmtKind {
    /// Variables of one type.
    Declare(Vec<Declared>),
    Expr(Expr),
    Print(Vec<Printed>),
    If(Vec<Branch>),
    CompactIf(Expr, Box<Stmt>),
    While(Expr, Vec<Stmt>),
    /// The line is that of `until`.
    Repeat(Vec<Stmt>, Expr, u32),
    Loop(Vec<Stmt>),
    For {
        first: Box<Stmt>,
        condition: Expr,
        step: Expr,
        body: Vec<Stmt>,
    },
    Switch(Expr, Vec<Branch>),
    Break,
    Continue,
    Goto(usize),
    Label(usize),
    Return(Option<Expr>),
    /// `waittime` of so many seconds.
    Wait(Expr),
    /// `waituntil` of something true.
    WaitUntil(Expr),
    Exit,
}

/// A variable.
#[derive(Clone, Debug)]
#[expect(missing_docs, reason = "the names say it")]
pub struct Variable {
    pub name: String,
    pub ty: Type,
    pub constant: bool,
    /// The value of a `const` whose initialiser is constant.
    pub value: Option<Value>,
}

/// A function.
#[derive(Clone, Debug)]
#[expect(missing_docs, reason = "the names say it")]
pub struct Func {
    pub name: String,
    pub module: usize,
    pub result: Base,
    /// How many of the locals are parameters.
    pub params: usize,
    /// The first parameter says how often it may still call itself.
    pub counted: bool,
    pub locals: Vec<Variable>,
    pub labels: Vec<String>,
    pub body: Vec<Stmt>,
    pub line: u32,
}

/// A global variable.
#[derive(Clone, Debug)]
#[expect(missing_docs, reason = "the names say it")]
pub struct Global {
    pub module: usize,
    pub variable: Variable,
    pub first: Option<Expr>,
    pub line: u32,
}

/// A program. The first module has `main`, the last of its functions.
#[derive(Clone, Default, Debug)]
#[expect(missing_docs, reason = "the names say it")]
pub struct Program {
    /// The names of the files without their ending.
    pub modules: Vec<String>,
    pub globals: Vec<Global>,
    pub funcs: Vec<Func>,
}

impl Expr {
    /// An expression that is not a constant.
    pub fn new(kind: Kind, ty: Type) -> Self {
        Self { kind, ty, constant: None, pattern: false }
    }

    /// An expression without array type that is not a constant.
    pub fn one(kind: Kind, base: Base) -> Self {
        Self::new(kind, Type::one(base))
    }

    /// Whether it is `~` of a literal in binary or hexadecimal.
    pub fn is_complement(&self) -> bool {
        match &self.kind {
            Kind::Paren(inner) => inner.is_complement(),
            Kind::Unary(Unary::Complement, inner) => self.pattern && inner.pattern,
            _ => false,
        }
    }

    /// Whether a function of the program is called in it.
    pub fn calls(&self) -> bool {
        match &self.kind {
            Kind::Literal(..) | Kind::Constant { .. } | Kind::Var { .. } => false,
            Kind::Call(..) => true,
            Kind::Index(inner, parts) => inner.calls() || parts.iter().any(Expr::calls),
            Kind::Component(inner, _) | Kind::Paren(inner) | Kind::Unary(_, inner) => inner.calls(),
            Kind::Binary { sides, .. } | Kind::Assign { sides, .. } => sides.0.calls() || sides.1.calls(),
            Kind::Step { place, .. } => place.calls(),
            Kind::Builtin(_, parts) | Kind::List(parts) => parts.iter().any(Expr::calls),
            Kind::Named(parts) => parts.iter().any(|(_, part)| part.calls()),
        }
    }

    /// How close it binds; 1 for what needs no parentheses anywhere.
    pub fn level(&self) -> u8 {
        match &self.kind {
            // The least int is written with a sign.
            Kind::Literal(_, text) if text.starts_with('-') => 2,
            Kind::Unary(..) | Kind::Step { .. } => 2,
            Kind::Binary { op, .. } => op.written().1,
            Kind::Assign { .. } => 13,
            _ => 1,
        }
    }
}
