//! `waituntil`, whose condition is evaluated repeatedly.

use super::body::FunctionCode;
use crate::hir::{Builtin, Expr, Passed, Place as HirPlace};
use arl_code::Op;
use arl_lang::catalog::Mode;

impl<'p> FunctionCode<'p, '_> {
    pub(super) fn wait_until(&mut self, builtin: &'p Builtin) {
        self.passing(|body| body.wait(builtin));
    }

    fn wait(&mut self, builtin: &'p Builtin) {
        let (mut condition, mut limit, mut flag): (Option<&'p Expr>, Option<&'p Expr>, Option<&'p HirPlace>) =
            Default::default();
        for arg in &builtin.args {
            let mode = builtin.entry.params.get(arg.param).map(|param| param.mode);
            match &arg.value {
                Passed::Value(value) if mode == Some(Mode::Condition) => condition = Some(value),
                Passed::Value(value) => limit = Some(value),
                Passed::Out(place) => flag = Some(place),
            }
        }
        let line = self.line;
        let limit = limit.map(|limit| self.number(limit, None));
        let wait = self.register();
        self.op(Op::Wait { to: wait, limit, line });
        let Some(condition) = condition else { return };
        let spot = flag.map(|flag| {
            let spot = self.spot_before(flag, &[condition]);
            self.settled(spot)
        });
        let facts = self.facts(condition);
        let changes = facts.changes || !facts.writes.is_empty();
        let again = self.here();
        let met = self.jump_if(condition, true);
        let late = limit.map(|_| {
            let to = self.register();
            self.op(Op::IsLate { to, wait });
            self.op(Op::JumpIf { from: to, to: 0 })
        });
        // If evaluating the condition changes something, or if a time limit ends the wait, the program does more than
        // wait.
        self.op(if limit.is_some() || changes { Op::NextCycle } else { Op::Change });
        self.op(Op::Jump { to: again });
        let Some(spot) = spot else {
            self.lead_here(met.into_iter().chain(late));
            return;
        };
        let value = self.register();
        self.lead_here(late);
        self.op(Op::Small { to: value, value: 1 });
        let over = self.op(Op::Jump { to: 0 });
        self.lead_here(met);
        self.op(Op::Small { to: value, value: 0 });
        self.lead_here([over]);
        self.store(spot, value);
    }
}
