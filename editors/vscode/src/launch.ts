// Fills in a launch configuration from the settings.

import type { Options } from "./options";

/** A launch configuration, as far as it is given. */
export interface Configuration {
  type: string;
  request: string;
  name: string;
  [key: string]: unknown;
}

/** The complete configuration; undefined if there is no program to debug. */
export function launchConfiguration<T extends Configuration>(
  given: T,
  program: string | undefined,
  folder: string | undefined,
  options: Options,
): T | undefined {
  const { robot, cell, io, scriptDir } = options;
  const defaults = Object.entries({ program, cwd: folder, robot, cell, io, scriptDir });
  const filled: Configuration = { ...given };
  if (!given.type) {
    // Without a configuration the active program is debugged.
    Object.assign(filled, { type: "arl2rs", request: "launch", name: "Debug ARL Program" });
  }
  for (const [key, value] of defaults) {
    if (filled[key] === undefined && value !== undefined && value !== "") {
      filled[key] = value;
    }
  }
  return typeof filled["program"] === "string" ? (filled as T) : undefined;
}
