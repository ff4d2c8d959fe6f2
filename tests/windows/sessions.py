"""The language server, the debugger, the view and a sweep of the command for Windows, under wine.

`ARL2RS` is the command as words: `scripts/windows.sh wine .../arl2rs.exe`. Run by `.ci/run windows`.
"""

import json
import os
import shlex
import shutil
import subprocess
import tempfile
import unittest
import urllib.request
from pathlib import Path
from urllib.parse import quote

COMMAND = shlex.split(os.environ["ARL2RS"])
EXAMPLE = Path(__file__).parents[2] / "examples" / "pick_and_place"
PROGRAM = "pick_and_place.arl"


def windows(path: Path) -> str:
    """A path as Windows writes it: wine's drive Z is the root."""
    return "Z:" + str(path).replace("/", "\\")


class Peer:
    """A process that exchanges messages with `Content-Length` headers."""

    def __init__(self, word: str, folder: Path) -> None:
        self.process = subprocess.Popen([*COMMAND, word], cwd=folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE)

    def send(self, message: dict) -> None:
        content = json.dumps(message).encode()
        self.process.stdin.write(b"Content-Length: %d\r\n\r\n" % len(content) + content)
        self.process.stdin.flush()

    def receive(self) -> dict:
        head = b""
        while not head.endswith(b"\r\n\r\n"):
            byte = self.process.stdout.read(1)
            if not byte:
                raise AssertionError("the process has ended")
            head += byte
        return json.loads(self.process.stdout.read(int(head.split(b":")[1])))

    def until(self, is_it) -> dict:
        while True:
            message = self.receive()
            if is_it(message):
                return message

    def end(self) -> int:
        self.process.stdin.close()
        code = self.process.wait(timeout=60)
        self.process.stdout.close()
        return code


class Debugger(Peer):
    """A client of the debugger."""

    def __init__(self, folder: Path) -> None:
        super().__init__("dap", folder)
        self.number = 0

    def ask(self, command: str, **arguments) -> None:
        self.number += 1
        self.send({"seq": self.number, "type": "request", "command": command, "arguments": arguments})

    def answer(self, command: str, **arguments) -> dict:
        self.ask(command, **arguments)
        answer = self.until(lambda message: message.get("command") == command)
        if not answer["success"]:
            raise AssertionError(answer["message"])
        return answer.get("body") or {}

    def stop(self) -> dict:
        return self.until(lambda message: message.get("event") in ("stopped", "terminated"))


class Sessions(unittest.TestCase):
    """What a person does at a desk with Windows, in a folder whose name has a space and a Chinese character."""

    def setUp(self) -> None:
        self.place = tempfile.TemporaryDirectory()
        self.folder = Path(self.place.name) / "My cell 点"
        shutil.copytree(EXAMPLE, self.folder)

    def tearDown(self) -> None:
        self.place.cleanup()

    def run_command(self, *words: str) -> str:
        done = subprocess.run([*COMMAND, *words], cwd=self.folder, capture_output=True, timeout=300)
        self.assertEqual(done.returncode, 0, done.stderr.decode())
        return done.stdout.decode()

    def test_the_server_finds_mistakes(self) -> None:
        server = Peer("lsp", self.folder)
        capabilities = {"processId": None, "rootUri": None, "capabilities": {}}
        server.send({"jsonrpc": "2.0", "id": 1, "method": "initialize", "params": capabilities})
        server.until(lambda message: message.get("id") == 1)
        server.send({"jsonrpc": "2.0", "method": "initialized", "params": {}})
        uri = "file:///Z:" + quote(str(self.folder / "wrong.arl"))
        document = {"uri": uri, "languageId": "arl", "version": 1, "text": "func void main()\r\n  movej 5\r\nendfunc\r\n"}
        server.send({"jsonrpc": "2.0", "method": "textDocument/didOpen", "params": {"textDocument": document}})
        found = server.until(lambda message: message.get("method") == "textDocument/publishDiagnostics")["params"]
        self.assertEqual([diagnostic["range"]["start"]["line"] for diagnostic in found["diagnostics"]], [1])
        server.send({"jsonrpc": "2.0", "id": 2, "method": "shutdown"})
        server.until(lambda message: message.get("id") == 2)
        server.send({"jsonrpc": "2.0", "method": "exit"})
        self.assertEqual(server.end(), 0)

    def test_the_debugger_halts_and_steps_back(self) -> None:
        debugger = Debugger(self.folder)
        program = windows(self.folder / PROGRAM)
        line = 1 + (self.folder / PROGRAM).read_text().splitlines().index('    print "ready"')
        debugger.answer("initialize", adapterID="arl")
        debugger.ask("launch", program=program, io="scenario.toml")
        debugger.until(lambda message: message.get("event") == "initialized")
        set_ones = debugger.answer("setBreakpoints", source={"path": program}, breakpoints=[{"line": line}])
        self.assertTrue(set_ones["breakpoints"][0]["verified"])
        debugger.answer("configurationDone")
        self.assertEqual(debugger.stop()["body"]["reason"], "breakpoint")
        frame = debugger.answer("stackTrace", threadId=1)["stackFrames"][0]
        self.assertEqual((frame["line"], frame["source"]["path"]), (line, program))
        debugger.ask("stepBack", threadId=1)
        self.assertEqual(debugger.stop()["body"]["reason"], "step")
        frame = debugger.answer("stackTrace", threadId=1)["stackFrames"][0]
        self.assertLess(frame["line"], line)
        debugger.answer("disconnect")
        self.assertEqual(debugger.end(), 0)

    def test_a_recording_is_viewed(self) -> None:
        self.run_command("run", PROGRAM, "--io", "scenario.toml", "--record", "run.mcap")
        view = subprocess.Popen([*COMMAND, "view", "run.mcap", "--no-open"], cwd=self.folder, stdout=subprocess.PIPE)
        try:
            address = view.stdout.readline().decode().strip()
            with urllib.request.urlopen(address, timeout=60) as page:
                self.assertIn(b"<title>", page.read())
        finally:
            view.kill()
            view.wait()
            view.stdout.close()

    def test_a_sweep_runs(self) -> None:
        sweep = f'program = "{PROGRAM}"\nio = "scenario.toml"\n[grid]\noverride = [50, 100]\n'
        (self.folder / "sweep.toml").write_text(sweep)
        rows = [json.loads(row) for row in self.run_command("sweep", "sweep.toml").splitlines()]
        self.assertEqual([row["outcome"] for row in rows], ["ended", "ended"])
        self.assertGreater(rows[0]["cycle_time"], rows[1]["cycle_time"])


if __name__ == "__main__":
    unittest.main()
