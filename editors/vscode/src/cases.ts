// Which files are cases: NAME.arl with NAME.out, NAME.err or NAME.alarm beside it.

const SIDECAR = /\.(?:out|err|alarm)$/;

/** The cases among these files. */
export function casesAmong(files: readonly string[]): string[] {
  const all = new Set(files);
  const programs = files.filter((file) => SIDECAR.test(file)).map((file) => file.replace(SIDECAR, ".arl"));
  return [...new Set(programs)].filter((program) => all.has(program) && !isHidden(program)).sort();
}

/** The folders to pass to the command: those of these cases, without folders that lie inside others. */
export function foldersOf(cases: readonly string[]): string[] {
  const folders = [...new Set(cases.map(folderOf))].sort();
  const isBelow = (inner: string, outer: string): boolean => inner !== outer && inner.startsWith(`${outer}/`);
  return folders.filter((folder) => !folders.some((other) => isBelow(folder, other)));
}

/** The folder of a path whose parts are separated by `/`. */
export function folderOf(path: string): string {
  return path.slice(0, Math.max(path.lastIndexOf("/"), 0));
}

/** The command skips folders whose names begin with a dot. */
function isHidden(path: string): boolean {
  return folderOf(path).split("/").some((part) => part.startsWith("."));
}
