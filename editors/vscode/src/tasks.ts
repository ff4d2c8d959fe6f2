// Tasks of the type `arl2rs`: the command in a terminal.

import * as vscode from "vscode";
import { commandEnvironment, findCommand } from "./command";
import { type Action, argumentsOf } from "./options";
import { firstFolder, options } from "./settings";

export const TASK_TYPE = "arl2rs";

/** A task as in `tasks.json`. */
interface Definition extends vscode.TaskDefinition {
  readonly command: Action;
  readonly path?: string;
  readonly args?: string[];
}

const ACTIONS: readonly Action[] = ["run", "check", "test", "pendant"];
/** The problem matchers for the output. Cases name files relative to their own folders: the test view shows those. */
const MATCHERS: Readonly<Record<Action, string[]>> = {
  run: ["$arl2rs", "$arl2rs-alarm"],
  check: ["$arl2rs"],
  test: ["$arl2rs-alarm"],
  pendant: ["$arl2rs-alarm"],
};

/** A task that acts on a program or on a folder of cases. */
export function taskFor(command: string, action: Action, path: string, more: readonly string[] = []): vscode.Task {
  return build(command, { type: TASK_TYPE, command: action, path, args: [...more] });
}

export class TaskProvider implements vscode.TaskProvider {
  provideTasks(): vscode.Task[] {
    const command = findCommand();
    if (command === undefined || vscode.window.activeTextEditor?.document.languageId !== "arl") {
      return [];
    }
    return ACTIONS.map((action) => build(command, { type: TASK_TYPE, command: action }));
  }

  resolveTask(task: vscode.Task): vscode.Task | undefined {
    const command = findCommand();
    const definition = task.definition as Definition;
    if (command === undefined || !ACTIONS.includes(definition.command)) {
      return undefined;
    }
    return build(command, definition, task.scope);
  }
}

function build(command: string, definition: Definition, scope?: vscode.Task["scope"]): vscode.Task {
  const action = definition.command;
  const path = definition.path ?? (action === "test" ? "${fileDirname}" : "${file}");
  const folder = firstFolder();
  const execution = new vscode.ProcessExecution(command, argumentsOf(action, path, options(), definition.args), {
    env: commandEnvironment(),
    ...(folder === undefined ? {} : { cwd: folder }),
  });
  const name = definition.path === undefined ? action : `${action} ${shortened(definition.path)}`;
  const where = scope ?? vscode.TaskScope.Workspace;
  const task = new vscode.Task(definition, where, name, TASK_TYPE, execution, MATCHERS[action]);
  const isScreen = action === "pendant";
  task.presentationOptions = {
    reveal: vscode.TaskRevealKind.Always,
    panel: isScreen ? vscode.TaskPanelKind.Dedicated : vscode.TaskPanelKind.Shared,
    focus: isScreen,
    clear: true,
  };
  if (action === "check") {
    task.group = vscode.TaskGroup.Build;
  } else if (action === "test") {
    task.group = vscode.TaskGroup.Test;
  }
  return task;
}

/** The last part of a path. */
function shortened(path: string): string {
  return path.split(/[\\/]/).filter((part) => part !== "").at(-1) ?? path;
}
