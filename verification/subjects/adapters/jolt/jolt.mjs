// Adapter of Jolt's soft bodies; `scripts/engines jolt` installs them.
// Settings: iterations = substeps of each step (5); compliance_scale = of all edges and hinges (1).
import fs from 'node:fs';
import path from 'node:path';
import initialize from 'jolt-physics';
import { Solver, serve } from '../foldproof_solver.mjs';

const Jolt = await initialize();
const about = new URL('node_modules/jolt-physics/package.json', import.meta.url);
// An argument: the file of `foldproof material` that builds the sheet.
const snippet = process.argv[2] && await import(path.resolve(process.argv[2]));
const { version } = JSON.parse(fs.readFileSync(about));

class SoftBody extends Solver {
  name = 'Jolt soft body'; version = version; precision = 'f4';
  scheme = 'position based, with compliance'; order = 0; obstacles = [];
  capabilities = ['set_state', 'held', 'masses', 'planes', 'boxes', 'spheres', 'capsules'];

  // Jolt calls the substeps of a step its iterations
  tunables = { iterations: { kind: 'substeps', range: [1, 10000], value: 5, proportional: true } };

  constructor() {
    super();
    const settings = new Jolt.JoltSettings();
    settings.mMaxWorkerThreads = 1;
    const pairs = new Jolt.ObjectLayerPairFilterTable(1);
    pairs.EnableCollision(0, 0);
    const layers = new Jolt.BroadPhaseLayerInterfaceTable(1, 1);
    layers.MapObjectToBroadPhaseLayer(0, new Jolt.BroadPhaseLayer(0));
    settings.mObjectLayerPairFilter = pairs;
    settings.mBroadPhaseLayerInterface = layers;
    settings.mObjectVsBroadPhaseLayerFilter =
      new Jolt.ObjectVsBroadPhaseLayerFilterTable(layers, 1, pairs, 1);
    this.jolt = new Jolt.JoltInterface(settings);
    this.system = this.jolt.GetPhysicsSystem();
    this.bodies = this.system.GetBodyInterface();
  }

  /// The scene's sheet.
  mapped(scene, scale) {
    const sheet = this.sheet(scene, scale), rigidity = scene.header.material.bending_rigidity;
    if (rigidity > 0) this.add_hinges(sheet, scene, scale / (2 * rigidity));
    sheet.Optimize();
    return sheet;
  }

  prepare(scene) {
    this.remove();
    const { gravity, settings } = scene.header;
    const { iterations = this.tuned(scene, 'iterations'), compliance_scale: scale = 1 } = settings;
    this.system.SetGravity(new Jolt.Vec3(...gravity));
    const sheet = snippet?.add_fabric(Jolt, Array.from(scene.rest), Array.from(scene.triangles))
      ?? this.mapped(scene, scale);
    const origin = new Jolt.RVec3(0, 0, 0), unturned = Jolt.Quat.prototype.sIdentity();
    const creation = new Jolt.SoftBodyCreationSettings(sheet, origin, unturned, 0);
    Object.assign(creation, {
      mNumIterations: Number(iterations), mLinearDamping: 0, mMaxLinearVelocity: 1e6, mPressure: 0,
      mFriction: 1, mUpdatePosition: false, mMakeRotationIdentity: false, mAllowSleeping: false,
    });
    this.place_obstacles(scene.header);
    this.body = this.bodies.CreateSoftBody(creation);
    this.bodies.AddBody(this.body.GetID(), Jolt.EActivation_Activate);
    this.motion = Jolt.castObject(this.body.GetMotionProperties(), Jolt.SoftBodyMotionProperties);
    this.set_state(scene.x, scene.v);
    return {
      stretch: `each edge's compliance is ${scale} over its stiffness [m/N]`,
      bending: `each hinge's compliance is ${scale} over 2 B w [1/J]`,
      damping: 'none but that of the method', step: `${iterations} substeps`,
      contact: 'friction mu^2, mean of it and 1: mu',
    };
  }

  place_obstacles({ planes = [], boxes = [], spheres = [], capsules = [] }) {
    const unturned = Jolt.Quat.prototype.sIdentity();
    const add = (shape, place, friction, turn = unturned) => {
      const creation = new Jolt.BodyCreationSettings(
        shape, new Jolt.RVec3(...place), turn, Jolt.EMotionType_Static, 0);
      creation.mFriction = friction ** 2;  // Jolt takes the geometric mean of two bodies
      const obstacle = this.bodies.CreateBody(creation);
      this.bodies.AddBody(obstacle.GetID(), Jolt.EActivation_DontActivate);
      this.obstacles.push(obstacle);
    };
    for (const { point, normal, friction } of planes) {
      const plane = new Jolt.Plane(new Jolt.Vec3(...normal), 0);
      add(new Jolt.PlaneShapeSettings(plane).Create().Get(), point, friction);
    }
    for (const { centre, half_extents, friction } of boxes)
      add(new Jolt.BoxShape(new Jolt.Vec3(...half_extents), 0), centre, friction);
    for (const { centre, radius, friction } of spheres)
      add(new Jolt.SphereShape(radius), centre, friction);
    for (const { a, b, radius, friction } of capsules) {  // Jolt's are along y
      const axis = new Jolt.Vec3(...a.map((_, c) => (b[c] - a[c]) / 2));
      const turn = Jolt.Quat.prototype.sFromTo(new Jolt.Vec3(0, 1, 0), axis.Normalized());
      const middle = a.map((_, c) => (a[c] + b[c]) / 2);
      add(new Jolt.CapsuleShape(axis.Length(), radius), middle, friction, turn);
    }
  }

  /// Particles, faces and edges of the scene.
  sheet(scene, scale) {
    const { x, mass, held, triangles, edges, edge_stiffness, rest_lengths } = scene;
    const sheet = new Jolt.SoftBodySharedSettings();
    const particle = new Jolt.SoftBodySharedSettingsVertex();
    for (let i = 0; i < mass.length; ++i) {
      const p = particle.mPosition;
      [p.x, p.y, p.z] = x.slice(3 * i, 3 * i + 3);
      particle.mInvMass = held.includes(i) ? 0 : 1 / mass[i];
      sheet.mVertices.push_back(particle);
    }
    for (let t = 0; t < triangles.length; t += 3)
      sheet.AddFace(new Jolt.SoftBodySharedSettingsFace(...triangles.slice(t, t + 3), 0));
    for (let e = 0; e < rest_lengths.length; ++e) {
      const [a, b] = edges.slice(2 * e, 2 * e + 2), compliance = scale / edge_stiffness[e];
      const edge = new Jolt.SoftBodySharedSettingsEdge(a, b, compliance);
      edge.mRestLength = rest_lengths[e];
      sheet.mEdgeConstraints.push_back(edge);
    }
    return sheet;
  }

  /// They store angle^2 / (2 compliance), the scene's B w angle^2, and count angles the other way.
  add_hinges(sheet, { hinges, hinge_weights, rest_angles }, compliance) {
    for (let h = 0; h < rest_angles.length; ++h) {
      const [c, d, a, b] = hinges.slice(4 * h, 4 * h + 4);
      const hinge = new Jolt.SoftBodySharedSettingsDihedralBend(a, b, d, c, 0);
      hinge.mCompliance = compliance / hinge_weights[h];
      hinge.mInitialAngle = rest_angles[h];
      sheet.mDihedralBendConstraints.push_back(hinge);
    }
  }

  remove() {
    for (const body of this.body ? [this.body, ...this.obstacles] : []) {
      this.bodies.RemoveBody(body.GetID());
      this.bodies.DestroyBody(body.GetID());
    }
    this.body = null, this.obstacles = [];
  }

  set_state(x, v) {
    this.x = Float32Array.from(x);
    this.v = Float32Array.from(v);
    for (let i = 0; i < x.length / 3; ++i) {
      const particle = this.motion.GetVertex(i);
      particle.mPosition.Set(...x.slice(3 * i, 3 * i + 3));
      particle.mPreviousPosition = particle.mPosition;
      particle.mVelocity.Set(...v.slice(3 * i, 3 * i + 3));
    }
  }

  advance(dt, steps) {
    for (let k = 0; k < steps; ++k) this.jolt.Step(dt, 1);
    for (let i = 0; i < this.x.length / 3; ++i) {
      const particle = this.motion.GetVertex(i);
      const p = particle.mPosition, u = particle.mVelocity;
      this.x.set([p.GetX(), p.GetY(), p.GetZ()], 3 * i);
      this.v.set([u.GetX(), u.GetY(), u.GetZ()], 3 * i);
    }
  }
}

serve(new SoftBody());
