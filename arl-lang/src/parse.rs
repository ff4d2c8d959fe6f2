//! Turns source text into a syntax tree. Every entry point reads to the end and reports all mistakes, each once.

use logos::Logos;

use crate::adapt::{Adapter, PlacedLexeme};
use crate::ast::{Block, Expr, ExprKind, File, StmtKind};
use crate::blocks::{Blocks, Doubts, error_at};
use crate::explain::explain;
use crate::followers::Followers;
use crate::grammar::LineParser;
use crate::habits::repair;
use crate::lexer::{Lexeme, LexicalError};
use crate::line::{Line, LineKind};
use crate::line_break::{self, Statement};
use crate::number::{Number, NumberError, NumberValue};
use crate::other_words::{
    Meant, argument, comment, first_word, function_of_others, motion_of_others, replace_operators,
};
use crate::outline::Outline;
use crate::recovery::{Recovered, other_function, recover};
use crate::span::Span;
use crate::symbol::{Interner, Symbol};
use crate::syntax_error::{SyntaxError, SyntaxErrorKind};
use crate::token::Placed;
use crate::tree::Context;

/// The end of the units of speed.
const PER_SECOND: &str = "/s";

/// What is read besides plain ARL.
#[derive(Clone, Copy, Default, Debug)]
pub struct ParseOptions {
    /// Whether `#name` and `#(tokens)` splice Rust values in, as in the macro.
    pub splices: bool,
}

/// A file and what is wrong with its form.
#[derive(Clone, Debug)]
pub struct Parsed {
    /// The tree of all that could be read.
    pub file: File,
    /// The mistakes, in the order of the text.
    pub errors: Vec<SyntaxError>,
    /// The Rust values spliced in; `ExprKind::Splice` counts them from 0.
    pub splices: Vec<Splice>,
}

/// Statements and what is wrong with their form.
#[derive(Clone, Debug)]
pub struct ParsedStatements {
    /// The statements that could be read.
    pub block: Block,
    /// The mistakes, in the order of the text.
    pub errors: Vec<SyntaxError>,
    /// The Rust values spliced in; `ExprKind::Splice` counts them from 0.
    pub splices: Vec<Splice>,
}

/// An expression and what is wrong with its form.
#[derive(Clone, Debug)]
pub struct ParsedExpression {
    /// The expression, `ExprKind::Error` where it could not be read.
    pub expr: Expr,
    /// The mistakes, in the order of the text.
    pub errors: Vec<SyntaxError>,
    /// The Rust values spliced in; `ExprKind::Splice` counts them from 0.
    pub splices: Vec<Splice>,
}

/// A Rust value spliced into ARL.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Splice {
    /// The name, or the text between the parentheses.
    pub span: Span,
    /// Whether it was written in parentheses.
    pub parenthesised: bool,
}

/// Reads a file.
pub fn parse(source: &str, interner: &mut Interner, options: ParseOptions) -> Parsed {
    let mut parser = Parser::new(source, interner, options, false);
    parser.run();
    let Parser { blocks, context, splices, .. } = parser;
    let mut errors = context.errors;
    let file = blocks.file(&mut errors);
    Parsed { file, errors: in_order(errors), splices }
}

/// Reads statements, as in the body of a function.
pub fn parse_statements(source: &str, interner: &mut Interner, options: ParseOptions) -> ParsedStatements {
    let mut parser = Parser::new(source, interner, options, true);
    parser.run();
    let Parser { blocks, context, splices, .. } = parser;
    let mut errors = context.errors;
    let block = blocks.block(&mut errors);
    ParsedStatements { block, errors: in_order(errors), splices }
}

/// Reads one expression.
pub fn parse_expression(source: &str, interner: &mut Interner, options: ParseOptions) -> ParsedExpression {
    let ParsedStatements { block, mut errors, splices } = parse_statements(source, interner, options);
    let mut statements = block.into_iter();
    let whole = Span::new(0, u32::try_from(source.len()).unwrap_or(u32::MAX));
    let expr = match (statements.next().map(|stmt| stmt.kind), statements.next()) {
        (Some(StmtKind::Expr(expr)), None) => *expr,
        (_, second) => {
            if errors.is_empty() {
                let span = second.map_or(whole, |stmt| stmt.span);
                errors.push(SyntaxError::new(SyntaxErrorKind::NotOneExpression, span));
            }
            Expr { kind: ExprKind::Error, span: whole }
        }
    };
    ParsedExpression { expr, errors, splices }
}

/// What each lexeme of a file is to the grammar, and what each line means for the blocks.
pub fn outline(source: &str) -> Outline {
    let mut interner = Interner::new();
    let mut parser = Parser::new(source, &mut interner, ParseOptions::default(), false);
    parser.outline = Some(Outline::default());
    parser.run();
    let mut outline = parser.outline.unwrap_or_default();
    outline.note_mistakes(&parser.context.errors);
    outline
}

fn in_order(mut errors: Vec<SyntaxError>) -> Vec<SyntaxError> {
    errors.sort_by_key(|error| error.span.start);
    errors
}

/// Reads a text line by line.
struct Parser<'a> {
    source: &'a str,
    options: ParseOptions,
    lexer: logos::Lexer<'a, Lexeme>,
    lexemes: Vec<PlacedLexeme>,
    adapter: Adapter<'a>,
    context: Context<'a>,
    grammar: LineParser,
    followers: Followers,
    blocks: Blocks<'a>,
    splices: Vec<Splice>,
    void: Symbol,
    /// The outline read so far, where one is wanted.
    outline: Option<Outline>,
    /// How far the rest of an incomplete statement was looked for without success.
    looked_until: u32,
    /// The end of the last line that was read.
    above: Option<Span>,
    /// Whether that line went on with the statement above it.
    is_inside: bool,
}

impl<'a> Parser<'a> {
    fn new(source: &'a str, interner: &'a mut Interner, options: ParseOptions, only_statements: bool) -> Self {
        let fits = u32::try_from(source.len()).is_ok_and(|length| length < u32::MAX);
        let mut errors = Vec::new();
        if !fits {
            errors.push(SyntaxError::new(SyntaxErrorKind::FileTooLarge, Span::new(0, 0)));
        }
        let source = if fits { source } else { "" };
        let mut adapter = Adapter::new(source, interner);
        let (endl, void) = (adapter.intern("endl"), adapter.intern("void"));
        let mut lexer = Lexeme::lexer(source);
        if source.starts_with('\u{feff}') {
            lexer.bump('\u{feff}'.len_utf8());
        }
        Self {
            source,
            options,
            lexer,
            lexemes: Vec::new(),
            adapter,
            context: Context { source, errors, endl },
            grammar: LineParser::new(),
            followers: Followers::default(),
            blocks: Blocks::new(source, only_statements),
            splices: Vec::new(),
            void,
            outline: None,
            looked_until: 0,
            above: None,
            is_inside: false,
        }
    }

    fn run(&mut self) {
        loop {
            let before = self.context.errors.len();
            let (mut more, broken) = self.read_line();
            // Consequences of a character or a number that could not be read are not reported as well.
            let mut quiet = self.context.errors.len() > before;
            if !quiet && let Some(read) = self.read_on() {
                (more, quiet) = (read, true);
            }
            let lexemes = std::mem::take(&mut self.lexemes);
            let mut rest = lexemes.as_slice();
            while !rest.is_empty() {
                let adapted = self.adapter.adapt(rest, &mut self.context.errors);
                if let Some(outline) = &mut self.outline {
                    outline.note_part(rest.get(..adapted.taken).unwrap_or(rest), &self.adapter.tokens);
                }
                self.line(broken || adapted.broken, quiet);
                self.above = self.adapter.tokens.last().map(|last| Span::new(last.0, last.2)).or(self.above);
                rest = rest.get(adapted.taken.max(1)..).unwrap_or_default();
            }
            self.lexemes = lexemes;
            if !more {
                return;
            }
        }
    }

    /// Reads the lexemes of the next line that has any. Returns whether more lines may follow, and whether something on
    /// the line could not be read.
    fn read_line(&mut self) -> (bool, bool) {
        self.lexemes.clear();
        let mut broken = false;
        while let Some(lexeme) = self.lexer.next() {
            let range = self.lexer.span();
            let (start, end) = (range.start as u32, range.end as u32);
            match lexeme {
                Ok(Lexeme::Newline) if self.lexemes.is_empty() && !broken => {}
                Ok(Lexeme::Newline) => return (true, broken),
                Ok(Lexeme::Splice) => {
                    let lexeme = self.splice(start, end);
                    self.lexemes.push((start, lexeme, end));
                }
                Ok(lexeme) => self.lexemes.push((start, lexeme, end)),
                Err(error) => match self.lexical_error(error, Span::new(start, end)) {
                    Instead::Lexeme(lexeme) => self.lexemes.push((start, lexeme, end)),
                    Instead::Nothing => {}
                    Instead::Broken => broken = true,
                },
            }
        }
        (false, broken)
    }

    /// Reads the rest of a statement that is incomplete at the end of its line from the lines below, and reports the
    /// error. Returns whether more lines may follow; `None` if the line is complete or the next lines are not the rest
    /// of it.
    fn read_on(&mut self) -> Option<bool> {
        let mut statement = Statement::of(&self.lexemes, self.source);
        let (_, _, end) = *self.lexemes.last()?;
        // The layout of lines with mistakes is left alone, and each line is looked at once, however many are
        // incomplete.
        if !statement.is_unfinished() || self.outline.is_some() || end < self.looked_until {
            return None;
        }
        let (lexer, splices, errors) = (self.lexer.clone(), self.splices.len(), self.context.errors.len());
        let mut lexemes = std::mem::take(&mut self.lexemes);
        let own = lexemes.len();
        let more = loop {
            let (more, broken) = self.read_line();
            let is_rest = statement.can_go_on_with(&self.lexemes, self.source);
            if broken || !is_rest || self.context.errors.len() > errors {
                break None;
            }
            statement.go_on(&self.lexemes);
            lexemes.append(&mut self.lexemes);
            if !statement.is_unfinished() {
                break Some(more);
            }
        };
        self.lexemes = lexemes;
        if let (Some(_), [.., last], [next, ..]) = (more, self.lexemes.get(..own)?, self.lexemes.get(own..)?) {
            let error = line_break::error(Span::new(last.0, last.2), Span::new(next.0, next.2));
            self.context.errors.push(error);
            return more;
        }
        self.looked_until = u32::try_from(self.lexer.span().end).unwrap_or(u32::MAX);
        self.lexemes.truncate(own);
        self.lexer = lexer;
        self.splices.truncate(splices);
        self.context.errors.truncate(errors);
        None
    }

    fn splice(&mut self, start: u32, end: u32) -> Lexeme {
        if !self.options.splices {
            let span = Span::new(start, end);
            self.context.errors.push(SyntaxError::new(SyntaxErrorKind::SpliceOutsideMacro, span));
            return Lexeme::Faulty;
        }
        let parenthesised = Span::new(start + 1, end).text(self.source).starts_with('(');
        let inside = if parenthesised { Span::new(start + 2, end - 1) } else { Span::new(start + 1, end) };
        self.splices.push(Splice { span: inside, parenthesised });
        Lexeme::Splice
    }

    /// Reports what the lexer could not read, and returns what is read instead.
    fn lexical_error(&mut self, error: LexicalError, mut span: Span) -> Instead {
        if matches!(error, LexicalError::Number(NumberError::Letters)) && self.is_per_second() {
            self.lexer.bump(PER_SECOND.len());
            span.end += PER_SECOND.len() as u32;
        }
        let text = span.text(self.source);
        let first = text.chars().next().unwrap_or('\u{fffd}');
        let (kind, place, instead) = match error {
            LexicalError::UnknownCharacter => (SyntaxErrorKind::UnknownCharacter(first), span, Instead::Broken),
            LexicalError::LooksLike(meant) => (SyntaxErrorKind::LooksLike(first, meant), span, punctuation(meant)),
            LexicalError::ForeignLetters => {
                // The name may begin with letters that are fine.
                let before = self.lexemes.pop_if(|(_, lexeme, end)| *lexeme == Lexeme::Word && *end == span.start);
                let whole = Span::new(before.map_or(span.start, |before| before.0), span.end);
                (SyntaxErrorKind::ForeignLetters(whole.text(self.source).into()), whole, Instead::Broken)
            }
            LexicalError::UnclosedText => (SyntaxErrorKind::UnclosedText, span, Instead::Broken),
            LexicalError::UnclosedComment => {
                (SyntaxErrorKind::UnclosedComment, Span::new(span.start, span.start + 2), Instead::Nothing)
            }
            LexicalError::BadEscape(offset) => {
                let at = span.start + offset;
                let escaped = Span::new(at + 1, span.end).text(self.source).chars().next().unwrap_or(' ');
                let place = Span::new(at, at + 1 + escaped.len_utf8() as u32);
                (SyntaxErrorKind::BadEscape(escaped), place, Instead::Lexeme(Lexeme::Text))
            }
            LexicalError::Number(NumberError::OtherHexadecimal(value)) if self.options.splices => {
                let value = NumberValue::Int(value, crate::ast::Radix::Hexadecimal);
                return Instead::Lexeme(Lexeme::Number(Number { value, unit: None }));
            }
            LexicalError::Number(error) => {
                let kind = match error {
                    NumberError::IntTooLarge => SyntaxErrorKind::IntTooLarge(text.into()),
                    NumberError::DoubleTooLarge => SyntaxErrorKind::DoubleTooLarge,
                    NumberError::BinaryDigits => SyntaxErrorKind::BinaryDigits(text.into()),
                    NumberError::Exponent => SyntaxErrorKind::NoExponent(text.into()),
                    NumberError::OtherHexadecimal(value) => SyntaxErrorKind::OtherHexadecimal(value),
                    NumberError::SeveralPoints | NumberError::Letters => SyntaxErrorKind::BadNumber(text.into()),
                };
                (kind, span, Instead::Lexeme(Lexeme::Faulty))
            }
            LexicalError::BareDollar => (SyntaxErrorKind::BareDollar, span, Instead::Lexeme(Lexeme::Faulty)),
            LexicalError::Backslash => (SyntaxErrorKind::Backslash, span, Instead::Broken),
            LexicalError::SingleQuotes => (SyntaxErrorKind::SingleQuotes, span, Instead::Lexeme(Lexeme::Faulty)),
            LexicalError::BareSplice | LexicalError::UnclosedSplice => {
                let kind = if self.options.splices {
                    SyntaxErrorKind::BareSplice
                } else {
                    SyntaxErrorKind::UnknownCharacter(first)
                };
                (kind, span, Instead::Broken)
            }
        };
        self.context.errors.push(SyntaxError::new(kind, place));
        instead
    }

    /// Whether `/s` follows as a whole word: it then belongs to a number that could not be read (`0.25m/s`).
    fn is_per_second(&self) -> bool {
        let rest = self.lexer.remainder();
        let begins = rest.get(..PER_SECOND.len()).is_some_and(|start| start.eq_ignore_ascii_case(PER_SECOND));
        begins
            && !rest.get(PER_SECOND.len()..).unwrap_or_default().starts_with(|c: char| c.is_alphanumeric() || c == '_')
    }

    /// Reads the line whose tokens the adapter holds.
    fn line(&mut self, broken: bool, quiet: bool) {
        if self.adapter.tokens.is_empty() {
            return;
        }
        let inside = std::mem::take(&mut self.is_inside);
        replace_operators(&mut self.adapter.tokens, self.source, &mut self.context.errors);
        let habits = repair(&mut self.adapter.tokens, self.source, &mut self.context.errors);
        let mut doubts = Doubts {
            braced: habits.opens_brace,
            closes_brace: habits.closes_brace,
            else_if: habits.else_if,
            ..Doubts::default()
        };
        if let Some(line) = habits.whole {
            return self.take(line, doubts);
        }
        if !quiet && let Some(error) = function_of_others(&self.adapter.tokens, self.source) {
            self.context.errors.push(error);
            return self.recover_meant(Meant::Function, doubts);
        }
        let tokens = self.adapter.tokens.as_slice();
        if broken {
            self.recover(tokens.len(), doubts);
            return;
        }
        let before = self.context.errors.len();
        match self.grammar.parse(&mut self.context, tokens.iter().copied()) {
            Ok(mut line) => {
                self.doubt_compact_if(&mut line, quiet, &mut doubts);
                self.take(line, doubts);
            }
            Err(error) => {
                self.context.errors.truncate(before);
                if !quiet && let Some(error) = line_break::begins_inside(tokens, self.above) {
                    // Of several such lines only the first is reported.
                    self.context.errors.extend(Some(error).filter(|_| !inside));
                    self.is_inside = true;
                    return;
                }
                if !quiet && let Some(error) = comment(tokens, self.source) {
                    self.context.errors.push(error);
                    return;
                }
                if !quiet && let Some(error) = motion_of_others(tokens, self.source) {
                    self.context.errors.push(error);
                    return;
                }
                if !quiet && let Some((error, meant)) = first_word(tokens, self.source) {
                    self.context.errors.push(error);
                    return self.recover_meant(meant, doubts);
                }
                if !quiet {
                    let (source, endl) = (self.source, self.context.endl);
                    let grammar = &self.grammar;
                    let followers = &self.followers;
                    let goes_on = |prefix: &[Placed], next| followers.can_follow(grammar, source, endl, prefix, next);
                    let (error, at) = explain(&error, source, tokens, endl, &goes_on);
                    let argument = tokens.get(at).and_then(|found| argument(*found, source));
                    self.context.errors.push(argument.unwrap_or(error));
                    return self.recover(at, doubts);
                }
                self.recover(tokens.len(), doubts);
            }
        }
    }

    /// Handles an `if` on one line whose statement is doubtful: braces of a block, or a line with other mistakes.
    fn doubt_compact_if(&mut self, line: &mut Line, quiet: bool, doubts: &mut Doubts) {
        let LineKind::Statement(StmtKind::CompactIf(parts)) = &mut line.kind else { return };
        if quiet {
            // Whether a statement was meant here is unknown.
            doubts.may_open = true;
            let unknown = error_at(parts.0.span);
            line.kind = LineKind::If(std::mem::replace(&mut parts.0, unknown));
        } else if let StmtKind::Expr(expr) = &parts.1.kind
            && matches!(expr.kind, ExprKind::Brace(_))
        {
            self.context.errors.push(SyntaxError::new(SyntaxErrorKind::BlockBrace, expr.span));
        }
    }

    /// Hands a line on to the blocks.
    fn take(&mut self, line: Line, doubts: Doubts) {
        if let Some(outline) = &mut self.outline {
            outline.note_line(&line, doubts);
        }
        self.blocks.take(line, doubts, &mut self.context.errors);
    }

    /// Keeps what can be recovered of a line whose first word belongs to another language, or has a slip in it.
    fn recover_meant(&mut self, meant: Meant, mut doubts: Doubts) {
        match meant {
            Meant::Nothing => {}
            Meant::Declaration => {
                self.adapter.tokens.remove(0);
                self.recover(self.adapter.tokens.len(), doubts);
            }
            Meant::Word(token) => {
                if let Some(first) = self.adapter.tokens.first_mut() {
                    first.1 = token;
                }
                let tokens = self.adapter.tokens.as_slice();
                let mut context = Context { source: self.source, errors: Vec::new(), endl: self.context.endl };
                match self.grammar.parse(&mut context, tokens.iter().copied()) {
                    Ok(line) => self.take(line, doubts),
                    Err(_) => self.recover(tokens.len(), doubts),
                }
            }
            Meant::Function => {
                let Some(line) = other_function(&self.adapter.tokens, self.void) else { return };
                doubts.drop = true;
                self.take(line, doubts);
            }
        }
    }

    /// Keeps what can be recovered of a line that is wrong from its token `at` on.
    fn recover(&mut self, at: usize, mut doubts: Doubts) {
        let tokens = self.adapter.tokens.as_slice();
        let mut context = Context { source: self.source, errors: Vec::new(), endl: self.context.endl };
        let good = tokens.get(..at).unwrap_or(tokens);
        let read = self.grammar.parse(&mut context, good.iter().copied()).ok();
        let Some(Recovered { line, may_open, drop }) = recover(tokens, read, self.void) else { return };
        doubts.may_open = may_open;
        doubts.drop = drop;
        self.take(line, doubts);
    }
}

/// What is read in the place of something that cannot be read.
enum Instead {
    Lexeme(Lexeme),
    Nothing,
    /// The line is not read by the grammar.
    Broken,
}

/// What a character from outside ASCII stands for.
fn punctuation(meant: char) -> Instead {
    Instead::Lexeme(match meant {
        '(' => Lexeme::ParenOpen,
        ')' => Lexeme::ParenClose,
        '[' => Lexeme::BracketOpen,
        ']' => Lexeme::BracketClose,
        '{' => Lexeme::BraceOpen,
        '}' => Lexeme::BraceClose,
        ',' => Lexeme::Comma,
        ';' => Lexeme::Semicolon,
        ':' => Lexeme::Colon,
        '"' => Lexeme::Faulty,
        ' ' => return Instead::Nothing,
        _ => return Instead::Broken,
    })
}
