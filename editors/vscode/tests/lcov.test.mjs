import assert from "node:assert/strict";
import { test } from "node:test";
import { load } from "./support.mjs";

const { readLcov } = await load("lcov");

test("lines and functions are read, file by file", () => {
  const text =
    "TN:\nSF:C:/cell/a.arl\nFN:1,half\nFN:7,main\nFNDA:3,half\nFNDA:0,main\nFNF:2\nFNH:1\n" +
    "DA:2,3\nDA:3,0\nLF:2\nLH:1\nend_of_record\nTN:\nSF:b.arl\nDA:1,12\nend_of_record\n";
  const [first, second] = readLcov(text);
  assert.equal(first.file, "C:/cell/a.arl");
  assert.deepEqual([...first.lines], [[2, 3], [3, 0]]);
  assert.deepEqual(first.functions, [
    { name: "half", line: 1, count: 3 },
    { name: "main", line: 7, count: 0 },
  ]);
  assert.deepEqual([second.file, [...second.lines], second.functions], ["b.arl", [[1, 12]], []]);
  assert.deepEqual(readLcov(""), []);
});
