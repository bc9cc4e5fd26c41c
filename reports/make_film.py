#!/usr/bin/python3
"""Makes films of one simulation: MP4 (H.264) for talks, GIF for pages. Needs ffmpeg.

    reports/make_film.py results/grab.h5                 -> results/grab.mp4, results/grab.gif
    reports/make_film.py results/grab.h5 --field strain --out strain.mp4

A picture holds the simulation's time, how fast it is shown, a scale bar,
and the colour bar of a field.
"""
from __future__ import annotations

import argparse
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

sys.dont_write_bytecode = True

from data.command_line import (  # noqa: E402
    OneLineParser, refusing_damage, require_modules, require_program
)

require_modules("make_film", "numpy", "h5py", "matplotlib", "PIL")
import numpy as np  # noqa: E402
from PIL import Image, ImageDraw, ImageFont  # noqa: E402

from data.quantities import number_text  # noqa: E402
from data.results import Case, load_case  # noqa: E402
from data.unreadable import Unreadable  # noqa: E402
from pictures.case_fields import Field, fields_of  # noqa: E402
from pictures.case_pictures import length_text, nice_length, select_frames  # noqa: E402
from pictures.case_scene import CaseScene, slowdown  # noqa: E402
from pictures.cloth_picture import picture_of  # noqa: E402
from pictures.look import colour_stops  # noqa: E402
from plots.plot_style import font_path, with_unit  # noqa: E402
from viewer.view_data import field_ticks, frames_to_turn  # noqa: E402

FIELDS = ("strain", "angle", "phi", "speed")
STILL = 0.6                         # seconds that the last frame stays
GIF_WIDTH, GIF_FPS = 480, 15        # at most
INK, SOFT = (36, 41, 46), (93, 101, 110)


@dataclass
class Film:
    """Subject and settings of a film."""
    scene: CaseScene
    frames: list[int]               # of the case, those that can be shown
    field: Field | None
    size: tuple[int, int]           # pixels, even
    fps: int


def main() -> int:
    """Returns 0 when the films are written, 2 when they cannot be."""
    options = arguments()
    require_program("make_film", "ffmpeg")
    both = [options.run.with_suffix(kind) for kind in (".mp4", ".gif")]
    with refusing_damage("make_film", options.run):
        film = film_of(load_case(options.run), options)
        for out in [options.out] if options.out else both:
            write_film(film, out)
            print(out)
    return 0


class FilmError(Unreadable):
    """Why there is no film, in one line."""


def arguments() -> argparse.Namespace:
    """The command line."""
    parser = OneLineParser(description="Make films of one simulation, MP4 and GIF.")
    parser.add_argument("run", metavar="RUN.h5", type=Path, help="the file of a simulation")
    parser.add_argument(
        "--out", metavar="FILE", type=Path,
        help="FILE.mp4 or FILE.gif (default: both, beside RUN.h5)"
    )
    parser.add_argument(
        "--field", choices=FIELDS, help="colour the cloth by a field (default: by its two sides)"
    )
    parser.add_argument(
        "--size", metavar="WxH", type=size_of, default=(1280, 720),
        help="pixels (default: 1280x720)"
    )
    parser.add_argument(
        "--fps", metavar="N", type=int, default=30, choices=range(1, 121),
        help="pictures a second (default: 30)"
    )
    options = parser.parse_args()
    if options.out and options.out.suffix not in (".mp4", ".gif"):
        parser.error(f"--out {options.out}: the name of a film ends in .mp4 or .gif")
    if options.out and not options.out.parent.is_dir():
        parser.error(f"--out {options.out}: there is no folder {options.out.parent}; make it first")
    return options


def size_of(text: str) -> tuple[int, int]:
    """Pixels of "1280x720"; H.264 wants even numbers."""
    sides = text.lower().split("x")
    if len(sides) == 2 and all(side.isascii() and side.isdigit() for side in sides):
        width, height = (int(side) for side in sides)
        if 64 <= width <= 4096 and 64 <= height <= 4096 and width % 2 == 0 and height % 2 == 0:
            return width, height
    raise argparse.ArgumentTypeError(f"'{text}' is not WIDTHxHEIGHT, even numbers from 64 to 4096")


def film_of(case: Case, options: argparse.Namespace) -> Film:
    """The film that was asked for. Throws FilmError where the file does not allow it."""
    if not len(case.frame_times) or not len(case.triangles):
        raise FilmError(f"{case.path}: it holds no frames of a cloth")
    frames = frames_to_turn(case)
    if not frames:
        raise FilmError(f"{case.path}: no frame has all its particles finite")
    _, scene = select_frames(case)
    fields = {field.name: field for field in fields_of(case, frames)} if options.field else {}
    if options.field and options.field not in fields:
        raise FilmError(
            f"{case.path}: it has no field '{options.field}'; it has: {', '.join(fields) or 'none'}"
        )
    return Film(scene, frames, fields.get(options.field), options.size, options.fps)


def write_film(film: Film, out: Path) -> None:
    """Draws every frame once and hands the pictures to ffmpeg; the file is renamed when whole."""
    partial = out.with_name(out.stem + ".partial" + out.suffix)
    width, height = film.size
    raw = [
        "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}", "-r", str(film.fps), "-i",
        "-"
    ]
    command = ["ffmpeg", "-v", "error", "-y", *raw, *encoding(film, out.suffix), str(partial)]
    run = subprocess.Popen(command, stdin=subprocess.PIPE, stderr=subprocess.PIPE)
    assert run.stdin is not None and run.stderr is not None
    try:
        drawn: dict[int, bytes] = {}
        for row in rows_of(film):
            if row not in drawn:
                drawn = {row: picture_bytes(film, row)}
            run.stdin.write(drawn[row])
        run.stdin.close()
    except BrokenPipeError:
        pass  # what ffmpeg says of it follows
    complaint = run.stderr.read().decode("utf-8", "replace").strip()
    if run.wait() != 0:
        partial.unlink(missing_ok=True)
        raise FilmError(f"{out}: ffmpeg failed: {' '.join(complaint.split()) or 'without a word'}")
    partial.replace(out)


def encoding(film: Film, kind: str) -> list[str]:
    """ffmpeg options for a file of this kind; the same input gives the same bytes."""
    if kind == ".mp4":
        return [
            "-c:v", "libx264", "-pix_fmt", "yuv420p", "-crf", "18", "-threads", "1", "-movflags",
            "+faststart", "-fflags", "+bitexact", "-flags:v", "+bitexact", "-map_metadata", "-1"
        ]
    smaller = f"fps={min(GIF_FPS, film.fps)},scale={min(GIF_WIDTH, film.size[0])}:-2:flags=lanczos"
    return [
        "-vf",
        f"{smaller},split[a][b];[a]palettegen=stats_mode=diff[p];"
        "[b][p]paletteuse=dither=bayer:bayer_scale=4",
        "-loop", "0"
    ]


def rows_of(film: Film) -> list[int]:
    """Which of the frames each picture of the film shows: the last that is not later."""
    times = film.scene.case.frame_times[film.frames]
    times = times - times[0]
    pace = 1.0 / slowdown(float(times[-1]))
    shown = np.arange(round((times[-1] / pace + STILL) * film.fps)) / film.fps * pace
    return [int(row) for row in np.searchsorted(times, shown + 1e-9, side="right") - 1]


def picture_bytes(film: Film, row: int) -> bytes:
    """One picture, RGB, 8 bits each."""
    width, height = film.size
    frame, scene = film.frames[row], film.scene
    camera = scene.camera.scaled_to(width, round(0.84 * height))
    drawn = Image.fromarray(
        picture_of(scene.cloth(frame, film.field, row), camera, scene.scenery(frame))
    )
    canvas = Image.new("RGB", film.size, (255, 255, 255))
    canvas.paste(
        drawn, ((width - drawn.width) // 2, max(0, round(0.84 * height) - drawn.height) // 2), drawn
    )
    write_words(canvas, film, float(scene.case.frame_times[frame]), camera.pixels_per_metre)
    return canvas.tobytes()


def write_words(canvas: Image.Image, film: Film, time: float, pixels_per_metre: float) -> None:
    """Below the picture: scale bar, time and pace, colour bar."""
    width, height = canvas.size
    size = max(9, round(0.032 * height))
    font, pen = ImageFont.truetype(font_path(), size), ImageDraw.Draw(canvas)
    top, margin = round(0.88 * height), round(0.03 * width)
    length = nice_length(0.2 * width / pixels_per_metre)
    pen.rectangle(
        (margin, top, margin + length * pixels_per_metre, top + max(1, size // 8)), fill=INK
    )
    pen.text((margin, top + 0.5 * size), length_text(length), font=font, fill=INK)
    times = film.scene.case.frame_times[film.frames]
    slower = slowdown(float(times[-1] - times[0]))
    pace = "real time" if slower == 1 else f"slowed {number_text(slower)} times"
    places = max(0, 2 - int(np.floor(np.log10(times[-1])))) if times[-1] > 0 else 0
    pen.text(
        (0.5 * width, top - 0.2 * size), f"{time:.{places}f} s", font=font, fill=INK, anchor="ma"
    )
    pen.text((0.5 * width, top + 1.2 * size), pace, font=font, fill=SOFT, anchor="ma")
    if film.field is not None:
        write_bar(
            pen, film.field, (round(0.7 * width), top, width - margin, top + round(0.6 * size)),
            font
        )


def write_bar(
    pen: ImageDraw.ImageDraw, field: Field, box: tuple[int, int, int, int],
    font: ImageFont.FreeTypeFont
) -> None:
    """A colour bar with its ends, its middle, and what it shows."""
    left, top, right, bottom = box
    places = np.linspace(0.0, 1.0, len(colour_stops(field.colours)))
    across = np.linspace(0.0, 1.0, right - left)
    colours = np.stack(
        [np.interp(across, places, channel) for channel in colour_stops(field.colours).T], axis=1
    )
    for x, colour in enumerate(np.round(colours).astype(int).tolist(), start=left):
        pen.line((x, top, x, bottom), fill=tuple(colour))
    for x, anchor, text in zip(
        (left, 0.5 * (left + right), right), ("la", "ma", "ra"), field_ticks(field)
    ):
        pen.text((x, bottom + 2), text, font=font, fill=INK, anchor=anchor)
    pen.text(
        (left, top - 0.3 * font.size), with_unit(field.label.split(",")[0], field.unit), font=font,
        fill=SOFT, anchor="ls"
    )


if __name__ == "__main__":
    sys.exit(main())
