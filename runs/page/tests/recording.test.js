// A recording in the browser.

import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { record, serve, skip, visit } from "./support.js";

const PROGRAM = `func void main()
  print "go"
  movej j:{0,-90,90,0,30,0}, vp:50%
  setdo(3, true)
  movej j:{40,-80,80,10,30,5}, vp:50%
  waittime 0.5
  setdo(3, false)
  movej j:{0,-70,90,0,30,0}, vp:50%
  waittime 0
  print "there"
endfunc
`;
const CELL = `[names]
"do.3" = "gripper"
[[body]]
name = "post"
box = [60, 60, 1400]
at = [700, -300, 700]
[[body]]
name = "part"
cylinder = [30, 80]
at = [0, 0, 60]
on = "flange"
when = "do.3"
`;

const path = mkdtempSync(join(tmpdir(), "arl2rs-view-"));
before(() => skip || record(path, "a", PROGRAM, { files: { "cell.toml": CELL }, options: ["--cell", "cell.toml"] }));
after(() => rmSync(path, { recursive: true, force: true }));

/** @param {any} page */
const state = (page) =>
  page.evaluate(() => ({ time: window.page.time, playing: window.page.playing, drawn: window.page.scene.drawn, end: window.page.end }));

test("another tool is not a motion", { skip }, async (test) => {
  const program = `tool grip = {{0, 0, 180, 0, 0, 0}, false}
func void main()
  movej j:{0,-90,90,0,30,0}, vp:50%
  movej j:{20,-80,90,0,30,0}, vp:50%, t:grip
  movej j:{0,-90,90,0,30,0}, vp:50%, t:$FLANGE
endfunc
`;
  record(path, "tools", program);
  const { url } = await serve(test, path, "tools.mcap");
  const { page, problems } = await visit(test, url);
  await page.waitForFunction(() => document.querySelector("#legend")?.textContent?.includes("mm/s"));
  const seen = await page.evaluate(() => {
    const { run, tracks } = /** @type {any} */ (window).page;
    const rows = run.channels[0].samples.piece(0, run.end);
    return {
      legend: document.querySelector("#legend")?.textContent,
      jumps: [...rows.jumps].filter(Boolean).length,
      fastest: Math.max(...tracks.rows.speed),
    };
  });
  assert.equal(seen.jumps, 2, "there and back");
  assert.ok(seen.fastest < 5000, `${seen.fastest} mm/s`);
  assert.match(seen.legend ?? "", /^0 to \d{2,4} mm\/s/);
  assert.deepEqual(problems, []);
});

test("a recording plays, scrubs and tells where the program is", { skip }, async (test) => {
  const { url } = await serve(test, path, "a.mcap");
  const { page, problems } = await visit(test, url);
  assert.equal(await page.title(), "a.mcap – arl2rs view");
  // Play.
  const before = await state(page);
  assert.equal(before.time, 0);
  await page.keyboard.press("Space");
  await page.waitForFunction(() => window.page.time > 0.2);
  await page.keyboard.press("Space");
  const played = await state(page);
  assert.ok(!played.playing && played.drawn > before.drawn, "pictures were drawn");
  // Scrub: a click on the time line, and the keys.
  const box = await page.locator("#tracks canvas").boundingBox();
  await page.mouse.click(box.x + box.width * 0.7, box.y + 30);
  const scrubbed = await state(page);
  assert.ok(Math.abs(scrubbed.time / scrubbed.end - 0.67) < 0.05, `${scrubbed.time} of ${scrubbed.end}`);
  await page.keyboard.press("Home");
  assert.equal((await state(page)).time, 0);
  // The next motion is that of line 5, and its pointer is in the text.
  await page.keyboard.press("ArrowDown");
  await page.keyboard.press("ArrowRight");
  await page.locator(".source .motion .number", { hasText: "5" }).waitFor();
  await page.locator("#now", { hasText: "movej in line 5" }).waitFor();
  // The robot of the page stands where the recording says.
  const [flange, tcp] = await page.evaluate(() => {
    const { frames, runs } = window.page.scene;
    const arm = frames[0].arms[0];
    const [flange, tcp] = [arm.links.at(-1).made, arm.tcp].map((frame) => frame.getWorldPosition(frame.position.clone()).toArray());
    return [flange, tcp];
  });
  flange.forEach((value, at) => assert.ok(Math.abs(value - tcp[at]) < 1e-5, `${flange} and ${tcp}`));
  // A line that is clicked is gone to.
  await page.locator(".source .code", { hasText: "j:{0,-70" }).click();
  await page.locator("#now", { hasText: "movej in line 8" }).waitFor();
  assert.deepEqual(problems, []);
});

test("what is carried is there while it is, signals have their names, contacts are marked", { skip }, async (test) => {
  const { url } = await serve(test, path, "a.mcap");
  const { page, problems } = await visit(test, url);
  const shown = () => page.evaluate(() => [...window.page.scene.frames[0].entities.keys()].filter((id) => id.startsWith("body/")));
  assert.deepEqual(await shown(), ["body/post"]);
  const contacts = await page.evaluate(() => window.page.run.answer.contacts);
  assert.ok(contacts.length > 0, "the arm goes through the post");
  await page.evaluate((time) => window.page.seek(time), contacts[0].time);
  await page.waitForFunction(() => [...window.page.scene.frames[0].entities.keys()].includes("body/part"));
  const red = await page.evaluate(() =>
    [...window.page.scene.frames[0].entities].filter(([, { group }]) => group.userData.marked).map(([id]) => id),
  );
  assert.ok(red.includes("body/post"), `${red}`);
  const labels = await page.evaluate(() => window.page.tracks.list.map((row) => row.label));
  assert.ok(labels.includes("gripper do.3"), `${labels}`);
  await page.getByRole("tab", { name: "Events" }).click();
  assert.match(await page.locator("#panel").innerText(), /go[\s\S]*touches post[\s\S]*there/);
  await page.getByRole("tab", { name: "Lines" }).click();
  assert.match(await page.locator("#panel").innerText(), /6\s+0\.000\s+0\.5\d+/, "line 6 waits");
  assert.deepEqual(problems, []);
});

test("a link opens at its moment, a reload stays there, and the colours are chosen", { skip }, async (test) => {
  const { url } = await serve(test, path, "a.mcap");
  const { page, problems } = await visit(test, `${url}#t=0.500&color=blend`);
  assert.equal((await state(page)).time, 0.5);
  assert.match(await page.locator("#legend").innerText(), /stops at the target/);
  for (const [key, word] of [
    ["1", "mm/s"],
    ["2", "j1"],
    ["4", "line 5"],
  ]) {
    await page.keyboard.press(key);
    await page.locator("#legend", { hasText: word }).waitFor();
  }
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("l");
  await page.reload();
  await page.waitForFunction(() => window.page?.tracks.rows);
  assert.equal((await state(page)).time, 0.52);
  const light = () => page.evaluate(() => document.documentElement.classList.contains("light"));
  const before = await light();
  await page.keyboard.press("d");
  assert.equal(await light(), !before);
  assert.deepEqual(problems, []);
});

test("a phone shows it below each other, nothing is cut off", { skip }, async (test) => {
  const { url } = await serve(test, path, "a.mcap");
  const { page, problems } = await visit(test, url, { width: 390, height: 844 });
  const width = await page.evaluate(() => document.documentElement.scrollWidth);
  assert.ok(width <= 390, `${width} wide`);
  await page
    .locator("#play")
    .tap()
    .catch(() => page.locator("#play").click());
  await page.waitForFunction(() => window.page.time > 0);
  assert.deepEqual(problems, []);
});

test("without WebGL everything else is shown", { skip }, async (test) => {
  const { url } = await serve(test, path, "a.mcap");
  const { page } = await visit(test, url, { args: ["--disable-3d-apis"] });
  assert.match(await page.locator("#nowhere").innerText(), /no WebGL/);
  await page.keyboard.press("ArrowDown");
  await page.keyboard.press("ArrowRight");
  await page.locator("#now", { hasText: "movej in line 5" }).waitFor();
});

test("a recording that is cut off is shown as far as it goes", { skip }, async (test) => {
  const bytes = readFileSync(join(path, "a.mcap"));
  writeFileSync(join(path, "cut.mcap"), bytes.subarray(0, bytes.length - 3000));
  const { url } = await serve(test, path, "cut.mcap");
  const { page } = await visit(test, url);
  assert.match(await page.locator("#trouble").innerText(), /the recording ends after/);
});

test("two recordings are in one cell, and what differs is a table", { skip }, async (test) => {
  record(path, "b", PROGRAM.replace("waittime 0.5", "waittime 0.9"), { options: ["--cell", "cell.toml"] });
  const { url } = await serve(test, path, "a.mcap", "b.mcap");
  const { page, problems } = await visit(test, url);
  assert.equal(await page.evaluate(() => window.page.scene.frames.length), 2);
  await page.getByRole("tab", { name: "Differences" }).click();
  const panel = page.locator("#panel");
  await panel.locator(".better, .worse").first().waitFor();
  assert.match(await panel.innerText(), /program of channel 1: `a.arl` became `b.arl`/);
  // The second one takes longer: at its end the first robot stands where it ended.
  await page.keyboard.press("End");
  const { time, end } = await state(page);
  assert.ok(time === end && end > (await page.evaluate(() => window.page.run.end)) + 0.3);
  assert.deepEqual(problems, []);
});
