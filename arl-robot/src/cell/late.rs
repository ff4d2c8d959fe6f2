//! What becomes of cycles that are late: part of `[controller]` of a cell file.

use crate::settings::{Section, SettingsError};

/// What becomes of the points of time at which cycles begin where one is a whole cycle late, or more, since the one
/// before took too long or the computer did something else. Cycles whose points have passed are lost and not made up
/// for: nothing comes faster than it should, and the time of the controller lags behind that of the world.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
#[non_exhaustive]
pub enum Late {
    /// They stay a grid: for drives that have a clock of their own.
    #[default]
    HoldGrid,
    /// The grid begins anew where the late cycle begins.
    Skip,
}

/// What is said of late cycles.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub struct LateCycles {
    /// What becomes of them; `None`: what the clock does by itself.
    pub late: Option<Late>,
    /// How many cycles may be lost within a second, before the robots are stopped; `None`: 20 where a robot is driven,
    /// any number where it is simulated.
    pub limit: Option<u32>,
}

/// No limit is larger.
const MOST: f64 = 1e6;

impl LateCycles {
    pub(super) fn read(controller: &Section<'_>) -> Result<Self, SettingsError> {
        let late = controller.word("late", &[("grid", Late::HoldGrid), ("skip", Late::Skip)])?;
        let what = "how many cycles may be lost within a second";
        let limit = controller.number("late_limit", what, 0.0, MOST)?;
        if let (Some(limit), Some(found)) = (limit, controller.find("late_limit"))
            && limit.fract() != 0.0
        {
            return Err(controller.wrong("late_limit", found, &format!("a whole number: {what}")));
        }
        Ok(Self { late, limit: limit.map(|limit| limit as u32) })
    }
}
