//! All places of a file that mean what the place under the cursor means.

use super::server::{Refusal, Server};
use arl2rs::index::{Meaning, Mention, Role};
use gen_lsp_types::*;

pub(super) fn highlights(
    server: &Server,
    params: DocumentHighlightParams,
) -> Result<Option<Vec<DocumentHighlight>>, Refusal> {
    Ok(find(server, &params.text_document_position_params))
}

fn find(server: &Server, at: &TextDocumentPositionParams) -> Option<Vec<DocumentHighlight>> {
    let place = server.place(at)?;
    let meaning = place.mention()?.meaning;
    let text = place.file.text(server)?;
    let same = |mention: &&Mention| is_same(mention.meaning, meaning);
    let all = place.file.index().of_file(place.file.id).iter().filter(same);
    let highlight = |mention: &Mention| DocumentHighlight {
        range: text.range(mention.at.span),
        kind: Some(match mention.role {
            Role::Writes | Role::Declares => DocumentHighlightKind::Write,
            Role::Uses => DocumentHighlightKind::Read,
        }),
    };
    Some(all.map(highlight).collect())
}

/// Overloads of a built-in are one thing to a reader.
fn is_same(one: Meaning, other: Meaning) -> bool {
    match (one, other) {
        (Meaning::Builtin(one), Meaning::Builtin(other)) => one.kind == other.kind && one.name == other.name,
        _ => one == other,
    }
}
