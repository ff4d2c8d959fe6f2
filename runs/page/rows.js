// The rows of the timeline: each draws itself into its strip.

import { rowAt } from "./samples.js";
import { kind, theme } from "./colors.js";

/**
 * What a row needs for drawing: the canvas, the place of its strip, and the positions of times on it.
 * @typedef {{context: CanvasRenderingContext2D, x: (time: number) => number, from: number, to: number, left: number, right: number, top: number, height: number}} Strip
 * @typedef {{label: string, height: number, value?: (time: number) => string, draw: (strip: Strip) => void}} Row
 */

/** The colour of a program line, by its number: the same in all rows. @param {number} line */
export function lineColor(line) {
  return kind((line * 5) % 8);
}

/** Which motions robots execute when. @param {import('./run.js').Run} run @param {import('./run.js').Channel} channel @param {string} label @returns {Row} */
export function motions(run, channel, label) {
  const starts = () => run.starts?.get(channel.number) ?? [];
  return {
    label,
    height: 26,
    value: (time) => {
      const motion = run.motionAt(channel.number, time);
      return motion && time < motion.start + motion.duration ? `${motion.kind} ${motion.line}` : run.stateAt(channel.number, time);
    },
    draw({ context, x, from, to, top, height }) {
      const all = run.motions?.get(channel.number) ?? [];
      let drawn = -1;
      context.textBaseline = "middle";
      for (let at = Math.max(rowAt(starts(), from), 0); at < all.length && all[at].start <= to; at++) {
        const motion = all[at];
        const [begin, end] = [x(motion.start), x(motion.start + motion.duration)];
        // What is narrower than a fraction of a pixel is not visible.
        if (end < drawn + 0.5) continue;
        drawn = end;
        context.fillStyle = lineColor(motion.line);
        context.fillRect(begin, top + 3, Math.max(end - begin - 0.5, 0.5), height - 6);
        if (end - begin > 26) {
          context.fillStyle = "#10131699";
          context.fillText(String(motion.line), begin + 4, top + height / 2 + 1);
        }
      }
      const states = run.track(channel.number).states;
      for (const [at, [time, state]] of states.entries()) {
        if (!["paused", "alarm", "stopped"].includes(state)) continue;
        const end = states[at + 1]?.[0] ?? run.end;
        context.fillStyle = theme(state === "alarm" ? "alarm" : "warning");
        context.globalAlpha = 0.35;
        context.fillRect(x(time), top + 1, Math.max(x(end) - x(time), 1.5), height - 2);
        context.globalAlpha = 1;
      }
    },
  };
}

/** Messages, warnings, alarms and contacts. @param {import('./run.js').Run} run @returns {Row} */
export function marks(run) {
  return {
    label: "events",
    height: 20,
    draw({ context, x, from, to, top, height }) {
      const middle = top + height / 2;
      for (const { time, level } of run.answer.log) {
        if (time < from || time > to) continue;
        context.fillStyle = theme(level === "message" ? "quiet" : level);
        const size = level === "message" ? 1.5 : 4;
        context.beginPath();
        context.arc(x(time), middle, size, 0, 7);
        context.fill();
      }
      for (const { time } of run.answer.contacts) {
        if (time < from || time > to) continue;
        context.fillStyle = theme("alarm");
        context.beginPath();
        context.moveTo(x(time), middle - 7);
        context.lineTo(x(time) + 6, middle + 5);
        context.lineTo(x(time) - 6, middle + 5);
        context.fill();
      }
    },
  };
}

/** An input or output. @param {import('./run.js').Run} run @param {import('./run.js').Lane} lane @returns {Row} */
export function signal(run, lane) {
  const digital = lane.signal.startsWith("d");
  const color = lane.signal.includes("i.") ? "high" : "accent";
  return {
    label: lane.label === lane.signal ? lane.signal : `${lane.label} ${lane.signal}`,
    height: digital ? 17 : 30,
    value: (time) => {
      const level = run.levelAt(lane, time);
      return digital ? (level ? "on" : "off") : level.toFixed(3);
    },
    draw({ context, x, from, to, top, height }) {
      const [most, least] = [Math.max(0, ...lane.values.slice(0, 5000)), Math.min(0, ...lane.values.slice(0, 5000))];
      /** @param {number} value */
      const y = (value) => top + height - 3 - ((value - least) / (most - least || 1)) * (height - 6);
      context.strokeStyle = context.fillStyle = theme(color);
      context.lineWidth = 1.2;
      context.beginPath();
      const first = rowAt(lane.times, from);
      let level = first < 0 ? 0 : lane.values[first];
      context.moveTo(x(from), y(level));
      let drawn = -1;
      for (let at = first + 1; at < lane.times.length && lane.times[at] <= to; at++) {
        const here = x(lane.times[at]);
        if (digital && level) {
          context.globalAlpha = 0.35;
          context.fillRect(
            x(Math.max(lane.times[at - 1] ?? from, from)),
            y(1),
            Math.max(here - x(Math.max(lane.times[at - 1] ?? from, from)), 0.5),
            y(0) - y(1),
          );
          context.globalAlpha = 1;
        }
        const before = level;
        level = lane.values[at];
        // Many changes within a pixel become one line from top to bottom.
        if (here - drawn < 0.4) continue;
        drawn = here;
        context.lineTo(here, y(before));
        context.lineTo(here, y(level));
      }
      const end = x(Math.min(to, run.end));
      if (digital && level) {
        const begin = x(Math.max(lane.times[rowAt(lane.times, to)] ?? from, from));
        context.globalAlpha = 0.35;
        context.fillRect(begin, y(1), Math.max(end - begin, 0.5), y(0) - y(1));
        context.globalAlpha = 1;
      }
      context.lineTo(end, y(level));
      context.stroke();
    },
  };
}

/**
 * A value over time, from rows fetched for the visible interval.
 * @param {{label: string, height: number, color: string, range?: number[], rows: () => import('./samples.js').Rows | undefined, get: (rows: import('./samples.js').Rows, row: number) => number, value: (time: number) => string, holds: boolean, gaps?: boolean}} of
 * @returns {Row}
 */
export function strip({ label, height, color, range, rows, get, value, holds, gaps }) {
  return {
    label,
    height,
    value,
    draw({ context, x, from, to, top, height, left, right }) {
      const found = rows();
      if (!found || found.count === 0) return;
      let [least, most] = range ?? [0, 0];
      if (!range) for (let row = 0; row < found.count; row++) most = Math.max(most, get(found, row));
      if (most <= least) most = least + 1;
      /** @param {number} value */
      const y = (value) => top + height - 3 - ((value - least) / (most - least)) * (height - 6);
      if (range) {
        context.strokeStyle = theme("line");
        context.setLineDash([3, 3]);
        context.beginPath();
        for (const limit of range) {
          context.moveTo(left, y(limit));
          context.lineTo(right, y(limit));
        }
        context.stroke();
        context.setLineDash([]);
      }
      context.strokeStyle = color;
      context.lineWidth = 1.3;
      context.beginPath();
      for (let row = Math.max(rowAt(found.times, from), 0); row < found.count; row++) {
        const time = found.times[row];
        // No motion led here: the line has a gap.
        if (gaps && found.jumps[row]) context.moveTo(x(time), y(get(found, row)));
        else if (holds && row > 0 && time - found.times[row - 1] > 0.06)
          context.lineTo(x(time - 0.004), y(get(found, row - 1)));
        else if (!holds && row > 0 && time - found.times[row - 1] > 0.06) {
          context.lineTo(x(found.times[row - 1]), y(0));
          context.lineTo(x(time - 0.004), y(0));
        }
        context.lineTo(x(time), y(get(found, row)));
        if (time > to) break;
      }
      context.stroke();
    },
  };
}
