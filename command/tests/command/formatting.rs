//! `arl2rs fmt`

use super::{Answer, Folder};
use std::io::Write;
use std::process::Stdio;

const UGLY: &str = "func void main()\nprint\"a\",1 //one\nendfunc";
const NICE: &str = "func void main()\n    print \"a\", 1 //one\nendfunc\n";

/// The answer to what stands on standard input.
fn piped(folder: &Folder, arguments: &[&str], input: &[u8]) -> std::process::Output {
    let mut command = folder.command(arguments);
    let command = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("the command starts");
    child.stdin.take().expect("a pipe").write_all(input).expect("written");
    child.wait_with_output().expect("an answer")
}

/// The names of what lies in the folder.
fn names(folder: &Folder) -> Vec<String> {
    let entries = std::fs::read_dir(&folder.path).expect("a folder");
    let mut names: Vec<String> =
        entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

#[test]
fn files_change_in_place_and_only_where_something_changes() {
    let folder = Folder::new("fmt_in_place").with("a.arl", UGLY).with("b.arl", NICE);
    let time = || std::fs::metadata(folder.path.join("b.arl")).and_then(|data| data.modified()).expect("a time");
    let before = time();
    folder.arl2rs(&["fmt", "a.arl", "b.arl"]).is(0, "");
    assert_eq!((folder.read("a.arl").as_str(), folder.read("b.arl").as_str()), (NICE, NICE));
    assert_eq!(time(), before);
    assert_eq!(names(&folder), ["a.arl", "b.arl"]);
    folder.arl2rs(&["fmt", "--check", "a.arl", "b.arl"]).is(0, "");
}

#[test]
fn check_names_what_would_change_and_changes_nothing() {
    let folder = Folder::new("fmt_check").with("a.arl", UGLY).with("b.arl", NICE).with("c.arl", "int  a\n");
    folder.arl2rs(&["fmt", "--check", "c.arl", "b.arl", "a.arl"]).is(1, "c.arl\na.arl\n");
    assert_eq!(folder.read("a.arl"), UGLY);
}

#[test]
fn folders_are_searched() {
    let folder = Folder::new("fmt_folder").with("in/a.arl", UGLY).with("in/deep/b.ARL", UGLY).with("in/c.txt", UGLY);
    let check = folder.arl2rs(&["fmt", "--check", "in"]);
    assert_eq!(check.out.replace('\\', "/"), "in/a.arl\nin/deep/b.ARL\n");
    folder.arl2rs(&["fmt", "in"]).is(0, "");
    assert_eq!([folder.read("in/a.arl"), folder.read("in/deep/b.ARL"), folder.read("in/c.txt")], [NICE, NICE, UGLY]);
    folder.write("empty/readme.txt", "");
    folder.arl2rs(&["fmt", "empty"]).is(0, "");
}

#[test]
fn standard_input_goes_to_standard_output() {
    let folder = Folder::new("fmt_stdin");
    Answer::of(piped(&folder, &["fmt", "-"], UGLY.as_bytes())).is(0, NICE);
    Answer::of(piped(&folder, &["fmt", "-"], NICE.as_bytes())).is(0, NICE);
    Answer::of(piped(&folder, &["fmt", "-", "--check"], UGLY.as_bytes())).is(1, "-\n");
    Answer::of(piped(&folder, &["fmt", "-", "--check"], NICE.as_bytes())).is(0, "");
    let answer = piped(&folder, &["fmt", "-"], b"//\xb5\xe3\nint  a");
    assert_eq!(answer.stdout, b"//\xb5\xe3\nint a\n");
    Answer::of(piped(&folder, &["fmt", "-"], b"\xff\xfei\0")).is(1, "").says("cannot read standard input");
}

#[test]
fn line_ends_and_encodings_stay() {
    let folder = Folder::new("fmt_encodings");
    let cases: [(&str, &[u8], &[u8]); 3] = [
        ("crlf.arl", b"int  a\r\nint  b\r\n", b"int a\r\nint b\r\n"),
        ("gb.arl", b"int  a//\xb5\xe3\xce\xbb\x81\x30\x81\x30", b"int a //\xb5\xe3\xce\xbb\x81\x30\x81\x30\n"),
        ("mark.arl", b"\xef\xbb\xbfprint  \"\xe7\x82\xb9\"", b"\xef\xbb\xbfprint \"\xe7\x82\xb9\"\n"),
    ];
    for (name, before, after) in cases {
        let path = folder.path.join(name);
        std::fs::write(&path, before).expect("written");
        folder.arl2rs(&["fmt", name]).is(0, "");
        assert_eq!(std::fs::read(&path).expect("read"), after, "{name}");
    }
}

#[test]
fn lines_with_mistakes_stay() {
    let broken = "func void main()\n  x = = 1\nprint  2\nif(a\n";
    let folder = Folder::new("fmt_broken").with("a.arl", broken);
    folder.arl2rs(&["fmt", "a.arl"]).is(0, "");
    assert_eq!(folder.read("a.arl"), "func void main()\n  x = = 1\n    print 2\nif(a\n");
}

#[test]
fn what_cannot_be_read_is_named_and_the_others_are_done() {
    let folder = Folder::new("fmt_missing").with("a.arl", UGLY);
    std::fs::write(folder.path.join("odd.arl"), b"int  a\n\xff\xff").expect("written");
    let answer = folder.arl2rs(&["fmt", "missing.arl", "odd.arl", "a.arl"]);
    answer.is(1, "").says("cannot read missing.arl").says("cannot read odd.arl: byte 7");
    assert_eq!(folder.read("a.arl"), NICE);
    assert_eq!(std::fs::read(folder.path.join("odd.arl")).expect("read"), b"int  a\n\xff\xff");
    folder.arl2rs(&["fmt"]).is(2, "");
}

#[test]
fn what_is_read_only_stays() {
    let folder = Folder::new("fmt_read_only").with("a.arl", UGLY).with("b.arl", UGLY);
    let path = folder.path.join("a.arl");
    let mut permissions = std::fs::metadata(&path).expect("there").permissions();
    permissions.set_readonly(true);
    std::fs::set_permissions(&path, permissions.clone()).expect("set");
    folder.arl2rs(&["fmt", "a.arl", "b.arl"]).is(1, "").says("cannot write a.arl");
    assert_eq!((folder.read("a.arl").as_str(), folder.read("b.arl").as_str()), (UGLY, NICE));
    assert_eq!(names(&folder), ["a.arl", "b.arl"]);
    #[expect(clippy::permissions_set_readonly_false, reason = "the folder is removed")]
    permissions.set_readonly(false);
    std::fs::set_permissions(&path, permissions).expect("set");
}

#[cfg(unix)]
#[test]
fn permissions_and_links_stay() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let folder = Folder::new("fmt_links").with("real/a.arl", UGLY);
    let real = folder.path.join("real/a.arl");
    std::fs::set_permissions(&real, std::fs::Permissions::from_mode(0o640)).expect("set");
    symlink("real/a.arl", folder.path.join("link.arl")).expect("a link");
    folder.arl2rs(&["fmt", "link.arl"]).is(0, "");
    assert_eq!(folder.read("real/a.arl"), NICE);
    assert!(folder.path.join("link.arl").is_symlink());
    assert_eq!(std::fs::metadata(&real).expect("there").permissions().mode() & 0o777, 0o640);
    symlink("/dev/zero", folder.path.join("zero.arl")).expect("a link");
    folder.arl2rs(&["fmt", "zero.arl"]).is(1, "").says("cannot read zero.arl: this is not a regular file");
}
