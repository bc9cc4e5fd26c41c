"""Contact with planes and boxes, right and wrong, in several schemes."""
from __future__ import annotations

import numpy as np
from foldproof_solver import Scene
from materials import Bends
from schemes import BackwardEuler, BackwardEulerSingle, Single
from toy import Toy
from toy_solver import ToySolver


class OnPlanes(Toy):
    """Planes stop a step that would end below them; friction takes at most mu of the impulse."""

    capabilities = (*ToySolver.capabilities, "planes")
    number = "f8"

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.planes = scene.header["scene"].get("planes", [])

    def step(self, dt: float) -> None:
        self.before, self.dt = self.x.astype("f8"), float(dt)
        super().step(dt)
        self.meet_obstacles()

    def meet_obstacles(self) -> None:
        for plane in self.planes:
            self.respond(plane)

    def respond(self, plane: dict) -> None:
        normal, v = np.array(plane["normal"]), self.v.astype("f8")
        gap = (self.before + self.dt * v - np.array(plane["point"])) @ normal
        self.touch(np.tile(normal, (len(v), 1)), gap, plane["friction"])

    def touch(self, normals: np.ndarray, gap: np.ndarray, friction: float) -> None:
        """Where the gap at the step's end is negative, along the normals (N, 3)."""
        v = self.v.astype("f8")
        push = self.push(gap)
        push[self.held] = 0
        v += push[:, None] * normals
        tangential = v - np.sum(v * normals, axis=1)[:, None] * normals
        speed = np.linalg.norm(tangential, axis=1)
        kept = self.kept(friction * push, speed)
        touched = push > 0
        v[touched] -= ((1 - kept)[:, None] * tangential)[touched]
        self.v = v.astype(self.number)
        self.x = (self.before + self.dt * v).astype(self.number)

    def push(self, gap: np.ndarray) -> np.ndarray:
        return np.maximum(0, -gap / self.dt)

    def kept(self, most: np.ndarray, speed: np.ndarray) -> np.ndarray:
        """The share of the tangential speed that friction leaves."""
        return np.maximum(0, 1 - most / np.maximum(speed, 1e-30))


class OnPlanesSingle(OnPlanes, Single):
    number = "f4"


class OnPlanesBackwardEuler(OnPlanes, BackwardEuler):
    pass


class OnPlanesBackwardEulerSingle(OnPlanes, BackwardEulerSingle):
    number = "f4"


class SinksIn(OnPlanes):
    """A soft plane."""

    def push(self, gap: np.ndarray) -> np.ndarray:
        return np.maximum(0, -gap * self.dt * 2e3)


class Jitters(OnPlanes):
    """Overcorrects: a particle that was below the plane ends above it."""

    def push(self, gap: np.ndarray) -> np.ndarray:
        return np.where(gap < 0, -gap / self.dt * 4, 0)


class StatesVelocitiesBeforeContact(OnPlanes):
    """The last half kick of a step comes after the response to contact."""

    def step(self, dt: float) -> None:
        self.v = self.v - dt / 2 * self.gravity if hasattr(self, "before") else self.v
        super().step(dt)
        self.v = self.v + dt / 2 * self.gravity


class PlanesAreLevel(OnPlanes):
    """A plane's point counts, its normal does not."""

    def respond(self, plane: dict) -> None:
        super().respond({**plane, "normal": [0, 0, 1]})


class PlanesPassTheOrigin(OnPlanes):
    """A plane's normal counts, its point does not."""

    def respond(self, plane: dict) -> None:
        super().respond({**plane, "point": [0, 0, 0]})


class FrictionPerAxis(OnPlanes):
    """A pyramid in place of Coulomb's cone: two directions in the plane, each with its limit."""

    def respond(self, plane: dict) -> None:
        normal, v = np.array(plane["normal"]), self.v
        super().respond({**plane, "friction": 0})
        push, friction = (self.v - v) @ normal, plane["friction"]
        first = np.cross(normal, [1.0, 0, 0])
        first /= np.linalg.norm(first)
        for axis in (first, np.cross(normal, first)):
            speed = v @ axis
            taken = np.sign(speed) * np.minimum(np.abs(speed), friction * push)
            self.v = self.v - taken[:, None] * axis
        self.x = self.before + self.dt * self.v


class FrictionTurns(OnPlanes):
    """Friction acts 20 degrees beside the motion: it hardly slows less, and pushes sideways."""

    def respond(self, plane: dict) -> None:
        normal, v = np.array(plane["normal"]), self.v
        super().respond(plane)
        push = ((self.v - v) @ normal)[:, None] * normal
        friction, turn = self.v - v - push, np.radians(20)
        self.v = v + push + np.cos(turn) * friction + np.sin(turn) * np.cross(normal, friction)
        self.x = self.before + self.dt * self.v


class BouncesTooHigh(OnPlanes):
    """What falls onto a plane leaves it faster than it came; what rests on it stays."""

    slowest = 0.5  # m/s, that it throws back

    def respond(self, plane: dict) -> None:
        normal = np.array(plane["normal"])
        came, gap = -self.v @ normal, (self.x - np.array(plane["point"])) @ normal
        super().respond(plane)
        thrown = np.where((gap < 0) & (came > self.slowest), 1.2 * came - self.v @ normal, 0)
        self.v = self.v + thrown[:, None] * normal


class BouncesTooHighWhenFast(BouncesTooHigh):
    slowest = 3.0


class FrictionBeyondTheCone(OnPlanes):
    """Friction stops what touches, however steep the slope."""

    def kept(self, most: np.ndarray, speed: np.ndarray) -> np.ndarray:
        return np.where(most > 0, 0.0, 1.0)


class FrictionCreeps(OnPlanes):
    """Friction that grows with the speed to Coulomb's, within some mm/s, so that its formula has no
    kink: steep slopes hardly show it."""

    def kept(self, most: np.ndarray, speed: np.ndarray) -> np.ndarray:
        return super().kept(most * speed / (speed + 0.002), speed)


class BendsOnPlanes(OnPlanes, Bends):
    pass


class BendsOnPlanesFrictionOfWeight(BendsOnPlanes):
    """Friction as much as a particle's own weight calls for, whatever else presses it on."""

    def respond(self, plane: dict) -> None:
        self.own = self.dt * max(0.0, -self.gravity @ np.array(plane["normal"]))
        self.friction = plane["friction"]
        super().respond(plane)

    def kept(self, most: np.ndarray, speed: np.ndarray) -> np.ndarray:
        return super().kept(np.full_like(most, self.friction * self.own), speed)


class BendsOnPlanesThatHoldDown(BendsOnPlanes):
    """What lies on a plane leaves it no more slowly than by 0.2 m/s."""

    def respond(self, plane: dict) -> None:
        super().respond(plane)
        normal = np.array(plane["normal"])
        lay = np.abs((self.before - np.array(plane["point"])) @ normal) < 1e-6
        speed = self.v @ normal
        stays = lay & (speed > 0) & (speed < 0.2)
        self.v[stays] -= speed[stays, None] * normal
        self.x[stays] = self.before[stays] + self.dt * self.v[stays]


class OnBoxes(Toy):
    """Particles that end a step in a box leave it by the nearest face, and stop there."""

    capabilities = (*ToySolver.capabilities, "boxes")
    checked_each = 1  # steps

    def alter(self, scene: Scene) -> None:
        self.boxes, self.steps = scene.header["scene"].get("boxes", []), 0

    def step(self, dt: float) -> None:
        super().step(dt)
        self.steps += 1
        for box in self.boxes if self.steps % self.checked_each == 0 else []:
            self.leave(box)

    def leave(self, box: dict) -> None:
        half, out = np.array(box["half_extents"]), self.x - np.array(box["centre"])
        depth = half - np.abs(out)
        for i in np.flatnonzero(np.all(depth > 0, axis=1)):
            c = np.argmin(depth[i])
            self.x[i, c] = box["centre"][c] + np.copysign(half[c], out[i, c])
            self.v[i, c] = 0


class OnBoxesNowAndThen(OnBoxes):
    """A search for contacts in every fourth step, to save time."""

    checked_each = 4


class BoxesThrowBack(OnBoxes):
    """What comes fast onto a box leaves it faster still."""

    def leave(self, box: dict) -> None:
        came = self.v.copy()
        super().leave(box)
        self.v = np.where((self.v == 0) & (np.abs(came) > 3), -1.2 * came, self.v)


class StartsFromRest(OnBoxes):
    """Ignores the start's velocity, so that nothing it throws or folds meets anything."""

    capabilities = (*OnBoxes.capabilities, "self_collision")

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.v = np.zeros_like(self.x)


class ParticlesRepelAlone(Toy):
    """Against itself: particles nearer than the thickness part, edges and triangles are nothing."""

    capabilities = (*ToySolver.capabilities, "self_collision")

    def alter(self, scene: Scene) -> None:
        self.thickness = scene.header["scene"].get("thickness", 0)

    def step(self, dt: float) -> None:
        super().step(dt)
        if self.thickness == 0:
            return  # all pairs: a square of the particles, which another law would see
        apart = self.x[:, None] - self.x
        near = np.linalg.norm(apart, axis=2) < self.thickness
        np.fill_diagonal(near, False)
        for i, j in np.argwhere(near):
            push = (self.thickness - np.linalg.norm(apart[i, j])) / 2
            self.x[i] += push * apart[i, j] / np.linalg.norm(apart[i, j])
