//! `run` and `build`. Programs share a cache, so that the runtime is compiled once for all tests.

use super::{Answer, Folder};
use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};

const HELLO: &str = "func void main()\n    int unused = 1\n    print \"hello \", count\nendfunc\n";

/// The command where cargo cannot be started: what works then needs no compilation.
fn without_cargo(folder: &Folder, arguments: &[&str]) -> Answer {
    let command = folder.command(arguments).env("CARGO", "/nowhere/cargo").output();
    Answer::of(command.expect("the command starts"))
}

#[test]
fn unchanged_programs_and_new_values_need_no_compilation() {
    let folder = Folder::new("run").with("a.arl", HELLO).with("a_data.arl", "int count = 3\nconst int LIMIT = 7\n");
    let run = ["run", "a.arl", "--engine", "native"];
    let first = folder.arl2rs(&run);
    first.is(0, "hello 3\n").says("ARL0902");
    let again = without_cargo(&folder, &run);
    again.is(0, "hello 3\n").says("ARL0902");

    // The runtime reads values again.
    folder.write("a_data.arl", "// taught\nint count = 40\nconst int LIMIT = 7\n");
    without_cargo(&folder, &run).says("cargo was not found");
    folder.write("a_data.arl", "int count = 40\nconst int LIMIT = 7\n");
    without_cargo(&folder, &run).is(0, "hello 40\n");
    without_cargo(&folder, &run).is(0, "hello 40\n");

    // Constants, types and names are compiled in.
    folder.write("a_data.arl", "int count = 40\nconst int LIMIT = 8\n");
    without_cargo(&folder, &run).is(1, "").says("cargo was not found");
    folder.write("a_data.arl", "double count = 40\nconst int LIMIT = 7\n");
    without_cargo(&folder, &run).is(1, "").says("cargo was not found");

    // A broken file is refused before anything runs.
    folder.write("a_data.arl", "int count = = 40\n");
    folder.arl2rs(&run).is(1, "").says("a_data.arl:1");

    // Text of the program is compiled.
    folder.write("a_data.arl", "double count = 1.5\n");
    folder.write("a.arl", &HELLO.replace("hello", "bye"));
    folder.arl2rs(&run).is(0, "bye 1.5\n");
}

#[test]
fn a_program_runs_at_once_unless_it_is_compiled_already() {
    // The end of the text is another one each time the test runs: an earlier run has compiled its program.
    let program = format!("{HELLO}// {:?}\n", std::time::SystemTime::now());
    let folder = Folder::new("at_once").with("a.arl", &program).with("a_data.arl", "int count = 3\n");
    without_cargo(&folder, &["run", "a.arl"]).is(0, "hello 3\n").says("ARL0902");
    folder.write("a_data.arl", "int count = 4\n");
    without_cargo(&folder, &["run", "a.arl"]).is(0, "hello 4\n").says("ARL0902");
    without_cargo(&folder, &["run", "a.arl", "--engine", "native"]).is(1, "").says("cargo was not found");
    without_cargo(&folder, &["run", "a.arl", "--set", "global.count=5"]).is(0, "hello 5\n");

    // What arl.toml says counts, and the command line before it.
    folder.write("arl.toml", "engine = \"native\"\n");
    without_cargo(&folder, &["run", "a.arl"]).is(1, "").says("cargo was not found");
    without_cargo(&folder, &["run", "a.arl", "--engine", "engine"]).is(0, "hello 4\n");
    let verbose = without_cargo(&folder, &["run", "a.arl", "--engine", "engine", "--verbose"]);
    verbose.is(0, "hello 4\n").says("engine: engine (the command line)");
    folder.write("arl.toml", "engine = \"fast\"\n");
    without_cargo(&folder, &["run", "a.arl"]).is(2, "").says("arl.toml:1: ").says("expected `engine` or `native`");
    folder.write("arl.toml", "");

    // The compiled program runs where it is up to date: it is there, and its process is another one.
    folder.arl2rs(&["run", "a.arl", "--engine", "native"]).is(0, "hello 4\n");
    let running = folder.arl2rs(&["run", "a.arl"]);
    running.is(0, "hello 4\n").says("ARL0902");
    folder.write("a.arl", &HELLO.replace("hello", "bye"));
    without_cargo(&folder, &["run", "a.arl"]).is(0, "bye 4\n");
    // What is compiled is no longer up to date, and stays.
    folder.write("a.arl", &program);
    without_cargo(&folder, &["run", "a.arl", "--engine", "native"]).is(0, "hello 4\n");
}

#[test]
fn exit_codes_tell_how_it_ended() {
    let folder = Folder::new("codes")
        .with("alarm.arl", "func void main()\n    int a = 0\n    print 1\n    print 2 / a\nendfunc\n")
        .with("endless.arl", "func void main()\n    print 1\n    loop\n        waittime 1\n    endloop\nendfunc\n")
        .with("wrong.arl", "func void main()\n    prnt 1\nendfunc\n");
    folder
        .arl2rs(&["run", "alarm.arl"])
        .is(3, "1\n")
        .says("alarm 20001: ")
        .says("(alarm.arl:4)")
        .says("  4 | print 2 / a\n");
    // The same text, written again, is what the program was compiled from.
    folder.write("alarm.arl", "func void main()\n    int a = 0\n    print 1\n    print 2 / a\nendfunc\n");
    folder.arl2rs(&["run", "alarm.arl"]).is(3, "1\n").says("  4 | print 2 / a\n");
    folder.arl2rs(&["run", "endless.arl", "--max-time", "2.5"]).is(4, "1\n").says("the program is at endless.arl:4");
    folder.write(
        "endless.arl",
        "func void main()\n    int k = 1\n    while(k > 0)\n        k = 1 + k % 9\n    endwhile\nendfunc\n",
    );
    folder
        .arl2rs(&["run", "endless.arl", "--max-time", "0.1"])
        .is(4, "")
        .says("the program is calculating in endless.arl");
    folder.arl2rs(&["run", "wrong.arl"]).is(1, "").says("ARL0211");
    folder.arl2rs(&["run", "endless.arl", "--robot", "none"]).is(2, "").says("none: no robot of this name is built in");
    folder.arl2rs(&["run", "endless.arl", "--io", "none.toml"]).is(2, "").says("none.toml");
}

#[cfg(unix)]
#[test]
fn an_interrupt_ends_with_130() {
    let folder = Folder::new("interrupt")
        .with("a.arl", "func void main()\n    print 1\n    loop\n        waittime 0.1\n    endloop\nendfunc\n");
    let mut command = folder.command(&["run", "a.arl", "--clock", "real"]);
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().expect("it starts");
    let mut line = String::new();
    BufReader::new(child.stdout.take().expect("its output")).read_line(&mut line).expect("a line");
    assert_eq!(line, "1\n");
    let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill");
    assert!(sent.success());
    assert_eq!(child.wait().expect("it ends").code(), Some(130));
}

/// The command listens to its program: what reaches the command alone reaches the program.
#[cfg(unix)]
#[test]
fn an_interrupt_of_the_command_alone_stops_the_robot() {
    let folder = Folder::new("interrupt_alone")
        .with("a.arl", "func void main()\n    print 1\n    loop\n        waittime 0.1\n    endloop\nendfunc\n");
    let options = ["run", "a.arl", "--clock", "real", "--record", "a.mcap", "--max-time", "60"];
    let mut child = folder.command(&options).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("it starts");
    let mut line = String::new();
    BufReader::new(child.stdout.as_mut().expect("its output")).read_line(&mut line).expect("a line");
    assert_eq!(line, "1\n");
    let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill");
    assert!(sent.success());
    Answer::of(child.wait_with_output().expect("it ends")).is(130, "").says("interrupted: the robot stops on its path");
}

#[cfg(target_os = "linux")]
#[test]
fn real_time_is_asked_for_and_the_report_says_how_late_cycles_began() {
    let folder = Folder::new("realtime").with("a.arl", "func void main()\n    waittime 0.05\n    print 7\nendfunc\n");
    let answer = folder.arl2rs(&["run", "a.arl", "--realtime=1023", "--report=r.jsonl"]);
    answer.is(0, "7\n").says("--realtime has no full effect: no core of its own: core 1023: ");
    let report = std::fs::read_to_string(folder.path.join("r.jsonl")).expect("a report");
    let objects = report.lines().filter_map(|line| serde_json::from_str::<serde_json::Value>(line).ok());
    let clock = objects.map(|object| object["clock"].clone()).find(|clock| !clock.is_null()).expect("the clock");
    let cycles = clock["cycles"].as_u64().expect("a number");
    let steps = clock["histogram"].as_array().expect("steps").iter().filter_map(|step| step[1].as_u64());
    assert!(cycles >= 50 && steps.sum::<u64>() == cycles, "{clock}");
    assert!(clock["longest"].as_f64().is_some_and(|longest| longest > 0.0) && clock["lost"].is_u64(), "{clock}");
    folder
        .arl2rs(&["run", "a.arl", "--realtime", "--clock", "virtual"])
        .is(2, "")
        .says("--realtime is for --clock real");
}

#[test]
fn two_at_once_do_not_disturb_each_other() {
    let folder = Folder::new("both").with("a.arl", "func void main()\n    print 7\nendfunc\n");
    let start = || folder.command(&["run", "a.arl"]).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn();
    let (one, other) = (start().expect("it starts"), start().expect("it starts"));
    for child in [one, other] {
        Answer::of(child.wait_with_output().expect("it ends")).is(0, "7\n");
    }
}

#[test]
fn built_programs_stand_alone() {
    let folder = Folder::new("build")
        .with("robot/a.arl", "func void main()\n    waittime 0.01\n    print getdi(1)\nendfunc\n")
        .with("on.toml", "[[event]]\nat = 0.0\ndi.1 = true\n");
    folder.arl2rs(&["build", "robot/a.arl"]).is(0, "");
    folder.arl2rs(&["build", "robot/a.arl", "-o", "out/mine"]).is(0, "");
    for program in [format!("a{}", std::env::consts::EXE_SUFFIX), "out/mine".to_string()] {
        let output =
            Command::new(folder.path.join(program)).args(["--io", "on.toml"]).current_dir(&folder.path).output();
        Answer::of(output.expect("it starts")).is(0, "true\n");
    }
}

#[test]
fn a_plot_shows_the_path_the_speeds_and_the_lines() {
    let program = "func void main()\n    joint a = {30,40,50,30}\n    movej a,vp:50%\n    waittime 0\n    \
                   pose p = cpose($FLANGE,$WORLD)\n    p.x = p.x - 100\n    lin p,vl:200\nendfunc\n";
    let folder =
        Folder::new("plot").with("way.arl", program).with("still.arl", "func void main()\n    print 1\nendfunc\n");
    folder.arl2rs(&["run", "way.arl", "--robot", "hsr065", "--plot", "way.svg", "--trace", "way.csv"]).is(0, "");
    let picture = folder.read("way.svg");
    for text in
        ["way.arl", "hsr065", "Top", "Front", "Side", "Speed of the TCP in mm/s", "j4  up to", "   7  lin p,vl:200"]
    {
        assert!(picture.contains(text), "{text}");
    }
    // Two motions, a thousand cycles: what nobody would see is left out.
    assert!(folder.read("way.csv").lines().count() > 1000 && picture.len() < 50_000, "{}", picture.len());
    // The same from the trace, which knows neither the program's name nor its text.
    folder.arl2rs(&["plot", "way.csv", "again.svg", "--robot", "hsr065"]).is(0, "");
    let again = folder.read("again.svg");
    assert!(again.contains("way.csv") && !again.contains("lin p"));

    // A robot that does not move gives no picture; the program's exit code stays.
    folder.arl2rs(&["run", "still.arl", "--plot", "still.svg"]).is(0, "1\n").says("no motion was executed");
    assert!(!folder.has("still.svg"));
    folder.arl2rs(&["run", "way.arl", "--max-time", "0.1", "--robot", "hsr065", "--plot", "part.svg"]).is(4, "");
    assert!(folder.read("part.svg").contains("1 motion"));
    folder
        .arl2rs(&["run", "way.arl", "--robot", "hsr065", "--plot", "none/way.svg"])
        .is(2, "")
        .says("cannot write none/way.svg");
    folder.arl2rs(&["plot", "way.arl", "x.svg"]).is(2, "").says("is not a trace of a run");
}

/// A program of two files, each with a motion in its line 3.
fn two_files(name: &str) -> Folder {
    Folder::new(name)
        .with("way.arl", "import \"parts.arl\"\nfunc void main()\n    movej j:{10,-90,90,0,0.5,0}\n    parts::aside()\nendfunc\n")
        .with("parts.arl", "func void aside()\n    pose p = getpose({10,-90,90,0,0.5,0},$FLANGE,$WORLD)\n    lin p:offset(p,0,40,0,0,0,0),vl:200\nendfunc\n")
}

#[test]
fn motions_stand_under_the_files_of_their_lines() {
    let folder = two_files("files");
    let run = |more: &[&str]| folder.arl2rs(&[&["run", "way.arl"], more].concat());
    run(&["--trace", "way.csv", "--trace-columns", "file", "--report=way.jsonl", "--record", "way.mcap"]).is(0, "");
    let trace = folder.read("way.csv");
    assert!(trace.starts_with("t,line,motion,j1,j2,j3,j4,j5,j6,ej1,ej2,ej3,ej4,ej5,ej6,x,y,z,a,b,c,file\n"), "{trace}");
    let mut places: Vec<String> = Vec::new();
    for row in trace.lines().skip(1) {
        let cells: Vec<&str> = row.split(',').collect();
        places.push([cells[1], cells[21]].join(" "));
    }
    places.retain(|place| place != "0 ");
    places.dedup();
    assert_eq!(places, ["3 way.arl", "3 parts.arl"]);
    let report = folder.read("way.jsonl");
    for part in ["\"motion\":1,\"file\":\"way.arl\",\"line\":3,", "\"motion\":2,\"file\":\"parts.arl\",\"line\":3,"] {
        assert!(report.contains(part), "{part} in {report}");
    }
    run(&["--report"])
        .is(0, "")
        .says("\n          3  movej  ")
        .says("\nparts.arl:3  lin  ")
        .says("close to a singularity: j4");
    run(&["--report=way.json", "--format", "json"]).is(0, "");
    let same = folder.arl2rs(&["compare", "way.json", "way.mcap"]);
    assert!(same.code == Some(0) && same.out.starts_with("nothing differs: "), "{}", same.out);
    let whole: serde_json::Value = serde_json::from_str(&folder.read("way.json")).unwrap();
    let lines = whole["channels"][0]["lines"].as_array().unwrap().iter();
    let lines: Vec<_> = lines.filter(|line| line["motions"] == 1).map(|line| (&line["file"], &line["line"])).collect();
    assert_eq!(lines, [(&"parts.arl".into(), &3.into()), (&"way.arl".into(), &3.into())]);
    // The same line of another file is another line, with its own text.
    run(&["--plot", "way.svg"]).is(0, "");
    let picture = folder.read("way.svg");
    for text in ["   3  movej j:", "parts.arl:3  lin p:offset", ">parts.arl:3</text>"] {
        assert!(picture.contains(text), "{text}");
    }
    folder.arl2rs(&["plot", "way.csv", "again.svg"]).is(0, "");
    assert!(folder.read("again.svg").contains(">parts.arl:3</text>"));
    run(&["--trace", "way.csv", "--trace-columns", "line"]).is(2, "").says("`line` is not a column: expected file");
}

#[test]
fn a_plot_shows_external_axes() {
    let robot = crate_robot("kr10-r1420").replacen(
        "\n[[link]]",
        "\n[[axis]]\nname = \"ej1\"\nlinear = true\nmin = 0.0\n\
        max = 900.0\nvel = 500.0\nacc = 2000.0\njerk = 9000.0\n\n[[link]]",
        1,
    );
    let program = "func void main()\n    joint a = {0,-90,90,0,45,0,400}\n    movej a,vp:50%\nendfunc\n";
    let folder = Folder::new("rail").with("rail.arl", program).with("rail.toml", &robot);
    folder.arl2rs(&["run", "rail.arl", "--robot", "rail.toml", "--plot", "rail.svg"]).is(0, "");
    let picture = folder.read("rail.svg");
    assert!(picture.contains("ej1  up to") && picture.contains("of 500 mm/s"));
}

fn crate_robot(name: &str) -> String {
    arl_robot::Robot::text(name).expect("the robot is built in").to_owned()
}

#[test]
fn a_report_says_what_each_line_did() {
    let program = "func void main()\n    joint a = {0,-90,90,0,45,0}\n    movej a,vp:50%\n    waittime 0\n    \
                   pose p = cpose($FLANGE,$WORLD)\n    for(int i = 0; i < 3; i++)\n        p.z = p.z - 50\n        \
                   lin p,vl:100,sl:10\n    endfor\n    waittime 1\nendfunc\n";
    let folder =
        Folder::new("report").with("way.arl", program).with("still.arl", "func void main()\n    print 1\nendfunc\n");
    let answer = folder.arl2rs(&["run", "way.arl", "--report"]);
    answer.is(0, "").says("line  motion  runs  programmed").says("s at rest; 4 motions");
    let row = answer.err.lines().find(|line| line.contains("lin ")).expect("a row of lin").to_owned();
    let words: Vec<&str> = row.split_whitespace().collect();
    // The last one is not blended.
    assert_eq!(words[..7], ["8", "lin", "3", "100", "mm/s", "100", "mm/s"], "{row}");
    assert!(row.contains("0 of 10 mm") && row.contains("tcp 5 %"), "{row}");
    answer.says("line 8: its target is reached with a stop: no motion followed in time");

    folder.arl2rs(&["run", "way.arl", "--report=way.jsonl"]).is(0, "");
    let text = folder.read("way.jsonl");
    let lines: Vec<serde_json::Value> = text.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    assert_eq!(lines.len(), 5);
    assert_eq!((&lines[1]["line"], &lines[1]["kind"], &lines[1]["unit"]), (&8.into(), &"lin".into(), &"mm/s".into()));
    assert_eq!((&lines[1]["blend"]["asked"], &lines[1]["blend"]["used"]), (&10.0.into(), &10.0.into()));
    assert_eq!(lines[4]["motions"], 4);
    assert!(lines[4]["standing"].as_f64().expect("a number") > 0.99);

    // The report of the whole run has the same seconds for each line.
    folder.arl2rs(&["run", "way.arl", "--report=way.json", "--format", "json"]).is(0, "");
    let whole: serde_json::Value = serde_json::from_str(&folder.read("way.json")).expect("JSON");
    for line in whole["channels"][0]["lines"].as_array().expect("lines") {
        let of_line = lines.iter().filter(|motion| motion["line"] == line["line"]);
        let seconds: f64 = of_line.filter_map(|motion| motion["duration"].as_f64()).sum();
        assert!((line["moving"].as_f64().expect("a number") - seconds).abs() < 1e-5, "{line} {seconds}");
    }

    folder
        .arl2rs(&["run", "still.arl", "--report"])
        .is(0, "1\n")
        .says(": 0.000 s moving (0 %)")
        .says("0 motions, 0.000 m");
    folder.arl2rs(&["run", "still.arl", "--report=none/a"]).is(2, "").says("none/a");
}

#[test]
fn a_report_is_in_the_order_of_execution_and_counts_no_zone_that_was_not_reached() {
    // What is planned ahead has the lower number, and comes behind what an interrupt does in between.
    let program = "func void aside()\n    stopmove\n    lin reltool(cpose(),0,0,-30,0,0,0),vl:100mm/s\n    startmove\n\
                   endfunc\nfunc void away()\n    stopmove\n    startmove 1\nendfunc\nfunc void main()\n    \
                   movej j:{10,-90,90,0,90,0}\n    waittime 0\n    pose p = cpose($FLANGE,$WORLD)\n    \
                   interrupt 1,when:getdi(1),do:aside()\n    interrupt 2,when:getdi(2),do:away()\n    setdo(1,true)\n    \
                   lin offset(p,0,200,0,0,0,0),vl:200mm/s,sl:20mm\n    lin offset(p,0,200,-100,0,0,0),vl:200mm/s\n    \
                   setdo(2,true)\n    lin offset(p,0,0,-100,0,0,0),vl:100mm/s,sl:20mm\n    lin p,vl:100mm/s\nendfunc\n";
    let scenario = "[[event]]\nwhen = \"do.1\"\nafter = 0.2\ndi.1 = true\n\
                    [[event]]\nwhen = \"do.2\"\nafter = 0.5\ndi.2 = true\n";
    let folder = Folder::new("report_order").with("way.arl", program).with("io.toml", scenario);
    folder.arl2rs(&["run", "way.arl", "--io", "io.toml", "--report=way.jsonl"]).is(0, "");
    let text = folder.read("way.jsonl");
    let motions: Vec<serde_json::Value> = text.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    let starts: Vec<f64> = motions.iter().filter_map(|motion| motion["start"].as_f64()).collect();
    assert!(starts.len() > 5 && starts.is_sorted(), "{text}");
    let numbers: Vec<i64> = motions.iter().filter_map(|motion| motion["motion"].as_i64()).collect();
    assert!(!numbers.is_sorted(), "the interrupt's motion was planned later: {text}");
    let exited = motions.iter().find(|motion| motion["line"] == 20).expect("the line that was left");
    assert_eq!((&exited["blend"]["asked"], &exited["blend"]["used"]), (&20.0.into(), &0.0.into()), "{text}");
}

#[test]
fn an_alarm_tells_its_line_and_the_calls_that_led_there() {
    let program = "int sizes[3]\nfunc int deep(int n)\n  return sizes[n]\nendfunc\nfunc int down(int n)\n  \
                   if(n > 40) return deep(n)\n  return down(n + 1)\nendfunc\nfunc void main()\n  print down(3)\nendfunc\n";
    let folder = Folder::new("calls").with("a.arl", program);
    let ran = folder.arl2rs(&["run", "a.arl"]);
    ran.is(3, "").says("(a.arl:3)\n  3 | return sizes[n]\ncalled in a.arl:6\n  6 | if(n > 40) return deep(n)\n");
    ran.says("called in a.arl:7\n").says("and 20 more calls\n");
}
