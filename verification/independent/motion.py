"""Prescribed motion: X(t) = C + R(w t)(X0 - C) + velocity t +
amplitude (sin(2 pi f t + p) - sin p)."""

import math

import numpy as np


def rotation_about(axis: np.ndarray, angle: float) -> np.ndarray:
    """3 x 3, by the exponential of the cross product (Rodrigues)."""
    x, y, z = axis / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross


def turned_by(keys: dict) -> np.ndarray:
    """The rotation of a `turn`."""
    return rotation_about(np.array(keys["axis"], dtype=float), math.radians(keys["angle"]))


class Motion:
    """Of a hold or an object, by the keys of its table; at rest before `from` and after `until`.

    A step that begins at `since` and ends where the motion stops sees it go on: see `clock`."""

    def __init__(self, keys: dict) -> None:
        def vector(key: str) -> np.ndarray:
            return np.array(keys.get(key, [0.0, 0.0, 0.0]), dtype=float)

        self.velocity, self.amplitude, self.center = map(
            vector, ("velocity", "amplitude", "center")
        )
        self.spin = np.radians(vector("angular_velocity"))
        self.rate = 2 * math.pi * keys.get("frequency", 0.0)
        self.phase = math.radians(keys.get("phase", 0.0))
        self.start, self.stop = keys.get("from", 0.0), keys.get("until", math.inf)

    def runs(self, since: float) -> bool:
        return self.start <= since < self.stop

    def clock(self, time: float, since: float) -> float:
        """The t of the formula [s]."""
        if self.runs(since):
            return time - self.start
        return 0.0 if since < self.start else self.stop - self.start

    def rotation(self, time: float, since: float) -> np.ndarray:
        angle = float(np.linalg.norm(self.spin)) * self.clock(time, since)
        return rotation_about(self.spin, angle) if angle else np.eye(3)

    def shift(self, time: float, since: float) -> np.ndarray:
        t = self.clock(time, since)
        swing = math.sin(self.rate * t + self.phase) - math.sin(self.phase)
        return self.velocity * t + self.amplitude * swing

    def place(self, start: np.ndarray, time: float, since: float) -> np.ndarray:
        """Of points that are at `start` (k x 3) before the motion begins."""
        turned = self.center + (start - self.center) @ self.rotation(time, since).T
        return turned + self.shift(time, since)

    def start_of(self, place: np.ndarray, time: float) -> np.ndarray:
        """Where points are before the motion begins that are at `place` (k x 3) at a time."""
        arm = place - self.shift(time, time) - self.center
        return self.center + arm @ self.rotation(time, time)

    def speed(self, start: np.ndarray, time: float, since: float) -> np.ndarray:
        """The derivative of `place`."""
        if not self.runs(since):
            return np.zeros_like(start)
        swing = self.rate * math.cos(self.rate * self.clock(time, since) + self.phase)
        arm = (start - self.center) @ self.rotation(time, since).T
        return np.cross(self.spin, arm) + self.velocity + self.amplitude * swing
