//! `startcompen`, `compen` and `endcompen`: shift and turn the lines, circles and splines between them.

use crate::context::cx::Cx;
use crate::fault::Fault;
use crate::motion::{Reference, is_unset};
use crate::values::{CompenType, Compendata, Str};

/// The largest total turn about each axis of a frame, in deg.
const MAX_TURN_DEG: f64 = 90.0;

/// `startcompen`: begins to compensate the motions that follow.
pub fn startcompen(data: Compendata) -> StartCompen {
    StartCompen { data }
}

/// `startcompen`, ready to run.
#[derive(Clone, Copy, Debug)]
#[must_use = "an instruction does nothing until it is run"]
pub struct StartCompen {
    data: Compendata,
}

impl StartCompen {
    /// Applies from the next motion on. Within a compensation it only changes the limits.
    ///
    /// # Errors
    /// A limit is not above 0.
    pub fn run(self, cx: &Cx) -> Result<(), Fault> {
        let data = &self.data;
        let limits = [
            ("tcp_max_vel", data.tcp_max_vel),
            ("tcp_max_acc", data.tcp_max_acc),
            ("tcp_max_jerk", data.tcp_max_jerk),
            ("ori_max_vel", data.ori_max_vel),
            ("ori_max_acc", data.ori_max_acc),
            ("ori_max_jerk", data.ori_max_jerk),
        ];
        for (name, value) in limits {
            if !(value > 0.0 && value.is_finite()) {
                return Err(domain("startcompen", format!("{name} is {value}, but must be above 0")));
            }
        }
        let limits = limits.map(|(_, value)| value);
        let mut unit = cx.channel_state().unit_mut("startcompen")?;
        match &mut unit.settings.compensation {
            Some(compensation) => compensation.limits = limits,
            None => unit.start_compensation(limits),
        }
        Ok(())
    }
}

/// The frame of a compensation: a constant, or its name.
#[derive(Clone, Debug)]
pub enum CompenFrame {
    /// A constant.
    Constant(CompenType),
    /// The name of the frame, in upper or lower case.
    Name(Str),
}

impl From<CompenType> for CompenFrame {
    fn from(constant: CompenType) -> Self {
        CompenFrame::Constant(constant)
    }
}

impl From<&Str> for CompenFrame {
    fn from(name: &Str) -> Self {
        CompenFrame::Name(name.clone())
    }
}

impl CompenFrame {
    fn reference(&self) -> Result<Reference, Fault> {
        const NAMES: [(&str, Reference); 5] = [
            ("TOOL", Reference::Tool),
            ("WOBJ", Reference::Wobj),
            ("TOOL_PATH", Reference::ToolPath),
            ("MODIFY_PATH", Reference::ModifyPath),
            ("WORLD", Reference::World),
        ];
        match self {
            CompenFrame::Constant(constant) => Ok(match constant {
                CompenType::Tool => Reference::Tool,
                CompenType::Wobj => Reference::Wobj,
                CompenType::ToolPath => Reference::ToolPath,
                CompenType::ModifyPath => Reference::ModifyPath,
                CompenType::World => Reference::World,
            }),
            CompenFrame::Name(name) => {
                let found = NAMES.iter().find(|(known, _)| name.as_bytes().eq_ignore_ascii_case(known.as_bytes()));
                found.map(|(_, reference)| *reference).ok_or_else(|| {
                    let names = NAMES.map(|(known, _)| known).join(", ");
                    domain("compen", format!("type is \"{name}\", but must be one of {names}"))
                })
            }
        }
    }
}

/// `compen`: adds to the shift and turn of the motions that follow, along and about the axes of a frame.
pub fn compen(frame: impl Into<CompenFrame>) -> Compen {
    Compen { frame: frame.into(), by: [0.0; 6] }
}

/// `compen`, ready to run.
#[derive(Clone, Debug)]
#[must_use = "an instruction does nothing until it is run"]
pub struct Compen {
    frame: CompenFrame,
    by: [f64; 6],
}

/// Declares the labels, each with its index in `by`.
macro_rules! labels {
    ($($(#[doc = $doc:literal])+ $label:ident $place:literal)+) => {
        $(
            $(#[doc = $doc])+
            pub fn $label(mut self, value: f64) -> Self {
                if let Some(place) = self.by.get_mut($place) {
                    *place = value;
                }
                self
            }
        )+
    };
}

impl Compen {
    labels! {
        /// The shift along x, in mm.
        x 0
        /// The shift along y, in mm.
        y 1
        /// The shift along z, in mm.
        z 2
        /// The turn about z, in deg.
        a 3
        /// The turn about y, in deg.
        b 4
        /// The turn about x, in deg.
        c 5
    }

    /// Applies from the next motion on.
    ///
    /// # Errors
    /// No compensation has been started, the frame is unknown, a value is not a number, or the total turn would be more
    /// than 90 deg.
    pub fn run(self, cx: &Cx) -> Result<(), Fault> {
        let reference = self.frame.reference()?;
        if let Some(value) = self.by.iter().find(|value| !value.is_finite() || is_unset(value.abs())) {
            return Err(domain("compen", format!("{value} is not a number to compensate by")));
        }
        let mut unit = cx.channel_state().unit_mut("compen")?;
        let Some(compensation) = &mut unit.settings.compensation else {
            return Err(domain("compen", "no compensation has been started: startcompen begins one".to_owned()));
        };
        let mut changed = *compensation;
        changed.add(reference, &self.by);
        let [_, _, _, turned @ ..] = changed.total(reference);
        if let Some(angle) = turned.iter().find(|angle| angle.abs() > MAX_TURN_DEG) {
            let problem =
                format!("the path would be turned by {angle} deg in all, but at most {MAX_TURN_DEG} deg is allowed");
            return Err(domain("compen", problem));
        }
        *compensation = changed;
        Ok(())
    }
}

/// `endcompen`: ends the compensation.
pub fn endcompen() -> EndCompen {
    EndCompen
}

/// `endcompen`, ready to run.
#[derive(Clone, Copy, Debug)]
#[must_use = "an instruction does nothing until it is run"]
pub struct EndCompen;

impl EndCompen {
    /// Applies from the next motion on, which starts where the compensated one ends.
    ///
    /// # Errors
    /// There is no compensation to end.
    pub fn run(self, cx: &Cx) -> Result<(), Fault> {
        let ended = cx.channel_state().unit_mut("endcompen")?.settings.compensation.take();
        let none = || domain("endcompen", "there is no compensation to end: startcompen begins one".to_owned());
        ended.map(|_| ()).ok_or_else(none)
    }
}

fn domain(function: &'static str, problem: String) -> Fault {
    Fault::Domain { function, problem: problem.into() }
}
