// Changes of points to be written into the data file.

import { COMPONENTS, ORIGIN, ask, componentsOf } from "./server.js";

/** @typedef {import('./server.js').Point} Point */
/** @typedef {import('./server.js').Change} Change */

/**
 * A pose with other components.
 * @param {Point} point @param {number[]} components @param {Record<string, number>} [more] other fields, such as `cfg`
 * @returns {Change}
 */
export function moved({ file, type, name, values }, components, more = {}) {
  const now = { ...values, ...Object.fromEntries(COMPONENTS.map((name, at) => [name, components[at]])), ...more };
  // The turns that are meant belong to the old axes.
  delete now.turn;
  return { file, type, name, values: now, before: values };
}

/** A pose, shifted. @param {Point} point @param {number[]} by mm along x, y and z */
export function shifted(point, by) {
  const components = componentsOf(point).map((value, at) => value + (by[at] ?? 0));
  return moved(point, components);
}

/**
 * A pose, mirrored at a plane through the origin of the workpiece. The tool's own axis with the name of the normal is reversed as well,
 * so that the result is an orientation, and the tool points as in the mirror image.
 * @param {Point} point @param {number} axis 0 for x, 1 for y, 2 for z
 * @param {number} channel @param {number[]} near the axes that the pose should be close to, in deg (mm)
 * @returns {Promise<Change | undefined>} undefined if the server refuses
 */
export async function mirrored(point, axis, channel, near) {
  const setting = { tool: ORIGIN, wobj: ORIGIN, base: ORIGIN };
  const components = componentsOf(point);
  const place = await ask("place", { channel, components, setting, near });
  if (!place) return undefined;
  const placed = [...place.placed];
  placed[axis] = -placed[axis];
  for (const other of [0, 1, 2]) if (other !== axis) placed[3 + other] = -placed[3 + other];
  const image = await ask("place", { channel, placed, setting, near, before: components });
  return image && moved(point, image.components);
}
