// What `arl2rs test` prints, as it was recorded.

import assert from "node:assert/strict";
import { test } from "node:test";
import { load, text } from "./support.mjs";

const { readReport } = await load("report");
const { casesAmong, foldersOf } = await load("cases");

test("failing cases", () => {
  const { failures, counts } = readReport(text("tests/recorded/test_failing.txt"));
  assert.deepEqual(counts, { passed: 4, failed: 7 });
  assert.equal(failures.length, 7);
  const of = (name) => failures.find((failure) => failure.file === `cases/${name}.arl`);
  assert.deepEqual(of("differs").difference, { expected: "one\nthree", actual: "one\ntwo" });
  assert.equal(of("differs").place, undefined);
  assert.equal(of("no_alarm").message, "it ended with an alarm\nalarm 20001: division by zero (no_alarm.arl:4)");
  assert.deepEqual(of("no_alarm").place, { file: "no_alarm.arl", line: 4, column: 1 });
  assert.match(of("other_line").message, /^expected alarm 10064 in line 2, found 20001 in line 4\n/);
  assert.equal(of("wrong_else").difference.expected, "1 string");
  assert.match(of("wrong_else").difference.actual, /^2 `a` must be of type int/);
  assert.deepEqual(of("wrong_out").place, { file: "wrong_out.arl", line: 2, column: 11 });
  assert.equal(of("sub/alone").message, "there is a alone.out, but no alone.arl");
  assert.match(of("sub/nothing").message, /^it has no expected results/);
});

test("passing cases, and no cases", () => {
  assert.deepEqual(readReport(text("tests/recorded/test_passing.txt")), {
    failures: [], counts: { passed: 1, failed: 0 },
  });
  assert.equal(readReport(text("tests/recorded/test_none.txt")).counts, undefined);
  assert.deepEqual(readReport("2 passed, 0 failed\r\n").counts, { passed: 2, failed: 0 });
});

test("a case that prints a count of its own ends no block", () => {
  const { failures, counts } = readReport(
    "FAILED a.arl\n  the output differs (- expected, + actual):\n" +
      "  -1 passed\n  +FAILED x.arl\n\n3 passed, 1 failed\n",
  );
  assert.deepEqual(failures[0].difference, { expected: "1 passed", actual: "FAILED x.arl" });
  assert.deepEqual([failures.length, counts.passed], [1, 3]);
});

test("which files are cases", () => {
  const files = ["w/a.arl", "w/a.out", "w/b.arl", "w/c.alarm", "w/d/e.arl", "w/d/e.err", "w/.x/f.arl", "w/.x/f.out"];
  assert.deepEqual(casesAmong(files), ["w/a.arl", "w/d/e.arl"]);
  assert.deepEqual(casesAmong(["w/a.arl", "w/a.out", "w/a.alarm"]), ["w/a.arl"]);
});

test("folders within others are not named twice", () => {
  assert.deepEqual(foldersOf(["/w/a/x.arl", "/w/a/b/y.arl", "/w/ab/z.arl", "/w/a/w.arl"]), ["/w/a", "/w/ab"]);
  assert.deepEqual(foldersOf([]), []);
});
