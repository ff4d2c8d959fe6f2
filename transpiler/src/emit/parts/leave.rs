//! Exits from a part: `return`, `break`, `continue`, and jumps to states.

use crate::emit::body::Body;
use arl_lang::catalog::Base;
use proc_macro2::TokenStream;
use quote::quote;

/// A part that is being emitted.
#[derive(Debug)]
pub(in crate::emit) struct Frame {
    /// The number of loops around it.
    pub(super) loops: usize,
    /// The ways in which it is left, in the order in which they were found.
    pub(super) leaves: Vec<Leave>,
}

/// How a part is left before its end.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(in crate::emit) enum Leave {
    /// The function ends.
    Return,
    /// The loop around the part ends.
    Break,
    /// The loop around the part goes to its next round.
    Continue,
    /// The function continues in the state that has been set.
    Jump,
}

impl<'p> Body<'p, '_> {
    /// The code that leaves the innermost part like this; `None` if there is no part, or if the loop is inside it.
    pub(in crate::emit) fn leave_part(&mut self, how: Leave, value: Option<&TokenStream>) -> Option<TokenStream> {
        let loops = self.flow.loops.len();
        let frame = self.flow.parts.last_mut()?;
        if matches!(how, Leave::Break | Leave::Continue) && loops > frame.loops {
            return None;
        }
        if !frame.leaves.contains(&how) {
            frame.leaves.push(how);
        }
        let leave = match how {
            Leave::Return => match value {
                Some(value) => quote!(Leave::Return(#value)),
                None => quote!(Leave::Return(())),
            },
            Leave::Break => quote!(Leave::Break),
            Leave::Continue => quote!(Leave::Continue),
            Leave::Jump => quote!(Leave::Jump),
        };
        let leave = self.ended(leave);
        Some(quote!(return #leave;))
    }

    /// The end of a part that may be left early.
    pub(super) fn ended(&self, leave: TokenStream) -> TokenStream {
        if self.fails() { quote!(Done::Ok(#leave)) } else { leave }
    }

    /// Whether the function's result can report alarms.
    pub(in crate::emit) fn fails(&self) -> bool {
        self.func.is_some_and(|func| func.effects.fails)
    }

    /// The match arm that carries out what leaving a part requests.
    pub(super) fn arm_of(&mut self, how: Leave) -> TokenStream {
        match how {
            Leave::Return => {
                let void = self.func.is_none_or(|func| func.result == Base::Void);
                let (pattern, value) = if void { (quote!(()), None) } else { (quote!(value), Some(quote!(value))) };
                let code = self.return_of(TokenStream::new(), value);
                quote!(Leave::Return(#pattern) => { #code })
            }
            Leave::Break => {
                let code = self.leave(true);
                quote!(Leave::Break => { #code })
            }
            Leave::Continue => {
                let code = self.leave(false);
                quote!(Leave::Continue => { #code })
            }
            Leave::Jump => {
                let code = self.go_on();
                quote!(Leave::Jump => { #code })
            }
        }
    }

    /// `return`, with a value computed by the statements before it.
    pub(in crate::emit) fn return_of(&mut self, before: TokenStream, value: Option<TokenStream>) -> TokenStream {
        if let Some(leave) = self.leave_part(Leave::Return, value.as_ref()) {
            return quote!(#before #leave);
        }
        match self.result(value) {
            Some(result) => quote!(#before return #result;),
            None => quote!(#before return;),
        }
    }
}
