// What `arl2rs test --coverage` writes: which lines and functions ran, and how often.

export interface FileCoverage {
  readonly file: string;
  /** Lines from 1, and how often they ran. */
  readonly lines: ReadonlyMap<number, number>;
  readonly functions: readonly FunctionCoverage[];
}

export interface FunctionCoverage {
  readonly name: string;
  readonly line: number;
  readonly count: number;
}

/** Reads lcov; lines without meaning here are skipped. */
export function readLcov(text: string): FileCoverage[] {
  const files: FileCoverage[] = [];
  let file = "";
  let lines = new Map<number, number>();
  let begins = new Map<string, number>();
  let counts = new Map<string, number>();
  for (const line of text.split(/\r?\n/)) {
    const [key = "", ...rest] = line.split(":");
    const value = rest.join(":");
    const comma = value.indexOf(",");
    const [first, second] = [value.slice(0, comma), value.slice(comma + 1)];
    switch (key) {
      case "SF":
        file = value;
        break;
      case "DA":
        lines.set(Number(first), Number(second));
        break;
      case "FN":
        begins.set(second, Number(first));
        break;
      case "FNDA":
        counts.set(second, Number(first));
        break;
      case "end_of_record": {
        const functions = [...begins].map(([name, line]) => ({ name, line, count: counts.get(name) ?? 0 }));
        files.push({ file, lines, functions });
        [lines, begins, counts] = [new Map(), new Map(), new Map()];
        break;
      }
    }
  }
  return files;
}
