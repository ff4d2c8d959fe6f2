"""Programs as libraries, as other languages have them: a host in C, and Python's ctypes. ARL2RS is the command."""

import ctypes
import json
import os
import shutil
import struct
import subprocess
import threading
from pathlib import Path

import pytest

ARL2RS = os.environ["ARL2RS"]
CHECKOUT = Path(__file__).resolve().parents[3]
TAKE = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_size_t)
RUN = ctypes.c_void_p


class Interface(ctypes.Structure):
    """ArlInterface of arl.h."""

    _fields_ = [
        ("version", ctypes.c_uint32),
        ("columns", ctypes.c_uint32),
        (
            "begin",
            ctypes.CFUNCTYPE(
                RUN, ctypes.POINTER(ctypes.c_char_p), ctypes.c_size_t, ctypes.c_int32, TAKE, ctypes.c_void_p
            ),
        ),
        ("go_on", ctypes.CFUNCTYPE(ctypes.c_int32, RUN, ctypes.c_uint64, ctypes.c_int32)),
        ("stop", ctypes.CFUNCTYPE(None, RUN)),
        ("order", ctypes.CFUNCTYPE(ctypes.c_int32, RUN, ctypes.c_char_p, TAKE, ctypes.c_void_p)),
        ("said", ctypes.CFUNCTYPE(None, RUN, TAKE, ctypes.c_void_p)),
        ("state", ctypes.CFUNCTYPE(None, RUN, TAKE, ctypes.c_void_p)),
        ("rows", ctypes.CFUNCTYPE(None, RUN, TAKE, ctypes.c_void_p)),
        ("time", ctypes.CFUNCTYPE(ctypes.c_double, RUN)),
        ("end", ctypes.CFUNCTYPE(None, RUN)),
        ("header", ctypes.CFUNCTYPE(None, TAKE, ctypes.c_void_p)),
        # More functions follow that are not called here.
    ]


def taken(ask):
    """What a function gives to the one that takes."""
    parts = []
    take = TAKE(lambda _, data, length: parts.append(ctypes.string_at(data, length) if length else b""))
    ask(take)
    return b"".join(parts)


IGNORE = TAKE(lambda *_: None)


def interface(path):
    """The interface of a library."""
    library = ctypes.CDLL(str(path))
    library.arl_interface.restype = ctypes.POINTER(Interface)
    arl = library.arl_interface().contents
    assert arl.version == 3
    return arl


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    """The fill program of the example, as a library."""
    made = tmp_path_factory.mktemp("library") / "libfill.so"
    source = CHECKOUT / "examples/build_door/robot/fill.arl"
    subprocess.run([ARL2RS, "build", "--library", source, "-o", made], check=True)
    return made


def test_a_host_in_c_runs_it(library, tmp_path):
    compiler = shutil.which("cc") or pytest.skip("there is no C compiler")
    host = tmp_path / "run"
    example = CHECKOUT / "library/examples/run.c"
    warnings = ["-Wall", "-Wextra", "-Werror", "-std=c11", "-D_GNU_SOURCE"]
    subprocess.run([compiler, *warnings, example, "-I", CHECKOUT / "library", "-ldl", "-o", host], check=True)

    def run(*arguments):
        return subprocess.run([host, library, *arguments], capture_output=True, text=True, cwd=tmp_path)

    ran = run("--state-dir", tmp_path)
    message, last = ran.stdout.splitlines()
    assert json.loads(message)["message"]["text"] == "2.5 litres, valves switched 2 times"
    assert last == "1.001 s, code 0" and ran.returncode == 0
    refused = run("--robot", "nobody")
    assert "nobody" in refused.stderr and refused.returncode == 2
    assert run("--override", "200").stderr == "--override 200: expected percent from 0 to 100"


def test_a_run_is_that_of_the_command_to_the_last_byte(tmp_path):
    folder = CHECKOUT / "examples/pick_and_place"
    source, scenario, made = folder / "pick_and_place.arl", folder / "scenario.toml", tmp_path / "libpick.so"
    subprocess.run([ARL2RS, "build", "--library", source, "-o", made], check=True, cwd=folder)
    command = [ARL2RS, "run", source, "--io", scenario, "--trace", tmp_path / "command.csv"]
    command += ["--state-dir", tmp_path / "state"]
    printed = subprocess.run(command, check=True, capture_output=True, text=True, cwd=folder).stdout

    arl = interface(made)
    words = ["--io", scenario, "--trace", tmp_path / "library.csv"]
    words = [os.fsencode(word) for word in words]
    run = arl.begin((ctypes.c_char_p * len(words))(*words), len(words), 0, IGNORE, None)
    assert arl.go_on(run, 10_000_000, 1) == 0
    output = [json.loads(line) for line in taken(lambda take: arl.said(run, take, None)).splitlines()]
    arl.end(run)
    assert [line["message"]["text"] for line in output if "message" in line] == printed.splitlines()
    assert (tmp_path / "library.csv").read_bytes() == (tmp_path / "command.csv").read_bytes()


def test_recursion_without_end_is_an_alarm_on_a_thread_with_2_mib(tmp_path):
    source, made = tmp_path / "deep.arl", tmp_path / "libdeep.so"
    source.write_text("func int deeper(int n)\n    return deeper(n + 1) + 1\nendfunc\n\nfunc void main()\n    print deeper(0)\nendfunc\n")
    subprocess.run([ARL2RS, "build", "--library", source, "-o", made], check=True)
    arl = interface(made)
    answers = []

    def run():
        begun = arl.begin(None, 0, 0, IGNORE, None)
        answers.append(arl.go_on(begun, 1000, 1))
        answers.append(taken(lambda take: arl.said(begun, take, None)).decode())
        arl.end(begun)

    threading.stack_size(2 << 20)
    thread = threading.Thread(target=run)
    thread.start()
    thread.join()
    assert answers[0] == 3 and '"alarm"' in answers[1], answers


def test_python_has_its_trace_and_two_runs_at_once(library, tmp_path):
    arl = interface(library)
    names = taken(lambda take: arl.header(take, None)).decode().split(",")
    assert len(names) == arl.columns and names[:4] == ["t", "line", "motion", "j1"]

    def begin():
        words = [b"--state-dir", str(tmp_path).encode()]
        run = arl.begin((ctypes.c_char_p * 2)(*words), 2, 1, IGNORE, None)
        assert run
        return run

    one, other = begin(), begin()
    assert arl.go_on(one, 500, 0) == -1 and arl.go_on(other, 250, 0) == -1
    assert arl.order(one, b"di.1 = true", IGNORE, None) == 0
    assert arl.go_on(one, 1_000_000, 0) == 0
    assert json.loads(taken(lambda take: arl.state(other, take, None)))["state"]["do"].startswith("10")
    rows = taken(lambda take: arl.rows(one, take, None))
    rows = list(struct.iter_unpack(f"{arl.columns}d", rows))
    assert len(rows) == 501 and [round(row[0] * 1000) for row in rows] == list(range(501))
    arl.stop(other)
    assert arl.go_on(other, 1_000_000, 0) == 130
    arl.end(one)
    arl.end(other)
