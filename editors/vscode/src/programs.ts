// The commands that act on a program: run, check, test, plot, pendant.

import * as path from "node:path";
import * as vscode from "vscode";
import { requireCommand } from "./command";
import type { Action } from "./options";
import { PlotView } from "./plot";
import { taskFor } from "./tasks";

export function registerPrograms(context: vscode.ExtensionContext): void {
  const plots = new PlotView();
  const storage = context.storageUri ?? context.globalStorageUri;
  const commands: [string, (uri: unknown) => Promise<void>][] = [
    ["arl2rs.run", (uri) => start("run", uri)],
    ["arl2rs.check", (uri) => start("check", uri)],
    ["arl2rs.test", (uri) => start("test", uri)],
    ["arl2rs.pendant", (uri) => start("pendant", uri)],
    ["arl2rs.plot", (uri) => plot(uri, storage, plots)],
  ];
  context.subscriptions.push(plots);
  for (const [name, command] of commands) {
    context.subscriptions.push(vscode.commands.registerCommand(name, command));
  }
}

async function start(action: Action, uri: unknown): Promise<void> {
  const file = await program(uri);
  const command = file && (await requireCommand());
  if (file && command) {
    const target = action === "test" ? path.dirname(file) : file;
    await vscode.tasks.executeTask(taskFor(command, action, target));
  }
}

async function plot(uri: unknown, storage: vscode.Uri, plots: PlotView): Promise<void> {
  const file = await program(uri);
  const command = file && (await requireCommand());
  if (!file || !command) {
    return;
  }
  await vscode.workspace.fs.createDirectory(storage);
  const drawing = vscode.Uri.joinPath(storage, `${path.parse(file).name}.svg`);
  await vscode.workspace.fs.delete(drawing).then(undefined, () => undefined);
  await ended(taskFor(command, "run", file, ["--plot", drawing.fsPath]));
  await plots.show(drawing);
}

/** Executes a task and waits for its end. */
async function ended(task: vscode.Task): Promise<void> {
  let end = (): void => undefined;
  const over = new Promise<void>((resolve) => (end = resolve));
  let execution: vscode.TaskExecution | undefined;
  const early = new Set<vscode.TaskExecution>();
  const listener = vscode.tasks.onDidEndTask((event) => {
    early.add(event.execution);
    if (event.execution === execution) {
      end();
    }
  });
  try {
    execution = await vscode.tasks.executeTask(task);
    if (!early.has(execution)) {
      await over;
    }
  } finally {
    listener.dispose();
  }
}

/** The file of a code lens, or of the active editor; it is saved and shown, as alarms are relative to it. */
async function program(uri: unknown): Promise<string | undefined> {
  const document = await documentOf(uri);
  if (document === undefined) {
    void vscode.window.showInformationMessage("Open an ARL program first.");
    return undefined;
  }
  if (document.uri.scheme !== "file") {
    void vscode.window.showInformationMessage("Save the program first: the command reads files.");
    return undefined;
  }
  const unsaved = vscode.workspace.textDocuments.filter((other) => other.languageId === "arl" && other.isDirty);
  const saved = await Promise.all(unsaved.filter((other) => other.uri.scheme === "file").map((other) => other.save()));
  if (saved.includes(false)) {
    void vscode.window.showErrorMessage("A program could not be saved, so it is not run.");
    return undefined;
  }
  if (vscode.window.activeTextEditor?.document !== document) {
    await vscode.window.showTextDocument(document);
  }
  return document.uri.fsPath;
}

async function documentOf(uri: unknown): Promise<vscode.TextDocument | undefined> {
  if (typeof uri === "string") {
    return vscode.workspace.openTextDocument(vscode.Uri.parse(uri, true));
  }
  if (uri instanceof vscode.Uri) {
    return vscode.workspace.openTextDocument(uri);
  }
  const active = vscode.window.activeTextEditor?.document;
  return active?.languageId === "arl" ? active : undefined;
}
