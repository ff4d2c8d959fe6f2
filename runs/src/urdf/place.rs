//! Places and rotations: the little geometry that the import needs.

/// A vector, m.
pub(super) type Vector = [f64; 3];

/// A rotation (rows of its matrix) and a translation in m.
#[derive(Clone, Copy, Debug)]
pub struct Transform {
    /// The rows of its matrix.
    pub turn: [Vector; 3],
    /// Its origin, in m.
    pub at: Vector,
}

pub(super) fn dot([a, b, c]: Vector, [x, y, z]: Vector) -> f64 {
    a * x + b * y + c * z
}

pub(super) fn cross([a, b, c]: Vector, [x, y, z]: Vector) -> Vector {
    [b * z - c * y, c * x - a * z, a * y - b * x]
}

/// `a + b * times`
pub(super) fn plus([a, b, c]: Vector, [x, y, z]: Vector, times: f64) -> Vector {
    [a + x * times, b + y * times, c + z * times]
}

pub(super) fn length(v: Vector) -> f64 {
    dot(v, v).sqrt()
}

impl Transform {
    pub(super) const ORIGIN: Transform =
        Transform { turn: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], at: [0.0; 3] };

    /// A rotation by `angle` (rad) about `axis`, a unit vector.
    pub(super) fn about(axis: Vector, angle: f64) -> Self {
        let ([x, y, z], (s, c)) = (axis, libm::sincos(angle));
        let t = 1.0 - c;
        let turn = [
            [t * x * x + c, t * x * y - s * z, t * x * z + s * y],
            [t * x * y + s * z, t * y * y + c, t * y * z - s * x],
            [t * x * z - s * y, t * y * z + s * x, t * z * z + c],
        ];
        Self { turn, at: [0.0; 3] }
    }

    pub(super) fn shift(at: Vector) -> Self {
        Self { at, ..Self::ORIGIN }
    }

    /// The origin of a URDF joint: a place, then roll, pitch and yaw about fixed axes.
    pub fn of_urdf(xyz: Vector, [roll, pitch, yaw]: Vector) -> Self {
        let [x, y, z] = Self::ORIGIN.turn;
        Self::shift(xyz).then(&Self::about(z, yaw)).then(&Self::about(y, pitch)).then(&Self::about(x, roll))
    }

    pub(super) fn turned(&self, v: Vector) -> Vector {
        self.turn.map(|row| dot(row, v))
    }

    pub(super) fn then(&self, next: &Transform) -> Transform {
        let columns = [0, 1, 2].map(|column| self.turned(next.column(column)));
        let [x, y, z] = columns;
        let row = |pick: fn(Vector) -> f64| [pick(x), pick(y), pick(z)];
        Transform {
            turn: [row(|[a, ..]| a), row(|[_, b, _]| b), row(|[.., c]| c)],
            at: plus(self.turned(next.at), self.at, 1.0),
        }
    }

    /// Where the frame's x (0), y (1) or z (2) points.
    pub(super) fn column(&self, column: usize) -> Vector {
        self.turn.map(|row| row.get(column).copied().unwrap_or(0.0))
    }
}
