"""The fields that a cloth can be coloured by, for pictures, films and the view in the page.
Chooses where their colours begin and end, and which field says most."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from data.cloth_values import all_values, edges_of
from data.garment import Garment, garment_of
from data.results import Case
from pictures.look import FABRICS, fabric_code
from plots.plot_style import name_of_fabric_colour

WORDS = {
    "speed": ("speed", "m/s"),
    "strain": ("strain, the largest |length / rest length \u2212 1| of a particle's edges", "1"),
    "angle": ("bending angle, the largest of a particle's hinges, 0 where flat", "rad"),
    "phi": ("distance to the objects, negative inside", "m")
}
COLOUR_BINS = 16                    # in which the colours of a picture are counted
SMALLEST = 1e-9                     # [unit]: a field whose values all stay below is roundings
OF_LARGEST = 99.0                   # percentile of all values at which the colours of a field end
# matplotlib's names of the colour maps: red below zero; sizes from zero on
SIDES, SIZES = "RdBu", "viridis"


@dataclass
class Field:
    """One number for each particle and frame, and how it is coloured."""
    name: str
    label: str                      # with what it is of, in words
    unit: str
    values: np.ndarray              # T x N, of the frames that were asked for
    low: float                      # [unit], where the colours begin
    high: float                     # [unit], where they end
    colours: str                    # SIDES | SIZES | FABRICS

    def codes(self, row: int) -> np.ndarray:
        """Places on the colour bar, N, from 0 to 1; what lies beyond its
        ends has the colour of the end."""
        return np.clip((self.values[row] - self.low) / (self.high - self.low), 0.0, 1.0)


def fields_of(case: Case, frames: list[int]) -> list[Field]:
    """Every field that the file allows and that is more than roundings, in these frames; colours
    span the values of all of them."""
    made = []
    for name, values in all_values(case).items():
        ends = _side_ends(case) if name == "phi" else _size_ends(values[frames])
        if ends[1] > SMALLEST:
            made.append(
                Field(
                    name, *WORDS[name], np.nan_to_num(values[frames], posinf=1e300), *ends,
                    SIDES if name == "phi" else SIZES
                )
            )
    garment = garment_of(case)
    if garment is not None and len(garment.fabrics) > 1:
        made.append(_fabrics(case, garment, len(frames)))
    return made


def _fabrics(case: Case, garment: Garment, frames: int) -> Field:
    """Of each particle the fabric of one of its triangles; colours are read off its label."""
    codes = np.zeros(len(case.held))
    codes[case.triangles] = fabric_code(garment.fabric)[:, None]
    label = "fabric, " + ", ".join(
        f"{name_of_fabric_colour(k)}: {fabric.name}" for k, fabric in enumerate(garment.fabrics)
    )
    return Field("fabric", label, "1", np.tile(codes, (frames, 1)), 0.0, 1.0, FABRICS)


def most_telling(
    fields: list[Field], rows: list[int], edges: np.ndarray
) -> tuple[Field, int] | None:
    """The field and that of the rows whose picture says most: colours are many (their entropy in
    bits), and neighbours are alike (the correlation over the edges), so that it is no noise. Where
    all say the same, as of a sheet that moves as one, the last. None where there are no fields."""
    rated = [(_telling(field.codes(row), edges), field, row) for field in fields for row in rows]
    rated = [one for one in rated if one[1].colours != FABRICS]  # they say nothing of the motion
    return max(rated, key=lambda entry: (entry[0], entry[2]))[1:] if rated else None


def _size_ends(values: np.ndarray) -> tuple[float, float]:
    """Colours of sizes begin at zero."""
    finite = values[np.isfinite(values)]
    return 0.0, float(np.percentile(finite, OF_LARGEST)) if len(finite) else 0.0


def _side_ends(case: Case) -> tuple[float, float]:
    """Colours of distances to the objects go to half an edge to both sides,
    as those of the contact maps do."""
    edges, rest = edges_of(case.triangles), case.rest_positions()
    places = case.positions(0) if rest is None else rest
    limit = 0.5 * float(np.linalg.norm(places[edges[:, 0]] - places[edges[:, 1]], axis=1).mean())
    return -limit, limit


def _telling(codes: np.ndarray, edges: np.ndarray) -> float:
    share = np.histogram(codes, COLOUR_BINS, (0.0, 1.0))[0] / len(codes)
    entropy = -float((share[share > 0] * np.log2(share[share > 0])).sum())
    near, far = codes[edges[:, 0]], codes[edges[:, 1]]
    spread = float(near.std() * far.std())
    alike = (
        float(((near - near.mean()) * (far - far.mean())).mean()) / spread
        if spread > 1e-12
        else 0.0
    )
    return entropy * max(alike, 0.0)
