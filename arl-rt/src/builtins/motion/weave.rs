//! `startweave` and `endweave`: a figure that is superimposed on the lines, circles and splines between them.

use nalgebra::Vector3;

use crate::context::cx::Cx;
use crate::fault::Fault;
use crate::motion::{Weave, WeaveShape, is_unset};
use crate::values::{Weavedata, Weaverotaxis, Weaveshape};

/// `startweave`: superimposes a weave on the lines, circles and splines that follow.
pub fn startweave(weave: Weavedata) -> StartWeave {
    StartWeave { weave }
}

/// `startweave`, ready to run.
#[derive(Clone, Copy, Debug)]
#[must_use = "an instruction does nothing until it is run"]
pub struct StartWeave {
    weave: Weavedata,
}

impl StartWeave {
    /// Applies from the next motion on, and replaces the current weave.
    ///
    /// # Errors
    /// A component is out of its range, or requests something unsupported: weld tracking, vibration, a weave of a SCARA
    /// robot.
    pub fn run(self, cx: &Cx) -> Result<(), Fault> {
        let weave = figure(&self.weave)?;
        cx.channel_state().unit_mut("startweave")?.settings.weave = Some(weave);
        Ok(())
    }
}

/// `endweave`: ends the weave.
pub fn endweave() -> EndWeave {
    EndWeave
}

/// `endweave`, ready to run.
#[derive(Clone, Copy, Debug)]
#[must_use = "an instruction does nothing until it is run"]
pub struct EndWeave;

impl EndWeave {
    /// Applies from the next motion on.
    ///
    /// # Errors
    /// There is no weave to end.
    pub fn run(self, cx: &Cx) -> Result<(), Fault> {
        let ended = cx.channel_state().unit_mut("endweave")?.settings.weave.take();
        ended
            .map(|_| ())
            .ok_or_else(|| domain("endweave", "there is no weave to end: startweave begins one".to_owned()))
    }
}

fn domain(function: &'static str, problem: String) -> Fault {
    Fault::Domain { function, problem: problem.into() }
}

/// The figure that a program describes.
fn figure(weave: &Weavedata) -> Result<Weave, Fault> {
    let refused = |problem: String| Err(domain("startweave", problem));
    let Weavedata { frequency, amplitude, dwell_left, dwell_right, dwell_middle, .. } = *weave;
    let not_negative = [
        ("amplitude", "mm", amplitude),
        ("dwell_left", "s", dwell_left),
        ("dwell_right", "s", dwell_right),
        ("dwell_middle", "s", dwell_middle),
        ("radius", "mm", weave.radius),
    ];
    if !(frequency > 0.0 && frequency.is_finite()) || is_unset(frequency) {
        return refused(format!("frequency is {frequency} Hz, but must be above 0"));
    }
    for (name, unit, value) in not_negative {
        if is_unset(value) {
            return refused(format!("{name} is not set"));
        }
        if !(value >= 0.0 && value.is_finite()) {
            return refused(format!("{name} is {value} {unit}, but must be 0 or more"));
        }
    }
    if !(0.0..=180.0).contains(&weave.swing_angle) {
        return refused(format!("swing_angle is {} deg, but must be 0 to 180", weave.swing_angle));
    }
    if !weave.rotation_angle.is_finite() || is_unset(weave.rotation_angle.abs()) {
        return refused(format!("rotation_angle is {}, which is not an angle", weave.rotation_angle));
    }
    if weave.track {
        return refused("track is true, but weld tracking is not supported: it needs a sensor at the torch".to_owned());
    }
    if weave.vibrat {
        return refused("vibrat is true, but vibration is not supported".to_owned());
    }
    let axis = match weave.weaverotaxis {
        Weaverotaxis::X => Vector3::x(),
        Weaverotaxis::Y => Vector3::y(),
        Weaverotaxis::Z => Vector3::z(),
    };
    let shape = match weave.weaveshape {
        Weaveshape::Simple => WeaveShape::Simple,
        Weaveshape::VShape => WeaveShape::VShape,
        Weaveshape::Triangle => WeaveShape::Triangle,
        Weaveshape::Ellipse => WeaveShape::Ellipse,
        Weaveshape::Eight => WeaveShape::Eight,
    };
    Ok(Weave {
        shape,
        frequency,
        amplitude,
        dwells: [dwell_left, dwell_right, dwell_middle],
        angle: weave.swing_angle,
        radius: weave.radius,
        turned: axis * weave.rotation_angle.to_radians(),
    })
}
