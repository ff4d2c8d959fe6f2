// Debugging: the adapter is `arl2rs dap`. The statement that the robot executes is shown beside the one that runs.

import * as vscode from "vscode";
import { commandEnvironment, requireCommand } from "./command";
import { launchConfiguration } from "./launch";
import { options } from "./settings";

/** The type of debugging sessions. */
export const DEBUG_TYPE = "arl2rs";

/** What the adapter reports about a robot's motion; no file if it executes none. */
interface MotionPointer {
  readonly channel: number;
  readonly file?: string | null;
  readonly line: number;
}

export function registerDebugging(context: vscode.ExtensionContext): void {
  const pointers = new MotionPointers();
  context.subscriptions.push(
    pointers,
    vscode.debug.registerDebugConfigurationProvider(DEBUG_TYPE, new Configurations()),
    vscode.debug.registerDebugAdapterDescriptorFactory(DEBUG_TYPE, { createDebugAdapterDescriptor: adapter }),
    vscode.debug.onDidReceiveDebugSessionCustomEvent((event) => {
      if (event.session.type === DEBUG_TYPE && event.event === "arl/motionPointer") {
        pointers.move(event.body as MotionPointer);
      }
    }),
    vscode.debug.onDidTerminateDebugSession((session) => {
      if (session.type === DEBUG_TYPE) {
        pointers.clear();
      }
    }),
    vscode.commands.registerCommand("arl2rs.nextMotion", nextMotion),
  );
}

async function adapter(): Promise<vscode.DebugAdapterDescriptor | undefined> {
  const command = await requireCommand();
  if (command === undefined) {
    return undefined;
  }
  return new vscode.DebugAdapterExecutable(command, ["dap"], { env: commandEnvironment() });
}

/** Continues the program of the active thread until its robot begins another motion. */
async function nextMotion(): Promise<void> {
  const session = vscode.debug.activeDebugSession;
  if (session?.type === DEBUG_TYPE) {
    const item = vscode.debug.activeStackItem;
    await session.customRequest("arl/nextMotion", { threadId: item?.threadId ?? 1 });
  }
}

/** Fills in what a launch configuration leaves out. */
class Configurations implements vscode.DebugConfigurationProvider {
  resolveDebugConfiguration(
    folder: vscode.WorkspaceFolder | undefined,
    configuration: vscode.DebugConfiguration,
  ): vscode.DebugConfiguration | undefined {
    const active = vscode.window.activeTextEditor?.document;
    const program = active?.languageId === "arl" ? active.uri.fsPath : undefined;
    return launchConfiguration(configuration, program, folder?.uri.fsPath, options());
  }
}

/** Marks the lines whose motions robots execute. */
class MotionPointers implements vscode.Disposable {
  private readonly places = new Map<number, { file: string; line: number }>();
  private readonly mark = vscode.window.createTextEditorDecorationType({
    isWholeLine: true,
    overviewRulerColor: new vscode.ThemeColor("charts.blue"),
    overviewRulerLane: vscode.OverviewRulerLane.Center,
    borderStyle: "solid",
    borderWidth: "0 0 0 3px",
    borderColor: new vscode.ThemeColor("charts.blue"),
    after: { contentText: "  \u25b6 robot", color: new vscode.ThemeColor("charts.blue") },
  });
  private readonly changes = vscode.window.onDidChangeVisibleTextEditors(() => this.show());

  move(pointer: MotionPointer): void {
    if (pointer.file && pointer.line > 0) {
      this.places.set(pointer.channel, { file: pointer.file, line: pointer.line });
    } else {
      this.places.delete(pointer.channel);
    }
    this.show();
  }

  clear(): void {
    this.places.clear();
    this.show();
  }

  dispose(): void {
    this.changes.dispose();
    this.mark.dispose();
  }

  private show(): void {
    for (const editor of vscode.window.visibleTextEditors) {
      const here = [...this.places.values()].filter((place) => place.file === editor.document.uri.fsPath);
      const lines = here.filter((place) => place.line <= editor.document.lineCount);
      editor.setDecorations(this.mark, lines.map((place) => editor.document.lineAt(place.line - 1).range));
    }
  }
}
