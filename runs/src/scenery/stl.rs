//! Triangles of STL files, as text or as bytes.
//!
//! Text files vary: solids without a name or without an end, capitals, blanks and a byte order mark at the start, names
//! in any encoding, line ends of CR, normals that are not numbers. All of it is read, every solid of the file. Normals
//! add nothing to the corners, and are skipped.

mod text;

use std::collections::HashMap;

/// The sizes of what is before the count of triangles, of the count, and of a triangle: a normal, three corners, two
/// bytes for free use.
const HEADER: usize = 80;
const COUNT: usize = 4;
const TRIANGLE: usize = 50;
/// Where the corners of a triangle begin, and how long one is.
const CORNERS: usize = 12;
const CORNER: usize = 12;

/// The corners of a triangle, finite.
type Corners = [[f32; 3]; 3];

/// Triangles by the indices of their corners, in the file's own unit. Equal corners are stored once.
#[derive(Default, Debug)]
pub struct Triangles {
    /// The corners, each once.
    pub corners: Vec<[f32; 3]>,
    /// Three corners each.
    pub triangles: Vec<[u32; 3]>,
    numbers: HashMap<[u32; 3], u32>,
}

/// The triangles of an STL file; there is at least one.
///
/// # Errors
/// It is not an STL file: the reason, with the line if it is text.
pub fn read(bytes: &[u8]) -> Result<Triangles, String> {
    let mut all = Triangles::default();
    each(bytes, |corners| all.add(corners))?;
    Ok(all)
}

/// The same triangles in the form that every viewer reads: as bytes, with nothing after them and a header that is not
/// taken for text. A file that has this form already otherwise stays as it is: it may contain colours.
///
/// # Errors
/// As for [`read`].
pub fn for_viewers(mut bytes: Vec<u8>) -> Result<Vec<u8>, String> {
    if text::is_text(&bytes) {
        return written_anew(&bytes);
    }
    let count = each(&bytes, |_| Ok(()))?;
    bytes.truncate(HEADER + COUNT + TRIANGLE * count);
    if text::begins(&bytes) {
        bytes.iter_mut().take(HEADER).for_each(|byte| *byte = 0);
    }
    Ok(bytes)
}

/// The triangles as bytes, without normals: readers compute these.
fn written_anew(bytes: &[u8]) -> Result<Vec<u8>, String> {
    let mut out = vec![0; HEADER + COUNT];
    let count = each(bytes, |corners| {
        out.extend([0; CORNERS]);
        corners.as_flattened().iter().for_each(|value| out.extend(value.to_le_bytes()));
        out.extend([0; 2]);
        Ok(())
    })?;
    let count = u32::try_from(count).map_err(|_| "it has too many triangles".to_owned())?;
    out.iter_mut().skip(HEADER).zip(count.to_le_bytes()).for_each(|(place, byte)| *place = byte);
    Ok(out)
}

/// Passes on the triangles of an STL file one by one; returns how many there are, at least one.
fn each(bytes: &[u8], mut take: impl FnMut(Corners) -> Result<(), String>) -> Result<usize, String> {
    let mut count = 0;
    let counted = |corners: Corners| {
        count += 1;
        take(corners)
    };
    let shown = if text::is_text(bytes) { text::each(bytes, counted) } else { each_of_bytes(bytes, counted) };
    shown?;
    if count == 0 { Err("it has no triangles".to_owned()) } else { Ok(count) }
}

/// Passes on triangles that are bytes, little endian.
fn each_of_bytes(bytes: &[u8], mut take: impl FnMut(Corners) -> Result<(), String>) -> Result<(), String> {
    let body = bytes.get(HEADER..).and_then(<[u8]>::split_first_chunk::<COUNT>);
    let Some((count, body)) = body else {
        return Err(format!(
            "it is not an STL file: text would begin with `solid`, and {} bytes are too few for the binary form",
            bytes.len()
        ));
    };
    let count = u32::from_le_bytes(*count) as usize;
    let is_there = body.len() / TRIANGLE;
    if is_there < count {
        return Err(format!("it is cut off: it announces {count} triangles, but has {is_there}"));
    }
    for (number, triangle) in (1..).zip(body.chunks_exact(TRIANGLE).take(count)) {
        let corners = triangle.get(CORNERS..CORNERS + 3 * CORNER).unwrap_or_default();
        let mut found = corners.chunks_exact(CORNER).map(|corner| {
            let mut values =
                corner.chunks_exact(4).filter_map(<[u8]>::first_chunk).map(|value| f32::from_le_bytes(*value));
            [(); 3].map(|()| values.next().unwrap_or(f32::NAN))
        });
        let corners = [(); 3].map(|()| found.next().unwrap_or([f32::NAN; 3]));
        if corners.as_flattened().iter().any(|value| !value.is_finite()) {
            return Err(format!("a corner of triangle {number} is not a finite position: {}", written(&corners)));
        }
        take(corners)?;
    }
    Ok(())
}

/// Corners as shown in a message.
fn written(corners: &Corners) -> String {
    let one = |corner: &[f32; 3]| corner.map(|value| value.to_string()).join(" ");
    corners.iter().map(one).collect::<Vec<_>>().join(", ")
}

impl Triangles {
    /// Adds a triangle.
    fn add(&mut self, corners: Corners) -> Result<(), String> {
        let mut triangle = [0; 3];
        for (place, corner) in triangle.iter_mut().zip(corners) {
            let next = u32::try_from(self.corners.len()).map_err(|_| "it has too many corners".to_owned())?;
            // 0 and -0 are equal, and their bits only once 0 was added.
            let bits = corner.map(|value| (value + 0.0).to_bits());
            *place = *self.numbers.entry(bits).or_insert(next);
            if *place == next {
                self.corners.push(corner);
            }
        }
        self.triangles.push(triangle);
        Ok(())
    }
}

#[cfg(test)]
mod tests;
