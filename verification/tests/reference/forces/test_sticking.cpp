// Targets, forces and bounds of sticking against the formulas at the head of its page.
#include <catch2/catch.hpp>
#include <cmath>

#include "reference/forces/degenerate.h"
#include "verification/tests/reference/forces/sticking_specimen.h"

using namespace foldproof;
using namespace foldproof::stuck;

TEST_CASE("a sticky patch by default has no stiffness, no reach, and no end") {
  const StickyPatch plain;
  CHECK(plain.stiffness == 0);
  CHECK(plain.forecast_time == 0);
  CHECK(plain.near == 0);
  CHECK(plain.far == 0);
  CHECK(plain.from == 0);
  CHECK(plain.until == std::numeric_limits<double>::infinity());
  CHECK(plain.release == 0);
}

TEST_CASE("targets are the means of their bonds' places, in order") {
  State s = state();
  for (const Sticking& all : {sticking(), out_of_reach()}) {
    const std::vector<StickyTarget> targets = all.targets_at(s);
    REQUIRE(targets.size() == groups.size());
    for (size_t k = 0; k < groups.size(); ++k) {
      const Group& group = groups[k];
      const StickyTarget& target = targets[k];
      const StickyPatch& patch = all.patches[size_t(group.patch)];
      CHECK(target.patch == group.patch);
      CHECK(target.particle == group.particle);
      CHECK(target.first == group.first);
      CHECK(target.count == group.count);
      const Vector3 place = target_at(all, group, s.time, s.x);
      const double d = (place - s.x.col(group.particle)).norm();
      CHECK((target.x - place).norm() < 1e-14);
      CHECK(target.distance == Approx(d).epsilon(1e-14));
      CHECK(target.stiffness == Approx(stiffness_of(patch, d)).epsilon(1e-12));
      CHECK(target.stiffness_slope == Approx(slope_of(patch, d)).epsilon(1e-12));
      const Vector3 v = patch.place ? target_velocity(all, group, s) : Vector3::Zero();
      CHECK((target.v - v).norm() < 1e-9);
      CHECK(target.frames.size() == (patch.place ? 0 : group.count));
    }
  }
  s.bonds.clear();
  CHECK(sticking().targets_at(s).empty());
}

TEST_CASE("a surface is asked once for its place and velocity, however many stick to it") {
  Sticking all = sticking();
  std::array<int, 2> places{}, velocities{};
  for (const size_t k : {0u, 1u}) {
    StickyPatch& patch = all.patches[2 * k + 1];
    patch.place = [&, k, ask = patch.place](double t) { return ++places[k], ask(t); };
    patch.velocity = [&, k, ask = patch.velocity](double t) { return ++velocities[k], ask(t); };
  }
  State s = state();
  s.bonds.erase(s.bonds.begin(), s.bonds.begin() + 3);  // the first is that of a surface
  s.bonds.push_back({3, 0, 2, Vector3(0.2, 0.3, 0.1)});
  CHECK(all.targets_at(s).size() == 6);
  CHECK(places == std::array<int, 2>{1, 1});
  CHECK(velocities == std::array<int, 2>{1, 1});
}

TEST_CASE("a bond to a triangle without area is refused with the patch and the particle") {
  State s = state();
  s.x.col(3) = s.x.col(1);
  CHECK_THROWS_WITH(sticking().targets_at(s),
                    "a triangle of sticky 'palm' has no area (particles 4)");
  CHECK_THROWS_AS(sticking().energy(s), DegenerateElement);
}

TEST_CASE("stiffness falls smoothly during the release before a patch's end") {
  State s = state();
  s.bonds = {{0, 0, 4, Vector3(0.21, 0.34, 0.13)}};
  Sticking all = sticking();
  const double full = all.targets_at(s)[0].stiffness;
  const auto share_at = [&](double t) {
    s.time = t;
    return all.targets_at(s)[0].stiffness / full;
  };
  StickyPatch& patch = all.patches[0];
  patch.until = 2.25;
  CHECK(share_at(2.2) == 1);
  CHECK(share_at(2.3) == 1);  // no release
  patch.release = 0.5;
  CHECK(share_at(0.3) == 1);
  CHECK(share_at(1.75) == 1);
  CHECK(share_at(2) == Approx(std::pow(1 - 0.25, 2)));
  CHECK(share_at(2.125) == Approx(std::pow(1 - 0.5625, 2)));
  CHECK(share_at(2.25) == 0);
  CHECK(share_at(2.5) == 0);
  s.time = 2;
  CHECK(all.targets_at(s)[0].stiffness_slope ==
        Approx(0.5625 * slope_of(sticking().patches[0], all.targets_at(s)[0].distance)));
  CHECK(all.energy(s) == Approx(0.5625 * sticking().energy(s)));
}

TEST_CASE("the springs of sticking have their energy, up to the most at which they break") {
  const State s = state();
  for (const Sticking& all : {sticking(), out_of_reach()}) {
    double energy = 0;
    for (const Group& group : groups) {
      const StickyPatch& patch = all.patches[size_t(group.patch)];
      const double d = (target_at(all, group, s.time, s.x) - s.x.col(group.particle)).norm();
      const double left = d < patch.far ? 1 - std::pow(d / patch.far, 2) : 0;
      energy += patch.stiffness * patch.far * patch.far / 6 * (1 - std::pow(left, 3));
    }
    CHECK(all.energy(s) == Approx(energy).epsilon(1e-13));
  }
}

TEST_CASE("the forces of sticking are its springs', handed on to cloth, and what surfaces drag") {
  const State s = state();
  const PerParticle3 start = scattered(n, 5.1);
  for (const Sticking& all : {sticking(), out_of_reach()}) {
    PerParticle3 elastic = start, expected = start;
    Eigen::MatrixXd D = Eigen::MatrixXd::Zero(3 * n, 3 * n);
    size_t dampers = 0;
    for (const Group& group : groups) {
      const StickyPatch& patch = all.patches[size_t(group.patch)];
      const Vector3 u = target_at(all, group, s.time, s.x) - s.x.col(group.particle);
      const double k = stiffness_of(patch, u.norm());
      const Eigen::MatrixXd G = arm_gradient(all, group, s);
      expected -= as_forces(k * G.transpose() * u);
      if (patch.place)
        expected.col(group.particle) += k * patch.forecast_time * target_velocity(all, group, s);
      D -= k * patch.forecast_time * G.transpose() * G;
      dampers += k * patch.forecast_time != 0;
    }
    all.add_elastic(s, elastic);
    CHECK(agree(elastic, expected, 1e-9));
    DampingOperator damping;
    all.prepare_damping(s, damping);
    CHECK(damping.targets.size() == dampers);
    const Eigen::MatrixXd matrix =
        foldproof::matrix_of(n, [&](const auto& v, auto& f) { damping.add_product(v, f); });
    CHECK(agree(matrix, D, 1e-9));
    PerParticle3 damped = start;
    damping.add_product(s.v, damped);
    CHECK(agree(damped, start + as_forces(D * s.v.reshaped()), 1e-9));
  }
}

TEST_CASE("a damper of sticking whose coefficient is 1 is kept, one of 0 is not") {
  State s = state();
  Sticking one{{patch({{0, 1, 2}}, 8, 0.125, 0.7)}};
  s.bonds = {{0, 0, 4, Vector3(0.25, 0.5, 0)}};
  s.x.col(4) = one.targets_at(s)[0].x;
  DampingOperator damping;
  one.prepare_damping(s, damping);
  REQUIRE(damping.targets.size() == 1);
  CHECK(damping.targets[0].coefficient == 1);
  CHECK(damping.targets[0].particle == 4);
  one.patches[0].forecast_time = 0;
  damping.targets.clear();
  one.prepare_damping(s, damping);
  CHECK(damping.targets.empty());
}

namespace {

/// Norm bounds of J at the corners of a target's frames: |w| + |height| |g|.
std::vector<std::pair<int, double>> corner_norms(const StickyTarget& target) {
  std::vector<std::pair<int, double>> list;
  for (const TriangleFrame& frame : target.frames)
    for (int i = 0; i < 3; ++i)
      list.emplace_back(
          frame.corners[size_t(i)],
          std::abs(frame.weights[i]) + std::abs(frame.height) * frame.slopes.col(i).norm());
  return list;
}

void add_rows(const StickyTarget& target, double coefficient, PerParticle& rows) {
  double sum = 1;
  for (const auto& [corner, norm] : corner_norms(target)) sum += norm;
  rows[target.particle] += coefficient * sum;
  for (const auto& [corner, norm] : corner_norms(target)) rows[corner] += coefficient * norm * sum;
}

}  // namespace

TEST_CASE(
    "the row sums of sticking are those of G^T G, and of frames that turn under its springs") {
  State s = state();
  s.v = {};
  const PerParticle start = scattered(n, 5.1).row(0).transpose();
  for (const Sticking& all : {sticking(), out_of_reach()}) {
    PerParticle expected = start, turning = start, rows = start;
    int steeper_along = 0, in_reach = 0;
    for (const StickyTarget& target : all.targets_at(s)) {
      const double k = target.stiffness, d = target.distance,
                   along = std::abs(k + slope_of(all.patches[size_t(target.patch)], d) * d * d);
      steeper_along += along > k;
      in_reach += k > 0;
      add_rows(target, std::max(k, along), expected);
      for (const TriangleFrame& frame : target.frames)
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            turning[frame.corners[size_t(i)]] += 3 * k * d * std::abs(frame.height) *
                                                 frame.slopes.col(i).norm() *
                                                 frame.slopes.col(j).norm();
    }
    CHECK(steeper_along > 0);
    CHECK(steeper_along < in_reach);
    all.add_bound_without_springs(s, rows);
    CHECK(agree(rows, turning, 1e-12));
    rows = start;
    all.add_stiffness_bound(s, rows);
    CHECK(agree(rows, expected + turning - start, 1e-12));
  }
  const StickyTarget two = sticking().targets_at(s)[0];
  PerParticle rows = start, expected = start;
  add_row_sums(4, two.frames, 0.37, rows);
  add_rows(two, 0.37, expected);
  CHECK(agree(rows, expected, 1e-14));
}

TEST_CASE("the shortest forecast is that of the patches that have bonds") {
  State s = state();
  Sticking all = sticking();
  CHECK(all.shortest_forecast(s) == 0);  // that of patch 2
  s.bonds.erase(s.bonds.begin() + 6);
  CHECK(all.shortest_forecast(s) == 0.23);
  s.bonds.erase(s.bonds.begin(), s.bonds.begin() + 3);
  CHECK(all.shortest_forecast(s) == 0.41);
  s.bonds.erase(s.bonds.begin(), s.bonds.begin() + 3);
  CHECK(all.shortest_forecast(s) == 1);
  s.bonds.clear();
  CHECK(all.shortest_forecast(s) == std::numeric_limits<double>::infinity());
}
