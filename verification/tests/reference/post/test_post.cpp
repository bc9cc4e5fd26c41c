// Cloth prepared for rendering: depth maps, points moved out of objects, and smoothed surfaces.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <set>

#include "reference/mesh/self_intersection.h"
#include "reference/mesh/shapes.h"
#include "reference/post/fold_projection.h"
#include "reference/post/smooth_cloth.h"

using namespace foldproof;

namespace {

constexpr DepthBand band{0.02, 0.1, 0.06};  // eps, tau, t^ [m]

double mapped(const char* name, const DepthBand& by, double phi) {
  return depth_map_named(name).at(by, phi);
}

Object placed(const Solid& solid, const Pose& place) {
  return {"body", RigidObject{solid, place, Motion{}}, 0.3};
}

Object ground() { return placed(HalfSpace{}, {}); }

/// A half-space above the plane z = height [m], its outside below.
Object ceiling(double height) {
  return placed(HalfSpace{}, {{0, 1, 0, 0}, {0, 0, height}});  // half a turn about x
}

/// Plain, within half a tolerance of 2^-10 m of 0.25 m.
FoldProjection coarse(int max_moves) {
  return {"plain", {0.25, 0.5, 0}, PinchedPoints::left_alone, 1.0 / 1024, max_moves};
}

ProjectedCloth project_point(const std::vector<Object>& objects, const Vector3& p,
                             const FoldProjection& projection) {
  return project_folds(objects, PerParticle3(p), 0.7, projection);
}

/// A smooth surface found by counting: a point's share is halved in each round in which it belongs
/// to a triangle that intersects another, ten times; then it is 0.
struct CountedSmoothing {
  PerParticle3 x;
  PerParticle share;
  int rounds = 0;
  long pairs = 0;
};

CountedSmoothing smoothed_by_counting(const ClothSmoother& smoother, const PerParticle3& cloth) {
  const PerParticle3 flat = smoother.flat.of(cloth), smooth = smoother.smooth.of(cloth);
  const auto& triangles = smoother.smooth.triangles;
  CountedSmoothing result{smooth, PerParticle::Ones(flat.cols())};
  std::vector<int> halvings(std::size_t(flat.cols()), 0);
  for (;;) {
    ++result.rounds;
    std::set<int> met;
    result.pairs = 0;
    for (const auto& [s, t] : self_intersections(result.x, triangles)) {
      ++result.pairs;
      met.insert(triangles[std::size_t(s)].begin(), triangles[std::size_t(s)].end());
      met.insert(triangles[std::size_t(t)].begin(), triangles[std::size_t(t)].end());
    }
    if (std::ranges::all_of(met, [&](int i) { return halvings[std::size_t(i)] > 10; }))
      return result;
    for (const int i : met) {
      const int n = ++halvings[std::size_t(i)];
      result.share[i] = n > 10 ? 0 : std::ldexp(1, -n);
      result.x.col(i) = flat.col(i) + result.share[i] * (smooth.col(i) - flat.col(i));
    }
  }
}

SmoothedCloth check_smoothing(const TriangleMesh& mesh, const PerParticle3& x) {
  const ClothSmoother smoother(mesh, 1);
  const SmoothedCloth cloth = smooth_cloth(smoother, x);
  const CountedSmoothing expected = smoothed_by_counting(smoother, x);
  CHECK(cloth.rounds == expected.rounds);
  CHECK(cloth.pairs_left == expected.pairs);
  CHECK(cloth.share == expected.share);
  CHECK((cloth.x - expected.x).cwiseAbs().maxCoeff() < 1e-15);
  return cloth;
}

/// Both sheets' triangles over both sheets' points, the second's after the first's.
TriangleMesh together(const TriangleMesh& one, const TriangleMesh& other) {
  PerParticle3 rest(3, one.rest.cols() + other.rest.cols());
  rest << one.rest, other.rest;
  std::vector<Triangle> triangles = one.triangles;
  const int n = one.particles();
  for (const Triangle& t : other.triangles) triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  return make_triangle_mesh(rest, triangles);
}

}  // namespace

TEST_CASE("the power law takes the share of the depths to its power") {
  // depths 0.16 m, band 0.08 m: the power is 2
  CHECK(mapped("power", band, 0.02) == Approx(0.02 + 0.08 * 0.25).epsilon(1e-14));
  CHECK(mapped("power", band, -0.02) == Approx(0.02 + 0.08 * 0.0625).epsilon(1e-14));
  CHECK(mapped("power", band, -0.06) == Approx(0.02).epsilon(1e-14));
  CHECK(mapped("power", band, -0.3) == 0.02);
  CHECK(mapped("power", band, 0.14) == 0.14);
}

TEST_CASE("the blend is straight up to half the band below its reach, then a parabola") {
  // w = 0.04 m, m = (0.08 - 0.02)/(0.16 - 0.02) = 3/7
  CHECK(mapped("blend", band, -0.02) == Approx(0.02 + 0.04 * 3 / 7).epsilon(1e-14));
  CHECK(mapped("blend", band, 0.05) == Approx(0.02 + 0.11 * 3 / 7).epsilon(1e-14));
  CHECK(mapped("blend", band, 0.08) == Approx(0.08 + 0.005 * 4 / 7).epsilon(1e-14));
  CHECK(mapped("blend", band, -0.3) == 0.02);
  CHECK(mapped("blend", band, 0.14) == 0.14);
}

TEST_CASE("the plain map changes only what is nearer than the least distance") {
  CHECK(mapped("plain", band, -0.3) == 0.02);
  CHECK(mapped("plain", band, 0.019) == 0.02);
  CHECK(mapped("plain", band, 0.021) == 0.021);
  CHECK(mapped("plain", band, 0.14) == 0.14);
}

TEST_CASE("at the reach of a map nothing changes, not by a bit") {
  for (int k = 1; k < 200; ++k) {
    const DepthBand by{0.0013 * k, 0.0031 * k + 0.017, 0.0071 * k};
    for (const DepthMap& map : depth_maps()) CHECK(map.at(by, by.reach) == by.reach);
  }
}

TEST_CASE("a depth map is found by its name, and an unknown one is told the names") {
  for (const char* name : {"plain", "power", "blend"}) CHECK(depth_map_named(name).name == name);
  CHECK(depth_maps().size() == 3);
  CHECK_THROWS_WITH(depth_map_named("flat"),
                    "unknown depth map 'flat'; known: plain, power, blend");
}

TEST_CASE("a band may begin at the surface and distinguish no penetration") {
  CHECK_NOTHROW(check_band({0, 0.2, 0.7}));
  CHECK_NOTHROW(check_band({0.1, 0.2, 0}));
  CHECK_NOTHROW(check_band({0.1999, 0.2, 0.7}));
  CHECK_NOTHROW(check_band({1.5, 2.5, 3.5}));
}

TEST_CASE("a band that is none is refused with its three lengths") {
  CHECK_THROWS_WITH(check_band({0.3, 0.2, 0.7}),
                    "a projection needs 0 <= eps < tau and 0 <= deepest, but eps = 0.300000 m, tau "
                    "= 0.200000 m, deepest = 0.700000 m");
  const double infinite = std::numeric_limits<double>::infinity(), nan = std::nan("");
  for (const DepthBand& wrong : {DepthBand{0.2, 0.2, 0.7},
                                 {-0.01, 0.2, 0.7},
                                 {0.1, 0.2, -0.01},
                                 {0.1, infinite, 0.7},
                                 {0.1, 0.2, infinite},
                                 {nan, 0.2, 0.7},
                                 {0.1, nan, 0.7},
                                 {0.1, 0.2, nan}})
    CHECK_THROWS_AS(check_band(wrong), InputError);
}

TEST_CASE("a projection needs a tolerance and a move, and says which it has") {
  FoldProjection projection = coarse(3);
  CHECK_NOTHROW(project_point({ground()}, {0.3, -0.7, 0.9}, projection));
  projection.tolerance = 0;
  CHECK_THROWS_WITH(project_point({ground()}, {0.3, -0.7, 0.9}, projection),
                    "a projection needs a tolerance above 0 and a move or more for a point, but "
                    "has 0.000000 m and 3");
  projection = coarse(0);
  CHECK_THROWS_WITH(project_point({ground()}, {0.3, -0.7, 0.9}, projection),
                    Catch::EndsWith("but has 0.000977 m and 0"));
  projection = coarse(1);
  projection.tolerance = std::numeric_limits<double>::infinity();
  CHECK_THROWS_AS(project_point({ground()}, {0.3, -0.7, 0.9}, projection), InputError);
  projection = coarse(1);
  projection.band.nearest = 0.6;
  CHECK_THROWS_AS(project_point({ground()}, {0.3, -0.7, 0.9}, projection), InputError);
}

TEST_CASE("a moved point lies half a tolerance beyond the mapped distance") {
  const ProjectedCloth cloth = project_point({ground()}, {0.3, -0.7, -0.125}, coarse(1));
  CHECK(cloth.outcomes == std::vector{ProjectionOutcome::moved});
  CHECK(cloth.x.col(0) == Vector3(0.3, -0.7, 0.25 + 1.0 / 2048));
  CHECK(cloth.before[0] == -0.125);
  CHECK(cloth.after[0] == 0.25 + 1.0 / 2048);
  CHECK(cloth.object_queries == 2);
}

TEST_CASE("a point at its mapped distance stays, and each point has its own outcome") {
  PerParticle3 x(3, 4);
  x << 0.3, 0.4, 0.6, 0.7, -0.7, 0.2, 0.8, 0.9, 0.25, 0.1875, 0.75, -0.375;
  const ProjectedCloth cloth = project_folds(std::vector{ground()}, x, 0.7, coarse(5));
  using enum ProjectionOutcome;
  CHECK(cloth.outcomes == std::vector{untouched, moved, untouched, moved});
  CHECK(cloth.count(untouched) == 2);
  CHECK(cloth.count(moved) == 2);
  CHECK(cloth.count(unfinished) == 0);
  CHECK(cloth.x.col(0) == x.col(0));
  CHECK(cloth.x.col(2) == x.col(2));
  CHECK(cloth.before == PerParticle(x.row(2).transpose()));
  CHECK(cloth.after[0] == 0.25);
  CHECK(cloth.after[2] == 0.75);
  CHECK(cloth.object_queries == 4 + 2);
}

TEST_CASE("objects are asked where they are at the time of the cloth") {
  Motion motion;
  motion.velocity = {0, 0, 0.5};
  const std::vector<Object> rising{{"lift", RigidObject{HalfSpace{}, {}, motion}, 0.3}};
  const ProjectedCloth cloth =
      project_folds(rising, PerParticle3(Vector3(0.3, -0.7, 0.5)), 0.75, coarse(2));
  CHECK(cloth.before[0] == 0.125);
  CHECK(cloth.x(2, 0) == 0.375 + 0.25 + 1.0 / 2048);
}

TEST_CASE("a point has arrived at the very distance, and at the whole tolerance beyond it") {
  // the first move ends a quarter and half a tolerance above the ground: as far below the ceiling
  const ProjectedCloth least =
      project_point({ground(), ceiling(0.5 + 1.0 / 2048)}, {0.3, -0.7, -0.125}, coarse(1));
  CHECK(least.after[0] == 0.25);
  CHECK(least.outcomes == std::vector{ProjectionOutcome::moved});

  // f is odd in its last bit, the tolerance one bit: half of it is rounded up to the whole
  const double bit = std::ldexp(1, -54), f = 0.25 + bit;
  FoldProjection fine = coarse(1);
  fine.band.nearest = f, fine.tolerance = bit;
  const ProjectedCloth most = project_point({ground()}, {0.3, -0.7, 0}, fine);
  CHECK(most.after[0] == f + bit);
  CHECK(most.outcomes == std::vector{ProjectionOutcome::moved});
}

TEST_CASE("a point that every move takes further from its distance stays") {
  // in the middle of a gap of 0.375 m, too narrow for 0.25 m on both sides
  const ProjectedCloth cloth =
      project_point({ground(), ceiling(0.375)}, {0.3, -0.7, 0.1875}, coarse(4));
  CHECK(cloth.outcomes == std::vector{ProjectionOutcome::unfinished});
  CHECK(cloth.x.col(0) == Vector3(0.3, -0.7, 0.1875));
  CHECK(cloth.after[0] == 0.1875);
  CHECK(cloth.object_queries == 1 + 4);
}

TEST_CASE("of places equally near to the distance the first one is kept") {
  const double aim = 0.25 + 1.0 / 2048;
  for (const int moves : {1, 2, 5}) {
    const ProjectedCloth cloth =
        project_point({ground(), ceiling(0.375)}, {0.3, -0.7, -0.0625}, coarse(moves));
    CHECK(cloth.x.col(0) == Vector3(0.3, -0.7, aim));
    CHECK(cloth.after[0] == 0.375 - aim);
    CHECK(cloth.before[0] == -0.0625);
    CHECK(cloth.outcomes == std::vector{ProjectionOutcome::unfinished});
  }
}

TEST_CASE("between walls without clearance the nearest of the places visited is kept") {
  // three walls around a triangle too small for the distance
  struct Wall {
    Vector3 normal;
    double offset;  // m
  };
  std::vector<Wall> walls;
  std::vector<Object> objects;
  for (const auto& [angle, offset] : {std::pair{0.4, -0.11}, {2.3, -0.17}, {4.6, -0.13}}) {
    const Eigen::Quaterniond tilt(Eigen::AngleAxisd(angle, Vector3::UnitX()));
    walls.push_back({tilt * Vector3::UnitZ(), offset});
    objects.push_back(placed(HalfSpace{}, {tilt, offset * (tilt * Vector3::UnitZ())}));
  }
  FoldProjection projection = coarse(7);
  const double aim = projection.band.nearest + projection.tolerance / 2;
  const auto nearest = [&](const Vector3& p) {
    std::pair<double, Vector3> least{1e9, Vector3::Zero()};
    for (const Wall& wall : walls)
      if (const double phi = wall.normal.dot(p) - wall.offset; phi < least.first)
        least = {phi, wall.normal};
    return least;
  };
  std::set<std::size_t> ranks;
  for (const Vector3& start : {Vector3(0.3, 0.02, 0.03), Vector3(0.3, -0.13, 0.07),
                               Vector3(0.3, 0.11, -0.12), Vector3(0.3, 0.05, 0.19)}) {
    std::vector<Vector3> places{start};
    for (int move = 0; move < 7; ++move) {
      const auto [phi, normal] = nearest(places.back());
      places.push_back(places.back() + (aim - phi) * normal);
    }
    const auto miss = [&](const Vector3& p) { return std::abs(nearest(p).first - aim); };
    const auto best = std::ranges::min_element(places, {}, miss);
    ranks.insert(std::size_t(best - places.begin()));
    const ProjectedCloth cloth = project_point(objects, start, projection);
    CHECK((cloth.x.col(0) - *best).norm() < 1e-14);
    CHECK(std::abs(cloth.after[0] - nearest(*best).first) < 1e-14);
    CHECK(cloth.outcomes == std::vector{ProjectionOutcome::unfinished});
    CHECK(cloth.object_queries == 1 + 7);
  }
  CHECK(ranks.size() > 1);
}

TEST_CASE("a pinched point is left alone only if asked, and others never for that") {
  const std::vector<Object> overlapping{ground(), ceiling(-0.25)};
  FoldProjection projection = coarse(1);
  const Vector3 inside_both(0.3, -0.7, -0.0625), inside_one(0.3, -0.7, -0.5);
  const ProjectedCloth left = project_point(overlapping, inside_both, projection);
  CHECK(left.outcomes == std::vector{ProjectionOutcome::pinched});
  CHECK(left.x.col(0) == inside_both);
  CHECK(left.after[0] == -0.1875);
  CHECK(left.object_queries == 1);
  projection.pinched = PinchedPoints::projected;
  const ProjectedCloth tried = project_point(overlapping, inside_both, projection);
  CHECK(tried.outcomes == std::vector{ProjectionOutcome::unfinished});
  CHECK(tried.object_queries == 2);
  const ProjectedCloth free = project_point({ground()}, inside_one, projection);
  CHECK(free.outcomes == std::vector{ProjectionOutcome::moved});
}

TEST_CASE("a smooth surface that meets nothing is checked once and kept") {
  const TriangleMesh sheet = make_sheet({SheetPattern::alternating, 1, 0.6, 4, 3});
  PerParticle3 x = sheet.rest;
  x.row(2) = 0.3 * x.row(0).array().square() - 0.2 * x.row(1).array();
  const SmoothedCloth cloth = check_smoothing(sheet, x);
  CHECK(cloth.rounds == 1);
  CHECK(cloth.pairs_left == 0);
  CHECK(cloth.share == PerParticle::Ones(cloth.x.cols()));
  CHECK(SmoothedCloth().rounds == 0);
  CHECK(SmoothedCloth().pairs_left == 0);
}

TEST_CASE("layers that only their smooth surfaces bring together are held back by halves") {
  const TriangleMesh lower = make_sheet({SheetPattern::alternating, 1, 0.6, 8, 5}),
                     upper = make_sheet({SheetPattern::one_diagonal, 1, 0.6, 4, 3});
  const TriangleMesh both = together(lower, upper);
  PerParticle3 x = both.rest;
  x.rightCols(upper.particles()).row(2).array() += 0.015;
  x.row(2).array() -= 0.9 * (x.row(0).array() - 0.5).abs();
  CHECK(check_smoothing(both, x).pairs_left == 0);
}

TEST_CASE("where cloth crosses itself its points are on the cloth after eleven rounds") {
  PerParticle3 x(3, 6);
  x << 0.1, 1.3, 0.2, 0.3, 0.6, 0.5, 0.2, 0.1, 1.2, 0.3, 0.7, 0.4, 0.1, 0.2, 0.1, -0.9, -0.6, 0.8;
  const TriangleMesh mesh = make_triangle_mesh(x, {{0, 1, 2}, {3, 4, 5}});
  const SmoothedCloth cloth = check_smoothing(mesh, x);
  CHECK(cloth.rounds >= 12);
  CHECK(cloth.pairs_left > 0);
  CHECK(cloth.share.minCoeff() == 0);
}

TEST_CASE("points that come to be held back later than others lose as many halves") {
  // two rough sheets, steep and shallow, through each other
  const TriangleMesh one = make_sheet({SheetPattern::alternating, 1, 0.6, 6, 4}),
                     other = make_sheet({SheetPattern::one_diagonal, 1, 0.6, 5, 3});
  const TriangleMesh both = together(one, other);
  PerParticle3 x = both.rest;
  for (Eigen::Index i = 0; i < x.cols(); ++i)
    x(2, i) = (i < one.particles() ? 0.1 * x(0, i) : 0.07 - 0.05 * x(0, i)) +
              0.06 * std::sin(double(7 * i * i % 23));
  const SmoothedCloth cloth = check_smoothing(both, x);
  CHECK(cloth.rounds > 12);
  CHECK(cloth.pairs_left > 0);
  CHECK(cloth.share.maxCoeff() > 0);
}

TEST_CASE("points of a smooth cloth are held back by halves") {
  // a ridge of wide cells over one of narrow cells, which Loop's rule rounds off less
  const TriangleMesh lower = make_sheet({SheetPattern::alternating, 1, 0.6, 8, 5}),
                     upper = make_sheet({SheetPattern::one_diagonal, 1, 0.6, 4, 3});
  PerParticle3 x(3, lower.rest.cols() + upper.rest.cols());
  x << lower.rest, upper.rest;
  x.rightCols(upper.rest.cols()).row(2).array() += 0.015;
  x.row(2).array() -= 0.9 * (x.row(0).array() - 0.5).abs();
  std::vector<Triangle> triangles = lower.triangles;
  for (const Triangle& t : upper.triangles) {
    const int n = int(lower.rest.cols());
    triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  }
  const SmoothedCloth cloth = smooth_cloth(ClothSmoother(make_triangle_mesh(x, triangles), 1), x);
  CHECK(cloth.pairs_left == 0);
  int between = 0;
  for (const double share : cloth.share) {
    int power = 0;
    CHECK((share == 0 || std::frexp(share, &power) == 0.5));
    between += share > 0 && share < 1;
  }
  CHECK(between > 0);
  CHECK(cloth.share.maxCoeff() == 1);
}
