#!/usr/bin/python3
"""Solvers that keep to the protocol and are wrong, each in one law of
physics or one claim: wrong.py KIND

The portable suite must find each by the laws that it breaks. "none" is the unspoiled toy;
"backward_euler" and "trapezoidal", alone or after "damped_", and "in_turn" are other correct
schemes, which must raise no alarm, at f8; "single", "backward_euler_single" and
"substeps_in_single" are some at f4, as "bends_in_substeps_of_single", "sleeps" is right but slow,
and "clamps_where_held" right where bending begins behind a clamp.
"""
from __future__ import annotations

import os
import sys
from pathlib import Path

os.environ["OPENBLAS_NUM_THREADS"] = "1"  # before numpy: small systems, and other jobs beside

import numpy as np  # noqa: E402

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "adapters"))
import contact  # noqa: E402
import materials  # noqa: E402
import processes  # noqa: E402
import round_bodies  # noqa: E402
import scaled  # noqa: E402
import schemes  # noqa: E402
import stated  # noqa: E402
from foldproof_solver import Scene, serve  # noqa: E402
from schemes import (  # noqa: E402
    BackwardEuler,
    BackwardEulerInSingle,
    DampedBackwardEuler,
    DampedTrapezoidal,
    Single,
    Trapezoidal,
)
from toy_solver import ToySolver  # noqa: E402


class Unspoiled(ToySolver):
    """The toy."""


class WrongMass(ToySolver):
    def prepare(self, scene: Scene) -> dict[str, str]:
        mapping = super().prepare(scene)
        self.mass = np.full_like(self.mass, self.mass.mean())
        return mapping


class OwnMassesIgnored(ToySolver):
    """Masses are those of the density, whatever the scene says."""

    def prepare(self, scene: Scene) -> dict[str, str]:
        mapping = super().prepare(scene)
        a, b, c = (scene.rest[scene.triangles[:, k]] for k in range(3))
        areas = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
        thirds = np.repeat(scene.header["scene"]["material"]["density"] * areas / 3, 3)
        self.mass = np.bincount(scene.triangles.ravel(), thirds, len(self.x))
        return mapping


class GravityScaled(ToySolver):
    def prepare(self, scene: Scene) -> dict[str, str]:
        mapping = super().prepare(scene)
        self.gravity = 1.02 * self.gravity
        return mapping


class StandsStillToHalf(ToySolver):
    """Moves nothing, and declares a tolerance that would allow it."""

    solve_tolerance = 0.5

    def advance(self, dt: float, steps: int) -> None:
        pass


class MomentumDropped(ToySolver):
    def advance(self, dt: float, steps: int) -> None:
        for _ in range(steps):
            super().advance(dt, 1)
            self.v[0] *= 0.999


class SingleForDouble(ToySolver):
    def advance(self, dt: float, steps: int) -> None:
        for _ in range(steps):
            super().advance(dt, 1)
            self.x, self.v = self.x.astype("f4").astype("f8"), self.v.astype("f4").astype("f8")


class FirstOrderAsSecond(ToySolver):
    scheme, order = "symplectic Euler, said to be Verlet", 2


class FirstOrderAsSecondInSingle(Single):
    scheme, order = "symplectic Euler, said to be Verlet", 2


class HiddenDamping(ToySolver):
    def advance(self, dt: float, steps: int) -> None:
        for _ in range(steps):
            super().advance(dt, 1)
            self.v *= 1 - 0.05 * dt


class KnowsItsAxes(ToySolver):
    """Springs along x are stiffer: right where it was tried, wrong when turned."""

    def forces(self) -> np.ndarray:
        f = super().forces()
        weight = self.mass[:, None] * self.gravity
        return weight + (f - weight) * np.array([1.01, 1, 1])


class DependsOnNumbers(ToySolver):
    """Springs whose first end has an even number are stiffer by a millionth."""

    def prepare(self, scene: Scene) -> dict[str, str]:
        mapping = super().prepare(scene)
        self.k = self.k * (1 + 1e-6 * (self.edges[:, 0] % 2 == 0))
        return mapping


class HeldLoosely(ToySolver):
    def advance(self, dt: float, steps: int) -> None:
        held, self.held = self.held, np.array([], int)
        start = self.x[held].copy()
        super().advance(dt, steps)
        self.x[held] = start + 1e-6 * (self.x[held] - start)
        self.held = held


class EnergyHalved(ToySolver):
    def energy(self) -> float:
        return 0.5 * super().energy()


class PreStressed(ToySolver):
    def prepare(self, scene: Scene) -> dict[str, str]:
        mapping = super().prepare(scene)
        self.length = 0.999 * self.length
        return mapping


class SpinDamped(ToySolver):
    """Takes angular momentum from a free sheet, linear momentum not."""

    def advance(self, dt: float, steps: int) -> None:
        for _ in range(steps):
            super().advance(dt, 1)
            mean = self.mass @ self.v / self.mass.sum()
            self.v = mean + (1 - 0.5 * dt) * (self.v - mean)


class ForcesUnbalanced(ToySolver):
    def forces(self) -> np.ndarray:
        f = super().forces()
        f[3] += 1e-9 * np.abs(f).max()
        return f


class KnowsItsUnits(ToySolver):
    """A margin in metres: rest lengths below it are not met."""

    def forces(self) -> np.ndarray:
        direction, elongation = self.springs()
        slack = np.sign(elongation) * np.minimum(np.abs(elongation), 1e-6)
        f = super().forces()
        pull = (self.k * slack)[:, None] * direction
        np.add.at(f, self.edges[:, 0], -pull)
        np.add.at(f, self.edges[:, 1], pull)
        return f


class KnowsLeftFromRight(ToySolver):
    """Each triangle is turned a little about its normal."""

    def prepare(self, scene: Scene) -> dict[str, str]:
        self.triangles = scene.triangles
        return super().prepare(scene)

    def forces(self) -> np.ndarray:
        f, corners = super().forces(), self.triangles.T
        for k in range(3):
            side = self.x[corners[(k + 2) % 3]] - self.x[corners[(k + 1) % 3]]
            np.add.at(f, corners[k], 1e-6 * side)
        return f


class GravityScaledInSingle(Single):
    """Wrong by less than a loose bound on the rounding of single precision would allow."""

    def prepare(self, scene: Scene) -> dict[str, str]:
        mapping = super().prepare(scene)
        self.gravity = np.float32(1.01) * self.gravity
        return mapping


class StiffensWithSmallSteps(ToySolver):
    """What a fixed number of iterations without compliance does: stiffness goes as 1/dt^2."""

    def advance(self, dt: float, steps: int) -> None:
        given, self.k = self.k, self.k * (0.002 / dt) ** 2
        super().advance(dt, steps)
        self.k = given


class StiffensALittleInSingle(Single):
    """Its changes grow fourfold, and are less than a bound on rounding in single precision."""

    def advance(self, dt: float, steps: int) -> None:
        given, self.k = self.k, self.k * np.float32(0.99 + 0.01 * (0.002 / dt) ** 2)
        super().advance(dt, steps)
        self.k = given


class SubstepsInSingle(Single):
    """Right, as position based engines are: five substeps a step, velocities from positions of
    single precision, so that short steps are mostly rounding."""

    def advance(self, dt: float, steps: int) -> None:
        dt /= 5
        for _ in range(5 * steps):
            start = self.x.astype("f4")
            super().advance(dt, 1)
            self.x = self.x.astype("f4").astype("f8")
            self.v = (self.x - start) / dt


class BendsInSubstepsOfSingle(SubstepsInSingle, materials.Bends):
    """Right; in steps of 0.1 ms a strip gains less speed by its bending than rounding gives it."""


class HeldSheetsWeighTwice(ToySolver):
    """Gravity is added once more where particles are held."""

    def prepare(self, scene: Scene) -> dict[str, str]:
        mapping = super().prepare(scene)
        if len(self.held):
            self.gravity = 2 * self.gravity
        return mapping


KINDS = {
    "bends": materials.Bends,
    "on_planes": contact.OnPlanes,
    "on_planes_single": contact.OnPlanesInSingle,
    "on_planes_backward_euler": contact.OnPlanesBackwardEuler,
    "on_planes_backward_euler_single": contact.OnPlanesBackwardEulerInSingle,
    "gravity_scaled_single": GravityScaledInSingle,
    "weft_per_length": materials.WeftPerLength,
    "springs_per_length": materials.SpringsPerLength,
    "springs_of_one_stiffness": materials.SpringsOfOneStiffness,
    "knows_its_units": KnowsItsUnits,
    "knows_left_from_right": KnowsLeftFromRight,
    "rest_lengths_kept": processes.RestLengthsKept,
    "springs_keep_their_directions": materials.SpringsKeepTheirDirections,
    "bends_upright_only": materials.BendsUprightOnly,
    "bends_face_up_alone": materials.BendsFaceUpAlone,
    "stiffens_when_sharp": materials.StiffensWhenSharp,
    "gives_at_small_angles": materials.GivesAtSmallAngles,
    "held_strips_weigh_twice": materials.HeldStripsWeighTwice,
    "held_strips_weigh_a_tenth_more": materials.HeldStripsWeighATenthMore,
    "bends_one_way_alone": materials.BendsOneWayAlone,
    "bends_by_long_springs": materials.BendsByLongSprings,
    "clamps_where_held": materials.ClampsWhereHeld,
    "weight_is_limited": materials.WeightIsLimited,
    "bends_with_limited_weight": materials.BendsWithLimitedWeight,
    "damped": materials.Damped,
    "damping_halved": materials.DampingHalved,
    "damps_all_motion": materials.DampsAllMotion,
    "mean_dampers": stated.MeanDampers,
    "damps_late": stated.DampsLate,
    "states_twice_the_damping": stated.StatesTwiceTheDamping,
    "states_unbalanced_damping": stated.StatesUnbalancedDamping,
    "energy_without_weight": stated.EnergyWithoutWeight,
    "states_stale_forces": stated.StatesStaleForces,
    "forgets_what_is_set": stated.ForgetsWhatIsSet,
    "springs_tear": materials.SpringsTear,
    "damped_backward_euler": DampedBackwardEuler,
    "damped_trapezoidal": DampedTrapezoidal,
    "damped_verlet": materials.DampedVerlet,
    "damped_verlet_single": materials.DampedVerletInSingle,
    "damped_unasked": materials.DampedUnasked,
    "bends_not_at_all": materials.BendsNotAtAll,
    "bends_unasked": materials.BendsUnasked,
    "springs_pull_alone": materials.SpringsPullAlone,
    "bends_fourfold": materials.BendsFourfold,
    "bends_to_flat": materials.BendsToFlat,
    "bending_energy_tripled": materials.BendingEnergyTripled,
    "bending_pulls_one_corner_less": materials.BendingPullsOneCornerLess,
    "on_boxes": contact.OnBoxes,
    "on_boxes_now_and_then": contact.OnBoxesNowAndThen,
    "particles_repel_alone": contact.ParticlesRepelAlone,
    "starts_from_rest": contact.StartsFromRest,
    "on_round_bodies": round_bodies.OnRoundBodies,
    "on_round_bodies_single": round_bodies.OnRoundBodiesInSingle,
    "on_round_bodies_backward_euler": round_bodies.OnRoundBodiesBackwardEuler,
    "chokes_on_round_bodies": round_bodies.ChokesOnRoundBodies,
    "radius_too_small": round_bodies.RadiusTooSmall,
    "radius_too_large": round_bodies.RadiusTooLarge,
    "stops_from_above": round_bodies.StopsFromAbove,
    "throws_back": round_bodies.ThrowsBack,
    "throws_back_when_fast": round_bodies.ThrowsBackWhenFast,
    "round_bodies_turn": round_bodies.RoundBodiesTurn,
    "round_bodies_without_friction": round_bodies.RoundBodiesWithoutFriction,
    "round_friction_halved": round_bodies.RoundFrictionHalved,
    "round_friction_is_drag": round_bodies.RoundFrictionIsDrag,
    "capsules_are_balls": round_bodies.CapsulesAreBalls,
    "round_bodies_stick": round_bodies.RoundBodiesStick,
    "sinks_in": contact.SinksIn,
    "jitters": contact.Jitters,
    "bounces_too_high": contact.BouncesTooHigh,
    "bounces_too_high_when_fast": contact.BouncesTooHighWhenFast,
    "boxes_throw_back": contact.BoxesThrowBack,
    "planes_are_level": contact.PlanesAreLevel,
    "friction_turns": contact.FrictionTurns,
    "planes_pass_the_origin": contact.PlanesPassTheOrigin,
    "friction_per_axis": contact.FrictionPerAxis,
    "friction_beyond_the_cone": contact.FrictionBeyondTheCone,
    "friction_creeps": contact.FrictionCreeps,
    "friction_halved": contact.FrictionHalved,
    "sticks_to_planes": contact.SticksToPlanes,
    "bends_on_planes": contact.BendsOnPlanes,
    "bends_on_planes_that_hold_down": contact.BendsOnPlanesThatHoldDown,
    "bends_on_planes_friction_halved": contact.BendsOnPlanesFrictionHalved,
    "bends_on_planes_friction_of_weight": contact.BendsOnPlanesFrictionOfWeight,
    "none": Unspoiled,
    "backward_euler": BackwardEuler,
    "backward_euler_single": BackwardEulerInSingle,
    "trapezoidal": Trapezoidal,
    "single": Single,
    "wrong_mass": WrongMass,
    "own_masses_ignored": OwnMassesIgnored,
    "gravity_scaled": GravityScaled,
    "stands_still_to_half": StandsStillToHalf,
    "momentum_dropped": MomentumDropped,
    "single_for_double": SingleForDouble,
    "first_order_as_second": FirstOrderAsSecond,
    "first_order_as_second_single": FirstOrderAsSecondInSingle,
    "hidden_damping": HiddenDamping,
    "state_not_restored": processes.StateNotRestored,
    "scene_leaves_traces": processes.SceneLeavesTraces,
    "random": processes.Random,
    "knows_its_axes": KnowsItsAxes,
    "depends_on_numbers": DependsOnNumbers,
    "in_turn": schemes.InTurn,
    "stiffens_with_small_steps": StiffensWithSmallSteps,
    "stiffens_a_little_single": StiffensALittleInSingle,
    "substeps_in_single": SubstepsInSingle,
    "bends_in_substeps_of_single": BendsInSubstepsOfSingle,
    "sleeps": processes.Sleeps,
    "asks_all_pairs": processes.AsksAllPairs,
    "waits_for_all_pairs": processes.WaitsForAllPairs,
    "held_sheets_weigh_twice": HeldSheetsWeighTwice,
    "held_loosely": HeldLoosely,
    "energy_halved": EnergyHalved,
    "pre_stressed": PreStressed,
    "spin_damped": SpinDamped,
    "forces_unbalanced": ForcesUnbalanced,
}

if __name__ == "__main__":
    if len(sys.argv) == 4 and sys.argv[1] == "scaled" and sys.argv[2] in scaled.QUANTITIES:
        serve(scaled.scaled(*sys.argv[2:]))
        sys.exit()
    if len(sys.argv) != 2 or sys.argv[1] not in KINDS:
        print("usage: wrong.py KIND, below foldproof;", *KINDS)
        print("or wrong.py scaled QUANTITY FACTOR;", *scaled.QUANTITIES)
        sys.exit(2)
    serve(KINDS[sys.argv[1]]())
