"""Bending, and materials whose parameters mean something else than the scene says."""
from __future__ import annotations

import numpy as np
from foldproof_solver import Declined, Scene
from toy import Toy, add_pulls
from toy_solver import ToySolver


class SpringsPerLength(Toy):
    """Young's modulus over length, as of a thread, whatever the mesh."""

    def alter(self, scene: Scene) -> None:
        self.k = scene.header["scene"]["material"]["young"] * 0.0866 / self.length


class WeftPerLength(Toy):
    """Its modulus along x is right on every mesh. Along y it grows as edges get shorter, and is
    right only with edges of 0.05 m."""

    def alter(self, scene: Scene) -> None:
        self.weft = 0.05 / np.mean(self.length)

    def forces(self) -> np.ndarray:
        weight = self.mass[:, None] * self.gravity
        return weight + (super().forces() - weight) * np.array([1, self.weft, 1])


class SpringsOfOneStiffness(Toy):
    """Young's modulus as every spring's stiffness."""

    def alter(self, scene: Scene) -> None:
        self.k = np.full_like(self.k, scene.header["scene"]["material"]["young"])


class SpringsTear(ToySolver):
    """A spring that is stretched by more than a tenth holds no more."""

    def springs(self) -> tuple[np.ndarray, np.ndarray]:
        direction, elongation = super().springs()
        return direction, np.where(elongation > 0.1 * self.length, 0, elongation)


class Bends(Toy):
    """Bending of a flat rest shape, quadratic in the positions.

    The cotangents of two neighbouring triangles of area A give the edge's length L times its angle.
    Bent by a curvature c about an axis along one of its edges' directions, the equilateral mesh
    has, for each particle, two edges of angle c L/sqrt(3) and one of c L/sqrt(12), on an area of
    L^2 sqrt(3)/2: energies of B/2 (L angle)^2/A add up to B c^2/2 an area."""

    rigidity = 1.0  # over the scene's

    def prepare(self, scene: Scene) -> dict[str, str]:
        material = scene.header["scene"]["material"]
        self.given, material["bending_rigidity"] = material["bending_rigidity"], 0
        if self.given and np.any(scene.rest_angles):
            raise Declined("rest angles: it bends to flat")
        if material["bending_damping"] > 0:
            raise Declined("dampers of hinges")
        return {**super().prepare(scene), "bending": "B of the scene, by the squared Laplacian"}

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.corners = scene.hinges
        found = [laplacian(scene.rest[hinge]) for hinge in scene.hinges]
        self.weights = np.array([weights for weights, _ in found]).reshape(-1, 4)
        scale = self.rigidity * self.given
        self.over_area = np.array([scale / area for _, area in found])

    def stiffness(self) -> np.ndarray:
        """Of each hinge: B over the area."""
        return self.over_area

    def bending(self) -> tuple[np.ndarray, float]:
        """Forces [N] and energy [J]."""
        sums = np.einsum("kc,kci->ki", self.weights, self.x[self.corners])
        pull = self.stiffness()[:, None] * sums
        f = np.zeros_like(self.x)
        np.add.at(f, self.corners, -self.weights[:, :, None] * pull[:, None])
        return f, 0.5 * np.sum(sums * pull)

    def normals(self) -> tuple[np.ndarray, np.ndarray]:
        """Of both triangles of each hinge."""
        a, b, c, d = (self.x[self.corners[:, k]] for k in range(4))
        return np.cross(d - c, a - c), np.cross(b - c, d - c)

    def angles(self) -> np.ndarray:
        """Of hinges, without a sign [rad]."""
        first, second = self.normals()
        sine = np.linalg.norm(np.cross(first, second), axis=1)
        return np.arctan2(sine, np.sum(first * second, axis=1))

    def forces(self) -> np.ndarray:
        return super().forces() + self.bending()[0]

    def energy(self) -> float:
        return super().energy() + self.bending()[1]


def laplacian(corners: np.ndarray) -> tuple[np.ndarray, float]:
    """Weights of two opposite corners and the ends of their shared edge, and the area of both
    triangles."""
    opposite, ends = corners[:2], corners[2:]
    weights, area = np.zeros(4), 0.0
    for k, far in enumerate(opposite):
        for near, other in ((0, 1), (1, 0)):
            side, base = far - ends[near], ends[other] - ends[near]
            cotangent = side @ base / np.linalg.norm(np.cross(side, base))
            weights[2 + other] += cotangent
            weights[k] -= cotangent
        area += np.linalg.norm(np.cross(far - ends[0], ends[1] - ends[0])) / 2
    return weights, area


class SpringsPullAlone(Bends):
    """A spring that is shorter than at rest is slack, as a yarn."""

    def springs(self) -> tuple[np.ndarray, np.ndarray]:
        direction, elongation = super().springs()
        return direction, np.maximum(0, elongation)


class SpringsKeepTheirDirections(Bends):
    """Springs along the edges of the rest shape, as for small displacements: tension does not
    straighten what is not flat."""

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        a, b = scene.edges.T
        self.direction = (scene.rest[b] - scene.rest[a]) / self.length[:, None]

    def springs(self) -> tuple[np.ndarray, np.ndarray]:
        d = self.x[self.edges[:, 1]] - self.x[self.edges[:, 0]]
        return self.direction, np.sum(d * self.direction, axis=1) - self.length


class BendsUnasked(Bends):
    """A flat sheet that resists bending whatever the scene says, as a coarse mesh that locks:
    B = Y L^2/2 of its edges L. Nothing that is flat shows it."""

    def prepare(self, scene: Scene) -> dict[str, str]:
        material = scene.header["scene"]["material"]
        if material["bending_rigidity"] > 0:
            raise Declined("bending")
        material["bending_rigidity"] = material["young"] * np.mean(scene.rest_lengths) ** 2 / 2
        return super().prepare(scene)


class BendsToFlat(Bends):
    """Takes rest angles, and ignores them."""

    def prepare(self, scene: Scene) -> dict[str, str]:
        scene.arrays["rest_angles"] = np.zeros_like(scene.rest_angles)
        return super().prepare(scene)


class BendingEnergyTripled(Bends):
    """Forces of bending are right, their energy is three times too large."""

    def energy(self) -> float:
        return super().energy() + 2 * self.bending()[1]


class BendingPullsOneCornerLess(Bends):
    """The force on the last corner of each hinge is halved."""

    def forces(self) -> np.ndarray:
        sums = np.einsum("kc,kci->ki", self.weights, self.x[self.corners])
        last = self.weights[:, 3:] * self.over_area[:, None] * sums
        f = super().forces()
        np.add.at(f, self.corners[:, 3], last / 2)
        return f


class BendsUprightOnly(Bends):
    """The theory of small deflections: bending resists height alone, whatever the slope. Turned
    sheets are bent the wrong way, and steep ones too little."""

    def forces(self) -> np.ndarray:
        bending, _ = self.bending()
        bending[:, :2] = 0
        return super(Bends, self).forces() + bending


class Damped(Toy):
    """Dampers along the edges, explicit: as the scene says."""

    capabilities = (*ToySolver.capabilities, "damping")
    share, stated = 1.0, "a damper per edge [N s/m]"  # share: of the scene's damping

    def prepare(self, scene: Scene) -> dict[str, str]:
        return {**super().prepare(scene), "damping": self.stated}

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        material = scene.header["scene"]["material"]
        self.c = self.share * material["stretch_damping"] / material["young"] * self.k

    def damping(self) -> np.ndarray:
        direction, _ = self.springs()
        a, b = self.edges.T
        pull = (self.c * np.sum((self.v[b] - self.v[a]) * direction, axis=1))[:, None] * direction
        f = np.zeros_like(self.x)
        add_pulls(f, self.edges, pull)
        return f

    def damp(self, dt: float) -> None:
        self.v = self.v + dt * self.damping() / self.mass[:, None]

    def step(self, dt: float) -> None:
        self.damp(dt)
        super().step(dt)


class DampsAllMotion(Damped):
    """Where edges are damped, motion against the room is, too."""

    def damping(self) -> np.ndarray:
        of_the_room = 0.05 * self.mass[:, None] * self.v if self.c.any() else 0
        return super().damping() - of_the_room


class DampedVerlet(Damped):
    """Velocity Verlet, of order 2 without damping. Each half step takes the damping of velocities
    that it has not changed yet: with damping the order is 1."""

    scheme, order = "velocity Verlet", 2

    def half_kick(self, dt: float) -> None:
        self.v = self.v + dt / 2 * (self.forces() + self.damping()) / self.mass[:, None]
        self.v[self.held] = 0

    def step(self, dt: float) -> None:
        self.half_kick(dt)
        self.x = self.x + dt * self.v
        self.half_kick(dt)


class DampedUnasked(Damped):
    """A fiftieth of sqrt(k m) at each edge: 1.7 % of critical damping in a breathing triangle.
    Momenta are kept, and units."""

    capabilities, stated = ToySolver.capabilities, "none"

    def alter(self, scene: Scene) -> None:
        self.c = 0.02 * np.sqrt(self.k * self.mass.mean())


class BendsFaceUpAlone(Bends):
    """Where the sheet is turned over by more than 120 degrees it does not resist bending, as where
    a table of angles ends."""

    def stiffness(self) -> np.ndarray:
        first, second = self.normals()
        normal = first + second
        return super().stiffness() * (normal[:, 2] > -0.5 * np.linalg.norm(normal, axis=1))


class StiffensWhenSharp(Bends):
    """As tan(2 theta)/2 grows: right at small angles, where rigidities are measured."""

    def stiffness(self) -> np.ndarray:
        return super().stiffness() * (1 + 16 * np.minimum(self.angles(), 0.64) ** 2)


class GivesAtSmallAngles(Bends):
    """No moment below half a milliradian, as of a hinge with play."""

    def stiffness(self) -> np.ndarray:
        moment = np.maximum(0, 1 - 5e-4 / np.maximum(self.angles(), 1e-12))
        return super().stiffness() * moment


class HeldSheetsWeighTwice(Toy):
    """Gravity is added once more where particles are held."""

    weight = 2.0  # over the scene's

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        if len(self.held):
            self.gravity = self.weight * self.gravity


class HeldStripsWeighTwice(HeldSheetsWeighTwice, Bends):
    pass


class HeldStripsWeighATenthMore(HeldStripsWeighTwice):
    weight = 1.1


class BendsByLongSprings(Bends):
    """As springs between particles two edges apart bend a sheet: more on coarse meshes. The
    rigidity is the scene's where edges are 5 cm long."""

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.over_area *= (np.mean(scene.rest_lengths) / 0.05) ** 2


class BendsOneWayAlone(Bends):
    """Woven cloth whose edges within 25 degrees of y bend freely, as rods of one direction. A strip
    along y, with which rigidities are measured, has none of them."""

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        along = scene.rest[self.corners[:, 3]] - scene.rest[self.corners[:, 2]]
        self.over_area[np.abs(along[:, 0]) < 0.42 * np.linalg.norm(along, axis=1)] = 0


class ClampsWhereHeld(Bends):
    """Right, with another clamp: cloth hardly bends along an edge between held particles, so that
    bending begins behind it."""

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.over_area[np.isin(self.corners[:, 2:], self.held).all(axis=1)] *= 10


class WeightIsLimited(Toy):
    """Gravity beyond that of the earth is cut."""

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.gravity = self.gravity * min(1, 9.81 / max(9.81, np.linalg.norm(self.gravity)))


class BendsWithLimitedWeight(WeightIsLimited, Bends):
    """The same, with bending."""
