//! Leaves out points that make no visible difference.

/// How far a line may be from the points that it replaces, in px.
const TOLERANCE: f64 = 0.15;

/// Takes points one by one and keeps those that a line through them needs. `None` among the kept ones lifts the pen.
#[derive(Clone, Debug, Default)]
pub(super) struct Line {
    kept: Vec<Option<[f64; 2]>>,
    /// The last point that was kept.
    anchor: Option<[f64; 2]>,
    /// The last point that came, if it was not kept.
    last: Option<[f64; 2]>,
    /// The first direction from the anchor, and how far to both sides of it the line may go, in rad.
    cone: Option<(f64, f64, f64)>,
    /// How far the last point was from the anchor.
    reach: f64,
}

impl Line {
    /// Adds the next point, in px.
    pub(super) fn push(&mut self, point: [f64; 2]) {
        let Some(anchor) = self.anchor else {
            self.keep(point);
            return;
        };
        let [dx, dy] = [point[0] - anchor[0], point[1] - anchor[1]];
        let distance = libm::hypot(dx, dy);
        if distance <= TOLERANCE && self.cone.is_none() {
            self.last = Some(point);
            return;
        }
        let direction = libm::atan2(dy, dx);
        let half = libm::asin(TOLERANCE / distance.max(TOLERANCE));
        let (first, low, high) = self.cone.unwrap_or((direction, -half, half));
        let off = wrapped(direction - first);
        // Turning back towards the anchor is another line: the turning point must stay.
        if off < low || off > high || distance < self.reach - TOLERANCE {
            let corner = self.last.unwrap_or(anchor);
            self.keep(corner);
            self.push(point);
            return;
        }
        self.cone = Some((first, low.max(off - half), high.min(off + half)));
        self.reach = self.reach.max(distance);
        self.last = Some(point);
    }

    fn keep(&mut self, point: [f64; 2]) {
        self.kept.push(Some(point));
        *self = Self { kept: std::mem::take(&mut self.kept), anchor: Some(point), ..Self::default() };
    }

    /// Whether the pen is down.
    pub(super) fn is_down(&self) -> bool {
        self.anchor.is_some()
    }

    /// Lifts the pen.
    pub(super) fn lift(&mut self) {
        if let Some(last) = self.last.take() {
            self.kept.push(Some(last));
        }
        if self.anchor.is_some() {
            self.kept.push(None);
        }
        *self = Self { kept: std::mem::take(&mut self.kept), ..Self::default() };
    }

    /// The points that are needed.
    pub(super) fn finish(mut self) -> Vec<Option<[f64; 2]>> {
        self.lift();
        self.kept
    }
}

fn wrapped(angle: f64) -> f64 {
    angle - std::f64::consts::TAU * (angle / std::f64::consts::TAU).round()
}

/// A line over time: of all values in one column of pixels, the lowest and the highest are drawn.
#[derive(Clone, Debug, Default)]
pub(super) struct OverTime {
    line: Line,
    column: Option<Column>,
}

#[derive(Clone, Copy, Debug)]
struct Column {
    number: i64,
    low: [f64; 2],
    high: [f64; 2],
    last: [f64; 2],
}

impl OverTime {
    /// Adds the next point, in px; x never decreases.
    pub(super) fn push(&mut self, point: [f64; 2]) {
        let number = point[0].floor() as i64;
        match &mut self.column {
            Some(column) if column.number == number => {
                column.low = if point[1] < column.low[1] { point } else { column.low };
                column.high = if point[1] > column.high[1] { point } else { column.high };
                column.last = point;
            }
            _ => {
                self.end_column();
                self.column = Some(Column { number, low: point, high: point, last: point });
            }
        }
    }

    fn end_column(&mut self) {
        let Some(Column { low, high, last, .. }) = self.column.take() else { return };
        let [first, second] = if low[0] <= high[0] { [low, high] } else { [high, low] };
        self.line.push(first);
        self.line.push(second);
        self.line.push(last);
    }

    /// Lifts the pen.
    pub(super) fn lift(&mut self) {
        self.end_column();
        self.line.lift();
    }

    /// The points that are needed.
    pub(super) fn finish(mut self) -> Vec<Option<[f64; 2]>> {
        self.end_column();
        self.line.finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn thinned(points: impl IntoIterator<Item = [f64; 2]>) -> Vec<[f64; 2]> {
        let mut line = Line::default();
        points.into_iter().for_each(|point| line.push(point));
        line.finish().into_iter().flatten().collect()
    }

    #[test]
    fn straight_lines_need_their_ends_only() {
        let there = (0..=1000).map(|at| [f64::from(at) * 0.1, f64::from(at) * 0.05]);
        assert_eq!(thinned(there.clone()), [[0.0, 0.0], [100.0, 50.0]]);
        // The path back is a line of its own.
        let back = (0..1000).rev().map(|at| [f64::from(at) * 0.1, f64::from(at) * 0.05]);
        let both = thinned(there.chain(back));
        assert_eq!(both.first().zip(both.last()), Some((&[0.0, 0.0], &[0.0, 0.0])));
        assert!(both.len() <= 5 && both.iter().any(|[x, _]| *x > 100.0 - TOLERANCE), "{both:?}");
    }

    #[test]
    fn curves_stay_where_they_are() {
        let circle = |at: f64| [100.0 * at.cos(), 100.0 * at.sin()];
        let points: Vec<[f64; 2]> = (0..=6000).map(|at| circle(f64::from(at) * 1e-3)).collect();
        let kept = thinned(points.iter().copied());
        assert!(kept.len() < 200 && kept.len() > 20, "{}", kept.len());
        for point in points {
            let near = kept.windows(2).map(|pair| distance(point, pair[0], pair[1])).fold(f64::INFINITY, f64::min);
            assert!(near < 2.5 * TOLERANCE, "{point:?} {near}");
        }
    }

    fn distance(point: [f64; 2], from: [f64; 2], to: [f64; 2]) -> f64 {
        let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
        let along = ((point[0] - from[0]) * dx + (point[1] - from[1]) * dy) / (dx * dx + dy * dy);
        let along = along.clamp(0.0, 1.0);
        (from[0] + along * dx - point[0]).hypot(from[1] + along * dy - point[1])
    }

    #[test]
    fn peaks_in_a_column_stay() {
        let mut line = OverTime::default();
        for at in 0..100_000 {
            line.push([f64::from(at) * 1e-3, if at == 50_500 { -40.0 } else { 0.0 }]);
        }
        let kept: Vec<[f64; 2]> = line.finish().into_iter().flatten().collect();
        assert!(kept.len() < 20 && kept.iter().any(|point| point[1] == -40.0), "{kept:?}");
    }
}
