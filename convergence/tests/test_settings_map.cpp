// The map of errors over settings, on made-up solvers whose limits are known.
#include <Eigen/Cholesky>
#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "convergence/any_case/settings_map.h"

namespace foldproof {
namespace {

using Random = std::mt19937;
double between(Random& random, double low, double high) {
  return std::uniform_real_distribution(low, high)(random);
}

/// A made-up solver: what it answers at a pair, and its limit.
struct MadeUp {
  std::function<Seen(const SettingsPair&)> answer;
  Seen limit;
  double motion;
};

/// Powers of both settings, in directions of their own, with a next term each.
MadeUp surface(Random& random) {
  const auto vector = [&](double size) {
    Seen v(4, 1);
    for (double& entry : v.reshaped()) entry = between(random, -1, 1);
    return Seen(v * (size / v.norm()));
  };
  const double p = between(random, 0.9, 2), q = between(random, 1, 2.5),
               r = between(random, 0.5, 1.5);
  const Seen limit = vector(1), first = vector(between(random, 0.1, 0.6)), second = vector(0.1),
             solve = vector(between(random, 0.3, 2));
  return {[=](const SettingsPair& at) {
            return Seen(limit + first * std::pow(at[0], -p) + second * std::pow(at[0], -p - 1) +
                        solve * std::pow(at[1], -q) * std::pow(at[0], -r));
          },
          limit, 1};
}

/// A chain of masses that hangs from its first one and swings from the horizontal.
struct ChainOfMasses {
  int n;              // masses that move
  double k, h_frame;  // N/m of each spring; s
  int frames;
  double length() const { return 1.0 / n; }
  double mass() const { return 0.2 / n; }
};

using Masses = Eigen::Matrix<double, 2, Eigen::Dynamic>;

Seen seen_of(const Masses& x) { return x.reshaped() / std::sqrt(double(x.cols())); }

/// Position based, with compliance: `iterations` sweeps a substep. Multipliers are kept over the
/// sweeps, or reset in each: then the springs are as many times as stiff as there are sweeps.
Seen swing_position_based(const ChainOfMasses& chain, const SettingsPair& at, bool resets) {
  const double h = chain.h_frame / at[0], compliance = 1 / (chain.k * h * h), w = 1 / chain.mass();
  Masses x(2, chain.n), v = Masses::Zero(2, chain.n);
  for (int i = 0; i < chain.n; ++i) x.col(i) << (i + 1) * chain.length(), 0;
  for (int step = 0; step < chain.frames * int(at[0]); ++step) {
    const Masses before = x;
    v.row(1).array() -= 9.81 * h;
    x += h * v;
    Eigen::VectorXd multipliers = Eigen::VectorXd::Zero(chain.n);
    for (int sweep = 0; sweep < int(at[1]); ++sweep) {
      if (resets) multipliers.setZero();
      for (int i = 0; i < chain.n; ++i) {
        const Eigen::Vector2d d = i > 0 ? x.col(i) - x.col(i - 1) : Eigen::Vector2d(x.col(0));
        const double weight = i > 0 ? 2 * w : w;
        const double change =
            -(d.norm() - chain.length() + compliance * multipliers[i]) / (weight + compliance);
        multipliers[i] += change;
        x.col(i) += w * change * d.normalized();
        if (i > 0) x.col(i - 1) -= w * change * d.normalized();
      }
    }
    v = (x - before) / h;
  }
  return seen_of(x);
}

/// Backward Euler of linear springs (rest length 0 about the start), with sweeps of Gauss and
/// Seidel from the old velocity; sweeps = 0: solved.
Seen swing_implicit(const ChainOfMasses& chain, double substeps, int sweeps) {
  const double h = chain.h_frame / substeps;
  const int n = chain.n;
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i < n; ++i) {
    stiffness(i, i) += chain.k * (i + 1 < n ? 2 : 1);
    if (i > 0) stiffness(i, i - 1) = stiffness(i - 1, i) = -chain.k;
  }
  const Eigen::MatrixXd matrix = chain.mass() * Eigen::MatrixXd::Identity(n, n) + h * h * stiffness;
  const Eigen::LLT<Eigen::MatrixXd> factored(matrix);
  Eigen::VectorXd u = Eigen::VectorXd::Zero(n), v = u;
  for (int step = 0; step < int(std::lround(chain.frames * substeps)); ++step) {
    const Eigen::VectorXd b = (chain.mass() * (v.array() - 9.81 * h)).matrix() - h * stiffness * u;
    if (sweeps == 0) v = factored.solve(b);
    for (int sweep = 0; sweep < sweeps; ++sweep)
      for (int i = 0; i < n; ++i) v[i] += (b[i] - matrix.row(i).dot(v)) / matrix(i, i);
    u += h * v;
  }
  return u / std::sqrt(double(n));
}

/// By Richardson's extrapolation from very short steps.
template <class Swing>
Seen limit_of_swing(const Swing& swing) {
  const Seen coarse = swing(2048), fine = swing(4096);
  return 2 * fine - coarse;
}

MadeUp implicit_chain(Random& random) {
  const ChainOfMasses chain{int(between(random, 6, 14)), between(random, 20, 200),
                            between(random, 0.02, 0.05), int(between(random, 4, 9))};
  const Seen limit = limit_of_swing([&](double s) { return swing_implicit(chain, s, 0); });
  return {[=](const SettingsPair& at) { return swing_implicit(chain, at[0], int(at[1])); }, limit,
          size_of(limit)};
}

MadeUp position_based_chain(Random& random, bool resets = false) {
  const double softest = resets ? 20 : 100;
  const ChainOfMasses chain{int(between(random, 5, 10)), between(random, softest, 10 * softest),
                            between(random, 0.02, 0.05), int(between(random, 4, 9))};
  const Seen limit = limit_of_swing([&](double s) {
    return swing_position_based(chain, {s, 2}, resets);
  });
  Masses start(2, chain.n);
  for (int i = 0; i < chain.n; ++i) start.col(i) << (i + 1) * chain.length(), 0;
  return {[=](const SettingsPair& at) { return swing_position_based(chain, at, resets); }, limit,
          size_of(limit - seen_of(start))};
}

constexpr double finest = 64;

SettingsMap map_from(double substeps, double iterations) {
  return {{{"substeps", TunableKind::substeps, substeps, 1, finest},
           {"iterations", TunableKind::iterations, iterations, 1, finest}},
          {{"positions", "m", 1e-12}}};
}

RunSettings runs_of(const MadeUp& solver) {
  return [&](const SettingsPair& at) {
    return SettingsRun{at, at[0] * at[1], 0, solver.motion, {solver.answer(at)}};
  };
}

/// The least cost of the grid of doubled values with the true error, which pairs of more substeps
/// have, too; infinite: none has it.
double best_of_grid(const MadeUp& solver, double wanted) {
  double best = INFINITY;
  for (double n = 1; n <= finest; n *= 2)
    for (double s = finest; s >= 1; s /= 2) {
      if (!(size_of(solver.answer({s, n}) - solver.limit) <= wanted * solver.motion)) break;
      best = std::min(best, s * n);
    }
  return best;
}

struct Score {
  int problems = 0, known = 0, held = 0, asked = 0, named = 0, near = 0, within_error = 0;
  std::vector<double> widths, ratios, costs;
};

void try_one(const MadeUp& solver, Random& random, Score& score) {
  SettingsMap map =
      map_from(std::exp2(int(between(random, 0, 3))), std::exp2(int(between(random, 1, 4))));
  const double grid = std::pow(2 * finest - 1, 2);
  const std::vector<PricedPair> pairs = find_pairs(map, 0, {1e-2, 1e-3}, grid / 3, runs_of(solver));
  const OwnLimit limit = own_limit(map, 0);
  ++score.problems;
  score.costs.push_back(map.cost() / grid);
  UNSCOPED_INFO(limit.none << limit.unknown);
  if (limit.value.size() > 0 && limit.none.empty()) {
    ++score.known;
    const double miss = size_of(limit.value - solver.limit);
    score.held += miss <= limit.bar;
    score.widths.push_back(limit.bar / solver.motion);
    if (miss > limit.bar) fmt::print("missed: {:.3g} of a bar {:.3g}\n", miss, limit.bar);
  }
  for (const PricedPair& pair : pairs) {
    const double best = best_of_grid(solver, pair.wanted);
    if (!std::isfinite(best)) continue;
    ++score.asked;
    if (!pair.because.empty()) {
      fmt::print("{}: {} ({}, best {}), cost {:.2f}\n", pair.wanted, pair.because, limit.none, best,
                 map.cost() / grid);
      continue;
    }
    ++score.named;
    score.ratios.push_back(pair.cost / best);
    score.near += pair.cost <= 1.5 * best;
    const double error = size_of(solver.answer(pair.at) - solver.limit) / solver.motion;
    score.within_error += error <= 1.1 * pair.wanted;
    if (pair.cost > 1.5 * best || error > 1.1 * pair.wanted)
      fmt::print("{}: {} x {} costs {} of {}, error {:.3g}\n", pair.wanted, pair.at[0], pair.at[1],
                 pair.cost, best, error);
  }
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values.empty() ? nan : values[values.size() / 2];
}

TEST_CASE("the map finds limits and cheapest pairs of made-up solvers") {
  Random random(20260101);
  Score score;
  for (int k = 0; k < 40; ++k) {
    const MadeUp solver = k % 3 == 0   ? surface(random)
                          : k % 3 == 1 ? implicit_chain(random)
                                       : position_based_chain(random);
    fmt::print("-- {} kind {}\n", k, k % 3);
    try_one(solver, random, score);
  }
  const std::string told = fmt::format(
      "limits: {} of {} known, {} in their bars, median width {:.2g} %; pairs: {} of {} named, {} "
      "within 1.5 of the grid's best, median ratio {:.2f}, {} have the error; cost: at most {:.2f} "
      "of the grid, median {:.2f}",
      score.known, score.problems, score.held, 100 * median(score.widths), score.named, score.asked,
      score.near, median(score.ratios), score.within_error, *std::ranges::max_element(score.costs),
      median(score.costs));
  WARN(told);
  CHECK(score.held >= 36);
  CHECK(median(score.widths) <= 0.02);
}

TEST_CASE("a solver whose limit depends on iterations has none") {
  Random random(77);
  for (int k = 0; k < 12; ++k) {
    const MadeUp solver = position_based_chain(random, true);
    SettingsMap map = map_from(1, 4);
    find_pairs(map, 0, {1e-2, 1e-3}, std::pow(2 * finest - 1, 2) / 3, runs_of(solver));
    const OwnLimit limit = own_limit(map, 0);
    INFO(limit.none << limit.unknown << limit.bar);
    CHECK(limit.none.starts_with("its limit depends on iterations"));
  }
}

/// Backward Euler of a fall in air, solved; its state is rounded to single precision.
Seen single_fall(double substeps) {
  float x = 0, v = 0;
  const float h = float(0.5 / substeps);
  for (int step = 0; step < int(substeps); ++step) {
    v = (v - 9.81F * h) / (1 + 2 * h);
    x += h * v;
  }
  return Seen::Constant(1, 1, x);
}

TEST_CASE("a solver in single precision has a floor that more substeps do not pass") {
  SettingsMap map{{{"substeps", TunableKind::substeps, 64}}, {{"height", "m"}}};
  for (double s = 64; s <= 32768; s *= 2) map.runs.push_back({{s, 1}, s, 0, 1, {single_fall(s)}});
  const std::string said = end_of_refinement(map, 0, own_limit(map, 0));
  INFO(said);
  CHECK(said.find("a floor of rounding") != std::string::npos);
}

TEST_CASE("substeps beyond the onset of rounding do not spoil the limit") {
  Random random(5);
  for (int k = 0; k < 20; ++k) {
    const double p = between(random, 0.9, 2), q = between(random, 1, 2), first = 0.3,
                 rounding = std::exp2(between(random, -24, -18));
    const RunSettings run = [&](const SettingsPair& at) {
      const double s = at[0], value = 1 + first * std::pow(s, -p) + rounding * std::pow(s, q);
      return SettingsRun{at, s, 0, 1, {Seen::Constant(1, 1, value)}};
    };
    SettingsMap map{{{"substeps", TunableKind::substeps, 1, 1, 1e6}}, {{"sag", "m", 1e-12}}};
    find_pairs(map, 0, {0.05, 1e-5}, 1e6, run);
    INFO(p << " " << q << " " << rounding << ", runs to " << map.runs.back().at[0]);
    const OwnLimit limit = own_limit(map, 0);
    CHECK(std::abs(limit.value(0, 0) - 1) <= limit.bar);
    CHECK(cheapest_pair(map, 0, 0.05).because.empty());
    CHECK(end_of_refinement(map, 0, limit).find("rounding") != std::string::npos);
    CHECK(map.cost() < 2e5);
    map.runs.push_back({{1.5, 1}, 1.5, 0, 1e3, {Seen::Constant(1, 1, 1e3)}});  // blows up
    CHECK(own_limit(map, 0).scale == limit.scale);
  }
}

}  // namespace
}  // namespace foldproof
