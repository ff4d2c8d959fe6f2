//! Random motion programs, and what is known of their motions.

use super::vector::Vector;
use arl_tests::random::Random;
use std::fmt::Write as _;

/// A number between two others.
pub(crate) fn between(random: &mut Random, from: f64, to: f64) -> f64 {
    from + (to - from) * (random.next() >> 11) as f64 / (1_u64 << 53) as f64
}

/// Where a motion goes.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum Goal {
    /// One of the taught positions.
    Taught(usize),
    /// The pose of the first taught position, so much added to each component.
    Shifted([f64; 6]),
}

#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum Kind {
    Movej,
    Ptp,
    Lin,
    /// Through a place that is so far from the first taught one.
    Cir(Vector),
    /// The first of two.
    CcirVia,
    Ccir,
    Spl,
}

#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum Zone {
    None,
    Percent(f64),
    Distance(f64),
}

/// A motion of a program.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Motion {
    pub(crate) line: usize,
    pub(crate) kind: Kind,
    pub(crate) goal: Goal,
    pub(crate) zone: Zone,
    /// In % of the axes' limits with `movej` and `ptp`, in mm/s with others.
    pub(crate) speed: f64,
    /// Part of the acceleration and of the jerk that `accset` leaves.
    pub(crate) accset: [f64; 2],
    /// The robot stands at the target.
    pub(crate) rests: bool,
}

/// A program, its motions, and the positions that its first motions teach.
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    pub(crate) text: String,
    pub(crate) motions: Vec<Motion>,
    pub(crate) taught: Vec<[f64; 6]>,
}

/// Where a kind of robot can move freely, and how far from there the axes may go.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Room {
    pub(crate) joints: [f64; 6],
    pub(crate) swing: f64,
    /// mm
    pub(crate) reach: f64,
}

struct Grower<'a> {
    random: &'a mut Random,
    room: Room,
    plan: Plan,
    lines: usize,
    accset: [f64; 2],
    velset: f64,
}

/// A program of so many motions.
pub(crate) fn grow(random: &mut Random, room: Room, count: usize) -> Plan {
    let plan = Plan { text: String::new(), motions: Vec::new(), taught: Vec::new() };
    let mut grower = Grower { random, room, plan, lines: 0, accset: [1.0; 2], velset: 1.0 };
    grower.program(count);
    grower.plan
}

impl Grower<'_> {
    fn line(&mut self, text: &str) {
        writeln!(self.plan.text, "{text}").unwrap();
        self.lines += 1;
    }

    fn program(&mut self, count: usize) {
        self.line("func void main()");
        self.profile();
        for at in 0..4 {
            let mut joints = self.room.joints;
            if at > 0 {
                for joint in &mut joints {
                    *joint += between(self.random, -self.room.swing, self.room.swing);
                }
            }
            self.plan.taught.push(joints.map(|joint| (joint * 1e3).round() / 1e3));
            self.line(&format!("  joint j{at} = {:?}", self.plan.taught[at]).replace('[', "{").replace(']', "}"));
        }
        for at in 0..4 {
            self.movej(at, Zone::None);
            self.wait();
            self.line(&format!("  pose p{at} = cpose($FLANGE,$WORLD)"));
        }
        while self.plan.motions.len() < count {
            self.setting();
            self.motion();
            if self.random.chance(12) {
                self.wait();
                if self.random.chance(50) {
                    self.profile();
                }
            }
        }
        self.wait();
        self.line("endfunc");
        // Splines stop at the last of a row.
        let kinds: Vec<Kind> = self.plan.motions.iter().map(|motion| motion.kind).collect();
        for (motion, next) in self.plan.motions.iter_mut().zip(&kinds[1..]) {
            motion.rests |= motion.kind == Kind::Spl && *next != Kind::Spl;
        }
    }

    /// Lets the robot come to rest.
    fn wait(&mut self) {
        let time = *self.random.pick(&["0", "0", "0.02", "0.15"]);
        self.line(&format!("  waittime {time}"));
        self.plan.motions.last_mut().expect("a motion").rests = true;
    }

    fn profile(&mut self) {
        let profile = if self.random.chance(50) { "O_type" } else { "S_type" };
        self.line(&format!("  $VEL_PROFILE = {profile}"));
    }

    fn setting(&mut self) {
        if self.random.chance(8) {
            let [acc, ramp] = [0, 1].map(|_| *self.random.pick(&[30, 60, 100, 100]));
            self.accset = [acc, ramp].map(|part| f64::from(part) / 100.0);
            self.line(&format!("  accset {acc},{ramp}"));
        }
        if self.random.chance(6) {
            let part = *self.random.pick(&[25, 60, 100, 100]);
            self.velset = f64::from(part) / 100.0;
            self.line(&format!("  velset {part},3000"));
        }
    }

    fn zone(&mut self) -> Zone {
        match self.random.below(4) {
            0 => Zone::None,
            1 => Zone::Percent(between(self.random, 1.0, 100.0).round()),
            _ => Zone::Distance(between(self.random, 1.0, 60.0).round()),
        }
    }

    fn motion(&mut self) {
        let zone = self.zone();
        match self.random.below(12) {
            0 | 1 => {
                let at = self.random.below(4);
                self.movej(at, zone);
            }
            2 | 3 => {
                let goal = self.goal();
                self.add(Kind::Ptp, "ptp p:", goal, zone);
            }
            kind @ 4..=6 => {
                // Four `ccir` in a row would be something else than two times two.
                if self.plan.motions.last().is_some_and(|last| last.kind == Kind::Ccir) {
                    self.wait();
                }
                let (via, end) = self.arc();
                if kind == 6 {
                    self.add(Kind::CcirVia, "ccir p:", Goal::Shifted(via), Zone::None);
                    self.add(Kind::Ccir, "ccir p:", Goal::Shifted(end), zone);
                } else {
                    let head = format!("cir m:{},p:", shifted(via));
                    self.add(Kind::Cir([via[0], via[1], via[2]]), &head, Goal::Shifted(end), zone);
                }
            }
            7 => {
                for _ in 0..2 + self.random.below(3) {
                    let goal = self.goal();
                    self.add(Kind::Spl, "spl p:", goal, Zone::None);
                }
            }
            _ => {
                let goal = self.goal();
                self.add(Kind::Lin, "lin p:", goal, zone);
            }
        }
    }

    fn movej(&mut self, at: usize, zone: Zone) {
        if self.plan.motions.last().is_none_or(|last| last.goal != Goal::Taught(at)) {
            self.add(Kind::Movej, &format!("movej j{at}"), Goal::Taught(at), zone);
        }
    }

    /// What is added to the first taught pose.
    fn shift(&mut self) -> [f64; 6] {
        let reach = self.room.reach;
        let mut shift = [reach, reach, reach, 8.0, 8.0, 8.0].map(|most| between(self.random, -most, most));
        if self.random.chance(40) {
            shift[3..].fill(0.0);
        }
        shift.map(|part| (part * 1e3).round() / 1e3)
    }

    /// The second and the third point of an arc that stays in the room.
    fn arc(&mut self) -> ([f64; 6], [f64; 6]) {
        let start = match self.plan.motions.last().map(|last| last.goal) {
            Some(Goal::Shifted(start)) => start,
            _ => {
                let start = self.shift();
                self.add(Kind::Lin, "lin p:", Goal::Shifted(start), Zone::None);
                start
            }
        };
        loop {
            let end = self.shift();
            let way: f64 = (0..3).map(|i| (end[i] - start[i]).powi(2)).sum::<f64>().sqrt();
            if way > self.room.reach / 2.0 {
                // Out of the line by a tenth to a half of its length, for the axis that the line follows least.
                let across = (0..3).min_by(|a, b| (end[*a] - start[*a]).abs().total_cmp(&(end[*b] - start[*b]).abs()));
                let mut via: [f64; 6] = std::array::from_fn(|i| (start[i] + end[i]) / 2.0);
                via[across.expect("three axes")] += way * between(self.random, 0.1, 0.5);
                return (via.map(|part| (part * 1e3).round() / 1e3), end);
            }
        }
    }

    fn goal(&mut self) -> Goal {
        let at = self.random.below(16);
        let last = self.plan.motions.last().map(|last| last.goal);
        match Goal::Taught(at) {
            goal if at < 4 && Some(goal) != last => goal,
            _ => Goal::Shifted(self.shift()),
        }
    }

    fn add(&mut self, kind: Kind, head: &str, goal: Goal, zone: Zone) {
        let axes = matches!(kind, Kind::Movej | Kind::Ptp);
        let percent = between(self.random, 10.0, 100.0).round();
        let tcp = between(self.random, 40.0, 1200.0).round();
        let (speed, label) = if axes { (percent, "vp") } else { (tcp, "vl") };
        let target = match goal {
            _ if kind == Kind::Movej => String::new(),
            Goal::Taught(at) => format!("p{at}"),
            Goal::Shifted(shift) => shifted(shift),
        };
        let rounding = match zone {
            Zone::None => "sl:-1".to_owned(),
            Zone::Percent(part) => format!("sp:{part}"),
            Zone::Distance(size) => format!("sl:{size}"),
        };
        self.line(&format!("  {head}{target},{label}:{speed},{rounding}"));
        let rests = zone == Zone::None && !matches!(kind, Kind::CcirVia | Kind::Spl);
        let speed = speed * self.velset;
        let (line, accset) = (self.lines, self.accset);
        self.plan.motions.push(Motion { line, kind, goal, zone, speed, accset, rests });
    }
}

/// The first taught pose with so much added.
fn shifted(shift: [f64; 6]) -> String {
    let components = ["x", "y", "z", "a", "b", "c"].iter().zip(shift);
    let components: Vec<String> = components.map(|(name, part)| format!("{name} p0.{name} + ({part})")).collect();
    format!("{{{}}}", components.join(","))
}
