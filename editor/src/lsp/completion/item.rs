//! The items of a completion.

use crate::lsp::markup::Format;
use crate::lsp::server::Server;
use crate::lsp::typing::Typing;
use arl_lang::catalog::{Entry, Param, reference};
use gen_lsp_types::*;

/// How near an item is to what is probably meant; nearer ones are shown first.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) enum Rank {
    Label,
    Local,
    Global,
    Function,
    Constant,
    BuiltIn,
    Keyword,
    /// What fits only with an index or a component after it.
    Part,
}

/// Items, collected.
pub(super) struct Items {
    /// The range that an item replaces.
    range: Range,
    snippets: bool,
    format: Format,
    is_begun: bool,
    all: Vec<CompletionItem>,
}

impl Items {
    pub(super) fn new(server: &Server, typing: &Typing<'_>) -> Self {
        let is_begun = typing.word.start < typing.word.end;
        let (range, format) = (typing.text.range(typing.word), server.formats.completion);
        Self { range, snippets: server.snippets, format, is_begun, all: Vec::new() }
    }

    /// Whether a part of the name is there already.
    pub(super) fn is_begun(&self) -> bool {
        self.is_begun
    }

    /// Replaces a range that begins at another byte than the name before the cursor.
    pub(super) fn replace(&mut self, range: Range) {
        self.range = range;
    }

    pub(super) fn add(&mut self, label: &str, kind: CompletionItemKind, rank: Rank, detail: String) {
        self.push(label, label.to_string(), kind, rank, detail, None, false);
    }

    pub(super) fn documented(&mut self, label: &str, kind: CompletionItemKind, rank: Rank, detail: String, doc: &str) {
        self.push(label, label.to_string(), kind, rank, detail, Some(doc.to_string()), false);
    }

    /// A function: with parentheses, the cursor between them where it takes arguments.
    pub(super) fn function(&mut self, name: &str, takes: bool, rank: Rank, detail: String, doc: Option<String>) {
        let text = match (takes, self.snippets) {
            (true, true) => format!("{name}($1)"),
            (true, false) => format!("{name}("),
            (false, _) => format!("{name}()"),
        };
        let snippet = takes && self.snippets;
        self.push(name, text, CompletionItemKind::Function, rank, detail, doc, snippet);
    }

    /// The label of a built-in's parameter.
    pub(super) fn argument_label(&mut self, entry: &Entry, param: &Param) {
        let detail = param.units.first().map_or_else(String::new, |unit| format!("in {}", unit.text()));
        let label = format!("{}:", param.name);
        let doc = reference::parameter(entry, param);
        self.push(&label, label.clone(), CompletionItemKind::Field, Rank::Label, detail, Some(doc), false);
    }

    /// The label of a parameter of one of the program's functions.
    pub(super) fn own_label(&mut self, name: &str) {
        let label = format!("{name}:");
        self.push(&label, label.clone(), CompletionItemKind::Field, Rank::Label, String::new(), None, false);
    }

    #[expect(clippy::too_many_arguments, reason = "all that an item is")]
    fn push(
        &mut self,
        label: &str,
        text: String,
        kind: CompletionItemKind,
        rank: Rank,
        detail: String,
        doc: Option<String>,
        snippet: bool,
    ) {
        let documentation = doc.map(|text| self.format.documentation(text));
        self.all.push(CompletionItem {
            label: label.to_string(),
            kind: Some(kind),
            detail: (!detail.is_empty()).then_some(detail),
            documentation,
            sort_text: Some(format!("{}{}", rank as u8, label.to_ascii_lowercase())),
            insert_text_format: snippet.then_some(InsertTextFormat::Snippet),
            text_edit: Some(CompletionItemTextEdit::TextEdit(TextEdit { range: self.range, new_text: text })),
            ..CompletionItem::default()
        });
    }

    /// The items, each name once: a nearer item hides one that is farther away.
    pub(super) fn finish(mut self) -> Vec<CompletionItem> {
        self.all.sort_by(|one, other| one.sort_text.cmp(&other.sort_text));
        let mut seen = std::collections::HashSet::new();
        self.all.retain(|item| seen.insert(item.label.to_ascii_lowercase()));
        self.all
    }
}
