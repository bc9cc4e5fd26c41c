"""A case file as a model: masses, forces, prescribed particles, and what modifies velocities."""

import tomllib
from pathlib import Path
import numpy as np

from beyond import Air, Membrane
from forces import Bending, Gravity, Springs
from motion import Motion
from objects import Collision, Object, points_of
from state import Span, State, Unsupported
from sticking import Carried, Sticky
from strain import StrainLimits
from surface import Surface, read_obj, sheet, surface_of


KNOWN = {
    "title", "about", "cloth", "start", "gravity", "stretch", "strain_limits", "bending", "hold",
    "object", "collision", "sticky", "time", "solver", "air", "membrane", "fabric"
}


class Model:
    """See read_case."""

    def __init__(self, case: dict, folder: Path) -> None:
        if unknown := set(case) - KNOWN:
            raise Unsupported(f"tables {', '.join(sorted(unknown))}")
        self.case = case
        self.cloth = surface_of(*rest_shape(case["cloth"], folder),
                                flat_pattern(case["cloth"], folder))
        self.fabric_of = fabrics(case, self.cloth)
        self.mass = np.zeros(len(self.cloth.rest))  # kg
        for corners, area, t in zip(self.cloth.triangles, self.cloth.triangle_areas,
                                    range(len(self.cloth.triangles))):
            self.mass[corners] += self.of_fabric("cloth", t)["density"] * area / 3
        self.start = start_state(case.get("start", {}), self.cloth.rest)
        self.held = np.zeros(len(self.mass), dtype=bool)
        self.holds: list[tuple[np.ndarray, Motion]] = []
        for keys in case.get("hold", []):
            chosen = held_particles(keys, self.start.x)
            self.held[chosen] = True
            self.holds.append((chosen, Motion(keys)))
        self.objects = [Object(keys, folder) for keys in case.get("object", [])]
        self.patches = [sticky(keys, self) for keys in case.get("sticky", [])]
        motions = [motion for _, motion in self.holds] + [one.motion for one in self.objects]
        # s
        self.events = {time for motion in motions for time in (motion.start, motion.stop)}
        self.events.update(time for patch in self.patches for time in patch.events())
        self.start = self.start._replace(v=self.prescribed_velocity(self.start.v, 0.0, 0.0))
        self.forces = forces_of(case, self)
        self.filters = filters_of(case, self)

    def of_fabric(self, table: str, triangle: int) -> dict:
        """The keys of [cloth], [stretch] or [bending] with those of the triangle's [[fabric]]."""
        own = self.fabric_of[triangle]
        return self.case[table] | (own if table == "cloth" else own.get(table, {}))

    def elastic(self, time: float, x: np.ndarray) -> np.ndarray:
        return sum((force.elastic(time, x) for force in self.forces), np.zeros_like(x))

    def damping(self, time: float, x: np.ndarray,
                seen: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        parts = [force.damping(time, x, seen) for force in self.forces]
        return sum(part[0] for part in parts), sum(part[1] for part in parts)

    def prescribed_velocity(self, v: np.ndarray, time: float, since: float) -> np.ndarray:
        """v, but prescribed particles have the velocity of their motion; `since` as for Motion."""
        v = v.copy()
        for chosen, motion in self.holds:
            v[chosen] = motion.speed(self.start.x[chosen], time, since)
        return v

    def prescribed_place(self, x: np.ndarray, time: float, since: float) -> np.ndarray:
        """x, but prescribed particles are where their motion has them."""
        x = x.copy()
        for chosen, motion in self.holds:
            x[chosen] = motion.place(self.start.x[chosen], time, since)
        return x

    def mean_velocity(self, now: State, v: np.ndarray, h: float) -> np.ndarray:
        """v, but prescribed particles have the velocity that takes them to their places at the end
        of a step h from now."""
        v = v.copy()
        for chosen, motion in self.holds:
            place = motion.place(self.start.x[chosen], now.time + h, now.time)
            v[chosen] = (place - now.x[chosen]) / h
        return v

    def update_bonds(self, state: State) -> None:
        for patch in self.patches:
            patch.update(state.time, state.x)

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


def flat_pattern(keys: dict, folder: Path) -> np.ndarray | None:
    if "mesh" not in keys or "pattern" not in keys:
        return None
    points, triangles = read_obj(folder / keys["pattern"])
    return keys.get("pattern_scale", 1.0) * points[triangles]


def fabrics(case: dict, cloth: Surface) -> list[dict]:
    """The table [[fabric]] of each triangle, the last that names it; {} without."""
    own: list[dict] = [{} for _ in cloth.triangles]
    for keys in case.get("fabric", []):
        for t in region(keys, "triangles", cloth.rest[cloth.triangles].mean(axis=1)):
            own[t] = keys
    return own


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
        each = [model.of_fabric("stretch", t) for t in range(len(model.cloth.triangles))]
        forces.append(Springs(model.cloth, each, rest_length_scale(case)))
    if "membrane" in case:
        forces.append(Membrane(model.cloth, case["membrane"]))
    if "bending" in case:
        each = [model.of_fabric("bending", t) for t in range(len(model.cloth.triangles))]
        forces.append(Bending(model.cloth, each))
    if "air" in case:
        forces.append(Air(model.cloth, case["air"]))
    return forces + model.patches


def rest_length_scale(case: dict) -> float:
    return case["stretch"].get("rest_length_scale", 1.0)


def filters_of(case: dict, model: Model) -> list:
    filters: list = []
    inverse_mass = np.where(model.held, 0.0, 1 / model.mass)
    if "strain_limits" in case:
        filters.append(StrainLimits(model.cloth, inverse_mass, case["strain_limits"],
                                    rest_length_scale(case)))
    if model.objects:
        keys = case.get("collision", {})
        if keys.get("response", "forecast") != "forecast":
            raise Unsupported(f"collision response {keys['response']}")
        points = points_of(model.cloth, inverse_mass, keys.get("points", "particles"))
        filters.append(Collision(model.objects, points, keys.get("forecast_time", 0.0)))
    return filters


def region(keys: dict, name: str, places: np.ndarray) -> list[int]:
    """Numbers given under `name`, or of places in a box or sphere; all if nothing is asked."""
    if name in keys:
        return list(keys[name])
    inside = np.ones(len(places), dtype=bool)
    if "box" in keys:
        low, high = np.array(keys["box"])
        inside = np.all((low <= places) & (places <= high), axis=1)
    elif "sphere" in keys:
        away = places - np.array(keys["sphere"]["center"])
        inside = np.linalg.norm(away, axis=1) <= keys["sphere"]["radius"]
    elif "group" in keys:
        raise Unsupported("regions that are groups")
    return np.flatnonzero(inside).tolist()


def sticky(keys: dict, model: Model) -> Sticky:
    surface, carried = keys["surface"], None
    triangles, corners = model.cloth.triangles, model.start.x
    if surface["of"] != "cloth":
        one = next(one for one in model.objects if one.name == surface["of"])
        triangles, corners = one.triangles, one.corners
        carried = Carried(corners, one.motion)
    chosen = region(surface, "triangles", corners[triangles].mean(axis=1))
    particles = region(keys["particles"], "particles", model.start.x)
    return Sticky(keys, triangles[chosen], particles, carried)


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
