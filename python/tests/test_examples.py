"""What the documents and the examples say, done."""

import doctest
import subprocess
import sys
from pathlib import Path

import pytest

import arl2rs

CHECKOUT = Path(__file__).resolve().parents[2]


def blocks(page, language):
    text = (CHECKOUT / page).read_text()
    return [part.split("\n```")[0] for part in text.split(f"```{language}\n")[1:]]


def test_the_code_of_the_page_runs(example, monkeypatch):
    monkeypatch.chdir(example)
    (example / "pitch.toml").write_text(blocks("docs/sweeps.md", "toml")[0])
    names = {}
    # A cluster is there only where somebody has one.
    for code in (code for code in blocks("docs/python.md", "python") if "ray.init" not in code):
        exec(compile(code, "docs/python.md", "exec"), names)
    assert names["result"].ended and names["session"].is_over and len(names["results"]) == 9
    assert len(arl2rs.load_sweep("pitch.toml")[1]) == 18


@pytest.mark.parametrize("module", [arl2rs, arl2rs.program, arl2rs.sweeps], ids=lambda module: module.__name__)
def test_the_examples_of_docstrings_hold(module):
    tried = doctest.testmod(module)
    assert tried.failed == 0
    assert tried.attempted > 0


def test_the_example_of_the_readme_draws_its_picture(tmp_path):
    subprocess.run([sys.executable, CHECKOUT / "examples/sweep/pitch.py"], check=True, cwd=tmp_path)
    assert (tmp_path / "pitch.png").stat().st_size > 5_000
    _, rows = arl2rs.load_sweep(CHECKOUT / "examples/sweep/pitch.toml")
    assert rows == arl2rs.grid({"global.pitch": range(60, 200, 5)})


def test_the_layout_gets_better(tmp_path):
    command = [sys.executable, CHECKOUT / "examples/layout/layout.py", "24"]
    printed = subprocess.run(command, check=True, cwd=tmp_path, capture_output=True, text=True).stdout
    before, _, _, after, *_ = printed.replace(" s before, ", " s before ").split()
    assert float(after) < 0.9 * float(before), printed
    assert (tmp_path / "layout.png").stat().st_size > 20_000
