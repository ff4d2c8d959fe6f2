//! `stopmove` and `startmove` suspend motion and go on with it.

use crate::context::cx::Cx;
use crate::fault::Fault;
use crate::motion::{Start, Stop};
use crate::values::Stoptype;

/// `stopmove`: brakes on the path, and keeps the motion that is planned for `startmove`.
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
    /// How it brakes: general without it.
    pub fn stop(mut self, kind: Stoptype) -> Self {
        self.stop = match kind {
            Stoptype::General => Stop::General,
            Stoptype::Fast => Stop::Fast,
        };
        self
    }

    /// Begins to brake, and does not wait for the end of it. Motions that what runs now, or what interrupts it, plans
    /// from here on come before the stopped ones go on.
    ///
    /// # Errors
    /// The channel has no robot.
    pub fn run(self, cx: &Cx) -> Result<(), Fault> {
        cx.channel_state().unit_mut("stopmove")?.set_aside(self.stop, cx.level().number);
        Ok(())
    }
}

/// How many motions `startmove` drops.
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

/// `startmove`: goes on with what the last `stopmove` stopped.
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
    /// How many motions are dropped, from the stopped one on; 0 without it.
    pub fn skip(mut self, count: impl Into<Skip>) -> Self {
        self.skip = count.into();
        self
    }

    /// Goes on as soon as the robot has come to rest and done what was planned since the stop; does not wait for that.
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
