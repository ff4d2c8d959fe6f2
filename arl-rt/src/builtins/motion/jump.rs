//! `jump`: the robot rises, moves across and sinks; before it sinks, the program can check a condition.

use super::modal::{GivenSpeed, Kind, Modal, Resolved};
use super::resolve;
use crate::context::cx::Cx;
use crate::fault::Fault;
use crate::motion::{Gate, GatePart, Lift, Target};
use crate::values::{Control, Pose, Speed, Tool, Wobj, is_set};

/// `jump`: up, over and down to a pose, with SCARA robots.
pub fn jump(p: impl Into<Pose>) -> Jump {
    let form = Form { rise: 25.0, sink: 25.0, height: 0.0, control: Control::default(), smooth: false };
    Jump { p: p.into(), modal: Modal::new(Kind::Axes), form }
}

/// `jump`, ready to run.
#[derive(Clone, Debug)]
#[must_use = "an instruction does nothing until it is run"]
pub struct Jump {
    p: Pose,
    modal: Modal,
    form: Form,
}

#[derive(Clone, Copy, Debug)]
struct Form {
    rise: f64,
    sink: f64,
    height: f64,
    control: Control,
    smooth: bool,
}

impl Jump {
    /// The speed; its set components go to `$DFSPEED`, which applies without it.
    pub fn v(mut self, speed: Speed) -> Self {
        self.modal.pace = Some(GivenSpeed::Speed(speed));
        self
    }

    /// The speed in % of the axes' speeds.
    pub fn vp(mut self, percent: f64) -> Self {
        self.modal.pace = Some(GivenSpeed::Percent(percent));
        self
    }

    /// The tool; it goes to `$DFTOOL`, which applies without it.
    pub fn t(mut self, tool: Tool) -> Self {
        self.modal.tool = Some(tool);
        self
    }

    /// The workpiece frame; it goes to `$DFWOBJ`, which applies without it.
    pub fn w(mut self, wobj: &Wobj) -> Self {
        self.modal.wobj = Some(wobj.clone());
        self
    }

    /// The distance of the vertical rise, in mm.
    pub fn a(mut self, rise: f64) -> Self {
        self.form.rise = rise;
        self
    }

    /// The distance of the vertical descent, in mm.
    pub fn b(mut self, sink: f64) -> Self {
        self.form.sink = sink;
        self
    }

    /// The height in the world that the TCP does not exceed, in mm; 0: the robot's own limit.
    pub fn z(mut self, height: f64) -> Self {
        self.form.height = height;
        self
    }

    /// Speeds and accelerations of rise and descent; components that are unset or 0 are as for the motion across.
    pub fn ctr(mut self, control: Control) -> Self {
        self.form.control = control;
        self
    }

    /// Whether the robot continues with the next motion without reaching the target.
    pub fn s(mut self, smooth: bool) -> Self {
        self.form.smooth = smooth;
        self
    }

    /// Plans the motion; waits only while the look-ahead is full.
    ///
    /// # Errors
    /// The motion cannot be planned; the message has the reason.
    pub async fn run(self, cx: &Cx) -> Result<(), Fault> {
        self.run_part(cx, GatePart::Whole).await
    }

    async fn run_part(self, cx: &Cx, part: GatePart) -> Result<(), Fault> {
        let (modal, target) = self.resolve(cx, part)?;
        resolve::plan(cx, &modal, target).await
    }

    /// Moves above the target, and waits until the robot is at rest there.
    ///
    /// # Errors
    /// The motion cannot be planned; the message has the reason.
    pub async fn above(self, cx: &Cx) -> Result<Above, Fault> {
        self.clone().run_part(cx, GatePart::Above).await?;
        cx.motion_end().await;
        Ok(Above { jump: self })
    }

    fn resolve(&self, cx: &Cx, part: GatePart) -> Result<(Resolved, Target), Fault> {
        let form = &self.form;
        for (name, distance) in [("a", form.rise), ("b", form.sink)] {
            if !distance.is_finite() || distance < 0.0 || is_unset(distance) {
                let problem = format!("{name} is {distance} mm, but must be 0 or more");
                return Err(Fault::Domain { function: "jump", problem: problem.into() });
            }
        }
        if !form.height.is_finite() {
            let problem = format!("Z is {} mm, but must be a number", form.height);
            return Err(Fault::Domain { function: "jump", problem: problem.into() });
        }
        let control = &form.control;
        let gate = Gate {
            rise: form.rise,
            sink: form.sink,
            highest: None,
            rising: lift(control.rising_vel, control.rising_acc, control.rising_dec)?,
            falling: lift(control.falling_vel, control.falling_acc, control.falling_dec)?,
            smooth: form.smooth,
            part,
        };
        let modal = self.modal.apply(cx)?;
        let (pose, wanted, external) = resolve::pose(cx, &self.p, &modal)?;
        let base = modal.setting.rig().base.translation.vector.z;
        let gate = Gate { highest: (form.height != 0.0 && is_set(form.height)).then_some(form.height - base), ..gate };
        Ok((modal.clone(), Target::Gate { pose, wobj: modal.setting.workpiece(), wanted, external, gate }))
    }
}

fn is_unset(value: f64) -> bool {
    !is_set(value)
}

/// The given percentages; the lower one of acceleration and deceleration applies to both.
fn lift(vel: f64, acc: f64, dec: f64) -> Result<Lift, Fault> {
    let given = |percent: f64| is_set(percent) && percent != 0.0;
    for percent in [vel, acc, dec].into_iter().filter(|percent| given(*percent)) {
        if !(percent > 0.0 && percent <= 100.0) {
            let problem = format!("a component of ctr is {percent} %, but must be 0 to 100 %");
            return Err(Fault::Domain { function: "jump", problem: problem.into() });
        }
    }
    let lowest = [acc, dec].into_iter().filter(|percent| given(*percent)).reduce(f64::min);
    Ok(Lift { vel: given(vel).then_some(vel), acc: lowest })
}

/// A `jump` whose robot is at rest above the target.
#[derive(Clone, Debug)]
#[must_use = "the robot stays above the target until it sinks"]
pub struct Above {
    jump: Jump,
}

impl Above {
    /// Moves down to the target.
    ///
    /// # Errors
    /// The motion cannot be planned; the message has the reason.
    pub async fn sink(self, cx: &Cx) -> Result<(), Fault> {
        self.jump.run_part(cx, GatePart::Rest).await
    }
}
