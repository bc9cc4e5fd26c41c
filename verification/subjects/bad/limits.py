"""Limits, clocks and sizes of the solver's own, which the small, slow scenes of other laws do not
reach; and held particles that are not, or that others notice."""
from __future__ import annotations

import numpy as np
from foldproof_solver import Scene
from materials import Bends, Damped
from toy import Toy


class Speed(Toy):
    """No particle is faster than 10 m/s."""

    def step(self, dt: float) -> None:
        speed = np.linalg.norm(self.v, axis=1, keepdims=True)
        self.v = self.v * np.minimum(1, 10 / np.maximum(speed, 10))
        super().step(dt)


class EdgesAreSlow(Toy):
    """Ends of an edge part by 4 m/s at most."""

    def step(self, dt: float) -> None:
        a, b = self.edges.T
        direction, _ = self.springs()
        for _ in range(30):
            parting = np.sum((self.v[b] - self.v[a]) * direction, axis=1)
            excess = (parting - np.clip(parting, -4, 4))[:, None] * direction / 6
            if not excess.any():
                break
            np.add.at(self.v, a, excess / 2)
            np.add.at(self.v, b, -excess / 2)
        super().step(dt)


class StrainIsLimited(Toy):
    """No edge is longer than 1.3 times at rest: its ends do not part then."""

    def step(self, dt: float) -> None:
        super().step(dt)
        a, b = self.edges.T
        for _ in range(10):
            direction, elongation = self.springs()
            pull = (np.maximum(0, elongation - 0.3 * self.length) / 6)[:, None] * direction
            np.add.at(self.x, a, pull / 2)
            np.add.at(self.x, b, -pull / 2)


class StiffensBeyondATenth(Toy):
    """Springs ten times as stiff beyond a strain of 10 %."""

    def springs(self) -> tuple[np.ndarray, np.ndarray]:
        direction, elongation = super().springs()
        return direction, elongation + 9 * np.maximum(0, elongation - 0.1 * self.length)


class ScalesVelocityEachStep(Toy):
    """By 0.9998 in every step, long or short, as solvers do that dissipate for stability."""

    def step(self, dt: float) -> None:
        super().step(dt)
        self.v *= 0.9998


class KnowsGravity(Toy):
    """Its size is that of the earth, as soon as there is any."""

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        size = np.linalg.norm(self.gravity)
        self.gravity = self.gravity * (9.81 / size if size else 0)


class StepsAreShort(Toy):
    """Beyond 1/60 s, the rest of a step is dropped."""

    def step(self, dt: float) -> None:
        super().step(min(dt, 1 / 60))


class FirstStepIsKept(Toy):
    """The length of a scene's first step is that of all."""

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.kept = None

    def advance(self, dt: float, steps: int) -> None:
        self.kept = self.kept or dt
        super().advance(self.kept, steps)


class StepOfPrepare(Toy):
    def prepare(self, scene: Scene) -> dict[str, str]:
        self.dt = scene.header["scene"]["dt"]
        return super().prepare(scene)

    def step(self, dt: float) -> None:
        super().step(self.dt)


class ManyStandStill(Toy):
    """Beyond 800 particles it gives its input back."""

    def step(self, dt: float) -> None:
        if len(self.x) <= 800:
            super().step(dt)


class ManyBendFreely(Bends):
    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.over_area *= len(self.x) <= 2000


class ManyAreNotDamped(Damped):
    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.c = self.c * (len(self.x) <= 2000)


class HoldsInOrderAlone(Toy):
    """A binary search among held particles, which needs their order."""

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        at = np.searchsorted(self.held, np.arange(len(self.x)))
        found = np.append(self.held, -1)[np.minimum(at, len(self.held))]
        self.held = np.flatnonzero(found == np.arange(len(self.x)))


class ReleasesAfterASecond(Toy):
    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.time = 0.0

    def step(self, dt: float) -> None:
        self.time += dt
        if self.time > 1:
            self.held = np.array([], int)
        super().step(dt)


class WeighsHalfBesideHeld(Toy):
    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        a, b = self.edges.T
        beside = np.zeros(len(self.x), bool)
        beside[b[np.isin(a, self.held)]] = beside[a[np.isin(b, self.held)]] = True
        self.lift = -0.5 * np.where(beside, self.mass, 0)[:, None] * self.gravity

    def forces(self) -> np.ndarray:
        return super().forces() + self.lift


class DampersSpareHeld(Damped):
    """An edge with a held end has no damper."""

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.c = self.c * ~np.isin(self.edges, self.held).any(axis=1)


class DampsAlongRest(Damped):
    """Dampers along the edges of the rest shape: they brake a sheet that has turned from it."""

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        a, b = self.edges.T
        self.along = (scene.rest[b] - scene.rest[a]) / np.linalg.norm(
            scene.rest[b] - scene.rest[a], axis=1, keepdims=True)

    def damping(self) -> np.ndarray:
        now, self.springs = (self.along, 0), lambda: now
        f = super().damping()
        del self.springs
        return f


class RestIsNeverScaled(Toy):
    """Ignores `rest_length_scale`."""

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        a, b = self.edges.T
        self.length = np.linalg.norm(scene.rest[b] - scene.rest[a], axis=1)


class Creeps(Toy):
    """Rest lengths follow strains beyond 8 %, at 5 times a second."""

    def step(self, dt: float) -> None:
        super().step(dt)
        _, elongation = self.springs()
        beyond = np.abs(elongation) > 0.08 * self.length
        self.length = self.length + 5 * dt * elongation * beyond


class SoftHypotenuses(Toy):
    """The longest edge of right-angled triangles has two thirds of its stiffness."""

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        slanted = np.isclose(self.length / self.length.min(), np.sqrt(2))
        self.k = self.k * np.where(slanted, 2 / 3, 1)


class DividesSteps(Damped):
    """Right: a step is made of equal parts that are not longer than its own."""

    substep = 7e-4  # s
    more = {"substep": substep}

    def advance(self, dt: float, steps: int) -> None:
        for _ in range(steps):
            parts = int(np.ceil(dt / self.substep * (1 - 1e-9)))
            for k in range(parts):
                self.part(k, parts, dt / parts)

    def part(self, k: int, parts: int, dt: float) -> None:
        self.step(dt)


class LosesAPart(DividesSteps):
    """Of three or more parts of a step, one is left out."""

    def part(self, k: int, parts: int, dt: float) -> None:
        if k == 0 or k + 1 < parts or parts < 3:
            super().part(k, parts, dt)


class DampsInTheFirstPart(DividesSteps):
    def part(self, k: int, parts: int, dt: float) -> None:
        given, self.c = self.c, self.c * (k == 0)
        super().part(k, parts, dt)
        self.c = given


class CountsPartsOnce(DividesSteps):
    """Each step has as many parts as the first one of its scene."""

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.count = 0

    def advance(self, dt: float, steps: int) -> None:
        self.count = self.count or int(np.ceil(dt / self.substep))
        for _ in range(self.count * steps):
            self.step(dt / self.count)


class BoundsPartsOnce(DividesSteps):
    """Parts are as long as the springs of the first scene of the process allow."""

    bound = 0.0

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.bound = self.bound or 0.5 / np.sqrt(np.max(self.k) / np.min(self.mass))
        self.substep = min(self.bound, 2e-3)


class Tires(Toy):
    """After a thousand steps velocities decay by 1/s."""

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.steps = 0

    def step(self, dt: float) -> None:
        self.steps += 1
        super().step(dt)
        self.v = self.v * np.exp(-dt * (self.steps > 1000))


class FreesHeldWhenSet(Toy):
    """After a state was set, the first held particle alone is held."""

    def set_state(self, x: np.ndarray, v: np.ndarray, time: float) -> None:
        super().set_state(x, v, time)
        self.held = self.held[:1]


class HeldNeighboursStateNothing(Toy):
    """States no force for neighbours of held particles."""

    is_moving = False

    def step(self, dt: float) -> None:
        self.is_moving = True
        super().step(dt)
        self.is_moving = False

    def forces(self) -> np.ndarray:
        f = super().forces()
        if not self.is_moving:
            f[self.edges[np.isin(self.edges, self.held).any(axis=1)]] = 0
        return f


class EnergyOfMotion(Toy):
    """States the kinetic energy, too."""

    def energy(self) -> float:
        return super().energy() + 0.5 * np.sum(self.mass[:, None] * self.v**2)


class SharpHingesHaveNoEnergy(Bends):
    """Those beyond one radian; their forces are right."""

    def bending(self) -> tuple[np.ndarray, float]:
        sums = np.einsum("kc,kci->ki", self.weights, self.x[self.corners])
        f, _ = super().bending()
        blunt = (self.angles() < 1) * self.stiffness()
        return f, 0.5 * np.sum(blunt[:, None] * sums**2)


class EnergyOfTheFirst(Toy):
    """States the energy of 512 springs at most."""

    def energy(self) -> float:
        _, elongation = self.springs()
        stored = (0.5 * self.k * elongation**2)[:512]
        return float(np.sum(stored) - np.sum(self.mass * (self.x @ self.gravity)))


class EnergyBesideHeld(Toy):
    """States no energy of springs at held particles."""

    def energy(self) -> float:
        given, self.k = self.k, self.k * ~np.isin(self.edges, self.held).any(axis=1)
        stated, self.k = super().energy(), given
        return stated


class DampersOfPrepare(Damped):
    """Dampers act for the step of `prepare`."""

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.prepared = scene.header["scene"]["dt"]

    def damp(self, dt: float) -> None:
        super().damp(self.prepared)


class HeldMoveForDampers(Damped):
    """Dampers see the velocities that the scene gives held particles."""

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.seen = scene.v[self.held]

    def damp(self, dt: float) -> None:
        self.v[self.held] = self.seen
        super().damp(dt)


class ScaledSpringsAreStiffer(Toy):
    """Stiffness over the rest length, as of a yarn, where rest lengths are scaled."""

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.k = self.k / scene.header["scene"]["material"]["rest_length_scale"]


class ForcesOfTheTime(Toy):
    """States the forces that it last stated at that time."""

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.stated: dict[float, np.ndarray] = {}
        self.is_moving, self.time = False, 0.0

    def set_state(self, x: np.ndarray, v: np.ndarray, time: float) -> None:
        super().set_state(x, v, time)
        self.time = time

    def advance(self, dt: float, steps: int) -> None:
        self.is_moving = True
        super().advance(dt, steps)
        self.is_moving = False

    def forces(self) -> np.ndarray:
        return super().forces() if self.is_moving else \
            self.stated.setdefault(self.time, super().forces())
