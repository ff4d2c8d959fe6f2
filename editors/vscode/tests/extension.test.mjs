// The bundle begins, in an editor that does nothing, and has all that package.json promises.

import assert from "node:assert/strict";
import { chmodSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import Module, { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { json, path } from "./support.mjs";

const manifest = json("package.json");

/** Something that can be called, made, extended and asked for anything; `known` is what it has of its own. */
function anything(known = {}) {
  return new Proxy(function () {}, {
    get: (target, name) => {
      if (name in known) {
        return known[name];
      }
      if (name === "prototype") {
        return target.prototype;
      }
      return typeof name === "symbol" || name === "then" ? undefined : anything();
    },
    apply: () => anything(),
    construct: () => anything(),
  });
}

const commands = [];
const messages = [];
let warn;
const warned = new Promise((resolve) => (warn = resolve));
const taskTypes = [];
// A bundle copies what a module has, and takes the rest from its prototype.
const editor = Object.create(anything({
  commands: anything({ registerCommand: (name) => commands.push(name) }),
  tasks: anything({ registerTaskProvider: (type) => taskTypes.push(type) }),
  window: anything({
    showErrorMessage: async (text) => void messages.push(text),
    showWarningMessage: async (text) => warn(text),
    activeTextEditor: undefined,
  }),
  workspace: anything({
    getConfiguration: () => ({ get: (name, otherwise) => otherwise }),
    workspaceFolders: undefined,
    findFiles: async () => [],
  }),
  tests: anything({ createTestController: () => anything({ items: anything({ replace: () => undefined }) }) }),
}));

const { _load } = Module;
Module._load = (name, ...rest) => (name === "vscode" ? editor : _load(name, ...rest));
const extension = createRequire(import.meta.url)(path("dist/extension.js"));
const tools = mkdtempSync(join(tmpdir(), "arl2rs-tools-"));
after(() => rmSync(tools, { recursive: true }));

test("it registers its commands, and says where the command is missing", async () => {
  for (const name of ["PATH", "Path", "CARGO_HOME"]) {
    delete process.env[name];
  }
  process.env.HOME = process.env.USERPROFILE = path("tests/nobody");
  extension.activate({ subscriptions: [], storageUri: undefined, globalStorageUri: undefined });
  assert.deepEqual(commands.sort(), manifest.contributes.commands.map(({ command }) => command).sort());
  assert.deepEqual(taskTypes, manifest.contributes.taskDefinitions.map(({ type }) => type));
  await new Promise((resolve) => setTimeout(resolve, 10));
  assert.equal(messages.length, 1);
  assert.match(messages[0], /cargo install --locked --path command/);
  await extension.deactivate();
});

const on_windows = process.platform === "win32" && "a script is not a command on Windows";

test("it says where the command is too old for a server", { skip: on_windows }, async () => {
  const old = join(tools, "arl2rs");
  writeFileSync(old, "#!/bin/sh\nexit 2\n");
  chmodSync(old, 0o755);
  process.env.PATH = tools;
  extension.activate({ subscriptions: [], storageUri: undefined, globalStorageUri: undefined });
  assert.match(await warned, new RegExp(`^${old} has no language server`));
  await extension.deactivate();
});
