// Where the command is looked for.

import assert from "node:assert/strict";
import { test } from "node:test";
import { load } from "./support.mjs";

const { locate, environmentFor } = await load("locate");

const around = (files, more = {}) => ({
  setting: "",
  environment: { PATH: "/usr/bin:/opt/bin" },
  home: "/home/me",
  folder: "/home/me/cell",
  windows: false,
  isCommand: (file) => files.includes(file),
  ...more,
});

test("PATH comes first, then the folders of cargo", () => {
  assert.equal(locate(around(["/opt/bin/arl2rs", "/home/me/.cargo/bin/arl2rs"])), "/opt/bin/arl2rs");
  assert.equal(locate(around(["/home/me/.cargo/bin/arl2rs"])), "/home/me/.cargo/bin/arl2rs");
  const environment = { CARGO_HOME: "/data/cargo" };
  assert.equal(locate(around(["/data/cargo/bin/arl2rs"], { environment })), "/data/cargo/bin/arl2rs");
  assert.equal(locate(around([])), undefined);
});

test("the setting counts alone", () => {
  const installed = "/home/me/.cargo/bin/arl2rs";
  const found = (setting, ...files) => locate(around([installed, ...files], { setting }));
  assert.equal(found("/x/arl2rs", "/x/arl2rs"), "/x/arl2rs");
  assert.equal(found("/x/arl2rs"), undefined);
  assert.equal(found("~/bin/arl2rs", "/home/me/bin/arl2rs"), "/home/me/bin/arl2rs");
  assert.equal(found("bin/arl2rs", "/home/me/cell/bin/arl2rs"), "/home/me/cell/bin/arl2rs");
  assert.equal(found("${workspaceFolder}/arl2rs", "/home/me/cell/arl2rs"), "/home/me/cell/arl2rs");
  assert.equal(found("arl2rs"), installed);
  assert.equal(found("arl2rs-new", "/usr/bin/arl2rs-new"), "/usr/bin/arl2rs-new");
});

test("Windows has other paths and an ending", () => {
  const windows = { windows: true, home: "C:\\Users\\me", environment: { Path: "C:\\tools;D:\\bin" } };
  assert.equal(locate(around(["D:\\bin\\arl2rs.exe"], windows)), "D:\\bin\\arl2rs.exe");
  const installed = "C:\\Users\\me\\.cargo\\bin\\arl2rs.exe";
  assert.equal(locate(around([installed], windows)), installed);
  assert.equal(locate(around(["E:\\a.exe"], { ...windows, setting: "E:\\a.exe" })), "E:\\a.exe");
  assert.deepEqual(environmentFor(around([], windows)), { Path: "C:\\tools;D:\\bin;C:\\Users\\me\\.cargo\\bin" });
});

test("the command finds cargo", () => {
  assert.deepEqual(environmentFor(around([])), { PATH: "/usr/bin:/opt/bin:/home/me/.cargo/bin" });
  const environment = { PATH: "/home/me/.cargo/bin:/usr/bin" };
  assert.deepEqual(environmentFor(around([], { environment })), environment);
});
