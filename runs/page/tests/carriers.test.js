// What external axes move, in the browser.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { command, record, serve, skip, visit } from "./support.js";

const PROGRAM = `func void main()
  movej j:{0,-70,100,0,60,0,0,0}, vp:100%
  movej j:{0,-70,100,0,60,0,90,200}, vp:100%
endfunc
`;
const axis = (name, more) => `[[axis]]\nname = "${name}"\nmin = -360\nmax = 360\nvel = 100\nacc = 1000\njerk = 10000\n${more}\n`;
/** A turntable with a slide on it. */
const CELL = `[[carrier]]
axis = "ej1"
at = [900, -300, 200]
[[carrier]]
axis = "ej2"
on = "ej1"
at = [100, 0, 50, 0, 90, 0]
[[body]]
name = "part"
box = [60, 60, 40]
at = [0, 0, 10]
on = "ej2"
`;

const path = mkdtempSync(join(tmpdir(), "arl2rs-view-"));
before(() => {
  if (skip) return;
  const built = execFileSync(command, ["robots", "kr10-r1420"], { encoding: "utf8" });
  const robot = built.replace(/\n\[\[link\]\][^]*/, "\n") + axis("ej1", "") + axis("ej2", "linear = true");
  record(path, "a", PROGRAM, { files: { "cell.toml": CELL, "arm.toml": robot }, options: ["--cell", "cell.toml", "--robot", "arm.toml"] });
});
after(() => rmSync(path, { recursive: true, force: true }));

test("a body goes with the external axes that move it", { skip }, async (test) => {
  const { url } = await serve(test, path, "a.mcap");
  const { page, problems } = await visit(test, url);
  const at = async (/** @type {number} */ time) => {
    await page.evaluate((time) => window.page.seek(time), time);
    // Two pictures later it is shown.
    await page.evaluate(() => new Promise((next) => requestAnimationFrame(() => requestAnimationFrame(next))));
    return page.evaluate(() => {
      const { of, group } = window.page.scene.frames[0].entities.get("body/part");
      const [mesh] = group.children;
      return { frame: of.frame, at: mesh.getWorldPosition(mesh.position.clone()).toArray() };
    });
  };
  const near = (/** @type {number[]} */ one, /** @type {number[]} */ other) =>
    assert.ok(Math.hypot(...one.map((value, axis) => value - other[axis])) < 1e-3, `${one} and ${other}`);
  const before = await at(0);
  assert.equal(before.frame, "ej2");
  // The slide lies along x of the table.
  near(before.at, [1.01, -0.3, 0.25]);
  const after = await at(await page.evaluate(() => window.page.end));
  near(after.at, [0.9, -0.3 + 0.1 + 0.01 + 0.2, 0.25]);
  assert.deepEqual(problems, []);
});
