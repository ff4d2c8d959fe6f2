//! The trait of drivers that exchange inputs and outputs with the outside, and the errors of drivers.

use std::{error, fmt, io};

use super::channel::OutputSignal;
use super::image::{Inputs, Outputs};

/// Exchanges inputs and outputs with the outside, once a cycle. All calls must return at once: slow exchanges, such as
/// a field bus, need a thread of their own and an image that both threads copy. The islands of a cell file work this
/// way.
///
/// A whole plant can be simulated in the process, too:
///
/// ```
/// use arl_rt::io::{Inputs, IoDriver, Outputs};
///
/// /// A tank: output 1 opens the valve above it; input 1 is on while it is full, analog input 1 tells the level in V.
/// #[derive(Default)]
/// struct Tank {
///     litres: f64,
///     open: bool,
/// }
///
/// impl IoDriver for Tank {
///     fn read(&mut self, mut inputs: Inputs<'_>) {
///         // Called once a cycle, of 1 ms here.
///         self.litres += if self.open { 0.05 } else { 0.0 };
///         inputs.set_digital_input(1, self.litres >= 10.0);
///         inputs.set_analog_input(1, self.litres.min(10.0));
///     }
///
///     fn write(&mut self, outputs: Outputs<'_>) {
///         self.open = outputs.digital_output(1);
///     }
/// }
///
/// # use arl_rt::emit::*;
/// # struct Fill;
/// # impl arl_rt::Program for Fill {
/// #     fn file(&self) -> File { File::new("fill.arl") }
/// #     fn family(&self) -> Family { Family::SixAxis }
/// #     fn main<'a>(&'a self, cx: &'a Cx) -> BoxFuture<'a> {
/// #         Box::pin(async move {
/// #             let file = self.file();
/// #             io::setdo(cx, 1, true).await.at(file, 2)?;
/// #             while !io::getdi(cx, 1).await.at(file, 3)? { cx.next_cycle().await; }
/// #             io::setdo(cx, 1, false).await.at(file, 4)?;
/// #             text::print().argtoprint(&"full after ").argtoprint(&cx.time()).run(cx).at(file, 5)
/// #         })
/// #     }
/// # }
/// // `Fill` is what this program becomes:
/// //     setdo(1,true)
/// //     waituntil getdi(1)
/// //     setdo(1,false)
/// //     print "full after ", ...
/// let messages = arl_rt::Captured::new();
/// let builder = arl_rt::Controller::builder().output(messages.clone()).io_driver(Tank::default());
/// let mut controller = builder.build(Box::new(Fill))?;
/// assert_eq!(controller.run(), arl_rt::Outcome::Ended);
/// assert_eq!(messages.text(), "full after 0.2\n");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait IoDriver {
    /// Connects, once, before the first cycle. This may take long.
    ///
    /// # Errors
    /// The reason why there are no inputs and outputs; the controller is not built then.
    fn start(&mut self) -> Result<(), DriverError> {
        Ok(())
    }

    /// Fills the inputs, at the start of a cycle. Inputs that are not set keep their level.
    fn read(&mut self, inputs: Inputs<'_>);

    /// Passes the outputs on, at the end of a cycle.
    fn write(&mut self, outputs: Outputs<'_>);

    /// Whether an output of this cycle ([`Outputs::cycle`]), or of a later one, has reached its destination: `syncdo`
    /// and `syncao` wait for this. Called after [`read`](IoDriver::read).
    fn has_reached(&self, _output: OutputSignal, _cycle: u64) -> bool {
        true
    }

    /// Returns a message for the user, once; called in each cycle until there is none left.
    fn take_warning(&mut self) -> Option<String> {
        None
    }

    /// The reason why no robot may continue to move, as long as it holds: the inputs no longer are those of the
    /// outside. Raises alarm 20051 for each program with a robot as soon as it runs.
    fn fault(&self) -> Option<&str> {
        None
    }

    /// Called when the controller ends; no other call follows. This may take long.
    fn close(&mut self) {}
}

/// I/O without an outside: inputs keep the levels that a scenario or the embedding program set.
#[derive(Clone, Copy, Default, Debug)]
pub struct SimulatedIo;

impl IoDriver for SimulatedIo {
    #[inline]
    fn read(&mut self, _inputs: Inputs<'_>) {}

    #[inline]
    fn write(&mut self, _outputs: Outputs<'_>) {}
}

/// The error of a driver that cannot be started, of a robot or of inputs and outputs. Texts and system errors convert
/// into it (`?`).
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum DriverError {
    /// The driver's own message.
    Message(String),
    /// A system call failed; kind and message of its error.
    System(io::ErrorKind, String),
}

impl fmt::Display for DriverError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            DriverError::Message(why) | DriverError::System(_, why) => write!(f, "{why}"),
        }
    }
}

impl error::Error for DriverError {}

impl From<String> for DriverError {
    fn from(why: String) -> Self {
        DriverError::Message(why)
    }
}

impl From<&str> for DriverError {
    fn from(why: &str) -> Self {
        DriverError::Message(why.to_owned())
    }
}

impl From<io::Error> for DriverError {
    fn from(error: io::Error) -> Self {
        DriverError::System(error.kind(), error.to_string())
    }
}
