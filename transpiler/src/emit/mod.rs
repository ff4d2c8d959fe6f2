//! Turns the checked program into readable Rust, as described in `docs/emitted-code.md`.

mod assignments;
mod body;
mod calls;
mod compound;
mod consts;
mod control_flow;
mod deferred_let;
mod elements;
mod events;
mod expressions;
mod fragment;
mod functions;
mod goto;
mod local_names;
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
mod unit;
mod usage;
mod usage_graph;
mod variables;
mod waiting;
mod written_back;

use crate::hir::Program;
use proc_macro2::TokenStream;
use unit::Unit;

/// Options of the emitter.
#[derive(Clone, Debug, Default)]
pub struct EmitOptions {
    /// Omits the comment in the first line that says where the code comes from.
    pub no_header: bool,
    /// The sizes from which on code takes the forms that compile faster.
    pub sizes: Sizes,
    /// Global variables keep their names, so that they can be set from outside.
    pub named: bool,
}

/// The sizes from which on code takes the forms that compile faster. They do not change what a program does.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Sizes {
    /// This many similar statements in a row become a table.
    pub table: usize,
    /// The minimum number of rows in a table for each kind of statement.
    pub rows_of_a_kind: usize,
    /// A block with more `.await`s than this is split into parts.
    pub awaits: usize,
    /// The maximum number of `.await`s in a part, unless one of its statements has more.
    pub awaits_of_a_part: usize,
    /// The minimum number of `.await`s in a part.
    pub least_awaits: usize,
    /// In a program with more `.await`s than this, functions with at least as many as a part are compiled separately.
    pub awaits_of_a_program: usize,
    /// In such a program, calls that occur this often with different constants become a function.
    pub uses_of_a_template: usize,
    /// More variables of one type and module than this become an array.
    pub variables: usize,
}

impl Default for Sizes {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl Sizes {
    /// The sizes that compile fastest.
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

    /// Uses all forms wherever possible, for tests.
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

/// The Rust code for a checked program whose effects are known (see [`crate::effects::infer`]). The same program always
/// gives the same text.
pub fn emit(program: &Program, options: &EmitOptions) -> String {
    let unit = Unit::new(program, options);
    let tokens = program::items(&unit);
    let printed = match syn::parse2::<syn::File>(tokens.clone()) {
        Ok(file) => prettyplease::unparse(&file),
        // A bug in this compiler; rustc shows it in the user's build.
        Err(error) => {
            let text = format!("arl2rs emitted code that Rust cannot read: {error}");
            format!("compile_error!({text:?});\n/*\n{}\n*/\n", tokens.to_string().replace("*/", "* /"))
        }
    };
    let text = unit.marks.fill(&printed);
    if options.no_header { text } else { format!("{}{text}", header(program)) }
}

/// The same code as tokens, without comments: the expansion of the macro.
pub fn emit_tokens(program: &Program) -> TokenStream {
    let unit = Unit::new(program, &EmitOptions::default());
    unit.marks.without_comments(program::items(&unit))
}

fn header(program: &Program) -> String {
    let file = program.modules.first().map_or("", |module| module.file.as_str());
    format!("// Emitted by arl2rs {} from {}. Changes belong there.\n\n", env!("CARGO_PKG_VERSION"), marks::clean(file))
}
