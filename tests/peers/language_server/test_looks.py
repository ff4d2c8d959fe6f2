"""How a program is shown: outline, folds, colours, hints, lenses, layout."""

import pytest
from lsprotocol import types

from buffer import Buffer


async def test_the_outline_has_functions_and_globals(cell):
    uri = cell.open("cell.arl")
    found = await cell.client.text_document_document_symbol_async(types.DocumentSymbolParams(cell.document(uri)))
    kinds = [(one.name, one.kind.name, one.detail) for one in found]
    assert kinds == [
        ("ROWS", "Constant", "int"),
        ("home", "Variable", "joint"),
        ("placed", "Variable", "int"),
        ("grip", "Function", "bool (int, bool)"),
        ("place", "Function", "void (double)"),
        ("main", "Function", "void ()"),
    ]
    buffer = cell.buffers[uri]
    for one in found:
        assert buffer.cut(one.selection_range) == one.name
        assert one.name in buffer.cut(one.range)
        assert (
            one.kind != types.SymbolKind.Function
            or buffer.cut(one.range).startswith("func")
            and buffer.cut(one.range).endswith("endfunc")
        )


async def test_the_outline_of_a_data_file_has_its_points(cell):
    uri = cell.open("cell_data.arl")
    found = await cell.client.text_document_document_symbol_async(types.DocumentSymbolParams(cell.document(uri)))
    assert [(one.name, one.detail) for one in found] == [("feeder", "pose"), ("gap", "double")]


async def test_the_outline_is_there_behind_a_mistake(editor):
    uri = editor.open("main.arl", "int a\nfunc void f()\n    if(\nendfunc\nfunc void main()\nendfunc\n")
    found = await editor.client.text_document_document_symbol_async(types.DocumentSymbolParams(editor.document(uri)))
    assert [one.name for one in found] == ["a", "f", "main"]


async def workspace_symbols(editor, query):
    found = await editor.client.workspace_symbol_async(types.WorkspaceSymbolParams(query=query))
    return sorted((one.name, editor.name(one.location.uri), one.container_name) for one in found)


async def test_symbols_of_the_workspace_are_found_without_opening_anything(cell):
    assert await workspace_symbols(cell, "full") == [("full", "rack.arl", "rack")]
    assert await workspace_symbols(cell, "GRP") == [("grip", "cell.arl", "cell")]
    assert await workspace_symbols(cell, "nothing like this") == []


async def test_an_empty_query_finds_everything(cell):
    names = [name for name, _, _ in await workspace_symbols(cell, "")]
    assert {"full", "grip", "main", "count", "home"} <= set(names)


async def test_symbols_of_data_files_are_found(cell):
    assert await workspace_symbols(cell, "feeder") == [("feeder", "cell_data.arl", "cell_data")]


async def test_symbols_are_those_of_unsaved_texts(cell):
    module = cell.open("rack.arl")
    cell.edit(module, ("bool full(", "bool complete("))
    assert await workspace_symbols(cell, "complete") == [("complete", "rack.arl", "rack")]
    assert await workspace_symbols(cell, "full") == []


async def folds(editor, text):
    uri = editor.open("main.arl", text)
    found = await editor.client.text_document_folding_range_async(types.FoldingRangeParams(editor.document(uri)))
    return sorted(
        (one.start_line + 1, one.end_line + 1, one.kind and str(getattr(one.kind, "value", one.kind))) for one in found
    )


async def test_functions_and_blocks_fold(editor):
    text = "func void main()\n    if(true)\n        print 1\n    else\n        print 2\n    endif\nendfunc\n"
    assert await folds(editor, text) == [(1, 6, None), (2, 5, None)]


async def test_comments_and_regions_fold(editor):
    text = "// one\n// two\nint a\n// region points\nint b\n// endregion\n"
    assert await folds(editor, text) == [(1, 2, "comment"), (4, 6, "region")]


async def test_folds_survive_what_is_not_closed(editor):
    assert await folds(editor, "func void f()\n    while(true)\n        print 1\nendfunc\n") == [(1, 3, None)]


async def tokens(editor, uri, range=None):
    """The tokens as text, kind and modifiers."""
    document = editor.document(uri)
    if range:
        params = types.SemanticTokensRangeParams(document, range)
        found = await editor.client.text_document_semantic_tokens_range_async(params)
    else:
        params = types.SemanticTokensParams(document)
        found = await editor.client.text_document_semantic_tokens_full_async(params)
    legend, buffer = editor.offered.semantic_tokens_provider.legend, editor.buffers[uri]
    all, line, character, last = [], 0, 0, types.Position(0, 0)
    for at in range_of_fives(found.data):
        down, right, length, kind, bits = found.data[at : at + 5]
        line, character = line + down, right if down else character + right
        start = types.Position(line, character)
        assert last <= start, "tokens overlap"
        last = types.Position(line, character + length)
        text = buffer.cut(types.Range(start, last))
        modifiers = {name for bit, name in enumerate(legend.token_modifiers) if bits >> bit & 1}
        all.append((text, legend.token_types[kind], modifiers))
    return all


def range_of_fives(data):
    assert len(data) % 5 == 0
    return range(0, len(data), 5)


async def test_colours_tell_what_names_are(cell):
    found = await tokens(cell, cell.open("cell.arl"))
    for expected in [
        ("ROWS", "variable", {"declaration", "readonly"}),
        ("ROWS", "variable", {"readonly"}),
        ("home", "variable", {"declaration"}),
        ("grip", "function", {"declaration"}),
        ("grip", "function", set()),
        ("channel", "parameter", {"declaration"}),
        ("channel", "parameter", set()),
        ("rack", "namespace", set()),
        ("count", "variable", {"modification"}),
        ("movej", "keyword", {"defaultLibrary"}),
        ("vp", "property", {"defaultLibrary"}),
        ("offset", "function", {"defaultLibrary"}),
        ("joint", "type", {"defaultLibrary"}),
        ("again", "label", {"declaration"}),
        ("again", "label", set()),
    ]:
        assert expected in found
    assert "while" not in {text for text, _, _ in found}


async def test_colours_behind_an_emoji_are_in_place(editor):
    uri = editor.open("main.arl", 'int a\nfunc void main()\n    print "\U0001f916", a, "\u70b9", a\nendfunc\n')
    assert [text for text, _, _ in await tokens(editor, uri)][-3:] == ["print", "a", "a"]


async def test_colours_of_a_part_are_those_of_the_whole(cell):
    uri = cell.open("cell.arl")
    text = cell.text(uri)
    start, end = text.index("func void place"), text.index("func void main")
    part = await tokens(cell, uri, cell.buffers[uri].range(start, end))
    whole = await tokens(cell, uri)
    assert part and any(whole[at : at + len(part)] == part for at in range(len(whole)))
    assert "place" in part[1] and len(part) < len(whole)


async def hints(editor, uri, range):
    params = types.InlayHintParams(editor.document(uri), range)
    found = await editor.client.text_document_inlay_hint_async(params)
    return [(editor.buffers[uri].offset(one.position), one.label) for one in found]


async def test_hints_name_parameters_and_units(editor):
    text = (
        "func void step(int count, double way)\nendfunc\nfunc void main()\n    step(3, 2.5)\n    waittime 2\nendfunc\n"
    )
    uri = editor.open("main.arl", text)
    whole = editor.buffers[uri].range(0, len(text))
    assert await hints(editor, uri, whole) == [
        (text.index("3,"), "count:"),
        (text.index("2.5"), "way:"),
        (text.index("2\nendfunc") + 1, "s"),
    ]
    line = editor.buffers[uri].range(text.index("    waittime"), text.index("    waittime") + 4)
    assert await hints(editor, uri, line) == []


async def test_hints_behind_an_emoji_are_in_place(editor):
    half = "func int half(int n, int m)\n    return n / m\nendfunc\n"
    text = half + 'func void main()\n    print "\U0001f916", half(4, m:2)\nendfunc\n'
    uri = editor.open("main.arl", text)
    found = await hints(editor, uri, editor.buffers[uri].range(0, len(text)))
    assert found == [(text.index("4, m"), "n:")]


async def lenses(editor, uri):
    return await editor.client.text_document_code_lens_async(types.CodeLensParams(editor.document(uri)))


async def test_lenses_stand_above_main(cell):
    uri = cell.open("cell.arl")
    found = await lenses(cell, uri)
    assert [(one.command.title, one.command.command) for one in found] == [
        ("run", "arl2rs.run"),
        ("plot", "arl2rs.plot"),
    ]
    assert {cell.buffers[uri].cut(one.range) for one in found} == {"main"}
    assert {one.command.arguments[0] for one in found} == {uri}


async def test_a_case_can_be_tested(cell):
    cell.write("cell.out", "1\n")
    found = await lenses(cell, cell.open("cell.arl"))
    assert [one.command.command for one in found] == ["arl2rs.run", "arl2rs.plot", "arl2rs.test"]


async def test_modules_have_no_lenses(cell):
    assert not await lenses(cell, cell.open("rack.arl"))


OPTIONS = types.FormattingOptions(tab_size=4, insert_spaces=True)


async def formatted(editor, text, name="main.arl"):
    uri = editor.open(name, text)
    params = types.DocumentFormattingParams(editor.document(uri), OPTIONS)
    edits = await editor.client.text_document_formatting_async(params)
    return editor.buffers[uri].applied(edits or []), edits


async def test_formatting_lays_a_program_out(editor):
    text, _ = await formatted(editor, "func void main( )\n  int a=1\n      a=a+1\nendfunc\n")
    assert text == "func void main()\n    int a = 1\n    a = a + 1\nendfunc\n"


async def test_formatting_leaves_what_is_laid_out(cell):
    uri = cell.open("cell.arl")
    params = types.DocumentFormattingParams(cell.document(uri), OPTIONS)
    assert not await cell.client.text_document_formatting_async(params)


async def test_formatting_twice_changes_nothing_more(editor):
    text = 'int   x\nfunc void main( )\nif(x==1)\nprint "\U0001f916"  ,x\nendif\nendfunc'
    once, _ = await formatted(editor, text)
    twice, edits = await formatted(editor, once, "other.arl")
    assert twice == once and not edits


async def test_formatting_changes_the_differing_lines_only(editor):
    before = "func void main()\n    int a = 1\n      a=a+1\nendfunc\n"
    _, edits = await formatted(editor, before)
    (edit,) = edits
    assert Buffer(before, editor.encoding).cut(edit.range) == "      a=a+1\n"


async def test_formatting_keeps_line_ends(editor):
    text, _ = await formatted(editor, "func void main()\r\nprint   1\r\nendfunc\r\n")
    assert text == "func void main()\r\n    print 1\r\nendfunc\r\n"


async def test_formatting_leaves_lines_with_mistakes(editor):
    text, _ = await formatted(editor, "func void main()\n  print   1\n  print  (  (\nendfunc\n")
    assert "    print 1\n" in text and "print  (  (" in text
