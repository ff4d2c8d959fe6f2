"""What a server must stand: requests that are not wanted any more, come too early, or make no sense."""

import asyncio

import pytest
from lsprotocol import types
from pygls.exceptions import JsonRpcException

from editor import wait

RIGHT = "int a\nfunc void main()\n    a = 1\nendfunc\n"


async def lives(editor):
    """Whether the server still does its work."""
    uri = editor.open("alive.arl", RIGHT.replace("a = 1", "a = nothing"))
    assert await editor.errors(uri) == ["ARL0201"]
    editor.close(uri)


@pytest.mark.parametrize("method", ["textDocument/hover", "workspace/symbol", "shutdown", "no/such/method"])
async def test_requests_before_hello_are_refused(silent, method):
    error = await silent.refused(silent.request(method, {}))
    assert error.code == types.ErrorCodes.ServerNotInitialized
    await silent.hello()
    await lives(silent)


async def test_texts_before_hello_count_for_nothing(silent):
    silent.open("main.arl", "nonsense")
    await silent.hello()
    await lives(silent)
    assert [one for one in silent.client.published if one.uri.endswith("main.arl")] == []


async def test_hello_that_makes_no_sense_may_be_sent_again(silent):
    request = silent.request("initialize", {"capabilities": 5})
    assert (await silent.refused(request)).code == types.ErrorCodes.InvalidParams
    await silent.hello()
    await lives(silent)


async def test_hello_twice_is_refused(editor):
    params = types.InitializeParams(capabilities=types.ClientCapabilities())
    error = await editor.refused(editor.client.initialize_async(params))
    assert error.code == types.ErrorCodes.InvalidRequest
    await lives(editor)


@pytest.mark.parametrize(
    "method",
    [
        "textDocument/hover",
        "textDocument/completion",
        "textDocument/signatureHelp",
        "textDocument/definition",
        "textDocument/references",
        "textDocument/documentHighlight",
        "textDocument/documentSymbol",
        "textDocument/codeAction",
        "textDocument/codeLens",
        "textDocument/formatting",
        "textDocument/onTypeFormatting",
        "textDocument/rename",
        "textDocument/prepareRename",
        "textDocument/foldingRange",
        "textDocument/semanticTokens/full",
        "textDocument/semanticTokens/range",
        "textDocument/inlayHint",
        "textDocument/prepareCallHierarchy",
        "callHierarchy/incomingCalls",
        "callHierarchy/outgoingCalls",
        "workspace/symbol",
    ],
)
async def test_parameters_that_make_no_sense_get_an_error(editor, method):
    for params in [{}, {"textDocument": 5}, {"textDocument": {"uri": 5}, "position": {"line": -1}, "query": 7}, [1, 2]]:
        error = await editor.refused(editor.request(method, params))
        assert error.code == types.ErrorCodes.InvalidParams
    await lives(editor)


@pytest.mark.parametrize("method", ["no/such/method", "textDocument/declaration", "$/unheardOf"])
async def test_requests_that_are_not_known_get_an_error(editor, method):
    error = await editor.refused(editor.request(method, {}))
    assert error.code == types.ErrorCodes.MethodNotFound
    await lives(editor)


@pytest.mark.parametrize(
    "method, params",
    [
        ("textDocument/didOpen", {"wrong": True}),
        ("textDocument/didChange", {"textDocument": {"uri": "file:///x.arl"}, "contentChanges": 5}),
        ("textDocument/didClose", []),
        ("workspace/didChangeWatchedFiles", {"changes": [{"uri": 1}]}),
    ],
)
async def test_notices_that_make_no_sense_are_shown(editor, method, params):
    editor.send({"jsonrpc": "2.0", "method": method, "params": params})
    await editor.until(lambda: editor.client.messages)
    assert method in editor.client.messages[0].message
    await lives(editor)


async def test_notices_that_are_not_known_are_passed_over(editor):
    editor.send({"jsonrpc": "2.0", "method": "$/unheardOf", "params": {}})
    editor.send({"jsonrpc": "2.0", "method": "no/such/notice"})
    await lives(editor)
    assert editor.client.messages == []


async def test_what_is_no_message_is_answered_and_passed_over(editor):
    for body in [
        b"{ this is not JSON",
        b"",
        b"[]",
        b"7",
        b"\xff\xfe",
        {"jsonrpc": "2.0"},
        {"jsonrpc": "2.0", "id": {}, "method": "shutdown"},
    ]:
        editor.send(body)
    await lives(editor)


async def test_changes_of_a_file_that_is_not_open_count_for_nothing(editor):
    uri = editor.uri("main.arl")
    document = types.VersionedTextDocumentIdentifier(uri=uri, version=1)
    change = types.TextDocumentContentChangeWholeDocument(text="nonsense")
    editor.client.text_document_did_change(types.DidChangeTextDocumentParams(document, [change]))
    editor.client.text_document_did_close(types.DidCloseTextDocumentParams(editor.document(uri)))
    await lives(editor)


async def test_requests_for_a_file_that_is_nowhere_find_nothing(editor):
    document = editor.document(editor.uri("nowhere.arl"))
    place = {"text_document": document, "position": types.Position(3, 3)}
    client = editor.client
    assert not await client.text_document_hover_async(types.HoverParams(**place))
    assert not await client.text_document_definition_async(types.DefinitionParams(**place))
    assert not await client.text_document_completion_async(types.CompletionParams(**place))
    assert not await client.text_document_folding_range_async(types.FoldingRangeParams(document))
    assert not await client.text_document_code_lens_async(types.CodeLensParams(document))
    assert not await client.text_document_document_symbol_async(types.DocumentSymbolParams(document))
    await lives(editor)


async def test_places_within_a_character_do_no_harm(editor):
    text = RIGHT + 'string s = "\U0001f916\U0001f916"\n'
    uri = editor.open("main.arl", text)
    quote = editor.buffers[uri].at('string s = |"')
    inside = types.Position(quote.line, quote.character + 2)
    place = {"text_document": editor.document(uri), "position": inside}
    await editor.client.text_document_hover_async(types.HoverParams(**place))
    await editor.client.text_document_completion_async(types.CompletionParams(**place))
    change = types.TextDocumentContentChangePartial(range=types.Range(inside, inside), text="x")
    editor.change(uri, [change])
    await lives(editor)


async def outcome(answer):
    """The result of a request, or the code of its error."""
    try:
        return await wait(answer)
    except JsonRpcException as error:
        return error.code


async def test_each_cancelled_request_is_answered_once(cell):
    uri = cell.open("cell.arl")
    send = cell.client.protocol.send_request
    params = types.ReferenceParams(context=types.ReferenceContext(True), **cell.at(uri, "rack::fu|ll"))
    numbers = [f"search {at}" for at in range(50)]
    answers = [asyncio.wrap_future(send("textDocument/references", params, msg_id=number)) for number in numbers]
    for number in numbers:
        cell.client.cancel_request(types.CancelParams(id=number))
    found = [await outcome(answer) for answer in answers]
    cancelled = [one for one in found if one == types.LSPErrorCodes.RequestCancelled]
    # How many the server got to before is a matter of time.
    done = [one for one in found if isinstance(one, (list, tuple))]
    assert len(cancelled) + len(done) == 50 and all(len(one) == 2 for one in done)
    await lives(cell)


async def test_a_request_that_is_not_cancelled_is_done(cell):
    uri = cell.open("cell.arl")
    send = cell.client.protocol.send_request
    params = types.HoverParams(**cell.at(uri, "rack::fu|ll"))
    answers = {at: asyncio.wrap_future(send("textDocument/hover", params, msg_id=at)) for at in range(1, 40)}
    for at in range(1, 40, 2):
        cell.client.cancel_request(types.CancelParams(id=at))
    for at, answer in answers.items():
        found = await outcome(answer)
        assert found == types.LSPErrorCodes.RequestCancelled and at % 2 or "full" in found.contents.value


async def test_what_is_not_there_may_be_cancelled(editor):
    editor.client.cancel_request(types.CancelParams(id="nothing"))
    editor.send({"jsonrpc": "2.0", "method": "$/cancelRequest", "params": {}})
    await lives(editor)
