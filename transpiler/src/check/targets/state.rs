//! What is known about tool, workpiece and robot at a point of a program, and what statements may change about it.

use arl_lang::span::Span;
use arl_robot::frames::Mount;
use arl_robot::kinematics::{Axes, Frame};

/// `$FLANGE`, the tool at the start of a program.
pub(super) fn flange() -> Mount {
    Mount { frame: Frame::identity(), on_flange: true }
}

/// `$WORLD`, the workpiece frame at the start of a program.
pub(super) fn world() -> Mount {
    Mount { frame: Frame::identity(), on_flange: false }
}

/// What is known when a motion is planned; `None` means unknown.
#[derive(Clone, Debug)]
pub(super) struct MotionState {
    /// `$DFTOOL`
    pub(super) tool: Option<Mount>,
    /// `$DFWOBJ`
    pub(super) wobj: Option<Mount>,
    /// The argument of an earlier motion, or the assignment, that set `$DFTOOL`.
    pub(super) tool_from: Option<Span>,
    /// The argument of an earlier motion, or the assignment, that set `$DFWOBJ`.
    pub(super) wobj_from: Option<Span>,
    /// The robot's configuration.
    pub(super) cfg: Option<u8>,
    /// The positions of its axes, up to whole turns.
    pub(super) axes: Option<Axes>,
    /// Control never reaches this point.
    pub(super) dead: bool,
}

impl MotionState {
    pub(super) const UNKNOWN: MotionState =
        MotionState { tool: None, wobj: None, tool_from: None, wobj_from: None, cfg: None, axes: None, dead: false };

    /// What is known at a point that control reaches from either of two places.
    pub(super) fn or(self, other: MotionState) -> MotionState {
        if self.dead {
            return other;
        }
        if other.dead {
            return self;
        }
        MotionState {
            tool: self.tool.filter(|tool| other.tool == Some(*tool)),
            wobj: self.wobj.filter(|wobj| other.wobj == Some(*wobj)),
            tool_from: self.tool_from.filter(|from| other.tool_from == Some(*from)),
            wobj_from: self.wobj_from.filter(|from| other.wobj_from == Some(*from)),
            cfg: self.cfg.filter(|cfg| other.cfg == Some(*cfg)),
            axes: self.axes.filter(|axes| other.axes == Some(*axes)),
            dead: false,
        }
    }

    /// Keeps what still holds after none, some or all of `changes` have happened.
    pub(super) fn may(&mut self, changes: &Changes) {
        self.tool = self.tool.filter(|tool| changes.tool.leaves(tool));
        self.wobj = self.wobj.filter(|wobj| changes.wobj.leaves(wobj));
        if changes.moves {
            (self.cfg, self.axes) = (None, None);
        }
    }
}

/// The possible new values of a variable.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub(super) enum Change {
    /// Nothing writes it.
    #[default]
    Never,
    /// The only value that it may get.
    To(Mount),
    /// Several values, or an unknown one.
    Other,
}

impl Change {
    pub(super) fn and(&mut self, other: Change) {
        *self = match (*self, other) {
            (Change::Never, change) | (change, Change::Never) => change,
            (Change::To(one), Change::To(two)) if one == two => other,
            _ => Change::Other,
        };
    }

    /// The only value that a variable with the initial value `start` can have.
    pub(super) fn only(self, start: Mount) -> Option<Mount> {
        Some(start).filter(|start| self.leaves(start))
    }

    fn leaves(self, value: &Mount) -> bool {
        match self {
            Change::Never => true,
            Change::To(new) => new == *value,
            Change::Other => false,
        }
    }
}

impl From<Option<Mount>> for Change {
    fn from(value: Option<Mount>) -> Self {
        value.map_or(Change::Other, Change::To)
    }
}

/// What statements may change.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub(super) struct Changes {
    pub(super) tool: Change,
    pub(super) wobj: Change,
    pub(super) moves: bool,
}

impl Changes {
    pub(super) fn and(&mut self, other: &Changes) {
        self.tool.and(other.tool);
        self.wobj.and(other.wobj);
        self.moves |= other.moves;
    }
}
