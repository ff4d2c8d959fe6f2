// The settings of the extension.

import * as vscode from "vscode";
import type { Options } from "./options";

/** The setting `arl2rs.path`; empty if not set. */
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

/** The folder to which relative paths in settings are relative. */
export function firstFolder(): string | undefined {
  return vscode.workspace.workspaceFolders?.find((folder) => folder.uri.scheme === "file")?.uri.fsPath;
}
