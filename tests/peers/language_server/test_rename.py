"""Other names, for everything that the program declares and for nothing else."""

import pytest
from lsprotocol import types


async def rename(editor, uri, words, name):
    params = types.RenameParams(new_name=name, **editor.at(uri, words))
    return await editor.client.text_document_rename_async(params)


async def refusal(editor, uri, words, name):
    params = types.RenameParams(new_name=name, **editor.at(uri, words))
    return await editor.refused(editor.client.text_document_rename_async(params))


async def prepare(editor, uri, words):
    return await editor.client.text_document_prepare_rename_async(types.PrepareRenameParams(**editor.at(uri, words)))


def on_disk(editor, name):
    return (editor.folder / name).read_text()


async def test_a_variable_of_a_module_is_renamed_in_all_files(cell):
    uri = cell.open("cell.arl")
    assert cell.apply(await rename(cell, uri, "rack::cou|nt", "total")) == {"cell.arl": 1, "rack.arl": 2}
    assert "rack::total = PLACED" in cell.text(uri)
    assert "int total = 0" in on_disk(cell, "rack.arl") and "number > total + reserve" in on_disk(cell, "rack.arl")
    assert await cell.diagnostics(uri) == []


async def test_a_variable_of_a_data_file_is_renamed_with_its_program(cell):
    uri = cell.open("cell.arl")
    assert cell.apply(await rename(cell, uri, "height + ga|p", "clearance")) == {"cell.arl": 1, "cell_data.arl": 1}
    assert "double clearance = 150" in on_disk(cell, "cell_data.arl")
    assert await cell.diagnostics(uri) == []


async def test_it_may_begin_in_the_data_file(cell):
    uri, data = cell.open("cell.arl"), cell.open("cell_data.arl")
    assert cell.apply(await rename(cell, data, "pose fee|der", "source")) == {"cell.arl": 1, "cell_data.arl": 1}
    assert "lin offset(source," in cell.text(uri) and "pose source =" in cell.text(data)
    await cell.becomes(uri)
    await cell.becomes(data)


async def test_the_data_file_of_a_module_is_renamed_while_nothing_is_open_but_it(cell):
    data = cell.open("rack_data.arl")
    assert cell.apply(await rename(cell, data, "int res|erve", "spare")) == {"rack.arl": 1, "rack_data.arl": 1}
    assert "count + spare" in on_disk(cell, "rack.arl")


async def test_unsaved_texts_are_renamed_as_they_are(cell):
    uri, module = cell.open("cell.arl"), cell.open("rack.arl")
    cell.edit(module, ("// Whether", "\n\n// Whether"), ("number > count", "number > 2 * count"))
    assert cell.apply(await rename(cell, uri, "rack::cou|nt", "total")) == {"cell.arl": 1, "rack.arl": 2}
    assert "number > 2 * total + reserve" in cell.text(module)
    await cell.becomes(uri)
    await cell.becomes(module)


@pytest.mark.parametrize(
    "words, name, edits",
    [
        ("func bool gr|ip(", "grasp", {"cell.arl": 2}),
        ("rack::fu|ll(", "complete", {"cell.arl": 1, "rack.arl": 1}),
        ("rack::fu|ll(", "count", {"cell.arl": 1, "rack.arl": 1}),
        ("goto ag|ain", "once_more", {"cell.arl": 2}),
        ("int rou|nd", "turn", {"cell.arl": 3}),
        ("int pla|ced = 0", "done", {"cell.arl": 5}),
        ("place(double hei|ght)", "h", {"cell.arl": 2}),
        ("int pla|ced = 0", "Placed", {"cell.arl": 5}),
        ("const int RO|WS", "ROWS", {"cell.arl": 2}),
    ],
)
async def test_all_uses_change_and_nothing_is_wrong_behind_it(cell, words, name, edits):
    uri = cell.open("cell.arl")
    assert cell.apply(await rename(cell, uri, words, name)) == edits
    assert await cell.diagnostics(uri) == []


async def test_labels_of_arguments_follow_their_parameter(editor):
    text = "func int twice(int way)\n    return 2 * way\nendfunc\nfunc void main()\n    print twice(way:1)\nendfunc\n"
    uri = editor.open("main.arl", text)
    assert editor.apply(await rename(editor, uri, "2 * wa|y", "far")) == {"main.arl": 3}
    assert "twice(far:1)" in editor.text(uri)
    assert await editor.diagnostics(uri) == []


async def test_all_programs_that_use_a_module_change(cell):
    text = 'import "rack.arl"\nfunc void main()\n    print RACK::Count, "count" // count\nendfunc\n'
    cell.happened(types.FileChangeType.Created, cell.write("other.arl", text))
    module = cell.open("rack.arl")
    edit = await rename(cell, module, "int cou|nt", "total")
    assert cell.apply(edit) == {"cell.arl": 1, "other.arl": 1, "rack.arl": 2}
    assert on_disk(cell, "other.arl") == text.replace("::Count", "::total")


async def test_a_module_of_a_folder_beside_changes(editor):
    editor.write("shared/rack.arl", "int count\n")
    editor.write("line/main.arl", 'import "../shared/rack.arl"\nfunc void main()\n    rack::count = 1\nendfunc\n')
    uri = editor.open("line/main.arl")
    edit = await rename(editor, uri, "rack::cou|nt", "total")
    assert editor.apply(edit) == {"line/main.arl": 1, "shared/rack.arl": 1}


async def test_a_name_that_a_closed_program_has_already_is_refused(cell):
    text = "func void main()\n    int total = 1\n    print total + gap\nendfunc\n"
    cell.happened(
        types.FileChangeType.Created, cell.write("other.arl", text), cell.write("other_data.arl", "int gap = 1\n")
    )
    data = cell.open("other_data.arl")
    assert "other.arl, line" in (await refusal(cell, data, "int ga|p", "total")).message


async def test_windows_line_ends_stay(editor):
    text = "int a\r\nfunc void main()\r\n    a = a + 1\r\nendfunc\r\n"
    uri = editor.open("main.arl", text)
    assert editor.apply(await rename(editor, uri, "int |a", "b")) == {"main.arl": 3}
    assert editor.text(uri) == text.replace("int a", "int b").replace("a = a + 1", "b = b + 1")


@pytest.mark.parametrize(
    "words, name",
    [("movej ho|me", "home"), ("rack::cou|nt", "count"), ("height + g|ap", "gap"), ("goto ag|ain", "again")],
)
async def test_prepare_gives_the_name_and_its_place(cell, words, name):
    uri = cell.open("cell.arl")
    found = await prepare(cell, uri, words)
    assert (found.placeholder, cell.buffers[uri].cut(found.range)) == (name, name)


@pytest.mark.parametrize("words", ["mov|ej", "get|di", "v|p:50%", "func bo|ol grip", "!ra|ck::", "func void ma|in"])
async def test_prepare_refuses_what_is_not_the_programs_own(cell, words):
    uri = cell.open("cell.arl")
    params = types.PrepareRenameParams(**cell.at(uri, words))
    error = await cell.refused(cell.client.text_document_prepare_rename_async(params))
    assert error.message


@pytest.mark.parametrize("words", ["wh|ile(", "    els|e", "fu|nc void main", "// Gr|ips", "int placed |= 0"])
async def test_words_of_the_language_have_nothing_to_rename(cell, words):
    uri = cell.open("cell.arl")
    assert await prepare(cell, uri, words) is None
    assert "no name here" in (await refusal(cell, uri, words, "other")).message


@pytest.mark.parametrize(
    "words, name, expected",
    [
        ("movej ho|me", "while", "word of the language"),
        ("movej ho|me", "MoveJ", "word of the language"),
        ("movej ho|me", "int", "word of the language"),
        ("movej ho|me", "2nd", "is not a name"),
        ("movej ho|me", "a b", "is not a name"),
        ("movej ho|me", "", "is not a name"),
        ("movej ho|me", "h\u00f6he", "is not a name"),
        ("movej ho|me", "rack::home", "is not a name"),
        ("movej ho|me", "placed", "placed"),
        ("int rou|nd", "PLACED", "placed"),
        ("height + g|ap", "height", "height"),
        ("func void ma|in", "start", "main"),
        ("mov|ej", "go", "part of the language"),
    ],
)
async def test_names_that_cannot_be_are_refused(cell, words, name, expected):
    uri = cell.open("cell.arl")
    error = await refusal(cell, uri, words, name)
    assert expected in error.message.lower()
