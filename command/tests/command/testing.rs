//! `test`.

use super::{Answer, Folder};
use std::process::Stdio;

#[test]
fn cases_pass_or_show_what_differs() {
    let print = |what: &str| format!("func void main()\n    print {what}\nendfunc\n");
    let folder = Folder::new("test")
        .with("good/out.arl", &print("1 + 1"))
        .with("good/out.out", "2\n")
        .with("good/error.arl", &print("1 + true"))
        .with("good/error.err", "2 bool\n")
        .with("good/alarm.arl", "func void main()\n    int a = 0\n    print 1\n    a = 1 / a\nendfunc\n")
        .with("good/alarm.alarm", "20001 4\n")
        .with("good/alarm.out", "1\n")
        .with("good/io.arl", "func void main()\n    waituntil getdi(3)\n    print \"on\"\nendfunc\n")
        .with("good/io.out", "on\n")
        .with("good/io.io.toml", "[[event]]\nat = 1.0\ndi.3 = true\n")
        .with("good/points.arl", &print("count"))
        .with("good/points_data.arl", "int count = 5\n")
        .with("good/points.out", "5\n")
        .with("good/late.arl", "func void main()\n    waittime 100\nendfunc\n")
        .with("good/late.out", "")
        .with("good/late.toml", "max_time = 1\n")
        .with("bad/out.arl", &print("1 + 1"))
        .with("bad/out.out", "3\n")
        .with("bad/error.arl", &print("1 + true"))
        .with("bad/error.err", "3\n")
        .with("bad/refused.arl", &print("1 + true"))
        .with("bad/refused.out", "2\n")
        .with("bad/alarm.arl", &print("1"))
        .with("bad/alarm.alarm", "* 2\n")
        .with("bad/nothing.arl", &print("1"))
        .with("bad/nothing.toml", "")
        .with("empty/module.arl", "func void f()\nendfunc\n");

    let good = folder.arl2rs(&["test", "good"]);
    assert_eq!(good.is(0, "6 passed, 0 failed\n").err, "");

    let both = folder.arl2rs(&["test", "good", "bad"]);
    assert_eq!(both.code, Some(1));
    assert_eq!(both.out.lines().last(), Some("6 passed, 5 failed"), "{}", both.out);
    let parts = [
        "FAILED bad/alarm.arl\n  an alarm was expected, but it ended",
        "FAILED bad/error.arl\n  the errors differ (- expected, + actual):\n  -3\n  +2 ",
        "FAILED bad/nothing.arl\n  it has no expected results",
        "FAILED bad/out.arl\n  the output differs (- expected, + actual):\n  -3\n  +2\n",
        "FAILED bad/refused.arl\n  it does not compile:\n  error[ARL",
    ];
    for part in parts {
        assert!(both.out.contains(part), "`{part}` is not in: {}", both.out);
    }

    folder.arl2rs(&["test", "good", "empty"]).is(2, "").says("empty has no case");
    folder.arl2rs(&["test", "nowhere"]).is(2, "").says("nowhere");
}

const COUNTS: &str = "func int half(int n)\n  if(n < 0)\n    return -1\n  endif\n  return n / 2\nendfunc\n\
                      func void main()\n  for(int i=0;i<3;i++)\n    print half(i)\n  endfor\nendfunc\n";

#[test]
fn results_are_reported_in_the_form_that_is_asked_for() {
    let folder = Folder::new("test_formats")
        .with("good.arl", "func void main()\n  waittime 0.5\n  print 1\nendfunc\n")
        .with("good.out", "1\n")
        .with("bad.arl", "func void main()\n  print 2\nendfunc\n")
        .with("bad.out", "<3>\n");
    let answer = folder.arl2rs(&["test", ".", "--format", "jsonl"]);
    assert_eq!(answer.code, Some(1));
    let lines: Vec<serde_json::Value> =
        answer.out.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    let [bad, good] = lines.as_slice() else { panic!("two cases: {}", answer.out) };
    assert_eq!((&bad["name"], &bad["outcome"]), (&"bad.arl".into(), &"failed".into()));
    assert!(bad["detail"].as_str().is_some_and(|detail| detail.contains("-<3>\n+2")), "{bad}");
    assert_eq!((&good["outcome"], &good["detail"]), (&"passed".into(), &serde_json::Value::Null));
    assert!(good["seconds"].as_f64() > Some(0.0) && good["cycle_time"].as_f64() >= Some(0.5), "{good}");
    let answer = folder.arl2rs(&["test", ".", "--format", "junit"]);
    assert!(
        answer.code == Some(1) && answer.out.contains("tests=\"2\" failures=\"1\"") && answer.out.contains("&lt;3&gt;")
    );
    // Parts are disjoint, and together all.
    folder.arl2rs(&["test", ".", "--shard", "2/2"]).is(0, "1 passed, 0 failed\n");
    let first = folder.arl2rs(&["test", ".", "--shard", "1/2"]);
    assert!(first.code == Some(1) && first.out.ends_with("0 passed, 1 failed\n"), "{first:?}");
    folder.arl2rs(&["test", ".", "--shard", "3/2"]).is(2, "").says("like 2/4");
}

#[test]
fn what_came_becomes_what_is_expected() {
    let folder = Folder::new("test_bless")
        .with("new.arl", "func void main()\n  print getdi(1)\nendfunc\n")
        .with("new.io.toml", "[[event]]\nat = 0\ndi.1 = true\n")
        .with("alarms.arl", "func void main()\n  int a = 0\n  print 1\n  print 2 / a\nendfunc\n")
        .with("alarms.out", "2\n")
        .with("wrong.arl", "func void main()\n  int a = \"x\"\n  print a\nendfunc\n")
        .with("wrong.err", "7 nothing\n")
        .with("endless.arl", "func void main()\n  loop\n    waittime 1\n  endloop\nendfunc\n")
        .with("endless.out", "\n");
    let blessed = folder.arl2rs(&["test", ".", "--bless"]);
    assert!(blessed.code == Some(1) && blessed.out.ends_with("3 passed, 1 failed\n"), "{blessed:?}");
    assert!(blessed.out.contains("endless.arl") && blessed.out.contains("nothing was blessed"), "{blessed:?}");
    assert_eq!(folder.read("new.out"), "true\n");
    assert_eq!((folder.read("alarms.out"), folder.read("alarms.alarm")), ("1\n".into(), "20001 4\n".into()));
    assert!(folder.read("wrong.err").starts_with("2 `a` must be of type int"), "{}", folder.read("wrong.err"));
    assert_eq!(folder.read("endless.out"), "\n");
    folder.write("endless.toml", "max_time = 2\n");
    folder.arl2rs(&["test", ".", "--bless"]).is(0, "4 passed, 0 failed\n");
    folder.arl2rs(&["test", "."]).is(0, "4 passed, 0 failed\n");
    // An alarm that is gone is expected no more.
    folder.write("alarms.arl", "func void main()\n  print 1\nendfunc\n");
    folder.arl2rs(&["test", ".", "--bless"]).is(0, "4 passed, 0 failed\n");
    assert!(!folder.has("alarms.alarm"));
}

#[test]
fn coverage_counts_lines_and_functions() {
    let folder = Folder::new("test_coverage")
        .with("counts.arl", COUNTS)
        .with("counts.out", "0\n0\n1\n")
        .with("uses.arl", "import \"lib/other.arl\"\nfunc void main()\n  other::go()\nendfunc\n")
        .with("uses.out", "went\n")
        .with("lib/other.arl", "func void go()\n  print \"went\"\nendfunc\nfunc void never()\n  print 1\nendfunc\n")
        .with("twice.arl", TWICE)
        .with("twice.out", "1\n2\n");
    folder.arl2rs(&["test", ".", "--coverage", "lcov.info"]).is(0, "3 passed, 0 failed\n");
    let lcov = folder.read("lcov.info");
    let records: Vec<&str> = lcov.split("end_of_record\n").map(str::trim).filter(|one| !one.is_empty()).collect();
    assert_eq!(records.len(), 4, "{lcov}");
    assert!(records[0].contains("SF:counts.arl\n"), "{lcov}");
    for line in ["FNDA:3,half", "FNDA:1,main", "DA:2,3", "DA:3,0", "DA:5,3", "DA:9,3", "FNH:2"] {
        assert!(records[0].lines().any(|found| found == line), "{line}\n{lcov}");
    }
    let other = records.iter().find(|one| one.contains("SF:lib/other.arl\n")).expect("the module");
    assert!(other.contains("FNDA:0,never") && other.contains("DA:2,1") && other.contains("DA:5,0"), "{other}");
    let twice = records.iter().find(|one| one.contains("SF:twice.arl\n")).expect("what begins again");
    assert!(twice.contains("FNDA:2,main") && twice.contains("FNDA:2,shown"), "{twice}");
}

/// A program that begins again.
const TWICE: &str = "func void shown(int n)
  print n
endfunc
func void main()
  $I[0]++
  shown($I[0])
  if($I[0] < 2) restart
endfunc
";

#[test]
fn mistakes_are_those_that_the_cell_makes() {
    let folder = Folder::new("test_cell")
        .with("part.arl", "func void main()\n  print getdi(part)\nendfunc\n")
        .with("part.err", "2 that is the cell's name for di.1\n")
        .with("part.toml", "cell = \"line.cell\"\n")
        .with("line.cell", "[names]\n\"di.1\" = \"part\"\n");
    folder.arl2rs(&["test", "."]).is(0, "1 passed, 0 failed\n");
}

#[test]
fn a_project_says_whether_its_cases_are_compiled() {
    let print = "func void main()\n    print 1\nendfunc\n";
    let folder = Folder::new("test_engine")
        .with("native/arl.toml", "engine = \"native\"\n")
        .with("native/a.arl", print)
        .with("native/a.out", "1\n")
        .with("other/b.arl", print)
        .with("other/b.out", "2\n");
    let without_cargo = |arguments: &[&str]| {
        let command = folder.command(arguments).env("CARGO", "/nowhere/cargo").output();
        Answer::of(command.expect("the command starts"))
    };
    without_cargo(&["test", "native"]).is(1, "").says("cargo was not found");
    without_cargo(&["test", "native", "--engine", "engine"]).is(0, "1 passed, 0 failed\n");
    let both = folder.arl2rs(&["test", "."]);
    assert!(both.out.starts_with("FAILED other/b.arl\n") && both.out.ends_with("1 passed, 1 failed\n"), "{}", both.out);
}

/// A case ends with the command, however that ends.
#[test]
fn a_case_does_not_outlive_the_command() {
    ends_with_the_command("engine");
}

#[test]
fn a_compiled_case_does_not_outlive_the_command() {
    ends_with_the_command("native");
}

fn ends_with_the_command(engine: &str) {
    use std::io::Read;
    let listener = std::net::TcpListener::bind("127.0.0.1:0").expect("a port");
    let port = listener.local_addr().expect("its address").port();
    let endless = format!(
        "socket peer\nfunc void main()\n  waituntil connect(peer, \"127.0.0.1\", {port})\n  loop\n    \
         waittime 0.1\n  endloop\nendfunc\n"
    );
    let folder = Folder::new(&format!("outlives_{engine}")).with("a.arl", &endless).with("a.out", "");
    let mut command = folder.command(&["test", ".", "--engine", engine]);
    let mut testing = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("the command starts");
    listener.set_nonblocking(true).expect("a listener that does not wait");
    let connected = (0..10_000).find_map(|_| {
        std::thread::sleep(std::time::Duration::from_millis(50));
        listener.accept().ok()
    });
    let (mut peer, _) = connected.expect("the case connects");
    peer.set_nonblocking(false).expect("a peer that waits");
    testing.kill().expect("it is killed");
    testing.wait().expect("it has ended");
    peer.set_read_timeout(Some(std::time::Duration::from_secs(50))).expect("a limit");
    // Closed in peace or not: who still ran would hold it open.
    let read = peer.read(&mut [0; 16]);
    let is_closed = match &read {
        Ok(count) => *count == 0,
        Err(error) => !matches!(error.kind(), std::io::ErrorKind::WouldBlock | std::io::ErrorKind::TimedOut),
    };
    assert!(is_closed, "the case goes on: {read:?}");
}

#[test]
fn what_only_the_engine_does_is_not_asked_of_compiled_programs() {
    let folder =
        Folder::new("test_watched").with("a.arl", "func void main()\n  print 1\nendfunc\n").with("a.out", "1\n");
    let refused = folder.arl2rs(&["test", ".", "--coverage", "c.info", "--engine", "native"]);
    refused.is(2, "").says("--coverage: only the engine stops at statements; leave out --engine native");
    let refused = folder.arl2rs(&["test", ".", "--debug", "--all-forms"]);
    refused.is(2, "").says("--debug: only the engine stops at statements; leave out --all-forms");
    folder.arl2rs(&["test", ".", "--coverage", "c.info"]).is(0, "1 passed, 0 failed\n");
}
