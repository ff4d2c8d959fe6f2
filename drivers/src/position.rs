//! Positions that robots report.

use arl_rt::motion::Joints;

/// The difference of two positions, axis by axis, in deg (mm).
pub(crate) fn difference(one: &Joints, other: &Joints) -> Joints {
    let mut result = *one;
    result.axes.iter_mut().zip(&other.axes).for_each(|(axis, other)| *axis -= other);
    result.external.iter_mut().zip(&other.external).for_each(|(axis, other)| *axis -= other);
    result
}
