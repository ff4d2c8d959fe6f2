// The entry point of the extension.

import * as vscode from "vscode";
import { registerDebugging } from "./debug";
import { registerPrograms } from "./programs";
import { Server } from "./server";
import { TASK_TYPE, TaskProvider } from "./tasks";
import { TestView } from "./tests";

let server: Server | undefined;

export function activate(context: vscode.ExtensionContext): void {
  const own = new Server();
  server = own;
  context.subscriptions.push(
    own,
    vscode.commands.registerCommand("arl2rs.restart", () => own.restart()),
    vscode.tasks.registerTaskProvider(TASK_TYPE, new TaskProvider()),
    vscode.workspace.onDidChangeConfiguration((change) => {
      if (change.affectsConfiguration("arl2rs.path")) {
        void own.restart();
      } else if (change.affectsConfiguration("arl2rs")) {
        void own.settingsChanged();
      }
    }),
    new TestView(),
  );
  registerPrograms(context);
  registerDebugging(context);
  void own.restart();
}

export function deactivate(): Promise<void> | undefined {
  return server?.stop();
}
