//! `run --record`: what is in the recording is read by other people's readers in `tests/peers`.

use super::Folder;
use std::process::Stdio;

const MOVES: &str = "func void main()\n  print \"go\"\n  movej j:{0,-90,90,0,30,0}\n  movej j:{20,-80,90,0,30,0}\n  waittime 0\n  print \"there\"\nendfunc\n";

/// What a file of this container begins and ends with.
const MAGIC: &[u8] = b"\x89MCAP0\r\n";

fn is_whole(folder: &Folder, name: &str) -> bool {
    let bytes = std::fs::read(folder.path.join(name)).expect("the recording");
    bytes.starts_with(MAGIC) && bytes.ends_with(MAGIC)
}

#[test]
fn a_run_is_recorded_and_says_what_it_says() {
    let folder = Folder::new("recording").with("a.arl", MOVES);
    let plain = folder.arl2rs(&["run", "a.arl", "--trace", "plain.csv"]);
    plain.is(0, "go\nthere\n");
    folder.arl2rs(&["run", "a.arl", "--record", "a.mcap", "--trace", "a.csv"]).is(0, "go\nthere\n");
    assert!(is_whole(&folder, "a.mcap"));
    assert_eq!(folder.read("plain.csv"), folder.read("a.csv"), "a recorder changes nothing");
    let description = folder.read("cell.urdf");
    assert!(description.contains("<link name=\"link_6\">") && description.contains("kr10-r1420"), "{description}");
    // The same run gives the same file, to the bit, with a plot beside it, too.
    folder.arl2rs(&["run", "a.arl", "--record", "b.mcap", "--plot", "b.svg"]).is(0, "go\nthere\n");
    let read = |name: &str| std::fs::read(folder.path.join(name)).expect("the recording");
    assert_eq!(read("a.mcap"), read("b.mcap"));
    assert!(folder.has("b.svg"));
}

#[test]
fn whatever_ends_a_run_its_recording_is_whole() {
    let alarm = "func void main()\n  int a = 0\n  movej j:{0,-90,90,0,30,0}\n  waittime 0\n  print 2 / a\nendfunc\n";
    let endless = "func void main()\n  loop\n    waittime 1\n  endloop\nendfunc\n";
    let folder = Folder::new("recording_ends").with("alarm.arl", alarm).with("endless.arl", endless);
    folder.arl2rs(&["run", "alarm.arl", "--record", "alarm.mcap"]).is(3, "").says("alarm 20001");
    folder.arl2rs(&["run", "endless.arl", "--record", "endless.mcap", "--max-time", "2"]).is(4, "");
    assert!(is_whole(&folder, "alarm.mcap") && is_whole(&folder, "endless.mcap"));
    // What does not begin is not recorded.
    folder.arl2rs(&["run", "alarm.arl", "--record", "none.mcap", "--robot", "none"]).is(2, "");
    assert!(!folder.has("none.mcap"));
    folder.arl2rs(&["run", "alarm.arl", "--record", "none.mcap", "--io", "none.toml"]).is(2, "");
    assert!(!folder.has("none.mcap"));
    folder.arl2rs(&["run", "alarm.arl", "--record", "no/folder.mcap"]).is(2, "").says("cannot write no/folder.mcap");
}

#[test]
fn a_description_of_the_users_stays() {
    let folder = Folder::new("recording_beside").with("a.arl", MOVES).with("cell.urdf", "<robot name=\"mine\"/>\n");
    let answer = folder.arl2rs(&["run", "a.arl", "--record", "a.mcap"]);
    answer.is(0, "go\nthere\n").says("cell.urdf is not of a recording: it stays");
    assert!(is_whole(&folder, "a.mcap"));
    assert_eq!(folder.read("cell.urdf"), "<robot name=\"mine\"/>\n");
}

#[cfg(unix)]
#[test]
fn a_program_goes_on_where_its_recording_cannot_be_written() {
    if !std::path::Path::new("/dev/full").exists() {
        return;
    }
    let folder = Folder::new("recording_full").with("a.arl", MOVES);
    std::os::unix::fs::symlink("/dev/full", folder.path.join("full.mcap")).expect("a link");
    let mut command = folder.command(&["run", "a.arl", "--record", "full.mcap"]);
    let answer = command.stdin(Stdio::null()).output().expect("the command starts");
    let stderr = String::from_utf8_lossy(&answer.stderr);
    assert_eq!((answer.status.code(), &*answer.stdout), (Some(0), &b"go\nthere\n"[..]), "{stderr}");
    assert!(stderr.contains("the recording full.mcap is incomplete"), "{stderr}");
}

#[cfg(unix)]
#[test]
fn a_program_ends_when_who_records_it_is_killed() {
    use std::io::Read;
    let endless = "func void main()\n  loop\n    print \"round\"\n    waittime 0.01\n  endloop\nendfunc\n";
    let folder = Folder::new("recording_killed").with("a.arl", endless);
    folder.arl2rs(&["run", "a.arl", "--max-time", "0.1"]);
    let mut command = folder.command(&["run", "a.arl", "--record", "a.mcap"]);
    let mut recorder = command.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().expect("the command starts");
    // The program holds the other end, too.
    let mut out = recorder.stdout.take().expect("its output");
    let mut bytes = vec![0; 1 << 16];
    out.read_exact(&mut bytes[..100]).expect("it runs");
    recorder.kill().expect("it is killed");
    recorder.wait().expect("it has ended");
    let mut remaining = 0;
    loop {
        let count = out.read(&mut bytes).expect("the rest");
        if count == 0 {
            break;
        }
        remaining += count;
        assert!(remaining < 500_000_000, "it goes on");
    }
}

/// What a script of the peers says of a recording; nothing where the modules that it needs are not installed, and
/// nobody requires them.
fn read_by(script: &str, modules: &str, recording: &std::path::Path) -> Option<serde_json::Value> {
    let python = std::env::var_os("ARL_PEERS_PYTHON").unwrap_or_else(|| "python3".into());
    let import = std::process::Command::new(&python).args(["-c", &format!("import {modules}")]).output();
    if !import.is_ok_and(|import| import.status.success()) {
        assert!(std::env::var("ARL_PEERS").as_deref() != Ok("required"), "Python with {modules} is not installed");
        eprintln!("skipped: Python with {modules} is not installed");
        return None;
    }
    let script = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/peers/scripts").join(script);
    let answer = std::process::Command::new(&python).arg(script).arg(recording).output().expect("python runs");
    assert!(answer.status.success(), "{}", String::from_utf8_lossy(&answer.stderr));
    Some(serde_json::from_slice(&answer.stdout).expect("a line of JSON"))
}

#[test]
fn peers_read_recordings() {
    let program = "func void main()\n  print \"go\"\n  movej j:{0,-90,90,0,30,0}\n  movej j:{20,-80,80,10,30,5}\n  waittime 0\n\
                   \x20 pose p = cpose($FLANGE,$WORLD)\n  p.z = p.z - 50\n  lin p,vl:200\n  waittime 0.1\n  int none = 0\n  print 1 / none\nendfunc\n";
    let folder = Folder::new("recording_peers").with("a.arl", program);
    folder.arl2rs(&["run", "a.arl", "--record", "a.mcap"]).is(3, "go\n");
    let recording = folder.path.join("a.mcap");
    let modules = "mcap, mcap_protobuf, foxglove_schemas_protobuf";
    let moving = ["link_1", "link_2", "link_3", "link_4", "link_5", "link_6", "tcp"];
    if let Some(read) = read_by("read_recording.py", modules, &recording) {
        assert_eq!(read["counts"], read["counted"], "the summary counts what is there");
        assert_eq!(read["moving"], serde_json::json!(moving));
        assert_eq!(read["texts"], serde_json::json!(["go"]));
        assert!(read["alarms"][0].as_str().is_some_and(|alarm| alarm.contains("alarm 20001")), "{read}");
        let kinds: Vec<_> = read["motions"].as_array().expect("motions").iter().map(|motion| &motion[1]).collect();
        assert_eq!(kinds, ["movej", "movej", "lin"]);
        assert_eq!(read["lines"], serde_json::json!([3, 4, 8]));
    }
    if let Some(read) = read_by("rerun_frames.py", "rerun", &recording) {
        assert_eq!(read["moving"], serde_json::json!(moving));
        assert_eq!(read["texts"], 2);
    }
}
