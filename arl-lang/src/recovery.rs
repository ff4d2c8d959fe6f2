//! What the tree keeps of a line that could not be read: that it opens or closes a block, and what it declares, so
//! that the error costs this line only.

use crate::ast::{Decl, Expr, For, FuncParam, Ident, Stmt, StmtKind, TypeRef, Var};
use crate::blocks::error_at;
use crate::explain::begins_value;
use crate::line::{FuncHead, Line, LineKind};
use crate::span::Span;
use crate::symbol::Symbol;
use crate::token::{Placed, Token};

/// A line recovered from one that could not be read.
pub(crate) struct Recovered {
    pub(crate) line: Line,
    /// It may or may not open a block.
    pub(crate) may_open: bool,
    /// Its block is not kept.
    pub(crate) drop: bool,
}

/// What to keep of `tokens`. `read` is the line that its valid beginning forms, if any, and `void` the symbol of that
/// type.
pub(crate) fn recover(tokens: &[Placed], read: Option<Line>, void: Symbol) -> Option<Recovered> {
    let (first, last) = (tokens.first()?, tokens.last()?);
    let span = Span::new(first.0, last.2);
    let unknown = || error_at(span);
    let mut may_open = false;
    let mut drop = false;
    let kind = match first.1 {
        Token::If => match condition_end(tokens) {
            // `if(a) endif`, `if(a) if(b) x()`: complete on their line. `if(a) while(b)`: the inner block continues.
            Some(end) if matches!(tokens.get(end), Some((_, Token::If | Token::EndIf, _))) => return None,
            Some(end) if tokens.get(end).is_some_and(|next| is_opener(next.1)) => {
                return recover(tokens.get(end..).unwrap_or_default(), None, void);
            }
            // `if(a) && (b)`, `if(a) )`: there is no statement after the condition.
            Some(end) if tokens.get(end).is_none_or(|next| !may_begin_statement(next.1)) => {
                LineKind::If(guard(read).unwrap_or_else(unknown))
            }
            _ => {
                may_open = true;
                LineKind::If(unknown())
            }
        },
        Token::ElseIf => LineKind::ElseIf(guard(read).unwrap_or_else(unknown)),
        Token::While => LineKind::While(guard(read).unwrap_or_else(unknown)),
        Token::Until => LineKind::Until(guard(read).unwrap_or_else(unknown)),
        Token::Switch => LineKind::Switch(guard(read).unwrap_or_else(unknown)),
        Token::Case => LineKind::Case(unknown()),
        Token::For => {
            LineKind::For(Box::new(For { init: loop_variable(tokens), condition: None, step: None, body: Vec::new() }))
        }
        Token::Else => LineKind::Else,
        Token::EndIf => LineKind::EndIf,
        Token::EndWhile => LineKind::EndWhile,
        Token::Repeat => LineKind::Repeat,
        Token::Loop => LineKind::Loop,
        Token::EndLoop => LineKind::EndLoop,
        Token::EndFor => LineKind::EndFor,
        Token::Default => LineKind::Default,
        Token::EndSwitch => LineKind::EndSwitch,
        Token::EndFunc => LineKind::EndFunc,
        Token::Func => match read {
            Some(Line { kind: kind @ LineKind::Func(_), .. }) => kind,
            _ => {
                let head = function_head(tokens, void);
                drop = head.is_none();
                let nameless = || {
                    let place = Span::new(first.0, first.2);
                    let result = TypeRef { name: void, system: false, span: place };
                    FuncHead { result, name: Ident { symbol: void, span: place }, params: Vec::new() }
                };
                LineKind::Func(Box::new(head.unwrap_or_else(nameless)))
            }
        },
        Token::Return => LineKind::Statement(StmtKind::Return(Some(Box::new(unknown())))),
        Token::Const | Token::Type(_) | Token::Name(_) | Token::System(_) => match declaration(tokens) {
            Some(decl) => LineKind::Statement(StmtKind::Decl(Box::new(decl))),
            None => return None,
        },
        _ => return None,
    };
    Some(Recovered { line: Line { kind, span }, may_open, drop })
}

/// Whether the token opens a block, `if` excepted.
fn is_opener(token: Token) -> bool {
    matches!(token, Token::While | Token::For | Token::Loop | Token::Repeat | Token::Switch)
}

/// Whether a statement may begin with the token.
fn may_begin_statement(token: Token) -> bool {
    begins_value(token)
        || matches!(
            token,
            Token::Instruction(_)
                | Token::ParenOpen
                | Token::PlusPlus
                | Token::MinusMinus
                | Token::Break
                | Token::Continue
                | Token::Goto
                | Token::Return
        )
}

/// The condition that was read before the error.
fn guard(read: Option<Line>) -> Option<Expr> {
    match read?.kind {
        LineKind::If(guard)
        | LineKind::ElseIf(guard)
        | LineKind::While(guard)
        | LineKind::Until(guard)
        | LineKind::Switch(guard) => Some(guard),
        _ => None,
    }
}

/// The index of the token after the parentheses of the condition that begins with the second token.
pub(crate) fn condition_end(tokens: &[Placed]) -> Option<usize> {
    let mut depth = 0_usize;
    for (at, (_, token, _)) in tokens.iter().enumerate().skip(1) {
        match token {
            Token::ParenOpen => depth += 1,
            Token::ParenClose if depth <= 1 => return Some(at + 1),
            Token::ParenClose => depth -= 1,
            _ => {}
        }
    }
    None
}

fn name(token: Option<&Placed>) -> Option<Ident> {
    match token {
        Some((start, Token::Name(symbol), end)) => Some(Ident { symbol: *symbol, span: Span::new(*start, *end) }),
        _ => None,
    }
}

fn type_ref(token: Option<&Placed>) -> Option<TypeRef> {
    let (start, token, end) = token?;
    let span = Span::new(*start, *end);
    match token {
        Token::Name(name) | Token::Type(name) => Some(TypeRef { name: *name, system: false, span }),
        Token::System(name) => Some(TypeRef { name: *name, system: true, span }),
        _ => None,
    }
}

/// The variables that the line declares; their values are unknown.
fn declaration(tokens: &[Placed]) -> Option<Decl> {
    let constant = tokens.first().filter(|first| first.1 == Token::Const).map(|first| Span::new(first.0, first.2));
    let rest = tokens.get(usize::from(constant.is_some())..)?;
    let ty = type_ref(rest.first())?;
    name(rest.get(1))?;
    let span = Span::new(tokens.first()?.0, tokens.last()?.2);
    let mut vars = Vec::new();
    let mut depth = 0_usize;
    let mut in_value = false;
    for pair in rest.windows(2) {
        let [(_, before, _), token] = pair else { continue };
        match before {
            Token::ParenOpen | Token::BracketOpen | Token::BraceOpen => depth += 1,
            Token::ParenClose | Token::BracketClose | Token::BraceClose => depth = depth.saturating_sub(1),
            Token::Assign(_) => in_value = true,
            Token::Comma if depth == 0 => in_value = false,
            _ => {}
        }
        // A name directly after a variable's name: the comma is missing.
        let begins = *before == Token::Comma || (!in_value && matches!(before, Token::Name(_)));
        let declares = vars.is_empty() || (depth == 0 && begins);
        if let (true, Some(name)) = (declares, name(Some(token))) {
            vars.push(Var { name, dims: Vec::new(), init: Some(error_at(span)) });
        }
    }
    Some(Decl { constant, ty, vars, span })
}

/// The variable that a `for` declares.
fn loop_variable(tokens: &[Placed]) -> Option<Stmt> {
    // `for i in range(3)`, `FOR i FROM 1 TO 3`: not a declaration.
    let opens = matches!(tokens.get(1), Some((_, Token::ParenOpen, _)));
    let mut decl = declaration(tokens.get(2..).filter(|_| opens)?)?;
    decl.vars.truncate(1);
    Some(Stmt { span: decl.span, kind: StmtKind::Decl(Box::new(decl)) })
}

/// The line that begins a function in another language's words.
pub(crate) fn other_function(tokens: &[Placed], void: Symbol) -> Option<Line> {
    let (first, last) = (tokens.first()?, tokens.last()?);
    let span = Span::new(first.0, last.2);
    let is_name = |token: &&Placed| matches!(token.1, Token::Name(_));
    let named = tokens.windows(2).find(|pair| matches!(pair, [(_, Token::Name(_), _), (_, Token::ParenOpen, _)]));
    let name = name(named.and_then(|pair| pair.first()).or_else(|| tokens.iter().skip(1).find(is_name)))
        .unwrap_or(Ident { symbol: void, span });
    let result = TypeRef { name: void, system: false, span: Span::new(first.0, first.2) };
    Some(Line { kind: LineKind::Func(Box::new(FuncHead { result, name, params: Vec::new() })), span })
}

/// The name of a function and those of its parameters that can be made out.
fn function_head(tokens: &[Placed], void: Symbol) -> Option<FuncHead> {
    let (result, name_at) = match (tokens.get(1), tokens.get(2)) {
        (Some((start, Token::Name(_), _)), None | Some((_, Token::ParenOpen, _))) => {
            (TypeRef { name: void, system: false, span: Span::new(*start, *start) }, 1)
        }
        (token, _) => (type_ref(token)?, 2),
    };
    let name_of = name(tokens.get(name_at))?;
    let mut params = Vec::new();
    for three in tokens.get(name_at + 1..).unwrap_or_default().windows(3) {
        // A type directly after a name: the comma is missing.
        let [(_, before, _), ty, param] = three else { continue };
        let begins = match before {
            Token::ParenOpen | Token::Comma => true,
            Token::Name(_) | Token::BracketClose => matches!(ty.1, Token::Type(_)),
            _ => false,
        };
        if !begins {
            continue;
        }
        if let (Some(ty), Some(name)) = (type_ref(Some(ty)), name(Some(param))) {
            params.push(FuncParam { ty, name, dims: Vec::new(), span: ty.span.to(name.span) });
        }
    }
    Some(FuncHead { result, name: name_of, params })
}
