//! Writes words of the language and built-in names in the spelling of the manual; names of the program itself stay.

use super::lines::{Item, LogicalLine, PlacedLexeme};
use arl_lang::catalog::{self, Base, Entry};
use arl_lang::control_word;
use arl_lang::lexer::Lexeme;
use arl_lang::outline::LexemeRole;
use std::collections::{HashMap, HashSet};
use std::sync::LazyLock;

/// The functions of the file, folded: these names never mean built-ins.
pub(super) fn functions(lines: &[LogicalLine<'_>]) -> HashSet<String> {
    let mut names = HashSet::new();
    for line in lines {
        let mut pieces = line.pieces();
        if pieces.next().is_some_and(|first| first.is_word("func")) {
            // The first piece is the type of the result, unless that is missing.
            names.extend(pieces.take(2).map(|piece| piece.text.to_ascii_lowercase()));
        }
    }
    names
}

/// Spells the words of a line.
pub(super) fn spell(items: &mut [Item<'_>], functions: &HashSet<String>) {
    let mut pieces: Vec<&mut PlacedLexeme<'_>> = items
        .iter_mut()
        .filter_map(|item| match item {
            Item::Piece(piece) => Some(piece),
            _ => None,
        })
        .collect();
    let mut speller = Speller { functions, instruction: &[], open: Vec::new() };
    for at in 0..pieces.len() {
        let around = Around {
            before: at.checked_sub(1).and_then(|at| pieces.get(at)).map(|piece| **piece),
            scope: at.checked_sub(2).and_then(|at| pieces.get(at)).map(|piece| **piece),
            next: pieces.get(at + 1).map(|piece| **piece),
        };
        if let Some(piece) = pieces.get_mut(at)
            && let Some(spelled) = speller.spelled(piece, around)
        {
            piece.text = spelled;
        }
    }
}

/// The pieces around a piece.
#[derive(Clone, Copy)]
struct Around<'a> {
    before: Option<PlacedLexeme<'a>>,
    /// The piece before `before`.
    scope: Option<PlacedLexeme<'a>>,
    next: Option<PlacedLexeme<'a>>,
}

impl<'a> Around<'a> {
    fn is_before(&self, lexeme: Lexeme) -> bool {
        self.before.is_some_and(|before| before.lexeme == lexeme)
    }

    fn is_next(&self, lexeme: Lexeme) -> bool {
        self.next.is_some_and(|next| next.lexeme == lexeme)
    }

    /// The piece before a `::` that precedes this piece.
    fn scope(&self) -> Option<PlacedLexeme<'a>> {
        self.scope.filter(|_| self.is_before(Lexeme::Scope))
    }
}

/// Goes through a line.
struct Speller<'a> {
    functions: &'a HashSet<String>,
    /// The instruction of the statement.
    instruction: &'static [Entry],
    /// For each open bracket, the function whose arguments it contains.
    open: Vec<&'static [Entry]>,
}

impl Speller<'_> {
    /// The correct spelling of a piece, if the language declares it.
    fn spelled(&mut self, piece: &PlacedLexeme<'_>, around: Around<'_>) -> Option<&'static str> {
        if piece.begins {
            self.instruction = &[];
        }
        match piece.lexeme {
            Lexeme::ParenOpen => {
                let called = around.before.filter(|before| before.role == LexemeRole::Name);
                let own = |called: &PlacedLexeme<'_>| {
                    around.scope.is_some_and(|before| is_member(&before)) || self.is_own(called)
                };
                let entries = called.filter(|called| !own(called)).map(|called| catalog::functions(called.text));
                self.open.push(entries.unwrap_or(&[]));
                None
            }
            Lexeme::BracketOpen | Lexeme::BraceOpen => {
                self.open.push(&[]);
                None
            }
            Lexeme::ParenClose | Lexeme::BracketClose | Lexeme::BraceClose => {
                self.open.pop();
                None
            }
            Lexeme::System => system(piece.text),
            Lexeme::Word => self.word(piece, around),
            _ => None,
        }
    }

    fn word(&mut self, piece: &PlacedLexeme<'_>, around: Around<'_>) -> Option<&'static str> {
        match piece.role {
            LexemeRole::Reserved | LexemeRole::Constant => control_word(piece.text),
            LexemeRole::Type => type_name(piece.text),
            LexemeRole::Instruction => {
                self.instruction = catalog::instructions(piece.text);
                entry_name(self.instruction, piece.text)
            }
            LexemeRole::Label => label(self.open.last().copied().unwrap_or(self.instruction), piece.text),
            LexemeRole::Name => self.name(piece, around),
            _ => None,
        }
    }

    fn name(&self, piece: &PlacedLexeme<'_>, around: Around<'_>) -> Option<&'static str> {
        if let Some(scope) = around.scope() {
            return constant(&scope, piece.text);
        }
        if around.before.is_some_and(|before| is_member(&before)) {
            return None;
        }
        // A type in a declaration or before a constant.
        if around.next.is_some_and(|next| next.role == LexemeRole::Name) || around.is_next(Lexeme::Scope) {
            return type_name(piece.text);
        }
        if around.is_next(Lexeme::ParenOpen) && !self.is_own(piece) {
            return entry_name(catalog::functions(piece.text), piece.text);
        }
        None
    }

    fn is_own(&self, piece: &PlacedLexeme<'_>) -> bool {
        self.functions.contains(&piece.text.to_ascii_lowercase())
    }
}

/// Whether the next piece is a component, or a member of a module or a type.
fn is_member(before: &PlacedLexeme<'_>) -> bool {
    matches!(before.lexeme, Lexeme::Dot | Lexeme::Scope)
}

/// A name and its other spellings.
fn names(name: &'static str, aliases: &'static [&'static str]) -> impl Iterator<Item = &'static str> {
    std::iter::once(name).chain(aliases.iter().copied())
}

/// The spelling of the name that equals `written`, if there is one.
fn one_of(mut names: impl Iterator<Item = &'static str>, written: &str) -> Option<&'static str> {
    names.find(|name| name.eq_ignore_ascii_case(written))
}

fn type_name(written: &str) -> Option<&'static str> {
    let plain = catalog::type_names().filter(|(_, base)| !base.is_system());
    one_of(plain.map(|(name, _)| name), written)
}

/// `$NAME`, a variable or a type, by its folded name.
static SYSTEM: LazyLock<HashMap<String, String>> = LazyLock::new(|| {
    let types = catalog::type_names().filter(|(_, base)| base.is_system()).map(|(name, _)| name);
    let variables = catalog::system_variables().flat_map(|found| names(found.name, found.aliases));
    let elements = catalog::system_variables().flat_map(catalog::SystemVariable::element_names);
    let names = types.chain(variables).map(String::from).chain(elements);
    names.map(|name| (name.to_ascii_lowercase(), format!("${name}"))).collect()
});

fn system(written: &str) -> Option<&'static str> {
    SYSTEM.get(&written.strip_prefix('$')?.to_ascii_lowercase()).map(String::as_str)
}

fn entry_name(entries: &'static [Entry], written: &str) -> Option<&'static str> {
    one_of(entries.iter().flat_map(|entry| names(entry.name, entry.aliases)), written)
}

fn label(entries: &'static [Entry], written: &str) -> Option<&'static str> {
    let params = entries.iter().flat_map(|entry| entry.params);
    one_of(params.flat_map(|param| names(param.name, param.aliases)), written)
}

/// A constant of the enumeration `scope`.
fn constant(scope: &PlacedLexeme<'_>, written: &str) -> Option<&'static str> {
    let Some(Base::Enum(id)) = catalog::base_type(scope.text.trim_start_matches('$')) else { return None };
    let constants = id.def().constants.iter();
    one_of(constants.flat_map(|found| names(found.name, found.aliases)), written)
}
