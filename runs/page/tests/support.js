// What the tests share: the command, programs that it records, and the page that it serves.

import { execFileSync, spawn } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { open } from "./browser.js";

/** The command that the environment names, and why a test without it is skipped. */
export const command = process.env.ARL2RS ?? "";
export const skip = command ? false : "ARL2RS names no command";

/** A folder for a test, gone behind it. @param {import('node:test').TestContext} test */
export function folder(test) {
  const path = mkdtempSync(join(tmpdir(), "arl2rs-view-"));
  test.after(() => rmSync(path, { recursive: true, force: true }));
  return path;
}

/** Records a program. @param {string} path @param {string} name @param {string} program @param {{files?: Record<string, string>, options?: string[]}} [more] */
export function record(path, name, program, { files = {}, options = [] } = {}) {
  writeFileSync(join(path, `${name}.arl`), program);
  for (const [file, text] of Object.entries(files)) writeFileSync(join(path, file), text);
  execFileSync(command, ["run", `${name}.arl`, "--record", `${name}.mcap`, ...options], {
    cwd: path,
    stdio: ["ignore", "ignore", "inherit"],
  });
}

/** Serves something; the address of the page. @param {import('node:test').TestContext} test @param {string} path @param {string[]} what */
export async function serve(test, path, ...what) {
  const server = spawn(command, ["view", ...what, "--no-open"], { cwd: path, stdio: ["ignore", "pipe", "inherit"] });
  const ended = new Promise((done) => server.on("exit", done));
  test.after(async () => {
    server.kill("SIGINT");
    await ended;
  });
  /** @type {string} */
  const url = await new Promise((found, failed) => {
    server.stdout.on("data", (bytes) => found(String(bytes).trim()));
    server.on("exit", () => failed(new Error("the server ended")));
  });
  return { url, server, ended };
}

/**
 * Opens a page; what it says on its console, and what it fails at, is kept.
 * @param {import('node:test').TestContext} test @param {string} url @param {{width?: number, height?: number, args?: string[]}} [look]
 */
export async function visit(test, url, { width = 1400, height = 850, args = [] } = {}) {
  const browser = await open(args);
  test.after(() => browser.close());
  const page = await browser.newPage({ viewport: { width, height } });
  /** @type {string[]} */
  const problems = [];
  page.on("console", (message) => {
    if (["error", "warning"].includes(message.type()) && !/GPU stall|GL Driver/.test(message.text())) problems.push(message.text());
  });
  page.on("pageerror", (error) => problems.push(String(error)));
  await page.goto(url);
  await page.waitForFunction(() => /** @type {any} */ (window).page?.tracks.rows);
  return { page, problems };
}
