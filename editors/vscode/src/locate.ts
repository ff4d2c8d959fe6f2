// Finds the command `arl2rs` on the disk.

import * as path from "node:path";

/** What the search depends on. */
export interface Surroundings {
  /** The setting `arl2rs.path`; empty if not set. */
  readonly setting: string;
  readonly environment: Readonly<Record<string, string | undefined>>;
  readonly home: string;
  /** The folder to which a relative path in the setting is relative. */
  readonly folder: string | undefined;
  readonly windows: boolean;
  /** Whether there is an executable file at a path. */
  readonly isCommand: (file: string) => boolean;
}

/** The path of the command. If the setting is given, nothing else is tried. */
export function locate(around: Surroundings): string | undefined {
  if (around.setting !== "") {
    return spellings(expanded(around), around.windows).find(around.isCommand);
  }
  return searched(around)
    .flatMap((folder) => spellings(paths(around).join(folder, "arl2rs"), around.windows))
    .find(around.isCommand);
}

/** The environment for the command, which calls `cargo`: the folder of `cargo` must be in `PATH`. */
export function environmentFor(around: Surroundings): Record<string, string> {
  const key = pathKey(around);
  return { [key]: searched(around).join(paths(around).delimiter) };
}

/** The folders of `PATH` and the folders into which cargo installs. */
function searched(around: Surroundings): string[] {
  const { join, delimiter } = paths(around);
  const listed = (around.environment[pathKey(around)] ?? "").split(delimiter);
  const cargo = around.environment["CARGO_HOME"];
  const all = [...listed, ...(cargo ? [join(cargo, "bin")] : []), join(around.home, ".cargo", "bin")];
  return [...new Set(all.filter((folder) => folder !== ""))];
}

/** The name of the variable `PATH`, which Windows spells `Path`. */
function pathKey(around: Surroundings): string {
  const same = (key: string) => (around.windows ? key.toUpperCase() === "PATH" : key === "PATH");
  return Object.keys(around.environment).find(same) ?? "PATH";
}

/** The setting with `~` and `${workspaceFolder}` replaced; a bare name is looked for in the folders. */
function expanded(around: Surroundings): string {
  const { join, isAbsolute } = paths(around);
  const text = around.setting
    .replace(/^~(?=$|[\\/])/, () => around.home)
    .replace("${workspaceFolder}", () => around.folder ?? "");
  if (isAbsolute(text)) {
    return text;
  }
  if (!/[\\/]/.test(text)) {
    const isThere = (file: string) => spellings(file, around.windows).some(around.isCommand);
    return searched(around).map((folder) => join(folder, text)).find(isThere) ?? text;
  }
  return around.folder === undefined ? text : join(around.folder, text);
}

function spellings(file: string, windows: boolean): string[] {
  return windows && !/\.exe$/i.test(file) ? [`${file}.exe`] : [file];
}

function paths(around: Surroundings): path.PlatformPath {
  return around.windows ? path.win32 : path.posix;
}
