"""A case file as a model: masses, forces, prescribed particles, and what modifies velocities."""

import tomllib
from pathlib import Path
from typing import NamedTuple

import numpy as np

from forces import Bending, Gravity, Springs
from motion import Motion
from surface import read_obj, sheet, surface_of


class State(NamedTuple):
    time: float  # s
    x: np.ndarray  # N x 3 [m]
    v: np.ndarray  # N x 3 [m/s]


class Span(NamedTuple):
    """When a velocity is corrected."""
    start: float  # of the motion that the velocity makes [s]
    end: float  # the same time if it is the velocity at the end of a step [s]
    step: float  # over which filters look ahead [s]


class Unsupported(Exception):
    """The case asks for something that this program does not do."""


KNOWN = {
    "title", "about", "cloth", "start", "gravity", "stretch", "bending", "hold", "time", "solver"
}


class Model:
    """See read_case."""

    def __init__(self, case: dict, folder: Path) -> None:
        if unknown := set(case) - KNOWN:
            raise Unsupported(f"tables {', '.join(sorted(unknown))}")
        self.case = case
        self.cloth = surface_of(*rest_shape(case["cloth"], folder))
        self.mass = case["cloth"]["density"] * self.cloth.areas  # kg
        self.start = start_state(case.get("start", {}), self.cloth.rest)
        self.held = np.zeros(len(self.mass), dtype=bool)
        self.holds: list[tuple[np.ndarray, Motion]] = []
        for keys in case.get("hold", []):
            chosen = held_particles(keys, self.start.x)
            self.held[chosen] = True
            self.holds.append((chosen, Motion(keys)))
        # s
        self.events = {time for _, motion in self.holds for time in (motion.start, motion.stop)}
        self.start = self.start._replace(v=self.prescribed_velocity(self.start.v, 0.0, 0.0))
        self.forces = forces_of(case, self)
        self.filters: list = []

    def elastic(self, time: float, x: np.ndarray) -> np.ndarray:
        return sum((force.elastic(time, x) for force in self.forces), np.zeros_like(x))

    def damping(self, time: float, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        parts = [force.damping(time, x) for force in self.forces]
        return sum(part[0] for part in parts), sum(part[1] for part in parts)

    def prescribed_velocity(self, v: np.ndarray, time: float, since: float) -> np.ndarray:
        """v, but prescribed particles have the velocity of their motion; `since` as for Motion."""
        v = v.copy()
        for chosen, motion in self.holds:
            v[chosen] = motion.speed(self.start.x[chosen], time, since)
        return v

    def mean_velocity(self, now: State, v: np.ndarray, h: float) -> np.ndarray:
        """v, but prescribed particles have the velocity that takes them to their places at the end
        of a step h from now."""
        v = v.copy()
        for chosen, motion in self.holds:
            place = motion.place(self.start.x[chosen], now.time + h, now.time)
            v[chosen] = (place - now.x[chosen]) / h
        return v

    def modify(self, span: Span, x: np.ndarray, v: np.ndarray) -> np.ndarray:
        """The paper's hook: strain limits first, then objects."""
        for correct in self.filters:
            v = correct(span, x, v)
        return v


def rest_shape(keys: dict, folder: Path) -> tuple[np.ndarray, np.ndarray]:
    if "mesh" in keys:
        points, triangles = read_obj(folder / keys["mesh"])
    elif keys["shape"] == "sheet":
        points, triangles = sheet(keys["width"], keys["height"], keys["columns"], keys["rows"])
    else:
        raise Unsupported(f"cloth shape {keys['shape']}")
    return points + np.array(keys.get("move", [0.0, 0.0, 0.0])), triangles


def start_state(keys: dict, rest: np.ndarray) -> State:
    center = rest.mean(axis=0)
    x = center + (rest - center) * np.array(keys.get("stretch", 1.0))
    spin = np.radians(np.array(keys.get("spin", [0.0, 0.0, 0.0])))
    v = np.array(keys.get("velocity", [0.0, 0.0, 0.0])) + np.cross(spin, x - center)
    return State(0.0, x, v)


def held_particles(keys: dict, x: np.ndarray) -> np.ndarray:
    if "particles" in keys:
        return np.array(keys["particles"])
    if "box" in keys:
        low, high = np.array(keys["box"])
        return np.flatnonzero(np.all((low <= x) & (x <= high), axis=1))
    top, bottom = x[:, 1].max(), x[:, 1].min()
    return np.flatnonzero(x[:, 1] >= top - keys["top"] * (top - bottom))


def forces_of(case: dict, model: Model) -> list:
    forces = []
    if "gravity" in case:
        acceleration = case["gravity"].get("acceleration", [0.0, -9.80665, 0.0])
        forces.append(Gravity(model.mass, np.array(acceleration)))
    if "stretch" in case:
        keys = case["stretch"]
        forces.append(Springs(model.cloth, keys["stiffness"], keys.get("damping", 0.0),
                              keys.get("rest_length_scale", 1.0)))
    if "bending" in case:
        forces.append(Bending(model.cloth, case["bending"]))
    return forces


def override(case: dict, path: str, value: object) -> None:
    """Sets a key given as `foldproof --set` takes it: table.key, or table.0.key of a list."""
    *way, last = path.split(".")
    table = case
    for word in way:
        table = table[int(word)] if isinstance(table, list) else table.setdefault(word, {})
    table[last] = value


def read_case(path: Path, changes: dict[str, object] | None = None) -> Model:
    """The model of a case file with some keys changed; Unsupported
    names what this program lacks."""
    case = tomllib.loads(path.read_text(encoding="utf-8"))
    for key, value in (changes or {}).items():
        override(case, key, value)
    return Model(case, path.parent)
