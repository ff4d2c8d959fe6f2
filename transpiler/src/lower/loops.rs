//! Loops, and where they give the cycle back.
//!
//! A loop that has to yield the cycle does so after its last statement, or at the start of the round if a `continue`
//! would jump over that. A loop in which nothing else counts rounds takes them one by one (`Op::Take`).

use super::body::FunctionCode;
use super::control_flow::OpenLoop;
use super::places::Spot;
use crate::effects::{flow, loops, visibility};
use crate::hir::{Counting, Expr, For, LocalId, LoopInfo, Stmt, Walk};
use arl_code::{Address, ChargeStep, Charging, Op, Place, Reg, Space};

/// The parts of a loop.
struct Parts<'p> {
    /// Evaluated before each round; `None` for always.
    condition: Option<&'p Expr>,
    body: &'p [Stmt],
    /// What comes after each round.
    rest: Rest<'p>,
}

/// What comes after each round of a loop.
enum Rest<'p> {
    Nothing,
    Until(&'p Expr),
    Step(Option<&'p Expr>),
}

impl<'p> FunctionCode<'p, '_> {
    /// `while(c)`
    pub(super) fn while_loop(&mut self, condition: &'p Expr, body: &'p [Stmt], info: LoopInfo) {
        if flow::always(condition) {
            return self.endless_loop(body, info);
        }
        let parts = Parts { condition: Some(condition), body, rest: Rest::Nothing };
        let Counting::Walking(Walk { local, step }) = info.counting else { return self.turns(&parts, info) };
        let first = self.counted(local);
        self.turns(&parts, info);
        let step = match step {
            1 => ChargeStep::Up,
            -1 => ChargeStep::Down,
            _ => {
                let by = self.register();
                self.op(Op::Small { to: by, value: step.unsigned_abs() as i32 });
                if step > 0 { ChargeStep::By(by) } else { ChargeStep::DownBy(by) }
            }
        };
        self.charge(first, local, step, info);
    }

    /// `loop`
    pub(super) fn endless_loop(&mut self, body: &'p [Stmt], info: LoopInfo) {
        self.turns(&Parts { condition: None, body, rest: Rest::Nothing }, info);
    }

    /// `repeat` ... `until(c)`
    pub(super) fn repeat_loop(&mut self, body: &'p [Stmt], until: &'p Expr, info: LoopInfo) {
        self.halt();
        self.turns(&Parts { condition: None, body, rest: Rest::Until(until) }, info);
    }

    /// `for(init; condition; step)`
    pub(super) fn for_loop(&mut self, each: &'p For) {
        let visible = self.flow.visible.len();
        let line = self.line;
        if let Some(range) = loops::emitted_range(each) {
            // Its bounds are looked at once.
            self.line = line;
            if crate::effects::pointer::is_needed(self.scope(), &self.lowering.movers, range.from) {
                self.op(Op::Line { line });
            }
            self.range_loop(each, &range);
        } else {
            self.halt_at_head(&each.init);
            for stmt in &each.init {
                self.statement(stmt);
            }
            self.line = line;
            self.general_for(each);
        }
        self.drop_declared(&each.init);
        self.end_scope(visible);
    }

    /// A `for` whose variable only counts: the test stands behind the round, too.
    fn range_loop(&mut self, each: &'p For, range: &loops::Range<'p>) {
        let (info, body, line) = (each.info, &each.body, self.line);
        let place = self.declare(range.local);
        self.flow.visible.push(range.local);
        let ty = self.local_type(range.local);
        self.passing(|emitter| emitter.set_new(Spot::new(place, ty), range.from));
        let Some(condition) = &each.condition else { return };
        let mut leave = self.jump_if(condition, false);
        let first = self.here();
        let continued = flow::continues(body);
        let spends = info.counts_in_context();
        if spends && continued {
            self.op(Op::Spend { rounds: info.rounds });
        }
        let OpenLoop { breaks, continues } = self.round(body);
        if spends && !continued && !flow::block_diverges(body) {
            self.op(Op::Spend { rounds: info.rounds });
        }
        self.lead_here(continues);
        self.drop_handles(body);
        self.line = line;
        if flow::goes_round(body) {
            let step_at = self.here();
            if let Some(step) = &each.step {
                self.passing(|body| body.effect_of(step));
            }
            let again = self.jump_if(condition, true);
            self.go_round(step_at, again, first);
        }
        leave.extend(breaks);
        self.lead_here(leave);
        self.drop_handles(body);
    }

    fn general_for(&mut self, each: &'p For) {
        let behind = match each.info.counting {
            Counting::Behind => loops::Head::of_any(each),
            _ => None,
        };
        let first = behind.as_ref().map(|head| self.counted(head.local));
        let condition = each.condition.as_ref().filter(|condition| !flow::always(condition));
        let parts = Parts { condition, body: &each.body, rest: Rest::Step(each.step.as_ref()) };
        self.turns(&parts, each.info);
        if let (Some(head), Some(first)) = (behind, first) {
            let step = head.step.filter(|step| loops::whole_number(step) != Some(1));
            let step = match step {
                None => ChargeStep::Up,
                Some(step) => ChargeStep::By(self.number(step, None)),
            };
            self.charge(first, head.local, step, each.info);
        }
    }

    /// The value that the variable of a loop has before it.
    fn counted(&mut self, local: LocalId) -> Reg {
        let to = self.register();
        let spot = self.counting_spot(local);
        self.load(spot, Some(to))
    }

    fn counting_spot(&mut self, local: LocalId) -> Spot {
        let ty = self.local_type(local);
        let place = self.locals.get(&local).copied().unwrap_or(Place::start(Space::Register(0)));
        Spot::new(place, ty)
    }

    /// Counts the rounds of a loop after it.
    fn charge(&mut self, first: Reg, local: LocalId, step: ChargeStep, info: LoopInfo) {
        let how = match info.spends {
            _ if self.flow.counts_alone => Charging::Counter,
            true => Charging::Spend,
            false => Charging::Charge,
        };
        let spot = self.counting_spot(local);
        let last = self.load(spot, None);
        self.op(Op::Charge { first, last, step, how, rounds: info.rounds });
    }

    /// The statements of a round.
    fn round(&mut self, body: &'p [Stmt]) -> OpenLoop {
        self.flow.loops.push(OpenLoop::default());
        self.block(body);
        self.flow.loops.pop().unwrap_or_default()
    }

    /// A loop, which may be endless.
    fn turns(&mut self, parts: &Parts<'p>, info: LoopInfo) {
        let (alone, spends) = (info.counts_alone(), info.counts_in_context());
        let continued = flow::continues(parts.body);
        let line = self.line;
        let outer = self.flow.counts_alone;
        self.flow.counts_alone |= alone;
        let has_rest = !matches!(parts.rest, Rest::Nothing);
        let start = self.here();
        if !has_rest {
            self.halt();
        }
        let head = self.here();
        let takes_first = alone && parts.condition.is_none_or(|condition| self.takes_first(condition));
        if takes_first {
            self.op(Op::Take { again: head });
        }
        let mut leave = Vec::new();
        if let Some(condition) = parts.condition {
            self.pointer(condition);
            leave = self.jump_if(condition, false);
        }
        let after_test = self.here();
        if alone && !takes_first {
            self.op(Op::Take { again: head });
        }
        if spends && continued && !has_rest {
            self.op(Op::Spend { rounds: info.rounds });
        }
        let OpenLoop { breaks, continues } = self.round(parts.body);
        let handles = !visibility::handles(parts.body, self.func).is_empty();
        // A condition that only calculates stands behind the round once more, which saves a jump.
        let turns = !takes_first && !self.is_watched();
        let turned = parts.condition.filter(|condition| turns && self.only_calculates(condition));
        if !has_rest {
            if !flow::block_diverges(parts.body) {
                if spends && !continued {
                    self.op(Op::Spend { rounds: info.rounds });
                }
                self.line = line;
                let step_at = self.here();
                self.turn(turned, start, after_test, step_at);
            }
            if (handles || self.is_watched()) && !continues.is_empty() {
                self.land(continues, parts.body);
                self.drop_handles(parts.body);
                self.op(Op::Jump { to: start });
            } else {
                continues.into_iter().for_each(|jump| self.lead(jump, start));
            }
        } else {
            self.land(continues, parts.body);
            self.drop_handles(parts.body);
            if flow::goes_round(parts.body) {
                let step_at = self.here();
                match parts.rest {
                    Rest::Until(until) => {
                        self.stand_at(until.span);
                        self.halt();
                        self.pointer(until);
                        leave.extend(self.jump_if(until, true));
                    }
                    Rest::Step(step) => {
                        self.line = line;
                        self.halt();
                        step.into_iter().for_each(|step| self.effect(step));
                    }
                    Rest::Nothing => {}
                }
                if spends {
                    self.op(Op::Spend { rounds: info.rounds });
                }
                self.line = line;
                self.turn(turned, start, after_test, step_at);
            }
        }
        self.line = line;
        self.flow.counts_alone = outer;
        self.lead_here(leave);
        self.land(breaks, parts.body);
        self.drop_handles(parts.body);
        if alone && parts.condition.is_some() && !takes_first {
            // The condition may have ended the loop although more was counted before it than there was.
            self.op(Op::Leave { again: head });
        }
    }

    /// Whether a loop that counts alone takes a round before it evaluates its condition.
    fn takes_first(&self, condition: &'p Expr) -> bool {
        loops::takes_first(self.scope(), condition)
    }

    /// Whether evaluating an expression needs neither the context nor a call.
    fn only_calculates(&self, condition: &'p Expr) -> bool {
        let facts = self.facts(condition);
        !facts.context && facts.calls.is_empty() && facts.writes.is_empty()
    }

    /// Goes on with the next round; its step, if there is one, begins at `step_at`.
    fn turn(&mut self, condition: Option<&'p Expr>, head: Address, after_test: Address, step_at: Address) {
        let Some(condition) = condition else {
            self.op(Op::Jump { to: head });
            return;
        };
        let met = self.jump_if(condition, true);
        self.go_round(step_at, met, after_test);
    }

    /// Leads the jumps of a condition to the next round. Where all that stands from the step on is a sum and one
    /// comparison with its result, one operation does both: nothing leads in between.
    fn go_round(&mut self, step_at: Address, jumps: Vec<Address>, round: Address) {
        let ops = &mut self.lowering.code.ops;
        let fused = match ops.get(step_at as usize..) {
            Some([Op::AddSmall { to, left, value: by }, test]) if to == left && jumps == [step_at + 1] => {
                let by = i16::try_from(*by).ok();
                by.and_then(|by| match *test {
                    Op::JumpLess { left, right, .. } if left == *to && right != *to => {
                        Some(Op::StepLess { left, right, by, to: round })
                    }
                    Op::JumpLessSmall { left, value, .. } if left == *to => {
                        Some(Op::StepLessSmall { left, by, value, to: round })
                    }
                    _ => None,
                })
            }
            _ => None,
        };
        if let Some(fused) = fused {
            ops.truncate(step_at as usize);
            self.op(fused);
        } else {
            jumps.into_iter().for_each(|jump| self.lead(jump, round));
        }
    }
}
