// Targets, derivatives and forecasts of sticking.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

#include "verification/tests/reference/forces/force_differences.h"

using namespace foldproof;

namespace {

constexpr int n = 9;  // particles

StickyPatch patch(const std::vector<Triangle>& triangles, double stiffness, double forecast_time,
                  double far) {
  StickyPatch made;
  made.triangles = triangles;
  made.stiffness = stiffness;
  made.forecast_time = forecast_time;
  made.far = far;
  return made;
}

/// Four patches, of which the second and the fourth move by themselves.
Sticking sticking() {
  Sticking all{{patch({{0, 1, 2}, {2, 1, 3}}, 19, 0.23, 2.6),
                patch({{3, 0, 1}, {1, 0, 2}}, 31, 0.41, 2.1), patch({{3, 2, 0}}, 7, 0, 2.3),
                patch({{2, 3, 1}}, 11, 1, 4.9)}};
  for (const size_t k : {1u, 3u}) {
    const double seed = k == 1 ? 6.1 : 8.4;
    all.patches[k].place = [seed](double t) {
      return PerParticle3(scattered(4, seed) + t * scattered(4, seed + 1.3));
    };
    all.patches[k].velocity = [seed](double) { return scattered(4, seed + 1.3); };
  }
  return all;
}

/// Nine bonds, which have seven targets.
State state() {
  State s{0.37, scattered(n, 0.4), scattered(n, 2.9)};
  s.bonds = {{0, 0, 4, Vector3(0.21, 0.34, 0.13)}, {0, 1, 4, Vector3(0.52, -0.11, -0.28)},
             {0, 1, 5, Vector3(0.17, 0.48, 0.31)}, {1, 0, 4, Vector3(0.29, 0.23, -0.19)},
             {1, 0, 6, Vector3(0.11, 0.62, 0.07)}, {1, 1, 6, Vector3(0.41, 0.37, -0.23)},
             {2, 0, 5, Vector3(0.33, 0.27, 0.09)}, {3, 0, 7, Vector3(0.44, 0.19, 0.16)},
             {3, 0, 8, Vector3(-0.12, 0.53, 0.35)}};
  return s;
}

/// A particle on its target on cloth.
State state_at_target(const Sticking& of) {
  State s = state();
  s.bonds = {{0, 0, 4, Vector3(0.25, 0.5, 0)}};
  s.x.col(4) = of.targets_at(s)[0].x;
  return s;
}

double stiffness_of(const StickyPatch& patch, double d) {
  return patch.stiffness * std::pow(1 - std::pow(d / patch.far, 2), 2);
}

/// dk/dd over d.
double slope_of(const StickyPatch& patch, double d) {
  const double far2 = patch.far * patch.far;
  return d < patch.far ? -4 * patch.stiffness / far2 * (1 - d * d / far2) : 0;
}

}  // namespace

TEST_CASE("the semidefinite derivative of sticking never pushes along its springs") {
  const auto product = [](const Sticking& of, const State& s, const Vector3& direction) {
    ForceDifferential K;
    of.add_elastic_differential(s, Definiteness::semidefinite, K);
    const int particle = s.bonds[0].particle;
    PerParticle3 dx = PerParticle3::Zero(3, n), df = dx;
    dx.col(particle) = direction;
    K.add_product(dx, df);
    return Vector3(df.col(particle));
  };
  Sticking all = sticking();
  State s = state();
  s.bonds = {s.bonds[7]};  // to a surface
  const StickyTarget target = all.targets_at(s)[0];
  const Vector3 u = target.x - s.x.col(7), across = u.cross(Vector3(3, 1, 2));
  const double d = u.norm();
  for (const double far : {1.1 * d, 2.2 * d, 2.3 * d, 9 * d}) {
    all.patches[3].far = far;
    const double k = stiffness_of(all.patches[3], d),
                 along = k + slope_of(all.patches[3], d) * d * d;
    CHECK((along < 0) == (far < std::sqrt(5) * d));
    CHECK(agree(product(all, s, across), -k * across, 1e-12));
    CHECK((product(all, s, u) + std::max(0.0, along) * u).norm() < 1e-12 * k * d);
  }
  // at its target a spring has one stiffness in all directions
  const Sticking one{{patch({{0, 1, 2}}, 8, 0, 0.7)}};
  CHECK(agree(product(one, state_at_target(one), u), -8 * u, 1e-14));
}
