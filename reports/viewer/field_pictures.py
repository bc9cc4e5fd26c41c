"""The picture of a case coloured by the field that says most of it, which is
where the view in the page begins."""
from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colorbar import Colorbar
from matplotlib.colors import ListedColormap, Normalize

from data.cloth_values import edges_of
from data.quantities import number_text, unit_text
from data.results import Case
from pictures.case_fields import Field, fields_of, most_telling
from pictures.case_pictures import picture_uri, select_frames
from pictures.cloth_picture import picture_of
from pictures.look import field_colours
from plots.plot_style import INK, are_for_papers, finish, new_figure, with_unit
from viewer.view_data import ViewData, field_ticks, frames_to_turn, make_view

PICTURE_WIDTH = 4.0                 # in the file [inch]


@dataclass
class FieldView:
    """A picture coloured by a field (None: by its two sides), and the data
    of the view that begins with it."""
    picture: str                    # WebP as a data URI
    size: tuple[int, int]           # pixels
    share: float                    # of the height of all that the camera sees
    time: float                     # [s]
    row: int                        # of the view's frames
    field: Field | None
    ticks: list[str]                # of the colour bar: beginning, middle, end
    unit: str                       # as it is written; "" for none
    data: ViewData | None           # None: the case is too large for the page


def make_field_view(case: Case, name: str, folder: Path, most: int) -> FieldView | None:
    """Draws the picture, also as name-field.{svg,pdf,png}; the data get `most` characters. None if
    there is nothing to draw."""
    if not len(case.frame_times) or not len(case.triangles):
        return None
    frames = frames_to_turn(case)
    if not frames:
        return None
    chosen, scene = select_frames(case)
    fields = fields_of(case, frames)
    rows = [row for row, frame in enumerate(frames) if frame in chosen] or [0]
    field, row = most_telling(fields, rows, edges_of(case.triangles)) or (
        None, rows[len(rows) // 2]
    )
    frame = frames[row]
    picture = without_empty_lines(
        picture_of(scene.cloth(frame, field, row), scene.camera, scene.scenery(frame))
    )
    if field is not None:
        if are_for_papers():
            _write_file(picture, field, float(case.frame_times[frame]), f"{name}-field", folder)
    data = make_view(scene, frames, fields, most)
    return FieldView(
        picture_uri(picture), picture.shape[1::-1], len(picture) / scene.camera.pixels[1],
        float(case.frame_times[frame]),
        row if data is None else min(round(row / data.stride), data.frames - 1), field,
        [] if field is None else field_ticks(field),
        "" if field is None or field.unit == "1" else unit_text(field.unit), data
    )


def without_empty_lines(picture: np.ndarray) -> np.ndarray:
    """The picture without what is empty above and below, but for a rim: the camera sees all that
    the cloth ever reaches."""
    seen = np.flatnonzero(picture[:, :, 3].any(axis=1))
    if not len(seen):
        return picture
    rim = len(picture) // 50
    return picture[max(seen[0] - rim, 0):seen[-1] + 1 + rim]


def _write_file(picture: np.ndarray, field: Field, time: float, name: str, folder: Path) -> None:
    """The picture with its time below and its colour bar beside it."""
    tall = PICTURE_WIDTH * picture.shape[0] / picture.shape[1]
    width, height = PICTURE_WIDTH + 1.5, max(tall, 2.0) + 0.6
    figure = new_figure(width, height)
    axes = figure.add_axes((0.0, 0.3 / height, PICTURE_WIDTH / width, tall / height))
    axes.imshow(picture, interpolation="none")
    axes.axis("off")
    axes.annotate(
        f"{number_text(time)} s", (0.5, 0.0), (0, -7), xycoords="axes fraction",
        textcoords="offset points", ha="center", va="top"
    )
    colours = ListedColormap(_srgb_of_bar(field))
    bar_axes = figure.add_axes(
        ((PICTURE_WIDTH + 0.25) / width, 0.35 / height, 0.16 / width, min(1.0, 2.0 / height))
    )
    bar = Colorbar(
        bar_axes, ScalarMappable(Normalize(field.low, field.high), colours), ticklocation="right"
    )
    bar.outline.set_visible(False)
    bar.set_ticks(np.linspace(field.low, field.high, 3), labels=field_ticks(field))
    figure.text(
        0.99, 1.0 - 0.04 / height, with_unit(field.label, field.unit), ha="right", va="top",
        fontsize=7.0, color=INK
    )
    finish(figure, name, folder, field.label)


def _srgb_of_bar(field: Field) -> np.ndarray:
    light = field_colours(np.linspace(0.0, 1.0, 256), field.colours).T
    return np.clip(
        np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055), 0.0, 1.0
    )
