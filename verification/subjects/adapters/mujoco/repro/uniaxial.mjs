// Stretches a square flex of MuJoCo along x, without foldproof, and compares its forces with plane
// stress: E t/(1 - nu^2) along x, nu times that across, for a strain of 1e-4.
//
// scripts/engines --version 3.14.0 mujoco && cp verification/subjects/adapters/mujoco/repro/uniaxial.mjs \
//   build/engines/mujoco-3.14.0/ && node build/engines/mujoco-3.14.0/uniaxial.mjs
import load from '@mujoco/mujoco';

const mujoco = await load();
const strain = 1e-4, modulus = 5, thickness = 1e-3;  // modulus: E t [N/m]
console.log(`MuJoCo ${mujoco.mj_versionString()}`);
console.log('cells  nu    along x: measured, plane stress   across: measured, plane stress [N/m]');

for (const cells of [1, 8]) for (const nu of [0, 0.25, 0.4]) {
  const points = [], triangles = [], n = cells + 1;
  for (let j = 0; j < n; ++j) for (let i = 0; i < n; ++i) points.push([i / cells, j / cells, 0]);
  for (let j = 0; j < cells; ++j) for (let i = 0; i < cells; ++i) {
    const a = j * n + i;
    triangles.push(a, a + 1, a + n + 1, a, a + n + 1, a + n);
  }
  const joints = ['1 0 0', '0 1 0', '0 0 1'].map(axis => `<joint type="slide" axis="${axis}"/>`);
  const bodies = points.map((p, i) => `<body name="b${i}" pos="${p.join(' ')}">
    <inertial pos="0 0 0" mass="0.1" diaginertia="1e-9 1e-9 1e-9"/>${joints.join('')}</body>`);
  const model = mujoco.MjModel.from_xml_string(`<mujoco>
    <compiler boundmass="0" boundinertia="0"/>
    <option integrator="Euler" gravity="0 0 0"/>
    <worldbody>${bodies.join('')}</worldbody>
    <deformable><flex name="sheet" dim="2" radius="1e-4"
      body="${points.map((_, i) => `b${i}`).join(' ')}" element="${triangles.join(' ')}">
      <elasticity young="${modulus / thickness}" poisson="${nu}" thickness="${thickness}"
        elastic2d="stretch"/>
      <contact internal="false" selfcollide="none"/></flex></deformable></mujoco>`);
  const data = new mujoco.MjData(model);
  data.qpos.set(points.flatMap(p => [strain * p[0], 0, 0]));
  mujoco.mj_forward(model, data);
  let along = 0, across = 0;  // N, on the sides x = 0 and y = 0, each 1 m long
  points.forEach((p, i) => {
    if (p[0] === 0) along += data.qfrc_passive[3 * i] / strain;
    if (p[1] === 0) across += data.qfrc_passive[3 * i + 1] / strain;
  });
  const stress = modulus / (1 - nu * nu);
  const row = [along, stress, across, nu * stress].map(value => value.toFixed(3).padStart(9));
  console.log(`${String(cells).padStart(5)}  ${nu.toFixed(2)} ${row.join(' ')}`);
}
