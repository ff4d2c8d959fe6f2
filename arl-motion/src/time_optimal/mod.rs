//! The fastest motion along the path ahead, and the thread that finds it in parallel with the cycle.

pub(crate) mod constraint_sampler;
pub(crate) mod law_follower;
pub(crate) mod law_memory;
pub(crate) mod law_solver_thread;
pub(crate) mod limit_check;
pub(crate) mod ramp;
pub(crate) mod set_points;
pub mod solver;
pub(crate) mod speed_scaling;
pub(crate) mod stop_prediction;
