//! A whole program in the form that the compiler emits, and what comes out of it.

use arl_rt::{Captured, Controller, Outcome};

#[expect(unreachable_pub, reason = "emitted modules are public, wherever they are included")]
#[path = "programs/pick.rs"]
mod pick_program;

use pick_program::Globals;

#[test]
fn the_emitted_program_runs() {
    let messages = Captured::new();
    let scenario = "[[event]]\nwhen = \"do.3\"\nafter = 0.25\ndi.3 = true\n\
                    [[event]]\nwhen = \"!do.3\"\ndi.3 = false\n";
    let scenario = arl_rt::io::Scenario::parse("pick.io.toml", scenario).unwrap();
    let mut controller =
        Controller::builder().output(messages.clone()).scenario(scenario).build(Box::new(Globals::new())).unwrap();
    let outcome = controller.run();
    assert_eq!(messages.text(), EXPECTED);
    let Outcome::Alarm(alarm) = outcome else { panic!("{outcome}") };
    assert_eq!(
        alarm.to_string(),
        "alarm 20003: index 6 is outside the array: its size is 6, so 0 to 5 are valid (pick.arl:35)"
    );
    assert_eq!(controller.place().1, 35);
}

const EXPECTED: &str = "\
pick and place
part 1 in time: true
part 2 in time: true
at {0,-90,90,0,45,0,9e+09,9e+09,9e+09,9e+09,9e+09,9e+09}
sum is 7
waited 0.25 s
limits off
again
a line of text
";
