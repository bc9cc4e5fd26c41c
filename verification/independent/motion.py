"""Prescribed motion: X(t) = C + R(w t)(X0 - C) + velocity t +
amplitude (sin(2 pi f t + p) - sin p)."""

import math

import numpy as np


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
        """3 x 3, by the exponential of the cross product (Rodrigues)."""
        t = self.clock(time, since)
        angle = np.linalg.norm(self.spin) * t
        if angle == 0:
            return np.eye(3)
        x, y, z = self.spin / np.linalg.norm(self.spin)
        cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        return np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross

    def place(self, start: np.ndarray, time: float, since: float) -> np.ndarray:
        """Of points that are at `start` (k x 3) before the motion begins."""
        t = self.clock(time, since)
        swing = math.sin(self.rate * t + self.phase) - math.sin(self.phase)
        turned = self.center + (start - self.center) @ self.rotation(time, since).T
        return turned + self.velocity * t + self.amplitude * swing

    def speed(self, start: np.ndarray, time: float, since: float) -> np.ndarray:
        """The derivative of `place`."""
        if not self.runs(since):
            return np.zeros_like(start)
        swing = self.rate * math.cos(self.rate * self.clock(time, since) + self.phase)
        arm = (start - self.center) @ self.rotation(time, since).T
        return np.cross(self.spin, arm) + self.velocity + self.amplitude * swing
