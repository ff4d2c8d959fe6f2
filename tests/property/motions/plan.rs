//! What the motions of a program must do, read from its text: programs of a few forms that `grow.rs` writes, and that a
//! person can shorten.

use super::geometry::{Frame, frame};

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
    Several(Slip),
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
    /// In the flange.
    pub(crate) tool: Frame,
    /// In the world.
    pub(crate) wobj: Frame,
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
}

/// A program, its motions, and the positions that its first motions teach.
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    pub(crate) text: String,
    pub(crate) motions: Vec<Motion>,
    pub(crate) taught: Vec<Vec<f64>>,
    pub(crate) settings: Vec<Setting>,
}

/// What instructions leave to those behind them.
struct Reader {
    plan: Plan,
    speeds: Speeds,
    velset: [f64; 2],
    accset: [f64; 2],
    profile: Profile,
    wrist: bool,
    /// How many ccir there are in a row.
    circles: usize,
}

impl Plan {
    /// Reads a program.
    pub(crate) fn read(text: &str) -> Plan {
        let world = Setting { tool: Frame::identity(), wobj: Frame::identity() };
        let plan = Plan { text: text.to_owned(), motions: Vec::new(), taught: Vec::new(), settings: vec![world] };
        let speeds = Speeds { axes: 0.05, tcp: 50.0, ori: 400.0, exj: 5.0, exl: 5.0 };
        let (velset, accset) = ([1.0, f64::INFINITY], [1.0; 2]);
        let mut reader = Reader { plan, speeds, velset, accset, profile: Profile::S, wrist: false, circles: 0 };
        for (at, line) in text.lines().enumerate() {
            let line = line.split("//").next().unwrap_or_default().trim();
            let (head, rest) = line.split_once(' ').unwrap_or((line, ""));
            reader.line(at + 1, head, rest.trim());
        }
        reader.finish()
    }

    /// The setting whose motions have no other.
    pub(crate) fn setting(&self, motion: &Motion) -> &Setting {
        &self.settings[motion.setting]
    }
}

impl Reader {
    fn line(&mut self, line: usize, head: &str, rest: &str) {
        match head {
            "" | "func" | "endfunc" | "pose" => {}
            "joint" => self.plan.taught.push(numbers(rest)),
            "tool" => {
                let tool = frame_of(&numbers(rest));
                self.plan.settings.push(Setting { tool, wobj: Frame::identity() });
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
            "$DFSPEED" => self.default_speeds(&numbers(rest)),
            "accset" => {
                let parts = numbers(rest);
                self.accset = [parts[0] / 100.0, parts[1] / 100.0];
            }
            "velset" => {
                let parts = numbers(rest);
                self.velset = [parts[0] / 100.0, parts[1]];
            }
            "waittime" => self.plan.motions.last_mut().expect("a motion").rests = true,
            _ => self.motion(line, head, rest),
        }
        self.circles = if head == "ccir" { self.circles + 1 } else { 0 };
    }

    fn default_speeds(&mut self, parts: &[f64]) {
        self.speeds = Speeds { axes: parts[0] / 100.0, tcp: parts[1], ori: parts[2], exj: parts[3], exl: parts[4] };
    }

    fn motion(&mut self, line: usize, head: &str, rest: &str) {
        let mut motion = Motion {
            line,
            kind: Kind::Lin,
            goal: Goal::Taught(0),
            setting: 0,
            zone: Zone::None,
            speeds: self.speeds,
            dura: None,
            accset: self.accset,
            profile: self.profile,
            wrist: self.wrist,
            rests: false,
        };
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
                "t" => motion.setting = if value == "$FLANGE" { 0 } else { number_at_end(value) },
                "w" => {}
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
        self.plan.motions.push(motion);
    }

    /// Says where the robot rests.
    fn finish(mut self) -> Plan {
        let next: Vec<Option<(Kind, usize)>> =
            self.plan.motions.iter().skip(1).map(|motion| Some((motion.kind, motion.setting))).chain([None]).collect();
        for (motion, next) in self.plan.motions.iter_mut().zip(next) {
            let goes_on =
                motion.kind == Kind::CcirVia || motion.kind == Kind::Spl && next == Some((Kind::Spl, motion.setting));
            motion.rests |= next.is_none() || motion.zone == Zone::None && !goes_on;
        }
        self.plan
    }
}

/// All numbers of a text, but those in names.
fn numbers(text: &str) -> Vec<f64> {
    let apart = |c: char| !(c.is_ascii_alphanumeric() || matches!(c, '.' | '-' | '$' | '_'));
    text.split(apart).filter_map(|word| word.parse().ok()).collect()
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
    Zone::Several(slip)
}
