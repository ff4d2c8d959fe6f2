// Robots by their URDF, and parts that they take along, in the browser.

import assert from "node:assert/strict";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { record, serve, skip, visit } from "./support.js";

const PROGRAM = `func void main()
  movej j:{0,-70,100,0,60,0}, vp:100%
  waittime 0.1
  setdo(1, true)
  waittime 0.1
  movej j:{60,-70,100,0,60,0}, vp:100%
  waittime 0.1
  setdo(1, false)
  waittime 0.1
  movej j:{0,-70,100,0,60,0}, vp:100%
endfunc
`;
/** The joints of the KR 10 R1420: place and axis. */
const JOINTS = [
  ["0 0 0.450", "0 0 -1"],
  ["0.150 0 0", "0 1 0"],
  ["0.610 0 0", "0 1 0"],
  ["0 0 0.02", "-1 0 0"],
  ["0.660 0 0", "0 1 0"],
  ["0.080 0 0", "-1 0 0"],
];
const joint = ([place, axis], at) =>
  `<joint name="joint_${at + 1}" type="revolute"><origin xyz="${place}"/><parent link="link_${at}"/><child link="link_${at + 1}"/>` +
  `<axis xyz="${axis}"/><limit lower="-3" upper="3" effort="1" velocity="4"/></joint>`;
const MESH = `<visual><geometry><mesh filename="arm.stl"/></geometry><material name="white"><color rgba="0.9 0.9 0.9 1"/></material></visual>`;
const LINKS = [0, 1, 2, 3, 4, 5, 6].map((at) => `<link name="link_${at}">${at === 2 ? MESH : ""}</link>`);
const URDF = `<robot name="arm">${LINKS.join("")}${JOINTS.map(joint).join("")}</robot>`;
/** A tetrahedron as long as the upper arm, in m. */
const CORNERS = ["0 -0.1 -0.1", "0 0.1 -0.1", "0 0 0.1", "0.6 0 0"];
const FACES = [
  [0, 2, 1],
  [0, 1, 3],
  [1, 2, 3],
  [2, 0, 3],
];
const face = (corners) => `facet normal 0 0 0\nouter loop\n${corners.map((at) => `vertex ${CORNERS[at]}\n`).join("")}endloop\nendfacet\n`;
const STL = `solid arm\n${FACES.map(face).join("")}endsolid arm\n`;
// The flange is at 803.4, 0, 583.4 when it takes the part.
const CELL = `urdf = "arm.urdf"
[[body]]
name = "part"
box = [60, 60, 40]
at = [803, 0, 500]
gripped_by = "do.1"
within = 200
`;

const path = mkdtempSync(join(tmpdir(), "arl2rs-view-"));
const files = { "cell.toml": CELL, "arm.urdf": URDF, "arm.stl": STL };
before(() => skip || record(path, "a", PROGRAM, { files, options: ["--cell", "cell.toml"] }));
after(() => rmSync(path, { recursive: true, force: true }));

test("a part goes along with the robot, whose shape is that of its URDF", { skip }, async (test) => {
  const { url } = await serve(test, path, "a.mcap");
  const { page, problems } = await visit(test, url);
  const part = () =>
    page.evaluate(() => {
      const { of, group } = window.page.scene.frames[0].entities.get("body/part");
      const [mesh] = group.children;
      return { frame: of.frame, at: mesh.getWorldPosition(mesh.position.clone()).toArray() };
    });
  const at = async (time) => {
    await page.evaluate((time) => window.page.seek(time), time);
    // Two pictures later it is shown.
    await page.evaluate(() => new Promise((next) => requestAnimationFrame(() => requestAnimationFrame(next))));
    return part();
  };
  const end = await page.evaluate(() => window.page.end);
  const before = await at(0);
  const after = await at(end);
  assert.deepEqual([before.frame, after.frame], ["world", "world"]);
  assert.ok(Math.hypot(before.at[0] - 0.803, before.at[1], before.at[2] - 0.5) < 1e-6, `${before.at}`);
  // Axis 1 turned by 60 degrees with it, the other way round than the world's.
  const turned = [0.803 * Math.cos(Math.PI / 3), -0.803 * Math.sin(Math.PI / 3), 0.5];
  assert.ok(Math.hypot(...turned.map((value, axis) => value - after.at[axis])) < 1e-3, `${after.at} and ${turned}`);
  const middle = await page.evaluate(() => {
    const { motions } = window.page.run.answer;
    const [, second] = motions;
    return second.start + second.duration / 2;
  });
  assert.equal((await at(middle)).frame, "flange");
  const arm = await page.evaluate(() => {
    const { group, of } = window.page.scene.frames[0].entities.get("the upper arm");
    const sides = group.children[0].geometry.attributes.position.count;
    return { frame: of.frame, sides, meshes: group.children.length };
  });
  assert.deepEqual(arm, { frame: "link_2", sides: 12, meshes: 1 });
  assert.deepEqual(problems, []);
});
