//! Whether what a cell says of a robot is for that robot.

use super::{Homes, Sensitivity};
use crate::robot::Robot;

/// Holds home points and conditions of collisions against their robot: each has a value for each axis.
///
/// # Errors
/// What does not fit, in a sentence.
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
