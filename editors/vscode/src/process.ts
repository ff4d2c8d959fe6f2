// Runs the command: collects its output, or checks whether it has a subcommand.

import { execFile, spawn } from "node:child_process";
import type * as vscode from "vscode";
import { commandEnvironment } from "./command";

export interface Ended {
  /** The exit code; absent if the command was ended from outside. */
  readonly code: number | undefined;
  readonly out: string;
  readonly err: string;
}

export function collect(
  command: string,
  args: readonly string[],
  folder: string | undefined,
  token: vscode.CancellationToken,
): Promise<Ended> {
  return new Promise((resolve, reject) => {
    const child = spawn(command, args, {
      env: { ...process.env, ...commandEnvironment() },
      stdio: ["ignore", "pipe", "pipe"],
      ...(folder === undefined ? {} : { cwd: folder }),
    });
    let out = "";
    let err = "";
    child.stdout.setEncoding("utf8").on("data", (text: string) => (out += text));
    child.stderr.setEncoding("utf8").on("data", (text: string) => (err += text));
    const cancelling = token.onCancellationRequested(() => child.kill());
    child.on("error", (error) => {
      cancelling.dispose();
      reject(error);
    });
    child.on("close", (code) => {
      cancelling.dispose();
      resolve({ code: code ?? undefined, out, err });
    });
    if (token.isCancellationRequested) {
      child.kill();
    }
  });
}

/** How long the command may take to show its help, in ms. */
const PATIENCE = 10_000;

/** Whether the command has this subcommand. An older version may not. */
export function knows(command: string, subcommand: string): Promise<boolean> {
  const env = { ...process.env, ...commandEnvironment() };
  return new Promise((resolve) => {
    execFile(command, [subcommand, "--help"], { env, timeout: PATIENCE }, (error) => resolve(error === null));
  });
}
