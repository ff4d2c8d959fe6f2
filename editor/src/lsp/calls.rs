//! The callers of a function, and the functions that it calls.

use super::navigation::uses_of;
use super::programs::Program;
use super::server::{Refusal, Server};
use super::uri::path_of;
use arl2rs::hir::FuncId;
use arl2rs::index::{Meaning, Role};
use gen_lsp_types::*;
use std::collections::BTreeMap;

pub(super) fn prepare(
    server: &Server,
    params: CallHierarchyPrepareParams,
) -> Result<Option<Vec<CallHierarchyItem>>, Refusal> {
    let find = || {
        let place = server.place(&params.text_document_position_params)?;
        let Meaning::Function(id) = place.mention()?.meaning else { return None };
        Some(vec![item(server, &place.file.program, id)?])
    };
    Ok(find())
}

/// A function as the protocol shows it.
fn item(server: &Server, program: &Program, id: FuncId) -> Option<CallHierarchyItem> {
    let function = program.index().function(id)?;
    let text = program.text(function.at.file, server.encoding)?;
    let path = program.path(function.at.file)?;
    Some(CallHierarchyItem {
        name: function.name.clone(),
        kind: SymbolKind::Function,
        tags: None,
        detail: path.file_stem().map(|stem| stem.to_string_lossy().into_owned()),
        uri: server.documents.uri(path),
        range: text.range(function.span()),
        selection_range: text.range(function.at.span),
        data: None,
    })
}

pub(super) fn incoming(
    server: &Server,
    params: CallHierarchyIncomingCallsParams,
) -> Result<Option<Vec<CallHierarchyIncomingCall>>, Refusal> {
    let mut callers: BTreeMap<(String, Position), CallHierarchyIncomingCall> = BTreeMap::new();
    for (program, mention) in uses_of(server, &params.item.uri, params.item.selection_range.start) {
        if mention.role == Role::Declares {
            continue;
        }
        let caller = program.index().function_at(mention.at.file, mention.at.span.start);
        let Some(from) = caller.and_then(|id| item(server, &program, id)) else { continue };
        let Some(place) = server.location(&program, mention.at) else { continue };
        let key = (from.uri.0.clone(), from.selection_range.start);
        let call = callers.entry(key).or_insert(CallHierarchyIncomingCall { from, from_ranges: Vec::new() });
        call.from_ranges.push(place.range);
    }
    Ok(Some(callers.into_values().collect()))
}

pub(super) fn outgoing(
    server: &Server,
    params: CallHierarchyOutgoingCallsParams,
) -> Result<Option<Vec<CallHierarchyOutgoingCall>>, Refusal> {
    let Some(file) = server.file(&path_of(&params.item.uri)) else { return Ok(None) };
    let (Some(text), index) = (file.text(server), file.index()) else { return Ok(None) };
    let start = text.offset(params.item.selection_range.start);
    let Some(function) = index.function_at(file.id, start).and_then(|id| index.function(id)) else { return Ok(None) };
    let span = function.span();
    let mut called: BTreeMap<FuncId, CallHierarchyOutgoingCall> = BTreeMap::new();
    let inside = index.of_file(file.id).iter().filter(|mention| {
        mention.role == Role::Uses && span.start <= mention.at.span.start && mention.at.span.end <= span.end
    });
    for mention in inside {
        let Meaning::Function(id) = mention.meaning else { continue };
        let Some(to) = item(server, &file.program, id) else { continue };
        let call = called.entry(id).or_insert(CallHierarchyOutgoingCall { to, from_ranges: Vec::new() });
        call.from_ranges.push(text.range(mention.at.span));
    }
    Ok(Some(called.into_values().collect()))
}
