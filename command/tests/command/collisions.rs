//! Collisions: what `run` and `check --collisions` say of them.

use super::Folder;

const REACHES: &str = "func void main()\n  int unused = 1\n  movej j:{0,-90,90,0,0,0}\n  movej j:{0,-20,60,0,0,0}\n  waittime 0\n  print \"done\"\nendfunc\n";
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
    answer.is(0, "done\n").says("the forearm touches table after ").says("(a.arl:4)");
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
    found.is(1, "").says("error").says("the forearm touches table").says("(a.arl:4)");
    assert_eq!(found.err.matches("ARL0902").count(), 1, "a warning is told once: {}", found.err);
    let found = folder.arl2rs(&["check", "--collisions", "--format", "json", "a.arl"]);
    assert_eq!(found.code, Some(1));
    let objects = found.out.lines().map(|line| serde_json::from_str::<serde_json::Value>(line).expect("JSON"));
    let first = objects.into_iter().find(|object| object["code"] == "collision").expect("a collision");
    assert_eq!((&first["severity"], &first["file"], &first["line"]), (&"error".into(), &"a.arl".into(), &4.into()));
    folder.arl2rs(&["check", "--collisions", "--cell", "free.toml", "a.arl"]).is(0, "");
    assert!(!folder.has(".arl-state"), "a check keeps nothing");

    // What keeps a run from its end is said; a program with mistakes does not run.
    folder.write("b.arl", "func void main()\n  int a = 0\n  print 1 / a\n  movej j:{0,-40,60,0,0,0}\nendfunc\n");
    folder.arl2rs(&["check", "--collisions", "b.arl"]).is(0, "").says("its run ended with `alarm 20001");
    folder.write("c.arl", "func void main()\n  movej\nendfunc\n");
    folder.arl2rs(&["check", "--collisions", "c.arl"]).is(1, "").says("ARL04");
    folder.arl2rs(&["check", "--clearance", "5", "a.arl"]).is(2, "").says("--collisions");
    // A run that fails finds nothing, and does not say that there is nothing.
    folder.write("arl.toml", "cell = \"cell.toml\"\nio = \"none.toml\"\n");
    folder.arl2rs(&["check", "--collisions", "a.arl"]).is(2, "").says("arl.toml:2: io: there is no none.toml");
    folder.write("island.toml", "[[island]]\naddress = \"127.0.0.1\"\ndi = [{ channel = 1, discrete_input = 0 }]\n");
    folder.write("arl.toml", "");
    let refused = folder.arl2rs(&["check", "--collisions", "--cell", "island.toml", "a.arl"]);
    refused.is(2, "").says("a check does not run a program whose cell has [[island]]");
}

#[test]
fn programs_of_other_channels_run_beside_the_first_one() {
    let folder = folder("collisions_channels");
    folder.write("two.toml", &format!("{TABLE}[[channel]]\nprogram = \"b.arl\"\n"));
    folder.write("b.arl", "func void main()\n  $BASE[0] = {{6000,0,0,0,0,0}}\n  movej j:{0,-90,90,0,0,0}\nendfunc\n");
    let found = folder.arl2rs(&["check", "--collisions", "--cell", "two.toml", "a.arl", "b.arl"]);
    found.is(1, "").says("the forearm of channel 1 touches table");
    assert!(!found.err.contains("of channel 2"), "{}", found.err);
    assert_eq!(found.err.matches("the forearm of channel 1 touches table").count(), 1, "{}", found.err);
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
    folder.write("bad.toml", "[[body]]\nname = \"jig\"\nbox = [10, 10, 10]\non = \"flange\"\nchannel = 2\n");
    folder.arl2rs(&["run", "a.arl", "--cell", "bad.toml"]).is(2, "").says("from 1 to 1");
}

#[test]
fn a_robot_that_waits_is_checked_where_its_place_is_known() {
    let turns = "func void main()\n  movej j:{90,0,0,0,0,0}\n  movej j:{-90,0,0,0,0,0}\nendfunc\n";
    let waits = "func void main()\n  waittime 10\nendfunc\n";
    let channel = "[[channel]]\nprogram = \"b.arl\"\n";
    // Side by side, 500 mm apart.
    let placed = format!("base = [0, 0, 0]\n{channel}base = [0, 500, 0]\n");
    let folder = Folder::new("collisions_waiting").with("a.arl", turns).with("b.arl", waits);
    let folder = folder.with("placed.toml", &placed).with("unplaced.toml", channel);
    let found = folder.arl2rs(&["check", "--collisions", "--cell", "placed.toml", "a.arl"]);
    found.is(1, "").says("of channel 1 touches").says("of channel 2");
    assert!(!found.err.contains("warning"), "{}", found.err);
    for words in [&["check", "--collisions"][..], &["run", "--clearance", "0"]] {
        let words = [words, &["--cell", "unplaced.toml", "a.arl"]].concat();
        let found = folder.arl2rs(&words);
        found.is(0, "").says("the robot of channel 2 was checked only against itself, as its program did not move it");
        assert_eq!(found.err.matches("warning").count(), 1, "{}", found.err);
    }
}

#[test]
fn what_touches_before_the_first_motion_is_found() {
    let folder = Folder::new("collisions_first").with("a.arl", "func void main()\n  waittime 1\nendfunc\n");
    // A post around the flange of the robot at home.
    let cell = "base = [0, 0, 0]\n[[body]]\nname = \"post\"\nbox = [3000, 3000, 400]\nat = [0, 0, 1000]\n";
    folder.write("cell.toml", cell);
    let found = folder.arl2rs(&["check", "--collisions", "--cell", "cell.toml", "a.arl"]);
    found.is(1, "").says("touches post after 0.000 s\n");
    let found = folder.arl2rs(&["check", "--collisions", "--cell", "cell.toml", "--format", "json", "a.arl"]);
    let first = found.out.lines().map(|line| serde_json::from_str::<serde_json::Value>(line).expect("JSON"));
    let first = first.into_iter().find(|object| object["code"] == "collision").expect("a collision");
    assert_eq!((&first["file"], &first["line"]), (&"a.arl".into(), &1.into()));
    folder.write("cell.toml", &cell.replace("base = [0, 0, 0]\n", ""));
    let found = folder.arl2rs(&["check", "--collisions", "--cell", "cell.toml", "a.arl"]);
    found
        .is(0, "")
        .says("the robot of channel 1 was checked only against itself, as its program did not move it: with `base`");
}
