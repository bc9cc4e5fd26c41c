"""One step of each scheme, as the lists of BMF03 section 3 are printed.

`exp` uses known velocities; `imp` solves (M - h/2 D(x)) w = M v + h/2 (f(x) + g) for w, directly.
"""

import functools
from typing import NamedTuple

import numpy as np

from model import Model
from state import Span, State


def explicit(model: Model, time: float, x: np.ndarray, v: np.ndarray, h: float,
             flow: np.ndarray, seen: np.ndarray) -> np.ndarray:
    """v + h a(time, x, flow), as for particles that nothing holds; drag as at `seen`."""
    matrix, known = model.damping(time, x, seen)
    force = model.elastic(time, x) + known + (matrix @ flow.ravel()).reshape(-1, 3)
    return v + h * force / model.mass[:, None]


def implicit(model: Model, time: float, x: np.ndarray, v: np.ndarray, h: float,
             known_flow: np.ndarray, seen: np.ndarray) -> np.ndarray:
    """The w with w = v + h a(time, x, w); prescribed particles have that of `known_flow`."""
    matrix, known = model.damping(time, x, seen)
    mass = np.repeat(model.mass, 3)
    right = mass * v.ravel() + h * (model.elastic(time, x) + known).ravel()
    left = np.diag(mass) - h * matrix
    w = known_flow.ravel().copy()
    free = np.repeat(~model.held, 3)
    right -= left[:, ~free] @ w[~free]
    w[free] = np.linalg.solve(left[np.ix_(free, free)], right[free])
    return w.reshape(-1, 3)


def scheme_a(model: Model, now: State, h: float) -> State:
    half = explicit(model, now.time, now.x, now.v, h / 2, now.v, now.v)
    flow = model.mean_velocity(now, half, h)
    flow = model.modify(Span(now.time, now.time + h, h), now.x, flow)
    x, time = now.x + h * flow, now.time + h
    v = implicit(model, time, x, half, h / 2, model.prescribed_velocity(half, time, now.time),
                 2 * flow - now.v)
    return State(time, x, model.modify(Span(time, time, h), x, v))


def scheme_b(model: Model, now: State, h: float) -> State:
    half = implicit(model, now.time, now.x, now.v, h / 2, model.mean_velocity(now, now.v, h), now.v)
    half = model.modify(Span(now.time, now.time + h, h), now.x, half)
    x, time = now.x + h * half, now.time + h
    v = explicit(model, time, x, half, h / 2, half, 2 * half - now.v)
    return State(time, x, model.prescribed_velocity(v, time, now.time))


def scheme_c(model: Model, now: State, h: float) -> State:
    flow = implicit(model, now.time, now.x, now.v, h / 2, model.mean_velocity(now, now.v, h), now.v)
    flow = model.modify(Span(now.time, now.time + h, h), now.x, flow)
    x, time = now.x + h * flow, now.time + h
    half = explicit(model, now.time, now.x, now.v, h / 2, now.v, now.v)
    v = implicit(model, time, x, half, h / 2, model.prescribed_velocity(half, time, now.time),
                 2 * flow - now.v)
    return State(time, x, model.modify(Span(time, time, h), x, v))


class Tableau(NamedTuple):
    """Of an explicit Runge-Kutta method (Butcher)."""
    stages: list[list[float]]
    weights: list[float]


TABLEAUS = {
    "forward-euler": Tableau([[]], [1]),
    "RK2": Tableau([[], [1 / 2]], [0, 1]),
    "SSP-RK3": Tableau([[], [1], [1 / 4, 1 / 4]], [1 / 6, 1 / 6, 2 / 3]),
    "RK4": Tableau([[], [1 / 2], [0, 1 / 2], [0, 0, 1]], [1 / 6, 1 / 3, 1 / 3, 1 / 6]),
}


def runge_kutta(tableau: Tableau, model: Model, now: State, h: float) -> State:
    """Prescribed particles have the places and velocities of each stage's time."""
    flows: list[np.ndarray] = []
    accelerations: list[np.ndarray] = []
    for row in tableau.stages:
        time = now.time + h * sum(row)
        x = now.x + h * weighted(row, flows, now.x)
        v = now.v + h * weighted(row, accelerations, now.v)
        x = model.prescribed_place(x, time, now.time)
        v = model.prescribed_velocity(v, time, now.time)
        flows.append(v)
        accelerations.append(explicit(model, time, x, np.zeros_like(v), 1.0, v, v))
    flow = model.mean_velocity(now, weighted(tableau.weights, flows, now.x), h)
    v = now.v + h * weighted(tableau.weights, accelerations, now.v)
    corrected = model.modify(Span(now.time, now.time + h, h), now.x, flow)
    x, time = now.x + h * corrected, now.time + h
    v = model.prescribed_velocity(v + corrected - flow, time, now.time)
    return State(time, x, model.modify(Span(time, time, h), x, v))


def weighted(weights: list[float], terms: list[np.ndarray], shape: np.ndarray) -> np.ndarray:
    return sum((weight * term for weight, term in zip(weights, terms)), np.zeros_like(shape))


SCHEMES = {"A": scheme_a, "B": scheme_b, "C": scheme_c} | {
    name: functools.partial(runge_kutta, tableau) for name, tableau in TABLEAUS.items()
}
