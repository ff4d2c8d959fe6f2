//! What is no regular file, and what cannot be written.
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
fn output_that_cannot_be_written_is_told_once() {
    let folder =
        Folder::new("full_disk").with("a.arl", PRINTS).with("wrong.arl", "func void main()\n    x = 1\nendfunc\n");
    let ran = on_a_full_disk(&folder, &["run", "a.arl"], false);
    ran.is(0, "").says("warning: standard output cannot be written: No space left on device");
    assert_eq!(ran.err.matches("cannot be written").count(), 1, "{}", ran.err);
    for tells in
        [&["emit", "a.arl"][..], &["doc", "movej"], &["robots", "six-10"], &["check", "--format", "json", "wrong.arl"]]
    {
        let told = on_a_full_disk(&folder, tells, false);
        told.is(1, "").says("error: cannot write to standard output: No space left on device");
    }
    on_a_full_disk(&folder, &["check", "wrong.arl"], true).is(1, "");
    on_a_full_disk(&folder, &["run", "a.arl", "--max-time", "0.05"], true).is(4, "part 1\n");
}

#[test]
fn settings_are_read_from_regular_files() {
    let folder = Folder::new("devices").with("a.arl", PRINTS);
    symlink("/dev/zero", folder.path.join("zero.toml")).expect("a link");
    for option in ["--robot", "--cell", "--io"] {
        folder.arl2rs(&["run", "a.arl", option, "zero.toml"]).is(2, "").says("this is no regular file");
    }
    folder.arl2rs(&["check", "a.arl", "--cell", "zero.toml"]).is(2, "").says("this is no regular file");
    folder.arl2rs(&["robots", "--import", "zero.toml"]).is(2, "").says("this is no regular file");
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
    folder.arl2rs(&["run", "writes.arl"]).is(3, "").says("this is no regular file");
    folder.arl2rs(&["run", "saves.arl"]).says("this is no regular file");
    // Links to files are followed.
    folder.write("reads.arl", &reads.replace("zero", "link"));
    folder.arl2rs(&["run", "reads.arl"]).is(0, "kept\n");
}
