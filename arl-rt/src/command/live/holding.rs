//! Buttons that move a robot as long as they are held: `hold = "j1+"`, sent again and again meanwhile.
//!
//! `hold.2` is the robot of channel 2. A direction is `j1+`, `x-` (in the world), `tool z+`, `rx+` (about x), `frame 0
//! 0 90 x+` (in a frame turned by a, b, c in deg), or `to 0 -90 90 0 90 0` for all axes; an empty one releases the
//! button. Where the order does not come again in time, the button counts as released: the loss of a page or a process
//! stops the robot on its path.

use arl_robot::kinematics::frame;
use nalgebra::Vector3;

use crate::controller::Controller;
use crate::unit::hold::{HeldButton, PressOutcome, Seen};

/// How long a button counts as held after an order, in s.
const HELD_S: f64 = 0.25;

/// The button that is held.
#[derive(Default)]
pub(super) struct Holding {
    held: Option<Button>,
}

struct Button {
    channel: u8,
    words: String,
    held: HeldButton,
    stage: Stage,
    /// The cycle in which it counts as released.
    until: u64,
}

/// The state of a button.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Stage {
    /// The robot comes to rest first.
    Waits,
    Moves,
    /// Something has stopped the robot, or it could not begin: nothing moves before the button is pressed again.
    Spent,
}

impl Holding {
    /// The channel and the direction of an order for a button, where it is such an order.
    pub(super) fn asked(order: &str) -> Option<(u8, &str)> {
        let (key, value) = order.split_once('=')?;
        let rest = key.trim().strip_prefix("hold")?;
        let channel = if rest.is_empty() { 1 } else { rest.strip_prefix('.')?.parse().ok()? };
        Some((channel, value.trim().trim_matches('"').trim()))
    }

    /// Holds a button, or releases it.
    pub(super) fn hold(&mut self, controller: &mut Controller, channel: u8, words: &str) -> Result<(), String> {
        let until = controller.cycle() + controller.cycles(HELD_S);
        if let Some(button) = &mut self.held {
            if button.channel == channel && button.words == words {
                button.until = until;
                return Ok(());
            }
            self.let_go(controller);
        }
        if words.is_empty() {
            return Ok(());
        }
        let held = parse(words)?;
        let pressed = controller.hold(channel, &held);
        let stage = pressed.as_ref().map_or(Stage::Spent, |pressed| stage(*pressed));
        self.held = Some(Button { channel, words: words.to_owned(), held, stage, until });
        pressed.map(drop)
    }

    /// To be called after each cycle: a button that is still held moves the robot on where the planned distance has
    /// been covered.
    pub(super) fn cycle_ended(&mut self, controller: &mut Controller) {
        let Some(button) = &mut self.held else { return };
        if controller.cycle() >= button.until {
            return self.let_go(controller);
        }
        let (channel, held) = (button.channel, &button.held);
        button.stage = match button.stage {
            Stage::Spent => Stage::Spent,
            Stage::Waits => controller.hold(channel, held).map_or(Stage::Spent, stage),
            Stage::Moves => controller.keep_on(channel, held).map_or(Stage::Spent, |()| Stage::Moves),
        };
    }

    /// Releases the button.
    pub(super) fn let_go(&mut self, controller: &mut Controller) {
        if let Some(button) = self.held.take() {
            controller.let_go(button.channel);
        }
    }
}

fn stage(pressed: PressOutcome) -> Stage {
    match pressed {
        PressOutcome::Begun => Stage::Moves,
        PressOutcome::Waits => Stage::Waits,
    }
}

/// Reads a direction, or a target for all axes.
fn parse(words: &str) -> Result<HeldButton, String> {
    let wrong = || {
        format!(
            "`{words}` is not a direction: expected one like `j1+`, `x-`, `tool z+`, `rx+`, `frame 0 0 90 x+` or `to 0 -90 90 0 90 0`"
        )
    };
    let all: Vec<&str> = words.split_whitespace().collect();
    let numbers = |of: &[&str]| -> Option<Vec<f64>> {
        let all: Option<Vec<f64>> = of.iter().map(|word| word.parse().ok()).collect();
        all.filter(|all| all.iter().all(|value| value.is_finite()))
    };
    let held = match &all[..] {
        ["to", axes @ ..] if !axes.is_empty() => numbers(axes).map(HeldButton::To),
        ["tool", direction] => tcp(direction, Seen::Tool),
        ["frame", a, b, c, direction] => numbers(&[a, b, c]).and_then(|angles| {
            let [a, b, c] = <[f64; 3]>::try_from(angles).ok()?;
            tcp(direction, Seen::Frame(frame([0.0, 0.0, 0.0, a, b, c]).rotation))
        }),
        [direction] => axis(direction).or_else(|| tcp(direction, Seen::Frame(nalgebra::UnitQuaternion::identity()))),
        _ => None,
    };
    held.ok_or_else(wrong)
}

/// Reads `j1+`; external axes follow the robot's own: `j7-` is the first external one of a robot with six axes.
fn axis(direction: &str) -> Option<HeldButton> {
    let (name, up) = sign(direction)?;
    let axis = name.strip_prefix('j')?.parse().ok()?;
    Some(HeldButton::Axis { axis, up })
}

fn tcp(direction: &str, of: Seen) -> Option<HeldButton> {
    let (name, up) = sign(direction)?;
    let (name, turns) = name.strip_prefix('r').map_or((name, false), |name| (name, true));
    let axis = match name {
        "x" => Vector3::x(),
        "y" => Vector3::y(),
        "z" => Vector3::z(),
        _ => return None,
    };
    Some(HeldButton::Tcp { along: if up { axis } else { -axis }, turns, of })
}

fn sign(direction: &str) -> Option<(&str, bool)> {
    let up = direction.strip_suffix('+').map(|name| (name, true));
    up.or_else(|| direction.strip_suffix('-').map(|name| (name, false)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_say_which_button_is_held() {
        assert_eq!(Holding::asked("hold = \"j1+\""), Some((1, "j1+")));
        assert_eq!(Holding::asked("hold.2=x-"), Some((2, "x-")));
        assert_eq!(Holding::asked("hold = \"\""), Some((1, "")));
        assert_eq!(
            (Holding::asked("di.1 = true"), Holding::asked("holder = 1"), Holding::asked("hold")),
            (None, None, None)
        );
    }

    #[test]
    fn words_say_what_is_moved() {
        assert_eq!(parse("j3-"), Ok(HeldButton::Axis { axis: 3, up: false }));
        assert_eq!(parse("to 1 -2.5"), Ok(HeldButton::To(vec![1.0, -2.5])));
        let Ok(HeldButton::Tcp { along, turns: false, of: Seen::Tool }) = parse("tool z-") else { panic!("the tool") };
        assert_eq!(along, -Vector3::z());
        assert!(matches!(parse("frame 0 0 90 rx+"), Ok(HeldButton::Tcp { turns: true, of: Seen::Frame(_), .. })));
        for wrong in
            ["", "j+", "jx+", "x", "q+", "tool j1+", "frame 0 0 x+", "to", "to a", "to inf", "frame 0 0 nan x+"]
        {
            assert!(parse(wrong).is_err(), "{wrong}");
        }
    }

    /// A program with one long motion, paused in the middle of it.
    fn paused() -> Controller {
        use crate::emit::*;
        struct Turn;
        impl crate::Program for Turn {
            fn file(&self) -> File {
                File::new("turn.arl")
            }
            fn family(&self) -> Family {
                Family::SixAxis
            }
            fn main<'a>(&'a self, cx: &'a Cx) -> BoxFuture<'a> {
                let target = Joint { j1: 90.0, j2: -90.0, j3: 90.0, j4: 0.0, j5: 45.0, j6: 0.0, ..Joint::default() };
                let tool = Tool { t_frame: Frame { x: 30.0, z: 120.0, ..Frame::default() }, stationary: false };
                Box::pin(async move { motion::movej(target).t(tool).run(cx).await.at(self.file(), 2) })
            }
        }
        let mut controller = Controller::builder().build(Box::new(Turn)).unwrap();
        controller.run_for(0.5);
        controller.press(crate::io::Pendant::Pause);
        controller.run_for(1.0);
        controller
    }

    /// Holds a button for this many cycles, and then no more.
    fn hold(controller: &mut Controller, words: &str, cycles: u64) -> Holding {
        let mut holding = Holding::default();
        for cycle in 0..cycles {
            if cycle.is_multiple_of(100) {
                holding.hold(controller, 1, words).unwrap();
            }
            controller.step();
            holding.cycle_ended(controller);
        }
        holding
    }

    fn tcp(controller: &Controller) -> Vec<f64> {
        controller.status().channels[0].robot.as_ref().unwrap().tcp.to_vec()
    }

    #[test]
    fn an_axis_moves_while_it_is_held_and_stops_when_nobody_says_so_any_more() {
        let mut controller = paused();
        let before = controller.joints().axes;
        let mut holding = hold(&mut controller, "j1-", 700);
        let held = controller.joints().axes;
        assert!(held[0] < before[0] - 1.0 && held[1..] == before[1..], "{before:?} {held:?}");
        // While it is held no program goes on.
        controller.press(crate::io::Pendant::Start);
        assert!(controller.take_warnings().iter().any(|warning| warning.contains("a button moves the robot")));
        // A lost page sends nothing more.
        let mut last = controller.joints().axes;
        for _ in 0..1500 {
            controller.step();
            holding.cycle_ended(&mut controller);
            last = controller.joints().axes;
        }
        assert!(last[0] < held[0] && last[0] > held[0] - 20.0, "{held:?} {last:?}");
        controller.run_for(0.5);
        assert_eq!(controller.joints().axes, last);
        // Then the program goes on from where it was.
        controller.press(crate::io::Pendant::Start);
        assert_eq!(controller.run(), crate::Outcome::Ended);
        assert_eq!(controller.joints().axes[0], 90.0);
    }

    #[test]
    fn the_tcp_moves_along_a_frame_and_turns_on_the_spot() {
        let mut controller = paused();
        let start = tcp(&controller);
        hold(&mut controller, "z-", 800).let_go(&mut controller);
        controller.run_for(1.0);
        let lower = tcp(&controller);
        assert!(lower[2] < start[2] - 20.0, "{start:?} {lower:?}");
        for at in [0, 1] {
            assert!((lower[at] - start[at]).abs() < 1e-3, "{start:?} {lower:?}");
        }
        // Jogging axes keeps the tool, too: afterwards the TCP is the same.
        hold(&mut controller, "j1-", 600).let_go(&mut controller);
        controller.run_for(1.0);
        let lower = tcp(&controller);
        hold(&mut controller, "tool rx+", 500).let_go(&mut controller);
        controller.run_for(1.0);
        let turned = tcp(&controller);
        assert!((0..3).all(|at| (turned[at] - lower[at]).abs() < 1e-3), "{lower:?} {turned:?}");
        assert!((3..6).any(|at| (turned[at] - lower[at]).abs() > 1.0), "{lower:?} {turned:?}");
    }

    #[test]
    fn all_axes_go_to_a_point_and_no_farther() {
        let mut controller = paused();
        let mut holding = hold(&mut controller, "to 10 -80 80 0 30 5", 20_000);
        assert_eq!(controller.joints().axes, [10.0, -80.0, 80.0, 0.0, 30.0, 5.0]);
        holding.let_go(&mut controller);
        controller.run_for(1.0);
        assert!(holding.hold(&mut controller, 1, "j9+").unwrap_err().contains("axes 1 to 6"));
        assert!(holding.hold(&mut controller, 4, "j1+").unwrap_err().contains("no channel 4"));
        assert!(holding.hold(&mut controller, 1, "to 1000").is_err(), "beyond its range");
    }

    #[test]
    fn what_a_button_did_not_add_is_not_dropped() {
        let mut controller = paused();
        // There is nothing to do, and then no path: the program's own motion stays.
        let here: Vec<String> = controller.joints().axes.iter().map(f64::to_string).collect();
        hold(&mut controller, &format!("to {}", here.join(" ")), 50);
        let mut holding = Holding::default();
        assert!(holding.hold(&mut controller, 1, "to 1000").is_err());
        holding.let_go(&mut controller);
        controller.run_for(0.1);
        controller.press(crate::io::Pendant::Start);
        controller.step();
        assert!(controller.take_warnings().is_empty());
        controller.run_for(0.05);
        assert!(controller.joints().axes[0] < 45.0, "it goes on from where it was");
        // In a second pause buttons act as in the first one.
        controller.run_for(0.2);
        controller.press(crate::io::Pendant::Pause);
        controller.run_for(1.0);
        for _ in 0..2 {
            let before = controller.joints().axes[0];
            let mut holding = hold(&mut controller, "j1-", 600);
            assert!(controller.joints().axes[0] < before - 0.5);
            holding.let_go(&mut controller);
            controller.run_for(1.0);
        }
        controller.press(crate::io::Pendant::Start);
        assert_eq!(controller.run(), crate::Outcome::Ended);
        assert_eq!(controller.joints().axes[0], 90.0);
    }

    #[test]
    fn a_robot_that_something_stopped_takes_another_press() {
        let mut controller = paused();
        let mut holding = hold(&mut controller, "j1-", 600);
        controller.press(crate::io::Pendant::ServoOff);
        controller.run_for(1.0);
        controller.press(crate::io::Pendant::ServoOn);
        let stopped = controller.joints().axes;
        for cycle in 0..1000_u32 {
            if cycle.is_multiple_of(100) {
                holding.hold(&mut controller, 1, "j1-").unwrap();
            }
            controller.step();
            holding.cycle_ended(&mut controller);
        }
        assert_eq!(controller.joints().axes, stopped);
        holding.hold(&mut controller, 1, "").unwrap();
        hold(&mut controller, "j1-", 600);
        assert!(controller.joints().axes[0] < stopped[0] - 0.5);
    }
}
