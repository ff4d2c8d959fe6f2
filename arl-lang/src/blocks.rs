//! Nests lines into blocks with an explicit stack, so that a missing or wrong closing line is one error that refers to
//! its opening line, and nesting uses no call stack.

use std::collections::VecDeque;

use crate::ast::{Arm, Block, Expr, ExprKind, File, For, Func, If, Item, Stmt, StmtKind, Switch};
use crate::block_look_ahead::{self, Event, Stack};
use crate::line::{FuncHead, Line, LineKind};
use crate::other_words::opening_slip;
use crate::span::{LineIndex, Span};
use crate::syntax_error::{BLOCK_LEVELS, BlockKind, Bracket, Hint, SyntaxError, SyntaxErrorKind};

/// What is known of a line besides its kind.
#[derive(Clone, Copy, Default, Debug)]
pub(crate) struct Doubts {
    /// The line could not be read and may or may not open a block.
    pub(crate) may_open: bool,
    /// A wrong word may have closed the block: the right one may be missing.
    pub(crate) may_be_closed: bool,
    /// The line ended with a `{`.
    pub(crate) braced: bool,
    /// The line began with a `}`.
    pub(crate) closes_brace: Option<Span>,
    /// It was written `else if`.
    pub(crate) else_if: bool,
    /// The block that it opens is not kept.
    pub(crate) drop: bool,
}

/// An open block.
struct Frame {
    kind: Open,
    /// The opening line.
    span: Span,
    /// The statements of the current branch.
    body: Block,
    doubts: Doubts,
    /// How many braces are open around the statements of its cases; each of them was reported.
    case_braces: usize,
}

impl Frame {
    fn new(kind: Open, span: Span, doubts: Doubts) -> Self {
        Self { kind, span, body: Vec::new(), doubts, case_braces: 0 }
    }

    /// Whether the block is a `switch` with a case.
    fn is_in_case(&self) -> bool {
        matches!(self.kind, Open::Switch(_, _, Some(_), _))
    }

    /// Whether the closing line may be missing without this being another mistake.
    fn is_quiet(&self) -> bool {
        self.doubts.may_open || self.doubts.may_be_closed
    }
}

/// What was read of a block before its current branch.
enum Open {
    Func(Box<FuncHead>),
    /// The branches that are complete, and the condition of the current one; `None` in the `else`.
    If(Vec<(Expr, Block)>, Option<Expr>),
    While(Expr),
    Repeat,
    Loop,
    For(Box<For>),
    /// The subject, the complete cases, the current case, and whether a `default` was read.
    Switch(Expr, Vec<Arm>, Option<(Option<Expr>, Span)>, bool),
}

impl Open {
    fn kind(&self) -> BlockKind {
        match self {
            Open::Func(_) => BlockKind::Func,
            Open::If(..) => BlockKind::If,
            Open::While(_) => BlockKind::While,
            Open::Repeat => BlockKind::Repeat,
            Open::Loop => BlockKind::Loop,
            Open::For(_) => BlockKind::For,
            Open::Switch(..) => BlockKind::Switch,
        }
    }
}

/// The limit of searches for a misspelt opener: a text with more stray closing lines has more than an occasional slip.
const MOST_SEARCHES: usize = 50;

/// Takes lines in order and makes a file, or a block of statements, of them.
pub(crate) struct Blocks<'source> {
    source: &'source str,
    lines: Option<LineIndex>,
    frames: Vec<Frame>,
    items: Vec<Item>,
    /// Statements outside all blocks, where only statements are read.
    statements: Block,
    only_statements: bool,
    /// The lines of the current function read so far.
    waiting: VecDeque<(Line, Doubts)>,
    /// Whether lines are held back until the end of their function, so that later lines can be looked at.
    waits: bool,
    /// How many `endif` may lack their `if`, because of an `else if` reported before.
    forgiven: usize,
    /// Whether a statement outside functions was reported since the last function.
    outside: bool,
    /// Whether the function before this one was reported as not closed: what follows this one may be its rest.
    cut_short: bool,
    /// How many blocks beyond the limit are open; their contents are not kept.
    beyond: usize,
    /// Whether exceeding the limit was reported in this function.
    too_deep: bool,
    /// How many searches for a misspelt opener remain: each walks the statements, and may nest those already read.
    searches: usize,
    last: Span,
}

impl<'source> Blocks<'source> {
    pub(crate) fn new(source: &'source str, only_statements: bool) -> Self {
        Self {
            source,
            lines: None,
            frames: Vec::new(),
            items: Vec::new(),
            statements: Vec::new(),
            only_statements,
            waiting: VecDeque::new(),
            waits: false,
            forgiven: 0,
            outside: false,
            cut_short: false,
            beyond: 0,
            too_deep: false,
            searches: MOST_SEARCHES,
            last: Span::default(),
        }
    }

    /// Takes the next line.
    pub(crate) fn take(&mut self, line: Line, doubts: Doubts, errors: &mut Vec<SyntaxError>) {
        let event = Event::of(&line.kind, doubts.may_open);
        if matches!(event, Event::Open(BlockKind::Func, _)) {
            self.take_waiting(errors);
        }
        self.waits |= matches!(event, Event::Open(..));
        if !self.waits {
            return self.take_now(line, doubts, errors);
        }
        self.waiting.push_back((line, doubts));
        if event == Event::Close(BlockKind::Func) {
            self.take_waiting(errors);
        }
    }

    /// Processes the lines that were held back.
    fn take_waiting(&mut self, errors: &mut Vec<SyntaxError>) {
        while let Some((line, doubts)) = self.waiting.pop_front() {
            self.take_now(line, doubts, errors);
        }
        self.waits = false;
    }

    fn take_now(&mut self, line: Line, doubts: Doubts, errors: &mut Vec<SyntaxError>) {
        let Line { kind, span } = line;
        self.last = span;
        if let Some(brace) = doubts.closes_brace
            && !self.closes_case_brace()
            && !self.is_braced()
        {
            errors.push(SyntaxError::new(SyntaxErrorKind::StrayClose(Bracket::Brace), brace));
        }
        match kind {
            LineKind::Statement(kind) => self.statement(Stmt { kind, span }, errors),
            LineKind::Import(import) => {
                if self.only_statements || !self.frames.is_empty() {
                    errors.push(SyntaxError::new(SyntaxErrorKind::ImportInside, span));
                    return;
                }
                self.outside = false;
                self.items.push(Item::Import(*import));
            }
            LineKind::Func(head) => self.func(head, span, doubts, errors),
            LineKind::If(condition) => self.open(Open::If(Vec::new(), Some(condition)), span, doubts, errors),
            LineKind::While(condition) => self.open(Open::While(condition), span, doubts, errors),
            LineKind::Repeat => self.open(Open::Repeat, span, doubts, errors),
            LineKind::Loop => self.open(Open::Loop, span, doubts, errors),
            LineKind::For(head) => self.open(Open::For(head), span, doubts, errors),
            LineKind::Switch(subject) => {
                self.open(Open::Switch(subject, Vec::new(), None, false), span, doubts, errors);
            }
            LineKind::ElseIf(condition) => self.branch("elseif", Some(condition), span, doubts, errors),
            LineKind::Else => self.branch("else", None, span, doubts, errors),
            LineKind::Case(value) => self.case(Some(value), span, errors),
            LineKind::Default => self.case(None, span, errors),
            LineKind::EndFunc => self.close(BlockKind::Func, span, None, errors),
            LineKind::EndIf => self.close(BlockKind::If, span, None, errors),
            LineKind::EndWhile => self.close(BlockKind::While, span, None, errors),
            LineKind::Until(condition) => self.close(BlockKind::Repeat, span, Some(condition), errors),
            LineKind::EndLoop => self.close(BlockKind::Loop, span, None, errors),
            LineKind::EndFor => self.close(BlockKind::For, span, None, errors),
            LineKind::EndSwitch => self.close(BlockKind::Switch, span, None, errors),
            LineKind::BraceOpen => {
                errors.push(SyntaxError::new(SyntaxErrorKind::BlockBrace, span));
                match self.frames.last_mut() {
                    Some(frame) if frame.is_in_case() => frame.case_braces += 1,
                    Some(frame) => frame.doubts.braced = true,
                    None => {}
                }
            }
            LineKind::BraceClose if self.closes_case_brace() => {}
            LineKind::BraceClose if self.is_braced() => self.pop(span, None),
            LineKind::BraceClose => {
                errors.push(SyntaxError::new(SyntaxErrorKind::StrayClose(Bracket::Brace), span));
            }
            LineKind::OtherEnd(text, function) => self.close_other(text, span, function, errors),
        }
    }

    /// Closes all open blocks and returns the items.
    pub(crate) fn file(mut self, errors: &mut Vec<SyntaxError>) -> File {
        self.finish(errors);
        self.items.shrink_to_fit();
        File { items: self.items }
    }

    /// Closes all open blocks and returns the statements.
    pub(crate) fn block(mut self, errors: &mut Vec<SyntaxError>) -> Block {
        self.finish(errors);
        self.statements.shrink_to_fit();
        self.statements
    }

    fn finish(&mut self, errors: &mut Vec<SyntaxError>) {
        self.take_waiting(errors);
        let last = self.last;
        while !self.frames.is_empty() {
            self.unclosed(last, errors);
        }
    }

    /// Whether the innermost block was opened with a brace.
    fn is_braced(&self) -> bool {
        self.frames.last().is_some_and(|frame| frame.doubts.braced)
    }

    /// Closes one brace around the statements of a case; returns whether one was open.
    fn closes_case_brace(&mut self) -> bool {
        let open = self.frames.last_mut().map(|frame| &mut frame.case_braces).filter(|open| **open > 0);
        open.map(|open| *open -= 1).is_some()
    }

    /// Handles a line that closes the innermost block, or the function, in another language's words.
    fn close_other(&mut self, text: Box<str>, span: Span, function: bool, errors: &mut Vec<SyntaxError>) {
        if function && let Some(position) = self.find(BlockKind::Func) {
            self.close_inside(position, span, errors);
        }
        let Some(frame) = self.frames.last() else {
            let hint = Hint::None;
            let found = format!("`{text}`").into();
            let expected = "a statement, a declaration or the beginning of a block".into();
            errors.push(SyntaxError::new(SyntaxErrorKind::Unexpected { found, expected, hint }, span));
            return;
        };
        let (kind, opened) = (frame.kind.kind(), frame.span);
        let line = self.line_of(opened);
        let error = SyntaxError::new(SyntaxErrorKind::OtherEnd(text, kind, line), span);
        errors.push(error.with(opened, format!("this `{}` is open", kind.opener())));
        self.pop(span, None);
    }

    fn line_of(&mut self, span: Span) -> u32 {
        let source = self.source;
        self.lines.get_or_insert_with(|| LineIndex::new(source)).line(span.start)
    }

    /// Adds a statement to the innermost block.
    fn statement(&mut self, stmt: Stmt, errors: &mut Vec<SyntaxError>) {
        let span = stmt.span;
        if self.beyond > 0 {
            return;
        }
        match self.frames.last_mut() {
            Some(frame) => {
                if let Open::Switch(_, arms, current @ None, _) = &mut frame.kind {
                    // Reported once: the rest goes to a case that is thrown away with the tree's other errors.
                    *current = Some((None, span));
                    debug_assert!(arms.is_empty());
                    errors.push(
                        SyntaxError::new(SyntaxErrorKind::BeforeFirstCase, span)
                            .with(frame.span, "the `switch` begins here"),
                    );
                }
                frame.body.push(stmt);
            }
            None if self.only_statements => self.statements.push(stmt),
            None => match stmt.kind {
                StmtKind::Decl(decl) => self.items.push(Item::Global(*decl)),
                _ => self.report_outside(span, errors),
            },
        }
    }

    fn report_outside(&mut self, span: Span, errors: &mut Vec<SyntaxError>) {
        if !std::mem::replace(&mut self.outside, true) && !self.cut_short {
            errors.push(SyntaxError::new(SyntaxErrorKind::OutsideFunction, span));
        }
    }

    fn func(&mut self, head: Box<FuncHead>, span: Span, doubts: Doubts, errors: &mut Vec<SyntaxError>) {
        if self.only_statements {
            errors.push(SyntaxError::new(SyntaxErrorKind::FuncAmongStatements, span));
            self.frames.push(Frame::new(Open::Func(head), span, Doubts { drop: true, ..doubts }));
            return;
        }
        self.cut_short = !self.frames.is_empty();
        while !self.frames.is_empty() {
            self.unclosed(span, errors);
        }
        self.beyond = 0;
        self.too_deep = false;
        self.forgiven = 0;
        self.outside = false;
        self.frames.push(Frame::new(Open::Func(head), span, doubts));
    }

    fn open(&mut self, kind: Open, span: Span, mut doubts: Doubts, errors: &mut Vec<SyntaxError>) {
        if self.frames.is_empty() && !self.only_statements {
            self.report_outside(span, errors);
            doubts.drop = true;
        }
        if let Some(Frame { kind: Open::Switch(_, _, None, _), .. }) = self.frames.last() {
            // The block belongs to no case; a statement in its place reports that.
            self.statement(Stmt { kind: StmtKind::Expr(Box::new(error_at(span))), span }, errors);
        }
        if self.frames.len() >= BLOCK_LEVELS {
            if !std::mem::replace(&mut self.too_deep, true) {
                errors.push(SyntaxError::new(SyntaxErrorKind::TooManyBlocks, span));
            }
            self.beyond += 1;
            return;
        }
        self.frames.push(Frame::new(kind, span, doubts));
    }

    /// The position of the innermost open block of the kind.
    fn find(&self, kind: BlockKind) -> Option<usize> {
        self.frames.iter().rposition(|frame| frame.kind.kind() == kind)
    }

    /// The position of the block that a closing line (`closes`) or a branch belongs to, if any: the innermost block of
    /// its kind, except for one that may not be a block, where that makes fewer mistakes.
    fn owner(&self, kind: BlockKind, closes: bool, span: Span) -> Option<usize> {
        let innermost = self.find(kind)?;
        if innermost + 1 == self.frames.len() && !self.frames.get(innermost)?.doubts.may_open {
            return Some(innermost);
        }
        if kind == BlockKind::Func {
            return Some(innermost);
        }
        let stack: Stack = self.frames.iter().map(|frame| (frame.kind.kind(), frame.is_quiet())).collect();
        let after = |position: usize| {
            let mut stack = stack.clone();
            let missing = block_look_ahead::missing(stack.get(position + 1..).unwrap_or_default());
            stack.truncate(if closes { position } else { position + 1 });
            missing + self.mistakes_to_come(stack)
        };
        let mut best = (after(innermost), Some(innermost));
        if self.frames.get(innermost).is_some_and(|frame| frame.doubts.may_open) {
            let around = stack.get(..innermost)?.iter().rposition(|(open, _)| *open == kind);
            if let Some(around) = around
                && after(around) < best.0
            {
                best = (after(around), Some(around));
            }
        } else {
            let mut same = stack.clone();
            if let (Some(top), true) = (same.last_mut(), closes) {
                top.1 = true;
            }
            let none = 1 + self.mistakes_to_come(same);
            if none < best.0 || (none == best.0 && self.stands_under_innermost(innermost, span)) {
                best = (none, None);
            }
        }
        best.1
    }

    /// How many mistakes the lines held back contain when `stack` is open.
    fn mistakes_to_come(&self, stack: Stack) -> usize {
        block_look_ahead::mistakes(
            stack,
            self.waiting.iter().map(|(line, doubts)| Event::of(&line.kind, doubts.may_open)),
        )
    }

    /// Whether a line is indented like the innermost block and unlike the block at `position`.
    fn stands_under_innermost(&self, position: usize, span: Span) -> bool {
        let indent = |span: Span| {
            let before = self.source.get(..span.start as usize).unwrap_or_default();
            before.bytes().rev().take_while(|byte| matches!(byte, b' ' | b'\t')).count()
        };
        let of_frame = |frame: Option<&Frame>| frame.map(|frame| indent(frame.span));
        let own = Some(indent(span));
        own == of_frame(self.frames.last()) && own != of_frame(self.frames.get(position))
    }

    /// Closes all blocks inside the one at `position`; each of them lacks its closing line.
    fn close_inside(&mut self, position: usize, span: Span, errors: &mut Vec<SyntaxError>) {
        while self.frames.len() > position + 1 {
            self.unclosed(span, errors);
        }
    }

    fn branch(
        &mut self,
        word: &'static str,
        condition: Option<Expr>,
        span: Span,
        doubts: Doubts,
        errors: &mut Vec<SyntaxError>,
    ) {
        if self.beyond > 0 {
            return;
        }
        let Some(position) = self.owner(BlockKind::If, false, span) else {
            errors.push(SyntaxError::new(SyntaxErrorKind::BranchOutsideIf(word), span));
            return;
        };
        self.close_inside(position, span, errors);
        let Some(frame) = self.frames.last_mut() else { return };
        let Open::If(arms, current) = &mut frame.kind else { return };
        frame.doubts.may_open = false;
        frame.doubts.braced |= doubts.braced;
        // If a separate `if` inside the `else` was meant, one more `endif` follows.
        self.forgiven += usize::from(doubts.else_if);
        let Some(before) = current.take() else {
            let error = SyntaxError::new(SyntaxErrorKind::BranchAfterElse(word), span);
            errors.push(error.with(frame.span, "the `if` begins here"));
            return;
        };
        let mut body = std::mem::take(&mut frame.body);
        body.shrink_to_fit();
        arms.push((before, body));
        *current = condition;
    }

    fn case(&mut self, value: Option<Expr>, span: Span, errors: &mut Vec<SyntaxError>) {
        if self.beyond > 0 {
            return;
        }
        let Some(position) = self.owner(BlockKind::Switch, false, span) else {
            if let Some(error) = self.misspelt_switch() {
                errors.push(error);
                return self.case(value, span, errors);
            }
            errors.push(SyntaxError::new(SyntaxErrorKind::CaseOutsideSwitch, span));
            return;
        };
        self.close_inside(position, span, errors);
        let Some(frame) = self.frames.last_mut() else { return };
        let Open::Switch(_, arms, current, default) = &mut frame.kind else { return };
        if value.is_none() && std::mem::replace(default, true) {
            let error = SyntaxError::new(SyntaxErrorKind::SecondDefault, span);
            errors.push(error.with(frame.span, "the `switch` begins here"));
        }
        end_case(arms, current, &mut frame.body);
        *current = Some((value, span));
    }

    fn close(&mut self, kind: BlockKind, span: Span, condition: Option<Expr>, errors: &mut Vec<SyntaxError>) {
        if kind == BlockKind::Func {
            self.beyond = 0;
        }
        if self.beyond > 0 {
            self.beyond -= 1;
            return;
        }
        let Some(position) = self.owner(kind, true, span) else {
            self.close_nothing(kind, span, condition, errors);
            return;
        };
        self.close_inside(position, span, errors);
        self.pop(span, condition);
    }

    /// Handles a closing line that belongs to no block.
    fn close_nothing(&mut self, kind: BlockKind, span: Span, condition: Option<Expr>, errors: &mut Vec<SyntaxError>) {
        if kind == BlockKind::If && self.forgiven > 0 {
            self.forgiven -= 1;
            return;
        }
        if kind == BlockKind::Func && (self.outside || std::mem::take(&mut self.cut_short)) {
            return;
        }
        let top = self.frames.last().map(|frame| (frame.kind.kind(), frame.span, frame.is_quiet()));
        match top {
            Some((open, opened, false)) if open != BlockKind::Func => {
                let line = self.line_of(opened);
                let error = SyntaxError::new(SyntaxErrorKind::WrongEnd(open, line, kind), span);
                errors.push(error.with(opened, format!("this `{}` is open", open.opener())));
                // The block stays open: the line may just as well be superfluous, with the right one still to come.
                if let Some(frame) = self.frames.last_mut() {
                    frame.doubts.may_be_closed = true;
                }
            }
            _ => errors.push(
                self.misspelt_opener(kind, condition)
                    .unwrap_or_else(|| SyntaxError::new(SyntaxErrorKind::StrayEnd(kind), span)),
            ),
        }
    }

    /// Finds the statement before this closing line that was meant to open its block, and makes it open the block.
    fn misspelt_opener(&mut self, kind: BlockKind, condition: Option<Expr>) -> Option<SyntaxError> {
        if !matches!(kind, BlockKind::Loop | BlockKind::Repeat | BlockKind::While | BlockKind::If) {
            return None;
        }
        let (error, span, inner) = self.take_misspelt(kind)?;
        let kind = match kind {
            BlockKind::Loop => StmtKind::Loop(inner),
            BlockKind::Repeat => StmtKind::Repeat(inner, condition.map(Box::new)),
            BlockKind::While => StmtKind::While(Box::new(error_at(span)), inner),
            _ => StmtKind::If(Box::new(If { arms: vec![(error_at(span), inner)], otherwise: None })),
        };
        self.body().push(Stmt { kind, span });
        Some(error)
    }

    /// Finds the statement directly before a case that was meant to open its `switch`, and opens the `switch`.
    fn misspelt_switch(&mut self) -> Option<SyntaxError> {
        if self.frames.len() >= BLOCK_LEVELS {
            return None;
        }
        let (error, span, _) = self.take_misspelt(BlockKind::Switch)?;
        let kind = Open::Switch(error_at(span), Vec::new(), None, false);
        self.frames.push(Frame::new(kind, span, Doubts::default()));
        Some(error)
    }

    /// Takes the last statement of the innermost block that looks like a misspelt opener of this kind of block. Returns
    /// its error, its place, and the statements after it.
    fn take_misspelt(&mut self, kind: BlockKind) -> Option<(SyntaxError, Span, Block)> {
        self.searches = self.searches.checked_sub(1)?;
        let source = self.source;
        // A name that the program itself defines is not a slip.
        let functions = self.items.iter().filter_map(|item| match item {
            Item::Func(func) => Some(func.name.span.text(source)),
            _ => None,
        });
        let own: Vec<&str> = functions.collect();
        let word = |stmt: &Stmt| {
            let span = named(stmt)?;
            let text = span.text(source);
            let slipped = opening_slip(text, kind.opener()) && !own.iter().any(|name| name.eq_ignore_ascii_case(text));
            slipped.then_some(span)
        };
        let body = self.body();
        // Nothing is allowed between `switch` and its first case.
        let looked_at = if kind == BlockKind::Switch { 1 } else { usize::MAX };
        let mut last = body.iter().enumerate().rev().take(looked_at);
        let (at, name) = last.find_map(|(at, stmt)| Some((at, word(stmt)?)))?;
        let inner = body.split_off(at + 1);
        let span = body.pop()?.span;
        Some((SyntaxError::new(SyntaxErrorKind::Misspelt(name.text(source).into(), kind.opener()), name), span, inner))
    }

    /// The statements of the innermost block.
    fn body(&mut self) -> &mut Block {
        match self.frames.last_mut() {
            Some(frame) => &mut frame.body,
            None => &mut self.statements,
        }
    }

    /// Closes the innermost block, whose closing line is missing before `span`.
    fn unclosed(&mut self, span: Span, errors: &mut Vec<SyntaxError>) {
        let Some(frame) = self.frames.last() else { return };
        let (kind, opened, doubts) = (frame.kind.kind(), frame.span, frame.doubts);
        if doubts.may_open {
            // It was not a block after all: its statements belong to the block around it.
            let body = self.frames.pop().map_or(Vec::new(), |frame| frame.body);
            match self.frames.last_mut() {
                Some(around) => around.body.extend(body),
                None => self.statements.extend(body),
            }
            return;
        }
        let name = match &frame.kind {
            Open::Func(head) => head.name.span.text(self.source).into(),
            _ => "".into(),
        };
        // Beyond the limit of nested blocks, closing lines were not tracked.
        if !self.too_deep && !doubts.may_be_closed {
            let error = SyntaxError::new(SyntaxErrorKind::UnclosedBlock(kind, name), opened);
            errors.push(error.with(span, format!("`{}` belongs before this, or earlier", kind.closer())));
        }
        self.pop(span, None);
    }

    /// Closes the innermost block and adds it to the one around it.
    fn pop(&mut self, end: Span, condition: Option<Expr>) {
        let Some(Frame { kind, span, mut body, doubts, .. }) = self.frames.pop() else { return };
        if doubts.drop {
            return;
        }
        body.shrink_to_fit();
        let kind = match kind {
            Open::Func(head) => {
                let FuncHead { result, name, params } = *head;
                self.items.push(Item::Func(Func { result, name, params, body, span, end }));
                return;
            }
            Open::If(mut arms, Some(condition)) => {
                arms.push((condition, body));
                StmtKind::If(Box::new(If { arms, otherwise: None }))
            }
            Open::If(arms, None) => StmtKind::If(Box::new(If { arms, otherwise: Some(body) })),
            Open::While(condition) => StmtKind::While(Box::new(condition), body),
            Open::Repeat => StmtKind::Repeat(body, condition.map(Box::new)),
            Open::Loop => StmtKind::Loop(body),
            Open::For(mut head) => {
                head.body = body;
                StmtKind::For(head)
            }
            Open::Switch(subject, mut arms, mut current, _) => {
                end_case(&mut arms, &mut current, &mut body);
                StmtKind::Switch(Box::new(Switch { subject, arms }))
            }
        };
        let stmt = Stmt { kind, span };
        match self.frames.last_mut() {
            Some(frame) => frame.body.push(stmt),
            None => self.statements.push(stmt),
        }
    }
}

/// Moves the current case with its statements to the complete ones.
fn end_case(arms: &mut Vec<Arm>, current: &mut Option<(Option<Expr>, Span)>, body: &mut Block) {
    let mut body = std::mem::take(body);
    body.shrink_to_fit();
    if let Some((value, span)) = current.take() {
        arms.push(Arm { value, span, body });
    }
}

/// The name that a statement consists of, or calls.
fn named(stmt: &Stmt) -> Option<Span> {
    let StmtKind::Expr(expr) = &stmt.kind else { return None };
    match &expr.kind {
        ExprKind::Name(_) => Some(expr.span),
        ExprKind::Call(call) => call.module.is_none().then_some(call.name.span),
        _ => None,
    }
}

/// An expression that stands for something that could not be read.
pub(crate) fn error_at(span: Span) -> Expr {
    Expr { kind: ExprKind::Error, span }
}
