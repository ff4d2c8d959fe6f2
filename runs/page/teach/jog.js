// Buttons that move the robot while they are held: its axes, its TCP, and the whole robot to the dragged one.

import { element } from "../dom.js";
import { holds } from "../live.js";

/** Directions of the TCP: along and about an axis of the frame. */
const DIRECTIONS = ["x", "y", "z", "rx", "ry", "rz"];
const SIGNS = ["-", "+"];

export class JogButtons {
  /**
   * @param {() => number[]} workpiece the angles of the workpiece's frame in deg
   * @param {() => string | undefined} target the order that moves the robot to the dragged robot; undefined if there is none
   */
  constructor(workpiece, target) {
    this.workpiece = workpiece;
    this.target = target;
    this.held = new AbortController();
    this.holder = element("div", { className: "jogs" });
    this.frame = /** @type {HTMLSelectElement} */ (element("select", { ariaLabel: "Directions" }));
    this.frame.append(...["world", "tool", "workpiece"].map((name) => element("option", { value: name }, name)));
  }

  /** Makes the buttons move this robot. @param {import('../run.js').Channel} channel */
  show(channel) {
    // The buttons of another robot are removed.
    this.held.abort();
    this.held = new AbortController();
    /** @param {string} name @param {string} title @param {() => string | undefined} direction */
    const button = (name, title, direction) => {
      const made = /** @type {HTMLButtonElement} */ (element("button", { title, className: "hold" }, name));
      const order = () => {
        const words = direction();
        return words && `hold.${channel.number} = "${words}"`;
      };
      holds(made, order, this.held.signal);
      return made;
    };
    const axes = channel.axes.map(({ name }, at) =>
      element("span", {}, ...SIGNS.map((sign) => button(`${name}${sign}`, `Hold: ${name}`, () => `j${at + 1}${sign}`))),
    );
    const tcp = DIRECTIONS.map((name) => {
      const title = `Hold: the TCP ${name.length > 1 ? "about" : "along"} ${name.at(-1)}`;
      return element("span", {}, ...SIGNS.map((sign) => button(`${name}${sign}`, title, () => `${this.seen()}${name}${sign}`)));
    });
    const go = button("Go there", "Hold: the robot goes to where the dragged one is", this.target);
    this.holder.replaceChildren(
      element("p", { className: "row" }, ...axes),
      element("p", { className: "row" }, element("label", {}, "TCP in ", this.frame), ...tcp, go),
    );
  }

  /** The frame of the directions, in the words of an order. */
  seen() {
    switch (this.frame.value) {
      case "tool":
        return "tool ";
      case "workpiece":
        return `frame ${this.workpiece().join(" ")} `;
      default:
        return "";
    }
  }
}
