//! What every name of a program means, by position, for editors.
//!
//! The checker records this where it resolves names (`check/mention.rs`), also in programs with errors. The rules of
//! the language are not repeated here. A name that could not be resolved has no mention.

mod expectation;

pub(crate) use expectation::MARKER;
pub use expectation::{ArgumentList, Expectation, HERE, Wanted};

use crate::diagnostics::{FileId, Location};
use crate::hir::{FuncId, GlobalId, ModuleId, Type, Value};
use arl_lang::catalog::{Base, Constant, Entry, Enum, Struct, SystemVariable};
use arl_lang::span::Span;
use std::collections::HashMap;

/// What a name means.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Meaning {
    /// A local variable or a parameter of a function, by the position of its declaration.
    Local(Location),
    /// A global variable.
    Global(GlobalId),
    /// A function of the program.
    Function(FuncId),
    /// A module: before `::`, or in the path of an `import`.
    Module(ModuleId),
    /// A label of `goto`, by its position.
    Label(Location),
    /// A built-in instruction or function.
    Builtin(&'static Entry),
    /// The label of a built-in's argument: the entry and the index of the parameter.
    Parameter(&'static Entry, usize),
    /// A system variable.
    System(&'static SystemVariable),
    /// A constant with a plain name: `PI`.
    Constant(&'static Constant),
    /// A constant of an enumeration, by its index.
    EnumConstant(Enum, u16),
    /// A component of a structure, by its index.
    Component(Struct, usize),
    /// A type.
    Type(Base),
    /// A number that looks like a name: `ffh`.
    Number(u32),
}

impl Meaning {
    /// Whether the program itself declares it, so that it can be renamed.
    pub fn is_own(&self) -> bool {
        matches!(self, Self::Local(_) | Self::Global(_) | Self::Function(_) | Self::Label(_))
    }
}

/// What a mention does with the thing that it names.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Role {
    /// Declares it.
    Declares,
    /// Writes it, and possibly also reads it.
    Writes,
    /// Anything else: reads, calls, jumps.
    Uses,
}

/// A name at a position.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Mention {
    /// The bytes of the name alone.
    pub at: Location,
    /// The meaning of the name.
    pub meaning: Meaning,
    /// What is done with it.
    pub role: Role,
}

/// The callee that receives an argument.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Callee {
    /// A function of the program.
    Function(FuncId),
    /// A built-in.
    Builtin(&'static Entry),
}

/// An argument and its parameter.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Argument {
    /// The value, without label and unit.
    pub at: Location,
    /// The position of the name of the instruction or function.
    pub of: Location,
    /// The callee that receives it.
    pub callee: Callee,
    /// The index of the parameter.
    pub parameter: usize,
    /// Whether it was written with its label.
    pub labelled: bool,
    /// Whether a unit follows it.
    pub unit: bool,
}

/// A local variable or parameter.
#[derive(Clone, PartialEq, Debug)]
pub struct LocalInfo {
    /// Its type; `None` if the declaration is wrong.
    pub ty: Option<Type>,
    /// Whether it is `const`.
    pub constant: bool,
    /// Its value, if it is a constant with a known value.
    pub value: Option<Value>,
    /// The function that it belongs to.
    pub func: Option<FuncId>,
    /// Whether it is a parameter.
    pub parameter: bool,
}

/// A global variable.
#[derive(Clone, PartialEq, Debug)]
pub struct GlobalInfo {
    /// Its name, as declared.
    pub name: String,
    /// Its module.
    pub module: ModuleId,
    /// The number of its item in the file: items below can see it.
    pub item: u32,
    /// Its type; `None` if the declaration is wrong.
    pub ty: Option<Type>,
    /// Whether it is `const`.
    pub constant: bool,
    /// Its value, if it is a constant with a known value.
    pub value: Option<Value>,
    /// The position of its name in the declaration.
    pub at: Location,
    /// The whole declaration, including its other variables.
    pub declaration: Span,
}

/// A function of the program.
#[derive(Clone, PartialEq, Debug)]
pub struct FunctionInfo {
    /// Its name, as declared.
    pub name: String,
    /// Its module.
    pub module: ModuleId,
    /// The number of its item in the file: items below can see it.
    pub item: u32,
    /// The names and types of its parameters, and the positions of their declarations.
    pub params: Vec<(String, Option<Type>, Location)>,
    /// The type of its result; `None` if the declaration is wrong.
    pub result: Option<Base>,
    /// The position of its name in the declaration.
    pub at: Location,
    /// The line of its header.
    pub header: Span,
    /// The line of its `endfunc`.
    pub end: Span,
}

impl FunctionInfo {
    /// The span of the whole function.
    pub fn span(&self) -> Span {
        self.header.to(self.end)
    }
}

/// A module: a file of the program.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct ModuleInfo {
    /// Its name as written before `::`, folded.
    pub name: String,
    /// Its file.
    pub file: FileId,
    /// The modules that it can name, with the names that it uses for them.
    pub imports: Vec<(String, ModuleId)>,
    /// Its data file, whose variables need no module name.
    pub data: Option<ModuleId>,
}

/// All names of a program.
#[derive(Clone, Default, Debug)]
pub struct Index {
    /// Sorted by file and position.
    pub(crate) mentions: Vec<Mention>,
    /// Sorted by file and position.
    pub(crate) arguments: Vec<Argument>,
    pub(crate) locals: HashMap<Location, LocalInfo>,
    /// The global variables, by [`GlobalId`].
    pub globals: Vec<GlobalInfo>,
    /// The functions, by [`FuncId`].
    pub functions: Vec<FunctionInfo>,
    /// The modules, by [`ModuleId`]; the main module is the first.
    pub modules: Vec<ModuleInfo>,
    /// What may stand at the position of [`HERE`] in the text.
    pub expectation: Option<Expectation>,
}

impl Index {
    /// The name at a position: the one that contains the byte `offset` or ends there.
    pub fn at(&self, file: FileId, offset: u32) -> Option<&Mention> {
        let behind =
            self.mentions.partition_point(|mention| (mention.at.file, mention.at.span.start) <= (file, offset));
        let before = self.mentions.get(..behind)?;
        before.last().filter(|mention| mention.at.file == file && offset <= mention.at.span.end)
    }

    /// All names of a file, in the order of the text.
    pub fn of_file(&self, file: FileId) -> &[Mention] {
        let start = self.mentions.partition_point(|mention| mention.at.file < file);
        let end = self.mentions.partition_point(|mention| mention.at.file <= file);
        self.mentions.get(start..end).unwrap_or_default()
    }

    /// All names with this meaning, by file and position.
    pub fn with(&self, meaning: Meaning) -> impl Iterator<Item = &Mention> {
        self.mentions.iter().filter(move |mention| mention.meaning == meaning)
    }

    /// The arguments in a file, in the order of the text.
    pub fn arguments(&self, file: FileId) -> impl Iterator<Item = &Argument> {
        self.arguments.iter().filter(move |argument| argument.at.file == file)
    }

    /// The information about a local variable, by the position of its declaration.
    pub fn local(&self, declared: Location) -> Option<&LocalInfo> {
        self.locals.get(&declared)
    }

    /// The information about a global variable.
    pub fn global(&self, id: GlobalId) -> Option<&GlobalInfo> {
        self.globals.get(id.0 as usize)
    }

    /// The information about a function.
    pub fn function(&self, id: FuncId) -> Option<&FunctionInfo> {
        self.functions.get(id.0 as usize)
    }

    /// The information about a module.
    pub fn module(&self, id: ModuleId) -> Option<&ModuleInfo> {
        self.modules.get(id.0 as usize)
    }

    /// The module of a file.
    pub fn module_of(&self, file: FileId) -> Option<ModuleId> {
        self.modules.iter().position(|module| module.file == file).map(|at| ModuleId(at as u32))
    }

    /// The function that contains a position.
    pub fn function_at(&self, file: FileId, offset: u32) -> Option<FuncId> {
        let contains_offset = |function: &FunctionInfo| {
            let span = function.span();
            function.at.file == file && (span.start..=span.end).contains(&offset)
        };
        self.functions.iter().position(contains_offset).map(|at| FuncId(at as u32))
    }

    /// The declaration of a meaning in the program; `None` for built-ins.
    pub fn declaration(&self, meaning: Meaning) -> Option<Location> {
        match meaning {
            Meaning::Local(at) | Meaning::Label(at) => Some(at),
            Meaning::Global(id) => self.global(id).map(|global| global.at),
            Meaning::Function(id) => self.function(id).map(|function| function.at),
            Meaning::Module(id) => self.module(id).map(|module| Location { file: module.file, span: Span::default() }),
            _ => None,
        }
    }

    /// Sorts the records and removes duplicates.
    pub(crate) fn finish(&mut self) {
        self.mentions.sort_by_key(|mention| (mention.at, mention.role));
        // A position has one meaning: code that was checked twice (overloads) was recorded twice.
        self.mentions.dedup_by_key(|mention| mention.at);
        self.arguments.sort_by_key(|argument| (argument.at, argument.of));
        self.arguments.dedup_by_key(|argument| (argument.at, argument.of));
    }
}
