//! Which tokens may follow the beginning of a line. Explaining mistakes queries the grammar for this again and again.

use std::cell::RefCell;
use std::collections::HashMap;
use std::mem::{Discriminant, discriminant};

use lalrpop_util::ParseError;

use crate::grammar::LineParser;
use crate::symbol::Symbol;
use crate::token::{Placed, Token};
use crate::tree::Context;

/// Longer beginnings of lines are not remembered.
const LONGEST: usize = 64;
/// How many answers are remembered.
const ANSWERS: usize = 4096;

/// The kinds of the first tokens of a line, and of the token after them: all that the grammar depends on.
type Question = (Vec<Discriminant<Token>>, Option<Discriminant<Token>>);

/// Queries the grammar and caches its answers for lines of the same form, which files with many mistakes repeat.
#[derive(Default)]
pub(crate) struct Followers {
    known: RefCell<HashMap<Question, bool>>,
}

impl Followers {
    /// Whether the tokens can be followed by `next`, or by the end of the line.
    pub(crate) fn can_follow(
        &self,
        grammar: &LineParser,
        source: &str,
        endl: Symbol,
        tokens: &[Placed],
        next: Option<Token>,
    ) -> bool {
        let ask = || goes_on(grammar, source, endl, tokens, next);
        if tokens.len() > LONGEST {
            return ask();
        }
        let kinds = tokens.iter().map(|(_, token, _)| discriminant(token)).collect();
        let question = (kinds, next.map(|next| discriminant(&next)));
        let mut known = self.known.borrow_mut();
        if known.len() >= ANSWERS {
            known.clear();
        }
        *known.entry(question).or_insert_with(ask)
    }
}

fn goes_on(grammar: &LineParser, source: &str, endl: Symbol, tokens: &[Placed], next: Option<Token>) -> bool {
    let mut context = Context { source, errors: Vec::new(), endl };
    let behind = u32::MAX;
    let next = next.map(|next| (behind, next, behind));
    match grammar.parse(&mut context, tokens.iter().copied().chain(next)) {
        Ok(_) => true,
        Err(ParseError::UnrecognizedEof { .. }) => next.is_some(),
        Err(_) => false,
    }
}
