"""What Blender's unitless settings mean, without foldproof: a square stretched on four meshes, a
hinge of three sizes, a hinge of unequal triangles, and the momentum of a sheet that is let go.

blender -b --factory-startup --python verification/subjects/adapters/blender/reproductions/moduli.py
"""
import tempfile
from pathlib import Path

import bpy
import numpy as np

MASS = 1.0  # kg, of each vertex
DT = 1e-3  # s; k dt^2/m is 1e-3 at most, so that the implicit step takes as little off a force


def sheet(start, rest, faces, **settings):
    """A scene with a cloth of that start and rest shape. No damping, no gravity."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.gravity = (0, 0, 0)
    mesh = bpy.data.meshes.new("mesh")
    mesh.from_pydata(np.asarray(start).tolist(), [], faces)
    made = bpy.data.objects.new("sheet", mesh)
    bpy.context.scene.collection.objects.link(made)
    made.shape_key_add(name="start", from_mix=False)
    key = made.shape_key_add(name="rest", from_mix=False)
    key.data.foreach_set("co", np.ravel(rest))
    s = made.modifiers.new("cloth", "CLOTH").settings
    s.rest_shape_key, s.quality, s.mass, s.air_damping = key, 1, MASS, 0
    s.tension_damping = s.compression_damping = s.shear_damping = s.bending_damping = 0
    s.tension_stiffness = s.compression_stiffness = s.bending_stiffness = 0
    s.time_scale = DT * 1000**0.5
    for name, value in settings.items():
        setattr(s, name, value)
    return made


def way(made, start, steps):
    for frame in range(1, steps + 2):
        bpy.context.scene.frame_set(frame)
    found = made.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    x = np.empty(3 * len(start))
    found.vertices.foreach_get("co", x)
    return x.reshape(-1, 3) - np.float32(start)


def forces(made, start):
    """From the way of one step from rest, too short to change the shape [N]."""
    return MASS * way(made, start, 1) / DT**2


def triangles(cells):
    """A square of a metre on a side in the plane z = 0."""
    n = cells + 1
    points = np.array([[i / cells, j / cells, 0] for j in range(n) for i in range(n)])
    at = [j * n + i for j in range(cells) for i in range(cells)]
    return points, [f for a in at for f in ([a, a + 1, a + n + 1], [a, a + n + 1, a + n])]


def stretched(cells, tension):
    """Force on the side x = 0 of a square that is stretched along x, over the strain [N/m]."""
    rest, faces = triangles(cells)
    start = rest * [1.1, 1, 1]
    found = forces(sheet(start, rest, faces, tension_stiffness=tension,
                         compression_stiffness=tension), start)
    return found[rest[:, 0] == 0, 0].sum() / 0.1


def bent(scale, bending, share=1.0):
    """Two triangles, one of a share of the other's height, bent at their edge: force on the first's
    corner, and torque of all forces, over the angle [N/rad], [N m/rad]."""
    high, angle = 3**0.5 / 2, 0.1
    rest = scale * np.array([[0, 0, 0], [0, 1, 0], [high, 0.5, 0], [-share * high, 0.5, 0]])
    start = rest.copy()
    start[2] = scale * np.array([high * np.cos(angle), 0.5, high * np.sin(angle)])
    found = forces(sheet(start, rest, [[0, 1, 3], [0, 2, 1]], bending_stiffness=bending), start)
    torque = np.cross(start, found).sum(axis=0)
    return np.linalg.norm(found[3]) / angle, np.linalg.norm(torque) / angle


def mean_ways():
    """Of a sheet that is let go with an uneven strain, over the mean length of the ways: each
    vertex alike, and each weighed by the third of the area around it that a density gives it."""
    rest, faces = triangles(6)
    start = rest * [1.04, 1.06, 1] + 0.02 * np.sin(7 * rest[:, [1, 2, 0]] + rest[:, [2, 0, 1]])
    moved = way(sheet(start, rest, faces, tension_stiffness=15, compression_stiffness=15),
                start, 20)
    share = np.bincount(np.ravel(faces), minlength=len(rest)) / (3 * len(faces))
    length = np.mean(np.linalg.norm(moved, axis=1))
    return np.linalg.norm(moved.mean(0)) / length, np.linalg.norm(share @ moved) / length


print(f"Blender {bpy.app.version_string}")
print("square of 1 m, tension stiffness 0.15: cells, force over strain [N/m], mean edge [m]")
for cells in (1, 2, 4, 8):
    rest, faces = triangles(cells)
    ends = {tuple(sorted((f[k], f[k - 1]))) for f in faces for k in range(3)}
    edge = np.mean([np.linalg.norm(rest[a] - rest[b]) for a, b in ends])
    print(f"stretched {cells} {stretched(cells, 0.15):.0f} {edge:.4f}")
print("two triangles, bending stiffness 50: edge [m], force on a corner [N/rad]")
for scale in (0.5, 1, 2):
    print(f"bent {scale} {bent(scale, 50)[0]:.1f}")
print("the same of 1 m, the second lower: its height over the first's, torque of all [N m/rad]")
for share in (1, 0.5, 0.25):
    print(f"torque {share} {bent(1, 50, share)[1]:.0f}")
print("mean way of a sheet that is let go: of vertices, by the area around them")
print("way {:.1e} {:.1e}".format(*mean_ways()))
