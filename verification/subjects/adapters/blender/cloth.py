"""Adapter of Blender's cloth; `scripts/engines blender` prints the command. Settings: README.md.
Blender's unit of time is 1/sqrt(1000) s: it takes a thousandth of the gravity. A step is a frame
of quality 1, as long as `time_scale` says. States come and go through Blender's cache on disk."""
import os
import sys
from pathlib import Path

import bpy
import numpy as np
from mathutils import Vector

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from foldproof_solver import Declined, Scene, Solver, serve  # noqa: E402

UNIT, GAP = 1000**-0.5, 0.001  # s; m, the least that Blender takes, on either side of a contact
FOLDER = os.environ["FOLDPROOF_FOLDER"]
CACHED = f"{FOLDER}/blendcache_cloth/c_%06d_00.bphys"
START, LAST = 2, 100_000  # frames; in frame 1 Blender starts afresh


def set_exactly(settings: object, name: str, value: float) -> None:
    setattr(settings, name, value)
    if not np.isclose(getattr(settings, name), value, rtol=1e-5, atol=0):
        raise Declined(f"{name} {value:.4g}: Blender takes {getattr(settings, name):.4g}")


def bending_stiffness(scene: Scene) -> float:
    """Blender pushes a corner with a third of 100 times stiffness, edge and angle [N]. This gives
    the hinges of the scene their moment, 2 B w angle, on average."""
    rigidity = scene.header["scene"]["material"]["bending_rigidity"]
    if rigidity == 0 or len(scene.hinges) == 0:
        return 0.0
    x1, x2, x3, x4 = (scene.rest[scene.hinges[:, k]] for k in range(4))
    edge = np.linalg.norm(x4 - x3, axis=1)
    n1, n2 = np.cross(x1 - x3, x1 - x4), np.cross(x2 - x4, x2 - x3)
    angles = np.arctan2(np.sum(np.cross(n1, n2) * (x4 - x3), 1) / edge, np.sum(n1 * n2, 1))
    if np.max(np.abs(angles - scene.rest_angles)) > 1e-6:
        raise Declined("rest angles that no rest shape has")
    return float(np.mean(0.06 * rigidity * scene.hinge_weights / np.linalg.norm(n1, axis=1)))


def place_latest_mesh(friction: float, place: np.ndarray, axis: np.ndarray) -> None:
    made = bpy.context.object
    made.location, made.rotation_mode = place, "QUATERNION"
    made.rotation_quaternion = Vector(axis).to_track_quat("Z", "Y")
    made.modifiers.new("collision", "COLLISION")
    made.collision.thickness_outer, made.collision.damping = GAP, 0
    set_exactly(made.collision, "cloth_friction", 100 * friction)


def add_obstacles(header: dict) -> None:
    inset, up, add = float(header["settings"].get("inset", 2 * GAP)), (0, 0, 1), bpy.ops.mesh
    for o in header.get("planes", []):
        add.primitive_plane_add(size=10)
        place_latest_mesh(o["friction"], o["point"] - inset * np.array(o["normal"]), o["normal"])
    for o in header.get("boxes", []):
        add.primitive_cube_add(size=2, scale=np.array(o["half_extents"]) - inset)
        place_latest_mesh(o["friction"], o["centre"], up)
    for o in header.get("spheres", []) + header.get("capsules", []):
        a, b = (np.array(o.get(end, o.get("centre"))) for end in "ab")
        length = np.linalg.norm(b - a)
        add.primitive_uv_sphere_add(segments=128, ring_count=65, radius=o["radius"] - inset)
        for vertex in bpy.context.object.data.vertices:
            vertex.co.z += np.copysign(length / 2, vertex.co.z)
        place_latest_mesh(o["friction"], (a + b) / 2, b - a if length > 0 else up)


class Cloth(Solver):
    name, version, level, precision = "Blender cloth", bpy.app.version_string, "L1", "f4"
    scheme, order = "backward Euler, linearized", 1
    capabilities = ("set_state", "held", "planes", "boxes", "spheres", "capsules", "self_collision")

    def prepare(self, scene: Scene) -> dict[str, str]:
        header = scene.header["scene"]
        material, weigh = header["material"], int(header["settings"].get("weigh", 0))
        if header["own_masses"]:
            raise Declined("unequal masses: Blender's vertices share one")
        if material["stretch_damping"] or material["bending_damping"]:
            raise Declined("damping in proportion to the stiffness of an edge or hinge")
        if material["rest_length_scale"] != 1:
            raise Declined("rest lengths that no rest shape has")
        bpy.ops.wm.read_factory_settings(use_empty=True)
        bpy.ops.wm.save_as_mainfile(filepath=f"{FOLDER}/cloth.blend")  # a cache needs it
        bpy.context.scene.gravity = header["gravity"]
        modifier = self.add_sheet(scene)
        if "--" in sys.argv:
            self.paste(sys.argv[-1], scene)
        else:
            self.set_material(modifier.settings, scene)
        add_obstacles(header)
        contact, thickness = modifier.collision_settings, header.get("thickness", 0)
        contact.use_collision, contact.distance_min = len(bpy.data.objects) > 1, GAP
        contact.use_self_collision, contact.self_friction = thickness > 0, 0
        set_exactly(contact, "self_distance_min", thickness or contact.self_distance_min)
        modifier.point_cache.name, modifier.point_cache.use_disk_cache = "c", True
        modifier.point_cache.frame_end = bpy.context.scene.frame_end = LAST
        self.weight = (np.mean(scene.mass) / scene.mass)[:, None] ** weigh
        self.settings, self.start = modifier.settings, scene.x
        self.x, self.v, self.got = scene.x, scene.v, None  # of these, what Blender knows
        return {
            "mass": "of each vertex: the mean of the scene's", "damping": "none, nor drag",
            "stretch": "mean stiffness of edges [N/m] times their mean length [m] over 1000",
            "bending": "angular: mean of 0.06 B w/(edge * height) of hinges", "friction": "100 mu",
            "contact": f"meshes, smaller by the {2 * GAP} m that Blender keeps the cloth away",
        }

    def add_sheet(self, scene: Scene) -> bpy.types.Modifier:
        mesh = bpy.data.meshes.new("sheet")
        mesh.from_pydata(scene.x.tolist(), [], scene.triangles.tolist())
        sheet = bpy.data.objects.new("sheet", mesh)
        bpy.context.scene.collection.objects.link(sheet)
        sheet.shape_key_add(name="start", from_mix=False)
        key = sheet.shape_key_add(name="rest", from_mix=False)
        key.data.foreach_set("co", scene.rest.astype("<f4").ravel())
        modifier = sheet.modifiers.new("cloth", "CLOTH")
        modifier.settings.rest_shape_key = key
        if len(scene.held):
            sheet.vertex_groups.new(name="held").add(scene.held.tolist(), 1.0, "REPLACE")
            modifier.settings.vertex_group_mass = "held"
        return modifier

    def set_material(self, s: bpy.types.ClothSettings, scene: Scene) -> None:
        s.quality, s.air_damping, s.mass = 1, 0, float(np.mean(scene.mass))
        s.tension_damping = s.compression_damping = s.shear_damping = s.bending_damping = 0
        stiffness = float(np.mean(scene.edge_stiffness) * np.mean(scene.rest_lengths)) / 1000
        set_exactly(s, "tension_stiffness", stiffness)
        s.compression_stiffness, s.bending_model = stiffness, "ANGULAR"
        set_exactly(s, "bending_stiffness", bending_stiffness(scene))

    def paste(self, snippet: str, scene: Scene) -> None:
        """Takes the material from a file of `foldproof material`, which measures the sheet."""
        sheet = bpy.data.objects["sheet"]
        bpy.context.view_layer.objects.active = sheet
        sheet.data.vertices.foreach_set("co", scene.rest.astype("<f4").ravel())
        exec(Path(snippet).read_text(), {})  # noqa: S102 (a file that the user named)
        sheet.data.vertices.foreach_set("co", scene.x.astype("<f4").ravel())
        sheet.modifiers["cloth"].settings.quality = 1

    def tell_state(self, dt: float) -> None:
        """Has Blender cache a frame, writes the state over it, and has Blender read it."""
        self.settings.time_scale = dt / UNIT
        bpy.context.scene.frame_set(1)
        bpy.context.scene.frame_set(START)
        numbers = np.hstack([self.x, np.asarray(self.v) * UNIT, self.start]).astype("<f4")
        file = Path(CACHED % START)
        file.write_bytes(file.read_bytes()[:20] + numbers.tobytes())
        bpy.context.scene.frame_set(START)
        self.frame, self.dt = START, dt

    def advance(self, dt: float, steps: int) -> None:
        for _ in range(steps):
            if self.x is not self.got or dt != self.dt or self.frame == LAST:
                self.tell_state(dt)
            self.frame += 1
            bpy.context.scene.frame_set(self.frame)
            numbers = np.fromfile(CACHED % self.frame, "<f4", offset=20).reshape(-1, 9)
            self.x = self.got = numbers[:, :3]
            self.v = numbers[:, 3:6] / UNIT * self.weight
            os.unlink(CACHED % (self.frame - 1))


serve(Cloth())
