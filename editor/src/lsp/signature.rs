//! The parameters of the call or instruction around the cursor.

use super::markup::Format;
use super::programs::Program;
use super::server::{Refusal, Server};
use super::signals;
use super::typing::{Surroundings, Typing};
use arl_lang::catalog::{self, Entry, Family, Kind, Param, Presence, reference};
use arl2rs::check::{base_name, type_name};
use arl2rs::index::{ArgumentList, Callee};
use gen_lsp_types::*;

pub(super) fn offered() -> SignatureHelpOptions {
    SignatureHelpOptions {
        trigger_characters: Some(vec!["(".into(), ",".into(), " ".into()]),
        retrigger_characters: Some(vec![":".into()]),
        ..SignatureHelpOptions::default()
    }
}

pub(super) fn signature(server: &Server, params: SignatureHelpParams) -> Result<Option<SignatureHelp>, Refusal> {
    let find = || {
        let typing = Typing::at(server, &params.text_document_position_params)?;
        let (family, format) = (server.family(&typing.path), server.formats.signature);
        if typing.surroundings == Surroundings::Code
            && let Some((expected, program)) = typing.expectation(server)
            && let Some(list) = expected.arguments
        {
            return shown(&program, &list, family, format);
        }
        // In a number or a text nothing is looked for, but the argument is known.
        let file = server.file(&typing.path)?;
        let argument = signals::argument_at(&file, typing.offset)?;
        let beside = file.index().arguments(file.id).filter(|one| one.of == argument.of);
        let mut taken = vec![0; argument.parameter + 1];
        for one in beside.filter(|one| one.at != argument.at) {
            if taken.len() <= one.parameter {
                taken.resize(one.parameter + 1, 0);
            }
            if let Some(count) = taken.get_mut(one.parameter) {
                *count += 1;
            }
        }
        let parameter = Some(argument.parameter);
        let list = ArgumentList { callee: argument.callee, of: argument.of, taken, parameter, may_be_label: false };
        shown(&file.program, &list, family, format)
    };
    Ok(find())
}

fn shown(program: &Program, list: &ArgumentList, family: Family, format: Format) -> Option<SignatureHelp> {
    match list.callee {
        Callee::Function(id) => own(program, id, list, family, format),
        Callee::Builtin(entry) => Some(built_in(entry, list, family, format)),
    }
}

/// A signature whose parameters are parts of its text.
fn information(format: Format, label: String, params: Vec<(String, String)>, doc: String) -> SignatureInformation {
    let text = |text: String| (!text.is_empty()).then(|| format.documentation(text));
    let mut end = 0;
    let params = params.into_iter().map(|(part, doc)| {
        // By its place: `int a` is also the beginning of `int ab`.
        let rest = label.get(end..).unwrap_or_default();
        let start = end + rest.find(&part).unwrap_or(0);
        end = start + part.len();
        ParameterInformation {
            label: ParameterInformationLabel::Tuple((start as u32, end as u32)),
            documentation: text(doc),
        }
    });
    let params = params.collect();
    SignatureInformation { label, documentation: text(doc), parameters: Some(params), active_parameter: None }
}

fn help(signatures: Vec<SignatureInformation>, chosen: usize, parameter: Option<usize>) -> SignatureHelp {
    // Without a number editors mark the first parameter: a number past the last one marks none.
    let behind = || signatures.iter().filter_map(|one| one.parameters.as_ref()).map(Vec::len).max().unwrap_or(0);
    let parameter = parameter.unwrap_or_else(behind);
    SignatureHelp {
        signatures,
        active_signature: Some(chosen as u32),
        active_parameter: Some(ActiveParameter::Int(parameter as u32)),
    }
}

fn own(
    program: &Program,
    id: arl2rs::hir::FuncId,
    list: &ArgumentList,
    family: Family,
    format: Format,
) -> Option<SignatureHelp> {
    let function = program.index().function(id)?;
    let param = |(name, ty, _): &(String, Option<arl2rs::hir::Type>, _)| {
        format!("{} {name}", ty.map_or_else(|| "?".into(), |ty| type_name(ty, family)))
    };
    let params: Vec<String> = function.params.iter().map(param).collect();
    let result = function.result.map_or("?", |base| base_name(base, family));
    let label = format!("{result} {}({})", function.name, params.join(", "));
    let doc = super::describe::comment_above(program, function.at);
    let params = params.into_iter().map(|param| (param, String::new())).collect();
    Some(help(vec![information(format, label, params, doc)], 0, list.parameter))
}

/// The overloads of a built-in that the robot's family has, those that take as many arguments first.
fn built_in(entry: &'static Entry, list: &ArgumentList, family: Family, format: Format) -> SignatureHelp {
    let all = match entry.kind {
        Kind::Function => catalog::functions(entry.name),
        Kind::Instruction => catalog::instructions(entry.name),
    };
    let of_family = all.iter().filter(|one| one.family.is_none_or(|only| only == family));
    let overloads: Vec<&Entry> = of_family.collect();
    let given: usize = list.taken.iter().sum();
    let takes = |one: &&Entry| {
        let repeats = one.params.iter().any(|param| matches!(param.presence, Presence::Repeat { .. }));
        repeats || one.params.len() > given
    };
    let chosen = overloads.iter().position(takes).unwrap_or(0);
    let has = |param: &&Param| param.is_of(family);
    let signatures = overloads.iter().map(|one| {
        let params = one.params.iter().filter(has).map(|param| {
            let label = match one.kind {
                Kind::Function => reference::prototype(param),
                Kind::Instruction => format!("{}:", param.name),
            };
            (label, reference::parameter(one, param))
        });
        information(format, reference::signature(one, Some(family)), params.collect(), one.doc.to_string())
    });
    // Its index among those that are shown.
    let parameter = list.parameter.map(|at| entry.params.iter().take(at).filter(has).count());
    help(signatures.collect(), chosen, parameter)
}
