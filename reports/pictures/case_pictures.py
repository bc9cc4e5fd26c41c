"""The row of pictures of one simulation: which frames, one camera for all, a
scale bar, and the strip as a file."""
from __future__ import annotations

from base64 import b64encode
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from data.quantities import number_text
from data.results import Case
from pictures.camera import Camera
from pictures.case_scene import CaseScene
from pictures.cloth_picture import SAMPLES, finish_pixels, paint, webp_bytes
from plots.plot_style import INK, are_for_papers, finish, new_figure

USUAL, WIDE = 5, 6                  # pictures in a row; wide ones are set in two lines of three
WIDE_ASPECT = 1.9                   # width over height
PICTURE_WIDTH = 2.2                 # of one picture in the strip [inch]
PORTRAIT_HEIGHT = 260               # pixels
TEXT_HEIGHT = 0.34                  # below each picture of the strip [inch]


@dataclass
class Picture:
    """One frame."""
    time: float        # [s]
    uri: str           # WebP as a data URI
    whole: bool        # false where particles are not finite or far outside the picture


@dataclass
class PictureRow:
    """All pictures of a case, same camera and scale."""
    pictures: list[Picture]
    size: tuple[int, int]           # pixels of each
    columns: int
    bar_metres: float
    bar_fraction: float             # of a picture's width
    held: int
    sticks: bool                    # is anything sticky?
    portrait: str                   # data URI of one frame, cut to the cloth
    portrait_size: tuple[int, int]


def make_pictures(case: Case, name: str, folder: Path) -> PictureRow | None:
    """Draws the case, and for papers writes the strip name-pictures.{svg,pdf,png}; None if it has
    no frames or no triangles."""
    if not len(case.frame_times) or not len(case.triangles):
        return None
    chosen, scene = select_frames(case)
    camera = scene.camera
    painted = [paint(scene.cloth(frame), camera, scene.scenery(frame)) for frame in chosen]
    drawn = [finish_pixels(samples) for samples in painted]
    times = [float(case.frame_times[frame]) for frame in chosen]
    bar = nice_length(0.3 * camera.metres[0])
    if are_for_papers():
        _write_strip(drawn, times, bar, camera, f"{name}-pictures", folder)
    whole = [scene.is_whole(case.positions(frame)) for frame in chosen]
    portrait = _portrait(painted[_portrait_of(whole)])
    return PictureRow(
        pictures=[
            Picture(time, picture_uri(picture), complete)
            for time, picture, complete in zip(times, drawn, whole)
        ],
        size=camera.pixels,
        columns=3 if len(drawn) == WIDE else USUAL,
        bar_metres=bar,
        bar_fraction=bar / camera.metres[0],
        held=int(case.held.sum()),
        sticks=case.stuck(0) is not None,
        portrait=picture_uri(portrait),
        portrait_size=(portrait.shape[1], portrait.shape[0]),
    )


def select_frames(case: Case) -> tuple[list[int], CaseScene]:
    """The frames that stand in the row, and the scene whose camera holds them."""
    chosen = evenly_spaced(case.frame_times, USUAL)
    scene = CaseScene(case, chosen)
    if (
        scene.camera.metres[0] < WIDE_ASPECT * scene.camera.metres[1]
        or len(case.frame_times) < WIDE
    ):
        return chosen, scene
    chosen = evenly_spaced(case.frame_times, WIDE)
    return chosen, CaseScene(case, chosen)


def evenly_spaced(times: np.ndarray, count: int) -> list[int]:
    """Indices of the frames nearest to evenly spaced times, first and last included."""
    wanted = np.linspace(times[0], times[-1], count)
    return sorted({int(np.abs(times - time).argmin()) for time in wanted})


def nice_length(most: float) -> float:
    """The largest of 1, 2, 5 times a power of ten that is not longer than `most` [m]."""
    power = 10.0 ** np.floor(np.log10(most))
    return float(
        max(step * power for step in (1.0, 2.0, 5.0) if step * power <= most * (1 + 1e-12))
    )


def length_text(metres: float) -> str:
    """A length as a scale bar says it."""
    for factor, unit in ((1.0, "m"), (100.0, "cm"), (1000.0, "mm")):
        if metres * factor >= 0.999:
            return f"{number_text(round(metres * factor, 9))} {unit}"
    return f"{number_text(metres)} m"


def _portrait_of(whole: list[bool]) -> int:
    """Which picture stands for the case: the last complete one of the
    first six tenths, else the first."""
    return max((k for k in range(round(0.6 * (len(whole) - 1)) + 1) if whole[k]), default=0)


def _trim(picture: np.ndarray) -> np.ndarray:
    """The picture without its empty margins."""
    lines, columns = (np.flatnonzero(picture[:, :, 3].any(axis=axis)) for axis in (1, 0))
    if not len(lines):
        return picture
    return picture[lines[0]:lines[-1] + 1, columns[0]:columns[-1] + 1]


def _portrait(samples: np.ndarray) -> np.ndarray:
    """The picture cut to what is in it, PORTRAIT_HEIGHT pixels high or a little more."""
    lines = np.flatnonzero((samples[:, :, 3] > 0).any(axis=1))
    height = lines[-1] - lines[0] if len(lines) else len(samples)
    return _trim(finish_pixels(samples, max(SAMPLES, height // PORTRAIT_HEIGHT)))


def picture_uri(picture: np.ndarray) -> str:
    """The picture as a data URI."""
    return "data:image/webp;base64," + b64encode(webp_bytes(np.ascontiguousarray(picture))).decode(
        "ascii"
    )


def _write_strip(drawn: list[np.ndarray], times: list[float], bar: float, camera: Camera, name: str,
                 folder: Path) -> None:
    """The pictures side by side, each with its time below, the first with the scale bar."""
    height, width = drawn[0].shape[:2]
    columns = 3 if len(drawn) == WIDE else len(drawn)
    lines = -(-len(drawn) // columns)
    tall = PICTURE_WIDTH * height / width
    cell = tall + TEXT_HEIGHT
    figure = new_figure(PICTURE_WIDTH * columns, cell * lines)
    for k, (picture, time) in enumerate(zip(drawn, times)):
        bottom = 1.0 - (k // columns + 1) / lines + TEXT_HEIGHT / cell / lines
        axes = figure.add_axes(((k % columns) / columns, bottom, 1 / columns, tall / cell / lines))
        axes.imshow(
            picture, interpolation="none", extent=(0.0, camera.metres[0], 0.0, camera.metres[1])
        )
        axes.axis("off")
        axes.annotate(f"{number_text(time)} s", (0.5, 0.0), (0, -7), xycoords="axes fraction",
                      textcoords="offset points", ha="center", va="top")
        if k == 0:
            axes.plot(
                [0.0, bar], [0.0, 0.0], color=INK, linewidth=1.6, clip_on=False,
                solid_capstyle="butt"
            )
            axes.annotate(length_text(bar), (0.0, 0.0), (0, -7), xycoords="axes fraction",
                          textcoords="offset points", ha="left", va="top")
    finish(figure, name, folder, "")
