//! `--set` and `arl2rs sweep`.

use super::*;

const PROGRAM: &str = "double pitch = 80\nint divisor = 3\npose place = {x 1, y 2}\nstring name = \"a\"\n\n\
                       func void main()\n    movej j:{0, -90, 90, 0, 90, 0}\n    movej j:{10, -90, 90, 0, 90, 0}, vp:50%\n    \
                       print name, \" \", pitch, \" \", place.x, \" \", place.y\n    print 12 / divisor\nendfunc\n";

#[test]
fn single_values_are_others_for_a_run() {
    let folder = Folder::new("set").with("p.arl", PROGRAM).with("s.toml", "[[event]]\nat = 1\ndi.1 = true\n");
    let run_with = |changes: &[&str]| {
        let set = changes.iter().flat_map(|change| ["--set", change]);
        let arguments: Vec<&str> =
            ["run", "p.arl", "--robot", "six-10", "--io", "s.toml"].into_iter().chain(set).collect();
        let Answer { code, out, err } = folder.arl2rs(&arguments);
        (code, out, err)
    };
    assert_eq!(
        run_with(&["global.pitch=100", "global.place={y 9}", "global.name=\"b\""]).1.lines().next(),
        Some("b 100 1 9")
    );
    let slow = run_with(&["robot.axis.1.vel=1", "io.event.1.at=2.5"]);
    assert_eq!((slow.0, slow.1.lines().next()), (Some(0), Some("a 80 1 2")), "{slow:?}");
    // A picture shows shares of the limits that the run had.
    folder
        .arl2rs(&["run", "p.arl", "--robot", "six-10", "--plot", "p.svg", "--set", "robot.axis.1.vel=77"])
        .is(0, "a 80 1 2\n4\n");
    assert!(std::fs::read_to_string(folder.path.join("p.svg")).expect("a picture").contains("of 77 deg/s"));
    folder
        .arl2rs(&["run", "p.arl", "--set", "robot.axis.1.vel=77"])
        .is(2, "")
        .says("--set robot.axis.1.vel: name the file, or a built-in robot, with --robot");
    for (change, words) in [
        ("global.pich=1", "there is no global variable `pich`; did you mean `pitch`?"),
        ("global.pitch=\"x\"", "expected a value of type double, found a string"),
        (
            "io.event.2.at=1",
            "s.toml: `event.2.at` does not exist: at `event` `2` is not an entry: there are 1, counted from 1",
        ),
        ("robot.axis.1.vel=fast", "[[axis]]"),
        ("cell.io.di=4", "--set cell.io.di: name the file with --cell"),
        ("pitch=1", "expected a place and a value"),
    ] {
        let (code, _, error) = run_with(&[change]);
        assert!(code == Some(2) && error.contains(words), "{change}: {code:?} {error}");
    }
}

const SWEEP: &str = "program = \"p.arl\"\nrobot = \"six-10\"\n\n[grid]\n\"global.divisor\" = [3, 0]\n\"global.place\" = [{ y = 5 }, {}]\n";

fn rows(answer: &Answer) -> Vec<serde_json::Value> {
    answer.out.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect()
}

#[test]
fn a_sweep_has_a_row_for_each_combination() {
    let folder = Folder::new("sweep").with("p.arl", PROGRAM).with("s.toml", SWEEP);
    let output = folder.arl2rs(&["sweep", "s.toml", "-o", "r.parquet"]);
    assert_eq!(output.code, Some(0), "{}", output.err);
    let all = rows(&output);
    let outcomes: Vec<_> = all.iter().map(|row| row["outcome"].as_str().unwrap_or_default()).collect();
    assert_eq!(outcomes, ["ended", "ended", "alarm", "alarm"]);
    assert_eq!(all[0]["parameters"].to_string(), r#"{"global.divisor":3,"global.place":{"y":5}}"#);
    assert_eq!(all[0]["output"][0], "a 80 1 5");
    assert_eq!((&all[0]["motions"], &all[0]["code"]), (&2.into(), &0.into()));
    let (whole, moving) = (all[0]["cycle_time"].as_f64(), all[0]["moving"].as_f64());
    assert!(whole >= moving && moving > Some(0.0), "{}", all[0]);
    let alarm = &all[2]["alarms"][0];
    assert_eq!((&alarm["number"], &alarm["file"], &alarm["line"]), (&20001.into(), &"p.arl".into(), &10.into()));
    assert_eq!(std::fs::read(folder.path.join("r.parquet")).expect("a file").get(..4), Some(&b"PAR1"[..]));
    // However it is cut, and whatever is known, the rows are the same.
    let parts: String =
        ["1/2", "2/2"].iter().map(|part| folder.arl2rs(&["sweep", "s.toml", "--shard", part]).out).collect();
    let sorted = |text: &str| {
        let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
        lines.sort();
        lines
    };
    assert_eq!(sorted(&parts), sorted(&output.out));
    assert_eq!(folder.arl2rs(&["sweep", "s.toml", "--no-cache", "--jobs", "1"]).out, output.out);
}

#[test]
fn what_is_known_does_not_run_again_until_something_changes() {
    let folder = Folder::new("sweep-known").with("p.arl", PROGRAM);
    let outcome = |timeout: u8| {
        folder
            .write("s.toml", &format!("program = \"p.arl\"\ntimeout = {timeout}\n[[run]]\n\"global.pitch\" = 4711\n"));
        rows(&folder.arl2rs(&["sweep", "s.toml"]))[0]["outcome"].to_string()
    };
    assert_eq!(outcome(60), "\"ended\"");
    // Whoever has to run has no time for it.
    assert_eq!(outcome(0), "\"ended\"");
    // The cache outlives the test: this was never known.
    let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).expect("it is later").as_micros();
    folder.write("p_data.arl", &format!("double depth = {now}.0\n"));
    assert_eq!(outcome(0), "\"hung\"");
    assert_eq!(outcome(60), "\"ended\"");
}

#[test]
fn runs_that_do_not_come_to_an_end_say_why() {
    let endless = "int n\nbool forever = false\nfunc void main()\n    while(n == 0 || forever)\n        n = 1\n    endwhile\nendfunc\n";
    let folder = Folder::new("sweep-lost").with("p.arl", endless);
    let table = "program = \"p.arl\"\nmax-time = 1e9\ntimeout = 1.5\n[[run]]\n[[run]]\n\"global.m\" = 1\n[[run]]\n\"global.forever\" = true\n\
                 [[run]]\nspeed = 1\n[[run]]\n\"global.n\" = 0\n";
    folder.write("s.toml", table);
    let output = folder.arl2rs(&["sweep", "s.toml", "--no-cache"]);
    let all = rows(&output);
    let outcomes: Vec<_> = all.iter().map(|row| row["outcome"].as_str().unwrap_or_default()).collect();
    assert_eq!(outcomes, ["ended", "refused", "hung", "refused", "ended"]);
    assert!(
        all[1]["problem"].as_str().is_some_and(|why| why.contains("there is no global variable `m`")),
        "{}",
        all[1]
    );
    assert!(all[3]["problem"].as_str().is_some_and(|why| why.contains("there is no parameter `speed`")), "{}", all[3]);
    assert_eq!(output.code, Some(1));
    output.says("3 runs could not be completed");
}

#[test]
fn mistakes_are_reported_before_anything_runs() {
    let folder = Folder::new("sweep-wrong").with("p.arl", "func void main()\n    movej 5\nendfunc\n");
    let run = |table: &str| {
        folder.write("s.toml", table);
        let Answer { code, out, err } = folder.arl2rs(&["sweep", "s.toml"]);
        assert_eq!(out, "");
        (code, err)
    };
    let (code, error) = run("program = \"p.arl\"\n");
    assert!(code == Some(1) && error.contains("p.arl:2"), "{error}");
    let (code, error) = run("program = \"p.arl\"\nspeed = 1\n");
    assert!(code == Some(2) && error.contains("s.toml:2: unknown field `speed`"), "{error}");
    folder.write("p.arl", "func void main()\nendfunc\n");
    let (code, error) = run("program = \"p.arl\"\nio = \"none.toml\"\n");
    assert!(code == Some(1) && error.contains("none.toml"), "{error}");
    assert_eq!(folder.arl2rs(&["sweep", "s.toml", "--shard", "3/2"]).code, Some(2));
    folder.arl2rs(&["sweep", "s.toml", "-o", "r.csv"]).is(2, "").says("FILE.parquet");
}

/// A wall in front of the robot, of two triangles.
const WALL: &str = "solid wall\nfacet normal 1 0 0\nouter loop\nvertex 0 -900 -900\nvertex 0 900 -900\nvertex 0 0 2000\nendloop\nendfacet\n\
                    facet normal 1 0 0\nouter loop\nvertex 0 -900 2000\nvertex 0 900 2000\nvertex 0 0 -900\nendloop\nendfacet\nendsolid wall\n";

#[test]
fn runs_look_for_collisions_where_a_sweep_asks_for_it() {
    let table = "[[body]]\nname = \"table\"\nbox = [600, 600, 40]\nat = [1200, 0, 250]\n\n[[body]]\nname = \"wall\"\nmesh = \"shapes/wall.stl\"\nat = [9000, 0, 0]\n";
    let folder = Folder::new("sweep-collisions")
        .with("p.arl", "func void main()\n  movej j:{0,-90,90,0,0,0}\n  movej j:{0,-20,60,0,0,0}\nendfunc\n")
        .with("cell.toml", table)
        .with("shapes/wall.stl", WALL);
    let sweep = |asked: &str| {
        let places = "[[run]]\n[[run]]\n\"cell.body.1.at\" = [1200, 0, -400]\n[[run]]\n\"cell.body.1.at\" = [1200, 0, -400]\n\"cell.body.2.at\" = [900, 0, 0]\n";
        folder.write("s.toml", &format!("program = \"p.arl\"\ncell = \"cell.toml\"\n{asked}\n{places}"));
        folder.arl2rs(&["sweep", "s.toml", "-o", "r.parquet"])
    };
    let found = |asked: &str| {
        let all = rows(&sweep(asked));
        all.iter().map(|row| row["collisions"].clone()).collect::<Vec<_>>()
    };
    assert_eq!(found(""), [serde_json::Value::Null, serde_json::Value::Null, serde_json::Value::Null]);
    let [by_table, free, by_wall] = found("collisions = true").try_into().expect("three rows");
    assert_eq!(free, serde_json::json!([]));
    let names = |contacts: &serde_json::Value| {
        let bodies = contacts.as_array().into_iter().flatten().map(|contact| contact["bodies"].to_string());
        bodies.collect::<Vec<_>>().join(" ")
    };
    assert!(names(&by_table).contains("\"the forearm\",\"table\""), "{by_table}");
    assert!(names(&by_wall).contains("wall") && !names(&by_wall).contains("table"), "{by_wall}");
    // They are those of a check.
    let checked = folder.arl2rs(&["check", "--collisions", "--format", "json", "--cell", "cell.toml", "p.arl"]);
    let checked: Vec<serde_json::Value> =
        checked.out.lines().filter_map(|line| serde_json::from_str(line).ok()).collect();
    let checked = checked.iter().filter(|object| object["code"] == "collision");
    let parts = ["time", "file", "line", "bodies", "distance"];
    let checked: Vec<Vec<_>> = checked.map(|object| parts.map(|part| object[part].clone()).into()).collect();
    let contacts = by_table.as_array().expect("contacts");
    let contacts: Vec<Vec<_>> = contacts.iter().map(|contact| parts.map(|part| contact[part].clone()).into()).collect();
    assert_eq!(contacts, checked);
    let near = found("clearance = 2000");
    assert!(near[1][0]["distance"].as_f64().is_some_and(|distance| distance > 0.0), "{}", near[1]);
    sweep("clearance = -1").is(2, "").says("clearance: expected a distance in mm");
    folder.write("shapes/wall.stl", "no triangles here");
    sweep("collisions = true").is(2, "").says("body `wall`");
    assert_eq!(sweep("").code, Some(0), "nobody needs the shape");
}

#[test]
fn what_ran_before_in_a_process_changes_nothing() {
    let program = "double angle = 1\n\nfunc void main()\n  movej j:{angle, -90, 90, 0, 90, 0}\n\
                   \x20 ptp p:{x 900, y -500, z 550, a 0, b 180, c 0}, vp:80%, sp:30%\n\
                   \x20 lin p:{x 900, y -500, z 400, a 0, b 180, c 0}, vl:250mm/s, sl:20mm\n\
                   \x20 lin p:{x 800, y 300, z 500, a angle, b 180, c 0}, vl:500mm/s\nendfunc\n";
    let folder = Folder::new("sweep-order").with("p.arl", program);
    let runs = [
        "\"global.angle\" = 2",
        "override = 60",
        "\"global.angle\" = 2.0\nseed = 3",
        "override = 60\nseed = 3",
        "seed = 3",
    ];
    let sweep = |order: &[usize]| {
        let table: String =
            order.iter().filter_map(|at| runs.get(*at)).map(|run| format!("[[run]]\n{run}\n")).collect();
        folder.write("s.toml", &format!("program = \"p.arl\"\nrobot = \"kr10-r1420\"\n{table}"));
        let answer = folder.arl2rs(&["sweep", "s.toml", "--no-cache", "--jobs", "1"]);
        let rows = rows(&answer).into_iter().map(|row| {
            let figures = ["outcome", "cycle_time", "moving", "way"].map(|figure| row[figure].to_string());
            (row["parameters"].to_string(), figures)
        });
        rows.collect::<std::collections::BTreeMap<_, _>>()
    };
    let (one, other) = (sweep(&[0, 1, 2, 3, 4]), sweep(&[4, 3, 1, 2, 0]));
    assert_eq!(one, other);
    assert!(one.len() == runs.len() && one.values().all(|[outcome, ..]| outcome == "\"ended\""), "{one:?}");
}

#[test]
fn shapes_go_along_with_the_runs_from_wherever_a_cell_names_them() {
    let wall = |file: &str| format!("[[body]]\nname = \"wall\"\nmesh = \"{file}\"\nat = [900, 0, 0]\n");
    let folder = Folder::new("sweep-shapes")
        .with("programs/p.arl", "func void main()\n  movej j:{0,-90,90,0,0,0}\n  movej j:{0,-20,60,0,0,0}\nendfunc\n")
        .with("cell.toml", &wall("programs/shapes/wall.stl"))
        .with("programs/shapes/wall.stl", WALL)
        .with("other.stl", WALL);
    let sweep = |runs: &str| {
        folder.write(
            "s.toml",
            &format!("program = \"programs/p.arl\"\ncell = \"cell.toml\"\ncollisions = true\n[[run]]\n{runs}\n"),
        );
        folder.arl2rs(&["sweep", "s.toml"])
    };
    let touches = |runs: &str| {
        let row = rows(&sweep(runs)).remove(0);
        let contacts = row["collisions"].as_array().unwrap_or_else(|| panic!("{row}")).clone();
        contacts.iter().any(|contact| contact["bodies"].to_string().contains("wall"))
    };
    assert!(touches(""));
    let other = "\"cell.body.1.mesh\" = \"other.stl\"";
    assert!(touches(other));
    // What was found with another shape counts no more.
    folder.write("other.stl", &WALL.replace("vertex 0 ", "vertex 9000 "));
    assert!(!touches(other));
    let answer = sweep("\"cell.body.1.mesh\" = \"none.stl\"\n[[run]]");
    let all = rows(&answer);
    let problem = all[0]["problem"].as_str().unwrap_or_default();
    assert!(problem.contains("none.stl") && !problem.contains("arl2rs-sweep"), "{problem}");
    assert_eq!((&all[0]["outcome"], &all[1]["outcome"]), (&"refused".into(), &"ended".into()));
    sweep("\"cell.body.1.mesh\" = \"none.stl\"").is(1, "").says("none.stl");
    // Where the runs are made, there is nothing but what goes along.
    folder.write("cell.toml", &wall(&folder.path.join("other.stl").display().to_string()));
    sweep("").is(2, "").says("named by an absolute path");
    folder.write("programs/cell.toml", &wall("../other.stl"));
    folder.write("s.toml", "program = \"programs/p.arl\"\ncell = \"programs/cell.toml\"\nclearance = 1\n");
    folder.arl2rs(&["sweep", "s.toml"]).is(2, "").says("lies outside of");
    // Also where other runs have other shapes.
    let rows = "[[run]]\n[[run]]\n\"cell.body.1.mesh\" = \"shapes/wall.stl\"\n";
    let table = format!("program = \"programs/p.arl\"\ncell = \"programs/cell.toml\"\nclearance = 1\n{rows}");
    folder.write("s.toml", &table);
    folder.arl2rs(&["sweep", "s.toml"]).is(2, "").says("lies outside of");
    // What is named in another way is not looked for elsewhere.
    let whole = folder.path.join("other.stl").display().to_string();
    folder.write("cell.toml", "body = [{ name = \"wall\", box = [1, 1, 1] }]\n");
    let refused = sweep(&format!("\"cell.body.1\" = {{ name = \"wall\", mesh = {whole:?} }}"));
    assert!(refused.out.contains("is not among the files of the sweep"), "{}{}", refused.out, refused.err);
}

#[test]
fn robots_of_other_channels_go_along_with_the_runs() {
    let slow = include_str!("../../../arl-robot/src/robot/files/kr10-r1420.toml").replace("vel = 220", "vel = 22");
    let folder = Folder::new("sweep-channels")
        .with("p.arl", "func void main()\n  waituntil getdi(1)\nendfunc\n")
        .with("b.arl", "func void main()\n  movej j:{0,-90,90,0,90,0}\n  movej j:{90,-90,90,0,90,0}\n  waittime 0\n  setdo(1, true)\nendfunc\n")
        .with("slow.toml", &slow)
        .with("s.toml", "[[event]]\nwhen = \"do.1\"\ndi.1 = true\n")
        .with("cell.toml", "[[channel]]\nprogram = \"b.arl\"\nrobot = \"kr10-r1420\"\n");
    let runs = "[[run]]\n[[run]]\n\"cell.channel.1.robot\" = \"slow.toml\"\n";
    folder.write("t.toml", &format!("program = \"p.arl\"\ncell = \"cell.toml\"\nio = \"s.toml\"\n{runs}"));
    let all = rows(&folder.arl2rs(&["sweep", "t.toml", "--no-cache"]));
    let time = |at: usize| all.get(at).and_then(|row| row["cycle_time"].as_f64()).unwrap_or_else(|| panic!("{all:?}"));
    assert!(time(1) > 2.0 * time(0), "{all:?}");
    folder.write("t.toml", "program = \"p.arl\"\ncell = \"cell.toml\"\nset.\"cell.channel.1.robot\" = \"none.toml\"\n");
    folder.arl2rs(&["sweep", "t.toml"]).is(1, "").says("none.toml");
}

#[test]
fn a_slip_in_the_name_of_a_variable_is_reported_before_anything_runs() {
    let folder = Folder::new("sweep-slip").with("p.arl", PROGRAM);
    let sweep = |table: &str| {
        folder.write("s.toml", &format!("program = \"p.arl\"\n{table}"));
        folder.arl2rs(&["sweep", "s.toml"])
    };
    sweep("[grid]\n\"global.pich\" = [1, 2]\n").is(2, "").says("no global variable `pich`: did you mean `pitch`?");
    sweep("[[run]]\n\"global.pitch\" = 1\n\"global.a\\nb\" = 1\n").is(2, "").says("no global variable");
    // Names fold, and may have the name of a file in front.
    let outcomes = |table: &str| rows(&sweep(table)).iter().map(|row| row["outcome"].clone()).collect::<Vec<_>>();
    assert_eq!(outcomes("[grid]\n\"global.p::Pitch\" = [100]\n"), ["ended"]);
    // One row with something else to say is a sweep.
    assert_eq!(outcomes("[[run]]\n\"global.pich\" = 1\n[[run]]\nseed = 1\n"), ["refused", "ended"]);
}

#[test]
fn hostile_tables_are_refused_in_words() {
    let folder = Folder::new("sweep-hostile").with("p.arl", PROGRAM);
    let sweep = |table: &str| {
        folder.write("s.toml", &format!("program = \"p.arl\"\n{table}"));
        folder.arl2rs(&["sweep", "s.toml"])
    };
    sweep("grid.seed = { from = 1, to = 2, count = 1000000000 }\n").is(2, "").says("[grid] seed");
    let grid = "{ from = 1, to = 2, count = 100000 }";
    sweep(&format!("[grid]\nseed = {grid}\noverride = {grid}\n")).is(2, "").says("more than 10000000 runs");
    for number in ["nan", "inf", "-inf"] {
        sweep(&format!("set.\"global.pitch\" = {number}\n")).is(2, "").says("not null, nan or inf");
        sweep(&format!("max-time = {number}\n")).is(2, "").says("max-time: expected a time from 0");
        sweep(&format!("grid.seed = {{ from = {number}, to = 2, count = 3 }}\n")).is(2, "").says("[grid] seed");
    }
    for file in ["../p.arl", "/etc/passwd", "a/../../p.arl"] {
        sweep(&format!("files = [{file:?}]\n")).is(2, "").says("expected a path in");
    }
    sweep("io = \"a\\nb.toml\"\n").is(1, "").says("b.toml: No such file");
    // A text is one word of a run, whatever it holds.
    let table = "[[run]]\n\"global.name\" = \"a\\r\\n\\tb\\\\\"\n[[run]]\nmode = \"\"\n[[run]]\nmode = \"auto\\r\"\n";
    let all = rows(&sweep(table));
    let outcomes: Vec<_> = all.iter().map(|row| row["outcome"].clone()).collect();
    assert_eq!(outcomes, ["ended", "refused", "refused"], "{all:?}");
    assert!(all[1]["problem"].as_str().is_some_and(|why| why.starts_with("--mode :")), "{}", all[1]);
}

#[test]
fn files_of_a_row_are_called_as_the_user_calls_them() {
    let folder =
        Folder::new("sweep-names").with("p.arl", PROGRAM).with("plans/s9.toml", "[[event]]\nat = 1\ndi.999 = maybe\n");
    folder.write("plans/good.toml", "[[event]]\nat = 1\ndi.1 = true\n");
    folder.write("s.toml", "program = \"p.arl\"\n[grid]\nio = [\"plans/good.toml\", \"plans/s9.toml\"]\n");
    let all = rows(&folder.arl2rs(&["sweep", "s.toml"]));
    assert_eq!((&all[0]["outcome"], &all[1]["outcome"]), (&"ended".into(), &"refused".into()));
    let problem = all[1]["problem"].as_str().unwrap_or_default();
    assert!(problem.starts_with("plans/s9.toml:3") && !problem.contains("named/"), "{problem}");
}
