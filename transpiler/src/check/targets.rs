//! Targets that a certain robot can never reach, as far as that is sure before the program runs.

use super::first_motion::known_structure;
use crate::diagnostics::flow::FlowProblem;
use crate::diagnostics::{Diagnostic, Location, Problem};
use crate::hir::{Expr, ExprKind, ModuleId, Passed, Place, Program, Root, Value};
use crate::visit;
use crate::{Arm, RobotLimits};
use arl_lang::catalog::{Base, Effect, Struct};
use arl_lang::span::Span;

/// An axis this little beyond its range, deg (mm), is brought into it when the program runs.
const SLACK: f64 = 1e-6;

/// Components from here on were not set.
const UNSET: f64 = 9e9;

/// What stands between a pose and the flange, or makes parts of the pose count no more. A program that writes one of these is
/// not looked at for poses.
const FRAMES: [&str; 7] = ["DFTOOL", "DFWOBJ", "BASE", "TOOL_OFFSET", "WOBJ_OFFSET", "IGNORE_ORI", "WRIST"];

/// The motions that go to their first argument with all its components; of a circle the orientation on the way is not known,
/// and where it ends may be given by an angle.
const TO_A_POSE: [&str; 2] = ["ptp", "lin"];

/// Warns of joint targets beyond the axes' ranges and of poses beyond the length of the arm: of those that are written where
/// the motion stands, or given to something that nothing changes; of poses only where the program never has another tool
/// than the flange and another workpiece than the world. All others are left to run time.
pub(crate) fn check(
    program: &Program,
    robot: &RobotLimits,
    locate: &dyn Fn(ModuleId, Span) -> Location,
) -> Vec<Diagnostic> {
    let arm = robot.arm.filter(|_| has_plain_frames(program));
    let mut found = Vec::new();
    for func in &program.funcs {
        for stmt in &func.body {
            visit::exprs_in_stmt(stmt, &mut |expr| {
                let ExprKind::Builtin(motion) = &expr.kind else { return };
                if motion.entry.effect != Effect::Plans {
                    return;
                }
                let target = motion.args.iter().find(|bound| bound.param == 0).map(|bound| &bound.value);
                let Some(Passed::Value(target)) = target else { return };
                let Some((id, values)) = known_structure(program, func, target) else { return };
                let problem = match (id, arm) {
                    (Struct::Joint, _) => beyond_range(program, values, robot),
                    (Struct::Pose, Some(arm)) if TO_A_POSE.contains(&motion.entry.name) => {
                        out_of_reach(program, values, arm, robot)
                    }
                    _ => None,
                };
                found.extend(problem.map(|problem| problem.at(locate(func.module, target.span))));
            });
        }
    }
    found
}

/// Whether all poses of the program are those of the flange in the world, as far as the program has a say.
fn has_plain_frames(program: &Program) -> bool {
    let mut plain = true;
    let mut see = |expr: &Expr| {
        let written = |place: &Place| matches!(place.root, Root::System(it) if FRAMES.iter().any(|name| it.name.eq_ignore_ascii_case(name)));
        plain &= match &expr.kind {
            ExprKind::Assign(both) => !written(&both.0),
            ExprKind::AssignOp(_, both) => !written(&both.0),
            ExprKind::Builtin(builtin) => {
                builtin.args.iter().all(|bound| match &bound.value {
                    Passed::Out(place) => !written(place),
                    Passed::Value(value) => {
                        builtin.entry.effect != Effect::Plans || !is_frame(value) || is_plain(value)
                    }
                }) && builtin.entry.name != "getbase_3p"
            }
            _ => true,
        };
    };
    for func in &program.funcs {
        func.body.iter().for_each(|stmt| visit::exprs_in_stmt(stmt, &mut see));
    }
    program.globals.iter().filter_map(|global| global.init.as_ref()).for_each(|init| visit::exprs(init, &mut see));
    plain
}

fn is_frame(value: &Expr) -> bool {
    matches!(value.ty.base, Base::Struct(Struct::Tool | Struct::Wobj))
}

/// `$FLANGE` or `$WORLD`.
fn is_plain(value: &Expr) -> bool {
    let ExprKind::Place(place) = &value.kind else { return false };
    matches!(place.root, Root::System(it) if ["FLANGE", "WORLD"].iter().any(|name| it.name.eq_ignore_ascii_case(name)))
}

/// A pose farther away than the arm is long.
fn out_of_reach(program: &Program, values: &[Option<Expr>], arm: Arm, robot: &RobotLimits) -> Option<FlowProblem> {
    let components = &Struct::Pose.def(program.family).components;
    let mut pose = [0.0; 6];
    for (place, name) in pose.iter_mut().zip(["x", "y", "z", "a", "b", "c"]) {
        let at = components.iter().position(|component| component.name == name)?;
        *place = number(values.get(at)?.as_ref()?).filter(|value| value.abs() < UNSET)?;
    }
    let by = arm.beyond(pose);
    (by > SLACK).then(|| FlowProblem::OutOfReach { by, robot: robot.name.clone() })
}

/// The first axis of a joint target that is beyond its range.
fn beyond_range(program: &Program, values: &[Option<Expr>], robot: &RobotLimits) -> Option<FlowProblem> {
    let components = &Struct::Joint.def(program.family).components;
    components.iter().zip(values).find_map(|(component, value)| {
        let value = number(value.as_ref()?).filter(|value| *value < UNSET)?;
        let axis = robot.axes.iter().find(|axis| axis.name.eq_ignore_ascii_case(component.name))?;
        let inside = (axis.min - SLACK..=axis.max + SLACK).contains(&value);
        (!inside).then(|| FlowProblem::BeyondRange { value, axis: axis.clone(), robot: robot.name.clone() })
    })
}

fn number(expr: &Expr) -> Option<f64> {
    match &expr.kind {
        ExprKind::Const(Value::Double(value)) => Some(*value),
        ExprKind::Const(Value::Int(value)) => Some(f64::from(*value)),
        ExprKind::Const(Value::Uint(value)) => Some(f64::from(*value)),
        ExprKind::Const(Value::Byte(value)) => Some(f64::from(*value)),
        ExprKind::Convert(inner) => number(inner),
        _ => None,
    }
}
