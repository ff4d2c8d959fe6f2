//! Triangles of STL files.

use std::io::{BufReader, Cursor};
use std::path::Path;

use arl_robot::regular_file;
use parry3d_f64::math::Vector;
use parry3d_f64::shape::TriMesh;

/// A mesh, and how far its corners are from its origin at most, in mm.
pub(super) fn load(file: &Path) -> Result<(TriMesh, f64), String> {
    let cannot = |why: String| format!("cannot read {}: {why}", file.display());
    let bytes = regular_file::read(file).map_err(|error| cannot(error.to_string()))?;
    let read = stl_io::read_stl(&mut BufReader::new(Cursor::new(bytes)));
    let stl = read.map_err(|error| cannot(format!("it is no STL file ({error})")))?;
    let corner = |corner: &stl_io::Vertex| {
        let [x, y, z]: [f32; 3] = (*corner).into();
        Vector::new(f64::from(x), f64::from(y), f64::from(z))
    };
    let corners: Vec<Vector> = stl.vertices.iter().map(corner).collect();
    if corners.iter().any(|corner| !corner.is_finite()) {
        return Err(cannot("it has corners that are no numbers".into()));
    }
    let triangles: Option<Vec<[u32; 3]>> = stl
        .faces
        .iter()
        .map(|face| {
            let [a, b, c] = face.vertices.map(|corner| u32::try_from(corner).ok());
            Some([a?, b?, c?])
        })
        .collect();
    let triangles = triangles.filter(|all| !all.is_empty()).ok_or_else(|| cannot("it has no triangles".into()))?;
    let farthest = corners.iter().map(|corner| corner.length()).fold(0.0, f64::max);
    let mesh = TriMesh::new(corners, triangles).map_err(|error| cannot(error.to_string()))?;
    Ok((mesh, farthest))
}
