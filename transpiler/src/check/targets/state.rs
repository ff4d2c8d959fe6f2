//! What is known of tool, workpiece and robot at a place of a program, and what statements may change of it.

use arl_lang::span::Span;
use arl_robot::frames::Mount;
use arl_robot::kinematics::{Axes, Frame};

/// `$FLANGE`, with which a program starts.
pub(super) fn flange() -> Mount {
    Mount { frame: Frame::identity(), on_flange: true }
}

/// `$WORLD`, in which a program starts.
pub(super) fn world() -> Mount {
    Mount { frame: Frame::identity(), on_flange: false }
}

/// What is known when a motion is planned; `None` is not known.
#[derive(Clone, Debug)]
pub(super) struct MotionState {
    /// `$DFTOOL`
    pub(super) tool: Option<Mount>,
    /// `$DFWOBJ`
    pub(super) wobj: Option<Mount>,
    /// The argument of an earlier motion, or the assignment, that `$DFTOOL` is from.
    pub(super) tool_from: Option<Span>,
    /// The same of `$DFWOBJ`.
    pub(super) wobj_from: Option<Span>,
    /// The robot's configuration.
    pub(super) cfg: Option<u8>,
    /// Where its axes stand, up to whole turns.
    pub(super) axes: Option<Axes>,
    /// Control never comes here.
    pub(super) dead: bool,
}

impl MotionState {
    pub(super) const UNKNOWN: MotionState =
        MotionState { tool: None, wobj: None, tool_from: None, wobj_from: None, cfg: None, axes: None, dead: false };

    /// What holds where control comes from here or from there.
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

    /// What still holds when `changes` may have happened, none, some or all of them.
    pub(super) fn may(&mut self, changes: &Changes) {
        self.tool = self.tool.filter(|tool| changes.tool.leaves(tool));
        self.wobj = self.wobj.filter(|wobj| changes.wobj.leaves(wobj));
        if changes.moves {
            (self.cfg, self.axes) = (None, None);
        }
    }
}

/// What a variable may become.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub(super) enum Change {
    /// Nothing writes it.
    #[default]
    Never,
    /// This is all that it may become.
    To(Mount),
    /// Several values, or one that is not known.
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

    /// The one value that a variable can have that begins as `start`.
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
