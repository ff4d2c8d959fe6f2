//! What each lexeme of a text is to the grammar, and what each line means for the blocks: for tools that work on the
//! text itself and decide as the parser does.

use crate::adapt::PlacedLexeme;
use crate::blocks::Doubts;
use crate::explain::is_word;
use crate::lexer::Lexeme;
use crate::line::{Line, LineKind};
use crate::recovery::condition_end;
use crate::syntax_error::{BlockKind, SyntaxError, SyntaxErrorKind};
use crate::token::{Placed, Token};

/// What a lexeme is to the grammar.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub enum LexemeRole {
    /// A name of the program or a built-in one; also a reserved word where only a name is possible.
    Name,
    /// `true`, `false` or `endl`.
    Constant,
    /// A word of a control structure.
    Reserved,
    /// The reserved name of a type.
    Type,
    /// The name of an instruction at the start of a statement.
    Instruction,
    /// The label of an argument, without its colon.
    Label,
    /// The colon of an argument's label, or of a label on a line of its own.
    LabelColon,
    /// The name of a component in braces, in front of its value.
    Component,
    /// The name of a label on a line of its own.
    Target,
    /// A unit, or a part of it, that is not part of its number's lexeme.
    Unit,
    /// Everything else; the lexeme itself tells what it is.
    #[default]
    Other,
}

/// The role of a lexeme.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct PlacedRole {
    /// The offset of the lexeme's first byte.
    pub start: u32,
    /// Its role.
    pub role: LexemeRole,
    /// Whether a statement begins with it: at the start of the line, after the condition of an `if` on one line, after
    /// the colon of a case.
    pub begins: bool,
}

/// What a line means for the blocks.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Turn {
    /// Nothing.
    None,
    /// It opens a block.
    Open(BlockKind),
    /// It could not be read, and may or may not open a block.
    MayOpen(BlockKind),
    /// It begins another branch or case of a block of this kind.
    Branch(BlockKind),
    /// It closes a block of this kind.
    Close(BlockKind),
    /// It closes the innermost block in another language's words; `true` if that is a function.
    CloseOther(bool),
    /// A `{` alone.
    OpenBrace,
    /// A `}` alone.
    CloseBrace,
}

/// What a line, or its part after the colon of a case, means for the blocks.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct PlacedTurn {
    /// An offset in the line.
    pub start: u32,
    /// The turn.
    pub turn: Turn,
    /// Whether it ends with a `{`, as in other languages.
    pub braced: bool,
}

/// The outline of a text.
#[derive(Clone, Default, Debug)]
pub struct Outline {
    /// The roles of the lexemes, in the order of the text; those of lines with mistakes may be missing.
    pub roles: Vec<PlacedRole>,
    /// What the lines mean for the blocks, in the order of the text.
    pub turns: Vec<PlacedTurn>,
    /// The offsets of mistakes in the form of a line, in no order. Mistakes that only concern how lines fit together as
    /// blocks are not among them.
    pub mistakes: Vec<u32>,
}

impl Outline {
    /// Notes the lexemes of a part of a line; `tokens` is what the adapter made of them.
    pub(crate) fn note_part(&mut self, lexemes: &[PlacedLexeme], tokens: &[Placed]) {
        let statement = match tokens.first() {
            Some((_, Token::If, _)) => condition_end(tokens).and_then(|at| tokens.get(at)),
            _ => None,
        };
        let mut remaining = tokens.iter().peekable();
        let mut end = 0;
        for (at, (start, lexeme, to)) in lexemes.iter().enumerate() {
            let role = match remaining.next_if(|token| token.0 == *start) {
                Some(token) => {
                    end = token.2;
                    // A number and its unit are one lexeme and two tokens.
                    remaining.next_if(|token| token.0 < *to);
                    role_of(token.1)
                }
                None if *start < end => LexemeRole::Unit,
                None if *lexeme == Lexeme::Colon => LexemeRole::LabelColon,
                None => LexemeRole::Other,
            };
            let begins = at == 0 || statement.is_some_and(|statement| statement.0 == *start);
            self.roles.push(PlacedRole { start: *start, role, begins });
        }
    }

    /// Notes a line as it goes to the blocks.
    pub(crate) fn note_line(&mut self, line: &Line, doubts: Doubts) {
        let turn = match turn_of(&line.kind) {
            Turn::Open(kind) if doubts.may_open => Turn::MayOpen(kind),
            turn => turn,
        };
        self.turns.push(PlacedTurn { start: line.span.start, turn, braced: doubts.braced });
    }

    /// Notes the mistakes in the form of lines.
    pub(crate) fn note_mistakes(&mut self, errors: &[SyntaxError]) {
        let of_lines = errors.iter().filter(|error| !is_about_blocks(&error.kind));
        self.mistakes.extend(of_lines.map(|error| error.span.start));
    }
}

fn role_of(token: Token) -> LexemeRole {
    match token {
        Token::Name(_) => LexemeRole::Name,
        Token::Type(_) => LexemeRole::Type,
        Token::Instruction(_) => LexemeRole::Instruction,
        Token::Label(_) => LexemeRole::Label,
        Token::Component(_) => LexemeRole::Component,
        Token::Target(_) => LexemeRole::Target,
        Token::True | Token::False | Token::Endl => LexemeRole::Constant,
        Token::Unit(_) => LexemeRole::Unit,
        token if is_word(token) => LexemeRole::Reserved,
        _ => LexemeRole::Other,
    }
}

fn turn_of(kind: &LineKind) -> Turn {
    match kind {
        LineKind::Statement(_) | LineKind::Import(_) => Turn::None,
        LineKind::Func(_) => Turn::Open(BlockKind::Func),
        LineKind::If(_) => Turn::Open(BlockKind::If),
        LineKind::While(_) => Turn::Open(BlockKind::While),
        LineKind::Repeat => Turn::Open(BlockKind::Repeat),
        LineKind::Loop => Turn::Open(BlockKind::Loop),
        LineKind::For(_) => Turn::Open(BlockKind::For),
        LineKind::Switch(_) => Turn::Open(BlockKind::Switch),
        LineKind::ElseIf(_) | LineKind::Else => Turn::Branch(BlockKind::If),
        LineKind::Case(_) | LineKind::Default => Turn::Branch(BlockKind::Switch),
        LineKind::EndFunc => Turn::Close(BlockKind::Func),
        LineKind::EndIf => Turn::Close(BlockKind::If),
        LineKind::EndWhile => Turn::Close(BlockKind::While),
        LineKind::Until(_) => Turn::Close(BlockKind::Repeat),
        LineKind::EndLoop => Turn::Close(BlockKind::Loop),
        LineKind::EndFor => Turn::Close(BlockKind::For),
        LineKind::EndSwitch => Turn::Close(BlockKind::Switch),
        LineKind::BraceOpen => Turn::OpenBrace,
        LineKind::BraceClose => Turn::CloseBrace,
        LineKind::OtherEnd(_, function) => Turn::CloseOther(*function),
    }
}

/// Whether a mistake does not concern the line where it is reported, but how lines fit together.
fn is_about_blocks(kind: &SyntaxErrorKind) -> bool {
    use SyntaxErrorKind as K;
    matches!(
        kind,
        K::UnclosedBlock(..)
            | K::StrayEnd(_)
            | K::WrongEnd(..)
            | K::OutsideFunction
            | K::FuncAmongStatements
            | K::ImportInside
            | K::BeforeFirstCase
            | K::CaseOutsideSwitch
            | K::BranchOutsideIf(_)
            | K::BranchAfterElse(_)
            | K::SecondDefault
            | K::TooManyBlocks
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::outline;

    /// The roles with the words they belong to.
    fn roles(source: &str) -> Vec<(&str, LexemeRole)> {
        let word = |start: u32| {
            let rest = source.get(start as usize..).unwrap_or_default();
            rest.split(|c: char| !c.is_ascii_alphanumeric()).next().unwrap_or_default()
        };
        let outline = outline(source);
        let words = outline.roles.iter().filter(|role| role.role != LexemeRole::Other);
        words.map(|role| (word(role.start), role.role)).collect()
    }

    #[test]
    fn roles_are_what_the_grammar_sees() {
        use LexemeRole as R;
        assert_eq!(
            roles("lin p:p1,vl:100 mm/s,vp:50%"),
            [
                ("lin", R::Instruction),
                ("p", R::Label),
                ("", R::LabelColon),
                ("p1", R::Name),
                ("vl", R::Label),
                ("", R::LabelColon),
                ("mm", R::Unit),
                ("", R::Unit),
                ("s", R::Unit),
                ("vp", R::Label),
                ("", R::LabelColon),
                ("", R::Unit),
            ]
        );
        assert_eq!(roles("pose p={x a%2}"), [("pose", R::Type), ("p", R::Name), ("x", R::Component), ("a", R::Name)]);
    }

    #[test]
    fn statements_begin_behind_conditions_and_cases() {
        let begins = |source: &str| -> Vec<u32> {
            outline(source).roles.iter().filter(|role| role.begins).map(|role| role.start).collect()
        };
        assert_eq!(begins("if(a)++i"), [0, 5]);
        assert_eq!(begins("if((a)+(b))\ncase 1:x=2"), [0, 12, 19]);
    }

    #[test]
    fn lines_turn_as_in_the_parser() {
        let turns = |source: &str| -> Vec<Turn> { outline(source).turns.iter().map(|turn| turn.turn).collect() };
        assert_eq!(turns("if(a) b=1\nif(a)\nend if"), [Turn::None, Turn::Open(BlockKind::If), Turn::CloseOther(false)]);
        assert_eq!(turns("if(a b=1\n}"), [Turn::MayOpen(BlockKind::If), Turn::CloseBrace]);
    }

    #[test]
    fn mistakes_are_those_of_lines() {
        assert_eq!(outline("func void f()\nx = = 2\nif(a)\nendfunc\nendif").mistakes, [18]);
    }
}
