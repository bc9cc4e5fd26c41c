"""Small drawings of what a study sets up: cloth, held particles, bodies, motions. They are not
to scale and show no result. Lengths are those of a box of 200 x 110."""
from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from math import cos, hypot, pi, sin

from markupsafe import Markup, escape

WIDTH, HEIGHT = 200, 110
Point = tuple[float, float]


@dataclass(frozen=True)
class Sketch:
    """A drawing as SVG, and what it shows in words."""

    svg: Markup
    words: str


def sketch_of(study: str) -> Sketch | None:
    """The drawing of a study's set-up; None if it has none."""
    if study not in _DRAWN:
        return None
    words, marks = _DRAWN[study]
    svg = '<svg class="sketch" viewBox="0 0 {} {}" role="img" aria-label="{}">{}</svg>'
    return Sketch(Markup(svg).format(WIDTH, HEIGHT, words, Markup("".join(marks))), words)


def drawn_studies() -> list[str]:
    """Names of the studies that have a drawing."""
    return list(_DRAWN)


# ---- marks ----


def _line(points: Iterable[Point], kind: str = "cloth", closed: bool = False) -> str:
    path = " ".join(f"{'L' if k else 'M'}{x:.1f} {y:.1f}" for k, (x, y) in enumerate(points))
    return f'<path class="{kind}" d="{path}{" Z" if closed else ""}"/>'


def _dot(at: Point, kind: str = "held") -> str:
    return f'<circle class="{kind}" cx="{at[0]:.1f}" cy="{at[1]:.1f}" r="2.6"/>'


def _arrow(start: Point, end: Point) -> str:
    length = hypot(end[0] - start[0], end[1] - start[1])
    along = ((end[0] - start[0]) / length, (end[1] - start[1]) / length)

    def back(side: float) -> Point:
        return end[0] - 6 * along[0] - side * along[1], end[1] - 6 * along[1] + side * along[0]

    return _line([start, end], "motion") + _line([back(2.8), end, back(-2.8)], "motion")


def _label(at: Point, text: str, anchor: str = "middle") -> str:
    return f'<text x="{at[0]:.1f}" y="{at[1]:.1f}" text-anchor="{anchor}">{escape(text)}</text>'


def _clamp(x: float, top: float, bottom: float, side: int) -> str:
    """A wall with hatching on its `side`, -1 left or 1 right."""
    rungs = "".join(
        _line([(x, y), (x + 5 * side, y + 5)], "wall") for y in range(int(top), int(bottom), 6)
    )
    return _line([(x, top), (x, bottom)], "wall") + rungs


def _gravity(at: Point) -> str:
    return _arrow(at, (at[0], at[1] + 22)) + _label((at[0] + 6, at[1] + 14), "g", "start")


def _arc(centre: Point, radius: float, start: float, end: float, steps: int = 40) -> list[Point]:
    """Points of an arc; angles in half turns from the right, upwards."""
    angles = [pi * (start + (end - start) * k / steps) for k in range(steps + 1)]
    return [(centre[0] + radius * cos(angle), centre[1] - radius * sin(angle)) for angle in angles]


def _wave(left: float, right: float, y: float, height: float, periods: float) -> list[Point]:
    """Leaves both ends level, as clamps ask."""
    return [
        (
            left + (right - left) * k / 80,
            y - height * sin(pi * k / 80) * sin(2 * pi * periods * k / 80),
        )
        for k in range(81)
    ]


def _grid(left: float, top: float, right: float, bottom: float, cells: int) -> str:
    across = [left + (right - left) * k / cells for k in range(cells + 1)]
    down = [top + (bottom - top) * k / cells for k in range(cells + 1)]
    return (
        "".join(_line([(x, top), (x, bottom)], "mesh") for x in across)
        + "".join(_line([(left, y), (right, y)], "mesh") for y in down)
        + "".join(
            _line([(across[i], down[j]), (across[i + 1], down[j + 1])], "mesh")
            for i in range(cells)
            for j in range(cells)
        )
        + _line([(left, top), (right, top), (right, bottom), (left, bottom)], "cloth", closed=True)
    )


def _bent(a: Point, b: Point, bow: float) -> list[Point]:
    length = hypot(b[0] - a[0], b[1] - a[1])
    normal = (-(b[1] - a[1]) / length, (b[0] - a[0]) / length)
    return [
        (
            a[0] + (b[0] - a[0]) * s + bow * sin(pi * s) * normal[0],
            a[1] + (b[1] - a[1]) * s + bow * sin(pi * s) * normal[1],
        )
        for s in (k / 12 for k in range(1, 13))
    ]


# ---- set-ups ----

_HINGE = [
    _line([(100, 14), (100, 96), (34, 62)], closed=True),
    _line([(100, 14), (100, 96), (160, 44)], closed=True),
    _dot((100, 14)), _dot((100, 96)), _dot((34, 62)), _dot((160, 44), "free")
]
_OSCILLATOR = (
    "Three corners of a hinge are held; the fourth moves across its plane.",
    [*_HINGE, _arrow((160, 44), (160, 16)), _arrow((160, 44), (160, 72)), _label((182, 48), "free")]
)
_HUNG_BY_EDGE = [_grid(56, 14, 136, 80, 5), *[_dot((56 + 16 * k, 14)) for k in range(6)]]
_BUCKLING = (
    "A strip between two clamps that approach each other.",
    [
        _clamp(24, 30, 76, -1), _line(_wave(24, 176, 53, 16, 1.5)), _clamp(176, 30, 76, 1),
        _arrow((194, 92), (168, 92)), _arrow((6, 92), (32, 92)),
        _line([(24, 53), (176, 53)], "path")
    ],
)
_ON_CYLINDER = [
    _line(_arc((100, 150), 92, 0.8, 0.2), "body"), _line(_arc((100, 150), 97, 0.8, 0.2)),
    _arrow((100, 110), (164, 68)), _label((140, 104), "radius R")
]
_STRIP = [(30 + 110 * s, 26 + 58 * s * s * (1.5 - 0.5 * s)) for s in (k / 30 for k in range(31))]
_ON_WEDGE = [(30.0, 60.0), (70.0, 34.0), (130.0, 34.0), (170.0, 60.0)]
_FREE = [(62.0, 34.0), (134.0, 24.0), (146.0, 80.0), (54.0, 88.0)]
_SPRING = [(66.0 + 8 * k, 60.0 + (9 if k % 2 else -9)) for k in range(8)]

# what a study sets up, in words and marks
_DRAWN: dict[str, tuple[str, list[str]]] = {
    "time-order.hinge": (
        "Two triangles share an edge that is held; one corner is moved, the other is free.",
        [
            *_HINGE, _line(_arc((34, 62), 15, 0.6, 1.4), "path"), _arrow((29.4, 48), (36, 46)),
            _label((2, 34), "prescribed", "start"), _label((160, 34), "free"), _gravity((184, 70))
        ],
    ),
    "stability-oscillator": _OSCILLATOR,
    "variable-step-stability": _OSCILLATOR,
    "time-order.sheet": (
        "A sheet hangs by its two upper corners, which are moved to and fro.",
        [
            _grid(56, 26, 136, 98, 5), _dot((56, 26)), _dot((136, 26)), _arrow((56, 18), (40, 18)),
            _arrow((56, 18), (72, 18)), _arrow((136, 18), (120, 18)), _arrow((136, 18), (152, 18)),
            _gravity((176, 46))
        ],
    ),
    "mesh-error": (
        "A sheet held along its upper edge swings out of its plane.",
        [*_HUNG_BY_EDGE, _arrow((142, 84), (168, 76))],
    ),
    "strain-sweeps": (
        "A sheet held along its upper edge; all below starts downwards.",
        [*_HUNG_BY_EDGE, *[_arrow((x, 104 - 24), (x, 104)) for x in (72, 96, 120)]],
    ),
    "cantilever": (
        "A strip is clamped level at one end and bends under its weight, or a load at its tip.",
        [
            _clamp(22, 8, 46, -1), _line([(22, 26), *_STRIP]), _dot((22, 26)), _dot((30, 26)),
            _gravity((170, 30)), _label((96, 18), "weight or tip load"),
            _line([(22, 26), (150, 26)], "path")
        ],
    ),
    "buckling": _BUCKLING,
    "folding": _BUCKLING,
    "biphasic": (
        "A strip is clamped at one end and pulled by the other.",
        [
            _clamp(24, 30, 76, -1),
            _line([(24, 44), (150, 44), (150, 62), (24, 62)], closed=True),
            *[_line([(x, 44), (x, 62)], "mesh") for x in range(45, 150, 21)],
            _arrow((154, 53), (190, 53)), _label((88, 92), "largest load at the clamp")
        ],
    ),
    "forecast-time": (
        "A point above a curved body, its velocity and the body's normal.",
        [
            _line(_arc((88, 150), 84, 0.82, 0.18), "body"), _dot((64, 36), "free"),
            _arrow((64, 36), (104, 52)), _line([(104, 52), (130, 62)], "path"),
            _arrow((88, 66), (88, 40)), _label((96, 44), "N", "start"),
            _label((84, 26), "v, over τ", "start"), _label((88, 96), "φ < 0")
        ],
    ),
    "pointwise-contact": (
        "Particles stay outside; triangles between them may still cut an edge of the object.",
        [
            _line([(100, 24), (190, 110), (10, 110)], "body", closed=True), _line(_ON_WEDGE),
            *[_dot(at, "free") for at in _ON_WEDGE], _label((100, 100), "object")
        ],
    ),
    "wrinkle-preservation": (
        "A wrinkled strip lies half inside a body before it is projected.",
        [
            _line([(10, 60), (190, 60), (190, 104), (10, 104)], "body", closed=True),
            _line(_wave(20, 180, 60, 18, 3)), _label((100, 98), "half inside")
        ],
    ),
    "bending-rigidity": ("A flat sheet is laid on a cylinder.", _ON_CYLINDER),
    "bending-scaling": ("A sheet is rolled on a cylinder whose curvature grows.", _ON_CYLINDER),
    "sticking-lag": (
        "A particle is bound to a moving target by a spring without length.",
        [
            _line([(50, 60), (62, 60), *_SPRING, (128, 60), (140, 60)], "mesh"),
            _dot((50, 60), "free"), _dot((140, 60)), _arrow((140, 40), (178, 40)),
            _label((50, 82), "particle"), _label((140, 82), "target"), _label((158, 30), "moves")
        ],
    ),
    "resting-contact": (
        "A sheet falls on a ball and hangs over it.",
        [
            _line(_arc((100, 78), 28, 0, 2, 60), "body", closed=True), _line([(30, 18), (170, 18)]),
            _arrow((56, 24), (56, 44)), _arrow((144, 24), (144, 44)),
            _line([(52, 100), *_arc((100, 78), 32, 0.9, 0.1), (148, 100)], "path")
        ],
    ),
    "momentum-drift": (
        "A bent, spinning sheet flies freely.",
        [
            _line(
                [
                    _FREE[0], *_bent(_FREE[0], _FREE[1], -8), *_bent(_FREE[1], _FREE[2], 7),
                    *_bent(_FREE[2], _FREE[3], 9), *_bent(_FREE[3], _FREE[0], 6)
                ],
                closed=True
            ),
            _line(_arc((100, 56), 46, 0.15, 0.62), "motion"), _arrow((92.6, 10.6), (80, 14.3)),
            _label((100, 62), "no outer force")
        ],
    ),
}
