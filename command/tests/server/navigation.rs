//! Where things are declared and used, what they are, how they are renamed.

use super::{Client, Folder, cursor};
use serde_json::{Value, json};
use std::collections::BTreeMap;

const RACK: &str = "// Where parts lie.\nint count\nfunc bool full(int number)\n    return number > count\nendfunc\n";
const MAIN: &str = "import \"rack.arl\"
joint home = {0, -90, 90, 0, 90, 0}
// Grips a part.
func bool grip(int channel)
    setdo(channel, true)
    return getdi(channel)
endfunc
func void main()
    const int ROWS = 3
    int count = ROWS
    again:
    movej home, vp:50%
    if(grip(1) && !rack::full(count))
        rack::count++
        goto again
    endif
endfunc
";

fn open(name: &str) -> (Client, Folder, String) {
    let folder = Folder::new(name).with("rack.arl", RACK).with("main.arl", MAIN);
    let mut client = Client::new(&folder);
    let uri = folder.uri("main.arl");
    client.set(&uri, MAIN);
    (client, folder, uri)
}

/// The place of the first `needle` behind `after`.
fn place(uri: &str, after: &str, needle: &str) -> Value {
    let from = MAIN.find(after).unwrap() + after.len();
    let at = from + MAIN[from..].find(needle).unwrap();
    let (_, position) = cursor(&format!("{}|{}", &MAIN[..at], &MAIN[at..]));
    json!({"textDocument": {"uri": uri}, "position": position})
}

#[test]
fn hover_tells_the_frames_of_a_pose() {
    let folder = Folder::new("frames");
    let mut client = Client::new(&folder);
    let uri = folder.uri("main.arl");
    let (text, position) = cursor(
        "wobj table\npose fe|eder = {x 700, y 0, z 600, a 0, b 180, c 0}\npose other = feeder\nfunc void main()\n    \
         lin feeder, vl:100mm/s, w:table\n    ptp feeder, vp:10%\n    lin feeder, vl:100mm/s, w:table\nendfunc\n",
    );
    client.set(&uri, &text);
    let hover = client.ask("textDocument/hover", json!({"textDocument": {"uri": uri}, "position": position}));
    let shown = hover["contents"]["value"].as_str().unwrap();
    assert!(shown.contains("A target in the frame `table` (lines 5, 7), `$DFWOBJ` (line 6)."), "{shown}");
}

#[test]
fn hover_tells_what_a_name_is() {
    let (mut client, _folder, uri) = open("hover");
    let expected = [
        ("movej ", "home", "joint home = {0, -90, 90, 0, 90, 0}"),
        ("int count = ", "ROWS", "const int ROWS = 3"),
        ("if(", "grip", "Grips a part."),
        ("rack::", "full", "func bool full(int number)"),
        ("again:\n", "movej", "movej j:"),
        ("movej home, ", "vp", "Units: `%`"),
        ("return ", "getdi", "bool getdi"),
        ("&& !", "rack", "Where parts lie."),
        ("func ", "bool", "`true` or `false`"),
        ("goto ", "again", "again:"),
        ("", "import", "# import"),
        ("endf", "unc", "# func"),
    ];
    for (after, needle, text) in expected {
        let hover = client.ask("textDocument/hover", place(&uri, after, needle));
        let value = hover["contents"]["value"].as_str().unwrap_or_default();
        assert!(value.contains(text), "{needle}: {value}");
    }
    assert_eq!(client.ask("textDocument/hover", place(&uri, "int count ", "=")), Value::Null);
}

#[test]
fn definitions_and_uses_go_across_files() {
    let (mut client, folder, uri) = open("uses");
    let found = client.ask("textDocument/definition", place(&uri, "rack::", "full"));
    assert_eq!((found["uri"].as_str(), &found["range"]["start"]["line"]), (Some(&*folder.uri("rack.arl")), &json!(2)));
    let mut params = place(&uri, "rack::full(count))\n        rack::", "count");
    params["context"] = json!({"includeDeclaration": true});
    let found = client.ask("textDocument/references", params.clone());
    let lines = |found: &Value| {
        let line =
            |one: &Value| (one["uri"].as_str().unwrap().ends_with("main.arl"), one["range"]["start"]["line"].as_i64());
        found.as_array().unwrap().iter().map(line).collect::<Vec<_>>()
    };
    assert_eq!(lines(&found), [(true, Some(13)), (false, Some(1)), (false, Some(3))]);
    params["context"] = json!({"includeDeclaration": false});
    let found = client.ask("textDocument/references", params);
    assert_eq!(lines(&found), [(true, Some(13)), (false, Some(3))]);
    let marked = client.ask("textDocument/documentHighlight", place(&uri, "int ", "count"));
    let kinds: Vec<_> = marked.as_array().unwrap().iter().map(|one| one["kind"].as_i64()).collect();
    assert_eq!(kinds, [Some(3), Some(2)]);
}

#[test]
fn renaming_changes_all_uses_in_all_files() {
    let (mut client, folder, uri) = open("rename");
    let mut params = place(&uri, "rack::full(count))\n        rack::", "count");
    params["newName"] = json!("total");
    let edit = client.ask("textDocument/rename", params);
    let changes: BTreeMap<String, Value> = serde_json::from_value(edit["changes"].clone()).unwrap();
    let count = |name: &str| changes[&folder.uri(name)].as_array().unwrap().len();
    assert_eq!((changes.len(), count("main.arl"), count("rack.arl")), (2, 1, 2));
}

#[test]
fn names_that_would_mean_something_else_are_refused() {
    let (mut client, _folder, uri) = open("clashes");
    let mut refused = |after: &str, needle: &str, name: &str| {
        let mut params = place(&uri, after, needle);
        params["newName"] = json!(name);
        client.refused("textDocument/rename", params)
    };
    for (name, reason) in [("while", "word of the language"), ("2nd", "is not a name"), ("a b", "is not a name")] {
        assert!(refused("int ", "count", name).contains(reason), "{name}");
    }
    // A local would hide a global; one of the same name is there already.
    assert!(refused("int ", "count", "home").contains("already has a meaning"));
    assert!(refused("int ", "count", "rows").contains("twice"));
    assert!(refused("again:\n", "movej", "go").contains("part of the language"));
    assert!(refused("&& !", "rack", "shelf").contains("rename the file"));
    assert!(refused("func void ", "main", "start").contains("begins with `main`"));
}

#[test]
fn symbols_calls_and_colours() {
    let (mut client, _folder, uri) = open("symbols");
    let document = json!({"textDocument": {"uri": uri}});
    let symbols = client.ask("textDocument/documentSymbol", document.clone());
    let names: Vec<_> = symbols.as_array().unwrap().iter().map(|one| one["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["home", "grip", "main"]);
    let found = client.ask("workspace/symbol", json!({"query": "ful"}));
    assert_eq!(found[0]["name"], "full");
    let items = client.ask("textDocument/prepareCallHierarchy", place(&uri, "func bool ", "grip"));
    let callers = client.ask("callHierarchy/incomingCalls", json!({"item": items[0]}));
    assert_eq!((&callers[0]["from"]["name"], callers.as_array().unwrap().len()), (&json!("main"), 1));
    let items = client.ask("textDocument/prepareCallHierarchy", place(&uri, "func void ", "main"));
    let called = client.ask("callHierarchy/outgoingCalls", json!({"item": items[0]}));
    let called: Vec<_> = called.as_array().unwrap().iter().map(|one| one["to"]["name"].as_str().unwrap()).collect();
    assert_eq!(called.len(), 2);
    assert!(called.contains(&"grip") && called.contains(&"full"));
    let tokens = client.ask("textDocument/semanticTokens/full", document.clone());
    assert_eq!(tokens["data"].as_array().unwrap().len() % 5, 0);
    let folds = client.ask("textDocument/foldingRange", document.clone());
    assert!(folds.as_array().unwrap().iter().any(|one| one["startLine"] == 12 && one["endLine"] == 14));
    let lenses = client.ask("textDocument/codeLens", document);
    assert_eq!(lenses[0]["command"]["command"], "arl2rs.run");
}

#[test]
fn hints_tell_parameters_and_units() {
    let folder = Folder::new("hints");
    let (mut client, uri) = (Client::new(&folder), folder.uri("main.arl"));
    client.set(
        &uri,
        "func void step(int count, double way)\nendfunc\nfunc void main()\n    step(3, 2.5)\n    waittime 2\nendfunc\n",
    );
    let range = json!({"start": {"line": 0, "character": 0}, "end": {"line": 9, "character": 0}});
    let hints = client.ask("textDocument/inlayHint", json!({"textDocument": {"uri": uri}, "range": range}));
    let all: Vec<_> = hints.as_array().unwrap().iter().map(|one| one["label"].as_str().unwrap()).collect();
    assert_eq!(all, ["count:", "way:", "s"]);
}

#[test]
fn quick_fixes_write_what_the_help_says() {
    let folder = Folder::new("fixes");
    let (mut client, uri) = (Client::new(&folder), folder.uri("main.arl"));
    client.set(&uri, "int counter\nfunc void main()\n    conter = 1\n    movej {0}, vpp:5%\nendfunc\n");
    let range = json!({"start": {"line": 2, "character": 5}, "end": {"line": 2, "character": 5}});
    let params = |range: Value| json!({"textDocument": {"uri": uri}, "range": range, "context": {"diagnostics": []}});
    let actions = client.ask("textDocument/codeAction", params(range));
    let edit = &actions[0]["edit"]["changes"][&uri][0];
    assert_eq!(edit["newText"], "counter");
    assert_eq!(edit["range"], json!({"start": {"line": 2, "character": 4}, "end": {"line": 2, "character": 10}}));
    let range = json!({"start": {"line": 3, "character": 16}, "end": {"line": 3, "character": 16}});
    let actions = client.ask("textDocument/codeAction", params(range));
    let edit = &actions[0]["edit"]["changes"][&uri][0];
    assert_eq!((&edit["newText"], &edit["range"]["end"]["character"]), (&json!("vp"), &json!(18)));
}

#[test]
fn names_behind_mistakes_are_not_left_behind() {
    let folder = Folder::new("mistakes");
    let (mut client, uri) = (Client::new(&folder), folder.uri("main.arl"));
    for line in ["b = below(a)", "movej nope, vl:a, foo:a", "print abs(nope, a)", "b = m::f(a)"] {
        client.set(&uri, &format!("func void main()\n    int a\n    int b\n    {line}\nendfunc\nfunc int below(int n)\n    return n\nendfunc\n"));
        let params = json!({"textDocument": {"uri": uri}, "position": {"line": 1, "character": 8}, "newName": "zz"});
        assert!(client.refused("textDocument/rename", params).contains("line 4"), "{line}");
    }
}

#[test]
fn a_parameter_that_labels_an_argument_behind_a_mistake_stays() {
    let folder = Folder::new("labels");
    let (mut client, uri) = (Client::new(&folder), folder.uri("main.arl"));
    let head = "func int twice(int way)\n    return 2 * way\nendfunc\nfunc void main()\n    int a\n";
    for (line, refused) in [("a = twice(way:1)", false), ("a = abs(nope, twice(way:1))", true)] {
        client.set(&uri, &format!("{head}    {line}\nendfunc\n"));
        let params = json!({"textDocument": {"uri": uri}, "position": {"line": 0, "character": 20}, "newName": "far"});
        let id = client.request("textDocument/rename", params);
        let answer = client.answer(id);
        match refused {
            true => {
                assert!(
                    answer["error"]["message"].as_str().is_some_and(|message| message.contains("line 6")),
                    "{answer}"
                )
            }
            false => assert_eq!(answer["result"]["changes"][&uri].as_array().map(Vec::len), Some(3), "{answer}"),
        }
    }
}

#[test]
fn a_text_with_slashes_is_no_comment() {
    let folder = Folder::new("slashes");
    let (mut client, uri) = (Client::new(&folder), folder.uri("main.arl"));
    client.set(&uri, "string place = \"http://x\" // where\n");
    let place = json!({"textDocument": {"uri": uri}, "position": {"line": 0, "character": 9}});
    let hover = client.ask("textDocument/hover", place);
    let value = hover["contents"]["value"].as_str().unwrap_or_default();
    assert!(value.contains("\"http://x\"") && value.ends_with("where"), "{value}");
}

#[test]
fn signals_have_the_names_of_the_cell_that_arl_toml_names() {
    let program = "func void main()\n    waituntil getdi(1)\n    setdo(2, true)\nendfunc\n";
    let folder = Folder::new("signals")
        .with("arl.toml", "cell = \"cell.toml\"\n")
        .with("cell.toml", "[io]\ndi = 4\n[names]\n\"di.1\" = \"part_present\"\n\"do.2\" = \"gripper\"\n")
        .with("main.arl", program);
    let (mut client, uri) = (Client::new(&folder), folder.uri("main.arl"));
    client.set(&uri, program);
    let at = json!({"textDocument": {"uri": uri}, "position": {"line": 1, "character": 20}});
    let hover = client.ask("textDocument/hover", at);
    assert_eq!(hover["contents"]["value"], "`di.1` is `part_present`");
    let range = json!({"start": {"line": 0, "character": 0}, "end": {"line": 4, "character": 0}});
    let hints = client.ask("textDocument/inlayHint", json!({"textDocument": {"uri": uri}, "range": range}));
    let all: Vec<_> = hints.as_array().unwrap().iter().map(|one| one["label"].as_str().unwrap()).collect();
    assert_eq!(all, ["part_present", "chan:", "gripper", "value:"]);
    // Another cell file: what it does not have is told.
    std::fs::write(folder.path.join("cell.toml"), "[io]\ndi = 0\n").unwrap();
    let changed = json!({"changes": [{"uri": folder.uri("cell.toml"), "type": 2}]});
    client.tell("workspace/didChangeWatchedFiles", changed);
    client.set(&uri, &format!("{program}\n"));
    let diagnostics = client.diagnostics(&uri);
    assert_eq!(diagnostics[0]["code"], "ARL0805", "{diagnostics:?}");
}

#[test]
fn the_unsaved_text_of_a_module_beside_the_folder_goes_first() {
    let folder = Folder::new("beside");
    std::fs::create_dir_all(folder.path.join("line")).unwrap();
    std::fs::create_dir_all(folder.path.join("shared")).unwrap();
    let folder = folder.with("shared/rack.arl", "int total\n");
    let (mut client, main, rack) = (Client::new(&folder), folder.uri("line/main.arl"), folder.uri("shared/rack.arl"));
    let program = "import \"../shared/rack.arl\"\nfunc void main()\n    rack::count = 1\nendfunc\n";
    client.set(&rack, "int count\n");
    client.set(&main, program);
    assert_eq!(client.diagnostics(&main), Vec::<Value>::new());
    let at = json!({"textDocument": {"uri": main}, "position": {"line": 2, "character": 12}, "newName": "parts"});
    let edit = client.ask("textDocument/rename", at);
    assert!(edit["changes"][&rack].is_array() && edit["changes"][&main].is_array(), "{edit}");
}

/// All addresses that an answer has.
fn addresses(value: &Value, found: &mut Vec<String>) {
    match value {
        Value::Array(values) => values.iter().for_each(|value| addresses(value, found)),
        Value::Object(values) => {
            for (key, value) in values {
                match value.as_str() {
                    Some(uri) if key == "uri" => found.push(uri.to_owned()),
                    _ if key == "changes" => {
                        found.extend(value.as_object().into_iter().flat_map(|all| all.keys().cloned()))
                    }
                    _ => addresses(value, found),
                }
            }
        }
        _ => {}
    }
}

#[test]
fn addresses_come_back_as_the_client_spells_them() {
    let folder = Folder::new("spelling");
    let base = folder.path.display();
    for uri in [
        format!("file://{base}/a%20(b)/main.arl"),
        format!("file://{base}/a%20%28b%29/main.arl"),
        format!("file://{base}/\u{96f6}\u{4ef6}/main.arl"),
        format!("file://{base}/c%2bd@e/m%C3%A4in.arl"),
        "inmemory://model/1.arl".to_owned(),
        "vscode-vfs://github/cell/a%20(b)/main.arl".to_owned(),
        "untitled:Untitled-1".to_owned(),
    ] {
        let mut client = Client::new(&folder);
        let text = "int wrong = \"x\"\nfunc void part()\nendfunc\nfunc void main()\n    part()\nendfunc\n";
        client.set(&uri, text);
        assert!(!client.diagnostics(&uri).is_empty(), "under this address: {uri}");
        let place = json!({"textDocument": {"uri": uri}, "position": {"line": 4, "character": 5}});
        let mut rename = place.clone();
        rename["newName"] = json!("piece");
        let mut uses = place.clone();
        uses["context"] = json!({"includeDeclaration": true});
        for (method, params) in [
            ("textDocument/definition", &place),
            ("textDocument/references", &uses),
            ("textDocument/rename", &rename),
            ("textDocument/prepareCallHierarchy", &place),
            ("workspace/symbol", &json!({"query": "part"})),
        ] {
            let mut found = Vec::new();
            addresses(&client.ask(method, params.clone()), &mut found);
            assert!(!found.is_empty() && found.iter().all(|found| *found == uri), "{method}: {uri} became {found:?}");
        }
        // What was told of a file is taken back under the same address.
        client.tell("textDocument/didClose", json!({"textDocument": {"uri": uri}}));
        assert_eq!(client.next_diagnostics(&uri), json!([]));
        assert!(client.leave());
    }
}

#[test]
fn files_beside_an_open_one_are_spelled_like_it() {
    let folder = Folder::new("beside (it)").with("rack.arl", RACK).with("main.arl", MAIN);
    let uri = format!("file://{}/main.arl", folder.path.display().to_string().replace(' ', "%20"));
    let mut client = Client::new(&Folder::new("elsewhere"));
    client.set(&uri, MAIN);
    let found = client.ask("textDocument/definition", place(&uri, "rack::", "full"));
    assert_eq!(found["uri"], uri.replace("main.arl", "rack.arl"));
    assert!(client.leave());
}
