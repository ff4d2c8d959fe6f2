//! A client of the server, and a folder with programs for it.

use crate::messages::{messages, send};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::Receiver;
use std::time::Duration;

/// A folder for one test.
pub(crate) struct Folder {
    pub(crate) path: PathBuf,
}

impl Folder {
    pub(crate) fn new(name: &str) -> Self {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("server").join(name);
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).expect("a folder");
        Self { path }
    }

    pub(crate) fn with(self, name: &str, text: impl AsRef<[u8]>) -> Self {
        std::fs::write(self.path.join(name), text).expect("a file");
        self
    }

    pub(crate) fn uri(&self, name: &str) -> String {
        format!("file://{}", self.path.join(name).display())
    }
}

/// A client that knows one server.
pub(crate) struct Client {
    child: Child,
    input: Option<ChildStdin>,
    output: Receiver<Value>,
    last: i64,
    versions: BTreeMap<String, i64>,
    /// The last diagnostics of each file.
    published: BTreeMap<String, Value>,
    /// What the server answered to `initialize`.
    pub(crate) offered: Value,
    /// Messages to the user.
    pub(crate) shown: Vec<String>,
}

impl Client {
    /// A client that has said hello, with a folder.
    pub(crate) fn new(folder: &Folder) -> Self {
        let markdown = json!({
            "hover": {"contentFormat": ["markdown"]},
            "completion": {"completionItem": {"documentationFormat": ["markdown"]}},
            "signatureHelp": {"signatureInformation": {"documentationFormat": ["markdown"]}},
        });
        Self::with(folder, json!(null), json!({"textDocument": markdown}))
    }

    /// A client with settings and capabilities of its own.
    pub(crate) fn with(folder: &Folder, settings: Value, capabilities: Value) -> Self {
        let mut client = Self::silent();
        let uri = format!("file://{}", folder.path.display());
        let folders = json!([{"uri": uri, "name": "cell"}]);
        client.offered = client.ask(
            "initialize",
            json!({
                "processId": null,
                "rootUri": uri,
                "workspaceFolders": folders,
                "capabilities": capabilities,
                "initializationOptions": settings,
            }),
        );
        client.tell("initialized", json!({}));
        client
    }

    /// A client that has said nothing.
    pub(crate) fn silent() -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_arl2rs"))
            .arg("lsp")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("the server starts");
        let input = child.stdin.take();
        let output = messages(child.stdout.take().expect("its output"));
        let (versions, published) = (BTreeMap::new(), BTreeMap::new());
        Self { child, input, output, last: 0, versions, published, offered: Value::Null, shown: Vec::new() }
    }

    pub(crate) fn send_text(&mut self, body: &str) {
        send(self.input.as_mut().expect("the input is open"), body);
    }

    /// Sends bytes as they are.
    pub(crate) fn send_raw(&mut self, bytes: &str) {
        let input = self.input.as_mut().expect("the input is open");
        input.write_all(bytes.as_bytes()).and_then(|()| input.flush()).expect("the server reads");
    }

    pub(crate) fn tell(&mut self, method: &str, params: Value) {
        self.send_text(&json!({"jsonrpc": "2.0", "method": method, "params": params}).to_string());
    }

    /// Sends a request; gives its number.
    pub(crate) fn request(&mut self, method: &str, params: Value) -> i64 {
        self.last += 1;
        self.send_text(&json!({"jsonrpc": "2.0", "id": self.last, "method": method, "params": params}).to_string());
        self.last
    }

    /// The whole answer to a request.
    pub(crate) fn answer(&mut self, id: i64) -> Value {
        loop {
            let message = self.message().expect("the server answers");
            if message["id"] == id && message["method"].is_null() {
                return message;
            }
        }
    }

    /// The result of a request; an error ends the test.
    pub(crate) fn ask(&mut self, method: &str, params: Value) -> Value {
        let id = self.request(method, params);
        let answer = self.answer(id);
        assert!(answer["error"].is_null(), "{method}: {answer}");
        answer["result"].clone()
    }

    /// The words of the error that a request ends with.
    pub(crate) fn refused(&mut self, method: &str, params: Value) -> String {
        let id = self.request(method, params);
        let answer = self.answer(id);
        answer["error"]["message"].as_str().unwrap_or_else(|| panic!("{method} was not refused: {answer}")).to_string()
    }

    /// The next message; diagnostics are kept on the way.
    pub(crate) fn message(&mut self) -> Option<Value> {
        // A server that says nothing for so long hangs.
        let message = match self.output.recv_timeout(Duration::from_secs(30)) {
            Ok(message) => message,
            Err(std::sync::mpsc::RecvTimeoutError::Disconnected) => return None,
            Err(std::sync::mpsc::RecvTimeoutError::Timeout) => panic!("the server says nothing any more"),
        };
        match message["method"].as_str() {
            Some("textDocument/publishDiagnostics") => {
                let uri = message["params"]["uri"].as_str().expect("an address").to_string();
                self.published.insert(uri, message["params"].clone());
            }
            Some("window/showMessage") => {
                self.shown.push(message["params"]["message"].as_str().expect("a text").to_string());
            }
            _ => {}
        }
        Some(message)
    }

    /// Opens a file with a text, or changes it to that text.
    pub(crate) fn set(&mut self, uri: &str, text: &str) {
        let version = self.versions.get(uri).map_or(1, |version| version + 1);
        self.versions.insert(uri.to_string(), version);
        if version == 1 {
            let item = json!({"uri": uri, "languageId": "arl", "version": version, "text": text});
            self.tell("textDocument/didOpen", json!({"textDocument": item}));
        } else {
            let document = json!({"uri": uri, "version": version});
            self.tell("textDocument/didChange", json!({"textDocument": document, "contentChanges": [{"text": text}]}));
        }
    }

    /// Changes a part of a file.
    pub(crate) fn edit(&mut self, uri: &str, changes: Value) {
        let version = self.versions[uri] + 1;
        self.versions.insert(uri.to_string(), version);
        let document = json!({"uri": uri, "version": version});
        self.tell("textDocument/didChange", json!({"textDocument": document, "contentChanges": changes}));
    }

    /// The diagnostics of a file that are told next.
    pub(crate) fn next_diagnostics(&mut self, uri: &str) -> Value {
        loop {
            let message = self.message().expect("the server tells it");
            if message["params"]["uri"] == uri {
                return message["params"]["diagnostics"].clone();
            }
        }
    }

    pub(crate) fn close(&mut self, uri: &str) {
        self.versions.remove(uri);
        self.published.remove(uri);
        self.tell("textDocument/didClose", json!({"textDocument": {"uri": uri}}));
    }

    /// The diagnostics of a file as it is now.
    pub(crate) fn diagnostics(&mut self, uri: &str) -> Vec<Value> {
        let version = self.versions.get(uri).copied();
        loop {
            if let Some(published) = self.published.get(uri)
                && (version.is_none() || published["version"].as_i64() == version)
            {
                return published["diagnostics"].as_array().expect("a list").clone();
            }
            self.message().expect("the server tells of each version");
        }
    }

    /// Says goodbye; whether the server ended as it should.
    pub(crate) fn leave(mut self) -> bool {
        self.ask("shutdown", json!(null));
        self.tell("exit", json!(null));
        self.input.take();
        self.child.wait().expect("it ends").success()
    }

    /// Closes the connection without a word; whether the server says that this was not as it should be.
    pub(crate) fn vanish(mut self) -> bool {
        self.input.take();
        !self.child.wait().expect("it ends").success()
    }
}

impl Drop for Client {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
