//! Motions whose path depends on the one behind them: they are planned once that one is known, or once none follows.

use crate::command::error::PlanError;
use crate::command::joints::Joints;
use crate::command::{Command, Settings, Target, Zone};
use crate::geometry::arc::circle_through;
use crate::geometry::spline::{Passing, SplinePoint, segment};
use crate::geometry::track::Track;
use crate::plan::curve::ToolCurve;
use crate::plan::lay_overlay::{OverlayStart, lay};
use crate::plan::motion::Motion;
use crate::plan::planner::Planner;
use arl_robot::kinematics::Frame;
use arl_robot::robot::Robot;

/// Points of a spline no farther apart than this, in mm, are the same: the tool only turns there.
const SAME_POINT_MM: f64 = 1e-3;

/// The kinds of motion that form one path together with their neighbours.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Kind {
    /// Circles through the targets of neighbours ([`crate::command::Target::Circle`]).
    Circle,
    /// Splines ([`crate::command::Target::Spline`]).
    Spline,
}

/// A motion that has been added, but is not planned yet.
#[derive(Clone, Debug)]
pub(crate) struct DeferredMotion {
    kind: Kind,
    command: Command,
    settings: Settings,
    pub(crate) number: u64,
    /// Where the robot is when the motion begins, and where the motion ends, as far as that is known already: without
    /// overlays.
    start: Joints,
    end: Joints,
    target: SplinePoint,
    before: Option<Predecessor>,
}

/// What the motion before, of the same kind and already planned, passes on to the next one.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Predecessor {
    /// Where the previous circle began.
    Circle(Joints),
    /// How the spline continues.
    Spline(Passing),
}

impl Target {
    /// The kind of path that the target forms with its neighbours, with its pose, workpiece frame and external axes.
    pub(crate) fn chained(&self) -> Option<(Kind, &[f64; 6], &Frame, &[f64; 6])> {
        match self {
            Target::Circle { pose, wobj, external, .. } => Some((Kind::Circle, pose, wobj, external)),
            Target::Spline { pose, wobj, external } => Some((Kind::Spline, pose, wobj, external)),
            _ => None,
        }
    }
}

impl DeferredMotion {
    /// Holds back a motion that starts at `start`; `None` for a kind that does not have to wait.
    pub(crate) fn new(
        robot: &Robot,
        start: &Joints,
        command: &Command,
        settings: &Settings,
        number: u64,
    ) -> Result<Option<Self>, PlanError> {
        let Some((kind, pose, wobj, external)) = command.target.chained() else { return Ok(None) };
        let planner = Planner { robot, start, command, settings };
        let tcp = planner.target_frame(pose, wobj)?;
        planner.tcp_speed()?;
        let end = Joints { axes: start.axes, external: *external }.completed(start, robot);
        let flange = command.rig.carried.flange_at(&tcp);
        let kinematics = &robot.kinematics;
        let axes = kinematics
            .inverse(&flange, kinematics.cfg(&start.axes), &start.axes)
            .ok_or_else(|| planner.refused(kinematics.refusal(&flange)))?;
        let end = Joints { axes, ..end };
        Ok(Some(Self {
            kind,
            command: command.clone(),
            settings: *settings,
            number,
            start: *start,
            end,
            target: SplinePoint { tcp, external: end.external },
            before: None,
        }))
    }

    /// Where it ends, as far as that is known.
    pub(crate) fn end(&self) -> &Joints {
        &self.end
    }

    /// Whether it can be the last of its kind.
    pub(crate) fn can_end(&self) -> bool {
        self.kind == Kind::Spline || self.before.is_some()
    }

    /// Whether the next motion forms one path with this one.
    pub(crate) fn goes_on(&self, robot: &Robot, next: &DeferredMotion) -> bool {
        self.kind == next.kind
            && match self.kind {
                Kind::Circle => {
                    let carried = |deferred: &DeferredMotion| std::mem::discriminant(&deferred.command.rig.carried);
                    carried(self) == carried(next)
                }
                Kind::Spline => self.command.rig.carried == next.command.rig.carried && !self.breaks_off(robot, next),
            }
    }

    /// Whether a spline has to end here and a new one to begin: points are the same, the path turns back, or another
    /// compensation begins to grow, which would not flow.
    fn breaks_off(&self, robot: &Robot, next: &DeferredMotion) -> bool {
        let from = self.from(robot);
        self.settings.compensation != next.settings.compensation
            || from.chord(&self.target) <= SAME_POINT_MM
            || self.target.chord(&next.target) <= SAME_POINT_MM
            || from.turns_back(&self.target, &next.target)
    }

    /// Lets it end with a stop, whatever its zone, where only [`DeferredMotion::breaks_off`] separates the next motion
    /// from the same spline: zones do not apply within a spline.
    pub(crate) fn stop_before(&mut self, robot: &Robot, next: &DeferredMotion) {
        if [self.kind, next.kind] == [Kind::Spline; 2] && self.breaks_off(robot, next) {
            self.command.zone = Zone::NONE;
        }
    }

    fn from(&self, robot: &Robot) -> SplinePoint {
        let tcp = self.command.rig.carried.path_frame_at(&robot.kinematics.forward(&self.start.axes));
        SplinePoint { tcp, external: self.start.external }
    }

    /// Plans it without overlays, together with the next motion of its path. Also returns what it passes on to that
    /// motion.
    ///
    /// # Errors
    /// It cannot be planned; the error contains its line.
    pub(crate) fn plan(
        &self,
        robot: &Robot,
        next: Option<&DeferredMotion>,
    ) -> Result<(Motion, Option<Predecessor>), PlanError> {
        let planner = Planner { robot, start: &self.start, command: &self.command, settings: &self.settings };
        let planned = match self.kind {
            Kind::Circle => self.circle(&planner, next),
            Kind::Spline => self.spline(&planner, next),
        };
        planned.map_err(|error| self.failed(error))
    }

    /// Whether its weave continues into the motion that forms one path with it.
    pub(crate) fn weaves_on(&self, next: &DeferredMotion) -> bool {
        self.kind == Kind::Spline && self.settings.weave == next.settings.weave
    }

    /// Adds the overlays of its settings to the planned motion.
    ///
    /// # Errors
    /// It cannot be executed with them; the error contains its line.
    pub(crate) fn laid(&self, robot: &Robot, plain: Motion, beginning: &OverlayStart<'_>) -> Result<Motion, PlanError> {
        let Some((_, _, wobj, _)) = self.command.target.chained() else { return Ok(plain) };
        lay(robot, plain, beginning, &wobj.rotation, &self.settings).map_err(|error| self.failed(error))
    }

    fn failed(&self, error: PlanError) -> PlanError {
        PlanError::Earlier { line: self.command.line, error: Box::new(error) }
    }

    /// The command.
    pub(crate) fn command(&self) -> &Command {
        &self.command
    }

    /// The settings at the time when it was added.
    pub(crate) fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Takes over what the motion before has passed on.
    pub(crate) fn goes_on_from(&mut self, end: &Joints, before: Option<Predecessor>) {
        (self.start, self.before) = (*end, before);
    }

    /// Notes that a circle began at `start`.
    pub(crate) fn follows_circle_from(&mut self, start: Joints) {
        self.before.get_or_insert(Predecessor::Circle(start));
    }

    fn circle(
        &self,
        planner: &Planner<'_>,
        next: Option<&DeferredMotion>,
    ) -> Result<(Motion, Option<Predecessor>), PlanError> {
        let Target::Circle { follow, external, .. } = &self.command.target else { return Err(PlanError::NoCircle) };
        let (start, target) = (planner.start_frame(), self.target.tcp);
        let [from, to] = [start, target].map(|frame| frame.translation.vector);
        let points = match (next, self.before) {
            (Some(next), _) => [from, to, next.target.tcp.translation.vector],
            (None, Some(Predecessor::Circle(before))) => {
                let before = self.command.rig.carried.path_frame_at(&planner.robot.kinematics.forward(&before.axes));
                [before.translation.vector, from, to]
            }
            _ => return Err(PlanError::LoneCircle),
        };
        let arc = circle_through(&points).ok_or(PlanError::NoCircle)?.arc(&from, &to);
        let turning = if *follow {
            arc.across.cross(&arc.along).normalize() * arc.sweep
        } else {
            (target.rotation * start.rotation.inverse()).scaled_axis()
        };
        let motion = planner.tool(Track::Arc(arc), turning, external)?;
        Ok((motion, Some(Predecessor::Circle(self.start))))
    }

    fn spline(
        &self,
        planner: &Planner<'_>,
        next: Option<&DeferredMotion>,
    ) -> Result<(Motion, Option<Predecessor>), PlanError> {
        let from = self.from(planner.robot);
        let speed = planner.tcp_speed()?;
        let start = match self.before {
            Some(Predecessor::Spline(passing)) => Some(passing),
            _ => None,
        };
        let end = match next {
            Some(next) => {
                let settings = &next.settings;
                let other = Planner { robot: planner.robot, start: &self.end, command: &next.command, settings };
                Some(Passing::through([&from, &self.target, &next.target], speed.min(other.tcp_speed()?)))
            }
            None => None,
        };
        if start.is_none() && end.is_none() {
            let Target::Spline { external, .. } = &self.command.target else { return Err(PlanError::NotANumber) };
            let track = Track::line(from.tcp.translation.vector, self.target.tcp.translation.vector);
            let turning = (self.target.tcp.rotation * from.tcp.rotation.inverse()).scaled_axis();
            return Ok((planner.tool(track, turning, external)?, None));
        }
        let base = planner.even_curve(
            Track::line(from.tcp.translation.vector, from.tcp.translation.vector),
            nalgebra::Vector3::zeros(),
            &self.end,
        );
        let (path, external, time) = segment([&from, &self.target], [start.as_ref(), end.as_ref()], speed);
        let curve = ToolCurve { path, external, ..base };
        let motion = planner.segment(curve, time, &self.target.external, start.is_some())?;
        Ok((motion, end.map(Predecessor::Spline)))
    }
}
