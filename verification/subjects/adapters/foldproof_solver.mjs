// The solver's side of the protocol (PROTOCOL.md) for node: derive from Solver, then call serve().
//
//   class Mine extends Solver {
//     name = 'mine'; version = '1.0'; scheme = 'symplectic Euler'; order = 1;
//     prepare(scene) { ... return { stretch: 'springs' }; }  // the mapping in words
//     advance(dt, steps) { ... }                             // moves this.x, this.v: 3 N numbers
//   }
//   serve(new Mine());
import fs from 'node:fs';

const types = { f8: Float64Array, f4: Float32Array, i4: Int32Array };

/// Thrown for what the solver does not offer; the message is the reason that the report prints.
export class Declined extends Error {}

/// What an adapter overrides. x [m], v [m/s], forces [N]: x, y, z of each particle; energies in J.
/// A scene has its arrays by name (triangles, rest, ...), and `header`, the rest.
export class Solver {
  name = 'unnamed'; version = '0'; level = 'L1'; precision = 'f8'; scheme = 'unnamed'; order = 1;
  capabilities = ['set_state', 'held', 'masses'];
  solve_tolerance = 0;  // relative residual of linear systems; 0 where none is solved
  more = {};            // further fields of the declaration, as { contact_offset: .001 }
  tunables = {};        // as { iterations: { kind: 'iterations', range: [1, 99], value: 5 } }
  /// The value of a tunable in a scene.
  tuned(scene, name) { return scene.header.tunables?.[name] ?? this.tunables[name].value; }
  prepare() { throw new Declined('scenes'); }
  advance() { throw new Declined('steps'); }
  set_state(x, v) { this.x = x; this.v = v; }
  forces() { throw new Declined('forces'); }
  damping() { throw new Declined('damping forces'); }
  /// Of the obstacles, the mean over the last advance.
  contact_forces() { throw new Declined('contact forces'); }
  energy() { throw new Declined('energy'); }
  /// To be called after each step of a long advance, with the part that is done, 0 to 1: says at
  /// most once a second that the solver is at work, so that it is not taken to hang.
  progress(part) { this.tell?.(part); }
}

/// The interval that holds a time, and the part of it that has passed; at rest outside.
function between(times, time) {
  let k = 0;
  while (k + 2 < times.length && times[k + 1] <= time) ++k;
  const part = (time - times[k]) / (times[k + 1] - times[k]);
  return times.length < 2 ? [0, 0] : [k, Math.min(Math.max(part, 0), 1)];
}

/// Row k of so many numbers each, mixed with the next one.
function mixed(rows, wide, [k, part]) {
  const row = Array.from(rows.subarray(k * wide, (k + 1) * wide));
  return part === 0 ? row : row.map((value, i) => value + part * (rows[(k + 1) * wide + i] - value));
}

/// Where the held particles are at a time [s]: 3 H numbers [m]; those that stay, too.
export function held_at(scene, time) {
  const { held, held_times, held_x, x } = scene;
  if (held_times) return mixed(held_x, 3 * held.length, between(held_times, time));
  return Array.from(held).flatMap(i => Array.from(x.subarray(3 * i, 3 * i + 3)));
}

/// An obstacle at a time [s]: the quaternion w, x, y, z, and the translation [m].
export function pose_at(scene, { motion }, time) {
  if (motion === undefined) return { turn: [1, 0, 0, 0], translation: [0, 0, 0] };
  const poses = scene[`motion_${motion}_poses`];
  const [k, part] = between(scene[`motion_${motion}_times`], time);
  const one = mixed(poses, 7, [k, 0]), other = part === 0 ? one : mixed(poses, 7, [k + 1, 0]);
  const translation = mixed(poses, 7, [k, part]).slice(0, 3);
  const cosine = one.slice(3).reduce((sum, q, i) => sum + q * other[3 + i], 0);
  const sign = cosine < 0 ? -1 : 1, angle = Math.acos(Math.min(sign * cosine, 1));
  if (angle < 1e-9) return { turn: one.slice(3), translation };
  const a = Math.sin((1 - part) * angle) / Math.sin(angle);
  const b = sign * Math.sin(part * angle) / Math.sin(angle);
  return { turn: one.slice(3).map((q, i) => a * q + b * other[3 + i]), translation };
}

function read(count, descriptor, bytes = Buffer.alloc(count)) {
  for (let at = 0; at < count;) {
    const more = fs.readSync(descriptor, bytes, at, count - at, null);
    if (more === 0) return null;
    at += more;
  }
  return bytes;
}

let unread = Buffer.alloc(0);  // read with a header, and beyond its end

function take(count, descriptor) {
  const first = unread.subarray(0, count);
  unread = unread.subarray(first.length);
  const rest = read(count - first.length, descriptor);
  return rest && Buffer.concat([first, rest]);
}

/// A header with its arrays; null at the end of the pipe.
function receive(descriptor) {
  let end;
  while ((end = unread.indexOf(10)) < 0) {
    const more = Buffer.alloc(65536), count = fs.readSync(descriptor, more, 0, more.length, null);
    if (count === 0) return null;
    unread = Buffer.concat([unread, more.subarray(0, count)]);
  }
  const header = JSON.parse(take(end + 1, descriptor).toString()), arrays = {};
  for (const { name, type, shape } of header.arrays ?? []) {
    const count = shape.reduce((product, extent) => product * extent, 1);
    const bytes = take(count * types[type].BYTES_PER_ELEMENT, descriptor);
    const aligned = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length);
    arrays[name] = new types[type](aligned);
  }
  return { header, arrays };
}

function send(descriptor, header, arrays = {}) {
  const listed = Object.entries(arrays).map(([name, { data, shape }]) =>
    ({ name, type: data instanceof Float32Array ? 'f4' : 'f8', shape }));
  const parts = [Buffer.from(JSON.stringify({ ...header, arrays: listed }) + '\n')];
  for (const { data } of Object.values(arrays))
    parts.push(Buffer.from(data.buffer, data.byteOffset, data.byteLength));
  const bytes = Buffer.concat(parts);
  for (let at = 0; at < bytes.length;) at += fs.writeSync(descriptor, bytes, at);
}

const vectors = (solver, data) =>
  ({ data: types[solver.precision].from(data), shape: [data.length / 3, 3] });
const state = solver => [{}, { x: vectors(solver, solver.x), v: vectors(solver, solver.v) }];

function run(solver, header, scene) {
  solver.prepare(scene);
  const frames = { x: [], v: [] };
  let done = 0;
  for (const steps of header.frames) {
    solver.advance(header.scene.dt, steps - done);
    done = steps;
    for (const name of ['x', 'v']) frames[name].push(...solver[name]);
  }
  const shape = [header.frames.length, solver.x.length / 3, 3];
  const all = name => ({ data: types[solver.precision].from(frames[name]), shape });
  return [{}, { x: all('x'), v: all('v') }];
}

/// Fields and arrays of the answer.
function answer(solver, header, arrays) {
  const { op, dt } = header, scene = { header: header.scene, ...arrays };
  if (op === 'start') {
    const { name, version, level, precision, capabilities, solve_tolerance } = solver;
    const scheme = { name: solver.scheme, order: solver.order }, protocol = 2;
    return [{ protocol, name, version, level, precision, scheme, capabilities, solve_tolerance,
      tunables: solver.tunables, ...solver.more }];
  }
  if (op === 'prepare') return [{ mapping: solver.prepare(scene) ?? {} }];
  if (op === 'run') return run(solver, header, scene);
  if (op === 'advance') solver.advance(dt, header.steps);
  if (op === 'advance' || op === 'get_state') return state(solver);
  if (arrays.x) solver.set_state(arrays.x, arrays.v, header.time ?? 0);
  if (op === 'step') { solver.advance(dt, 1); return state(solver); }
  if (['forces', 'damping', 'contact_forces'].includes(op))
    return [{}, { f: vectors(solver, solver[op]()) }];
  if (op === 'energy') return [{ energy: solver.energy() }];
  throw new Declined(`operation '${op}'`);
}

/// Answers until 'stop' or the end of the pipe. An exception is told, and the next call answered.
export function serve(solver) {
  const source = Number(process.env.FOLDPROOF_IN), sink = Number(process.env.FOLDPROOF_OUT);
  for (let message; (message = receive(source));) {
    const { header, arrays } = message, id = header.id;
    if (header.op === 'stop') return send(sink, { id });
    let told = performance.now();  // ms
    solver.tell = part => {
      if (performance.now() - told < 1000) return;
      told = performance.now();
      send(sink, { id, progress: Math.min(Math.max(part, 0), 1) });
    };
    try {
      const [fields, sent] = answer(solver, header, arrays);
      send(sink, { id, ...fields }, sent);
    } catch (error) {
      if (error instanceof Declined) { send(sink, { id, declined: error.message }); continue; }
      console.error(error);
      send(sink, { id, error: String(error) });
    }
  }
}
