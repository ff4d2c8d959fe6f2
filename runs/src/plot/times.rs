//! The speed of the TCP and of the axes over time, with the lines that are executed.

use super::outline::{Outline, colour};
use super::robot::Robot;
use super::scale::{Scale, label, step, ticks};
use super::svg::{Anchor, Area, Picture, short};
use super::thin::OverTime;
use super::trace::RobotMotion;

/// px that a line's number needs in its band.
const DIGIT: f64 = 6.2;
/// px between two marks of where motions begin.
const APART: f64 = 7.0;

/// The chart of the TCP's speed and the one of the axes' speeds, with the band of lines above them.
pub(super) struct Times<'a> {
    outline: &'a Outline,
    robot: &'a Robot,
    band: Area,
    speed: Area,
    axes: Area,
    across: Scale,
    highest: f64,
    upward: Scale,
    /// The highest share of an axis's limit that is shown, in %.
    share: f64,
    shares: Scale,
    speed_line: OverTime,
    axis_lines: Vec<OverTime>,
}

impl<'a> Times<'a> {
    /// `band`, `speed` and `axes` have the same width.
    pub(super) fn new(outline: &'a Outline, robot: &'a Robot, band: Area, speed: Area, axes: Area) -> Self {
        let [from, to] = outline.time;
        let end = to.max(from + 1e-3);
        let highest = outline.speed.max(1.0) * 1.08;
        let peak = robot.axes.iter().map(|axis| 100.0 * peak(outline, axis.column) / axis.vel).fold(0.0, f64::max);
        let share = f64::max(110.0, peak * 1.05);
        Self {
            outline,
            robot,
            band,
            speed,
            axes,
            across: Scale::new([from, end], speed.x, speed.right()),
            highest,
            upward: Scale::new([0.0, highest], speed.bottom(), speed.y),
            share,
            shares: Scale::new([-share, share], axes.bottom(), axes.y),
            speed_line: OverTime::default(),
            axis_lines: vec![OverTime::default(); robot.axes.len()],
        }
    }

    /// Adds the next cycle.
    pub(super) fn push(&mut self, moved: &RobotMotion) {
        let x = self.across.at(moved.row.t);
        match moved.speed {
            Some(speed) => self.speed_line.push([x, self.upward.at(speed)]),
            None => self.speed_line.lift(),
        }
        for (line, axis) in self.axis_lines.iter_mut().zip(&self.robot.axes) {
            let speed = moved.axes.get(axis.column).copied().unwrap_or(f64::NAN);
            if speed.is_finite() {
                line.push([x, self.shares.at(100.0 * speed / axis.vel)]);
            }
        }
    }

    /// Draws the charts.
    pub(super) fn draw(mut self, picture: &mut Picture) {
        self.draw_band(picture);
        self.grounds(picture);
        let line = std::mem::take(&mut self.speed_line).finish();
        picture.path(&line, "curve", "#1f2328");
        for (at, line) in std::mem::take(&mut self.axis_lines).into_iter().enumerate() {
            picture.path(&line.finish(), "curve", colour(at));
        }
        self.legends(picture);
    }

    /// One block for each motion, with the number of its line where it fits.
    fn draw_band(&self, picture: &mut Picture) {
        let Area { x, y, height, .. } = self.band;
        picture.text([x - 8.0, y + height - 4.0], Anchor::End, "tick", "line");
        let mut drawn_to = f64::NEG_INFINITY;
        for stretch in &self.outline.stretches {
            let (from, to) = (self.across.at(stretch.from), self.across.at(stretch.to));
            if to < drawn_to + 0.25 {
                continue;
            }
            drawn_to = to;
            let block = Area { x: from, width: (to - from - 0.5).max(0.3), ..self.band };
            picture.rect(&block, "", Some(self.outline.colour(stretch.place)));
            let text = self.outline.label(stretch.place);
            if block.width > DIGIT * text.chars().count() as f64 + 3.0 {
                let middle = [block.x + block.width / 2.0, y + height - 4.0];
                picture.text(middle, Anchor::Middle, "band", &text);
            }
        }
    }

    fn grounds(&self, picture: &mut Picture) {
        let seconds = step(self.outline.time[1] - self.outline.time[0], 10.0);
        for value in ticks(self.outline.time, seconds) {
            let x = self.across.at(value);
            for area in [&self.speed, &self.axes] {
                picture.line([x, area.y], [x, area.bottom()], "grid");
            }
            picture.text([x, self.axes.bottom() + 13.0], Anchor::Middle, "tick", &label(value, seconds));
        }
        picture.text([self.axes.right(), self.axes.bottom() + 28.0], Anchor::End, "tick", "time in s");
        let by = step(self.highest, 5.0);
        for value in ticks([0.0, self.highest], by) {
            self.level(&self.speed, self.upward.at(value), &label(value, by), picture);
        }
        let by = step(2.0 * self.share, 9.0);
        for value in ticks([-self.share, self.share], by) {
            self.level(&self.axes, self.shares.at(value), &label(value, by), picture);
        }
        self.changes(picture);
        let limit = |area: &Area, y: f64, picture: &mut Picture| picture.line([area.x, y], [area.right(), y], "limit");
        if self.robot.tcp <= self.highest {
            limit(&self.speed, self.upward.at(self.robot.tcp), picture);
        }
        for share in [-100.0, 100.0] {
            limit(&self.axes, self.shares.at(share), picture);
        }
        for (area, head) in
            [(&self.speed, "Speed of the TCP in mm/s"), (&self.axes, "Axis speeds in % of their limits")]
        {
            picture.rect(area, "frame", None);
            picture.text([area.x, area.y - 7.0], Anchor::Start, "head", head);
        }
    }

    fn level(&self, area: &Area, y: f64, text: &str, picture: &mut Picture) {
        picture.line([area.x, y], [area.right(), y], "grid");
        picture.text([area.x - 5.0, y + 3.5], Anchor::End, "tick", text);
    }

    /// Marks where motions begin.
    fn changes(&self, picture: &mut Picture) {
        let mut last = f64::NEG_INFINITY;
        for stretch in &self.outline.stretches {
            let x = self.across.at(stretch.from);
            if x >= last + APART && x > self.speed.x + 0.5 {
                last = x;
                for area in [&self.speed, &self.axes] {
                    picture.line([x, area.y], [x, area.bottom()], "change");
                }
            }
        }
    }

    fn legends(&self, picture: &mut Picture) {
        let x = self.speed.right() + 18.0;
        let highest = format!("highest {} mm/s", rounded(self.outline.speed));
        picture.text([x, self.speed.y + 10.0], Anchor::Start, "", &highest);
        let text = format!("limit on lines {} mm/s", short(self.robot.tcp));
        picture.text([x, self.speed.y + 28.0], Anchor::Start, "tick", &text);
        let apart = f64::min(34.0, self.axes.height / self.robot.axes.len().max(1) as f64);
        for (at, axis) in self.robot.axes.iter().enumerate() {
            let y = self.axes.y + 10.0 + at as f64 * apart;
            picture.rect(&Area { x, y: y - 8.0, width: 12.0, height: 3.0 + 6.0 }, "", Some(colour(at)));
            let peak = peak(self.outline, axis.column);
            let text = format!("{}  up to {} %", axis.name, rounded(100.0 * peak / axis.vel));
            picture.text([x + 18.0, y], Anchor::Start, "", &text);
            if apart > 26.0 {
                let unit = if axis.linear { "mm/s" } else { "deg/s" };
                let text = format!("of {} {unit}", short(axis.vel));
                picture.text([x + 18.0, y + 12.0], Anchor::Start, "tick", &text);
            }
        }
    }
}

fn peak(outline: &Outline, column: usize) -> f64 {
    outline.axes.get(column).copied().unwrap_or_default()
}

/// A number of three digits or so.
fn rounded(value: f64) -> String {
    if value >= 99.95 { format!("{value:.0}") } else { format!("{value:.1}") }
}
