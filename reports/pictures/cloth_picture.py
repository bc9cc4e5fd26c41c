"""Draws a triangle mesh into an RGBA picture: z-buffer, normals interpolated per sample, two sides
of two colours or a field's, and the shadows of one light.

Light is added up in linear colour and averaged over the samples of a pixel before it becomes sRGB.
"""
from __future__ import annotations

from dataclasses import dataclass
from io import BytesIO

import numpy as np
from matplotlib import image

from pictures.camera import Camera
from pictures.look import MARK, SET_BACK, STUCK
from pictures.raster import Raster, rasterise
from pictures.shading import Surface, shade

SAMPLES = 2                                 # per pixel along each axis
COARSE = 64                                 # triangles; up to here every triangle is shaded flat
WEBP_QUALITY = 72                           # of 100; outlines are kept without a loss


@dataclass
class Cloth:
    """The cloth in one frame: N particles, M triangles; those that are not finite are left out."""
    x: np.ndarray                   # N x 3 [m]
    triangles: np.ndarray           # M x 3
    held: np.ndarray                # N, what is marked
    stuck: np.ndarray | None = None  # N, what is marked in another colour
    # N, places on the colour bar `colours`; None: two sides of two colours
    codes: np.ndarray | None = None
    colours: str = ""


@dataclass
class Scenery:
    """Objects in one frame: V vertices, F triangles."""
    x: np.ndarray                   # V x 3 [m]
    triangles: np.ndarray           # F x 3
    ground: np.ndarray              # V, true for what has no end
    centre: np.ndarray              # 3 [m], of the cloth in all frames
    reach: float                    # [m], how far the cloth goes from there


def picture_of(cloth: Cloth, camera: Camera, scenery: Scenery | None = None) -> np.ndarray:
    """The picture, RGBA, height x width x 4, uint8."""
    return finish_pixels(paint(cloth, camera, scenery))


def paint(cloth: Cloth, camera: Camera, scenery: Scenery | None = None) -> np.ndarray:
    """Linear light and coverage of every sample, height x width x 4, SAMPLES
    times the camera's pixels each way."""
    width, height = (SAMPLES * size for size in camera.pixels)
    surface = _surface_of(cloth, scenery)
    points, nearness = camera.project(surface.x, SAMPLES)
    nearness[surface.particles:] -= SET_BACK * max(camera.metres)
    raster = rasterise(points, nearness, surface.triangles, (height, width))
    seen = raster.seen >= 0
    colour = np.zeros((height, width, 4), dtype=np.float32)
    light, cover = shade(raster, surface, camera, SAMPLES)
    for channel in range(3):
        colour[:, :, channel][seen] = light[channel]
    colour[:, :, 3][seen] = cover
    for marked, ink in ((cloth.held, MARK), (cloth.stuck, STUCK)):
        if marked is not None:
            _mark(colour, (points, nearness), marked, raster, (0.02 * max(camera.metres), ink))
    return colour


def finish_pixels(colour: np.ndarray, size: int = SAMPLES) -> np.ndarray:
    """Averages size x size samples (weighted by coverage) to a pixel and
    turns linear light into 8-bit sRGB."""
    height, width = colour.shape[0] // size, colour.shape[1] // size
    weighted = colour[:height * size, :width * size].copy()
    weighted[:, :, :3] *= weighted[:, :, 3:]
    lines = sum(weighted[k::size] for k in range(size))
    mean = sum(lines[:, k::size] for k in range(size)) / np.float32(size * size)
    light = np.clip(mean[:, :, :3] / np.maximum(mean[:, :, 3:], 1e-6), 0.0, 1.0)
    code = np.arange(4097) / 4096
    srgb = np.where(code <= 0.0031308, 12.92 * code, 1.055 * code ** (1 / 2.4) - 0.055)
    encoded = np.round(255 * srgb).astype(np.uint8)[np.round(4096 * light).astype(np.int16)]
    return np.concatenate([encoded, np.round(255 * mean[:, :, 3:]).astype(np.uint8)], axis=2)


def webp_bytes(picture: np.ndarray) -> bytes:
    """The picture as a WebP file: its outlines without a loss, its colours
    nearly so, in a fifth of the space."""
    buffer = BytesIO()
    image.imsave(buffer, picture, format="webp", pil_kwargs={"quality": WEBP_QUALITY, "method": 5})
    return buffer.getvalue()


def _surface_of(cloth: Cloth, scenery: Scenery | None) -> Surface:
    """A coarse mesh is taken apart: three corners of its own for every triangle, behind the
    particles, which keep the marks."""
    x, triangles, codes = cloth.x, cloth.triangles, cloth.codes
    if len(triangles) <= COARSE:
        corners = len(x) + np.arange(3 * len(triangles)).reshape(-1, 3)
        x = np.concatenate([x, x[triangles].reshape(-1, 3)])
        codes = None if codes is None else np.concatenate([codes, codes[triangles].ravel()])
        triangles = corners
    ground = np.zeros(len(x), dtype=bool)
    if scenery is None:
        centre = np.median(cloth.x[np.isfinite(cloth.x).all(axis=1)], axis=0)
        return Surface(x, triangles, len(x), ground, centre, 1.0, codes, cloth.colours)
    return Surface(
        np.concatenate([x, scenery.x]), np.concatenate([triangles, scenery.triangles + len(x)]),
        len(x), np.concatenate([ground, scenery.ground]), scenery.centre, scenery.reach, codes,
        cloth.colours
    )


def _mark(
    colour: np.ndarray, place: tuple[np.ndarray, np.ndarray], marked: np.ndarray, raster: Raster,
    pen: tuple[float, np.ndarray]
) -> None:
    """A ringed dot on every marked particle, weaker where cloth hides it. place: of all points in
    the picture, and their nearness [m]; pen: behind how much a dot
    is hidden [m], and its colour."""
    (points, nearness), (behind, inside) = place, pen
    which = np.flatnonzero(marked & np.isfinite(points[:len(marked)]).all(axis=1))
    radius = (7.0 if len(which) <= 60 else 3.2) * SAMPLES
    reach = int(radius) + 1
    dy, dx = np.mgrid[-reach:reach + 1, -reach:reach + 1]
    distance = np.hypot(dx, dy)
    height, width = raster.seen.shape
    for particle in which:
        column, line = (int(value) for value in points[particle])
        if not (reach <= column < width - reach and reach <= line < height - reach):
            continue
        hidden = raster.nearness[line, column] > nearness[particle] + behind
        patch = colour[line - reach:line + reach + 1, column - reach:column + reach + 1]
        ink = np.where((distance > 0.68 * radius)[:, :, None], 0.95, inside)
        alpha = (np.clip(radius - distance + 0.5, 0.0, 1.0) * (0.35 if hidden else 1.0))[:, :, None]
        patch[:, :, :3] = patch[:, :, :3] * (1 - alpha) + ink * alpha
        patch[:, :, 3:] = np.maximum(patch[:, :, 3:], alpha)
