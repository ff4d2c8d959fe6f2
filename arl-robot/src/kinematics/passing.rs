//! Passing the wrist singularity: where the middle axis of the wrist is near 0, axes 4 and 6 turn about nearly the same
//! line, and an exact orientation would make axis 4 swing round at once. A passage leads axis 4 smoothly from its
//! position before that section to the one needed after it; the TCP stays exactly on its path, and the orientation
//! deviates by at most the distance of the middle axis from 0.

use nalgebra::{Matrix6, Vector3, Vector6};

use super::angles::wrap;
use super::frame::Frame;
use super::{Axes, Kinematics, Opw, wrap_degrees};
use crate::robot::Axis;

/// A passage is where the sine of the wrist's middle axis is below this: 4 deg, the largest deviation of the
/// orientation.
pub const PASSAGE: f64 = 0.07;

/// Below this part of `PASSAGE`, axis 4 is at rest where a path begins or ends.
const STILL: f64 = 0.4;

/// The step at which a path is examined, as part of it.
const STEP: f64 = 1.0 / 512.0;
/// The part of the path over which differences approximate derivatives.
const DIFFERENCE: f64 = 1e-4;
/// The TCP counts as exact within this, in mm; the orientation's two exact components in rad.
const EXACT: f64 = 1e-9;
const EXACT_TURN: f64 = 1e-12;
const MOST_STEPS: usize = 30;

/// A section of a path that passes the wrist singularity.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Passage {
    /// The start of the section, as a path parameter within 0 to 1.
    pub from: f64,
    /// The end of the section.
    pub to: f64,
    /// Coefficients of axis 4 (deg) over the part of the section, lowest power first.
    axis4: [f64; 6],
    /// The configuration after the section: the middle axis may have passed through 0.
    pub cfg_behind: u8,
}

impl Passage {
    /// The position of axis 4 (deg) at a path parameter within the section.
    pub fn axis4(&self, at: f64) -> f64 {
        let part = ((at - self.from) / (self.to - self.from)).clamp(0.0, 1.0);
        self.axis4.iter().rev().fold(0.0, |sum, coefficient| sum * part + coefficient)
    }
}

impl Kinematics {
    /// The axes with axis 4 at `axis4` (deg) that bring the TCP of `tool` (relative to the flange) to the position of
    /// `tcp` (in the base) exactly, and its orientation as near as that axis allows: the deviation is a turn about the
    /// line at right angles to axes 5 and 6. `near` are the axes shortly before; the result is the solution that
    /// continues them. `None` for a SCARA, and if no axes lead there.
    pub fn inverse_at_axis4(&self, tcp: &Frame, tool: &Frame, axis4: f64, near: &Axes) -> Option<Axes> {
        let Kinematics::SixAxis(_) = self else { return None };
        let mut axes = *near;
        let [_, _, _, fourth, ..] = &mut axes;
        *fourth = axis4;
        for _ in 0..MOST_STEPS {
            let found = self.forward(&axes) * tool;
            let off = tcp.translation.vector - found.translation.vector;
            let turn = (tcp.rotation * found.rotation.inverse()).scaled_axis();
            let screws = self.jacobian(&axes, &found.translation.vector);
            let line = |column: usize| screws.fixed_view::<3, 1>(0, column).into_owned();
            let (fifth, sixth) = (line(4), line(5));
            if off.norm() < EXACT && fifth.dot(&turn).abs().max(sixth.dot(&turn).abs()) < EXACT_TURN {
                return Some(axes);
            }
            // Rows: the TCP in m, the two components of the orientation, and axis 4, which stays.
            let mut matrix = Matrix6::zeros();
            for column in 0..6 {
                let moving: Vector3<f64> = screws.fixed_view::<3, 1>(3, column) / 1000.0;
                let turning = line(column);
                let rows = Vector6::new(moving.x, moving.y, moving.z, fifth.dot(&turning), sixth.dot(&turning), 0.0);
                matrix.set_column(column, &rows);
            }
            matrix[(5, 3)] = 1.0;
            let [x, y, z]: [f64; 3] = (off / 1000.0).into();
            let wanted = Vector6::new(x, y, z, fifth.dot(&turn), sixth.dot(&turn), 0.0);
            let step: [f64; 6] = matrix.lu().solve(&wanted)?.into();
            axes.iter_mut().zip(step).for_each(|(axis, step)| *axis += step.to_degrees());
            if !axes.iter().all(|axis| axis.is_finite()) {
                return None;
            }
        }
        None
    }

    /// The sections of a path that pass the wrist singularity, in order. `flange` returns the frame of the flange in
    /// the base for a path parameter from 0 to 1, `start` are the axes where the path begins, in configuration `cfg`,
    /// and `axes` are the robot's own, within whose ranges axis 4 is led. Empty for a path without such sections, and
    /// for a SCARA.
    pub fn passages(&self, flange: impl Fn(f64) -> Frame, cfg: u8, start: &Axes, axes: &[Axis]) -> Vec<Passage> {
        let Kinematics::SixAxis(opw) = self else { return Vec::new() };
        let range = axes.get(3).map_or((f64::NEG_INFINITY, f64::INFINITY), |axis| (axis.min, axis.max));
        let search = PassageSearch { opw, flange, start, range };
        let mut passages = Vec::new();
        let (mut cfg, mut near, mut at) = (cfg, *start, 0.0);
        let mut entered = search.wrist_sine(start) < PASSAGE;
        let mut from = 0.0;
        while at < 1.0 {
            let next = (at + STEP).min(1.0);
            let is_inside = search.is_inside(next, cfg, &near);
            if !entered && is_inside {
                from = search.border(at, next, cfg, &near);
                entered = true;
            }
            if entered && (!is_inside || next >= 1.0) {
                let to = if is_inside { 1.0 } else { search.border(next, at.max(from), cfg, &near) };
                let Some((passage, end)) = search.passage(from, to, cfg, &near) else { break };
                passages.push(passage);
                cfg = passage.cfg_behind;
                set_axis4(&mut near, end);
                entered = false;
            } else if !entered && let Some(found) = search.exact(next, cfg, &near) {
                let followed = axis4(&near) + wrap_degrees(axis4(&found) - axis4(&near));
                near = found;
                set_axis4(&mut near, followed);
            }
            at = next;
        }
        passages
    }
}

fn axis4(axes: &Axes) -> f64 {
    let [_, _, _, axis4, ..] = *axes;
    axis4
}

fn set_axis4(axes: &mut Axes, to: f64) {
    let [_, _, _, axis4, ..] = axes;
    *axis4 = to;
}

/// The search for passages on a path.
struct PassageSearch<'a, F> {
    opw: &'a Opw,
    /// The frame of the flange in the base for a path parameter from 0 to 1.
    flange: F,
    /// The axes where the path begins.
    start: &'a Axes,
    /// The range of axis 4 (deg).
    range: (f64, f64),
}

impl<F: Fn(f64) -> Frame> PassageSearch<'_, F> {
    /// The axes at a path parameter with the exact orientation.
    fn exact(&self, at: f64, cfg: u8, near: &Axes) -> Option<Axes> {
        self.opw.inverse(&(self.flange)(at), cfg, near)
    }

    /// The absolute sine of the wrist's middle axis.
    fn wrist_sine(&self, axes: &Axes) -> f64 {
        let [_, _, _, _, fifth, _] = self.opw.inner(axes);
        libm::sin(fifth.to_radians()).abs()
    }

    fn is_inside(&self, at: f64, cfg: u8, near: &Axes) -> bool {
        self.exact(at, cfg, near).is_some_and(|axes| self.wrist_sine(&axes) < PASSAGE)
    }

    /// The border of a passage between a place outside and one inside.
    fn border(&self, mut outside: f64, mut within: f64, cfg: u8, near: &Axes) -> f64 {
        for _ in 0..50 {
            let middle = 0.5 * (outside + within);
            if self.is_inside(middle, cfg, near) { within = middle } else { outside = middle }
        }
        outside
    }

    /// The passage over a section, and the position of axis 4 after it. `near` are the axes shortly before. `None` if
    /// no axes lead to its end.
    fn passage(&self, from: f64, to: f64, cfg: u8, near: &Axes) -> Option<(Passage, f64)> {
        let end = axis4(&self.exact(to, cfg, near)?);
        let first = if from == 0.0 { axis4(self.start) } else { axis4(near) };
        // Half a turn of axis 4 more or less, with the middle axis on the other side, gives the same orientation.
        let least = end_of_axis4(end, first, self.range);
        let flips = (wrap_degrees(least - end)).abs() > 90.0;
        let starts = if from == 0.0 { first } else { first + from_exact(self.exact(from, cfg, near), first) };
        let start = self.derivatives(from, starts, cfg, near);
        let axis4 = quintic(start, self.derivatives(to, least, cfg, near), to - from);
        let cfg_behind = if flips { cfg ^ 1 } else { cfg };
        Some((Passage { from, to, axis4, cfg_behind }, least))
    }

    /// The value of axis 4 at a border of the passage, with its first and second derivative with respect to the path
    /// parameter.
    fn derivatives(&self, border: f64, value: f64, cfg: u8, near: &Axes) -> [f64; 3] {
        if border <= 0.0 || border >= 1.0 {
            let [first, second] = self.derivatives_at_end(border, cfg, near).unwrap_or_default();
            return [value, first, second];
        }
        let shift = |by: f64| self.exact(border + by, cfg, near).map(|axes| axis4(&axes) - value);
        let (Some(before), Some(here), Some(after)) = (shift(-DIFFERENCE), shift(0.0), shift(DIFFERENCE)) else {
            return [value, 0.0, 0.0];
        };
        let [before, after] = wrap([before - here, after - here]);
        [value, (after - before) / (2.0 * DIFFERENCE), (after + before) / (DIFFERENCE * DIFFERENCE)]
    }

    /// The derivatives of axis 4 at an end of the path: those of the exact motion, the smaller the nearer to 0 the
    /// middle axis is. An adjoining path does the same there.
    fn derivatives_at_end(&self, end: f64, cfg: u8, near: &Axes) -> Option<[f64; 2]> {
        let here = self.exact(end, cfg, near)?;
        let share = share_kept(self.wrist_sine(&here));
        if share == 0.0 {
            return None;
        }
        let step = if end <= 0.0 { DIFFERENCE } else { -DIFFERENCE };
        let shift = |steps: f64| {
            self.exact(end + steps * step, cfg, near).map(|axes| wrap_degrees(axis4(&axes) - axis4(&here)))
        };
        let (one, two, three) = (shift(1.0)?, shift(2.0)?, shift(3.0)?);
        let first = (18.0 * one - 9.0 * two + 2.0 * three) / (6.0 * step);
        let second = (-5.0 * one + 4.0 * two - three) / (step * step);
        Some([share * first, share * second])
    }
}

/// The share of its exact motion that axis 4 keeps where the path begins or ends inside a passage: 1 at the border, 0
/// near the singular point.
fn share_kept(sine: f64) -> f64 {
    let part = ((sine / PASSAGE - STILL) / (1.0 - STILL)).clamp(0.0, 1.0);
    part * part * (3.0 - 2.0 * part)
}

/// The distance of the exact axis 4 from `value`, without whole turns.
fn from_exact(axes: Option<Axes>, value: f64) -> f64 {
    axes.map_or(0.0, |axes| wrap_degrees(axis4(&axes) - value))
}

/// The angle that differs from `end` by half turns, is nearest to `start` and within the range.
fn end_of_axis4(end: f64, start: f64, (min, max): (f64, f64)) -> f64 {
    let first = end + 180.0 * ((start - end) / 180.0).round();
    let all = [first, first - 180.0, first + 180.0];
    let fits = all.into_iter().filter(|angle| (min..=max).contains(angle));
    fits.min_by(|a, b| (a - start).abs().total_cmp(&(b - start).abs())).unwrap_or(first)
}

/// The coefficients over the part of a section of length `length` that begins and ends with these values, first and
/// second derivatives.
fn quintic(start: [f64; 3], end: [f64; 3], length: f64) -> [f64; 6] {
    let [p, v, a] = start;
    let [q, w, b] = end;
    let (v, w, a, b) = (v * length, w * length, a * length * length, b * length * length);
    let distance = q - p;
    [
        p,
        v,
        0.5 * a,
        10.0 * distance - 6.0 * v - 4.0 * w - 1.5 * a + 0.5 * b,
        -15.0 * distance + 8.0 * v + 7.0 * w + 1.5 * a - b,
        6.0 * distance - 3.0 * (v + w) - 0.5 * a + 0.5 * b,
    ]
}

#[cfg(test)]
#[cfg(feature = "files")]
mod tests {
    use super::*;
    use crate::kinematics::frame;
    use crate::kinematics::random::Random;
    use crate::robot::Robot;
    use nalgebra::Translation3;

    fn all(robot: &Robot, tcp: &dyn Fn(f64) -> Frame, tool: &Frame, start: &Axes) -> Vec<Passage> {
        let back = tool.inverse();
        robot.kinematics.passages(|at| tcp(at) * back, robot.kinematics.cfg(start), start, robot.own_axes())
    }

    /// Follows a line of the TCP with its passages; returns the largest jump of an axis from one place to the next, the
    /// largest change of a jump, and the largest deviation of the orientation (rad).
    fn follow(robot: &Robot, tcp: &dyn Fn(f64) -> Frame, tool: &Frame, start: &Axes, places: i32) -> (f64, f64, f64) {
        let kinematics = &robot.kinematics;
        let passages = all(robot, tcp, tool, start);
        let (mut near, mut cfg) = (*start, kinematics.cfg(start));
        let (mut most, mut bend, mut gave) = (0.0_f64, 0.0_f64, 0.0_f64);
        let mut last = [0.0; 6];
        for place in 1..=places {
            let at = f64::from(place) / f64::from(places);
            let passage = passages.iter().find(|passage| passage.from <= at && at <= passage.to);
            let found = match passage {
                Some(passage) => {
                    cfg = passage.cfg_behind;
                    kinematics.inverse_at_axis4(&tcp(at), tool, passage.axis4(at), &near).unwrap()
                }
                None => {
                    let mut found = kinematics.inverse(&(tcp(at) * tool.inverse()), cfg, &near).unwrap();
                    found.iter_mut().zip(near).for_each(|(new, old)| *new = old + wrap_degrees(*new - old));
                    found
                }
            };
            let reached = kinematics.forward(&found) * tool;
            assert!((reached.translation.vector - tcp(at).translation.vector).norm() < 1e-7, "the TCP is exact");
            gave = gave.max(reached.rotation.angle_to(&tcp(at).rotation));
            for ((new, old), last) in found.iter().zip(near).zip(&mut last) {
                let jump = new - old;
                most = most.max(jump.abs());
                if place > 1 {
                    bend = bend.max((jump - *last).abs());
                }
                *last = jump;
            }
            near = found;
        }
        let end = kinematics.forward(&near) * tool;
        assert!(end.rotation.angle_to(&tcp(1.0).rotation) < 1e-6, "the target's orientation is exact");
        (most, bend, gave)
    }

    /// A line whose flange keeps its orientation; at its middle the axes are at `middle`.
    fn through(robot: &Robot, middle: &Axes, tool: &Frame, travel: Vector3<f64>) -> impl Fn(f64) -> Frame + use<> {
        let pose = robot.kinematics.forward(middle) * tool;
        move |at: f64| {
            let place = pose.translation.vector + travel * (at - 0.5);
            Frame::from_parts(Translation3::from(place), pose.rotation)
        }
    }

    #[test]
    fn lines_pass_the_singularity_with_the_tcp_exact_and_even_axes() {
        let robot = Robot::builtin("kr10-r1420").unwrap();
        let tool = frame([30.0, -20.0, 160.0, 10.0, 35.0, 0.0]);
        for (fifth, travel) in [
            (0.0, Vector3::new(100.0, 300.0, -200.0)),
            (0.02, Vector3::new(0.0, 400.0, 100.0)),
            (0.5, Vector3::new(-80.0, 350.0, 150.0)),
            (2.0, Vector3::new(50.0, -350.0, 100.0)),
        ] {
            let tcp = through(&robot, &[10.0, -70.0, 80.0, 25.0, fifth, 15.0], &tool, travel);
            let start = [0, 1].into_iter().find_map(|bit| {
                let near = [10.0, -70.0, 80.0, 25.0, 5.0, 15.0];
                let found = robot.kinematics.inverse(&(tcp(0.0) * tool.inverse()), bit, &near)?;
                (found[3].abs() < 90.0).then_some(found)
            });
            let start = start.unwrap();
            let passages = all(&robot, &tcp, &tool, &start);
            assert_eq!(passages.len(), 1, "{fifth}: {passages:?}");
            let (most, bend, gave) = follow(&robot, &tcp, &tool, &start, 1000);
            let (finer, finer_bend, _) = follow(&robot, &tcp, &tool, &start, 4000);
            // Steps shrink with the distance of the places, their changes with its square: position and speed are
            // continuous.
            assert!(most < 3.0 && finer < 0.3 * most, "{fifth}: {most} {finer}");
            assert!(finer_bend < 0.1 * bend + 1e-6, "{fifth}: {bend} {finer_bend}");
            assert!(gave < 1.01 * PASSAGE, "{fifth}: {gave}");
        }
    }

    #[test]
    fn random_lines_past_the_singularity_stay_even() {
        let mut random = Random::new(41);
        let (mut passed, mut worst) = (0, (0.0_f64, 0.0_f64));
        for name in ["kr10-r1420", "irb2400-10", "tx2-60"] {
            let robot = Robot::builtin(name).unwrap();
            let kinematics = &robot.kinematics;
            for _ in 0..60 {
                let mut number = |size: f64| random.between(-size, size);
                let middle = match name {
                    "kr10-r1420" => [number(90.0), -70.0 + number(20.0), 80.0 + number(20.0)],
                    _ => [number(90.0), number(20.0), 40.0 + number(20.0)],
                };
                let [j1, j2, j3] = middle;
                let middle = [j1, j2, j3, number(60.0), number(5.0), number(60.0)];
                let tool = frame([number(50.0), number(50.0), 100.0 + number(100.0), number(90.0), number(60.0), 0.0]);
                let travel = Vector3::new(number(150.0), number(150.0), number(150.0));
                let tcp = through(&robot, &middle, &tool, travel);
                let Some(start) = kinematics.inverse(&(tcp(0.0) * tool.inverse()), kinematics.cfg(&middle), &middle)
                else {
                    continue;
                };
                // Only lines that the arm itself can follow without another singular point, and within its ranges.
                let fits = |at: f64| {
                    let found = kinematics.inverse(&(tcp(at) * tool.inverse()), kinematics.cfg(&middle), &middle);
                    found.is_some_and(|[_, _, third, ..]| (third - j3).abs() < 30.0)
                };
                if !(0..=20).all(|part| fits(f64::from(part) / 20.0)) {
                    continue;
                }
                if all(&robot, &tcp, &tool, &start).is_empty() {
                    continue;
                }
                passed += 1;
                let (most, _, gave) = follow(&robot, &tcp, &tool, &start, 500);
                let (finer, ..) = follow(&robot, &tcp, &tool, &start, 2000);
                worst = (worst.0.max(most), worst.1.max(gave));
                assert!(finer < 0.35 * most, "{name} {middle:?} {travel}: {most} {finer}");
                assert!(gave < 1.05 * PASSAGE, "{name} {middle:?} {travel}: {gave}");
            }
        }
        assert!(passed > 100, "{passed}");
        assert!(worst.0 < 5.0, "{worst:?}");
    }

    #[test]
    fn a_line_that_begins_or_ends_at_the_singularity_is_passed_too() {
        let robot = Robot::builtin("irb2400-10").unwrap();
        let tool = frame([0.0, 0.0, 100.0, 0.0, 0.0, 0.0]);
        let singular = [0.0, 10.0, -20.0, 30.0, 0.0, -10.0];
        let tcp = through(&robot, &singular, &tool, Vector3::new(200.0, 300.0, 100.0));
        // From the middle on.
        let (most, ..) = follow(&robot, &|at| tcp(0.5 + 0.5 * at), &tool, &singular, 500);
        assert!(most < 1.0, "{most}");
        let start = robot.kinematics.inverse(&(tcp(0.0) * tool.inverse()), 0, &singular).unwrap();
        let (most, ..) = follow(&robot, &|at| tcp(0.5 * at), &tool, &start, 500);
        assert!(most < 1.0, "{most}");
    }

    #[test]
    fn a_line_that_begins_or_ends_just_inside_goes_on_evenly() {
        let robot = Robot::builtin("kr10-r1420").unwrap();
        let (tool, travel) = (Frame::identity(), Vector3::new(40.0, 20.0, 40.0));
        let start = [3.8, -77.2, 81.2, -60.7, 4.006, 64.0];
        let tcp = through(&robot, &start, &tool, travel * 2.0);
        let passages = all(&robot, &|at| tcp(0.5 + 0.5 * at), &tool, &start);
        assert!(matches!(passages[..], [Passage { from: 0.0, to, .. }] if to < 0.01), "{passages:?}");
        let (most, bend, _) = follow(&robot, &|at| tcp(0.5 + 0.5 * at), &tool, &start, 10_000);
        assert!(bend < 0.01 * most, "{most} {bend}");
        let end = robot.kinematics.inverse(&(tcp(1.0) * tool.inverse()), robot.kinematics.cfg(&start), &start).unwrap();
        let (most, bend, _) = follow(&robot, &|at| tcp(1.0 - 0.5 * at), &tool, &end, 10_000);
        assert!(bend < 0.01 * most, "{most} {bend}");
    }

    #[test]
    fn a_path_that_keeps_clear_has_no_passage() {
        let robot = Robot::builtin("kr10-r1420").unwrap();
        let start = [10.0, -70.0, 80.0, 25.0, 40.0, 15.0];
        let tcp = through(&robot, &start, &Frame::identity(), Vector3::new(20.0, 0.0, 0.0));
        assert_eq!(all(&robot, &tcp, &Frame::identity(), &start), []);
        let scara = Robot::builtin("hsr065").unwrap();
        let tcp = through(&scara, &[0.0; 6], &Frame::identity(), Vector3::zeros());
        assert_eq!(all(&scara, &tcp, &Frame::identity(), &[0.0; 6]), []);
    }
}
