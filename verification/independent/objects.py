"""Objects with closed forms, or closed meshes, and the cloth's response to them: interface
forecasting of BMF03 section 5.2."""

import math
from pathlib import Path
from typing import NamedTuple

import numpy as np

from closest import signed_distance
from state import Span, Unsupported
from motion import Motion, turned_by
from surface import Surface, read_obj


class Answer(NamedTuple):
    """Of an object at a point, for a span of time."""
    phi: float  # signed distance at its start [m]
    normal: np.ndarray  # outward, at its start
    velocity: np.ndarray  # of the object's point there, on average over the span [m/s]
    friction: float


def half_space(_keys: dict, p: np.ndarray) -> tuple[float, np.ndarray]:
    return p[2], np.array([0.0, 0.0, 1.0])


def sphere(keys: dict, p: np.ndarray) -> tuple[float, np.ndarray]:
    away = np.linalg.norm(p)
    return away - keys["radius"], p / away


def capsule(keys: dict, p: np.ndarray) -> tuple[float, np.ndarray]:
    half = keys["length"] / 2
    return sphere(keys, p - [0, 0, min(max(p[2], -half), half)])


def torus(keys: dict, p: np.ndarray) -> tuple[float, np.ndarray]:
    outward = np.array([p[0], p[1], 0]) / math.hypot(p[0], p[1])
    return sphere({"radius": keys["tube_radius"]}, p - keys["ring_radius"] * outward)


def box(keys: dict, p: np.ndarray) -> tuple[float, np.ndarray]:
    """Inside, the nearest face; outside, the nearest point of the box."""
    beyond = np.abs(p) - np.array(keys["size"]) / 2
    side = np.where(p < 0, -1.0, 1.0)
    if np.all(beyond <= 0):
        axis = int(np.argmax(beyond))
        return beyond[axis], side[axis] * np.eye(3)[axis]
    away = np.maximum(beyond, 0)
    return float(np.linalg.norm(away)), side * away / np.linalg.norm(away)


SHAPES = {"half_space": half_space, "sphere": sphere, "capsule": capsule, "torus": torus,
          "box": box}


class SolidMesh:
    """A closed mesh, by the nearest of all its triangles."""

    def __init__(self, points: np.ndarray, triangles: np.ndarray) -> None:
        self.points, self.triangles = points, triangles

    def __call__(self, _keys: dict, p: np.ndarray) -> tuple[float, np.ndarray]:
        return signed_distance(self.points[self.triangles], p)


class Object:
    """The point X of a solid starts at turn X + move; then it has the motion."""

    def __init__(self, keys: dict, folder: Path) -> None:
        if "keyframe" in keys or "deform" in keys or "frames" in keys:
            raise Unsupported("keyframes, and bodies that deform")
        self.keys, self.motion = keys, Motion(keys)
        self.friction = keys.get("friction", 0.0)
        self.name = keys.get("name", "")
        self.turn = turned_by(keys["turn"]) if "turn" in keys else np.eye(3)
        self.move = np.array(keys.get("move", [0.0, 0.0, 0.0]))
        self.triangles = np.zeros((0, 3), dtype=int)
        if "mesh" in keys:
            if keys.get("field") != "exact":
                raise Unsupported("distances that are not exact")
            points, self.triangles = read_obj(folder / keys["mesh"])
            self.corners = points @ self.turn.T + self.move
            self.distance = SolidMesh(points, self.triangles)
        elif keys["shape"] in SHAPES:
            self.distance = SHAPES[keys["shape"]]
        else:
            raise Unsupported(f"object shape {keys['shape']}")

    def at(self, p: np.ndarray, span: Span) -> Answer:
        """The velocity is that of the chord from p to where the object's point is at the end."""
        rotation = self.motion.rotation(span.start, span.start)
        start = self.motion.start_of(p, span.start)
        phi, normal = self.distance(self.keys, (start - self.move) @ self.turn)
        if span.end > span.start:
            end = self.motion.place(start, span.end, span.start)
            velocity = (end - p) / (span.end - span.start)
        else:
            velocity = self.motion.speed(start, span.start, span.start)
        return Answer(phi, rotation @ self.turn @ normal, velocity, self.friction)


def forecast(at: Answer, v: np.ndarray, tau: float) -> np.ndarray:
    """Section 5.2 of the paper, in its order: normal velocity, then friction."""
    phi_new = at.phi + tau * (v - at.velocity) @ at.normal
    if phi_new >= 0:
        return v
    v_n, v_pn = at.velocity @ at.normal, v @ at.normal
    v_t, v_pt = at.velocity - v_n * at.normal, v - v_pn * at.normal
    v_pn_new = v_pn - phi_new / tau
    sliding = v_pt - v_t
    speed = np.linalg.norm(sliding)
    if speed > 0:
        sliding = max(0.0, 1 - at.friction * (v_pn_new - v_pn) / speed) * sliding
    return v_pn_new * at.normal + v_t + sliding


class Point(NamedTuple):
    """The mean of a few particles, and what each gets of a change of its velocity."""
    particles: np.ndarray
    shares: np.ndarray


def points_of(cloth: Surface, inverse_mass: np.ndarray, kind: str) -> list[Point]:
    """Centres of triangles, midpoints of edges, particles. The least impulses that change a mean
    are as the inverse masses."""
    groups = [cloth.triangles] if kind == "faces" else []
    groups += [np.array(sorted(map(tuple, cloth.edges)))] if kind in ("faces", "edges") else []
    groups.append(np.arange(len(inverse_mass))[:, None])
    points = []
    for row in (row for group in groups for row in group):
        weights = inverse_mass[row]
        if weights.any():
            points.append(Point(row, weights / weights.mean()))
    return points


class Collision:
    """Velocities that keep the points of the cloth out of objects."""

    def __init__(self, objects: list[Object], points: list[Point], forecast_time: float) -> None:
        self.objects, self.points, self.forecast_time = objects, points, forecast_time
        self.corrected = 0

    def __call__(self, span: Span, x: np.ndarray, v: np.ndarray) -> np.ndarray:
        v = v.copy()
        tau = self.forecast_time or span.step
        for particles, shares in self.points:
            p, before = x[particles].mean(axis=0), v[particles].mean(axis=0)
            after = self.response([one.at(p, span) for one in self.objects], before, tau)
            if np.any(after != before):
                v[particles] += shares[:, None] * (after - before)
                self.corrected += 1
        return v

    def response(self, answers: list[Answer], v: np.ndarray, tau: float) -> np.ndarray:
        """Against every object, the one that would be entered most deeply first."""
        if sum(at.phi < 0 for at in answers) > 1:
            raise Unsupported("a point between two objects")
        left = list(answers)
        while left:
            depths = [at.phi + tau * (v - at.velocity) @ at.normal for at in left]
            v = forecast(left.pop(int(np.argmin(depths))), v, tau)
        return v
