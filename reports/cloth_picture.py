"""Draws a triangle mesh into an RGBA picture: z-buffer, normals interpolated per pixel, two-sided colour.

Every triangle is cut into rows and every row into a span of pixel centres, so no pixel outside a triangle
is visited. Light is added up in linear colour and averaged over SUPERSAMPLING^2 samples before it becomes
sRGB.
"""
from __future__ import annotations

from dataclasses import dataclass
from io import BytesIO

import numpy as np
from matplotlib import image

from camera import Camera, area_normals

SUPERSAMPLING = 2                           # samples per pixel along each axis; _finished averages just 2 x 2
COARSE = 64                                 # triangles; up to here every triangle is shaded flat
FRONT = np.array([0.56, 0.175, 0.085])      # linear RGB of the side that the triangles' normals point to
BACK = np.array([0.085, 0.20, 0.30])
OBJECT = np.array([0.30, 0.30, 0.29])       # what the cloth can hit, both sides
MARK = np.array([0.012, 0.014, 0.018])      # held particles
STUCK = np.array([0.60, 0.30, 0.01])        # particles that stick to something
KEY_LIGHT = np.array([-0.50, 0.62, 0.60])   # in camera axes: right, up, toward the viewer
FILL_LIGHT = np.array([0.85, -0.05, 0.50])
SET_BACK = 0.008                            # of the picture's size: cloth that lies on an object stays visible
WEBP_EFFORT = 40                            # of 100; 20 is a third faster and a tenth larger
PAIRS_AT_ONCE = 1_500_000                   # rows of triangles treated together, to bound memory


@dataclass
class Scenery:
    """Objects in one frame: positions V x 3 [m] and triangles F x 3."""
    x: np.ndarray
    triangles: np.ndarray


@dataclass
class Samples:
    """What each sample of the picture sees: its triangle (-1: nothing) and how near that is [m]."""
    triangle: np.ndarray   # height x width
    nearness: np.ndarray


def picture_of(x: np.ndarray, triangles: np.ndarray, held: np.ndarray, camera: Camera,
               scenery: Scenery | None = None, stuck: np.ndarray | None = None) -> np.ndarray:
    """The cloth at positions x (N x 3 [m]) and the objects, RGBA, height x width x 4, uint8. Triangles that
    are not finite are left out. held, stuck: N, what is marked."""
    width, height = (SUPERSAMPLING * size for size in camera.pixels)
    if len(triangles) <= COARSE:
        x, triangles, held = _taken_apart(x, triangles, held)
    particles = len(x)
    if scenery is not None:
        x, triangles = np.concatenate([x, scenery.x]), np.concatenate([triangles, scenery.triangles + len(x)])
        held = np.concatenate([held, np.zeros(len(scenery.x), dtype=bool)])
    normals = vertex_normals(x, triangles)
    points, nearness = camera.project(x, SUPERSAMPLING)
    nearness[particles:] -= SET_BACK * max(camera.metres)
    triangles = _drawable(points, triangles, (width, height))
    planes = _barycentric_planes(points, triangles)
    samples = _visible(points, nearness, triangles, planes, (height, width))
    light = _shaded(samples, triangles, planes, normals, camera, triangles[:, 0] >= particles)
    colour = np.zeros((height, width, 4), dtype=np.float32)
    seen = samples.triangle >= 0
    for channel in range(3):
        colour[:, :, channel][seen] = light[channel]
    colour[:, :, 3] = seen
    _mark(colour, points, nearness, held, samples, camera)
    if stuck is not None:
        beyond = np.zeros(len(points) - len(stuck), dtype=bool)
        _mark(colour, points, nearness, np.concatenate([stuck, beyond]), samples, camera, STUCK)
    return _finished(colour)


def webp_bytes(picture: np.ndarray) -> bytes:
    """The picture as a WebP file, without a loss: what is seen of it is that of a PNG file nearly twice as large."""
    buffer = BytesIO()
    image.imsave(buffer, picture, format="webp", pil_kwargs={"lossless": True, "method": 2, "quality": WEBP_EFFORT})
    return buffer.getvalue()


def _taken_apart(x: np.ndarray, triangles: np.ndarray, held: np.ndarray) -> tuple[np.ndarray, np.ndarray,
                 np.ndarray]:
    """The same mesh with three corners of its own for every triangle, behind the particles (which keep the
    marks)."""
    corners = len(x) + np.arange(3 * len(triangles)).reshape(-1, 3)
    marks = np.concatenate([held, np.zeros(3 * len(triangles), dtype=bool)])
    return np.concatenate([x, x[triangles].reshape(-1, 3)]), corners, marks


def vertex_normals(x: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Area-weighted unit normals, N x 3; zero where no finite triangle touches a particle."""
    faces = np.nan_to_num(area_normals(x, triangles), posinf=0.0, neginf=0.0)
    total = np.zeros((len(x), 3))
    for axis in range(3):
        for corner in range(3):
            total[:, axis] += np.bincount(triangles[:, corner], faces[:, axis], minlength=len(x))
    return total / np.maximum(np.linalg.norm(total, axis=1, keepdims=True), 1e-300)


def _drawable(points: np.ndarray, triangles: np.ndarray, size: tuple[int, int]) -> np.ndarray:
    """Triangles that are finite, meet the picture and are not edge-on."""
    corners = points[triangles]
    with np.errstate(invalid="ignore", over="ignore"):
        a, b, c = (corners[:, k] for k in range(3))
        twice_area = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
        meets = (corners.max(axis=1) >= 0).all(axis=1) & (corners.min(axis=1) <= np.array(size)).all(axis=1)
        modest = (np.abs(corners) < 1e6).all(axis=(1, 2))
        return triangles[meets & modest & (np.abs(twice_area) > 1e-9)]


def _barycentric_planes(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """M x 3 x 3: weight of corner k at pixel (px, py) is planes[m, k] . (px, py, 1)."""
    a, b, c = (points[triangles[:, corner]] for corner in range(3))
    rows = [_edge_plane(b, c), _edge_plane(c, a), _edge_plane(a, b)]
    twice_area = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    return np.stack(rows, axis=1) / twice_area[:, None, None]


def _edge_plane(p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Twice the signed area of (p, q, pixel) as an affine function of the pixel, M x 3."""
    return np.stack([p[:, 1] - q[:, 1], q[:, 0] - p[:, 0], p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]], axis=1)


def _visible(points: np.ndarray, nearness: np.ndarray, triangles: np.ndarray, planes: np.ndarray,
             shape: tuple[int, int]) -> Samples:
    """The z-buffer: the nearest triangle at every sample."""
    samples = Samples(np.full(shape, -1, dtype=np.int64), np.full(shape, -np.inf))
    depth_planes = np.einsum("mk,mkc->mc", nearness[triangles], planes)
    heights = points[triangles][:, :, 1]
    first = np.maximum(np.ceil(heights.min(axis=1) - 0.5).astype(int), 0)
    last = np.minimum(np.floor(heights.max(axis=1) - 0.5).astype(int), shape[0] - 1)
    rows = np.maximum(last - first + 1, 0)
    box = np.ptp(points[triangles][:, :, 0], axis=1)
    ends = np.cumsum(rows * (box + 2.0))
    cuts = np.searchsorted(ends, np.arange(PAIRS_AT_ONCE, ends[-1] if len(ends) else 0, PAIRS_AT_ONCE))
    for chunk in np.split(np.arange(len(triangles)), cuts):
        owner, line = _repeated(chunk, first[chunk], rows[chunk])
        start, count = _spans(planes[owner], line + 0.5, shape[1])
        which, column = _repeated(np.arange(len(owner)), start, count)
        pixel_owner, pixel_line = owner[which], line[which]
        plane = depth_planes[pixel_owner]
        near = plane[:, 0] * (column + 0.5) + plane[:, 1] * (pixel_line + 0.5) + plane[:, 2]
        _keep_nearest(samples, pixel_line * shape[1] + column, near, pixel_owner)
    return samples


def _repeated(items: np.ndarray, first: np.ndarray, count: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Each item count times, beside first, first + 1, ..."""
    total = int(count.sum())
    offset = np.arange(total) - np.repeat(np.cumsum(count) - count, count)
    return np.repeat(items, count), np.repeat(first, count) + offset


def _spans(planes: np.ndarray, y: np.ndarray, width: int) -> tuple[np.ndarray, np.ndarray]:
    """First pixel and number of pixels whose centres lie in the triangle, for triangles `planes` on lines
    y."""
    left, right = np.zeros(len(y)), np.full(len(y), float(width))
    for corner in range(3):
        slope = planes[:, corner, 0]
        rest = planes[:, corner, 1] * y + planes[:, corner, 2]
        with np.errstate(divide="ignore", invalid="ignore"):
            crossing = -rest / slope
        left = np.where(slope > 0, np.maximum(left, crossing), left)
        right = np.where(slope < 0, np.minimum(right, crossing), right)
        right = np.where((slope == 0) & (rest < 0), -1.0, right)
    start = np.ceil(np.clip(left, 0, width) - 0.5 - 1e-7).astype(int)
    stop = np.floor(np.clip(right, -1, width) - 0.5 + 1e-7).astype(int)
    start, stop = np.maximum(start, 0), np.minimum(stop, width - 1)
    return start, np.maximum(stop - start + 1, 0)


def _keep_nearest(samples: Samples, pixel: np.ndarray, near: np.ndarray, owner: np.ndarray) -> None:
    triangle, nearness = samples.triangle.reshape(-1), samples.nearness.reshape(-1)
    while True:  # of equal pixels the last written stays; those nearer than that are written again
        better = np.flatnonzero(near > nearness[pixel])
        if not len(better):
            return
        pixel, near, owner = pixel[better], near[better], owner[better]
        triangle[pixel], nearness[pixel] = owner, near


def _shaded(samples: Samples, triangles: np.ndarray, planes: np.ndarray, normals: np.ndarray,
            camera: Camera, of_object: np.ndarray) -> np.ndarray:
    """Linear RGB of every sample that sees a triangle, 3 x S in raster order. of_object: M."""
    seen = np.flatnonzero(samples.triangle.ravel() >= 0)
    owner = samples.triangle.ravel()[seen]
    column = (seen % samples.triangle.shape[1] + 0.5).astype(np.float32)
    line = (seen // samples.triangle.shape[1] + 0.5).astype(np.float32)
    weights = [_affine(planes[:, corner], owner, column, line) for corner in range(3)]
    front = _faces_viewer(planes)[owner]
    normal = _normals_of_samples(weights, triangles, owner, normals, front, camera)
    cloth = np.where(front, FRONT[:, None], BACK[:, None])
    colour = _lit(normal, np.where(of_object[owner], OBJECT[:, None], cloth).astype(np.float32))
    colour *= 1.0 - 0.42 * _sunken(samples, camera).ravel()[seen]
    lines = np.where(of_object[owner], 0.0, _edge_lines(planes, owner, weights))
    return colour * (1.0 - 0.34 * lines)


def _affine(plane: np.ndarray, owner: np.ndarray, column: np.ndarray, line: np.ndarray) -> np.ndarray:
    """plane[owner] . (column, line, 1) for planes M x 3, about the first sample's place to spare single
    precision."""
    column0, line0 = float(column[0]) if len(column) else 0.0, float(line[0]) if len(line) else 0.0
    level = plane[:, 0] * column0 + plane[:, 1] * line0 + plane[:, 2]
    slopes = plane.astype(np.float32)
    across = slopes[:, 0][owner] * (column - np.float32(column0))
    down = slopes[:, 1][owner] * (line - np.float32(line0))
    return across + down + level.astype(np.float32)[owner]


def _faces_viewer(planes: np.ndarray) -> np.ndarray:
    """True where a triangle shows its front: its outline then runs clockwise in pixels, whose y points
    down."""
    return planes[:, 0, 0] * planes[:, 1, 1] - planes[:, 0, 1] * planes[:, 1, 0] < 0


def _normals_of_samples(weights: list[np.ndarray], triangles: np.ndarray, owner: np.ndarray,
                        normals: np.ndarray, front: np.ndarray, camera: Camera) -> list[np.ndarray]:
    """Unit normals in camera axes (right, up, toward), turned to the viewer; flat where the mesh is very
    coarse."""
    turned = (normals @ np.stack([camera.right, camera.up, camera.toward], axis=1)).astype(np.float32)
    corners = [triangles[:, corner][owner] for corner in range(3)]
    normal = [sum(weight * turned[:, axis][corner] for weight, corner in zip(weights, corners))
              for axis in range(3)]
    sign = np.where(front, np.float32(1), np.float32(-1))
    normal = [sign * normal[0], sign * normal[1], np.abs(normal[2])]
    length = np.maximum(np.sqrt(normal[0] ** 2 + normal[1] ** 2 + normal[2] ** 2), 1e-12)
    return [component / length for component in normal]


def _lit(normal: list[np.ndarray], cloth: np.ndarray) -> np.ndarray:
    """Soft ambient from above, a wrapped key light, a weak fill, and a rim where the cloth turns away; 3 x
    S."""
    def toward(light: np.ndarray) -> np.ndarray:
        x, y, z = (np.float32(value) for value in light / np.linalg.norm(light))
        return x * normal[0] + y * normal[1] + z * normal[2]

    key = np.clip((toward(KEY_LIGHT) + 0.16) / 1.16, 0.0, 1.0)
    fill = np.clip(toward(FILL_LIGHT), 0.0, 1.0)
    key_squared, turned_away = key * key, 1.0 - normal[2]
    light = 0.16 + 0.20 * (0.5 + 0.5 * normal[1]) + 1.02 * key * np.sqrt(key) + 0.14 * fill
    return cloth * light + (0.10 * turned_away * turned_away * turned_away + 0.03 * key_squared * key_squared)


def _sunken(samples: Samples, camera: Camera) -> np.ndarray:
    """0 to 1: how far a sample lies behind its surroundings, which a reader takes for shadow in the folds."""
    coarse = (slice(None, None, 2), slice(None, None, 2))
    mask = (samples.triangle[coarse] >= 0).astype(float)
    near = np.where(mask > 0, samples.nearness[coarse], 0.0)
    radius = max(2, int(0.022 * max(mask.shape)))
    amount, total = mask, near
    for _ in range(2):
        amount, total = _box_mean(amount, radius), _box_mean(total, radius)
    behind = total / np.maximum(amount, 1e-6) - near
    sunken = np.clip(behind / (0.05 * max(camera.metres)), 0.0, 1.0).astype(np.float32)
    fine = sunken.repeat(2, axis=0).repeat(2, axis=1)
    return fine[:samples.triangle.shape[0], :samples.triangle.shape[1]]


def _box_mean(values: np.ndarray, radius: int) -> np.ndarray:
    size = 2 * radius + 1
    for _ in range(2):  # along the rows, then, transposed, along the columns
        total = np.cumsum(np.pad(values, [(radius + 1, radius), (0, 0)]), axis=0)
        values = ((total[size:] - total[:-size]) / size).T
    return values


def _edge_lines(planes: np.ndarray, owner: np.ndarray, weights: list[np.ndarray]) -> np.ndarray:
    """0 to 1: the mesh's edges as fine lines, fading out where triangles are only a few pixels large."""
    altitudes = (1.0 / np.maximum(np.hypot(planes[:, :, 0], planes[:, :, 1]), 1e-12)).astype(np.float32)
    distances = [weights[corner] * altitudes[:, corner][owner] for corner in range(3)]
    distance = np.minimum(np.minimum(distances[0], distances[1]), distances[2])
    fade = (altitudes.min(axis=1) / SUPERSAMPLING - 5.0) / 14.0
    strength = np.clip(fade, 0.0, 1.0)[owner]
    return strength * np.clip(0.45 * SUPERSAMPLING + 0.5 - distance, 0.0, 1.0)


def _mark(colour: np.ndarray, points: np.ndarray, nearness: np.ndarray, held: np.ndarray, samples: Samples,
          camera: Camera, inside: np.ndarray = MARK) -> None:
    """A ringed dot of the colour `inside` on every particle of `held`, weaker where cloth hides it."""
    which = np.flatnonzero(held & np.isfinite(points).all(axis=1))
    radius = (5.4 if len(which) <= 60 else 2.4) * SUPERSAMPLING
    reach = int(radius) + 1
    dy, dx = np.mgrid[-reach:reach + 1, -reach:reach + 1]
    distance = np.hypot(dx, dy)
    height, width = samples.triangle.shape
    for particle in which:
        column, line = (int(value) for value in points[particle])
        if not (reach <= column < width - reach and reach <= line < height - reach):
            continue
        hidden = samples.nearness[line, column] > nearness[particle] + 0.02 * max(camera.metres)
        patch = colour[line - reach:line + reach + 1, column - reach:column + reach + 1]
        ink = np.where((distance > 0.68 * radius)[:, :, None], 0.95, inside)
        alpha = (np.clip(radius - distance + 0.5, 0.0, 1.0) * (0.35 if hidden else 1.0))[:, :, None]
        patch[:, :, :3] = patch[:, :, :3] * (1 - alpha) + ink * alpha
        patch[:, :, 3:] = np.maximum(patch[:, :, 3:], alpha)


def _finished(colour: np.ndarray) -> np.ndarray:
    """Averages the samples (weighted by coverage) and turns linear light into 8-bit sRGB."""
    colour[:, :, :3] *= colour[:, :, 3:]
    lines = colour[0::2] + colour[1::2]
    mean = 0.25 * (lines[:, 0::2] + lines[:, 1::2])
    light = np.clip(mean[:, :, :3] / np.maximum(mean[:, :, 3:], 1e-6), 0.0, 1.0)
    code = np.arange(4097) / 4096
    srgb = np.where(code <= 0.0031308, 12.92 * code, 1.055 * code ** (1 / 2.4) - 0.055)
    encoded = np.round(255 * srgb).astype(np.uint8)[np.round(4096 * light).astype(np.int16)]
    return np.concatenate([encoded, np.round(255 * mean[:, :, 3:]).astype(np.uint8)], axis=2)
