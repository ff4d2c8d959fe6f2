//! What a server must stand: odd messages, unsaved texts, encodings, settings.

use super::{Client, Folder, cursor};
use serde_json::{Value, json};

const WRONG: &str = "func void main()\n    int a = true + \"x\"\nendfunc\n";

#[test]
fn diagnostics_carry_the_version_that_they_are_about() {
    let folder = Folder::new("versions");
    let (mut client, uri) = (Client::new(&folder), folder.uri("main.arl"));
    client.set(&uri, "func void main()\n    moevj {j1 0}\nendfunc\n");
    let diagnostics = client.diagnostics(&uri);
    assert_eq!(diagnostics[0]["code"], "ARL0211");
    assert_eq!(
        diagnostics[0]["range"],
        json!({"start": {"line": 1, "character": 4}, "end": {"line": 1, "character": 9}})
    );
    client.set(&uri, "func void main()\nendfunc\n");
    assert!(client.diagnostics(&uri).is_empty());
    assert!(client.leave());
}

#[test]
fn malformed_messages_end_nothing() {
    let folder = Folder::new("malformed");
    let (mut client, uri) = (Client::new(&folder), folder.uri("main.arl"));
    client.send_text("{ this is not JSON");
    assert_eq!(client.message().unwrap()["error"]["code"], -32700);
    client.send_text("[1, 2]");
    assert_eq!(client.message().unwrap()["error"]["code"], -32600);
    let id = client.request("textDocument/hover", json!({"position": 5}));
    assert_eq!(client.answer(id)["error"]["code"], -32602);
    let id = client.request("textDocument/unheardOf", json!({}));
    assert_eq!(client.answer(id)["error"]["code"], -32601);
    client.tell("textDocument/didChange", json!({"wrong": true}));
    client.tell("$/unheardOf", json!({}));
    let place = json!({"textDocument": {"uri": "file:///nowhere/x.arl"}, "position": {"line": 9, "character": 9}});
    assert_eq!(client.ask("textDocument/hover", place), Value::Null);
    client.set(&uri, WRONG);
    assert!(!client.diagnostics(&uri).is_empty());
    assert!(client.shown.iter().any(|text| text.contains("didChange")), "{:?}", client.shown);
    assert!(client.leave());
}

#[test]
fn hello_comes_first_and_goodbye_last() {
    let mut client = Client::silent();
    let id = client.request("textDocument/hover", json!({}));
    assert_eq!(client.answer(id)["error"]["code"], -32002);
    assert!(client.vanish());
}

#[test]
fn positions_count_utf16_or_bytes() {
    let folder = Folder::new("encodings");
    let text = "func void main()\n    string s = \"\u{1f916}\u{e4}\" + undeclared\nendfunc\n";
    for (offered, name, start) in [(json!(["utf-16"]), "utf-16", 23), (json!(["utf-8", "utf-16"]), "utf-8", 26)] {
        let mut client = Client::with(&folder, json!(null), json!({"general": {"positionEncodings": offered}}));
        assert_eq!(client.offered["capabilities"]["positionEncoding"], name);
        let uri = folder.uri("main.arl");
        client.set(&uri, text);
        let diagnostics = client.diagnostics(&uri);
        assert_eq!(diagnostics[0]["range"]["start"]["character"], start, "{name}");
        let change = json!([{"range": {"start": {"line": 1, "character": start}, "end": {"line": 1, "character": start + 10}}, "text": "\"x\""}]);
        client.edit(&uri, change);
        let diagnostics = client.diagnostics(&uri);
        assert!(diagnostics.iter().all(|one| one["severity"] == 2), "{diagnostics:?}");
    }
}

#[test]
fn files_of_other_encodings_are_read_from_the_disk() {
    let (bytes, _, _) = encoding_rs::GB18030.encode("// \u{70b9}\npose part = {x 1, y 2, z 3, a 0, b 180, c 0}\n");
    let folder = Folder::new("gb18030").with("rack.arl", bytes);
    let (mut client, uri) = (Client::new(&folder), folder.uri("main.arl"));
    let (text, position) = cursor("import \"rack.arl\"\nfunc void main()\n    lin rack::pa|rt\nendfunc\n");
    client.set(&uri, &text);
    let diagnostics = client.diagnostics(&uri);
    assert!(diagnostics.iter().all(|one| one["severity"] == 2), "{diagnostics:?}");
    let place = json!({"textDocument": {"uri": uri}, "position": position});
    let hover = client.ask("textDocument/hover", place);
    assert!(hover["contents"]["value"].as_str().unwrap().contains('\u{70b9}'), "{hover}");
}

#[test]
fn unsaved_modules_go_before_those_of_the_disk() {
    let folder = Folder::new("unsaved").with("rack.arl", "int count\n");
    let (mut client, uri, module) = (Client::new(&folder), folder.uri("main.arl"), folder.uri("rack.arl"));
    client.set(&uri, "import \"rack.arl\"\nfunc void main()\n    rack::total = 1\nendfunc\n");
    assert_eq!(client.diagnostics(&uri)[0]["code"], "ARL0213");
    client.set(&module, "int total\n");
    client.diagnostics(&module);
    assert_eq!(client.next_diagnostics(&uri), json!([]));
    client.close(&module);
    assert_eq!(client.next_diagnostics(&uri)[0]["code"], "ARL0213");
}

#[test]
fn errors_that_a_change_causes_in_programs_that_are_not_open_are_reported() {
    let main = "import \"rack.arl\"\nfunc void main()\n    rack::count = 1\nendfunc\n";
    let folder = Folder::new("importers").with("rack.arl", "int count\n").with("main.arl", main);
    let (mut client, module, uri) = (Client::new(&folder), folder.uri("rack.arl"), folder.uri("main.arl"));
    client.set(&module, "int count\n");
    client.diagnostics(&module);
    // Looks at the whole workspace.
    client.ask("workspace/symbol", json!({"query": ""}));
    client.set(&module, "int total\n");
    assert_eq!(client.next_diagnostics(&uri)[0]["code"], "ARL0213");
}

#[test]
fn modules_need_no_main_and_data_files_belong_to_their_program() {
    let main = "func void main()\n    movej home\nendfunc\n";
    let data = "joint home = {0, 0, 0, 0, 0, 0}\n";
    let folder = Folder::new("parts").with("cell.arl", main).with("cell_data.arl", data);
    let (mut client, uri) = (Client::new(&folder), folder.uri("cell_data.arl"));
    client.set(&uri, data);
    assert!(client.diagnostics(&uri).is_empty());
    let rack = folder.uri("rack.arl");
    client.set(&rack, "int count\n");
    assert!(client.diagnostics(&rack).is_empty());
}

#[test]
fn settings_name_the_robot_and_mistakes_in_them_are_reported() {
    let folder = Folder::new("settings");
    let mut client = Client::with(&folder, json!({"robot": "hsr065"}), json!({}));
    let uri = folder.uri("main.arl");
    client.set(&uri, "joint home = {j1 0, j5 0}\n");
    assert_eq!(client.diagnostics(&uri)[0]["code"], "ARL0208");
    client.tell("workspace/didChangeConfiguration", json!({"settings": {"arl2rs": {"robot": "no-such-robot"}}}));
    client.ask("textDocument/documentSymbol", json!({"textDocument": {"uri": uri}}));
    assert!(client.shown.iter().any(|text| text.contains("no-such-robot")), "{:?}", client.shown);
    // Settings of others change nothing.
    client.tell("workspace/didChangeConfiguration", json!({"settings": {"python": {}}}));
    client.set(&uri, "joint home = {j1 0, j5 1}\n");
    assert_eq!(client.diagnostics(&uri)[0]["code"], "ARL0208");
    client.tell("workspace/didChangeConfiguration", json!({"settings": {"arl2rs": {}}}));
    client.set(&uri, "joint home = {j1 0, j5 0} \n");
    assert!(client.diagnostics(&uri).is_empty());
}

#[test]
fn a_robot_file_that_changes_is_read_again() {
    let robot = |name: &str| {
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_arl2rs")).args(["robots", name]).output().unwrap();
        output.stdout
    };
    let folder = Folder::new("robot_file").with("robot.toml", robot("kr10-r1420"));
    let mut client = Client::with(&folder, json!({"robot": "robot.toml"}), json!({}));
    let uri = folder.uri("main.arl");
    client.set(&uri, "joint home = {j1 0, j5 0}\n");
    assert!(client.diagnostics(&uri).is_empty());
    let folder = folder.with("robot.toml", robot("hsr065"));
    let changes = json!([{"uri": folder.uri("robot.toml"), "type": 2}]);
    client.tell("workspace/didChangeWatchedFiles", json!({"changes": changes}));
    assert_eq!(client.next_diagnostics(&uri)[0]["code"], "ARL0208");
}

#[test]
fn a_header_that_is_wrong_does_not_take_the_next_request_with_it() {
    let folder = Folder::new("headers");
    let mut client = Client::new(&folder);
    let lost = "{\"jsonrpc\":\"2.0\",\"method\":\"$/lost\",\"params\":{}}";
    for field in
        ["Content-Length: 5", "Content-Length: 70", "Content-Length: 5000", "Content-Length: x", "Content-Length: -1"]
    {
        client.send_raw(&format!("{field}\r\n\r\n{lost}"));
        assert_eq!(client.ask("workspace/symbol", json!({"query": ""})), json!([]), "{field}");
    }
    assert!(client.leave());
}

#[test]
fn a_change_of_a_range_that_is_none_is_refused() {
    let folder = Folder::new("no_range");
    let (mut client, uri) = (Client::new(&folder), folder.uri("main.arl"));
    client.set(&uri, WRONG);
    let before = client.diagnostics(&uri);
    assert!(!before.is_empty());
    for line in [json!(-1), json!(1.5), json!("1"), json!(4_294_967_296_u64), json!(null)] {
        let range = json!({"start": {"line": line, "character": 0}, "end": {"line": line, "character": 1}});
        client.edit(&uri, json!([{"range": range, "text": ""}]));
        client.ask("workspace/symbol", json!({"query": ""}));
        let message = client.shown.pop().unwrap_or_default();
        assert!(message.contains("an invalid range"), "{line}: {message}");
    }
    // The text is still there.
    let symbols = client.ask("textDocument/documentSymbol", json!({"textDocument": {"uri": uri}}));
    assert_eq!(symbols[0]["name"], "main");
    // Whole documents need no range.
    client.edit(&uri, json!([{"range": null, "text": "func void main()\nendfunc\n"}]));
    assert!(client.diagnostics(&uri).is_empty());
    assert!(client.leave());
}

#[cfg(unix)]
#[test]
fn pipes_and_devices_in_the_workspace_stop_nothing() {
    let folder = Folder::new("pipes").with("uses.arl", "import \"pipe.arl\"\nfunc void main()\nendfunc\n");
    let made = std::process::Command::new("mkfifo").arg(folder.path.join("pipe.arl")).status().expect("mkfifo");
    assert!(made.success());
    for name in ["zero.arl", "main_data.arl", "arl.toml"] {
        std::os::unix::fs::symlink("/dev/zero", folder.path.join(name)).expect("a link");
    }
    let (mut client, uri) = (Client::new(&folder), folder.uri("uses.arl"));
    client.set(&uri, "import \"pipe.arl\"\nimport \"zero.arl\"\nfunc void main()\nendfunc\n");
    let diagnostics = client.diagnostics(&uri);
    let messages: Vec<&str> = diagnostics.iter().filter_map(|one| one["message"].as_str()).collect();
    assert_eq!(messages.iter().filter(|text| text.contains("not a regular file")).count(), 2, "{messages:?}");
    let main = folder.uri("main.arl");
    client.set(&main, "func void main()\nendfunc\n");
    // What is wrong with the data file is not told of its program.
    assert!(client.diagnostics(&main).is_empty());
    client.ask("workspace/symbol", json!({"query": ""}));
    assert!(client.shown.iter().any(|text| text.contains("arl.toml")), "{:?}", client.shown);
    assert!(client.leave());
}
