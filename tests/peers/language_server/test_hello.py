"""Hello and goodbye, as editors say them."""

import pytest
from lsprotocol import types
from pytest_lsp import client_capabilities

EDITORS = {
    "visual-studio-code": "utf-16",
    "neovim@v0.8": "utf-16",
    "neovim@v0.10": "utf-16",
    "neovim": "utf-8",
    "emacs": "utf-8",
}
PROGRAM = 'int unknown = "\U0001f916" + nothing\nfunc void main()\nendfunc\n'


@pytest.mark.parametrize("name", EDITORS)
async def test_editors_say_hello(silent, name):
    result = await silent.hello(client_capabilities(name))
    assert result.server_info.name == "arl2rs"
    assert silent.encoding == EDITORS[name]
    sync = silent.offered.text_document_sync
    assert sync.open_close and sync.change == types.TextDocumentSyncKind.Incremental
    uri = silent.open("main.arl", PROGRAM)
    assert await silent.errors(uri)
    assert await silent.leave() == 0


async def test_clients_that_say_nothing_of_encodings_get_utf16(silent):
    result = await silent.hello()
    assert result.capabilities.position_encoding in (None, "utf-16")


@pytest.mark.parametrize(
    "offered, chosen", [(["utf-16"], "utf-16"), (["utf-32", "utf-16"], "utf-16"), (["utf-16", "utf-8"], "utf-8")]
)
async def test_encodings_are_what_both_know(silent, offered, chosen):
    general = types.GeneralClientCapabilities(position_encodings=offered)
    await silent.hello(types.ClientCapabilities(general=general))
    assert silent.encoding == chosen


async def test_a_folder_may_be_named_by_its_address_alone(silent):
    silent.write("rack.arl", "int shelves\n")
    await silent.hello(workspace_folders=None)
    found = await silent.client.workspace_symbol_async(types.WorkspaceSymbolParams(query="shelves"))
    assert [silent.name(one.location.uri) for one in found] == ["rack.arl"]


async def test_no_folder_is_needed(silent):
    await silent.hello(workspace_folders=None, root_uri=None)
    uri = silent.open("untitled:Untitled-1", PROGRAM)
    assert await silent.errors(uri)


async def test_news_of_files_are_asked_for_where_the_client_can(silent):
    await silent.hello(client_capabilities("visual-studio-code"))
    await silent.until(lambda: silent.client.registrations)
    (registration,) = silent.client.registrations
    assert registration.method == types.WORKSPACE_DID_CHANGE_WATCHED_FILES
    patterns = [watcher["globPattern"] for watcher in registration.register_options["watchers"]]
    assert "**/*.arl" in patterns


async def test_news_of_files_are_not_asked_for_where_the_client_cannot(silent):
    await silent.hello(client_capabilities("neovim"))
    assert await silent.errors(silent.open("main.arl", PROGRAM))
    assert silent.client.registrations == []


async def test_two_folders_are_both_searched(silent):
    silent.write("one/rack.arl", "int shelves\n")
    silent.write("two/shelf.arl", "int shelves\n")
    folders = [types.WorkspaceFolder(uri=silent.uri(name), name=name) for name in ("one", "two")]
    await silent.hello(workspace_folders=folders)
    found = await silent.client.workspace_symbol_async(types.WorkspaceSymbolParams(query="shelves"))
    assert sorted(silent.name(one.location.uri) for one in found) == ["one/rack.arl", "two/shelf.arl"]


async def test_goodbye_ends_the_server_well(editor):
    editor.open("main.arl", PROGRAM)
    assert await editor.leave() == 0


async def test_exit_without_shutdown_is_reported(silent):
    await silent.hello()
    silent.client.exit(None)
    assert await silent.client._server.wait() == 1


async def test_a_lost_client_ends_the_server(silent):
    await silent.hello()
    silent.client._server.stdin.close()
    assert await silent.client._server.wait() == 1


async def test_after_shutdown_requests_are_refused(editor):
    uri = editor.open("main.arl", PROGRAM)
    await editor.client.shutdown_async(None)
    hover = editor.client.text_document_hover_async(types.HoverParams(**editor.at(uri, "noth|ing")))
    assert (await editor.refused(hover)).code == types.ErrorCodes.InvalidRequest
    editor.client.exit(None)
    assert await editor.client._server.wait() == 0


@pytest.mark.parametrize(
    "settings, code", [({"robot": "hsr065"}, "ARL0208"), ({"arl2rs": {"robot": "hsr065"}}, "ARL0208"), (None, None)]
)
async def test_settings_come_with_hello(silent, settings, code):
    await silent.hello(settings=settings)
    uri = silent.open("main.arl", "joint home = {j1 0, j5 0}\n")
    assert await silent.codes(uri) == [code] * (code is not None)


async def test_settings_change_later(editor):
    uri = editor.open("main.arl", "joint home = {j1 0, j5 0}\n")
    assert await editor.codes(uri) == []
    mark = editor.mark()
    settings = {"arl2rs": {"robot": "hsr065"}}
    editor.client.workspace_did_change_configuration(types.DidChangeConfigurationParams(settings=settings))
    assert (await editor.first_diagnostics(uri, mark))[0].code == "ARL0208"
    settings = {"arl2rs": {"robot": "no-such-robot"}}
    editor.client.workspace_did_change_configuration(types.DidChangeConfigurationParams(settings=settings))
    await editor.until(lambda: editor.client.messages)
    assert "no-such-robot" in editor.client.messages[0].message
