// The points of the program as frames in the cell.

import { AxesHelper, Group, Raycaster, Vector2 } from "../three.js";
import { put } from "../robot.js";
import { ask, componentsOf, isPlainPose, key } from "./server.js";

/** The length at which frames of points are drawn, in m, and the factor for chosen ones. */
const LENGTH_M = 0.07;
const CHOSEN = 1.7;
/** The distance within which a click hits a frame, in m. */
const NEAR_M = 0.02;

export class PointMarks {
  /** @param {import('../scene.js').CellScene} scene */
  constructor(scene) {
    this.scene = scene;
    this.marks = new Group();
  }

  /**
   * Redraws the poses of these points.
   * @param {import('./server.js').Point[]} points @param {Set<string>} chosen
   * @param {number} channel @param {import('./server.js').Setting} setting @param {number[]} near axes in deg (mm)
   */
  async draw(points, chosen, channel, setting, near) {
    this.marks.removeFromParent();
    for (const old of /** @type {AxesHelper[]} */ (this.marks.children)) old.dispose();
    const marks = new Group();
    this.marks = marks;
    this.scene.scene.add(marks);
    for (const point of points.filter(isPlainPose)) {
      const place = await ask("place", { channel, components: componentsOf(point), setting, near });
      // The marks may have been redrawn in the meantime.
      if (!place || this.marks !== marks) return;
      const mark = new AxesHelper(chosen.has(key(point)) ? LENGTH_M * CHOSEN : LENGTH_M);
      mark.userData.name = key(point);
      put(mark, place.placed);
      marks.add(mark);
    }
    this.scene.stale = true;
  }

  /** The name of the clicked point. @param {MouseEvent} event @returns {string | undefined} */
  at(event) {
    const { renderer, camera } = this.scene;
    const { left, top, width, height } = renderer.domElement.getBoundingClientRect();
    const at = new Vector2(((event.clientX - left) / width) * 2 - 1, 1 - ((event.clientY - top) / height) * 2);
    const ray = new Raycaster();
    ray.params.Line.threshold = NEAR_M;
    ray.setFromCamera(at, camera);
    return ray.intersectObjects(this.marks.children)[0]?.object.userData.name;
  }
}
