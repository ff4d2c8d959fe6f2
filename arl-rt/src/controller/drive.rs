//! The drivers that a cell file asks for.

use super::builder::SetupError;
use super::foreground::Body;
use crate::cycle::clock_source::Clock;
use crate::unit::robot_driver::{Connect, Driven, DrivenTime};

/// Gives the robots of channels, from 1, the drivers that their settings ask for. A robot that sets the control cycle
/// becomes the clock. Returns whether a driver lives in real time, in which the cycles then have to run.
///
/// # Errors
/// There is no such driver, or no driver at all, or a robot that sets the control cycle is not the only one driven, or
/// the times of the robots do not go together.
pub(super) fn drive<'a>(
    bodies: impl Iterator<Item = &'a mut Body>,
    connect: Connect,
    clock: &mut Box<dyn Clock>,
) -> Result<bool, SetupError> {
    let mut robot_clock = None;
    let mut count = 0;
    let (mut in_the_world, mut in_its_own, mut needs_the_world) = (clock.is_real(), false, false);
    for (channel, body) in (1..).zip(bodies) {
        in_the_world |= body.has_driver;
        count += u32::from(body.has_driver || body.settings.is_some());
        let Some(settings) = body.settings.take().filter(|_| !body.has_driver) else { continue };
        let Driven { driver, time } = connect(&settings).map_err(|problem| SetupError::Driver { channel, problem })?;
        (body.driver, body.has_driver) = (driver, true);
        match time {
            DrivenTime::World => needs_the_world = true,
            DrivenTime::Robot => in_its_own = true,
            DrivenTime::Clock(clock) => {
                in_the_world |= clock.is_real();
                in_its_own |= !clock.is_real();
                robot_clock = Some(clock);
            }
        }
    }
    let refused = match count {
        0 => Some("robots are to be driven, but the cell has no [driver]"),
        2.. if robot_clock.is_some() => Some(
            "a robot that sets the control cycle (protocol \"rsi\") is driven together with another one: it needs a \
             controller of its own, as each would wait for the other",
        ),
        _ if in_its_own && (in_the_world || needs_the_world) => Some(
            "a robot with `time = \"robot\"` can be driven neither in real time nor together with one that has \
             `time = \"world\"`: its own time is what counts",
        ),
        _ => None,
    };
    if let Some(text) = refused {
        return Err(SetupError::Cell(text.to_owned()));
    }
    if let Some(robot_clock) = robot_clock {
        *clock = robot_clock;
    }
    Ok(needs_the_world)
}
