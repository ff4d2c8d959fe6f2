//! Targets that a given robot can never reach, as far as that is certain before the program runs.
//!
//! `constants` determines which targets, tools and workpieces are known, `facts` what the program as a whole may change
//! between a target and the robot. `walk` goes through each function and tracks what is known where a motion is planned
//! (`state`), and `judge` uses the robot's kinematics.

mod constants;
mod facts;
mod judge;
mod state;
mod walk;

use crate::diagnostics::{Diagnostic, Label, Location, Problem};
use crate::hir::{ModuleId, Program};
use arl_lang::span::Span;
use arl_robot::Robot;

/// The environment of a program and its robot.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Around {
    /// No other programs run in parallel.
    pub(crate) alone: bool,
    /// The robot stands in the origin of the world frame, as far as files show.
    pub(crate) in_origin: bool,
}

/// Warns about constant targets that end in an alarm: joint targets out of the axis ranges; poses out of reach, out of
/// the axis ranges or out of the requested configuration; lines that pass a singular point. Considers only targets that
/// are written in the motion or assigned to a variable that is never changed, and poses only if tool and workpiece are
/// known, too. All others are left to run time. Points of data files count with their present values, provided that the
/// program runs alone: other programs might teach them.
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
