// A map of the robot's reach in one plane, with one orientation.

import { CanvasTexture, DoubleSide, Group, Mesh, MeshBasicMaterial, PlaneGeometry } from "../three.js";
import { scale } from "../colors.js";
import { element } from "../dom.js";
import { put } from "../robot.js";

/** The extent of the map around the robot, and the distance between its places, in mm. */
export const EXTENT = { half: 2000, step: 40 };
/** The number of levels in which the server reports the distance from a singular point. */
const LEVELS = 9;

export class ReachMap {
  /** @param {import('../scene.js').CellScene} scene @param {import('../api.js').Mapped} map */
  constructor(scene, map) {
    this.scene = scene;
    const length = (map.side * map.step) / 1000;
    const texture = new CanvasTexture(painted(map));
    this.material = new MeshBasicMaterial({ map: texture, transparent: true, side: DoubleSide, depthWrite: false });
    this.geometry = new PlaneGeometry(length, length);
    const plane = new Mesh(this.geometry, this.material);
    const middle = ((map.side - 1) * map.step) / 2000;
    plane.position.set(middle, middle, 0);
    this.group = new Group();
    put(this.group, map.origin);
    this.group.add(plane);
    scene.scene.add(this.group);
    scene.stale = true;
  }

  remove() {
    this.group.removeFromParent();
    this.material.map?.dispose();
    this.material.dispose();
    this.geometry.dispose();
    this.scene.stale = true;
  }
}

/** Draws a pixel for each place. @param {import('../api.js').Mapped} map */
function painted({ side, places }) {
  const canvas = /** @type {HTMLCanvasElement} */ (element("canvas", { width: side, height: side }));
  const context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
  for (let at = 0; at < places.length; at++) {
    const level = Number(places[at]);
    const [r, g, b] = scale((level - 1) / (LEVELS - 1)).map((part) => part * 255);
    context.fillStyle = level > 0 ? `rgb(${r} ${g} ${b} / 70%)` : "rgb(0 0 0 / 0%)";
    context.fillRect(at % side, side - 1 - Math.floor(at / side), 1, 1);
  }
  return canvas;
}
