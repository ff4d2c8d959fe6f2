// The command `arl2rs` on this machine, and the message if it is missing.

import * as fs from "node:fs";
import * as os from "node:os";
import * as vscode from "vscode";
import { environmentFor, locate, type Surroundings } from "./locate";
import { commandSetting, firstFolder } from "./settings";

/** The path of the command, if it exists. */
export function findCommand(): string | undefined {
  return locate(surroundings());
}

/** The environment variables that the command needs in addition to those of the editor. */
export function commandEnvironment(): Record<string, string> {
  return environmentFor(surroundings());
}

/** The path of the command. If it is missing, the user is informed and may try again. */
export async function requireCommand(): Promise<string | undefined> {
  for (;;) {
    const found = findCommand();
    if (found !== undefined) {
      return found;
    }
    if (!(await wantsRetry())) {
      return undefined;
    }
  }
}

async function wantsRetry(): Promise<boolean> {
  const setting = commandSetting();
  const what =
    setting === ""
      ? "The command arl2rs was found neither in PATH nor in ~/.cargo/bin."
      : `The setting arl2rs.path does not name a command: ${setting}`;
  const how = "In a checkout of arl2rs, `cargo install --locked --path command` installs it.";
  const settings = "Open Settings";
  const retry = "Try Again";
  const chosen = await vscode.window.showErrorMessage(`${what} ${how}`, settings, retry);
  if (chosen === settings) {
    await vscode.commands.executeCommand("workbench.action.openSettings", "arl2rs.path");
  }
  return chosen === retry;
}

function surroundings(): Surroundings {
  return {
    setting: commandSetting(),
    environment: process.env,
    home: os.homedir(),
    folder: firstFolder(),
    windows: process.platform === "win32",
    isCommand,
  };
}

function isCommand(file: string): boolean {
  try {
    fs.accessSync(file, fs.constants.X_OK);
    return fs.statSync(file).isFile();
  } catch {
    return false;
  }
}
