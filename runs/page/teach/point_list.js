// The points of the program as a table, in which one or several are chosen.

import { element } from "../dom.js";
import { COMPONENTS, key } from "./server.js";

/** @typedef {import('./server.js').Point} Point */

export class PointList {
  /** @param {(name: string, more: boolean) => void} clicked a point, and whether others stay chosen */
  constructor(clicked) {
    this.clicked = clicked;
    /** @type {Point[]} */
    this.points = [];
    /** @type {Set<string>} the chosen points, by their files and names */
    this.chosen = new Set();
    this.rows = element("tbody");
    this.holder = element("table", { className: "list" }, this.rows);
  }

  /** Shows these points. @param {Point[]} points */
  show(points) {
    this.points = points;
    this.rows.replaceChildren(...points.map((point) => this.row(point)));
  }

  /** @param {Point} point */
  row(point) {
    const name = key(point);
    const chosen = this.chosen.has(name);
    const box = element("input", { type: "checkbox", checked: chosen, ariaLabel: point.name });
    const order = point.type === "pose" ? COMPONENTS : Object.keys(point.values).sort();
    const shown = order.filter((name) => name in point.values).slice(0, 6);
    const values = shown.map((name) => `${name} ${point.values[name]}`).join(", ");
    const row = element(
      "tr",
      { className: chosen ? "chosen" : "" },
      element("td", {}, box),
      element("td", {}, point.name),
      element("td", {}, point.type),
      element("td", { className: "text" }, values),
    );
    box.addEventListener("click", (event) => {
      event.stopPropagation();
      this.clicked(name, true);
    });
    row.addEventListener("click", () => this.clicked(name, false));
    return row;
  }

  /**
   * Chooses a point; `more` adds it to the chosen points, or removes it.
   * @param {string} name @param {boolean} more
   * @returns {Point | undefined} the point, if it is now chosen
   */
  choose(name, more) {
    if (!more) this.chosen = new Set([name]);
    else if (!this.chosen.delete(name)) this.chosen.add(name);
    this.show(this.points);
    return this.chosen.has(name) ? this.point(name) : undefined;
  }

  /** @param {string} name */
  point(name) {
    return this.points.find((point) => key(point) === name);
  }

  /** The chosen points. */
  all() {
    return [...this.chosen].map((name) => this.point(name)).filter((point) => point !== undefined);
  }

  /** The chosen point, if it is the only one. */
  only() {
    return this.chosen.size === 1 ? this.all()[0] : undefined;
  }
}
