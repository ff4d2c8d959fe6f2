"""The cycle time of the pick-and-place example for each pitch of its pallet."""

from pathlib import Path

import arl2rs

cell = Path(__file__).parent.parent / "pick_and_place"
rows = arl2rs.grid({"global.pitch": range(60, 200, 5)})
results = arl2rs.sweep(cell / "pick_and_place.arl", rows, scenario=cell / "scenario.toml")
results.plot("global.pitch").savefig("pitch.png")
print(results, results.best()["parameters"])
