// The picture of the documentation.

import { execFileSync } from "node:child_process";
import { test } from "node:test";
import { command, path, skip } from "./support.mjs";

test("the picture shows what the grammar and the server say", { skip }, () => {
  execFileSync(process.execPath, [path("scripts/picture.mjs"), command, "--check"], { stdio: "pipe" });
});
