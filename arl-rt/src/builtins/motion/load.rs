//! The load on the flange, and collision detection.

use crate::builtins::frames::is_open;
use crate::context::cx::Cx;
use crate::fault::Fault;
use crate::unit::dynamics::Load;
use crate::values::{Str, ToolInertiaPara};

/// The name of the only mechanical unit.
const UNIT: &str = "R1";

/// `toolload`: sets the load on the flange for the motions that follow.
pub fn toolload(toolinertia: ToolInertiaPara) -> ToolLoad {
    ToolLoad { toolinertia }
}

/// `toolload`, ready to run.
#[derive(Clone, Copy, Debug)]
#[must_use = "an instruction does nothing until it is run"]
pub struct ToolLoad {
    toolinertia: ToolInertiaPara,
}

impl ToolLoad {
    /// Applies from the next motion on, until another load is set or the program is reset.
    ///
    /// # Errors
    /// The mass or a moment of inertia is below 0, or a component is not a number.
    pub fn run(self, cx: &Cx) -> Result<(), Fault> {
        carry(cx, "toolload", &self.toolinertia)
    }
}

/// `toolswitch`: takes the load `$TOOL_INERTIA[toolindex]` for the motions that follow.
pub fn toolswitch(toolindex: i32) -> ToolSwitch {
    ToolSwitch { toolindex, mu: None }
}

/// `toolswitch`, ready to run.
#[derive(Clone, Debug)]
#[must_use = "an instruction does nothing until it is run"]
pub struct ToolSwitch {
    toolindex: i32,
    mu: Option<Str>,
}

impl ToolSwitch {
    /// The mechanical unit; by default the channel's own.
    pub fn mu(mut self, name: &Str) -> Self {
        self.mu = Some(name.clone());
        self
    }

    /// Applies from the next motion on, until another load is set or the program is reset.
    ///
    /// # Errors
    /// The element or the unit does not exist, the mass or a moment of inertia is below 0, or a component is not a
    /// number.
    pub fn run(self, cx: &Cx) -> Result<(), Fault> {
        unit("toolswitch", self.mu.as_ref())?;
        let load = cx.system().tool_inertia.with(|loads| {
            let size = loads.len() as u32;
            let found = usize::try_from(self.toolindex).ok().and_then(|index| loads.get(index).copied());
            found.ok_or(Fault::Index { index: self.toolindex, size })
        })?;
        carry(cx, "toolswitch", &load)
    }
}

fn carry(cx: &Cx, function: &'static str, load: &ToolInertiaPara) -> Result<(), Fault> {
    let (centre, inertia) = (&load.centroidpos, &load.inertiatensor);
    let not_negative = [("mass", load.m), ("Ixx", inertia.ixx), ("Iyy", inertia.iyy), ("Izz", inertia.izz)];
    let any = [
        ("x of the centre of mass", centre.x),
        ("y of the centre of mass", centre.y),
        ("z of the centre of mass", centre.z),
        ("Ixy", inertia.ixy),
        ("Ixz", inertia.ixz),
        ("Iyz", inertia.iyz),
    ];
    let refused = |what: &str, value: f64, wanted: &str| {
        let problem = format!("the load's {what} is {value}, but must be {wanted}");
        Err(Fault::Domain { function, problem: problem.into() })
    };
    for (what, value) in not_negative {
        if is_open(value) || value < 0.0 {
            return refused(what, value, "0 or more");
        }
    }
    for (what, value) in any {
        if is_open(value) {
            return refused(what, value, "a number");
        }
    }
    cx.channel_state().unit_mut(function)?.set_load(Load::from(load));
    Ok(())
}

/// `startdetect`: detects collisions during the motions that follow, with a condition of the cell file.
pub fn startdetect(cid: i32) -> StartDetect {
    StartDetect { cid, mu: None }
}

/// `startdetect`, ready to run.
#[derive(Clone, Debug)]
#[must_use = "an instruction does nothing until it is run"]
pub struct StartDetect {
    cid: i32,
    mu: Option<Str>,
}

impl StartDetect {
    /// The mechanical unit; by default the channel's own.
    pub fn mu(mut self, name: &Str) -> Self {
        self.mu = Some(name.clone());
        self
    }

    /// Applies from the next motion on, until `enddetect` or until the program is reset.
    ///
    /// # Errors
    /// The condition is not within 0 to 16, the unit does not exist, or the robot file has no masses.
    pub fn run(self, cx: &Cx) -> Result<(), Fault> {
        const FUNCTION: &str = "startdetect";
        unit(FUNCTION, self.mu.as_ref())?;
        let Some(cid) = u8::try_from(self.cid).ok().filter(|cid| *cid <= 16) else {
            let problem = format!("cid is {}, but must be 0 to 16", self.cid);
            return Err(Fault::Domain { function: FUNCTION, problem: problem.into() });
        };
        let channel_state = cx.channel_state();
        let sensitivity = channel_state.sensitivity(cid);
        let mut unit = channel_state.unit_mut(FUNCTION)?;
        if unit.detect(Some(&sensitivity)) {
            return Ok(());
        }
        Err(Fault::NoMasses { function: FUNCTION, robot: unit.robot().name.as_str().into() })
    }
}

/// `enddetect`: ends collision detection for the motions that follow.
pub fn enddetect() -> EndDetect {
    EndDetect { mu: None }
}

/// `enddetect`, ready to run.
#[derive(Clone, Debug)]
#[must_use = "an instruction does nothing until it is run"]
pub struct EndDetect {
    mu: Option<Str>,
}

impl EndDetect {
    /// The mechanical unit; by default the channel's own.
    pub fn mu(mut self, name: &Str) -> Self {
        self.mu = Some(name.clone());
        self
    }

    /// Applies from the next motion on.
    ///
    /// # Errors
    /// The unit does not exist.
    pub fn run(self, cx: &Cx) -> Result<(), Fault> {
        unit("enddetect", self.mu.as_ref())?;
        cx.channel_state().unit_mut("enddetect")?.detect(None);
        Ok(())
    }
}

/// Checks that the mechanical unit exists.
fn unit(function: &'static str, mu: Option<&Str>) -> Result<(), Fault> {
    match mu.map(Str::to_text) {
        Some(name) if !name.eq_ignore_ascii_case(UNIT) => {
            let problem = format!("there is no mechanical unit \"{name}\", only \"{UNIT}\"");
            Err(Fault::Domain { function, problem: problem.into() })
        }
        _ => Ok(()),
    }
}
