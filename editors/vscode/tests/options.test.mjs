// The argument lists of the command, and the settings of the server.

import assert from "node:assert/strict";
import { test } from "node:test";
import { load } from "./support.mjs";

const { argumentsOf, serverOptions } = await load("options");

const nothing = { robot: "", cell: "", io: "", scriptDir: "", strict: false };
const all = { robot: "kr6-r700", cell: "a b/cell.toml", io: "io.toml", scriptDir: "script", strict: true };

test("options stand where they are set", () => {
  assert.deepEqual(argumentsOf("run", "p.arl", nothing), ["run", "p.arl"]);
  assert.deepEqual(argumentsOf("check", "p.arl", nothing), ["check", "p.arl"]);
  assert.deepEqual(argumentsOf("test", "cases", all), ["test", "cases"]);
  const common = ["--robot", "kr6-r700", "--cell", "a b/cell.toml", "--script-dir", "script"];
  assert.deepEqual(argumentsOf("check", "p.arl", all), ["check", "p.arl", ...common, "--strict"]);
  assert.deepEqual(argumentsOf("run", "p.arl", all, ["--plot", "p.svg"]), [
    "run", "p.arl", ...common, "--io", "io.toml", "--plot", "p.svg",
  ]);
  assert.deepEqual(argumentsOf("pendant", "p.arl", all).slice(0, 3), ["run", "p.arl", "--pendant"]);
});

test("the server gets what is set", () => {
  assert.deepEqual(serverOptions(nothing), { strict: false });
  assert.deepEqual(serverOptions(all), {
    robot: "kr6-r700", cell: "a b/cell.toml", scriptDir: "script", strict: true,
  });
});
