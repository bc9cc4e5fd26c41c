// How long are positions predictable? Twin runs, disturbed at the start, tell when they no longer
// are: beyond that time orders and error bars of positions mean nothing, and runs are compared by
// their means over time, with the spread of an ensemble as uncertainty.
#pragma once

#include <string>
#include <vector>

#include "convergence/any_case/converge.h"
#include "convergence/any_case/level_run.h"

namespace foldproof {

/// How a twin's start differs.
struct Disturbance {
  double size;      // root mean square over the particles, by mass [m]
  unsigned number;  // another one gives another disturbance
};

/// The twin's displacement at the start, 3 x N [m]: six waves over space, none shorter than the
/// cloth's extent, which fade out towards prescribed particles and leave those alone. Particles
/// that start in one place stay together. A smooth map of space keeps layers apart, and strains
/// cloth little; noise particle by particle would do neither. The same on every machine for the
/// same number and `--seed` (verification/seeds.h). All 0 if no particle is free.
PerParticle3 displacement_of(const Disturbance& disturbance, const Scene& scene);

/// The largest size for which no two waves' crests meet: a fiftieth of the cloth's extent [m].
double largest_disturbance(const Scene& scene);

/// A tiny one, that arithmetic could make: 1e-12 of the cloth's extent [m].
double rounding_disturbance(const Scene& scene);

/// The level with its start disturbed and with the very steps of its run, so that the twins differ
/// in nothing else.
Level disturbed_level(Level level, const std::vector<double>& step_ends,
                      const Disturbance& disturbance);

/// For each frame, the root mean square over the particles, by mass (N [kg]), of how far two runs
/// are apart [m]. As many as the shorter run has frames.
std::vector<double> distances(const LevelRun& a, const LevelRun& b, const PerParticle& mass);

/// The error of the ladder's first level [m]: its distance to the finest level that came to its
/// end, the median over frames after the start, up to the first that exceeds the ceiling [m]. That
/// of the first frame after the start if it exceeds the ceiling itself; 0 without such a level.
double error_of_first_level(const std::vector<LevelRun>& runs, const PerParticle& mass,
                            double ceiling);

/// d(t) = d0 exp(rate t), fitted to ln d by least squares.
struct Growth {
  double rate = nan;  // 1/s; NaN with fewer than six frames to fit, or twins that coincide
  // half the difference of the rates of the two halves of the range [1/s]
  double uncertainty = nan;
  double from = nan, to = nan;  // the fit's range [s]
};

/// Fits frames from a quarter of the time, when the disturbance has turned to where it grows, until
/// the distance exceeds the ceiling [m], where growth is no longer linear.
Growth growth_of(const std::vector<double>& times, const std::vector<double>& distances,
                 double ceiling);

/// When the distance first reaches the ceiling, linear between frames [s]; infinite if never.
double crossing_time(const std::vector<double>& times, const std::vector<double>& distances,
                     double ceiling);

struct Twin {
  double disturbance = 0;         // m
  std::vector<double> distances;  // to the run that was not disturbed, one a frame [m]
  double horizon = nan;           // s; infinite: not reached
  std::string stopped;            // why it came to no end, or ""
};

struct Predictability {
  double fraction = 0.1;      // of the motion, at which twins are said to have parted [1]
  double motion = nan;        // m
  double end = nan;           // of the run [s]
  std::vector<double> times;  // of the frames [s]
  Twin rounding, error;       // disturbed by rounding_disturbance, and by the first level's error
  Growth growth;              // of the rounding twin's distance, else of the error twin's
  double horizon = nan;       // the earlier of the twins' [s]; infinite: none; NaN: not known
  std::string reason;         // why it is not known, or ""
};

/// The twins' disturbances, rounding first. fraction: in (0, 1).
std::vector<Disturbance> twin_disturbances(const Scene& scene, const std::vector<LevelRun>& runs,
                                           double fraction);

/// Reads the twins against the ladder's first level; both in the order of twin_disturbances.
Predictability predictability(const Scene& scene, const LevelRun& first,
                              const std::vector<Disturbance>& disturbances,
                              const std::vector<LevelRun>& twins, double fraction);

/// "predictable to its end (1.5 s): ...", "beyond t = 1.3 s only statistics: ...", or why neither.
std::string in_words(const Predictability& p);

/// Each run with the frames up to this time only [s]: what orders and bars of
/// positions are asked of.
std::vector<LevelRun> frames_until(std::vector<LevelRun> runs, double time);

/// Calls inconclusive what a horizon makes so: quantities taken after it, and positions that have
/// no two frames before it. Adds to what is not asymptotic that contacts differ between levels,
/// and from when on.
void limit_to_horizon(const std::vector<Measurement>& measurements,
                      const std::vector<LevelRun>& runs, const Predictability& p,
                      LadderAnswer& answer);

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
