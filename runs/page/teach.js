// Teaching: the points of the program in the cell, a robot to drag, and the changes that are written.

import { Object3D } from "./three.js";
import { element } from "./dom.js";
import { showProblem } from "./live.js";
import { DraggedRobot } from "./teach/dragged_robot.js";
import { mirrored, moved, shifted } from "./teach/edits.js";
import { JogButtons } from "./teach/jog.js";
import { PointList } from "./teach/point_list.js";
import { PointMarks } from "./teach/point_marks.js";
import { PoseForm } from "./teach/pose_form.js";
import { EXTENT, ReachMap } from "./teach/reach_map.js";
import { ORIGIN, ask, componentsOf, isPlainPose, key } from "./teach/server.js";

/** @typedef {import('./teach/server.js').Point} Point */
/** @typedef {{axes?: number[], components?: number[], placed?: number[]}} Asked where the dragged robot should be, in one of three ways */

/** @param {string} name @param {string} title @param {() => void} does */
function button(name, title, does) {
  const made = /** @type {HTMLButtonElement} */ (element("button", { title }, name));
  made.addEventListener("click", does);
  return made;
}

/** @param {string} ariaLabel @param {() => void} changed */
function select(ariaLabel, changed) {
  const made = /** @type {HTMLSelectElement} */ (element("select", { ariaLabel }));
  made.addEventListener("change", changed);
  return made;
}

export class Teach {
  /** @param {import('./main.js').Page} page */
  constructor(page) {
    this.page = page;
    /** @type {import('./api.js').Points} what the data files hold */
    this.data = { points: [], frames: [], undo: 0, troubles: [] };
    this.tool = "as now";
    this.wobj = "world";
    /** @type {import('./api.js').TaughtPose | undefined} the position of the dragged robot, as the server reports it */
    this.place = undefined;
    /** @type {number[]} the axes of the dragged robot */
    this.axes = [];
    /** @type {number[]} the external axes with which the place was taken */
    this.external = [];
    this.solution = 0;
    /** @type {import('./teach/dragged_robot.js').Mode} */
    this.mode = "translate";
    /** @type {DraggedRobot | undefined} */
    this.robot = undefined;
    /** @type {ReachMap | undefined} */
    this.mapped = undefined;
    this.tools = select("Tool", () => this.setting());
    this.wobjs = select("Workpiece", () => this.setting());
    this.points = new PointList((name, more) => this.choose(name, more));
    this.form = new PoseForm(
      (components) => this.request({ components }, this.picked?.cfg),
      (solution) => this.pick(solution),
    );
    this.jog = new JogButtons(
      () => this.data.frames.find((one) => one.type === "wobj" && key(one) === this.wobj)?.angles ?? [0, 0, 0],
      () => this.target(),
    );
    this.marks = page.scene && new PointMarks(page.scene);
    this.save = button("Teach", "Write this pose into the chosen point", () => this.teach());
    this.undo = button("Undo", "Undo the last change", () => this.write("undo", {}));
    this.holder = element("div", { className: "teach" });
    this.build();
    this.jog.show(this.channel);
    this.refresh();
  }

  /** The channel whose robot is taught: the one shown. */
  get channel() {
    return this.page.channel;
  }

  /** How many axes the robot has without external ones. */
  get own() {
    return this.channel.links.length - 1;
  }

  get moment() {
    const { run, time } = this.page;
    return this.channel?.samples.at(Math.min(time, run.end), run.end);
  }

  /** The configuration in which the dragged robot stands. */
  get picked() {
    return this.place?.solutions[this.solution];
  }

  build() {
    const move = button("Move", "Arrows for moving the TCP", () => this.handle("translate"));
    const turn = button("Turn", "Rings for turning the TCP", () => this.handle("rotate"));
    const here = button("From robot", "Where the robot is now", () => this.fromRobot());
    const map = button("Map", "What the robot reaches in this plane with this orientation", () => this.map());
    const amounts = ["x", "y", "z"].map(
      (name) => /** @type {HTMLInputElement} */ (element("input", { type: "number", value: "0", ariaLabel: `by ${name}` })),
    );
    const by = () => amounts.map((amount) => Number(amount.value));
    const shift = button("Shift", "Shift all chosen points by these amounts in mm", () => this.shift(by()));
    const mirrors = ["x", "y", "z"].map((name, axis) =>
      button(`Mirror ${name}`, `Mirror all chosen points at ${name} = 0`, () => this.mirror(axis)),
    );
    this.holder.replaceChildren(
      element("p", { className: "row" }, element("label", {}, "Tool ", this.tools), element("label", {}, "Workpiece ", this.wobjs)),
      this.points.holder,
      this.form.row,
      this.form.solutions,
      this.form.hint,
      element("p", { className: "row" }, this.save, this.undo, move, turn, here, map),
      this.jog.holder,
      element("p", { className: "row" }, "Shift by", ...amounts, shift, ...mirrors),
    );
  }

  /** Takes in that another robot is shown. */
  changed() {
    [this.place, this.axes, this.external, this.solution] = [undefined, [], [], 0];
    this.points.chosen.clear();
    this.robot?.remove();
    this.mapped?.remove();
    [this.robot, this.mapped] = [undefined, undefined];
    this.form.clear();
    this.jog.show(this.channel);
    this.take(this.data);
  }

  async refresh() {
    const data = await ask("points");
    if (data) this.take(data);
  }

  /** Takes in the contents of the data files. @param {import('./api.js').Points} data */
  take(data) {
    this.data = data;
    if (data.troubles.length > 0) showProblem(data.troubles.join(" "));
    const option = (/** @type {string} */ name) => element("option", { value: name }, name.split(": ").at(-1) ?? name);
    const names = (/** @type {string} */ type) => data.frames.filter((frame) => frame.type === type && !frame.other);
    this.tools.replaceChildren(...["as now", "flange", ...names("tool").map(key)].map(option));
    this.wobjs.replaceChildren(...["world", ...names("wobj").map(key)].map(option));
    this.tools.value = this.tool;
    this.wobjs.value = this.wobj;
    this.points.show(data.points);
    if (data.points.length === 0) this.form.say("The program has no data file with points: NAME_data.arl beside NAME.arl.");
    this.undo.disabled = data.undo === 0;
    this.drawPoints();
  }

  /** @param {string} name @param {boolean} more whether others stay chosen */
  choose(name, more) {
    const point = this.points.choose(name, more);
    this.drawPoints();
    this.allowSaving();
    if (point) this.goTo(point);
  }

  /** The pose can be written where the robot reaches it and one point is chosen that is not computed. */
  allowSaving() {
    this.save.disabled = !this.picked?.axes || !this.points.only()?.plain;
  }

  /** Chooses the point clicked in the cell. @param {MouseEvent} event */
  clicked(event) {
    const name = this.marks?.at(event);
    if (name) this.choose(name, event.shiftKey);
  }

  /** Tool, workpiece and base, as the server expects them. @returns {import('./teach/server.js').Setting} */
  where() {
    const named = (/** @type {string} */ type, /** @type {string} */ name) =>
      this.data.frames.find((frame) => frame.type === type && key(frame) === name)?.placed;
    const tool = this.tool === "as now" ? this.toolNow() : (named("tool", this.tool) ?? ORIGIN);
    const base = this.channel ? this.page.run.baseAt(this.channel.number, this.page.time) : ORIGIN;
    return { tool, wobj: named("wobj", this.wobj) ?? ORIGIN, base };
  }

  /** The robot's tool at this moment: the TCP seen from the flange. */
  toolNow() {
    const arm = this.page.scene?.frames[0].arms.find((arm) => arm.channel === this.channel);
    if (!arm) return ORIGIN;
    arm.tcp.updateWorldMatrix(true, false);
    const flange = arm.links.at(-1)?.made ?? arm.base;
    flange.updateWorldMatrix(true, false);
    const seen = new Object3D();
    seen.applyMatrix4(flange.matrixWorld.clone().invert().multiply(arm.tcp.matrixWorld));
    return [...seen.position.toArray().map((value) => value * 1000), ...seen.quaternion.toArray()];
  }

  /** Takes in that another tool or workpiece is chosen. */
  setting() {
    this.tool = this.tools.value;
    this.wobj = this.wobjs.value;
    this.drawPoints();
    if (this.axes.length > 0) this.request({ axes: this.axes });
  }

  /** The axes that a solution should be close to. */
  near() {
    return this.axes.length > 0 ? this.axes : (this.moment?.axes ?? this.channel.axes.map(() => 0));
  }

  /** Moves the dragged robot to a point. @param {Point} point */
  goTo(point) {
    const { type, values, plain } = point;
    const missing = type === "pose" ? values.x === undefined : values.j1 === undefined;
    if (!plain || missing) return this.form.say("The program computes this point, or sets it later: it cannot be shown.");
    this.external = this.externals((at) => values[`ej${at}`]);
    if (type === "joint") return this.request({ axes: Array.from({ length: this.own }, (_, at) => values[`j${at + 1}`] ?? 0) });
    return this.request({ components: componentsOf(point) }, values.cfg ?? 0);
  }

  /** Moves the dragged robot to the position of the robot. */
  fromRobot() {
    const moment = this.moment;
    if (!moment) return;
    this.external = this.externals(() => undefined);
    this.request({ axes: moment.axes.slice(0, this.own) });
  }

  /** The external axes, taken from those that are known. @param {(number: number) => number | undefined} of */
  externals(of) {
    const now = this.moment?.axes ?? [];
    return this.channel.axes.slice(this.own).map((_, at) => of(at + 1) ?? now[this.own + at] ?? 0);
  }

  /** Moves the dragged robot; of several orders the last one counts. @param {Asked} order @param {number} [cfg] the wanted configuration */
  async request(order, cfg) {
    if (!this.channel || this.requesting) {
      this.next = { order, cfg };
      return;
    }
    this.requesting = true;
    const place = await ask("place", {
      ...order,
      channel: this.channel.number,
      setting: this.where(),
      near: this.near(),
      before: this.place?.components,
    });
    this.requesting = false;
    if (place) this.show(place, cfg, order.placed !== undefined);
    if (this.next) {
      const { order, cfg } = this.next;
      this.next = undefined;
      this.request(order, cfg);
    }
  }

  /** @param {import('./api.js').TaughtPose} place @param {number | undefined} cfg @param {boolean} dragged */
  show(place, cfg, dragged) {
    this.place = place;
    const wanted = place.solutions.findIndex((one) => one.cfg === cfg && one.axes);
    const same = place.solutions.findIndex((one, at) => at === this.solution && one.axes);
    const at = wanted >= 0 ? wanted : dragged && same >= 0 ? same : (place.nearest ?? -1);
    this.form.show(place);
    // While dragging, the handle is already at the pointer.
    this.pick(at, !dragged);
  }

  /** Takes one of the configurations. @param {number} at @param {boolean} [handle] whether the handle goes to the TCP */
  pick(at, handle = true) {
    if (!this.place) return;
    this.solution = at;
    if (this.picked?.axes) this.axes = this.picked.axes;
    this.form.offer(this.place, at);
    this.allowSaving();
    this.drawRobot(this.place, handle);
  }

  /** The order that moves the robot to the position of the dragged robot. */
  target() {
    if (this.picked?.axes) return `to ${[...this.axes.slice(0, this.own), ...this.external].join(" ")}`;
    showProblem("Choose a point first, or drag the robot to where it should go.");
    return undefined;
  }

  /** Writes changes, and takes in the new contents. @param {'save' | 'undo'} what @param {object} order */
  async write(what, order) {
    const data = await ask(what, order);
    if (!data) return;
    showProblem("");
    this.take(data);
    this.form.say("Written. It takes effect from the next reset of the program.");
  }

  /** Writes the pose of the dragged robot into the chosen point. */
  teach() {
    const point = this.points.only();
    if (!point || !this.place || !this.picked?.axes) return;
    const { file, type, name, values } = point;
    const external = Object.fromEntries(this.external.map((axis, at) => [`ej${at + 1}`, axis]));
    if (type === "pose") return this.write("save", [moved(point, this.place.components, { cfg: this.picked.cfg, ...external })]);
    const joints = Object.fromEntries(this.axes.slice(0, this.own).map((axis, at) => [`j${at + 1}`, axis]));
    return this.write("save", [{ file, type, name, values: { ...values, ...joints, ...external }, before: values }]);
  }

  /** The chosen poses; none if not all chosen points can be shifted and mirrored. */
  poses() {
    const { chosen } = this.points;
    const poses = this.points.all().filter(isPlainPose);
    if (poses.length > 0 && poses.length === chosen.size) return poses;
    showProblem("Choose poses that are plain numbers: only those can be shifted and mirrored.");
    return [];
  }

  /** @param {number[]} by mm along x, y and z */
  async shift(by) {
    const changes = this.poses().map((pose) => shifted(pose, by));
    if (changes.length > 0) await this.write("save", changes);
  }

  /** @param {number} axis the normal of the plane: 0 for x, 1 for y, 2 for z */
  async mirror(axis) {
    const changes = [];
    for (const pose of this.poses()) {
      const change = await mirrored(pose, axis, this.channel.number, this.near());
      if (!change) return;
      changes.push(change);
    }
    if (changes.length > 0) await this.write("save", changes);
  }

  /** Shows what the robot reaches around its base, in the plane of the pose; or removes the map. */
  async map() {
    const scene = this.page.scene;
    if (this.mapped) {
      this.mapped.remove();
      this.mapped = undefined;
      return;
    }
    if (!scene || !this.place) return showProblem("Choose a point first, or take the pose of the robot.");
    const map = await ask("map", {
      channel: this.channel.number,
      components: this.place.components,
      setting: this.where(),
      near: this.near(),
      ...EXTENT,
    });
    if (map) this.mapped = new ReachMap(scene, map);
  }

  drawPoints() {
    if (this.channel) this.marks?.draw(this.data.points, this.points.chosen, this.channel.number, this.where(), this.near());
  }

  /** Draws the dragged robot and its handle. @param {import('./api.js').TaughtPose} place @param {boolean} handle */
  drawRobot(place, handle) {
    const { scene, run } = this.page;
    if (!scene) return;
    const dragged = (/** @type {number[]} */ placed) => this.request({ placed }, this.picked?.cfg);
    this.robot ??= new DraggedRobot(scene, run, this.channel, this.mode, dragged);
    if (handle) this.robot.hold(place.placed);
    this.robot.show(this.axes, this.where().base, place.placed);
  }

  /** How the TCP is dragged. @param {import('./teach/dragged_robot.js').Mode} mode */
  handle(mode) {
    this.mode = mode;
    if (!this.place) this.fromRobot();
    this.robot?.control.setMode(mode);
  }
}
