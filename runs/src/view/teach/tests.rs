//! Points are written where they are; places have their solutions.

use std::path::{Path, PathBuf};

use arl_robot::{Robot, atomic_file};
use serde_json::{Value, json};

use super::super::serve::Answer;
use super::Teacher;

const NONE: [f64; 7] = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
const POINTS: &str = "// points\r\njoint home = {0, -90, 90, 0, 90, 0}\r\npose feeder = {x 900, y -500, z 400, a 0, b 180, c 0} // of the belt\r\n\
                      pose later\r\ntool grip = {{0, 0, 120, 0, 0, 0}, false}\r\nwobj held = {{1, 2, 3, 0, 0, 0}, true}\r\nint n = 3\r\n";

/// A folder with data files, removed with this value.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("arl2rs-teach-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&path).unwrap();
        std::fs::write(path.join("p_data.arl"), POINTS).unwrap();
        std::fs::write(path.join("p.arl"), "func void main()\nendfunc\n").unwrap();
        Self(path)
    }

    fn teacher(&self) -> Teacher {
        Teacher::new(vec![Robot::builtin("kr10-r1420").unwrap()], &[self.0.join("p.arl"), self.0.join("p_data.arl")])
    }

    fn text(&self) -> String {
        std::fs::read_to_string(self.0.join("p_data.arl")).unwrap()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn json_of(answer: Answer) -> Result<Value, String> {
    match answer {
        Answer::Json(text) => Ok(serde_json::from_str(&text).unwrap()),
        Answer::Refused(why) => Err(why),
        Answer::NotFound | Answer::Bytes(..) => Err("something else".into()),
    }
}

fn ask(teacher: &Teacher, what: &str, order: &Value) -> Result<Value, String> {
    json_of(teacher.answer(&[what], Some(&order.to_string())))
}

#[test]
fn points_tools_and_workpieces_are_reported() {
    let folder = Folder::new("told");
    let points = json_of(folder.teacher().answer(&["points"], None)).unwrap();
    let feeder = &points["points"][1];
    assert_eq!((feeder["name"].as_str(), feeder["type"].as_str()), (Some("feeder"), Some("pose")));
    assert_eq!(feeder["values"], json!({"x": 900.0, "y": -500.0, "z": 400.0, "a": 0.0, "b": 180.0, "c": 0.0}));
    assert_eq!(points["points"][0]["values"]["j2"], -90.0);
    assert_eq!(points["points"][2]["values"], json!({}));
    let frames: Vec<_> =
        points["frames"].as_array().unwrap().iter().map(|frame| (&frame["name"], &frame["other"])).collect();
    assert_eq!(frames, [(&json!("grip"), &json!(false)), (&json!("held"), &json!(true))]);
    assert_eq!(points["frames"][0]["placed"][2], 120.0);
}

#[test]
fn a_point_is_written_where_it_stands_and_taken_back() {
    let folder = Folder::new("written");
    let teacher = folder.teacher();
    let change = |name: &str, before: Value, values: Value| json!([{"file": "p_data.arl", "type": "pose", "name": name, "before": before, "values": values}]);
    let feeder = json!({"x": 900.0, "y": -500.0, "z": 400.0, "a": 0.0, "b": 180.0, "c": 0.0});
    ask(
        &teacher,
        "save",
        &change("feeder", feeder.clone(), json!({"x": 950.00049, "y": -500, "z": -0.0001, "cfg": 1})),
    )
    .unwrap();
    let moved = POINTS.replace("{x 900, y -500, z 400, a 0, b 180, c 0}", "{x 950, y -500, z 0, cfg 1}");
    assert_eq!(folder.text(), moved);
    let saved = ask(&teacher, "save", &change("LATER", json!({}), json!({"x": 1.5}))).unwrap();
    assert_eq!((folder.text(), saved["undo"].as_u64()), (moved.replace("pose later", "pose later = {x 1.5}"), Some(2)));
    ask(&teacher, "undo", &json!({})).unwrap();
    assert_eq!(folder.text(), moved);
    ask(&teacher, "undo", &json!({})).unwrap();
    assert_eq!(folder.text(), POINTS);
    assert!(ask(&teacher, "undo", &json!({})).unwrap_err().contains("there is nothing to undo"));
    // Several at once, all or none.
    let both = json!([{"file": "p_data.arl", "type": "pose", "name": "feeder", "before": feeder, "values": {"x": 1}},
                      {"file": "p_data.arl", "type": "pose", "name": "none", "before": {}, "values": {"x": 1}}]);
    assert!(ask(&teacher, "save", &both).unwrap_err().contains("has no pose none"));
    assert_eq!(folder.text(), POINTS);
    // What others have written since is not undone.
    assert!(
        ask(&teacher, "save", &change("feeder", json!({}), json!({"x": 1}))).unwrap_err().contains("somebody else")
    );
    ask(&teacher, "save", &change("feeder", feeder, json!({"x": 1}))).unwrap();
    std::fs::write(folder.0.join("p_data.arl"), "pose feeder\n").unwrap();
    assert!(ask(&teacher, "undo", &json!({})).unwrap_err().contains("somebody else"));
}

#[test]
fn nothing_else_is_written() {
    let folder = Folder::new("else");
    let teacher = folder.teacher();
    let refused = |file: &str, ty: &str, name: &str, values: Value| {
        let before = json!({"x": 900.0, "y": -500.0, "z": 400.0, "a": 0.0, "b": 180.0, "c": 0.0});
        let change = json!([{"file": file, "type": ty, "name": name, "before": before, "values": values}]);
        ask(&teacher, "save", &change).unwrap_err()
    };
    for file in ["p.arl", "../p_data.arl", "/etc/passwd", ""] {
        assert!(refused(file, "pose", "feeder", json!({"x": 1})).contains("is not a data file"), "{file}");
    }
    assert!(refused("p_data.arl", "int", "n", json!({"x": 1})).contains("a pose or a joint"));
    assert!(refused("p_data.arl", "pose", "feeder", json!({"x}": 1})).contains("not a component"));
    assert!(refused("p_data.arl", "pose", "feeder", json!({"cfg": 1.5})).contains("expected a whole number"));
    for (name, value) in [("x", 1e306), ("z", -1e7), ("ej1", 8.9e9), ("cfg", 8.0), ("cfg", 1e300), ("turn", -2.0)] {
        assert!(refused("p_data.arl", "pose", "feeder", json!({name: value})).contains("expected"), "{name} {value}");
    }
    assert!(refused("p_data.arl", "pose", "feeder", json!({})).contains("no components"));
    assert!(ask(&teacher, "save", &json!({"x": 1})).unwrap_err().contains("cannot be read"));
    // Nor are computed values replaced.
    std::fs::write(
        folder.0.join("p_data.arl"),
        "double high = 5\npose feeder = {x 1, z high + 2}\npose copy = feeder\n",
    )
    .unwrap();
    assert!(refused("p_data.arl", "pose", "Feeder", json!({"x": 1})).contains("computed"));
    assert!(refused("p_data.arl", "pose", "copy", json!({"x": 1})).contains("computed"));
    std::fs::write(folder.0.join("p_data.arl"), POINTS).unwrap();
    assert_eq!(folder.text(), POINTS);
    assert!(Path::new(&folder.0).read_dir().unwrap().count() == 2, "nothing is left beside the file");
}

#[test]
fn saves_and_those_of_a_program_are_all_there() {
    let folder = Folder::new("beside");
    let file = folder.0.join("p_data.arl");
    std::thread::scope(|scope| {
        // As `savefilepose` does.
        scope.spawn(|| {
            for number in 1..=40 {
                let value = format!("{{x {number}}}");
                atomic_file::change(&file, |bytes| arl_lang::with_value(bytes, "pose", "later", &value)).unwrap();
            }
        });
        let teacher = folder.teacher();
        let mut before = json!({"x": 900.0, "y": -500.0, "z": 400.0, "a": 0.0, "b": 180.0, "c": 0.0});
        for number in 1..=40 {
            let values = json!({"x": f64::from(number)});
            let change =
                json!([{"file": "p_data.arl", "type": "pose", "name": "feeder", "before": before, "values": values}]);
            ask(&teacher, "save", &change).unwrap();
            before = values;
        }
    });
    let text = folder.text();
    assert!(text.contains("feeder = {x 40} // of the belt") && text.contains("later = {x 40}"), "{text}");
}

#[test]
fn what_others_write_between_is_not_taken_back() {
    let folder = Folder::new("between");
    std::fs::write(folder.0.join("q_data.arl"), "pose second = {x 1}\n").unwrap();
    let sources = ["p.arl", "p_data.arl", "q_data.arl"].map(|name| folder.0.join(name));
    let teacher = Teacher::new(vec![Robot::builtin("kr10-r1420").unwrap()], &sources);
    let both = json!([{"file": "p_data.arl", "type": "pose", "name": "later", "before": {}, "values": {"x": 1}},
                      {"file": "q_data.arl", "type": "pose", "name": "second", "before": {"x": 1}, "values": {"x": 2}}]);
    ask(&teacher, "save", &both).unwrap();
    std::fs::write(folder.0.join("q_data.arl"), "pose second = {x 3}\n").unwrap();
    assert!(ask(&teacher, "undo", &json!({})).unwrap_err().contains("by somebody else since: it is left as it is"));
    assert!(folder.text().contains("later = {x 1}"), "all or none");
    assert_eq!(std::fs::read_to_string(folder.0.join("q_data.arl")).unwrap(), "pose second = {x 3}\n");
}

#[test]
fn a_place_has_all_its_solutions_and_each_leads_to_it() {
    let folder = Folder::new("place");
    let teacher = folder.teacher();
    let tool = [0.0, 0.0, 120.0, 0.0, 0.0, 0.0, 1.0];
    let setting = json!({"tool": tool, "wobj": [10, 20, 0, 0, 0, 0, 1], "base": NONE});
    let near = [0.0, -90.0, 90.0, 0.0, 90.0, 0.0];
    let asked = json!({"components": [890, -520, 400, 0, 180, 0], "channel": 1, "setting": setting, "near": near});
    let place = ask(&teacher, "place", &asked).unwrap();
    assert_eq!((place["placed"][0].as_f64(), place["placed"][1].as_f64()), (Some(900.0), Some(-500.0)));
    let solutions = place["solutions"].as_array().unwrap();
    assert_eq!(solutions.len(), 8);
    let mut reached = 0;
    for solution in solutions {
        if solution["axes"].is_null() {
            assert!(solution["why"].as_str().is_some_and(|why| !why.is_empty()), "{solution}");
            continue;
        }
        reached += 1;
        let back = json!({"axes": solution["axes"], "channel": 1, "setting": setting, "near": near});
        let back = ask(&teacher, "place", &back).unwrap();
        for at in 0..3 {
            let (one, other) = (place["components"][at].as_f64().unwrap(), back["components"][at].as_f64().unwrap());
            assert!((one - other).abs() < 1e-6, "{one} {other}");
        }
    }
    // Dragged, it is written as users see it.
    assert_eq!(place["components"], json!([890.0, -520.0, 400.0, 0.0, 180.0, 0.0]));
    let asked = json!({"placed": place["placed"], "channel": 1, "setting": setting, "near": near, "before": place["components"]});
    let dragged = ask(&teacher, "place", &asked).unwrap();
    for at in 0..6 {
        let (one, other) = (place["components"][at].as_f64().unwrap(), dragged["components"][at].as_f64().unwrap());
        assert!((one - other).abs() < 1e-6, "{dragged}");
    }
    assert!(reached >= 2 && place["nearest"].is_u64(), "{place}");
    // Far away, and straight above at a singular point.
    let far = json!({"components": [5000, 0, 400, 0, 180, 0], "channel": 1, "setting": setting, "near": near});
    let far = ask(&teacher, "place", &far).unwrap();
    assert!(far["nearest"].is_null() && far["solutions"][0]["why"].as_str().unwrap().contains("out of reach"));
    let straight = json!({"axes": [0, -90, 90, 0, 0, 0], "channel": 1, "setting": setting, "near": near});
    let straight = ask(&teacher, "place", &straight).unwrap();
    assert_eq!(straight["solutions"][0]["near"], "wrist");
    assert!(ask(&teacher, "place", &json!({"channel": 1, "setting": setting, "near": near})).is_err());
    for (components, tool) in [([1e308, 0.0, 400.0, 0.0, 180.0, 0.0], NONE), ([0.0; 6], [0.0; 7])] {
        let setting = json!({"tool": tool, "wobj": NONE, "base": NONE});
        let wild = json!({"components": components, "channel": 1, "setting": setting, "near": near});
        assert!(ask(&teacher, "place", &wild).is_err(), "{wild}");
    }
    assert!(ask(&teacher, "place", &json!({"axes": [1], "channel": 1, "setting": setting, "near": near})).is_err());
}

#[test]
fn a_map_tells_where_a_plane_is_reached() {
    let folder = Folder::new("map");
    let teacher = folder.teacher();
    let setting = json!({"tool": NONE, "wobj": NONE, "base": NONE});
    let near = [0.0, -90.0, 90.0, 0.0, 90.0, 0.0];
    let map = json!({"components": [0, 0, 400, 0, 180, 0], "channel": 1, "setting": setting, "near": near, "half": 1500, "step": 100});
    let map = ask(&teacher, "map", &map).unwrap();
    let (side, places) = (map["side"].as_u64().unwrap() as usize, map["places"].as_str().unwrap());
    assert_eq!((side, places.len()), (31, 31 * 31));
    // A corner is too far; 900 mm before the robot is not.
    let at = |x: i32, y: i32| places.as_bytes()[((y + 1500) / 100) as usize * side + ((x + 1500) / 100) as usize];
    assert!(at(-1500, -1500) == b'0' && at(900, 0) > b'1', "{places}");
    let many = json!({"components": [0, 0, 400, 0, 180, 0], "channel": 1, "setting": setting, "near": near, "half": 1e9, "step": 1});
    assert!(ask(&teacher, "map", &many).unwrap_err().contains("out of range"));
    let many = json!({"components": [0, 0, 400, 0, 180, 0], "channel": 1, "setting": setting, "near": near, "half": 1e6, "step": 1});
    assert!(ask(&teacher, "map", &many).unwrap_err().contains("at most"));
}
