//! Parameters of a motion from the instruction, or else from the system variables.

use crate::builtins::frames::Setting;
use crate::context::cx::Cx;
use crate::context::system::{self, System};
use crate::fault::Fault;
use crate::motion;
use crate::unit::{Inherited, Mounts};
use crate::values::{Frame, Slip, SmallArray, Speed, Tool, Wobj, is_set};

/// The components of a speed that a motion uses.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Kind {
    /// Percent of the axes' speeds.
    Axes,
    /// Speeds of the TCP.
    Line,
}

/// The speed that an instruction gives.
#[derive(Clone, Copy, Debug)]
pub(super) enum GivenSpeed {
    Speed(Speed),
    /// % of the robot's speed.
    Percent(f64),
    /// mm/s.
    Line(f64),
}

/// The blending that an instruction gives.
#[derive(Clone, Copy, Debug)]
pub(super) enum Blend {
    Slip(Slip),
    /// % of the largest zone.
    Percent(f64),
    /// mm.
    Line(f64),
}

/// The parameters of an instruction besides its target.
#[derive(Clone, Debug)]
pub(super) struct Modal {
    kind: Kind,
    pub(super) pace: Option<GivenSpeed>,
    pub(super) blend: Option<Blend>,
    pub(super) tool: Option<Tool>,
    pub(super) wobj: Option<Wobj>,
    pub(super) duration: Option<f64>,
    /// The angle to travel along a circle, in deg.
    pub(super) angle: Option<f64>,
}

/// The parameters of an instruction, completed from the system variables.
#[derive(Clone, Debug)]
pub(super) struct Resolved {
    pub(super) kind: Kind,
    pub(super) speed: motion::Speed,
    /// What carries tool and workpiece.
    pub(super) setting: Setting,
    pub(super) duration: Option<f64>,
    pub(super) zone: motion::Zone,
    /// The tool and workpiece frames in effect that the instruction does not set.
    pub(super) mounts: Mounts,
}

impl Modal {
    pub(super) fn new(kind: Kind) -> Self {
        Self { kind, pace: None, blend: None, tool: None, wobj: None, duration: None, angle: None }
    }

    /// Updates the modal system variables with the parameters of the instruction, and takes the missing ones from them.
    pub(super) fn apply(&self, cx: &Cx) -> Result<Resolved, Fault> {
        self.check()?;
        let system = cx.system();
        if let Some(pace) = self.pace {
            system.dfspeed.set(self.speed(cx, pace, system.dfspeed.get()));
        }
        if let Some(blend) = self.blend {
            system.dfslip.set(slip(self.kind, blend, system.dfslip.get()));
        }
        let known = &cx.channel_state().mounts;
        let given = |frame: &Frame| Some(Inherited { frame: frame.components(), from: Some(cx.place()) });
        if let Some(tool) = self.tool {
            known.set(Mounts { tool: given(&tool.t_frame), ..known.get() });
            system.dftool.set(tool);
        }
        if let Some(wobj) = &self.wobj {
            known.set(Mounts { wobj: given(&wobj.w_frame), ..known.get() });
            system.dfwobj.set(wobj.clone());
        }
        Ok(Resolved {
            kind: self.kind,
            speed: speed(&system.dfspeed.get()),
            setting: setting(system)?,
            duration: self.duration,
            zone: zone(&system.dfslip.get())?,
            mounts: self.inherited(system, known.get()),
        })
    }

    /// The tool and workpiece frames in effect that the instruction does not set; `known` has their possible origins.
    fn inherited(&self, system: &System, known: Mounts) -> Mounts {
        let held = |frame: [f64; 6], known: Option<Inherited>| {
            let known = known.filter(|known| known.frame == frame).and_then(|known| known.from);
            (frame != [0.0; 6]).then_some(Inherited { frame, from: known })
        };
        let tool = || held(system.dftool.get().t_frame.components(), known.tool);
        let wobj = || held(system.dfwobj.get().w_frame.components(), known.wobj);
        Mounts { tool: self.tool.is_none().then(tool).flatten(), wobj: self.wobj.is_none().then(wobj).flatten() }
    }

    /// Checks that labels with one number have a number that is set.
    fn check(&self) -> Result<(), Fault> {
        let speed = match self.pace {
            Some(GivenSpeed::Percent(value)) => Some(("vp", value)),
            Some(GivenSpeed::Line(value)) => Some(("vl", value)),
            Some(GivenSpeed::Speed(_)) | None => None,
        };
        let zone = match self.blend {
            Some(Blend::Percent(value)) => Some(("sp", value)),
            Some(Blend::Line(value)) => Some(("sl", value)),
            Some(Blend::Slip(_)) | None => None,
        };
        let others = [("dura", self.duration), ("CA", self.angle)];
        let others = others.into_iter().filter_map(|(label, value)| Some((label, value?)));
        match speed.into_iter().chain(zone).chain(others).find(|(_, value)| !is_set(*value)) {
            Some((label, _)) => Err(Fault::Motion(
                format!(
                    "{label} is 9e+09, which stands for a value that was not set: give a number, or leave {label} out"
                )
                .into(),
            )),
            None => Ok(()),
        }
    }

    /// `$DFSPEED` with the components that the instruction sets.
    fn speed(&self, cx: &Cx, pace: GivenSpeed, mut speed: Speed) -> Speed {
        match (pace, self.kind) {
            (GivenSpeed::Speed(new), _) => {
                let places = [
                    (&mut speed.per, new.per),
                    (&mut speed.tcp, new.tcp),
                    (&mut speed.ori, new.ori),
                    (&mut speed.exj, new.exj),
                    (&mut speed.exl, new.exl),
                ];
                for (place, new) in places {
                    if is_set(new) {
                        *place = new;
                    }
                }
            }
            (GivenSpeed::Percent(percent), Kind::Axes) => speed.per = percent,
            (GivenSpeed::Percent(percent), Kind::Line) => {
                if let Some(unit) = cx.channel_state().robot() {
                    let tcp = &unit.robot().tcp;
                    speed.tcp = tcp.vel * percent / 100.0;
                    speed.ori = tcp.ori_vel * percent / 100.0;
                }
            }
            (GivenSpeed::Line(millimetres), _) => speed.tcp = millimetres,
        }
        speed
    }
}

/// `$DFSLIP` with the components that the instruction sets.
fn slip(kind: Kind, blend: Blend, mut slip: Slip) -> Slip {
    match blend {
        Blend::Slip(new) => {
            let places = [
                (&mut slip.perdis, new.perdis),
                (&mut slip.pdis, new.pdis),
                (&mut slip.odis, new.odis),
                (&mut slip.ejdis, new.ejdis),
                (&mut slip.eldis, new.eldis),
                (&mut slip.jdis, new.jdis),
            ];
            for (place, new) in places {
                if is_set(new) {
                    *place = new;
                }
            }
            // An axis motion without blending must not be blended by an earlier distance of the TCP.
            if kind == Kind::Axes && is_set(new.jdis) && new.jdis <= 0.0 && !is_set(new.pdis) {
                slip.pdis = new.jdis;
            }
        }
        // Earlier values of other measures must not blend a target that shall be reached exactly.
        Blend::Percent(percent) if percent < 0.0 => slip = NO_SLIP,
        Blend::Percent(percent) => slip.perdis = percent,
        Blend::Line(distance) => slip = Slip { pdis: distance, ..NO_SLIP },
    }
    slip
}

/// No blending.
const NO_SLIP: Slip = Slip { perdis: -1.0, pdis: -1.0, odis: -1.0, ejdis: -1.0, eldis: -1.0, jdis: -1.0 };

/// What carries `$DFTOOL` and `$DFWOBJ`, with the offsets of all tools and workpieces.
fn setting(system: &System) -> Result<Setting, Fault> {
    let (tool, wobj) = (system.dftool.get(), system.dfwobj.get());
    let base = system.base.with(|base| base.first().map_or_else(Default::default, |base| base.w_frame));
    let (tool_offset, wobj_offset) = (system.tool_offset.with(components), system.wobj_offset.with(components));
    let frames = [
        ("the tool frame", tool.t_frame.components()),
        ("the workpiece frame", wobj.w_frame.components()),
        ("$BASE[0]", base.components()),
        ("$TOOL_OFFSET", tool_offset),
        ("$WOBJ_OFFSET", wobj_offset),
    ];
    for (name, components) in frames {
        if let Some(value) = components.iter().find(|value| !value.is_finite() || motion::is_unset(value.abs())) {
            return Err(Fault::Motion(
                format!("{name} holds the value {value}, which is not a length or angle").into(),
            ));
        }
    }
    Ok(Setting::new(&tool, &wobj, &base).with_offsets(&tool_offset, &wobj_offset))
}

fn components(offset: &SmallArray<f64, 6>) -> [f64; 6] {
    let mut components = [0.0; 6];
    for (component, value) in components.iter_mut().zip(offset.iter()) {
        *component = *value;
    }
    components
}

/// The speed that `$DFSPEED` describes; unset components have their default.
fn speed(speed: &Speed) -> motion::Speed {
    let or = |value: f64, default: f64| if is_set(value) { value } else { default };
    let Speed { per, tcp, ori, exj, exl } = system::DFSPEED;
    motion::Speed {
        percent: or(speed.per, per),
        tcp: or(speed.tcp, tcp),
        ori: or(speed.ori, ori),
        exj: or(speed.exj, exj),
        exl: or(speed.exl, exl),
    }
}

/// The zone that `$DFSLIP` describes; unset components stay unset.
fn zone(slip: &Slip) -> Result<motion::Zone, Fault> {
    let zone = motion::Zone {
        percent: slip.perdis,
        tcp: slip.pdis,
        ori: slip.odis,
        joint: slip.jdis,
        turning: slip.ejdis,
        linear: slip.eldis,
    };
    let motion::Zone { percent, tcp, ori, joint, turning, linear } = zone;
    if [percent, tcp, ori, joint, turning, linear].iter().any(|size| !size.is_finite()) {
        return Err(Fault::Motion("the zone (slip) holds a value that is not a number".into()));
    }
    Ok(zone)
}
