"""What a name is, where it is declared, where it is used."""

import pytest
from lsprotocol import types


async def hover(editor, uri, words):
    found = await editor.client.text_document_hover_async(types.HoverParams(**editor.at(uri, words)))
    return found and (found.contents.value, editor.buffers[uri].cut(found.range))


@pytest.mark.parametrize(
    "words, name, expected",
    [
        ("movej ho|me", "home", "joint home = {0, -90, 90, 0, 90, 0}"),
        ("movej |home", "home", "Where the robot waits."),
        ("movej home|", "home", "global variable"),
        ("round < RO|WS", "ROWS", "const int ROWS = 3"),
        ("round|++", "round", "int round"),
        ("if(gr|ip(1", "grip", "Grips a part."),
        ("height + g|ap", "gap", "double gap"),
        ("rack::fu|ll(", "full", "func bool full(int number)"),
        ("!ra|ck::", "rack", "Where parts lie."),
        ("rack::count = PLA|CED", "PLACED", "int placed"),
        ("goto ag|ain", "again", "again:"),
        ("mov|ej", "movej", "movej"),
        ("v|p:50%", "vp", "%"),
        ("get|di", "getdi", "bool getdi"),
        ("|waittime 2", "waittime", "waittime"),
        ("func b|ool grip", "bool", "true"),
        ("wh|ile(", "while", "# while"),
        ("    els|e", "else", "# if"),
        ("endw|hile", "endwhile", "# while"),
        ("fu|nc void main", "func", "# func"),
        ("got|o", "goto", "# goto"),
        ("imp|ort", "import", "# import"),
        ("ret|urn", "return", "# return"),
        ("con|st", "const", "# variables"),
    ],
)
async def test_hover_tells_what_a_word_is(cell, words, name, expected):
    uri = cell.open("cell.arl")
    value, under = await hover(cell, uri, words)
    assert under == name
    assert expected.lower() in value.lower()


@pytest.mark.parametrize("words", ["// Grips| a part", "int placed |= 0", "\n|\nconst int ROWS"])
async def test_hover_says_nothing_where_there_is_no_name(cell, words):
    assert await hover(cell, cell.open("cell.arl"), words) is None


@pytest.mark.parametrize(
    "words, file, line",
    [
        ("movej ho|me", "cell.arl", "joint |home ="),
        ("rack::fu|ll(", "rack.arl", "bool |full("),
        ("height + g|ap", "cell_data.arl", "double |gap"),
        ("rack::count = PLA|CED", "cell.arl", "int |placed = 0"),
        ("goto ag|ain", "cell.arl", "|again:"),
        ("setdo(channel, clo|se)", "cell.arl", "bool |close)"),
        ("!ra|ck::", "rack.arl", "|// Where parts lie."),
        ('"rack|.arl"', "rack.arl", "|// Where parts lie."),
    ],
)
async def test_definition_goes_to_the_declaration(cell, words, file, line):
    uri, target = cell.open("cell.arl"), cell.open(file)
    found = await cell.client.text_document_definition_async(types.DefinitionParams(**cell.at(uri, words)))
    assert cell.name(found.uri) == file
    assert found.range.start == cell.buffers[target].at(line)


@pytest.mark.parametrize("words", ["mov|ej", "wh|ile(", "// Grips| a part"])
async def test_what_is_built_in_has_no_definition(cell, words):
    params = types.DefinitionParams(**cell.at(cell.open("cell.arl"), words))
    assert not await cell.client.text_document_definition_async(params)


async def references(editor, uri, words, with_declaration=True):
    context = types.ReferenceContext(include_declaration=with_declaration)
    params = types.ReferenceParams(context=context, **editor.at(uri, words))
    found = await editor.client.text_document_references_async(params)
    return [(editor.name(one.uri), one.range.start.line + 1) for one in found]


async def test_references_go_across_files(cell):
    uri = cell.open("cell.arl")
    declared, uses = ("rack.arl", 2), [("cell.arl", 20), ("rack.arl", 6)]
    assert sorted(await references(cell, uri, "rack::co|unt")) == sorted([declared, *uses])
    assert sorted(await references(cell, uri, "rack::co|unt", False)) == uses


async def test_references_are_the_same_from_each_end(cell):
    uri, data = cell.open("cell.arl"), cell.open("cell_data.arl")
    expected = [("cell.arl", 15), ("cell_data.arl", 3)]
    assert await references(cell, uri, "height + g|ap") == expected
    assert await references(cell, data, "double ga|p") == expected


async def test_references_ignore_case(cell):
    uri = cell.open("cell.arl")
    lines = [line for _, line in await references(cell, uri, "int pla|ced = 0")]
    assert lines == [6, 17, 18, 20, 33]


async def test_references_of_a_local_stay_in_its_function(editor):
    text = "func void f()\n    int a\n    a = 1\nendfunc\nfunc void main()\n    int a\n    a = 2\nendfunc\n"
    uri = editor.open("main.arl", text)
    assert await references(editor, uri, "|a = 2") == [("main.arl", 6), ("main.arl", 7)]


async def test_references_from_a_module_find_programs_that_are_not_open(cell):
    module = cell.open("rack.arl")
    assert ("cell.arl", 17) in await references(cell, module, "bool fu|ll(")


async def test_highlights_tell_reading_from_writing(cell):
    uri = cell.open("cell.arl")
    params = types.DocumentHighlightParams(**cell.at(uri, "int rou|nd"))
    found = await cell.client.text_document_document_highlight_async(params)
    kinds = [one.kind for one in found]
    read, write = types.DocumentHighlightKind.Read, types.DocumentHighlightKind.Write
    assert kinds == [write, read, write]
    assert {cell.buffers[uri].cut(one.range) for one in found} == {"round"}
