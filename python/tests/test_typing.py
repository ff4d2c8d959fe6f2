"""What mypy says of those who use the package."""

import re
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent / "typing"


def mypy(file, cache):
    command = [
        sys.executable,
        "-P",
        "-m",
        "mypy",
        "--strict",
        "--no-error-summary",
        f"--cache-dir={cache}",
        str(HERE / file),
    ]
    return subprocess.run(command, capture_output=True, text=True, check=False, cwd=cache).stdout


def test_right_uses_pass(tmp_path):
    assert mypy("right.py", tmp_path) == ""


def test_each_of_twenty_typos_is_found(tmp_path):
    output = mypy("typos.py", tmp_path)
    found = {int(line) for line in re.findall(r"typos\.py:(\d+): error", output)}
    wrong = {at for at, line in enumerate((HERE / "typos.py").read_text().splitlines(), 1) if line.endswith("# typo")}
    assert len(wrong) >= 20 and found == wrong, output
