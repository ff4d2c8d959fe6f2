// The timeline: motions, events, signals and axes over time, with zooming, scrubbing and playback.

import { theme } from "./colors.js";
import { element } from "./dom.js";
import { kind } from "./colors.js";
import { marks, motions, signal, strip } from "./rows.js";

const GUTTER = 132;
const AXIS_HEIGHT = 24;
const FONT = "11px system-ui, sans-serif";
/** The shortest interval shown, in s. */
const SHORTEST_S = 0.02;

export class Tracks {
  /**
   * @param {HTMLElement} holder @param {import('./run.js').Run[]} runs @param {import('./run.js').Channel} channel the robot whose axes are shown
   * @param {(time: number) => void} seek
   */
  constructor(holder, runs, channel, seek) {
    this.holder = holder;
    this.runs = runs;
    this.canvas = /** @type {HTMLCanvasElement} */ (element("canvas"));
    this.tall = element("div", { className: "tall" });
    holder.replaceChildren(this.canvas, this.tall);
    this.context = /** @type {CanvasRenderingContext2D} */ (this.canvas.getContext("2d"));
    // What does not change as time advances: the rows, without the moment.
    this.still = /** @type {HTMLCanvasElement} */ (element("canvas"));
    this.stillContext = /** @type {CanvasRenderingContext2D} */ (this.still.getContext("2d"));
    this.channel = channel;
    this.seek = seek;
    this.from = 0;
    this.to = this.end;
    this.follows = true;
    this.time = 0;
    this.width = holder.clientWidth;
    this.height = holder.clientHeight;
    /** @type {import('./samples.js').Rows | undefined} */
    this.rows = undefined;
    /** Whether the rows must be redrawn, or only the moment. */
    this.stale = true;
    this.moved = true;
    /** @type {import('./rows.js').Row[]} */
    this.list = [];
    this.rebuild();
    new ResizeObserver(() => this.resize()).observe(holder);
    this.resize();
    this.listen();
  }

  get end() {
    return Math.max(...this.runs.map((run) => run.end), SHORTEST_S);
  }

  /** Shows another robot, or signals that are new. @param {import('./run.js').Channel} [channel] */
  rebuild(channel = this.channel) {
    if (channel !== this.channel) this.rows = undefined;
    this.channel = channel;
    const [run, other] = this.runs;
    const several = run.robots.length > 1;
    /** @type {import('./rows.js').Row[]} */
    const list = [];
    for (const one of run.robots) list.push(motions(run, one, several ? `robot ${one.number}` : "motions"));
    if (other) for (const one of other.robots) list.push(motions(other, one, "the other run"));
    list.push(marks(run));
    if (channel) {
      const rows = () => this.rows;
      /** @param {number} time */
      const moment = (time) => channel.samples.at(time, run.end);
      list.push(
        strip({
          label: "TCP speed",
          height: 44,
          color: kind(0),
          rows,
          get: (found, row) => found.speed[row],
          holds: false,
          gaps: true,
          value: (time) => `${(moment(time)?.speed ?? 0).toFixed(0)} mm/s`,
        }),
      );
    }
    for (const lane of run.sortedLanes) list.push(signal(run, lane));
    channel?.axes.forEach((axis, at) => {
      list.push(
        strip({
          label: axis.name,
          height: 40,
          color: kind(at + 1),
          range: [axis.min, axis.max],
          holds: true,
          rows: () => this.rows,
          get: (found, row) => found.axes[row * found.width + at],
          value: (time) => `${(channel.samples.at(time, run.end)?.axes[at] ?? 0).toFixed(2)} ${axis.unit}`,
        }),
      );
    });
    this.lanes = run.lanes.size;
    this.list = list;
    this.stale = true;
    this.tall.style.height = `${this.contentHeight}px`;
    this.fetch();
  }

  get contentHeight() {
    return this.list.reduce((sum, row) => sum + row.height, AXIS_HEIGHT) + 4;
  }

  resize() {
    const { clientWidth, clientHeight } = this.holder;
    const ratio = window.devicePixelRatio || 1;
    this.width = clientWidth;
    this.height = clientHeight;
    for (const canvas of [this.canvas, this.still]) Object.assign(canvas, { width: clientWidth * ratio, height: clientHeight * ratio });
    Object.assign(this.canvas.style, { width: `${clientWidth}px`, height: `${clientHeight}px` });
    // The canvas stays in place while the content below it scrolls.
    this.tall.style.marginTop = `${-clientHeight}px`;
    this.tall.style.height = `${this.contentHeight}px`;
    this.fetch();
    this.stale = true;
  }

  /** @param {number} time */
  x(time) {
    return GUTTER + ((time - this.from) / (this.to - this.from)) * (this.width - GUTTER - 6);
  }

  /** @param {number} x */
  timeAt(x) {
    return this.from + ((x - GUTTER) / (this.width - GUTTER - 6)) * (this.to - this.from);
  }

  /** Fetches the data of the strips after a short delay: a wheel turns quickly. */
  fetch() {
    clearTimeout(this.due);
    if (!this.channel) return;
    this.due = setTimeout(async () => {
      const margin = (this.to - this.from) * 0.1;
      const { channel } = this;
      try {
        const rows = await channel.samples.window(this.from - margin, this.to + margin, this.width * 2);
        // Another robot may have been chosen in the meantime.
        if (channel !== this.channel) return;
        this.rows = rows;
        this.stale = true;
      } catch {
        // A lost server is reported elsewhere.
      }
    }, 60);
  }

  /** @param {number} from @param {number} to */
  zoom(from, to) {
    const length = Math.min(Math.max(to - from, SHORTEST_S), this.end);
    this.from = Math.min(Math.max(from, 0), this.end - length);
    this.to = this.from + length;
    this.follows = length > this.end * 0.999;
    this.fetch();
    this.stale = true;
  }

  /** Shows the whole run. */
  fit() {
    this.zoom(0, this.end);
  }

  listen() {
    const { canvas, holder } = this;
    /** @param {PointerEvent} event */
    const scrub = (event) => this.seek(Math.min(Math.max(this.timeAt(event.offsetX), 0), this.end));
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      scrub(event);
    });
    canvas.addEventListener("pointermove", (event) => {
      if (event.buttons & 1) scrub(event);
    });
    canvas.addEventListener("dblclick", () => this.fit());
    holder.addEventListener("scroll", () => (this.stale = true));
    canvas.addEventListener(
      "wheel",
      (event) => {
        const length = this.to - this.from;
        if (event.shiftKey || Math.abs(event.deltaX) > Math.abs(event.deltaY)) {
          const by = ((event.deltaX || event.deltaY) / this.width) * length;
          this.zoom(this.from + by, this.to + by);
        } else if (event.ctrlKey || event.metaKey || event.offsetY < AXIS_HEIGHT || this.contentHeight <= this.height) {
          const factor = Math.exp(event.deltaY * 0.0015);
          const at = this.timeAt(event.offsetX);
          this.zoom(at - (at - this.from) * factor, at + (this.to - at) * factor);
        } else {
          // The rows scroll.
          return;
        }
        event.preventDefault();
      },
      { passive: false },
    );
  }

  /** Shows a moment. @param {number} time */
  show(time) {
    if (this.follows && Math.abs(this.to - this.end) > 1e-6) {
      [this.from, this.to] = [0, this.end];
      this.stale = true;
      if (!this.fetched || performance.now() - this.fetched > 400) {
        this.fetched = performance.now();
        this.fetch();
      }
    }
    if (this.runs[0].lanes.size !== this.lanes) this.rebuild();
    // When playback leaves the visible interval, the interval follows.
    if (time !== this.time && (time > this.to || time < this.from)) {
      const length = this.to - this.from;
      this.zoom(time - length * 0.1, time + length * 0.9);
    }
    this.time = time;
    this.moved = true;
  }

  draw() {
    // A canvas without a size cannot be drawn.
    if ((!this.stale && !this.moved) || !this.still.width || !this.still.height) return;
    if (this.stale) this.drawStill();
    this.stale = this.moved = false;
    const { context, height } = this;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.drawImage(this.still, 0, 0);
    const ratio = window.devicePixelRatio || 1;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.font = FONT;
    context.textBaseline = "middle";
    context.textAlign = "right";
    context.fillStyle = theme("text");
    for (const { row, top } of this.shown()) {
      const value = row.value?.(this.time);
      const y = top + Math.min(row.height / 2, 12);
      if (value && y > AXIS_HEIGHT + 5) context.fillText(value, GUTTER - 6, y, 56 + (row.height > 30 ? 10 : 0));
    }
    context.textAlign = "left";
    const here = this.x(this.time);
    if (here >= GUTTER) context.fillRect(here - 0.5, 0, 1, height);
  }

  /** The visible rows and their positions. */
  *shown() {
    let top = AXIS_HEIGHT - this.holder.scrollTop;
    for (const row of this.list) {
      if (top + row.height > AXIS_HEIGHT && top < this.height) yield { row, top };
      top += row.height;
    }
  }

  drawStill() {
    const { stillContext: context, width, height } = this;
    const ratio = window.devicePixelRatio || 1;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.fillStyle = theme("sunk");
    context.fillRect(0, 0, width, height);
    context.font = FONT;
    for (const { row, top } of this.shown()) this.drawRow(row, top);
    this.drawTimes();
  }

  /** @param {import('./rows.js').Row} row @param {number} top */
  drawRow(row, top) {
    const { stillContext: context, width } = this;
    context.save();
    context.beginPath();
    context.rect(GUTTER, Math.max(top, AXIS_HEIGHT), width - GUTTER, row.height);
    context.clip();
    row.draw({ context, x: (time) => this.x(time), from: this.from, to: this.to, left: GUTTER, right: width, top, height: row.height });
    context.restore();
    context.save();
    context.beginPath();
    context.rect(0, Math.max(top, AXIS_HEIGHT), width, row.height);
    context.clip();
    context.fillStyle = theme("line");
    context.fillRect(0, top + row.height - 0.5, width, 0.5);
    context.textBaseline = "middle";
    context.fillStyle = theme("quiet");
    context.fillText(row.label, 8, top + Math.min(row.height / 2, 12), GUTTER - 62);
    context.restore();
  }

  /** The time scale above: ticks at round numbers. */
  drawTimes() {
    const { stillContext: context, width } = this;
    context.fillStyle = theme("back");
    context.fillRect(0, 0, width, AXIS_HEIGHT);
    const wished = ((this.to - this.from) / Math.max(width - GUTTER, 1)) * 80;
    const power = 10 ** Math.floor(Math.log10(wished));
    const step = power * /** @type {number} */ ([1, 2, 5, 10].find((factor) => factor * power >= wished));
    const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    context.textBaseline = "middle";
    for (let time = Math.ceil(this.from / step) * step; time <= this.to + 1e-9; time += step) {
      const x = this.x(time);
      context.fillStyle = theme("line");
      context.fillRect(x, AXIS_HEIGHT - 6, 1, 6);
      context.fillStyle = theme("quiet");
      context.fillText(`${time.toFixed(digits)} s`, x + 3, AXIS_HEIGHT / 2);
    }
  }
}
