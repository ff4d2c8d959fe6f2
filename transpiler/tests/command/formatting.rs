//! `arl2rs fmt`

use super::Folder;
use std::io::Write;
use std::process::Stdio;

const MESSY: &str = "func void main( )\nwaittime  1\nendfunc\n";
const NEAT: &str = "func void main()\n    waittime 1\nendfunc\n";

#[test]
fn files_are_laid_out_in_place() {
    let folder = Folder::new("fmt_in_place").with("a.arl", MESSY).with("cells/b.arl", MESSY).with("cells/c.txt", MESSY);
    let answer = folder.arl2rs(&["fmt", "a.arl", "cells"]);
    assert_eq!((answer.code, answer.out.as_str()), (Some(0), ""), "{}", answer.err);
    assert_eq!((folder.read("a.arl"), folder.read("cells/b.arl")), (NEAT.into(), NEAT.into()));
    assert_eq!(folder.read("cells/c.txt"), MESSY);
    assert_eq!(std::fs::read_dir(folder.path.join("cells")).expect("a folder").count(), 2);
}

#[test]
fn a_check_writes_nothing_and_names_what_would_change() {
    let folder = Folder::new("fmt_check").with("a.arl", MESSY).with("b.arl", NEAT);
    let answer = folder.arl2rs(&["fmt", "--check", "a.arl", "b.arl"]);
    assert_eq!((answer.code, answer.out.as_str()), (Some(1), "a.arl\n"));
    assert_eq!(folder.read("a.arl"), MESSY);
    assert_eq!(folder.arl2rs(&["fmt", "--check", "b.arl"]).code, Some(0));
}

#[test]
fn standard_input_goes_to_standard_output() {
    let folder = Folder::new("fmt_stdin");
    let mut command = folder.command(&["fmt", "-"]);
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().expect("the command starts");
    child.stdin.take().expect("its input").write_all(MESSY.as_bytes()).expect("it reads");
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(String::from_utf8_lossy(&output.stdout), NEAT);
}

#[test]
fn line_ends_and_encodings_stay() {
    let folder = Folder::new("fmt_encodings").with("a.arl", &MESSY.replace('\n', "\r\n"));
    let chinese = format!("// \u{70b9}\n{MESSY}");
    std::fs::write(folder.path.join("b.arl"), encoding_rs::GB18030.encode(&chinese).0).expect("a file");
    assert_eq!(folder.arl2rs(&["fmt", "a.arl", "b.arl"]).code, Some(0));
    assert_eq!(folder.read("a.arl"), NEAT.replace('\n', "\r\n"));
    let bytes = std::fs::read(folder.path.join("b.arl")).expect("the file is there");
    assert_eq!(encoding_rs::GB18030.decode(&bytes).0, format!("// \u{70b9}\n{NEAT}"));
}

#[test]
fn lines_with_mistakes_stay_and_the_rest_is_done() {
    let folder = Folder::new("fmt_mistakes").with("a.arl", "func void main()\n  x = = 2\nwaittime 1\nendfunc\n");
    assert_eq!(folder.arl2rs(&["fmt", "a.arl"]).code, Some(0));
    assert_eq!(folder.read("a.arl"), "func void main()\n  x = = 2\n    waittime 1\nendfunc\n");
}

#[test]
fn what_cannot_be_read_is_named_and_the_others_are_done() {
    let folder = Folder::new("fmt_missing").with("a.arl", MESSY).with("c.arl", "");
    std::fs::write(folder.path.join("b.arl"), b"int a\n\xff\xff").expect("a file");
    let answer = folder.arl2rs(&["fmt", "nowhere.arl", "b.arl", "a.arl", "c.arl"]);
    assert_eq!(answer.code, Some(1));
    assert!(answer.err.contains("nowhere.arl") && answer.err.contains("b.arl"), "{}", answer.err);
    assert_eq!((folder.read("a.arl"), folder.read("c.arl")), (NEAT.into(), String::new()));
}
