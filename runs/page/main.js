// The page of `arl2rs view`: one moment of a run, shown everywhere at once.

import { byId, dialog, element, seconds, write } from "./dom.js";
import { BEHIND_S, Live } from "./live.js";
import { Now, differences, events, lines } from "./panels.js";
import { COLORS } from "./path.js";
import { Run } from "./run.js";
import { CellScene } from "./scene.js";
import { Source } from "./source.js";
import { Teach } from "./teach.js";
import { Tracks } from "./tracks.js";

const RATES = [0.05, 0.1, 0.25, 0.5, 1, 2, 5, 10, 50];
const NORMAL = RATES.indexOf(1);
const KEYS = [
  ["Space", "play or pause"],
  ["← →", "a step back or forward"],
  ["Shift ← →", "a second"],
  ["↑ ↓", "the previous or next motion"],
  ["Home End", "beginning, end"],
  ["[ ]", "slower, faster"],
  ["1 2 3 4", "colour of the path: speed, limit, blend, line"],
  ["F", "show all of the cell"],
  ["0", "show all of the time line"],
  ["L", "copy a link to this moment"],
  ["D", "dark or light"],
  ["Wheel", "on the time scale: zoom; elsewhere with Ctrl"],
  ["Shift wheel", "scroll along the time line"],
];
/** The step of the arrow keys in s: that of the frames of a recording. */
const STEP_S = 0.02;

export class Page {
  /** @param {Run[]} runs */
  constructor(runs) {
    this.runs = runs;
    this.run = runs[0];
    this.playing = false;
    this.rate = NORMAL;
    this.mode = "speed";
    this.time = 0;
    this.channel = this.run.robots[0];
    this.tab = "Source";
    this.stale = true;
    this.last = performance.now();
    this.fromLink();
    this.scene = this.makeScene();
    this.tracks = new Tracks(byId("tracks"), runs, this.channel, (time) => this.seek(time));
    this.source = new Source(this.run, (file, line) => this.seekLine(file, line));
    this.now = new Now(byId("now"));
    this.controls();
    if (this.run.live) this.goLive();
    if (this.run.answer.teaches && this.channel) {
      this.teach = new Teach(this);
      this.scene?.renderer.domElement.addEventListener("dblclick", (event) => this.teach?.clicked(event));
    }
    this.showTab(this.tab);
    requestAnimationFrame((now) => this.frame(now));
  }

  /** Follows a running program. */
  goLive() {
    this.following = true;
    this.live = new Live(this.run, {
      begun: () => location.reload(),
      more: () => {
        this.stale = this.tracks.stale = true;
        if (
          !["Source", "Teach"].includes(this.tab) &&
          this.shownVersion !== this.run.answer.version &&
          !byId("panel").contains(document.activeElement)
        )
          this.showTab(this.tab);
      },
      ended: () => (this.following = false),
    });
  }

  makeScene() {
    try {
      return new CellScene(byId("scene"), this.runs);
    } catch (problem) {
      const text = "The cell cannot be drawn: this browser has no WebGL, or it is switched off. Everything else works.";
      Object.assign(byId("nowhere"), { hidden: false, textContent: text });
      console.warn(String(problem));
    }
  }

  get end() {
    return Math.max(...this.runs.map((run) => run.end));
  }

  /** @param {number} time */
  seek(time) {
    this.time = Math.min(Math.max(time, 0), this.end);
    this.following = this.run.live && this.time > this.end - 0.3;
    if (this.following) this.play(false);
    this.stale = true;
  }

  /** The next moment at which a line's motion begins, or the first one. @param {string} file @param {number} line */
  seekLine(file, line) {
    const own = this.run.motionsOf(this.channel?.number, file, line);
    const next = own.find((motion) => motion.start > this.time + 1e-3) ?? own[0];
    if (next) this.seek(next.start);
  }

  /** @param {number} by */
  seekMotion(by) {
    const starts = this.run.starts?.get(this.channel?.number) ?? [];
    const later = starts.filter((start) => (by > 0 ? start > this.time + 1e-6 : start < this.time - 1e-6));
    const found = by > 0 ? later[0] : later.at(-1);
    if (found !== undefined) this.seek(found);
  }

  play(on = !this.playing) {
    if (on && this.time >= this.end - 1e-6 && !this.run.live) this.time = 0;
    this.playing = on;
    if (on) this.following = false;
    Object.assign(byId("play"), { textContent: on ? "❙❙" : "▶", ariaLabel: on ? "Pause" : "Play" });
    this.stale = true;
  }

  controls() {
    byId("play").addEventListener("click", () => this.play());
    byId("fit").addEventListener("click", () => this.scene?.fit());
    byId("link").addEventListener("click", () => this.copyLink());
    byId("theme").addEventListener("click", () => this.theme());
    byId("help").addEventListener("click", () => dialog("keys").showModal());
    byId("keys").append(
      element(
        "table",
        {},
        ...KEYS.map(([key, does]) => element("tr", {}, element("td", {}, element("kbd", {}, key)), element("td", {}, does))),
      ),
    );
    byId("keys").addEventListener("click", () => dialog("keys").close());
    byId("rate").append(...RATES.map((rate, at) => element("option", { value: at }, `${rate}×`)));
    byId("rate").addEventListener("change", () => this.setRate(Number(byId("rate").value)));
    byId("color").append(...Object.entries(COLORS).map(([mode, name]) => element("option", { value: mode }, name)));
    byId("color").addEventListener("change", () => this.setMode(byId("color").value));
    byId("channel").append(
      ...this.run.robots.map((one) => element("option", { value: one.number }, `${one.number}: ${one.robot}`)),
    );
    byId("channels").hidden = this.run.robots.length < 2;
    byId("channel").addEventListener("change", () => {
      const robot = this.run.robots.find((one) => one.number === Number(byId("channel").value));
      if (robot) this.chooseRobot(robot);
    });
    if (this.channel) byId("channel").value = String(this.channel.number);
    this.setRate(this.rate);
    this.setMode(this.mode);
    const tabs = [
      "Source",
      "Lines",
      "Events",
      ...(this.run.live ? ["Inputs"] : []),
      ...(this.run.answer.teaches ? ["Teach"] : []),
      ...(this.runs.length > 1 ? ["Differences"] : []),
    ];
    byId("tabs").append(
      ...tabs.map((name) => {
        const tab = element("button", { role: "tab" }, name);
        tab.addEventListener("click", () => this.showTab(name));
        return tab;
      }),
    );
    write(byId("name"), this.runs.map((run) => run.name).join(" and "));
    document.title = `${this.run.name} – arl2rs view`;
    const problems = this.runs.map((run) => run.problem).filter(Boolean);
    Object.assign(byId("trouble"), { hidden: problems.length === 0, textContent: problems.join(" ") });
    window.addEventListener("keydown", (event) => this.key(event));
    window.addEventListener("hashchange", () => this.fromLink());
  }

  /** Shows another robot. @param {import('./run.js').Channel} robot */
  chooseRobot(robot) {
    if (robot === this.channel) return;
    this.channel = robot;
    byId("channel").value = String(robot.number);
    this.tracks.rebuild(robot);
    this.teach?.changed();
    this.showTab(this.tab);
    this.stale = true;
  }

  /** @param {KeyboardEvent} event */
  key(event) {
    const target = /** @type {HTMLElement} */ (event.target);
    if (event.ctrlKey || event.metaKey || event.altKey || /^(INPUT|SELECT|TEXTAREA|DIALOG)$/.test(target.tagName)) return;
    const by = event.shiftKey ? 1 : STEP_S;
    /** @type {Record<string, () => void>} */
    const does = {
      " ": () => this.play(),
      ArrowLeft: () => this.seek(this.time - by),
      ArrowRight: () => this.seek(this.time + by),
      ArrowUp: () => this.seekMotion(-1),
      ArrowDown: () => this.seekMotion(1),
      Home: () => this.seek(0),
      End: () => this.seek(this.end),
      "[": () => this.setRate(this.rate - 1),
      "]": () => this.setRate(this.rate + 1),
      f: () => this.scene?.fit(),
      0: () => this.tracks.fit(),
      l: () => this.copyLink(),
      d: () => this.theme(),
      "?": () => dialog("keys").showModal(),
    };
    Object.keys(COLORS).forEach((mode, at) => (does[String(at + 1)] = () => this.setMode(mode)));
    const act = does[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!act) return;
    // A focused button is not pressed as well.
    if (event.key === " " && target.tagName === "BUTTON") target.blur();
    act();
    event.preventDefault();
  }

  /** @param {number} rate */
  setRate(rate) {
    this.rate = Math.min(Math.max(rate, 0), RATES.length - 1);
    byId("rate").value = String(this.rate);
  }

  /** @param {string} mode */
  setMode(mode) {
    this.mode = mode in COLORS ? mode : "speed";
    byId("color").value = this.mode;
    this.stale = true;
  }

  theme() {
    const light = document.documentElement.classList.toggle("light");
    localStorage.setItem("theme", light ? "light" : "dark");
    this.scene?.colors();
    this.tracks.stale = true;
    this.stale = true;
  }

  /** The address of this moment. */
  link() {
    const words = new URLSearchParams({
      t: seconds(this.time),
      color: this.mode,
      ...(this.channel ? { robot: String(this.channel.number) } : {}),
    });
    return `#${words}`;
  }

  copyLink() {
    history.replaceState(null, "", this.link());
    navigator.clipboard?.writeText(location.href).catch(() => {});
  }

  /** Goes to the moment of the address. */
  fromLink() {
    const words = new URLSearchParams(location.hash.slice(1));
    const time = Number(words.get("t"));
    if (Number.isFinite(time) && time > 0) this.time = Math.min(time, this.end);
    const mode = words.get("color") ?? this.mode;
    if (mode in COLORS) this.mode = mode;
    const robot = this.run.robots.find((one) => String(one.number) === words.get("robot"));
    // At first nothing is there that shows it.
    if (robot && this.tracks) this.chooseRobot(robot);
    else this.channel = robot ?? this.channel;
    this.stale = true;
  }

  /** @param {string} name */
  showTab(name) {
    this.tab = name;
    for (const tab of [...byId("tabs").children]) tab.setAttribute("aria-selected", String(tab.textContent === name));
    const chosen = (/** @type {string} */ file, /** @type {number} */ line) => this.seekLine(file, line);
    const channel = this.channel?.number ?? 1;
    const panel = byId("panel");
    if (name === "Source") panel.replaceChildren(this.source.holder);
    else if (name === "Lines") panel.replaceChildren(lines(this.run, channel, chosen));
    else if (name === "Events") panel.replaceChildren(events(this.run, (time) => this.seek(time)));
    else if (name === "Teach") panel.replaceChildren(...(this.teach ? [this.teach.holder] : []));
    else if (name === "Inputs") panel.replaceChildren(...(this.live ? [this.live.inputs()] : []));
    else this.showDifferences(panel, chosen);
    this.shownVersion = this.run.answer.version;
    this.source.marked = "";
    this.stale = true;
  }

  /** @param {HTMLElement} panel @param {(file: string, line: number) => void} chosen */
  async showDifferences(panel, chosen) {
    panel.replaceChildren(element("p", { className: "hint" }, "Comparing the two runs."));
    const answer = await fetch("/api/differences");
    const shown = answer.ok ? differences(await answer.json(), chosen) : element("p", { className: "hint" }, await answer.text());
    if (this.tab === "Differences") panel.replaceChildren(shown);
  }

  /** Draws a frame. @param {number} now */
  frame(now) {
    const passed = Math.min((now - this.last) / 1000, 0.25);
    this.last = now;
    if (this.following) {
      const wished = Math.max(this.end - BEHIND_S, 0);
      // News arrives in bursts: time advances evenly, and catches up if it has fallen behind.
      const next = this.time + passed;
      this.time = Math.abs(wished - next) > 0.5 ? wished : Math.min(next + (wished - next) * 0.1, this.end);
      this.stale = true;
    } else if (this.playing) {
      this.time += passed * RATES[this.rate];
      if (this.time >= this.end && !this.run.live) {
        this.time = this.end;
        this.play(false);
      }
      this.stale = true;
    }
    if (this.stale) {
      this.stale = false;
      this.show();
    }
    this.scene?.draw();
    this.tracks.draw();
    requestAnimationFrame((later) => this.frame(later));
  }

  show() {
    const { run, channel, time } = this;
    write(byId("time"), seconds(time));
    this.scene?.show(time, this.mode);
    this.tracks.show(time);
    this.now.show(run, channel, time);
    if (channel && this.tab === "Source") {
      const moment = channel.samples.at(Math.min(time, run.end), run.end);
      const { files } = run.track(channel.number);
      this.source.times(channel.number);
      if (moment) {
        const program = moment.line > 0 ? { file: files[moment.file] ?? "", line: moment.line } : undefined;
        const motion = moment.motion > 0 ? { file: files[moment.motionFile] ?? "", line: moment.motionLine } : undefined;
        this.source.mark(program, motion);
      }
    }
  }
}

async function begin() {
  const wished = localStorage.getItem("theme") ?? (matchMedia("(prefers-color-scheme: light)").matches ? "light" : "dark");
  document.documentElement.classList.toggle("light", wished === "light");
  try {
    /** @type {string[]} */
    const names = await (await fetch("/api/runs")).json();
    /** @type {Page | undefined} */
    let page;
    const changed = () => {
      if (page) page.stale = page.tracks.stale = true;
    };
    const runs = await Promise.all(names.map((_, number) => Run.load(number, changed)));
    page = new Page(runs);
    Object.assign(window, { page });
  } catch (problem) {
    Object.assign(byId("trouble"), {
      hidden: false,
      textContent: `The run cannot be shown: ${problem instanceof Error ? problem.message : problem}`,
    });
  }
}

begin();
