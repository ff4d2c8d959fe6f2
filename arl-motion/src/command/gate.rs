//! The form of a gate: how a motion rises, goes over and sinks.

/// The form of a gate.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Gate {
    /// How far it rises straight up at least, in mm, 0 or more.
    pub rise: f64,
    /// How far it sinks straight down at least, in mm, 0 or more.
    pub sink: f64,
    /// The height of the TCP in the robot's base that it does not pass, in mm; `None`: the robot's own limit.
    pub highest: Option<f64>,
    /// How it rises.
    pub rising: Lift,
    /// How it sinks.
    pub falling: Lift,
    /// Whether it goes on to the next motion without reaching its target.
    pub smooth: bool,
    /// How much of it is done.
    pub part: GatePart,
}

impl Gate {
    /// Whether it stops straight above its target.
    pub(crate) fn stays(&self) -> bool {
        self.part == GatePart::Above
    }
}

/// How much of a gate is done: all of it, or the way to where its target is looked at from above, and the rest.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum GatePart {
    /// From its start to its target.
    #[default]
    Whole,
    /// From its start to straight above its target, where it stops.
    Above,
    /// From there to its target: the rest of the gate before, with which it is one motion in records.
    Rest,
}

/// How fast a gate rises or sinks; what is `None` is as on the way over.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Lift {
    /// Percent of the axis's speed, above 0.
    pub vel: Option<f64>,
    /// Percent of the axis's acceleration and deceleration. Below 20 counts as 20, above 100 as 100.
    pub acc: Option<f64>,
}
