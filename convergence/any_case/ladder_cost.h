// Costs of a ladder's levels: measured of those that ran, forecast of the others.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "convergence/any_case/level_run.h"

namespace foldproof {

struct LevelCost {
  double work = 0;     // operator applications times particles [1]
  double seconds = 0;  // of the processor, for one thread [s]
  // memory for positions of all frames and ends of all steps, doubled for writing them [bytes]
  double bytes = 0;
};

LevelCost cost_of(const Level& level, const LevelRun& run);

/// The costs of all `levels`: the measured ones (two or more), then forecasts of the others.
/// Work and bytes grow from level to level by the factor of the last two measured ones (bytes never
/// fall), seconds as work does.
std::vector<LevelCost> foreseen_costs(const std::vector<LevelCost>& measured, int levels);

struct LadderLimits {
  double seconds = std::numeric_limits<double>::infinity();  // of the clock, for the whole ladder
  double bytes = std::numeric_limits<double>::infinity();
};

/// Seconds of the processor for levels first .. last.
std::vector<double> seconds_of(const std::vector<LevelCost>& costs, size_t first, size_t last);

/// Seconds of the clock for runs that each take so many of the processor, side by side on `threads`
/// cores.
double clock_seconds(const std::vector<double>& seconds, int threads);

/// The other runs of a ladder in space, each as a share of the finest mesh's seconds. The first is
/// the check of the steps, with twice as many steps and a quarter of the particles; then come the
/// coarser meshes, coarse to fine, with the finest one's steps. finest: that mesh's level.
std::vector<double> parts_of_finest(int finest);

/// Seconds of the clock for a ladder in space whose finest mesh is level `finest` and takes so many
/// seconds of the processor: it runs alone, since all others take its steps.
double mesh_clock_seconds(double seconds, int finest, int threads);

/// How many levels are run, and why the next one is not, with the numbers; "" if all are.
struct Affordable {
  int levels;
  std::string refusal;
};

/// The levels that ran, and those to come that fit the limits with all before them. costs: of all
/// levels. clock: seconds of the clock for the whole ladder if its last level is the given one.
Affordable affordable_levels(const std::vector<LevelCost>& costs, size_t measured,
                             const std::function<double(size_t)>& clock,
                             const LadderLimits& limits);

/// "40 s", "12 min", "5.2 h".
std::string duration_text(double seconds);

}  // namespace foldproof
