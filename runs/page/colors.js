// Colours of the page and of paths.

/** Colours that are easy to distinguish, even with a colour vision deficiency. */
const KINDS = ["#f0913a", "#4da3e0", "#5cc98b", "#c77dd8", "#f5c542", "#ff6f91", "#58c9c3", "#a3a86b"];

/**
 * One of a few colours, chosen by a number.
 * @param {number} number
 */
export function kind(number) {
  return KINDS[number % KINDS.length];
}

/**
 * A colour of the page: `alarm`.
 * @param {string} name
 */
export function theme(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

/** Stops of a colour scale from slow to fast, which is also readable in grey. */
const SCALE = [
  [0.23, 0.3, 0.75],
  [0.13, 0.57, 0.55],
  [0.48, 0.82, 0.32],
  [0.99, 0.91, 0.14],
];

/**
 * A colour of the scale for a fraction, as three fractions of 1.
 * @param {number} part
 * @returns {number[]}
 */
export function scale(part) {
  const at = Math.min(Math.max(part, 0), 1) * (SCALE.length - 1);
  const low = Math.min(Math.floor(at), SCALE.length - 2);
  return SCALE[low].map((value, channel) => value + (SCALE[low + 1][channel] - value) * (at - low));
}

/** The scale as a CSS gradient. */
export const gradient = `linear-gradient(to right, ${SCALE.map((stop) => `rgb(${stop.map((value) => value * 255).join(" ")})`).join(", ")})`;

/**
 * The components of `#rrggbb` as three fractions of 1.
 * @param {string} hex
 * @returns {number[]}
 */
export function parts(hex) {
  return [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16) / 255);
}

/**
 * Converts the components of an sRGB colour to linear light, in which surfaces and lines are drawn.
 * @param {number[]} color
 */
export function light(color) {
  return color.map((part) => (part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4));
}
