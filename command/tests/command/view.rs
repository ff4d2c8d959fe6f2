//! `view`: its page is shown to browsers in `runs/page/tests`; here is who is served, and what.

use super::Folder;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

const MOVES: &str = "func void main()\n  print \"go\"\n  movej j:{20,-80,90,0,30,0}\nendfunc\n";

/// A command that serves, ended with the test.
struct Serving(Child, String);

impl Serving {
    fn start(folder: &Folder, what: &[&str]) -> Self {
        let mut command = folder.command(&[&["view", "--no-open"], what].concat());
        let mut child = command.stdout(Stdio::piped()).stdin(Stdio::null()).spawn().expect("the command starts");
        let mut line = String::new();
        BufReader::new(child.stdout.take().expect("its output")).read_line(&mut line).expect("its address");
        let address = line.trim().strip_prefix("http://").and_then(|line| line.strip_suffix('/')).expect("an address");
        Self(child, address.to_owned())
    }

    /// The answer to a request with these headers besides.
    fn ask(&self, request: &str, headers: &str, body: &str) -> String {
        let mut stream = TcpStream::connect(&self.1).expect("it listens");
        let host = if headers.contains("Host:") { String::new() } else { format!("Host: {}\r\n", self.1) };
        let length = body.len();
        let text =
            format!("{request} HTTP/1.1\r\n{host}{headers}Connection: close\r\nContent-Length: {length}\r\n\r\n{body}");
        stream.write_all(text.as_bytes()).expect("it reads");
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer).expect("it answers");
        String::from_utf8_lossy(&answer).into_owned()
    }
}

impl Drop for Serving {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

#[test]
fn a_recording_is_served_to_its_own_page_only() {
    let folder = Folder::new("view").with("a.arl", MOVES);
    folder.arl2rs(&["run", "a.arl", "--record", "a.mcap"]).is(0, "go\n");
    let serving = Serving::start(&folder, &["a.mcap"]);
    let page = serving.ask("GET /", "", "");
    assert!(page.starts_with("HTTP/1.1 200") && page.contains("main.js") && page.contains("frame-ancestors"), "{page}");
    let run = serving.ask("GET /api/run/0", "", "");
    assert!(run.contains("\"text\":\"go\"") && run.contains("movej j:{20") && run.contains("kr10-r1420"), "{run}");
    for (request, headers) in [
        // Another page of the same browser, by its own name or by one that leads here.
        ("GET /api/run/0", "Origin: http://example.com\r\n"),
        ("GET /api/run/0", "Host: example.com\r\n"),
        ("GET /", "Host: localhost\r\n"),
        // Nobody who is not a page gives orders.
        ("POST /api/order", ""),
        ("POST /api/order", "Origin: null\r\n"),
    ] {
        let answer = serving.ask(request, headers, "");
        assert!(answer.starts_with("HTTP/1.1 403"), "{request} {headers}: {answer}");
    }
    for path in
        ["/../Cargo.toml", "/a.mcap", "/api/run/7", "/api/run/0/model/0", "/api/run/0/samples?channel=9", "/api"]
    {
        let answer = serving.ask(&format!("GET {path}"), "", "");
        assert!(answer.starts_with("HTTP/1.1 404"), "{path}: {answer}");
    }
    let own = format!("Origin: http://{}\r\n", serving.1);
    let answer = serving.ask("POST /api/order", &own, "pendant = \"start\"");
    assert!(answer.starts_with("HTTP/1.1 409") && answer.contains("recording"), "{answer}");
    let answer = serving.ask("DELETE /", "", "");
    assert!(answer.starts_with("HTTP/1.1 405"), "{answer}");
    // A second one on its port.
    let port = serving.1.rsplit(':').next().expect("a port");
    folder.arl2rs(&["view", "a.mcap", "--no-open", "--port", port]).is(2, "").says(&format!("port {port} is taken"));
}

#[test]
fn the_time_of_a_scenario_begins_with_the_start_button() {
    let program = "func void main()\n  waituntil getdi(1)\n  print \"seen\"\nendfunc\n";
    let scenario = "[[event]]\nat = 0.3\ndi.1 = true\n[[event]]\nat = 0.5\ndi.1 = false\n";
    let folder = Folder::new("view_scenario").with("a.arl", program).with("s.toml", scenario);
    let serving = Serving::start(&folder, &["a.arl", "--io", "s.toml"]);
    let own = format!("Origin: http://{}\r\n", serving.1);
    // Longer than the scenario takes.
    std::thread::sleep(Duration::from_millis(1500));
    for (order, times) in [("start", 1), ("reset", 2)] {
        let answer = serving.ask("POST /api/order", &own, &format!("pendant = \"{order}\""));
        assert!(answer.starts_with("HTTP/1.1 200"), "{answer}");
        let began = Instant::now();
        while serving.ask("GET /api/run/0", "", "").matches("\"text\":\"seen\"").count() < times {
            assert!(began.elapsed() < Duration::from_secs(60), "the program waits for ever");
            std::thread::sleep(Duration::from_millis(50));
        }
    }
}

#[test]
fn what_is_no_recording_is_refused() {
    let folder = Folder::new("view_wrong").with("a.mcap", "no recording").with("a.arl", MOVES);
    folder.arl2rs(&["view", "none.mcap"]).is(1, "").says("cannot read none.mcap");
    folder.arl2rs(&["view", "a.mcap"]).is(1, "").says("a.mcap is not a recording of a run");
    folder.arl2rs(&["view", "a.mcap", "a.arl"]).is(2, "").says("it can only be shown alone");
    folder.arl2rs(&["view", "a.mcap", "--robot", "scara"]).is(2, "").says("leave these options out");
    folder.arl2rs(&["view"]).is(2, "");
    folder
        .with("b.arl", "func void main()\n  movej 5\nendfunc\n")
        .arl2rs(&["view", "b.arl", "--no-open"])
        .is(1, "")
        .says("ARL");
}

#[test]
fn two_runs_are_compared_by_line() {
    let slow = "func void main()\n  movej j:{0,-90,90,0,30,0}, vp:50%\n  waittime 0.5\n  print \"there\"\nendfunc\n";
    let quick = slow.replace("0.5", "0.2").replace("there", "here");
    let folder = Folder::new("compare").with("a.arl", slow);
    folder.arl2rs(&["run", "a.arl", "--record", "a.mcap", "--report=a.json", "--format", "json"]).is(0, "there\n");
    // A recording and the report of the same run say the same.
    let same = folder.arl2rs(&["compare", "a.mcap", "a.json"]);
    assert_eq!(same.code, Some(0), "{}", same.out);
    assert!(same.out.starts_with("nothing differs: "), "{}", same.out);
    let folder = folder.with("a.arl", &quick);
    folder.arl2rs(&["run", "a.arl", "--report=b.json", "--format", "json"]).is(0, "here\n");
    let differs = folder.arl2rs(&["compare", "a.mcap", "b.json"]);
    assert_eq!(differs.code, Some(1));
    for part in ["-0.300 s", "message 1: `there` became `here`", "a.arl:3"] {
        assert!(differs.out.contains(part), "{part}: {}", differs.out);
    }
    assert!(!differs.out.contains("a.arl:2 "), "the motion is the same: {}", differs.out);
    let answer = folder.arl2rs(&["compare", "a.mcap", "b.json", "--format", "json"]);
    let answer: serde_json::Value = serde_json::from_str(&answer.out).expect("an object");
    assert_eq!(answer["lines"][0]["line"], 3);
    folder.arl2rs(&["compare", "a.json", "none.json"]).is(1, "").says("cannot read none.json");
    let folder = folder.with("wrong.json", "{\"version\":1}").with("wrong.mcap", "nothing");
    folder.arl2rs(&["compare", "a.json", "wrong.json"]).is(1, "").says("wrong.json is not a report of a whole run");
    folder.arl2rs(&["compare", "wrong.mcap", "a.json"]).is(1, "").says("wrong.mcap is not a recording of a run");
}

#[test]
fn a_report_has_other_forms() {
    let program = "func void main()\n  setdo(3, true)\n  movej j:{0,-90,90,0,30,0}, vp:50%\n  waittime 0\n  print \"<there>\"\nendfunc\n";
    let folder = Folder::new("report_forms").with("a.arl", program);
    folder.arl2rs(&["run", "a.arl", "--report=a.html", "--format", "html"]).is(0, "<there>\n");
    let page = folder.read("a.html");
    for part in ["a.arl:3", "movej", "do.3", "&lt;there&gt;", "kr10-r1420"] {
        assert!(page.contains(part), "{part}: {page}");
    }
    // Without a file it goes where the table goes.
    let answer = folder.arl2rs(&["run", "a.arl", "--report", "--format", "json"]);
    answer.is(0, "<there>\n").says("\"way\"");
    folder.arl2rs(&["run", "a.arl", "--report", "--format", "human"]).is(0, "<there>\n").says("cycle time");
    folder.arl2rs(&["run", "a.arl", "--format", "json"]).is(2, "");
    folder.arl2rs(&["run", "a.arl", "--report=no/a.json", "--format", "json"]).is(2, "").says("cannot write no/a.json");
    folder.arl2rs(&["run", "a.arl", "--robot", "none", "--report=c.json", "--format", "json"]).is(2, "");
    assert!(!folder.has("c.json"));
    // The plot shows what changes.
    folder.arl2rs(&["run", "a.arl", "--plot", "a.svg"]).is(0, "<there>\n");
    assert!(folder.read("a.svg").contains("do.3"));
}
