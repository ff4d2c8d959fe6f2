//! `arl2rs new` and `arl.toml`; names of signals.

use super::Folder;

#[test]
fn a_new_program_runs_and_passes_its_test() {
    let folder = Folder::new("new");
    let made = folder.arl2rs(&["new", "station"]);
    assert!(made.code == Some(0) && made.out.contains("arl2rs run station.arl"), "{made:?}");
    let folder = Folder { path: folder.path.join("station") };
    folder.arl2rs(&["check", "--strict", "station.arl"]).is(0, "");
    folder.arl2rs(&["fmt", "--check", "."]).is(0, "");
    let printed = folder.read("station.out");
    let ran = folder.arl2rs(&["run", "station.arl"]);
    ran.is(0, &printed);
    assert_eq!(ran.err, "");
    folder.arl2rs(&["test", "."]).is(0, "1 passed, 0 failed\n");
    // A part that the gripper loses.
    folder.write("station.io.toml", "[[event]]\nat = 0.5\npart_present = true\n");
    folder.arl2rs(&["run", "station.arl"]).is(0, "the gripper holds nothing\n0 of 3 parts placed\n");
}

#[test]
fn a_program_needs_a_name_and_a_place() {
    let folder = Folder::new("new_names").with("full/a.txt", "");
    for (name, words) in [
        ("my cell", "letters, digits and `_`"),
        ("1st", "begins with a letter"),
        ("While", "a word of the language"),
        ("rack_data", "data files"),
        ("full", "not empty"),
        ("cell", "has another meaning"),
    ] {
        folder.arl2rs(&["new", name]).is(2, "").says(words);
    }
}

const WAITS: &str = "func void main()\n  waituntil getdi(1)\n  print \"came\"\nendfunc\n";

#[test]
fn arl_toml_says_what_the_command_does_not() {
    let folder = Folder::new("arl_toml")
        .with("arl.toml", "robot = \"hsr065\"\ncell = \"cells/cell.toml\"\nio = \"s.toml\"\n")
        .with("cells/cell.toml", "[io]\ndi = 4\n[names]\n\"di.1\" = \"part\"\n")
        .with("s.toml", "[[event]]\nat = 0.5\npart = true\n")
        .with("src/deep/waits.arl", WAITS);
    let program = "src/deep/waits.arl";
    let ran = folder.arl2rs(&["run", program, "--verbose"]);
    ran.is(0, "came\n").says("robot: hsr065 (arl.toml)").says("io: s.toml (arl.toml)");
    // From another folder the same files are meant.
    let inside = Folder { path: folder.path.join("src") };
    inside.arl2rs(&["run", "deep/waits.arl"]).is(0, "came\n");
    std::mem::forget(inside);
    // What the command says goes first.
    let named = folder.arl2rs(&["run", program, "--robot", "six-10", "--verbose"]);
    named.is(0, "came\n").says("robot: six-10 (the command line)").says("cell: cells/cell.toml (arl.toml)");
    // Checks know the cell; tests use robot and cell, and a scenario of their own.
    folder.write(program, &WAITS.replace("getdi(1)", "getdi(5)"));
    folder.arl2rs(&["check", program]).is(1, "").says("the cell has DI 1 to 4");
    folder.write(program, WAITS);
    folder.write("src/deep/waits.out", "came\n");
    folder.write("src/deep/waits.io.toml", "[[event]]\nat = 0.1\npart = true\n");
    folder.arl2rs(&["test", "src"]).is(0, "1 passed, 0 failed\n");
    for (text, words) in [
        ("robt = \"a\"", "arl.toml:1: unknown field `robt`"),
        ("robot = \"none\"", "none: no robot of this name is built in"),
        ("robot = \"none.toml\"", "none.toml"),
        ("\ncell = \"no.toml\"", "arl.toml:2: cell: there is no no.toml"),
        ("\nrobot = 3", "arl.toml:2: "),
    ] {
        folder.write("arl.toml", text);
        folder.arl2rs(&["check", program]).is(2, "").says(words);
    }
}

#[test]
fn a_file_in_a_folder_beside_is_of_no_project_here() {
    let folder = Folder::new("beside_project")
        .with("here/arl.toml", "robot = \"hsr065\"\n")
        .with("there/p.arl", "func void main()\n  print 1\nendfunc\n");
    let here = Folder { path: folder.path.join("here") };
    let checked = here.arl2rs(&["check", "--verbose", "../there/p.arl"]);
    assert_eq!((checked.code, checked.err.as_str()), (Some(0), ""));
    std::mem::forget(here);
}

#[test]
fn files_of_several_projects_are_checked_each_as_its_own() {
    let folder = Folder::new("two_projects")
        .with("six/arl.toml", "robot = \"six-10\"\n")
        .with("six/a.arl", "func void main()\n  pose p = {x 800, b 180}\n  print p\nendfunc\n")
        .with("scara/arl.toml", "robot = \"hsr065\"\n")
        .with("scara/b.arl", "func void main()\n  joint j = {j5 1}\n  print j\nendfunc\n");
    let both = folder.arl2rs(&["check", "six/a.arl", "scara/b.arl"]);
    both.is(1, "").says("scara/b.arl").says("`j5`");
    assert!(!both.err.contains("six/a.arl"), "{}", both.err);
}

#[test]
fn a_scenario_tells_where_it_names_what_is_not_there() {
    let folder = Folder::new("scenario_lines")
        .with("a.arl", WAITS)
        .with("s.toml", "[[event]]\nat = 1\ndi.1 = true\n\n[[event]]\nat = 2\ndi.99 = true\n");
    folder.arl2rs(&["run", "a.arl", "--io", "s.toml"]).is(2, "").says("s.toml:5: the scenario cannot set an input");
}

#[test]
fn what_arl_toml_names_and_is_not_there_is_reported_with_its_line() {
    let folder = Folder::new("typos").with("a.arl", WAITS);
    for (text, words) in [
        (
            "robot = \"six10\"\n",
            "arl.toml:1: robot: six10: no robot of this name is built in, and no such file exists; did you mean `six-10`?",
        ),
        ("# none\nrobot = \"my.toml\"\n", "/my.toml: cannot read the robot file"),
        ("\ncell = \"cel.toml\"\n", "arl.toml:2: cell: there is no cel.toml"),
    ] {
        folder.write("arl.toml", text);
        folder.arl2rs(&["check", "a.arl"]).is(2, "").says(words);
        folder.arl2rs(&["run", "a.arl"]).is(2, "").says(words);
    }
    folder.write("arl.toml", "io = \"sc.toml\"\n");
    folder.arl2rs(&["run", "a.arl"]).is(2, "").says("arl.toml:1: io: there is no sc.toml");
    // What the command says goes first.
    folder.write("arl.toml", "robot = \"six10\"\nio = \"sc.toml\"\n");
    folder.arl2rs(&["check", "a.arl", "--robot", "six-10"]).is(0, "");
}

#[test]
fn no_scenario_can_be_asked_for() {
    let folder = Folder::new("no_scenario").with("a.arl", WAITS).with("arl.toml", "io = \"s.toml\"\n");
    folder.write("s.toml", "[[event]]\nat = 0.5\ndi.1 = true\n");
    folder.arl2rs(&["run", "a.arl"]).is(0, "came\n");
    folder.arl2rs(&["run", "a.arl", "--io", "none"]).is(4, "").says("nothing can change any more");
}
