#include "convergence/any_case/motion_statistics.h"

#include <array>
#include <cmath>

#include "verification/cases/folds.h"

namespace foldproof {

namespace {

/// The means of `values` over the frames after `from` [s].
double mean_after(const std::vector<double>& times, const std::vector<double>& values,
                  double from) {
  double sum = 0;
  int count = 0;
  for (size_t k = 0; k < std::min(times.size(), values.size()); ++k)
    if (times[k] > from) sum += values[k], ++count;
  return count > 0 ? sum / count : nan;
}

std::vector<double> heights(const Scene& scene, const LevelRun& run) {
  const PerParticle mass = lumped_masses(scene.mesh, scene.density);
  const Vector3 up = -scene.gravity->normalized();
  std::vector<double> all;
  for (const PerParticle3& x : run.x) all.push_back(up.dot(x * mass) / mass.sum());
  return all;
}

/// Means of the bands' shares over the frames after `from` [s].
FoldSpectrum mean_spectrum(const TriangleMesh& mesh, const LevelRun& run, double from) {
  FoldSpectrum mean = {};
  int count = 0;
  for (size_t k = 0; k < run.x.size(); ++k) {
    if (!(run.times[k] > from)) continue;
    const FoldSpectrum one = fold_spectrum(mesh, run.x[k]);
    for (size_t b = 0; b < mean.size(); ++b) mean[b] += one[b];
    ++count;
  }
  for (double& share : mean) share = count > 0 ? share / count : nan;
  return mean;
}

/// The 97.5 % point of Student's distribution: a table, then the expansion of Cornish and Fisher
/// (Abramowitz and Stegun 26.7.5), which is off by less than 0.004 from eleven degrees of freedom.
double student_t(int freedom) {
  constexpr std::array<double, 10> table = {12.706, 4.303, 3.182, 2.776, 2.571,
                                            2.447,  2.365, 2.306, 2.262, 2.228};
  if (freedom <= int(table.size())) return table[size_t(freedom - 1)];
  const double z = 1.959964, n = freedom;
  return z + (std::pow(z, 3) + z) / (4 * n) +
         (5 * std::pow(z, 5) + 16 * std::pow(z, 3) + 3 * z) / (96 * n * n);
}

void take_ensemble(const std::vector<double>& values, StatisticOverRuns& over) {
  over.mean = over.spread = over.reach = nan;
  if (values.size() < 2) return;
  const double n = double(values.size());
  double sum = 0, squares = 0;
  for (const double value : values) sum += value;
  over.mean = sum / n;
  for (const double value : values) squares += (value - over.mean) * (value - over.mean);
  over.spread = std::sqrt(squares / (n - 1));
  over.reach = reach_factor(int(n)) * over.spread;
}

}  // namespace

std::vector<MotionStatistic> motion_statistics(const Scene& scene, const LevelRun& run,
                                               double from) {
  std::vector<MotionStatistic> all;
  if (scene.gravity && scene.gravity->norm() > 0)
    all.push_back({"height", "m", mean_after(run.times, heights(scene, run), from)});
  all.push_back({"kinetic energy", "J", mean_after(run.times, run.kinetic, from)});
  all.push_back({"elastic energy", "J", mean_after(run.times, run.elastic, from)});
  all.push_back({"contact points", "1", mean_after(run.times, run.contacts, from)});
  const FoldSpectrum shares = mean_spectrum(scene.mesh, run, from);
  for (size_t b = 0; b < shares.size(); ++b)
    all.push_back({"folds of " + name_of_fold_band(b), "1", shares[b]});
  return all;
}

double reach_factor(int n) { return student_t(n - 1) * std::sqrt(1 + 1.0 / n); }

std::vector<StatisticOverRuns> statistics_over_runs(const Scene& scene,
                                                    const std::vector<LevelRun>& ensemble,
                                                    const std::vector<LevelRun>& levels,
                                                    double from) {
  std::vector<std::vector<MotionStatistic>> of_ensemble, of_levels;
  for (const LevelRun& run : ensemble)
    if (run.stopped.empty()) of_ensemble.push_back(motion_statistics(scene, run, from));
  for (const LevelRun& run : levels) of_levels.push_back(motion_statistics(scene, run, from));
  std::vector<StatisticOverRuns> all;
  for (size_t m = 0; m < of_levels.front().size(); ++m) {
    StatisticOverRuns over;
    over.name = of_levels.front()[m].name;
    over.unit = of_levels.front()[m].unit;
    std::vector<double> values;
    for (const auto& one : of_ensemble) values.push_back(one[m].value);
    take_ensemble(values, over);
    for (size_t k = 0; k < levels.size(); ++k) {
      over.levels.push_back(levels[k].stopped.empty() ? of_levels[k][m].value : nan);
      over.agrees.push_back(std::abs(over.levels.back() - over.mean) <= over.reach);
    }
    all.push_back(over);
  }
  return all;
}

}  // namespace foldproof
