"""A case as the view in the page needs it: a text of a few kilobytes, which viewer_data.js unpacks.

The text is base64 of raw deflate of: the header's length (4 bytes, little endian), the header
(JSON), then the arrays that it lists, one after the other. Whole numbers are differences to what is
expected, and stand as all their lowest bytes, then all their second bytes, and so on, since most of
the higher ones are zero.
"""
from __future__ import annotations

import json
import zlib
from base64 import b64encode
from dataclasses import dataclass
from typing import Any

import numpy as np

from data.quantities import unit_text
from data.results import Case
from pictures.camera import frames_that_set_the_scale, upright_axes
from pictures.case_fields import Field
from pictures.case_scene import ENDLESS, CaseScene, slowdown
from pictures.look import (
    BACK, FABRICS, FILL_LIGHT, FRONT, GROUND, GROUND_FADES, MARK, OBJECT, SET_BACK, STUCK,
    colour_stops
)
from pictures.shading import world_light
from plots.plot_style import level_text

LEAST_FRAMES = 8                    # with fewer there is no view
CODES = 65535                       # places along each side of the box of a case
HELD, STICKS = 1, 2                 # what a mark says of a particle

Arrays = list[tuple[dict[str, Any], bytes]]   # name, bytes of a number, how many; and what it is


@dataclass
class ViewData:
    """Data of a case for its view in the page."""
    text: str                       # as above
    frames: int                     # that it holds
    stride: int                     # of those that can be shown it holds every so many-th
    of_frames: int                  # that the file has
    not_whole: int                  # left out since particles are not finite, or far away
    # [m], the largest distance of a particle from its place in the file
    error: float


def frames_to_turn(case: Case) -> list[int]:
    """Frames whose particles are all finite and not far away from the first."""
    frames = [case.positions(frame) for frame in range(len(case.frame_times))]
    kept = {id(x) for x in frames_that_set_the_scale(frames)}
    return [k for k, x in enumerate(frames) if id(x) in kept]


def make_view(
    scene: CaseScene, frames: list[int], fields: list[Field], most: int
) -> ViewData | None:
    """The view on these frames, in which the fields have a row each; every second one, third one
    and so on where the text were longer than `most` characters. None if it still were."""
    for stride in range(1, max(2, len(frames) // LEAST_FRAMES + 1)):
        rows = list(range(0, len(frames), stride))
        packed, error = _pack(scene, [frames[row] for row in rows], fields, rows)
        text = b64encode(packed).decode("ascii")
        if len(text) <= most:
            times = len(scene.case.frame_times)
            return ViewData(text, len(rows), stride, times, times - len(frames), error)
    return None


def _pack(
    scene: CaseScene, frames: list[int], fields: list[Field], rows: list[int]
) -> tuple[bytes, float]:
    case = scene.case
    x = case.every_frame("positions")[frames]
    box, codes, error = _in_box(x)
    arrays = [
        _array("positions", 2, _over_time(codes, 16)),
        _array("triangles", 3, _along(case.triangles.ravel())),
        _array("marks", 1, _over_time(_marks(case, frames), 8))
    ]
    arrays += [
        _array(
            f"field {k}", 1,
            _over_time(np.round(255 * np.stack([field.codes(row) for row in rows])), 8)
        )
        for k, field in enumerate(fields)
    ]
    objects = []
    for k, part in enumerate(case.objects):
        objects.append(_object(part, k, frames, arrays))
    times = case.frame_times[frames]
    header = {
        "times": times.tolist(),
        "particles": len(case.held),
        "box": box,
        "objects": objects,
        "look": _look(scene),
        "slowed": slowdown(float(times[-1] - times[0])),
        "fields": [_field(field) for field in fields],
        "maps": {
            name: colour_stops(name).tolist()
            for name in sorted({field.colours for field in fields})
        },
        "arrays": [about for about, _ in arrays],
    }
    told = json.dumps(header, separators=(",", ":")).encode("ascii")
    whole = len(told).to_bytes(4, "little") + told + b"".join(data for _, data in arrays)
    squeezer = zlib.compressobj(9, zlib.DEFLATED, -15, 9)
    return squeezer.compress(whole) + squeezer.flush(), error


def _look(scene: CaseScene) -> dict[str, Any]:
    """Colours, lights and the camera that the view begins with."""
    camera = scene.camera
    middle = np.array(camera.corner) + 0.5 * np.array(camera.metres)
    pan = middle - [scene.centre @ camera.right, scene.centre @ camera.up]
    inks = dict(front=FRONT, back=BACK, object=OBJECT, ground=GROUND, held=MARK, stuck=STUCK)
    return {
        "inks": {name: ink.tolist() for name, ink in inks.items()},
        "light": world_light(camera).tolist(),
        "fill": (FILL_LIGHT / np.linalg.norm(FILL_LIGHT)).tolist(),
        "toward": camera.toward.tolist(), "pan": pan.tolist(),
        "upright": upright_axes(scene.up).ravel().tolist(), "metres": list(camera.metres),
        "centre": scene.centre.tolist(), "reach": scene.reach, "fades": GROUND_FADES,
        "setBack": SET_BACK * max(camera.metres)
    }


def _field(field: Field) -> dict[str, Any]:
    return {
        "name": field.name, "label": field.label,
        "unit": "" if field.unit == "1" else unit_text(field.unit), "ticks": field_ticks(field),
        "colours": field.colours
    }


def field_ticks(field: Field) -> list[str]:
    """The values at the beginning, the middle and the end of a colour bar, as texts; none of
    fabrics, which have no bar."""
    if field.colours == FABRICS:
        return ["", "", ""]
    return [level_text(float(value)) for value in np.linspace(field.low, field.high, 3)]


def _object(part: Any, k: int, frames: list[int], arrays: Arrays) -> dict[str, Any]:
    """Header entry of an object; its arrays are added to `arrays`."""
    about = {"name": part.name, "vertices": len(part.vertices), "ground": part.shape == ENDLESS,
             "deforms": part.deformed is not None}
    places = part.vertices[None] if part.deformed is None else part.deformed[frames]
    about["box"], codes, _ = _in_box(places)
    arrays += [_array(f"object {k}", 2, _over_time(codes, 16)),
               _array(f"object {k} triangles", 3, _along(part.triangles.ravel()))]
    if part.deformed is None:
        poses = np.concatenate([part.rotation[frames], part.translation[frames]], axis=1).astype(
            "<f4"
        )
        poses = poses[:1] if (poses == poses[0]).all() else poses
        arrays.append(
            ({"name": f"object {k} poses", "kind": "floats", "count": poses.size}, poses.tobytes())
        )
    return about


def _in_box(x: np.ndarray) -> tuple[dict[str, list[float]], np.ndarray, float]:
    """The box of points T x N x 3 [m], their places in it as whole numbers, T x 3 x N, and the
    largest distance from there [m]."""
    low = x.min(axis=(0, 1))
    step = np.maximum(x.max(axis=(0, 1)) - low, 1e-12) / CODES
    codes = np.round((x - low) / step)
    error = float(np.linalg.norm(low + step * codes - x, axis=2).max())
    return (
        {"low": low.tolist(), "step": step.tolist()}, codes.astype(np.int64).transpose(0, 2, 1),
        error
    )


def _marks(case: Case, frames: list[int]) -> np.ndarray:
    """T x N: 0, HELD or STICKS."""
    stuck = [case.stuck(frame) for frame in frames]
    return np.stack(
        [np.where(case.held, HELD, 0 if row is None else STICKS * row) for row in stuck]
    )


def _over_time(codes: np.ndarray, bits: int) -> np.ndarray:
    """Differences to the frame before, those of the first frame to the neighbour
    before, as numbers of so many bits."""
    codes = codes.astype(np.int64)
    first = np.diff(codes[0], axis=-1, prepend=0)[None]
    half = 1 << (bits - 1)
    return (np.concatenate([first, np.diff(codes, axis=0)]) + half) % (2 * half) - half


def _along(indices: np.ndarray) -> np.ndarray:
    return np.diff(indices, prepend=0)


def _array(name: str, size: int, numbers: np.ndarray) -> tuple[dict[str, Any], bytes]:
    """Whole numbers of `size` bytes: the sign becomes the lowest
    bit, then each byte has its place."""
    numbers = numbers.ravel()
    unsigned = np.where(numbers < 0, -2 * numbers - 1, 2 * numbers)
    planes = [((unsigned >> (8 * k)) & 255).astype(np.uint8).tobytes() for k in range(size)]
    return {"name": name, "kind": size, "count": len(numbers)}, b"".join(planes)
