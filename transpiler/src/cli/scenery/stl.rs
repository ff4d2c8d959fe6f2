//! Triangles of STL files, as text or as bytes.
//!
//! Text comes in many hands' spelling: solids without a name or without an end, capitals, blanks and a byte order mark before, names in any
//! encoding, line ends of CR, normals that are no numbers. All of it is read, every solid of the file. Normals say nothing that corners do
//! not say, and are passed over.

mod text;

use std::collections::HashMap;

/// What stands before the count of triangles, the count, and a triangle: a normal, three corners, two bytes that are anybody's.
const HEADER: usize = 80;
const COUNT: usize = 4;
const TRIANGLE: usize = 50;
/// Where the corners of a triangle begin, and how long one is.
const CORNERS: usize = 12;
const CORNER: usize = 12;

/// Triangles by the numbers of their corners, in the file's own unit. Corners are finite; equal ones are one.
#[derive(Default, Debug)]
pub(in crate::cli) struct Triangles {
    pub(in crate::cli) corners: Vec<[f32; 3]>,
    pub(in crate::cli) triangles: Vec<[u32; 3]>,
    numbers: HashMap<[u32; 3], u32>,
}

/// The triangles of an STL file; there is at least one.
///
/// # Errors
/// It is none: why, with the line where it is text.
pub(in crate::cli) fn read(bytes: &[u8]) -> Result<Triangles, String> {
    let triangles = if text::is_text(bytes) { text::read(bytes) } else { of_bytes(bytes) }?;
    if triangles.triangles.is_empty() { Err("it has no triangles".to_owned()) } else { Ok(triangles) }
}

/// The same triangles in the form that every viewer reads: as bytes. What is of this form already stays as it is.
///
/// # Errors
/// As for [`read`].
pub(in crate::cli) fn for_viewers(bytes: Vec<u8>) -> Result<Vec<u8>, String> {
    let triangles = read(&bytes)?;
    Ok(if text::is_text(&bytes) { triangles.bytes() } else { bytes })
}

/// Triangles as bytes, little endian.
fn of_bytes(bytes: &[u8]) -> Result<Triangles, String> {
    let body = bytes.get(HEADER..).and_then(<[u8]>::split_first_chunk::<COUNT>);
    let Some((count, body)) = body else {
        return Err(format!(
            "it is no STL file: text would begin with `solid`, and {} bytes are too few for the other form",
            bytes.len()
        ));
    };
    let count = u32::from_le_bytes(*count) as usize;
    let is_there = body.len() / TRIANGLE;
    if is_there < count {
        return Err(format!("it is cut off: it says that it has {count} triangles, and has {is_there}"));
    }
    let mut all = Triangles::default();
    for (number, triangle) in (1..).zip(body.chunks_exact(TRIANGLE).take(count)) {
        let corners = triangle.get(CORNERS..CORNERS + 3 * CORNER).unwrap_or_default();
        let mut found = corners.chunks_exact(CORNER).map(|corner| {
            let mut values =
                corner.chunks_exact(4).filter_map(<[u8]>::first_chunk).map(|value| f32::from_le_bytes(*value));
            [(); 3].map(|()| values.next().unwrap_or(f32::NAN))
        });
        let corners = [(); 3].map(|()| found.next().unwrap_or([f32::NAN; 3]));
        if corners.as_flattened().iter().any(|value| !value.is_finite()) {
            return Err(format!("a corner of triangle {number} is no place: {}", written(&corners)));
        }
        all.add(corners)?;
    }
    Ok(all)
}

/// Corners as a message has them.
fn written(corners: &[[f32; 3]]) -> String {
    let one = |corner: &[f32; 3]| corner.map(|value| value.to_string()).join(" ");
    corners.iter().map(one).collect::<Vec<_>>().join(", ")
}

impl Triangles {
    /// Adds a triangle.
    fn add(&mut self, corners: [[f32; 3]; 3]) -> Result<(), String> {
        let mut triangle = [0; 3];
        for (place, corner) in triangle.iter_mut().zip(corners) {
            let next = u32::try_from(self.corners.len()).map_err(|_| "it has too many corners".to_owned())?;
            *place = *self.numbers.entry(corner.map(f32::to_bits)).or_insert(next);
            if *place == next {
                self.corners.push(corner);
            }
        }
        self.triangles.push(triangle);
        Ok(())
    }

    /// As bytes, without normals: who reads them computes these.
    fn bytes(&self) -> Vec<u8> {
        let mut out = vec![0; HEADER];
        out.extend((self.triangles.len() as u32).to_le_bytes());
        for triangle in &self.triangles {
            out.extend([0; CORNERS]);
            for corner in triangle {
                let corner = self.corners.get(*corner as usize).copied().unwrap_or_default();
                corner.iter().for_each(|value| out.extend(value.to_le_bytes()));
            }
            out.extend([0; 2]);
        }
        out
    }
}

#[cfg(test)]
mod tests;
