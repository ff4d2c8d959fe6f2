// A running program: its news, the buttons of the pendant, its inputs.

import { byId, element, write } from "./dom.js";

/** The interval at which news is requested, in ms. */
const NEWS_MS = 50;
/** How far the displayed moment lags behind the latest data, in s, so that there is always data ahead. */
export const BEHIND_S = 0.06;

/** The buttons, the orders that they send to the program, and the states in which they are active. */
const BUTTONS = [
  ["Start", 'pendant = "start"', "Let the program and the robot go on", ["paused", "standstill"]],
  ["Pause", 'pendant = "pause"', "Stop on the path", ["running"]],
  ["Step", 'pendant = "step"', "One motion or statement", ["paused"]],
  ["Reset", 'pendant = "reset"', "Back to the beginning of the program", ["paused", "ended", "alarm", "stopped"]],
  ["Clear", 'pendant = "clear"', "Clear the alarm", ["alarm"]],
];

/** Sends an order to the program; shows the error if it is refused. @param {string} order */
export async function tell(order) {
  const answer = await fetch("/api/order", { method: "POST", body: order }).catch((problem) => ({
    ok: false,
    text: async () => String(problem),
  }));
  if (!answer.ok) showProblem(await answer.text());
  return answer.ok;
}

/** @param {string} text */
export function showProblem(text) {
  Object.assign(byId("trouble"), { hidden: text === "", textContent: text });
}

/** A held button repeats its order at this interval, in ms: without an order for a quarter of a second, the robot stops. */
const HOLD_MS = 80;

/**
 * A button that moves the robot as long as it is held, by pointer or by key.
 * @param {HTMLButtonElement} button @param {() => string | undefined} words what is moved, in the words of an order
 * @param {AbortSignal} signal aborted when the button is removed
 */
export function holds(button, words, signal) {
  /** @type {string | undefined} */
  let order;
  /** @type {Promise<unknown>} keeps the orders in sequence, even if an answer is slow */
  let sent = Promise.resolve();
  const say = () => {
    if (order === undefined) return;
    // A button that has been removed from the page is no longer held, even if the pointer is still down.
    if (!button.isConnected) return letGo();
    const now = order;
    sent = sent.then(() => tell(now)).then(() => setTimeout(say, HOLD_MS));
  };
  const hold = () => {
    const held = words();
    if (order !== undefined || held === undefined || button.disabled) return;
    order = held;
    button.classList.add("on");
    say();
  };
  const letGo = () => {
    if (order === undefined) return;
    const key = order.split("=")[0];
    order = undefined;
    button.classList.remove("on");
    sent = sent.then(() => tell(`${key}= ""`));
  };
  let pointer = -1;
  button.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    pointer = event.pointerId;
    button.setPointerCapture(pointer);
    hold();
  });
  /** @param {PointerEvent} event */
  const lifted = (event) => {
    if (event.pointerId === pointer) letGo();
  };
  for (const end of ["pointerup", "pointercancel", "lostpointercapture"])
    document.addEventListener(end, /** @type {EventListener} */ (lifted), { capture: true, signal });
  button.addEventListener("blur", letGo);
  button.addEventListener("keydown", (event) => {
    if ([" ", "Enter"].includes(event.key)) {
      hold();
      event.preventDefault();
      event.stopPropagation();
    }
  });
  button.addEventListener("keyup", letGo);
  button.addEventListener("contextmenu", (event) => event.preventDefault());
  window.addEventListener("blur", letGo, { signal });
  window.addEventListener("pagehide", letGo, { signal });
  document.addEventListener("visibilitychange", letGo, { signal });
  signal.addEventListener("abort", letGo);
}

export class Live {
  /** @param {import('./run.js').Run} run @param {{begun: () => void, more: () => void, ended: () => void}} does */
  constructor(run, does) {
    this.run = run;
    this.does = does;
    this.buttons = BUTTONS.map(([name, order, title, states]) => {
      const button = /** @type {HTMLButtonElement} */ (element("button", { title }, /** @type {string} */ (name)));
      button.addEventListener("click", () => tell(/** @type {string} */ (order)));
      return { button, states };
    });
    this.percent = element("output", { title: "The override" }, "100 %");
    const by = (/** @type {number} */ step) => () => tell(`override = ${Math.min(Math.max(this.speed + step, 0), 100)}`);
    const less = element("button", { title: "Slower", ariaLabel: "Override down" }, "−");
    const more = element("button", { title: "Faster", ariaLabel: "Override up" }, "+");
    less.addEventListener("click", by(-10));
    more.addEventListener("click", by(10));
    byId("buttons").replaceChildren(...this.buttons.map(({ button }) => button), less, this.percent, more);
    byId("buttons").hidden = false;
    this.show();
    this.ask();
  }

  get speed() {
    return this.run.answer.controller.at(-1)?.override ?? 100;
  }

  async ask() {
    try {
      const news = await this.run.refresh();
      if (news === "begun") return this.does.begun();
      if (news === "more") this.does.more();
      if (this.lost) showProblem("");
      this.lost = false;
    } catch {
      this.lost = true;
      showProblem("The arl2rs command has ended or does not answer. What was shown so far is still here.");
    }
    this.show();
    if (!this.run.live) {
      showProblem("The program has ended. Start `arl2rs view` again to go on.");
      return this.does.ended();
    }
    setTimeout(() => this.ask(), this.lost ? 1000 : NEWS_MS);
  }

  /** Shows which buttons are active now. */
  show() {
    const states = this.run.robots.map((channel) => this.run.stateAt(channel.number, this.run.end));
    for (const { button, states: own } of this.buttons) {
      const acts = states.some((/** @type {string} */ state) => own.includes(state)) && this.run.live && !this.lost;
      if (button.disabled === acts) button.disabled = !acts;
    }
    write(this.percent, `${Math.round(this.speed)} %`);
  }

  /** Inputs that can be set, and any other order. */
  inputs() {
    const { names, levels } = this.run.answer;
    const named = Object.keys(names ?? {}).filter((signal) => signal.startsWith("di."));
    const used = [...this.run.lanes.keys()].filter((signal) => signal.startsWith("di."));
    const signals = [...new Set([...named, ...used])].sort((one, other) => Number(one.slice(3)) - Number(other.slice(3)));
    const rows = signals.map((signal) => {
      const on = () => this.run.answer.levels?.di[Number(signal.slice(3)) - 1] === "1";
      const button = element("button", { className: on() ? "on" : "", ariaLabel: signal }, on() ? "on" : "off");
      button.addEventListener("click", () => tell(`${signal} = ${!on()}`));
      return element(
        "tr",
        {},
        element("td", {}, signal),
        element("td", { className: "text" }, names?.[signal] ?? ""),
        element("td", {}, button),
      );
    });
    const order = /** @type {HTMLInputElement} */ (
      element("input", { placeholder: "di.5 = true", ariaLabel: "An order in the words of a scenario", size: 28, spellcheck: false })
    );
    const form = element("form", { className: "hint" }, order, " ", element("button", {}, "Send"));
    form.addEventListener("submit", async (event) => {
      event.preventDefault();
      if (order.value.trim() && (await tell(order.value.trim()))) order.value = "";
    });
    const table = element("table", { className: "list" }, element("tbody", {}, ...rows));
    return element("div", {}, ...(levels ? [table] : []), form);
  }
}
