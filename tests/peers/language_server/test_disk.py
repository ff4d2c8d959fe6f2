"""Files of the disk: what is open goes before them, and news of them are taken in."""

import pytest
from lsprotocol import types

MAIN = 'import "rack.arl"\nfunc void main()\n    rack::count = 1\nendfunc\n'
BESIDE = MAIN.replace("rack.arl", "../shared/rack.arl")
CREATED, CHANGED, DELETED = types.FileChangeType.Created, types.FileChangeType.Changed, types.FileChangeType.Deleted


async def test_an_unsaved_module_goes_before_that_of_the_disk(editor):
    editor.write("rack.arl", "int total\n")
    uri = editor.open("main.arl", MAIN)
    assert await editor.errors(uri) == ["ARL0213"]
    module = editor.open("rack.arl", "int count\n")
    await editor.becomes(uri)
    editor.close(module)
    await editor.becomes(uri, "ARL0213")


async def test_an_unsaved_module_of_a_folder_beside_goes_before_that_of_the_disk(editor):
    editor.write("shared/rack.arl", "int total\n")
    editor.write("line/main.arl", BESIDE)
    uri = editor.open("line/main.arl")
    assert await editor.errors(uri) == ["ARL0213"]
    mark = editor.mark()
    editor.open("shared/rack.arl", "int count\n")
    assert await editor.first_diagnostics(uri, mark) == []


async def test_a_module_of_a_folder_beside_that_changes_outside_is_read_again(editor):
    editor.write("shared/rack.arl", "int total\n")
    editor.write("line/main.arl", BESIDE)
    uri = editor.open("line/main.arl")
    assert await editor.errors(uri) == ["ARL0213"]
    editor.happened(CHANGED, editor.write("shared/rack.arl", "int count\n"))
    await editor.becomes(uri)


async def test_an_unsaved_module_of_the_script_folder_goes_before_that_of_the_disk(silent):
    silent.write("script/rack.arl", "int total\n")
    await silent.hello(settings={"scriptDir": "script"})
    uri = silent.open("main.arl", MAIN.replace("rack.arl", "/home/ae/script/rack.arl"))
    assert await silent.errors(uri) == ["ARL0213"]
    silent.open("script/rack.arl", "int count\n")
    await silent.becomes(uri)


async def test_a_module_that_was_never_saved_is_imported(editor):
    uri = editor.open("main.arl", MAIN)
    assert await editor.errors(uri)
    editor.open("rack.arl", "int count\n")
    await editor.becomes(uri)


async def test_an_unsaved_data_file_counts(editor):
    uri = editor.open("main.arl", "func void main()\n    print gap\nendfunc\n")
    assert await editor.errors(uri) == ["ARL0201"]
    data = editor.open("main_data.arl", "int gap = 1\n")
    await editor.becomes(uri)
    editor.close(data)
    await editor.becomes(uri, "ARL0201")


async def test_hover_and_definition_see_unsaved_texts(cell):
    uri, module = cell.open("cell.arl"), cell.open("rack.arl")
    cell.edit(
        module,
        ("// Where parts lie.\n", "// Where parts lie.\n\n\n"),
        ("Whether there is no room", "Says if there is no room"),
    )
    hover = await cell.client.text_document_hover_async(types.HoverParams(**cell.at(uri, "rack::fu|ll")))
    assert "Says if there is no room" in hover.contents.value
    found = await cell.client.text_document_definition_async(types.DefinitionParams(**cell.at(uri, "rack::fu|ll")))
    assert found.range.start.line == 6


async def test_a_file_that_appears_mends_what_misses_it(editor):
    uri = editor.open("main.arl", MAIN)
    assert await editor.errors(uri)
    editor.happened(CREATED, editor.write("rack.arl", "int count\n"))
    await editor.becomes(uri)


async def test_a_file_that_is_deleted_is_missed(editor):
    module = editor.write("rack.arl", "int count\n")
    uri = editor.open("main.arl", MAIN)
    assert await editor.diagnostics(uri) == []
    mark = editor.mark()
    editor.path(module).unlink()
    editor.happened(DELETED, module)
    assert [one.code for one in await editor.first_diagnostics(uri, mark)][0] == "ARL0601"


async def test_a_file_that_is_renamed_is_missed_under_its_old_name(editor):
    module = editor.write("rack.arl", "int count\n")
    uri = editor.open("main.arl", MAIN)
    assert await editor.diagnostics(uri) == []
    mark = editor.mark()
    shelf = editor.uri("shelf.arl")
    editor.path(module).rename(editor.path(shelf))
    editor.happened(DELETED, module)
    editor.happened(CREATED, shelf)
    assert [one.code for one in await editor.first_diagnostics(uri, mark)][0] == "ARL0601"
    editor.set(uri, MAIN.replace("rack", "shelf"))
    await editor.becomes(uri)


async def test_a_file_that_changes_outside_is_read_again(editor):
    module = editor.write("rack.arl", "int count\n")
    uri = editor.open("main.arl", MAIN)
    assert await editor.diagnostics(uri) == []
    editor.write("rack.arl", "int total\n")
    editor.happened(CHANGED, module)
    await editor.becomes(uri, "ARL0213")


async def test_news_of_an_open_file_change_nothing(editor):
    module = editor.write("rack.arl", "int count\n")
    uri, _ = editor.open("main.arl", MAIN), editor.open("rack.arl")
    await editor.becomes(uri)
    editor.write("rack.arl", "int total\n")
    editor.happened(CHANGED, module)
    editor.path(module).unlink()
    editor.happened(DELETED, module)
    editor.edit(uri, ("= 1", "= 2"))
    assert await editor.diagnostics(uri) == []


async def test_symbols_of_a_deleted_file_are_gone(cell):
    query = types.WorkspaceSymbolParams(query="full")
    assert len(await cell.client.workspace_symbol_async(query)) == 1
    module = cell.uri("rack.arl")
    cell.path(module).unlink()
    cell.happened(DELETED, module)
    assert not await cell.client.workspace_symbol_async(query)


async def test_symbols_of_a_new_file_are_found(cell):
    query = types.WorkspaceSymbolParams(query="brand_new")
    assert not await cell.client.workspace_symbol_async(query)
    cell.happened(CREATED, cell.write("sub/extra.arl", "int brand_new\n"))
    (found,) = await cell.client.workspace_symbol_async(query)
    assert cell.name(found.location.uri) == "sub/extra.arl"


async def test_diagnostics_of_a_closed_program_are_cleared_when_it_is_deleted(editor):
    module = editor.write("rack.arl", "int count\n")
    program = editor.write("main.arl", MAIN)
    editor.happened(CREATED, module, program)
    editor.open("rack.arl")
    assert await editor.client.workspace_symbol_async(types.WorkspaceSymbolParams(query="main"))
    mark = editor.mark()
    editor.set(module, "int total\n")
    assert [one.code for one in await editor.first_diagnostics(program, mark)] == ["ARL0213"]
    mark = editor.mark()
    editor.path(program).unlink()
    editor.happened(DELETED, program)
    assert await editor.first_diagnostics(program, mark) == []


async def test_a_file_in_a_national_encoding_is_read_from_the_disk(editor):
    module = "// \u70b9\u4f4d\u8868\nint count // \u8ba1\u6570\nfunc int next()\n    return count + 1\nendfunc\n"
    editor.write("rack.arl", module.encode("gb18030"))
    uri = editor.open("main.arl", 'import "rack.arl"\nfunc void main()\n    rack::count = rack::next()\nendfunc\n')
    assert await editor.diagnostics(uri) == []
    hover = await editor.client.text_document_hover_async(types.HoverParams(**editor.at(uri, "rack::co|unt")))
    assert "\u8ba1\u6570" in hover.contents.value
    found = await editor.client.text_document_definition_async(types.DefinitionParams(**editor.at(uri, "rack::ne|xt")))
    assert (found.range.start.line, found.range.start.character) == (2, 9)


async def test_places_in_a_file_in_a_national_encoding_count_characters(editor):
    editor.write("rack.arl", 'string name = "\u70b9\u4f4d", other = "\u8868"\n'.encode("gb18030"))
    uri = editor.open("main.arl", 'import "rack.arl"\nfunc void main()\n    print rack::name, rack::other\nendfunc\n')
    assert await editor.diagnostics(uri) == []
    edit = await editor.client.text_document_rename_async(
        types.RenameParams(new_name="second", **editor.at(uri, "rack::oth|er"))
    )
    # The editor has decoded the file.
    module = editor.open("rack.arl", 'string name = "\u70b9\u4f4d", other = "\u8868"\n')
    assert editor.apply(edit) == {"main.arl": 1, "rack.arl": 1}
    assert editor.text(module) == 'string name = "\u70b9\u4f4d", second = "\u8868"\n'
    await editor.becomes(uri)


async def test_a_file_with_a_byte_order_mark_is_read_from_the_disk(editor):
    editor.write("rack.arl", "\ufeffint count\n")
    uri = editor.open("main.arl", MAIN)
    assert await editor.diagnostics(uri) == []
    found = await editor.client.text_document_definition_async(types.DefinitionParams(**editor.at(uri, "rack::co|unt")))
    assert found.range.start == types.Position(0, 4)


async def test_names_of_files_may_have_blanks_and_signs(editor):
    editor.write("a b/r\u00e4ck #1/rack.arl", "int count\n")
    text = MAIN.replace("rack.arl", "r\u00e4ck #1/rack.arl")
    uri = editor.open("a b/main+100%.arl", text)
    assert await editor.diagnostics(uri) == []
    found = await editor.client.text_document_definition_async(types.DefinitionParams(**editor.at(uri, "rack::co|unt")))
    assert editor.name(found.uri) == "a b/r\u00e4ck #1/rack.arl"
    edit = await editor.client.text_document_rename_async(
        types.RenameParams(new_name="total", **editor.at(uri, "rack::co|unt"))
    )
    assert set(editor.apply(edit)) == {"a b/main+100%.arl", "a b/r\u00e4ck #1/rack.arl"}
    assert await editor.diagnostics(uri) == []


async def test_closing_an_unsaved_text_leaves_what_the_disk_has(editor):
    editor.happened(CREATED, editor.write("rack.arl", "int count\n"))
    uri = editor.open("rack.arl", "int count = nothing\n")
    assert await editor.errors(uri) == ["ARL0201"]
    mark = editor.mark()
    editor.close(uri)
    assert await editor.first_diagnostics(uri, mark) == []


async def test_a_file_that_is_deleted_while_it_is_open_is_clear_once_it_is_closed(editor):
    editor.happened(CREATED, editor.write("rack.arl", "int count = nothing\n"))
    uri = editor.open("rack.arl")
    assert await editor.errors(uri) == ["ARL0201"]
    editor.path(uri).unlink()
    editor.happened(DELETED, uri)
    mark = editor.mark()
    editor.close(uri)
    assert await editor.first_diagnostics(uri, mark) == []


async def test_a_file_that_the_editor_renames_is_clear_under_its_old_name(editor):
    editor.happened(CREATED, editor.write("rack.arl", "int count = nothing\n"))
    old = editor.open("rack.arl")
    assert await editor.errors(old) == ["ARL0201"]
    mark = editor.mark()
    editor.close(old)
    editor.path(old).rename(editor.path(editor.uri("shelf.arl")))
    new = editor.open("shelf.arl")
    editor.happened(DELETED, old)
    editor.happened(CREATED, new)
    assert await editor.errors(new) == ["ARL0201"]
    cleared = lambda one: one.uri == old and not one.diagnostics
    await editor.until(lambda: [one for one in editor.client.published[mark:] if cleared(one)])


async def test_a_data_file_that_is_deleted_is_missed_by_its_program(cell):
    uri = cell.open("cell.arl")
    assert await cell.diagnostics(uri) == []
    data = cell.uri("cell_data.arl")
    cell.path(data).unlink()
    cell.happened(DELETED, data)
    await cell.becomes(uri, "ARL0201", "ARL0201")
    cell.happened(
        CREATED, cell.write("cell_data.arl", "pose feeder = {x 1, y 2, z 3, a 0, b 180, c 0}\ndouble gap = 1\n")
    )
    await cell.becomes(uri)


async def test_endings_may_be_in_capitals(editor):
    editor.write("RACK.ARL", "int count\n")
    uri = editor.open("MAIN.ARL", MAIN.replace("rack.arl", "RACK.ARL"))
    assert await editor.diagnostics(uri) == []
