// The options of the command `arl2rs`, and the argument lists made from them.

export interface Options {
  readonly robot: string;
  readonly cell: string;
  readonly io: string;
  readonly scriptDir: string;
  readonly strict: boolean;
}

/** The actions of a task. */
export type Action = "run" | "check" | "test" | "pendant";

/** The arguments for an action on a program, or on a folder of cases. */
export function argumentsOf(action: Action, path: string, options: Options, more: readonly string[] = []): string[] {
  switch (action) {
    case "run":
      return ["run", path, ...common(options), ...given("--io", options.io), ...more];
    case "pendant":
      return ["run", path, "--pendant", ...common(options), ...given("--io", options.io), ...more];
    case "check":
      return ["check", path, ...common(options), ...(options.strict ? ["--strict"] : []), ...more];
    case "test":
      return ["test", path, ...more];
  }
}

/** The options for the language server: only those that are set. */
export function serverOptions(options: Options): Record<string, string | boolean> {
  const { robot, cell, scriptDir, strict } = options;
  const texts = Object.entries({ robot, cell, scriptDir }).filter(([, value]) => value !== "");
  return { ...Object.fromEntries(texts), strict };
}

function common(options: Options): string[] {
  return [
    ...given("--robot", options.robot),
    ...given("--cell", options.cell),
    ...given("--script-dir", options.scriptDir),
  ];
}

function given(option: string, value: string): string[] {
  return value === "" ? [] : [option, value];
}
