//! The handling of late cycles: part of `[controller]` of a cell file.

use crate::settings::{Section, SettingsError};

/// The start times of cycles after one that is late by a whole cycle or more, because the previous cycle took too long
/// or the computer was busy. Cycles whose start times have passed are lost and not made up for: nothing runs faster
/// than it should, and controller time lags behind real time.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
#[non_exhaustive]
pub enum Late {
    /// The start times stay on their grid: for drives that have a clock of their own.
    #[default]
    HoldGrid,
    /// The grid begins again at the start of the late cycle.
    Skip,
}

/// The settings for late cycles.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub struct LateCycles {
    /// The handling of late cycles; `None` for the default of the clock.
    pub late: Option<Late>,
    /// The number of cycles that may be lost within a second before the robots are stopped; `None`: 20 for a driven
    /// robot, any number for a simulated one.
    pub limit: Option<u32>,
}

/// The largest limit.
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
