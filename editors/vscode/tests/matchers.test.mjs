// The problem matchers of package.json on recorded outputs.

import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { test } from "node:test";
import { command, json, path, skip, text } from "./support.mjs";

const { problemMatchers } = json("package.json").contributes;

/** What a matcher finds in a text; its patterns match lines that follow each other. */
function found(name, output) {
  const { pattern } = problemMatchers.find((matcher) => matcher.name === name);
  const patterns = [pattern].flat();
  const lines = output.split("\n");
  return lines.flatMap((_, at) => {
    const problem = {};
    for (const [step, { regexp, ...parts }] of patterns.entries()) {
      const match = new RegExp(regexp).exec(lines[at + step] ?? "");
      if (match === null) {
        return [];
      }
      Object.entries(parts).forEach(([part, group]) => (problem[part] = match[group]));
    }
    return [problem];
  });
}

test("errors of a check", () => {
  const problems = found("arl2rs", text("tests/recorded/check.txt"));
  const short = problems.map((found) => `${found.severity} ${found.code} ${found.file} ${found.line} ${found.column}`);
  assert.deepEqual(short, [
    "error ARL0601 pick.arl 1 8",
    "error ARL0201 pick.arl 5 7",
    "error ARL0301 pick.arl 5 14",
    "error ARL0127 pick.arl 7 9",
    "error ARL0503 pick.arl 11 11",
  ]);
  assert.equal(problems[1].message, "there is no variable `p1` here");
});

test("warnings, line ends of Windows and paths with blanks and drives", () => {
  const recorded = text("tests/recorded/check_warning.txt");
  const problem = { severity: "warning", code: "ARL0902", message: "the variable `b` is never read" };
  assert.deepEqual(found("arl2rs", recorded), [{ ...problem, file: "p2.arl", line: "2", column: "7" }]);
  const windows = recorded.replace("p2.arl:", "C:\\my cell\\p2.arl:").replaceAll("\n", "\r\n");
  assert.deepEqual(found("arl2rs", windows), [{ ...problem, file: "C:\\my cell\\p2.arl", line: "2", column: "7" }]);
});

test("the command still prints what was recorded", { skip }, () => {
  const { stderr } = spawnSync(command, ["check", path("tests/grammar/numbers_and_units.arl")], { encoding: "utf8" });
  const problems = found("arl2rs", stderr);
  assert.ok(problems.length > 0);
  assert.equal(problems.length, stderr.match(/^(?:error|warning)\[/gm).length);
  assert.equal(problems[0].file, path("tests/grammar/numbers_and_units.arl"));
});

test("alarms of a run", () => {
  const recorded = text("tests/recorded/alarm.txt");
  const problem = { message: "alarm 20001: division by zero", code: "20001" };
  assert.deepEqual(found("arl2rs-alarm", recorded), [
    { ...problem, file: "lib/rack.arl", line: "2" },
    { ...problem, file: "w.arl", line: "4" },
  ]);
  assert.equal(found("arl2rs", recorded).length, 1);
  const [other] = found("arl2rs-alarm", "alarm 10064: no file (of that name) here (file.arl:12)\r");
  assert.deepEqual(other, {
    message: "alarm 10064: no file (of that name) here", code: "10064", file: "file.arl", line: "12",
  });
});
