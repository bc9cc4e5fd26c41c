"""The same scene in each judged solver: a sheet that has fallen on a ball, seen by one camera."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from data.trials import Trial
from pictures.camera import choose_camera
from pictures.case_pictures import picture_uri
from pictures.cloth_picture import Cloth, Scenery, picture_of

UP = np.array([0.0, 0.0, 1.0])
DRAWN = 0.985  # of the ball: cloth that lies on it hides it
FAR = 3.0  # of the ball's radius: what is farther off its centre has left the picture


@dataclass(frozen=True)
class Portrait:
    label: str
    uri: str  # of the picture; "" if there is none
    words: str  # what is to see, or why there is nothing


@dataclass(frozen=True)
class Portraits:
    about: str  # the scene, as the program says it
    all: list[Portrait]  # one for each solver


def portraits_of(trials: list[Trial], labels: list[str]) -> Portraits | None:
    """None if no solver has a picture."""
    asked = [trial.facts.get("portrait") for trial in trials]
    drawn = [one for one in asked if one and "x" in one and _is_near(one)]
    if not drawn:
        return None
    ball, ball_triangles = _sphere(np.array(drawn[0]["centre"]), DRAWN * drawn[0]["radius"])
    shapes = [np.array(one["x"]) for one in drawn]
    triangles = np.array(drawn[0]["triangles"])
    camera = choose_camera(shapes, triangles, ball, UP)
    scenery = Scenery(ball, ball_triangles, np.zeros(len(ball), dtype=bool),
                      np.array(drawn[0]["centre"]), FAR * drawn[0]["radius"])
    return Portraits(
        drawn[0]["about"],
        [_portrait(label, one, camera, scenery) for label, one in zip(labels, asked)]
    )


def _portrait(label: str, one: dict[str, Any] | None, camera: Any, scenery: Scenery) -> Portrait:
    if one is None:
        return Portrait(label, "", "not asked: only some laws were")
    if "x" not in one:
        return Portrait(label, "", one["why_none"])
    if not _is_near(one):
        return Portrait(label, "", "the sheet is not at the ball")
    x = np.array(one["x"])
    cloth = Cloth(x, np.array(one["triangles"]), np.zeros(len(x), dtype=bool))
    depth = one["radius"] - np.linalg.norm(x - one["centre"], axis=1).min()
    lowest = one["centre"][2] + one["radius"] - x[:, 2].min()
    words = f"lowest point {lowest:.3f} m below the ball's top"
    if depth > 0.01 * one["radius"]:
        words += f"; {1000 * depth:.0f} mm deep in the ball"
    return Portrait(label, picture_uri(picture_of(cloth, camera, scenery)), words)


def _is_near(one: dict[str, Any]) -> bool:
    away = np.linalg.norm(np.array(one["x"]) - one["centre"], axis=1)
    return bool(away.max() < 2 * FAR * one["radius"])


def _sphere(centre: np.ndarray, radius: float) -> tuple[np.ndarray, np.ndarray]:
    """Vertices V x 3 [m] and triangles F x 3 of a sphere."""
    rings, sectors = 24, 48
    theta, phi = np.meshgrid(np.linspace(0, np.pi, rings + 1),
                             np.linspace(0, 2 * np.pi, sectors, endpoint=False), indexing="ij")
    points = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], -1)
    row, column = np.meshgrid(np.arange(rings), np.arange(sectors), indexing="ij")
    a, b = row * sectors + column, row * sectors + (column + 1) % sectors
    lower = np.stack([a, a + sectors, b + sectors], -1), np.stack([a, b + sectors, b], -1)
    return centre + radius * points.reshape(-1, 3), np.concatenate(lower).reshape(-1, 3)
