//! `waittime`, `waituntil`, `pause` and `assert`: waiting, and ending the program.

use crate::context::cx::Cx;
use crate::fault::Fault;
use arl_robot::cell::Rate;

/// `waittime`: waits until all planned motion has ended, then for `time` seconds, counted in cycles.
pub fn waittime(time: f64) -> WaitTime {
    WaitTime { time }
}

/// `waittime`, ready to run.
#[derive(Clone, Copy, Debug)]
#[must_use = "an instruction does nothing until it is run"]
pub struct WaitTime {
    time: f64,
}

impl WaitTime {
    /// Waits.
    ///
    /// # Errors
    /// The time is negative or not a number.
    pub async fn run(self, cx: &Cx) -> Result<(), Fault> {
        let cycles = wait_cycles(cx.shared().rate, self.time, "waittime")?;
        cx.motion_end().await;
        cx.goes_on();
        let over = cx.cycle().saturating_add(cycles);
        while cx.cycle() < over {
            cx.wait_until(over).await;
        }
        Ok(())
    }
}

/// `waituntil`: prepares to wait for a condition, which the caller evaluates once a cycle.
pub fn waituntil(cx: &Cx) -> WaitUntil<'_> {
    WaitUntil { cx, maxtime: None }
}

/// `waituntil` before it starts.
#[derive(Clone, Copy, Debug)]
#[must_use = "an instruction does nothing until it is started"]
pub struct WaitUntil<'a> {
    cx: &'a Cx,
    maxtime: Option<f64>,
}

impl<'a> WaitUntil<'a> {
    /// The longest time to wait, in s, counted from the end of the previous motion.
    pub fn maxtime(mut self, seconds: f64) -> Self {
        self.maxtime = Some(seconds);
        self
    }

    /// Waits until all planned motion has ended; the time counts from there.
    ///
    /// # Errors
    /// The longest time is negative or not a number.
    pub async fn start(self) -> Result<Wait<'a>, Fault> {
        let cycles = match self.maxtime {
            Some(seconds) => Some(wait_cycles(self.cx.shared().rate, seconds, "waituntil")?),
            None => None,
        };
        self.cx.motion_end().await;
        self.cx.goes_on();
        Ok(Wait { cx: self.cx, over: cycles.map(|cycles| self.cx.cycle().saturating_add(cycles)) })
    }
}

/// `waituntil` while it waits.
#[derive(Clone, Copy, Debug)]
pub struct Wait<'a> {
    cx: &'a Cx,
    over: Option<u64>,
}

impl Wait<'_> {
    /// Whether the longest time is over.
    #[inline]
    pub fn late(&self) -> bool {
        self.over.is_some_and(|over| self.cx.cycle() >= over)
    }

    /// The first cycle in which the longest time is over, if there is one.
    pub fn over(&self) -> Option<u64> {
        self.over
    }
}

/// `pause`: waits until all planned motion has ended, then until the start button is pressed.
pub fn pause() -> Pause {
    Pause(())
}

/// `pause`, ready to run.
#[derive(Clone, Copy, Debug)]
#[must_use = "an instruction does nothing until it is run"]
pub struct Pause(());

impl Pause {
    /// Waits for the start button: [`crate::Controller::resume`], or `pendant = "start"` of a scenario.
    ///
    /// # Errors
    /// None yet.
    pub async fn run(self, cx: &Cx) -> Result<(), Fault> {
        cx.motion_end().await;
        cx.channel_state().paused.set(true);
        cx.goes_on();
        while cx.channel_state().paused.get() {
            cx.next_cycle().await;
        }
        Ok(())
    }
}

/// `assert`: an alarm if `x` is false.
///
/// # Errors
/// [`Fault::Assertion`].
#[inline]
pub fn assert(x: bool) -> Result<(), Fault> {
    if x { Ok(()) } else { Err(Fault::Assertion) }
}

/// The number of cycles that a program waits for this time.
///
/// # Errors
/// The time is negative or not a number.
pub(super) fn wait_cycles(rate: Rate, seconds: f64, function: &'static str) -> Result<u64, Fault> {
    if seconds >= 0.0 {
        return Ok(rate.cycles(seconds));
    }
    let problem = format!("the time is {seconds} s, but must be 0 or more").into();
    Err(Fault::Domain { function, problem })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_to_wait_are_numbers_from_0_on() {
        let rate = Rate::default();
        assert_eq!(wait_cycles(rate, 0.003, "waittime"), Ok(3));
        assert!(wait_cycles(rate, -1.0, "waittime").is_err());
        assert!(wait_cycles(rate, f64::NAN, "waittime").is_err());
    }
}
