//! Where something is declared, and where it is used.

use super::places::Declared;
use super::programs::Program;
use super::server::{Refusal, Server};
use arl2rs::index::{Meaning, Mention, Role};
use gen_lsp_types::*;
use std::path::PathBuf;
use std::rc::Rc;

pub(super) fn definition(server: &Server, params: DefinitionParams) -> Result<Option<DefinitionResponse>, Refusal> {
    Ok(find(server, &params.text_document_position_params))
}

fn find(server: &Server, at: &TextDocumentPositionParams) -> Option<DefinitionResponse> {
    let place = server.place(at)?;
    let mention = place.mention()?;
    let declared = place.file.index().declaration(mention.meaning)?;
    let location = server.location(&place.file.program, declared)?;
    Some(DefinitionResponse::Definition(Definition::Location(location)))
}

pub(super) fn references(server: &Server, params: ReferenceParams) -> Result<Option<Vec<Location>>, Refusal> {
    let with_declaration = params.context.include_declaration;
    let at = &params.text_document_position_params;
    let found = uses_of(server, &at.text_document.uri, at.position);
    let wanted = |(_, mention): &(Rc<Program>, Mention)| with_declaration || mention.role != Role::Declares;
    let found = found.into_iter().filter(wanted);
    Ok(Some(found.filter_map(|(program, mention)| server.location(&program, mention.at)).collect()))
}

/// All places, in all programs that know it, of what the place means, in an order that does not depend on the place.
pub(super) fn uses_of(server: &Server, uri: &Uri, position: Position) -> Vec<(Rc<Program>, Mention)> {
    let Some(place) = server.place_at(uri, position) else { return Vec::new() };
    let Some(mention) = place.mention() else { return Vec::new() };
    let index = place.file.index();
    let program = &place.file.program;
    let declared = index.declaration(mention.meaning).and_then(|at| Declared::new(program, at));
    let mut found: Vec<(Declared, Rc<Program>, Mention)> = Vec::new();
    for other in programs_with(server, program, declared.as_ref()) {
        let meaning = match &declared {
            Some(declared) => meaning_of(&other, declared, mention.meaning),
            None => Some(mention.meaning),
        };
        let same = meaning.into_iter().flat_map(|meaning| other.index().with(meaning));
        found.extend(same.filter_map(|mention| Some((Declared::new(&other, mention.at)?, other.clone(), *mention))));
    }
    found.sort_by(|one, other| one.0.cmp(&other.0));
    found.dedup_by(|one, other| one.0 == other.0);
    found.into_iter().map(|(_, program, mention)| (program, mention)).collect()
}

/// The programs in which something declared there may be used. A built-in, which nothing declares, is looked for in
/// `own` only.
fn programs_with(server: &Server, own: &Rc<Program>, declared: Option<&Declared>) -> Vec<Rc<Program>> {
    let Some(declared) = declared else { return vec![own.clone()] };
    let mut roots: Vec<PathBuf> = server.workspace.dependents(&declared.path);
    roots.push(declared.path.clone());
    roots.extend(server.documents.paths().cloned());
    roots.sort();
    roots.dedup();
    let programs = roots.iter().filter_map(|root| server.program(root));
    let mut programs: Vec<Rc<Program>> = programs.filter(|program| program.file(&declared.path).is_some()).collect();
    programs.push(own.clone());
    programs
}

/// What `meaning` of another program is in this program: ids differ, places do not.
fn meaning_of(program: &Program, declared: &Declared, meaning: Meaning) -> Option<Meaning> {
    let file = program.file(&declared.path)?;
    if let Meaning::Module(_) = meaning {
        return program.index().module_of(file).map(Meaning::Module);
    }
    let mention = program.index().at(file, declared.start)?;
    (mention.at.span.start == declared.start && mention.role == Role::Declares).then_some(mention.meaning)
}
