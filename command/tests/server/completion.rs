//! What is offered at a place, and what is not. The cases are in `completion.txt`:
//!
//! ```text
//! # title
//! a line of `main`, or more, with | where the cursor is
//! => names that are offered ;; !names that are not
//! => nothing
//! => first, second ...      these are offered first, in this order
//! ```

use super::{Client, Folder, cursor, labels};
use serde_json::json;

const RACK: &str =
    "pose slot = {x 1, y 2, z 3, a 0, b 180, c 0}\nint count\nfunc bool full(int n)\n    return n > 3\nendfunc\n";
const HEAD: &str = "import \"rack.arl\"
joint home = {0, -90, 90, 0, 90, 0}
pose feeder = {x 900, y -500, z 400, a 0, b 180, c 0}
double limit = 50
int numbers[4]
const int ROWS = 3
func bool grip(int channel, bool on)
    return on
endfunc
func void main()
    int placed = 0
    bool late
";
const END: &str = "\n    again:\n    rack::count = numbers[placed]\nendfunc\nfunc void later()\nendfunc\n";

#[test]
fn what_fits_is_offered_and_nothing_else() {
    let folder = Folder::new("completion").with("rack.arl", RACK);
    let (mut client, uri) = (Client::new(&folder), folder.uri("main.arl"));
    let mut failed = Vec::new();
    for case in include_str!("completion.txt").split("# ").skip(1) {
        let (title, rest) = case.split_once('\n').expect("a title and a program");
        let (lines, expected) = rest.split_once("=> ").expect("what is expected");
        let lines = lines.trim_end_matches('\n');
        // Lines that are not indented are a file of their own.
        let whole = match lines.starts_with("    ") {
            true => format!("{HEAD}{lines}{END}"),
            false => lines.to_string(),
        };
        let (text, position) = cursor(&whole);
        client.set(&uri, &text);
        let items = client.ask("textDocument/completion", json!({"textDocument": {"uri": uri}, "position": position}));
        let offered = labels(&items);
        if let Some(wrong) = wrong(&offered, expected.trim()) {
            failed.push(format!("{title}: {wrong}\n   offered: {}", offered.join(" ")));
        }
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}

/// What differs from what is expected.
fn wrong(offered: &[String], expected: &str) -> Option<String> {
    if expected == "nothing" {
        return (!offered.is_empty()).then(|| "nothing was expected".into());
    }
    let (wanted, unwanted) = expected.split_once(";;").unwrap_or((expected, ""));
    if let Some(first) = wanted.trim().strip_suffix("...") {
        let first: Vec<&str> = first.split(',').map(str::trim).collect();
        return (offered.get(..first.len()) != Some(&first.iter().map(ToString::to_string).collect::<Vec<_>>()[..]))
            .then(|| format!("{first:?} should come first"));
    }
    let is_there = |name: &str| offered.iter().any(|label| label == name);
    let missing = wanted.split_whitespace().find(|name| !is_there(name));
    let spare = unwanted.split_whitespace().filter_map(|name| name.strip_prefix('!')).find(|name| is_there(name));
    missing.map(|name| format!("{name} is missing")).or(spare.map(|name| format!("{name} does not fit")))
}
