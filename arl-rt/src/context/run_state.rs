//! The state of a controller.

/// What the controller does at the moment.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum State {
    /// The program runs, or its last motion does.
    Running,
    /// The program waits for the start button.
    Paused,
    /// The program has ended; [`Controller::outcome`](crate::Controller::outcome) reports how.
    Ended,
}
