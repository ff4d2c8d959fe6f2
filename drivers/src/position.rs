//! Positions that robots report.

use arl_rt::motion::Joints;

/// A position to begin at: all of it has to be numbers.
///
/// # Errors
/// It is not.
pub(crate) fn begin_at(position: Joints) -> Result<Joints, String> {
    let is_number = position.axes.iter().chain(&position.external).all(|axis| axis.is_finite());
    if is_number { Ok(position) } else { Err("it says that the robot is at what is no number".to_owned()) }
}

/// How far one is from another, axis by axis, in deg (mm).
pub(crate) fn difference(one: &Joints, other: &Joints) -> Joints {
    let mut result = *one;
    result.axes.iter_mut().zip(&other.axes).for_each(|(axis, other)| *axis -= other);
    result.external.iter_mut().zip(&other.external).for_each(|(axis, other)| *axis -= other);
    result
}
