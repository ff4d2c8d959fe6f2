//! Collisions: what `run` and `check --collisions` say of them.

use super::Folder;

const REACHES: &str = "func void main()\n  movej j:{0,-90,90,0,0,0}\n  movej j:{0,-20,60,0,0,0}\n  waittime 0\n  print \"done\"\nendfunc\n";
const TABLE: &str = "[[body]]\nname = \"table\"\nbox = [600, 600, 40]\nat = [1200, 0, 250]\n";

fn folder(name: &str) -> Folder {
    Folder::new(name)
        .with("a.arl", REACHES)
        .with("cell.toml", TABLE)
        .with("free.toml", &TABLE.replace("250]\n", "-400]\n"))
}

#[test]
fn a_run_says_what_its_robot_touches_first() {
    let folder = folder("collisions_run");
    let answer = folder.arl2rs(&["run", "a.arl", "--cell", "cell.toml"]);
    answer.is(0, "done\n").says("the forearm touches table after ").says("(a.arl:3)");
    assert_eq!(answer.err.matches("the forearm touches table").count(), 1, "{}", answer.err);
    let free = folder.arl2rs(&["run", "a.arl", "--cell", "free.toml"]);
    free.is(0, "done\n");
    assert!(!free.err.contains("touches"), "{}", free.err);
    folder
        .arl2rs(&["run", "a.arl", "--cell", "free.toml", "--clearance", "2000"])
        .is(0, "done\n")
        .says("comes within ");
    folder.arl2rs(&["run", "a.arl", "--clearance=-1"]).is(2, "").says("expected a distance in mm");
}

#[test]
fn a_check_finds_collisions_before_anybody_looks() {
    let folder = folder("collisions_check").with("arl.toml", "cell = \"cell.toml\"\n");
    folder.arl2rs(&["check", "a.arl"]).is(0, "");
    let found = folder.arl2rs(&["check", "--collisions", "a.arl"]);
    found.is(1, "").says("error").says("the forearm touches table").says("(a.arl:3)");
    let found = folder.arl2rs(&["check", "--collisions", "--format", "json", "a.arl"]);
    assert_eq!(found.code, Some(1));
    let first: serde_json::Value = serde_json::from_str(found.out.lines().next().expect("a line")).expect("JSON");
    assert_eq!((&first["code"], &first["severity"], &first["line"]), (&"collision".into(), &"error".into(), &3.into()));
    folder.arl2rs(&["check", "--collisions", "--cell", "free.toml", "a.arl"]).is(0, "");
    assert!(!folder.has(".arl-state"), "a check keeps nothing");

    // What keeps a run from its end is said; a program with mistakes does not run.
    folder.write("b.arl", "func void main()\n  int a = 0\n  print 1 / a\n  movej j:{0,-40,60,0,0,0}\nendfunc\n");
    folder.arl2rs(&["check", "--collisions", "b.arl"]).is(0, "").says("its run ended with `alarm 20001");
    folder.write("c.arl", "func void main()\n  movej\nendfunc\n");
    folder.arl2rs(&["check", "--collisions", "c.arl"]).is(1, "").says("ARL04");
    folder.arl2rs(&["check", "--clearance", "5", "a.arl"]).is(2, "").says("--collisions");
}

#[test]
fn broken_bodies_are_refused_before_the_run() {
    let folder = folder("collisions_broken").with("broken.stl", "no triangles here");
    for (text, words) in [
        ("[[body]]\nname = \"jig\"\nmesh = \"none.stl\"\n", "body `jig`: cannot read"),
        ("[[body]]\nname = \"jig\"\nmesh = \"broken.stl\"\n", "body `jig`: cannot read"),
        ("[[body]]\nname = \"jig\"\nbox = [0, 10, 10]\n", "its edges along x, y and z in mm"),
    ] {
        folder.write("bad.toml", text);
        let answer = folder.arl2rs(&["run", "a.arl", "--cell", "bad.toml"]);
        answer.is(2, "").says(words);
    }
    // On the flange of a channel without a robot: told, and the program runs.
    folder.write("bad.toml", "[[body]]\nname = \"jig\"\nbox = [10, 10, 10]\non = \"flange\"\nchannel = 2\n");
    folder.arl2rs(&["run", "a.arl", "--cell", "bad.toml"]).is(0, "done\n").says("which has no robot");
}
