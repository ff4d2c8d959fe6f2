//! Blending: how much of two motions a blend takes, its curve, and the limits to pass it with.

pub(crate) mod blend_limits;
pub(crate) mod corner;
pub(crate) mod mid_curvature;
pub(crate) mod no_blend;
pub(crate) mod smoothing;
pub(crate) mod zone;
