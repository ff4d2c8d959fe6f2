//! Samples the path for a time law: how everything moves at places close enough together, and within which limits.

use std::sync::Arc;

use crate::command::joints::{ALL, Joints};
use crate::follow::segment::{GuidedTool, Segment};
use crate::follow::shared_deque::SharedDeque;
use crate::limits::constant::Constraint;
use crate::plan::constraints::{Constraints, PathLimits};
use crate::time_optimal::solver::{BoundaryState, ConstrainedPath, Row, guess_steps, places, thinned};
use arl_robot::robot::Robot;

/// The longest time, in s, between two places, nominal or as estimated, and the least and the largest number of places.
const LONGEST_SPACING_S: f64 = 0.008;
const FEWEST_PLACES: f64 = 48.0;
const MOST_EVEN_PLACES: f64 = 250.0;
const MOST_PLACES: usize = 900;
/// Where more places by this factor are needed, a path is sampled once more.
const WORTH_WALKING_AGAIN: f64 = 1.2;
/// The density of places for a short part, and their maximum number.
const COARSE_DENSITY: f64 = 0.2;
const MOST_COARSE_PLACES: usize = 40;
/// Outside blends, the least distance of two places, as a share of the spacing.
const CLOSEST_SHARE_OF_SPACING: f64 = 1.0 / 256.0;
/// A step as a share of the path over which the motion changes.
const STEP_SHARE_OF_SCALE: f64 = 0.06;
/// Share of the highest speed so far that still counts at the next place in finding how far the motion changes: where
/// everything turns back, the speed is low for a moment, but the motion does not change faster because of that.
const FORGOTTEN_SHARE: f64 = 0.7;
/// Number of places in each part of a blend.
const PLACES_OF_BLEND_PART: u32 = 3;
/// The distance between places may grow by this share of their distance from a blend: where the blend is sharp, the
/// robot is slow beside it, as beside a stop.
const GROWTH_BESIDE_BLEND: f64 = 0.4;
/// A start that is slower than this share of the full speed gets places as if it had this speed.
const SLOWEST_START: f64 = 1e-4;
/// Distance from a place at which its two sides are sampled, as a share of the segment.
const BESIDE_SHARE: f64 = 1e-9;
/// Places no farther apart than this, as a share of the spacing or of the path, are the same.
const SAME_PLACE_SHARE: f64 = 1e-9;
/// A law is found without places that are closer together than about this, in s: set-points are 1 ms apart, but a sharp
/// blend is passed in few of them.
const CLOSEST_S: f64 = 0.0004;
/// The same distance where an acceleration may change at once.
const CLOSEST_WITHOUT_JERK_LIMITS_S: f64 = 0.0003;
/// With more segments than this ahead, their ends are not places of their own; ends are sampled where they are farther
/// apart than this share of the spacing.
const MOST_SEGMENTS_WITH_ENDS: usize = 150;
const CLOSEST_ENDS_SHARE: f64 = 0.1;
/// Maximum number of times that the end is moved nearer because there are too many places before it.
const MOST_SHORTENINGS: usize = 6;

/// Segments in a row. Times are nominal, in s since the path began.
#[derive(Debug)]
pub(crate) struct Part {
    pub(crate) segments: SharedDeque<Segment>,
    /// Index of the first segment.
    pub(crate) from: usize,
    /// Number of segments.
    pub(crate) count: usize,
    /// Where the first segment begins.
    pub(crate) begin: f64,
    /// Where the last segment ends.
    pub(crate) end: f64,
    /// Whether the robot has to stop there.
    pub(crate) stops: bool,
}

impl Part {
    /// A path of these segments, from rest to rest.
    pub(crate) fn whole(segments: SharedDeque<Segment>) -> Self {
        let end = segments.iter().map(|segment| segment.time).sum();
        Self { from: 0, count: segments.len(), begin: 0.0, end, stops: true, segments }
    }

    fn get(&self, index: usize) -> Option<&Segment> {
        if index < self.count { self.segments.get(self.from + index).map(|segment| &**segment) } else { None }
    }

    fn iter(&self) -> impl Iterator<Item = &Segment> {
        self.segments.range(self.from, self.count).map(|segment| &**segment)
    }
}

/// The path from a place on. Parameters are in s of nominal time since the path began.
pub(crate) struct ConstraintSampler {
    /// The robot that moves.
    pub(crate) robot: Arc<Robot>,
    part: Part,
    /// Where sampling begins, and joints near there.
    pub(crate) at: f64,
    near: Joints,
    /// Where sampling ends, and whether the robot has to stop there.
    pub(crate) end: f64,
    pub(crate) stops: bool,
    /// The least time, in s, that an acceleration takes to rise, where the path is sampled for a stop: then each place
    /// has limits of its own, also along motions with a duration.
    rise: Option<f64>,
}

/// A part of the path that is ready to be timed.
pub(crate) struct SampledPath {
    pub(crate) path: ConstrainedPath,
    /// The path without places that are closer together in time than set-points can show, if there are any.
    pub(crate) thinned: Option<ConstrainedPath>,
    /// Where it ends; earlier than requested where there are too many places.
    pub(crate) end: f64,
}

impl ConstraintSampler {
    /// Samples a part of the path from `at` on, with the joints at `near` there.
    pub(crate) fn new(robot: &Arc<Robot>, part: Part, at: f64, near: &Joints) -> Self {
        let (end, stops) = (part.end, part.stops);
        Self { robot: Arc::clone(robot), part, at, near: *near, end, stops, rise: None }
    }

    /// The number of segments that it holds, including those that it does not sample.
    pub(crate) fn segments(&self) -> usize {
        self.part.segments.len()
    }

    /// Whether another sampler samples the same path from the same place.
    pub(crate) fn is_like(&self, other: &Self) -> bool {
        let Self { robot, part, at, near, end, stops, rise } = self;
        let place = (part.begin, *at, *near, *end, *stops, *rise);
        place == (other.part.begin, other.at, other.near, other.end, other.stops, other.rise)
            && part.count == other.part.count
            && *robot == other.robot
            && part.iter().zip(other.part.iter()).all(|(segment, other)| segment.is_like(other))
    }

    /// The sampler ending at `end`, if that is nearer.
    pub(crate) fn up_to(mut self, end: f64) -> Self {
        if end < self.end {
            (self.end, self.stops) = (end, false);
        }
        self
    }

    /// The sampler for a stop, where an acceleration takes at least `rise` s to rise.
    pub(crate) fn for_stop(self, rise: f64) -> Self {
        Self { rise: Some(rise), ..self }
    }

    /// The sampler from `at` on, which is farther ahead.
    pub(crate) fn behind(self, at: f64) -> Self {
        Self { at, ..self }
    }

    /// Samples the path to `to`, with `density` times the usual number of places.
    pub(crate) fn look(&self, to: f64, density: f64, start: BoundaryState, end: BoundaryState) -> Option<SampledPath> {
        self.look_at(to, density, MOST_PLACES, [start, end], None)
    }

    /// Samples the path to `to` where the parameter has about this mean speed.
    pub(crate) fn look_at_speed(
        &self,
        to: f64,
        density: f64,
        edges: [BoundaryState; 2],
        speed: f64,
    ) -> Option<SampledPath> {
        self.look_at(to, density, MOST_PLACES, edges, Some((to - self.at) / speed))
    }

    /// Samples a short part of the path from rest on, up to `to` at most, at a few places.
    pub(crate) fn sample_short_part(&self, to: f64) -> Option<SampledPath> {
        let end = if to < self.end { BoundaryState { vel: 1.0, acc: 0.0 } } else { BoundaryState::REST };
        self.look_at(to.min(self.end), COARSE_DENSITY, MOST_COARSE_PLACES, [BoundaryState::REST, end], None)
    }

    /// Returns a walk along the path that finds positions only.
    pub(crate) fn sample_coarsely(&self) -> Stroll<'_> {
        Stroll { sampler: self, joints: self.near, index: 0, before: self.part.begin }
    }

    /// Samples the path to `to`, which takes about `duration` s; where the duration is not known, it is estimated.
    fn look_at(
        &self,
        mut to: f64,
        density: f64,
        most: usize,
        edges: [BoundaryState; 2],
        mut duration: Option<f64>,
    ) -> Option<SampledPath> {
        let is_fine = density >= 1.0;
        for _ in 0..MOST_SHORTENINGS {
            match self.walk(to, duration.unwrap_or_default(), density, most, edges) {
                Ok((path, many)) => {
                    let steps = if is_fine { guess_steps(&path, edges)? } else { Vec::new() };
                    if is_fine && duration.is_none() {
                        let guessed = steps.iter().sum();
                        duration = Some(guessed);
                        if even_places(guessed) > WORTH_WALKING_AGAIN * even_places(to - self.at) {
                            continue;
                        }
                    }
                    // Where a singular point is all that is known about an end, no motion along the rest leads there.
                    let [first, last] = [*path.places().first()?, *path.places().last()?];
                    if (first - self.at).max(to - last) > SAME_PLACE_SHARE * (to - self.at) {
                        return None;
                    }
                    let closest = if path.limits_jerk() { CLOSEST_S } else { CLOSEST_WITHOUT_JERK_LIMITS_S };
                    let thinned = if is_fine && !many { thinned(&path, &steps, closest / density) } else { None };
                    return Some(SampledPath { path, thinned, end: to });
                }
                Err(reached) => {
                    let shorter = self.at + 0.8 * (reached - self.at);
                    duration = duration.map(|duration| duration * (shorter - self.at) / (to - self.at));
                    to = shorter;
                }
            }
        }
        None
    }

    /// Samples the path, which takes at least `duration` s, with a density of places; returns it with whether it has
    /// too many segments for places of their own, or how far it got with the maximum number of places.
    fn walk(
        &self,
        to: f64,
        duration: f64,
        density: f64,
        most: usize,
        [start, end]: [BoundaryState; 2],
    ) -> Result<(ConstrainedPath, bool), f64> {
        let count = (density * even_places(duration.max(to - self.at))) as usize;
        let spacing = (to - self.at) / count as f64;
        let mut stations: Vec<(f64, bool)> =
            places(self.at, to, count, start, end).into_iter().map(|at| (at, true)).collect();
        let (joints, many) = self.joints(to, CLOSEST_ENDS_SHARE * spacing, density >= 1.0);
        stations.extend(joints.into_iter().map(|at| (at, !many)));
        stations.sort_by(|a, b| a.0.total_cmp(&b.0));
        stations.dedup_by(|next, kept| {
            let same = next.0 - kept.0 <= SAME_PLACE_SHARE * spacing;
            kept.1 |= same && next.1;
            same
        });

        let mut path = ConstrainedPath::new();
        let mut constraints = Constraints::signed(&self.robot);
        let is_coarse = density < 1.0;
        let mut walk = Walk::new(self, many || is_coarse);
        let grades = if is_coarse { Vec::new() } else { self.grades(spacing, start, many) };
        let mut grade = 0;
        for (station, next) in stations.iter().zip(stations.iter().skip(1).map(Some).chain([None])) {
            let mut at = station.0;
            let mut is_place = station.1;
            loop {
                let step = walk.rows(at, spacing, &mut constraints);
                while grades.get(grade + 1).is_some_and(|next| next.at <= at) {
                    grade += 1;
                }
                let step = step.min(spacing_at(&grades, grade, at));
                // Where too many segments meet for places of their own, those that are far enough from the last place
                // become places nevertheless.
                is_place |= at - path.places().last().copied().unwrap_or(self.at) >= step;
                if is_place && !constraints.rows.is_empty() {
                    let rows = constraints.rows.drain(..).map(row);
                    match walk.jump {
                        Some(before) => path.push_jump(at, rows, before),
                        None => path.push(at, rows),
                    }
                }
                if path.places().len() > most {
                    return Err(at);
                }
                match next {
                    Some((next, _)) if at + 1.3 * step < *next => (at, is_place) = (at + step, true),
                    _ => break,
                }
            }
        }
        Ok((path, many))
    }

    /// The permitted spacing of places at the start, and where segments meet if there are not too many.
    fn grades(&self, spacing: f64, start: BoundaryState, many: bool) -> Vec<Grade> {
        // After a slow start, places are initially no farther apart than in proportion to its speed.
        let slow = if start.vel > 0.0 { spacing * start.vel.clamp(SLOWEST_START, 1.0) } else { spacing };
        let mut grades = vec![Grade { at: self.at, spacing: slow }];
        let (mut at, mut before) = (self.part.begin, spacing);
        for segment in self.part.iter().filter(|_| !many) {
            let own = if segment.parametrization.is_some() { spacing_in_blend(segment, spacing) } else { spacing };
            if let Some(start) = grades.last_mut() {
                start.spacing = start.spacing.min(own).min(before);
            }
            at += segment.time;
            grades.push(Grade { at: at.max(self.at), spacing: own });
            before = own;
        }
        let bind = |last: &mut f64, grade: &mut Grade, width: f64| {
            grade.spacing = grade.spacing.min(*last + GROWTH_BESIDE_BLEND * width);
            *last = grade.spacing;
        };
        let (mut spacing, mut at) = (f64::INFINITY, self.at);
        for grade in &mut grades {
            bind(&mut spacing, grade, grade.at - std::mem::replace(&mut at, grade.at));
        }
        spacing = f64::INFINITY;
        for grade in grades.iter_mut().rev() {
            bind(&mut spacing, grade, std::mem::replace(&mut at, grade.at) - grade.at);
        }
        grades
    }

    /// Where derivatives jump before `to`, between segments and within them, and for fine sampling the places near
    /// singular points; and whether there are too many of them to be places. In that case those nearer to each other
    /// than `closest` are left out.
    fn joints(&self, to: f64, closest: f64, is_fine: bool) -> (Vec<f64>, bool) {
        let mut joints = Vec::new();
        let (mut start, mut count) = (self.part.begin, 0);
        for segment in self.part.iter() {
            if start >= to {
                break;
            }
            count += 1;
            let close = is_fine.then(|| segment.close_places()).into_iter().flatten();
            let inner = segment.jumps().chain(close).map(|at| start + at);
            joints.extend(inner.filter(|at| *at > self.at && *at < to));
            start += segment.time;
        }
        let many = count > MOST_SEGMENTS_WITH_ENDS;
        if many {
            joints.sort_by(f64::total_cmp);
            let mut last = self.at;
            joints.retain(|at| {
                let is_far = *at - last >= closest;
                last = if is_far { *at } else { last };
                is_far
            });
        }
        (joints, many)
    }
}

/// The number of places for a path that takes `time` s.
fn even_places(time: f64) -> f64 {
    (time / LONGEST_SPACING_S).clamp(FEWEST_PLACES, MOST_EVEN_PLACES)
}

/// The permitted spacing of places at `at`.
#[derive(Clone, Copy, Debug)]
struct Grade {
    at: f64,
    spacing: f64,
}

/// The permitted distance of the next place from `at`, which is behind the grade `index`.
fn spacing_at(grades: &[Grade], index: usize, at: f64) -> f64 {
    let before = grades.get(index).map_or(f64::INFINITY, |grade| grade.spacing + GROWTH_BESIDE_BLEND * (at - grade.at));
    // The next place itself is nearer to what comes.
    let behind = grades.get(index + 1).map_or(f64::INFINITY, |grade| {
        (grade.spacing + GROWTH_BESIDE_BLEND * (grade.at - at)) / (1.0 + GROWTH_BESIDE_BLEND)
    });
    before.min(behind)
}

/// The spacing of places in a blend.
fn spacing_in_blend(segment: &Segment, spacing: f64) -> f64 {
    (segment.time / f64::from(PLACES_OF_BLEND_PART * segment.bends())).min(spacing)
}

/// The state of a walk along the path.
struct Walk<'a> {
    sampler: &'a ConstraintSampler,
    /// Whether there are so many segments that they do not get places of their own.
    many: bool,
    joints: Joints,
    /// The segment that was sampled last, and where it begins.
    index: usize,
    before: f64,
    /// Where derivatives jump: the number of rows that belong to the side before.
    jump: Option<usize>,
    /// The speed of an axis relative to its highest speed, now or shortly before.
    fastest: f64,
}

/// Positions of the axes at consecutive places of the path.
pub(crate) struct Stroll<'a> {
    sampler: &'a ConstraintSampler,
    joints: Joints,
    /// The segment that was reached last, and where it begins.
    index: usize,
    before: f64,
}

/// All positions at a place of the path.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Point {
    /// The parameter.
    pub(crate) at: f64,
    pub(crate) joints: Joints,
    /// Limits of the motion there.
    pub(crate) pace: PathLimits,
    /// The tool, if its path is limited.
    pub(crate) tool: Option<GuidedTool>,
}

impl Stroll<'_> {
    /// Moves on to the place `at`, which is not before the last one, and close to it.
    pub(crate) fn go_to(&mut self, at: f64) -> Point {
        let (mut pace, mut tool) = (PathLimits::FREE, None);
        let segments = &self.sampler.part;
        while let Some(segment) = segments.get(self.index) {
            let end = self.before + segment.time;
            if at < end || self.index + 1 == segments.count {
                let here = (at - self.before).min(segment.time);
                self.joints = segment.joints_on(&self.sampler.robot.kinematics, here, &self.joints);
                pace = segment.pace.unwrap_or(pace);
                tool = segment.tool(&self.sampler.robot.kinematics, here, &self.joints);
                break;
            }
            (self.before, self.index) = (end, self.index + 1);
        }
        Point { at, joints: self.joints, pace, tool }
    }
}

impl<'a> Walk<'a> {
    fn new(sampler: &'a ConstraintSampler, many: bool) -> Self {
        Self { sampler, many, joints: sampler.near, index: 0, before: sampler.part.begin, jump: None, fastest: 0.0 }
    }

    /// Leaves segments behind that end before `at`, where too many of them meet for places of their own.
    fn skip_to(&mut self, at: f64) {
        while let Some(segment) = self.sampler.part.get(self.index)
            && !segment.stops
            && self.before + segment.time < at
            && self.index + 1 < self.sampler.part.count
        {
            (self.before, self.index) = (self.before + segment.time, self.index + 1);
        }
    }

    /// Adds the limits at `at`; where a segment begins, those of the one before as well. Returns a step over which the
    /// motion changes little, no longer than `spacing`.
    fn rows(&mut self, at: f64, spacing: f64, constraints: &mut Constraints) -> f64 {
        let mut step = spacing;
        self.jump = None;
        self.skip_to(at - SAME_PLACE_SHARE * spacing);
        while let Some(segment) = self.sampler.part.get(self.index) {
            let here = (at - self.before).min(segment.time);
            self.joints = segment.joints_on(&self.sampler.robot.kinematics, here, &self.joints);
            // Where derivatives jump, those of both sides count.
            let beside = BESIDE_SHARE * segment.time;
            let jumps = segment.jumps_beside(here, 2.0 * beside);
            if segment.bends() > 1 && !self.many {
                step = step.min(spacing_in_blend(segment, spacing));
            }
            let sides = if jumps { [here - beside, here + beside] } else { [here; 2] };
            for (side, at) in sides.iter().take(if jumps { 2 } else { 1 }).enumerate() {
                if side > 0 && here > 0.0 {
                    self.jump = Some(constraints.rows.len());
                }
                let at = at.clamp(0.0, segment.time);
                if let Some(rates) =
                    segment.limit(&self.sampler.robot, at, &self.joints, self.sampler.rise, constraints)
                {
                    let longest = (STEP_SHARE_OF_SCALE * scale(&self.sampler.robot, &rates, &mut self.fastest))
                        .max(CLOSEST_SHARE_OF_SPACING * spacing);
                    step = step.min(longest);
                }
            }
            let end = self.before + segment.time;
            if at < end || segment.stops || self.index + 1 == self.sampler.part.count {
                break;
            }
            (self.before, self.index) = (end, self.index + 1);
            self.jump = Some(constraints.rows.len());
        }
        step
    }
}

/// The time over which the motion changes substantially; `fastest` is the decaying maximum of the speed so far.
fn scale(robot: &Robot, rates: &[[f64; ALL]; 3], fastest: &mut f64) -> f64 {
    let own = robot.own_axes();
    let [first, second, third] = rates.map(|all| {
        let joints = Joints::of(&all);
        let values = joints.axes.iter().take(own.len()).chain(&joints.external);
        values.zip(&robot.axes).map(|(rate, axis)| rate.abs() / axis.vel).fold(0.0, f64::max)
    });
    *fastest = first.max(FORGOTTEN_SHARE * *fastest);
    let scale = (*fastest / second).min((*fastest / third).sqrt());
    if scale.is_nan() { f64::INFINITY } else { scale }
}

fn row(bound: Constraint) -> Row {
    let Constraint { first, second, third, vel, acc, jerk } = bound;
    Row { first, second, third, vel: vel.min(1e12), acc, jerk }
}
