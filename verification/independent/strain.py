"""Strain limits: sweeps over the springs (BMF03 section 3, after Provot 1995)."""

import math

import numpy as np

from state import Span
from surface import Surface


class StrainLimits:
    """Springs stay within limits over a step, by impulses along their current directions."""

    def __init__(self, cloth: Surface, inverse_mass: np.ndarray, keys: dict, scale: float) -> None:
        self.inverse_mass = inverse_mass
        low, high = 1 - keys.get("compression", 0.0), 1 + keys.get("extension", 0.1)
        self.order, self.sweeps = keys.get("order", "gauss_seidel"), keys.get("sweeps", 20)
        self.tolerance = keys.get("tolerance", 1e-3)
        springs = [(int(a), int(b)) for a, b in sorted(map(tuple, np.sort(cloth.edges, axis=1)))]
        if self.order == "coloured":
            colour = colours_of(springs)
            springs = sorted(springs, key=lambda spring: (colour[spring], spring))
        self.springs = springs
        lengths = [scale * float(np.linalg.norm(cloth.rest[b] - cloth.rest[a])) for a, b in springs]
        self.rest = lengths
        self.bounds = [(low * length, high * length) for length in lengths]
        self.most_sweeps = 0  # of any call

    def __call__(self, span: Span, x: np.ndarray, v: np.ndarray) -> np.ndarray:
        v = v.copy()
        for number in range(self.sweeps):
            self.most_sweeps = max(self.most_sweeps, number + 1)
            numbers = list(range(len(self.springs)))
            if self.order == "alternating" and number % 2 == 1:
                numbers.reverse()
            if self.order == "jacobi":
                worst = self.sweep_at_once(numbers, span.step, x, v)
            else:
                worst = self.sweep_in_turn(numbers, span.step, x, v)
            if worst <= self.tolerance and self.violation(span.step, x, v) <= self.tolerance:
                break
        return v

    def violation(self, h: float, x: np.ndarray, v: np.ndarray) -> float:
        return max(self.needed(number, h, x, v)[0] for number in range(len(self.springs)))

    def sweep_in_turn(self, numbers: list[int], h: float, x: np.ndarray, v: np.ndarray) -> float:
        """The largest violation that a spring had when its turn came."""
        worst = 0.0
        for number in numbers:
            violation, change = self.needed(number, h, x, v)
            worst = max(worst, violation)
            self.push(number, change / h, v)
        return worst

    def sweep_at_once(self, numbers: list[int], h: float, x: np.ndarray, v: np.ndarray) -> float:
        """Each impulse is divided by the larger number of impulses at its two ends; prescribed
        particles, which none can move, do not count."""
        found = {number: self.needed(number, h, x, v) for number in numbers}
        acting = {number: change for number, (_, change) in found.items() if change.any()}
        meeting = np.zeros(len(x))
        for number in acting:
            meeting[list(self.springs[number])] += 1
        meeting[self.inverse_mass == 0] = 0
        for number, change in acting.items():
            self.push(number, change / (h * meeting[list(self.springs[number])].max()), v)
        return max(violation for violation, _ in found.values())

    def needed(self, number: int, h: float, x: np.ndarray,
               v: np.ndarray) -> tuple[float, np.ndarray]:
        """How far the predicted length is beyond a limit, in rest lengths; and the change of the
        predicted difference, along d, that brings it to the limit. A spring whose part across d
        is too long is made as short as it can be."""
        a, b = self.springs[number]
        d = x[b] - x[a]
        predicted = d + h * (v[b] - v[a])
        length = float(np.linalg.norm(predicted))
        low, high = self.bounds[number]
        target = min(max(length, low), high)
        violation = abs(length - target) / self.rest[number]
        if violation < 1e-15 or not (self.inverse_mass[a] or self.inverse_mass[b]):
            return violation, np.zeros(3)
        direction = d / np.linalg.norm(d)
        along = predicted @ direction
        across = predicted - along * direction
        wanted = math.sqrt(max(0.0, target**2 - across @ across))
        return violation, (wanted - along) * direction

    def push(self, number: int, change: np.ndarray, v: np.ndarray) -> None:
        """Changes v_b - v_a by equal and opposite impulses."""
        a, b = self.springs[number]
        w_a, w_b = self.inverse_mass[a], self.inverse_mass[b]
        if w_a + w_b > 0:
            v[a] -= w_a / (w_a + w_b) * change
            v[b] += w_b / (w_a + w_b) * change


def colours_of(springs: list[tuple[int, int]]) -> dict[tuple[int, int], int]:
    """In their order, each spring gets the first colour that no earlier one at its ends has."""
    taken: dict[int, set[int]] = {}
    colours = {}
    for a, b in springs:
        used = taken.setdefault(a, set()) | taken.setdefault(b, set())
        colour = next(number for number in range(len(springs)) if number not in used)
        colours[a, b] = colour
        taken[a].add(colour)
        taken[b].add(colour)
    return colours
