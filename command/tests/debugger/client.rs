//! A client of the debug adapter, and a folder with programs for it.

use crate::messages::{messages, send};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::Receiver;
use std::time::Duration;

/// How long a message may take: a program may have to be compiled, with the runtime.
const LONGEST: Duration = Duration::from_secs(240);

/// A folder for one test.
pub(crate) struct Folder(pub(crate) PathBuf);

impl Folder {
    pub(crate) fn new(name: &str) -> Self {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("debugger").join(name);
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).expect("a folder");
        Self(path)
    }

    pub(crate) fn with(self, name: &str, text: &str) -> Self {
        std::fs::write(self.0.join(name), text).expect("a file");
        self
    }

    pub(crate) fn path(&self, name: &str) -> String {
        self.0.join(name).display().to_string()
    }
}

/// A client that knows one adapter.
pub(crate) struct Client {
    child: Child,
    input: Option<ChildStdin>,
    output: Receiver<Value>,
    sent: i64,
    /// Events that nobody has asked for yet.
    events: Vec<Value>,
    /// What the program printed.
    pub(crate) printed: String,
    /// Everything else that was shown.
    pub(crate) other_output: String,
}

impl Client {
    pub(crate) fn new() -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_arl2rs"))
            .arg("dap")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("the command starts");
        let input = child.stdin.take();
        let output = messages(child.stdout.take().expect("its output"));
        let mut client = Self {
            child,
            input,
            output,
            sent: 0,
            events: Vec::new(),
            printed: String::new(),
            other_output: String::new(),
        };
        client.ask("initialize", json!({"adapterID": "arl"}));
        client
    }

    /// A program that is launched, with breakpoints on these lines; it runs.
    pub(crate) fn running(folder: &Folder, more: Value, lines: &[u32]) -> Self {
        let mut client = Self::new();
        let mut launch = json!({"program": folder.path("main.arl"), "cwd": folder.0});
        for (key, value) in more.as_object().expect("an object") {
            launch[key] = value.clone();
        }
        client.ask("launch", launch);
        client.event("initialized");
        let breakpoints: Vec<Value> = lines.iter().map(|line| json!({"line": line})).collect();
        client.set_breakpoints(folder, "main.arl", json!(breakpoints));
        client.ask("configurationDone", json!({}));
        client
    }

    pub(crate) fn set_breakpoints(&mut self, folder: &Folder, name: &str, breakpoints: Value) -> Value {
        let source = json!({"path": folder.path(name)});
        self.ask("setBreakpoints", json!({"source": source, "breakpoints": breakpoints}))["breakpoints"].clone()
    }

    fn send(&mut self, command: &str, arguments: Value) -> i64 {
        self.sent += 1;
        let message = json!({"seq": self.sent, "type": "request", "command": command, "arguments": arguments});
        send(self.input.as_mut().expect("it is open"), &message.to_string());
        self.sent
    }

    fn next(&mut self) -> Value {
        let message = self.output.recv_timeout(LONGEST).expect("the adapter says something");
        if message["event"] == "output" {
            let text = message["body"]["output"].as_str().expect("a text");
            if message["body"]["category"] == "stdout" { &mut self.printed } else { &mut self.other_output }
                .push_str(text);
        }
        message
    }

    /// The answer to a request, whatever it is.
    pub(crate) fn answer(&mut self, command: &str, arguments: Value) -> Value {
        let number = self.send(command, arguments);
        loop {
            let message = self.next();
            if message["type"] == "response" && message["request_seq"] == number {
                return message;
            }
            self.events.push(message);
        }
    }

    /// What a request gives.
    pub(crate) fn ask(&mut self, command: &str, arguments: Value) -> Value {
        let answer = self.answer(command, arguments);
        assert_eq!(answer["success"], true, "{command}: {answer}\n{}", self.other_output);
        answer["body"].clone()
    }

    /// What a request is refused with.
    pub(crate) fn refused(&mut self, command: &str, arguments: Value) -> String {
        let answer = self.answer(command, arguments);
        assert_eq!(answer["success"], false, "{answer}");
        answer["message"].as_str().expect("a text").to_owned()
    }

    /// The next event of a kind.
    pub(crate) fn event(&mut self, event: &str) -> Value {
        if let Some(at) = self.events.iter().position(|known| known["event"] == event) {
            return self.events.remove(at)["body"].clone();
        }
        loop {
            let message = self.next();
            if message["event"] == event {
                return message["body"].clone();
            }
            self.events.push(message);
        }
    }

    /// Waits until the program halts: why, and the functions that run, the innermost first, with their lines.
    pub(crate) fn halt(&mut self) -> (String, Vec<String>) {
        let stopped = self.event("stopped");
        let thread = stopped["threadId"].clone();
        (stopped["reason"].as_str().expect("a reason").to_owned(), self.stack(&thread))
    }

    pub(crate) fn stack(&mut self, thread: &Value) -> Vec<String> {
        let frames = self.ask("stackTrace", json!({"threadId": thread}))["stackFrames"].clone();
        let shown = |frame: &Value| format!("{} {}", frame["name"].as_str().expect("a name"), frame["line"]);
        frames.as_array().expect("frames").iter().map(shown).collect()
    }

    /// Lets the program go on, and waits until it halts.
    pub(crate) fn go(&mut self, command: &str) -> (String, Vec<String>) {
        self.ask(command, json!({"threadId": 1}));
        self.halt()
    }

    /// An expression's value, seen from the innermost function, in the console.
    pub(crate) fn value(&mut self, expression: &str) -> String {
        self.value_in("repl", expression)
    }

    pub(crate) fn value_in(&mut self, context: &str, expression: &str) -> String {
        let frame = self.frame();
        let answer = self.answer("evaluate", json!({"expression": expression, "frameId": frame, "context": context}));
        let text = if answer["success"] == true { &answer["body"]["result"] } else { &answer["message"] };
        text.as_str().expect("a text").to_owned()
    }

    pub(crate) fn frame(&mut self) -> Value {
        self.ask("stackTrace", json!({"threadId": 1}))["stackFrames"][0]["id"].clone()
    }

    /// The variables of a scope: `name = value`.
    pub(crate) fn scope(&mut self, name: &str) -> (Value, Vec<String>) {
        let frame = self.frame();
        let scopes = self.ask("scopes", json!({"frameId": frame}))["scopes"].clone();
        let scopes = scopes.as_array().expect("scopes");
        let found = scopes.iter().find(|scope| scope["name"] == name).expect("the scope");
        let reference = found["variablesReference"].clone();
        (reference.clone(), self.parts(&reference))
    }

    pub(crate) fn parts(&mut self, reference: &Value) -> Vec<String> {
        let all = self.ask("variables", json!({"variablesReference": reference}))["variables"].clone();
        let text = |value: &Value| value.as_str().expect("a text").to_owned();
        let shown = |one: &Value| format!("{} = {}", text(&one["name"]), text(&one["value"]));
        all.as_array().expect("variables").iter().map(shown).collect()
    }

    /// Lets the program go on to its end, without breakpoints in a file: what it printed, and its exit code.
    pub(crate) fn run_out(&mut self, folder: &Folder) -> (String, Value) {
        self.set_breakpoints(folder, "main.arl", json!([]));
        self.ask("continue", json!({"threadId": 1}));
        self.ended()
    }

    /// Waits for the end: what the program printed, and its exit code.
    pub(crate) fn ended(&mut self) -> (String, Value) {
        let code = self.event("exited")["exitCode"].clone();
        self.event("terminated");
        (self.printed.clone(), code)
    }
}

impl Drop for Client {
    fn drop(&mut self) {
        // An adapter whose editor is gone ends by itself, and takes along what it has made.
        self.input = None;
        for _ in 0..100 {
            if let Ok(Some(_)) = self.child.try_wait() {
                return;
            }
            std::thread::sleep(Duration::from_millis(50));
        }
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
