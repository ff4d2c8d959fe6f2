// Reads what `arl2rs test` prints.

/** A case that did not pass. */
export interface Failure {
  /** The path as printed. */
  readonly file: string;
  readonly message: string;
  /** The expected and the actual text, if outputs or errors differ. */
  readonly difference?: { readonly expected: string; readonly actual: string };
  /** The place that the message points to; lines and columns from 1. */
  readonly place?: { readonly file: string; readonly line: number; readonly column: number };
}

export interface Report {
  readonly failures: readonly Failure[];
  /** The counts of the last line. Without them, the command gave up early. */
  readonly counts: { readonly passed: number; readonly failed: number } | undefined;
}

const HEAD = /^FAILED (.+)$/;
const COUNTS = /^(\d+) passed(?:, (\d+) failed)?$/;
const ALARM = /^alarm \d+: .* \(([^()]+):(\d+)\)$/m;
const ARROW = /^ *--> (.+?):(\d+):(\d+)$/m;
const DIFFERENCE = /^the (?:output differs|errors differ) \(- expected, \+ actual\):$/;

/** The report in a text. */
export function readReport(text: string): Report {
  const failures: Failure[] = [];
  let counts: Report["counts"];
  let block: { file: string; lines: string[] } | undefined;
  const close = (): void => {
    if (block !== undefined) {
      failures.push(failure(block.file, block.lines));
      block = undefined;
    }
  };
  for (const line of text.split(/\r?\n/)) {
    const head = HEAD.exec(line);
    const last = COUNTS.exec(line);
    if (head?.[1] !== undefined) {
      close();
      block = { file: head[1], lines: [] };
    } else if (last !== null) {
      close();
      counts = { passed: Number(last[1]), failed: Number(last[2] ?? 0) };
    } else {
      block?.lines.push(line.startsWith("  ") ? line.slice(2) : line);
    }
  }
  close();
  return { failures, counts };
}

function failure(file: string, lines: readonly string[]): Failure {
  const message = lines.join("\n").trimEnd();
  const difference = differenceIn(lines);
  const place = placeIn(message);
  return { file, message, ...(difference && { difference }), ...(place && { place }) };
}

function differenceIn(lines: readonly string[]): Failure["difference"] {
  const start = lines.findIndex((line) => DIFFERENCE.test(line));
  if (start < 0) {
    return undefined;
  }
  const rest = lines.slice(start + 1);
  const end = rest.findIndex((line) => !/^[-+ ]/.test(line));
  const compared = end < 0 ? rest : rest.slice(0, end);
  const side = (mark: string): string =>
    compared.filter((line) => line.startsWith(mark) || line.startsWith(" ")).map((line) => line.slice(1)).join("\n");
  return { expected: side("-"), actual: side("+") };
}

function placeIn(message: string): Failure["place"] {
  const arrow = ARROW.exec(message);
  if (arrow?.[1] !== undefined) {
    return { file: arrow[1], line: Number(arrow[2]), column: Number(arrow[3]) };
  }
  const alarm = ALARM.exec(message);
  return alarm?.[1] === undefined ? undefined : { file: alarm[1], line: Number(alarm[2]), column: 1 };
}
