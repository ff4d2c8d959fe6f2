//! Curves: lines, circles and splines, and how a parameter moves along them.

pub(crate) mod arc;
pub(crate) mod derivatives;
pub(crate) mod paced_quintic;
pub(crate) mod parametrization;
pub(crate) mod quintic;
pub(crate) mod rotation;
pub(crate) mod spline;
pub(crate) mod tcp_path;
pub(crate) mod track;
