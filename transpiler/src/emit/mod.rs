//! From the checked program to readable Rust, as `docs/emitted-code.md` describes it.

mod assignments;
mod body;
mod calls;
mod comments;
mod compound;
mod consts;
mod deferred_let;
mod events;
mod expressions;
mod fragment;
mod functions;
mod goto;
mod loops;
mod machine;
mod mentions;
mod names;
mod operators;
mod places;
mod points;
mod program;
mod sequence;
mod statements;
mod switch;
mod tokens;
mod types;
mod usage;
mod usage_graph;
mod variables;
mod waiting;

use crate::effects;
use crate::hir::Program;
use body::Unit;
use comments::Comments;
use names::Names;
use proc_macro2::TokenStream;

/// How to emit.
#[derive(Clone, Debug, Default)]
pub struct EmitOptions {
    /// No comment in the first line that says where the code comes from.
    pub no_header: bool,
}

/// The Rust for a checked program whose effects are known (see [`crate::effects::infer`]). The same program gives the
/// same text.
pub fn emit(program: &Program, options: &EmitOptions) -> String {
    let unit = Unit::new(program);
    let tokens = program::items(&unit);
    let printed = match syn::parse2::<syn::File>(tokens.clone()) {
        Ok(file) => prettyplease::unparse(&file),
        // A mistake of this compiler; rustc shows it where the user builds.
        Err(error) => {
            let text = format!("arl2rs emitted code that Rust cannot read: {error}");
            format!("compile_error!({text:?});\n/*\n{}\n*/\n", tokens.to_string().replace("*/", "* /"))
        }
    };
    let text = unit.comments.fill(&printed);
    if options.no_header { text } else { format!("{}{text}", header(program)) }
}

/// The same as tokens, without comments: what the macro expands to.
pub fn emit_tokens(program: &Program) -> TokenStream {
    let unit = Unit::new(program);
    comments::without_marks(program::items(&unit))
}

fn header(program: &Program) -> String {
    let file = program.modules.first().map_or("", |module| module.file.as_str());
    format!(
        "// Emitted by arl2rs {} from {}. Changes belong there.\n\n",
        env!("CARGO_PKG_VERSION"),
        comments::clean(file)
    )
}

impl<'p> Unit<'p> {
    fn new(program: &'p Program) -> Self {
        let lines = program.modules.iter().map(|module| arl_lang::span::LineIndex::new(&module.source)).collect();
        let (movers, reached) = (effects::pointer_movers(program), effects::reached(program));
        Self { program, names: Names::new(program), comments: Comments::default(), lines, movers, reached }
    }
}
