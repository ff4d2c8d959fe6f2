"""Starts `arl2rs lsp` for each test, and looks that no answer was one that the client cannot read."""

import os
import shutil
from pathlib import Path

import pytest
import pytest_asyncio
from pytest_lsp import ClientServerConfig

from editor import Client, Editor, wait

ARL2RS = os.environ.get("ARL2RS")
PROGRAMS = Path(__file__).parent / "programs"


def pytest_collection_modifyitems(items):
    if not ARL2RS:
        skipped = pytest.mark.skip(reason="ARL2RS does not name the command")
        for item in items:
            if Path(__file__).parent in item.path.parents:
                item.add_marker(skipped)


@pytest_asyncio.fixture
async def silent(tmp_path):
    """An editor that has said nothing yet, in an empty folder."""
    config = ClientServerConfig(server_command=[ARL2RS, "lsp"], client_factory=Client)
    client = await config.start()
    yield Editor(client, tmp_path)
    server = client._server
    try:
        if server.returncode is None:
            if client.capabilities is None:
                server.kill()
            else:
                await wait(client.shutdown_session())
        await wait(client.stop())
    finally:
        if server.returncode is None:
            server.kill()
    assert not client.faults, client.faults


@pytest_asyncio.fixture
async def editor(silent):
    """An editor that has said hello, with nothing but what every client can do, in an empty folder."""
    await silent.hello()
    return silent


@pytest_asyncio.fixture
async def cell(silent):
    """An editor in the folder of a cell: a program, a module, and the data file of each."""
    shutil.copytree(PROGRAMS, silent.folder, dirs_exist_ok=True)
    await silent.hello()
    return silent
