"""What steps hand on: a state, and the time that a velocity is for."""

from typing import NamedTuple

import numpy as np


class State(NamedTuple):
    time: float  # s
    x: np.ndarray  # N x 3 [m]
    v: np.ndarray  # N x 3 [m/s]


class Span(NamedTuple):
    """When a velocity is corrected."""
    start: float  # of the motion that the velocity makes [s]
    end: float  # the same time if it is the velocity at the end of a step [s]
    step: float  # over which filters look ahead [s]


class Unsupported(Exception):
    """The case asks for something that this program does not do."""
