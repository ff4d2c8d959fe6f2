"""Converts a recording with Rerun's command and counts the rows that it makes of frames and of the log: a line of JSON."""

import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

RERUN = Path(sys.executable).parent / "rerun"


def rerun(*arguments: str) -> str:
    done = subprocess.run([RERUN, *arguments], check=True, capture_output=True, text=True, timeout=300)
    return done.stdout


with tempfile.TemporaryDirectory() as folder:
    converted = str(Path(folder) / "converted.rrd")
    rerun("mcap", "convert", sys.argv[1], "-o", converted)
    frames, transforms, texts = {}, 0, 0
    for line in rerun("rrd", "print", converted).splitlines():
        rows = re.search(r"with (\d+) rows .* - (\S+) - data columns: \[(.*)\]", line)
        if rows and "Transform3D:child_frame" in rows[3]:
            transforms += int(rows[1])
        if rows and "TextLog:text" in rows[3]:
            texts += int(rows[1])
    for row in rerun("rrd", "print", "-vvv", converted).splitlines():
        # A row of a table: the child stands before its parent.
        columns = [column.strip() for column in row.split("┆")]
        names = [at for at, column in enumerate(columns) if re.fullmatch(r"\[(\w+/)?(base_link|link_\d|flange|tcp)\]", column)]
        if names:
            places = frames.setdefault(columns[names[0]].strip("[]"), set())
            places.add(tuple(columns[names[0] + 2 :]))

moving = sorted(name for name, places in frames.items() if len(places) > 10)
print(json.dumps({"transforms": transforms, "texts": texts, "frames": sorted(frames), "moving": moving}))
