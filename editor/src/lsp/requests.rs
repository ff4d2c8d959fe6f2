//! Which file answers which request.

use super::server::{Refusal, Server};
use super::transport::{answer as reply, refusal};
use super::{actions, calls, completion, folding, formatting, highlights, hints, hover, lenses, navigation, rename};
use super::{signature, symbols, tokens};
use gen_lsp_types::json_rpc::Id;
use gen_lsp_types::*;
use serde_json::Value;

/// The requests that ask for all uses of something, and so need to know all programs.
const OF_ALL_PROGRAMS: [&str; 4] =
    ["textDocument/references", "textDocument/rename", "callHierarchy/incomingCalls", "workspace/symbol"];

/// Answers a request.
pub(super) fn answer(server: &mut Server, id: &Id, method: &str, params: Value) -> Value {
    if !OF_ALL_PROGRAMS.contains(&method) {
        return answer_one(server, id, method, params);
    }
    server.look_at_all();
    let answer = answer_one(server, id, method, params);
    server.forget_unopened();
    answer
}

fn answer_one(server: &Server, id: &Id, method: &str, params: Value) -> Value {
    let call = Call { server, id, params };
    match method {
        "textDocument/hover" => call.by::<HoverRequest>(hover::hover),
        "textDocument/definition" => call.by::<DefinitionRequest>(navigation::definition),
        "textDocument/references" => call.by::<ReferencesRequest>(navigation::references),
        "textDocument/documentHighlight" => call.by::<DocumentHighlightRequest>(highlights::highlights),
        "textDocument/prepareRename" => call.by::<PrepareRenameRequest>(rename::prepare),
        "textDocument/rename" => call.by::<RenameRequest>(rename::rename),
        "textDocument/documentSymbol" => call.by::<DocumentSymbolRequest>(symbols::of_document),
        "workspace/symbol" => call.by::<WorkspaceSymbolRequest>(symbols::of_workspace),
        "textDocument/prepareCallHierarchy" => call.by::<CallHierarchyPrepareRequest>(calls::prepare),
        "callHierarchy/incomingCalls" => call.by::<CallHierarchyIncomingCallsRequest>(calls::incoming),
        "callHierarchy/outgoingCalls" => call.by::<CallHierarchyOutgoingCallsRequest>(calls::outgoing),
        "textDocument/completion" => call.by::<CompletionRequest>(completion::completion),
        "textDocument/signatureHelp" => call.by::<SignatureHelpRequest>(signature::signature),
        "textDocument/foldingRange" => call.by::<FoldingRangeRequest>(folding::folding),
        "textDocument/semanticTokens/full" => call.by::<SemanticTokensRequest>(tokens::full),
        "textDocument/semanticTokens/range" => call.by::<SemanticTokensRangeRequest>(tokens::range),
        "textDocument/inlayHint" => call.by::<InlayHintRequest>(hints::hints),
        "textDocument/codeAction" => call.by::<CodeActionRequest>(actions::actions),
        "textDocument/codeLens" => call.by::<CodeLensRequest>(lenses::lenses),
        "textDocument/formatting" => call.by::<DocumentFormattingRequest>(formatting::all),
        "textDocument/onTypeFormatting" => call.by::<DocumentOnTypeFormattingRequest>(formatting::typed),
        _ => refusal(id, ErrorCodes::MethodNotFound, &format!("`{method}` is not supported")),
    }
}

/// A request on its way to its handler.
struct Call<'a> {
    server: &'a Server,
    id: &'a Id,
    params: Value,
}

impl Call<'_> {
    fn by<R: Request>(self, handle: fn(&Server, R::Params) -> Result<R::Result, Refusal>) -> Value {
        let params = match serde_json::from_value(self.params) {
            Ok(params) => params,
            Err(error) => return refusal(self.id, ErrorCodes::InvalidParams, &error.to_string()),
        };
        match handle(self.server, params) {
            Ok(result) => reply(self.id, &result),
            Err(Refusal { code, message }) => refusal(self.id, code, &message),
        }
    }
}
