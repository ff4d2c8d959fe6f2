//! The files that a run leaves: what they held stays until there is something better, and nothing of the user's is
//! written over.

use super::{Answer, Folder};

const MOVES: &str = "func void main()\n  print \"go\"\n  movej j:{0,-90,90,0,30,0}\n  movej j:{20,-80,90,0,30,0}\n  waittime 0\n  print \"there\"\nendfunc\n";
/// All that a run can leave.
const ALL: [&str; 9] =
    ["--record", "a.mcap", "--plot", "a.svg", "--trace", "a.csv", "--report=a.json", "--format", "json"];
const FILES: [&str; 4] = ["a.mcap", "a.svg", "a.csv", "a.json"];

fn bytes(folder: &Folder) -> Vec<Option<Vec<u8>>> {
    FILES.iter().map(|name| std::fs::read(folder.path.join(name)).ok()).collect()
}

#[test]
fn a_run_that_is_refused_destroys_nothing() {
    let folder = Folder::new("results_refused").with("a.arl", MOVES).with("bad.toml", "[[event]]\nwhen = 1\n");
    let refused: [&[&str]; 6] = [
        &["--io", "none.toml"],
        &["--io", "bad.toml"],
        &["--set", "global.none=1"],
        &["--drive", "--engine", "engine"],
        &["--cell", "none.toml"],
        &["--robot", "none"],
    ];
    let run = |more: &[&str]| folder.arl2rs(&[&["run", "a.arl"], &ALL[..], more].concat());
    for more in refused {
        assert_ne!(run(more).code, Some(0), "{more:?}");
        assert!(bytes(&folder).iter().all(Option::is_none), "{more:?} left something");
    }
    run(&[]).is(0, "go\nthere\n");
    let whole = bytes(&folder);
    assert!(whole.iter().all(|bytes| bytes.as_ref().is_some_and(|bytes| bytes.len() > 100)));
    for more in refused {
        run(more);
        assert!(bytes(&folder) == whole, "{more:?} changed something");
    }
    // The line-by-line report, and the traces of several robots, are written by the program itself.
    let lines = ["--report=a.json", "--trace", "a.csv"];
    folder.arl2rs(&[&["run", "a.arl"], &lines[..], &["--set", "global.none=1"]].concat()).is(2, "");
    assert!(bytes(&folder) == whole);
}

#[test]
fn no_result_is_written_over_an_input_or_another_result() {
    let folder = Folder::new("results_over")
        .with("a.arl", "import \"part.arl\"\nfunc void main()\n  part::go()\nendfunc\n")
        .with("part.arl", "func void go()\n  waittime 0\nendfunc\n")
        .with("io.toml", "")
        .with("cell.toml", "");
    let of_run: [(&[&str], &str); 8] = [
        (&["--plot", "a.arl"], "--plot would overwrite a.arl, which is the program"),
        (&["--trace", "./part.arl"], "--trace would overwrite ./part.arl, which is a file of the program"),
        (&["--io", "io.toml", "--record", "io.toml"], "which is the scenario"),
        (&["--cell", "cell.toml", "--report=cell.toml"], "which is the cell"),
        (&["--plot", "x", "--record", "x"], "--plot and --record would write the same file, x"),
        (&["--trace", "x", "--report=x", "--format", "html"], "--trace and --report would write the same file, x"),
        (&["--trace", "none/x"], "cannot write none/x"),
        (&["--record", "none/"], "cannot write none/"),
    ];
    for (options, why) in of_run {
        let answer = folder.arl2rs(&[&["run", "a.arl"], options].concat());
        answer.is(2, "").says(why);
    }
    folder.arl2rs(&["build", "a.arl", "-o", "part.arl"]).is(2, "").says("would overwrite part.arl");
    folder.arl2rs(&["run", "a.arl", "--trace", "t.csv"]).is(0, "");
    folder.write("second.arl", MOVES);
    folder.write("cell.toml", "[[channel]]\nprogram = \"second.arl\"\nrobot = \"six-10\"\n");
    let traces = ["run", "a.arl", "--cell", "cell.toml", "--trace", "t.csv"];
    let others: [&[&str]; 3] =
        [&["--report=t.2.csv"], &["--record", "t.2.csv"], &["--report=t.2.csv", "--format", "json"]];
    for other in others {
        folder.arl2rs(&[&traces[..], other].concat()).is(2, "").says("would write the same file, t.2.csv");
    }
    folder.arl2rs(&["plot", "t.csv", "t.csv"]).is(2, "").says("would overwrite t.csv, which is the trace");
    assert!(folder.read("part.arl").starts_with("func void go()") && !folder.has("x"));
}

#[test]
fn what_is_cut_off_is_read_as_far_as_it_goes() {
    let folder = Folder::new("results_cut").with("a.arl", &MOVES.replace("waittime 0", "waittime 5"));
    folder.arl2rs(&[&["run", "a.arl"], &ALL[..]].concat()).is(0, "go\nthere\n");
    for part in [30, 60, 90] {
        let cut = |name: &str| {
            let bytes = std::fs::read(folder.path.join(name)).expect("the file");
            let to = folder.path.join(format!("cut-{name}"));
            std::fs::write(to, bytes.get(..bytes.len() * part / 100).expect("a part")).expect("written");
        };
        ["a.mcap", "a.csv"].into_iter().for_each(cut);
        let answer = folder.arl2rs(&["compare", "cut-a.mcap", "a.mcap"]);
        assert_eq!(answer.code, Some(1), "{part} %: {answer:?}");
        answer.says("cut-a.mcap: the recording ends after ").says("the rest is missing");
        folder.arl2rs(&["plot", "cut-a.csv", "cut.svg"]).is(0, "");
        assert!(folder.read("cut.svg").trim_end().ends_with("</svg>"));
    }
}

#[test]
fn what_is_run_at_once_needs_no_cache() {
    let folder = Folder::new("results_no_cache").with("a.arl", MOVES).with("not-a-folder", "");
    std::fs::create_dir(folder.path.join("tmp")).expect("a folder");
    folder.write("s.toml", "program = \"a.arl\"\n[grid]\nseed = [1, 2]\n");
    let none = folder.path.join("not-a-folder/cache");
    let without = |words: &[&str]| {
        let mut command = folder.command(words);
        command.env("ARL2RS_CACHE", &none).env("TMPDIR", folder.path.join("tmp"));
        Answer::of(command.output().expect("the command starts"))
    };
    without(&["run", "a.arl"]).is(0, "go\nthere\n");
    without(&["run", "a.arl", "--plot", "a.svg"]).is(0, "go\nthere\n");
    without(&["check", "a.arl", "--collisions"]).is(0, "");
    let swept = without(&["sweep", "s.toml"]);
    assert_eq!((swept.code, swept.out.lines().count()), (Some(0), 2), "{swept:?}");
    swept.says("results cannot be kept for the next sweep");
    assert!(folder.has("a.svg"));
    #[cfg(unix)]
    assert_eq!(left_in(&folder, "tmp"), ["arl2rs-sweeps.lock"]);
}

#[cfg(unix)]
fn left_in(folder: &Folder, name: &str) -> Vec<String> {
    let entries = std::fs::read_dir(folder.path.join(name)).expect("the folder");
    entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect()
}

/// What a command says that gets signals: one at once when it has printed a line, others as fast as they can be sent.
#[cfg(unix)]
fn signalled(folder: &Folder, words: &[&str], signals: &[&str]) -> Answer {
    use std::io::{BufRead, BufReader, Read};
    use std::process::{Command, Stdio};
    let _ = std::fs::create_dir(folder.path.join("tmp"));
    let mut command = folder.command(words);
    command.env("TMPDIR", folder.path.join("tmp")).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("it starts");
    let mut out = BufReader::new(child.stdout.take().expect("its output"));
    let mut text = String::new();
    out.read_line(&mut text).expect("a line");
    let kills: Vec<String> = signals.iter().map(|signal| format!("kill {signal} {}", child.id())).collect();
    assert!(Command::new("sh").args(["-c", &kills.join("; ")]).status().is_ok());
    // What ignores a signal ends all the same, and is found out by its exit code.
    let (ended, is_over) = std::sync::mpsc::channel();
    let limit = std::thread::spawn({
        let process = child.id().to_string();
        move || {
            if is_over.recv_timeout(std::time::Duration::from_secs(60)).is_err() {
                drop(Command::new("kill").arg("-KILL").arg(process).status());
            }
        }
    });
    out.read_to_string(&mut text).expect("its output");
    let rest = child.wait_with_output().expect("it ends");
    let _ = ended.send(());
    limit.join().expect("no panic");
    let err = String::from_utf8_lossy(&rest.stderr).into_owned();
    Answer { code: rest.status.code(), out: text, err }
}

#[cfg(unix)]
fn ignores_hang_up() -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| u64::from_str_radix(line.strip_prefix("SigIgn:")?.trim(), 16).ok());
    mask.is_none_or(|mask| mask & 1 == 1)
}

/// Moves for a long time, and says so.
#[cfg(unix)]
const ENDLESS: &str = "func void main()\n  print \"go\"\n  loop\n    movej j:{0,-90,90,0,30,0}\n    movej j:{20,-80,90,0,30,0}\n  endloop\nendfunc\n";

#[cfg(unix)]
#[test]
fn a_request_to_end_stops_the_robot_and_all_results_are_whole() {
    let folder = Folder::new("results_terminated").with("a.arl", ENDLESS);
    // Whoever ends a process may send several at once, of which none is impatience.
    let signals: [&[&str]; 6] =
        [&["-TERM"], &["-INT"], &["-TERM", "-TERM"], &["-HUP"], &["-HUP", "-HUP"], &["-TERM", "-HUP", "-HUP"]];
    // Tests that were started to outlive their terminal pass that on.
    let ignored = |signals: &[&str]| ignores_hang_up() && signals.contains(&"-HUP");
    for signals in signals.into_iter().filter(|signals| !ignored(signals)) {
        let words = [&["run", "a.arl", "--clock", "real"], &ALL[..]].concat();
        let answer = signalled(&folder, &words, signals);
        assert_eq!((answer.code, &*answer.out), (Some(130), "go\n"), "{signals:?}: {answer:?}");
        answer.says("interrupted: the robot stops on its path");
        let compared = folder.arl2rs(&["compare", "a.mcap", "a.mcap"]);
        assert_eq!((compared.code, &*compared.err), (Some(0), ""), "the recording is whole");
        assert!(folder.read("a.svg").trim_end().ends_with("</svg>"));
        assert_eq!(left_in(&folder, "tmp"), [""; 0]);
        // Without a listener the program runs in the process of the command.
        let answer = signalled(&folder, &["run", "a.arl", "--clock", "real"], signals);
        assert_eq!(answer.code, Some(130), "{signals:?}: {answer:?}");
        answer.says("interrupted: the robot stops on its path");
    }
}

/// What a run that was killed leaves is its own: nothing of an earlier run could be taken for it.
#[cfg(unix)]
#[test]
fn a_run_that_is_killed_leaves_nothing_of_an_earlier_one() {
    let folder = Folder::new("results_killed").with("a.arl", ENDLESS);
    let until = std::time::Instant::now() + std::time::Duration::from_secs(100);
    let killed_once_written = |words: &[&str], name: &str| {
        let mut child = folder.command(words).stdout(std::process::Stdio::null()).spawn().expect("it starts");
        while std::fs::metadata(folder.path.join(name)).is_ok_and(|about| about.len() < 1000) {
            assert_eq!(child.try_wait().expect("it runs"), None);
            assert!(std::time::Instant::now() < until, "{name} is not written");
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
        child.kill().and_then(|()| child.wait()).expect("it ends");
    };
    FILES.iter().for_each(|name| folder.write(name, "as it was"));
    killed_once_written(&[&["run", "a.arl", "--clock", "real"], &ALL[..]].concat(), "a.mcap");
    assert!(!folder.read("a.csv").contains("as it was"));
    let compared = folder.arl2rs(&["compare", "a.mcap", "a.mcap"]);
    assert_eq!(compared.code, Some(0), "{compared:?}");
    compared.says("the rest is missing");
    // These are made at the end of a run.
    assert_eq!((&*folder.read("a.svg"), &*folder.read("a.json")), ("as it was", "as it was"));
    // In the process of the command.
    folder.write("b.csv", &"as it was\n".repeat(200));
    let mut child = folder.command(&["run", "a.arl", "--clock", "real", "--trace", "b.csv"]);
    let mut child = child.stdout(std::process::Stdio::null()).spawn().expect("it starts");
    while folder.read("b.csv").starts_with("as") {
        assert!(std::time::Instant::now() < until, "the trace is not begun");
    }
    child.kill().and_then(|()| child.wait()).expect("it ends");
    assert!(!folder.read("b.csv").contains("as it was"));
}

#[cfg(target_os = "linux")]
#[test]
fn a_screen_whose_terminal_is_gone_stops_the_robot_first() {
    use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
    use rustix::termios::{Winsize, tcsetwinsize};
    use std::io::Read;
    use std::process::Stdio;
    let moved = "func void main()\n  movej j:{0,-90,90,0,30,0}\n  waittime 0\n  print \"hun\",\"dred\"\n";
    let folder =
        Folder::new("results_screen").with("a.arl", &ENDLESS.replace("func void main()\n  print \"go\"\n", moved));
    let mut here = std::fs::File::from(
        openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC).expect("a terminal"),
    );
    grantpt(&here).and_then(|()| unlockpt(&here)).expect("a terminal");
    let size = Winsize { ws_row: 40, ws_col: 100, ws_xpixel: 0, ws_ypixel: 0 };
    tcsetwinsize(&here, size).expect("a size");
    let path = ptsname(&here, Vec::new()).expect("its name").into_string().expect("a path");
    let there = || Stdio::from(std::fs::OpenOptions::new().read(true).write(true).open(&path).expect("it opens"));
    let mut command = folder.command(&["run", "a.arl", "--pendant", "--trace", "a.csv"]);
    let mut child = command.stdin(there()).stdout(there()).stderr(there()).spawn().expect("it starts");
    drop(command);
    // What the program has printed is on the screen, and nowhere in its text.
    let (mut screen, mut bytes) = (String::new(), [0; 4096]);
    while !screen.contains("hundred") {
        let count = here.read(&mut bytes).expect("the screen");
        assert!(screen.len() < 1 << 20, "{screen}");
        screen.push_str(&String::from_utf8_lossy(bytes.get(..count).unwrap_or_default()));
    }
    drop(here);
    assert_eq!(child.wait().expect("it ends").code(), Some(1));
    // The trace of a program that was killed has no last rows.
    let trace = folder.read("a.csv");
    let axes = |row: &str| row.split(',').skip(3).take(6).map(str::to_owned).collect::<Vec<_>>();
    let rows: Vec<Vec<String>> = trace.lines().skip(1).map(axes).collect();
    let [first, .., before, last] = &rows[..] else { panic!("{trace}") };
    assert!(first != last && before == last, "it moved, and stands at the end: {first:?} {before:?} {last:?}");
}

#[cfg(unix)]
#[test]
fn whoever_is_impatient_keeps_the_picture_of_before() {
    let folder = Folder::new("results_impatient").with("a.arl", ENDLESS);
    for clock in ["real", "virtual"] {
        folder.write("a.svg", "as it was");
        folder.write("a.csv", "as it was");
        let words = ["run", "a.arl", "--clock", clock, "--plot", "a.svg", "--trace", "a.csv"];
        let answer = signalled(&folder, &words, &["-INT", "-INT", "-INT"]);
        assert_eq!(answer.code, Some(130), "{answer:?}");
        assert!(!answer.err.contains("cannot read") && !answer.err.contains("not a row"), "{answer:?}");
        let picture = folder.read("a.svg");
        assert!(picture == "as it was" || picture.trim_end().ends_with("</svg>"), "{answer:?}");
        assert_eq!(left_in(&folder, "tmp"), [""; 0]);
    }
}

#[cfg(unix)]
#[test]
fn an_interrupted_sweep_keeps_the_table_of_before() {
    let folder = Folder::new("results_sweep").with("a.arl", ENDLESS);
    folder
        .write("s.toml", "program = \"a.arl\"\nmax-time = 0.1\n[grid]\nseed = { from = 1, to = 2000, count = 2000 }\n");
    folder.write("s.parquet", "as it was");
    for (more, says) in [(&["--no-cache"][..], "no results are kept"), (&[], "finished runs are kept")] {
        let answer = signalled(&folder, &[&["sweep", "s.toml", "-o", "s.parquet"], more].concat(), &["-TERM"]);
        assert_eq!(answer.code, Some(130), "{answer:?}");
        answer.says(says).says("s.parquet was not written");
        assert_eq!(folder.read("s.parquet"), "as it was");
    }
}
