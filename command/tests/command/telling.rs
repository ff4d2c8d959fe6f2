//! `explain`, `doc`, `robots`, and usage.

use super::{Answer, Folder};

#[test]
fn usage_mistakes_end_with_two() {
    let folder = Folder::new("usage");
    folder.arl2rs(&[]).is(2, "").says("Usage");
    folder.arl2rs(&["check"]).is(2, "").says("FILE");
    folder.arl2rs(&["run", "a.arl", "--clock", "fast"]).is(2, "").says("virtual");
    folder.arl2rs(&["fly"]).is(2, "").says("fly");
}

#[test]
fn a_cache_is_cleaned_and_limited() {
    let folder = Folder::new("clean");
    folder.write("kept.txt", "not ours");
    let clean = |words: &[&str], limit: &str| {
        let mut command = folder.command(words);
        command.env("ARL2RS_CACHE", &folder.path).env("ARL2RS_CACHE_LIMIT", limit);
        Answer::of(command.output().expect("the command starts"))
    };
    let nothing = format!("nothing to remove from {}\n", folder.path.display());
    clean(&["clean"], "").is(0, &nothing);
    folder.write("programs/arl-a-00000001/stamp", "arl2rs stamp 1\n");
    folder.write("programs/arl-a-00000001/lock", "");
    clean(&["clean", "--older", "1"], "none").is(0, &nothing);
    let removed = format!("removed 1 program from {}: 15 B\n", folder.path.display());
    clean(&["clean"], "2.5").is(0, &removed);
    assert!(folder.has("kept.txt") && !folder.has("programs/arl-a-00000001"));
    clean(&["clean"], "0.2").is(2, "").says("ARL2RS_CACHE_LIMIT").says("at least 1");
    folder.arl2rs(&["clean", "--older", "-1"]).is(2, "");
}

#[test]
fn codes_have_pages() {
    let folder = Folder::new("explain");
    let page = folder.arl2rs(&["explain", "arl0301"]);
    assert_eq!(page.code, Some(0), "{}", page.err);
    assert!(page.out.contains("ARL0301"), "{}", page.out);
    folder.arl2rs(&["explain", "ARL9999"]).is(2, "").says("ARL9999");
    folder.arl2rs(&["explain", "x"]).is(2, "").says("ARL0203");
}

#[test]
fn built_ins_have_a_reference() {
    let folder = Folder::new("doc");
    for name in ["movej", "SIN", "pose", "$DFSPEED"] {
        let page = folder.arl2rs(&["doc", name]);
        assert_eq!(page.code, Some(0), "{}", page.err);
        assert!(page.out.to_lowercase().contains(&name.to_lowercase()), "{}", page.out);
    }
    folder.arl2rs(&["doc", "movj"]).is(2, "").says("did you mean `movej`?");
}

#[test]
fn robots_are_listed_and_printed() {
    let folder = Folder::new("robots");
    let list = folder.arl2rs(&["robots"]);
    assert!(list.out.lines().any(|line| line.starts_with("six-10 ")), "{}", list.out);
    let file = folder.arl2rs(&["robots", "six-10"]);
    assert!(file.out.contains("[geometry]"), "{}", file.out);
    folder.write("mine.toml", &file.out);
    folder.write("a.arl", "func void main()\nendfunc\n");
    folder.arl2rs(&["check", "--robot", "mine.toml", "a.arl"]).is(0, "");
    folder.arl2rs(&["robots", "six"]).is(2, "").says("six-10");
}

#[test]
fn a_urdf_becomes_a_robot_file() {
    let folder = Folder::new("import");
    let mut urdf = String::from("<robot name=\"pick\"><link name=\"base\"/>");
    let joints = [("0 0 0.3", "revolute"), ("0.4 0 0", "revolute"), ("0.3 0 0", "prismatic"), ("0 0 0", "revolute")];
    for (at, (xyz, kind)) in joints.iter().enumerate() {
        let parent = if at == 0 { "base".to_owned() } else { format!("l{at}") };
        urdf += &format!(
            "<link name=\"l{0}\"/><joint name=\"a{0}\" type=\"{kind}\"><origin xyz=\"{xyz}\"/><parent link=\"{parent}\"/>\
             <child link=\"l{0}\"/><axis xyz=\"0 0 1\"/><limit lower=\"-2\" upper=\"2\" effort=\"0\" velocity=\"3\"/></joint>",
            at + 1
        );
    }
    folder.write("pick.urdf", &(urdf.clone() + "</robot>"));
    let file = folder.arl2rs(&["robots", "--import", "pick.urdf"]);
    assert!(file.out.contains("family = \"scara\"") && file.out.contains("l1 = 400.0"), "{}", file.out);
    folder.write("pick.toml", &file.out);
    folder.write("a.arl", "func void main()\n    joint j = {1,2,3,4}\n    print j.j4\nendfunc\n");
    folder.arl2rs(&["check", "--robot", "pick.toml", "a.arl"]).is(0, "");
    folder.write("bent.urdf", &(urdf.replacen("0.4 0 0", "0.4 0.1 0", 1) + "</robot>"));
    folder.arl2rs(&["robots", "--import", "bent.urdf"]).is(2, "").says("bent.urdf").says("not stretched along x");
    folder.arl2rs(&["robots", "--import", "none.urdf"]).is(2, "").says("cannot read none.urdf");
}
