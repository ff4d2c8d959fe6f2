//! Targets that a certain robot can never reach, as far as that is sure before the program runs.
//!
//! `constants` says which targets, tools and workpieces are known, `facts` what the program as a whole may change of
//! what stands between a target and the robot, `walk` goes along each function and knows what holds where a motion is
//! planned (`state`), and `judge` asks the robot's kinematics.

mod constants;
mod facts;
mod judge;
mod state;
mod walk;

use crate::diagnostics::{Diagnostic, Label, Location, Problem};
use crate::hir::{ModuleId, Program};
use arl_lang::span::Span;
use arl_robot::Robot;

/// What is around a program and its robot.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Around {
    /// No other programs run beside it.
    pub(crate) alone: bool,
    /// The robot stands in the world's origin, as far as files say.
    pub(crate) in_origin: bool,
}

/// Warns of constant targets that end in an alarm: joint targets beyond the ranges of axes, poses out of reach, out of
/// the axes' ranges or out of the configuration asked for, lines that pass a singular point. Of those only that are
/// written where the motion stands, or given to something that nothing changes; of poses only where tool and workpiece
/// are known, too. All others are left to run time. Points of data files count with the values that they have now,
/// where the program runs alone: others might teach them.
pub(crate) fn check(
    program: &Program,
    robot: &Robot,
    around: Around,
    locate: &dyn Fn(ModuleId, Span) -> Location,
) -> Vec<Diagnostic> {
    let mut facts = facts::ProgramFacts::of(program);
    facts.teaches |= !around.alone;
    facts.plain_frames &= around.in_origin;
    let mut found = Vec::new();
    walk::each_function(program, robot, &facts, &mut |module, span, problem, also| {
        let mut diagnostic = problem.at(locate(module, span));
        let labels = also.into_iter().map(|(module, span, text)| Label { at: locate(module, span), text: text.into() });
        diagnostic.labels.extend(labels);
        found.push(diagnostic);
    });
    found
}
