// What can be compared of runs whose positions are not predictable: means over time, with the
// spread of an ensemble as their uncertainty.
#pragma once

#include <string>
#include <vector>

#include "convergence/any_case/level_run.h"

namespace foldproof {

/// One number of a run: its mean over the frames after a time.
struct MotionStatistic {
  std::string name, unit;
  double value;
};

/// Of the frames after `from` [s]: mean height by mass (against gravity; where there is gravity),
/// kinetic and elastic energy, contact points, and the shares of the bands of fold angles
/// (verification/cases/folds.h). NaN without a frame.
std::vector<MotionStatistic> motion_statistics(const Scene& scene, const LevelRun& run,
                                               double from);

/// One statistic over an ensemble, and how other runs compare.
struct StatisticOverRuns {
  std::string name, unit;
  double mean = 0, spread = 0;  // of the ensemble, spread its standard deviation
  double reach = 0;             // half the range in which 95 of 100 further runs lie
  std::vector<double> levels;   // of each level of the ladder
  std::vector<bool> agrees;     // whether it lies within `reach` of the mean
};

/// The factor of reach over spread for an ensemble of n >= 2 runs: Student's t for 95 % and n - 1
/// degrees of freedom, times sqrt(1 + 1/n), for one further run of normal distribution.
double reach_factor(int n);

/// The ensemble's statistics against those of the levels. Runs that came to no end are left out of
/// the ensemble; with fewer than two left, mean, spread and reach are NaN and nothing agrees.
std::vector<StatisticOverRuns> statistics_over_runs(const Scene& scene,
                                                    const std::vector<LevelRun>& ensemble,
                                                    const std::vector<LevelRun>& levels,
                                                    double from);

}  // namespace foldproof
