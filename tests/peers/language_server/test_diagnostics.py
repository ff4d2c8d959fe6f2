"""What is wrong with a text, told for each version of it."""

import pytest
from lsprotocol import types

RIGHT = "func void main()\n    print 1\nendfunc\n"
WRONG = RIGHT.replace("print", "pritn")


async def test_a_mistake_is_reported_where_it_stands_and_cleared_when_mended(editor):
    uri = editor.open("main.arl", WRONG, version=7)
    (found,) = await editor.diagnostics(uri)
    assert (found.code, found.source, found.severity) == ("ARL0211", "arl2rs", types.DiagnosticSeverity.Error)
    assert editor.buffers[uri].cut(found.range) == "pritn"
    assert editor.client.published[-1].version == 7
    editor.edit(uri, ("pritn", "print"))
    assert await editor.diagnostics(uri) == []
    assert editor.client.published[-1].version == 8


async def test_whole_texts_and_parts_may_come_in_turn(editor):
    uri = editor.open("main.arl", RIGHT)
    assert await editor.codes(uri) == []
    editor.set(uri, WRONG)
    assert await editor.codes(uri) == ["ARL0211"]
    editor.edit(uri, ("pritn 1\n", "print 1\n    print 2\n"), ("print 2", "print nothing"))
    (found,) = await editor.diagnostics(uri)
    assert found.code == "ARL0201" and editor.buffers[uri].cut(found.range) == "nothing"
    editor.set(uri, RIGHT)
    assert await editor.codes(uri) == []


async def test_changes_of_one_message_count_one_after_the_other(editor):
    uri = editor.open("main.arl", RIGHT)
    editor.edit(uri, ("    print 1\n", ""), ("main()\n", "main()\n    int a\n"), ("int a", "int b = 1\n    print b"))
    assert editor.text(uri) == "func void main()\n    int b = 1\n    print b\nendfunc\n"
    assert await editor.codes(uri) == []


async def test_the_whole_text_and_a_part_may_come_in_one_message(editor):
    uri = editor.open("main.arl", WRONG)
    buffer = editor.buffers[uri]
    buffer.text = WRONG
    whole = types.TextDocumentContentChangeWholeDocument(text=WRONG)
    at = WRONG.index("pritn")
    editor.change(uri, [whole, editor.part(buffer, at, at + 5, "print")])
    assert await editor.codes(uri) == []


async def test_the_last_version_is_reported_behind_many_keys(editor):
    uri = editor.open("main.arl", "")
    for at, one in enumerate(WRONG):
        editor.splice(uri, at, at, one)
    assert await editor.codes(uri) == ["ARL0211"]
    versions = [one.version for one in editor.client.published]
    assert versions == sorted(set(versions))


async def test_deleting_everything_leaves_nothing_wrong(editor):
    uri = editor.open("main.arl", WRONG)
    editor.splice(uri, 0, len(WRONG), "")
    assert await editor.diagnostics(uri) == []
    editor.splice(uri, 0, 0, WRONG)
    assert await editor.codes(uri) == ["ARL0211"]


async def test_what_nobody_needs_is_shown_pale(editor):
    uri = editor.open("main.arl", "func void main()\n    int spare\nendfunc\n")
    (found,) = await editor.diagnostics(uri)
    assert found.severity == types.DiagnosticSeverity.Warning
    assert list(found.tags) == [types.DiagnosticTag.Unnecessary]
    assert editor.buffers[uri].cut(found.range) == "spare"


async def test_other_places_explain_a_mistake(editor):
    uri = editor.open("main.arl", "int a\nint A\nfunc void main()\nendfunc\n")
    (found,) = await editor.diagnostics(uri)
    (related,) = found.related_information
    assert editor.buffers[uri].cut(related.location.range) == "a"


async def test_a_mistake_of_a_module_is_reported_at_the_module(cell):
    cell.write("rack.arl", "int count = nothing\nfunc bool full(int number)\n    return number > count\nendfunc\n")
    uri, module = cell.open("cell.arl"), cell.open("rack.arl")
    assert await cell.errors(module) == ["ARL0201"]
    assert await cell.errors(uri) == []


async def test_a_data_file_is_seen_by_its_program(cell):
    data = cell.open("cell_data.arl")
    assert await cell.diagnostics(data) == []
    program = cell.open("cell.arl")
    assert await cell.diagnostics(program) == []
    mark = cell.mark()
    cell.edit(data, ("gap =", "space ="))
    found = await cell.first_diagnostics(program, mark)
    assert [(one.code, cell.buffers[program].cut(one.range)) for one in found] == [("ARL0201", "gap")]
    mark = cell.mark()
    cell.edit(data, ("space =", "gap ="))
    assert await cell.first_diagnostics(program, mark) == []


@pytest.mark.parametrize("name", ["new.arl", "untitled:new.arl", "untitled:Untitled-1"])
async def test_closing_clears_what_was_reported_of_a_buffer_without_a_file(editor, name):
    uri = editor.open(name, WRONG)
    assert await editor.codes(uri) == ["ARL0211"]
    mark = editor.mark()
    editor.close(uri)
    assert await editor.first_diagnostics(uri, mark) == []


async def test_a_thousand_mistakes_are_reported_at_most(editor):
    text = "func void main()\n" + "    pritn 1\n" * 1200 + "endfunc\n"
    uri = editor.open("main.arl", text)
    assert len(await editor.diagnostics(uri)) == 1000
