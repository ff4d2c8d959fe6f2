//! The border to real inputs and outputs.

use super::{Inputs, Outputs};

/// Exchanges inputs and outputs with the outside, once a cycle. Both calls must return at once.
pub trait IoDriver {
    /// Fills the inputs, at the start of a cycle. What it leaves alone keeps its level.
    fn read(&mut self, inputs: Inputs<'_>);

    /// Passes the outputs on, at the end of a cycle.
    fn write(&mut self, outputs: Outputs<'_>);
}

/// Io without an outside: inputs keep what a scenario or the embedding program gave them.
#[derive(Clone, Copy, Default, Debug)]
pub struct SimulatedIo;

impl IoDriver for SimulatedIo {
    #[inline]
    fn read(&mut self, _inputs: Inputs<'_>) {}

    #[inline]
    fn write(&mut self, _outputs: Outputs<'_>) {}
}
