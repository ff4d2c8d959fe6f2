// The taught pose as numbers, and the configurations in which the robot reaches it.

import { element, write } from "../dom.js";
import { COMPONENTS } from "./server.js";

/** The step of a number's arrows: in mm, in deg. */
const STEP = { mm: 10, deg: 5 };

/** @typedef {import('../api.js').TaughtPose} TaughtPose */

export class PoseForm {
  /** @param {(components: number[]) => void} typed @param {(solution: number) => void} picked */
  constructor(typed, picked) {
    this.picked = picked;
    this.values = COMPONENTS.map((name) => {
      const step = ["x", "y", "z"].includes(name) ? STEP.mm : STEP.deg;
      const input = /** @type {HTMLInputElement} */ (element("input", { type: "number", step, ariaLabel: name }));
      input.addEventListener("change", () => {
        const components = this.values.map(({ input }) => Number(input.value));
        if (components.every(Number.isFinite)) typed(components);
      });
      return { input, label: element("label", {}, name, input) };
    });
    this.row = element("p", { className: "row values" }, ...this.values.map(({ label }) => label));
    this.solutions = element("div", { className: "solutions" });
    this.hint = element("p", { className: "hint" });
  }

  /** @param {string} text */
  say(text) {
    write(this.hint, text);
  }

  /** Shows the numbers of a pose. @param {TaughtPose} place */
  show(place) {
    this.values.forEach(({ input }, at) => (input.value = String(Math.round(place.components[at] * 1000) / 1000)));
  }

  /** Offers the configurations; `picked` is that of the robot. @param {TaughtPose} place @param {number} picked */
  offer({ solutions }, picked) {
    this.solutions.replaceChildren(
      ...solutions.map((one, number) => {
        const name = `cfg ${one.cfg}${one.near ? ` ⚠ ${one.near}` : ""}`;
        const title = one.axes ? one.axes.map((axis) => axis.toFixed(1)).join(", ") : one.why;
        const button = element("button", { title, disabled: !one.axes, className: number === picked ? "on" : "" }, name);
        button.addEventListener("click", () => this.picked(number));
        return button;
      }),
    );
    const solution = solutions[picked];
    const reasons = [...new Set(solutions.map((one) => one.why).filter(Boolean))];
    if (!solution?.axes) this.say(`The robot cannot reach this pose: ${reasons.slice(0, 2).join("; ")}.`);
    else if (solution.near)
      this.say(`Near the ${solution.near} singularity (clearance ${solution.clearance.toFixed(3)}): axes may turn quickly there.`);
    else this.say("");
  }

  /** Removes the configurations. */
  clear() {
    this.solutions.replaceChildren();
  }
}
