// The frames of robots, and the bodies fixed to them.

import {
  AxesHelper,
  BoxGeometry,
  Color,
  CylinderGeometry,
  DoubleSide,
  Group,
  Mesh,
  MeshStandardMaterial,
  Object3D,
  Quaternion,
  STLLoader,
  SphereGeometry,
  Vector3,
} from "./three.js";

/** The length at which frames are drawn, in m. */
const AXES_M = 0.12;
/** The placeholder of a tool: its radius in m, its colour. */
const TOOL_M = 0.008;
const TOOL = [0.7, 0.72, 0.75, 1];
/** The colour of another run, which is drawn transparent. */
const GHOST = new Color("#4da3e0");

/** @typedef {ReturnType<Frames['arm']>} Arm */

/** The frames of a run: those of its robots, and the world. */
export class Frames {
  /**
   * @param {import("./run.js").Run} run @param {Group} world @param {boolean} ghost
   * @param {import('./run.js').Channel[]} [channels] the channels whose robots are meant, if not all
   */
  constructor(run, world, ghost, channels = run.robots) {
    this.run = run;
    this.world = world;
    this.ghost = ghost;
    /** @type {Map<string, Object3D>} */
    this.all = new Map([["world", world]]);
    this.arms = channels.map((channel) => this.arm(channel));
    /** @type {Map<string, {of: import('./api.js').Entity, group: Group}>} */
    this.entities = new Map();
    /** @type {Map<string, {form: string, group: Group}>} the last drawing of each body, and the description it was made from */
    this.drawn = new Map();
    /** @type {Map<number, import('three').BufferGeometry>} the triangles fetched so far */
    this.meshes = new Map();
  }

  /** @param {import('./run.js').Channel} channel */
  arm(channel) {
    /** @param {string} name @param {Object3D} parent */
    const frame = (name, parent) => {
      const made = new Group();
      parent.add(made);
      this.all.set(name, made);
      return made;
    };
    const base = frame(channel.links[0].parent, this.world);
    /** @param {import('./api.js').PageLink} link @param {Object3D} parent @param {number} moves the index of the axis that moves it */
    const joint = (link, parent, moves) => {
      const [x, y, z, ...turned] = link.origin;
      const made = frame(link.frame, parent);
      const rest = new Quaternion(...turned);
      const place = new Vector3(x, y, z).divideScalar(1000);
      made.position.copy(place);
      made.quaternion.copy(rest);
      const axis = link.axis.length === 3 ? new Vector3(...link.axis).normalize() : undefined;
      return { made, rest, place, axis, linear: link.linear, moves };
    };
    const links = channel.links.map((link, at) =>
      joint(link, this.all.get(link.parent) ?? base, at),
    );
    const carriers = (channel.carriers ?? []).map((carrier) => {
      const moves = channel.axes.findIndex((axis) => axis.name === carrier.moved_by);
      return joint(carrier, this.all.get(carrier.parent) ?? this.world, moves);
    });
    const tcp = frame(channel.tcp, this.world);
    if (!this.ghost) tcp.add(new AxesHelper(AXES_M));
    // It is known that there is something between the flange and the TCP, but not what.
    const tool = new Mesh(new CylinderGeometry(TOOL_M, TOOL_M, 1, 12).rotateX(Math.PI / 2), this.material(TOOL));
    this.world.add(tool);
    return { channel, base, links, carriers, tcp, tool };
  }

  /**
   * Moves a robot to its position.
   * @param {Arm} arm @param {number[]} axes in deg (mm) @param {number[]} base @param {number[]} tcp
   */
  pose(arm, axes, base, tcp) {
    put(arm.base, base);
    put(arm.tcp, tcp);
    for (const link of [...arm.links, ...arm.carriers]) {
      if (!link.axis) continue;
      const value = axes[link.moves] ?? 0;
      if (link.linear) {
        const displacement = link.axis
          .clone()
          .applyQuaternion(link.rest)
          .multiplyScalar(value / 1000);
        link.made.position.copy(link.place).add(displacement);
      } else {
        const turned = new Quaternion().setFromAxisAngle(link.axis, (value * Math.PI) / 180);
        link.made.quaternion.copy(link.rest).multiply(turned);
      }
    }
    this.world.updateMatrixWorld(true);
    const from = (arm.links.at(-1)?.made ?? arm.base).getWorldPosition(new Vector3());
    const along = arm.tcp.position.clone().sub(from);
    const length = along.length();
    arm.tool.visible = length > 1e-3;
    arm.tool.position.copy(from).addScaledVector(along, 0.5);
    arm.tool.scale.z = length;
    if (arm.tool.visible) arm.tool.quaternion.setFromUnitVectors(new Vector3(0, 0, 1), along.divideScalar(length));
  }

  /**
   * Shows the bodies that exist, and no others. A body that reappears unchanged uses its earlier drawing.
   * @param {Map<string, import('./api.js').Entity>} there
   */
  show(there) {
    for (const [id, { of, group }] of this.entities) {
      if (there.get(id) === of) continue;
      group.removeFromParent();
      this.entities.delete(id);
    }
    for (const [id, of] of there) {
      const parent = this.all.get(of.frame);
      if (this.entities.has(id) || !parent) continue;
      const form = JSON.stringify(of);
      let drawn = this.drawn.get(id);
      if (drawn?.form !== form) {
        drawn = { form, group: new Group() };
        this.fill(drawn.group, of);
        this.drawn.set(id, drawn);
      }
      parent.add(drawn.group);
      this.entities.set(id, { of, group: drawn.group });
    }
  }

  /** @param {Group} group @param {import('./api.js').Entity} entity */
  fill(group, entity) {
    /** @param {import('three').BufferGeometry} geometry @param {import('./api.js').PageSolid | import('./api.js').PageModel} one */
    const add = (geometry, one) => {
      const [x, y, z, ...turned] = one.pose;
      const mesh = new Mesh(geometry, this.material(one.color));
      mesh.position.set(x, y, z);
      mesh.quaternion.set(.../** @type {[number, number, number, number]} */ (turned));
      group.add(mesh);
      return mesh;
    };
    for (const one of entity.cubes) add(new BoxGeometry(...one.size), one);
    for (const one of entity.spheres) add(new SphereGeometry(one.size[0] / 2, 28, 18), one);
    for (const one of entity.cylinders) {
      const [width, , length] = one.size;
      add(new CylinderGeometry(width / 2, width / 2, length, 36).rotateX(Math.PI / 2), one);
    }
    for (const one of entity.models) {
      /** @param {import('three').BufferGeometry} geometry */
      const addMesh = (geometry) => {
        const mesh = add(geometry, one);
        mesh.material.side = DoubleSide;
        mesh.scale.set(.../** @type {[number, number, number]} */ (one.scale));
      };
      if (one.model === null) continue;
      const known = this.meshes.get(one.model);
      if (known) {
        addMesh(known);
        continue;
      }
      this.mesh(one.model)
        .then((geometry) => {
          addMesh(geometry);
          this.run.changed();
        })
        .catch((problem) => console.warn(`${entity.id} cannot be drawn: ${problem}`));
    }
  }

  /** The triangles of a mesh of the recording. @param {number} model */
  async mesh(model) {
    const answer = await fetch(`${this.run.address}/model/${model}`);
    const geometry = new STLLoader().parse(await answer.arrayBuffer());
    // Normals in files are unreliable, and so is which side of a triangle is the outside.
    geometry.computeVertexNormals();
    this.meshes.set(model, geometry);
    return geometry;
  }

  /** @param {number[]} color */
  material([r, g, b, a]) {
    if (this.ghost) return new MeshStandardMaterial({ color: GHOST, transparent: true, opacity: 0.28, depthWrite: false });
    const color = new Color().setRGB(r, g, b, "srgb");
    return new MeshStandardMaterial({ color, roughness: 0.55, metalness: 0.1, transparent: a < 1, opacity: a });
  }

  /** Highlights bodies. @param {Set<string>} ids @param {string} color */
  mark(ids, color) {
    for (const [id, { group }] of this.entities) {
      // Links of the same name have their number behind the name.
      const marked = ids.has(id) || (!id.startsWith("body/") && ids.has(id.replace(/\/\d+$/, "")));
      if (group.userData.marked === marked) continue;
      group.userData.marked = marked;
      for (const mesh of /** @type {Mesh<import('three').BufferGeometry, MeshStandardMaterial>[]} */ (group.children)) {
        mesh.material.emissive.set(marked ? color : "#000000");
        mesh.material.emissiveIntensity = marked ? 0.8 : 0;
      }
    }
  }
}

/** @param {Object3D} object @param {number[]} placed x, y, z in mm, and a quaternion */
export function put(object, [x, y, z, i, j, k, w]) {
  object.position.set(x / 1000, y / 1000, z / 1000);
  object.quaternion.set(i, j, k, w);
}
