"""Style3D of Newton without foldproof: a damper that no parameter asks for, and forces of one
triangle, which must exert no torque. Each line: measured, right.

scripts/engines newton && build/engines/newton/bin/python THIS_FILE
"""
import newton
import numpy as np
import warp as wp

POINTS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0.0]])
Style3D = newton.solvers.SolverStyle3D


def moved(x, v, steps, dt, stiffness):
    """Velocities [m/s] after some steps without gravity."""
    builder = newton.ModelBuilder(gravity=(0.0, 0.0, 0.0))
    Style3D.register_custom_attributes(builder)
    builder.add_particles(POINTS.tolist(), [(0.0, 0.0, 0.0)] * 4, [1.0] * 4, [0.0] * 4)
    builder.add_triangles([0], [1], [2], custom_attributes={
        "style3d:tri_aniso_ke": [(stiffness, stiffness, stiffness / 2)]})
    builder.add_edges([0], [-1], [1], [2], edge_ke=[0.0])
    model = builder.finalize(device="cpu")
    solver = Style3D(model, config=Style3D.Config(iterations=10))
    solver.collision = None
    states = model.state(), model.state()
    for state in states:
        state.particle_q.assign(x.astype(np.float32))
        state.particle_qd.assign(v.astype(np.float32))
    for _ in range(steps):
        solver.step(*states, None, None, dt)
        states = states[::-1]
    return states[0].particle_qd.numpy().astype(float)


wp.config.quiet = True
drift = np.tile([1.0, 0.0, 0.0], (4, 1))
for dt in (1e-2, 1e-3):
    steps = round(0.2 / dt)
    print(f"speed after 0.2 s of free drift in steps of {dt} s: "
          f"{moved(POINTS, drift, steps, dt, 10.0)[0, 0]:.4f} 1.0000")
# stretched by 30 % along x and sheared
x = POINTS @ np.array([[1.3, 0, 0], [0.3, 1, 0], [0, 0, 1]])
f = moved(x, 0 * x, 1, 1e-3, 10.0)[:3] / 1e-3
torque = np.linalg.norm(np.cross(x[:3], f).sum(axis=0)) / np.abs(f).max()
print(f"torque of a sheared triangle, over its largest force times 1 m: {torque:.4f} 0.0000")
