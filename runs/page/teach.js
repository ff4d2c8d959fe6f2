// Teaching: points of the program in the cell, a robot to drag, and what is written.

import {
  AxesHelper,
  CanvasTexture,
  DoubleSide,
  Group,
  Mesh,
  MeshBasicMaterial,
  Object3D,
  PlaneGeometry,
  Raycaster,
  TransformControls,
  Vector2,
} from "./three.js";
import { scale } from "./colors.js";
import { element, write } from "./dom.js";
import { holds, trouble } from "./live.js";
import { Frames, put } from "./robot.js";

const NOWHERE = [0, 0, 0, 0, 0, 0, 1];
const COMPONENTS = ["x", "y", "z", "a", "b", "c"];
/** Frames of points are drawn so long, in m. */
const POINT_M = 0.07;
/** A map of reach goes so far around the robot, and from place to place, in mm. */
const MAP = { half: 2000, step: 40 };

/**
 * @typedef {{points: import('./api.js').Points, save: import('./api.js').Points, undo: import('./api.js').Points, place: import('./api.js').TaughtPose, map: import('./api.js').Mapped}} Answers
 * @typedef {import('./api.js').Point} Point
 * @typedef {Pick<Point, 'file' | 'type' | 'name' | 'values'> & {before: Point['values']}} Change
 */

/**
 * Asks the server for something; what cannot be is told.
 * @template {keyof Answers} What
 * @param {What} what @param {object} [order]
 * @returns {Promise<Answers[What] | undefined>}
 */
async function ask(what, order) {
  const body = order === undefined ? {} : { method: "POST", body: JSON.stringify(order) };
  const answer = await fetch(`/api/teach/${what}`, body);
  if (answer.ok) return answer.json();
  trouble(await answer.text());
  return undefined;
}

/** What names a point, or a frame: its file and its name. @param {{file: string, name: string}} of */
function key({ file, name }) {
  return `${file}: ${name}`;
}

/** @param {string} name @param {string} title @param {() => void} does */
function button(name, title, does) {
  const made = /** @type {HTMLButtonElement} */ (element("button", { title }, name));
  made.addEventListener("click", does);
  return made;
}

export class Teach {
  /** @param {import('./main.js').Page} page */
  constructor(page) {
    this.page = page;
    /** @type {import('./api.js').Points} */
    this.told = { points: [], frames: [], undo: 0, troubles: [] };
    /** @type {Set<string>} the points that are chosen, by their files and names */
    this.chosen = new Set();
    this.tool = "as now";
    this.wobj = "world";
    /** @type {import('./api.js').TaughtPose | undefined} where the dragged robot is, as the server says */
    this.place = undefined;
    /** @type {number[]} its axes */
    this.axes = [];
    /** @type {number[]} the external axes with which the place was taken */
    this.external = [];
    this.solution = 0;
    this.holder = element("div", { className: "teach" });
    this.tools = /** @type {HTMLSelectElement} */ (element("select", { ariaLabel: "Tool" }));
    this.wobjs = /** @type {HTMLSelectElement} */ (element("select", { ariaLabel: "Workpiece" }));
    this.list = element("tbody");
    this.solutions = element("div", { className: "solutions" });
    this.word = element("p", { className: "hint" });
    this.values = COMPONENTS.map((name) => {
      const step = ["x", "y", "z"].includes(name) ? 10 : 5;
      const input = /** @type {HTMLInputElement} */ (element("input", { type: "number", step, ariaLabel: name }));
      input.addEventListener("change", () => this.typed());
      return { name, input, label: element("label", {}, name, input) };
    });
    this.save = button("Teach", "Write this pose into the chosen point", () => this.teach());
    this.undoing = button("Undo", "Undo the last change", () => this.write("undo", {}));
    this.jogs = element("div", { className: "jogs" });
    this.holding = new AbortController();
    this.frame = /** @type {HTMLSelectElement} */ (element("select", { ariaLabel: "Directions" }));
    this.frame.append(...["world", "tool", "workpiece"].map((name) => element("option", { value: name }, name)));
    this.build();
    this.refresh();
  }

  /** The robot that is taught: the one that is shown. */
  get channel() {
    return this.page.channel;
  }

  get moment() {
    const { run, time } = this.page;
    return this.channel?.samples.at(Math.min(time, run.end), run.end);
  }

  build() {
    this.tools.addEventListener("change", () => this.setting());
    this.wobjs.addEventListener("change", () => this.setting());
    const move = button("Move", "Arrows for moving the TCP", () => this.gizmo("translate"));
    const turn = button("Turn", "Rings for turning the TCP", () => this.gizmo("rotate"));
    const here = button("From robot", "Where the robot is now", () => this.fromRobot());
    const map = button("Map", "What the robot reaches in this plane with this orientation", () => this.map());
    const amounts = ["x", "y", "z"].map(
      (name) => /** @type {HTMLInputElement} */ (element("input", { type: "number", value: "0", ariaLabel: `by ${name}` })),
    );
    const shift = button("Shift", "Shift all chosen points by these amounts in mm", () => this.shift(amounts.map((amount) => Number(amount.value))));
    const mirrors = ["x", "y", "z"].map((name, axis) =>
      button(`Mirror ${name}`, `Mirror all chosen points at ${name} = 0`, () => this.mirror(axis)),
    );
    this.jogButtons();
    this.holder.replaceChildren(
      element("p", { className: "row" }, element("label", {}, "Tool ", this.tools), element("label", {}, "Workpiece ", this.wobjs)),
      element("table", { className: "list" }, this.list),
      element("p", { className: "row values" }, ...this.values.map(({ label }) => label)),
      this.solutions,
      this.word,
      element("p", { className: "row" }, this.save, this.undoing, move, turn, here, map),
      this.jogs,
      element("p", { className: "row" }, "Shift by", ...amounts, shift, ...mirrors),
    );
  }

  /** What is told of a direction, for the robot that is shown. @param {string} words */
  holdOrder(words) {
    return `hold.${this.channel.number} = "${words}"`;
  }

  /** Buttons that move the robot while they are held: its axes, its TCP, and all of it to the dragged one. */
  jogButtons() {
    // Those of another robot are there no more.
    this.holding.abort();
    this.holding = new AbortController();
    /** @param {string} name @param {string} title @param {() => string | undefined} words */
    const held = (name, title, words) => {
      const made = /** @type {HTMLButtonElement} */ (element("button", { title, className: "hold" }, name));
      holds(
        made,
        () => {
          const said = words();
          return said && this.holdOrder(said);
        },
        this.holding.signal,
      );
      return made;
    };
    const axes = this.channel.axes.map((axis, at) =>
      element("span", {}, ...["-", "+"].map((sign) => held(`${axis.name}${sign}`, `Hold: ${axis.name}`, () => `j${at + 1}${sign}`))),
    );
    const angles = () =>
      this.told.frames.find((one) => one.type === "wobj" && key(one) === this.wobj)?.angles ?? [0, 0, 0];
    const seen = () => ({ world: "", tool: "tool ", workpiece: `frame ${angles().join(" ")} ` })[this.frame.value] ?? "";
    const tcp = ["x", "y", "z", "rx", "ry", "rz"].map((name) =>
      element(
        "span",
        {},
        ...["-", "+"].map((sign) =>
          held(`${name}${sign}`, `Hold: the TCP ${name.length > 1 ? "about" : "along"} ${name.at(-1)}`, () => `${seen()}${name}${sign}`),
        ),
      ),
    );
    const go = held("Go there", "Hold: the robot goes to where the dragged one is", () => {
      if (this.place?.solutions[this.solution]?.axes)
        return `to ${[...this.axes.slice(0, this.channel.links.length - 1), ...this.external].join(" ")}`;
      trouble("Choose a point first, or drag the robot to where it should go.");
      return undefined;
    });
    this.jogs.replaceChildren(
      element("p", { className: "row" }, ...axes),
      element("p", { className: "row" }, element("label", {}, "TCP in ", this.frame), ...tcp, go),
    );
  }

  /** Another robot is shown. */
  changed() {
    [this.place, this.axes, this.external, this.solution] = [undefined, [], [], 0];
    this.chosen.clear();
    for (const old of [this.ghost?.world, this.handle, this.control?.getHelper(), this.mapped]) old?.removeFromParent();
    this.control?.dispose();
    [this.ghost, this.handle, this.control, this.mapped] = [undefined, undefined, undefined, undefined];
    this.solutions.replaceChildren();
    this.jogButtons();
    this.take(this.told);
  }

  async refresh() {
    const told = await ask("points");
    if (told) this.take(told);
  }

  /** Takes in what the data files hold. @param {import('./api.js').Points} told */
  take(told) {
    this.told = told;
    if (told.troubles.length > 0) trouble(told.troubles.join(" "));
    const option = (/** @type {string} */ name) => element("option", { value: name }, name.split(": ").at(-1) ?? name);
    const names = (/** @type {string} */ type) => told.frames.filter((frame) => frame.type === type && !frame.other);
    this.tools.replaceChildren(...["as now", "flange", ...names("tool").map(key)].map(option));
    this.wobjs.replaceChildren(...["world", ...names("wobj").map(key)].map(option));
    this.tools.value = this.tool;
    this.wobjs.value = this.wobj;
    const rows = told.points.map((point) => {
      const box = /** @type {HTMLInputElement} */ (
        element("input", { type: "checkbox", checked: this.chosen.has(key(point)), ariaLabel: point.name })
      );
      const order = point.type === "pose" ? COMPONENTS : Object.keys(point.values).sort();
      const shown = order.filter((name) => name in point.values).slice(0, 6);
      const cells = [element("td", {}, box), element("td", {}, point.name), element("td", {}, point.type)];
      const values = element("td", { className: "text" }, shown.map((name) => `${name} ${point.values[name]}`).join(", "));
      const row = element("tr", { className: this.chosen.has(key(point)) ? "chosen" : "" }, ...cells, values);
      box.addEventListener("click", (event) => {
        event.stopPropagation();
        this.choose(key(point), true);
      });
      row.addEventListener("click", () => this.choose(key(point), false));
      return row;
    });
    this.list.replaceChildren(...rows);
    if (rows.length === 0) write(this.word, "The program has no data file with points: NAME_data.arl beside NAME.arl.");
    this.undoing.disabled = told.undo === 0;
    this.drawPoints();
  }

  /** Chooses a point; `more` adds it to those that are chosen, or takes it away. @param {string} name @param {boolean} more */
  choose(name, more) {
    if (!more) this.chosen = new Set([name]);
    else if (!this.chosen.delete(name)) this.chosen.add(name);
    this.take(this.told);
    const point = this.point(name);
    if (point && this.chosen.has(name)) this.goTo(point);
  }

  /** @param {string} name */
  point(name) {
    return this.told.points.find((point) => key(point) === name);
  }

  /** Tool, workpiece and base, as the server wants them. */
  where() {
    const named = (/** @type {string} */ type, /** @type {string} */ name) =>
      this.told.frames.find((frame) => frame.type === type && key(frame) === name)?.placed;
    const tool = this.tool === "as now" ? this.toolNow() : (named("tool", this.tool) ?? NOWHERE);
    const base = this.channel ? this.page.run.baseAt(this.channel.number, this.page.time) : NOWHERE;
    return { tool, wobj: named("wobj", this.wobj) ?? NOWHERE, base };
  }

  /** The tool that the robot has at this moment: the TCP seen from the flange. */
  toolNow() {
    const arm = this.page.scene?.frames[0].arms.find((arm) => arm.channel === this.channel);
    if (!arm) return NOWHERE;
    arm.tcp.updateWorldMatrix(true, false);
    const flange = arm.links.at(-1)?.made ?? arm.base;
    flange.updateWorldMatrix(true, false);
    const seen = new Object3D();
    seen.applyMatrix4(flange.matrixWorld.clone().invert().multiply(arm.tcp.matrixWorld));
    return [...seen.position.toArray().map((value) => value * 1000), ...seen.quaternion.toArray()];
  }

  setting() {
    this.tool = this.tools.value;
    this.wobj = this.wobjs.value;
    this.drawPoints();
    if (this.axes.length > 0) this.ask({ axes: this.axes });
  }

  /** The axes that a solution is to be near to. */
  near() {
    return this.axes.length > 0 ? this.axes : (this.moment?.axes ?? this.channel.axes.map(() => 0));
  }

  /** Where a point is. @param {Point} point */
  goTo({ type, values, plain }) {
    const own = this.channel.links.length - 1;
    const missing = type === "pose" ? values.x === undefined : values.j1 === undefined;
    if (!plain || missing) return write(this.word, "The program computes this point, or sets it later: it cannot be shown.");
    this.external = this.externals((at) => values[`ej${at}`]);
    if (type === "joint") return this.ask({ axes: Array.from({ length: own }, (_, at) => values[`j${at + 1}`] ?? 0) });
    return this.ask({ components: COMPONENTS.map((name) => values[name] ?? 0) }, values.cfg ?? 0);
  }

  /** The external axes, from those that are known. @param {(number: number) => number | undefined} of */
  externals(of) {
    const own = this.channel.links.length - 1;
    const now = this.moment?.axes ?? [];
    return this.channel.axes.slice(own).map((_, at) => of(at + 1) ?? now[own + at] ?? 0);
  }

  /** Has the dragged robot go somewhere. @param {{axes?: number[], components?: number[], placed?: number[]}} order @param {number} [cfg] the configuration that is wanted */
  async ask(order, cfg) {
    if (!this.channel || this.asking) {
      this.next = { order, cfg };
      return;
    }
    this.asking = true;
    const place = await ask("place", {
      ...order,
      channel: this.channel.number,
      setting: this.where(),
      near: this.near(),
      before: this.place?.components,
    });
    this.asking = false;
    if (place) this.show(place, cfg, order.placed !== undefined);
    if (this.next) {
      const { order, cfg } = this.next;
      this.next = undefined;
      this.ask(order, cfg);
    }
  }

  /** @param {import('./api.js').TaughtPose} place @param {number | undefined} cfg @param {boolean} dragged */
  show(place, cfg, dragged) {
    this.place = place;
    const wanted = place.solutions.findIndex((one) => one.cfg === cfg && one.axes);
    const same = place.solutions.findIndex((one, at) => at === this.solution && one.axes);
    const at = wanted >= 0 ? wanted : dragged && same >= 0 ? same : (place.nearest ?? -1);
    this.values.forEach(({ input }, component) => (input.value = String(Math.round(place.components[component] * 1000) / 1000)));
    this.pick(at);
    this.drawGhost(!dragged);
  }

  /** Takes one of the configurations. @param {number} at */
  pick(at) {
    const solutions = this.place?.solutions ?? [];
    const solution = solutions[at];
    this.solution = at;
    if (solution?.axes) this.axes = solution.axes;
    this.solutions.replaceChildren(
      ...solutions.map((one, number) => {
        const name = `cfg ${one.cfg}${one.near ? ` ⚠ ${one.near}` : ""}`;
        const title = one.axes ? one.axes.map((axis) => axis.toFixed(1)).join(", ") : one.why;
        const button = /** @type {HTMLButtonElement} */ (
          element("button", { title, disabled: !one.axes, className: number === at ? "on" : "" }, name)
        );
        button.addEventListener("click", () => {
          this.pick(number);
          this.drawGhost(true);
        });
        return button;
      }),
    );
    const reasons = [...new Set(solutions.map((one) => one.why).filter(Boolean))];
    if (!solution?.axes) write(this.word, `The robot cannot reach this pose: ${reasons.slice(0, 2).join("; ")}.`);
    else if (solution.near)
      write(this.word, `Near the ${solution.near} singularity (clearance ${solution.clearance.toFixed(3)}): axes may turn quickly there.`);
    else write(this.word, "");
    this.save.disabled = !solution?.axes || this.chosen.size !== 1 || !this.point([...this.chosen][0])?.plain;
  }

  typed() {
    const components = this.values.map(({ input }) => Number(input.value));
    if (components.every(Number.isFinite)) this.ask({ components }, this.place?.solutions[this.solution]?.cfg);
  }

  fromRobot() {
    const moment = this.moment;
    if (!moment) return;
    this.external = this.externals(() => undefined);
    this.ask({ axes: moment.axes.slice(0, this.channel.links.length - 1) });
  }

  /** Writes, and takes in what is there then. @param {'save' | 'undo'} what @param {object} order */
  async write(what, order) {
    const told = await ask(what, order);
    if (!told) return;
    trouble("");
    this.take(told);
    write(this.word, "Written. It takes effect from the next reset of the program.");
  }

  /** A point with these components. @param {Point} point @param {number[]} components @param {Record<string, number>} [more] */
  moved({ file, type, name, values }, components, more = {}) {
    const now = { ...values, ...Object.fromEntries(COMPONENTS.map((name, at) => [name, components[at]])), ...more };
    // Which turns are meant goes with the axes of before.
    delete now.turn;
    return { file, type, name, values: now, before: values };
  }

  /** Writes the dragged place into the chosen point. */
  teach() {
    const point = this.point([...this.chosen][0]);
    const solution = this.place?.solutions[this.solution];
    if (!point || !this.place || !solution?.axes) return;
    const { file, type, name, values } = point;
    const external = Object.fromEntries(this.external.map((axis, at) => [`ej${at + 1}`, axis]));
    if (type === "pose") return this.write("save", [this.moved(point, this.place.components, { cfg: solution.cfg, ...external })]);
    const own = this.channel.links.length - 1;
    const joints = Object.fromEntries(this.axes.slice(0, own).map((axis, at) => [`j${at + 1}`, axis]));
    return this.write("save", [{ file, type, name, values: { ...values, ...joints, ...external }, before: values }]);
  }

  /** The chosen poses. */
  poses() {
    const points = [...this.chosen]
      .map((name) => this.point(name))
      .filter((point) => point !== undefined)
      .filter((point) => point.type === "pose" && point.plain && point.values.x !== undefined);
    if (points.length === 0 || points.length < this.chosen.size) {
      trouble("Choose poses that are plain numbers: only those can be shifted and mirrored.");
      return [];
    }
    return points;
  }

  /** @param {number[]} by mm along x, y and z */
  shift(by) {
    const points = this.poses();
    const moved = (/** @type {Point} */ { values }) => COMPONENTS.map((name, at) => (values[name] ?? 0) + (by[at] ?? 0));
    if (points.length > 0)
      this.write(
        "save",
        points.map((point) => this.moved(point, moved(point))),
      );
  }

  /**
   * Mirrors at a plane through the origin of the workpiece. With the plane the tool's own axis of the same name is turned round, so that what
   * comes out is an orientation, and the tool points where the mirror shows it.
   * @param {number} axis
   */
  async mirror(axis) {
    const points = this.poses();
    const changes = [];
    for (const point of points) {
      const near = this.near();
      const here = { tool: NOWHERE, wobj: NOWHERE, base: NOWHERE };
      const components = COMPONENTS.map((name) => point.values[name] ?? 0);
      const place = await ask("place", { channel: this.channel.number, components, setting: here, near });
      if (!place) return;
      const placed = [...place.placed];
      placed[axis] = -placed[axis];
      for (const other of [0, 1, 2]) if (other !== axis) placed[3 + other] = -placed[3 + other];
      const mirrored = await ask("place", { channel: this.channel.number, placed, setting: here, near, before: components });
      if (!mirrored) return;
      changes.push(this.moved(point, mirrored.components));
    }
    if (changes.length > 0) await this.write("save", changes);
  }

  /** Where the robot reaches, around its base, in the plane of the place. */
  async map() {
    const scene = this.page.scene;
    if (this.mapped) {
      this.mapped.removeFromParent();
      for (const plane of /** @type {Mesh<PlaneGeometry, MeshBasicMaterial>[]} */ (this.mapped.children)) {
        plane.material.map?.dispose();
        plane.material.dispose();
        plane.geometry.dispose();
      }
      this.mapped = undefined;
      this.page.stale = true;
      return;
    }
    if (!scene || !this.place) return trouble("Choose a point first, or take the pose of the robot.");
    const map = await ask("map", {
      channel: this.channel.number,
      components: this.place.components,
      setting: this.where(),
      near: this.near(),
      ...MAP,
    });
    if (!map) return;
    const canvas = /** @type {HTMLCanvasElement} */ (element("canvas", { width: map.side, height: map.side }));
    const context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
    for (let at = 0; at < map.places.length; at++) {
      const level = Number(map.places[at]);
      const [r, g, b] = scale((level - 1) / 8).map((part) => part * 255);
      context.fillStyle = level > 0 ? `rgb(${r} ${g} ${b} / 70%)` : "rgb(0 0 0 / 0%)";
      context.fillRect(at % map.side, map.side - 1 - Math.floor(at / map.side), 1, 1);
    }
    const length = (map.side * map.step) / 1000;
    const material = new MeshBasicMaterial({ map: new CanvasTexture(canvas), transparent: true, side: DoubleSide, depthWrite: false });
    const plane = new Mesh(new PlaneGeometry(length, length), material);
    const middle = ((map.side - 1) * map.step) / 2000;
    plane.position.set(middle, middle, 0);
    this.mapped = new Group();
    put(this.mapped, map.origin);
    this.mapped.add(plane);
    scene.scene.add(this.mapped);
    scene.stale = true;
  }

  /** The points of the program as frames in the cell. */
  async drawPoints() {
    const scene = this.page.scene;
    if (!scene) return;
    this.marks?.removeFromParent();
    for (const old of /** @type {AxesHelper[]} */ (this.marks?.children ?? [])) old.dispose();
    const marks = new Group();
    this.marks = marks;
    scene.scene.add(marks);
    const setting = this.where();
    for (const point of this.told.points) {
      const { type, values, plain } = point;
      if (type !== "pose" || !plain || values.x === undefined) continue;
      const components = COMPONENTS.map((component) => values[component] ?? 0);
      const place = await ask("place", { channel: this.channel.number, components, setting, near: this.near() });
      // Meanwhile they may be drawn anew.
      if (!place || this.marks !== marks) return;
      const mark = new AxesHelper(this.chosen.has(key(point)) ? POINT_M * 1.7 : POINT_M);
      mark.userData.name = key(point);
      put(mark, place.placed);
      marks.add(mark);
    }
    scene.stale = true;
  }

  /** The robot that is dragged, and what it is dragged by. @param {boolean} placed whether the handle goes where the TCP is */
  drawGhost(placed) {
    const scene = this.page.scene;
    if (!scene || !this.place) return;
    if (!this.ghost) {
      const world = new Group();
      scene.scene.add(world);
      this.ghost = new Frames(this.page.run, world, true, [this.channel]);
      this.ghost.show(new Map([...this.page.run.sceneAt(0)].filter(([id]) => !id.startsWith("body/"))));
      this.handle = new Object3D();
      scene.scene.add(this.handle);
      this.control = new TransformControls(scene.camera, scene.renderer.domElement);
      this.control.setSize(0.8);
      this.control.setSpace("local");
      this.control.attach(this.handle);
      this.control.addEventListener("dragging-changed", (event) => (scene.controls.enabled = !event.value));
      this.control.addEventListener("change", () => (scene.stale = true));
      this.control.addEventListener("objectChange", () => this.dragged());
      scene.scene.add(this.control.getHelper());
    }
    if (placed && this.handle) put(this.handle, this.place.placed);
    const arm = this.ghost.arms.find((arm) => arm.channel.number === this.channel.number);
    const { base } = this.where();
    if (arm) this.ghost.pose(arm, this.axes, base, this.place.placed);
    scene.stale = true;
  }

  dragged() {
    if (!this.handle) return;
    const { position, quaternion } = this.handle;
    const placed = [...position.toArray().map((/** @type {number} */ value) => value * 1000), ...quaternion.toArray()];
    this.ask({ placed }, this.place?.solutions[this.solution]?.cfg);
  }

  /** @param {"translate" | "rotate"} mode */
  gizmo(mode) {
    if (!this.place) this.fromRobot();
    this.control?.setMode(mode);
  }

  /** Chooses the point that is clicked in the cell. @param {MouseEvent} event */
  clicked(event) {
    const scene = this.page.scene;
    if (!scene || !this.marks) return;
    const { left, top, width, height } = scene.renderer.domElement.getBoundingClientRect();
    const at = new Vector2(((event.clientX - left) / width) * 2 - 1, 1 - ((event.clientY - top) / height) * 2);
    const ray = new Raycaster();
    ray.params.Line.threshold = 0.02;
    ray.setFromCamera(at, scene.camera);
    const hit = ray.intersectObjects(this.marks.children)[0];
    if (hit) this.choose(hit.object.userData.name, event.shiftKey);
  }
}
