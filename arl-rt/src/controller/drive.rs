//! The drivers that a cell file asks for.

use super::builder::SetupError;
use super::foreground::Body;
use crate::cycle::clock_source::Clock;
use crate::unit::robot_driver::{Connect, Driven, DrivenTime};

/// What robots that are driven ask of the time.
#[derive(Default)]
pub(super) struct Time {
    /// One of them lives in the time of the world.
    pub(super) is_of_the_world: bool,
    /// They live in a time of their own.
    pub(super) is_of_a_robot: bool,
    /// One of them gives the beat.
    pub(super) beat: Option<Box<dyn Clock>>,
}

/// Gives the robots of channels, from 1, the drivers that their settings ask for.
///
/// # Errors
/// There is no such driver, or none at all, or one that gives the beat is not alone, or their times do not go together.
pub(super) fn drive<'a>(bodies: impl Iterator<Item = &'a mut Body>, connect: Connect) -> Result<Time, SetupError> {
    let mut time = Time::default();
    let (mut in_the_world, mut in_its_own) = (false, false);
    let mut count = 0;
    for (channel, body) in (1..).zip(bodies) {
        in_the_world |= body.has_driver;
        count += u32::from(body.has_driver || body.settings.is_some());
        let Some(settings) = body.settings.take().filter(|_| !body.has_driver) else { continue };
        let of_channel = |problem| SetupError::Driver { channel, problem };
        let Driven { driver, time: own } = connect(&settings).map_err(of_channel)?;
        (body.driver, body.has_driver) = (driver, true);
        let is_real = match &own {
            DrivenTime::World => true,
            DrivenTime::Robot => false,
            DrivenTime::Beat(clock) => clock.is_real(),
        };
        in_the_world |= is_real;
        in_its_own |= !is_real;
        match own {
            DrivenTime::World => time.is_of_the_world = true,
            DrivenTime::Robot => {}
            DrivenTime::Beat(clock) => time.beat = Some(clock),
        }
    }
    if time.beat.is_some() && count > 1 {
        // It waits for its robot, and its robot for it: another one would have to do without set-points meanwhile.
        let text = "a robot that gives the beat of the cycles (protocol \"rsi\") is driven beside another one: \
                    it needs a controller of its own";
        return Err(SetupError::Cell(text.to_owned()));
    }
    time.is_of_a_robot = in_its_own;
    match (in_the_world, in_its_own) {
        (false, false) => Err(SetupError::Cell("robots are to be driven, but the cell has no [driver]".to_owned())),
        (true, true) => Err(SetupError::Cell(
            "a robot with `time = \"robot\"` is driven beside one in the time of the world: no time suits both"
                .to_owned(),
        )),
        _ => Ok(time),
    }
}
