//! The code of a block with parts.

use super::leave::Frame;
use super::plan::BlockPiece;
use crate::emit::body::Body;
use crate::emit::control_flow::Tail;
use crate::emit::mentions;
use crate::emit::rows::Group;
use crate::hir::{LocalId, Stmt, StmtKind};
use proc_macro2::TokenStream;
use quote::quote;
use std::collections::{HashMap, HashSet};

impl<'p> Body<'p, '_> {
    /// The code of consecutive groups in a block, split into parts if there are many.
    pub(in crate::emit) fn grouped(&mut self, groups: Vec<Group<'p>>, tail: Tail) -> TokenStream {
        let weights: Vec<usize> = groups.iter().map(|group| self.group_weight(group)).collect();
        let mut pieces = self.planned(&groups, &weights);
        let mut out = TokenStream::new();
        let mut behind = Vec::new();
        if pieces.iter().any(|piece| matches!(piece, BlockPiece::Part(_))) {
            // The room for a call is asked for between two parts, not inside of one: it is held until the end.
            let leads_back = groups.iter().position(|group| self.leads_back(group));
            if let Some(at) = leads_back.filter(|_| self.form.guard.is_some()) {
                let ((first, rest), (first_weights, rest_weights)) = (groups.split_at(at), weights.split_at(at));
                pieces = self.planned(first, first_weights);
                behind = self.planned(rest, rest_weights);
                behind.iter_mut().for_each(|piece| piece.shift(at));
            }
            let all: Vec<BlockPiece> = pieces.iter().chain(&behind).cloned().collect();
            // Variables that live before all states also live before the parts of one state.
            let of_states = self.flow.machine.as_ref().map(|machine| machine.hoisted.clone()).unwrap_or_default();
            for id in outside_parts(&groups, &all).into_iter().filter(|id| !of_states.contains(id)) {
                out.extend(self.hoisted_variable(id));
                self.locals.hoisted.insert(id);
            }
        }
        if behind.is_empty() {
            out.extend(self.pieces(&pieces, &groups, tail));
        } else {
            out.extend(self.pieces(&pieces, &groups, Tail::Inner));
            out.extend(self.form.guard.take());
            out.extend(self.pieces(&behind, &groups, tail));
        }
        out
    }

    /// Whether a group calls a function that may lead back to the current one.
    fn leads_back(&self, group: &Group<'p>) -> bool {
        match group {
            Group::Alone(stmt) => self.calls_itself(stmt),
            Group::Table(rows) => rows.iter().any(|row| self.calls_itself(row.stmt)),
        }
    }

    fn pieces(&mut self, pieces: &[BlockPiece], groups: &[Group<'p>], tail: Tail) -> TokenStream {
        let mut out = TokenStream::new();
        let last = pieces.len().saturating_sub(1);
        for (at, piece) in pieces.iter().enumerate() {
            let tail = if at == last { tail } else { Tail::Inner };
            out.extend(match piece {
                BlockPiece::Group(number) => groups.get(*number).map(|group| self.group(group, tail)),
                BlockPiece::Part(pieces) => Some(self.part(pieces, groups)),
            });
        }
        out
    }

    fn group(&mut self, group: &Group<'p>, tail: Tail) -> TokenStream {
        let calls_itself = self.form.guard.is_some() && self.leads_back(group);
        let guard = if calls_itself { self.form.guard.take() } else { None };
        let own = self.form.guard.take();
        let code = match group {
            Group::Alone(stmt) => self.statement(stmt, tail),
            Group::Table(rows) => self.table(rows),
        };
        self.form.guard = own;
        quote!(#guard #code)
    }

    /// `let lines = async { .. }; part(pin!(lines)).await?;`
    fn part(&mut self, pieces: &[BlockPiece], groups: &[Group<'p>]) -> TokenStream {
        self.flow.parts.push(Frame { loops: self.flow.loops.len(), leaves: Vec::new() });
        let code = self.pieces(pieces, groups, Tail::Inner);
        let leaves = self.flow.parts.pop().map(|frame| frame.leaves).unwrap_or_default();
        let ask = self.fails().then(|| quote!(?));
        let lines = self.reserve("lines");
        self.release(&lines);
        if leaves.is_empty() {
            let end = self.fails().then(|| quote!(Done::Ok(())));
            return quote!(let #lines = async { #code #end }; part(pin!(#lines)).await #ask;);
        }
        let returns = leaves.contains(&super::Leave::Return);
        let end = self.ended(if returns { quote!(Leave::On) } else { quote!(Leave::<()>::On) });
        let arms: Vec<TokenStream> = leaves.into_iter().map(|how| self.arm_of(how)).collect();
        // A separate statement ends the borrows of the part, which the arms may need.
        let left = self.reserve("left");
        self.release(&left);
        quote! {
            let #lines = async { #code #end };
            let #left = part(pin!(#lines)).await #ask;
            match #left {
                #(#arms)*
                _ => {}
            }
        }
    }
}

/// The locals that are declared in a part and mentioned outside it, in the order of their declarations.
fn outside_parts(groups: &[Group<'_>], pieces: &[BlockPiece]) -> Vec<LocalId> {
    let mut part_of = vec![0; groups.len()];
    number_parts(pieces, 0, &mut 0, &mut part_of);
    let mut declared: Vec<LocalId> = Vec::new();
    let mut home: HashMap<LocalId, usize> = HashMap::new();
    for (group, part) in groups.iter().zip(&part_of) {
        if let Group::Alone(Stmt { kind: StmtKind::Let(id, _), .. }) = group
            && *part != 0
        {
            declared.push(*id);
            home.insert(*id, *part);
        }
    }
    let mut outside = HashSet::new();
    for (group, part) in groups.iter().zip(&part_of) {
        let mut see = |id: LocalId| {
            if home.get(&id).is_some_and(|home| home != part) {
                outside.insert(id);
            }
        };
        match group {
            Group::Alone(stmt) => mentions::each_local(stmt, &mut see),
            Group::Table(rows) => rows.iter().for_each(|row| mentions::each_local(row.stmt, &mut see)),
        }
    }
    declared.retain(|id| outside.contains(id));
    declared
}

/// Numbers the parts that directly contain the groups; 0 means outside.
fn number_parts(pieces: &[BlockPiece], own: usize, last: &mut usize, part_of: &mut [usize]) {
    for piece in pieces {
        match piece {
            BlockPiece::Group(number) => {
                if let Some(part) = part_of.get_mut(*number) {
                    *part = own;
                }
            }
            BlockPiece::Part(pieces) => {
                *last += 1;
                number_parts(pieces, *last, last, part_of);
            }
        }
    }
}
