// What a launch configuration leaves out.

import assert from "node:assert/strict";
import { test } from "node:test";
import { load } from "./support.mjs";

const { launchConfiguration } = await load("launch");

const options = { robot: "kr6-r700", cell: "", io: "io.toml", scriptDir: "", strict: true };

test("without a configuration the active program is debugged", () => {
  assert.deepEqual(launchConfiguration({ type: "", request: "", name: "" }, "/a/p.arl", "/a", options), {
    type: "arl2rs", request: "launch", name: "Debug ARL Program",
    program: "/a/p.arl", cwd: "/a", robot: "kr6-r700", io: "io.toml",
  });
});

test("what is configured counts", () => {
  const given = { type: "arl2rs", request: "launch", name: "n", program: "q.arl", robot: "kr10-r1420", io: "none.toml" };
  const whole = launchConfiguration(given, "/a/p.arl", undefined, options);
  assert.deepEqual(whole, given);
});

test("without a program nothing is debugged", () => {
  assert.equal(launchConfiguration({ type: "", request: "", name: "" }, undefined, "/a", options), undefined);
});
