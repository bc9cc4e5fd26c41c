"""A flex of MuJoCo without foldproof: its modulus, its rigidity, and whether a flat sheet
rests. Each line: measured, right.

scripts/engines mujoco && build/engines/mujoco/bin/python THIS_FILE
"""
import mujoco
import numpy as np

YOUNG, NU, THICKNESS, HEIGHT = 1e5, 0.25, 5e-3, np.sqrt(3) / 2  # Pa, 1, m, of a triangle [m]
PLATE = YOUNG * THICKNESS**3 / 12 / (1 - NU**2)  # N m


def forces(points, triangles, moved, elastic):
    """Forces [N] on the points, moved by so much [m] from where they rest."""
    bodies = "".join(
        f'<body name="b{i}" pos="{p[0]} {p[1]} {p[2]}"><inertial pos="0 0 0" mass="1" '
        'diaginertia="1e-9 1e-9 1e-9"/>' + "".join(
            f'<joint type="slide" axis="{axis}"/>' for axis in ("1 0 0", "0 1 0", "0 0 1")) +
        "</body>" for i, p in enumerate(points))
    model = mujoco.MjModel.from_xml_string(f"""<mujoco>
      <compiler boundmass="0" boundinertia="0"/><option gravity="0 0 0"/>
      <worldbody>{bodies}</worldbody><deformable><flex name="sheet" dim="2" radius="1e-4"
        body="{" ".join(f"b{i}" for i in range(len(points)))}"
        element="{" ".join(map(str, np.ravel(triangles)))}">
        <elasticity young="{YOUNG}" poisson="{NU}" thickness="{THICKNESS}" elastic2d="{elastic}"/>
        <contact selfcollide="none"/></flex></deformable></mujoco>""")
    data = mujoco.MjData(model)
    data.qpos[:] = np.ravel(moved)
    mujoco.mj_forward(model, data)
    return data.qfrc_passive.reshape(-1, 3).copy()


print("MuJoCo", mujoco.__version__)

square = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0.0]])
pull = forces(square, [[0, 1, 3], [0, 3, 2]], square * [1e-5, 0, 0], "stretch")
along = abs(pull[square[:, 0] == 0, 0].sum()) / 1e-5 / (YOUNG * THICKNESS)
across = abs(pull[square[:, 1] == 0, 1].sum()) / 1e-5 / (YOUNG * THICKNESS)
print(f"modulus along a stretch, over E t: {along:.4f} {1 / (1 - NU**2):.4f}")
print(f"modulus across a stretch, over E t: {across:.4f} {NU / (1 - NU**2):.4f}")

# an energy of B (L angle)^2/(2 A), A the area of both triangles, gives an endless mesh rigidity B
pair = np.array([[0, 0, 0], [1, 0, 0], [0.5, HEIGHT, 0], [0.5, -HEIGHT, 0]])
lifted = np.zeros((4, 3))
lifted[2, 2] = 1e-3 * HEIGHT
moment = -HEIGHT * forces(pair, [[0, 1, 2], [1, 0, 3]], lifted, "bend")[2, 2]
print(f"rigidity, over E t^3/(12 (1 - nu^2)): {moment / 1e-3 * HEIGHT / PLATE:.4f} 1.0000")

kite = np.array([[0, 0, 0], [0, HEIGHT, 0], [0.5, HEIGHT, 0], [0, 2 * HEIGHT, 0]])
for order, triangles in (("lower", [[0, 2, 1], [1, 2, 3]]), ("upper", [[1, 2, 3], [0, 2, 1]])):
    largest = np.abs(forces(kite, triangles, np.zeros((4, 3)), "bend")).max() / PLATE
    print(f"force on a flat kite at rest, {order} triangle first, over B/L: {largest:.4f} 0.0000")

curved = pair + [[0, 0, 0], [0, 0, 0], [0, 0, 0.2], [0, 0, 0]]
largest = np.abs(forces(curved, [[0, 1, 2], [1, 0, 3]], np.zeros((4, 3)), "bend")).max() / PLATE
print(f"force on a hinge that is curved at rest, over B/L: {largest:.4f} 0.0000")
