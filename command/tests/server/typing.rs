//! What happens while somebody types: signatures, closing words, layout.

use super::{Client, Folder, cursor, labels};
use serde_json::{Value, json};

#[test]
fn a_parameter_that_the_robot_does_not_have_is_not_offered() {
    let folder = Folder::new("other_family");
    let uri = folder.uri("main.arl");
    let head = "joint up\ntool grip\nspeed fast\nfunc void main()\n    ";
    for (robot, has, dura) in [("hsr065", false, 6), ("kr10-r1420", true, 7)] {
        let mut client = Client::with(&folder, json!({"robot": robot}), json!({}));
        let (text, position) = cursor(&format!("{head}movej up, |\nendfunc\n"));
        client.set(&uri, &text);
        let offered =
            labels(&client.ask("textDocument/completion", json!({"textDocument": {"uri": uri}, "position": position})));
        let is_offered = |name: &str| offered.iter().any(|label| label.trim_end_matches(':') == name);
        assert_eq!(["v", "fast", "t", "grip"].map(is_offered), [true, true, has, has], "{robot}: {offered:?}");
        let (text, position) = cursor(&format!("{head}movej up, dura:|2\nendfunc\n"));
        client.set(&uri, &text);
        let help =
            client.ask("textDocument/signatureHelp", json!({"textDocument": {"uri": uri}, "position": position}));
        let shown = help["signatures"][0]["label"].as_str().unwrap_or_default();
        assert_eq!((shown.contains("t:"), &help["activeParameter"]), (has, &json!(dura)), "{robot}: {shown}");
    }
}

#[test]
fn signatures_show_the_parameter_at_the_cursor() {
    let folder = Folder::new("signatures");
    let (mut client, uri) = (Client::new(&folder), folder.uri("main.arl"));
    let head = "pose feeder\nfunc bool grip(int channel, bool on)\n    return on\nendfunc\nfunc void main()\n    ";
    let cases = [
        ("grip(|)", "bool grip(int channel, bool on)", json!(0)),
        ("grip(1, |)", "bool grip(int channel, bool on)", json!(1)),
        ("grip(1, tr|", "bool grip(int channel, bool on)", json!(1)),
        ("lin feeder, vl:|", "lin p:", json!(2)),
        ("offset(feeder, |1)", "pose offset(pose p", json!(1)),
        ("grip(1|2, true)", "bool grip(int channel, bool on)", json!(0)),
        ("print offset(feeder, 1, 2|.5)", "pose offset(pose p", json!(2)),
        ("grip(abs(|), true)", "abs(", json!(0)),
    ];
    for (line, label, parameter) in cases {
        let (text, position) = cursor(&format!("{head}{line}\nendfunc\n"));
        client.set(&uri, &text);
        let help =
            client.ask("textDocument/signatureHelp", json!({"textDocument": {"uri": uri}, "position": position}));
        let active = help["activeSignature"].as_u64().unwrap_or_default() as usize;
        let shown = help["signatures"][active]["label"].as_str().unwrap_or_default();
        assert!(shown.contains(label), "{line}: {help}");
        assert_eq!(help["activeParameter"], parameter, "{line}");
    }
    let (text, position) = cursor(&format!("{head}int a // grip(|\nendfunc\n"));
    client.set(&uri, &text);
    let help = client.ask("textDocument/signatureHelp", json!({"textDocument": {"uri": uri}, "position": position}));
    assert_eq!(help, Value::Null);
}

#[test]
fn what_closes_a_block_comes_of_itself() {
    let folder = Folder::new("closers");
    let (mut client, uri) = (Client::new(&folder), folder.uri("main.arl"));
    let (text, position) = cursor("func void main()\n    while(true)\n|\nendfunc\n");
    client.set(&uri, &text);
    let options = json!({"tabSize": 4, "insertSpaces": true});
    let params = json!({"textDocument": {"uri": uri}, "position": position, "ch": "\n", "options": options});
    let edits = client.ask("textDocument/onTypeFormatting", params);
    assert_eq!(edits[0]["newText"], "        ");
    assert_eq!(edits[1]["newText"], "\n    endwhile");
}

#[test]
fn formatting_changes_the_lines_that_differ() {
    let folder = Folder::new("formatting");
    let (mut client, uri) = (Client::new(&folder), folder.uri("main.arl"));
    client.set(&uri, "func void main()\n    int a = 1\n      a=a+1\nendfunc\n");
    let options = json!({"tabSize": 4, "insertSpaces": true});
    let params = json!({"textDocument": {"uri": uri}, "options": options});
    let edits = client.ask("textDocument/formatting", params);
    assert_eq!(edits[0]["newText"], "    a = a + 1\n");
    assert_eq!(edits[0]["range"]["start"], json!({"line": 2, "character": 0}));
    assert_eq!(edits.as_array().unwrap().len(), 1);
}
