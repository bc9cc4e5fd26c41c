"""What protocol 2 adds, right and wrong: what is led and moves, materials, limits, air, layers."""
from __future__ import annotations

import numpy as np
from contact import OnPlanes
from foldproof_solver import Scene


class Follows(OnPlanes):
    """Held particles and planes are where they are said to be at each step's end."""

    capabilities = (*OnPlanes.capabilities, "moving_held", "moving_obstacles", "materials", "air",
                    "strain_limits")
    sweeps = 100

    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        self.scene, self.time, constants = scene, 0.0, scene.header["scene"]
        self.air, self.limits = constants.get("air"), constants.get("strain_limits")

    def set_state(self, x: np.ndarray, v: np.ndarray, time: float) -> None:
        super().set_state(x, v, time)
        self.time = time

    def held_at(self, time: float) -> np.ndarray:
        return self.scene.held_at(time)

    def step(self, dt: float) -> None:
        self.before, self.dt = self.x, dt
        self.v = self.v + dt * (self.forces() + self.drag()) / self.mass[:, None]
        end = self.held_at(self.time + dt)
        self.v[self.held] = (end - self.before[self.held]) / dt
        if self.limits:
            self.limit()
        self.x = self.before + dt * self.v
        self.meet_obstacles()
        self.x[self.held] = end
        self.time += dt

    def drag(self) -> np.ndarray:
        """Of the air on each triangle, a third at each corner (N, 3)."""
        f = np.zeros_like(self.x)
        if not self.air:
            return f
        corners = self.x[self.scene.triangles]
        double = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        area = np.linalg.norm(double, axis=1)[:, None] / 2
        normal = double / (2 * area)
        u = self.wind() - self.v[self.scene.triangles].mean(axis=1)
        along = np.sum(u * normal, axis=1)[:, None]
        across = u - along * normal
        pull = self.air["density"] * area / 2 * (
            self.air["normal_drag"] * np.abs(along) * along * normal +
            self.air["tangential_drag"] * np.linalg.norm(across, axis=1)[:, None] * across)
        for corner in range(3):
            np.add.at(f, self.scene.triangles[:, corner], pull / 3)
        return f

    def wind(self) -> np.ndarray:
        return np.array(self.air["wind"])

    def extension(self) -> float:
        return self.limits["extension"]

    def limit(self) -> None:
        """All edges from the same velocities, each impulse shared among those that meet."""
        a, b = self.edges.T
        free = np.ones(len(self.x))
        free[self.held] = 0
        inverse = free / self.mass
        meet = np.bincount(self.edges.ravel(), minlength=len(self.x))
        longest = self.length * (1 + self.extension())
        shortest = self.length * (1 - self.limits["compression"])
        for _ in range(self.sweeps):
            d = self.before[b] - self.before[a] + self.dt * (self.v[b] - self.v[a])
            length = np.linalg.norm(d, axis=1)
            over = length - np.clip(length, shortest, longest)
            impulse = over / self.dt / np.maximum(inverse[a] + inverse[b], 1e-30)
            impulse = (impulse / np.maximum(meet[a], meet[b]) * 1.8 / length)[:, None] * d
            np.add.at(self.v, a, inverse[a, None] * impulse)
            np.add.at(self.v, b, -inverse[b, None] * impulse)

    def pose_at(self, plane: dict, time: float) -> tuple[np.ndarray, np.ndarray]:
        return self.scene.pose_at(plane, time)

    def moved(self, plane: dict) -> np.ndarray:
        """How fast the plane's points move at the particles (N, 3)."""
        (now, at), (later, there) = (self.pose_at(plane, self.time + k * self.dt) for k in (0, 1))
        return ((self.before - at) @ now @ later.T + there - self.before) / self.dt

    def respond(self, plane: dict) -> None:
        turn, shift = self.pose_at(plane, self.time + self.dt)
        normal, point = turn @ plane["normal"], turn @ plane["point"] + shift
        gap, moved = (self.x - point) @ normal, self.moved(plane)
        self.v = self.v - moved
        self.touch(np.tile(normal, (len(gap), 1)), gap, plane["friction"])
        self.v = self.v + moved
        self.x = self.before + self.dt * self.v


class HeldStay(Follows):
    def held_at(self, time: float) -> np.ndarray:
        return self.scene.held_at(0)


class HeldAreAStepLate(Follows):
    def held_at(self, time: float) -> np.ndarray:
        return self.scene.held_at(time - self.dt)


class HeldGoOn(Follows):
    """Beyond the last time they keep their velocity."""

    def held_at(self, time: float) -> np.ndarray:
        last = self.scene.arrays.get("held_times", [time])[-1]
        if time <= last:
            return self.scene.held_at(time)
        before = self.scene.held_at(last - 1e-3)
        return before + (time - last + 1e-3) / 1e-3 * (self.scene.held_at(last) - before)


class PlanesStay(Follows):
    def pose_at(self, plane: dict, time: float) -> tuple[np.ndarray, np.ndarray]:
        return self.scene.pose_at(plane, 0)


class PlanesDoNotTurn(Follows):
    def pose_at(self, plane: dict, time: float) -> tuple[np.ndarray, np.ndarray]:
        return np.eye(3), self.scene.pose_at(plane, time)[1]


class FrictionOfStandingPlanes(Follows):
    """A plane pushes as it moves, but rubs as if it stood."""

    def moved(self, plane: dict) -> np.ndarray:
        normal = np.array(plane["normal"])
        return np.outer(super().moved(plane) @ normal, normal)


class FirstMaterialAlone(Follows):
    def alter(self, scene: Scene) -> None:
        super().alter(scene)
        if "material_of_triangle" in scene.arrays:
            first = scene.material_of_triangle[0]
            ends = scene.triangles[scene.material_of_triangle == first]
            other = ~np.isin(self.edges, ends).all(axis=1)
            materials = scene.header["scene"]["materials"]
            self.k = np.where(other, self.k * materials[0]["young"] / materials[1]["young"], self.k)


class LimitsAreTheirOwn(Follows):
    """Ten per cent, whatever is asked."""

    def extension(self) -> float:
        return 0.1


class NoLimits(Follows):
    def limit(self) -> None:
        pass


class StillAir(Follows):
    def wind(self) -> np.ndarray:
        return np.zeros(3)


class NoAir(Follows):
    def drag(self) -> np.ndarray:
        return np.zeros_like(self.x)


class FollowsBoxes(Follows):
    """Boxes without turns: particles leave them by the nearest face, with friction."""

    capabilities = (*Follows.capabilities, "boxes")

    def meet_obstacles(self) -> None:
        super().meet_obstacles()
        for box in self.scene.header["scene"].get("boxes", []):
            self.leave(box)

    def leave(self, box: dict) -> None:
        out = self.x - box["centre"] - self.pose_at(box, self.time + self.dt)[1]
        depth = np.array(box["half_extents"]) - np.abs(out)
        face = np.argmin(depth, axis=1)
        rows = np.arange(len(out))
        normals = np.zeros_like(out)
        normals[rows, face] = np.copysign(1, out[rows, face])
        inside = np.all(depth > 0, axis=1)
        moved = self.moved(box)
        self.v = self.v - moved
        self.touch(normals, np.where(inside, -depth[rows, face], 1), box["friction"])
        self.v = self.v + moved
        self.x = self.before + self.dt * self.v


class GripOfOneSide(FollowsBoxes):
    """What is in one box is not looked for in another."""

    def meet_obstacles(self) -> None:
        Follows.meet_obstacles(self)
        for box in self.scene.header["scene"].get("boxes", [])[:1]:
            self.leave(box)


class LayersRub(Follows):
    """Of held cloth that lies level, on what lies above it; right there alone."""

    capabilities = (*Follows.capabilities, "self_collision", "layer_friction")

    def meet_obstacles(self) -> None:
        super().meet_obstacles()
        constants = self.scene.header["scene"]
        if "layer_friction" in constants:
            top = self.x[self.held, 2].max() + constants["thickness"]
            self.respond({"point": [0, 0, top], "normal": [0, 0, 1],
                          "friction": self.rubs(constants["layer_friction"])})
            self.x[self.held] = self.before[self.held]

    def rubs(self, friction: float) -> float:
        return friction


class LayersDoNotRub(LayersRub):
    def rubs(self, friction: float) -> float:
        return 0.0


class LayersStick(LayersRub):
    def rubs(self, friction: float) -> float:
        return 10.0
