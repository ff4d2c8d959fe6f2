//! `stopmove` and `startmove`: suspend and resume motion.

use crate::context::cx::Cx;
use crate::fault::Fault;
use crate::motion::{Start, Stop};
use crate::values::Stoptype;

/// `stopmove`: brakes on the path, and keeps the planned motion for `startmove`.
pub fn stopmove() -> StopMove {
    StopMove { stop: Stop::General }
}

/// `stopmove`, ready to run.
#[derive(Clone, Copy, Debug)]
#[must_use = "an instruction does nothing until it is run"]
pub struct StopMove {
    stop: Stop,
}

impl StopMove {
    /// The kind of braking; general by default.
    pub fn stop(mut self, kind: Stoptype) -> Self {
        self.stop = match kind {
            Stoptype::General => Stop::General,
            Stoptype::Fast => Stop::Fast,
        };
        self
    }

    /// Begins to brake without waiting for standstill. Motions that the running code, or code that interrupts it, plans
    /// from now on are executed before the stopped ones continue.
    ///
    /// # Errors
    /// The channel has no robot.
    pub fn run(self, cx: &Cx) -> Result<(), Fault> {
        cx.channel_state().unit_mut("stopmove")?.set_aside(self.stop, cx.level().number);
        Ok(())
    }
}

/// The number of motions that `startmove` drops.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Skip(i32);

impl From<i32> for Skip {
    fn from(count: i32) -> Self {
        Skip(count)
    }
}

impl From<bool> for Skip {
    fn from(stopped: bool) -> Self {
        Skip(i32::from(stopped))
    }
}

/// `startmove`: resumes the motion that the last `stopmove` stopped.
pub fn startmove() -> StartMove {
    StartMove { skip: Skip(0) }
}

/// `startmove`, ready to run.
#[derive(Clone, Copy, Debug)]
#[must_use = "an instruction does nothing until it is run"]
pub struct StartMove {
    skip: Skip,
}

impl StartMove {
    /// The number of motions to drop, from the stopped one on; 0 by default.
    pub fn skip(mut self, count: impl Into<Skip>) -> Self {
        self.skip = count.into();
        self
    }

    /// Resumes as soon as the robot has come to rest and executed the motions planned since the stop; does not wait for
    /// this.
    ///
    /// # Errors
    /// `skip` is negative, no motion is stopped, or the channel has no robot.
    pub fn run(self, cx: &Cx) -> Result<(), Fault> {
        let domain = |problem: String| Fault::Domain { function: "startmove", problem: problem.into() };
        let Skip(skip) = self.skip;
        let skip = u32::try_from(skip).map_err(|_| domain(format!("skip is {skip}, but must be 0 or more")))?;
        let (file, line) = cx.place();
        let started = cx.channel_state().unit_mut("startmove")?.start_again(Start { skip, manual: false, line }, file);
        if started {
            Ok(())
        } else {
            Err(domain("no motion is stopped: each startmove needs a stopmove before it".into()))
        }
    }
}
