"""Places in texts that are more than ASCII, in each encoding of positions."""

import random

import pytest
import pytest_asyncio
from lsprotocol import types

TEXT = 'string s = "\u00e4"\nfunc void main()\n    s = "\U0001f916\u70b9" + nothing // \u00b5\nendfunc\n'


@pytest_asyncio.fixture(params=["utf-16", "utf-8"])
async def encoded(silent, request):
    """An editor that counts in one encoding."""
    general = types.GeneralClientCapabilities(position_encodings=[request.param])
    await silent.hello(types.ClientCapabilities(general=general))
    assert silent.encoding == request.param
    return silent


def cut(editor, uri, range):
    return editor.buffers[uri].cut(range)


async def test_a_mistake_behind_an_emoji_is_in_place(encoded):
    uri = encoded.open("main.arl", TEXT)
    (found,) = await encoded.diagnostics(uri)
    assert cut(encoded, uri, found.range) == "nothing"


async def test_an_edit_behind_an_emoji_is_in_place(encoded):
    uri = encoded.open("main.arl", TEXT)
    encoded.edit(uri, ("nothing", '"\U0001f916"'), ("\u00b5", "\U0001f916\U0001f916"), (' + "\U0001f916"', " + nought"))
    (found,) = await encoded.diagnostics(uri)
    assert (found.code, cut(encoded, uri, found.range)) == ("ARL0201", "nought")


async def test_an_emoji_is_inserted_and_taken_away(encoded):
    uri = encoded.open("main.arl", TEXT)
    encoded.edit(uri, ("\u70b9", "\u70b9\U0001f469\u200d\U0001f680"))
    encoded.edit(uri, ("\U0001f916", ""))
    (found,) = await encoded.diagnostics(uri)
    assert cut(encoded, uri, found.range) == "nothing"


async def test_names_behind_an_emoji_are_found(encoded):
    uri = encoded.open("main.arl", TEXT.replace("nothing", "s"))
    at = encoded.buffers[uri].at(" + |s //")
    place = {"text_document": encoded.document(uri), "position": at}
    hover = await encoded.client.text_document_hover_async(types.HoverParams(**place))
    assert "string s" in hover.contents.value and hover.range.start == at
    params = types.RenameParams(new_name="text", **place)
    encoded.apply(await encoded.client.text_document_rename_async(params))
    assert encoded.text(uri) == TEXT.replace("nothing", "text").replace("string s ", "string text ").replace(
        "    s =", "    text ="
    )
    assert await encoded.diagnostics(uri) == []


async def test_related_places_behind_an_emoji_are_in_place(encoded):
    uri = encoded.open("main.arl", 'string s = "\U0001f916\u70b9", t, T\nfunc void main()\nendfunc\n')
    (found,) = await encoded.diagnostics(uri)
    (related,) = found.related_information
    assert (cut(encoded, uri, found.range), cut(encoded, uri, related.location.range)) == ("T", "t")


async def test_formatting_behind_an_emoji_is_in_place(encoded):
    uri = encoded.open("main.arl", 'func void main()\n  print "\U0001f916"  ,1 // \u00b5\nendfunc // \U0001f916')
    options = types.FormattingOptions(tab_size=4, insert_spaces=True)
    edits = await encoded.client.text_document_formatting_async(
        types.DocumentFormattingParams(encoded.document(uri), options)
    )
    assert (
        encoded.buffers[uri]
        .applied(edits)
        .startswith('func void main()\n    print "\U0001f916", 1 // \u00b5\nendfunc // \U0001f916')
    )


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
async def test_line_ends_are_those_of_the_protocol(encoded, end):
    uri = encoded.open("main.arl", TEXT.replace("\n", end))
    (found,) = await encoded.diagnostics(uri)
    assert (found.range.start.line, cut(encoded, uri, found.range)) == (2, "nothing")
    encoded.edit(uri, ("nothing", "nought"))
    (found,) = await encoded.diagnostics(uri)
    assert cut(encoded, uri, found.range) == "nought"


@pytest.mark.parametrize("sign", ["\u2028", "\u0085", "\x0b", "\x0c"])
async def test_other_signs_end_no_line(encoded, sign):
    uri = encoded.open("main.arl", TEXT.replace("\u00e4", sign))
    found = (await encoded.diagnostics(uri))[-1]
    assert (found.range.start.line, cut(encoded, uri, found.range)) == (2, "nothing")


async def test_positions_behind_the_end_are_the_end(encoded):
    uri = encoded.open("main.arl", TEXT)
    buffer = encoded.buffers[uri]
    for position in [types.Position(2, 999), types.Position(99, 0), types.Position(2**31 - 1, 2**31 - 1)]:
        place = {"text_document": encoded.document(uri), "position": position}
        assert await encoded.client.text_document_hover_async(types.HoverParams(**place)) is None
        await encoded.client.text_document_completion_async(types.CompletionParams(**place))
    end = types.Range(types.Position(99, 0), types.Position(999, 9))
    buffer.text += "int more\n"
    encoded.change(uri, [types.TextDocumentContentChangePartial(range=end, text="int more\n")])
    assert "more" in [cut(encoded, uri, one.selection_range) for one in await outline(encoded, uri)]


async def outline(editor, uri):
    return await editor.client.text_document_document_symbol_async(types.DocumentSymbolParams(editor.document(uri)))


@pytest.mark.parametrize("seed", range(5))
async def test_random_edits_leave_the_text_of_the_editor(encoded, seed):
    random_ = random.Random(seed)
    pieces = [
        "\U0001f916",
        "\u70b9",
        "\u00e4",
        "a",
        " ",
        "\n",
        "\r\n",
        '"',
        "//",
        "int x\n",
        "func void f()\n",
        "endfunc\n",
        "s",
    ]
    uri = encoded.open("main.arl", TEXT)
    for _ in range(60):
        text = encoded.text(uri)
        start = random_.randrange(len(text) + 1)
        end = min(len(text), start + random_.choice([0, 0, 0, 1, 2, 9]))
        new = "".join(random_.choices(pieces, k=random_.randrange(4)))
        # A client that edits between CR and LF would be wrong.
        if any(text[at - 1 : at + 1] == "\r\n" for at in (start, end)):
            continue
        encoded.splice(uri, start, end, new)
    edited = [(one.code, one.range, one.message) for one in await encoded.diagnostics(uri)]
    symbols = await outline(encoded, uri)
    # The same text, sent as a whole, is the same to the server.
    encoded.set(uri, encoded.text(uri))
    assert [(one.code, one.range, one.message) for one in await encoded.diagnostics(uri)] == edited
    assert await outline(encoded, uri) == symbols
    for one in symbols:
        assert cut(encoded, uri, one.selection_range) == one.name
        assert one.range.start <= one.selection_range.start and one.selection_range.end <= one.range.end
