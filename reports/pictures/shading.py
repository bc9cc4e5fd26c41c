"""The light that comes from every sample of a picture: colour of cloth or field,
lights, shadow, edges of the mesh."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from data.cloth_values import area_normals
from pictures.camera import Camera
from pictures.look import (
    BACK, FILL_LIGHT, FRONT, GROUND, GROUND_FADES, KEY_LIGHT, OBJECT, field_colours
)
from pictures.raster import Raster, SeenSamples, faces_viewer
from pictures.shadows import lit_share, shadow_map

WRAP = 0.16                                 # how far the key light goes round, as a cosine
# of the picture's longer side: ground fades towards its border
BORDER = 0.09


@dataclass
class Surface:
    """Cloth and objects as one mesh of N vertices and M triangles; the first
    `particles` vertices are the cloth's."""
    x: np.ndarray                   # N x 3 [m]
    triangles: np.ndarray           # M x 3
    particles: int
    ground: np.ndarray              # N, true for what has no end
    centre: np.ndarray              # 3 [m], where ground is seen best
    reach: float                    # [m], how far it is seen well
    # particles, places on a colour bar; None: two sides of two colours
    codes: np.ndarray | None
    colours: str                    # that colour bar


def shade(
    raster: Raster, surface: Surface, camera: Camera, samples_per_pixel: int
) -> tuple[np.ndarray, np.ndarray]:
    """Linear RGB, 3 x S, and coverage, S, of every sample that sees a triangle, in raster order."""
    seen = SeenSamples(raster)
    of_object = (raster.triangles[:, 0] >= surface.particles)[seen.owner]
    on_ground = surface.ground[raster.triangles[:, 0]][seen.owner]
    front = faces_viewer(raster.planes)[seen.owner]
    normal = _normals(seen, surface, camera, front)
    colour = np.where(front, FRONT[:, None], BACK[:, None]).astype(np.float32)
    if surface.codes is not None:
        beyond = np.zeros(len(surface.x) - len(surface.codes))
        codes = seen.at(np.concatenate([surface.codes, beyond]))
        colour = field_colours(np.clip(codes, 0.0, 1.0), surface.colours)
    thing = np.where(on_ground, GROUND[:, None], OBJECT[:, None]).astype(np.float32)
    light, shine = _lights(normal, _light_share(seen, surface, camera, normal))
    of_field = ~of_object & (surface.codes is not None)
    # so that the colours of a field stay those of its bar
    light = np.where(of_field, 0.40 + 0.52 * light, light)
    colour = np.where(of_object, thing, colour) * light + np.where(of_field | on_ground, 0.0, shine)
    colour *= 1.0 - 0.34 * np.where(
        of_object, 0.0, _edge_lines(raster.planes, seen, samples_per_pixel)
    )
    cover = (
        np.where(on_ground, _ground_cover(seen, surface), 1.0)
        if on_ground.any()
        else np.ones(len(front))
    )
    return colour, cover


def vertex_normals(x: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Area-weighted unit normals, N x 3; zero where no finite triangle touches a particle."""
    faces = np.nan_to_num(area_normals(x, triangles), posinf=0.0, neginf=0.0)
    total = np.zeros((len(x), 3))
    for axis in range(3):
        for corner in range(3):
            total[:, axis] += np.bincount(triangles[:, corner], faces[:, axis], minlength=len(x))
    return total / np.maximum(np.linalg.norm(total, axis=1, keepdims=True), 1e-300)


def world_light(camera: Camera) -> np.ndarray:
    """The direction to the light that casts shadows, 3, unit."""
    light = np.stack([camera.right, camera.up, camera.toward]).T @ KEY_LIGHT
    return light / np.linalg.norm(light)


def _normals(
    seen: SeenSamples, surface: Surface, camera: Camera, front: np.ndarray
) -> list[np.ndarray]:
    """Unit normals in camera axes (right, up, toward), turned to the viewer."""
    turned = vertex_normals(surface.x, surface.triangles) @ np.stack(
        [camera.right, camera.up, camera.toward], axis=1
    )
    normal = [seen.at(turned[:, axis]) for axis in range(3)]
    sign = np.where(front, np.float32(1), np.float32(-1))
    normal = [sign * normal[0], sign * normal[1], np.abs(normal[2])]
    length = np.maximum(np.sqrt(normal[0] ** 2 + normal[1] ** 2 + normal[2] ** 2), 1e-12)
    return [component / length for component in normal]


def _toward(light: np.ndarray, normal: list[np.ndarray]) -> np.ndarray:
    x, y, z = (np.float32(value) for value in light / np.linalg.norm(light))
    return x * normal[0] + y * normal[1] + z * normal[2]


def _light_share(
    seen: SeenSamples, surface: Surface, camera: Camera, normal: list[np.ndarray]
) -> np.ndarray:
    """From 0 to 1, S: how much of each sample the key light reaches. Ground casts no shadow."""
    casters = surface.triangles[~surface.ground[surface.triangles[:, 0]]]
    with np.errstate(invalid="ignore"):
        near = np.abs(surface.x - surface.centre).max(axis=1) < 4.0 * max(camera.metres)
    shadows = shadow_map(surface.x, casters[near[casters].all(axis=1)], world_light(camera))
    if shadows is None:
        return np.ones(len(seen.owner), dtype=np.float32)
    points, nearness = shadows.camera.project(np.nan_to_num(surface.x), 1)
    towards = _toward(KEY_LIGHT, normal)
    facing = np.flatnonzero(towards > -WRAP)            # the others get nothing of it anyway
    place = [seen.at(values)[facing] for values in (points[:, 0], points[:, 1], nearness)]
    reached = np.ones(len(towards), dtype=np.float32)
    reached[facing] = lit_share(shadows, place, towards[facing])
    return reached


def _lights(normal: list[np.ndarray], reached: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Light on a sample: soft from above, a wrapped key light where it reaches, a weak fill. And
    what shines back whatever the colour: a rim where the cloth turns away,
    and a little of the key light."""
    key = reached * np.clip((_toward(KEY_LIGHT, normal) + WRAP) / (1.0 + WRAP), 0.0, 1.0)
    fill = np.clip(_toward(FILL_LIGHT, normal), 0.0, 1.0)
    turned_away = 1.0 - normal[2]
    light = 0.20 + 0.22 * (0.5 + 0.5 * normal[1]) + 0.98 * key * np.sqrt(key) + 0.14 * fill
    return light, 0.08 * turned_away * turned_away * turned_away + 0.03 * key * key * key * key


def _edge_lines(planes: np.ndarray, seen: SeenSamples, samples_per_pixel: int) -> np.ndarray:
    """0 to 1: the mesh's edges as fine lines, fading out where
    triangles are only a few pixels large."""
    altitudes = (1.0 / np.maximum(np.hypot(planes[:, :, 0], planes[:, :, 1]), 1e-12)).astype(
        np.float32
    )
    distances = [seen.weights[corner] * altitudes[:, corner][seen.owner] for corner in range(3)]
    distance = np.minimum(np.minimum(distances[0], distances[1]), distances[2])
    fade = (altitudes.min(axis=1) / samples_per_pixel - 7.0) / 19.0
    strength = np.clip(fade, 0.0, 1.0)[seen.owner]
    return strength * np.clip(0.6 * samples_per_pixel + 0.5 - distance, 0.0, 1.0)


def _ground_cover(seen: SeenSamples, surface: Surface) -> np.ndarray:
    """1 near the cloth, 0 far from it and at the border of the picture: what has no
    end must not seem to have one."""
    upright = vertex_normals(surface.x, surface.triangles)
    offset = surface.x - surface.centre
    along = offset - upright * (upright * offset).sum(axis=1, keepdims=True)
    away = np.sqrt(sum(seen.at(along[:, axis]) ** 2 for axis in range(3))) / surface.reach
    near = np.clip((GROUND_FADES[1] - away) / (GROUND_FADES[1] - GROUND_FADES[0]), 0.0, 1.0)
    near *= np.clip(seen.from_border / BORDER, 0.0, 1.0)
    return near * near * (3.0 - 2.0 * near)
