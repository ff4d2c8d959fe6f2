// The cell in three dimensions.

import {
  AmbientLight,
  AxesHelper,
  Box3,
  Color,
  DirectionalLight,
  GridHelper,
  Group,
  HemisphereLight,
  OrbitControls,
  PerspectiveCamera,
  Scene,
  Vector3,
  WebGLRenderer,
} from "./three.js";
import { gradient, theme } from "./colors.js";
import { element } from "./dom.js";
import { Paint, path } from "./path.js";
import { Frames } from "./robot.js";

/** How long a contact is shown, in s. */
const CONTACT_S = 0.5;

/** The names of a body in the scene, by its name in a contact. @param {string} name @returns {string[]} */
function idsOf(name) {
  const of = /^(.*) of channel (\d+)$/.exec(name);
  return [`body/${name}`, of ? `channel_${of[2]}/${of[1]}` : name];
}

export class CellScene {
  /**
   * @param {HTMLElement} holder @param {import('./run.js').Run[]} runs
   * @throws if the browser has no WebGL
   */
  constructor(holder, runs) {
    this.holder = holder;
    this.runs = runs;
    this.renderer = new WebGLRenderer({ antialias: true });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    holder.prepend(this.renderer.domElement);
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(40, 1, 0.01, 200);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.addEventListener("change", () => (this.stale = true));
    this.stale = true;
    /** Counts the frames drawn, for a test of the frame rate. */
    this.drawn = 0;
    const light = new DirectionalLight("#ffffff", 2.2);
    light.position.set(2, -3, 5);
    this.scene.add(light, new HemisphereLight("#ffffff", "#667788", 1.1), new AmbientLight("#ffffff", 0.25));
    this.grid = new Group();
    this.scene.add(this.grid, new AxesHelper(0.3));
    this.frames = runs.map((run, at) => {
      const world = new Group();
      this.scene.add(world);
      return new Frames(run, world, at > 0);
    });
    this.paths = runs.map(() => ({ group: new Group(), of: /** @type {string} */ (""), rows: 0 }));
    this.paths.forEach(({ group }) => this.scene.add(group));
    this.colors();
    new ResizeObserver(() => this.resize()).observe(holder);
    this.resize();
    this.fitted = false;
  }

  /** The colours of the page have changed. */
  colors() {
    this.scene.background = new Color(theme("back"));
    this.grid.clear();
    const grid = new GridHelper(6, 24, theme("quiet"), theme("line"));
    grid.rotateX(Math.PI / 2);
    this.grid.add(grid);
    this.paths?.forEach((path) => (path.of = ""));
    this.stale = true;
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.holder;
    this.renderer.setSize(width, height);
    this.camera.aspect = width / Math.max(height, 1);
    this.camera.updateProjectionMatrix();
    this.stale = true;
  }

  /** Moves the camera so that it sees all robots, bodies and paths. */
  fit() {
    const box = new Box3();
    for (const { all } of this.frames) box.expandByObject(all.get("world") ?? new Group());
    for (const { group } of this.paths) box.expandByObject(group);
    if (box.isEmpty()) box.set(new Vector3(-1, -1, 0), new Vector3(1, 1, 1.5));
    const middle = box.getCenter(new Vector3());
    const radius = Math.max(box.getSize(new Vector3()).length() / 2, 0.2);
    const away = (0.8 * radius) / Math.sin((this.camera.fov * Math.PI) / 360) / Math.min(1, this.camera.aspect);
    this.controls.target.copy(middle);
    this.camera.position.copy(middle).add(new Vector3(0.8, -1, 0.55).normalize().multiplyScalar(away));
    this.controls.update();
    this.stale = true;
  }

  /**
   * Shows a moment.
   * @param {number} time @param {string} mode the meaning of the colour of paths
   */
  show(time, mode) {
    let complete = true;
    this.runs.forEach((run, at) => {
      const now = Math.min(time, run.end);
      const frames = this.frames[at];
      for (const arm of frames.arms) {
        const moment = arm.channel.samples.at(now, run.end);
        if (moment) frames.pose(arm, moment.axes, run.baseAt(arm.channel.number, now), moment.tcp);
        else complete = false;
      }
      frames.show(run.sceneAt(now));
      const near = run.answer.contacts.filter((contact) => now >= contact.time - 1e-9 && now < contact.time + CONTACT_S);
      frames.mark(new Set(near.flatMap((contact) => [...idsOf(contact.one), ...idsOf(contact.other)])), theme("alarm"));
      this.showPath(at, now, mode);
    });
    if (complete && !this.fitted) {
      this.fitted = true;
      this.fit();
    }
    this.stale = true;
  }

  /** @param {number} at @param {number} time @param {string} mode */
  showPath(at, time, mode) {
    const [run, shown] = [this.runs[at], this.paths[at]];
    const pieces = run.robots.map((channel) => ({ channel, rows: channel.samples.piece(time, run.end) }));
    const count = pieces.reduce((sum, { rows }) => sum + (rows?.count ?? 0), 0);
    const of = [mode, run.answer.motions.length, ...pieces.map(({ rows }) => (rows ? `${rows.times[0]}` : ""))].join();
    // A growing path is redrawn only now and then.
    const grown = count - shown.rows;
    if (of === shown.of && (grown === 0 || (run.live && grown < 25 + shown.rows / 50))) return;
    Object.assign(shown, { of, rows: count });
    for (const old of /** @type {import('three').Mesh<import('three').BufferGeometry, import('three').Material>[]} */ ([...shown.group.children])) {
      old.removeFromParent();
      old.geometry.dispose();
      old.material.dispose();
    }
    for (const { channel, rows } of pieces) {
      if (!rows) continue;
      const fastest = rows.speed.reduce((most, speed) => Math.max(most, speed), 0);
      const paint = new Paint(mode, run, channel, fastest);
      const line = path(rows, paint, { opacity: at > 0 ? 0.4 : 1 });
      if (line) shown.group.add(line);
      if (at === 0 && channel === run.robots[0]) this.legend(paint);
    }
  }

  /** @param {Paint} paint */
  legend(paint) {
    const legend = /** @type {HTMLElement} */ (this.holder.querySelector("#legend"));
    const entries = [];
    if (paint.mode === "speed") {
      const bar = element("i", { className: "scale" });
      bar.style.background = gradient;
      entries.push(element("span", {}, bar, `0 to ${paint.fastest.toFixed(0)} mm/s`));
    }
    for (const [name, color] of [...paint.known].slice(0, 12)) {
      const mark = element("i");
      mark.style.background = `rgb(${color.map((part) => part * 255).join(" ")})`;
      entries.push(element("span", {}, mark, name));
    }
    legend.replaceChildren(...entries);
  }

  /** Draws a frame if something has changed. */
  draw() {
    if (!this.stale) return;
    this.stale = false;
    this.drawn++;
    this.renderer.render(this.scene, this.camera);
  }
}
