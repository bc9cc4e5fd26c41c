// Projection of cloth out of objects by depth.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "reference/mesh/shapes.h"
#include "reference/post/fold_projection.h"
#include "reference/post/smooth_cloth.h"

using namespace foldproof;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr DepthBand band{0.01, 0.03, 0.05};

double mapped(const char* name, double phi) { return depth_map_named(name).at(band, phi); }

/// z < height, or z > height for a ceiling.
Object level(double height, bool is_ceiling = false) {
  Pose place;
  if (is_ceiling) place.rotation = Eigen::AngleAxisd(std::acos(-1.0), Vector3::UnitX());
  place.translation = {0, 0, height};
  return {"level", RigidObject{HalfSpace{}, place, Motion{}}, 0};
}

PerParticle3 at_heights(const std::vector<double>& z) {
  PerParticle3 x(3, Eigen::Index(z.size()));
  for (Eigen::Index i = 0; i < x.cols(); ++i) x.col(i) << 0.3 + double(i), -0.7, z[size_t(i)];
  return x;
}

const FoldProjection plainly{"plain", {0.08, 0.2, 0.3}, PinchedPoints::left_alone, 0.002, 5};

}  // namespace

TEST_CASE("depth maps: values worked out by hand") {
  // power: u = (phi + .05)/.08, p = .08/.02 = 4
  CHECK(mapped("power", -0.01) == Approx(0.01 + 0.02 / 16).epsilon(1e-14));
  CHECK(mapped("power", 0.01) == Approx(0.01 + 0.02 * 81 / 256).epsilon(1e-14));
  // blend: w = .01, m = .015/.075 = .2
  CHECK(mapped("blend", -0.03) == Approx(0.014).epsilon(1e-14));
  CHECK(mapped("blend", 0.02) == Approx(0.024).epsilon(1e-14));
  CHECK(mapped("blend", 0.025) == Approx(0.026).epsilon(1e-14));
  for (const char* name : {"power", "blend"}) {
    CHECK(mapped(name, -0.07) == 0.01);  // deeper than is told apart
    CHECK(mapped(name, 0.03) == 0.03);
    CHECK(mapped(name, 0.04) == 0.04);
  }
  CHECK(mapped("plain", -0.07) == 0.01);
  CHECK(mapped("plain", 0.02) == 0.02);
}

TEST_CASE("depth maps: an unknown one is refused with the names of the others") {
  CHECK_THROWS_WITH(depth_map_named("steep"),
                    "unknown depth map 'steep'; known: plain, power, blend");
  CHECK(depth_maps().size() == 3);
}

TEST_CASE("depth maps: a band is refused unless 0 <= eps < tau and 0 <= deepest, all finite") {
  const double none = std::numeric_limits<double>::quiet_NaN();
  CHECK_NOTHROW(check_band({0, 1e-300, 0}));
  for (const DepthBand& wrong : std::vector<DepthBand>{{-1e-300, 1, 1},
                                                       {0.5, 0.5, 1},
                                                       {0.6, 0.5, 1},
                                                       {0.1, 0.5, -1e-300},
                                                       {0.1, infinity, 1},
                                                       {0.1, 0.5, infinity},
                                                       {none, 1, 1},
                                                       {0.1, none, 1},
                                                       {0.1, 1, none}})
    CHECK_THROWS_AS(check_band(wrong), InputError);
  CHECK_THROWS_WITH(check_band({0.25, 0.125, 3}), Catch::Contains("eps = 0.25") &&
                                                      Catch::Contains("tau = 0.125") &&
                                                      Catch::Contains("deepest = 3.0"));
}

TEST_CASE("projection: a tolerance above 0 and a move are needed") {
  const std::vector<Object> floor{level(0)};
  const PerParticle3 x = at_heights({-0.1});
  const auto project = [&](double tolerance, int moves) {
    FoldProjection settings = plainly;
    settings.tolerance = tolerance, settings.max_moves = moves;
    return project_folds(floor, x, 0, settings);
  };
  CHECK_NOTHROW(project(1e-3, 1));
  CHECK_THROWS_WITH(project(0, 7), Catch::Contains("0.000000 m and 7"));
  CHECK_THROWS_AS(project(infinity, 7), InputError);
  CHECK_THROWS_AS(project(1e-3, 0), InputError);
}

TEST_CASE("projection: of a plane each point arrives in one move, in the middle of the tolerance") {
  const std::vector<Object> floor{level(0.5)};
  const PerParticle3 x = at_heights({0.4, 0.57, 0.6, 0.9});  // phi -.1, .07, .1, .4
  const ProjectedCloth cloth = project_folds(floor, x, 0, plainly);
  for (const int i : {0, 1}) {
    CHECK((cloth.x.col(i) - Vector3(0.3 + i, -0.7, 0.581)).norm() < 1e-14);
    CHECK(cloth.after[i] == Approx(0.081));
    CHECK(cloth.outcomes[size_t(i)] == ProjectionOutcome::moved);
  }
  CHECK(cloth.x.rightCols(2) == x.rightCols(2));
  CHECK((cloth.before - PerParticle((x.row(2).array() - 0.5).transpose())).norm() < 1e-15);
  CHECK(cloth.after[3] == cloth.before[3]);
  CHECK(cloth.count(ProjectionOutcome::moved) == 2);
  CHECK(cloth.count(ProjectionOutcome::untouched) == 2);
  CHECK(cloth.count(ProjectionOutcome::pinched) == 0);
  CHECK(cloth.object_queries == 4 + 2);
}

TEST_CASE("projection: between objects with too little clearance the nearest place is kept") {
  const std::vector<Object> gap{level(0), level(0.1, true)};  // phi is at most .05 between them
  const PerParticle3 x = at_heights({0.045, -0.02});
  const ProjectedCloth cloth = project_folds(gap, x, 0, plainly);
  CHECK(cloth.count(ProjectionOutcome::unfinished) == 2);
  CHECK(cloth.x.col(0) == x.col(0));  // each move leads nearer to an object
  CHECK(cloth.after[0] == cloth.before[0]);
  CHECK(cloth.after[1] == Approx(0.019));  // better than -.02, and no later move is better
  CHECK(std::min(cloth.x(2, 1), 0.1 - cloth.x(2, 1)) == Approx(0.019));
  CHECK(cloth.object_queries == 2 + 2 * 5);
}

TEST_CASE("projection: a point inside two objects is left alone, if it is asked for") {
  const std::vector<Object> overlap{level(0.2), level(0.1, true)};
  const PerParticle3 x = at_heights({0.16});  // .04 and .06 deep
  FoldProjection settings = plainly;
  ProjectedCloth cloth = project_folds(overlap, x, 0, settings);
  CHECK(cloth.outcomes[0] == ProjectionOutcome::pinched);
  CHECK(cloth.x == x);
  CHECK(cloth.before[0] == Approx(-0.06));
  CHECK(cloth.after[0] == cloth.before[0]);
  CHECK(cloth.object_queries == 1);
  settings.pinched = PinchedPoints::projected;
  cloth = project_folds(overlap, x, 0, settings);
  CHECK(cloth.outcomes[0] == ProjectionOutcome::unfinished);
  CHECK(cloth.object_queries == 1 + 5);
}

TEST_CASE("projection: objects are asked where they are at its time") {
  Motion rising;
  rising.velocity = {0, 0, 0.25};
  const std::vector<Object> lift{{"lift", RigidObject{HalfSpace{}, {}, rising}, 0}};
  const ProjectedCloth cloth = project_folds(lift, at_heights({0.3}), 2, plainly);
  CHECK(cloth.before[0] == Approx(-0.2));
  CHECK(cloth.x(2, 0) == Approx(0.581));
}

TEST_CASE("smoothing: cloth that meets itself nowhere takes the smooth positions at once") {
  const TriangleMesh mesh = make_disc(0.4, 3);
  PerParticle3 x = mesh.rest;
  x(2, 4) += 0.15;
  const ClothSmoother smoother(mesh, 1);
  const SmoothedCloth cloth = smooth_cloth(smoother, x);
  CHECK(cloth.x == smoother.smooth.of(x));
  CHECK(cloth.x != smoother.flat.of(x));
  CHECK(cloth.share == PerParticle::Ones(cloth.x.cols()));
  CHECK(cloth.rounds == 1);
  CHECK(cloth.pairs_left == 0);
}
