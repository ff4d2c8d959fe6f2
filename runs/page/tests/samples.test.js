// What the server sends of a run, read without a browser.

import assert from "node:assert/strict";
import { test } from "node:test";
import { decode, momentAt } from "../samples.js";

/**
 * Rows of one axis, 4 ms apart, as the server sends them.
 * @param {number[]} xs where the TCP is @param {number[]} [jumps]
 */
function rows(xs, jumps = []) {
  const count = xs.length;
  const parts = [
    new Uint32Array([count, 1]),
    new Float64Array(xs.map((_, at) => at * 0.004)),
    new Float32Array(xs),
    new Float32Array(xs.flatMap((x) => [x, 0, 0, 0, 0, 0, 1])),
    new Float32Array(count).fill(100),
    new Uint32Array(count * 4).fill(1),
    new Uint8Array(xs.map((_, at) => Number(jumps.includes(at)))),
  ];
  const bytes = parts.flatMap((part) => [...new Uint8Array(part.buffer)]);
  return decode(new Uint8Array(bytes).buffer);
}

test("another tool is there at once", () => {
  const found = rows([0, 1, 46, 47], [2]);
  assert.deepEqual([...found.jumps], [0, 0, 1, 0]);
  const x = (/** @type {number} */ time) => momentAt(found, time)?.tcp[0];
  assert.equal(x(0.002), 0.5);
  assert.equal(x(0.006), 1, "it stays until then");
  assert.equal(x(0.008), 46);
});
