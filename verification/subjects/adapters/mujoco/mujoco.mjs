// Adapter of the flexible bodies of MuJoCo 3; `scripts/engines --version 3.14.0 mujoco` installs it.
// Settings: integrator = Euler, RK4 or discrete; poisson = ratio (1/3); thickness [m] (1e-3);
// solref, solimp = of contacts ("1e-4 1", which MuJoCo raises to two steps; "0.5 0.5 0.001").
import load from '@mujoco/mujoco';
import { Declined, Solver, serve } from '../foldproof_solver.mjs';

const mujoco = await load();
const orders = { Euler: 1, RK4: 4, discrete: 1 };
const vector = (x, i) => Array.from(x.slice(3 * i, 3 * i + 3)).join(' ');

/// The obstacles; their friction and softness hold against any flex. At rest a particle is about
/// g (2 dt)^2 (1 - d) deep, d the impedance: with d = 0.5 more than the g dt^2 of a free step, so that
/// it does not chatter.
function geoms({ planes = [], boxes = [], spheres = [], capsules = [], settings }) {
  const { solref = '1e-4 1', solimp = '0.5 0.5 0.001' } = settings;
  const geom = (friction, attributes) =>
    `<geom friction="${friction} 0 0" priority="1" solref="${solref}" solimp="${solimp}" ` +
    Object.entries(attributes).map(([name, value]) => `${name}="${[value].flat().join(' ')}"`)
      .join(' ') + '/>';
  return [
    ...planes.map(o =>
      geom(o.friction, { type: 'plane', pos: o.point, zaxis: o.normal, size: [0, 0, 1] })),
    ...boxes.map(o => geom(o.friction, { type: 'box', pos: o.centre, size: o.half_extents })),
    ...spheres.map(o => geom(o.friction, { type: 'sphere', pos: o.centre, size: o.radius })),
    ...capsules.map(o =>
      geom(o.friction, { type: 'capsule', fromto: [...o.a, ...o.b], size: o.radius })),
  ].join('');
}

class Flex extends Solver {
  name = 'MuJoCo flex'; version = mujoco.mj_versionString(); level = 'L2';
  scheme = 'Euler, Runge-Kutta or discrete'; order = 1;
  capabilities = [
    'set_state', 'held', 'masses', 'damping', 'planes', 'boxes', 'spheres', 'capsules'];

  prepare(scene) {
    const { material, gravity, settings } = scene.header;
    if (material.bending_rigidity > 0) throw new Declined('bending: not mapped yet');
    if (material.rest_length_scale !== 1) throw new Declined('rest lengths that no rest shape has');
    const integrator = settings.integrator ?? 'Euler', poisson = Number(settings.poisson ?? 1 / 3);
    if (!(integrator in orders)) throw new Error(`unknown integrator ${integrator}`);
    const thickness = Number(settings.thickness ?? 1e-3), young = material.young / thickness;
    this.scene = scene;
    this.moves = Array.from(scene.mass, (_, i) => !scene.held.includes(i));
    const joints = 'xyz'.split('').map((_, c) =>
      `<joint type="slide" axis="${[0, 1, 2].map(k => Number(k === c)).join(' ')}"/>`).join('');
    const bodies = Array.from(scene.mass, (mass, i) =>
      `<body name="b${i}" pos="${vector(scene.rest, i)}">
         <inertial pos="0 0 0" mass="${mass}" diaginertia="1e-9 1e-9 1e-9"/>
         ${this.moves[i] ? joints : ''}</body>`).join('');
    const obstacles = geoms(scene.header), meets = Number(obstacles.length > 0);
    this.model?.delete(), this.data?.delete();
    this.model = mujoco.MjModel.from_xml_string(`<mujoco>
      <compiler boundmass="0" boundinertia="0"/>
      <option integrator="${integrator}" gravity="${gravity.join(' ')}" cone="elliptic">
        ${meets ? '' : '<flag contact="disable" constraint="disable"/>'}</option>
      <worldbody>${obstacles}${bodies}</worldbody>
      <deformable><flex name="sheet" dim="2" radius="1e-4"
        body="${this.moves.map((_, i) => `b${i}`).join(' ')}"
        element="${scene.triangles.join(' ')}">
        <elasticity young="${young}" poisson="${poisson}" thickness="${thickness}"
          damping="${material.stretch_damping / material.young}" elastic2d="stretch"/>
        <contact internal="false" selfcollide="none" contype="${meets}" conaffinity="${meets}"/>
      </flex></deformable></mujoco>`);
    // the flex has taken its rest shape from where the bodies were; body 0 is the world
    for (const i of scene.held)
      for (let c = 0; c < 3; ++c) this.model.body_pos[3 * (i + 1) + c] = scene.x[3 * i + c];
    this.data = new mujoco.MjData(this.model);
    this.set_state(scene.x, scene.v);
    return {
      stretch: `elastic triangles, not springs: ${thickness} m thick, Young's modulus ` +
        `${young} Pa, Poisson's ratio ${poisson.toFixed(3)}; springs of edges are ignored`,
      damping: 'of the stiffness matrix [s]', step: integrator,
      contact: 'of triangles, soft: solref and solimp; elliptic friction cones',
    };
  }

  /// Numbers of the particles that move, as MuJoCo orders them; and back.
  free(numbers) { return numbers.filter((_, i) => this.moves[Math.floor(i / 3)]); }
  spread(numbers, otherwise) {
    let at = 0;
    return otherwise.map((n, i) => this.moves[Math.floor(i / 3)] ? numbers[at++] : n);
  }

  set_state(x, v) {
    this.x = Float64Array.from(x);
    this.v = Float64Array.from(v);
    mujoco.mj_resetData(this.model, this.data);
    this.data.qpos.set(this.free(this.x.map((p, i) => p - this.scene.rest[i])));
    this.data.qvel.set(this.free(this.v));
  }

  advance(dt, steps) {
    this.model.opt.timestep = dt;
    for (let k = 0; k < steps; ++k) mujoco.mj_step(this.model, this.data);
    this.require_no_warning();
    const { rest, x } = this.scene, moved = this.spread(this.data.qpos, x.map(() => 0));
    this.x = x.map((p, i) => this.moves[Math.floor(i / 3)] ? rest[i] + moved[i] : p);
    this.v = this.spread(this.data.qvel, x.map(() => 0));
  }

  /// MuJoCo resets an unstable motion to its start, and goes on.
  require_no_warning() {
    for (let kind = 0; kind < this.data.warning.size(); ++kind) {
      const { number, lastinfo } = this.data.warning.get(kind);
      if (number > 0) throw new Error(mujoco.mju_warningText(kind, lastinfo));
    }
  }

  forces() {
    mujoco.mj_forward(this.model, this.data);
    const { qfrc_passive, qfrc_bias } = this.data;
    return this.spread(qfrc_passive.map((f, i) => f - qfrc_bias[i]), this.scene.x.map(() => 0));
  }

  damping() { throw new Declined('damping forces: not told apart from the elastic ones'); }

  energy() { throw new Declined("the energy: MuJoCo's leaves out the elastic one of flexes"); }
}

serve(new Flex());
