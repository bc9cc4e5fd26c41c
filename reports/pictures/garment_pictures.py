"""A garment as it is worn: triangles in the colours of their fabrics, strokes along the warp."""
from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from data.cloth_values import area_normals
from data.garment import Garment, garment_of
from data.results import Case
from pictures.camera import Camera
from pictures.case_pictures import Picture, picture_uri, select_frames
from pictures.cloth_picture import Cloth, picture_of
from pictures.look import FABRICS, fabric_code
from plots.pattern_plot import FlatPlaces, plot_pattern, stroke_distance, warp_strokes
from plots.plot_style import Plot, fabric_colour, variable_of

THICK, RAISED = 0.035, 0.02  # width of a stroke and its height over the cloth, of their distance
ARROW = 17.0                 # longest half of the wind's arrow, in the units of its drawing


@dataclass
class GarmentView:
    """What a page shows of a garment."""
    garment: Garment
    pattern: Plot | None
    pictures: list[Picture]
    size: tuple[int, int]        # pixels of each
    swatches: list[str]          # a CSS colour for each fabric
    # from where to where the wind blows in the pictures, x0, y0, x1, y1 within -ARROW .. ARROW;
    # None where there is none
    arrow: tuple[float, float, float, float] | None

    @property
    def columns(self) -> list[tuple[str, list[float]]]:
        """Of the table of fabrics: what at least one of them has, and its value of each."""
        heads = {
            "density": "density [kg/m²]", "area": "area [m²]", "mass": "mass [kg]",
            "stretch": "springs, Y [N/m]", "warp": "warp [N/m]", "weft": "weft [N/m]",
            "shear": "shear [N/m]", "bending": "bending, ke [J]"
        }
        fabrics = self.garment.fabrics
        columns = [(head, [getattr(one, key) for one in fabrics]) for key, head in heads.items()]
        return [(head, values) for head, values in columns if not np.isnan(values).all()]

    @property
    def wind_speed(self) -> float:
        """[m/s]; 0 for still air, or none."""
        return 0.0 if self.garment.wind is None else float(np.linalg.norm(self.garment.wind))


def make_garment_view(case: Case, name: str, folder: Path) -> GarmentView | None:
    """None for a case without panels, fabrics and air."""
    garment = garment_of(case)
    if garment is None or not len(case.frame_times):
        return None
    chosen, scene = select_frames(case)
    shown = [chosen[0], chosen[-1]] if len(chosen) > 1 else chosen
    strokes = _Strokes(garment) if garment.pattern is not None else None
    pictures = []
    for frame in shown if garment.fabrics else []:
        cloth = dressed(case, garment, frame, strokes)
        picture = picture_uri(picture_of(cloth, scene.camera, scene.scenery(frame)))
        pictures.append(
            Picture(float(case.frame_times[frame]), picture, scene.is_whole(case.positions(frame)))
        )
    return GarmentView(
        garment, plot_pattern(garment, name, folder), pictures, scene.camera.pixels,
        [variable_of(fabric_colour(k)) for k in range(len(garment.fabrics))],
        _arrow(garment.wind, scene.camera)
    )


def dressed(case: Case, garment: Garment, frame: int, strokes: _Strokes | None) -> Cloth:
    """The cloth of one frame: a particle has a vertex for each fabric that meets in it, and the
    strokes are triangles above either side."""
    x = case.positions(frame)
    corners = np.stack([np.repeat(garment.fabric, 3), case.triangles.ravel()], axis=1)
    vertices, index = np.unique(corners, axis=0, return_inverse=True)
    places, triangles = x[vertices[:, 1]], index.reshape(-1, 3)
    codes, held = fabric_code(vertices[:, 0]), case.held[vertices[:, 1]]
    if strokes is not None and np.isfinite(x).all():
        more, ribbons = strokes.on(x, case.triangles)
        triangles = np.concatenate([triangles, ribbons + len(places)])
        places = np.concatenate([places, more])
        codes = np.concatenate([codes, np.ones(len(more))])
        held = np.concatenate([held, np.zeros(len(more), bool)])
    return Cloth(places, triangles, held, None, codes, FABRICS)


class _Strokes:
    """Strokes by their places in the pattern: S strokes of P points."""

    def __init__(self, garment: Garment) -> None:
        flat = warp_strokes(garment)
        self.apart = stroke_distance(garment)
        self.owner = np.zeros(flat.shape[:2], int)
        self.weights = np.zeros(flat.shape[:2] + (3,))
        if len(flat):
            places = FlatPlaces(garment.pattern)
            self.owner = places.triangles(flat)
            self.weights = places.weights(flat, self.owner)

    def on(self, x: np.ndarray, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Vertices V x 3 [m] and triangles of the strokes on a cloth."""
        line = (self.weights[..., None] * x[triangles[self.owner]]).sum(axis=2)
        normal = _unit(area_normals(x, triangles))[self.owner]
        aside = _unit(np.cross(np.gradient(line, axis=1), normal)) * THICK * self.apart / 2
        rise = RAISED * self.apart * normal
        borders = [line + up * rise + side * aside for up in (1, -1) for side in (1, -1)]
        vertices = np.stack(borders, axis=2)                     # S x P x 4 x 3
        number = np.arange(vertices[..., 0].size).reshape(vertices.shape[:3])
        ribbons = []
        for face in (0, 2):
            a, b = number[:, :-1, face], number[:, :-1, face + 1]
            c, d = number[:, 1:, face], number[:, 1:, face + 1]
            ribbons += [np.stack([a, b, d], axis=-1), np.stack([a, d, c], axis=-1)]
        return vertices.reshape(-1, 3), np.concatenate([one.reshape(-1, 3) for one in ribbons])


def _unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-300)


def _arrow(
    wind: np.ndarray | None, camera: Camera
) -> tuple[float, float, float, float] | None:
    if wind is None or not np.linalg.norm(wind) > 0:
        return None
    x, y = ARROW * np.array([wind @ camera.right, -(wind @ camera.up)]) / np.linalg.norm(wind)
    return (-float(x), -float(y), float(x), float(y))
