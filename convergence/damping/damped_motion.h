// Motions that damping alone brings to rest, whose way is known: a triangle that expands, a hinge
// that folds, a sheet in which every damped mode moves.
#pragma once

#include <string_view>
#include <vector>

#include "verification/subject.h"

namespace foldproof {

/// A motion without stiffness. Its coordinates go from 0 to 1 without ever turning back.
struct DampedMotion {
  std::string name, words;
  Scene scene;
  double rate;                           // c, of the fastest coordinate [1/s]
  std::function<State(double t)> exact;  // at t [s] > 0
  // of each coordinate over its whole way [1]
  std::function<std::vector<double>(const State&)> progress;
  // of each coordinate over that at the start [1]
  std::function<std::vector<double>(const State&)> speed;
};

/// An equilateral triangle of damped edges, expanding evenly: its directions never change, so that
/// the motion is linear, with c = 9 kd/(density L^2).
DampedMotion expanding_triangle();

/// A hinge of damped angle and damped edges that folds by about 0.8 rad: not linear. Its way is
/// GSL's; its exact motion passes its place of rest by 0.4 % and returns.
DampedMotion folding_hinge();

/// A flat sheet of damped springs; a coordinate is a mode of vibration that stiffness as large as
/// the damping would have, and as such a mode of the damping.
DampedMotion sheet_in_plane(int cells);

// Motions to rest against stiffness that damping outweighs.

/// A flat, free sheet with springs and hinges, whose modes are all damped more than four times
/// critically. Each starts displaced by its way and moving towards rest, so that half of the way
/// decays at its fast rate and half at its slow one: positions and velocities both fall without a
/// turn. rate: the fastest mode's c.
DampedMotion overdamped_sheet(int cells);

/// A hinge bent by nearly two radians beyond its rest angle, with one triangle held, released;
/// springs and hinge overdamped. Not linear. Its way is that back to the rest angle, and its speed
/// is over way times rate.
DampedMotion closing_hinge();

struct DampedMotions {
  DampedMotion triangle, hinge, sheet;
};

/// Progress and speed of all coordinates, and the energy, after each step from the
/// start: a row a step.
struct DampedRun {
  std::vector<std::vector<double>> progress, speed;
  std::vector<double> kinetic_energy;  // over that at the start [1]
  Work work;
};

/// Steps with h = 2 a/c. BDF2 gets the exact state after its first step, so that it is judged and
/// not the method that starts it. A run ends early when a coordinate passes 1e9, or is NaN.
DampedRun run_damped(const Subject& subject, const DampedMotion& motion, std::string_view method,
                     double a, int steps);

/// The largest progress of any coordinate: 1 when nothing overshoots (with signs; NaN if any is).
double largest_progress(const DampedRun& run);

/// How far any coordinate has turned back at most, over its whole way; 0 when its
/// progress never falls.
double largest_reversal(const DampedRun& run);

/// Turning back or overshooting, the worse of the two, over the whole displacement.
double worst_overshoot_or_reversal(const DampedRun& run);

}  // namespace foldproof
