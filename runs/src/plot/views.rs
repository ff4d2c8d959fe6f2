//! The path of the TCP from the top, the front and the side, all at one scale.

use super::outline::{Outline, colour};
use super::scale::{Scale, label, step, ticks};
use super::svg::{Anchor, Area, Picture};
use super::thin::Line;
use super::trace::{ProgramLine, RobotMotion};
use std::collections::{BTreeMap, HashSet};

/// The names of the world's axes.
const NAMES: [&str; 3] = ["x", "y", "z"];

/// The views: title, and which component of a place goes to the right and which upwards. The front is seen against x.
const VIEWS: [(&str, usize, usize); 3] = [("Top", 0, 1), ("Front (against x)", 1, 2), ("Side (along y)", 0, 2)];

/// The least extent of a view, mm.
const LEAST: f64 = 10.0;

/// Of more lines than this, neighbours are drawn as one: they could not be told apart, and each is an element of the
/// picture.
const MOST_PATHS: usize = 1000;

/// One view.
struct View {
    title: &'static str,
    right: usize,
    up: usize,
    area: Area,
    ranges: [[f64; 2]; 2],
    across: Scale,
    upward: Scale,
    /// How many lines are drawn as one.
    together: usize,
    /// The path so far, by line of the program: the first of those that are drawn as one.
    paths: BTreeMap<ProgramLine, Line>,
    current: Option<ProgramLine>,
    last: Option<[f64; 2]>,
    /// Pieces of path that are already drawn: a loop of the program draws its path once.
    drawn: HashSet<(ProgramLine, [i32; 4])>,
    /// Where the lines' numbers may be placed: line and place.
    marks: Vec<(ProgramLine, [f64; 2])>,
}

/// The three views.
pub(super) struct Views {
    views: Vec<View>,
    step: f64,
}

impl Views {
    /// Lays the views out side by side, `gap` px apart.
    pub(super) fn new(outline: &Outline, whole: &Area, gap: f64) -> Self {
        let width = (whole.width - 2.0 * gap) / 3.0;
        let extent = |at: usize| outline.space.get(at).map_or(LEAST, |[low, high]| (high - low).max(LEAST));
        // mm for one px; the path leaves a margin.
        let scale = VIEWS.iter().map(|(_, right, up)| (extent(*right) / width).max(extent(*up) / whole.height));
        let scale = scale.fold(0.0, f64::max) * 1.16;
        let views = VIEWS.iter().enumerate().map(|(at, (title, right, up))| {
            let area = Area { x: whole.x + at as f64 * (width + gap), width, ..*whole };
            let range = |component: usize, pixels: f64| {
                let middle = outline.space.get(component).map_or(0.0, |[low, high]| f64::midpoint(*low, *high));
                [middle - scale * pixels / 2.0, middle + scale * pixels / 2.0]
            };
            let ranges = [range(*right, area.width), range(*up, area.height)];
            View {
                title,
                right: *right,
                up: *up,
                area,
                ranges,
                across: Scale::new(ranges[0], area.x, area.right()),
                upward: Scale::new(ranges[1], area.bottom(), area.y),
                together: outline.lines.len().div_ceil(MOST_PATHS).max(1),
                paths: BTreeMap::new(),
                current: None,
                last: None,
                drawn: HashSet::new(),
                marks: Vec::new(),
            }
        });
        Self { views: views.collect(), step: step(scale * width, 5.0) }
    }

    /// Adds the next cycle.
    pub(super) fn push(&mut self, outline: &Outline, moved: &RobotMotion) {
        self.views.iter_mut().for_each(|view| view.push(outline, moved));
    }

    /// Draws the views.
    pub(super) fn draw(self, outline: &Outline, picture: &mut Picture) {
        for view in self.views {
            view.draw(outline, self.step, picture);
        }
    }
}

impl View {
    fn push(&mut self, outline: &Outline, moved: &RobotMotion) {
        let component = |at: usize| moved.row.tcp.get(at).copied().unwrap_or_default();
        let point = [self.across.at(component(self.right)), self.upward.at(component(self.up))];
        let before = self.last.replace(point);
        if moved.row.motion == 0 {
            self.lift();
            return;
        }
        let line = self.drawn_as(outline, moved.row.place);
        if self.current != Some(line) {
            self.lift();
            self.current = Some(line);
        }
        let from = if moved.speed.is_some() { before.unwrap_or(point) } else { point };
        // Quarters of a pixel: what is already drawn there is not drawn again.
        let rounded = |value: f64| (value * 4.0).round() as i32;
        let path = self.paths.entry(line).or_default();
        let [begin, end] = [from, point].map(|[x, y]| [rounded(x), rounded(y)]);
        if begin == end && path.is_down() {
            // Too short to be visible by itself.
            path.push(point);
            return;
        }
        let new = self.drawn.insert((line, [begin[0], begin[1], end[0], end[1]]));
        if !new {
            path.lift();
            return;
        }
        if moved.speed.is_none() {
            path.lift();
        }
        path.push(from);
        path.push(point);
    }

    /// The first of the lines that are drawn as one with this line.
    fn drawn_as(&self, outline: &Outline, line: ProgramLine) -> ProgramLine {
        let first = outline.place(line).and_then(|at| outline.lines.get(at / self.together * self.together));
        first.copied().unwrap_or(line)
    }

    fn lift(&mut self) {
        if let Some(line) = self.current.take()
            && let Some(path) = self.paths.get_mut(&line)
        {
            path.lift();
        }
    }

    fn draw(mut self, outline: &Outline, step: f64, picture: &mut Picture) {
        self.ground(step, picture);
        // Colours repeat after some lines: neighbouring lines differ however many lines are drawn as one.
        for (at, line) in outline.lines.iter().step_by(self.together).enumerate() {
            let Some(path) = self.paths.remove(line) else { continue };
            let points = path.finish();
            picture.path(&points, "way", colour(at));
            if let Some(place) = longest(&points) {
                self.marks.push((*line, place));
            }
        }
        self.numbers(outline, picture);
    }

    fn ground(&self, step: f64, picture: &mut Picture) {
        let Area { x, y, .. } = self.area;
        let (right, bottom) = (self.area.right(), self.area.bottom());
        for value in ticks(self.ranges[0], step) {
            let at = self.across.at(value);
            picture.line([at, y], [at, bottom], if value == 0.0 { "zero" } else { "grid" });
            picture.text([at, bottom + 13.0], Anchor::Middle, "tick", &label(value, step));
        }
        for value in ticks(self.ranges[1], step) {
            let at = self.upward.at(value);
            picture.line([x, at], [right, at], if value == 0.0 { "zero" } else { "grid" });
            picture.text([x - 5.0, at + 3.5], Anchor::End, "tick", &label(value, step));
        }
        picture.rect(&self.area, "frame", None);
        let name = |at: usize| NAMES.get(at).copied().unwrap_or_default();
        picture.text([x, y - 8.0], Anchor::Start, "head", self.title);
        let axes = format!("{} \u{2192}  {} \u{2191}  mm", name(self.right), name(self.up));
        picture.text([right, y - 8.0], Anchor::End, "tick", &axes);
    }

    /// The lines' numbers beside their paths, as far as they do not cover each other.
    fn numbers(&self, outline: &Outline, picture: &mut Picture) {
        let mut taken: Vec<[f64; 4]> = Vec::new();
        for (line, [x, y]) in &self.marks {
            let text = outline.label(*line);
            let width = 6.5 * text.len() as f64 + 4.0;
            let fits = |[left, top]: [f64; 2]| {
                let inside = left > self.area.x
                    && left + width < self.area.right()
                    && top > self.area.y
                    && top + 12.0 < self.area.bottom();
                let free = |other: &[f64; 4]| {
                    left + width < other[0] || left > other[2] || top + 12.0 < other[1] || top > other[3]
                };
                inside && taken.iter().all(free)
            };
            let around = [[4.0, -14.0], [4.0, 2.0], [-4.0 - width, -14.0], [-4.0 - width, 2.0]];
            let Some([left, top]) = around.map(|[dx, dy]| [x + dx, y + dy]).into_iter().find(|place| fits(*place))
            else {
                continue;
            };
            taken.push([left, top, left + width, top + 12.0]);
            // White around it, so that it can be read on top of paths.
            picture.text([left + 2.0, top + 10.0], Anchor::Start, "halo", &text);
            picture.text([left + 2.0, top + 10.0], Anchor::Start, "mark", &text);
        }
    }
}

/// The middle of the longest straight piece of a path; of a dot, the dot.
fn longest(points: &[Option<[f64; 2]>]) -> Option<[f64; 2]> {
    let pairs = points.windows(2).filter_map(|pair| Some((*pair.first()?.as_ref()?, *pair.last()?.as_ref()?)));
    let length = |(from, to): &([f64; 2], [f64; 2])| libm::hypot(to[0] - from[0], to[1] - from[1]);
    let best = pairs.max_by(|a, b| length(a).total_cmp(&length(b)));
    match best {
        Some((from, to)) => Some([f64::midpoint(from[0], to[0]), f64::midpoint(from[1], to[1])]),
        None => points.iter().flatten().next().copied(),
    }
}

#[cfg(test)]
mod tests {
    use super::super::robot::AXES;
    use super::super::trace::{Movement, Row};
    use super::*;

    /// The views of a path around a circle of 100 mm, with this many lines and turns.
    fn drawn(lines: u32, turns: f64) -> String {
        let row = |line: u32| {
            let angle = f64::from(line) / f64::from(lines) * turns * std::f64::consts::TAU;
            let tcp = [900.0 + 100.0 * angle.cos(), 100.0 * angle.sin(), 500.0];
            let place = ProgramLine { file: 0, line: line + 1 };
            Row { t: f64::from(line) * 1e-3, place, motion: u64::from(line) + 1, axes: [f64::NAN; AXES], tcp }
        };
        let outline = Outline::of((0..lines).map(|line| Ok(row(line)))).unwrap().unwrap();
        let area = Area { x: 0.0, y: 0.0, width: 1100.0, height: 330.0 };
        let (mut views, mut movement) = (Views::new(&outline, &area, 46.0), Movement::default());
        (0..lines).for_each(|line| views.push(&outline, &movement.next(row(line))));
        let mut picture = Picture::default();
        views.draw(&outline, &mut picture);
        picture.finish(1100.0, 330.0, "t")
    }

    #[test]
    fn many_lines_are_drawn_together() {
        assert_eq!(drawn(300, 1.0).matches("<path").count(), 3 * 300, "each line for itself");
        let many = drawn(50_000, 50.0);
        assert!(many.matches("<path").count() <= 3 * MOST_PATHS);
        assert!(many.len() < 1_000_000, "{} bytes", many.len());
    }
}
