// The language server: `arl2rs lsp`.

import * as vscode from "vscode";
import {
  LanguageClient,
  type LanguageClientOptions,
  type ServerOptions,
  TransportKind,
} from "vscode-languageclient/node";
import { commandEnvironment, findCommand, requireCommand } from "./command";
import { serverOptions } from "./options";
import { knows } from "./process";
import { options } from "./settings";

export class Server implements vscode.Disposable {
  private client: LanguageClient | undefined;
  /** Starts and stops are executed one after the other. */
  private last: Promise<void> = Promise.resolve();

  /** Starts or restarts the server. */
  restart(): Promise<void> {
    return this.then(async () => {
      await this.end();
      await this.begin();
    });
  }

  /** Sends the current settings to the server. */
  settingsChanged(): Promise<void> {
    return this.then(async () => {
      const settings = { arl2rs: serverOptions(options()) };
      if (this.client?.isRunning()) {
        await this.client.sendNotification("workspace/didChangeConfiguration", { settings });
      }
    });
  }

  stop(): Promise<void> {
    return this.then(() => this.end());
  }

  dispose(): void {
    void this.stop();
  }

  private then(step: () => Promise<void>): Promise<void> {
    this.last = this.last.then(step).catch((error: unknown) => {
      void vscode.window.showErrorMessage(`The language server of arl2rs: ${text(error)}`);
    });
    return this.last;
  }

  private async begin(): Promise<void> {
    const command = findCommand();
    if (command === undefined) {
      // The message may stay for a long time; nothing waits for it.
      void requireCommand().then((found) => (found === undefined ? undefined : this.restart()));
      return;
    }
    if (!(await knows(command, "lsp"))) {
      const newer = "A newer one has it: `cargo install --locked --path command`, in a checkout of arl2rs.";
      void vscode.window.showWarningMessage(`${command} has no language server. ${newer}`);
      return;
    }
    const server: ServerOptions = {
      command,
      args: ["lsp"],
      transport: TransportKind.stdio,
      options: { env: { ...process.env, ...commandEnvironment() } },
    };
    const client: LanguageClientOptions = {
      documentSelector: [
        { scheme: "file", language: "arl" },
        { scheme: "untitled", language: "arl" },
      ],
      initializationOptions: serverOptions(options()),
    };
    this.client = new LanguageClient("arl2rs", "ARL", server, client);
    await this.client.start();
  }

  private async end(): Promise<void> {
    const client = this.client;
    this.client = undefined;
    // Stopping a client that never started fails.
    await client?.dispose().catch(() => undefined);
  }
}

function text(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}
