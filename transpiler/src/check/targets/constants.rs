//! The values of expressions that are known before the program runs: targets, frames, tools and workpieces made of
//! constants.

use super::super::convert::number;
use super::super::first_motion::{GlobalPoints, known_structure, known_value};
use super::state::MotionState;
use crate::hir::{Builtin, Expr, ExprKind, Func, Passed, Program, Root, Value};
use arl_lang::catalog::{PoseShift, Role, Struct, UNSET};
use arl_robot::frames::Mount;
use arl_robot::kinematics::{Frame, frame};

/// Where names are looked up.
#[derive(Clone, Copy)]
pub(super) struct ConstantScope<'a> {
    pub(super) program: &'a Program,
    pub(super) func: &'a Func,
    /// Which global variables count as known.
    pub(super) globals: GlobalPoints,
}

/// A target pose with all six components set.
pub(super) struct Pose {
    /// The target position of the TCP relative to the workpiece.
    pub(super) frame: Frame,
    /// `cfg`, if it is constant.
    pub(super) cfg: Option<i32>,
}

impl<'a> ConstantScope<'a> {
    /// The axes of a joint target that are set and constant, with their names, in the order of the components.
    pub(super) fn joints(self, target: &'a Expr) -> Option<Vec<(&'static str, f64)>> {
        let (Struct::Joint, values) = self.braces(target)? else { return None };
        let names = Struct::Joint.def(self.program.family).components.iter().map(|component| component.name);
        let set = |value: &Option<Expr>| value.as_ref().and_then(number).filter(|value| *value < UNSET);
        Some(names.zip(values).filter_map(|(name, value)| Some((name, set(value)?))).collect())
    }

    /// A target pose, made of constants or shifted from such a pose.
    pub(super) fn pose(self, target: &'a Expr) -> Option<Pose> {
        let target = known_value(self.program, self.func, self.globals, target)?;
        if let ExprKind::Builtin(function) = &target.kind {
            return self.moved(function);
        }
        let (Struct::Pose, values) = self.braces(target)? else { return None };
        let place = frame(self.components(Struct::Pose, values, None)?);
        let cfg = self.component(Struct::Pose, values, "cfg").map_or(Some(0), |cfg| number(cfg).map(|cfg| cfg as i32));
        Some(Pose { frame: place, cfg })
    }

    /// The result of applying `offset` or `reltool` to a pose.
    fn moved(self, function: &'a Builtin) -> Option<Pose> {
        let shift = function.entry.shift?;
        let pose = self.pose(argument(function, "p")?)?;
        let mut by = [0.0; 6];
        for (place, name) in by.iter_mut().zip(["dx", "dy", "dz", "rz", "ry", "rx"]) {
            *place = argument(function, name).and_then(number).filter(|by| by.is_finite())?;
        }
        let by = frame(by);
        let frame = match shift {
            PoseShift::Tool => pose.frame * by,
            PoseShift::Workpiece => {
                let place = pose.frame.translation.vector + by.translation.vector;
                Frame::from_parts(place.into(), by.rotation * pose.frame.rotation)
            }
        };
        Some(Pose { frame, ..pose })
    }

    /// A tool or a workpiece; `$DFTOOL` and `$DFWOBJ` have the values in `state`.
    pub(super) fn mount(self, value: &'a Expr, state: &MotionState) -> Option<Mount> {
        if let ExprKind::Place(place) = &value.kind
            && let Root::System(variable) = place.root
        {
            return match variable.role {
                Some(Role::Flange) => Some(super::state::flange()),
                Some(Role::World) => Some(super::state::world()),
                Some(Role::DefaultTool) if place.path.is_empty() => state.tool,
                Some(Role::DefaultWorkpiece) if place.path.is_empty() => state.wobj,
                _ => None,
            };
        }
        let (id, values) = self.braces(value)?;
        let [place, turned, carrier @ ..] = values else { return empty(id, values) };
        let frame = place.as_ref().map_or(Some(Frame::identity()), |place| self.frame(place))?;
        let flag = turned.as_ref().map_or(Some(false), flag)?;
        let alone = carrier.iter().flatten().all(is_empty_text);
        match id {
            Struct::Tool => Some(Mount { frame, on_flange: !flag }),
            Struct::Wobj if alone => Some(Mount { frame, on_flange: flag }),
            _ => None,
        }
    }

    fn frame(self, value: &'a Expr) -> Option<Frame> {
        let (Struct::Frame, values) = self.braces(value)? else { return None };
        self.components(Struct::Frame, values, Some(0.0)).map(frame)
    }

    fn braces(self, value: &'a Expr) -> Option<(Struct, &'a [Option<Expr>])> {
        known_structure(self.program, self.func, self.globals, value)
    }

    /// x, y, z, a, b, c; components left out have the value `start`.
    fn components(self, id: Struct, values: &[Option<Expr>], start: Option<f64>) -> Option<[f64; 6]> {
        let mut found = [0.0; 6];
        for (place, name) in found.iter_mut().zip(["x", "y", "z", "a", "b", "c"]) {
            let given = self.component(id, values, name).map_or(start, number)?;
            *place = Some(given).filter(|value| value.abs() < UNSET)?;
        }
        Some(found)
    }

    fn component<'v>(self, id: Struct, values: &'v [Option<Expr>], name: &str) -> Option<&'v Expr> {
        let at = id.def(self.program.family).components.iter().position(|component| component.name == name)?;
        values.get(at)?.as_ref()
    }
}

/// `{}`: a structure of default values.
fn empty(id: Struct, values: &[Option<Expr>]) -> Option<Mount> {
    match id {
        _ if !values.is_empty() => None,
        Struct::Tool => Some(super::state::flange()),
        Struct::Wobj => Some(super::state::world()),
        _ => None,
    }
}

fn is_empty_text(value: &Expr) -> bool {
    matches!(&value.kind, ExprKind::Const(Value::String(text)) if text.is_empty())
}

fn flag(value: &Expr) -> Option<bool> {
    match &value.kind {
        ExprKind::Const(Value::Bool(flag)) => Some(*flag),
        _ => None,
    }
}

/// The value given for a parameter.
pub(super) fn argument<'a>(builtin: &'a Builtin, name: &str) -> Option<&'a Expr> {
    let wanted = builtin.entry.params.iter().position(|param| param.name.eq_ignore_ascii_case(name))?;
    builtin.args.iter().find(|bound| bound.param == wanted).and_then(|bound| match &bound.value {
        Passed::Value(value) => Some(value),
        Passed::Out(_) => None,
    })
}
