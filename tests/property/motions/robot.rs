//! Robot files: what they allow, and others made of them at random.

use super::grow::between;
use arl_tests::random::Random;
use std::fmt::Write as _;

/// What an axis may do, in deg (mm) and s.
#[derive(Clone, Default, Debug)]
pub(crate) struct Axis {
    pub(crate) min: f64,
    pub(crate) max: f64,
    pub(crate) vel: f64,
    pub(crate) acc: f64,
    pub(crate) jerk: f64,
}

/// A robot file, and its limits as this test reads them.
#[derive(Clone, Debug)]
pub(crate) struct Robot {
    pub(crate) name: String,
    pub(crate) text: String,
    pub(crate) axes: Vec<Axis>,
}

impl Robot {
    /// A robot that is built in.
    pub(crate) fn named(name: &str) -> Robot {
        let text = arl_robot::Robot::text(name).expect("a built-in robot");
        Robot::read(name, text)
    }

    fn read(name: &str, text: &str) -> Robot {
        let mut axes: Vec<Axis> = Vec::new();
        for (section, key, value) in entries(text) {
            match (section, key) {
                ("[[axis]]", "name") => axes.push(Axis::default()),
                ("[[axis]]", key) => {
                    let axis = axes.last_mut().expect("the name comes first");
                    let value: f64 = value.parse().expect("a number");
                    match key {
                        "min" => axis.min = value,
                        "max" => axis.max = value,
                        "vel" => axis.vel = value,
                        "acc" => axis.acc = value,
                        "jerk" => axis.jerk = value,
                        _ => panic!("an axis has {key}"),
                    }
                }
                _ => {}
            }
        }
        Robot { name: name.into(), text: text.into(), axes }
    }

    /// The robot with other limits of speed, acceleration and jerk: between 0.4 and 2 times as much each.
    pub(crate) fn otherwise(&self, random: &mut Random) -> Robot {
        let mut text = String::new();
        let mut section = "";
        for line in self.text.lines() {
            if line.starts_with('[') {
                section = line.split_whitespace().next().unwrap_or_default();
            }
            let limits = ["vel", "acc", "jerk", "ori_vel", "ori_acc", "ori_jerk"];
            match line.split_once(" = ") {
                Some((key, value)) if limits.contains(&key) && matches!(section, "[tcp]" | "[[axis]]") => {
                    let value: f64 = value.parse().expect("a number");
                    writeln!(text, "{key} = {:.3}", value * between(random, 0.4, 2.0)).unwrap();
                }
                _ => writeln!(text, "{line}").unwrap(),
            }
        }
        Robot::read(&self.name, &text)
    }
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
