//! `check` and `emit`.

use super::Folder;

const GOOD: &str = "func void main()\n    print \"hello\"\nendfunc\n";
const BAD: &str = "func void main()\n    int a = \"x\"\n    prnt 3\nendfunc\n";

#[test]
fn a_right_program_is_not_worth_a_word() {
    let folder = Folder::new("right").with("a.arl", GOOD);
    let answer = folder.arl2rs(&["check", "a.arl"]);
    assert_eq!(answer.is(0, "").err, "");
}

#[test]
fn mistakes_show_their_source() {
    let folder = Folder::new("mistakes").with("robot/a.arl", BAD);
    let answer = folder.arl2rs(&["check", "robot/a.arl"]);
    answer
        .is(1, "")
        .says("error[ARL0301]")
        .says("--> robot/a.arl:2:13\n")
        .says("2 |     int a = \"x\"")
        .says("2 errors");
}

#[test]
fn people_see_fifty_mistakes_and_how_many_there_are() {
    let wrong: String = (0..200).map(|at| format!("    x{at} = 1\n")).collect();
    let folder = Folder::new("many").with("a.arl", &format!("func void main()\n{wrong}endfunc\n"));
    let shown = |more: &[&str]| {
        let answer = folder.arl2rs(&[&["check", "a.arl"], more].concat());
        assert_eq!(answer.code, Some(1));
        let summary = answer.err.lines().rfind(|line| !line.is_empty()).unwrap_or_default().to_string();
        (answer.err.matches("error[ARL0201]").count(), summary)
    };
    let rest = |count: usize| {
        format!("error: a.arl: 200 errors; {count} of them not shown: `arl2rs check --max-errors 0` shows all")
    };
    assert_eq!(shown(&[]), (50, rest(150)));
    assert_eq!(shown(&["--max-errors", "3"]), (3, rest(197)));
    assert_eq!(shown(&["--max-errors", "0"]), (200, "error: a.arl: 200 errors".into()));
    let all = folder.arl2rs(&["check", "a.arl", "--format", "json", "--max-errors", "3"]);
    assert_eq!(all.out.lines().count(), 200);
    folder.arl2rs(&["emit", "a.arl"]).is(1, "").says("150 of them not shown");
}

#[test]
fn json_is_one_object_a_line() {
    let folder = Folder::new("json").with("a.arl", BAD);
    let answer = folder.arl2rs(&["check", "--format", "json", "a.arl"]);
    assert_eq!((answer.code, answer.err.as_str()), (Some(1), ""));
    let objects: Vec<serde_json::Value> =
        answer.out.lines().map(|line| serde_json::from_str(line).expect("an object")).collect();
    assert_eq!(objects.len(), 2);
    let first = objects[0].as_object().expect("an object");
    let mut keys: Vec<&str> = first.keys().map(String::as_str).collect();
    keys.sort_unstable();
    assert_eq!(keys, ["code", "column", "end_column", "end_line", "file", "help", "line", "message", "severity"]);
    assert_eq!((first["code"].as_str(), first["severity"].as_str()), (Some("ARL0301"), Some("error")));
    assert_eq!((first["line"].as_u64(), first["column"].as_u64()), (Some(2), Some(13)));
    assert_eq!((first["end_line"].as_u64(), first["end_column"].as_u64()), (Some(2), Some(16)));
    assert_eq!(first["file"].as_str(), Some("a.arl"));
}

#[test]
fn modules_of_a_given_program_need_no_main_but_programs_do() {
    let folder = Folder::new("modules")
        .with("a.arl", "import \"lib/tools.arl\"\nfunc void main()\n    tools::go()\nendfunc\n")
        .with("a_data.arl", "int count = 3\n")
        .with("lib/tools.arl", "func void go()\nendfunc\n");
    folder.arl2rs(&["check", "lib/tools.arl", "a.arl", "a_data.arl"]).is(0, "");
    folder.arl2rs(&["check", "lib/tools.arl"]).is(1, "").says("main");
}

#[test]
fn a_mistake_in_a_module_of_two_programs_is_reported_once() {
    let program = "import \"m.arl\"\nfunc void main()\n    m::go()\nendfunc\n";
    let folder = Folder::new("once")
        .with("a.arl", program)
        .with("b.arl", program)
        .with("m.arl", "func void go()\n    int a = true + 1\nendfunc\n");
    let answer = folder.arl2rs(&["check", "--format", "json", "a.arl", "b.arl"]);
    assert_eq!((answer.code, answer.out.lines().count()), (Some(1), 1), "{}", answer.out);
}

#[test]
fn strict_warns_and_passes() {
    let folder = Folder::new("strict").with("a.arl", "func void main()\n    int Count = 1\n    print count\nendfunc\n");
    assert_eq!(folder.arl2rs(&["check", "a.arl"]).is(0, "").err, "");
    folder.arl2rs(&["check", "--strict", "a.arl"]).is(0, "").says("warning[ARL0951]");
}

#[test]
fn the_robot_decides_about_types() {
    let hsr065 = arl_robot::Robot::text("hsr065").expect("the robot is built in").to_owned();
    let folder = Folder::new("robot")
        .with("a.arl", "func void main()\n    joint p = {1,2,3,4,5,6}\n    movej p\nendfunc\n")
        .with("mine.toml", &hsr065)
        .with("half.toml", &hsr065.replacen("l1 = ", "length = ", 1))
        .with("wrong.toml", "name = \"x\"\nfamily = \"delta\"\n");
    folder.arl2rs(&["check", "a.arl"]).is(0, "");
    folder.arl2rs(&["check", "--robot", "six-10", "a.arl"]).is(0, "");
    let as_scara = "func void main()\n    joint p = {1,2,3,4}\n    p.j5 = 1\n    movej p\nendfunc\n";
    folder.write("a.arl", as_scara);
    folder.arl2rs(&["check", "--robot", "mine.toml", "a.arl"]).is(1, "").says("j5");
    folder.arl2rs(&["check", "--robot", "wrong.toml", "a.arl"]).is(2, "").says("wrong.toml:2: ").says("six-axis");
    folder.arl2rs(&["check", "--robot", "half.toml", "a.arl"]).is(2, "").says("half.toml:").says("`length`");
    folder
        .arl2rs(&["check", "--robot", "nothing", "a.arl"])
        .is(2, "")
        .says("nothing: no robot of this name is built in");
}

#[test]
fn bytes_that_are_no_text_are_a_diagnostic() {
    let folder = Folder::new("bytes");
    std::fs::write(folder.path.join("a.arl"), [0xff, 0xfe, 0x00, 0xd8, 0x00]).expect("a file");
    let answer = folder.arl2rs(&["check", "a.arl", "nothing.arl"]);
    answer.is(1, "").says("a.arl").says("nothing.arl");
}

#[test]
fn emitted_rust_does_not_depend_on_the_working_directory() {
    let folder = Folder::new("emit").with("robot/a.arl", GOOD).with("robot/b.arl", BAD);
    let there = folder.arl2rs(&["emit", "robot/a.arl"]);
    assert_eq!(there.code, Some(0));
    assert!(there.out.contains("// 2: print \"hello\""), "{}", there.out);
    folder.arl2rs(&["emit", "robot/a.arl", "-o", "out"]).is(0, "");
    assert_eq!(folder.read("out/a.rs"), there.out);
    let inside = folder.command(&["emit", "a.arl"]).current_dir(folder.path.join("robot")).output();
    assert_eq!(String::from_utf8_lossy(&inside.expect("it starts").stdout), there.out);
    folder.arl2rs(&["emit", "robot/b.arl"]).is(1, "").says("ARL0301");
}

#[test]
fn targets_that_a_robot_cannot_reach_are_warned_of() {
    let program = "const joint FAR = {500,-90,90,0,45,0}\nfunc void main()\n    joint start = {0,-90,90,0,45,0}\n    \
        joint changed = {500,-90,90,0,45,0}\n    movej start\n    movej FAR\n    changed.j1 = 10\n    movej changed\n    \
        lin p:{1600,0,450,0,90,0}\n    lin p:{1400,0,450,0,90,0}\n    lin p:{x 1600}\n    \
        cir m:{3000,0,450,0,90,0},p:{1300,0,450,0,90,0}\nendfunc\n";
    let tool = program.replace("lin p:{1400", "lin t:{{0,0,-500,0,0,0}},p:{1400");
    let taught = program.replacen("const joint FAR = {500,-90,90,0,45,0}\n", "", 1);
    let folder = Folder::new("reach").with("far.arl", program).with("tool.arl", &tool).with("taught.arl", &taught);
    folder.write("taught_data.arl", "joint FAR = {500,-90,90,0,45,0}\n");
    let answer = folder.arl2rs(&["check", "far.arl", "--robot", "kr10-r1420"]);
    answer.is(0, "").says("far.arl:6:").says("ARL0907").says("j1 at 500 deg").says("-170 to 170 deg");
    answer.says("far.arl:9:").says("ARL0908").says("99.697 mm beyond the reach of kr10-r1420").says("2 warnings");
    // The tool holds from its line on. Points of data files count as they are now; without a robot nothing is sure.
    let answer = folder.arl2rs(&["check", "tool.arl", "--robot", "kr10-r1420"]);
    answer.is(0, "").says("tool.arl:9:").says("tool.arl:10:").says("tool.arl:12:").says("4 warnings");
    folder.arl2rs(&["check", "taught.arl", "--robot", "kr10-r1420"]).is(0, "").says("taught.arl:5:").says("2 warnings");
    assert_eq!(folder.arl2rs(&["check", "far.arl"]).err, "");
}

#[test]
fn channels_are_those_of_the_cell() {
    let folder = Folder::new("check_cell");
    folder.write(
        "a.arl",
        "func void main()\n  setdo(9,true)\n  int channel = 99\n  setao(1,5)\n  setdo(channel,true)\nendfunc\n",
    );
    folder.write("small.toml", "[io]\ndo = 8\nao = [\"mA\"]\n[home]\ntolerance = 1\n");
    folder.write("wrong.toml", "[io]\ndoo = 8\n");
    folder.arl2rs(&["check", "a.arl"]).is(0, "");
    folder.arl2rs(&["check", "--cell", "small.toml", "a.arl"]).is(1, "").says("DO 9 does not exist").says("a.arl:2:9");
    folder
        .arl2rs(&["check", "--cell", "wrong.toml", "a.arl"])
        .is(2, "")
        .says("wrong.toml:2:")
        .says("did you mean `do`?");
    folder.arl2rs(&["check", "--cell", "none.toml", "a.arl"]).is(2, "").says("none.toml").says("cannot read");
}

#[test]
fn foreground_channels_are_those_of_the_cell() {
    let folder = Folder::new("check_foreground");
    folder.write(
        "a.arl",
        "func void main()\n  print curppline(2)\n  print curppline(3)\n  print curppline(1)\nendfunc\n",
    );
    folder.write("b.arl", "func void main()\n  waittime 1\nendfunc\n");
    let behind = "[[channel]]\nprogram = \"b.arl\"\nbackground = true\n";
    folder.write("one.toml", behind);
    folder.write("two.toml", &format!("{behind}[[channel]]\nprogram = \"b.arl\"\n"));
    folder.arl2rs(&["check", "a.arl"]).is(0, "");
    let one = folder.arl2rs(&["check", "--cell", "one.toml", "a.arl"]);
    one.is(1, "").says("a.arl:2:19").says("foreground channel 2 does not exist: the cell has one").says("a.arl:3:19");
    let two = folder.arl2rs(&["check", "--cell", "two.toml", "a.arl"]);
    two.is(1, "").says("a.arl:3:19").says("foreground channel 3 does not exist: the cell has channels 1 to 2");
    assert!(!two.err.contains("a.arl:2:"), "{}", two.err);
}

#[test]
fn a_cell_that_a_run_refuses_is_refused_by_a_check_in_the_same_words() {
    let folder = Folder::new("same_cell").with("a.arl", "func void main()\n    print 1\nendfunc\n");
    let channel = "[[channel]]\nprogram = \"a.arl\"\nrobot = \"hsr065\"\n";
    for (cell, words) in [
        ("[controller]\ncycle = nan\n".to_owned(), ":2"),
        ("[modbus_tcp]\nport = 99999\n".into(), "a TCP port"),
        ("[[collision]]\ncid = 99\npercent = 10\n".into(), "the number of a condition from 0 to 16"),
        ("[home]\nhome2 = [0, 1, 2]\n".into(), "has 3 positions"),
        ("[[collision]]\ncid = 1\ntorque = [1, 2]\n".into(), "has 2 torques"),
        (format!("{channel}home3 = [1]\n"), "robot hsr065 has 4 axes"),
        ("[external]\nstart_prog_di = 65\n".into(), "the cell has DI 1 to 64"),
        ("[network]\nlisten = \"nowhere\"\n".into(), "\"loopback\""),
        ("[networks]\n".into(), "did you mean `network`?"),
    ] {
        folder.write("cell.toml", &cell);
        let checked = folder.arl2rs(&["check", "a.arl", "--cell", "cell.toml"]);
        checked.is(2, "").says(words);
        let ran = folder.arl2rs(&["run", "a.arl", "--cell", "cell.toml"]);
        ran.is(2, "").says(words);
    }
    folder.write("cell.toml", "[home]\nhome2 = [0, 1, 2, 3]\n");
    folder.arl2rs(&["check", "a.arl", "--cell", "cell.toml", "--robot", "hsr065"]).is(0, "");
    folder.arl2rs(&["check", "a.arl", "--cell", "cell.toml", "--background"]).is(0, "");
}

#[test]
fn a_folder_is_no_program() {
    let folder = Folder::new("folder").with("cell/lib.arl", "int n\n").with("cell/pick.arl", GOOD);
    for command in ["check", "run", "emit", "build"] {
        folder
            .arl2rs(&[command, "cell"])
            .is(2, "")
            .says("cell is a folder: name the file that has `main`, such as cell/pick.arl");
    }
}

#[test]
fn a_program_without_its_ending_is_meant() {
    let folder = Folder::new("ending").with("pick.arl", GOOD);
    folder.arl2rs(&["check", "pick"]).is(2, "").says("there is no file pick; did you mean pick.arl?");
    folder.arl2rs(&["check", "."]).is(2, "").says(". is a folder: name the file that has `main`, such as ./pick.arl");
}
