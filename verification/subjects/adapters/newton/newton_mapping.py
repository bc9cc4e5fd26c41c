"""What the numbers of a scene become in Newton's solvers, and what those numbers mean, measured.

Energies as the sources of Newton 1.8.0 have them; L, h, A of a hinge: its edge's length, height
and area of a triangle (mean of two), theta its angle from rest, w = L^2/(4 A):

    wanted         B w theta^2, so that the far corner feels 2 B w theta/h
    VBD            ke L theta^2/2                    vbd/particle_vbd_kernels.py
    XPBD           far corner feels ke L theta       xpbd/kernels.py: gradients lack 1/(2 A)
    SemiImplicit   far corner feels ke L^2 theta     semi_implicit/kernels_particle.py: likewise
    Style3D        3 ke L^2/(4 A) (2 sin(theta/2))^2 style3d/kernels.py: about flat alone
"""
from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any, Iterator

import newton
import numpy as np
from foldproof_solver import Declined, Scene

USUAL = {
    "vbd": {"iterations": 20, "substeps": 1, "contact": 10.0},
    "xpbd": {"iterations": 10, "substeps": 1, "contact": 1.0},
    "semi_implicit": {"iterations": 1, "substeps": 10, "contact": 0.1},
    "style3d": {"iterations": 10, "substeps": 1, "contact": 10.0},
}
GEOMETRIC = ("vbd", "style3d")  # mean of the friction of particle and shape; else arithmetic


def require_mapped(scene: Scene, options: argparse.Namespace) -> None:
    """Declines what the solver cannot be given."""
    material = scene.header["scene"]["material"]
    if material.get("bending_damping", 0) > 0:
        raise Declined("bending damping: not mapped")
    if material["stretch_damping"] > 0 and options.stretch == "triangles":
        raise Declined("damping in proportion to the stiffness: triangles have one viscosity")
    if material["bending_rigidity"] > 0 and options.solver == "style3d" \
            and np.abs(scene.rest_angles).max(initial=0) > 1e-9:
        raise Declined("rest angles: Style3D bends about a flat hinge")
    if options.mapping == "defaults" and (scene.header["scene"].get("own_masses")
                                          or material["rest_length_scale"] != 1):
        raise Declined("own masses, or rest lengths of no rest shape: the helpers take none")


def build(scene: Scene, options: argparse.Namespace) -> tuple[newton.Model, dict[str, str]]:
    """The model at its rest shape, and the mapping in words."""
    header = scene.header["scene"]
    builder = newton.ModelBuilder(gravity=tuple(map(float, header["gravity"])))
    if options.solver == "style3d":
        newton.solvers.SolverStyle3D.register_custom_attributes(builder)
    add = add_as_helpers if options.mapping == "defaults" else add_cloth
    if options.snippet:
        add = add_as_snippet
    mapping = add(builder, scene, options)
    frictions = add_obstacles(builder, header, options)
    if options.solver == "vbd":
        builder.set_coloring(coloring(scene))
    model = builder.finalize(device=options.device)
    model.soft_contact_mu = frictions
    if options.mapping == "fair":
        model.particle_grid = None  # XPBD's refuses particles without radius
        model.contact_mass = float(scene.mass.min())
        mapping["contact"] = (f"penalties of {options.contact:g} least masses/substep^2"
                              if options.solver != "xpbd" else "positions; relaxation 0.9")
    return model, mapping


def add_cloth(builder: newton.ModelBuilder, scene: Scene,
              options: argparse.Namespace) -> dict[str, str]:
    material = scene.header["scene"]["material"]
    moves = np.ones(len(scene.mass), bool)
    moves[scene.held] = False
    rest = scene.rest * (material["rest_length_scale"] if options.stretch == "triangles" else 1)
    builder.add_particles(rest.tolist(), np.zeros_like(rest).tolist(),
                          np.where(moves, scene.mass, 0).tolist(), [0.0] * len(rest),
                          [int(newton.ParticleFlags.ACTIVE) * int(m) for m in moves])
    stretch = add_springs if options.stretch == "springs" else add_triangles
    mapping = {"stretch": stretch(builder, scene, options)}
    mapping["bending"] = add_hinges(builder, scene, options)
    return mapping


def add_springs(builder: newton.ModelBuilder, scene: Scene, options: argparse.Namespace) -> str:
    material = scene.header["scene"]["material"]
    share = material["stretch_damping"] / material["young"]
    for (i, j), k in zip(scene.edges.tolist(), scene.edge_stiffness, strict=True):
        builder.add_spring(i, j, float(k), float(share * k), 0.0)
    builder.spring_rest_length[:] = scene.rest_lengths.tolist()
    i, j, k = scene.triangles.T
    none = [0.0] * len(i)
    builder.add_triangles(i, j, k, tri_ke=none, tri_ka=none, tri_kd=none, tri_drag=none,
                          tri_lift=none)
    return "a spring per edge, of the edge's own stiffness, rest length and damper"


def add_triangles(builder: newton.ModelBuilder, scene: Scene, options: argparse.Namespace) -> str:
    young = scene.header["scene"]["material"]["young"]
    i, j, k = scene.triangles.T
    none = [0.0] * len(i)
    if options.solver == "style3d":
        axes = {"style3d:tri_aniso_ke": [(young, young, young / 2)] * len(i)}
        builder.add_triangles(i, j, k, tri_ke=none, tri_ka=none, tri_kd=none, tri_drag=none,
                              tri_lift=none, custom_attributes=axes)
        return f"triangles of Baraff and Witkin: {young} N/m along both axes, half of it in shear"
    nu = options.poisson
    mu, la = young / (2 * (1 + nu)), young * nu / (1 - nu * nu)
    # SemiImplicit's tri_ka is lambda + mu, VBD adds the mu itself
    ka = la + mu if options.solver == "semi_implicit" else la
    builder.add_triangles(i, j, k, tri_ke=[mu] * len(i), tri_ka=[ka] * len(i), tri_kd=none,
                          tri_drag=none, tri_lift=none)
    return f"neo-Hookean triangles: Young's modulus {young} N/m, Poisson's ratio {nu:.3f}"


def add_hinges(builder: newton.ModelBuilder, scene: Scene, options: argparse.Namespace) -> str:
    b = scene.header["scene"]["material"]["bending_rigidity"]
    hinges, w = scene.hinges, scene.hinge_weights
    rest = np.asarray(builder.particle_q)
    length = np.linalg.norm(rest[hinges[:, 3]] - rest[hinges[:, 2]], axis=1)
    area = length**2 / (4 * w)  # mean of two [m^2]
    ke = {"vbd": 2 * b * w / length, "xpbd": b * w / area, "semi_implicit": b * w / area / length,
          "style3d": np.full(len(w), b / 3)}[options.solver]
    border = border_edges(scene)
    i, j, k, l = np.concatenate([hinges, border]).T
    zeros = np.zeros(len(border))
    attributes = style3d_edges(rest, hinges, len(border)) if options.solver == "style3d" else None
    if b > 0 or options.solver in GEOMETRIC:  # whose self-contact needs edges
        builder.add_edges(i, j, k, l, rest=np.concatenate([scene.rest_angles, zeros]).tolist(),
                          edge_ke=np.concatenate([ke, zeros]).tolist(),
                          edge_kd=[0.0] * len(i), custom_attributes=attributes)
    return "per hinge, so that it stores B w angle^2" if b > 0 else "none"


def border_edges(scene: Scene) -> np.ndarray:
    """Edges of one triangle: its far corner, -1, and the ends, (K, 4)."""
    inner = {frozenset(pair) for pair in scene.hinges[:, 2:].tolist()}
    rows = [(c, -1, a, b) for t in scene.triangles.tolist()
            for a, b, c in (t, t[1:] + t[:1], t[2:] + t[:2]) if frozenset((a, b)) not in inner]
    return np.array(rows, int).reshape(-1, 4)


def style3d_edges(rest: np.ndarray, hinges: np.ndarray, border: int) -> dict[str, list]:
    """Areas and cotangents at the ends of the edge, as style3d/cloth.py orders them."""
    x1, x2, x3, x4 = (rest[hinges[:, c]] for c in range(4))

    def cot(a: np.ndarray, b: np.ndarray, c: np.ndarray) -> np.ndarray:
        return np.sum((b - a) * (c - a), axis=1) / np.linalg.norm(np.cross(b - a, c - a), axis=1)

    area = sum(np.linalg.norm(np.cross(x4 - x3, far - x3), axis=1) for far in (x1, x2)) / 2
    cots = np.stack([cot(x3, x4, x1), cot(x3, x4, x2), cot(x4, x3, x1), cot(x4, x3, x2)], axis=1)
    return {"style3d:edge_rest_area": area.tolist() + [1.0] * border,
            "style3d:edge_bending_cot": cots.tolist() + [(0.0, ) * 4] * border}


def coloring(scene: Scene) -> list[np.ndarray]:
    """Groups of particles such that no spring, triangle or hinge joins two of one group."""
    neighbours: list[set[int]] = [set() for _ in scene.mass]
    for element in (*scene.edges.tolist(), *scene.triangles.tolist(), *scene.hinges.tolist()):
        for i in element:
            neighbours[i].update(element)
    colors: list[int] = []
    for i, near in enumerate(neighbours):
        taken = {colors[j] for j in near if j < i}
        colors.append(next(c for c in range(len(near) + 1) if c not in taken))
    return [np.flatnonzero(np.array(colors) == c) for c in range(max(colors) + 1)]


def add_obstacles(builder: newton.ModelBuilder, header: dict[str, Any],
                  options: argparse.Namespace) -> float:
    """Adds planes, boxes, spheres and capsules; returns the friction that particles must have."""
    obstacles = [(kind, o) for kind in ("planes", "boxes", "spheres", "capsules")
                 for o in header.get(kind, [])]
    mus = [o["friction"] for _, o in obstacles] or [0.0]
    geometric = options.solver in GEOMETRIC
    own = max(mus) if geometric else min(mus)
    for kind, o in obstacles:
        mu = o["friction"]
        shape = newton.ModelBuilder.ShapeConfig()
        if options.mapping == "fair":
            shape.mu = (mu * mu / own if own > 0 else 0.0) if geometric else 2 * mu - own
            shape.margin = 0.0
        else:
            shape.mu = mu
        add_obstacle(builder, kind, o, shape)
    return own


def add_obstacle(builder: newton.ModelBuilder, kind: str, o: dict[str, Any],
                 shape: newton.ModelBuilder.ShapeConfig) -> None:
    import warp as wp
    if kind == "planes":
        n, p = np.array(o["normal"], float), np.array(o["point"], float)
        builder.add_shape_plane(plane=(*map(float, n), float(-n @ p)), width=0.0, length=0.0,
                                cfg=shape)
    elif kind == "boxes":
        hx, hy, hz = map(float, o["half_extents"])
        builder.add_shape_box(-1, xform=wp.transform(wp.vec3(*o["centre"]), wp.quat_identity()),
                              hx=hx, hy=hy, hz=hz, cfg=shape)
    elif kind == "spheres":
        builder.add_shape_sphere(-1, xform=wp.transform(wp.vec3(*o["centre"]),
                                                        wp.quat_identity()),
                                 radius=float(o["radius"]), cfg=shape)
    else:
        a, b = np.array(o["a"], float), np.array(o["b"], float)
        along = wp.quat_between_vectors(wp.vec3(0.0, 0.0, 1.0),
                                        wp.vec3(*(b - a) / np.linalg.norm(b - a)))
        builder.add_shape_capsule(-1, xform=wp.transform(wp.vec3(*(a + b) / 2), along),
                                  radius=float(o["radius"]),
                                  half_height=float(np.linalg.norm(b - a) / 2), cfg=shape)


def set_contact_stiffness(model: newton.Model, options: argparse.Namespace, dt: float) -> None:
    """Contacts are springs, except XPBD's: stiff enough that cloth at rest is g substep^2/contact
    deep, damped and rubbed as an explicit step bears."""
    if options.mapping == "defaults" or model.shape_count == 0:
        return
    step = dt / options.substeps
    ke = options.contact * model.contact_mass / step**2
    implicit = options.solver in GEOMETRIC
    kd = 0.0 if implicit else 0.3 * model.contact_mass / step
    kf = 0.5 * model.contact_mass / step
    model.soft_contact_ke, model.soft_contact_kd, model.soft_contact_kf = ke, kd, kf
    for name, value in (("ke", ke), ("kd", kd), ("kf", kf)):
        getattr(model, f"shape_material_{name}").fill_(value)


def add_as_helpers(builder: newton.ModelBuilder, scene: Scene,
                   options: argparse.Namespace) -> dict[str, str]:
    """As the engine's examples build cloth: `add_cloth_mesh`, the scene's numbers where it asks for
    such, all else as it is there."""
    import warp as wp
    material = scene.header["scene"]["material"]
    young, b = material["young"], material["bending_rigidity"]
    where = {"pos": wp.vec3(0.0, 0.0, 0.0), "rot": wp.quat_identity(),
             "vel": wp.vec3(0.0, 0.0, 0.0), "vertices": [wp.vec3(*p) for p in scene.rest],
             "indices": scene.triangles.ravel().tolist(), "density": material["density"]}
    if options.solver == "style3d":
        newton.solvers.style3d.add_cloth_mesh(
            builder, **where, tri_aniso_ke=wp.vec3(young, young, young / 10),
            edge_aniso_ke=wp.vec3(b, b, b / 2))
    elif options.solver == "xpbd":
        builder.add_cloth_mesh(**where, scale=1.0, edge_ke=b, add_springs=True, spring_ke=young)
    else:
        builder.add_cloth_mesh(**where, scale=1.0, tri_ke=young, tri_ka=young, edge_ke=b)
    for i in scene.held.tolist():
        builder.particle_mass[i], builder.particle_flags[i] = 0.0, 0
    return {"all": "the engine's helper function and its defaults; Young's modulus and rigidity "
                   "where it asks for stiffnesses"}


def add_as_snippet(builder: newton.ModelBuilder, scene: Scene,
                   options: argparse.Namespace) -> dict[str, str]:
    """As the text that `foldproof material` printed builds it; it holds its own material."""
    names: dict[str, Any] = {}
    exec(Path(options.snippet).read_text(), names)  # noqa: S102 (a file that the user named)
    names["add_fabric"](builder, scene.rest.tolist(), scene.triangles.ravel().tolist())
    for i in scene.held.tolist():
        builder.particle_mass[i], builder.particle_flags[i] = 0.0, 0
    return {"all": f"add_fabric of {options.snippet}"}


# Constants, measured -------------------------------------------------------------------------

ANGLE, STRAIN, STEP = 0.05, 1e-3, 1e-2  # rad, 1, s


def kite(material: dict[str, float], x: np.ndarray) -> Scene:
    """Two triangles at a common edge of 0.8 m, the far corner of the first at the origin; all
    others are held."""
    rest = np.array([[0, 0, 0], [0, -1.2, 0], [-0.4, -0.6, 0], [0.4, -0.6, 0]], float)
    triangles, hinge = np.array([[0, 2, 3], [1, 3, 2]]), np.array([[0, 1, 2, 3]])
    edges = np.array([[0, 2], [0, 3], [2, 3], [1, 2], [1, 3]])
    full = {"density": 1.0, "stretch_damping": 0.0, "rest_length_scale": 1.0, **material}
    arrays = {
        "triangles": triangles, "rest": rest, "x": rest + x, "v": 0 * rest, "mass": np.ones(4),
        "held": np.array([1, 2, 3]), "edges": edges, "edge_stiffness": np.full(5, full["young"]),
        "rest_lengths": np.linalg.norm(rest[edges[:, 0]] - rest[edges[:, 1]], axis=1),
        "hinges": hinge, "hinge_weights": np.array([0.8**2 / (4 * 0.24)]),
        "rest_angles": np.array([full.pop("rest_angle", 0.0)])
    }
    return Scene({"scene": {"gravity": [0.0, 0.0, 0.0], "material": full}}, arrays)


def pull(solver: Any, material: dict[str, float], d: np.ndarray) -> np.ndarray:
    """Force [N] on the free corner that is moved by d [m]."""
    x = np.zeros((4, 3))
    x[0] = d
    solver.prepare(kite(material, x))
    solver.advance(STEP, 1)
    return solver.v[0].astype(float) / STEP


def meet_obstacles(make: Any, options: argparse.Namespace) -> None:
    """A step of contact with everything, so that no kernel is left to be compiled."""
    scene = kite({"young": 100.0, "bending_rigidity": 1.0}, np.zeros((4, 3)))
    rough = {"friction": 0.5}
    scene.header["scene"].update(
        planes=[{"point": [0, 0, 0], "normal": [0, 0, 1], **rough}],
        boxes=[{"centre": [0, 0, 0], "half_extents": [0.1, 0.1, 0.1], **rough}],
        spheres=[{"centre": [0, 0, 0], "radius": 0.1, **rough}],
        capsules=[{"a": [0, 0, 0], "b": [0.1, 0, 0], "radius": 0.1, **rough}])
    if options.solver in GEOMETRIC:
        scene.header["scene"]["thickness"] = 1e-3
    solver = make(options)
    solver.prepare(scene)
    solver.advance(1e-3, 1)


def require_constants(make: Any, options: argparse.Namespace) -> Iterator[str]:
    """Measures what stiffnesses mean; raises where it is not what the mapping assumes."""
    once = argparse.Namespace(**{**vars(options), "graph": False, "substeps": 1, "snippet": None})
    solver, h, w = make(once), 0.6, 0.8**2 / (4 * 0.24)
    bends, young = {"young": 1e-9, "bending_rigidity": 1.0}, 100.0
    bent = -pull(solver, bends, np.array([0, 0, h * np.tan(ANGLE)]))[2]
    rows = [("hinge [N]", bent, 2 * w * ANGLE / h * np.cos(ANGLE))]
    if options.solver != "style3d":  # whose hinges have no rest angle
        up = pull(solver, {**bends, "rest_angle": ANGLE}, np.array([0, 0, h * np.tan(ANGLE)]))[2]
        down = pull(solver, {**bends, "rest_angle": ANGLE}, np.array([0, 0, -h * np.tan(ANGLE)]))[2]
        rows.append(("rest angle, over twice the hinge", max(abs(up), abs(down)) / (2 * bent), 1.0))
        rows.append(("rest angle, sign", float(abs(down) < abs(up)), 1.0))
    stretched = {"young": young, "bending_rigidity": 0.0}
    moved = -pull(solver, stretched, np.array([0, STRAIN * h, 0]))[1]
    sheared = -pull(solver, stretched, np.array([STRAIN * h, 0, 0]))[0]
    if options.stretch == "springs":
        long = np.hypot(0.4, 0.6)
        rows += [("springs along y [N]", moved, 2 * young * STRAIN * h * (0.6 / long)**2),
                 ("springs along x [N]", sheared, 2 * young * STRAIN * h * (0.4 / long)**2)]
    else:
        nu = 0.0 if options.solver == "style3d" else options.poisson
        rows += [("triangle along y [N]", moved, 0.24 * young / (1 - nu * nu) * STRAIN / h),
                 ("triangle in shear [N]", sheared, 0.24 * young / (2 * (1 + nu)) * STRAIN / h)]
    for name, found, assumed in rows:
        if not abs(found - assumed) <= 0.03 * abs(assumed):
            raise SystemExit(f"newton_cloth: {options.solver} of {newton.__version__}: {name}: "
                             f"measured {found:.4g}, the mapping assumes {assumed:.4g}; derive the "
                             "mapping anew")
        yield f"{options.solver:14}{name:34}{found:10.5g}{assumed:10.5g}"
