//! What the motions of a program must do, read from its text: programs of a few forms that `grow.rs` writes, and that a
//! person can shorten.

use super::geometry::{Frame, frame};
use super::robot::Tcp;

/// mm/s that the TCP keeps to in manual operation.
pub(crate) const MANUAL: f64 = 250.0;

/// What a motion is told about its target.
#[derive(Clone, PartialEq, Debug)]
pub(crate) enum Goal {
    /// One of the taught positions.
    Taught(usize),
    /// The pose of the first taught position in the motion's workpiece frame, so much added to each component, and to
    /// each external axis.
    Shifted([f64; 6], Vec<f64>),
}

#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum Kind {
    Movej,
    Ptp,
    Lin,
    /// Through a place that is so far from the first taught one.
    Cir([f64; 3]),
    /// The first of two.
    CcirVia,
    Ccir,
    Spl,
    /// Rising and sinking straight for so long, in mm.
    Jump([f64; 2]),
}

impl Kind {
    /// Whether the TCP is led on its way.
    pub(crate) fn leads_tool(self) -> bool {
        !matches!(self, Kind::Movej | Kind::Ptp | Kind::Jump(_))
    }
}

/// Where a corner may be rounded off, each from its target: what is 0 is not asked for.
#[derive(Clone, Copy, PartialEq, Default, Debug)]
pub(crate) struct Slip {
    /// mm of the TCP
    pub(crate) pdis: f64,
    /// deg of the tool
    pub(crate) odis: f64,
    /// deg of the turning external axis that goes farthest
    pub(crate) ejdis: f64,
    /// mm of the linear external axis that goes farthest
    pub(crate) eldis: f64,
    /// deg of the axis that goes farthest
    pub(crate) jdis: f64,
}

#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum Zone {
    None,
    Percent(f64),
    /// mm of the TCP
    Distance(f64),
    Measures(Slip),
}

/// Programmed speeds, all in effect: velset is in them.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Speeds {
    /// Share of the axes' limits.
    pub(crate) axes: f64,
    /// mm/s
    pub(crate) tcp: f64,
    /// deg/s
    pub(crate) ori: f64,
    /// deg/s of turning external axes
    pub(crate) exj: f64,
    /// mm/s of linear external axes
    pub(crate) exl: f64,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Profile {
    T,
    S,
    O,
}

/// What is carried, and where the targets are.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Setting {
    /// In the flange. Of one that stands: in the flange at the first taught position, there in the world from then on.
    pub(crate) tool: Frame,
    /// In the world, or in the flange.
    pub(crate) wobj: Frame,
    /// Whether the tool stands, and the robot holds the workpiece.
    pub(crate) held: bool,
}

impl Setting {
    /// The TCP as ways are seen: in the world, or in the flange.
    pub(crate) fn tcp(&self, flange: &Frame) -> Frame {
        if self.held { flange.inverse() * self.tool } else { flange * self.tool }
    }

    /// The flange where the TCP is so.
    pub(crate) fn flange(&self, tcp: &Frame) -> Frame {
        if self.held { self.tool * tcp.inverse() } else { tcp * self.tool.inverse() }
    }
}

/// A motion of a program.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Motion {
    pub(crate) line: usize,
    pub(crate) kind: Kind,
    pub(crate) goal: Goal,
    pub(crate) setting: usize,
    pub(crate) zone: Zone,
    pub(crate) speeds: Speeds,
    /// s
    pub(crate) dura: Option<f64>,
    /// Part of the acceleration and of the jerk that `accset` leaves.
    pub(crate) accset: [f64; 2],
    pub(crate) profile: Profile,
    /// Axis 4 may be led through the wrist singularity, where the orientation gives way.
    pub(crate) wrist: bool,
    /// The robot stands at the target.
    pub(crate) rests: bool,
    /// The program waits there.
    pub(crate) waits: bool,
    /// No point of the robot's tool goes faster than in manual operation.
    pub(crate) manual: bool,
}

impl Motion {
    /// Whether its target is a place on a curve that goes on behind it, whatever its zone.
    pub(crate) fn goes_on_into(&self, next: &Motion) -> bool {
        self.kind == Kind::CcirVia || self.kind == Kind::Spl && next.kind == Kind::Spl && next.setting == self.setting
    }
}

/// What the program does when an input goes on: it stops its motion, moves, and goes on.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Handler {
    pub(crate) input: usize,
    pub(crate) fast: bool,
    pub(crate) motions: Vec<Motion>,
    /// The line of `startmove`.
    pub(crate) start: usize,
    /// How many motions are dropped.
    pub(crate) skip: usize,
}

/// The operating mode.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Mode {
    Auto,
    Manual,
    ManualFast,
}

impl Mode {
    const WORDS: [(&str, Mode); 3] = [("auto", Mode::Auto), ("manual", Mode::Manual), ("manufast", Mode::ManualFast)];

    /// As the command line has it.
    pub(crate) fn word(self) -> &'static str {
        Self::WORDS.iter().find(|(_, mode)| *mode == self).expect("a word for each mode").0
    }

    fn of(word: &str) -> Mode {
        Self::WORDS.iter().find(|(known, _)| *known == word).unwrap_or_else(|| panic!("mode {word}")).1
    }
}

/// A program, its motions, and the positions that its first motions teach.
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    pub(crate) text: String,
    pub(crate) mode: Mode,
    pub(crate) handlers: Vec<Handler>,
    pub(crate) motions: Vec<Motion>,
    pub(crate) taught: Vec<Vec<f64>>,
    pub(crate) settings: Vec<Setting>,
}

/// What instructions leave to those behind them.
struct Reader<'a> {
    plan: Plan,
    tcp: &'a Tcp,
    /// The function that is being read, where that is not `main`.
    handler: Option<Handler>,
    /// A tool to come, in the flange at the first taught position.
    standing: Frame,
    speeds: Speeds,
    velset: [f64; 2],
    accset: [f64; 2],
    profile: Profile,
    wrist: bool,
    /// How many ccir there are in a row.
    circles: usize,
    /// The setting of the default tool.
    default_tool: usize,
}

impl Plan {
    /// Reads a program for a robot with such limits.
    pub(crate) fn read(text: &str, tcp: &Tcp) -> Plan {
        let world = Setting { tool: Frame::identity(), wobj: Frame::identity(), held: false };
        let mode = text.lines().find_map(|line| line.strip_prefix("// mode: ")).map_or(Mode::Auto, Mode::of);
        let plan = Plan {
            text: text.to_owned(),
            mode,
            handlers: Vec::new(),
            motions: Vec::new(),
            taught: Vec::new(),
            settings: vec![world],
        };
        let mut reader = Reader {
            plan,
            tcp,
            handler: None,
            standing: Frame::identity(),
            speeds: Speeds { axes: 0.05, tcp: 50.0, ori: 400.0, exj: 5.0, exl: 5.0 },
            velset: [1.0, f64::INFINITY],
            accset: [1.0; 2],
            profile: Profile::S,
            wrist: false,
            circles: 0,
            default_tool: 0,
        };
        for (at, line) in text.lines().enumerate() {
            let line = line.split("//").next().unwrap_or_default().trim();
            let (head, rest) = line.split_once(' ').unwrap_or((line, ""));
            reader.line(at + 1, head, rest.trim());
        }
        reader.finish()
    }

    /// How many motions are planned ahead from one on: up to where the program waits.
    pub(crate) fn ahead(&self, from: usize) -> usize {
        let remaining = self.motions.get(from..).unwrap_or_default();
        remaining.iter().position(|motion| motion.waits).map_or(remaining.len(), |at| at + 1)
    }
}

impl Reader<'_> {
    fn line(&mut self, line: usize, head: &str, rest: &str) {
        match head {
            "" | "interrupt" => {}
            "func" => self.function(rest),
            "endfunc" => self.plan.handlers.extend(self.handler.take()),
            "stopmove" => self.handler_here().fast = rest == "fast",
            "startmove" => {
                let handler = self.handler_here();
                (handler.start, handler.skip) = (line, skip(rest));
            }
            "pose" => {
                if let Some(numbers) = numbers(rest).first_chunk() {
                    self.standing = frame(*numbers);
                }
            }
            "joint" => self.plan.taught.push(numbers(rest)),
            "tool" => {
                let held = rest.ends_with("true}");
                let tool = if held { self.standing } else { frame_of(&numbers(rest)) };
                self.plan.settings.push(Setting { tool, wobj: Frame::identity(), held });
            }
            "wobj" => self.plan.settings.last_mut().expect("a setting").wobj = frame_of(&numbers(rest)),
            "$VEL_PROFILE" => {
                self.profile = match rest {
                    "= T_type" => Profile::T,
                    "= S_type" => Profile::S,
                    "= O_type" => Profile::O,
                    _ => panic!("line {line}: {rest}"),
                };
            }
            "$WRIST" => self.wrist = rest == "= true",
            "$DFTOOL" => self.default_tool = setting(rest.trim_start_matches(['=', ' '])),
            "$DFSPEED" => self.default_speeds(&numbers(rest)),
            "accset" => {
                let parts = numbers(rest);
                self.accset = [parts[0] / 100.0, parts[1] / 100.0];
            }
            "velset" => {
                let parts = numbers(rest);
                self.velset = [parts[0] / 100.0, parts[1]];
            }
            "waittime" => {
                let motions = self.handler.as_mut().map_or(&mut self.plan.motions, |handler| &mut handler.motions);
                if let Some(last) = motions.last_mut() {
                    (last.rests, last.waits) = (true, true);
                }
            }
            _ => self.motion(line, head, rest),
        }
        self.circles = if head == "ccir" { self.circles + 1 } else { 0 };
    }

    /// `void stop2(pose p1_0)`: what is done when the second input goes on.
    fn function(&mut self, rest: &str) {
        let name = rest.split_once(' ').and_then(|(_, name)| name.split('(').next()).unwrap_or_default();
        if let Some(input) = name.strip_prefix("stop") {
            let input = input.parse().expect("the number of an input");
            self.handler = Some(Handler { input, fast: false, motions: Vec::new(), start: 0, skip: 0 });
        }
    }

    fn handler_here(&mut self) -> &mut Handler {
        self.handler.as_mut().expect("a function that is called stop and a number")
    }

    fn default_speeds(&mut self, parts: &[f64]) {
        self.speeds = Speeds { axes: parts[0] / 100.0, tcp: parts[1], ori: parts[2], exj: parts[3], exl: parts[4] };
    }

    #[expect(clippy::too_many_lines, reason = "one arm for each motion")]
    fn motion(&mut self, line: usize, head: &str, rest: &str) {
        let mut motion = Motion {
            line,
            kind: Kind::Lin,
            goal: Goal::Taught(0),
            setting: self.default_tool,
            zone: Zone::None,
            speeds: self.speeds,
            dura: None,
            accset: self.accset,
            profile: self.profile,
            wrist: self.wrist,
            rests: false,
            waits: false,
            manual: self.plan.mode == Mode::Manual,
        };
        let before = self.speeds;
        let (mut via, mut gate, mut through) = ([0.0; 3], [25.0; 2], false);
        for argument in split(rest) {
            let (label, value) = match argument.split_once(':') {
                Some((label, value)) if !label.contains('{') => (label, value),
                _ => ("", argument.as_str()),
            };
            let number = || value.parse::<f64>().unwrap_or_else(|_| panic!("line {line}: {argument}"));
            match label {
                "" => motion.goal = Goal::Taught(number_at_end(value)),
                "p" => motion.goal = goal(value),
                "m" => {
                    if let Goal::Shifted([x, y, z, ..], _) = goal(value) {
                        via = [x, y, z];
                    }
                }
                "t" => motion.setting = setting(value),
                "w" => {}
                "vp" if leads_tool(head) => {
                    self.speeds.tcp = self.tcp.vel * number() / 100.0;
                    self.speeds.ori = self.tcp.ori_vel * number() / 100.0;
                }
                "vp" => self.speeds.axes = number() / 100.0,
                "vl" => self.speeds.tcp = number(),
                "v" => self.default_speeds(&numbers(value)),
                "dura" => motion.dura = Some(number()),
                "s" if head == "jump" => through = value == "true",
                "sl" if number() > 0.0 => motion.zone = Zone::Distance(number()),
                "sp" if number() > 0.0 => motion.zone = Zone::Percent(number()),
                "sl" | "sp" => {}
                "s" => motion.zone = slip(value),
                "a" => gate[0] = number(),
                "b" => gate[1] = number(),
                _ => panic!("line {line}: {label}"),
            }
        }
        motion.kind = match head {
            "movej" => Kind::Movej,
            "ptp" => Kind::Ptp,
            "lin" => Kind::Lin,
            "cir" => Kind::Cir(via),
            "ccir" if self.circles.is_multiple_of(2) => Kind::CcirVia,
            "ccir" => Kind::Ccir,
            "spl" => Kind::Spl,
            "jump" => Kind::Jump(gate),
            _ => panic!("line {line}: {head}"),
        };
        if through {
            motion.zone = Zone::Percent(25.0);
        }
        let [part, most] = self.velset;
        let speeds = self.speeds;
        motion.speeds = Speeds {
            axes: speeds.axes * part,
            tcp: (speeds.tcp * part).min(most),
            ori: speeds.ori * part,
            exj: speeds.exj * part,
            exl: speeds.exl * part,
        };
        if motion.dura.is_some() {
            motion.speeds = Speeds { axes: 1.0, tcp: most, ori: f64::INFINITY, exj: f64::INFINITY, exl: f64::INFINITY };
        }
        if motion.manual {
            motion.speeds.tcp = motion.speeds.tcp.min(MANUAL);
        }
        let Some(handler) = &mut self.handler else {
            self.plan.motions.push(motion);
            return;
        };
        // When it runs, the program has said other things, which nobody knows here.
        motion.speeds = Speeds { ori: f64::INFINITY, exj: f64::INFINITY, exl: f64::INFINITY, ..motion.speeds };
        (motion.rests, motion.profile) = (true, Profile::T);
        handler.motions.push(motion);
        self.speeds = before;
    }

    /// Says where the robot rests.
    fn finish(mut self) -> Plan {
        if !self.plan.text.contains("T_type") {
            let motions = self.plan.handlers.iter_mut().flat_map(|handler| &mut handler.motions);
            motions.for_each(|motion| motion.profile = Profile::S);
        }
        let motions = &self.plan.motions;
        let next = motions.iter().skip(1).map(Some).chain([None]);
        let rests = motions
            .iter()
            .zip(next)
            .map(|(motion, next)| next.is_none_or(|next| motion.zone == Zone::None && !motion.goes_on_into(next)));
        let rests: Vec<bool> = rests.collect();
        for (motion, rests) in self.plan.motions.iter_mut().zip(rests) {
            motion.rests |= rests;
        }
        self.plan
    }
}

/// Whether instructions lead the TCP.
fn leads_tool(head: &str) -> bool {
    matches!(head, "lin" | "cir" | "ccir" | "spl")
}

/// What `startmove` says: how many motions, or whether the stopped one.
fn skip(text: &str) -> usize {
    match text {
        "" | "false" => 0,
        "true" => 1,
        count => count.parse().expect("a number of motions"),
    }
}

/// All numbers of a text, but those in names.
fn numbers(text: &str) -> Vec<f64> {
    let apart = |c: char| !(c.is_ascii_alphanumeric() || matches!(c, '.' | '-' | '$' | '_'));
    text.split(apart).filter_map(|word| word.parse().ok()).collect()
}

/// The setting whose tool this is.
fn setting(tool: &str) -> usize {
    if tool == "$FLANGE" { 0 } else { number_at_end(tool) }
}

fn number_at_end(name: &str) -> usize {
    name.trim_start_matches(|c: char| !c.is_ascii_digit()).parse().unwrap_or_else(|_| panic!("{name}"))
}

fn frame_of(numbers: &[f64]) -> Frame {
    frame(numbers.first_chunk().copied().expect("six numbers"))
}

/// Arguments, apart at the commas that are not in braces.
fn split(text: &str) -> Vec<String> {
    let (mut parts, mut depth) = (vec![String::new()], 0);
    for c in text.chars() {
        match c {
            '{' | '(' => depth += 1,
            '}' | ')' => depth -= 1,
            ',' if depth == 0 => {
                parts.push(String::new());
                continue;
            }
            _ => {}
        }
        parts.last_mut().expect("a part").push(c);
    }
    parts.into_iter().map(|part| part.trim().to_owned()).collect()
}

/// `pS_K`, or `{x pS_0.x + (1.5),..}`.
fn goal(text: &str) -> Goal {
    let Some(inner) = text.strip_prefix('{').and_then(|text| text.strip_suffix('}')) else {
        return Goal::Taught(text.rsplit('_').next().and_then(|at| at.parse().ok()).expect("a taught pose"));
    };
    let mut parts = split(inner).into_iter().map(|part| {
        let (_, shift) = part.split_once("+ (").expect("a shift");
        shift.trim_end_matches(')').parse().expect("a number")
    });
    let pose = std::array::from_fn(|_| parts.next().unwrap_or_default());
    Goal::Shifted(pose, parts.collect())
}

/// `{pdis 3,odis 5,..}`
fn slip(text: &str) -> Zone {
    let mut slip = Slip::default();
    for part in split(text.trim_matches(['{', '}'])) {
        let (name, value) = part.split_once(' ').expect("a component");
        let value: f64 = value.parse().expect("a number");
        match name {
            "perdis" => {}
            "pdis" => slip.pdis = value,
            "odis" => slip.odis = value,
            "ejdis" => slip.ejdis = value,
            "eldis" => slip.eldis = value,
            "jdis" => slip.jdis = value,
            _ => panic!("{name}"),
        }
    }
    Zone::Measures(slip)
}
