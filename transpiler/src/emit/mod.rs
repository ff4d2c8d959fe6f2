//! From the checked program to readable Rust, as `docs/emitted-code.md` describes it.

mod assignments;
mod body;
mod calls;
mod compound;
mod consts;
mod deferred_let;
mod elements;
mod events;
mod expressions;
mod fragment;
mod functions;
mod goto;
mod hooks;
mod loops;
mod machine;
mod marks;
mod mentions;
mod names;
mod operators;
mod parts;
mod places;
mod points;
mod program;
mod rows;
mod sequence;
mod slots;
mod slots_init;
mod statements;
mod switch;
mod templates;
mod temporaries;
mod tokens;
mod types;
mod usage;
mod usage_graph;
mod variables;
mod waiting;
mod written_back;

use crate::effects;
use crate::hir::Program;
use body::Unit;
use marks::Marks;
use names::Names;
use proc_macro2::TokenStream;
use slots::Slots;
use templates::Templates;

/// How to emit.
#[derive(Clone, Debug, Default)]
pub struct EmitOptions {
    /// No comment in the first line that says where the code comes from.
    pub no_header: bool,
    /// From which sizes on code takes the forms that are compiled sooner.
    pub sizes: Sizes,
    /// For a debugger: the program halts where it is told to, and shows its variables.
    /// [`compile_program`](crate::compile::compile_program) makes the checked program ready for it.
    pub watched: bool,
    /// Global variables keep their names, so that they can be set from outside.
    pub named: bool,
}

/// From which sizes on code takes the forms that are compiled sooner. They change nothing of what a program does.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Sizes {
    /// So many like statements in a row become a table.
    pub table: usize,
    /// So many rows for each kind of statement in it.
    pub rows_of_a_kind: usize,
    /// A block with more `.await`s than this is in parts.
    pub awaits: usize,
    /// A part has at most so many, where its statements have no more each.
    pub awaits_of_a_part: usize,
    /// A part has at least so many.
    pub least_awaits: usize,
    /// In a program with more than this, functions with at least as many as a part are compiled by themselves.
    pub awaits_of_a_program: usize,
    /// And calls that are found so often, with other constants, become a function.
    pub uses_of_a_template: usize,
    /// More variables of one type and module than this are an array.
    pub variables: usize,
}

impl Default for Sizes {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl Sizes {
    /// What costs least to compile.
    pub const DEFAULT: Self = Self {
        table: 8,
        rows_of_a_kind: 4,
        awaits: 64,
        awaits_of_a_part: 32,
        least_awaits: 8,
        awaits_of_a_program: 256,
        uses_of_a_template: 4,
        variables: 64,
    };

    /// All forms wherever they are possible: for tests.
    pub const LEAST: Self = Self {
        table: 1,
        rows_of_a_kind: 1,
        awaits: 1,
        awaits_of_a_part: 1,
        least_awaits: 1,
        awaits_of_a_program: 0,
        uses_of_a_template: 1,
        variables: 0,
    };
}

/// The Rust for a checked program whose effects are known (see [`crate::effects::infer`]). The same program gives the
/// same text.
pub fn emit(program: &Program, options: &EmitOptions) -> String {
    let unit = Unit::new(program, options);
    let tokens = program::items(&unit);
    let printed = match syn::parse2::<syn::File>(tokens.clone()) {
        Ok(file) => prettyplease::unparse(&file),
        // A mistake of this compiler; rustc shows it where the user builds.
        Err(error) => {
            let text = format!("arl2rs emitted code that Rust cannot read: {error}");
            format!("compile_error!({text:?});\n/*\n{}\n*/\n", tokens.to_string().replace("*/", "* /"))
        }
    };
    let text = unit.marks.fill(&printed);
    if options.no_header { text } else { format!("{}{text}", header(program)) }
}

/// The same as tokens, without comments: what the macro expands to.
pub fn emit_tokens(program: &Program) -> TokenStream {
    let unit = Unit::new(program, &EmitOptions::default());
    unit.marks.without_comments(program::items(&unit))
}

fn header(program: &Program) -> String {
    let file = program.modules.first().map_or("", |module| module.file.as_str());
    format!("// Emitted by arl2rs {} from {}. Changes belong there.\n\n", env!("CARGO_PKG_VERSION"), marks::clean(file))
}

impl<'p> Unit<'p> {
    fn new(program: &'p Program, &EmitOptions { sizes, watched, named, .. }: &EmitOptions) -> Self {
        let lines = program.modules.iter().map(|module| arl_lang::span::LineIndex::new(&module.source)).collect();
        let (movers, reached) = (effects::pointer_movers(program), effects::reached(program));
        let mut names = Names::new(program);
        let slots = Slots::new(program, &names, sizes);
        let apart = parts::apart(program, sizes);
        let templates = match parts::is_large(program, sizes) {
            true => Templates::new(program, &mut names, &slots, sizes),
            false => Templates::default(),
        };
        Self {
            program,
            names,
            slots,
            templates,
            marks: Marks::default(),
            lines,
            movers,
            reached,
            apart,
            sizes,
            watched,
            named: named || watched,
        }
    }
}
