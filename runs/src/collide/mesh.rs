//! Triangles of STL files.

use std::path::Path;

use arl_robot::cell::LARGEST_MM;
use arl_robot::regular_file;
use parry3d_f64::math::Vector;
use parry3d_f64::shape::{SharedShape, TriMesh};
use parry3d_f64::transformation::try_convex_hull;

use crate::scenery::stl;

/// Triangles by the indices of their corners, which are in mm.
pub(super) struct Mesh {
    corners: Vec<Vector>,
    triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// Reads an STL file whose unit is `scale` mm along x, y and z.
    pub(super) fn load(file: &Path, scale: [f64; 3]) -> Result<Self, String> {
        let cannot = |why: &str| cannot(file, why);
        let bytes = regular_file::read(file).map_err(|error| cannot(&error.to_string()))?;
        let stl = stl::read(&bytes).map_err(|why| cannot(&why))?;
        let corner = |corner: &[f32; 3]| Vector::from_array(corner.map(f64::from)) * Vector::from_array(scale);
        let corners: Vec<Vector> = stl.corners.iter().map(corner).collect();
        let is_far = |corner: &&Vector| corner.is_nan() || corner.abs().max_element() > LARGEST_MM;
        if let Some(far) = corners.iter().find(is_far) {
            let why = format!("a corner is at {far} mm; the limit is {LARGEST_MM} mm: is its `scale` right?");
            return Err(cannot(&why));
        }
        Ok(Self { corners, triangles: stl.triangles })
    }

    /// The greatest distance of its corners from its origin, in mm.
    pub(super) fn farthest(&self) -> f64 {
        self.corners.iter().map(|corner| corner.length()).fold(0.0, f64::max)
    }

    /// Its surface.
    pub(super) fn surface(self, file: &Path) -> Result<SharedShape, String> {
        let mesh = TriMesh::new(self.corners, self.triangles).map_err(|error| cannot(file, &error.to_string()))?;
        Ok(SharedShape::new(mesh))
    }

    /// Its convex hull; its surface if it is flat.
    pub(super) fn hull(self, file: &Path) -> Result<SharedShape, String> {
        let hull = try_convex_hull(&self.corners).ok();
        let hull = hull.and_then(|(corners, triangles)| SharedShape::convex_mesh(corners, &triangles));
        hull.map_or_else(|| self.surface(file), Ok)
    }
}

fn cannot(file: &Path, why: &str) -> String {
    format!("cannot read {}: {why}", file.display())
}
