"""Quick fixes: what they write leaves nothing wrong."""

import pytest
from lsprotocol import types
from pytest_lsp import client_capabilities

HEAD = "int counter\nint n = 1\nfunc void main()\n"


async def actions(editor, uri, found, only=None):
    """The actions for a diagnostic, asked for as an editor does where the cursor is in it."""
    context = types.CodeActionContext(diagnostics=[found], only=only, trigger_kind=types.CodeActionTriggerKind.Invoked)
    params = types.CodeActionParams(editor.document(uri), found.range, context)
    return await editor.client.text_document_code_action_async(params) or []


async def mend(editor, uri):
    """Applies the first fix of each mistake, until there is none."""
    titles = []
    while mistakes := [one for one in await editor.diagnostics(uri) if one.severity == types.DiagnosticSeverity.Error]:
        (action,) = await actions(editor, uri, mistakes[0])
        assert action.kind == types.CodeActionKind.QuickFix and action.is_preferred
        assert list(action.diagnostics) == [mistakes[0]]
        editor.apply(action.edit)
        titles.append(action.title)
        assert len(titles) < 5, titles
    return titles


@pytest.mark.parametrize(
    "wrong, right",
    [
        ("    if(n <> 3)\n        print n\n    endif\n", "    if(n != 3)\n        print n\n    endif\n"),
        ("    whlie(n < 3)\n        n++\n    endwhile\n", "    while(n < 3)\n        n++\n    endwhile\n"),
        ("    if(n == 1 and n < 3)\n        n++\n    endif\n", "    if(n == 1 && n < 3)\n        n++\n    endif\n"),
        ("    if(not n == 1)\n        n++\n    endif\n", "    if(! n == 1)\n        n++\n    endif\n"),
        (
            "    if(n == 1)\n        n++\n    else if(n == 2)\n        n--\n    endif\n",
            "    if(n == 1)\n        n++\n    elseif(n == 2)\n        n--\n    endif\n",
        ),
        ("    conter = 1\n", "    counter = 1\n"),
        ("    pritn n\n", "    print n\n"),
        ("    n = asb(n)\n", "    n = abs(n)\n"),
        ("    goto agian\n    again:\n", "    goto again\n    again:\n"),
        (
            "    joint h = {0, 0, 0, 0, 0, 0}\n    movej h, vpp:5%\n",
            "    joint h = {0, 0, 0, 0, 0, 0}\n    movej h, vp:5%\n",
        ),
        ("    pose p = {x 1, y 2}\n    p.cfgg = 1\n", "    pose p = {x 1, y 2}\n    p.cfg = 1\n"),
        ('    pirnt "\U0001f916", cuonter\n', '    print "\U0001f916", counter\n'),
        ('    print "\U0001f916\u70b9", n <> 1, conter\n', '    print "\U0001f916\u70b9", n != 1, counter\n'),
    ],
)
async def test_what_a_fix_writes_is_right(editor, wrong, right):
    uri = editor.open("main.arl", f"{HEAD}{wrong}endfunc\n")
    assert await mend(editor, uri)
    assert editor.text(uri) == f"{HEAD}{right}endfunc\n"
    assert await editor.errors(uri) == []


async def test_names_of_a_module_get_their_prefix(cell):
    uri = cell.open("cell.arl")
    cell.edit(uri, ("rack::full(", "full("), ("rack::count", "count"))
    assert await mend(cell, uri) == ["write `rack::full`", "write `rack::count`"]
    assert await cell.diagnostics(uri) == []


async def test_names_of_an_unsaved_module_get_their_prefix(cell):
    uri, module = cell.open("cell.arl"), cell.open("rack.arl")
    cell.edit(module, ("bool full(", "bool complete("))
    cell.edit(uri, ("rack::full(", "complete("))
    assert await mend(cell, uri) == ["write `rack::complete`"]


async def test_a_fix_in_utf8_is_in_place(silent):
    await silent.hello(client_capabilities("neovim"))
    assert silent.encoding == "utf-8"
    uri = silent.open("main.arl", f'{HEAD}    print "\U0001f916\u70b9", n <> 1\nendfunc\n')
    assert await mend(silent, uri) == ["write `!=`"]
    assert '\U0001f916\u70b9", n != 1' in silent.text(uri)


@pytest.mark.parametrize(
    "only, count",
    [
        ([types.CodeActionKind.QuickFix], 1),
        ([types.CodeActionKind.Empty], 1),
        ([types.CodeActionKind.Refactor], 0),
        ([types.CodeActionKind.SourceOrganizeImports], 0),
    ],
)
async def test_only_what_is_wanted_comes(editor, only, count):
    uri = editor.open("main.arl", f"{HEAD}    pritn n\nendfunc\n")
    (found,) = [one for one in await editor.diagnostics(uri) if one.code == "ARL0211"]
    assert len(await actions(editor, uri, found, only)) == count


async def test_where_nothing_is_wrong_there_is_nothing_to_fix(cell):
    uri = cell.open("cell.arl")
    assert await cell.diagnostics(uri) == []
    params = types.CodeActionParams(
        cell.document(uri), cell.buffers[uri].range(0, len(cell.text(uri))), types.CodeActionContext([])
    )
    assert not await cell.client.text_document_code_action_async(params)


async def test_a_fix_of_a_version_that_is_gone_is_not_offered(editor):
    uri = editor.open("main.arl", f"{HEAD}    pritn n\nendfunc\n")
    (found,) = [one for one in await editor.diagnostics(uri) if one.code == "ARL0211"]
    editor.edit(uri, ("pritn", "print"))
    assert await actions(editor, uri, found) == []
