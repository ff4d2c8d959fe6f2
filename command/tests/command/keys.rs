//! What a program writes of its run is what `arl_wire` reads: the same keys, on all levels.

use super::{Folder, cache};
use arl_wire::Line;
use serde_json::Value;
use std::collections::BTreeSet;
use std::io::{BufRead, BufReader, Write};
use std::path::PathBuf;
use std::process::{Command, Stdio};

/// Zones, one of which is made smaller, a place beside a singular point, a message and an alarm.
const PROGRAM: &str = "\
double none = 0
func void main()
    movej j:{0,-90,90,0,60,0},vp:100%
    pose here = cpose()
    lin offset(here,0,2,0,0,0,0),vl:1000mm/s,sl:5mm
    lin offset(here,0,120,0,0,0,0),vl:1000mm/s,sl:5mm
    lin offset(here,80,120,40,0,0,0),vl:1000mm/s
    print \"half\"
    movej j:{0,-90,90,40,3,0},vp:100%
    here = cpose()
    lin offset(here,0,40,0,0,0,0),vl:1000mm/s
    waittime 0
    print 1 % none
endfunc
";

/// The executable that `run` has kept of a program, by its stem.
fn kept(stem: &str) -> PathBuf {
    let folders = std::fs::read_dir(cache().join("programs")).expect("kept programs").flatten();
    let files = folders.flat_map(|folder| std::fs::read_dir(folder.path()).into_iter().flatten().flatten());
    let mut found = files.map(|file| file.path()).filter(|path| {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        path.is_file() && name.strip_prefix(stem).is_some_and(|rest| rest.starts_with('-'))
    });
    found.next().expect("the program is kept")
}

#[test]
fn what_a_program_writes_is_what_the_wire_reads() {
    let folder = Folder::new("keys").with("keys_of_lines.arl", PROGRAM);
    folder.arl2rs(&["run", "keys_of_lines.arl", "--engine", "native"]).says("alarm 20001");
    let mut program = Command::new(kept("keys_of_lines"));
    program.args(["--live", "--clock", "virtual", "--each-cycle", "--each-motion", "--max-time", "60"]);
    program.current_dir(&folder.path);
    let mut program = program.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().expect("it starts");
    let mut orders = program.stdin.take();
    orders.as_mut().expect("its orders").write_all(b"no such order\n").expect("an order");
    let lines = BufReader::new(program.stdout.take().expect("its lines")).lines();
    let mut seen = BTreeSet::new();
    for line in lines {
        let line = line.expect("a line");
        let written: Value = serde_json::from_str(&line).expect("JSON");
        let read: Line = serde_json::from_value(written.clone()).unwrap_or_else(|error| panic!("{error}: {line}"));
        assert_eq!(serde_json::to_value(&read).expect("a line"), written, "{line}");
        seen.extend(written.as_object().expect("an object").keys().cloned());
        // Who drives it lets it go on until it is told to end.
        if written.get("alarm").is_some() {
            drop(orders.take());
        }
        if let Some(report) = written.get("report") {
            let all = report.as_object().expect("an object").keys();
            seen.extend(all.filter(|key| ["blend", "slowed"].contains(&key.as_str())).cloned());
        }
    }
    program.wait().expect("it ends");
    let wanted = ["alarm", "blend", "cycle", "hello", "message", "refused", "report", "slowed", "state"];
    let wanted: BTreeSet<String> = wanted.map(str::to_owned).into();
    assert!(seen.is_superset(&wanted), "only {seen:?}");
}
