//! The motion instructions: they turn what a program sets, and the defaults for what it leaves out, into a command for
//! the planner.

mod compensation;
mod jump;
mod load;
mod modal;
mod resolve;
mod weave;

use crate::context::cx::Cx;
use crate::fault::Fault;
use crate::motion::Target;
use crate::values::{Joint, Pose, Slip, Speed, Tool, Wobj};
use modal::{Blend, GivenSpeed, Kind, Modal};

pub use compensation::{Compen, CompenFrame, EndCompen, StartCompen, compen, endcompen, startcompen};
pub use jump::{Above, Jump, jump};
pub use load::{EndDetect, StartDetect, ToolLoad, ToolSwitch, enddetect, startdetect, toolload, toolswitch};
pub(crate) use resolve::wanted;
pub use weave::{EndWeave, StartWeave, endweave, startweave};

/// Declares an instruction's builder: its target and its optional labels.
macro_rules! instruction {
    (
        $(#[doc = $doc:literal])+
        $name:ident $builder:ident ($($target:ident: $ty:ty),+) $kind:ident { $($label:ident)* }
        -> |$self:ident, $modal:ident, $cx:ident| $resolve:expr
    ) => {
        $(#[doc = $doc])+
        pub fn $name($($target: impl Into<$ty>),+) -> $builder {
            $builder { $($target: $target.into(),)+ modal: Modal::new(Kind::$kind) }
        }

        #[doc = concat!("`", stringify!($name), "`, ready to run.")]
        #[derive(Clone, Debug)]
        #[must_use = "an instruction does nothing until it is run"]
        pub struct $builder {
            $($target: $ty,)+
            modal: Modal,
        }

        impl $builder {
            $( instruction!(@label $label); )*

            /// Plans the motion; waits only while the look-ahead is full.
            ///
            /// # Errors
            /// The motion cannot be planned; the message has the reason.
            pub async fn run(self, cx: &Cx) -> Result<(), Fault> {
                let $self = self;
                let $cx = cx;
                let $modal = $self.modal.apply(cx)?;
                resolve::plan(cx, &$modal, $resolve?).await
            }
        }
    };
    (@label v) => {
        /// The speed; its set components go to `$DFSPEED`, which applies without it.
        pub fn v(mut self, speed: Speed) -> Self {
            self.modal.pace = Some(GivenSpeed::Speed(speed));
            self
        }
    };
    (@label vp) => {
        /// The speed in % of the robot's speed.
        pub fn vp(mut self, percent: f64) -> Self {
            self.modal.pace = Some(GivenSpeed::Percent(percent));
            self
        }
    };
    (@label vl) => {
        /// The speed of the TCP in mm/s.
        pub fn vl(mut self, speed: f64) -> Self {
            self.modal.pace = Some(GivenSpeed::Line(speed));
            self
        }
    };
    (@label s) => {
        /// The blending; its set components go to `$DFSLIP`, which applies without it.
        pub fn s(mut self, slip: impl Into<Slip>) -> Self {
            self.modal.blend = Some(Blend::Slip(slip.into()));
            self
        }
    };
    (@label sp) => {
        /// The blending in % of the largest zone.
        pub fn sp(mut self, percent: f64) -> Self {
            self.modal.blend = Some(Blend::Percent(percent));
            self
        }
    };
    (@label sl) => {
        /// The blending as a distance in mm.
        pub fn sl(mut self, distance: f64) -> Self {
            self.modal.blend = Some(Blend::Line(distance));
            self
        }
    };
    (@label t) => {
        /// The tool; it goes to `$DFTOOL`, which applies without it.
        pub fn t(mut self, tool: Tool) -> Self {
            self.modal.tool = Some(tool);
            self
        }
    };
    (@label w) => {
        /// The workpiece frame; it goes to `$DFWOBJ`, which applies without it.
        pub fn w(mut self, wobj: &Wobj) -> Self {
            self.modal.wobj = Some(wobj.clone());
            self
        }
    };
    (@label ca) => {
        /// The angle to travel along the circle, in deg, instead of to the target.
        pub fn ca(mut self, angle: f64) -> Self {
            self.modal.angle = Some(angle);
            self
        }
    };
    (@label dura) => {
        /// The duration of the motion, in s; the speed is then ignored.
        pub fn dura(mut self, seconds: f64) -> Self {
            self.modal.duration = Some(seconds);
            self
        }
    };
}

instruction! {
    /// `movej`: moves all axes to their positions; they arrive together.
    movej MoveJ (j: Joint) Axes { v vp s sp sl t dura }
    -> |this, modal, cx| resolve::joints(cx, &this.j).map(Target::Joints)
}

instruction! {
    /// `ptp`: moves the TCP to a pose; all axes arrive together, and the path of the TCP is not defined.
    ptp Ptp (p: Pose) Axes { v vp s sl sp t w dura }
    -> |this, modal, cx| resolve::pose(cx, &this.p, &modal).map(|(pose, wanted, external)| Target::Pose {
        pose, wobj: modal.setting.workpiece(), wanted, external
    })
}

instruction! {
    /// `lin`: moves the TCP along a straight line; the tool turns uniformly along it.
    lin Lin (p: Pose) Line { v vl vp s sl sp t w dura }
    -> |this, modal, cx| resolve::pose(cx, &this.p, &modal).map(|(pose, _, external)| Target::Line {
        pose, wobj: modal.setting.workpiece(), external
    })
}

instruction! {
    /// `cir`: moves the TCP along a circle through a via point; the tool turns uniformly along it or, with
    /// `$ORI_REF_PATH`, with the path.
    cir Cir (m: Pose, p: Pose) Line { v vl vp s sl sp t w ca dura }
    -> |this, modal, cx| resolve::pose(cx, &this.p, &modal).and_then(|(pose, _, external)| {
        let (via, follow) = (resolve::via(&this.m)?, cx.system().ori_ref_path.get());
        Ok(Target::Arc { via, pose, wobj: modal.setting.workpiece(), angle: this.modal.angle, follow, external })
    })
}

instruction! {
    /// `ccir`: moves the TCP along the circle that consecutive `ccir` define; the tool turns uniformly along it or,
    /// with `$ORI_REF_PATH`, with the path.
    ccir Ccir (p: Pose) Line { v vl vp s sl sp t w }
    -> |this, modal, cx| resolve::pose(cx, &this.p, &modal).map(|(pose, _, external)| Target::Circle {
        pose, wobj: modal.setting.workpiece(), follow: cx.system().ori_ref_path.get(), external
    })
}

instruction! {
    /// `spl`: moves the TCP, the tool's rotation and the external axes smoothly through the targets of consecutive
    /// `spl`.
    spl Spl (p: Pose) Line { v vl vp s sl sp t w }
    -> |this, modal, cx| resolve::pose(cx, &this.p, &modal).map(|(pose, _, external)| Target::Spline {
        pose, wobj: modal.setting.workpiece(), external
    })
}

/// `velset`: scales the programmed speeds of the motions that follow to `percent`, and limits their TCP speed to `max`
/// mm/s.
pub fn velset(percent: i32, max: i32) -> VelSet {
    VelSet { percent, max }
}

/// `velset`, ready to run.
#[derive(Clone, Copy, Debug)]
#[must_use = "an instruction does nothing until it is run"]
pub struct VelSet {
    percent: i32,
    max: i32,
}

impl VelSet {
    /// Applies from the next motion on.
    ///
    /// # Errors
    /// The percentage is not within 0 to 100, or the largest speed is below 0.
    pub fn run(self, cx: &Cx) -> Result<(), Fault> {
        let domain = |problem: String| Fault::Domain { function: "velset", problem: problem.into() };
        if !(0..=100).contains(&self.percent) {
            return Err(domain(format!("override is {} %, but must be 0 to 100 %", self.percent)));
        }
        if self.max < 0 {
            return Err(domain(format!("max is {} mm/s, but must be 0 or more", self.max)));
        }
        let mut unit = cx.channel_state().unit_mut("velset")?;
        unit.settings.speed_percent = f64::from(self.percent);
        unit.settings.max_tcp = f64::from(self.max);
        Ok(())
    }
}

/// `accset`: scales the accelerations and jerks of the motions that follow to `acc` and `ramp` percent. Values below 20
/// count as 20; values above 100 make nothing faster than the robot file allows.
pub fn accset(acc: i32, ramp: i32) -> AccSet {
    AccSet { acc, ramp }
}

/// `accset`, ready to run.
#[derive(Clone, Copy, Debug)]
#[must_use = "an instruction does nothing until it is run"]
pub struct AccSet {
    acc: i32,
    ramp: i32,
}

impl AccSet {
    /// Applies from the next motion on.
    ///
    /// # Errors
    /// A percentage is not within 0 to 300.
    pub fn run(self, cx: &Cx) -> Result<(), Fault> {
        for (name, percent) in [("acc", self.acc), ("ramp", self.ramp)] {
            if !(0..=300).contains(&percent) {
                let problem = format!("{name} is {percent} %, but must be 0 to 300 %");
                return Err(Fault::Domain { function: "accset", problem: problem.into() });
            }
        }
        let mut unit = cx.channel_state().unit_mut("accset")?;
        unit.settings.acc_percent = f64::from(self.acc);
        unit.settings.jerk_percent = f64::from(self.ramp);
        Ok(())
    }
}
