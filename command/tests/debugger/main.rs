//! `arl2rs dap`, as an editor uses it.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "tests start processes, and may fail")]

mod client;
#[path = "../support/messages.rs"]
mod messages;
mod pointer;

use client::{Client, Folder};
use serde_json::json;
use std::process::Command;

const COUNTS: &str = "\
int total = 0
pose feeder = {x 900, y -500, z 400, a 0, b 180, c 0}
const int ROUNDS = 3
func int add(int a, int b)
    int sum = a + b
    return sum
endfunc
func void main()
    int table[2][2] = {{1, 2}, {3, 4}}
    string name = \"part\"
    int i
    for(i = 0; i < ROUNDS; i++)
        total = add(total, i)
        print name, \" \", total
    endfor
    print \"done\"
endfunc
";

fn counts(name: &str) -> Folder {
    Folder::new(name).with("main.arl", COUNTS)
}

fn reason_and_top((reason, stack): (String, Vec<String>)) -> String {
    format!("{reason}: {}", stack.first().expect("a function"))
}

#[test]
fn it_halts_steps_and_goes_on() {
    let mut client = Client::running(&counts("steps"), json!({}), &[13]);
    assert_eq!(client.halt(), ("breakpoint".into(), vec!["main 13".into()]));
    assert_eq!(client.go("stepIn"), ("step".into(), vec!["add 5".into(), "main 13".into()]));
    assert_eq!(reason_and_top(client.go("next")), "step: add 6");
    assert_eq!(reason_and_top(client.go("next")), "step: main 14");
    assert_eq!(reason_and_top(client.go("stepIn")), "step: main 12");
    assert_eq!(reason_and_top(client.go("continue")), "breakpoint: main 13");
    assert_eq!(reason_and_top(client.go("stepIn")), "step: add 5");
    assert_eq!(reason_and_top(client.go("stepOut")), "step: main 14");
    client.ask("setBreakpoints", json!({"source": {"path": counts("steps").path("main.arl")}, "breakpoints": []}));
    client.ask("continue", json!({"threadId": 1}));
    assert_eq!(client.ended(), ("part 0\npart 1\npart 3\ndone\n".into(), json!(0)));
}

#[test]
fn variables_are_shown_and_set() {
    let mut client = Client::running(&counts("variables"), json!({}), &[5, 14]);
    assert_eq!(reason_and_top(client.halt()), "breakpoint: add 5");
    assert_eq!(client.scope("Locals").1, ["a = 0", "b = 0"]);
    assert_eq!(reason_and_top(client.go("continue")), "breakpoint: main 14");
    let (locals, shown) = client.scope("Locals");
    assert_eq!(shown, ["table = {{1,2},{3,4}}", "name = \"part\"", "i = 0"]);
    for (expression, value) in [
        ("table[1][0] + total", "3"),
        ("name + \"!\"", "\"part!\""),
        ("feeder.x / 2", "450"),
        ("ROUNDS", "3"),
        ("getdi(1)", "false"),
        ("$DFSPEED.tcp", "50"),
        ("sqrt(total + 9) + 1", "4"),
        ("abs(-3)", "3"),
        ("abs(-2.5)", "2.5"),
        ("strlen(name) + strlen(substr(name, 1, 2))", "6"),
        ("tostr(255, hex)", "\"ff\""),
        ("offset(feeder, 10, 0, 0, 0, 0, 0).x", "910"),
        ("getpose(cjoint(), $FLANGE, $WORLD).b", "0"),
        ("log(0)", "log: 0 is not above 0"),
        ("abs(25.0) / 2", "12.5"),
        ("bitcheck(5.0, 0)", "bitcheck does not take these arguments here: see `arl2rs doc bitcheck`"),
        ("fmod(y:3, x:10)", "arguments are given in order here, without labels and units"),
        ("sqrt(name)", "sqrt does not take these arguments here: see `arl2rs doc sqrt`"),
        ("setdo(1, true)", "setdo cannot be called while the program is halted"),
        ("add(1, 2)", "only built-in functions can be called while the program is halted, and add is not one"),
        ("nothing", "there is no variable nothing here"),
    ] {
        assert_eq!(client.value(expression), value, "{expression}");
    }
    client.ask("setVariable", json!({"variablesReference": locals, "name": "i", "value": "i + 1"}));
    client.ask("setVariable", json!({"variablesReference": locals, "name": "name", "value": "\"piece\""}));
    let frame = client.frame();
    client.ask("setExpression", json!({"frameId": frame, "expression": "table[1][1]", "value": "9"}));
    client.ask("setExpression", json!({"frameId": frame, "expression": "feeder.z", "value": "1.5"}));
    for context in ["watch", "hover"] {
        assert!(client.value_in(context, "total = 7").contains("`==` compares"));
    }
    assert_eq!(client.value("total = 39"), "39");
    assert_eq!(client.value("total++"), "40");
    assert_eq!(client.value("feeder"), "{x 900,y -500,z 1.5,a 0,b 180,c 0,cfg 0,turn -1}");
    assert_eq!(client.scope("Locals").1, ["table = {{1,2},{3,9}}", "name = \"piece\"", "i = 1"]);
    // Rows that are open in the editor show what was set in them.
    let rows = client.ask("variables", json!({"variablesReference": locals}))["variables"][0].clone();
    let rows = rows["variablesReference"].clone();
    let row = client.ask("variables", json!({"variablesReference": rows}))["variables"][0].clone();
    let row = row["variablesReference"].clone();
    assert_eq!(client.parts(&row), ["[0] = 1", "[1] = 2"]);
    client.ask("setVariable", json!({"variablesReference": row, "name": "[1]", "value": "22"}));
    assert_eq!(client.parts(&row), ["[0] = 1", "[1] = 22"]);
    assert_eq!(client.parts(&rows), ["[0] = {1,22}", "[1] = {3,9}"]);
    let unknown = json!({"expression": "total", "frameId": 4711});
    assert_eq!(client.refused("evaluate", unknown), "the frame is no longer there");
    assert_eq!(client.refused("stackTrace", json!({"threadId": 7})), "there is no thread 7");
    let wrong = client.refused("setVariable", json!({"variablesReference": locals, "name": "i", "value": "\"x\""}));
    assert!(wrong.contains("expected a value of type int"), "{wrong}");
    let (globals, files) = client.scope("Globals");
    assert_eq!(files, ["main.arl = "]);
    let reference = client.ask("variables", json!({"variablesReference": globals}))["variables"][0].clone();
    let shown = client.parts(&reference["variablesReference"]);
    assert_eq!(shown.first().map(String::as_str), Some("total = 40"));
    assert_eq!(reason_and_top(client.go("continue")), "breakpoint: add 5");
    client.set_breakpoints(&Folder(counts("variables").0), "main.arl", json!([]));
    client.ask("continue", json!({"threadId": 1}));
    assert_eq!(client.ended().0, "piece 40\npiece 42\ndone\n");
}

#[test]
fn breakpoints_have_conditions_counts_and_messages() {
    let folder = counts("breakpoints");
    let mut client = Client::new();
    client.ask("launch", json!({"program": folder.path("main.arl")}));
    let answer = client.set_breakpoints(
        &folder,
        "main.arl",
        json!([
            {"line": 13, "condition": "i == 1"},
            {"line": 14, "hitCondition": "3"},
            {"line": 7},
            {"line": 6, "logMessage": "sum is {sum}"},
            {"line": 99},
            {"line": 16, "hitCondition": "often"},
            {"line": 16, "condition": "i ="},
        ]),
    );
    let lines: Vec<_> =
        answer.as_array().unwrap().iter().map(|one| (one["verified"] == true, one["line"].as_u64())).collect();
    assert_eq!(
        lines,
        [
            (true, Some(13)),
            (true, Some(14)),
            (true, Some(9)),
            (true, Some(6)),
            (false, None),
            (false, None),
            (false, None)
        ]
    );
    client.ask("setFunctionBreakpoints", json!({"breakpoints": [{"name": "ADD", "condition": "b == 2"}]}));
    client.ask("configurationDone", json!({}));
    assert_eq!(reason_and_top(client.halt()), "breakpoint: main 9");
    assert_eq!(reason_and_top(client.go("continue")), "breakpoint: main 13");
    assert_eq!(client.value("i"), "1");
    assert_eq!(reason_and_top(client.go("continue")), "breakpoint: add 5");
    assert_eq!(client.value("a * 10 + b"), "12");
    assert_eq!(reason_and_top(client.go("continue")), "breakpoint: main 14");
    client.ask("continue", json!({"threadId": 1}));
    client.ended();
    for message in ["sum is 0\n", "sum is 1\n", "sum is 3\n"] {
        assert!(client.other_output.contains(message), "{}", client.other_output);
    }
}

#[test]
fn it_goes_back_and_repeats_itself() {
    let mut client = Client::running(&counts("back"), json!({}), &[14]);
    assert_eq!(reason_and_top(client.halt()), "breakpoint: main 14");
    assert_eq!(reason_and_top(client.go("stepBack")), "step: add 6");
    assert_eq!(client.value("sum"), "0");
    client.value("sum = 10");
    assert_eq!(reason_and_top(client.go("continue")), "breakpoint: main 14");
    assert_eq!(client.value("total"), "10");
    assert_eq!(reason_and_top(client.go("continue")), "breakpoint: main 14");
    assert_eq!(client.value("total"), "11");
    assert_eq!(reason_and_top(client.go("stepBack")), "step: add 6");
    assert_eq!(client.value("sum"), "11", "what was set by hand is set again");
    assert_eq!(client.go("reverseContinue").1, ["main 14"]);
    assert_eq!(client.value("total"), "10");
    client.set_breakpoints(&Folder(counts("back").0), "main.arl", json!([]));
    client.ask("continue", json!({"threadId": 1}));
    assert_eq!(client.ended().0, "part 10\npart 11\npart 13\ndone\n");
}

const CELL: &str = "\
joint home = {60, -90, 90, 0, 90, 0}
int seen = 0
func void opened(int gate)
    seen = seen + gate
    setdo(3, true)
endfunc
func void main()
    interrupt \"gate\", when:getdi(5), do:opened(7)
    movej home, vp:50%
    movej j:{20, -90, 90, 0, 90, 0}, vp:50%, sl:5mm
    movej home, vp:50%
    waittime 0
    print seen, \" \", getdo(3)
    int none = 0
    print 1 / none
endfunc
";

const SCENARIO: &str = "[[event]]\nat = 0.6\ndi.5 = true\n";

fn cell(name: &str) -> Folder {
    Folder::new(name).with("main.arl", CELL).with("io.toml", SCENARIO)
}

#[test]
fn it_halts_in_the_action_of_an_interrupt_while_the_robot_moves() {
    let folder = cell("interrupt");
    let mut client = Client::running(&folder, json!({"io": "io.toml", "trace": "watched.csv"}), &[4]);
    let (reason, stack) = client.halt();
    assert_eq!(reason, "breakpoint");
    assert_eq!(stack[..2], ["opened 4", "the interrupt \"gate\" 8"]);
    assert!(stack[2].starts_with("main "), "{stack:?}");
    assert_eq!(client.value("gate"), "7");
    let pointer = client.event("arl/motionPointer");
    assert_eq!((&pointer["channel"], &pointer["motion"]), (&json!(1), &json!(1)), "{pointer}");
    assert!(pointer["file"].as_str().unwrap().ends_with("main.arl"));
    let (_, robot) = client.scope("Robot");
    let value = |line: &str| line.split(' ').nth(2).expect("a value").parse::<f64>().expect("a number");
    assert!(robot[0].starts_with("j1 = ") && robot[0].ends_with(" deg"), "{robot:?}");
    assert!(robot[6].starts_with("x = ") && value(&robot[6]).abs() > 1.0, "{robot:?}");
    assert!(robot.last().unwrap().starts_with("motion = number"), "{robot:?}");
    let (_, before) = client.scope("Robot");
    assert_eq!(robot, before, "time stands still");
    let (reason, stack) = client.go("continue");
    assert_eq!((reason.as_str(), stack.first().map(String::as_str)), ("exception", Some("main 15")));
    assert!(client.ask("exceptionInfo", json!({"threadId": 1}))["description"].as_str().unwrap().contains("division"));
    assert_eq!(client.value("none"), "0");
    client.ask("continue", json!({"threadId": 1}));
    assert_eq!(client.ended(), ("7 true\n".into(), json!(3)));
    assert!(client.other_output.contains("alarm 20001"), "{}", client.other_output);
    // The same run without a debugger, to the last bit.
    let ran = Command::new(env!("CARGO_BIN_EXE_arl2rs"))
        .args(["run", "main.arl", "--io", "io.toml", "--trace", "alone.csv"])
        .current_dir(&folder.0)
        .output()
        .expect("the command runs");
    assert_eq!(String::from_utf8_lossy(&ran.stdout), "7 true\n");
    let trace = |name: &str| std::fs::read_to_string(folder.path(name)).expect("a trace");
    assert_eq!(trace("watched.csv").lines().count(), trace("alone.csv").lines().count());
    assert!(trace("watched.csv") == trace("alone.csv"), "halting changes nothing");
}

#[test]
fn it_steps_by_motion_halts_at_events_and_pauses() {
    let folder = cell("motion");
    let mut client = Client::new();
    client.ask("launch", json!({"program": folder.path("main.arl"), "io": "io.toml", "stopOnEntry": true}));
    client.ask("setExceptionBreakpoints", json!({"filters": ["events"]}));
    client.ask("configurationDone", json!({}));
    assert_eq!(reason_and_top(client.halt()), "entry: main 8");
    client.go("arl/nextMotion");
    let pointer = client.event("arl/motionPointer");
    assert_eq!((&pointer["line"], &pointer["motion"]), (&json!(9), &json!(1)));
    let (reason, stack) = client.go("continue");
    assert_eq!((reason.as_str(), stack[0].as_str()), ("event", "the interrupt \"gate\" 8"));
    client.ask("restart", json!({}));
    assert_eq!(reason_and_top(client.halt()), "entry: main 8");
    client.ask("terminate", json!({}));
    client.event("terminated");
}

#[test]
fn a_program_that_waits_can_be_paused() {
    let folder = Folder::new("pause").with(
        "main.arl",
        "func void main()\n    int k\n    while(k >= 0)\n        k = (k + 1) % 1000\n    endwhile\nendfunc\n",
    );
    let mut client = Client::running(&folder, json!({}), &[]);
    assert_eq!(reason_and_top(client.go("pause")).split(' ').next(), Some("pause:"));
    client.value("k = -5");
    client.ask("continue", json!({"threadId": 1}));
    // One round may have been on its way: below 0 it ends, at -4 or so.
    assert_eq!(client.ended().1, json!(0));
}

#[test]
fn in_real_time_the_robot_stops_on_its_path() {
    let folder = Folder::new("real").with(
        "main.arl",
        "func void main()\n    movej j:{0, -90, 90, 0, 90, 0}, vp:50%\n    movej j:{40, -90, 90, 0, 90, 0}, vp:20%\n    \
         waittime 0.01\n    print \"there\"\nendfunc\n",
    );
    let mut client = Client::running(&folder, json!({"clock": "real"}), &[]);
    loop {
        if client.event("arl/motionPointer")["motion"].as_u64() > Some(0) {
            break;
        }
    }
    client.go("pause");
    std::thread::sleep(std::time::Duration::from_millis(500));
    let (_, stopped) = client.scope("Robot");
    std::thread::sleep(std::time::Duration::from_millis(100));
    assert_eq!(client.scope("Robot").1, stopped, "it has come to rest, and stays");
    assert_ne!(stopped[0], "j1 = 40.000 deg", "on its way");
    assert!(client.refused("stepBack", json!({"threadId": 1})).contains("real time"));
    client.ask("continue", json!({"threadId": 1}));
    assert_eq!(client.ended(), ("there\n".into(), json!(0)));
}

#[test]
fn mistakes_are_reported() {
    let mut client = Client::new();
    assert!(client.refused("launch", json!({})).contains("has no `program`"));
    assert!(client.refused("launch", json!({"program": "a.arl", "clock": "fast"})).contains("virtual or real"));
    assert!(client.refused("continue", json!({"threadId": 1})).contains("no program runs"));
    assert!(client.refused("fly", json!({})).contains("no request `fly`"));
    let folder = Folder::new("mistakes").with("main.arl", "func void main()\n    movej 5\nendfunc\n");
    assert!(client.refused("launch", json!({"program": folder.path("main.arl")})).contains("error"));
    assert!(client.other_output.contains("error[ARL"), "{}", client.other_output);
    client.ask("disconnect", json!({}));
    // A program that does not begin ends the session.
    let folder = Folder::new("no_scenario").with("main.arl", "func void main()\nendfunc\n").with("io.toml", "at = 1\n");
    let mut client = Client::new();
    client.ask("launch", json!({"program": folder.path("main.arl"), "io": "io.toml"}));
    client.refused("configurationDone", json!({}));
    client.event("terminated");
    assert!(client.other_output.contains("io.toml"), "{}", client.other_output);
}

#[test]
fn what_killed_adapters_left_is_taken_away() {
    let folder = Folder::new("left").with("main.arl", "func void main()\nendfunc\n");
    // No process of Linux has such a number; this one is there.
    let leftovers =
        [4_194_305, std::process::id()].map(|process| std::env::temp_dir().join(format!("arl2rs-debug-{process}-9")));
    leftovers.iter().for_each(|path| std::fs::write(path, "").unwrap());
    let mut client = Client::running(&folder, json!({}), &[]);
    client.ended();
    let there = leftovers.each_ref().map(|path| path.exists());
    leftovers.iter().for_each(|path| drop(std::fs::remove_file(path)));
    assert_eq!(there, [!std::path::Path::new("/proc/self").exists(), true]);
}

#[test]
fn a_run_that_cannot_go_on_says_who_waits() {
    let folder = Folder::new("standstill").with("main.arl", "func void main()\n    waituntil getdi(9)\nendfunc\n");
    let mut client = Client::running(&folder, json!({}), &[]);
    assert_eq!(client.halt(), ("pause".into(), vec!["main 2".into()]));
    // Nothing was changed: the run ends. An input that is set lets it go on.
    client.ask("continue", json!({"threadId": 1}));
    assert_eq!(client.ended().1, json!(4));
    assert!(client.other_output.contains("nothing can change any more"), "{}", client.other_output);
    let mut client = Client::running(&folder, json!({}), &[]);
    client.halt();
    let (signals, _) = client.scope("Signals");
    let kinds = client.ask("variables", json!({"variablesReference": signals}))["variables"].clone();
    let inputs = &kinds[0]["variablesReference"];
    client.ask("setVariable", json!({"variablesReference": inputs, "name": "9", "value": "true"}));
    client.ask("continue", json!({"threadId": 1}));
    assert_eq!(client.ended().1, json!(0));
    // Without alarms there are no such halts, either.
    let mut client = Client::new();
    client.ask("launch", json!({"program": folder.path("main.arl")}));
    client.ask("setExceptionBreakpoints", json!({"filters": []}));
    client.ask("configurationDone", json!({}));
    assert_eq!(client.ended().1, json!(4));
    assert!(client.refused("goto", json!({"threadId": 1, "targetId": 0})).contains("no such target"));
    assert!(client.refused("stepBack", json!({"threadId": 1})).contains("no program runs"));
}

#[test]
fn without_debugging_nothing_halts() {
    let mut client = Client::running(&counts("no_debug"), json!({"noDebug": true}), &[13]);
    assert_eq!(client.ended().0, "part 0\npart 1\npart 3\ndone\n");
}

#[test]
fn in_real_time_conditions_go_on_while_the_program_is_halted() {
    let folder = Folder::new("conditions").with(
        "main.arl",
        "func bool open()\n    bool level = getdi(5)\n    return level\nendfunc\nfunc void act()\n    print \"never\"\nendfunc\n\
         func void main()\n    interrupt \"gate\", when:open(), do:act()\n    waittime 0.05\n    print \"done\"\nendfunc\n",
    );
    let mut client = Client::running(&folder, json!({"clock": "real"}), &[2, 10]);
    assert_eq!(client.halt(), ("breakpoint".into(), vec!["main 10".into()]));
    std::thread::sleep(std::time::Duration::from_millis(50));
    client.ask("continue", json!({"threadId": 1}));
    assert_eq!(client.ended(), ("done\n".into(), json!(0)));
}

#[test]
fn the_steps_back_of_an_endless_program_end() {
    let folder = Folder::new("endless").with(
        "main.arl",
        "func void main()\n    int k = 1\n    while(k > 0)\n        k = k + 1\n        waittime 0.1\n    endwhile\nendfunc\n",
    );
    let mut client = Client::running(&folder, json!({}), &[4]);
    assert_eq!(reason_and_top(client.halt()), "breakpoint: main 4");
    assert_eq!(reason_and_top(client.go("continue")), "breakpoint: main 4");
    assert_eq!(reason_and_top(client.go("next")), "step: main 5");
    assert_eq!(client.value("k"), "3");
    assert_eq!(client.go("reverseContinue").1, ["main 4"]);
    assert_eq!(client.value("k"), "2");
    client.set_breakpoints(&folder, "main.arl", json!([]));
    assert_eq!(client.go("reverseContinue").1, ["main 2"]);
    client.ask("disconnect", json!({}));
}

#[test]
fn hits_are_counted_as_far_as_the_run_has_gone() {
    let folder = counts("hits");
    let mut client = Client::new();
    client.ask("launch", json!({"program": folder.path("main.arl")}));
    client.set_breakpoints(&folder, "main.arl", json!([{"line": 14, "hitCondition": "== 2"}]));
    client.ask("configurationDone", json!({}));
    assert_eq!(reason_and_top(client.halt()), "breakpoint: main 14");
    assert_eq!(client.value("i"), "1");
    assert_eq!(reason_and_top(client.go("stepBack")), "step: add 6");
    assert_eq!(reason_and_top(client.go("continue")), "breakpoint: main 14");
    assert_eq!(client.value("i"), "1", "the first hit was before");
}

#[test]
fn what_was_printed_is_there_when_the_program_halts() {
    let mut client = Client::running(&counts("printed"), json!({}), &[14]);
    client.halt();
    client.go("next");
    // The text comes over another pipe than the halt.
    while client.printed.is_empty() {
        client.ask("threads", json!({}));
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    assert_eq!(client.printed, "part 0\n");
}

#[test]
fn programs_of_a_cell_may_have_files_of_the_same_name() {
    let program =
        |name: &str| format!("string name = \"{name}\"\nfunc void main()\n    waittime 0.1\n    print name\nendfunc\n");
    let folder = Folder::new("cell").with("main.arl", &program("one"));
    std::fs::create_dir_all(folder.0.join("two")).unwrap();
    let folder =
        folder.with("two/main.arl", &program("two")).with("cell.toml", "[[channel]]\nprogram = \"two/main.arl\"\n");
    let mut client = Client::new();
    client.ask("launch", json!({"program": folder.path("main.arl"), "cell": "cell.toml"}));
    client.set_breakpoints(&folder, "two/main.arl", json!([{"line": 4}]));
    client.ask("configurationDone", json!({}));
    let stopped = client.event("stopped");
    assert_eq!(stopped["threadId"], 2, "{stopped}");
    let frame = client.ask("stackTrace", json!({"threadId": 2}))["stackFrames"][0].clone();
    assert_eq!(frame["source"]["path"], folder.path("two/main.arl"));
    let value = client.ask("evaluate", json!({"expression": "name", "frameId": frame["id"]}));
    assert_eq!(value["result"], "\"two\"");
    client.ask("continue", json!({"threadId": 2}));
    assert_eq!(client.ended().1, json!(0));
}

#[test]
fn clocks_and_connections_are_shown() {
    let folder = Folder::new("handles").with(
        "main.arl",
        "clock all\nsocket line\nclock each[2][1]\nfunc void main()\n    clock own\n    clkstart(all)\n    clkstart(own)\n    waittime 0.5\n    \
         clkstop(own)\n    waittime 0.25\n    print clkread(own)\nendfunc\n",
    );
    let mut client = Client::running(&folder, json!({}), &[11]);
    client.halt();
    let (_, locals) = client.scope("Locals");
    assert!(locals.contains(&"own = 0.500 s, stopped".to_owned()), "{locals:?}");
    assert_eq!(client.value("all"), "0.750 s, running");
    assert_eq!(client.value("line"), "closed");
    let (globals, _) = client.scope("Globals");
    let file = client.ask("variables", json!({"variablesReference": globals}))["variables"][0].clone();
    assert_eq!(
        client.parts(&file["variablesReference"]),
        ["all = 0.750 s, running", "line = closed", "each = {0.000 s, stopped; 0.000 s, stopped}"]
    );
    assert_eq!(client.value("all = 3"), "3 does not fit: expected a value of type clock");
}

#[test]
fn what_a_block_declares_ends_with_it() {
    let folder = Folder::new("blocks").with(
        "main.arl",
        "func void main()\n    if(true)\n        clock row[2]\n        int inner = 1\n        print inner\n    endif\n    \
         for(int i = 0; i < 2; i++)\n        if(i == 1)\n            clock pair[2]\n            int left = 3\n            \
         print left\n            break\n        endif\n    endfor\n    int last = 5\n    print last\nendfunc\n",
    );
    let mut client = Client::running(&folder, json!({}), &[5, 12, 16]);
    let mut locals = || {
        client.halt();
        let locals = client.scope("Locals").1;
        client.ask("continue", json!({"threadId": 1}));
        locals
    };
    let row = |name: &str| format!("{name} = {{0.000 s, stopped; 0.000 s, stopped}}");
    // Numbers come before clocks.
    assert_eq!(locals(), ["inner = 1".into(), row("row")]);
    assert_eq!(locals(), ["i = 1".into(), "left = 3".into(), row("pair")]);
    assert_eq!(locals(), ["last = 5"]);
}

#[test]
fn a_function_may_have_hundreds_of_variables() {
    let declared: String = (0..300).map(|number| format!("    int v{number} = {number}\n")).collect();
    let text = format!("func void main()\n{declared}    print v0 + v299\nendfunc\n");
    let folder = Folder::new("hundreds").with("main.arl", &text);
    let mut client = Client::running(&folder, json!({}), &[302]);
    client.halt();
    assert_eq!(client.scope("Locals").1.len(), 300);
    assert_eq!(client.value("v299 = 7"), "7");
    client.ask("continue", json!({"threadId": 1}));
    assert_eq!(client.ended().1, json!(0));
    assert_eq!(client.printed, "7\n");
}

#[test]
fn a_launch_configuration_with_mistakes_is_refused() {
    let folder = counts("launch_mistakes").with("broken.toml", "[[event]]\nat = \"noon\"\n");
    let launch = |more: serde_json::Value| {
        let mut launch = json!({"program": folder.path("main.arl"), "cwd": folder.0});
        launch.as_object_mut().expect("an object").extend(more.as_object().expect("an object").clone());
        launch
    };
    for (more, why) in [
        (json!({"io": "none.toml"}), "io: "),
        (json!({"trace": "none/trace.csv"}), "trace: "),
        (json!({"override": 150}), "override 150: expected a number of percent, 0 to 100"),
        (json!({"maxTime": -1}), "maxTime -1: expected a time in s, 0 or more"),
        (json!({"robot": "none"}), "none"),
        (json!({"stopOnEntry": "yes"}), "expected a boolean"),
    ] {
        let refused = Client::new().refused("launch", launch(more));
        assert!(refused.contains(why), "{why}: {refused}");
    }
    // What only the program finds is told by it.
    let mut client = Client::new();
    client.ask("launch", launch(json!({"io": "broken.toml", "scenrio": "x", "__sessionId": 1, "type": "arl"})));
    client.event("initialized");
    let refused = client.refused("configurationDone", json!({}));
    assert!(refused.contains("broken.toml:2"), "{refused}");
    assert!(client.other_output.contains("unknown key `scenrio`"), "{}", client.other_output);
    assert!(!client.other_output.contains("sessionId") && !client.other_output.contains("`type`"));
}

#[test]
fn who_does_not_speak_the_protocol_is_told() {
    let ended = |input: &str| {
        let mut child = Command::new(env!("CARGO_BIN_EXE_arl2rs"))
            .arg("dap")
            .stdin(std::process::Stdio::piped())
            .stdout(std::process::Stdio::null())
            .stderr(std::process::Stdio::piped())
            .spawn()
            .expect("the command starts");
        let mut stdin = child.stdin.take().expect("its input");
        std::io::Write::write_all(&mut stdin, input.as_bytes()).expect("it reads");
        drop(stdin);
        let output = child.wait_with_output().expect("it ends");
        (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
    };
    let (code, says) = ended("{\"command\": \"initialize\"}\n");
    assert!(code == Some(1) && says.contains("Content-Length"), "{says}");
    assert_eq!(ended(""), (Some(0), String::new()));
}
