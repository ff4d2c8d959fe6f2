//! Goes through the statements of each function and checks its motions, tracking what is known at each point.

use super::super::first_motion::GlobalPoints;
use super::constants::{ConstantScope, argument};
use super::facts::ProgramFacts;
use super::judge::{self, TcpLine, Verdict};
use super::state::{MotionState, flange, world};
use crate::diagnostics::targets::TargetProblem;
use crate::hir::{Block, Builtin, Expr, ExprKind, For, ModuleId, Place, Program, Root, Stmt, StmtKind};
use crate::visit;
use arl_lang::catalog::{Effect, Motion, Role};
use arl_lang::span::Span;
use arl_robot::Robot;
use arl_robot::frames::{Mount, Setting};
use arl_robot::kinematics::Frame;

/// How a motion reaches its target.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Approach {
    /// By the axes, to the configuration given in the target.
    Axes,
    /// Along a path, in the configuration of the start.
    Path,
}

/// Reports a problem with a target in a module.
type Tell<'a> = dyn FnMut(ModuleId, Span, TargetProblem, Vec<Also>) + 'a;

/// Another position related to the problem.
pub(super) type Also = (ModuleId, Span, &'static str);

/// Checks the motions of all functions.
pub(super) fn each_function(program: &Program, robot: &Robot, facts: &ProgramFacts, tell: &mut Tell<'_>) {
    for (at, func) in program.funcs.iter().enumerate() {
        let is_main = program.main.is_some_and(|main| main.0 as usize == at) && !facts.main_is_called;
        let state = match program.main {
            _ if is_main => MotionState { tool: Some(flange()), wobj: Some(world()), ..MotionState::UNKNOWN },
            // It may be called from anywhere in the program.
            Some(_) => MotionState {
                tool: facts.everywhere.tool.only(flange()),
                wobj: facts.everywhere.wobj.only(world()),
                ..MotionState::UNKNOWN
            },
            // Other programs may call it.
            None => MotionState::UNKNOWN,
        };
        let globals = if facts.teaches { GlobalPoints::Unwritten } else { GlobalPoints::AsTaught };
        let mut walk = Walk { scope: ConstantScope { program, func, globals }, robot, facts, state, tell: &mut *tell };
        walk.block(&func.body);
    }
}

struct Walk<'a, 't> {
    scope: ConstantScope<'a>,
    robot: &'a Robot,
    facts: &'a ProgramFacts,
    state: MotionState,
    tell: &'t mut Tell<'t>,
}

impl<'a> Walk<'a, '_> {
    fn report(&mut self, span: Span, problem: TargetProblem) {
        (self.tell)(self.scope.func.module, span, problem, Vec::new());
    }

    /// Reports a target together with the places where it is given and where tool and workpiece were set.
    fn report_target(&mut self, motion: &Builtin, target: &Expr, problem: TargetProblem) {
        let module = self.scope.func.module;
        let mut also = Vec::new();
        if let ExprKind::Place(place) = &target.kind
            && let Root::Global(id) = place.root
            && let Some(global) = self.scope.program.globals.get(id.0 as usize)
        {
            also.push((global.module, global.span, "the target is given here"));
        }
        let held = |label: &str, from: Option<Span>, mount: Option<Mount>, start: Mount| {
            from.filter(|_| argument(motion, label).is_none() && mount.is_some_and(|mount| mount != start))
        };
        let frame = held("w", self.state.wobj_from, self.state.wobj, world());
        let tool = held("t", self.state.tool_from, self.state.tool, flange());
        also.extend(frame.map(|from| (module, from, "the workpiece frame in force was set here")));
        also.extend(tool.map(|from| (module, from, "the tool in force was set here")));
        let problem = problem.with_inherited(frame.is_some(), tool.is_some());
        (self.tell)(module, target.span, problem, also);
    }

    fn block(&mut self, block: &'a Block) {
        block.iter().for_each(|stmt| self.stmt(stmt));
    }

    fn stmt(&mut self, stmt: &'a Stmt) {
        match &stmt.kind {
            StmtKind::Let(_, init) => init.iter().for_each(|init| self.expr(init)),
            StmtKind::Eval(expr) => self.expr(expr),
            StmtKind::If(arms, otherwise) => self.branches(arms, otherwise.as_ref()),
            StmtKind::Switch(subject, arms) => {
                self.expr(subject);
                let before = self.state.clone();
                let complete = arms.iter().any(|arm| arm.value.is_none());
                let mut after = MotionState { dead: complete, ..before.clone() };
                for arm in arms {
                    self.state = before.clone();
                    self.block(&arm.body);
                    after = after.or(self.state.clone());
                }
                self.state = after;
            }
            StmtKind::While(condition, body, _) | StmtKind::Repeat(body, condition, _) => {
                self.round(&[condition], body);
            }
            StmtKind::Loop(body, _) => self.round(&[], body),
            StmtKind::For(each) => self.counted(each),
            StmtKind::Return(value) => {
                value.iter().for_each(|value| self.expr(value));
                self.state.dead = true;
            }
            StmtKind::Break | StmtKind::Continue | StmtKind::Goto(_) => self.state.dead = true,
            StmtKind::Label(label) => {
                if self.scope.func.labels.get(label.0 as usize).is_none_or(|label| label.used) {
                    self.state = MotionState::UNKNOWN;
                }
            }
        }
    }

    fn branches(&mut self, arms: &'a [(Expr, Block)], otherwise: Option<&'a Block>) {
        let mut after: Option<MotionState> = None;
        for (condition, block) in arms {
            self.expr(condition);
            let before = self.state.clone();
            self.block(block);
            let there = std::mem::replace(&mut self.state, before);
            after = Some(match after {
                Some(after) => after.or(there),
                None => there,
            });
        }
        otherwise.iter().for_each(|block| self.block(block));
        if let Some(after) = after {
            self.state = after.or(self.state.clone());
        }
    }

    fn counted(&mut self, each: &'a For) {
        self.block(&each.init);
        let ends: Vec<&Expr> = each.condition.iter().chain(&each.step).collect();
        self.round(&ends, &each.body);
    }

    /// A loop: what a round may change is unknown inside and after the loop.
    fn round(&mut self, ends: &[&'a Expr], body: &'a Block) {
        for end in ends {
            self.state.may(&self.facts.of_expr(self.scope, end));
        }
        self.state.may(&self.facts.of_block(self.scope, body));
        let before = self.state.clone();
        ends.iter().for_each(|end| self.expr(end));
        self.block(body);
        self.state = before;
    }

    fn expr(&mut self, expr: &'a Expr) {
        match &expr.kind {
            ExprKind::Builtin(builtin) if builtin.entry.effect == Effect::Plans => {
                self.parts(expr);
                self.motion(builtin);
            }
            ExprKind::Builtin(builtin) if builtin.entry.effect == Effect::Ends => self.state.dead = true,
            ExprKind::Assign(both) if both.0.path.is_empty() => {
                self.parts(expr);
                self.assign(&both.0, &both.1);
            }
            _ => {
                self.parts(expr);
                self.state.may(&self.facts.of_one(self.scope, expr));
            }
        }
    }

    /// What the parts of an expression may change, and the motions in them.
    fn parts(&mut self, expr: &'a Expr) {
        visit::exprs(expr, &mut |part| {
            if std::ptr::eq(part, expr) {
                return;
            }
            // The time of the motion is unknown.
            if let ExprKind::Builtin(builtin) = &part.kind
                && builtin.entry.effect == Effect::Plans
            {
                self.state = MotionState::UNKNOWN;
                self.motion(builtin);
                self.state = MotionState::UNKNOWN;
            }
            self.state.may(&self.facts.of_one(self.scope, part));
        });
    }

    fn assign(&mut self, place: &Place, value: &'a Expr) {
        let Root::System(variable) = place.root else { return };
        let mount = |state: &MotionState| self.scope.mount(value, state);
        match variable.role {
            Some(Role::DefaultTool) => {
                self.state.tool = mount(&self.state);
                self.state.tool_from = Some(place.span);
            }
            Some(Role::DefaultWorkpiece) => {
                self.state.wobj = mount(&self.state);
                self.state.wobj_from = Some(place.span);
            }
            _ => {}
        }
    }

    /// A motion: its tool and workpiece stay in effect for the motions after it.
    fn motion(&mut self, motion: &'a Builtin) {
        let Some(kind) = motion.entry.motion else { return };
        if let Some(tool) = argument(motion, "t") {
            self.state.tool = self.scope.mount(tool, &self.state);
            self.state.tool_from = Some(tool.span);
        }
        if let Some(wobj) = argument(motion, "w") {
            self.state.wobj = self.scope.mount(wobj, &self.state);
            self.state.wobj_from = Some(wobj.span);
        }
        self.state.may(&self.facts.anytime);
        let before = (self.state.cfg, self.state.axes);
        (self.state.cfg, self.state.axes) = (None, None);
        if kind.keeps_configuration() && self.facts.lines_keep_cfg {
            self.state.cfg = before.0;
        }
        match kind {
            Motion::Joint => self.joint_target(motion),
            Motion::PointToPoint | Motion::Jump => self.pose_target(motion, Approach::Axes, before.1),
            Motion::Line | Motion::Spline => self.pose_target(motion, Approach::Path, before.1),
            Motion::Arc if self.facts.arcs_turn_to_targets => self.pose_target(motion, Approach::Path, before.1),
            // The end of such an arc is not known from its instruction alone.
            Motion::Arc | Motion::JoinedArc => {}
        }
    }

    fn joint_target(&mut self, motion: &'a Builtin) {
        let Some(target) = argument(motion, "j") else { return };
        let Some(joints) = self.scope.joints(target) else { return };
        if let Some(problem) = judge::joints(self.robot, &joints) {
            self.report_target(motion, target, problem);
        }
        let mut axes = [0.0; 6];
        for (place, axis) in axes.iter_mut().zip(self.robot.own_axes()) {
            let Some((_, value)) = joints.iter().find(|(name, _)| axis.name.eq_ignore_ascii_case(name)) else { return };
            *place = *value;
        }
        self.stands(axes);
    }

    fn pose_target(&mut self, motion: &'a Builtin, approach: Approach, start: Option<[f64; 6]>) {
        if !self.facts.plain_frames || argument(motion, "ca").is_some() {
            return;
        }
        let Some(target) = argument(motion, "p") else { return };
        let (Some(tool), Some(wobj)) = (self.state.tool, self.state.wobj) else { return };
        let Some(pose) = self.scope.pose(target) else { return };
        let setting = Setting::new(tool, wobj, Frame::identity());
        let Ok(flange) = setting.flange_of(&pose.frame) else { return };
        let cfg = match approach {
            Approach::Path => self.state.cfg,
            Approach::Axes if !self.facts.as_taught => None,
            Approach::Axes => match pose.cfg.map(u8::try_from) {
                None => None,
                Some(Ok(cfg)) => Some(cfg),
                Some(Err(_)) => {
                    let problem = TargetProblem::no_such_cfg(self.robot, pose.cfg.unwrap_or_default());
                    return self.report(target.span, problem);
                }
            },
        };
        match judge::pose(self.robot, &flange, cfg) {
            Verdict::Refused(problem) => self.report_target(motion, target, problem),
            Verdict::Open => {}
            Verdict::Reached(axes) => {
                let Some(cfg) = cfg else { return };
                if let (Some(start), Some(Motion::Line), true) = (start, motion.entry.motion, self.is_plain_line()) {
                    let line = TcpLine {
                        start: &start,
                        carried: setting.rig().carried,
                        end: setting.workpiece() * pose.frame,
                        cfg,
                    };
                    if let Some(problem) = judge::line(self.robot, &line) {
                        self.report_target(motion, target, problem);
                    }
                }
                if (approach == Approach::Axes || self.is_plain_line()) && argument(motion, "sig").is_none() {
                    self.stands(axes);
                }
            }
        }
    }

    /// Whether lines go straight from target to target.
    fn is_plain_line(&self) -> bool {
        self.facts.lines_are_exact && self.facts.lines_keep_cfg
    }

    /// The motion ends with these axis positions; near a singular point some axes may be elsewhere.
    fn stands(&mut self, axes: [f64; 6]) {
        let kinematics = &self.robot.kinematics;
        if kinematics.clearance(&axes) > judge::OPEN {
            self.state.cfg = Some(kinematics.cfg(&axes));
            self.state.axes = Some(axes);
        }
    }
}
