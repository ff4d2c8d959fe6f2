//! Quick fixes: the corrections that diagnostics suggest.

use super::server::{Refusal, Server};
use arl2rs::diagnostics::Diagnostic as Found;
use gen_lsp_types::*;
use std::collections::HashMap;

pub(super) fn actions(server: &Server, params: CodeActionParams) -> Result<Option<Vec<CodeActionResponse>>, Refusal> {
    let wanted = params.context.only.as_ref();
    if wanted
        .is_some_and(|only| !only.iter().any(|kind| [CodeActionKind::QuickFix, CodeActionKind::Empty].contains(kind)))
    {
        return Ok(None);
    }
    let find = || {
        let file = server.document(&params.text_document)?;
        let part = file.text(server)?.span(params.range);
        let here = |found: &&Found| {
            let at = found.primary.at;
            at.file == file.id && at.span.start <= part.end && part.start <= at.span.end
        };
        let fixes = file.program.checked.diagnostics.iter().filter(here).filter_map(|found| {
            let fix = found.fix.as_ref()?;
            let place = server.location(&file.program, fix.at)?;
            let edit = TextEdit { range: place.range, new_text: fix.text.clone() };
            let code = Some(Code::String(found.code.to_string()));
            let sent = params.context.diagnostics.iter().filter(|sent| sent.code == code);
            Some(CodeActionResponse::CodeAction(CodeAction {
                title: format!("write `{}`", fix.text),
                kind: Some(CodeActionKind::QuickFix),
                diagnostics: Some(sent.cloned().collect()),
                is_preferred: Some(true),
                edit: Some(WorkspaceEdit {
                    changes: Some(HashMap::from([(place.uri, vec![edit])])),
                    ..WorkspaceEdit::default()
                }),
                ..CodeAction::default()
            }))
        });
        Some(fixes.collect())
    };
    Ok(find())
}
