// The snippets are programs.

import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { command, json, skip } from "./support.mjs";

const snippets = Object.values(json("snippets/arl.json"));

/** What stands there when somebody takes all that is proposed. */
function expanded(body) {
  const values = new Map();
  const inner = /\$\{(\d+):([^{}]*)\}/;
  let text = body.join("\n");
  for (let match = inner.exec(text); match !== null; match = inner.exec(text)) {
    values.set(match[1], match[2]);
    text = text.replace(match[0], () => match[2]);
  }
  return text.replace(/\$(\d+)/g, (_, number) => values.get(number) ?? "").replaceAll("\t", "    ");
}

const POINTS = `joint home = {0, -90, 90, 0, 90, 0}
pose target = {x 900, y -300, z 400, a 0, b 180, c 0}
pose through = {x 950, y 0, z 400, a 0, b 180, c 0}
int number = 1
`;

/** A program with the snippet where it belongs. */
function program(prefix, text) {
  switch (prefix) {
    case "main":
      return text;
    case "func":
      return `${text}\nfunc void main()\nendfunc\n`;
    case "import":
      return `${text}\nfunc void main()\n    print module::count\nendfunc\n`;
    default:
      return `${POINTS}func void main()\n    movej home\n    ptp target\n${text}\nendfunc\n`;
  }
}

test("placeholders are taken as they are proposed", () => {
  assert.equal(expanded(["a ${1:b} ${2:c(${3:1})}, $1$0", "\t$2"]), "a b c(1), b\n    c(1)");
});

test("all that is promised is there", () => {
  const prefixes = snippets.flatMap(({ prefix }) => prefix);
  const promised = [
    "func", "main", "if", "ifelse", "while", "for", "loop", "repeat", "switch", "movej", "lin", "cir", "waituntil",
    "interrupt", "pose", "joint", "import",
  ];
  assert.deepEqual(promised.filter((prefix) => !prefixes.includes(prefix)), []);
});

for (const { prefix, body } of snippets) {
  const name = [prefix].flat()[0];
  test(`the command takes ${name}`, { skip }, () => {
    const folder = mkdtempSync(join(tmpdir(), "arl2rs-snippets-"));
    try {
      writeFileSync(join(folder, "module.arl"), "int count = 1\n");
      writeFileSync(join(folder, "program.arl"), program(name, expanded(body)));
      const { status, stderr } = spawnSync(command, ["check", "program.arl"], { cwd: folder, encoding: "utf8" });
      assert.equal(status, 0, stderr);
      assert.doesNotMatch(stderr, /^error/m);
    } finally {
      rmSync(folder, { recursive: true });
    }
  });
}
