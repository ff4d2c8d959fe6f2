//! Random programs with random edits: what the server tells is what `arl2rs check` says, and no request ends it.

use super::{Client, Folder};
use arl2rs::sources::FileSystem;
use arl2rs::{CheckOptions, check};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Small and the same everywhere.
struct Random(u64);

impl Random {
    fn below(&mut self, most: usize) -> usize {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((self.0 >> 33) as usize) % most.max(1)
    }
}

fn programs() -> Vec<PathBuf> {
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/conformance");
    let mut found = Vec::new();
    for area in std::fs::read_dir(corpus).unwrap().flatten().map(|entry| entry.path()).filter(|path| path.is_dir()) {
        let files = std::fs::read_dir(area).unwrap().flatten().map(|entry| entry.path());
        found.extend(files.filter(|path| path.extension().is_some_and(|ending| ending == "arl")));
    }
    found.sort();
    found
}

/// A change of a text: a line is taken out, doubled, or a part of it is replaced by something typical of typing.
fn edit(text: &str, random: &mut Random) -> (Value, String) {
    const TYPED: [&str; 12] =
        ["(", ")", "endif\n", "movej ", "\"", "x", " = ", "{", "// ", ",", "func void f()\n", "\u{1f916}"];
    let lines: Vec<&str> = text.split_inclusive('\n').collect();
    let line = random.below(lines.len());
    let old = lines.get(line).copied().unwrap_or_default();
    let at = |line: usize, character: usize| json!({"line": line, "character": character});
    let (start, end, new) = match random.below(4) {
        0 => (at(line, 0), at(line + 1, 0), String::new()),
        1 => (at(line, 0), at(line, 0), old.to_string()),
        _ => {
            let length = old.trim_end().encode_utf16().count();
            let from = random.below(length + 1);
            let to = (from + random.below(3)).min(length);
            (at(line, from), at(line, to), TYPED[random.below(TYPED.len())].to_string())
        }
    };
    let offset = |place: &Value| {
        let (line, character) =
            (place["line"].as_u64().unwrap() as usize, place["character"].as_u64().unwrap() as usize);
        let start: usize = lines.iter().take(line).map(|line| line.len()).sum();
        let mut units = 0;
        let inside = lines.get(line).map_or(0, |line| {
            line.char_indices()
                .find(|(_, one)| {
                    let there = units >= character;
                    units += one.len_utf16();
                    there
                })
                .map_or(line.len(), |(at, _)| at)
        });
        start + inside
    };
    let (from, to) = (offset(&start), offset(&end).max(offset(&start)));
    let changed = format!("{}{new}{}", &text[..from], &text[to..]);
    (json!([{"range": {"start": start, "end": end}, "text": new}]), changed)
}

/// What `check` says of a file, as code and first line.
fn expected(path: &Path) -> Vec<(String, u64)> {
    let first = check(path, &FileSystem, &CheckOptions::default());
    // A file without `main` is a module to an editor.
    let checked = match first.diagnostics.iter().any(|one| one.code.to_string() == "ARL0501") {
        true => check(path, &FileSystem, &CheckOptions { library: true, ..CheckOptions::default() }),
        false => first,
    };
    let here = checked.diagnostics.iter().filter(|one| one.primary.at.file.0 == 0);
    let mut all: Vec<_> =
        here.map(|one| (one.code.to_string(), u64::from(checked.files.line(one.primary.at)) - 1)).collect();
    all.sort();
    all
}

#[test]
fn the_server_says_what_check_says() {
    let rounds: usize = std::env::var("ARL_PROPERTY_COUNT").ok().and_then(|text| text.parse().ok()).unwrap_or(1);
    let seed: u64 = std::env::var("ARL_PROPERTY_SEED").ok().and_then(|text| text.parse().ok()).unwrap_or(0);
    let mut random = Random(seed.wrapping_mul(977) + 7);
    let folder = Folder::new("random_edits");
    let mut client = Client::new(&folder);
    let programs = programs();
    let requests = ["hover", "definition", "completion", "signatureHelp", "documentHighlight"];
    for _ in 0..60 * rounds {
        let source = &programs[random.below(programs.len())];
        let Ok(mut text) = std::fs::read_to_string(source) else { continue };
        let uri = folder.uri("program.arl");
        client.set(&uri, &text);
        for _ in 0..5 {
            let (changes, changed) = edit(&text, &mut random);
            client.edit(&uri, changes);
            text = changed;
            std::fs::write(folder.path.join("program.arl"), &text).unwrap();
            let mut published: Vec<(String, u64)> = client
                .diagnostics(&uri)
                .iter()
                .map(|one| (one["code"].as_str().unwrap().to_string(), one["range"]["start"]["line"].as_u64().unwrap()))
                .collect();
            published.sort();
            assert_eq!(published, expected(&folder.path.join("program.arl")), "{}:\n{text}", source.display());
            let line = random.below(text.lines().count() + 1);
            let position = json!({"line": line, "character": random.below(40)});
            let request = requests[random.below(requests.len())];
            client.ask(&format!("textDocument/{request}"), json!({"textDocument": {"uri": uri}, "position": position}));
        }
        client.close(&uri);
    }
    assert!(client.leave());
}
