//! Every system variable of the manual's chapters 9 and 10: what the manual says of it, held against the catalog and
//! against a program that runs.

use super::Folder;
use arl_lang::catalog::{Access, Takes, system_variables};
use std::collections::BTreeMap;
use std::fmt::Write;

/// When a variable goes back to its default.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Restored {
    /// With each reset of the program.
    Reset,
    /// When the controller starts.
    Start,
    /// When the controller starts, to what was saved last.
    Saved,
    /// Never: every change is kept.
    Never,
    /// It cannot be written.
    ReadOnly,
}

use Restored::{Never, ReadOnly, Reset, Saved, Start};

/// Name, type as `typeof` tells it, what is looked at of it, what that prints at first, a value and how that is
/// printed, when the default comes back.
type Row = (&'static str, &'static str, &'static str, &'static str, &'static str, &'static str, Restored);

const TOOL: &str = "{{0,0,0,0,0,0},false}";
const MOVED: &str = "{{0,0,120,0,0,0},false}";

#[rustfmt::skip]
const TABLE: &[Row] = &[
    // 10.1
    ("I", "int[100]", "[99]", "0", "7", "7", Saved),
    ("I_NAME", "string[100]", "[99]", "", "\"parts\"", "parts", Never),
    ("B", "bool[100]", "[99]", "false", "true", "true", Saved),
    ("B_NAME", "string[100]", "[99]", "", "\"ready\"", "ready", Never),
    ("D", "double[100]", "[99]", "0", "-1.5", "-1.5", Saved),
    ("D_NAME", "string[100]", "[99]", "", "\"height\"", "height", Never),
    ("P", "pose[100]", "[99].x", "9e+09", "100", "100", Saved),
    ("J", "joint[100]", "[99].j6", "9e+09", "10", "10", Saved),
    ("TOOLS", "tool[32]", "[31]", TOOL, MOVED, MOVED, Saved),
    ("TOOLS_NAME", "string[32]", "[31]", "", "\"gripper\"", "gripper", Never),
    ("WOBJS", "wobj[32]", "[31]", TOOL, MOVED, MOVED, Saved),
    ("WOBJS_NAME", "string[32]", "[31]", "", "\"pallet\"", "pallet", Never),
    ("BASE", "wobj[3]", "[2]", TOOL, MOVED, MOVED, Saved),
    ("FLANGE", "tool", "", TOOL, MOVED, "", ReadOnly),
    ("WORLD", "wobj", "", "{{0,0,0,0,0,0},false,WORLD}", MOVED, "", ReadOnly),
    // 3.5.6, beside the tools
    ("TOOL_INERTIA", "ToolInertiaPara[32]", "[31].m", "0", "1500", "1500", Saved),
    // 10.2
    ("WRIST", "bool", "", "false", "true", "true", Reset),
    ("CONFIG_CHECK", "bool", "", "true", "false", "false", Reset),
    ("DFSPEED", "speed", "", "{5,50,400,5,5}", "{6,60,300,7,8}", "{6,60,300,7,8}", Reset),
    ("DFSLIP", "slip", ".pdis", "-1", "5", "5", Reset),
    ("DFTOOL", "tool", "", TOOL, MOVED, MOVED, Reset),
    ("DFWOBJ", "wobj", "", TOOL, MOVED, MOVED, Reset),
    ("IGNORE_ORI", "bool", "", "false", "true", "true", Reset),
    ("ORI_REF_PATH", "bool", "", "false", "true", "true", Reset),
    ("VEL_PROFILE", "$VEL_PROFILE", "", "S_TYPE", "T_TYPE", "T_TYPE", Reset),
    ("TRAJ_ELAPSE_TIME", "double", "", "0", "1", "", ReadOnly),
    ("TRAJ_LEFT_TIME", "double", "", "0", "1", "", ReadOnly),
    ("TRAJ_ELAPSE_DIS", "double", "", "0", "1", "", ReadOnly),
    ("TRAJ_LEFT_DIS", "double", "", "0", "1", "", ReadOnly),
    ("CJOINT", "joint", ".j1", "0", "1", "", ReadOnly),
    ("RPP_ENABLE", "bool", "", "false", "true", "true", Reset),
    ("AT_HOME", "bool[5]", "[1]", "false", "true", "", ReadOnly),
    ("EXT_CTL_ACT", "bool", "", "true", "false", "", ReadOnly),
    ("PGNO_REQ", "bool", "", "false", "true", "true", Reset),
    ("PGNO", "int", "", "-1", "5", "5", Start),
    ("PI", "double", "", "3.14159", "3", "", ReadOnly),
    ("CTL_MODE", "controlmode", "", "AUTO", "MANUAL", "", ReadOnly),
    ("WOBJ_OFFSET", "double[6]", "[5]", "0", "50", "50", Reset),
    ("TOOL_OFFSET", "double[6]", "[5]", "0", "50", "50", Reset),
    ("RESET_POS_TYPE", "string[100]", "[99]", "", "\"cmd\"", "cmd", Never),
    ("RESET_POS_THRESHOLD", "double[100]", "[99]", "0", "0.5", "0.5", Never),
    // 5.6.1.5
    ("DETECT_SOCKET_CLOSE", "bool", "", "false", "true", "true", Reset),
    ("ERR_SOCKET_CLOSED", "int", "", "1", "2", "", ReadOnly),
    // 9.1
    ("EXT_CTL_ACT_DI", "int", "", "0", "0", "0", Saved),
    ("SERVO_ON_DI", "int", "", "0", "62", "62", Saved),
    ("SERVO_OFF_DI", "int", "", "0", "62", "62", Saved),
    ("START_PROG_DI", "int", "", "0", "62", "62", Saved),
    ("PAUSE_PROG_DI", "int", "", "0", "62", "62", Saved),
    ("RESET_PROG_DI", "int", "", "0", "62", "62", Saved),
    ("CLEAR_ALARM_DI", "int", "", "0", "62", "62", Saved),
    ("PGNO_TYPE", "int", "", "0", "2", "2", Saved),
    ("PGNO_LENGTH", "int", "", "8", "16", "16", Saved),
    ("PGNO_FBIT_DI", "int", "", "0", "40", "40", Saved),
    ("PGNO_PARITY_DI", "int", "", "0", "-62", "-62", Saved),
    ("PGNO_VALID_DI", "int", "", "0", "62", "62", Saved),
    ("EXT_CTL_ACT_CONF_DO", "int", "", "0", "1", "1", Saved),
    ("SERVO_ON_DO", "int", "", "0", "2", "2", Saved),
    ("PGNO_REQ_DO", "int", "", "0", "3", "3", Saved),
    ("AT_HOME_DO", "int[5]", "[4]", "0", "4", "4", Saved),
    ("AT_T1_DO", "int", "", "0", "9", "9", Saved),
    ("AT_T2_DO", "int", "", "0", "10", "10", Saved),
    ("AT_AUT_DO", "int", "", "0", "11", "11", Saved),
    ("PGNO_ACK_FBIT_DO", "int", "", "0", "12", "12", Saved),
    ("CHAN_STATE_DO", "int", "", "0", "40", "40", Saved),
];

/// Statements that write what a variable does not take, and its name.
const BEYOND: &[(&str, &str)] = &[
    ("RESET_POS_THRESHOLD", "$RESET_POS_THRESHOLD[0] = 0.51"),
    ("RESET_POS_THRESHOLD", "$RESET_POS_THRESHOLD[99] = -0.01"),
    ("RESET_POS_THRESHOLD", "$RESET_POS_THRESHOLD = {0, 0.6}"),
    ("RESET_POS_THRESHOLD", "$RESET_POS_THRESHOLD[0] = pow(10, 400)"),
    ("RESET_POS_TYPE", "$RESET_POS_TYPE[0] = \"comand\""),
    ("RESET_POS_TYPE", "$RESET_POS_TYPE[99] = \"CMD\""),
    ("RESET_POS_TYPE", "$RESET_POS_TYPE = {\"cmd\", \"feed\"}"),
    ("RESET_POS_TYPE", "$RESET_POS_TYPE[1] += \" \""),
    ("PGNO_TYPE", "$PGNO_TYPE = 3"),
    ("PGNO_TYPE", "$PGNO_TYPE = -1"),
    ("PGNO_TYPE", "$PGNO_TYPE--"),
    ("PGNO_LENGTH", "$PGNO_LENGTH = 0"),
    ("PGNO_LENGTH", "$PGNO_LENGTH = $PGNO_LENGTH + 9"),
];

#[test]
fn the_catalog_says_what_the_table_says() {
    let mut rows: BTreeMap<&str, &Row> = TABLE.iter().map(|row| (row.0, row)).collect();
    for variable in system_variables() {
        let row = rows.remove(variable.name).unwrap_or_else(|| panic!("${} is not in the table", variable.name));
        let (name, ty, .., restored) = row;
        assert_eq!(variable.access == Access::ReadOnly, *restored == ReadOnly, "${name}");
        let sizes: String = variable.dims.iter().map(|size| format!("[{size}]")).collect();
        assert!(ty.ends_with(&sizes) && ty.contains('[') != sizes.is_empty(), "${name}: {ty} and {sizes}");
        let expected = match *restored {
            Reset => "Reset",
            Start => "Startup",
            Saved => "Saved",
            Never => "Permanent",
            // What is read-only is as the controller has it.
            ReadOnly => continue,
        };
        assert_eq!(format!("{:?}", variable.restore), expected, "${name}");
        let limited = BEYOND.iter().any(|(beyond, _)| beyond == name);
        assert_eq!(variable.takes != Takes::All, limited, "${name}");
    }
    assert!(rows.is_empty(), "{:?} are not in the catalog", rows.keys());
}

/// A program that tells all variables, writes them, and tells them again: by the inputs that are on, saves them (1),
/// does nothing but tell them (2), sets them back by `init` (3). In the loop running mode it ends with its second run.
fn program() -> String {
    let mut tell = String::from("func void tell(string when)\n");
    let (mut write, mut save) = (String::new(), String::new());
    for (name, _, part, _, value, _, restored) in TABLE {
        let _ = writeln!(tell, "    print when, \" {name} \", typeof(${name}), \" \", ${name}{part}");
        if *restored != ReadOnly {
            let _ = writeln!(write, "    ${name}{part} = {value}");
        }
        if *restored == Saved {
            let _ = writeln!(save, "        savesv(\"{name}\")");
        }
    }
    format!(
        "{tell}endfunc\nfunc void main()\n    $I[0] = $I[0] + 1\n    waittime 0.01\n    if(getdi(2) || $I[0] == 2)\n        \
         tell(\"later\")\n        exit\n    endif\n    tell(\"first\")\n{write}    tell(\"written\")\n    if(getdi(1))\n{save}    \
         endif\n    if(getdi(3))\n        init()\n        tell(\"init\")\n    endif\nendfunc\n"
    )
}

/// What was told at a time: the text behind the name of each variable.
fn reported_values<'a>(out: &'a str, when: &str) -> BTreeMap<&'a str, &'a str> {
    let lines = out.lines().filter_map(|line| line.strip_prefix(when)?.strip_prefix(' ')?.split_once(' '));
    lines.collect()
}

/// Compares what was told with what the table says; `written` says for which rows the written value is expected.
#[track_caller]
fn compare(out: &str, when: &str, written: impl Fn(Restored, &str) -> bool) {
    let reported = reported_values(out, when);
    let mut wrong = String::new();
    for (name, ty, _, default, _, value, restored) in TABLE {
        let value = if *restored != ReadOnly && written(*restored, name) { value } else { default };
        // The external control is not active any more, or a row of outputs is dark: only what was asked counts.
        let expected = format!("{ty} {value}");
        let found = reported.get(name).copied().unwrap_or("nothing");
        if found != expected {
            let _ = writeln!(wrong, "{when} ${name}: {found:?} instead of {expected:?}");
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

#[test]
fn variables_begin_are_written_and_are_restored_as_the_manual_says() {
    let folder = Folder::new("system_variables").with("all.arl", &program());
    for input in 1..=3 {
        folder.write(&format!("di{input}.toml"), &format!("[[event]]\nat = 0\ndi.{input} = true\n"));
    }
    let run = |options: &[&str]| {
        let answer = folder.arl2rs(&[&["run", "all.arl"], options].concat());
        assert_eq!(answer.code, Some(0), "{}", answer.err);
        answer.out
    };
    // At the reset of the loop running mode.
    let out = run(&["--loop", "--state-dir", "a"]);
    compare(&out, "first", |_, _| false);
    compare(&out, "written", |_, _| true);
    compare(&out, "later", |restored, _| restored != Reset);
    // When the controller starts again, without savesv and with it.
    compare(&run(&["--io", "di2.toml", "--state-dir", "a"]), "later", |restored, _| restored == Never);
    run(&["--io", "di1.toml", "--state-dir", "b"]);
    let out = run(&["--io", "di2.toml", "--state-dir", "b"]);
    compare(&out, "later", |restored, _| matches!(restored, Never | Saved));
    // `init`: 10.2 at its defaults, 10.1 (and the settings of chapter 9) as saved last, which is never. Names are saved
    // with every change.
    let out = run(&["--io", "di3.toml", "--state-dir", "c"]);
    compare(&out, "init", |_, name| name.ends_with("_NAME"));
}

#[test]
fn read_only_variables_are_refused_by_the_compiler() {
    let mut text = String::from("func void main()\n");
    let all: Vec<&Row> = TABLE.iter().filter(|row| row.6 == ReadOnly).collect();
    for (name, _, part, _, value, ..) in &all {
        let _ = writeln!(text, "    ${name}{part} = {value}");
    }
    let folder = Folder::new("system_read_only").with("a.arl", &(text + "endfunc\n"));
    let answer = folder.arl2rs(&["check", "a.arl", "--format", "json"]);
    assert_eq!(answer.code, Some(1));
    let lines: Vec<&str> = answer.out.lines().filter(|line| line.contains("\"severity\":\"error\"")).collect();
    assert_eq!(lines.len(), all.len(), "{}", answer.out);
    for (at, (line, row)) in lines.iter().zip(&all).enumerate() {
        assert!(line.contains(&format!("\"line\":{}", at + 2)) && line.contains(row.0), "{line}");
    }
}

#[test]
fn values_beyond_the_range_are_alarms() {
    let mut folder = Folder::new("system_beyond");
    for (at, (_, statement)) in BEYOND.iter().enumerate() {
        let text = format!("func void main()\n    {statement}\nendfunc\n");
        folder = folder.with(&format!("case{at}.arl"), &text).with(&format!("case{at}.alarm"), "20006 2\n");
    }
    let passed = format!("{} passed, 0 failed\n", BEYOND.len());
    folder.arl2rs(&["test", "."]).is(0, &passed);
}
