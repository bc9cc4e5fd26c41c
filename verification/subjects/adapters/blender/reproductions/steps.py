"""How many steps Blender's cloth takes in a frame of some quality, without foldproof: one triangle
falls from rest for a frame. In n steps of 1/quality of a frame it falls n (n + 1)/2 times gravity
over a thousand and over the square of the quality, by symplectic Euler and backward Euler alike.

blender -b --factory-startup --python verification/subjects/adapters/blender/reproductions/steps.py
"""
import bpy
import numpy as np


def fall(rate, quality):
    """Way in a frame, in a scene of so many frames a second [m]."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.gravity, scene.render.fps = (0, 0, -10), rate
    mesh = bpy.data.meshes.new("mesh")
    mesh.from_pydata([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [], [(0, 1, 2)])
    made = bpy.data.objects.new("sheet", mesh)
    scene.collection.objects.link(made)
    settings = made.modifiers.new("cloth", "CLOTH").settings
    settings.quality, settings.air_damping = quality, 0
    for frame in (1, 2):
        scene.frame_set(frame)
    found = made.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    return -found.vertices[0].co.z


print(f"Blender {bpy.app.version_string}")
for rate in (24, 60):
    print(f"rate {rate} {fall(rate, 1):.6f} m")
for quality in (1, 2, 5, 10, 11, 12, 20, 40, 80):
    sums = fall(24, quality) / 0.01 * quality**2
    print(f"quality {quality} {(np.sqrt(1 + 8 * sums) - 1) / 2:.3f} steps")
