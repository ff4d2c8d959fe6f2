//! The words of the language: which are reserved, and what each of them is to the grammar.

use crate::symbol::{Interner, Symbol};
use crate::token::Token;

/// What a word is.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum Word {
    /// A name of the program or a built-in one.
    Name,
    /// A word of a control structure or a constant: always this token.
    Fixed(Token),
    /// A reserved name of a type.
    Type,
    /// A reserved name of an instruction.
    Instruction,
    /// The name of an instruction that a program may use for its own things, too.
    OpenInstruction,
}

/// The words of control structures and constants.
const FIXED: [(&str, Token); 27] = [
    ("break", Token::Break),
    ("case", Token::Case),
    ("const", Token::Const),
    ("continue", Token::Continue),
    ("default", Token::Default),
    ("else", Token::Else),
    ("elseif", Token::ElseIf),
    ("endfor", Token::EndFor),
    ("endfunc", Token::EndFunc),
    ("endif", Token::EndIf),
    ("endl", Token::Endl),
    ("endloop", Token::EndLoop),
    ("endswitch", Token::EndSwitch),
    ("endwhile", Token::EndWhile),
    ("false", Token::False),
    ("for", Token::For),
    ("func", Token::Func),
    ("goto", Token::Goto),
    ("if", Token::If),
    ("import", Token::Import),
    ("loop", Token::Loop),
    ("repeat", Token::Repeat),
    ("return", Token::Return),
    ("switch", Token::Switch),
    ("true", Token::True),
    ("until", Token::Until),
    ("while", Token::While),
];

/// The types whose names are reserved.
const TYPES: &str = "bool byte clock controlmode double frame int joint jvel num_base parity pos pose printto slip \
     speed stopbits stoptype string tool toolinertiapara uint void weavedata weaverotaxis weaveshape wobj";

/// The instructions whose names are reserved.
const INSTRUCTIONS: &str = "accset ccir cir compen endcompen endweave exit interrupt lin movej pause print ptp \
     restart scan startcompen startmove startweave stopmove timer toolload toolswitch trigger velset waittime waituntil";

/// The instructions whose names are not reserved.
const OPEN_INSTRUCTIONS: &str =
    "delint disableint enableint enddetect jump setdoimv spl startdetect startweavelin startweavespa";

/// All words of the language.
fn all_words() -> impl Iterator<Item = (&'static str, Word)> {
    let fixed = FIXED.iter().map(|(word, token)| (*word, Word::Fixed(*token)));
    let types = TYPES.split_whitespace().map(|word| (word, Word::Type));
    let instructions = INSTRUCTIONS.split_whitespace().map(|word| (word, Word::Instruction));
    let open = OPEN_INSTRUCTIONS.split_whitespace().map(|word| (word, Word::OpenInstruction));
    fixed.chain(types).chain(instructions).chain(open)
}

/// Whether `name` may not be a program's own name.
pub fn is_reserved(name: &str) -> bool {
    all_words().any(|(word, kind)| kind != Word::OpenInstruction && word.eq_ignore_ascii_case(name))
}

/// All words of the language: of control structures, of constants, of types and of instructions.
pub fn language_words() -> impl Iterator<Item = &'static str> {
    all_words().map(|(word, _)| word)
}

/// The words of control structures and constants, sorted.
pub fn control_words() -> impl Iterator<Item = &'static str> {
    FIXED.iter().map(|(word, _)| *word)
}

/// The spelling of a word of a control structure or a constant, where `name` is one in any case.
pub fn control_word(name: &str) -> Option<&'static str> {
    control_words().find(|word| word.eq_ignore_ascii_case(name))
}

/// The token of a word of a control structure or a constant, where `name` is one in any case.
pub(crate) fn control_token(name: &str) -> Option<Token> {
    FIXED.iter().find(|(word, _)| word.eq_ignore_ascii_case(name)).map(|(_, token)| *token)
}

/// The kind of each interned name, by its symbol.
pub(crate) struct Vocabulary {
    words: Vec<Word>,
}

impl Vocabulary {
    /// Interns the words of the language and remembers what they are.
    pub(crate) fn new(interner: &mut Interner) -> Self {
        let mut words = Vec::new();
        for (word, kind) in all_words() {
            let at = interner.intern(word).index();
            if at >= words.len() {
                words.resize(at + 1, Word::Name);
            }
            if let Some(place) = words.get_mut(at) {
                *place = kind;
            }
        }
        Self { words }
    }

    /// The kind of the word `symbol`.
    pub(crate) fn word(&self, symbol: Symbol) -> Word {
        self.words.get(symbol.index()).copied().unwrap_or(Word::Name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_word_is_what_the_tables_say() {
        let mut interner = Interner::new();
        interner.intern("early");
        let words = Vocabulary::new(&mut interner);
        let late = interner.intern("late");
        assert_eq!(words.word(late), Word::Name);
        assert_eq!(interner.find("early").map(|symbol| words.word(symbol)), Some(Word::Name));
        for (word, kind) in all_words() {
            assert_eq!(word, word.to_ascii_lowercase());
            assert_eq!(interner.find(word).map(|symbol| words.word(symbol)), Some(kind), "{word}");
        }
        assert_eq!(all_words().count(), 27 + 27 + 26 + 10);
    }

    #[test]
    fn reserved_words_ignore_case() {
        assert!(is_reserved("EndWhile") && is_reserved("ToolInertiaPara") && is_reserved("movej"));
        assert!(!is_reserved("jump") && !is_reserved("abs") && !is_reserved("socket"));
    }
}
