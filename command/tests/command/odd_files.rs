//! What is not a regular file, and what cannot be written.
#![cfg(unix)]

use super::{Answer, Folder};
use std::fs::OpenOptions;
use std::os::unix::fs::symlink;

const PRINTS: &str = "func void main()\n    int n\n    for(n=1;n<=3;n=n+1)\n        print \"part \",n\n        \
                      waittime 0.1\n    endfor\nendfunc\n";

/// The answer of a command whose standard output or standard error is a disk that is full.
fn on_a_full_disk(folder: &Folder, arguments: &[&str], error: bool) -> Answer {
    let full = OpenOptions::new().write(true).open("/dev/full").expect("Linux has it");
    let mut command = folder.command(arguments);
    match error {
        true => command.stderr(full),
        false => command.stdout(full),
    };
    Answer::of(command.output().expect("the command starts"))
}

#[test]
fn output_that_cannot_be_written_is_reported_once() {
    let folder =
        Folder::new("full_disk").with("a.arl", PRINTS).with("wrong.arl", "func void main()\n    x = 1\nendfunc\n");
    let ran = on_a_full_disk(&folder, &["run", "a.arl"], false);
    ran.is(0, "").says("warning: standard output cannot be written: No space left on device");
    assert_eq!(ran.err.matches("cannot be written").count(), 1, "{}", ran.err);
    for tells in
        [&["emit", "a.arl"][..], &["doc", "movej"], &["robots", "six-10"], &["check", "--format", "json", "wrong.arl"]]
    {
        let answer = on_a_full_disk(&folder, tells, false);
        answer.is(1, "").says("error: cannot write to standard output: No space left on device");
    }
    on_a_full_disk(&folder, &["check", "wrong.arl"], true).is(1, "");
    on_a_full_disk(&folder, &["run", "a.arl", "--max-time", "0.05"], true).is(4, "part 1\n");
}

#[test]
fn settings_are_read_from_regular_files() {
    let folder = Folder::new("devices").with("a.arl", PRINTS);
    symlink("/dev/zero", folder.path.join("zero.toml")).expect("a link");
    for option in ["--robot", "--cell", "--io"] {
        folder.arl2rs(&["run", "a.arl", option, "zero.toml"]).is(2, "").says("this is not a regular file");
    }
    folder.arl2rs(&["check", "a.arl", "--cell", "zero.toml"]).is(2, "").says("this is not a regular file");
    folder.arl2rs(&["robots", "--import", "zero.toml"]).is(2, "").says("this is not a regular file");
}

#[test]
fn programs_read_and_write_regular_files() {
    let reads = "func void main()\n    print gettextstr(\"zero.txt\",1)\nendfunc\n";
    let writes = "func void main()\n    print to:file,filepath:\"zero.txt\",\"lost\"\nendfunc\n";
    let saves = "func void main()\n    print savearl(\"zero.txt\",\"copy.arl\",true)\nendfunc\n";
    let folder =
        Folder::new("device_files").with("reads.arl", reads).with("writes.arl", writes).with("saves.arl", saves);
    symlink("/dev/zero", folder.path.join("zero.txt")).expect("a link");
    folder.write("kept.txt", "kept");
    symlink("kept.txt", folder.path.join("link.txt")).expect("a link");
    folder.arl2rs(&["run", "reads.arl"]).is(3, "").says("alarm 10064");
    folder.arl2rs(&["run", "writes.arl"]).is(3, "").says("this is not a regular file");
    folder.arl2rs(&["run", "saves.arl"]).says("this is not a regular file");
    // Links to files are followed.
    folder.write("reads.arl", &reads.replace("zero", "link"));
    folder.arl2rs(&["run", "reads.arl"]).is(0, "kept\n");
}

/// Makes a pipe that nobody writes to.
fn pipe(folder: &Folder, name: &str) {
    let made = std::process::Command::new("mkfifo").arg(folder.path.join(name)).status().expect("mkfifo");
    assert!(made.success());
}

#[test]
fn what_is_no_regular_file_is_refused_wherever_a_file_is_named() {
    const WORDS: &str = "not a regular file";
    let folder = Folder::new("pipes").with("a.arl", PRINTS).with("sub/a.arl", PRINTS);
    for name in ["pipe.arl", "pipe.toml", "pipe.csv", "pipe.mcap", "pipe.urdf", "p_data.arl", "sub/arl.toml", "t/c.arl"]
    {
        std::fs::create_dir_all(folder.path.join("t")).expect("a folder");
        pipe(&folder, name);
    }
    symlink("/dev/zero", folder.path.join("zero.arl")).expect("a link");
    folder.write("t/c.out", "");
    folder.write("p.arl", PRINTS);
    folder.write("imports.arl", "import \"pipe.arl\"\nfunc void main()\nendfunc\n");
    for program in ["pipe.arl", "zero.arl", "p.arl", "imports.arl"] {
        for command in ["check", "emit", "run"] {
            folder.arl2rs(&[command, program]).is(1, "").says(WORDS);
        }
    }
    folder.arl2rs(&["check", "sub/a.arl"]).is(1, "").says("arl.toml").says(WORDS);
    folder.arl2rs(&["check", "a.arl", "--robot", "pipe.toml"]).is(2, "").says(WORDS);
    folder.arl2rs(&["check", "a.arl", "--cell", "pipe.toml"]).is(2, "").says(WORDS);
    folder.arl2rs(&["fmt", "pipe.arl"]).is(1, "").says(WORDS);
    folder.arl2rs(&["plot", "pipe.csv", "p.svg"]).says(WORDS);
    folder.arl2rs(&["compare", "pipe.mcap", "pipe.mcap"]).says(WORDS);
    folder.arl2rs(&["robots", "--import", "pipe.urdf"]).says(WORDS);
    folder.arl2rs(&["sweep", "pipe.toml"]).is(1, "").says(WORDS);
    folder.arl2rs(&["view", "pipe.mcap", "--no-open"]).says(WORDS);
    let tested = folder.arl2rs(&["test", "t"]);
    assert!(tested.code == Some(1) && tested.out.contains(WORDS), "{tested:?}");
    // Standard input is asked for by its own name.
    let mut command = folder.command(&["fmt", "-"]);
    let piped = || std::process::Stdio::piped();
    let mut child = command.stdin(piped()).stdout(piped()).stderr(piped()).spawn().expect("it starts");
    std::io::Write::write_all(&mut child.stdin.take().expect("its input"), b"int  a\n").expect("written");
    Answer::of(child.wait_with_output().expect("it ends")).is(0, "int a\n");
}

#[test]
fn a_program_that_becomes_a_pipe_is_not_waited_for() {
    let folder = Folder::new("becomes_a_pipe").with("a.arl", PRINTS).with("a_data.arl", "int b = 1\n");
    folder.arl2rs(&["run", "a.arl"]).is(0, "part 1\npart 2\npart 3\n");
    std::fs::remove_file(folder.path.join("a_data.arl")).expect("removed");
    pipe(&folder, "a_data.arl");
    folder.arl2rs(&["run", "a.arl"]).is(1, "").says("not a regular file");
}
