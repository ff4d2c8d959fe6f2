//! Programs that wait for what nobody brings about.

use super::Folder;

const WAITS: &str = "func void main()\n    print \"before\"\n    waituntil getdi(1)\n    print \"never\"\nendfunc\n";

#[test]
fn a_run_ends_where_nothing_can_change() {
    let folder = Folder::new("standstill").with("a.arl", WAITS);
    let answer = folder.arl2rs(&["run", "a.arl"]);
    answer
        .is(4, "before\n")
        .says("nothing can change any more after 1.00")
        .says("  a.arl:3 waits for its condition, which does not hold")
        .says("  3 | waituntil getdi(1)")
        .says("  di.1 is off");
    // Where time is limited, and where there is no hurry, the program goes on waiting.
    let limited = folder.arl2rs(&["run", "a.arl", "--max-time", "0.001"]);
    limited.is(4, "before\n").says("the time limit of 0.001 s has passed");
    let real = folder.arl2rs(&["run", "a.arl", "--clock", "real", "--max-time", "0.05"]);
    real.is(4, "before\n").says("the time limit of 0.05 s has passed");
}

#[test]
fn a_run_ends_whose_robot_may_not_move() {
    let moves = "func void main()\n    movej j:{0,-90,90,0,60,0}\n    print \"planned\"\n    waittime 0\n    print \"never\"\nendfunc\n";
    let folder = Folder::new("override-0").with("a.arl", moves);
    folder
        .arl2rs(&["run", "a.arl", "--override", "0"])
        .is(4, "planned\n")
        .says("nothing can change any more after")
        .says("  a.arl:4 waits for motion, and the override is 0");
    let again = "func void main()\n    movej j:{0,-90,90,0,60,0}\n    restart\nendfunc\n";
    folder.write("b.arl", again);
    folder.arl2rs(&["run", "b.arl", "--override", "0"]).is(4, "").says("waits for motion, and the override is 0");
    folder.write("s.toml", "[[event]]\nat = 0\npendant = \"step\"\n\n[[event]]\nat = 0.1\npendant = \"step\"\n");
    folder.arl2rs(&["run", "a.arl", "--override", "0", "--io", "s.toml"]).is(4, "").says("nothing can change any more");
    // Whoever gives it speed again lets it go on.
    folder.write("s.toml", "[[event]]\nat = 2\noverride = 100\n");
    folder.arl2rs(&["run", "a.arl", "--override", "0", "--io", "s.toml"]).is(0, "planned\nnever\n");
    folder.write("s.toml", "[[event]]\nat = 0.2\noverride = 0\n");
    folder.arl2rs(&["run", "a.arl", "--io", "s.toml"]).is(4, "planned\n").says("the override is 0");
}

#[test]
fn a_case_that_waits_in_vain_fails_unless_it_sets_a_time() {
    let stopped = "bool started\n\nfunc void halt()\n    stopmove\nendfunc\n\nfunc void main()\n    interrupt when:started, do:halt()\n    \
                   movej j:{0,-90,90,0,60,0}\n    started = true\n    movej j:{0,-90,90,0,90,0}\n    setdo(1,true)\nendfunc\n";
    let beside = "func void main()\n    waituntil getdo(7)\nendfunc\n";
    let cell = "[[channel]]\nprogram = \"beside.arl\"\nbackground = true\n";
    let folder = Folder::new("vain")
        .with("cases/button.arl", "func void main()\n    pause\nendfunc\n")
        .with("cases/button.out", "")
        .with("cases/limited.arl", WAITS)
        .with("cases/limited.out", "before\n")
        .with("cases/limited.toml", "max_time = 2\n")
        .with("cases/motion.arl", stopped)
        .with("cases/motion.out", "")
        .with("cases/several.arl", "func void main()\n    waituntil getdo(8)\nendfunc\n")
        .with("cases/several.out", "")
        .with("cases/several.toml", "cell = \"cell.toml\"\n")
        .with("cases/cell.toml", cell)
        .with("cases/beside.arl", beside);
    let answer = folder.arl2rs(&["test", "cases"]);
    assert_eq!(answer.code, Some(1));
    for words in [
        "1 passed, 3 failed",
        "it waits for something that never happens",
        "button.arl:2 waits for the start button",
        "motion.arl:12 waits for motion that is stopped",
        "channel 1: several.arl:2 waits for its condition",
        "background channel 1: beside.arl:2 waits for its condition",
    ] {
        assert!(answer.out.contains(words), "{words} is not in\n{}", answer.out);
    }
}

#[test]
fn an_alarm_comes_before_who_waits_for_its_program() {
    let waits = "func void main()\n  waituntil getdi(1)\nendfunc\n";
    let fails = "func void main()\n  int a = 0\n  waittime 0.5\n  print 1 / a\nendfunc\n";
    let folder = Folder::new("standstill_alarm").with("waits.arl", waits).with("fails.arl", fails);
    let cells = [
        ("waits.arl", "fails.arl", ""),
        ("fails.arl", "waits.arl", ""),
        ("waits.arl", "fails.arl", "background = true\n"),
    ];
    for (first, second, background) in cells {
        folder.write("cell.toml", &format!("[[channel]]\nprogram = \"{second}\"\n{background}"));
        let run = |words: &[&str]| folder.arl2rs(&[&["run", first, "--cell", "cell.toml"], words].concat());
        run(&[]).is(3, "").says("alarm 20001").says("nothing can change any more after").says("waits.arl:2");
        run(&["--max-time", "1"]).is(3, "").says("alarm 20001");
        // What ends before the alarm has none.
        run(&["--max-time", "0.2"]).is(4, "").says("the time limit of 0.2 s has passed");
    }
}
