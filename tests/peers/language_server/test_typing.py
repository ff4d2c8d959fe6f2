"""What helps while somebody types: completion, signatures, the end of a block."""

from itertools import pairwise

import pytest
from lsprotocol import types
from pytest_lsp import client_capabilities

from buffer import Buffer

HEAD = """import "rack.arl"
joint home = {0, -90, 90, 0, 90, 0}
int parts
// Counts on.
func int add(int one, int other)
    return one + other
endfunc
"""


async def complete(editor, line, outside=False):
    """The file, and the items at the `|` of a line in `main`."""
    editor.write("rack.arl", "int count\nfunc bool full(int n)\n    return n > count\nendfunc\n")
    text = line if outside else f"{HEAD}func void main()\n{line}\nendfunc\n"
    uri = editor.open("main.arl", text.replace("|", ""))
    position = Buffer(text.replace("|", ""), editor.encoding).position(text.index("|"))
    params = types.CompletionParams(text_document=editor.document(uri), position=position)
    found = await editor.client.text_document_completion_async(params)
    for item in found.items:
        # The protocol wants a part of the cursor's line that holds the cursor.
        range = item.text_edit.range
        assert range.start.line == range.end.line and range.start <= position <= range.end
    return uri, found.items


def labels(items):
    return [item.label for item in items]


@pytest.mark.parametrize(
    "line, offered, not_offered",
    [
        ("    mo|", ["movej", "parts", "add"], ["while(", "sin"]),
        ("    wh|", ["while"], []),
        ("    movej |", ["home", "j:", "vp:"], ["movej", "while"]),
        ("    movej home, |", ["vp:", "dura:"], ["j:"]),
        ("    parts = rack::|", ["count", "full"], ["parts", "sin"]),
        ("    parts = add(|", ["one:", "parts"], ["home"]),
        ("    home.|", ["j1", "j6"], ["x", "parts"]),
        ("    $|", ["$VEL_PROFILE", "$WOBJS"], ["parts"]),
        ("    waittime 2|", ["s"], ["parts"]),
        ("    parts = 1 // pa|", [], ["parts"]),
        # In front of a name that is there already.
        ("    movej |home", ["home", "j:"], ["movej"]),
        ("    parts = |parts + 1", ["parts", "add"], []),
        ("    parts = rack::|count", ["count", "full"], ["parts"]),
        # Nothing fits into a call that takes nothing.
        ("    print cdate(|)", [], ["parts", "home"]),
        ('    print "pa|"', [], ["parts"]),
    ],
)
async def test_what_fits_is_offered(editor, line, offered, not_offered):
    _, items = await complete(editor, line)
    names = labels(items)
    assert [name for name in offered if name not in names] == []
    assert [name for name in not_offered if name in names] == []


@pytest.mark.parametrize(
    "line, offered",
    [("|", ["func", "import", "const", "int"]), ('import "|"', ["rack.arl"]), ('import "ra|"', ["rack.arl"])],
)
async def test_what_fits_outside_of_functions_is_offered(editor, line, offered):
    _, items = await complete(editor, line, outside=True)
    assert [name for name in offered if name not in labels(items)] == []


async def test_an_item_takes_the_place_of_what_was_typed(editor):
    uri, items = await complete(editor, "    par|")
    item = next(item for item in items if item.label == "parts")
    assert editor.buffers[uri].cut(item.text_edit.range) == "par"
    editor.set(uri, editor.buffers[uri].applied([item.text_edit]).replace("parts\n", "parts = 1\n"))
    assert await editor.errors(uri) == []


async def test_items_lie_behind_an_emoji(editor):
    uri, items = await complete(editor, '    print "\U0001f916", par|')
    item = next(item for item in items if item.label == "parts")
    assert editor.buffers[uri].cut(item.text_edit.range) == "par"


async def test_items_carry_their_reference(editor):
    _, items = await complete(editor, "    parts = a|")
    ours = next(item for item in items if item.label == "add")
    assert "Counts on." in ours.documentation.value
    built_in = next(item for item in items if item.label == "abs")
    assert built_in.documentation.kind == types.MarkupKind.Markdown and built_in.documentation.value


async def test_functions_are_snippets_where_the_client_can(silent):
    await silent.hello(client_capabilities("visual-studio-code"))
    _, items = await complete(silent, "    parts = a|")
    item = next(item for item in items if item.label == "add")
    assert (item.insert_text_format, item.text_edit.new_text) == (types.InsertTextFormat.Snippet, "add($1)")


async def test_functions_are_plain_where_the_client_cannot(editor):
    _, items = await complete(editor, "    parts = a|")
    assert {item.insert_text_format for item in items} <= {None, types.InsertTextFormat.PlainText}
    assert all("$1" not in item.text_edit.new_text for item in items)


@pytest.mark.parametrize("name", ["visual-studio-code", "neovim", "emacs"])
async def test_items_are_what_the_editor_can_show(silent, name):
    await silent.hello(client_capabilities(name))
    # pytest-lsp compares them with what the editor announces.
    _, items = await complete(silent, "    movej |")
    assert items


async def test_hover_is_plain_where_the_client_cannot_show_more(silent):
    hover = types.HoverClientCapabilities(content_format=[types.MarkupKind.PlainText])
    await silent.hello(types.ClientCapabilities(text_document=types.TextDocumentClientCapabilities(hover=hover)))
    uri = silent.open("main.arl", "func void main()\nendfunc\n")
    found = await silent.client.text_document_hover_async(types.HoverParams(**silent.at(uri, "ma|in")))
    assert found.contents.kind == types.MarkupKind.PlainText


@pytest.mark.parametrize("name", ["visual-studio-code", "neovim"])
async def test_items_are_resolved_where_that_is_offered(silent, name):
    await silent.hello(client_capabilities(name))
    _, items = await complete(silent, "    movej |")
    assert items
    if silent.offered.completion_provider.resolve_provider:
        for item in items:
            assert (await silent.client.completion_item_resolve_async(item)).label == item.label


async def signature(editor, line, above=""):
    """The signature at the `|` of a line in `main`."""
    uri = editor.open("main.arl", f"{HEAD}{above}func void main()\n{line.replace('|', '')}\nendfunc\n")
    params = types.SignatureHelpParams(**editor.at(uri, line))
    return await editor.client.text_document_signature_help_async(params)


@pytest.mark.parametrize(
    "line, label, parameter",
    [
        ("    parts = add(|)", "int add(int one, int other)", "int one"),
        ("    parts = add(1, |2)", "int add(int one, int other)", "int other"),
        ("    parts = add(1, add(|2, 3))", "int add(int one, int other)", "int one"),
        ("    parts = add(other:1, one:|2)", "int add(int one, int other)", "int one"),
        ("    movej home, vp:|50%", "movej", "vp:"),
        ('    print "\U0001f916", add(1, |2)', "int add(int one, int other)", "int other"),
    ],
)
async def test_the_parameter_at_the_cursor_is_marked(editor, line, label, parameter):
    found = await signature(editor, line)
    chosen = found.signatures[found.active_signature or 0]
    assert label in chosen.label
    marked = chosen.parameters[found.active_parameter].label
    assert (marked if isinstance(marked, str) else chosen.label[slice(*marked)]) == parameter


@pytest.mark.parametrize("line", ["    parts = add(next(|), 2)", "    print cdate(|)"])
async def test_a_call_without_parameters_is_not_taken_for_the_one_around_it(editor, line):
    found = await signature(editor, line, "func int next()\n    return 1\nendfunc\n")
    assert found is None or found.signatures[0].label.split("(")[0].endswith(("next", "cdate"))


async def test_typeof_has_a_signature(editor):
    found = await signature(editor, "    string kind = typeof(|parts)")
    assert "typeof" in found.signatures[0].label


async def test_a_parameter_that_is_given_is_not_marked(editor):
    found = await signature(editor, "    movej home, |")
    chosen = found.signatures[found.active_signature or 0]
    at = found.active_parameter or 0
    # One behind the last parameter marks none.
    marked = [chosen.label[slice(*one.label)] for one in chosen.parameters[at : at + 1]]
    assert marked not in (["j:"], ["p:"])


@pytest.mark.parametrize("line", ["    parts| = 1", "    parts = 1 // add(1,|", "    parts = add(1, 2)| + 3"])
async def test_outside_of_calls_there_is_no_signature(editor, line):
    assert await signature(editor, line) is None


async def test_a_signature_carries_the_comment_of_its_function(editor):
    found = await signature(editor, "    parts = add(|)")
    assert "Counts on." in found.signatures[0].documentation.value


async def test_each_function_that_is_offered_has_a_signature_and_a_page(editor):
    uri, items = await complete(editor, "    print |")
    functions = [item.label for item in items if item.kind == types.CompletionItemKind.Function]
    assert len(functions) > 50
    for name in functions:
        editor.set(uri, f"{HEAD}func void main()\n    print {name}()\nendfunc\n")
        hover = await editor.client.text_document_hover_async(types.HoverParams(**editor.at(uri, f"print |{name}()")))
        assert name.lower() in hover.contents.value.lower()
        params = types.SignatureHelpParams(**editor.at(uri, f"print {name}(|)"))
        found = await editor.client.text_document_signature_help_async(params)
        if "()" in hover.contents.value or name == "typeof":
            # They have tests of their own.
            continue
        for one in found.signatures:
            assert name.lower() in one.label.lower()
            places = [parameter.label for parameter in one.parameters]
            assert all(0 <= start < end <= len(one.label) for start, end in places)
            assert all(before[1] <= behind[0] for before, behind in pairwise(places))


OPTIONS = types.FormattingOptions(tab_size=4, insert_spaces=True)


@pytest.mark.parametrize(
    "before, behind",
    [
        (
            "func void main()\n    while(true)\n|\nendfunc\n",
            "func void main()\n    while(true)\n        \n    endwhile\nendfunc\n",
        ),
        (
            "func void main()\n    loop\n|\n    endloop\nendfunc\n",
            "func void main()\n    loop\n        \n    endloop\nendfunc\n",
        ),
        ("func void main()\n|\n", "func void main()\n    \nendfunc\n"),
    ],
)
async def test_enter_closes_a_block_that_nothing_closes(editor, before, behind):
    at = before.index("|")
    uri = editor.open("main.arl", before.replace("|", ""))
    position = editor.buffers[uri].position(at)
    params = types.DocumentOnTypeFormattingParams(
        text_document=editor.document(uri), position=position, ch="\n", options=OPTIONS
    )
    edits = await editor.client.text_document_on_type_formatting_async(params)
    assert editor.buffers[uri].applied(edits) == behind
