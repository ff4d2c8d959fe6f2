//! What is known before a program runs of the targets that a robot cannot reach. A line that must be warned of ends in
//! a comment with the code and words of the message; all others must not be.

#![allow(clippy::expect_used, clippy::panic, reason = "tests stop where something is wrong")]

use arl_robot::Robot;
use arl2rs::{CheckOptions, SourceError, Sources, check_text};
use std::path::Path;

/// The text of `main_data.arl`, if there is one.
struct Data(Option<&'static str>);

impl Sources for Data {
    fn read(&self, path: &Path) -> Result<Vec<u8>, SourceError> {
        let data = self.0.filter(|_| path.ends_with("main_data.arl")).ok_or(SourceError::Missing)?;
        Ok(data.into())
    }
}

/// Checks a program for a robot.
fn check(robot: &str, program: &str) {
    check_with(robot, program, None);
}

/// Checks a program with a data file.
fn check_with(robot: &str, program: &str, data: Option<&'static str>) {
    let robot = Robot::builtin(robot).expect("a built-in robot");
    let options = CheckOptions { family: robot.family, robot: Some(robot), ..CheckOptions::default() };
    let checked = check_text(Path::new("main.arl"), program, &Data(data), &options);
    let mut found: Vec<String> = Vec::new();
    for diagnostic in &checked.diagnostics {
        let line = checked.files.line(diagnostic.primary.at) as usize;
        let text = program.lines().nth(line - 1).unwrap_or_default();
        let reported = format!("{} {}", diagnostic.code.0, diagnostic.message);
        match text.split_once("// ").map(|(_, words)| words.split_once(' ').unwrap_or((words, ""))) {
            Some((code, words)) if code == diagnostic.code.0.to_string() && reported.contains(words) => {
                found.push(text.into())
            }
            _ => panic!("line {line}: {reported}\n{text}"),
        }
    }
    let expected: Vec<&str> = program.lines().filter(|line| line.contains("// ")).collect();
    assert_eq!(found, expected, "{program}");
}

/// A `main` of six axes whose arm is stretched out to about 1500 mm in front, bent at the start.
fn kr10(body: &str) {
    check("kr10-r1420", &format!("func void main()\njoint start = {{0,-90,90,0,45,0}}\n{body}\nendfunc\n"));
}

#[test]
fn targets_moved_from_constant_ones_are_looked_at() {
    kr10(
        "pose near = {1100,0,450,0,90,0}
        pose over = offset(near,0,0,200,0,0,0)
        movej start
        lin over
        lin offset(near,600,0,0,0,0,0) // 908 199.697 mm beyond the reach
        lin reltool(near,0,0,600,0,0,0) // 908 199.697 mm beyond the reach
        lin offset(offset(near,300,0,0,0,0,0),300,0,0,0,0,0) // 908 199.697 mm
        ptp offset(near,0,0,0,90,0,0)
        lin reltool(offset(near,0,0,0,90,0,0),0,0,1500,0,0,0) // 908
        over.z = 450
        lin offset(over,600,0,0,0,0,0)
        double far = 600
        far = far + 1
        lin offset(near,far,0,0,0,0,0)",
    );
}

#[test]
fn global_and_taught_points_that_nothing_changes_are_looked_at() {
    let points = "pose feeder = {9000,0,450,0,90,0}
        pose moved = {9000,0,450,0,90,0}
        tool long = {{0,0,300,0,0,0},false}";
    let body = "movej j:{0,-90,90,0,45,0}
        lin feeder // 908
        lin moved
        lin p:{1700,0,450,0,90,0},t:long
        lin p:{2000,0,450,0,90,0} // 908
        lin taught // 908
        movej far // 907
        endfunc";
    let teach = "func void teach()\nmoved.x = 1000\nendfunc";
    let data = Some("pose taught = {9000,0,450,0,90,0}\njoint far = {0,-90,90,0,45,700}\n");
    check_with("kr10-r1420", &format!("{points}\n{teach}\nfunc void main()\n{body}\n"), data);
    // What the program teaches itself is not known.
    let learns = "print saveposenow(1,\"main.arl\",\"taught\",feeder)";
    let body = "movej j:{0,-90,90,0,45,0}\nlin feeder // 908\nlin taught\nmovej far\nendfunc";
    check_with("kr10-r1420", &format!("{points}\nfunc void main()\n{learns}\n{body}\n"), data);
}

#[test]
fn tools_and_workpieces_of_labels_hold_until_the_next_ones() {
    kr10(
        "const tool long = {{0,0,300,0,0,0},false}
        const wobj table = {{600,0,100,0,0,0},false}
        movej start
        lin p:{1700,0,450,0,90,0} // 908 199.697 mm beyond the reach
        lin p:{1700,0,450,0,90,0},t:long
        lin p:{1100,0,350,0,90,0},w:table
        lin p:{1300,0,350,0,90,0} // 908
        lin p:{1300,0,350,0,90,0},w:$WORLD
        lin p:{1700,0,450,0,90,0}
        $DFTOOL = $FLANGE
        lin p:{1700,0,450,0,90,0} // 908
        $DFTOOL = {{0,0,300,0,0,0},false}
        lin p:{1700,0,450,0,90,0}
        lin p:{1700,0,450,0,90,0},t:{{0,0,-300,0,0,0},false} // 908",
    );
}

#[test]
fn held_workpieces_go_to_tools_that_stand() {
    kr10(
        "movej start
        ptp p:{0,0,0,0,-90,0},t:{{1200,0,800,0,0,0},true},w:{{0,0,100,0,0,0},true}
        ptp p:{0,0,0,0,90,0},t:{{2200,0,800,0,0,0},true},w:{{0,0,100,0,0,0},true} // 908
        ptp p:{0,0,0,0,90,0},t:$FLANGE",
    );
}

#[test]
fn what_is_not_sure_is_left_alone() {
    kr10(
        "tool changing = {{0,0,300,0,0,0},false}
        changing.t_frame.z = 400
        movej start
        lin p:{1900,0,450,0,90,0},t:changing
        lin p:{2900,0,450,0,90,0}
        lin p:{2900,0,450,0,90,0},t:$TOOLS[3]
        lin p:{2900,0,450,0,90,0},t:$FLANGE,w:$WOBJS[1]
        pose p = {2900,0,450,0,90,0}
        p.x = 1000
        lin p,w:$WORLD
        lin p:{x 2900,z 450}
        lin p:{2900,0,450,0,90,0} // 908",
    );
    kr10("movej start\n$BASE[0].w_frame.x = 1000\nlin p:{1900,0,450,0,90,0}");
    kr10("movej start\n$TOOL_OFFSET[0] = 1000\nlin p:{1900,0,450,0,90,0}");
    kr10("movej start\n$IGNORE_ORI = true\nlin p:{1900,0,450,0,90,0}");
    let arc = "cir m:{1200,100,450,0,90,0},p:{1700,0,450,0,90,0}";
    kr10(&format!("movej start\n{arc} // 908"));
    kr10(&format!("movej start\n$ORI_REF_PATH = true\n{arc}"));
    kr10(&format!("movej start\n{arc},ca:30"));
}

#[test]
fn branches_and_loops_may_change_tools() {
    kr10(
        "const tool long = {{0,0,300,0,0,0},false}
        movej start
        if(getdi(1))
            ptp p:{1300,0,450,0,90,0},t:long
            lin p:{2000,0,450,0,90,0} // 908
        endif
        lin p:{1700,0,450,0,90,0}
        lin p:{1700,0,450,0,90,0},t:$FLANGE // 908
        if(getdi(1))
            lin p:{1300,0,450,0,90,0},t:long
        else
            lin p:{1300,0,450,0,90,0},t:long
        endif
        lin p:{1700,0,450,0,90,0}
        lin p:{2000,0,450,0,90,0} // 908
        while(getdi(2))
            lin p:{1700,0,450,0,90,0}
            lin p:{1700,0,450,0,90,0},t:$FLANGE // 908
            if(getdi(3))
                break
            endif
            lin p:{1700,0,450,0,90,0},t:long
        endwhile
        lin p:{1700,0,450,0,90,0}",
    );
}

#[test]
fn functions_may_be_called_from_anywhere() {
    let program = |label: &str| {
        format!(
            "func void change()\nlin p:{{1300,0,450,0,90,0}}{label}\nendfunc\n\
             func void main()\njoint start = {{0,-90,90,0,45,0}}\nmovej start\nchange()\nlin p:{{1700,0,450,0,90,0}}"
        )
    };
    check("kr10-r1420", &(program("") + " // 908\nendfunc\n"));
    check("kr10-r1420", &(program(",t:$FLANGE") + " // 908\nendfunc\n"));
    check("kr10-r1420", &(program(",t:{{0,0,300,0,0,0},false}") + "\nendfunc\n"));
    // Nobody knows who calls the functions of a module.
    let options = CheckOptions {
        library: true,
        robot: Some(Robot::builtin("kr10-r1420").expect("a built-in robot")),
        ..CheckOptions::default()
    };
    let module = "func void go()\nlin p:{1700,0,450,0,90,0}\nendfunc\n";
    assert!(check_text(Path::new("go.arl"), module, &Data(None), &options).diagnostics.is_empty());
}

#[test]
fn configurations_ranges_and_singular_points_are_reported() {
    kr10(
        "movej start
        ptp p:{900,0,600,0,90,0,4} // 907 j1 at 180 deg in cfg 4, 10 deg beyond its range
        ptp p:{900,0,600,0,90,0,0}
        ptp p:{900,0,600,0,90,0,8} // 909 no configuration cfg 8
        ptp p:{900,0,600,0,90,0,-1} // 909 no configuration cfg -1
        movej j:{0,-200,90,0,45,0} // 907 j2 at -200 deg, 15 deg beyond its range
        movej j:{10,-90,90,0,45,0}
        lin p:{890,0,1080,0,89.9,0} // 910 99.7 % along it, axes 4 and 6
        movej j:{10,-90,90,0,45,0}
        lin p:{890,0,1080,0,110,0}",
    );
    // Straight through the singular point, up to which no axis turns: there axes 4 and 6 would have to turn by half a
    // turn.
    kr10("movej start\nlin p:{900,0,900,0,90,0} // 910 74.4 % along it, axes 4 and 6");
    kr10("movej start\nlin p:{900,0,900,180,50,180}");
    kr10("movej start\n$CONFIG_CHECK = false\nptp p:{900,0,600,0,90,0,4}");
    kr10("movej start\n$WRIST = true\nmovej j:{10,-90,90,0,45,0}\nlin p:{890,0,1080,0,89.9,0}");
}

#[test]
fn scara_robots_have_their_own() {
    check(
        "hsr065",
        "func void main()
        movej j:{0,0,300,0} // 907 j3 at 300 mm, 80 mm beyond its range
        ptp p:{300,300,250,0,10,0,0} // 908 tilt its flange by 10 deg
        ptp p:{300,300,-500,0,0,0,0} // 907 beyond its range
        jump p:{900,0,250,0,0,0} // 908 250.000 mm
        ptp p:{300,300,250,0,0,0,4}
        ptp p:{300,300,250,0,0,0,1} // 909
        endfunc\n",
    );
}
