//! The checked program: names resolved, types known, conversions explicit, arguments bound, constants folded.
//!
//! Invariants that the emitter relies on:
//! - every `Expr::ty` is the type of the value; operands of an operator have the type that the operator works on
//!   (shifts: the left operand's type and an `int` count), so an implicit conversion is always a `Convert` node;
//! - values of `Assign` and `AssignOp` have the type of their place, call arguments the type of their parameter;
//! - conditions are `bool`;
//! - indices are `int`, one for each dimension of the array; constant ones are in range;
//! - the arguments of a built-in are in source order, the presence of each parameter is respected, defaults are filled
//!   in.

use arl_lang::ast::{BinaryOp, Step, UnaryOp};
use arl_lang::catalog::{Base, Entry, Enum, Family, Space, Struct, SystemVariable};
use arl_lang::span::Span;
use std::sync::{PoisonError, RwLock};

/// Index of a module in [`Program::modules`].
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct ModuleId(pub u32);

/// Index of a global variable in [`Program::globals`].
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct GlobalId(pub u32);

/// Index of a function in [`Program::funcs`].
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct FuncId(pub u32);

/// Index of a local variable in [`Func::locals`].
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct LocalId(pub u32);

/// Index of a label in [`Func::labels`].
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct LabelId(pub u32);

/// The maximum number of dimensions of an array.
pub const MAX_DIMS: usize = 8;

/// A type: a base type or an array of one. Kept small because every expression has one.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Type {
    /// The type of a scalar or of the elements.
    pub base: Base,
    /// 0 for a scalar, else one more than the index of the sizes in `SHAPES`.
    shape: u16,
}

/// The sizes of all array shapes used by any program in this process. Equal shapes share one number.
static SHAPES: RwLock<Vec<&'static [u16]>> = RwLock::new(Vec::new());

impl Type {
    /// A type without dimensions.
    pub const fn scalar(base: Base) -> Self {
        Self { base, shape: 0 }
    }

    /// An array type; `None` beyond [`MAX_DIMS`] dimensions, sizes beyond 65535, or more than 65535 different shapes.
    pub fn array(base: Base, dims: &[u32]) -> Option<Self> {
        if dims.is_empty() {
            return Some(Self::scalar(base));
        }
        let sizes = dims.iter().map(|size| u16::try_from(*size).ok()).collect::<Option<Vec<u16>>>()?;
        if sizes.len() > MAX_DIMS {
            return None;
        }
        let mut shapes = SHAPES.write().unwrap_or_else(PoisonError::into_inner);
        let known = shapes.iter().position(|known| **known == *sizes);
        let at = known.unwrap_or_else(|| {
            shapes.push(sizes.leak());
            shapes.len() - 1
        });
        Some(Self { base, shape: u16::try_from(at + 1).ok()? })
    }

    /// The sizes of the dimensions; empty for a scalar.
    pub fn dims(&self) -> &'static [u16] {
        if self.shape == 0 {
            return &[];
        }
        let shapes = SHAPES.read().unwrap_or_else(PoisonError::into_inner);
        shapes.get(self.shape as usize - 1).copied().unwrap_or(&[])
    }

    /// Whether the type is an array.
    pub const fn is_array(&self) -> bool {
        self.shape != 0
    }

    /// The number of elements; 1 for a scalar.
    #[expect(clippy::len_without_is_empty, reason = "no type is without elements")]
    pub fn len(&self) -> usize {
        self.dims().iter().map(|size| *size as usize).product()
    }

    /// The type of one element.
    pub const fn element(&self) -> Type {
        Type::scalar(self.base)
    }

    /// The approximate size of a value in memory, in bytes.
    pub fn bytes(&self, family: Family) -> usize {
        bytes(self.base, family).saturating_mul(self.len())
    }
}

fn bytes(base: Base, family: Family) -> usize {
    match base {
        Base::Void => 0,
        Base::Bool | Base::Byte | Base::Enum(_) => 1,
        Base::Int | Base::Uint => 4,
        Base::Double => 8,
        Base::String => 24,
        Base::Handle(_) => 32,
        Base::Struct(id) => {
            id.def(family).components.iter().map(|component| bytes(component.ty, family).next_multiple_of(4)).sum()
        }
    }
}

/// A checked program: one file with a `main` and everything that it uses.
#[derive(Debug)]
pub struct Program {
    /// The name of the main module.
    pub name: String,
    /// The robot family that the program was checked for.
    pub family: Family,
    /// The modules; the main module is the first.
    pub modules: Vec<Module>,
    /// All global variables, in the order in which they are initialised.
    pub globals: Vec<Global>,
    /// All functions.
    pub funcs: Vec<Func>,
    /// `main`; absent only in libraries and macro fragments.
    pub main: Option<FuncId>,
}

/// One source file.
#[derive(Debug)]
pub struct Module {
    /// The file name without `.arl`, folded: a Rust identifier unless it is a Rust keyword.
    pub name: String,
    /// The file name as shown to users.
    pub file: String,
    /// The text.
    pub source: String,
    /// Whether the module is a `_data.arl` file, whose literal values are read again on load.
    pub data: bool,
}

/// A global variable.
#[derive(Debug)]
pub struct Global {
    /// The name, folded.
    pub name: String,
    /// The module that declares it.
    pub module: ModuleId,
    /// Its type.
    pub ty: Type,
    /// Whether it is `const`.
    pub constant: bool,
    /// Whether any statement writes it.
    pub mutated: bool,
    /// The value of a `const` scalar whose initialiser is constant.
    pub value: Option<Value>,
    /// The initialiser.
    pub init: Option<Expr>,
    /// For variables of a data module: whether the initialiser is made of literals only, so that it can be re-taught.
    pub teachable: bool,
    /// The position of the name in its declaration.
    pub span: Span,
}

/// A function.
#[derive(Debug)]
pub struct Func {
    /// The name, folded.
    pub name: String,
    /// The module that defines it.
    pub module: ModuleId,
    /// The parameters: the first locals.
    pub params: Vec<LocalId>,
    /// All local variables, parameters first.
    pub locals: Vec<Local>,
    /// The labels that `goto` may name.
    pub labels: Vec<GotoLabel>,
    /// The type of the result.
    pub result: Base,
    /// The statements.
    pub body: Block,
    /// The header line.
    pub span: Span,
    /// The `endfunc` line.
    pub end: Span,
    /// What a call may do; filled in by the effects pass.
    pub effects: Effects,
    /// Whether the function contains a `goto`.
    pub has_goto: bool,
}

/// What calling a function may do.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub struct Effects {
    /// It may yield the cycle: emitted as `async fn`.
    pub waits: bool,
    /// It may end in an alarm, `exit` or `restart`: emitted with a `Done<T>` result.
    pub fails: bool,
    /// It needs the context `cx`.
    pub context: bool,
    /// It reads or writes global variables.
    pub globals: bool,
    /// It changes something visible outside the function: it does not only look and compute.
    pub changes: bool,
    /// It may call itself, directly or indirectly: calls to an `async` one are boxed.
    pub recursive: bool,
}

/// A local variable or parameter.
#[derive(Debug)]
pub struct Local {
    /// The name, folded.
    pub name: String,
    /// Its type.
    pub ty: Type,
    /// Whether it is `const`.
    pub constant: bool,
    /// The value of a `const` scalar whose initialiser is constant.
    pub value: Option<Value>,
    /// Whether it is written after its declaration (or passed where a built-in writes).
    pub mutated: bool,
    /// Whether it is read anywhere.
    pub read: bool,
    /// Whether an event that the function declares can see it change; filled in by the effects pass.
    pub shared: bool,
    /// The position of the name in its declaration.
    pub span: Span,
}

/// A label.
#[derive(Debug)]
pub struct GotoLabel {
    /// The name, folded.
    pub name: String,
    /// The position of the label.
    pub span: Span,
    /// Whether a `goto` names it.
    pub used: bool,
}

/// Statements in order. A block is a scope.
pub type Block = Vec<Stmt>;

/// A statement with its line (for block statements: the opening line).
#[derive(Debug)]
pub struct Stmt {
    /// What it does.
    pub kind: StmtKind,
    /// The position of the statement.
    pub span: Span,
}

/// The kinds of statements.
#[derive(Debug)]
pub enum StmtKind {
    /// A declaration; without an initialiser the variable gets its default value each time.
    Let(LocalId, Option<Expr>),
    /// An expression for its effect: assignments, calls, instructions.
    Eval(Expr),
    /// `if`, `elseif`s, `else`. A compact `if` is represented in the same way.
    If(Vec<(Expr, Block)>, Option<Block>),
    /// `while`
    While(Expr, Block, LoopInfo),
    /// `repeat` ... `until`
    Repeat(Block, Expr, LoopInfo),
    /// `loop`
    Loop(Block, LoopInfo),
    /// `for`
    For(Box<For>),
    /// `switch`; if no case matches the subject, control goes to the arm without a value, wherever it stands.
    Switch(Expr, Vec<Arm>),
    /// `break`: leaves the innermost loop (never a switch).
    Break,
    /// `continue`: goes to the next round of the innermost loop.
    Continue,
    /// `goto`
    Goto(LabelId),
    /// `label:`
    Label(LabelId),
    /// `return`, with a value of the function's result type.
    Return(Option<Expr>),
}

/// What the effects pass has found out about a loop.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub struct LoopInfo {
    /// Whether a round may pass without waiting, so that the loop itself has to yield the cycle.
    pub spends: bool,
    /// As how many rounds one round counts if `spends` is set: itself and all rounds of the counted loops inside.
    pub rounds: i32,
    /// Where the rounds are counted if `spends` is set.
    pub counting: Counting,
    /// The number of the loop in its function.
    pub number: u32,
}

impl LoopInfo {
    /// Whether each round of the loop is counted in the context.
    pub(crate) fn counts_in_context(self) -> bool {
        self.spends && self.counting == Counting::InContext
    }

    /// Whether the loop counts the rounds that it spends in a variable of its own.
    pub(crate) fn counts_alone(self) -> bool {
        self.spends && self.counting == Counting::Alone
    }
}

/// Where the rounds of a loop are counted.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub enum Counting {
    /// In the context, or not at all: something inside the loop also counts there or yields the cycle.
    #[default]
    InContext,
    /// In a variable of its own: nothing inside counts in the context.
    Alone,
    /// All at once after the loop: the loop variable rises in equal steps to a constant, so the rounds are few and
    /// their number can be calculated. The loop does not yield the cycle in between.
    Behind,
    /// As `Behind`, for a `while` that ends when this variable reaches its limit.
    Walking(Walk),
    /// Nowhere: the `for` has few rounds. The rounds of loops inside it are counted after those loops, and that is
    /// where the cycle is yielded.
    Inside,
}

impl Counting {
    /// Whether the rounds are counted after the loop.
    pub(crate) fn is_behind(self) -> bool {
        matches!(self, Self::Behind | Self::Walking(_))
    }
}

/// A variable that changes in equal steps, one in each round of a loop.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Walk {
    /// The variable.
    pub local: LocalId,
    /// What each round adds to it; never 0.
    pub step: i32,
}

/// `for(init; condition; step)`
#[derive(Debug)]
pub struct For {
    /// Declarations or one expression; the declared variables live in the loop.
    pub init: Vec<Stmt>,
    /// Missing means true.
    pub condition: Option<Expr>,
    /// Evaluated after each round, also after `continue`.
    pub step: Option<Expr>,
    /// The statements of a round.
    pub body: Block,
    /// What the effects pass found out.
    pub info: LoopInfo,
    /// Whether an event may see a variable of the loop header change; filled in by the effects pass.
    pub shared: bool,
}

/// `case value:` or `default:`
#[derive(Debug)]
pub struct Arm {
    /// The value, of the subject's type; `None` for `default`.
    pub value: Option<Value>,
    /// The statements.
    pub body: Block,
    /// The position of the case line.
    pub span: Span,
}

/// A typed expression.
#[derive(Debug)]
pub struct Expr {
    /// The type of its value.
    pub ty: Type,
    /// The kind of expression.
    pub kind: ExprKind,
    /// The position of the expression.
    pub span: Span,
}

/// The kinds of expressions.
#[derive(Debug)]
pub enum ExprKind {
    /// A constant.
    Const(Value),
    /// The value of a variable, component or element.
    Place(Box<Place>),
    /// A component of a value that is not a variable: `cjoint().j1`.
    FieldOf(Box<Expr>, Struct, usize),
    /// An implicit conversion to this expression's type: byte, int, uint, double or enum to a wider number or bool,
    /// int to enum where constant.
    Convert(Box<Expr>),
    /// An operator with one operand.
    Unary(UnaryOp, Box<Expr>),
    /// An operator with two operands of one type (see the invariants). On strings: concatenation and comparison; on
    /// joints: sum and difference; on frames and poses: composition, where the two types may differ.
    Binary(BinaryOp, Box<(Expr, Expr)>),
    /// `place = value`; the value of the expression is the new value.
    Assign(Box<(Place, Expr)>),
    /// `place op= value`; the value has the type of the place, except for shifts (an int) and `pose *= frame`.
    AssignOp(BinaryOp, Box<(Place, Expr)>),
    /// A concatenation of strings whose result is kept and could exceed the maximum length of a string.
    Grown(Box<Expr>),
    /// `++`, `--`
    Step(Step, Box<Place>),
    /// A call of a user's function.
    Call(FuncId, Vec<Expr>),
    /// A built-in function or instruction.
    Builtin(Box<Builtin>),
    /// A structure from braces: one value per component, where `None` keeps the default; an empty list means all
    /// defaults.
    Struct(Struct, Vec<Option<Expr>>),
    /// An array from braces, flattened; elements missing at the end have their default values.
    Array(Vec<Expr>),
    /// A Rust value spliced in by the macro.
    Splice(u32),
}

/// A bound use of a built-in.
#[derive(Debug)]
pub struct Builtin {
    /// The chosen overload in the catalog.
    pub entry: &'static Entry,
    /// The arguments in source order (defaults last).
    pub args: Vec<Bound>,
}

impl Builtin {
    /// Whether it uses registers or coils of the controller's Modbus TCP server.
    pub(crate) fn is_served(&self) -> bool {
        matches!(self.entry.space(), Some(Space::ModbusRegister | Space::ModbusCoil))
    }
}

/// An argument and its parameter.
#[derive(Debug)]
pub struct Bound {
    /// Index into the entry's parameters.
    pub param: usize,
    /// The value or place that is passed.
    pub value: Passed,
}

/// What is passed to a parameter.
#[derive(Debug)]
pub enum Passed {
    /// A value (also conditions and actions, which are evaluated repeatedly).
    Value(Expr),
    /// A variable that is written.
    Out(Place),
}

/// Something that can be read and written.
#[derive(Debug)]
pub struct Place {
    /// The variable.
    pub root: Root,
    /// Components and elements, outermost first.
    pub path: Vec<Projection>,
    /// The type of the component or element at the end of the path.
    pub ty: Type,
    /// The position of the place.
    pub span: Span,
}

/// A variable.
#[derive(Clone, Copy, Debug)]
pub enum Root {
    /// A local variable of the function.
    Local(LocalId),
    /// A global variable.
    Global(GlobalId),
    /// A system variable.
    System(&'static SystemVariable),
}

/// A step into a structure or an array.
#[derive(Debug)]
pub enum Projection {
    /// The component with this index in the structure's definition.
    Field(Struct, usize),
    /// An element: one index per dimension of an array with these sizes.
    Index(Vec<Expr>, Type),
}

/// A constant value.
#[derive(Clone, PartialEq, Debug)]
pub enum Value {
    /// int
    Int(i32),
    /// uint
    Uint(u32),
    /// byte
    Byte(u8),
    /// double
    Double(f64),
    /// bool
    Bool(bool),
    /// string
    String(std::rc::Rc<str>),
    /// The constant of an enumeration with this index.
    Enum(Enum, u16),
}

impl Value {
    /// The type of the value.
    pub fn base(&self) -> Base {
        match self {
            Value::Int(_) => Base::Int,
            Value::Uint(_) => Base::Uint,
            Value::Byte(_) => Base::Byte,
            Value::Double(_) => Base::Double,
            Value::Bool(_) => Base::Bool,
            Value::String(_) => Base::String,
            Value::Enum(id, _) => Base::Enum(*id),
        }
    }
}
