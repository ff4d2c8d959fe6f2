// What the tests share.

import { readFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

/** A file of the extension, by its path in this folder's parent. */
export const path = (file) => fileURLToPath(new URL(`../${file}`, import.meta.url));
export const text = (file) => readFileSync(path(file), "utf8");
export const json = (file) => JSON.parse(text(file));

/** A module of `src` that needs nothing of the editor. */
export async function load(name) {
  const { outputFiles } = await build({
    entryPoints: [path(`src/${name}.ts`)],
    bundle: true,
    write: false,
    platform: "node",
    format: "esm",
  });
  return import(`data:text/javascript;base64,${Buffer.from(outputFiles[0].contents).toString("base64")}`);
}

/** The command that the environment names, and why a test without it is skipped. */
export const command = process.env.ARL2RS;
export const skip = command ? false : "ARL2RS names no command";
