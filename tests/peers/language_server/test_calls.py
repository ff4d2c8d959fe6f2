"""Who calls a function, and whom it calls."""

from lsprotocol import types


async def item(editor, uri, words):
    params = types.CallHierarchyPrepareParams(**editor.at(uri, words))
    (found,) = await editor.client.text_document_prepare_call_hierarchy_async(params)
    return found


async def incoming(editor, item):
    found = await editor.client.call_hierarchy_incoming_calls_async(types.CallHierarchyIncomingCallsParams(item))
    return sorted((one.from_.name, editor.name(one.from_.uri), len(one.from_ranges)) for one in found)


async def outgoing(editor, item):
    found = await editor.client.call_hierarchy_outgoing_calls_async(types.CallHierarchyOutgoingCallsParams(item))
    return sorted((one.to.name, editor.name(one.to.uri), len(one.from_ranges)) for one in found)


async def test_the_item_is_the_function(cell):
    uri = cell.open("cell.arl")
    found = await item(cell, uri, "if(gr|ip(1")
    buffer = cell.buffers[uri]
    assert (found.name, found.kind) == ("grip", types.SymbolKind.Function)
    assert buffer.cut(found.selection_range) == "grip"
    assert buffer.cut(found.range).startswith("func bool grip") and buffer.cut(found.range).endswith("endfunc")


async def test_calls_go_across_files(cell):
    uri = cell.open("cell.arl")
    full = await item(cell, uri, "rack::fu|ll(")
    assert cell.name(full.uri) == "rack.arl"
    assert await incoming(cell, full) == [("place", "cell.arl", 1)]
    place = await item(cell, uri, "func void pla|ce(")
    assert await outgoing(cell, place) == [("full", "rack.arl", 1), ("grip", "cell.arl", 1)]
    assert await incoming(cell, place) == [("main", "cell.arl", 1)]


async def test_callers_are_found_from_a_module_while_the_program_is_closed(cell):
    module = cell.open("rack.arl")
    full = await item(cell, module, "bool fu|ll(")
    assert await incoming(cell, full) == [("place", "cell.arl", 1)]


async def test_calls_can_be_followed_step_by_step(cell):
    uri = cell.open("cell.arl")
    main = await item(cell, uri, "func void ma|in")
    assert await incoming(cell, main) == []
    step = types.CallHierarchyOutgoingCallsParams(main)
    (call,) = await cell.client.call_hierarchy_outgoing_calls_async(step)
    assert [cell.buffers[uri].cut(one) for one in call.from_ranges] == ["place"]
    assert await outgoing(cell, call.to) == [("full", "rack.arl", 1), ("grip", "cell.arl", 1)]


async def test_a_function_may_call_itself(editor):
    f = "func int f(int n)\n    if(n > 0) n = f(n - 1) + f(n - 2)\n    return n\nendfunc\n"
    text = f + "func void main()\n    print f(3)\nendfunc\n"
    uri = editor.open("main.arl", text)
    found = await item(editor, uri, "func int |f(")
    assert await incoming(editor, found) == [("f", "main.arl", 2), ("main", "main.arl", 1)]
    assert await outgoing(editor, found) == [("f", "main.arl", 2)]


async def test_a_variable_has_no_calls(cell):
    uri = cell.open("cell.arl")
    params = types.CallHierarchyPrepareParams(**cell.at(uri, "movej ho|me"))
    assert not await cell.client.text_document_prepare_call_hierarchy_async(params)
