//! The parameters of the call or instruction around the cursor.

use super::describe::{full_type, type_name};
use super::programs::Program;
use super::server::{Refusal, Server};
use super::typing::{Surroundings, Typing};
use crate::index::{ArgumentList, Callee};
use arl_lang::catalog::{self, Entry, Family, Kind, Presence, reference};
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
        if typing.surroundings != Surroundings::Code {
            return None;
        }
        let (expected, program) = typing.expectation(server)?;
        let list = expected.arguments?;
        Some(match list.callee {
            Callee::Function(id) => own(&program, id, &list, server.options.family)?,
            Callee::Builtin(entry) => built_in(entry, &list, server.options.family),
        })
    };
    Ok(find())
}

/// A signature whose parameters are parts of its text.
fn information(label: String, params: Vec<(String, String)>, doc: String) -> SignatureInformation {
    let text = |value: String| {
        (!value.is_empty()).then_some(Documentation::MarkupContent(MarkupContent { kind: MarkupKind::Markdown, value }))
    };
    let params = params.into_iter().map(|(label, doc)| ParameterInformation {
        label: ParameterInformationLabel::String(label),
        documentation: text(doc),
    });
    SignatureInformation { label, documentation: text(doc), parameters: Some(params.collect()), active_parameter: None }
}

fn help(signatures: Vec<SignatureInformation>, chosen: usize, parameter: Option<usize>) -> SignatureHelp {
    SignatureHelp {
        signatures,
        active_signature: Some(chosen as u32),
        active_parameter: parameter.map(|at| ActiveParameter::Int(at as u32)),
    }
}

fn own(program: &Program, id: crate::hir::FuncId, list: &ArgumentList, family: Family) -> Option<SignatureHelp> {
    let function = program.index().function(id)?;
    let param = |(name, ty, _): &(String, Option<crate::hir::Type>, _)| {
        format!("{} {name}", ty.map_or_else(|| "?".into(), |ty| full_type(ty, family)))
    };
    let params: Vec<String> = function.params.iter().map(param).collect();
    let result = function.result.map_or("?", |base| type_name(base, family));
    let label = format!("{result} {}({})", function.name, params.join(", "));
    let doc = super::describe::comment_above(program, function.at);
    let params = params.into_iter().map(|param| (param, String::new())).collect();
    Some(help(vec![information(label, params, doc)], 0, list.parameter))
}

/// The overloads of a built-in that the robot's family has, those that take as many arguments first.
fn built_in(entry: &'static Entry, list: &ArgumentList, family: Family) -> SignatureHelp {
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
    let signatures = overloads.iter().map(|one| {
        let params = one.params.iter().map(|param| {
            let label = match one.kind {
                Kind::Function => reference::prototype(param),
                Kind::Instruction => format!("{}:", param.name),
            };
            (label, reference::parameter(one, param))
        });
        information(reference::signature(one), params.collect(), one.doc.to_string())
    });
    help(signatures.collect(), chosen, list.parameter)
}
