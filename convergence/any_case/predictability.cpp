#include "convergence/any_case/predictability.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <tuple>

#include "verification/cases/folds.h"
#include "verification/seeds.h"

namespace foldproof {

namespace {

constexpr int waves = 6;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Numbers in [-1, 1), the same on every machine.
class Numbers {
 public:
  explicit Numbers(unsigned seed) : bits_(shifted_seed(seed)) {}
  double next() { return double(bits_()) / 2147483648.0 - 1; }
  Vector3 next_vector() {
    const double a = next(), b = next(), c = next();
    return {a, b, c};
  }

 private:
  std::mt19937 bits_;
};

/// 0 at prescribed particles, 1 from a quarter of the cloth's extent on, linear between.
PerParticle freedom_of(const Scene& scene) {
  const double ramp = longest_side(scene.x) / 4;
  PerParticle freedom = PerParticle::Ones(scene.x.cols());
  for (const PrescribedParticle& p : scene.prescribed) {
    const PerParticle away =
        (scene.x.colwise() - Vector3(scene.x.col(p.particle))).colwise().norm() / ramp;
    freedom = freedom.cwiseMin(away);
  }
  return freedom;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// Slope of ln d over t by least squares, over the frames [first, last).
double slope(const std::vector<double>& t, const std::vector<double>& d, size_t first,
             size_t last) {
  double mean_t = 0, mean_y = 0, tt = 0, ty = 0;
  const double count = double(last - first);
  for (size_t k = first; k < last; ++k) mean_t += t[k] / count, mean_y += std::log(d[k]) / count;
  for (size_t k = first; k < last; ++k) {
    tt += (t[k] - mean_t) * (t[k] - mean_t);
    ty += (t[k] - mean_t) * (std::log(d[k]) - mean_y);
  }
  return ty / tt;
}

Twin twin_of(const LevelRun& first, const LevelRun& run, double disturbance,
             const PerParticle& mass, double ceiling) {
  Twin twin{disturbance, distances(first, run, mass), nan, run.stopped};
  if (run.stopped.empty()) twin.horizon = crossing_time(first.times, twin.distances, ceiling);
  return twin;
}

/// Why the twins tell nothing; "" if they do.
std::string why_unknown(const Predictability& p, const Scene& scene) {
  if (!(p.motion > 1e3 * p.rounding.disturbance)) return "the cloth hardly moves";
  if (!(p.rounding.disturbance > 0)) return "the cloth has no extent";
  if (freedom_of(scene).maxCoeff() == 0) return "no particle is free";
  for (const Twin* twin : {&p.rounding, &p.error})
    if (!twin->stopped.empty()) return "a disturbed run came to no end: " + twin->stopped;
  return "";
}

/// The first time at which two levels have contacts that differ by more than a tenth, and by more
/// than one [s]; NaN if none.
double contacts_part(const std::vector<LevelRun>& runs) {
  double first = nan;
  for (size_t j = 0; j + 1 < runs.size(); ++j) {
    const std::vector<double>&a = runs[j].contacts, &b = runs[j + 1].contacts;
    for (size_t k = 0; k < std::min(a.size(), b.size()); ++k) {
      if (!(std::abs(a[k] - b[k]) > std::max(1.0, 0.1 * std::max(a[k], b[k])))) continue;
      first = std::isnan(first) ? runs[j].times[k] : std::min(first, runs[j].times[k]);
      break;
    }
  }
  return first;
}

void make_inconclusive(ErrorBar& bar, const std::string& reason) {
  bar.reading = Reading::inconclusive;
  bar.reason = reason;
  bar.order = bar.limit = nan;
}

std::string growth_in_words(const Growth& growth) {
  if (std::isnan(growth.rate)) return "no growth rate: too few frames";
  return fmt::format("growth rate {:.3g} +- {:.2g} 1/s (fit from {:.3g} to {:.3g} s)", growth.rate,
                     growth.uncertainty, growth.from, growth.to);
}

/// The mean of value(k) over the `frames` whose time is after `from` [s].
double mean_after(double from, const std::vector<double>& times, size_t frames,
                  const std::function<double(size_t)>& value) {
  double sum = 0;
  int count = 0;
  for (size_t k = 0; k < std::min(times.size(), frames); ++k)
    if (times[k] > from) sum += value(k), ++count;
  return count > 0 ? sum / count : nan;
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

PerParticle3 displacement_of(const Disturbance& disturbance, const Scene& scene) {
  const double extent = longest_side(scene.x);
  PerParticle3 u = PerParticle3::Zero(3, scene.x.cols());
  if (!(extent > 0)) return u;
  Numbers numbers(20031 + disturbance.number);
  for (int j = 0; j < waves; ++j) {
    const Vector3 amplitude = numbers.next_vector();
    const Vector3 wave = numbers.next_vector() * (2 * pi / (std::sqrt(3) * extent));  // rad/m
    const double phase = pi * numbers.next();
    for (Eigen::Index i = 0; i < u.cols(); ++i)
      u.col(i) += amplitude * std::cos(wave.dot(scene.x.col(i) - scene.x.col(0)) + phase);
  }
  u = u * freedom_of(scene).asDiagonal();
  const double size = mean_square_root(u, masses_of(scene));
  return size > 0 ? PerParticle3(u * (disturbance.size / size)) : PerParticle3(0 * u);
}

double largest_disturbance(const Scene& scene) { return longest_side(scene.x) / 50; }

double rounding_disturbance(const Scene& scene) { return 1e-12 * longest_side(scene.x); }

Level disturbed_level(Level level, const std::vector<double>& step_ends,
                      const Disturbance& disturbance) {
  Scene& scene = level.input_case.scene;
  scene.x += displacement_of(disturbance, scene);
  scene.schedule.step.ends = step_ends;
  level.label = fmt::format("{}, disturbed by {:.2g} m ({})", scene.name, disturbance.size,
                            disturbance.number);
  return level;
}

std::vector<double> distances(const LevelRun& a, const LevelRun& b, const PerParticle& mass) {
  std::vector<double> all;
  for (size_t k = 0; k < std::min(a.x.size(), b.x.size()); ++k)
    all.push_back(mean_square_root(a.x[k] - b.x[k], mass));
  return all;
}

double error_of_first_level(const std::vector<LevelRun>& runs, const PerParticle& mass,
                            double ceiling) {
  const auto finest = std::ranges::find_if(runs.rbegin(), runs.rend(),
                                           [](const LevelRun& run) { return run.stopped.empty(); });
  if (finest == runs.rend()) return 0;
  std::vector<double> before;
  const std::vector<double> apart = distances(runs.front(), *finest, mass);
  for (size_t k = 1; k < apart.size() && apart[k] < ceiling; ++k) before.push_back(apart[k]);
  if (before.empty()) return apart.size() > 1 ? apart[1] : 0;
  return median(before);
}

Growth growth_of(const std::vector<double>& times, const std::vector<double>& distances,
                 double ceiling) {
  size_t last = 0;
  while (last < distances.size() && distances[last] > 0 && distances[last] < ceiling) ++last;
  if (last == 0) return {};
  const double quarter = times.front() + (times[last - 1] - times.front()) / 4;
  size_t first = 0;
  while (first < last && times[first] < quarter) ++first;
  if (last - first < 6) return {};
  const size_t middle = (first + last) / 2;
  const double early = slope(times, distances, first, middle);
  const double late = slope(times, distances, middle, last);
  return {slope(times, distances, first, last), std::abs(late - early) / 2, times[first],
          times[last - 1]};
}

double crossing_time(const std::vector<double>& times, const std::vector<double>& distances,
                     double ceiling) {
  for (size_t k = 0; k < distances.size(); ++k) {
    if (distances[k] < ceiling) continue;
    if (k == 0 || !std::isfinite(distances[k])) return times[k];
    const double part = (ceiling - distances[k - 1]) / (distances[k] - distances[k - 1]);
    return times[k - 1] + part * (times[k] - times[k - 1]);
  }
  return infinity;
}

std::vector<Disturbance> twin_disturbances(const Scene& scene, const std::vector<LevelRun>& runs,
                                           double fraction) {
  const PerParticle mass = masses_of(scene);
  const double ceiling = fraction * largest_motion(runs.front().x, mass);
  const double rounding = rounding_disturbance(scene);
  const double error = error_of_first_level(runs, mass, ceiling);
  return {{rounding, 1}, {std::clamp(error, rounding, largest_disturbance(scene)), 1}};
}

Predictability predictability(const Scene& scene, const LevelRun& first,
                              const std::vector<Disturbance>& disturbances,
                              const std::vector<LevelRun>& twins, double fraction) {
  const PerParticle mass = masses_of(scene);
  Predictability p;
  p.fraction = fraction;
  p.motion = largest_motion(first.x, mass);
  p.times = first.times;
  p.end = first.times.back();
  const double ceiling = fraction * p.motion;
  p.rounding = twin_of(first, twins[0], disturbances[0].size, mass, ceiling);
  p.error = twin_of(first, twins[1], disturbances[1].size, mass, ceiling);
  p.growth = growth_of(p.times, p.rounding.distances, ceiling);
  if (std::isnan(p.growth.rate)) p.growth = growth_of(p.times, p.error.distances, ceiling);
  p.reason = why_unknown(p, scene);
  if (p.reason.empty()) p.horizon = std::min(p.rounding.horizon, p.error.horizon);
  return p;
}

std::string in_words(const Predictability& p) {
  if (!p.reason.empty()) return "predictability not known: " + p.reason;
  const std::string growth = growth_in_words(p.growth);
  if (p.horizon < p.end)
    return fmt::format(
        "beyond t = {:.3g} s only statistics: runs that start {:.2g} m apart are then {:.2g} m "
        "apart, {:.2g} of the motion ({:.2g} m); {}",
        p.horizon,
        p.rounding.horizon < p.error.horizon ? p.rounding.disturbance : p.error.disturbance,
        p.fraction * p.motion, p.fraction, p.motion, growth);
  return fmt::format(
      "predictable to its end (t = {:.3g} s): runs that start {:.2g} and {:.2g} m apart never "
      "differ by more than {:.2g} and {:.2g} m, while the motion is {:.2g} m; {}",
      p.end, p.rounding.disturbance, p.error.disturbance, std::ranges::max(p.rounding.distances),
      std::ranges::max(p.error.distances), p.motion, growth);
}

std::vector<LevelRun> frames_until(std::vector<LevelRun> runs, double time) {
  for (LevelRun& run : runs) {
    const auto after = std::ranges::upper_bound(run.times, time);
    const size_t kept = size_t(after - run.times.begin());
    run.times.resize(kept);
    run.x.resize(std::min(run.x.size(), kept));
  }
  return runs;
}

void limit_to_horizon(const std::vector<Measurement>& measurements,
                      const std::vector<LevelRun>& runs, const Predictability& p,
                      LadderAnswer& answer) {
  const double contacts = contacts_part(runs);
  for (size_t k = 0; k < answer.quantities.size(); ++k) {
    ErrorBar& bar = answer.quantities[k].bar;
    const bool is_before = k == 0 ? p.times.size() > 1 && p.horizon > p.times[1]
                                  : measurements[k - 1].when == Instant::at_time &&
                                        measurements[k - 1].time <= p.horizon;
    if (p.horizon < p.end && !is_before)
      make_inconclusive(
          bar, fmt::format("asked beyond t = {:.3g} s, where only statistics are predictable",
                           p.horizon));
    if (bar.reading != Reading::asymptotic && !std::isnan(contacts))
      bar.reason += fmt::format("; contacts differ between levels from t = {:.3g} s on", contacts);
  }
}

std::vector<MotionStatistic> motion_statistics(const Scene& scene, const LevelRun& run,
                                               double from) {
  std::vector<MotionStatistic> all;
  const auto add = [&](const std::string& name, const std::string& unit, size_t frames,
                       const std::function<double(size_t)>& value) {
    all.push_back({name, unit, mean_after(from, run.times, frames, value)});
  };
  const PerParticle mass = masses_of(scene);
  if (scene.gravity && scene.gravity->norm() > 0) {
    const Vector3 up = -scene.gravity->normalized();
    add("height", "m", run.x.size(),
        [&](size_t k) { return up.dot(run.x[k] * mass) / mass.sum(); });
  }
  for (const auto& [name, unit, values] : {std::tuple{"kinetic energy", "J", &run.kinetic},
                                           {"elastic energy", "J", &run.elastic},
                                           {"contact points", "1", &run.contacts}})
    add(name, unit, values->size(), [&](size_t k) { return (*values)[k]; });
  std::vector<FoldSpectrum> folds(run.x.size());
  for (size_t k = 0; k < folds.size(); ++k)
    if (run.times[k] > from) folds[k] = fold_spectrum(scene.mesh, run.x[k]);
  for (size_t b = 0; b < FoldSpectrum{}.size(); ++b)
    add("folds of " + name_of_fold_band(b), "1", folds.size(),
        [&](size_t k) { return folds[k][b]; });
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
