"""Which samples of a picture the light reaches: the light's own z-buffer, looked into several times
for each sample, so that the edges of shadows are soft."""
from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from pictures.camera import Camera, fit_camera
from pictures.raster import rasterise

TEXELS = 512                        # along the longer side of the light's picture
SOFT = 2.6                          # texels: how far around a sample's place is looked
TAPS = 8                            # looks for each sample
# texels around the light's picture: more than 2 SOFT, so that no look leaves them
RIM = 7


@dataclass
class ShadowMap:
    """How near to the light its nearest surface is, as the light sees it (orthographic)."""
    camera: Camera
    nearness: np.ndarray            # height x width [m]; -inf where there is nothing


def shadow_map(x: np.ndarray, triangles: np.ndarray, light: np.ndarray) -> ShadowMap | None:
    """The view of a light far away in the direction `light` (3, unit) on triangles M x 3 of points
    x (N x 3 [m]); None if there is nothing that casts a shadow."""
    points = x[np.unique(triangles)]
    points = points[np.isfinite(points).all(axis=1)]
    if not len(points):
        return None
    right = np.cross([0.0, 1.0, 0.0] if abs(light[1]) < 0.95 else [0.0, 0.0, -1.0], light)
    right /= np.linalg.norm(right)
    camera = fit_camera(points, right, np.cross(light, right), light)
    camera = replace(camera, pixels_per_metre=TEXELS / max(camera.metres))
    width, height = camera.pixels
    return ShadowMap(camera, rasterise(*camera.project(x, 1), triangles, (height, width)).nearness)


def lit_share(shadows: ShadowMap, place: list[np.ndarray], towards_light: np.ndarray) -> np.ndarray:
    """From 0 (in the shadow) to 1, for S samples. place: their column, line and nearness as the
    light sees them; towards_light: cosine of the angle between normal and light."""
    texel = 1.0 / shadows.camera.pixels_per_metre
    cosine = np.clip(towards_light, 0.2, 1.0)
    least = place[2] + np.float32(texel) * (
        np.float32(1.5) + np.float32(SOFT) * np.sqrt(1 - cosine * cosine) / cosine
    )
    # beyond the light's picture nothing is in the way
    around = np.pad(shadows.nearness, RIM, constant_values=-np.inf)
    column, line = (
        np.clip(
            place[axis] + np.float32(RIM), np.float32(SOFT),
            np.float32(around.shape[1 - axis] - 1 - SOFT)
        )
        for axis in (0, 1)
    )
    nearest, lit = around.astype(np.float32).ravel(), np.zeros(len(least), dtype=np.uint8)
    for tap in range(TAPS):
        angle, radius = 2.4 * tap, SOFT * np.sqrt((tap + 0.5) / TAPS)
        texels = (line + np.float32(radius * np.sin(angle))).astype(np.int32)
        texels *= around.shape[1]
        texels += (column + np.float32(radius * np.cos(angle))).astype(np.int32)
        lit += nearest[texels] <= least
    return lit.astype(np.float32) / TAPS
