// Points, taught in the browser.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { folder, serve, skip, visit } from "./support.js";

const PROGRAM = `func void main()
  movej home, vp:50%
  ptp feeder, vp:50%
  print feeder.x
endfunc
`;
const POINTS = `// Points of a.arl.
joint home = {0, -90, 90, 0, 90, 0}
pose feeder = {x 900, y -500, z 400, a 0, b 180, c 0} // the belt
pose pallet = {x 800, y 300, z 350, a 0, b 180, c 0}
tool grip = {{0, 0, 100, 0, 0, 0}, false}
`;

/** A program with points, in a repository. @param {any} test */
function project(test) {
  const path = folder(test);
  const git = (...words) =>
    execFileSync("git", words, { cwd: path, encoding: "utf8", env: { ...process.env, GIT_CONFIG_GLOBAL: "/dev/null" } });
  writeFileSync(join(path, "a.arl"), PROGRAM);
  writeFileSync(join(path, "a_data.arl"), POINTS);
  git("init", "-q");
  git("add", ".");
  git("-c", "user.name=a", "-c", "user.email=a@b", "commit", "-qm", "points");
  return { path, git, points: () => readFileSync(join(path, "a_data.arl"), "utf8") };
}

const field = (page, name) => page.getByLabel(name, { exact: true });

test("a point is moved by 50 mm: git diff shows it, and the program goes there", { skip }, async (test) => {
  const { path, git, points } = project(test);
  const { url } = await serve(test, path, "a.arl", "--teach");
  const { page, problems } = await visit(test, url);
  await page.getByRole("tab", { name: "Teach" }).click();
  await page.getByText("feeder", { exact: true }).click();
  await page.waitForFunction(() => document.querySelector('[aria-label="x"]').value === "900");
  await field(page, "x").fill("950");
  await field(page, "x").press("Enter");
  await page.waitForFunction(() => window.page.teach.place?.components[0] === 950);
  await page.getByRole("button", { name: "Teach", exact: true }).click();
  await page.locator(".teach .hint", { hasText: "Written" }).waitFor();
  const diff = git("diff", "-U0")
    .split("\n")
    .filter((line) => /^[+-][^+-]/.test(line));
  assert.deepEqual(
    diff.map((line) => line.replace(/, cfg \d/, "")),
    [
      "-pose feeder = {x 900, y -500, z 400, a 0, b 180, c 0} // the belt",
      "+pose feeder = {x 950, y -500, z 400, a 0, b 180, c 0} // the belt",
    ],
  );
  // The dragged robot stands where the point is.
  const tcp = await page.evaluate(() => window.page.teach.place.placed.slice(0, 3));
  assert.ok(Math.hypot(tcp[0] - 950, tcp[1] + 500, tcp[2] - 400) < 1e-6, `${tcp}`);
  // From the next reset on the program goes there.
  await page.getByRole("button", { name: "Reset" }).click();
  await page.locator("#now h2", { hasText: /stopped|ended/ }).waitFor();
  await page.getByRole("button", { name: "Reset" }).click();
  await page.waitForFunction(() => window.page.run.answer.log.some((log) => log.text === "950"), undefined, { timeout: 20000 });
  await page.getByRole("button", { name: "Undo" }).click();
  await page.waitForFunction(() => window.page.teach.data.undo === 0);
  assert.equal(points(), POINTS);
  assert.deepEqual(problems, []);
});

test("groups are shifted and mirrored, configurations offered, the TCP dragged", { skip }, async (test) => {
  const { path, points } = project(test);
  const { url } = await serve(test, path, "a.arl", "--teach");
  const { page, problems } = await visit(test, url);
  await page.getByRole("tab", { name: "Teach" }).click();
  for (const name of ["feeder", "pallet"]) await page.getByRole("checkbox", { name }).click();
  await page.getByLabel("by z").fill("25");
  await page.getByRole("button", { name: "Shift" }).click();
  await page.waitForFunction(() => window.page.teach.data.undo === 1);
  assert.match(points(), /feeder = {x 900, y -500, z 425,.*\n.*pallet = {x 800, y 300, z 375,/);
  await page.getByRole("button", { name: "Mirror y" }).click();
  await page.waitForFunction(() => window.page.teach.data.undo === 2);
  assert.match(points(), /feeder = {x 900, y 500, z 425,.*\n.*pallet = {x 800, y -300, z 375,/);
  // All configurations are offered, those that do not reach with a reason.
  await page.getByText("feeder", { exact: true }).click();
  await page.waitForFunction(() => document.querySelectorAll(".solutions button").length === 8);
  const offered = await page.locator(".solutions button").evaluateAll((all) => all.map((one) => [one.disabled, one.title]));
  assert.ok(
    offered.some(([disabled]) => !disabled) && offered.every(([disabled, title]) => !disabled || title.length > 5),
    JSON.stringify(offered),
  );
  // Dragged out of reach it says so, and nothing can be taught there.
  await page.evaluate(() => {
    const { robot } = window.page.teach;
    robot.handle.position.set(4, 0, 1);
    robot.dragged();
  });
  await page.locator(".teach .hint", { hasText: "out of reach" }).waitFor();
  assert.ok(await page.getByRole("button", { name: "Teach", exact: true }).isDisabled());
  // A map of reach is a plane in the cell.
  await page.getByText("pallet", { exact: true }).click();
  await page.waitForFunction(() => window.page.teach.place?.nearest !== null);
  await page.getByRole("button", { name: "Map" }).click();
  await page.waitForFunction(() => window.page.teach.mapped?.group.children.length === 1);
  assert.deepEqual(problems, []);
});

test("the robot moves while a button is held, and no longer", { skip }, async (test) => {
  const { path } = project(test);
  const { url } = await serve(test, path, "a.arl", "--teach");
  const { page, problems } = await visit(test, url);
  await page.getByRole("tab", { name: "Teach" }).click();
  const axes = () =>
    page.evaluate(() =>
      window.page.channel.samples.window(window.page.run.end, window.page.run.end).then((rows) => [...rows.axes.slice(-6)]),
    );
  const rests = async () => {
    for (let last = [NaN]; ;) {
      const now = await axes();
      if (now.every((axis, at) => axis === last[at])) return now;
      last = now;
      await page.waitForTimeout(300);
    }
  };
  const before = await rests();
  const box = await page.getByRole("button", { name: "j1+" }).boundingBox();
  await page.mouse.move(box.x + 5, box.y + 5);
  await page.mouse.down();
  await page.waitForTimeout(1500);
  await page.mouse.up();
  const held = await rests();
  assert.ok(held[0] > before[0] + 2 && held[0] < 160, `${before} ${held}`);
  // A page that is lost while it holds a button stops the robot, too.
  await page.mouse.down();
  await page.waitForTimeout(800);
  await page.goto("about:blank");
  await page.goto(url);
  await page.waitForFunction(() => window.page?.tracks.rows);
  const lost = await rests();
  assert.ok(lost[0] > held[0] && lost[0] < 165, `${held} ${lost}`);
  assert.deepEqual(problems, []);
});

test("without --teach nothing is written", { skip }, async (test) => {
  const { path, points } = project(test);
  const { url } = await serve(test, path, "a.arl");
  const { page } = await visit(test, url);
  assert.equal(await page.getByRole("tab", { name: "Teach" }).count(), 0);
  const status = await page.evaluate(async () => (await fetch("/api/teach/undo", { method: "POST", body: "{}" })).status);
  assert.equal(status, 409);
  assert.equal(points(), POINTS);
});
