//! The form of a gate: how a motion rises, moves across and sinks.

/// The form of a gate.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Gate {
    /// The least distance by which it rises straight up, in mm, 0 or more.
    pub rise: f64,
    /// The least distance by which it sinks straight down, in mm, 0 or more.
    pub sink: f64,
    /// The highest permitted position of the TCP in the robot's base, in mm; `None`: the robot's own limit.
    pub highest: Option<f64>,
    /// How it rises.
    pub rising: Lift,
    /// How it sinks.
    pub falling: Lift,
    /// Whether it continues to the next motion without reaching its target.
    pub smooth: bool,
    /// Which part of it is executed.
    pub part: GatePart,
}

impl Gate {
    /// Whether it stops straight above its target.
    pub(crate) fn stays(&self) -> bool {
        self.part == GatePart::Above
    }
}

/// The executed part of a gate: all of it, or the motion to above its target, where it is looked at, or the rest.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum GatePart {
    /// From its start to its target.
    #[default]
    Whole,
    /// From its start to straight above its target, where it stops.
    Above,
    /// From there to its target: the rest of the gate before, which forms one motion with it in records.
    Rest,
}

/// Speed and acceleration of a gate's rising or sinking; `None` values are those of the motion across.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Lift {
    /// Percent of the axis's speed, above 0.
    pub vel: Option<f64>,
    /// Percent of the axis's acceleration and deceleration. Below 20 counts as 20, above 100 as 100.
    pub acc: Option<f64>,
}
