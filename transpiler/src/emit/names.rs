//! Rust names for the names of the program.
//!
//! A folded ARL name is its Rust name, unless it is a Rust keyword or would hide something that the emitted code uses;
//! it then gets trailing underscores. Of two or more underscores in a row one is kept, as rustc expects.

use crate::hir::{Func, LocalId, ModuleId, Program};
use proc_macro2::{Ident, Span, TokenStream, TokenTree};
use std::collections::{HashMap, HashSet};

/// Words that cannot be names in any edition up to 2024.
const KEYWORDS: &[&str] = &[
    "abstract", "as", "async", "await", "become", "box", "break", "const", "continue", "crate", "do", "dyn", "else",
    "enum", "extern", "false", "final", "fn", "for", "gen", "if", "impl", "in", "let", "loop", "macro", "match", "mod",
    "move", "mut", "override", "priv", "pub", "ref", "return", "self", "static", "struct", "super", "trait", "true",
    "try", "type", "typeof", "union", "unsafe", "unsized", "use", "virtual", "where", "while", "yield",
];

/// Functions of the prelude, and the parameter names of emitted functions.
const VALUES: &[&str] = &[
    "append",
    "cx",
    "fits",
    "g",
    "part",
    "div",
    "rem",
    "rem_double",
    "shl",
    "shr",
    "index",
    "index2",
    "in_range",
    "one_of",
    "truth",
];

/// Names that a module must not hide: crates, and the parameters of functions of the program as a whole.
const OUTSIDE: &[&str] = &["arl_rt", "core", "std", "alloc", "cx", "g"];

/// Whether a word is a Rust keyword.
fn is_keyword(name: &str) -> bool {
    KEYWORDS.contains(&name)
}

/// Whether emitted functions use a name for something else.
pub(super) fn is_taken_value(name: &str) -> bool {
    VALUES.contains(&name)
}

/// A Rust name; the text must be a valid one.
pub(super) fn ident(name: &str) -> Ident {
    Ident::new(name, Span::call_site())
}

/// The name of a field or method: the folded name, unless it is a Rust keyword.
pub(super) fn field(name: &str) -> Ident {
    ident(&tidy(&name.to_ascii_lowercase(), &|name| is_keyword(name)))
}

/// The replacement for a name that consists only of underscores.
const UNDERSCORE: &str = "underscore";

/// `after_stop` as `AfterStop`.
pub(super) fn camel_case(name: &str) -> String {
    let mut out = String::new();
    for part in name.split('_').filter(|part| !part.is_empty()) {
        let mut letters = part.chars();
        out.extend(letters.next().map(|first| first.to_ascii_uppercase()));
        out.push_str(letters.as_str());
    }
    if out.starts_with(|c: char| c.is_ascii_alphabetic()) { out } else { format!("Label{out}") }
}

/// The name without doubled underscores, with underscores appended as long as it is taken.
fn tidy(name: &str, taken: &dyn Fn(&str) -> bool) -> String {
    let mut tidy = String::with_capacity(name.len() + 1);
    let inner = name.trim_matches('_');
    let lead = name.len() - name.trim_start_matches('_').len();
    tidy.extend(std::iter::repeat_n('_', lead.min(1)));
    for c in inner.chars() {
        if c != '_' || !tidy.ends_with('_') {
            tidy.push(c);
        }
    }
    if name.len() > lead + inner.len() {
        tidy.push('_');
    }
    // A lone underscore is not a name, and a leading one would silence warnings about unused variables.
    while tidy == "_" || tidy.is_empty() || taken(&tidy) {
        tidy.push('_');
        if tidy == "__" {
            tidy = UNDERSCORE.to_owned();
        }
    }
    tidy
}

/// Whether code uses the prelude: every path, call and type of the prelude begins with one of these words, or with a
/// type that belongs neither to Rust itself nor to the module.
pub(super) fn mentions_prelude(code: &TokenStream) -> bool {
    code.clone().into_iter().any(|token| match token {
        TokenTree::Ident(word) => {
            let word = word.to_string();
            PRELUDE.contains(&word.as_str()) || is_taken_value(&word) && word != "g" || is_type(&word)
        }
        TokenTree::Group(group) => mentions_prelude(&group.stream()),
        _ => false,
    })
}

/// Types of the prelude begin with a capital letter, as do a few names that do not belong to it.
fn is_type(word: &str) -> bool {
    const OTHERS: &[&str] = &[
        "Globals",
        "Variables",
        "Default",
        "Ok",
        "Err",
        "Some",
        "None",
        "Box",
        "Self",
        "State",
        "Row",
        "ARL__",
        "ROWS",
        "ARL_ROWS__",
    ];
    word.starts_with(|c: char| c.is_ascii_uppercase()) && !OTHERS.contains(&word) && word != "FILE"
}

/// Modules of the prelude whose functions may be called without the context.
const PRELUDE: &[&str] = &["math", "bits", "strings", "convert", "pose", "flow", "text", "random"];

/// The names of everything outside functions.
#[derive(Debug)]
pub(super) struct Names {
    modules: Vec<Ident>,
    funcs: Vec<Ident>,
    globals: Vec<Ident>,
    /// The function names of each module: locals must not hide them.
    functions_of: Vec<HashSet<String>>,
}

impl Names {
    /// Assigns names for a program.
    pub(super) fn new(program: &Program) -> Self {
        let mut used = HashSet::new();
        let modules = program
            .modules
            .iter()
            .map(|module| {
                distinct(&of_file(&module.name), &mut used, |name| is_keyword(name) || OUTSIDE.contains(&name))
            })
            .collect();
        let mut functions_of = vec![HashSet::new(); program.modules.len()];
        let mut spare = HashSet::new();
        let mut of_module = |used: &mut [HashSet<String>], module: ModuleId, name: &str, values: bool| {
            let used = used.get_mut(module.0 as usize).unwrap_or(&mut spare);
            distinct(name, used, |name| is_keyword(name) || (values && is_taken_value(name)))
        };
        let funcs =
            program.funcs.iter().map(|func| of_module(&mut functions_of, func.module, &func.name, true)).collect();
        let mut fields = vec![HashSet::new(); program.modules.len()];
        let globals =
            program.globals.iter().map(|global| of_module(&mut fields, global.module, &global.name, false)).collect();
        Self { modules, funcs, globals, functions_of }
    }

    /// The module's name.
    pub(super) fn module(&self, id: ModuleId) -> Ident {
        pick(&self.modules, id.0)
    }

    /// The function's name in its module.
    pub(super) fn func(&self, id: u32) -> Ident {
        pick(&self.funcs, id)
    }

    /// The field of a global variable in the structure of its module.
    pub(super) fn global(&self, id: u32) -> Ident {
        pick(&self.globals, id)
    }

    /// A name for one more function of a module: `lin_1`.
    pub(super) fn new_function(&mut self, module: ModuleId, wanted: &str) -> Ident {
        let wanted = wanted.to_ascii_lowercase();
        let Some(names) = self.functions_of.get_mut(module.0 as usize) else { return ident(&wanted) };
        let name = (1..).map(|number| format!("{wanted}_{number}")).find(|name| !names.contains(name));
        let name = name.unwrap_or(wanted);
        names.insert(name.clone());
        ident(&name)
    }

    /// Whether a module has a function of this Rust name.
    pub(super) fn has_function(&self, module: ModuleId, name: &str) -> bool {
        self.functions_of.get(module.0 as usize).is_some_and(|names| names.contains(name))
    }

    /// The names of a function's locals. Two of them may share a name if the program hides one behind the other, but
    /// not if variables of several blocks share a scope: in functions with `goto` or parts, which are `scattered`.
    pub(super) fn locals(&self, func: &Func, scattered: bool, unread: &dyn Fn(LocalId) -> bool) -> Vec<Ident> {
        let mut by_name: HashMap<String, String> = HashMap::new();
        let mut used = HashSet::new();
        let mut out = Vec::with_capacity(func.locals.len());
        for (at, local) in func.locals.iter().enumerate() {
            // A name of underscores alone is not valid in Rust. It gets a new one, which still has to show whether it
            // is never read.
            let name = if local.name.chars().all(|c| c == '_') { UNDERSCORE } else { &local.name };
            let lead = if unread(LocalId(at as u32)) && !name.starts_with('_') { "_" } else { "" };
            let wanted = format!("{lead}{name}");
            // An unread `depth` and `_depth` are two different names.
            let key = if scattered { at.to_string() } else { format!("{lead} {}", local.name) };
            let name = by_name.entry(key).or_insert_with(|| {
                let taken =
                    |name: &str| is_keyword(name) || is_taken_value(name) || self.has_function(func.module, name);
                distinct(&wanted, &mut used, taken).to_string()
            });
            out.push(ident(name));
        }
        out
    }
}

/// The name of a file, which may contain any characters, made valid for Rust.
fn of_file(name: &str) -> String {
    let fits = |text: &str| syn::parse_str::<Ident>(text).is_ok();
    let inner = |c: char| !c.is_whitespace() && fits(&format!("x_{c}"));
    let text: String = name.chars().map(|c| if inner(c) { c } else { '_' }).collect();
    let begins = text.chars().next().is_some_and(|first| first == '_' || fits(&format!("{first}_")));
    if begins { text } else { format!("file_{text}") }
}

fn distinct(name: &str, used: &mut HashSet<String>, taken: impl Fn(&str) -> bool) -> Ident {
    let found = tidy(name, &|name| taken(name) || used.contains(name));
    used.insert(found.clone());
    ident(&found)
}

fn pick(names: &[Ident], at: u32) -> Ident {
    names.get(at as usize).cloned().unwrap_or_else(|| ident("unknown"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn local(name: &str) -> String {
        tidy(name, &|name| is_keyword(name) || is_taken_value(name))
    }

    #[test]
    fn files_may_have_any_name() {
        let alphabet = "abcdefghijklmnopqrstuvwxyz_0123456789";
        let names =
            [("my-part 2", "my_part_2"), ("1x", "file_1x"), ("程序", "程序"), ("", "file_"), (alphabet, alphabet)];
        for (file, name) in names {
            assert_eq!(of_file(file), name);
        }
    }

    #[test]
    fn names_stay_unless_taken() {
        assert_eq!(local("count"), "count");
        assert_eq!(local("type"), "type_");
        assert_eq!(local("index"), "index_");
        assert_eq!(local("cx"), "cx_");
        assert_eq!(local("a__b"), "a_b");
        assert_eq!(local("__a_"), "_a_");
        assert_eq!(local("_"), "underscore");
        assert_eq!(local("___"), "underscore");
    }

    #[test]
    fn two_names_never_become_one() {
        let mut used = HashSet::new();
        let names: Vec<String> = ["a__b", "a_b", "a_b_", "type", "type_"]
            .iter()
            .map(|name| distinct(name, &mut used, is_keyword).to_string())
            .collect();
        assert_eq!(names.iter().collect::<HashSet<_>>().len(), names.len(), "{names:?}");
    }
}
