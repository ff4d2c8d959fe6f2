// The path of the TCP, coloured by a chosen quantity.

import { LineMaterial, LineSegments2, LineSegmentsGeometry } from "./three.js";
import { kind, light, parts, scale, theme } from "./colors.js";

/** The meanings of the colour, by name, in the order of the keys 1 to 4. */
export const COLORS = {
  speed: "speed",
  limit: "closest limit",
  blend: "blend",
  line: "line",
};

/** The limit that a motion comes closest to, and how much of it is used. @param {import('./run.js').Motion | undefined} motion */
export function closest(motion) {
  const limits = { speed: motion?.vel, acceleration: motion?.acc, jerk: motion?.jerk };
  const known = Object.entries(limits).flatMap(([of, limit]) => (limit ? [{ of, axis: limit[0], percent: limit[1] }] : []));
  return known.sort((one, other) => other.percent - one.percent)[0];
}

/** How a motion ends. @param {import('./run.js').Motion | undefined} motion */
export function ending(motion) {
  if (!motion?.blend) return "stops at the target";
  const { asked, used } = motion.blend;
  if (used <= 0) return "zone asked for, stops";
  return used < asked * 0.999 ? "smaller zone than asked for" : "zone as asked for";
}

const ENDINGS = ["stops at the target", "zone as asked for", "smaller zone than asked for", "zone asked for, stops"];

/** The colours of a path and their meaning. */
export class Paint {
  /** @param {string} mode @param {import('./run.js').Run} run @param {import('./run.js').Channel} channel @param {number} fastest in mm/s */
  constructor(mode, run, channel, fastest) {
    this.mode = mode;
    this.fastest = fastest;
    this.quiet = parts(theme("quiet").padEnd(7, "0"));
    /** @type {Map<string, number[]>} */
    this.known = new Map();
    this.of = (/** @type {number} */ motion) => run.byNumber?.get(`${channel.number}/${motion}`);
  }

  /** @param {number} speed @param {number} motion @param {number} line */
  color(speed, motion, line) {
    if (this.mode === "speed") return scale(this.fastest > 0 ? speed / this.fastest : 0);
    if (this.mode === "line") return this.kind(`line ${line}`);
    const found = this.of(motion);
    // The report of a motion is known once the run has ended.
    if (!found) return this.quiet;
    if (this.mode === "blend") return this.kind(ending(found), ENDINGS);
    return this.kind(closest(found)?.axis ?? "none");
  }

  /** @param {string} name @param {string[]} [fixed] */
  kind(name, fixed) {
    const color = this.known.get(name) ?? parts(kind(fixed ? fixed.indexOf(name) : this.known.size));
    this.known.set(name, color);
    return color;
  }
}

/**
 * The path through rows.
 * @param {import('./samples.js').Rows} rows
 * @param {Paint} paint
 * @param {{opacity: number}} look
 */
export function path(rows, paint, look) {
  const positions = [];
  const colors = [];
  for (let row = 1; row < rows.count; row++) {
    const [from, to] = [(row - 1) * 7, row * 7];
    const distance = Math.hypot(rows.tcp[to] - rows.tcp[from], rows.tcp[to + 1] - rows.tcp[from + 1], rows.tcp[to + 2] - rows.tcp[from + 2]);
    if (distance < 1e-3 || rows.jumps[row]) continue;
    const [, line, motion] = rows.pointers.subarray(row * 4);
    const color = light(paint.color(rows.speed[row], motion, line));
    for (const at of [from, to]) {
      for (let axis = 0; axis < 3; axis++) positions.push(rows.tcp[at + axis] / 1000);
      colors.push(...color);
    }
  }
  if (positions.length === 0) return undefined;
  const geometry = new LineSegmentsGeometry();
  geometry.setPositions(positions);
  geometry.setColors(colors);
  const material = new LineMaterial({ vertexColors: true, linewidth: 2.5, transparent: look.opacity < 1, opacity: look.opacity });
  return new LineSegments2(geometry, material);
}
