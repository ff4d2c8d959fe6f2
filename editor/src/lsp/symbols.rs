//! The declarations of a file, and those of the workspace.

use super::places::File;
use super::server::{Refusal, Server};
use arl_lang::catalog::Family;
use arl2rs::check::{base_name, type_name};
use arl2rs::diagnostics::Location as Place;
use arl2rs::index::{FunctionInfo, GlobalInfo};
use gen_lsp_types::*;
use std::path::{Path, PathBuf};

pub(super) fn of_document(
    server: &Server,
    params: DocumentSymbolParams,
) -> Result<Option<DocumentSymbolResponse>, Refusal> {
    Ok(server.document(&params.text_document).map(|file| {
        let mut all = declared(server, &file);
        all.sort_by_key(|symbol| symbol.selection_range.start);
        DocumentSymbolResponse::DocumentSymbolList(all)
    }))
}

/// The functions and globals of a file.
#[expect(deprecated, reason = "the field is there, and has to be left empty")]
fn declared(server: &Server, file: &File) -> Vec<DocumentSymbol> {
    let index = file.index();
    let Some(text) = file.text(server) else { return Vec::new() };
    let family = file.program.family;
    let symbol = |name: &str, detail: String, kind: SymbolKind, span, at: Place| DocumentSymbol {
        name: name.to_string(),
        detail: Some(detail),
        kind,
        tags: None,
        deprecated: None,
        range: text.range(span),
        selection_range: text.range(at.span),
        children: None,
    };
    let functions = index.functions.iter().filter(|function| function.at.file == file.id).map(|function| {
        let detail = signature(family, function);
        symbol(&function.name, detail, SymbolKind::Function, function.span(), function.at)
    });
    let globals = index.globals.iter().filter(|global| global.at.file == file.id).map(|global| {
        let detail = global.ty.map(|ty| type_name(ty, family)).unwrap_or_default();
        symbol(&global.name, detail, kind(global), global.declaration.to(global.at.span), global.at)
    });
    functions.chain(globals).collect()
}

fn kind(global: &GlobalInfo) -> SymbolKind {
    if global.constant { SymbolKind::Constant } else { SymbolKind::Variable }
}

/// `pose (pose, double)`: a function's type in short.
fn signature(family: Family, function: &FunctionInfo) -> String {
    let params = function.params.iter().map(|(_, ty, _)| ty.map_or_else(|| "?".into(), |ty| type_name(ty, family)));
    let params = params.collect::<Vec<_>>().join(", ");
    let result = function.result.map_or("?", |base| base_name(base, family));
    format!("{result} ({params})")
}

pub(super) fn of_workspace(
    server: &Server,
    params: WorkspaceSymbolParams,
) -> Result<Option<WorkspaceSymbolResponse>, Refusal> {
    let mut paths: Vec<_> = server.workspace.programs().chain(server.documents.paths()).cloned().collect();
    // Data files are not programs of their own.
    let data: Vec<_> = paths.iter().filter_map(|path| data_beside(path)).collect();
    paths.extend(data);
    paths.sort();
    paths.dedup();
    let mut found = Vec::new();
    for path in paths {
        let Some(file) = server.file(&path) else { continue };
        let module = path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
        for symbol in declared(server, &file).into_iter().filter(|symbol| fits(&symbol.name, &params.query)) {
            let location = Location { uri: server.documents.uri(&path), range: symbol.selection_range };
            found.push(WorkspaceSymbol {
                location: WorkspaceSymbolLocation::Location(location),
                data: None,
                base_symbol_information: BaseSymbolInformation {
                    name: symbol.name,
                    kind: symbol.kind,
                    tags: None,
                    container_name: module.clone(),
                },
            });
        }
    }
    Ok(Some(WorkspaceSymbolResponse::WorkspaceSymbolList(found)))
}

/// The data file of a program, where there is one.
fn data_beside(program: &Path) -> Option<PathBuf> {
    let stem = program.file_stem()?.to_string_lossy();
    Some(program.with_file_name(format!("{stem}_data.arl"))).filter(|path| path.is_file())
}

/// Whether a name has all characters of the query, in their order.
fn fits(name: &str, query: &str) -> bool {
    let mut rest = name.chars().map(|one| one.to_ascii_lowercase());
    query.chars().filter(|one| !one.is_whitespace()).all(|one| rest.any(|other| other == one.to_ascii_lowercase()))
}
