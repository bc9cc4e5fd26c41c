"""Bending of one hinge of unequal triangles in Newton, without foldproof: its forces must exert no
torque. Each line: the largest torque over the largest force times the edge's length; right: 0.

scripts/engines newton && build/engines/newton/bin/python THIS_FILE
"""
import newton
import numpy as np
import warp as wp

STEP = 1e-3  # s
POINTS = np.array([[0, 0, 0], [0, -1.5, 0], [-0.4, -0.5, 0], [0.4, -0.5, 0]])  # heights .5 and 1 m
BENT = np.array([[0, 0, 0.2], [0, 0, 0], [0, 0, 0], [0, 0, 0]])


def forces(make_solver):
    """Forces [N] of a bent hinge between (0, 2, 3) and (1, 3, 2): mass times dv/dt of a step."""
    builder = newton.ModelBuilder(gravity=(0.0, 0.0, 0.0))
    builder.add_particles(POINTS.tolist(), [(0.0, 0.0, 0.0)] * 4, [1.0] * 4, [0.0] * 4)
    builder.add_edges([0], [1], [2], [3], edge_ke=[1.0], edge_kd=[0.0])
    builder.set_coloring([[0], [1], [2], [3]])
    model = builder.finalize(device="cpu")
    model.particle_grid = None
    before, after = model.state(), model.state()
    for state in (before, after):
        state.particle_q.assign((POINTS + BENT).astype(np.float32))
    make_solver(model).step(before, after, None, None, STEP)
    return after.particle_qd.numpy().astype(float) / STEP


wp.config.quiet = True
print("Newton", newton.__version__)
solvers = newton.solvers
for name, make in (("SemiImplicit", solvers.SolverSemiImplicit), ("XPBD", solvers.SolverXPBD),
                   ("VBD", lambda model: solvers.SolverVBD(model, iterations=50))):
    f = forces(make)
    torque = np.linalg.norm(np.cross(POINTS + BENT, f).sum(axis=0))
    print(f"{name}: {torque / np.abs(f).max() / 0.8:.4f} 0.0000")
