//! What is in a cell or is carried, and the shapes of its robots: what viewers draw, and what robots can touch.

mod description;
mod fit;
mod shape;
pub mod stl;
#[cfg(test)]
pub(crate) mod tests;

use arl_robot::cell::{Body, Carrier, Cell, Form, Solid, Stands};
use arl_robot::kinematics::Frame;
use arl_robot::robot::Robot;
use std::path::{Path, PathBuf};

use arl_terminal::failure::Failure;
#[cfg(any(test, feature = "fuzzing"))]
pub use description::of_text;
pub use shape::Shape;

/// The bodies of a cell and the shapes of its robots.
#[derive(Clone, Default, Debug)]
pub struct Scenery {
    /// The bodies of the cell, and how they look.
    pub bodies: Vec<(Body, Looks)>,
    /// The carriers, which take bodies along.
    pub carriers: Vec<Carrier>,
    /// The shapes of the robots by channels; `None`: capsules along the robot's links.
    shapes: Vec<Option<Shape>>,
    /// Whether the cell says where the robots stand, by channels.
    placed: Vec<bool>,
}

/// The looks of something, and what of it can be touched.
#[derive(Clone, Default, PartialEq, Debug)]
pub struct Looks {
    /// What viewers draw.
    pub seen: Vec<Piece>,
    /// What can be touched.
    pub touched: Vec<Piece>,
}

/// A solid in the frame of its owner.
#[derive(Clone, PartialEq, Debug)]
pub struct Piece {
    /// Its frame, in mm.
    pub at: Frame,
    /// Its form.
    pub solid: Solid,
    /// Red, green, blue and opacity, from 0 to 1, if given.
    pub color: Option<[f64; 4]>,
}

impl Scenery {
    /// The scenery of a cell whose channels have these robots, in the order of the channels. A robot whose shape cannot
    /// be read has capsules, which is reported to `tell`.
    ///
    /// # Errors
    /// A URDF file of a body cannot be read, or a robot does not have the axis of a carrier.
    pub fn of(cell: &Cell, robots: &[Robot], tell: &dyn Fn(&str)) -> Result<Self, Failure> {
        let looks = |body: &Body| match &body.form {
            Form::Solid(solid) => Ok((body.clone(), Looks::of(solid))),
            Form::Urdf(file) => {
                let wrong = |problem| Failure::Usage(format!("body `{}`: {}: {problem}", body.name, file.display()));
                description::of_body(file).map(|looks| (body.clone(), looks)).map_err(wrong)
            }
        };
        let bodies = cell.bodies.iter().map(looks).collect::<Result<_, Failure>>()?;
        let others = cell.programs.channels.iter().filter(|channel| !channel.background).map(|channel| &channel.stands);
        let all: Vec<_> = robots.iter().zip(std::iter::once(&cell.stands).chain(others)).collect();
        for carrier in &cell.carriers {
            let Some((robot, _)) = all.get(carrier.channel as usize - 1) else { continue };
            has_axis(robot, carrier)?;
        }
        let shapes = all.iter().map(|(robot, stands)| shape_of(robot, stands, tell)).collect::<Result<_, Failure>>()?;
        let placed = all.iter().map(|(_, stands)| stands.base.is_some()).collect();
        Ok(Self { bodies, carriers: cell.carriers.clone(), shapes, placed })
    }

    /// The shape of the robot of a channel, from 0.
    pub fn shape(&self, channel: usize) -> Option<&Shape> {
        self.shapes.get(channel)?.as_ref()
    }

    /// Whether the cell says where the robot of a channel, from 0, stands.
    pub fn is_placed(&self, channel: usize) -> bool {
        self.placed.get(channel) == Some(&true)
    }
}

/// The files that a cell names for the looks of its robots and bodies.
pub fn named(cell: &Cell) -> impl Iterator<Item = &Path> {
    let bodies = cell.bodies.iter().filter_map(|body| match &body.form {
        Form::Urdf(file) | Form::Solid(Solid::Mesh { file, .. }) => Some(file.as_path()),
        Form::Solid(_) => None,
    });
    let others = cell.programs.channels.iter().map(|channel| &channel.stands);
    let robots = std::iter::once(&cell.stands).chain(others).filter_map(|stands| stands.urdf.as_deref());
    bodies.chain(robots)
}

/// The same with the meshes that these files name, as far as they can be found. An invalid file is reported where it is
/// used.
pub fn files(cell: &Cell) -> impl Iterator<Item = PathBuf> {
    named(cell).flat_map(|file| std::iter::once(file.to_owned()).chain(description::meshes(file)))
}

/// Checks that a robot has the axis of a carrier.
fn has_axis(robot: &Robot, Carrier { axis, channel, .. }: &Carrier) -> Result<(), Failure> {
    if robot.external_axes().iter().any(|external| external.name == *axis) {
        return Ok(());
    }
    let known: Vec<&str> = robot.external_axes().iter().map(|external| &*external.name).collect();
    let has = if known.is_empty() { "no external axes".to_owned() } else { format!("only {}", known.join(", ")) };
    let text = format!(
        "the cell has a [[carrier]] for the axis `{axis}`, but the robot {} of channel {channel} has {has}",
        robot.name
    );
    Err(Failure::Usage(text))
}

fn shape_of(robot: &Robot, stands: &Stands, tell: &dyn Fn(&str)) -> Result<Option<Shape>, Failure> {
    let Some(file) = &stands.urdf else { return Ok(None) };
    let shape = Shape::read(file, robot);
    let tell = |problem| tell(&format!("{}: {problem}; capsules are used for the robot instead", file.display()));
    Ok(shape.map_err(tell).ok())
}

impl Looks {
    /// One solid.
    fn of(solid: &Solid) -> Self {
        let piece = Piece { at: Frame::identity(), solid: solid.clone(), color: None };
        Self { seen: vec![piece.clone()], touched: vec![piece] }
    }
}
