//! The kinds of mistakes in the form of a program, and their texts.

use crate::other_motions::OtherMotion;
use crate::span::Span;
use std::fmt;

/// A mistake in the form of a program.
#[derive(Clone, PartialEq, Debug)]
pub struct SyntaxError {
    /// What is wrong.
    pub kind: SyntaxErrorKind,
    /// Where it is.
    pub span: Span,
    /// Other places that explain the mistake, each with a text.
    pub related: Vec<(Span, String)>,
}

impl SyntaxError {
    /// An error at one place.
    pub fn new(kind: SyntaxErrorKind, span: Span) -> Self {
        Self { kind, span, related: Vec::new() }
    }

    /// Adds another place that explains the mistake.
    #[must_use]
    pub fn with(mut self, span: Span, words: impl Into<String>) -> Self {
        self.related.push((span, words.into()));
        self
    }
}

impl fmt::Display for SyntaxError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.kind.message())
    }
}

impl std::error::Error for SyntaxError {}

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
    /// The opening bracket.
    pub const fn open(self) -> &'static str {
        match self {
            Bracket::Paren => "(",
            Bracket::Square => "[",
            Bracket::Brace => "{",
        }
    }

    /// The closing bracket.
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
    /// The word that opens the block.
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

    /// The word that closes the block.
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
    /// `if a == 1`: the condition needs parentheses.
    ConditionParens,
    /// `int(x)`: types do not convert.
    Conversion,
    /// `if(a) if(b) ...`: the compact `if` takes a simple statement.
    CompactIf,
    /// A declaration after a compact `if`.
    CompactDeclaration,
    /// `else x = 1`.
    ElseAlone,
    /// The parts of a `for` are separated by `;`.
    For,
    /// A `;` is followed by an event, a comma and an action.
    Events,
    /// `int a[] = ...` lacks the size.
    ArraySize,
    /// `joint j = j:{...}`: a label outside arguments.
    Label,
    /// An instruction in the place of a value.
    InstructionValue,
    /// `; text` and `! text` of other languages.
    Comment,
    /// `int[3] a`: the sizes come after the name.
    SizeBehindName,
    /// `int $a`: only system variables have a `$`.
    PlainName,
    /// `setdo 1, true`: a function's arguments need parentheses.
    FunctionParens,
    /// `p[0.1, 0.2, ...]`: a pose as URScript writes it.
    PoseLiteral,
    /// `lib.inc(3)`: what is called of a module.
    ModuleCall,
    /// `void func f()`: the type of the result before `func`.
    TypeBehindFunc,
    /// `case 1, 2:`: several values in a case.
    OneCase,
    /// `vl:100mm/sec`, `sl:20 cm`: units that ARL does not have, or a space before one.
    Units,
    /// `double d = 3,5`: a decimal comma.
    DecimalPoint,
    /// `pose p = (1, 2, 3)`: the values of a structure in parentheses.
    Braces,
    /// `import lib`: the path of a module without its quotes.
    ImportQuotes,
}

/// Where a statement continues across the end of a line.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum LineBreak {
    /// After the marked end of a line.
    Behind,
    /// The marked place is the beginning of the next line.
    Before,
}

/// Declares the kinds: number, title, description.
macro_rules! syntax_errors {
    ($dollar:tt $($number:literal $title:literal =>
        $(#[doc = $doc:literal])+ $variant:ident $(($($tuple:tt)*))? $({ $($fields:tt)* })?,)+
    ) => {
        /// The kinds of mistakes in the form of a program.
        #[derive(Clone, PartialEq, Debug)]
        pub enum SyntaxErrorKind {
            $($(#[doc = $doc])+ $variant $(($($tuple)*))? $({ $($fields)* })?,)+
        }

        impl SyntaxErrorKind {
            /// Its number: 101.. for characters and numbers, 120.. for lines, 140.. for blocks, 154.. for words of
            /// other languages. Numbers never change.
            pub const fn number(&self) -> u16 {
                match self {
                    $(Self::$variant { .. } => $number,)+
                }
            }
        }

        /// Every number with its title.
        pub const TITLES: &[(u16, &str)] = &[$(($number, $title)),+];

        /// Gives every number with its title, as literals, to the macro of that name.
        #[doc(hidden)]
        #[macro_export]
        macro_rules! each_syntax_code {
            ($dollar then:ident) => {
                $dollar then! { $($number $title)+ }
            };
        }
    };
}

syntax_errors! { $
    101 "A character that means nothing in ARL" =>
        /// A character that means nothing in ARL.
        UnknownCharacter(char),
    102 "A character that only looks like the one that was meant" =>
        /// A character from outside ASCII that looks like one that was meant: what was found, what was meant.
        LooksLike(char, char),
    103 "Letters that are not allowed in a name" =>
        /// Letters from outside ASCII in a name.
        ForeignLetters(Box<str>),
    104 "A string without its closing quote" =>
        /// A string without its closing quote.
        UnclosedText,
    105 "A block comment that is not closed" =>
        /// A block comment that is not closed.
        UnclosedComment,
    106 "An escape that strings do not have" =>
        /// An escape that strings do not have.
        BadEscape(char),
    107 "An int beyond 32 bits" =>
        /// An int that needs more than 32 bits.
        IntTooLarge(Box<str>),
    108 "A double that is too large" =>
        /// A double that is too large.
        DoubleTooLarge,
    109 "A binary number with digits other than 0 and 1" =>
        /// A binary number with digits other than 0 and 1.
        BinaryDigits(Box<str>),
    110 "An exponent without digits" =>
        /// An exponent without digits.
        NoExponent(Box<str>),
    111 "A hexadecimal number in another language's notation" =>
        /// `0x3e`: its value.
        OtherHexadecimal(u32),
    112 "A word that begins like a number but is not one" =>
        /// A word that begins like a number but is not one.
        BadNumber(Box<str>),
    113 "A `$` without a name" =>
        /// `$` without a name.
        BareDollar,
    114 "A `\\` before the end of its line" =>
        /// `\` before the end of the line.
        Backslash,
    115 "Text in single quotes" =>
        /// Text in single quotes.
        SingleQuotes,
    116 "A Rust value outside of the macro" =>
        /// `#name` outside the macro.
        SpliceOutsideMacro,
    117 "A `#` that splices nothing" =>
        /// `#` that splices nothing.
        BareSplice,
    118 "A file of 4 GB or more" =>
        /// A file of 4 GB or more.
        FileTooLarge,

    120 "Something that is not allowed here" =>
        /// Something that is not allowed here.
        Unexpected {
            /// What was found.
            found: Box<str>,
            /// What would have been accepted there.
            expected: Box<str>,
            /// A hint at the remedy.
            hint: Hint,
        },
    121 "A line that ends too early" =>
        /// The line ends where something is missing.
        EndsEarly {
            /// What could have followed.
            expected: Box<str>,
            /// A hint at the remedy.
            hint: Hint,
        },
    122 "A closing bracket is missing" =>
        /// A closing bracket is missing.
        MissingClose(Bracket),
    123 "A closing bracket that closes nothing" =>
        /// A closing bracket that closes nothing.
        StrayClose(Bracket),
    124 "A bracket closed by another kind of bracket" =>
        /// A bracket is closed by another kind's: opened, found.
        WrongClose(Bracket, Bracket),
    125 "A comma is missing" =>
        /// A comma is missing before this.
        MissingComma(Box<str>),
    126 "The colon of a case is missing" =>
        /// The colon after `case x` or `default` is missing.
        MissingColon,
    127 "A value is missing" =>
        /// A value is missing between these two; the second is empty at the end of the line.
        MissingValue(Box<str>, Box<str>),
    128 "A `;` at the end of a line" =>
        /// A `;` at the end of the line.
        Semicolon,
    129 "Two statements on one line" =>
        /// Two statements on one line.
        SeveralStatements,
    130 "A reserved word where a name belongs" =>
        /// A reserved word where a name belongs.
        ReservedWord(Box<str>),
    131 "A label with something after it" =>
        /// A label with something after it.
        LabelNotAlone(Box<str>),
    132 "`else if` instead of `elseif`" =>
        /// `else if`
        ElseIf,
    133 "A word of another language after a condition" =>
        /// `then`, `do` and the like after a condition.
        Then(Box<str>),
    134 "A block in braces" =>
        /// A block in braces.
        BlockBrace,
    135 "An assignment to something that is not a variable" =>
        /// An assignment to something that is not a variable.
        NotAssignable(Box<str>),
    136 "A unit that does not follow the value of an argument" =>
        /// A unit that does not follow the value of an argument.
        MisplacedUnit,
    137 "An expression with too many levels" =>
        /// Too many levels of brackets, operators or members in one expression.
        TooManyLevels,
    138 "A colon after the name of a component" =>
        /// `{x:1}`
        ComponentColon(Box<str>),
    139 "A start value with an operator" =>
        /// `int a += 1`
        CompoundStartValue,

    140 "A block that is never closed" =>
        /// A block that is never closed; a function's name, empty for others.
        UnclosedBlock(BlockKind, Box<str>),
    141 "A closing line without a block" =>
        /// A closing line without a block.
        StrayEnd(BlockKind),
    142 "A block closed by another block's word" =>
        /// A block that is closed by another kind's word: opened, the line that opens it, found.
        WrongEnd(BlockKind, u32, BlockKind),
    143 "A statement outside of functions" =>
        /// A statement outside functions.
        OutsideFunction,
    144 "A function among statements" =>
        /// A function among statements of the macro.
        FuncAmongStatements,
    145 "`import` inside a function" =>
        /// `import` inside a function.
        ImportInside,
    146 "A statement before the first case" =>
        /// A statement between `switch` and the first `case`.
        BeforeFirstCase,
    147 "A case without its switch" =>
        /// `case` or `default` without a `switch`.
        CaseOutsideSwitch,
    148 "A branch without its if" =>
        /// `elseif` or `else` without an `if`.
        BranchOutsideIf(&'static str),
    149 "A branch after the else" =>
        /// `elseif` or `else` after `else`.
        BranchAfterElse(&'static str),
    150 "A second default" =>
        /// A second `default`.
        SecondDefault,
    151 "Too many nested blocks" =>
        /// Too many nested blocks.
        TooManyBlocks,
    152 "The end of a block in another language's words" =>
        /// `end if`, `end`, `wend`: what was written, the block, the line that opens it.
        OtherEnd(Box<str>, BlockKind, u32),
    153 "Not exactly one expression" =>
        /// More than one statement where a single expression is expected.
        NotOneExpression,
    154 "A word of another language" =>
        /// A word that another language has for something: the word, and what ARL has.
        OtherWord(Box<str>, &'static str),
    155 "An operator of another language" =>
        /// An operator as another language writes it: what was found, what ARL writes.
        OtherOperator(Box<str>, &'static str),
    156 "A misspelled keyword of a control structure" =>
        /// `whlie`: what was written, what was meant.
        Misspelt(Box<str>, &'static str),
    157 "A statement that continues on the next line" =>
        /// A statement whose lines are not joined by `\`.
        LineBreak(LineBreak),
    158 "A motion of another language" =>
        /// A motion as another language writes it.
        OtherMotion(Box<OtherMotion>),
}

/// The most brackets that may be open at one place.
pub const BRACKET_LEVELS: usize = 200;

/// The most blocks that may be open at one place.
pub const BLOCK_LEVELS: usize = 200;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_in_order_and_unique() {
        assert!(TITLES.windows(2).all(|pair| pair[0].0 < pair[1].0));
        assert_eq!(SyntaxErrorKind::NotOneExpression.number(), 153);
    }
}
