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
console.log(`motions ${await page.evaluate(() => window.page.run.told.motions.length)}, ${await page.evaluate(() => window.page.run.end)} s of the robot's time`);
console.log(`shown after ${((performance.now() - begin) / 1000).toFixed(2)} s`);
const times = await page.evaluate(async () => {
  const { page } = window;
  // The graphics card is another one on each computer: what the page itself does counts.
  page.scene.renderer.render = () => {};
  const times = [];
  for (let at = 0; at < 600; at++) {
    const begin = performance.now();
    page.time = (page.end * at) / 600 > 250 ? at * 0.4 : (page.end * at) / 600;
    page.stale = page.tracks.stale = true;
    page.show();
    page.scene.draw();
    page.tracks.draw();
    times.push(performance.now() - begin);
    if (at % 20 === 0) await new Promise((done) => setTimeout(done));
  }
  return times.sort((one, other) => one - other);
});
const at = (part) => times[Math.floor(part * (times.length - 1))].toFixed(2);
console.log(`a picture takes ${at(0.5)} ms, 99 of 100 at most ${at(0.99)} ms; 60 a second leave 16.7 ms`);
await browser.close();
server.kill();
