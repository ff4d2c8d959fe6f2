//! Checks that a cell's settings for a robot match that robot.

use super::{Homes, Sensitivity};
use crate::robot::Robot;

/// Checks home points and collision conditions against their robot: each must have a value for each axis.
///
/// # Errors
/// Returns the mismatch as a sentence.
pub fn fit(homes: &Homes, collisions: &[(u8, Sensitivity)], robot: &Robot) -> Result<(), String> {
    let (name, axes, own) = (&robot.name, robot.axes.len(), robot.own_axes().len());
    if let Some(home) = homes.points.iter().flatten().find(|home| home.len() != axes) {
        let found = home.len();
        return Err(format!("a home point of the cell has {found} positions; robot {name} has {axes} axes"));
    }
    for (cid, sensitivity) in collisions {
        if let Sensitivity::Torques(torques) = sensitivity
            && torques.len() != own
        {
            let found = torques.len();
            return Err(format!(
                "collision condition {cid} of the cell has {found} torques; robot {name} has {own} axes"
            ));
        }
    }
    Ok(())
}
