"""Dynamic sticking constraints of BMF03 section 6."""

import math
from typing import NamedTuple

import numpy as np

from closest import nearest_on, weights_of
from forces import nothing
from motion import Motion


class Bond(NamedTuple):
    """A particle's place in the frame of a triangle."""
    particle: int
    triangle: int  # of the patch
    weights: np.ndarray  # of its corners; sum to one
    height: float  # m


class Frame(NamedTuple):
    """The place of a bond now, and how it moves with the corners."""
    place: np.ndarray  # m
    jacobian: np.ndarray  # 3 corners x 3 x 3: change of the place for that of a corner


def frame_at(corners: np.ndarray, bond: Bond) -> Frame:
    """Place: weights . corners + height n, n = N/|N|, N = (b - a) x (c - a).
    dn = (1 - n n^T) dN/|N|, dN = (c - b) x da + (a - c) x db + (b - a) x dc."""
    a, b, c = corners
    big = np.cross(b - a, c - a)
    size = np.linalg.norm(big)
    n = big / size
    flat = (np.eye(3) - np.outer(n, n)) / size
    jacobian = np.stack([
        weight * np.eye(3) + bond.height * flat @ cross_with(opposite)
        for weight, opposite in zip(bond.weights, (c - b, a - c, b - a))
    ])
    return Frame(bond.weights @ corners + bond.height * n, jacobian)


def cross_with(edge: np.ndarray) -> np.ndarray:
    """The matrix of y -> edge x y."""
    x, y, z = edge
    return np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])


class Carried:
    """Corners of triangles of an object, carried by its motion."""

    def __init__(self, corners: np.ndarray, motion: Motion) -> None:
        self.corners, self.motion = corners, motion

    def place(self, time: float) -> np.ndarray:
        return self.motion.place(self.corners, time, time)

    def velocity(self, time: float) -> np.ndarray:
        return self.motion.speed(self.corners, time, time)


class Sticky:
    """One patch of triangles, of the cloth (`carried` is None) or of an object."""

    def __init__(self, keys: dict, triangles: np.ndarray, particles: list[int],
                 carried: Carried | None) -> None:
        self.triangles, self.particles, self.carried = triangles, particles, carried
        self.stiffness, self.near, self.far = keys["stiffness"], keys["near"], keys["far"]
        self.tau = keys["forecast_time"]
        self.start, self.stop = keys.get("from", 0.0), keys.get("until", math.inf)
        self.release = keys.get("release", 0.0)
        self.bonds: list[Bond] = []

    def events(self) -> set[float]:
        return {self.start, self.stop, self.stop - self.release}

    def corners(self, time: float, x: np.ndarray) -> np.ndarray:
        return (self.carried.place(time) if self.carried else x)[self.triangles]

    def stiffness_at(self, time: float, distance: float) -> float:
        """Falls smoothly with the distance, and at the end of its time."""
        fading = 0.0
        if self.release:
            fading = max(0.0, (time - (self.stop - self.release)) / self.release)
        if distance >= self.far or fading >= 1:
            return 0.0
        return self.stiffness * (1 - fading**2)**2 * (1 - (distance / self.far)**2)**2

    def by_particle(self) -> dict[int, list[Bond]]:
        return {
            particle: [bond for bond in self.bonds if bond.particle == particle]
            for particle in sorted({bond.particle for bond in self.bonds})
        }

    def update(self, time: float, x: np.ndarray) -> None:
        """Once a step: bonds break, then particles without any form some."""
        corners = self.corners(time, x)
        if not self.start <= time < self.stop:
            self.bonds = []
            return
        for particle, bonds in self.by_particle().items():
            target = np.mean([frame_at(corners[b.triangle], b).place for b in bonds], axis=0)
            if np.linalg.norm(target - x[particle]) > self.far:
                self.bonds = [bond for bond in self.bonds if bond.particle != particle]
        stuck = {bond.particle for bond in self.bonds}
        for particle in (p for p in self.particles if p not in stuck):
            away = np.linalg.norm(x[particle] - nearest_on(corners, x[particle]), axis=1)
            is_near = away <= self.near
            if self.carried is None:
                is_near &= np.all(self.triangles != particle, axis=1)
            for number in np.flatnonzero(is_near):
                self.bonds.append(bond_at(particle, number, corners[number], x[particle]))

    def elastic(self, time: float, x: np.ndarray) -> np.ndarray:
        corners, force = self.corners(time, x), np.zeros_like(x)
        for particle, bonds in self.by_particle().items():
            frames = [frame_at(corners[bond.triangle], bond) for bond in bonds]
            away = np.mean([frame.place for frame in frames], axis=0) - x[particle]
            pull = self.stiffness_at(time, float(np.linalg.norm(away))) * away
            force[particle] += pull
            if self.carried is None:
                for bond, frame in zip(bonds, frames):
                    for corner, jacobian in zip(self.triangles[bond.triangle], frame.jacobian):
                        force[corner] -= jacobian.T @ pull / len(bonds)
        return force

    def damping(self, time: float, x: np.ndarray,
                _seen: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """-k tau G^T G with G v = v_t - v; what a moving object adds to v_t is known."""
        matrix, known = nothing(len(x))
        corners = self.corners(time, x)
        for particle, bonds in self.by_particle().items():
            frames = [frame_at(corners[bond.triangle], bond) for bond in bonds]
            away = np.mean([frame.place for frame in frames], axis=0) - x[particle]
            factor = self.tau * self.stiffness_at(time, float(np.linalg.norm(away)))
            rows = np.zeros((3, len(x), 3))  # G
            rows[:, particle, :] -= np.eye(3)
            if self.carried is None:
                for bond, frame in zip(bonds, frames):
                    for corner, jacobian in zip(self.triangles[bond.triangle], frame.jacobian):
                        rows[:, corner, :] += jacobian / len(bonds)
            else:
                speeds = self.carried.velocity(time)
                known[particle] += factor * sum(
                    np.einsum("kij,kj->i", frame.jacobian, speeds[self.triangles[bond.triangle]])
                    for bond, frame in zip(bonds, frames)
                ) / len(bonds)
            rows = rows.reshape(3, -1)
            matrix -= factor * rows.T @ rows
        return matrix, known


def bond_at(particle: int, number: int, corners: np.ndarray, p: np.ndarray) -> Bond:
    a, b, c = corners
    normal = np.cross(b - a, c - a)
    height = float((p - a) @ normal / np.linalg.norm(normal))
    return Bond(particle, number, weights_of(corners[None], p)[0], height)
