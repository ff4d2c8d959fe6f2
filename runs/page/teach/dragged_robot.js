// A second, transparent robot in the cell, which is dragged by its TCP.

import { Group, Object3D, TransformControls } from "../three.js";
import { Frames, put } from "../robot.js";

/** @typedef {"translate" | "rotate"} Mode */

export class DraggedRobot {
  /**
   * @param {import('../scene.js').CellScene} scene @param {import('../run.js').Run} run @param {import('../run.js').Channel} channel
   * @param {Mode} mode @param {(placed: number[]) => void} dragged the place that the TCP is dragged to: x, y, z in mm, and a quaternion
   */
  constructor(scene, run, channel, mode, dragged) {
    this.scene = scene;
    this.moved = dragged;
    this.frames = new Frames(run, new Group(), true, [channel]);
    this.frames.show(new Map([...run.sceneAt(0)].filter(([id]) => !id.startsWith("body/"))));
    this.handle = new Object3D();
    this.control = new TransformControls(scene.camera, scene.renderer.domElement);
    this.control.setSize(0.8);
    this.control.setSpace("local");
    this.control.setMode(mode);
    this.control.attach(this.handle);
    this.control.addEventListener("dragging-changed", (event) => (scene.controls.enabled = !event.value));
    this.control.addEventListener("change", () => (scene.stale = true));
    this.control.addEventListener("objectChange", () => this.dragged());
    scene.scene.add(this.frames.world, this.handle, this.control.getHelper());
  }

  /** Moves the robot. @param {number[]} axes in deg (mm) @param {number[]} base @param {number[]} tcp */
  show(axes, base, tcp) {
    this.frames.pose(this.frames.arms[0], axes, base, tcp);
    this.scene.stale = true;
  }

  /** Moves the handle. @param {number[]} tcp */
  hold(tcp) {
    put(this.handle, tcp);
  }

  dragged() {
    const { position, quaternion } = this.handle;
    this.moved([...position.toArray().map((value) => value * 1000), ...quaternion.toArray()]);
  }

  remove() {
    for (const part of [this.frames.world, this.handle, this.control.getHelper()]) part.removeFromParent();
    this.control.dispose();
    this.scene.stale = true;
  }
}
