//! Scenarios and orders: reading, effects and errors.

use super::*;
use arl_robot::cell::Rate;
use arl_robot::robot::Description;

fn play(text: &str, cycles: u64, mut each: impl FnMut(u64, &mut Image)) -> Vec<Effect> {
    let scenario = Scenario::parse("io.toml", text).unwrap();
    scenario.check(&Channels::default(), &[&Robot::builtin("kr10-r1420").unwrap()]).unwrap();
    let mut image = Image::new(&Channels::default());
    let mut playing = Playing::new(scenario, &image, Rate::default());
    let mut effects = Vec::new();
    for cycle in 0..cycles {
        playing.play(cycle, &mut image, |effect| effects.push(effect));
        each(cycle, &mut image);
    }
    effects
}

#[test]
fn events_come_at_their_time() {
    let text = "[[event]]\nat = 0.005\ndi.5 = true\nai.2 = 4.5\n[[event]]\nat = 0.002\ndi.5 = false\ndi.6 = true\n";
    let mut seen = Vec::new();
    play(text, 8, |_, image| {
        seen.push((image.digitals(Digital::Di, 5, 6).unwrap(), image.analog_input(2).unwrap()));
    });
    assert_eq!(seen, [(0, 0.0), (0, 0.0), (2, 0.0), (2, 0.0), (2, 0.0), (3, 4.5), (3, 4.5), (3, 4.5)]);
}

#[test]
fn edges_set_off_events_every_time() {
    let text = "[[event]]\nwhen = \"do.3\"\nafter = 0.002\ndi.1 = true\n[[event]]\nwhen = \"!do.3\"\ndi.1 = false\n";
    let mut seen = Vec::new();
    play(text, 12, |cycle, image| {
        if cycle.is_multiple_of(4) {
            image.set_digital(Digital::Do, 3, cycle % 8 == 0).unwrap();
        }
        seen.push(image.digital(Digital::Di, 1).unwrap());
    });
    let on = [2, 3, 4, 10, 11];
    let expected: Vec<bool> = (0..12).map(|cycle| on.contains(&cycle)).collect();
    assert_eq!(seen, expected);
}

#[test]
fn the_pendant_speaks() {
    let text = "[[event]]\nat = 0\npendant = \"start\"\noverride = 50\n";
    assert_eq!(
        play(text, 1, |_, _| {}),
        [Pendant::Start, Pendant::Override(Override::from_percent(50.0).unwrap())].map(Effect::Pendant)
    );
}

#[test]
fn mistakes_name_line_and_what_was_expected() {
    for (text, line, words) in [
        ("[[event]]\nat = 1\ndi.5 = 1", 3, "`di.5`: expected true or false, found the number 1"),
        ("[[event]]\nat = 1\ndo.5 = true", 3, "did you mean `di`?"),
        ("[[event]]\nat = 1\ndi.x = true", 3, "a channel number from 1"),
        ("[[event]]\ndi.5 = true", 1, "neither `at` nor `when`"),
        ("[[event]]\nat = 1\nwhen = \"do.1\"\ndi.5 = true", 1, "both `at` and `when`"),
        ("[[event]]\nat = 1\nafter = 1\ndi.5 = true", 3, "counts from `when`"),
        ("[[event]]\nat = 1", 1, "changes nothing"),
        ("[[event]]\nwhen = \"do3\"\ndi.5 = true", 2, "expected \"do.3\""),
        ("[[event]]\nwhen = \"!pwm.1\"\ndi.5 = true", 2, "\"pwm.1\" (changes)"),
        ("[[event]]\nat = -1\ndi.5 = true", 2, "expected seconds"),
        ("[[event]]\nat = 1\npendant = \"strat\"", 3, "did you mean `start`?"),
        ("[[event]]\nat = 1\npendant = \"servo\"", 3, "the pendant has no button"),
        ("[[event]]\nat = 1\njog.j1 = true", 3, "`jog.j1`: expected deg"),
        ("[[event]]\nat = 1\noverride = 101", 3, "expected percent from 0 to 100"),
        ("[[event]]\nat = 1\nforce = [1, 2]", 3, "three components in N"),
        ("[[event]]\nat = 1\nforce = 80", 3, "three components in N"),
        ("[[event]]\nat = 1\ntorque.j7 = 80", 3, "did you mean `j1`?"),
        ("[[event]]\nat = 1\ntorque.j3 = \"much\"", 3, "`torque.j3`: expected a torque in Nm"),
        ("[[event]]\nat = 1\ntorque = 3", 3, "expected the table torque"),
        ("[[event]]\nat = 1\nforce = [0, nan, 0]", 3, "three components in N"),
        ("[[event]]\nat = 1\nforce = [0, 1e300, 0]", 3, "three components in N"),
        ("[[event]]\nat = 1\njog.j1 = inf", 3, "`jog.j1`: expected deg, or mm of a linear axis, from -1000000"),
        ("[[event]]\nat = 1\ntorque.j1 = -1e9", 3, "from -1000000 to 1000000, found the number -1e9"),
        ("[[event]]\nat = nan\ndi.1 = true", 2, "seconds from 0"),
        ("[[event]]\nat = 1\noverride = nan", 3, "percent from 0 to 100"),
        ("[[event]]\nat = 1\nai.1 = nan", 3, "`ai.1`: expected a number"),
        ("[[events]]\nat = 1", 1, "did you mean `event`?"),
        ("event = 3", 1, "[[event]]"),
        ("[[event]\n", 1, "not TOML"),
    ] {
        let error = Scenario::parse("io.toml", text).unwrap_err();
        assert_eq!(error.line, line, "{text}: {error}");
        assert!(error.message.contains(words), "{text}: {error}");
    }
}

#[test]
fn forces_and_torques_are_reported_in_order() {
    let text = "[[event]]\nat = 0\ntorque.j3 = -20.5\nforce = [1, 2.5, -3]\ntorque.j1 = 7\n";
    let effects = [RobotEffect::Torque(2, -20.5), RobotEffect::Torque(0, 7.0), RobotEffect::Force([1.0, 2.5, -3.0])];
    assert_eq!(play(text, 1, |_, _| {}), effects.map(|robot_effect| Effect::Robot(1, robot_effect)));
}

#[test]
fn events_name_the_channel_of_their_robot() {
    let scenario = Scenario::parse("io.toml", "[[event]]\nat = 1\nchannel = 2\ntorque.j5 = 1").unwrap();
    let (six, four) = (Robot::builtin("kr10-r1420").unwrap(), Robot::builtin("hsr065").unwrap());
    let check = |robots: &[&Robot]| scenario.check(&Channels::default(), robots);
    assert_eq!(check(&[&four, &six]), Ok(()));
    assert!(check(&[&six, &four]).unwrap_err().contains("robot hsr065 has j1 to j4"));
    assert!(check(&[&six]).unwrap_err().contains("channel 2, but there are 1 channels"));
    for channel in [0, 7] {
        let text = format!("[[event]]\nat = 1\nchannel = {channel}\ntorque.j5 = 1");
        let error = Scenario::parse("io.toml", &text).unwrap_err();
        assert!(error.line == 3 && error.message.contains("a channel with a robot from"), "{error}");
    }
}

#[test]
fn a_scenario_goes_on_until_nothing_is_pending() {
    let text = "[[event]]\nat = 0.002\ndi.1 = true\n[[event]]\nwhen = \"di.1\"\nafter = 0.003\npendant = \"reset\"\n";
    let scenario = Scenario::parse("io.toml", text).unwrap();
    let mut image = Image::new(&Channels::default());
    let mut playing = Playing::new(scenario, &image, Rate::default());
    assert!(playing.resets());
    let goes_on: Vec<bool> = (0..8)
        .map(|cycle| {
            playing.play(cycle, &mut image, |_| {});
            playing.goes_on(&image)
        })
        .collect();
    // In cycle 2 the input goes on, in cycle 3 this is seen, and 3 ms after cycle 2 the button is pressed.
    assert_eq!(goes_on, [true, true, true, true, true, false, false, false]);
}

#[test]
fn axes_and_masses_must_exist() {
    let scenario = Scenario::parse("io.toml", "[[event]]\nat = 1\ntorque.j5 = 1").unwrap();
    let scara = Robot::builtin("hsr065").unwrap();
    let error = scenario.check(&Channels::default(), &[&scara]).unwrap_err();
    assert!(error.contains("turns j5, but robot hsr065 has j1 to j4"), "{error}");
    let described = Robot::builtin("kr10-r1420").unwrap().into_description();
    let robot = Robot::new(Description { links: Vec::new(), ..described }).unwrap();
    let error = scenario.check(&Channels::default(), &[&robot]).unwrap_err();
    assert!(error.contains("has no [[link]]"), "{error}");
}

#[test]
fn channels_must_exist() {
    for (text, words) in [
        ("[[event]]\nat = 1\ndi.65 = true", "DI 65 does not exist"),
        ("[[event]]\nat = 1\nai.9 = 1", "AI 9 does not exist"),
        ("[[event]]\nwhen = \"do.65\"\ndi.1 = true", "do.65, but there are 64"),
        ("[[event]]\nwhen = \"pwm.4\"\ndi.1 = true", "pwm.4, but there are 3"),
    ] {
        let scenario = Scenario::parse("io.toml", text).unwrap();
        let error = scenario.check(&Channels::default(), &[&Robot::builtin("kr10-r1420").unwrap()]).unwrap_err();
        assert!(error.contains(words), "{error}");
    }
}

fn names() -> arl_robot::cell::Names {
    let text = "[names]\n\"di.1\" = \"part\"\n\"do.2\" = \"gripper\"\n\"ai.1\" = \"height\"\n";
    arl_robot::cell::Cell::parse("cell.toml", text).unwrap().names
}

#[test]
fn signals_may_be_called_by_their_names() {
    let text = "[[event]]\nat = 0.001\npart = true\nheight = 2.5\n[[event]]\nwhen = \"!gripper\"\npart = false\n";
    let named = Scenario::parse_with("io.toml", text, &names()).unwrap();
    let plain = text.replace("part", "di.1").replace("height", "ai.1").replace("gripper", "do.2");
    assert_eq!(named, Scenario::parse("io.toml", &plain).unwrap());
    let order = Order::parse("part = true", &names()).unwrap();
    assert_eq!(order, Order::parse("di.1 = true", &Names::default()).unwrap());
    for (text, line, words) in [
        ("[[event]]\nat = 1\nparts = true", 3, "did you mean `part`?"),
        ("[[event]]\nat = 1\ngripper = true", 3, "`gripper` is do.2, an output: a scenario sets inputs"),
        ("[[event]]\nat = 1\npart = 3", 3, "`part` is di.1: expected true or false, found the number 3"),
        ("[[event]]\nat = 1\nheight = true", 3, "`height` is ai.1: expected a number, found true"),
        ("[[event]]\nwhen = \"height\"\npart = true", 2, "expected \"do.3\""),
    ] {
        let error = Scenario::parse_with("io.toml", text, &names()).unwrap_err();
        assert!(error.line == line && error.message.contains(words), "{error}");
    }
}

#[test]
fn a_follower_has_the_level_of_what_it_follows_some_time_later() {
    let text = "[[follow]]\nsignal = \"part\"\nof = \"gripper\"\nafter = 0.002\n\
                [[follow]]\nsignal = \"di.3\"\nof = \"!gripper\"\n";
    let scenario = Scenario::parse_with("io.toml", text, &names()).unwrap();
    let mut image = Image::new(&Channels::default());
    let mut playing = Playing::new(scenario, &image, Rate::default());
    let mut seen = Vec::new();
    for cycle in 0..10 {
        playing.play(cycle, &mut image, |_| {});
        seen.push((image.digital(Digital::Di, 1).unwrap(), image.digital(Digital::Di, 3).unwrap()));
        if cycle == 2 || cycle == 6 {
            image.set_digital(Digital::Do, 2, cycle == 2).unwrap();
        }
    }
    let part: Vec<usize> = (0..10).filter(|cycle| seen[*cycle].0).collect();
    let opposite: Vec<usize> = (0..10).filter(|cycle| seen[*cycle].1).collect();
    assert_eq!((part, opposite), (vec![4, 5, 6, 7], vec![0, 1, 2, 7, 8, 9]));
    for (text, line, words) in [
        ("[[follow]]\nof = \"do.1\"", 1, "lacks `signal`: an input"),
        ("[[follow]]\nsignal = \"di.1\"", 1, "lacks `of`: a digital signal"),
        ("[[follow]]\nsignal = \"do.1\"\nof = \"do.1\"", 2, "expected an input"),
        ("[[follow]]\nsignal = \"di.1\"\nof = \"ai.1\"", 3, "expected a digital signal"),
        ("[[follow]]\nsignal = \"di.1\"\nof = \"do.1\"\nafter = -1", 4, "seconds from 0"),
        ("[[event]]\nat = 1\ndi.1 = true\n[[follow]]\nsignl = \"di.1\"", 5, "did you mean `signal`?"),
        (
            "[[follow]]\nsignal = \"di.1\"\nof = \"do.1\"\n[[follow]]\nsignal = \"di.1\"\nof = \"do.2\"",
            5,
            "line 1 makes it follow one",
        ),
    ] {
        let error = Scenario::parse("io.toml", text).unwrap_err();
        assert!(error.line == line && error.message.contains(words), "{error}");
    }
}

#[test]
fn what_a_cell_does_not_have_is_reported_with_its_line() {
    let robot = Robot::builtin("kr10-r1420").unwrap();
    let check = |text: &str| Scenario::parse("s.toml", text).unwrap().check(&Channels::default(), &[&robot]);
    let text = "# a comment\n\n[[event]]\nat = 1\ndi.1 = true\n[[event]]\nat = 1\ndi.99 = true\n";
    assert!(check(text).unwrap_err().starts_with("s.toml:6: the scenario cannot set an input"), "{:?}", check(text));
    let text = "[[follow]]\nsignal = \"di.1\"\nof = \"do.99\"\n";
    assert_eq!(check(text).unwrap_err(), "s.toml:1: the scenario waits for do.99, but there are 64");
}
