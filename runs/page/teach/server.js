// Requests to the server of the view about points and poses.

import { showProblem } from "../live.js";

/** The components of a pose, as ARL names them: mm along, deg about. */
export const COMPONENTS = ["x", "y", "z", "a", "b", "c"];
/** The world frame: x, y, z in mm, and a quaternion. */
export const ORIGIN = [0, 0, 0, 0, 0, 0, 1];

/**
 * @typedef {{points: import('../api.js').Points, save: import('../api.js').Points, undo: import('../api.js').Points, place: import('../api.js').TaughtPose, map: import('../api.js').Mapped}} Answers
 * @typedef {import('../api.js').Point} Point
 * @typedef {{tool: number[], wobj: number[], base: number[]}} Setting the frames of a pose
 * @typedef {Pick<Point, 'file' | 'type' | 'name' | 'values'> & {before: Point['values']}} Change
 */

/**
 * Sends a request to the server; shows the reason if it is refused.
 * @template {keyof Answers} What
 * @param {What} what @param {object} [order]
 * @returns {Promise<Answers[What] | undefined>}
 */
export async function ask(what, order) {
  const body = order === undefined ? {} : { method: "POST", body: JSON.stringify(order) };
  const answer = await fetch(`/api/teach/${what}`, body);
  if (answer.ok) return answer.json();
  showProblem(await answer.text());
  return undefined;
}

/** The key of a point or a frame: its file and its name. @param {{file: string, name: string}} of */
export function key({ file, name }) {
  return `${file}: ${name}`;
}

/** The components of a pose; missing ones are 0. @param {Point} pose */
export function componentsOf({ values }) {
  return COMPONENTS.map((name) => values[name] ?? 0);
}

/** Whether a point is a pose whose numbers are written in the data file. @param {Point} point */
export function isPlainPose({ type, plain, values }) {
  return type === "pose" && plain && values.x !== undefined;
}
