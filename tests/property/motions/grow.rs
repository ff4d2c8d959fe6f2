//! Random motion programs, of the forms that `plan.rs` reads.

mod handlers;

use super::plan::{Goal, Kind, Mode, Plan};
use super::robot::Robot;
use arl_tests::random::Random;
pub(crate) use handlers::HANDLERS;
use std::fmt::Write as _;

/// A number between two others.
pub(crate) fn between(random: &mut Random, from: f64, to: f64) -> f64 {
    from + (to - from) * (random.next() >> 11) as f64 / (1_u64 << 53) as f64
}

/// Where a kind of robot can move freely, and how far from there the axes may go.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Room {
    pub(crate) robot: &'static str,
    pub(crate) joints: [f64; 6],
    /// deg (mm)
    pub(crate) swing: f64,
    /// mm
    pub(crate) reach: f64,
}

/// Rooms of all built-in robots; the last one is about the wrist singularity, which `$WRIST` passes.
pub(crate) const ROOMS: [Room; 8] = [
    Room { robot: "kr10-r1420", joints: [0.0, -90.0, 90.0, 0.0, 45.0, 0.0], swing: 12.0, reach: 120.0 },
    Room { robot: "kr6-r700", joints: [10.0, -90.0, 100.0, 5.0, 45.0, 0.0], swing: 12.0, reach: 70.0 },
    Room { robot: "irb2400-10", joints: [0.0, 10.0, 10.0, 5.0, 45.0, 0.0], swing: 12.0, reach: 120.0 },
    Room { robot: "tx2-60", joints: [0.0, 20.0, 70.0, 5.0, 45.0, 0.0], swing: 12.0, reach: 60.0 },
    Room { robot: "six-10", joints: [0.0, 10.0, 20.0, 5.0, 45.0, 0.0], swing: 12.0, reach: 120.0 },
    Room { robot: "hsr065", joints: [20.0, 85.0, 50.0, 10.0, 0.0, 0.0], swing: 12.0, reach: 70.0 },
    Room { robot: "cobra600", joints: [5.0, 60.0, -105.0, 0.0, 0.0, 0.0], swing: 8.0, reach: 40.0 },
    Room { robot: "kr10-r1420", joints: [0.0, -80.0, 80.0, 3.0, 6.0, 0.0], swing: 8.0, reach: 80.0 },
];

/// What a program shall be like.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wishes {
    /// How many motions, about.
    pub(crate) count: usize,
    /// Whether it is about the wrist singularity.
    pub(crate) passes: bool,
    /// Whether inputs let it stop its motion and go on.
    pub(crate) stops: bool,
    pub(crate) mode: Mode,
}

struct Grower<'a> {
    random: &'a mut Random,
    room: Room,
    robot: &'a Robot,
    text: String,
    count: usize,
    settings: usize,
    /// The setting whose tool stands, where there is one.
    standing: Option<usize>,
    /// The last motion's kind, goal and setting.
    last: Option<(Kind, Goal, usize)>,
    waited: bool,
}

/// The text of a program.
pub(crate) fn grow(random: &mut Random, room: Room, robot: &Robot, wishes: Wishes) -> String {
    let text = String::new();
    let (count, settings, standing) = (0, 1, None);
    let mut grower = Grower { random, room, robot, text, count, settings, standing, last: None, waited: false };
    grower.program(wishes);
    grower.text
}

fn rounded(value: f64) -> f64 {
    (value * 1e3).round() / 1e3
}

fn list(values: &[f64]) -> String {
    format!("{values:?}").replace('[', "{").replace(']', "}").replace(' ', "")
}

impl Grower<'_> {
    fn line(&mut self, text: &str) {
        writeln!(self.text, "{text}").unwrap();
    }

    fn about(&mut self, most: f64) -> f64 {
        rounded(between(self.random, -most, most))
    }

    fn program(&mut self, wishes: Wishes) {
        self.profile();
        if wishes.passes {
            self.line("  $WRIST = true");
        }
        let (exj, exl) = (between(self.random, 20.0, 120.0).round(), between(self.random, 80.0, 800.0).round());
        let ori = between(self.random, 40.0, 500.0).round();
        self.line(&format!("  $DFSPEED = {{20,100,{ori},{exj},{exl}}}"));
        for at in 1..1 + self.random.below(3) {
            self.setting(at);
            self.settings += 1;
        }
        for at in 0..4 {
            self.teach(at);
        }
        for at in 0..4 {
            let [before, argument] = self.robot.tool_of_movej("$FLANGE");
            self.line(&format!("{before}  movej j{at},vp:40,sl:-1{argument}"));
            self.waited = true;
            self.line("  waittime 0");
            if at == 0 && self.random.chance(35) {
                self.standing_tool();
            }
            for setting in 0..self.settings {
                let (tool, wobj) = names(setting);
                self.line(&format!("  pose p{setting}_{at} = cpose({tool},{wobj})"));
            }
        }
        self.last = Some((Kind::Movej, Goal::Taught(3), 0));
        let mut functions = String::new();
        if wishes.stops {
            let declarations;
            (functions, declarations) = self.handlers(wishes.mode);
            self.text.push_str(&declarations);
        }
        while self.count < wishes.count {
            self.overrides();
            self.motion();
            if self.random.chance(12) {
                self.wait();
            }
            if self.random.chance(6) {
                self.profile();
            }
        }
        self.line("  waittime 0");
        self.line("endfunc");
        let (robot, mode, main) = (&self.robot.name, wishes.mode.word(), &self.text);
        self.text = format!("// robot: {robot}\n// mode: {mode}\n{functions}func void main()\n{main}");
    }

    /// A tool that stands near where the flange is, and a workpiece on the flange.
    fn standing_tool(&mut self) {
        let at = self.settings;
        let tilt = if self.robot.scara { 0.0 } else { 40.0 };
        let tool = [60.0, 60.0, 90.0, 90.0, tilt, tilt].map(|most| self.about(most));
        let wobj = [60.0, 60.0, 60.0, 90.0, tilt, tilt].map(|most| self.about(most));
        let shift = list(&tool).replace(['{', '}'], "");
        self.line(&format!("  pose c{at} = reltool(cpose($FLANGE,$WORLD),{shift})"));
        self.line(&format!("  tool t{at} = {{{{c{at}.x,c{at}.y,c{at}.z,c{at}.a,c{at}.b,c{at}.c}},true}}"));
        self.line(&format!("  wobj w{at} = {{{},true}}", list(&wobj)));
        self.standing = Some(at);
        self.settings += 1;
    }

    fn teach(&mut self, at: usize) {
        let mut joints = self.room.joints[..self.robot.own].to_vec();
        if at > 0 {
            for joint in &mut joints {
                *joint = rounded(*joint + between(self.random, -self.room.swing, self.room.swing));
            }
        }
        let external = self.external();
        joints.extend(external);
        self.line(&format!("  joint j{at} = {}", list(&joints)));
    }

    /// How far external axes are from where they begin.
    fn external(&mut self) -> Vec<f64> {
        let external = &self.robot.axes[self.robot.own..];
        let travels: Vec<f64> = external.iter().map(|axis| if axis.linear { 120.0 } else { 25.0 }).collect();
        travels.into_iter().map(|travel| self.about(travel)).collect()
    }

    /// A tool and a workpiece frame.
    fn setting(&mut self, at: usize) {
        let tilt = if self.robot.scara { 0.0 } else { 40.0 };
        let tool = [60.0, 60.0, 90.0, 90.0, tilt, tilt].map(|most| self.about(most));
        let wobj = [400.0, 400.0, 100.0, 90.0, tilt, tilt].map(|most| self.about(most));
        self.line(&format!("  tool t{at} = {{{},false}}", list(&tool)));
        self.line(&format!("  wobj w{at} = {{{},false}}", list(&wobj)));
    }

    /// Lets the robot come to rest.
    fn wait(&mut self) {
        let time = *self.random.pick(&["0", "0", "0.02", "0.15"]);
        self.line(&format!("  waittime {time}"));
        self.waited = true;
    }

    fn profile(&mut self) {
        let profile = *self.random.pick(&["O_type", "O_type", "S_type", "S_type", "S_type", "T_type"]);
        self.line(&format!("  $VEL_PROFILE = {profile}"));
    }

    fn overrides(&mut self) {
        if self.random.chance(8) {
            let [acc, ramp] = [0, 1].map(|_| *self.random.pick(&[30, 60, 100, 100]));
            self.line(&format!("  accset {acc},{ramp}"));
        }
        if self.random.chance(6) {
            let (part, most) = (*self.random.pick(&[25, 60, 100, 100]), *self.random.pick(&[150, 600, 3000, 3000]));
            self.line(&format!("  velset {part},{most}"));
        }
    }

    fn zone(&mut self, leads_tool: bool) -> String {
        let mut size = |most: f64| between(self.random, 1.0, most).round();
        let (part, distance, turn, external, linear) = (size(100.0), size(60.0), size(15.0), size(20.0), size(80.0));
        match self.random.below(6) {
            0 => "sl:-1".into(),
            1 => format!("sp:{part}"),
            2 if leads_tool => format!("s:{{perdis -1,pdis {distance},odis {turn},ejdis {external},eldis {linear}}}"),
            2 if self.robot.scara => format!("s:{{perdis -1,pdis {distance},ejdis {external},eldis {linear}}}"),
            2 => format!("s:{{perdis -1,jdis {turn},ejdis {external},eldis {linear}}}"),
            _ => format!("sl:{distance}"),
        }
    }

    fn motion(&mut self) {
        let scara = self.robot.scara;
        match self.random.below(14) {
            0 | 1 => {
                let at = self.random.below(4);
                self.movej(at);
            }
            2 | 3 => {
                let goal = self.goal();
                self.add(Kind::Ptp, goal);
            }
            kind @ 4..=6 => {
                let setting = self.random.below(self.settings);
                let (via, end) = self.arc(setting);
                if kind == 6 && !scara {
                    // Four `ccir` in a row would be something else than two times two.
                    if matches!(self.last, Some((Kind::Ccir, ..))) && !self.waited {
                        self.wait();
                    }
                    self.add_with(Kind::CcirVia, Goal::Shifted(via, self.no_shift()), None, setting);
                    self.add_with(Kind::Ccir, end, None, setting);
                } else {
                    self.add_with(Kind::Cir([0.0; 3]), end, Some(via), setting);
                }
            }
            7 => {
                let setting = self.random.below(self.settings);
                for _ in 0..2 + self.random.below(3) {
                    let goal = self.goal();
                    self.add_with(Kind::Spl, goal, None, setting);
                }
            }
            8 | 9 if scara => {
                // The height of a tool that stands says nothing.
                let (goal, setting) = (self.goal(), self.random.below(self.settings));
                let setting = if self.standing == Some(setting) { 0 } else { setting };
                self.add_with(Kind::Jump([0.0; 2]), goal, None, setting);
            }
            _ => {
                let goal = self.goal();
                self.add(Kind::Lin, goal);
            }
        }
    }

    fn no_shift(&self) -> Vec<f64> {
        vec![0.0; self.robot.axes.len() - self.robot.own]
    }

    fn movej(&mut self, at: usize) {
        if self.last.as_ref().is_none_or(|(_, goal, _)| *goal != Goal::Taught(at)) {
            self.add(Kind::Movej, Goal::Taught(at));
        }
    }

    /// What is added to the first taught pose.
    fn shift(&mut self) -> [f64; 6] {
        let reach = self.room.reach;
        let tilt = if self.robot.scara { 0.0 } else { 8.0 };
        let mut shift = [reach, reach, reach, 8.0, tilt, tilt].map(|most| self.about(most));
        if self.random.chance(40) {
            shift[3..].fill(0.0);
        }
        shift
    }

    /// The second and the third point of an arc that stays in the room.
    fn arc(&mut self, setting: usize) -> ([f64; 6], Goal) {
        let start = match &self.last {
            Some((_, Goal::Shifted(start, _), last)) if *last == setting => *start,
            _ => {
                let start = self.shift();
                let goal = Goal::Shifted(start, self.external());
                self.add_with(Kind::Lin, goal, None, setting);
                start
            }
        };
        loop {
            let end = self.shift();
            let chord: f64 = (0..3).map(|i| (end[i] - start[i]).powi(2)).sum::<f64>().sqrt();
            if chord > self.room.reach / 2.0 {
                // Out of the line by a tenth to a half of its length, for the axis that the line follows least.
                let across = (0..3).min_by(|a, b| (end[*a] - start[*a]).abs().total_cmp(&(end[*b] - start[*b]).abs()));
                let mut via: [f64; 6] = std::array::from_fn(|i| f64::midpoint(start[i], end[i]));
                via[across.expect("three axes")] += chord * between(self.random, 0.1, 0.5);
                return (via.map(rounded), Goal::Shifted(end, self.external()));
            }
        }
    }

    fn goal(&mut self) -> Goal {
        let at = self.random.below(16);
        let last = self.last.as_ref().map(|(_, goal, _)| goal.clone());
        match Goal::Taught(at) {
            goal if at < 4 && Some(&goal) != last.as_ref() => goal,
            _ => Goal::Shifted(self.shift(), self.external()),
        }
    }

    /// A motion in any setting; mostly in that of the last one, so that corners of lines have one tool.
    fn add(&mut self, kind: Kind, goal: Goal) {
        let last = self.last.as_ref().map_or(0, |(_, _, setting)| *setting);
        let setting = if self.random.chance(75) { last } else { self.random.below(self.settings) };
        self.add_with(kind, goal, None, setting);
    }

    fn add_with(&mut self, kind: Kind, goal: Goal, via: Option<[f64; 6]>, setting: usize) {
        let head = match kind {
            Kind::Movej => "movej",
            Kind::Ptp => "ptp",
            Kind::Lin => "lin",
            Kind::Cir(_) => "cir",
            Kind::CcirVia | Kind::Ccir => "ccir",
            Kind::Spl => "spl",
            Kind::Jump(_) => "jump",
        };
        let mut parts = Vec::new();
        if let Some(via) = via {
            parts.push(format!("m:{}", shifted(setting, &via, &[])));
        }
        parts.push(match &goal {
            Goal::Taught(at) if kind == Kind::Movej => format!("j{at}"),
            Goal::Taught(at) => format!("p:p{setting}_{at}"),
            Goal::Shifted(shift, external) => format!("p:{}", shifted(setting, shift, external)),
        });
        parts.push(self.speed(kind));
        if matches!(kind, Kind::Jump(_)) {
            parts.push(format!("a:{},b:{}", self.random.below(30), self.random.below(30)));
            parts.push(format!("s:{}", self.random.chance(50)));
        } else {
            parts.push(self.zone(kind.leads_tool()));
        }
        let (tool, wobj) = names(setting);
        let [before, last] = match kind {
            Kind::Movej => self.robot.tool_of_movej(&tool),
            _ => [String::new(), format!(",t:{tool},w:{wobj}")],
        };
        self.line(&format!("{before}  {head} {}{last}", parts.join(",")));
        self.count += 1;
        self.last = Some((kind, goal, setting));
        self.waited = false;
    }

    fn speed(&mut self, kind: Kind) -> String {
        let percent = between(self.random, 10.0, 100.0).round();
        let tcp = between(self.random, 40.0, 1200.0).round();
        let timed = !matches!(kind, Kind::CcirVia | Kind::Ccir | Kind::Spl | Kind::Jump(_));
        match self.random.below(20) {
            0 if timed => format!("dura:{:.1}", between(self.random, 4.0, 6.0)),
            1 | 2 => {
                let [ori, exj, exl] = [(30.0, 400.0), (20.0, 120.0), (80.0, 800.0)]
                    .map(|(from, to)| between(self.random, from, to).round());
                format!("v:{{{percent},{tcp},{ori},{exj},{exl}}}")
            }
            3..=5 if kind.leads_tool() => format!("vp:{}", between(self.random, 3.0, 70.0).round()),
            _ if kind.leads_tool() => format!("vl:{tcp}"),
            _ => format!("vp:{percent}"),
        }
    }
}

fn names(setting: usize) -> (String, String) {
    if setting == 0 { ("$FLANGE".into(), "$WORLD".into()) } else { (format!("t{setting}"), format!("w{setting}")) }
}

/// The first taught pose in a setting, with so much added.
fn shifted(setting: usize, shift: &[f64; 6], external: &[f64]) -> String {
    let names = ["x", "y", "z", "a", "b", "c", "ej1", "ej2"];
    let components = names.iter().zip(shift.iter().chain(external));
    let components: Vec<String> =
        components.map(|(name, part)| format!("{name} p{setting}_0.{name} + ({part:?})")).collect();
    format!("{{{}}}", components.join(","))
}

/// The plan of a program that is grown anew.
pub(crate) fn plan(random: &mut Random, room: Room, robot: &Robot, wishes: Wishes) -> Plan {
    Plan::read(&grow(random, room, robot, wishes), &robot.tcp)
}
