//! The words for what can be wrong with the form of a program.

use crate::syntax_error::{self, BlockKind, Hint, SyntaxErrorKind};

impl Hint {
    const fn text(self) -> Option<&'static str> {
        Some(match self {
            Hint::None => return None,
            Hint::ResultType => {
                "The type of the result comes before the name, `void` where there is none: `func void main()`."
            }
            Hint::References => {
                "Parameters are passed by value; there are no references. To change the caller's value, return it or use a global variable."
            }
            Hint::OneIndex => "Each index has brackets of its own: `b[1][2]`.",
            Hint::InstructionParens => {
                "An instruction's arguments follow its name without parentheses: `print \"a\", 1`."
            }
            Hint::WholeCondition => "The parentheses go around the whole condition: `if((a) && (b))`.",
            Hint::ConditionParens => {
                "The condition or value is written in parentheses: `if(a == 1)`, `until(a == 1)`, `switch(n)`."
            }
            Hint::Conversion => {
                "A type's name does not convert values. Use `toint`, `todouble`, `tostr` or `trunc`, or assign to a variable of the type."
            }
            Hint::CompactIf => {
                "The `if` on one line takes one simple statement. Put the inner block on lines of its own, up to its `endif`."
            }
            Hint::CompactDeclaration => {
                "The `if` on one line takes one simple statement, not a declaration: the variable would exist on this line only."
            }
            Hint::ElseAlone => "Write `else` on a line of its own, and its statements on the lines below.",
            Hint::For => "`for` has three parts with `;` between them: `for(int i=0;i<5;i++)`.",
            Hint::Events => {
                "The `;` of a motion is followed by an event, a comma and an action: `lin p1;T(1),setdo(2,true)`. Comments begin with `//`."
            }
            Hint::ArraySize => "An array's size is written between its brackets: `int a[3]`.",
            Hint::Label => "`name:` labels an argument; elsewhere, write the value alone.",
            Hint::SizeBehindName => {
                "The sizes of an array follow its name: `int a[3]`. Functions cannot return arrays."
            }
            Hint::PlainName => "Names that a program declares have no `$`: only system variables begin with it.",
            Hint::Comment => "Comments begin with `//`.",
            Hint::FunctionParens => "A function's arguments are written in parentheses: `setdo(1, true)`.",
            Hint::PoseLiteral => {
                "Poses are written in braces, in mm and deg: `{x 100, y 200, z 300, a 0, b 180, c 0}`."
            }
            Hint::ModuleCall => {
                "A component cannot be called, and there are no methods: a function gets what it works on as \
                 an argument, `function(value)`. A function of a module is written after two colons, `module::function(...)`."
            }
            Hint::TypeBehindFunc => "The type of the result follows `func`: `func void name()`.",
            Hint::OneCase => "A `case` has one value; for several values use `if`, or a function that each case calls.",
            Hint::Units => "The units are %, mm, mm/s, deg, deg/s and s, right after the number: `vl:100mm/s`.",
            Hint::DecimalPoint => "A number has a decimal point: `3.5`.",
            Hint::Braces => "The values of a structure are written in braces: `{700, 0, 600, 0, 180, 0}`.",
            Hint::ImportQuotes => "The path of a module is written in quotes: `import \"rack.arl\"`.",
            Hint::InstructionValue => "An instruction is written at the beginning of its line and has no value.",
        })
    }
}

impl syntax_error::LineBreak {
    const fn message(self) -> &'static str {
        match self {
            Self::Behind => "this statement is not complete at the end of its line",
            Self::Before => "this line continues the statement of the line above",
        }
    }

    const fn label(self) -> &'static str {
        match self {
            Self::Behind => "write `\\` after this, at the end of the line",
            Self::Before => "write `\\` at the end of the line above",
        }
    }
}

impl SyntaxErrorKind {
    /// What is wrong, in one line.
    pub fn message(&self) -> String {
        use SyntaxErrorKind::*;
        match self {
            UnknownCharacter(found) => format!("{} means nothing in ARL", show_character(*found)),
            LooksLike(found, meant) => {
                format!("this is {}, not {}", show_character(*found), show_ascii(*meant))
            }
            ForeignLetters(name) => format!("`{name}` cannot be a name"),
            UnclosedText => "this string is never closed".into(),
            UnclosedComment => "this comment is never closed".into(),
            BadEscape(escaped) => format!("strings have no escape `\\{}`", escaped.escape_default()),
            IntTooLarge(text) => format!("`{text}` does not fit into 32 bits"),
            DoubleTooLarge => "this number is beyond the largest double".into(),
            BinaryDigits(text) => format!("`{text}` is not a binary number"),
            NoExponent(text) => format!("the exponent of `{text}` has no digits"),
            OtherHexadecimal(_) => "in ARL a hexadecimal number ends with an `h`".into(),
            BadNumber(text) => format!("`{text}` is neither a number nor a name"),
            BareDollar => "a name is missing after `$`".into(),
            Backslash => "`\\` must be the last character of its line".into(),
            SingleQuotes => "strings are written in double quotes".into(),
            SpliceOutsideMacro => "Rust values can be spliced in only inside `arl!`".into(),
            BareSplice => "`#` splices nothing in".into(),
            FileTooLarge => "this file is too large".into(),
            Unexpected { found, .. } => format!("{found} is not allowed here"),
            EndsEarly { .. } => "this line ends too early".into(),
            MissingClose(bracket) => format!("`{}` is missing", bracket.close()),
            StrayClose(bracket) => format!("this `{}` closes nothing", bracket.close()),
            WrongClose(open, found) => format!("`{}` cannot close a `{}`", found.close(), open.open()),
            MissingComma(before) => format!("a comma is missing before {before}"),
            MissingColon => "the `:` of this case is missing".into(),
            MissingValue(after, before) if before.is_empty() => format!("a value is missing after {after}"),
            MissingValue(after, before) => format!("a value is missing between {after} and {before}"),
            Semicolon => "a line does not end with `;`".into(),
            SeveralStatements => "each statement needs a line of its own".into(),
            ReservedWord(word) => format!("`{word}` is a reserved word and cannot be a name"),
            LabelNotAlone(name) => format!("the label `{name}` needs a line of its own"),
            ElseIf => "`else if` is written as one word".into(),
            Then(word) => format!("ARL has no `{word}` after a condition"),
            BlockBrace => "blocks have no braces".into(),
            NotAssignable(what) => format!("{what} cannot be assigned to"),
            MisplacedUnit => "a unit can only follow the value of an argument".into(),
            TooManyLevels => "this expression has too many levels".into(),
            ComponentColon(name) => format!("there is no `:` between the component `{name}` and its value"),
            CompoundStartValue => "a start value follows a plain `=`".into(),
            UnclosedBlock(kind, name) => unclosed(*kind, name),
            StrayEnd(kind) => format!("this `{}` closes nothing: no `{}` is open", kind.closer(), kind.opener()),
            WrongEnd(open, line, found) => {
                format!("`{}` cannot close the `{}` of line {line}", found.closer(), open.opener())
            }
            OutsideFunction => "statements belong inside functions".into(),
            FuncAmongStatements => "a function cannot be defined among statements".into(),
            ImportInside => "`import` belongs outside functions".into(),
            BeforeFirstCase => "this statement belongs to no case".into(),
            CaseOutsideSwitch => "this case belongs to no `switch`".into(),
            BranchOutsideIf(word) => format!("this `{word}` belongs to no `if`"),
            BranchAfterElse(word) => format!("no `{word}` can follow the `else` of an `if`"),
            SecondDefault => "this `switch` has a `default` already".into(),
            TooManyBlocks => "too many blocks are open here".into(),
            OtherEnd(found, kind, line) => format!("`{found}` does not close the `{}` of line {line}", kind.opener()),
            NotOneExpression => "exactly one expression belongs here".into(),
            OtherWord(word, _) => format!("`{word}` is not a word of ARL"),
            OtherOperator(found, ours) => format!("ARL writes `{ours}`, not `{found}`"),
            Misspelt(word, _) => format!("`{word}` is not a word of ARL"),
            OtherMotion(motion) => format!("this is a motion as {} writes it", motion.language),
            LineBreak(place) => place.message().into(),
        }
    }

    /// The words at the marked place.
    pub fn label(&self) -> String {
        use SyntaxErrorKind::*;
        match self {
            UnknownCharacter(_) | BadNumber(_) | Backslash | BareSplice => "remove this".into(),
            LooksLike(_, meant) => format!("{} was probably meant", show_ascii(*meant)),
            ForeignLetters(_) => "these letters are not allowed in names".into(),
            UnclosedText | UnclosedComment => "it begins here".into(),
            BadEscape(_) => "unknown escape".into(),
            IntTooLarge(_) | DoubleTooLarge => "too large".into(),
            BinaryDigits(_) => "digits other than 0 and 1".into(),
            NoExponent(_) => "digits are missing after this".into(),
            OtherHexadecimal(value) => format!("write `{}`", arl_hexadecimal(*value)),
            BareDollar => "the name of a system variable is missing".into(),
            SingleQuotes => "write `\"`".into(),
            SpliceOutsideMacro => "not in an ARL file".into(),
            FileTooLarge => "here".into(),
            Unexpected { expected, .. } | EndsEarly { expected, .. } => format!("expected {expected}"),
            MissingClose(bracket) => format!("`{}` belongs after this, or earlier", bracket.close()),
            StrayClose(bracket) => format!("no `{}` is open here", bracket.open()),
            WrongClose(open, _) => format!("`{}` belongs here", open.close()),
            MissingComma(_) => "`,` belongs before this".into(),
            MissingColon => "`:` belongs after this".into(),
            MissingValue(_, before) if before.is_empty() => "a value belongs after this".into(),
            MissingValue(..) => "a value belongs before this".into(),
            Semicolon => "remove this".into(),
            SeveralStatements => "begin a new line here".into(),
            ReservedWord(_) => "choose another name".into(),
            LabelNotAlone(_) => "begin a new line after the label".into(),
            ElseIf => "write `elseif`".into(),
            Then(_) => "remove this".into(),
            BlockBrace => "remove this".into(),
            NotAssignable(_) => "not a variable".into(),
            MisplacedUnit => "unit".into(),
            TooManyLevels => "too deep".into(),
            ComponentColon(name) => format!("write `{name}`, a space and the value"),
            CompoundStartValue => "write `=`".into(),
            UnclosedBlock(kind, _) => format!("this needs its `{}`", kind.closing_line()),
            StrayEnd(_) => "remove this".into(),
            WrongEnd(open, ..) | OtherEnd(_, open, _) => format!("write `{}`", open.closing_line()),
            OutsideFunction => "this is outside of any function".into(),
            FuncAmongStatements => "define it outside".into(),
            ImportInside => "move this to the top of the file".into(),
            BeforeFirstCase => "before the first `case`".into(),
            CaseOutsideSwitch => "no `switch` is open here".into(),
            BranchOutsideIf(_) => "no `if` is open here".into(),
            BranchAfterElse(_) => "after the `else`".into(),
            SecondDefault => "second `default`".into(),
            TooManyBlocks => "one block too many".into(),
            NotOneExpression => "this is something else".into(),
            OtherWord(..) => "not known".into(),
            OtherOperator(_, ours) | Misspelt(_, ours) => format!("write `{ours}`"),
            OtherMotion(motion) => format!("in ARL `{}`", motion.ours),
            LineBreak(place) => place.label().into(),
        }
    }

    /// What would be right, where there is more to say.
    pub fn help(&self) -> Option<String> {
        self.help_with_names().or_else(|| self.plain_help().map(String::from))
    }

    /// The help that names what was found or what is meant.
    fn help_with_names(&self) -> Option<String> {
        use SyntaxErrorKind::*;
        match self {
            OtherHexadecimal(value) => Some(format!("Write `{}`.", arl_hexadecimal(*value))),
            BadNumber(text) => other_unit(text).map(|number| format!("ARL has mm, deg and s: `{number}`.")),
            OtherMotion(motion) => Some(format!("Write `{}`: {OTHER_MOTIONS}", motion.ours)),
            WrongEnd(open, ..) => {
                let (opener, closer) = (open.opener(), open.closing_line());
                Some(format!("A `{opener}` extends to its `{closer}`. Write that, or remove this line."))
            }
            OtherWord(_, ours) => Some(format!("ARL has {ours}.")),
            Misspelt(_, meant) => Some(format!("Did you mean `{meant}`?")),
            _ => None,
        }
    }

    /// The help that is the same for every mistake of a kind.
    fn plain_help(&self) -> Option<&'static str> {
        use SyntaxErrorKind::*;
        Some(match self {
            UnknownCharacter('?') => "ARL has no `?:`. Write an `if` with an `else`.",
            LooksLike(..) => {
                "Characters of other alphabets look alike and are not the same. Switch the input method to half-width."
            }
            ForeignLetters(_) => {
                "Names are made of the letters a to z, digits and `_`. Strings and comments may contain any character."
            }
            UnclosedText => "Write the closing `\"` on the same line.",
            UnclosedComment => "Write `*/` at its end. Block comments do not nest.",
            BadEscape(_) => {
                "The escapes are `\\n`, `\\r`, `\\t`, `\\\"` and `\\\\`. A backslash itself is written `\\\\`."
            }
            IntTooLarge(_) => "Ints have 32 bits. Write a double (`4294967296.0`) where a double is allowed.",
            BinaryDigits(_) => "A `b` after digits makes a binary number, an `h` a hexadecimal one: `1100b`, `12bh`.",
            NoExponent(_) => "Write the exponent's digits (`12e3`), or an `h` for a hexadecimal number (`12eh`).",
            BadNumber(_) => {
                "Names begin with a letter or `_`. A number may be followed by `b`, `h` or a unit: %, mm, mm/s, deg, deg/s, s."
            }
            Backslash => "It joins a line with the next one. Nothing may follow it, not even a comment.",
            SingleQuotes => "Write `\"text\"`.",
            BareSplice => "Write `#name` for a Rust variable, `#(expression)` for anything else.",
            FileTooLarge => "ARL files must be smaller than 4 GB.",
            Unexpected { hint, .. } | EndsEarly { hint, .. } => return hint.text(),
            LineBreak(_) => JOINED_LINES,
            MissingClose(_) => ONE_LINE,
            MissingValue(_, before) if before.is_empty() => ONE_LINE,
            MissingColon => "Write `case 1:` or `default:`, and the statements on the lines below.",
            Semicolon => {
                "The end of the line ends the statement. A `;` adds events to a motion: `lin p1;T(1),setdo(2,true)`."
            }
            SeveralStatements => {
                "The end of the line ends a statement; `;` does not separate statements. Comments begin with `//`."
            }
            LabelNotAlone(_) => "Write the statement on the next line.",
            ElseIf => "With `elseif` the whole chain has one `endif`.",
            Then(_) => "The statements follow on the next lines, up to the closing word.",
            BlockBrace => {
                "A block extends from its first line to its closing word: `if(c)` ... `endif`, `while(c)` ... `endwhile`."
            }
            NotAssignable(_) => "The left side of `=` must be a variable, an element or a component. `==` compares.",
            MisplacedUnit => {
                "Units belong to arguments of instructions: `lin p1,vl:100mm/s`. Elsewhere a number has no unit."
            }
            TooManyLevels => "Compute parts of it in separate variables first.",
            TooManyBlocks => "Move the inner blocks to a function of their own.",
            ReservedWord(_) => {
                "Words of the language cannot be names of variables, functions or labels, in upper or lower case."
            }
            ComponentColon(_) => "Braces have no colons: `{x 1, y 2}`. The labels of arguments have them: `lin p:p1`.",
            StrayEnd(_) => "Remove it, or look above for a line that closes too early.",
            OutsideFunction => {
                "Only `import`, declarations and `func` are allowed outside functions. A program begins in `func void main()`."
            }
            FuncAmongStatements => "Define functions in an ARL file or a macro of their own.",
            ImportInside => "Imports apply to the whole file.",
            BeforeFirstCase => "Nothing may come between `switch` and its first `case`.",
            SecondDefault => "A `switch` has at most one.",
            UnknownCharacter('#') => "Comments begin with `//`.",
            BranchAfterElse(_) => "The order is `if`, any number of `elseif`, at most one `else`, `endif`.",
            _ => return None,
        })
    }
}

impl SyntaxErrorKind {
    /// The replacement for the marked text, where it certainly mends the mistake.
    pub fn fix(&self) -> Option<&'static str> {
        match self {
            Self::OtherOperator(_, ours) | Self::Misspelt(_, ours) => Some(ours),
            Self::ElseIf => Some("elseif"),
            _ => None,
        }
    }
}

/// How the motions of ARL differ from those of other languages.
pub const OTHER_MOTIONS: &str = "in ARL commas separate the arguments and a colon follows each label; \
poses and joints are written in braces, in mm and deg. `accset` sets accelerations; `movej` goes to a joint, \
`ptp` and `lin` go to a pose.";

/// A block, or the function of this name, that is never closed.
fn unclosed(kind: BlockKind, name: &str) -> String {
    let block = if name.is_empty() { format!("this `{}`", kind.opener()) } else { format!("the function `{name}`") };
    format!("{block} is never closed: its `{}` is missing", kind.closer())
}

/// Where a statement ends.
const ONE_LINE: &str = "A statement ends with its line. To continue it on the next one, end the line with `\\`.";

/// How a statement of several lines is written.
const JOINED_LINES: &str = "The end of a line ends a statement, even inside brackets. A `\\` as the last character joins a \
line with the next: write it at the end of each line of the statement except the last, with no comment after it.";

/// Units that ARL does not have: the number that makes ARL's unit of each, and that unit.
const OTHER_UNITS: [(&str, f64, &str); 8] = [
    ("m/s", 1000.0, "mm/s"),
    ("cm/s", 10.0, "mm/s"),
    ("rad/s", 180.0 / std::f64::consts::PI, "deg/s"),
    ("m", 1000.0, "mm"),
    ("cm", 10.0, "mm"),
    ("rad", 180.0 / std::f64::consts::PI, "deg"),
    ("ms", 0.001, "s"),
    ("min", 60.0, "s"),
];

/// Whether a word is a unit somewhere.
pub(crate) fn is_unit(word: &str) -> bool {
    let units = ["mm", "deg", "s", "sec", "inch", "grad"].into_iter();
    units.chain(OTHER_UNITS.map(|(other, ..)| other)).any(|unit| unit.eq_ignore_ascii_case(word))
}

/// A number with a unit that ARL does not have, converted to the unit that it has.
fn other_unit(text: &str) -> Option<String> {
    let at = text.find(|c: char| c.is_ascii_alphabetic())?;
    let (number, unit) = text.split_at_checked(at)?;
    let (_, factor, ours) = OTHER_UNITS.iter().find(|(other, ..)| unit.eq_ignore_ascii_case(other))?;
    let value = number.parse::<f64>().ok()? * factor;
    Some(format!("{}{ours}", (value * 1000.0).round() / 1000.0))
}

/// A character as a reader can recognise it.
fn show_character(c: char) -> String {
    if c.is_control() || c.is_whitespace() || c == '\u{feff}' {
        return format!("the character U+{:04X}", u32::from(c));
    }
    format!("`{c}` (U+{:04X})", u32::from(c))
}

fn show_ascii(c: char) -> String {
    if c == ' ' { "a space".into() } else { format!("`{c}`") }
}

/// The number as ARL writes it.
fn arl_hexadecimal(value: u32) -> String {
    let digits = format!("{value:x}");
    if digits.starts_with(|first: char| first.is_ascii_digit()) { format!("{digits}h") } else { format!("0{digits}h") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hexadecimal_as_arl_writes_it() {
        assert_eq!(arl_hexadecimal(0x3e), "3eh");
        assert_eq!(arl_hexadecimal(0xff), "0ffh");
    }
}
