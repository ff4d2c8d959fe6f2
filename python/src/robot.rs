//! Robots: their axes, and the conversion from axes to poses and back.

use arl_robot::Robot as Description;
use arl_robot::frames::{Mount, Setting};
use arl_robot::kinematics::{Axes, Wanted, frame, frame_components};
use arl_robot::robot::{Axis, Family};
use pyo3::buffer::PyBuffer;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::problem::Refused;

/// The number of components of a pose: x, y, z in mm, a, b, c in deg.
const COMPONENTS: usize = 6;

/// Name, whether it is linear, lowest and highest position, speed, acceleration, jerk.
type AxisFacts = (String, bool, f64, f64, f64, f64, f64);
/// The axes of each pose as the bytes of doubles, and why a pose has none.
type Found<'py> = (Bound<'py, PyBytes>, Vec<Option<String>>);

/// What is between a pose and the flange: tool, workpiece and base (mm, deg), whether the tool is stationary, and
/// whether the robot holds the workpiece.
#[derive(FromPyObject)]
pub(crate) struct Frames([f64; COMPONENTS], [f64; COMPONENTS], [f64; COMPONENTS], bool, bool);

impl Frames {
    fn setting(&self) -> PyResult<Setting> {
        let Self(tool, wobj, base, stationary, robhold) = self;
        let tool = Mount { frame: frame(*tool), on_flange: !stationary };
        let wobj = Mount { frame: frame(*wobj), on_flange: *robhold };
        let setting = Setting::new(tool, wobj, frame(*base));
        setting.check().map_err(|error| Refused::new_err(error.to_string()))?;
        Ok(setting)
    }
}

/// A robot.
#[pyclass(frozen)]
pub(crate) struct Robot {
    robot: Description,
}

impl Robot {
    fn own(&self) -> &[Axis] {
        self.robot.own_axes()
    }

    /// A row of axes, in the form that kinematics take.
    fn axes(row: &[f64]) -> Axes {
        let mut axes = Axes::default();
        axes.iter_mut().zip(row).for_each(|(to, number)| *to = *number);
        axes
    }
}

#[pymethods]
impl Robot {
    /// A built-in robot, or the robot of a file.
    #[new]
    fn new(name_or_path: &str) -> PyResult<Self> {
        let robot = Description::load(name_or_path).map_err(|error| Refused::new_err(error.to_string()))?;
        Ok(Self { robot })
    }

    #[getter]
    fn name(&self) -> &str {
        &self.robot.name
    }

    #[getter]
    fn family(&self) -> &'static str {
        match self.robot.family {
            Family::SixAxis => "six-axis",
            Family::Scara => "scara",
        }
    }

    /// The robot's own axes, then the external ones.
    #[getter]
    fn axes_facts(&self) -> Vec<AxisFacts> {
        let facts = |axis: &Axis| (axis.name.clone(), axis.linear, axis.min, axis.max, axis.vel, axis.acc, axis.jerk);
        self.robot.axes.iter().map(facts).collect()
    }

    /// How many of these axes are the robot's own.
    #[getter]
    fn own_count(&self) -> usize {
        self.own().len()
    }

    #[getter]
    fn home(&self) -> Vec<f64> {
        self.robot.home.clone()
    }

    /// The TCP's poses in the workpiece frame and the configurations, for rows of axes.
    fn forward<'py>(
        &self,
        py: Python<'py>,
        joints: PyBuffer<f64>,
        frames: Frames,
    ) -> PyResult<(Bound<'py, PyBytes>, Vec<u8>)> {
        let (setting, joints) = (frames.setting()?, joints.to_vec(py)?);
        let (mut poses, mut cfgs) = (Vec::new(), Vec::new());
        py.detach(|| {
            for row in joints.chunks_exact(self.own().len()) {
                let axes = Self::axes(row);
                poses.extend(frame_components(&setting.pose_of(&self.robot.kinematics.forward(&axes))));
                cfgs.push(self.robot.kinematics.cfg(&axes));
            }
        });
        Ok((bytes(py, &poses)?, cfgs))
    }

    /// The axes that bring the TCP to rows of poses, each near a row of axes; for a pose that is not reached, the axes
    /// are not numbers, and there is a reason. `how`: `cfg`, `turn`, and whether each pose is near the previous one
    /// that was reached.
    fn inverse<'py>(
        &self,
        py: Python<'py>,
        poses: PyBuffer<f64>,
        near: PyBuffer<f64>,
        how: (Option<u8>, i32, bool),
        frames: Frames,
    ) -> PyResult<Found<'py>> {
        let (cfg, turn, chained) = how;
        let (setting, poses, near) = (frames.setting()?, poses.to_vec(py)?, near.to_vec(py)?);
        let (count, wanted) = (self.own().len(), Wanted { cfg, turn });
        let (mut found, mut reasons, mut last) = (Vec::new(), Vec::new(), None);
        py.detach(|| {
            for (at, pose) in poses.as_chunks::<COMPONENTS>().0.iter().enumerate() {
                let start = near.chunks_exact(count).nth(at).or_else(|| near.chunks_exact(count).next_back());
                let start = last.filter(|_| chained).unwrap_or_else(|| Self::axes(start.unwrap_or_default()));
                match self.reach(&setting, *pose, wanted, &start) {
                    Ok(axes) => {
                        found.extend(axes.iter().take(count));
                        reasons.push(None);
                        last = Some(axes);
                    }
                    Err(reason) => {
                        found.extend(std::iter::repeat_n(f64::NAN, count));
                        reasons.push(Some(reason));
                    }
                }
            }
        });
        Ok((bytes(py, &found)?, reasons))
    }

    /// The values that `cfg` can have.
    #[getter]
    fn configurations(&self) -> Vec<u8> {
        self.robot.kinematics.configurations().to_vec()
    }
}

impl Robot {
    fn reach(&self, setting: &Setting, pose: [f64; COMPONENTS], wanted: Wanted, near: &Axes) -> Result<Axes, String> {
        if pose.iter().any(|number| !number.is_finite()) {
            return Err("a component of the pose is not a number".into());
        }
        let flange = setting.flange_of(&frame(pose)).map_err(|error| error.to_string())?;
        let chosen = self.robot.kinematics.choose(&flange, wanted, self.own(), near);
        chosen.map_err(|refusal| refusal.to_string())
    }
}

/// The names of the built-in robots.
#[pyfunction]
pub(crate) fn robots() -> Vec<&'static str> {
    Description::builtin_names().collect()
}

/// Doubles as bytes.
fn bytes<'py>(py: Python<'py>, numbers: &[f64]) -> PyResult<Bound<'py, PyBytes>> {
    PyBytes::new_with(py, std::mem::size_of_val(numbers), |bytes| {
        bytes.chunks_exact_mut(8).zip(numbers).for_each(|(to, number)| to.copy_from_slice(&number.to_ne_bytes()));
        Ok(())
    })
}
