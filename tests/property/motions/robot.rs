//! Robot files: what they allow, and others made of them at random.

use super::geometry::Frame;
use super::grow::between;
use arl_tests::random::Random;
use std::fmt::Write as _;

/// What an axis may do, in deg (mm) and s.
#[derive(Clone, Default, Debug)]
pub(crate) struct Axis {
    pub(crate) linear: bool,
    pub(crate) min: f64,
    pub(crate) max: f64,
    pub(crate) vel: f64,
    pub(crate) acc: f64,
    pub(crate) jerk: f64,
}

/// What the TCP may do, in mm, deg and s.
#[derive(Clone, Default, Debug)]
pub(crate) struct Tcp {
    pub(crate) vel: f64,
    pub(crate) acc: f64,
    pub(crate) ori_vel: f64,
    pub(crate) ori_acc: f64,
}

/// A robot file, and its limits as this test reads them.
#[derive(Clone, Debug)]
pub(crate) struct Robot {
    /// How this robot is made again: a built-in robot, the seed of its limits (0: its own), the number of external
    /// axes.
    pub(crate) name: String,
    pub(crate) text: String,
    pub(crate) scara: bool,
    /// Its own axes, then external ones.
    pub(crate) axes: Vec<Axis>,
    pub(crate) own: usize,
    pub(crate) tcp: Tcp,
    /// What says where the flange is: the TCP of a tool that stands does not move in the trace.
    model: arl_robot::Robot,
}

/// External axes, one that turns and one that is linear.
const EXTERNAL: [&str; 2] = [
    "\n[[axis]]\nname = \"ej1\"\nmin = -170.0\nmax = 170.0\nvel = 90.0\nacc = 450.0\njerk = 5400.0\n",
    "\n[[axis]]\nname = \"ej2\"\nlinear = true\nmin = -800.0\nmax = 800.0\nvel = 600.0\nacc = 3000.0\njerk = 36000.0\n",
];

impl Robot {
    /// A robot as [`Robot::name`] says it.
    pub(crate) fn of(name: &str) -> Robot {
        let mut words = name.split_whitespace();
        let built_in = words.next().expect("a robot");
        let mut number = || words.next().map_or(0, |word| word.parse::<u64>().expect("a number"));
        let (seed, external) = (number(), number() as usize);
        let text = arl_robot::Robot::text(built_in).expect("a built-in robot");
        let (axes, links) = text
            .split_once("\n[[link]]")
            .map_or((text, String::new()), |(axes, links)| (axes, format!("\n[[link]]{links}")));
        let text = format!("{axes}{}{links}", EXTERNAL[..external].concat());
        Robot::read(name, if seed == 0 { text } else { varied(&text, &mut Random::new(seed)) })
    }

    /// How a `movej` gets its tool: by a line before it on SCARA robots, else by an argument.
    pub(crate) fn tool_of_movej(&self, tool: &str) -> [String; 2] {
        if self.scara {
            [format!("  $DFTOOL = {tool}\n"), String::new()]
        } else {
            [String::new(), format!(",t:{tool}")]
        }
    }

    /// The flange in the world.
    pub(crate) fn flange(&self, axes: &[f64]) -> Frame {
        let own = std::array::from_fn(|i| if i < self.own { axes[i] } else { 0.0 });
        self.model.kinematics.forward(&own)
    }

    /// The same robot with an axis, from 0, that turns as far as it likes.
    pub(crate) fn turning_freely(&self, axis: usize) -> Robot {
        let (mut text, mut at) = (String::new(), None);
        for line in self.text.lines() {
            if line.starts_with("[[axis]]") {
                at = Some(at.map_or(0, |at: usize| at + 1));
            }
            match line.split_once(" = ") {
                Some(("min", _)) if at == Some(axis) => text.push_str("min = -100000.0"),
                Some(("max", _)) if at == Some(axis) => text.push_str("max = 100000.0"),
                _ => text.push_str(line),
            }
            text.push('\n');
        }
        Robot::read(&self.name, text)
    }

    fn read(name: &str, text: String) -> Robot {
        let mut robot = Robot {
            name: name.into(),
            text: String::new(),
            scara: false,
            axes: Vec::new(),
            own: 0,
            tcp: Tcp::default(),
            model: arl_robot::Robot::parse(name, &text).expect("a robot file"),
        };
        for (section, key, value) in entries(&text) {
            let number = || -> f64 { value.parse().expect("a number") };
            match (section, key) {
                ("", "family") => robot.scara = value == "\"scara\"",
                ("[tcp]", "vel") => robot.tcp.vel = number(),
                ("[tcp]", "acc") => robot.tcp.acc = number(),
                ("[tcp]", "ori_vel") => robot.tcp.ori_vel = number(),
                ("[tcp]", "ori_acc") => robot.tcp.ori_acc = number(),
                ("[[axis]]", "name") => {
                    robot.axes.push(Axis::default());
                    robot.own += usize::from(!value.starts_with("\"e"));
                }
                ("[[axis]]", key) => {
                    let axis = robot.axes.last_mut().expect("the name comes first");
                    match key {
                        "linear" => axis.linear = true,
                        "min" => axis.min = number(),
                        "max" => axis.max = number(),
                        "vel" => axis.vel = number(),
                        "acc" => axis.acc = number(),
                        "jerk" => axis.jerk = number(),
                        _ => panic!("an axis has {key}"),
                    }
                }
                _ => {}
            }
        }
        Robot { text, ..robot }
    }
}

/// A robot file with other limits of speed, acceleration and jerk: between 0.4 and 2 times as much each.
fn varied(text: &str, random: &mut Random) -> String {
    let mut varied = String::new();
    let mut section = "";
    for line in text.lines() {
        if line.starts_with('[') {
            section = line.split_whitespace().next().unwrap_or_default();
        }
        let limits = ["vel", "acc", "jerk", "ori_vel", "ori_acc", "ori_jerk"];
        match line.split_once(" = ") {
            Some((key, value)) if limits.contains(&key) && matches!(section, "[tcp]" | "[[axis]]") => {
                let value: f64 = value.parse().expect("a number");
                writeln!(varied, "{key} = {:.3}", value * between(random, 0.4, 2.0)).unwrap();
            }
            _ => writeln!(varied, "{line}").unwrap(),
        }
    }
    varied
}

/// The settings of a robot file with their sections.
fn entries(text: &str) -> impl Iterator<Item = (&str, &str, &str)> {
    let mut section = "";
    text.lines().filter_map(move |line| {
        let line = line.split('#').next().unwrap_or_default().trim();
        if line.starts_with('[') {
            section = line;
        }
        let (key, value) = line.split_once(" = ")?;
        Some((section, key, value))
    })
}
