//! Weaves as requested.

use nalgebra::Vector3;

/// The figure of a weave.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum WeaveShape {
    /// From side to side: evenly swinging or, with dwells, straight with dwells at the sides and in the middle.
    Simple,
    /// Up the two sides of a V and back.
    VShape,
    /// Up one side of a V, across, and down the other.
    Triangle,
    /// Around an ellipse, with `radius` as half its length along the path and `amplitude` as half its width.
    Ellipse,
    /// Along a figure of eight across the path, with loops of `radius` to each side along the path.
    Eight,
}

/// A weave: a figure that is laid over the paths of the TCP repeatedly.
///
/// Its frame has x along the path, y to the left, and z away from where the tool points.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Weave {
    /// The figure.
    pub shape: WeaveShape,
    /// Figures per s, not counting dwells; above 0.
    pub frequency: f64,
    /// The largest distance from the path in mm, 0 or more.
    pub amplitude: f64,
    /// Dwells at the left side, at the right side, and in the middle each time that it is passed, in s, 0 or more.
    pub dwells: [f64; 3],
    /// The angle between the sides of the V and of the triangle, in deg, 0 to 180.
    pub angle: f64,
    /// Half the length of the ellipse and of the eight along the path, in mm, 0 or more.
    pub radius: f64,
    /// The rotation of the figure about an axis of its frame, as a rotation vector in rad.
    pub turned: Vector3<f64>,
}

impl Weave {
    /// The time of a figure including its dwells, in s.
    pub fn period(&self) -> f64 {
        let [left, right, middle] = self.dwells;
        let stays = match self.shape {
            WeaveShape::Simple | WeaveShape::VShape => left + right + 2.0 * middle,
            WeaveShape::Triangle => left + right + middle,
            WeaveShape::Ellipse | WeaveShape::Eight => 0.0,
        };
        1.0 / self.frequency + stays
    }

    /// Whether it has corners, which have to be rounded.
    pub(crate) fn is_cornered(&self) -> bool {
        match self.shape {
            WeaveShape::Simple => self.dwells.iter().any(|stay| *stay > 0.0),
            WeaveShape::VShape | WeaveShape::Triangle => true,
            WeaveShape::Ellipse | WeaveShape::Eight => false,
        }
    }
}
