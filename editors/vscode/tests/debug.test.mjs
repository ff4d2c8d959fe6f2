// The debug adapter, with Microsoft's own client.

import assert from "node:assert/strict";
import { mkdtempSync, realpathSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { DebugClient } from "@vscode/debugadapter-testsupport";
import { command, skip } from "./support.mjs";

const PROGRAM = `func void opened(int gate)
    setdo(3, true)
endfunc
func void main()
    joint home = {60, -90, 90, 0, 90, 0}
    interrupt "gate", when:getdi(5), do:opened(7)
    movej home, vp:50%
    movej j:{30, -90, 90, 0, 90, 0}, vp:50%
    waittime 0
    print "done"
endfunc
`;

let folder, client;

before(async () => {
  folder = realpathSync(mkdtempSync(join(tmpdir(), "arl2rs-debug-")));
  writeFileSync(join(folder, "main.arl"), PROGRAM);
  writeFileSync(join(folder, "io.toml"), "[[event]]\nat = 0.5\ndi.5 = true\n");
});

after(async () => {
  await client?.stop();
  rmSync(folder, { recursive: true, force: true });
});

test("a breakpoint in the action of an interrupt", { skip, timeout: 300_000 }, async () => {
  const program = join(folder, "main.arl");
  const launch = { program, io: "io.toml" };
  client = new DebugClient(command, "dap", "arl2rs", { cwd: folder });
  client.defaultTimeout = 240_000;
  await client.start();
  await client.hitBreakpoint(launch, { path: program, line: 2 });
  const { body: { stackFrames } } = await client.stackTraceRequest({ threadId: 1 });
  assert.deepEqual(stackFrames.map((frame) => frame.name), ["opened", "the interrupt \"gate\"", "main"]);
  const { body: { result } } = await client.evaluateRequest({ expression: "gate * 2", frameId: stackFrames[0].id });
  assert.equal(result, "14");
  await Promise.all([
    client.nextRequest({ threadId: 1 }),
    client.waitForEvent("stopped"),
  ]);
  await Promise.all([
    client.continueRequest({ threadId: 1 }),
    client.assertOutput("stdout", "done", 60_000),
    client.waitForEvent("terminated"),
  ]);
});
