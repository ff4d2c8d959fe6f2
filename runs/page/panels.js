// Panels of text and numbers beside the cell: lines, events, this moment, two runs side by side.

import { element, seconds, write } from "./dom.js";
import { closest, ending } from "./path.js";

/** @param {string[]} titles @param {HTMLElement[]} rows */
function table(titles, rows) {
  const head = element("thead", {}, element("tr", {}, ...titles.map((title) => element("th", {}, title))));
  return element("table", { className: "list" }, head, element("tbody", {}, ...rows));
}

/** @param {(string | [string, string])[]} cells @param {() => void} [chosen] */
function row(cells, chosen) {
  const made = element(
    "tr",
    {},
    ...cells.map((cell) => (typeof cell === "string" ? element("td", {}, cell) : element("td", { className: cell[1] }, cell[0]))),
  );
  if (chosen) made.addEventListener("click", chosen);
  return made;
}

/** @param {number} number @param {number} [digits] */
function short(number, digits = 1) {
  return Number(number.toFixed(digits)).toString();
}

/** The times of each line's motions. @param {import('./run.js').Run} run @param {number} channel @param {(file: string, line: number) => void} chosen */
export function lines(run, channel, chosen) {
  const { files, lines } = run.track(channel);
  const rows = lines
    .filter((one) => one.line > 0)
    .sort((one, other) => other.moving + other.standing - one.moving - one.standing)
    .map(({ file, line, moving, standing }) => {
      const own = run.motionsOf(channel, files[file] ?? "", line);
      const kinds = [...new Set(own.map((motion) => motion.kind))].join(", ");
      const limits = own.map(closest).filter(Boolean);
      const limit = limits.sort((one, other) => (other?.percent ?? 0) - (one?.percent ?? 0))[0];
      const name = files.length > 1 ? `${files[file]}:${line}` : String(line);
      const limited = limit ? `${limit.axis} ${limit.of} ${limit.percent.toFixed(0)} %` : "";
      return row([name, kinds, seconds(moving), seconds(standing), own.length ? String(own.length) : "", limited], () =>
        chosen(files[file], line),
      );
    });
  if (rows.length === 0) return element("p", { className: "hint" }, "Nothing has run yet.");
  return table(["line", "motion", "moving s", "standing s", "runs", "closest limit"], rows);
}

/** Messages, warnings, alarms and contacts. @param {import('./run.js').Run} run @param {(time: number) => void} seek */
export function events(run, seek) {
  const rows = [...run.answer.log]
    .sort((one, other) => one.time - other.time)
    .slice(-5000)
    .map(({ time, level, text }) => row([seconds(time), [text, `text ${level}`]], () => seek(time)));
  if (rows.length === 0) return element("p", { className: "hint" }, "The program has printed nothing, and nothing went wrong.");
  return table(["s", ""], rows);
}

/** What differs between two runs. @param {import('./api.js').Differences} answer what the server reports about both @param {(file: string, line: number) => void} chosen */
export function differences(answer, chosen) {
  /** @param {number | null} one @param {number | null} other @returns {[string, string]} */
  const change = (one, other) => {
    const by = (other ?? 0) - (one ?? 0);
    return [Math.abs(by) < 5e-4 ? "" : `${by > 0 ? "+" : ""}${by.toFixed(3)}`, Math.abs(by) < 5e-4 ? "" : by > 0 ? "worse" : "better"];
  };
  const cell = (/** @type {number | null} */ value) => (value === null ? "" : seconds(value));
  const rows = answer.lines.map(({ file, line, one, other }) =>
    row([`${file}:${line}`, cell(one), cell(other), change(one, other)], () => chosen(file, line)),
  );
  const hints = answer.said.map((/** @type {string} */ text) => element("p", { className: "hint" }, text));
  if (rows.length === 0 && hints.length === 0) return element("p", { className: "hint" }, "Nothing differs between the two runs.");
  return element("div", {}, ...hints, table(["line", "this run s", "the other s", "by s"], rows));
}

/** The displayed moment. */
export class Now {
  /** @param {HTMLElement} holder */
  constructor(holder) {
    this.holder = holder;
    /** @type {import('./run.js').Channel | undefined} */
    this.channel = undefined;
    /** @type {{axis: import('./api.js').PageAxis, value: HTMLElement, bar: HTMLMeterElement, row: HTMLElement}[]} */
    this.axes = [];
  }

  /** @param {import('./run.js').Channel} channel */
  build(channel) {
    this.channel = channel;
    this.title = element("h2");
    this.motion = element("p");
    this.axes = channel.axes.map((axis) => {
      const value = element("td", { className: "number" });
      const bar = /** @type {HTMLMeterElement} */ (
        element("meter", { min: axis.min, max: axis.max, title: `${axis.min} to ${axis.max} ${axis.unit}` })
      );
      return { axis, value, bar, row: element("tr", {}, element("td", {}, axis.name), value, element("td", {}, bar)) };
    });
    this.tcp = element("p");
    this.holder.replaceChildren(
      this.title,
      this.motion,
      element("table", {}, ...this.axes.map((axis) => axis.row)),
      this.tcp,
    );
  }

  /** @param {import('./run.js').Run} run @param {import('./run.js').Channel} channel @param {number} time */
  show(run, channel, time) {
    if (!channel) return;
    if (this.channel !== channel) this.build(channel);
    const moment = channel.samples.at(Math.min(time, run.end), run.end);
    if (!moment) return;
    for (const [at, { axis, value, bar }] of this.axes.entries()) {
      const is = moment.axes[at] ?? 0;
      write(value, `${is.toFixed(2)} ${axis.unit}`);
      bar.value = is;
    }
    const [x, y, z] = moment.tcp;
    write(
      /** @type {HTMLElement} */ (this.tcp),
      `TCP ${x.toFixed(1)}  ${y.toFixed(1)}  ${z.toFixed(1)} mm, ${moment.speed.toFixed(0)} mm/s`,
    );
    const state = run.stateAt(channel.number, time);
    const mode = [...run.answer.controller].reverse().find((one) => one.time <= time + 1e-9);
    write(
      /** @type {HTMLElement} */ (this.title),
      `${channel.robot} · ${state}${mode ? ` · ${mode.mode}, override ${mode.override} %` : ""}`,
    );
    write(
      /** @type {HTMLElement} */ (this.motion),
      moment.motion ? inWords(run.byNumber?.get(`${channel.number}/${moment.motion}`), moment.motionLine) : "The robot stands still.",
    );
  }
}

/** A motion in words. @param {import('./run.js').Motion | undefined} motion @param {number} line */
function inWords(motion, line) {
  if (!motion) return `Motion of line ${line}.`;
  const { kind, start, duration, way, programmed, reached, unit, blend } = motion;
  const limit = closest(motion);
  const parts = [
    `${kind} in line ${line}: ${seconds(duration)} s from ${seconds(start)} s, ${short(way)} mm`,
    `${short(reached)} of ${short(programmed)} ${unit}`,
    limit ? `${limit.of} of ${limit.axis} at ${limit.percent.toFixed(0)} %` : "",
    blend ? `zone ${short(blend.used)} of ${short(blend.asked)} ${blend.unit}${blend.why ? ` (${blend.why})` : ""}` : ending(motion),
  ];
  return `${parts.filter(Boolean).join(" · ")}.`;
}
