//! Triangles of STL files.

use std::io::{BufReader, Cursor};
use std::path::Path;

use arl_robot::regular_file;
use parry3d_f64::math::Vector;
use parry3d_f64::shape::{SharedShape, TriMesh};
use parry3d_f64::transformation::try_convex_hull;

/// Triangles by the numbers of their corners, which are in mm.
pub(super) struct Mesh {
    corners: Vec<Vector>,
    triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// That of an STL file whose unit is so many mm along x, y and z.
    pub(super) fn load(file: &Path, scale: [f64; 3]) -> Result<Self, String> {
        let cannot = |why: &str| cannot(file, why);
        let bytes = regular_file::read(file).map_err(|error| cannot(&error.to_string()))?;
        let read = stl_io::read_stl(&mut BufReader::new(Cursor::new(bytes)));
        let stl = read.map_err(|error| cannot(&format!("it is no STL file ({error})")))?;
        let corner = |corner: &stl_io::Vertex| {
            let [x, y, z]: [f32; 3] = (*corner).into();
            Vector::new(f64::from(x), f64::from(y), f64::from(z)) * Vector::from_array(scale)
        };
        let corners: Vec<Vector> = stl.vertices.iter().map(corner).collect();
        if corners.iter().any(|corner| !corner.is_finite()) {
            return Err(cannot("it has corners that are no numbers"));
        }
        let triangles: Option<Vec<[u32; 3]>> = stl
            .faces
            .iter()
            .map(|face| {
                let [a, b, c] = face.vertices.map(|corner| u32::try_from(corner).ok());
                Some([a?, b?, c?])
            })
            .collect();
        let triangles = triangles.filter(|all| !all.is_empty()).ok_or_else(|| cannot("it has no triangles"))?;
        Ok(Self { corners, triangles })
    }

    /// How far its corners are from its origin at most, in mm.
    pub(super) fn farthest(&self) -> f64 {
        self.corners.iter().map(|corner| corner.length()).fold(0.0, f64::max)
    }

    /// Its surface.
    pub(super) fn surface(self, file: &Path) -> Result<SharedShape, String> {
        let mesh = TriMesh::new(self.corners, self.triangles).map_err(|error| cannot(file, &error.to_string()))?;
        Ok(SharedShape::new(mesh))
    }

    /// Its convex hull; of what is flat, its surface.
    pub(super) fn hull(self, file: &Path) -> Result<SharedShape, String> {
        let hull = try_convex_hull(&self.corners).ok();
        let hull = hull.and_then(|(corners, triangles)| SharedShape::convex_mesh(corners, &triangles));
        hull.map_or_else(|| self.surface(file), Ok)
    }
}

fn cannot(file: &Path, why: &str) -> String {
    format!("cannot read {}: {why}", file.display())
}
