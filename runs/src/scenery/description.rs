//! The solids of the links of a URDF.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use arl_robot::cell::Solid;
use arl_robot::kinematics::Frame;
use arl_robot::regular_file;
use nalgebra::{Matrix3, Rotation3, Translation3, UnitQuaternion};
use percent_encoding::percent_decode_str;
use urdf_rs::{Geometry, Link, Material, Pose};

use super::{Looks, Piece};
use crate::urdf::{self, Transform, Tree};

/// A URDF has lengths in m.
const MM: f64 = 1000.0;

/// A URDF file.
pub(super) struct Description {
    pub(super) robot: urdf_rs::Robot,
    file: PathBuf,
    /// The colours of its materials, by their names.
    colors: HashMap<String, [f64; 4]>,
}

/// The looks of a thing that a URDF describes, with its joints at 0, in the frame of its root.
pub(super) fn of_body(file: &Path) -> Result<Looks, String> {
    of_description(&Description::read(file)?)
}

/// The same from a text; paths of meshes start from the folder of `file`.
///
/// # Errors
/// The text is not URDF, or names a mesh that cannot be read.
#[cfg(any(test, feature = "fuzzing"))]
pub fn of_text(text: &str, file: &Path) -> Result<Looks, String> {
    of_description(&Description::of(text, file)?)
}

fn of_description(description: &Description) -> Result<Looks, String> {
    let tree = Tree::of(&description.robot)?;
    description.looks(&tree, &tree.fixed_to(tree.root(), &[]))
}

/// The meshes that a URDF file names, as far as they exist; none if the file is not a URDF.
pub(super) fn meshes(file: &Path) -> Vec<PathBuf> {
    let Ok(description) = Description::read(file) else { return Vec::new() };
    let links = description.robot.links.iter();
    let forms = links.flat_map(|link| {
        let seen = link.visual.iter().map(|visual| &visual.geometry);
        seen.chain(link.collision.iter().map(|collision| &collision.geometry))
    });
    let meshes = forms.filter_map(|form| match form {
        Geometry::Mesh { filename, .. } => description.mesh(filename).ok(),
        _ => None,
    });
    meshes.collect()
}

impl Description {
    pub(super) fn read(file: &Path) -> Result<Self, String> {
        let text = regular_file::read_text(file).map_err(|error| format!("cannot be read: {error}"))?;
        Self::of(&text, file)
    }

    /// The description in a text; paths of meshes start from the folder of `file`.
    fn of(text: &str, file: &Path) -> Result<Self, String> {
        let robot = urdf::parse(text)?;
        let color = |material: &Material| Some((material.name.clone(), material.color.as_ref()?.rgba.0));
        // Of two materials with one name the first one counts.
        let colors = robot.materials.iter().rev().filter_map(color).collect();
        Ok(Self { robot, file: file.to_owned(), colors })
    }

    /// The looks of these links together, each at its place in a common frame.
    pub(super) fn looks(&self, tree: &Tree<'_>, links: &[(&str, Transform)]) -> Result<Looks, String> {
        let mut looks = Looks::default();
        for (name, place) in links {
            let Some(link) = tree.link(name) else { continue };
            let of_link = self.link(link)?;
            let there = frame(place);
            let moved = |piece: Piece| Piece { at: there * piece.at, ..piece };
            looks.seen.extend(of_link.seen.into_iter().map(moved));
            looks.touched.extend(of_link.touched.into_iter().map(moved));
        }
        Ok(looks)
    }

    /// The looks of a link. What can only be seen can be touched there, too; what cannot be drawn looks as it is
    /// touched.
    fn link(&self, link: &Link) -> Result<Looks, String> {
        let wrong = |problem: String| format!("link `{}`: {problem}", link.name);
        let mut touched = Vec::new();
        for collision in &link.collision {
            touched.extend(self.pieces(&collision.origin, &collision.geometry, None).map_err(wrong)?);
        }
        let mut seen = Vec::new();
        let mut undrawn = None;
        for visual in &link.visual {
            let color = visual.material.as_ref().and_then(|material| self.color(material));
            match self.pieces(&visual.origin, &visual.geometry, color) {
                Ok(pieces) => seen.extend(pieces),
                Err(problem) => undrawn = Some(problem),
            }
        }
        match (undrawn, touched.is_empty()) {
            (Some(problem), true) => return Err(wrong(problem)),
            (Some(_), false) => seen.clone_from(&touched),
            (None, true) => touched.clone_from(&seen),
            (None, false) if seen.is_empty() => seen.clone_from(&touched),
            (None, false) => {}
        }
        Ok(Looks { seen, touched })
    }

    fn pieces(&self, origin: &Pose, geometry: &Geometry, color: Option<[f64; 4]>) -> Result<Vec<Piece>, String> {
        let at = frame(&Transform::of_urdf(origin.xyz.0, origin.rpy.0));
        let one = |at: Frame, solid: Solid| Piece { at, solid, color };
        let has_size = |sizes: &[f64]| {
            let all = sizes.iter().all(|size| *size > 0.0 && size.is_finite());
            all.then_some(()).ok_or_else(|| "it has a form whose size is not finite and above 0".to_owned())
        };
        Ok(match geometry {
            Geometry::Box { size } => {
                has_size(&size.0)?;
                vec![one(at, Solid::Box(size.0.map(|edge| edge * MM)))]
            }
            Geometry::Sphere { radius } => {
                has_size(&[*radius])?;
                vec![one(at, Solid::Sphere(radius * MM))]
            }
            Geometry::Cylinder { radius, length } => {
                has_size(&[*radius, *length])?;
                vec![one(at, Solid::Cylinder { radius: radius * MM, length: length * MM })]
            }
            Geometry::Capsule { radius, length } => {
                has_size(&[*radius, *length])?;
                let end = |side: f64| at * Frame::translation(0.0, 0.0, 0.5 * side * length * MM);
                let ball = |side: f64| one(end(side), Solid::Sphere(radius * MM));
                vec![one(at, Solid::Cylinder { radius: radius * MM, length: length * MM }), ball(1.0), ball(-1.0)]
            }
            Geometry::Mesh { filename, scale } => {
                let scale = scale.map_or([1.0; 3], |scale| scale.0);
                if scale.iter().any(|scale| !scale.is_finite() || *scale == 0.0) {
                    return Err("it has a mesh whose `scale` is 0 or not finite".to_owned());
                }
                let file = self.mesh(filename)?;
                vec![one(at, Solid::Mesh { file, scale: scale.map(|scale| scale * MM) })]
            }
        })
    }

    /// The file of a mesh; only STL files can be read.
    fn mesh(&self, name: &str) -> Result<PathBuf, String> {
        let is_stl = Path::new(name).extension().is_some_and(|end| end.eq_ignore_ascii_case("stl"));
        if !is_stl {
            return Err(format!("the mesh `{name}` is not an STL file: other formats cannot be read"));
        }
        let folder = self.file.parent().unwrap_or(Path::new(""));
        let Some(in_package) = name.strip_prefix("package://").or_else(|| name.strip_prefix("model://")) else {
            let path = name.strip_prefix("file://").map(|address| address.strip_prefix("localhost").unwrap_or(address));
            let path = path.map(|path| percent_decode_str(path).decode_utf8_lossy().into_owned());
            let file = folder.join(path.as_deref().unwrap_or(name));
            return if file.is_file() { Ok(file) } else { Err(format!("there is no file {}", file.display())) };
        };
        let (package, path) = in_package.split_once('/').ok_or_else(|| format!("`{name}` names no file"))?;
        let found = packages(folder, package).into_iter().map(|folder| folder.join(path)).find(|file| file.is_file());
        found.ok_or_else(|| {
            format!("`{name}` is not found: no folder `{package}` above this file, in ROS_PACKAGE_PATH or in AMENT_PREFIX_PATH has it")
        })
    }

    fn color(&self, material: &Material) -> Option<[f64; 4]> {
        let named = || self.colors.get(&material.name).copied();
        material.color.as_ref().map(|color| color.rgba.0).or_else(named)
    }
}

/// Where a ROS package may be: a folder above, one beside those, or where ROS looks.
fn packages(folder: &Path, package: &str) -> Vec<PathBuf> {
    let folder = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
    let of = |variable: &str| {
        let all = std::env::var_os(variable).unwrap_or_default();
        std::env::split_paths(&all).filter(|path| !path.as_os_str().is_empty()).collect::<Vec<_>>()
    };
    let above = folder.ancestors().map(Path::to_owned).chain(of("ROS_PACKAGE_PATH"));
    let mut all: Vec<PathBuf> = Vec::new();
    for path in above {
        if path.file_name().is_some_and(|name| name == package) {
            all.push(path.clone());
        }
        all.push(path.join(package));
    }
    all.extend(of("AMENT_PREFIX_PATH").into_iter().map(|prefix| prefix.join("share").join(package)));
    all
}

/// A place of a URDF as a frame in mm.
pub(super) fn frame(place: &Transform) -> Frame {
    let [x, y, z] = place.at.map(|value| value * MM);
    let [first, second, third] = place.turn;
    let rows = [first, second, third].concat();
    let turned = Rotation3::from_matrix_unchecked(Matrix3::from_row_slice(&rows));
    Frame::from_parts(Translation3::new(x, y, z), UnitQuaternion::from_rotation_matrix(&turned))
}
