// The settings of the extension.

import * as vscode from "vscode";
import type { Options } from "./options";

/** What `arl2rs.path` says; empty where it says nothing. */
export function commandSetting(): string {
  return vscode.workspace.getConfiguration("arl2rs").get("path", "").trim();
}

/** The options that programs are checked and run with. */
export function options(): Options {
  const settings = vscode.workspace.getConfiguration("arl2rs");
  const text = (name: string) => settings.get(name, "").trim();
  return {
    robot: text("robot"),
    cell: text("cell"),
    io: text("io"),
    scriptDir: text("scriptDir"),
    strict: settings.get("strict", false),
  };
}

/** The folder that relative paths in settings count from. */
export function firstFolder(): string | undefined {
  return vscode.workspace.workspaceFolders?.find((folder) => folder.uri.scheme === "file")?.uri.fsPath;
}
