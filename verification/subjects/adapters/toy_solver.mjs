// A mass-spring solver as an example: springs along the edges, symplectic Euler.
//
// foldproof judge --solver "node verification/subjects/adapters/toy_solver.mjs"
import { Declined, Solver, serve } from './foldproof_solver.mjs';

class ToySolver extends Solver {
  name = 'toy springs (JavaScript)'; version = '1.0'; level = 'L2';
  scheme = 'symplectic Euler'; order = 1;

  prepare(scene) {
    if (scene.header.material.bending_rigidity > 0) throw new Declined('bending');
    this.scene = scene;
    this.x = scene.x.slice();
    this.v = scene.v.slice();
    return { stretch: "a spring per edge, of the edge's own stiffness [N/m]", damping: 'none' };
  }

  forces() {
    const { mass, edges, edge_stiffness, rest_lengths, header } = this.scene, x = this.x;
    const f = x.map((_, i) => mass[Math.floor(i / 3)] * header.gravity[i % 3]);
    for (let e = 0; e < edge_stiffness.length; ++e) {
      const a = 3 * edges[2 * e], b = 3 * edges[2 * e + 1];
      const d = [0, 1, 2].map(c => x[b + c] - x[a + c]), length = Math.hypot(...d);
      const pull = edge_stiffness[e] * (length - rest_lengths[e]) / length;
      for (let c = 0; c < 3; ++c) f[a + c] += pull * d[c], f[b + c] -= pull * d[c];
    }
    return f;
  }

  energy() {
    const { mass, edges, edge_stiffness, rest_lengths, header } = this.scene, x = this.x;
    let sum = 0;
    for (let e = 0; e < edge_stiffness.length; ++e) {
      const a = 3 * edges[2 * e], b = 3 * edges[2 * e + 1];
      const length = Math.hypot(...[0, 1, 2].map(c => x[b + c] - x[a + c]));
      sum += edge_stiffness[e] * (length - rest_lengths[e]) ** 2 / 2;
    }
    return x.reduce((all, p, i) => all - mass[Math.floor(i / 3)] * header.gravity[i % 3] * p, sum);
  }

  damping() { return this.x.map(() => 0); }

  advance(dt, steps) {
    for (let k = 0; k < steps; ++k) {
      const f = this.forces();
      this.v = this.v.map((u, i) => u + dt * f[i] / this.scene.mass[Math.floor(i / 3)]);
      for (const i of this.scene.held) this.v.fill(0, 3 * i, 3 * i + 3);
      this.x = this.x.map((p, i) => p + dt * this.v[i]);
    }
  }
}

serve(new ToySolver());
