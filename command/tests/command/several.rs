//! Programs with others beside them, by their cell file.

use super::{Answer, Folder};
use std::process::Command;

const FIRST: &str = "func void main()\n    waituntil getdo(1)\n    print \"first \", count\nendfunc\n";
const SECOND: &str = "func void main()\n    joint a = {10,20,30,40}\n    movej a\n    setdo(1,true)\n    print \"second \", many\n\
                      endfunc\n";
const CELL: &str = "[[channel]]\nprogram = \"second.arl\"\nrobot = \"hsr065\"\n";

fn folder(name: &str) -> Folder {
    Folder::new(name)
        .with("first.arl", FIRST)
        .with("first_data.arl", "int count = 3\n")
        .with("second.arl", SECOND)
        .with("second_data.arl", "int many = 5\n")
        .with("cell.toml", CELL)
}

/// The command where cargo cannot be started: what works then needs no compilation.
fn without_cargo(folder: &Folder, arguments: &[&str]) -> Answer {
    Answer::of(folder.command(arguments).env("CARGO", "/nowhere/cargo").output().expect("the command starts"))
}

#[test]
fn several_unchanged_programs_and_new_values_need_no_compilation() {
    let folder = folder("several");
    let run = ["run", "first.arl", "--cell", "cell.toml", "--engine", "native"];
    folder.arl2rs(&run).is(0, "second 5\nfirst 3\n");
    without_cargo(&folder, &run).is(0, "second 5\nfirst 3\n");

    // The runtime reads values of all programs again.
    folder.write("second_data.arl", "int many = 50\n");
    without_cargo(&folder, &run).is(0, "second 50\nfirst 3\n");

    // What the cell says of channels is compiled in, the rest is not.
    folder.write("cell.toml", &format!("{CELL}[io]\ndi = 8\n"));
    without_cargo(&folder, &run).is(0, "second 50\nfirst 3\n");
    folder.write("cell.toml", &format!("{CELL}\n[[channel]]\nprogram = \"second.arl\"\nrobot = \"hsr065\"\n"));
    without_cargo(&folder, &run).is(0, "second 50\nsecond 50\nfirst 3\n");
    folder.write("cell.toml", &format!("load = [\"first.arl\"]\n{CELL}"));
    without_cargo(&folder, &run).is(1, "").says("cargo was not found");
    folder.write("cell.toml", CELL);
    folder.write("second.arl", &SECOND.replace("second", "other"));
    without_cargo(&folder, &run).is(1, "").says("cargo was not found");
    folder.arl2rs(&run).is(0, "other 50\nfirst 3\n");
}

#[test]
fn data_files_lie_beside_their_own_program() {
    // The first program has a file of that name, too, and a program of the same name stands elsewhere.
    let cell = "[[channel]]\nprogram = \"second/second.arl\"\n[[channel]]\nprogram = \"../third/second.arl\"\n";
    let waiting =
        |seconds: u32| format!("func void main()\n    waittime {seconds}\n    print \"second \", many\nendfunc\n");
    let folder = Folder::new("several_folders")
        .with("first/first.arl", &FIRST.replace("waituntil getdo(1)", "waittime 3"))
        .with("first/first_data.arl", "int count = 3\n")
        .with("first/second_data.arl", "int many = 1\n")
        .with("first/second/second.arl", &waiting(1))
        .with("first/second/second_data.arl", "int many = 5\n")
        .with("third/second.arl", &waiting(2))
        .with("third/second_data.arl", "int many = 7\n")
        .with("first/cell.toml", cell);
    let native = ["run", "first/first.arl", "--cell", "first/cell.toml", "--engine", "native"];
    let run = &native[..4];
    folder.arl2rs(run).is(0, "second 5\nsecond 7\nfirst 3\n");
    folder.arl2rs(&native).is(0, "second 5\nsecond 7\nfirst 3\n");
    folder.write("first/second/second_data.arl", "int many = 50\n");
    folder.write("third/second_data.arl", "int many = 70\n");
    without_cargo(&folder, run).is(0, "second 50\nsecond 70\nfirst 3\n");
    without_cargo(&folder, &native).is(0, "second 50\nsecond 70\nfirst 3\n");
    folder.write("third/second_data.arl", "int many = \"seven\"\n");
    folder.arl2rs(run).is(1, "").says("second_data.arl:1:");
}

#[test]
fn a_program_cannot_be_for_robots_of_two_builds() {
    let folder = folder("several_builds");
    folder.write("cell.toml", &format!("{CELL}[[channel]]\nprogram = \"second.arl\"\n"));
    for words in [&["check", "first.arl"][..], &["run", "first.arl"], &["build", "first.arl", "-o", "first"]] {
        let answer = folder.arl2rs(&[words, &["--cell", "cell.toml"]].concat());
        answer.is(2, "").says("cell.toml:4: second.arl is for a six-axis robot here, but for a SCARA robot elsewhere");
    }
}

#[test]
fn programs_that_a_cell_names_are_checked_for_their_channels() {
    let folder = folder("several_check");
    let check = ["check", "first.arl", "--cell", "cell.toml"];
    folder.arl2rs(&check).is(0, "");
    assert_eq!(folder.arl2rs(&check).err, "");

    // A SCARA knows no `ccir`, its targets are judged by its own axes, and what is named on the command line is checked
    // as the cell has it.
    folder
        .write("second.arl", "func void main()\n    joint a = {500,0,0,0}\n    movej a\n    setdo(20,true)\nendfunc\n");
    folder.arl2rs(&check).is(0, "").says("second.arl:3:").says("ARL0907").says("hsr065");
    folder.write("cell.toml", &format!("{CELL}[io]\ndo = 8\n"));
    folder.arl2rs(&check).is(1, "").says("second.arl:4:").says("DO 20 does not exist");
    let answer = folder.arl2rs(&["check", "first.arl", "second.arl", "--cell", "cell.toml", "--format", "json"]);
    assert_eq!(answer.out.lines().filter(|line| line.contains("DO 20")).count(), 1, "{}", answer.out);

    folder.write("cell.toml", "[[channel]]\nprogram = \"second.arl\"\nbackground = true\n");
    folder.arl2rs(&check).is(1, "").says("second.arl:3:").says("ARL0704");
    folder.write("cell.toml", "[[channel]]\nprogram = \"third.arl\"\n");
    folder.arl2rs(&check).is(2, "").says("cell.toml:1: there is no file third.arl");
    folder.write("cell.toml", "[[channel]]\nprogramm = \"second.arl\"\n");
    folder.arl2rs(&check).is(2, "").says("cell.toml:2:").says("did you mean `program`?");
}

#[test]
fn a_built_program_has_all_channels() {
    let folder = folder("several_build");
    folder.arl2rs(&["build", "first.arl", "--cell", "cell.toml", "-o", "both"]).is(0, "");
    let both = |arguments: &[&str]| {
        let output = Command::new(folder.path.join("both")).args(arguments).current_dir(&folder.path).output();
        Answer::of(output.expect("it starts"))
    };
    both(&["--cell", "cell.toml"]).is(0, "second 5\nfirst 3\n");
    both(&["--max-time", "1"]).is(4, "");
    folder.write("cell.toml", "[[channel]]\nprogram = \"third.arl\"\n");
    both(&["--cell", "cell.toml"]).is(2, "").says("third.arl, which was not compiled together with this one");
    folder.write("second.arl", "func void main()\n    prnt 1\nendfunc\n");
    folder.write("cell.toml", CELL);
    folder.arl2rs(&["build", "first.arl", "--cell", "cell.toml", "-o", "none"]).is(1, "").says("second.arl:2:");
    assert!(!folder.has("none"));
}

#[test]
fn cases_run_what_their_cell_names() {
    let folder = Folder::new("several_test")
        .with("good/first.arl", FIRST)
        .with("good/first_data.arl", "int count = 3\n")
        .with("good/first.out", "second 5\nfirst 3\n")
        .with("good/first.toml", "cell = \"cell.toml\"\n")
        .with("good/second.arl", &SECOND.replace("many", "5"))
        .with("good/cell.toml", CELL)
        .with("good/alarm.arl", "func void main()\n    waittime 0.1\n    print 1\nendfunc\n")
        .with("good/alarm.toml", "cell = \"divide.cell.toml\"\n")
        .with("good/alarm.alarm", "20001 3\n")
        .with("good/alarm.out", "1\n")
        .with("good/divide.cell.toml", "[[channel]]\nprogram = \"divide.arl\"\nbackground = true\n")
        .with("good/divide.arl", "func void main()\n    int a = 0\n    a = 1 / a\nendfunc\n")
        .with("bad/first.arl", "func void main()\nendfunc\n")
        .with("bad/first.out", "")
        .with("bad/first.toml", "cell = \"cell.toml\"\n")
        .with("bad/second.arl", "func void main()\n    prnt 1\nendfunc\n")
        .with("bad/cell.toml", CELL)
        .with("worse/first.arl", "func void main()\nendfunc\n")
        .with("worse/first.out", "")
        .with("worse/first.toml", "cell = \"none.toml\"\n");
    assert_eq!(folder.arl2rs(&["test", "good"]).is(0, "2 passed, 0 failed\n").err, "");
    let bad = folder.arl2rs(&["test", "bad"]);
    assert!(bad.out.contains("second.arl: it does not compile:") && bad.out.ends_with("0 passed, 1 failed\n"));
    let worse = folder.arl2rs(&["test", "worse"]);
    assert!(worse.out.contains("none.toml: cannot read the cell file"), "{}", worse.out);
}

#[test]
fn each_channel_is_reported_with_its_own_time_and_its_tcp_stands_on_its_base() {
    let cell = "base = [700, 0, 450]\n[[channel]]\nprogram = \"long.arl\"\n";
    let folder = Folder::new("several_reported")
        .with("short.arl", "func void main()\n    waittime 0.01\n    movej j:{3,-90,90,0,90,0}\nendfunc\n")
        .with("long.arl", "func void main()\n    movej j:{5,-90,90,0,90,0}\n    waittime 2\nendfunc\n")
        .with("cell.toml", cell);
    let run = ["run", "short.arl", "--cell", "cell.toml", "--trace", "short.csv", "--report=short.jsonl"];
    folder.arl2rs(&run).is(0, "");
    let rows: Vec<Vec<f64>> = (folder.read("short.csv").lines().skip(1))
        .map(|row| row.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN)).collect())
        .collect();
    let place = |row: &[f64]| row[15..18].to_vec();
    let moves = rows.windows(2).map(|pair| {
        place(&pair[0]).iter().zip(place(&pair[1])).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max)
    });
    assert!(moves.fold(0.0, f64::max) < 1.0, "the TCP jumps");
    assert!(rows[0][15] > 1000.0 && rows[0][17] > 1000.0, "{:?}", rows[0]);
    let report = folder.read("short.jsonl");
    let times: Vec<f64> = (report.lines())
        .map(|line| serde_json::from_str::<serde_json::Value>(line).unwrap())
        .filter_map(|object| object["cycle_time"].as_f64())
        .collect();
    assert!((times[0] - rows.len() as f64 * 0.001).abs() < 1e-9, "{times:?} {}", rows.len());
    assert!(times[0] < 1.0 && times[1] > 2.0, "{times:?}");
}
