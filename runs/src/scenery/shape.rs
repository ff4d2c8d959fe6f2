//! The shape of a robot from its URDF.

use std::path::Path;

use arl_robot::robot::Robot;

use super::description::Description;
use super::fit::{fit, made_of};
use super::{Looks, Piece};
use crate::urdf::{self, Chain, Tree};

/// A robot's links, the base first.
#[derive(Clone, PartialEq, Debug)]
pub struct Shape {
    links: Vec<Looks>,
}

impl Shape {
    /// Reads the shape of a robot from its URDF file.
    ///
    /// # Errors
    /// The file cannot be read, has forms that cannot be read, or is of another robot.
    pub(super) fn read(file: &Path, robot: &Robot) -> Result<Self, String> {
        let description = Description::read(file)?;
        let tree = Tree::of(&description.robot)?;
        let chain = Chain::of(&tree)?;
        let axes = robot.own_axes().len();
        if chain.joints.len() != axes {
            return Err(format!(
                "its arm has {} moving joints, but {} has {axes} axes",
                chain.joints.len(),
                robot.name
            ));
        }
        let order = urdf::order(&chain)?;
        let fitted = fit(&chain, robot, &order)?;
        let moving: Vec<&str> = chain.joints.iter().map(|joint| joint.name.as_str()).collect();
        let mut links = vec![Looks::default(); axes + 1];
        let children = chain.joints.iter().filter_map(|joint| Some(tree.link(&joint.child)?.name.as_str()));
        let roots = std::iter::once(tree.root()).chain(children);
        for (root, fitted) in roots.zip(fitted) {
            let looks = description.looks(&tree, &tree.fixed_to(root, &moving))?;
            if looks == Looks::default() {
                continue;
            }
            let wrong =
                || format!("its link `{root}` does not move like any link of {}; {}", robot.name, made_of(robot));
            let (link, there) = fitted.ok_or_else(wrong)?;
            let moved = |piece: Piece| Piece { at: there * piece.at, ..piece };
            if let Some(of_link) = links.get_mut(link) {
                of_link.seen.extend(looks.seen.into_iter().map(moved));
                of_link.touched.extend(looks.touched.into_iter().map(moved));
            }
        }
        if links.iter().all(|link| link.touched.is_empty()) {
            return Err("none of its links has a form".to_owned());
        }
        Ok(Self { links })
    }

    /// The looks of each link in its frame, the base first.
    pub fn links(&self) -> impl Iterator<Item = (usize, &Looks)> {
        self.links.iter().enumerate()
    }
}
