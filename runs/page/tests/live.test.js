// A program that runs while it is shown.

import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { folder, serve, skip, visit } from "./support.js";

const PROGRAM = `func void main()
  print "go"
  movej j:{0,-90,90,0,30,0}, vp:50%
  waituntil getdi(5)
  while(true)
    movej j:{30,-80,80,10,30,5}, vp:30%
    movej j:{-30,-80,80,10,30,5}, vp:30%
  endwhile
endfunc
`;

/** @param {any} page @param {string} word */
const says = (page, word) => page.locator("#now h2", { hasText: word }).waitFor();

test("a program is started, paused, told inputs, and stopped with the command", { skip }, async (test) => {
  const path = folder(test);
  writeFileSync(join(path, "a.arl"), PROGRAM);
  writeFileSync(join(path, "cell.toml"), '[names]\n"di.5" = "door_open"\n');
  const { url, server, ended } = await serve(test, path, "a.arl", "--cell", "cell.toml");
  const { page, problems } = await visit(test, url);
  // Nothing moves before somebody says so.
  await says(page, "paused");
  await page.getByRole("button", { name: "Start" }).click();
  await says(page, "running");
  await page.getByRole("tab", { name: "Events" }).click();
  await page.locator("#panel", { hasText: "go" }).waitFor();
  // An input, by its name.
  await page.getByRole("tab", { name: "Inputs" }).click();
  await page.locator("#panel", { hasText: "door_open" }).waitFor();
  await page.getByRole("button", { name: "di.5" }).click();
  await page.waitForFunction(() => window.page.run.track(1).files && window.page.run.lanes.has("di.5"));
  await page.getByRole("tab", { name: "Source" }).click();
  await page.locator(".source .motion .number", { hasText: "6" }).waitFor();
  // A reload finds it as it is, and what it did before.
  await page.reload();
  await page.waitForFunction(() => window.page?.tracks.rows && window.page.run.lanes.has("di.5"));
  await says(page, "running");
  await page.getByRole("button", { name: "Override down" }).click();
  await page.locator("#buttons output", { hasText: "90 %" }).waitFor();
  await page.getByRole("button", { name: "Pause" }).click();
  await says(page, "paused");
  // What cannot be is told.
  await page.evaluate(() => fetch("/api/order", { method: "POST", body: "di.1 = maybe" }));
  await page.getByRole("tab", { name: "Events" }).click();
  await page.locator("#panel .warning", { hasText: "di.1 = maybe" }).waitFor();
  assert.deepEqual(problems, []);
  // Ctrl-C stops the robot and the command, and the page says so.
  server.kill("SIGINT");
  assert.equal(await ended, 130);
  await page.locator("#trouble", { hasText: /ended|gone/ }).waitFor();
});

test("motions are told as they end, with what they did", { skip }, async (test) => {
  const path = folder(test);
  writeFileSync(join(path, "a.arl"), PROGRAM);
  const { url } = await serve(test, path, "a.arl");
  const { page } = await visit(test, url);
  await page.getByRole("button", { name: "Start" }).click();
  await page.waitForFunction(() => window.page.run.answer.motions.length > 0);
  const motion = await page.evaluate(() => window.page.run.answer.motions[0]);
  assert.equal(motion.kind, "movej");
  assert.ok(motion.duration > 0.01 && motion.vel[1] > 0, JSON.stringify(motion));
});
