// The grammar and its words.

import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { test } from "node:test";
import { command, json, path, skip } from "./support.mjs";

const words = json("words.json");

test("the grammar is what the script writes", () => {
  execFileSync(process.execPath, [path("scripts/grammar.mjs"), "--check"], { stdio: "pipe" });
});

test("words are sorted, in lower case, and stand once", () => {
  assert.deepEqual(Object.keys(words), ["keywords", "types", "instructions", "functions", "constants", "system"]);
  for (const list of Object.values(words)) {
    assert.deepEqual(list, [...new Set(list.map((word) => word.toLowerCase()))].sort());
  }
});

test("the command knows the words", { skip }, () => {
  const basic = ["bool", "byte", "double", "int", "string", "uint", "void"];
  const names = [
    ...words.types.filter((word) => !basic.includes(word)),
    ...words.instructions,
    ...words.functions,
    ...words.constants,
    ...words.system.map((word) => `$${word}`),
  ];
  const unknown = names.filter((name) => spawnSync(command, ["doc", name]).status !== 0);
  assert.deepEqual(unknown, []);
});
