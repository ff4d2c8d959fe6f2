//! Programs for a debugger: each function may be halted at each of its statements, where its variables can be read and
//! set from outside.
//!
//! Invariants:
//! - the program does the same, and in the same cycles, as without a debugger: rounds of loops are counted as
//!   determined before;
//! - a variable may be set at any statement, so nothing is concluded from which code writes it.

use super::loops;
use crate::hir::{Block, Program, StmtKind};
use arl_lang::catalog::Base;

/// Prepares all functions of a program whose effects are known for a debugger.
pub(crate) fn mark(program: &mut Program) {
    for func in &mut program.funcs {
        let effects = &mut func.effects;
        (effects.waits, effects.fails, effects.context) = (true, true, true);
        let params = &func.params;
        for (at, local) in func.locals.iter_mut().enumerate() {
            let known = local.constant && local.value.is_some();
            let handed_handle = matches!(local.ty.base, Base::Handle(_)) && params.iter().any(|id| id.0 as usize == at);
            local.shared |= !known && !handed_handle;
        }
        share_loops(&mut func.body);
    }
}

fn share_loops(block: &mut Block) {
    for stmt in block {
        if let StmtKind::For(each) = &mut stmt.kind {
            each.shared = true;
        }
        loops::inner_blocks(stmt).into_iter().for_each(share_loops);
    }
}
