//! The language server, as editors see it: `arl2rs lsp`, spoken to over its standard input and output.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, reason = "a test")]

mod client;
mod completion;
#[path = "../support/messages.rs"]
mod messages;
mod navigation;
mod neovim;
mod protocol;
mod random_edits;
mod typing;

use client::{Client, Folder};
use serde_json::{Value, json};

/// The text without its `|`, and where that stood.
fn cursor(text: &str) -> (String, Value) {
    let at = text.find('|').expect("a cursor");
    let before = &text[..at];
    let line = before.matches('\n').count();
    let character = before[before.rfind('\n').map_or(0, |end| end + 1)..].encode_utf16().count();
    (text.replacen('|', "", 1), json!({"line": line, "character": character}))
}

/// The names of items, in order.
fn labels(items: &Value) -> Vec<String> {
    let label = |item: &Value| item["label"].as_str().expect("a label").to_string();
    let items = items.get("items").unwrap_or(items);
    items.as_array().map(|items| items.iter().map(label).collect()).unwrap_or_default()
}
