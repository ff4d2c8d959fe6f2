//! What can be wrong with the form of a program, and the words for it.

use crate::span::Span;

/// A mistake in the form of a program.
#[derive(Clone, PartialEq, Debug)]
pub struct SyntaxError {
    /// What is wrong.
    pub kind: SyntaxErrorKind,
    /// Where.
    pub span: Span,
    /// Other places that explain it, each with its words.
    pub related: Vec<(Span, String)>,
}

impl SyntaxError {
    /// An error at one place.
    pub fn new(kind: SyntaxErrorKind, span: Span) -> Self {
        Self { kind, span, related: Vec::new() }
    }

    /// The same with another place that explains it.
    #[must_use]
    pub fn with(mut self, span: Span, words: impl Into<String>) -> Self {
        self.related.push((span, words.into()));
        self
    }
}

/// A pair of brackets.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Bracket {
    /// `(` and `)`
    Paren,
    /// `[` and `]`
    Square,
    /// `{` and `}`
    Brace,
}

impl Bracket {
    /// The opening one.
    pub const fn open(self) -> &'static str {
        match self {
            Bracket::Paren => "(",
            Bracket::Square => "[",
            Bracket::Brace => "{",
        }
    }

    /// The closing one.
    pub const fn close(self) -> &'static str {
        match self {
            Bracket::Paren => ")",
            Bracket::Square => "]",
            Bracket::Brace => "}",
        }
    }
}

/// What opens a block.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum BlockKind {
    /// `func` to `endfunc`
    Func,
    /// `if` to `endif`
    If,
    /// `while` to `endwhile`
    While,
    /// `repeat` to `until`
    Repeat,
    /// `loop` to `endloop`
    Loop,
    /// `for` to `endfor`
    For,
    /// `switch` to `endswitch`
    Switch,
}

impl BlockKind {
    /// The word that opens it.
    pub const fn opener(self) -> &'static str {
        match self {
            BlockKind::Func => "func",
            BlockKind::If => "if",
            BlockKind::While => "while",
            BlockKind::Repeat => "repeat",
            BlockKind::Loop => "loop",
            BlockKind::For => "for",
            BlockKind::Switch => "switch",
        }
    }

    /// The word that closes it.
    pub const fn closer(self) -> &'static str {
        match self {
            BlockKind::Func => "endfunc",
            BlockKind::If => "endif",
            BlockKind::While => "endwhile",
            BlockKind::Repeat => "until",
            BlockKind::Loop => "endloop",
            BlockKind::For => "endfor",
            BlockKind::Switch => "endswitch",
        }
    }

    /// The closing line as it is written.
    pub(crate) const fn closing_line(self) -> &'static str {
        match self {
            BlockKind::Repeat => "until(condition)",
            other => other.closer(),
        }
    }
}

/// What a line that the grammar refuses would need, where it is known.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Hint {
    /// Nothing special is known.
    None,
    /// `func main()` lacks the type of the result.
    ResultType,
    /// `func void add(int &a)`: there are no references.
    References,
    /// `b[1,2]`: each index has brackets of its own.
    OneIndex,
    /// `print("a", 1)`: an instruction's arguments have no parentheses around them.
    InstructionParens,
    /// `if(a) && (b)`: the parentheses go around the whole condition.
    WholeCondition,
    /// `if a == 1`: the condition stands in parentheses.
    ConditionParens,
    /// `int(x)`: types do not convert.
    Conversion,
    /// `if(a) if(b) ...`: the compact `if` takes a simple statement.
    CompactIf,
    /// A declaration behind a compact `if`.
    CompactDeclaration,
    /// `else x = 1`.
    ElseAlone,
    /// The parts of a `for` are separated by `;`.
    For,
    /// Behind `;` stand an event, a comma and an action.
    Events,
    /// `int a[] = ...` lacks the size.
    ArraySize,
    /// `joint j = j:{...}`: a label outside of arguments.
    Label,
    /// An instruction in the place of a value.
    InstructionValue,
}

/// The kinds of mistakes in the form of a program.
#[derive(Clone, PartialEq, Debug)]
pub enum SyntaxErrorKind {
    /// A character that means nothing in ARL.
    UnknownCharacter(char),
    /// A character from outside ASCII that looks like one that was meant: what was found, what was meant.
    LooksLike(char, char),
    /// Letters from outside ASCII in a name.
    ForeignLetters(Box<str>),
    /// A string without its closing quote.
    UnclosedText,
    /// A block comment without its end.
    UnclosedComment,
    /// An escape that strings do not have.
    BadEscape(char),
    /// An int that needs more than 32 bits.
    IntTooLarge(Box<str>),
    /// A double beyond the largest one.
    DoubleTooLarge,
    /// A binary number with other digits than 0 and 1.
    BinaryDigits(Box<str>),
    /// An exponent without digits.
    NoExponent(Box<str>),
    /// `0x3e`: its value.
    OtherHexadecimal(u32),
    /// A word that begins like a number and is none.
    BadNumber(Box<str>),
    /// `$` without a name.
    BareDollar,
    /// `\` before the end of the line.
    Backslash,
    /// Text in single quotes.
    SingleQuotes,
    /// `#name` outside of the macro.
    SpliceOutsideMacro,
    /// `#` that splices nothing.
    BareSplice,
    /// A file of 4 GB or more.
    FileTooLarge,

    /// Something that cannot stand here.
    Unexpected {
        /// What was found.
        found: Box<str>,
        /// What could have stood there.
        expected: Box<str>,
        /// What may help.
        hint: Hint,
    },
    /// The line ends where something is missing.
    EndsEarly {
        /// What could have followed.
        expected: Box<str>,
        /// What may help.
        hint: Hint,
    },
    /// A closing bracket is missing.
    MissingClose(Bracket),
    /// A closing bracket that closes nothing.
    StrayClose(Bracket),
    /// A bracket is closed by another kind's: opened, found.
    WrongClose(Bracket, Bracket),
    /// A comma is missing in front of this.
    MissingComma(Box<str>),
    /// The colon behind `case x` or `default` is missing.
    MissingColon,
    /// A value is missing between these two; the second is empty at the end of the line.
    MissingValue(Box<str>, Box<str>),
    /// A `;` at the end of the line.
    Semicolon,
    /// Two statements on one line.
    SeveralStatements,
    /// A reserved word where a name belongs.
    ReservedWord(Box<str>),
    /// A label with something behind it.
    LabelNotAlone(Box<str>),
    /// `else if`
    ElseIf,
    /// `then`, `do` and the like behind a condition.
    Then(Box<str>),
    /// A block in braces.
    BlockBrace,
    /// An assignment to something that is no variable.
    NotAssignable(Box<str>),
    /// A unit that is not behind the value of an argument.
    MisplacedUnit,
    /// Too many levels of brackets, operators or members in one expression.
    TooManyLevels,
    /// `{x:1}`
    ComponentColon(Box<str>),
    /// `int a += 1`
    CompoundStartValue,

    /// A block that is never closed; a function's name, empty for others.
    UnclosedBlock(BlockKind, Box<str>),
    /// A closing line without a block.
    StrayEnd(BlockKind),
    /// A block that is closed by another kind's word: opened, the line that opens it, found.
    WrongEnd(BlockKind, u32, BlockKind),
    /// A statement outside of functions.
    OutsideFunction,
    /// A function among statements of the macro.
    FuncAmongStatements,
    /// `import` inside a function.
    ImportInside,
    /// A statement between `switch` and the first `case`.
    BeforeFirstCase,
    /// `case` or `default` without a `switch`.
    CaseOutsideSwitch,
    /// `elseif` or `else` without an `if`.
    BranchOutsideIf(&'static str),
    /// `elseif` or `else` behind `else`.
    BranchAfterElse(&'static str),
    /// A second `default`.
    SecondDefault,
    /// Too many blocks in blocks.
    TooManyBlocks,
    /// `end if`, `end`, `wend`: what was written, the block, the line that opens it.
    OtherEnd(Box<str>, BlockKind, u32),
    /// More than one statement where a single expression was asked for.
    NotOneExpression,
}

/// How many brackets may be open at one place.
pub const BRACKET_LEVELS: usize = 200;

/// How many blocks may be open at one place.
pub const BLOCK_LEVELS: usize = 200;

/// A kind's number and its title.
macro_rules! numbers {
    ($($number:literal $pattern:pat => $title:literal,)*) => {
        impl SyntaxErrorKind {
            /// Its number: 101.. for characters and numbers, 120.. for lines, 140.. for blocks. Numbers never change.
            pub const fn number(&self) -> u16 {
                match self {
                    $($pattern => $number,)*
                }
            }
        }

        /// Every number with its title.
        pub const TITLES: &[(u16, &str)] = &[$(($number, $title),)*];
    };
}

numbers! {
    101 SyntaxErrorKind::UnknownCharacter(_) => "A character that means nothing in ARL",
    102 SyntaxErrorKind::LooksLike(..) => "A character that only looks like the one that was meant",
    103 SyntaxErrorKind::ForeignLetters(_) => "Letters in a name that names cannot have",
    104 SyntaxErrorKind::UnclosedText => "A string without its closing quote",
    105 SyntaxErrorKind::UnclosedComment => "A block comment without its end",
    106 SyntaxErrorKind::BadEscape(_) => "An escape that strings do not have",
    107 SyntaxErrorKind::IntTooLarge(_) => "An int beyond 32 bits",
    108 SyntaxErrorKind::DoubleTooLarge => "A double beyond the largest one",
    109 SyntaxErrorKind::BinaryDigits(_) => "A binary number with other digits than 0 and 1",
    110 SyntaxErrorKind::NoExponent(_) => "An exponent without digits",
    111 SyntaxErrorKind::OtherHexadecimal(_) => "A hexadecimal number in another language's notation",
    112 SyntaxErrorKind::BadNumber(_) => "A word that begins like a number and is none",
    113 SyntaxErrorKind::BareDollar => "A `$` without a name",
    114 SyntaxErrorKind::Backslash => "A `\\` before the end of its line",
    115 SyntaxErrorKind::SingleQuotes => "Text in single quotes",
    116 SyntaxErrorKind::SpliceOutsideMacro => "A Rust value outside of the macro",
    117 SyntaxErrorKind::BareSplice => "A `#` that splices nothing",
    118 SyntaxErrorKind::FileTooLarge => "A file of 4 GB or more",
    120 SyntaxErrorKind::Unexpected { .. } => "Something that cannot stand here",
    121 SyntaxErrorKind::EndsEarly { .. } => "A line that ends too early",
    122 SyntaxErrorKind::MissingClose(_) => "A closing bracket is missing",
    123 SyntaxErrorKind::StrayClose(_) => "A closing bracket that closes nothing",
    124 SyntaxErrorKind::WrongClose(..) => "A bracket closed by another kind of bracket",
    125 SyntaxErrorKind::MissingComma(_) => "A comma is missing",
    126 SyntaxErrorKind::MissingColon => "The colon of a case is missing",
    127 SyntaxErrorKind::MissingValue(..) => "A value is missing",
    128 SyntaxErrorKind::Semicolon => "A `;` at the end of a line",
    129 SyntaxErrorKind::SeveralStatements => "Two statements on one line",
    130 SyntaxErrorKind::ReservedWord(_) => "A reserved word where a name belongs",
    131 SyntaxErrorKind::LabelNotAlone(_) => "A label with something behind it",
    132 SyntaxErrorKind::ElseIf => "`else if` instead of `elseif`",
    133 SyntaxErrorKind::Then(_) => "A word of another language behind a condition",
    134 SyntaxErrorKind::BlockBrace => "A block in braces",
    135 SyntaxErrorKind::NotAssignable(_) => "An assignment to something that is no variable",
    136 SyntaxErrorKind::MisplacedUnit => "A unit that is not behind the value of an argument",
    137 SyntaxErrorKind::TooManyLevels => "An expression with too many levels",
    138 SyntaxErrorKind::ComponentColon(_) => "A colon behind the name of a component",
    139 SyntaxErrorKind::CompoundStartValue => "A start value with an operator",
    140 SyntaxErrorKind::UnclosedBlock(..) => "A block that is never closed",
    141 SyntaxErrorKind::StrayEnd(_) => "A closing line without a block",
    142 SyntaxErrorKind::WrongEnd(..) => "A block closed by another block's word",
    143 SyntaxErrorKind::OutsideFunction => "A statement outside of functions",
    144 SyntaxErrorKind::FuncAmongStatements => "A function among statements",
    145 SyntaxErrorKind::ImportInside => "`import` inside a function",
    146 SyntaxErrorKind::BeforeFirstCase => "A statement before the first case",
    147 SyntaxErrorKind::CaseOutsideSwitch => "A case without its switch",
    148 SyntaxErrorKind::BranchOutsideIf(_) => "A branch without its if",
    149 SyntaxErrorKind::BranchAfterElse(_) => "A branch behind the else",
    150 SyntaxErrorKind::SecondDefault => "A second default",
    151 SyntaxErrorKind::TooManyBlocks => "Too many blocks in blocks",
    152 SyntaxErrorKind::OtherEnd(..) => "The end of a block in another language's words",
    153 SyntaxErrorKind::NotOneExpression => "More or less than one expression",
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_in_order_and_unique() {
        assert!(TITLES.windows(2).all(|pair| pair[0].0 < pair[1].0));
        assert_eq!(SyntaxErrorKind::NotOneExpression.number(), 153);
    }
}
