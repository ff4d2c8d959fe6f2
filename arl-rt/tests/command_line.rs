//! The command line of a compiled program. This test is its own program: it starts itself again with `ARL_RT_PROGRAM`
//! set, and is then what `arl2rs build` makes.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test without the harness by which clippy knows tests")]

use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Output, Stdio};
use std::time::SystemTime;

use arl_rt::emit::*;

#[expect(unreachable_pub, reason = "emitted modules are public, wherever they are included")]
#[path = "programs/pick.rs"]
mod pick_program;

const PROGRAM: &str = "ARL_RT_PROGRAM";
const FILE: File = File::new("t.arl");

/// Programs by name.
struct Small(String);

impl Program for Small {
    fn file(&self) -> File {
        FILE
    }

    fn family(&self) -> Family {
        Family::SixAxis
    }

    #[expect(clippy::too_many_lines, reason = "a program")]
    fn main<'a>(&'a self, cx: &'a Cx) -> BoxFuture<'a> {
        Box::pin(async move {
            match self.0.as_str() {
                "hello" => text::print().argtoprint(&"hello").run(cx).at(FILE, 1),
                "count" => {
                    let count = cx.system().i.update(|i| {
                        i[0] += 1;
                        i[0]
                    });
                    cx.system().i_name.update(|names| names[0] = "runs".into());
                    system::savesv(cx, &"I".into()).await.at(FILE, 2)?;
                    text::print().argtoprint(&count).run(cx).at(FILE, 3)
                }
                "save" => loop {
                    let count = cx.system().i.update(|i| {
                        i[0] += 1;
                        i[99] = i[0];
                        i[0]
                    });
                    system::savesv(cx, &"I".into()).await.at(FILE, 2)?;
                    text::print().argtoprint(&count).run(cx).at(FILE, 3)?;
                    cx.next_cycle().await;
                },
                "first" => {
                    let (first, last) = cx.system().i.with(|i| (i[0], i[99]));
                    text::print().argtoprint(&first).argtoprint(&" ").argtoprint(&last).run(cx).at(FILE, 4)
                }
                "forever" => {
                    let there = Joint::of_axes([40.0, -90.0, 90.0, 0.0, 45.0, 0.0]);
                    let back = Joint::of_axes([-40.0, -90.0, 90.0, 0.0, 45.0, 0.0]);
                    loop {
                        cx.line(FILE, 5);
                        motion::movej(there).vp(50.0).run(cx).await.at(FILE, 5)?;
                        motion::movej(back).vp(50.0).run(cx).await.at(FILE, 6)?;
                        text::print().argtoprint(&"round").run(cx).at(FILE, 7)?;
                    }
                }
                "watched" => {
                    let frame = cx.frame("main", FILE, 3);
                    let (round, table) = (Rc::new(Cell::new(0)), Rc::new(Shared::new(Array::<i32, 65>::start())));
                    let watch = Rc::new(Clock::new());
                    frame.variable(0, "round", &[], &round);
                    frame.variable(1, "table", &[], &table);
                    frame.handle(2, "watch", &[], &watch);
                    loop {
                        frame.runs(4).await;
                        round.set(round.get() + 1);
                        cx.next_cycle().await;
                    }
                }
                "swing" => loop {
                    for (line, j1) in [(5, 40.0), (6, -40.0)] {
                        cx.line(FILE, line);
                        let there = Joint::of_axes([j1, -90.0, 90.0, 0.0, 45.0, 0.0]);
                        motion::movej(there).vp(50.0).run(cx).await.at(FILE, line)?;
                    }
                },
                "where" => {
                    let file = channel::curmpfile(cx, 1).at(FILE, 10)?;
                    let line = channel::curmpline(cx, 1).at(FILE, 10)?;
                    text::print().argtoprint(&file).argtoprint(&" ").argtoprint(&line).run(cx).at(FILE, 10)
                }
                "when" => text::print()
                    .argtoprint(&time::cdate(cx))
                    .argtoprint(&" ")
                    .argtoprint(&time::ctime(cx))
                    .argtoprint(&" ")
                    .argtoprint(&math::rand(cx))
                    .argtoprint(&" ")
                    .argtoprint(&cx.system().ctl_mode.get())
                    .run(cx)
                    .at(FILE, 8),
                "deep" => deeper(cx, 0).map(|_| ()),
                "log" => {
                    text::print().to(Printto::File).filepath(&"log.txt".into()).argtoprint(&"line").run(cx).at(FILE, 9)
                }
                other => panic!("no program {other}"),
            }
        })
    }
}

fn deeper(cx: &Cx, level: i32) -> Done<i32> {
    let _entered = cx.enter(1, 0).at(FILE, 12)?;
    let fill = std::hint::black_box([level; 64]);
    Ok(deeper(cx, level.wrapping_add(1))?.wrapping_add(fill[3]))
}

fn main() -> ExitCode {
    match std::env::var(PROGRAM) {
        Ok(name) if name == "pick" => arl_rt::emit::program_main::main(pick_program::Globals::new, "."),
        Ok(name) if name == "watched" => {
            let (words, make) = (std::env::args_os().skip(1).collect(), move || Small(name.clone()));
            ExitCode::from(arl_rt::emit::program_main::main_within(words, make, &[], ".", SystemTime::now(), || false))
        }
        Ok(name) => arl_rt::emit::program_main::main(move || Small(name), "."),
        Err(_) => {
            for (name, test) in TESTS {
                test();
                println!("test {name} ... ok");
            }
            let _ = std::fs::remove_dir_all(place());
            ExitCode::SUCCESS
        }
    }
}

const TESTS: &[(&str, fn())] = &[
    ("help_and_usage", help_and_usage),
    ("alarms", alarms),
    ("state_is_kept", state_is_kept),
    ("damaged_state_is_refused", damaged_state_is_refused),
    ("state_survives_a_kill", state_survives_a_kill),
    ("pointers_survive_a_kill", pointers_survive_a_kill),
    ("a_process_that_was_stopped_stops_its_robot", a_process_that_was_stopped_stops_its_robot),
    ("pointers_that_cannot_be_kept_are_a_warning", pointers_that_cannot_be_kept_are_a_warning),
    ("the_time_is_over", the_time_is_over),
    ("virtual_time_is_the_same_every_time", virtual_time_is_the_same_every_time),
    ("recursion_without_end_is_an_alarm", recursion_without_end_is_an_alarm),
    ("files_are_below_the_script_directory", files_are_below_the_script_directory),
    ("ctrl_c_stops_on_the_path", ctrl_c_stops_on_the_path),
    ("traces_are_written", traces_are_written),
    ("wrong_files_name_their_line", wrong_files_name_their_line),
    ("orders_drive_a_run", orders_drive_a_run),
    ("after_its_end_a_live_run_waits", after_its_end_a_live_run_waits),
    ("a_live_run_shows_what_is_inside", a_live_run_shows_what_is_inside),
];

fn run(program: &str, arguments: &[&str]) -> Output {
    command(program, arguments).output().unwrap()
}

fn command(program: &str, arguments: &[&str]) -> Command {
    let mut command = Command::new(std::env::current_exe().unwrap());
    command.env(PROGRAM, program).args(arguments).stdin(Stdio::null());
    let place = place();
    std::fs::create_dir_all(&place).unwrap();
    command.current_dir(place);
    command
}

/// Where the programs run; what they keep without being told where lies below.
fn place() -> PathBuf {
    std::env::temp_dir().join(format!("arl-rt-command-line-{}", std::process::id()))
}

fn check(output: &Output, code: i32, stdout: &str, stderr: &str) {
    let (out, err) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert_eq!(output.status.code(), Some(code), "{out}{err}");
    assert_eq!(out, stdout, "{err}");
    assert!(err.contains(stderr), "{err}");
    assert!(!stderr.is_empty() || err.is_empty(), "{err}");
}

/// A directory that is removed at the end.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("arl-rt-{name}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn file(&self, name: &str, text: &str) -> String {
        let path = self.0.join(name);
        std::fs::write(&path, text).unwrap();
        path.display().to_string()
    }

    fn path(&self) -> &Path {
        &self.0
    }

    fn text(&self) -> &str {
        self.0.to_str().unwrap()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn help_and_usage() {
    check(&run("hello", &[]), 0, "hello\n", "");
    let help = run("hello", &["--help"]);
    assert_eq!(help.status.code(), Some(0));
    assert!(String::from_utf8_lossy(&help.stdout).contains("--max-time"));
    check(&run("hello", &["--nonsense"]), 2, "", "--nonsense");
    check(&run("hello", &["--robot", "kr99"]), 2, "", "kr99");
    check(&run("hello", &["--robot", "hsr065"]), 2, "", "the program was checked for a six-axis robot");
}

fn alarms() {
    let folder = Folder::new("alarms");
    let scenario = folder.file("s.toml", "[[event]]\nat = 0\ndi.3 = true\n");
    let output = run("pick", &["--io", &scenario, "--state-dir", folder.text()]);
    assert_eq!(output.status.code(), Some(3));
    assert!(String::from_utf8_lossy(&output.stdout).starts_with("pick and place\npart 1 in time: true\n"));
    assert_eq!(
        String::from_utf8_lossy(&output.stderr),
        "alarm 20003: index 6 is outside the array: its size is 6, so 0 to 5 are valid (pick.arl:35)\n"
    );
}

fn state_is_kept() {
    let folder = Folder::new("state");
    for count in ["1\n", "2\n", "3\n"] {
        check(&run("count", &["--state-dir", folder.text()]), 0, count, "");
    }
    let names = std::fs::read_to_string(folder.path().join("I_NAME.state")).unwrap();
    assert!(names.starts_with("\"runs\"\n"), "names are kept by themselves: {names}");
    let scripts = Folder::new("state-default");
    check(&run("count", &["--script-dir", scripts.text()]), 0, "1\n", "");
    assert!(scripts.path().join(".arl-state/I.state").is_file());
}

/// Whoever damages a state file by hand, and in whatever way: the run does not begin, says which file it is and leaves
/// it as it is, so that the last good value is still there once it is put right.
fn damaged_state_is_refused() {
    let folder = Folder::new("damaged");
    let run = || run("count", &["--state-dir", folder.text()]);
    check(&run(), 0, "1\n", "");
    let file = folder.path().join("I.state");
    let good = std::fs::read(&file).unwrap();
    let text = String::from_utf8(good.clone()).unwrap();
    let first_line_gone = text.split_once('\n').unwrap().1.to_owned();
    let damages: [(&str, Vec<u8>); 11] = [
        ("cut in half", good[..good.len() / 2].to_vec()),
        ("without its last line", text.rsplit_once("check").unwrap().0.into()),
        ("empty", Vec::new()),
        ("a digit changed", text.replacen('1', "7", 1).into()),
        ("a word for a number", text.replacen('1', "one", 1).into()),
        ("a line gone", first_line_gone.into()),
        ("a line too many", format!("5\n{text}").into()),
        ("something behind it", format!("{text}5\n").into()),
        ("other line ends", text.replace('\n', "\r\n").into()),
        ("no text", [&[0xff, 0xfe, 0], &good[..]].concat()),
        ("zeros, as after a power failure", vec![0; good.len()]),
    ];
    for (what, content) in damages {
        assert_ne!(content, good, "{what}");
        std::fs::write(&file, &content).unwrap();
        let output = run();
        println!("{what}");
        check(&output, 3, "", "I.state: the file is damaged; remove it to start with the default");
        assert_eq!(std::fs::read(&file).unwrap(), content, "{what}: it is left as it is");
    }
    std::fs::remove_file(&file).unwrap();
    std::fs::create_dir(&file).unwrap();
    check(&run(), 3, "", "I.state: cannot be read");
    std::fs::remove_dir(&file).unwrap();
    std::fs::write(&file, &good).unwrap();
    check(&run(), 0, "2\n", "");
    // So it is with where the programs stood.
    let file = folder.path().join("POINTERS.state");
    let good = std::fs::read_to_string(&file).unwrap();
    for content in [good.replace("t.arl", "u.arl"), good.replace("program", "motion"), String::new()] {
        assert_ne!(content, good);
        std::fs::write(&file, &content).unwrap();
        check(&run(), 3, "", "POINTERS.state: the file is damaged; remove it to start with the default");
        assert_eq!(std::fs::read_to_string(&file).unwrap(), content, "it is left as it is");
    }
    std::fs::remove_file(&file).unwrap();
    check(&run(), 0, "3\n", "");
}

/// Whenever a program is killed that moves the robot to and fro: afterwards one of its two motions was the last one.
fn pointers_survive_a_kill() {
    let folder = Folder::new("kill-pointers");
    let file = folder.path().join("POINTERS.state");
    let (mut lines, mut last) = ([0, 0], String::new());
    for _ in 0..6 {
        let _ = std::fs::remove_file(&file);
        let mut child = command("swing", &["--state-dir", folder.text()]).stdout(Stdio::null()).spawn().unwrap();
        while !file.exists() {
            assert_eq!(child.try_wait().unwrap(), None, "it runs until it is killed");
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
        child.kill().unwrap();
        child.wait().unwrap();
        let after = run("where", &["--state-dir", folder.text()]);
        assert_eq!(after.status.code(), Some(0), "{}", String::from_utf8_lossy(&after.stderr));
        last = String::from_utf8_lossy(&after.stdout).into_owned();
        match last.as_str() {
            "t.arl 5\n" => lines[0] += 1,
            "t.arl 6\n" => lines[1] += 1,
            other => panic!("{other}"),
        }
    }
    println!("the last motion was that of line 5, of line 6: {lines:?}");
    // It stays so until another motion is executed.
    check(&run("where", &["--state-dir", folder.text()]), 0, &last, "");
    assert_eq!(std::fs::read_to_string(&file).unwrap().lines().next(), Some("program 1 \"t.arl\" 0"));
}

/// Between two set-points of a process that was stopped its robot had to do without.
#[cfg(target_os = "linux")]
fn a_process_that_was_stopped_stops_its_robot() {
    let folder = Folder::new("stopped");
    let cell = folder.path().join("cell.toml");
    std::fs::write(&cell, "[controller]\nlate_limit = 50\n").unwrap();
    let words = ["--state-dir", folder.text(), "--clock", "real", "--cell", cell.to_str().unwrap(), "--report"];
    let mut child = command("swing", &words).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    let id = child.id().to_string();
    let signal = |name: &str| {
        let sent = Command::new("kill").args([name, &id]).status().unwrap();
        assert!(sent.success(), "{name}");
    };
    while !folder.path().join("POINTERS.state").exists() {
        assert_eq!(child.try_wait().unwrap(), None, "it runs until it is stopped");
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    signal("-STOP");
    std::thread::sleep(std::time::Duration::from_millis(300));
    signal("-CONT");
    let output = child.wait_with_output().unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(3), "{errors}");
    assert!(errors.contains("alarm 20074: the computer was too busy: "), "{errors}");
    assert!(errors.contains("cycles: ") && errors.contains(" us late at most: "), "{errors}");
}

#[cfg(not(target_os = "linux"))]
fn a_process_that_was_stopped_stops_its_robot() {}

#[cfg(unix)]
fn pointers_that_cannot_be_kept_are_a_warning() {
    let folder = Folder::new("no-pointers");
    let nowhere = folder.path().join("nowhere");
    std::os::unix::fs::symlink(folder.path().join("missing"), &nowhere).unwrap();
    let output = run("hello", &["--state-dir", nowhere.to_str().unwrap()]);
    check(&output, 0, "hello\n", "warning: the program pointers cannot be saved: ");
    assert_eq!(String::from_utf8_lossy(&output.stderr).lines().count(), 1, "it is said once");
}

#[cfg(not(unix))]
fn pointers_that_cannot_be_kept_are_a_warning() {}

fn state_survives_a_kill() {
    use std::io::{BufRead, BufReader};
    let folder = Folder::new("kill");
    for round in 0..10 {
        let mut child = command("save", &["--state-dir", folder.text()]).stdout(Stdio::piped()).spawn().unwrap();
        let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
        for _ in 0..=round {
            lines.next().unwrap().unwrap();
        }
        child.kill().unwrap();
        child.wait().unwrap();
        let after = run("first", &["--state-dir", folder.text()]);
        assert_eq!(after.status.code(), Some(0), "{}", String::from_utf8_lossy(&after.stderr));
        let values = String::from_utf8_lossy(&after.stdout).into_owned();
        let (first, last) = values.trim_end().split_once(' ').unwrap();
        assert_eq!(first, last, "the old or the new content, whole");
        assert_ne!(first, "0");
    }
}

fn the_time_is_over() {
    let output = run("forever", &["--max-time", "0.5"]);
    assert_eq!(output.status.code(), Some(4));
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(error.contains("the time limit of 0.5 s has passed; the program is at t.arl:5"), "{error}");
}

fn virtual_time_is_the_same_every_time() {
    let first = run("when", &[]);
    check(&first, 0, &String::from_utf8_lossy(&run("when", &[]).stdout), "");
    assert!(first.stdout.starts_with(b"2000-01-01 00:00:00 "));
    let other = run("when", &["--seed", "2", "--start-time", "2026-11-21 10:11:12", "--mode", "manual"]);
    let other = String::from_utf8_lossy(&other.stdout).into_owned();
    assert!(other.starts_with("2026-11-21 10:11:12 ") && other.ends_with(" MANUAL\n"), "{other}");
    assert_ne!(other.split(' ').nth(2), String::from_utf8_lossy(&first.stdout).split(' ').nth(2));
}

fn recursion_without_end_is_an_alarm() {
    check(&run("deep", &[]), 3, "", "alarm 20007: function calls are nested too deep (t.arl:12)");
}

fn files_are_below_the_script_directory() {
    let folder = Folder::new("scripts");
    check(&run("log", &["--script-dir", folder.text()]), 0, "", "");
    check(&run("log", &["--script-dir", folder.text()]), 0, "", "");
    assert_eq!(std::fs::read_to_string(folder.path().join("log.txt")).unwrap(), "line\nline\n");
    let missing = folder.path().join("missing");
    check(&run("log", &["--script-dir", missing.to_str().unwrap()]), 3, "", "alarm 20009: file \"log.txt\"");
}

#[cfg(unix)]
fn ctrl_c_stops_on_the_path() {
    use std::io::Read;
    let folder = Folder::new("ctrl-c");
    let trace = folder.path().join("t.csv");
    let arguments = ["--clock", "real", "--trace", trace.to_str().unwrap()];
    let mut child = command("forever", &arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    // The robot is on its way when the program has planned its first round.
    let mut first = [0; 6];
    child.stdout.as_mut().unwrap().read_exact(&mut first).unwrap();
    let interrupt = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(interrupt.success());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130));
    assert!(String::from_utf8_lossy(&output.stderr).contains("the robot stops on its path"));
    let rows = std::fs::read_to_string(&trace).unwrap();
    let axis = |row: &str| row.split(',').nth(3).unwrap().parse::<f64>().unwrap();
    let positions: Vec<f64> = rows.lines().skip(1).map(axis).collect();
    let last = positions.windows(2).last().unwrap();
    assert!((last[1] - last[0]).abs() < 1e-3, "it stands at the end: {last:?}");
    let fastest = positions.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
    assert!(fastest < 0.12, "no jump at the stop: {fastest} deg in a cycle");
}

#[cfg(not(unix))]
fn ctrl_c_stops_on_the_path() {}

fn traces_are_written() {
    let folder = Folder::new("trace");
    let trace = folder.path().join("t.csv");
    let output = run("forever", &["--max-time", "0.1", "--trace", trace.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(4));
    let text = std::fs::read_to_string(&trace).unwrap();
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("t,line,motion,j1,j2,j3,j4,j5,j6,ej1,ej2,ej3,ej4,ej5,ej6,x,y,z,a,b,c"));
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    assert!(rows.len() >= 100);
    assert!(rows.iter().all(|row| row.len() == 21));
    assert_eq!(rows[1][..3], ["0.001000", "5", "1"]);
    assert_eq!(rows[1][9], "", "there are no external axes");
    assert!(rows[50][3].split('.').nth(1).unwrap().len() >= 6);
}

fn wrong_files_name_their_line() {
    let folder = Folder::new("wrong");
    let scenario = folder.file("s.toml", "[[event]]\nat = 0\ndi.3 = 1\n");
    check(&run("hello", &["--io", &scenario]), 2, "", "s.toml:3:8: `di.3`: expected true or false, found the number 1");
    let cell = folder.file("c.toml", "[io]\ndo = 2\n\n[home]\nhom2 = []\n");
    check(&run("hello", &["--cell", &cell]), 2, "", "c.toml:5:1: [home] has no key `hom2`; did you mean `home2`?");
    let cell = folder.file("d.toml", "[io]\ndi = 2\n");
    check(
        &run("hello", &["--cell", &cell, "--io", &folder.file("e.toml", "[[event]]\nat = 1\ndi.3 = true\n")]),
        2,
        "",
        "DI 3 does not exist: this cell has channels 1 to 2",
    );
    check(&run("hello", &["--cell", "/nowhere.toml"]), 2, "", "cannot read the cell file");
}

/// A run that is driven by lines.
struct Live {
    child: std::process::Child,
    lines: std::io::Lines<BufReader<std::process::ChildStdout>>,
}

impl Live {
    fn start(program: &str) -> Self {
        let mut command = command(program, &["--live", "--state-dir", "live-state"]);
        let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let lines = BufReader::new(child.stdout.take().unwrap()).lines();
        Self { child, lines }
    }

    fn order(&mut self, order: &str) {
        writeln!(self.child.stdin.as_mut().unwrap(), "{order}").unwrap();
    }

    /// The next line with all of these words in it.
    fn line(&mut self, words: &[&str]) -> String {
        let found = self.lines.by_ref().map(Result::unwrap).find(|line| words.iter().all(|word| line.contains(word)));
        found.unwrap_or_else(|| panic!("no line with {words:?}"))
    }

    /// Ends the orders; the exit code and the last line.
    fn leave(mut self) -> (Option<i32>, String) {
        drop(self.child.stdin.take());
        let last = self.lines.map(Result::unwrap).last().unwrap();
        (self.child.wait().unwrap().code(), last)
    }
}

fn orders_drive_a_run() {
    let mut live = Live::start("forever");
    let hello = live.line(&["hello"]);
    for words in ["\"program\":\"t.arl\"", "\"name\":\"j6\",\"unit\":\"deg\",\"min\":"] {
        assert!(hello.contains(words), "{hello}");
    }
    live.line(&["state", "\"state\":\"running\"", "\"motion_line\":5", "\"override\":100", "\"di\":\"000"]);
    live.order("override = 50\ndi.3 = true\n\n");
    live.line(&["state", "\"override\":50", "\"di\":\"0010"]);
    live.order("do.3 = true");
    live.line(&["refused", "do.3 = true", "did you mean `di`?"]);
    live.order("ai.9 = 1");
    live.line(&["refused", "AI 9 does not exist"]);
    // Nobody drives any more: the robot stops on its path, and the program with it.
    let (code, last) = live.leave();
    assert_eq!(code, Some(130), "{last}");
    assert!(last.contains("\"state\":\"stopped\""), "{last}");
}

fn after_its_end_a_live_run_waits() {
    let mut live = Live::start("hello");
    let message = live.line(&["message"]);
    assert!(message.contains("\"hmi\":true,\"console\":false,\"text\":\"hello\""), "{message}");
    live.line(&["state", "\"state\":\"ended\""]);
    live.order("di.1 = true");
    live.line(&["state", "\"state\":\"ended\"", "\"di\":\"10"]);
    let (code, last) = live.leave();
    assert_eq!(code, Some(0), "{last}");
}

fn a_live_run_shows_what_is_inside() {
    let mut live = Live::start("watched");
    live.order("inside = 2");
    live.line(&["refused", "there is no channel 2"]);
    live.order("inside = one");
    live.line(&["refused", "`one` is not a channel"]);
    live.order("inside = 1");
    // It is told again and again, for the first time perhaps before the program has begun.
    let inside = live.line(&["\"inside\":{\"channel\":1,", "\"name\":\"main\""]);
    for words in [
        r#"{"id":1,"name":"main","file":"t.arl","line":4,"event":false}"#,
        r#"{"name":"round","type":"int","value":""#,
        r#"{"name":"table","type":"int[65]","value":".."}"#,
        r#""handles":[{"name":"watch","type":"clock","value":"0.000 s, stopped"}]"#,
    ] {
        assert!(inside.contains(words), "{words}\n{inside}");
    }
    live.line(&["inside"]);
    assert_eq!(live.leave().0, Some(130));
    let mut plain = Live::start("forever");
    plain.order("inside = 1");
    plain.line(&["refused", "this program was not made for inspection"]);
    plain.leave();
}
