"""The pick-and-place example, in a folder of each test's own."""

import shutil
from pathlib import Path

import pytest

import arl2rs

EXAMPLE = Path(__file__).resolve().parents[2] / "examples/pick_and_place"


@pytest.fixture(scope="session")
def example(tmp_path_factory):
    """A copy of the example, that programs are compiled once for all tests."""
    folder = tmp_path_factory.mktemp("example")
    for file in EXAMPLE.iterdir():
        if file.is_file():
            shutil.copy(file, folder)
    return folder


@pytest.fixture(scope="session")
def program(example):
    return arl2rs.compile(example / "pick_and_place.arl", scenario=example / "scenario.toml")


@pytest.fixture(scope="session")
def short(tmp_path_factory):
    """A program of a moment, with global variables of all kinds; it waits for input 1 where `waits` says so."""
    source = tmp_path_factory.mktemp("short") / "short.arl"
    source.write_text(
        'int parts = 3\ndouble angle = 1\nbool waits = false\nstring name = "a"\npose place = {x 1, y 2}\nint row[3] = {1, 2, 3}\n\n'
        "func void main()\n    movej j:{0, -90, 90, 0, 90, 0}\n    movej j:{angle, -90, 90, 0, 90, 0}\n"
        "    if(waits)\n        waituntil getdi(1)\n    endif\n    setdo(2, true)\n"
        '    print name, " ", 12 / parts, " ", place.x, " ", place.y, " ", row[0], row[1]\nendfunc\n'
    )
    return source


@pytest.fixture(autouse=True)
def in_a_folder_of_its_own(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
