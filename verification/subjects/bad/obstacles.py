"""Contact with every kind of obstacle, and between layers: right, and wrong in one place each."""
from __future__ import annotations

import numpy as np
from contact import OnPlanes
from foldproof_solver import Scene
from materials import Damped
from toy_solver import ToySolver

KINDS = ("planes", "boxes", "spheres", "capsules")


class OnObstacles(OnPlanes):
    """A step that would end in an obstacle ends on it; friction as on planes."""

    capabilities = (*ToySolver.capabilities, *KINDS)

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        constants = scene.header["scene"]
        self.thickness = constants.get("thickness", 0)
        self.bodies = [(kind, body) for kind in KINDS for body in constants.get(kind, [])]

    def meet_obstacles(self) -> None:
        for kind, body in self.bodies:
            p = self.before + self.dt * self.v.astype("f8")
            normals, gap = getattr(self, "to_" + kind)(body, p)
            self.touch(normals, gap, self.friction(kind, body, normals))

    def friction(self, kind: str, body: dict, normals: np.ndarray) -> float | np.ndarray:
        return body["friction"]

    # outward normals (N, 3) and distances (N) [m]

    def to_planes(self, body: dict, p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        normal = np.array(body["normal"])
        return np.tile(normal, (len(p), 1)), (p - body["point"]) @ normal

    def to_boxes(self, body: dict, p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Of the nearest face; outside, only the sign of the distance counts."""
        out = p - body["centre"]
        beyond = np.abs(out) - body["half_extents"]
        face = np.argmax(beyond, axis=1)
        rows = np.arange(len(p))
        normals = np.zeros_like(p)
        normals[rows, face] = np.copysign(1, out[rows, face])
        return normals, beyond[rows, face]

    def to_spheres(self, body: dict, p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return self.to_capsules({**body, "a": body["centre"], "b": body["centre"]}, p)

    def to_capsules(self, body: dict, p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        a, axis = np.array(body["a"]), np.array(body["b"]) - body["a"]
        part = self.part_of_axis((p - a) @ axis / max(axis @ axis, 1e-30))
        out = p - a - part[:, None] * axis
        length = np.linalg.norm(out, axis=1)
        return out / length[:, None], length - body["radius"]

    def part_of_axis(self, part: np.ndarray) -> np.ndarray:
        return np.clip(part, 0, 1)


class RoughOnTopAlone(OnObstacles):
    """Boxes have friction where something can lie on them, not on their other faces."""

    def friction(self, kind: str, body: dict, normals: np.ndarray) -> float | np.ndarray:
        mu = super().friction(kind, body, normals)
        return np.where(normals[:, 2] > 0.9, mu, 0) if kind == "boxes" else mu


class CapsulesEndless(OnObstacles):
    """Cylinders without an end."""

    def part_of_axis(self, part: np.ndarray) -> np.ndarray:
        return part


class WallsAreNothing(OnObstacles):
    """Planes are floors."""

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.bodies = [(kind, body) for kind, body in self.bodies
                       if kind != "planes" or body["normal"][2] > 0.3]


class PointsAreNothing(OnObstacles):
    """A capsule has an axis."""

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.bodies = [(kind, body) for kind, body in self.bodies
                       if kind != "capsules" or np.ptp([body["a"], body["b"]], axis=0).max() > 1e-6]


class ForgetsOthers(OnObstacles):
    """The first obstacle of each kind."""

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.bodies = [(kind, scene.header["scene"][kind][0]) for kind in dict(self.bodies)]


class FirstKindAlone(OnObstacles):
    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.bodies = [one for one in self.bodies if one[0] == self.bodies[0][0]]


class MeetsOneObstacle(OnObstacles):
    """A particle meets one obstacle a step: the first one."""

    def meet_obstacles(self) -> None:
        self.is_free = np.full(len(self.x), True)
        super().meet_obstacles()

    def touch(self, normals: np.ndarray, gap: np.ndarray, friction: float) -> None:
        super().touch(normals, np.where(self.is_free, gap, 1), friction)
        self.is_free &= gap >= 0


class MeansFriction(OnObstacles):
    """One friction for a sheet: the mean of all obstacles of a kind that touch it."""

    def friction(self, kind: str, body: dict, normals: np.ndarray) -> float | np.ndarray:
        distance = getattr(self, "to_" + kind)
        near = [other["friction"] for one, other in self.bodies
                if one == kind and np.any(distance(other, self.before)[1] < 1e-3)]
        return float(np.mean(near)) if near else body["friction"]


class KeepsOldObstacles(OnObstacles):
    """Obstacles add up from scene to scene, where a scene has none of its own."""

    old: list = []

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.bodies = self.old = self.bodies or self.old


class FarObstaclesPull(OnObstacles):
    """A soft contact without an end: a millionth of g, a kilometre away as near."""

    def step(self, dt: float) -> None:
        self.v = self.v + 1e-5 * dt * len(self.bodies)
        super().step(dt)


class ObstaclesRebound(OnObstacles):
    """A third of the speed comes back."""

    def touch(self, normals: np.ndarray, gap: np.ndarray, friction: float) -> None:
        came = -np.sum(self.v * normals, axis=1)
        super().touch(normals, gap, friction)
        back = came / 3 - np.sum(self.v * normals, axis=1)
        self.v = self.v + np.where((gap < 0) & (came > 0.1), back, 0)[:, None] * normals


class ObstaclesCling(OnObstacles):
    """What touches an obstacle leaves it at half its speed."""

    def touch(self, normals: np.ndarray, gap: np.ndarray, friction: float) -> None:
        super().touch(normals, gap, friction)
        leaves = np.maximum(0, np.sum(self.v * normals, axis=1)) * (np.abs(gap) < 1e-3)
        self.v = self.v - (leaves / 2)[:, None] * normals
        self.x = self.before + self.dt * self.v


class FastClothSlides(OnObstacles):
    """No friction above 2 m/s."""

    def kept(self, most: np.ndarray, speed: np.ndarray) -> np.ndarray:
        return np.where(speed > 2, 1, super().kept(most, speed))


class SlowClothCreeps(OnObstacles):
    """No friction below 1 mm/s."""

    def kept(self, most: np.ndarray, speed: np.ndarray) -> np.ndarray:
        slow = np.minimum(1, 0.001 / np.maximum(speed, 1e-30))
        return np.maximum(super().kept(most, speed), slow)


class SlidesBesideHeld(OnObstacles):
    """No friction on the neighbours of held particles."""

    def friction(self, kind: str, body: dict, normals: np.ndarray) -> float | np.ndarray:
        mu = np.full(len(normals), super().friction(kind, body, normals))
        mu[self.edges[np.isin(self.edges, self.held).any(axis=1)]] = 0
        return mu


class BoxesOffCentre(OnObstacles):
    """Boxes 5 mm from where they are."""

    def to_boxes(self, body: dict, p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return super().to_boxes(body, p - np.array([0, 0, 0.005]))


class NoObstacleIsSmall(OnObstacles):
    """Boxes are at least 4 cm thick, radii at least 10 cm."""

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        for kind, body in self.bodies:
            if kind == "boxes":
                body["half_extents"] = np.maximum(body["half_extents"], 0.02)
            elif kind != "planes":
                body["radius"] = max(body["radius"], 0.1)


class PlanesSnapToAxes(OnObstacles):
    """A normal within 18 degrees of an axis is the axis."""

    def to_planes(self, body: dict, p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        normal = np.where(np.abs(body["normal"]) > 0.95, np.sign(body["normal"]), 0)
        return super().to_planes({**body, "normal": normal} if normal.any() else body, p)


class SixtyFourContacts(OnObstacles):
    def touch(self, normals: np.ndarray, gap: np.ndarray, friction: float) -> None:
        touched = np.flatnonzero(gap < 0)
        gap = gap.copy()
        gap[touched[64:]] = 1
        super().touch(normals, gap, friction)


class Layers(OnObstacles):
    """Particles nearer to a triangle of another sheet than the thickness, on the side that they
    were on at the start, are pushed apart at the speed that they miss, before they move."""

    capabilities = (*OnObstacles.capabilities, "self_collision")
    reach = 1.0  # of the thickness

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.triangles = scene.triangles
        sheet = np.arange(len(self.x))
        for _ in range(len(self.x)):  # numbers of joined particles spread along the edges
            np.minimum.at(sheet, self.edges[:, 0], sheet[self.edges[:, 1]])
            np.minimum.at(sheet, self.edges[:, 1], sheet[self.edges[:, 0]])
        self.sheet, self.side = sheet, {}

    def meet_obstacles(self) -> None:
        if self.thickness > 0 and len(set(self.sheet)) > 1:
            self.part_layers()
        super().meet_obstacles()

    def part_layers(self) -> None:
        for t in self.triangles:
            a, b, c = self.before[t]
            normal = np.cross(b - a, c - a)
            normal /= np.linalg.norm(normal)
            others = np.flatnonzero(self.sheet != self.sheet[t[0]])
            out = self.before[others] - a
            plane = np.linalg.lstsq(np.stack([b - a, c - a], axis=1), out.T, rcond=None)[0]
            within = (plane.min(axis=0) >= -1e-9) & (plane.sum(axis=0) <= 1 + 1e-9)
            for i, distance, (s, r) in zip(others[within], (out @ normal)[within],
                                           plane.T[within], strict=True):
                side = self.side.setdefault((i, *t), np.sign(distance))
                self.push_apart(i, t, np.array([1 - s - r, s, r]), side * normal, side * distance)

    def push_apart(self, i: int, t: np.ndarray, weights: np.ndarray, normal: np.ndarray,
                   distance: float) -> None:
        leaving = (self.v[i] - weights @ self.v[t]) @ normal
        wanted = self.wanted(distance) - leaving
        if wanted > 0 and distance + self.dt * leaving < self.reach * self.thickness:
            inertia = 1 / self.mass[i] + np.sum(weights**2 / self.mass[t])
            self.give(i, t, weights, wanted / inertia * normal)

    def wanted(self, distance: float) -> float:
        """The speed at which what is so near must part [m/s]."""
        return (self.reach * self.thickness - distance) * min(1, 0.1 / self.dt) / self.dt / 10

    def give(self, i: int, t: np.ndarray, weights: np.ndarray, impulse: np.ndarray) -> None:
        self.v[i] += impulse / self.mass[i]
        self.v[t] -= weights[:, None] * impulse / self.mass[t][:, None]


class LayersPushOneSide(Layers):
    """The vertex is pushed out of the triangle, which feels nothing."""

    def give(self, i: int, t: np.ndarray, weights: np.ndarray, impulse: np.ndarray) -> None:
        self.v[i] += impulse / self.mass[i]


class LayersPushCorners(Layers):
    """The triangle's corners share the impulse evenly, wherever it was hit."""

    def give(self, i: int, t: np.ndarray, weights: np.ndarray, impulse: np.ndarray) -> None:
        super().give(i, t, np.full(3, 1 / 3), impulse)


class LayersTwiceAsThick(Layers):
    reach = 2.0


class LayersGlue(Layers):
    """What is nearer than the thickness moves together."""

    def push_apart(self, i: int, t: np.ndarray, weights: np.ndarray, normal: np.ndarray,
                   distance: float) -> None:
        if distance < self.thickness:
            apart = self.v[i] - weights @ self.v[t]
            inertia = 1 / self.mass[i] + np.sum(weights**2 / self.mass[t])
            self.give(i, t, weights, -apart / inertia)


class LayersForgetPlanes(Layers):
    """Layers or obstacles, never both in one scene."""

    def meet_obstacles(self) -> None:
        if self.thickness > 0 and self.bodies and len(set(self.sheet)) > 1:
            return super(Layers, self).meet_obstacles()
        return super().meet_obstacles()


class ThickOnPlanes(Layers):
    """Keeps the cloth's thickness from obstacles, too."""

    def to_planes(self, body: dict, p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        normals, gap = super().to_planes(body, p)
        return normals, gap - self.thickness


class NeighboursRepel(Layers):
    """Particles nearer than the thickness part, in one sheet, too."""

    def part_layers(self) -> None:
        pass

    def meet_obstacles(self) -> None:
        apart = self.before[:, None] - self.before
        distance = np.linalg.norm(apart, axis=2) + np.eye(len(apart))
        push = np.maximum(0, self.thickness - distance) / distance
        self.v = self.v + np.sum(push[:, :, None] * apart, axis=1) / self.dt / 10
        super().meet_obstacles()


class FirstAtEachPlace(OnObstacles):
    """What is above or below another obstacle is left out, as if it were the same."""

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        places: set[tuple[float, ...]] = set()
        for one in self.bodies.copy():
            body = one[1]
            centre = body.get("centre", body.get("point")) or np.add(body["a"], body["b"]) / 2
            place = tuple(np.round(centre[:2], 6))
            if place in places:
                self.bodies.remove(one)
            places.add(place)


class FrictionAboveOneGlues(OnObstacles):
    def friction(self, kind: str, body: dict, normals: np.ndarray) -> float | np.ndarray:
        return body["friction"] if body["friction"] < 1 else 1e9


class DampersSpareContact(OnObstacles, Damped):
    """Edges with an end on an obstacle are not damped."""

    capabilities = (*OnObstacles.capabilities, "damping")

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.touched = np.zeros(len(self.x), bool)

    def touch(self, normals: np.ndarray, gap: np.ndarray, friction: float) -> None:
        self.touched = gap < 0
        super().touch(normals, gap, friction)

    def damp(self, dt: float) -> None:
        given, self.c = self.c, self.c * ~self.touched[self.edges].any(axis=1)
        super().damp(dt)
        self.c = given


class BoxesHaveNoEdge(OnObstacles):
    """The top of a box goes on where it ends, for what came from there."""

    def to_boxes(self, body: dict, p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        height = p[:, 2] - body["centre"][2] - body["half_extents"][2]
        return np.tile([0.0, 0.0, 1.0], (len(p), 1)), height


class LayersInsideAlone(Layers):
    """A particle that lies over another one's corner or edge is not found."""

    def push_apart(self, i: int, t: np.ndarray, weights: np.ndarray, normal: np.ndarray,
                   distance: float) -> None:
        if weights.min() > 1e-3:
            super().push_apart(i, t, weights, normal, distance)


class ThicknessStays(Layers):
    """A scene without a thickness has that of the scene before."""

    kept = 0.0

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.kept = self.thickness = self.thickness or self.kept
