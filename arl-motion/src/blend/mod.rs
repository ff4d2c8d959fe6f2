//! Blending: how much of two motions a blend takes, its curve, and the limits within which it is passed.

pub(crate) mod blend_limits;
pub(crate) mod corner;
pub(crate) mod mid_curvature;
pub(crate) mod no_blend;
pub(crate) mod smoothing;
pub(crate) mod zone;
