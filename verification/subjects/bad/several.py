"""Solvers that are right with one obstacle, piece, call or scene, and wrong with several."""
from __future__ import annotations

import numpy as np
from foldproof_solver import Scene
from obstacles import Layers, OnObstacles
from toy import Toy
from toy_solver import ToySolver


class SumsWhatPushes(OnObstacles):
    """Each obstacle answers the velocity before all of them."""

    def meet_obstacles(self) -> None:
        bodies, before = self.bodies, self.v.copy()
        for one in bodies:
            kept, self.v, self.bodies = self.v, before.copy(), [one]
            super().meet_obstacles()
            self.v = kept + self.v - before
        self.bodies = bodies
        self.x = self.before + self.dt * self.v


class LargeReachOut(OnObstacles):
    """Boxes of some metres are larger by a thousandth."""

    def to_boxes(self, body: dict, p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        normals, gap = super().to_boxes(body, p)
        size = max(body["half_extents"])
        return normals, gap - (1e-3 * size if size > 2 else 0)


class RimsSnag(OnObstacles):
    """On a box, what moves in from within 3 mm of a rim meets the side there."""

    def to_boxes(self, body: dict, p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        normals, gap = super().to_boxes(body, p)
        out = self.before - body["centre"]
        side = body["half_extents"] - np.abs(out)
        inward = -self.v * np.sign(out)
        for axis in (0, 1):
            snags = (normals[:, 2] > 0.5) & (side[:, axis] < 0.003) & (inward[:, axis] > 0.01)
            normals[snags] = np.sign(out[snags, axis])[:, None] * np.eye(3)[axis]
            gap[snags] = -self.dt * inward[snags, axis]
        return normals, gap


class BoxesShrinkForThickCloth(OnObstacles):
    capabilities = (*OnObstacles.capabilities, "self_collision")

    def to_boxes(self, body: dict, p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        normals, gap = super().to_boxes(body, p)
        return normals, gap + self.thickness


class LoosePiecesFreeze(Layers):
    """Where a particle is held, pieces without one stay."""

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        if len(self.held):
            loose = np.flatnonzero(~np.isin(self.sheet, self.sheet[self.held]))
            self.held = np.concatenate([self.held, loose])
            self.v[self.held] = 0


class CallsBeginWithoutFriction(OnObstacles):
    """The first step of each call knows no contact before it, and so no friction."""

    def advance(self, dt: float, steps: int) -> None:
        for k in range(steps):
            self.is_first = k == 0
            self.step(dt)

    def friction(self, kind: str, body: dict, normals: np.ndarray) -> float | np.ndarray:
        return 0 if self.is_first else super().friction(kind, body, normals)


class HeldStayHeld(OnObstacles):
    """Who was held in a scene of as many particles is held in the next one, too."""

    kept = np.array([], int)

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        if not hasattr(self, "many") or self.many != len(self.x):
            self.kept = np.array([], int)
        self.many = len(self.x)
        self.held = self.kept = np.union1d(self.kept, self.held).astype(int)


class HeldArePushed(OnObstacles):
    """Obstacles push held particles out, too."""

    def touch(self, normals: np.ndarray, gap: np.ndarray, friction: float) -> None:
        held, self.held = self.held, self.held[:0]
        super().touch(normals, gap, friction)
        self.held = held


class TablesOfEightEdges(Toy):
    """A particle has at most eight edges; others pull at their far end alone."""

    def forces(self) -> np.ndarray:
        f, of = super().forces(), self.edges.ravel()
        order = np.argsort(of, kind="stable")
        first = np.searchsorted(of[order], of[order])
        too_many = order[np.arange(len(of)) - first >= 8]
        edge, end = too_many // 2, too_many % 2
        i, j = self.edges[edge, end], self.edges[edge, 1 - end]
        apart = self.x[j] - self.x[i]
        length = np.linalg.norm(apart, axis=1)
        pull = self.k[edge] * (length - self.length[edge]) / length
        np.add.at(f, i, -pull[:, None] * apart)
        return f


class HitTrianglesAreHeld(Layers):
    """No corner of a triangle that has a held one is pushed."""

    def give(self, i: int, t: np.ndarray, weights: np.ndarray, impulse: np.ndarray) -> None:
        corners = self.v[t].copy()
        super().give(i, t, weights, impulse)
        if np.isin(t, self.held).any():
            self.v[t] = corners


class LayersRub(Layers):
    """With a friction of 0.3 that no scene states."""

    def give(self, i: int, t: np.ndarray, weights: np.ndarray, impulse: np.ndarray) -> None:
        super().give(i, t, weights, impulse)
        normal = impulse / np.linalg.norm(impulse)
        along = self.v[i] - weights @ self.v[t]
        along -= along @ normal * normal
        inertia = 1 / self.mass[i] + np.sum(weights**2 / self.mass[t])
        stops = np.linalg.norm(along) / inertia
        share = min(1, 0.3 * np.linalg.norm(impulse) / max(stops, 1e-30))
        super().give(i, t, weights, -share * along / inertia)


class ForcesKick(ToySolver):
    """Who asks for forces gets the kick of two steps."""

    def prepare(self, scene: Scene) -> dict[str, str]:
        self.dt = scene.header["scene"]["dt"]
        self.is_asked = True
        return super().prepare(scene)

    def advance(self, dt: float, steps: int) -> None:
        self.is_asked = False
        super().advance(dt, steps)
        self.is_asked = True

    def forces(self) -> np.ndarray:
        f = super().forces()
        if self.is_asked:
            self.v = self.v + 2 * self.dt * f / self.mass[:, None]
        return f
