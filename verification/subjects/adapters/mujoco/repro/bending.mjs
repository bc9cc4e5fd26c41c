// Bending of a flex of MuJoCo, without foldproof: its rigidity, and whether a flat sheet rests.
//
// scripts/engines --version 3.14.0 mujoco && cp verification/subjects/adapters/mujoco/repro/bending.mjs \
//   build/engines/mujoco-3.14.0/ && node build/engines/mujoco-3.14.0/bending.mjs
import load from '@mujoco/mujoco';

const mujoco = await load();
const young = 1e5, poisson = 1 / 3, thickness = 5e-3;                   // Pa, 1, m
const plate = young * thickness ** 3 / 12 / (1 - poisson * poisson);    // N m
const height = Math.sqrt(3) / 2;                                        // of a triangle [m]

/// Forces [N], three a point, on points that are displaced by so much [m].
function forces(points, triangles, displaced) {
  const joints = ['1 0 0', '0 1 0', '0 0 1'].map(axis => `<joint type="slide" axis="${axis}"/>`);
  const bodies = points.map((p, i) => `<body name="b${i}" pos="${p.join(' ')}">
    <inertial pos="0 0 0" mass="0.1" diaginertia="1e-9 1e-9 1e-9"/>${joints.join('')}</body>`);
  const model = mujoco.MjModel.from_xml_string(`<mujoco>
    <compiler boundmass="0" boundinertia="0"/><option gravity="0 0 0"/>
    <worldbody>${bodies.join('')}</worldbody>
    <deformable><flex name="sheet" dim="2" radius="1e-4"
      body="${points.map((_, i) => `b${i}`).join(' ')}" element="${triangles.join(' ')}">
      <elasticity young="${young}" poisson="${poisson}" thickness="${thickness}"
        elastic2d="bend"/>
      <contact internal="false" selfcollide="none"/></flex></deformable></mujoco>`);
  const data = new mujoco.MjData(model);
  data.qpos.set(displaced.flat());
  mujoco.mj_forward(model, data);
  const found = Array.from(data.qfrc_passive);
  data.delete(), model.delete();
  return found;
}

console.log(`MuJoCo ${mujoco.mj_versionString()}`);

// Two equilateral triangles that are folded by an angle: an energy of B/2 (L angle)^2/A, with A
// the area of both, gives an endless mesh of them the rigidity B.
const pair = [[0, 0, 0], [1, 0, 0], [0.5, height, 0], [0.5, -height, 0]], angle = 1e-3;
const lifted = [[0, 0, 0], [0, 0, 0], [0, 0, height * angle], [0, 0, 0]];
const moment = -height * forces(pair, [0, 1, 2, 1, 0, 3], lifted)[8];
console.log(`rigidity over E t^3/(12 (1 - nu^2)): ${(moment / angle * height / plate).toFixed(4)}`);

// A flat kite of two right triangles at rest, in two orders of its triangles.
const kite = [[0, 0, 0], [0, height, 0], [0.5, height, 0], [0, 2 * height, 0]];
for (const [order, triangles] of [['lower', [0, 2, 1, 1, 2, 3]], ['upper', [1, 2, 3, 0, 2, 1]]]) {
  const largest = Math.max(...forces(kite, triangles, kite.map(() => [0, 0, 0])).map(Math.abs));
  const share = (largest / plate).toFixed(4);
  console.log(`flat kite at rest, its ${order} triangle first: ${share} B/L`);
}
