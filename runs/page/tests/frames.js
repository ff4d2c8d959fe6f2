// How long a picture takes the page, without what the graphics card does: `ARL2RS=COMMAND node tests/frames.js RUN.mcap`

import { spawn } from "node:child_process";
import { open } from "./browser.js";

const server = spawn(process.env.ARL2RS ?? "arl2rs", ["view", process.argv[2], "--no-open"], { stdio: ["ignore", "pipe", "inherit"] });
const url = await new Promise((found) => server.stdout.on("data", (bytes) => found(String(bytes).trim())));
const browser = await open();
const page = await browser.newPage({ viewport: { width: 1400, height: 850 } });
const begin = performance.now();
await page.goto(url);
await page.waitForFunction(() => window.page?.tracks.rows && window.page.scene.fitted);
const motions = await page.evaluate(() => window.page.run.answer.motions.length);
console.log(`motions ${motions}, ${await page.evaluate(() => window.page.run.end)} s of the robot's time`);
console.log(`shown after ${((performance.now() - begin) / 1000).toFixed(2)} s`);
/** Pictures while it plays, each at a time of its own: what they take the page, and how far they are apart. @param {boolean} scrubs */
const measure = (scrubs) =>
  page.evaluate(async (scrubs) => {
    const { page } = window;
    // The graphics card is another one on each computer: what the page itself does counts.
    page.scene.renderer.render = () => {};
    const [taken, apart] = [[], []];
    let last = 0;
    for (let at = 0; at < 600; at++) {
      const now = await new Promise((next) => requestAnimationFrame(next));
      const begin = performance.now();
      page.time = scrubs ? (page.end * at) / 600 : Math.min(page.end, 250) * (at / 600);
      page.stale = true;
      page.show();
      page.scene.draw();
      page.tracks.draw();
      taken.push(performance.now() - begin);
      if (last) apart.push(now - last);
      last = now;
    }
    const sorted = (list) => list.sort((one, other) => one - other);
    return [sorted(taken), sorted(apart)];
  }, scrubs);
for (const scrubs of [false, true]) {
  const [taken, apart] = await measure(scrubs);
  const at = (list, part) => list[Math.floor(part * (list.length - 1))].toFixed(2);
  const what = scrubs ? "scrubbed over all of it" : "played";
  console.log(`${what}: a picture takes the page ${at(taken, 0.5)} ms, 99 of 100 at most ${at(taken, 0.99)} ms, all ${at(taken, 1)} ms`);
  console.log(`  pictures are ${at(apart, 0.5)} ms apart, 99 of 100 at most ${at(apart, 0.99)} ms`);
}
await browser.close();
server.kill();
