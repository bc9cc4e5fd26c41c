"""A case as its pictures show it: one camera for all frames, the cloth and the objects of each."""
from __future__ import annotations

import numpy as np

from data.results import Case
from pictures.camera import Camera, choose_camera, frames_that_set_the_scale, up_against
from pictures.case_fields import Field
from pictures.cloth_picture import Cloth, Scenery

# of the cloth's size: parts of objects this near to it are in the picture
NEAR = 0.35
ENDLESS = "half_space"              # the shape that has no end
SHORTEST = 0.5                      # seconds that a film lasts at least


class CaseScene:
    """The scene of a case; its camera holds the cloth in the frames that are shown."""

    def __init__(self, case: Case, shown: list[int]) -> None:
        frames = [case.positions(frame) for frame in shown]
        kept = np.concatenate(frames_that_set_the_scale(frames))
        self.case = case
        # 3 [m], of the cloth in these frames
        self.centre = 0.5 * (kept.min(axis=0) + kept.max(axis=0))
        self.reach = max(float(np.linalg.norm(kept - self.centre, axis=1).max()), 1e-12)   # [m]
        self.up = up_against(case.gravity)                          # 3, unit
        self.camera: Camera = choose_camera(
            frames, case.triangles, self._landmarks(kept, shown), self.up
        )

    def cloth(self, frame: int, field: Field | None = None, row: int = 0) -> Cloth:
        """The cloth in one frame, in its two colours or in those of a row of a field."""
        case = self.case
        codes, colours = (None, "") if field is None else (field.codes(row), field.colours)
        return Cloth(
            case.positions(frame), case.triangles, case.held, case.stuck(frame), codes, colours
        )

    def scenery(self, frame: int) -> Scenery | None:
        """All objects in one frame; None if there are none."""
        objects = self.case.objects
        if not objects:
            return None
        starts = np.cumsum([0] + [len(part.vertices) for part in objects])
        return Scenery(
            np.concatenate([part.positions(frame) for part in objects]),
            np.concatenate([part.triangles + start for part, start in zip(objects, starts)]),
            np.concatenate(
                [np.full(len(part.vertices), part.shape == ENDLESS) for part in objects]
            ),
            self.centre,
            self.reach,
        )

    def is_whole(self, x: np.ndarray) -> bool:
        """Whether all of the cloth is finite and in the picture."""
        if not np.isfinite(x).all():
            return False
        points, _ = self.camera.project(x, 1)
        return bool((points >= -1).all() and (points <= np.array(self.camera.pixels) + 1).all())

    def _landmarks(self, cloth: np.ndarray, shown: list[int]) -> np.ndarray:
        """Points of the objects that the picture has to hold, M x 3 [m]: those near the
        cloth, for a floor has no end."""
        low, high = cloth.min(axis=0), cloth.max(axis=0)
        reach = NEAR * (high - low).max()
        parts = [part.positions(frame) for frame in shown for part in self.case.objects]
        points = np.concatenate([*parts, np.zeros((0, 3))])
        return points[((points >= low - reach) & (points <= high + reach)).all(axis=1)]


def slowdown(seconds: float) -> float:
    """How many times slower than in truth a simulation of so many seconds is shown:
    1, or so that it lasts SHORTEST."""
    if not seconds > 0 or seconds >= SHORTEST:
        return 1.0
    power = 10.0 ** np.floor(np.log10(SHORTEST / seconds))
    return float(
        next(
            step * power
            for step in (1.0, 2.0, 5.0, 10.0)
            if step * power * seconds >= SHORTEST * (1 - 1e-9)
        )
    )
