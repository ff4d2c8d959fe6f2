//! The server's state and its loop: what comes in, in which order it is handled, what goes out.
//!
//! One thread does everything. Waiting messages are taken in first, so that a request that was cancelled meanwhile
//! costs nothing, and the diagnostics of a text that changed again are never computed. If a handler panics, the answer
//! is an error; the server continues.

use super::documents::{Document, Documents};
use super::markup::Formats;
use super::programs::{CheckedPrograms, Program};
use super::projects::Projects;
use super::settings::Settings;
use super::text::Encoding;
use super::transport::{Incoming, answer, notification, refusal};
use super::uri::path_of;
use super::workspace::Workspace;
use super::{capabilities, diagnostics, requests};
use arl_lang::catalog::Family;
use arl2rs::CheckOptions;
use arl2rs::compile::{Bug, guard};
use gen_lsp_types::json_rpc::Id;
use gen_lsp_types::*;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};
use std::collections::{BTreeSet, VecDeque};
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::mpsc::{Receiver, Sender, TryRecvError};

/// The protocol's number for a request that the client no longer wants.
const CANCELLED: i32 = -32800;

/// Why a request is not fulfilled, in words for the user.
#[derive(Debug)]
pub(super) struct Refusal {
    pub(super) code: ErrorCodes,
    pub(super) message: String,
}

impl Refusal {
    /// A request that cannot be fulfilled.
    pub(super) fn new(message: impl Into<String>) -> Self {
        // The protocol's RequestFailed, for which there is no name.
        Self { code: ErrorCodes::Custom(-32803), message: message.into() }
    }
}

/// The phase of the connection.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Phase {
    New,
    Running,
    ShutDown,
}

/// One client's server.
#[derive(Debug)]
pub(super) struct Server {
    outgoing: Sender<Value>,
    phase: Phase,
    pub(super) encoding: Encoding,
    /// Whether the client fills in places that a completion leaves open.
    pub(super) snippets: bool,
    /// The formats of text that the client shows.
    pub(super) formats: Formats,
    /// Whether the client can be asked to report changes of files on the disk.
    watches: bool,
    folders: Vec<PathBuf>,
    settings: Settings,
    /// How files are checked that no `arl.toml` applies to.
    options: Rc<CheckOptions>,
    projects: Projects,
    pub(super) documents: Documents,
    programs: CheckedPrograms,
    pub(super) workspace: Workspace,
    /// Files whose diagnostics have to be sent, the most urgent ones first, each once.
    stale: VecDeque<PathBuf>,
    /// Files of which the client has diagnostics.
    published: BTreeSet<PathBuf>,
}

impl Server {
    pub(super) fn new(outgoing: Sender<Value>) -> Self {
        Self {
            outgoing,
            phase: Phase::New,
            encoding: Encoding::default(),
            snippets: false,
            formats: Formats::default(),
            watches: false,
            folders: Vec::new(),
            settings: Settings::default(),
            options: Rc::default(),
            projects: Projects::default(),
            documents: Documents::default(),
            programs: CheckedPrograms::default(),
            workspace: Workspace::default(),
            stale: VecDeque::new(),
            published: BTreeSet::new(),
        }
    }

    /// Serves until `exit`, or until no more messages come. Returns whether the client shut down as it should.
    pub(super) fn serve(mut self, incoming: &Receiver<Incoming>) -> bool {
        let mut queue = VecDeque::new();
        while self.fill(&mut queue, incoming) {
            match queue.pop_front() {
                Some(Incoming::Notification(method, _)) if method == "exit" => break,
                Some(message) => self.take(message),
                None => self.work(),
            }
        }
        self.phase == Phase::ShutDown
    }

    /// Takes in the messages that have come; waits if there is nothing to do. `false` once no more will come.
    fn fill(&mut self, queue: &mut VecDeque<Incoming>, incoming: &Receiver<Incoming>) -> bool {
        loop {
            let has_work = !queue.is_empty() || self.has_work();
            let next = match incoming.try_recv() {
                Ok(message) => message,
                Err(TryRecvError::Empty) if has_work => return true,
                Err(TryRecvError::Empty) => match incoming.recv() {
                    Ok(message) => message,
                    Err(_) => return false,
                },
                Err(TryRecvError::Disconnected) => return !queue.is_empty(),
            };
            match next {
                Incoming::Notification(method, params) if method == "$/cancelRequest" => self.cancel(queue, &params),
                message => queue.push_back(message),
            }
        }
    }

    /// Answers a waiting request that is no longer wanted.
    fn cancel(&self, queue: &mut VecDeque<Incoming>, params: &Value) {
        let Some(id) = params.get("id").and_then(|id| serde_json::from_value::<Id>(id.clone()).ok()) else { return };
        let waits = queue.iter().position(|message| matches!(message, Incoming::Request(own, ..) if *own == id));
        if let Some(at) = waits {
            queue.remove(at);
            self.send(refusal(&id, ErrorCodes::Custom(CANCELLED), "cancelled"));
        }
    }

    fn send(&self, message: Value) {
        // The writer is gone only when the client is; the input ends then, too.
        let _ = self.outgoing.send(message);
    }

    fn take(&mut self, message: Incoming) {
        match message {
            Incoming::Request(id, method, params) => {
                let reply = match guard(|| self.request(&id, &method, params)) {
                    Ok(reply) => reply,
                    Err(bug) => refusal(&id, ErrorCodes::InternalError, &bug.to_string()),
                };
                self.send(reply);
            }
            Incoming::Notification(method, params) => {
                if let Err(bug) = guard(|| self.notice(&method, params)) {
                    self.complain(&bug.to_string());
                }
            }
            Incoming::Malformed(reply) => self.send(reply),
            Incoming::Response => {}
        }
    }

    fn request(&mut self, id: &Id, method: &str, params: Value) -> Value {
        match (self.phase, method) {
            (Phase::New, "initialize") => match serde_json::from_value(params) {
                Ok(params) => answer(id, &self.initialize(params)),
                Err(error) => refusal(id, ErrorCodes::InvalidParams, &error.to_string()),
            },
            (Phase::New, _) => refusal(id, ErrorCodes::ServerNotInitialized, "`initialize` comes first"),
            (Phase::Running, "shutdown") => {
                self.phase = Phase::ShutDown;
                answer(id, &Value::Null)
            }
            (Phase::Running, "initialize") => refusal(id, ErrorCodes::InvalidRequest, "initialized already"),
            (Phase::Running, _) => requests::answer(self, id, method, params),
            (Phase::ShutDown, _) => refusal(id, ErrorCodes::InvalidRequest, "shut down already"),
        }
    }

    #[expect(deprecated, reason = "what clients without folders say")]
    fn initialize(&mut self, params: InitializeParams) -> InitializeResult {
        self.phase = Phase::Running;
        let offered = params.capabilities.general.and_then(|general| general.position_encodings);
        self.encoding = Encoding::of(&offered.unwrap_or_default());
        let text = params.capabilities.text_document;
        self.formats = Formats::of(text.as_ref());
        let item = text.and_then(|text| text.completion).and_then(|completion| completion.completion_item);
        self.snippets = item.and_then(|item| item.snippet_support).unwrap_or(false);
        let watching = params.capabilities.workspace.and_then(|workspace| workspace.did_change_watched_files);
        self.watches = watching.and_then(|watching| watching.dynamic_registration).unwrap_or(false);
        let folders = match params.workspace_folders_initialize_params.workspace_folders {
            Some(WorkspaceFolders::WorkspaceFolderList(folders)) => {
                folders.iter().map(|one| path_of(&one.uri)).collect()
            }
            _ => params.root_uri.iter().map(path_of).collect(),
        };
        self.folders = folders;
        self.workspace = Workspace::search(&self.folders);
        self.set(params.initialization_options.unwrap_or_default());
        InitializeResult { capabilities: capabilities::all(self.encoding), server_info: Some(capabilities::info()) }
    }

    /// Takes over settings; errors in them are reported, and the old ones stay.
    fn set(&mut self, value: Value) {
        match Settings::read(&value) {
            Ok(settings) => self.apply(settings.unwrap_or_else(|| self.settings.clone())),
            Err(text) => self.complain(&text),
        }
    }

    /// Reads the files that the settings name, and checks everything again.
    fn apply(&mut self, settings: Settings) {
        let folder = self.folders.first().cloned();
        match settings.options(folder.as_deref(), None) {
            Ok(options) => {
                self.settings = settings;
                self.options = Rc::new(options);
                self.projects.forget();
                self.programs.forget_all();
                self.workspace.look_again();
                let all: Vec<PathBuf> = self.documents.paths().chain(&self.published).cloned().collect();
                self.stale.extend(all);
                let mut seen = BTreeSet::new();
                self.stale.retain(|path| seen.insert(path.clone()));
            }
            Err(text) => self.complain(&text),
        }
    }

    /// Shows the user an error.
    fn complain(&self, text: &str) {
        self.send(notification("window/showMessage", &json!({"type": 1, "message": text})));
    }

    fn notice(&mut self, method: &str, params: Value) {
        if self.phase != Phase::Running {
            return;
        }
        match method {
            "initialized" => self.ask_for_news(),
            "textDocument/didOpen" => {
                self.with(method, params, |server, params: DidOpenTextDocumentParams| {
                    let item = params.text_document;
                    let path = server.documents.open(&item.uri, Document::new(item.text, item.version));
                    server.changed(&path);
                });
            }
            "textDocument/didChange" if has_range_of_none(&params) => {
                self.complain("a change has an invalid range: the server keeps the text that it had");
            }
            "textDocument/didChange" => {
                self.with(method, params, |server, params: DidChangeTextDocumentParams| {
                    let path = path_of(&params.text_document.text_document_identifier.uri);
                    let (version, encoding) = (params.text_document.version, server.encoding);
                    if let Some(document) = server.documents.get_mut(&path) {
                        document.change(params.content_changes, version, encoding);
                        server.changed(&path);
                    }
                });
            }
            "textDocument/didClose" => {
                self.with(method, params, |server, params: DidCloseTextDocumentParams| {
                    let path = path_of(&params.text_document.uri);
                    server.documents.close(&path);
                    server.changed(&path);
                    server.programs.keep(&server.documents);
                });
            }
            "workspace/didChangeWatchedFiles" => {
                self.with(method, params, |server, params: DidChangeWatchedFilesParams| {
                    let paths: Vec<PathBuf> = params.changes.iter().map(|change| path_of(&change.uri)).collect();
                    // It may be the robot or the cell that the settings name.
                    if paths.iter().any(|path| path.extension().is_some_and(|ending| ending == "toml")) {
                        server.apply(server.settings.clone());
                    }
                    for path in paths {
                        // Open files are as the editor has them.
                        if server.documents.get(&path).is_none() {
                            server.changed(&path);
                        }
                    }
                });
            }
            "workspace/didChangeConfiguration" => {
                self.with(method, params, |server, params: DidChangeConfigurationParams| server.set(params.settings));
            }
            _ => {}
        }
    }

    fn with<P: DeserializeOwned>(&mut self, method: &str, params: Value, take: impl FnOnce(&mut Self, P)) {
        match serde_json::from_value(params) {
            Ok(params) => take(self, params),
            Err(error) => self.complain(&format!("`{method}` has invalid parameters: {error}")),
        }
    }

    /// Asks the client to report changes of files on the disk.
    fn ask_for_news(&self) {
        if !self.watches {
            return;
        }
        let watchers = ["**/*.arl", "**/*.toml"].map(|pattern| json!({"globPattern": pattern}));
        let registration = json!({
            "id": "files",
            "method": "workspace/didChangeWatchedFiles",
            "registerOptions": {"watchers": watchers},
        });
        let params = json!({"registrations": [registration]});
        self.send(json!({"jsonrpc": "2.0", "id": 0, "method": "client/registerCapability", "params": params}));
    }

    /// Forgets what depends on a file; the diagnostics of the file and of all that use it are to be sent again.
    fn changed(&mut self, path: &Path) {
        let mut roots: BTreeSet<PathBuf> = self.programs.forget(path).into_iter().collect();
        roots.extend(self.workspace.dependents(path));
        roots.insert(self.programs.root(path, &self.documents));
        self.workspace.changed(path, self.documents.exists(path));
        let of_roots = |open: &&PathBuf| roots.contains(&self.programs.root(open, &self.documents));
        let mut stale: BTreeSet<PathBuf> = self.documents.paths().filter(of_roots).cloned().collect();
        stale.extend(roots.into_iter().filter(|root| self.is_shown(root)));
        if self.published.contains(path) || self.is_shown(path) {
            // The file that is being edited goes before what depends on it.
            stale.remove(path);
            self.stale.retain(|other| other != path);
            self.stale.push_front(path.to_path_buf());
        }
        for path in stale {
            if !self.stale.contains(&path) {
                self.stale.push_back(path);
            }
        }
    }

    /// Whether the diagnostics of a file are sent: it is open, or one of the workspace.
    fn is_shown(&self, path: &Path) -> bool {
        self.documents.get(path).is_some() || self.workspace.knows(path)
    }

    fn has_work(&self) -> bool {
        self.phase == Phase::Running && (!self.stale.is_empty() || self.workspace.is_open())
    }

    /// Does a piece of background work: sends one file's diagnostics, or looks at one file of the workspace.
    fn work(&mut self) {
        let Some(path) = self.stale.pop_front() else {
            if let Err(bug) = guard(|| self.look()) {
                self.complain(&bug.to_string());
            }
            return;
        };
        let version = self.documents.get(&path).map(|document| document.version);
        // A file that is neither open nor used by what is open has no diagnostics.
        let found = match self.is_shown(&path) {
            true => guard(|| diagnostics::of(self, &path)).unwrap_or_else(|bug| vec![diagnostics::of_bug(&bug)]),
            false => Vec::new(),
        };
        let root = self.root(&path);
        if let Some(program) = self.programs.known(&root) {
            self.workspace.learn(&root, &program);
        }
        let had = if found.is_empty() { self.published.remove(&path) } else { !self.published.insert(path.clone()) };
        if version.is_some() || had || !found.is_empty() {
            let params = PublishDiagnosticsParams { uri: self.documents.uri(&path), version, diagnostics: found };
            self.send(notification("textDocument/publishDiagnostics", &params));
        }
        self.programs.free();
    }

    /// The main file of the program that a file is checked with.
    pub(super) fn root(&self, path: &Path) -> PathBuf {
        self.programs.root(path, &self.documents)
    }

    /// The program that a file is checked with, as it is now.
    pub(super) fn program(&self, path: &Path) -> Option<Rc<Program>> {
        self.check(path).ok()
    }

    /// The same, or the failure of the compiler.
    pub(super) fn check(&self, path: &Path) -> Result<Rc<Program>, Bug> {
        self.programs.of(path, &self.documents, &self.options_of(path))
    }

    /// How a file is checked: by the settings, then by the `arl.toml` beside it or above it.
    pub(super) fn options_of(&self, path: &Path) -> Rc<CheckOptions> {
        let Some(project) = self.projects.find(path) else { return self.options.clone() };
        let folder = self.folders.first().map(PathBuf::as_path);
        self.projects.options(&project, |file| self.settings.options(folder, Some(file))).unwrap_or_else(|text| {
            if !text.is_empty() {
                self.complain(&text);
            }
            self.options.clone()
        })
    }

    /// The kind of robot that a file is for.
    pub(super) fn family(&self, path: &Path) -> Family {
        self.options_of(path).family
    }

    /// Looks at one more file of the workspace.
    fn look(&mut self) {
        let Some(path) = self.workspace.next() else { return };
        let options = self.options_of(&path);
        self.workspace.look(&path, &self.documents, &options);
    }

    /// Forgets the programs that were needed for one request only.
    pub(super) fn forget_unopened(&self) {
        self.programs.keep(&self.documents);
    }

    /// Looks at all files of the workspace that have not been looked at yet.
    pub(super) fn look_at_all(&mut self) {
        while self.workspace.is_open() {
            self.look();
        }
    }
}

/// Whether a change has an invalid range: without the range the change would be that of the whole document.
fn has_range_of_none(params: &Value) -> bool {
    let changes = params.get("contentChanges").and_then(Value::as_array).into_iter().flatten();
    let mut ranges = changes.filter_map(|change| change.get("range")).filter(|range| !range.is_null());
    ranges.any(|range| serde_json::from_value::<Range>(range.clone()).is_err())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::mpsc::channel;

    #[test]
    fn a_request_that_waits_is_cancelled() {
        let (sender, incoming) = channel();
        let (outgoing, answers) = channel();
        let request = |id: i64, method: &str| Incoming::Request(Id::Number(id), method.into(), json!({}));
        let notice = |method: &str, params| Incoming::Notification(method.into(), params);
        // All of it is there before the server looks.
        for message in [
            Incoming::Request(Id::Number(1), "initialize".into(), json!({"capabilities": {}})),
            request(2, "workspace/symbol"),
            request(3, "shutdown"),
            notice("$/cancelRequest", json!({"id": 2})),
            notice("$/cancelRequest", json!({"id": 77})),
            notice("exit", Value::Null),
        ] {
            sender.send(message).unwrap();
        }
        assert!(Server::new(outgoing).serve(&incoming));
        let answers: Vec<_> =
            answers.iter().map(|answer| (answer["id"].as_i64(), answer["error"]["code"].as_i64())).collect();
        assert_eq!(answers, [(Some(2), Some(i64::from(CANCELLED))), (Some(1), None), (Some(3), None)]);
    }
}
