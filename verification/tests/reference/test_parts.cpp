// Parts of the reference: zones of colliding cloth, and prescribed motion where it does least.
#include <barrier>
#include <catch2/catch.hpp>

#include "reference/bodies/self_intersection.h"
#include "reference/dynamics/system.h"
#include "reference/fast/threads.h"
#include "reference/filters/impact_zones.h"
#include "reference/filters/strain_limit.h"
#include "reference/mesh/nearest_point.h"
#include "reference/mesh/seams.h"
#include "reference/mesh/shapes.h"
#include "reference/motion/pose.h"
#include "reference/post/smooth_cloth.h"
#include "reference/scene/scene.h"

using namespace foldproof;

TEST_CASE("zones join, grow and are counted without the particles that are in none") {
  ImpactZones zones(13);
  CHECK(zones.zones() == 0);
  CHECK(zones.particles() == 0);
  const FeaturePair first{PairKind::edge_edge, {0, 1, 2, 3}},
      other{PairKind::edge_edge, {8, 7, 6, 9}};
  zones.join(first);
  CHECK(zones.zones() == 1);
  CHECK(zones.particles() == 4);
  zones.join(other);
  CHECK(zones.zones() == 2);
  CHECK(zones.particles() == 8);
  CHECK(zones.are_joined(first));
  CHECK_FALSE(zones.are_joined({PairKind::edge_edge, {0, 1, 6, 7}}));
  CHECK(zones.take_grown_zones() == std::vector<std::vector<int>>{{0, 1, 2, 3}, {6, 7, 8, 9}});
  CHECK(zones.take_grown_zones().empty());
  zones.join({PairKind::vertex_triangle, {3, 9, 11, 12}});
  CHECK(zones.zones() == 1);
  CHECK(zones.particles() == 10);
  CHECK(zones.take_grown_zones() ==
        std::vector<std::vector<int>>{{0, 1, 2, 3, 6, 7, 8, 9, 11, 12}});
}

TEST_CASE("a body that does not turn stays in its place, wherever its centre is") {
  Motion motion;
  motion.center = {0.3, -0.7, 1.9};
  const Vector3 start(2.1, 0.4, -0.8);
  CHECK((position_at(motion, start, 3.7) - start).norm() < 1e-15);
  CHECK(velocity_at(motion, start, 3.7) == Vector3::Zero());
  const Pose pose = pose_at(motion, 3.7);
  CHECK(pose.translation.norm() < 1e-15);
  CHECK((to_world(pose, start) - start).norm() < 1e-15);
  motion.velocity = {0, 0.5, 0};
  CHECK((position_at(motion, start, 2) - start - Vector3(0, 1, 0)).norm() < 1e-15);
}

TEST_CASE("the events of prescribed particles ascend, each once, without those that are over") {
  Motion late, early;
  late.from = 0.7, late.until = 1.9;
  early.from = 0.3, early.until = 0.7;
  const std::vector<PrescribedParticle> particles{{4, Vector3::Zero(), late},
                                                  {7, Vector3::Zero(), early}};
  CHECK(event_times(particles, 0.3) == std::vector<double>{0.7, 1.9});
  CHECK(event_times(particles, 0.1) == std::vector<double>{0.3, 0.7, 1.9});
}

TEST_CASE("threads: all parts of a loop are under way at once") {
  for (const int parts : {2, 3}) {
    std::barrier all_have_begun(parts);  // for which fewer threads would wait for ever
    in_parallel(parts, [&](int) { all_have_begun.arrive_and_wait(); });
    SUCCEED();
  }
}

TEST_CASE("sticking that forecasts allows steps of twice its time, if nothing else forbids them") {
  System system = make_system((PerParticle(3) << 0.5, 0.02, 0.3).finished());
  State s;
  s.x = PerParticle3(3, 3);
  s.x << 0, 1, 2, 0, 0, 0, 0.01, 0, 0;
  s.v = PerParticle3::Zero(3, 3);
  const StretchSprings springs{{{1, 2, 1.0, 30.0, 0.0}}};
  system.forces.emplace_back(springs);
  const double of_springs = elastic_limit(system, s);
  CHECK(widened_limit(system, s, 0.001) == 0.001);  // nothing sticks

  StickyPatch patch;
  patch.triangles = {{0, 1, 2}};
  patch.place = [](double) {
    return (PerParticle3(3, 3) << -1, 1, 0, -1, -1, 2, 0, 0, 0).finished();
  };
  patch.velocity = [](double) { return PerParticle3(PerParticle3::Zero(3, 3)); };
  patch.particles = {0};
  patch.stiffness = 1e7;
  patch.near = patch.far = 0.1;
  for (const double forecast : {0.2 * of_springs, 3 * of_springs}) {
    patch.forecast_time = forecast;
    system.forces = {springs, Sticking{{patch}}};
    begin_step(system, s);
    REQUIRE(s.bonds.size() == 1);
    const double wanted = std::min(of_springs, 2 * forecast);
    CHECK(elastic_limit(system, s) < 0.1 * wanted);
    CHECK(widened_limit(system, s, elastic_limit(system, s)) == Approx(wanted).epsilon(1e-14));
    CHECK(widened_limit(system, s, 7 * of_springs) == 7 * of_springs);
  }
}

TEST_CASE("threads: a share has the elements that touch its particles, in runs of one kind") {
  // elements of two, two, two and four particles; of the two shares the first has particles 0 to 2
  const Sharing sharing =
      share_out(2, 6, {{0, 1, 0, 1}, {1, 2, 1, 2}, {4, 5, 4, 5}, {0, 2, 3, 4}, {2, 5, 2, 5}});
  CHECK(sharing->elements == 5);
  const auto runs_of = [&](size_t share) {
    std::vector<std::array<size_t, 3>> runs;
    for (const ElementRun& run : sharing->shares.at(share).runs)
      runs.push_back({run.first, run.end, size_t(run.is_inside)});
    return runs;
  };
  CHECK(runs_of(0) == std::vector<std::array<size_t, 3>>{{0, 2, 1}, {3, 5, 0}});
  CHECK(runs_of(1) == std::vector<std::array<size_t, 3>>{{2, 3, 1}, {3, 5, 0}});
  CHECK(sharing->shares[0].first == 0);
  CHECK(sharing->shares[0].end == 3);
  CHECK(sharing->shares[1].end == 6);
  CHECK_FALSE(share_out(1, 6, {}));
}

TEST_CASE("sweeps of strain limiting end at the tolerance, not below it") {
  // the long spring is met last, and leaves the short one too long
  const std::vector<Spring> springs{{0, 1, 0.5, 1, 0}, {1, 2, 2, 1, 0}};
  const PerParticle3 x = (PerParticle3(3, 3) << 0, 0.5, 2.8, 0, 0, 0, 0, 0, 0).finished();
  const PerParticle inverse_mass = (PerParticle(3) << 0, 1, 0).finished();
  const auto limited = [&](double tolerance) {
    StrainLimits limits;
    limits.tolerance = tolerance;
    PerParticle3 v = PerParticle3::Zero(3, 3);
    return limit_strain(make_strain_limiter(limits, springs, inverse_mass), 1, x, v);
  };
  const StrainSweeps once = limited(1);
  CHECK(once.sweeps == 1);
  CHECK(once.remaining_violation == Approx(0.1));
  CHECK(limited(once.remaining_violation).sweeps == 1);
  CHECK(limited(std::nextafter(once.remaining_violation, 0)).sweeps > 1);
}

TEST_CASE("self-collision counts the pairs that it asks and those that it keeps apart") {
  // the corner of a triangle comes down on the inside of another
  PerParticle3 rest(3, 6);
  rest << 0, -0.08, 0.09, -0.11, 0.12, 0.01, -0.03, 0.02, -0.05, -0.1, -0.12, 0.1, 0.0024, 0.2,
      0.21, 0, 0, 0;
  Scene scene = scene_at_rest(make_triangle_mesh(std::move(rest), {{0, 1, 2}, {3, 4, 5}}), 0.17);
  scene.self_collision = SelfCollisionSettings{0.002, 0, 0, 8, true};
  const System system = build_system(scene);
  const auto& filter = std::get<SelfCollision>(system.filters.back());
  State s = start_state(scene);
  for (const auto& [speed, met] : {std::pair{0.1, 0}, std::pair{0.9, 1}}) {
    s.v.leftCols(3).row(2).setConstant(-speed);
    PerParticle3 v = s.v;
    Work work;
    filter.correct({0, 0.004, 0.004}, s, v, work);
    CHECK(work.crossings == met);
    CHECK(work.crossing_queries >= met);
    CHECK(work.zones == 0);
    CHECK((v != s.v) == (met > 0));
  }
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

TEST_CASE("prescribed motion has no velocity before it begins and from its end on") {
  Motion motion;
  motion.from = 0.3, motion.until = 0.7;
  motion.velocity = {1, 0, 0};
  for (const double time : {0.1, 0.7, 0.9})
    CHECK(velocity_at(motion, Vector3(1, 2, 3), time) == Vector3::Zero());
  for (const double time : {0.3, 0.5})
    CHECK(velocity_at(motion, Vector3(1, 2, 3), time) == motion.velocity);
}

TEST_CASE("rotations of keyframes are normalised") {
  Keyframe key{0, {}};
  key.pose.rotation.coeffs() *= 2;
  CHECK(make_keyframes({key}).keys[0].pose.rotation.norm() == 1);
}

TEST_CASE("what lies between two regions of a triangle belongs to its corner") {
  const Corners3 corners{Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0, 1, 0)};
  CHECK(nearest_on_triangle(corners, {0, -1, 0}).feature == Feature::a);
  CHECK(nearest_on_triangle(corners, {1, -1, 0}).feature == Feature::b);
  CHECK(nearest_on_triangle(corners, {-1, 1, 0}).feature == Feature::c);
  CHECK(nearest_on_triangle(corners, {0.5, -1, 0}).feature == Feature::ab);
}

TEST_CASE("dampers are shared out as springs are if each spring has one") {
  StretchSprings springs{{{0, 1, 1, 1, 0.1}, {1, 2, 1, 1, 0.1}}};
  springs.use_threads(2, 3);
  CHECK(springs.sharing);
  CHECK(springs.damper_sharing == springs.sharing);
  springs.springs[1].damping = 0;
  springs.use_threads(2, 3);
  CHECK_FALSE(springs.damper_sharing);
}

TEST_CASE("triangles of one plane intersect where only their edges cross") {
  PerParticle3 x(3, 6);
  x << 0, 4, 2, 0, 4, 2, 0, 0, 3, 2, 2, -1, 0, 0, 0, 0, 0, 0;
  const std::vector<Triangle> star{{0, 1, 2}, {3, 4, 5}};
  CHECK(self_intersections(x, star).size() == 1);
  x.rightCols(3).row(0).array() += 4.5;
  CHECK(self_intersections(x, star).empty());
}

TEST_CASE("seams need a distance") {
  const TriangleMesh sheet = make_sheet({SheetPattern::one_diagonal, 1, 1, 1, 1});
  for (const double distance : {0.0, -1.0, double(INFINITY)})
    CHECK_THROWS_WITH(close_seams({sheet.rest, sheet.triangles, {}}, distance),
                      Catch::Contains("seams need a distance > 0 m"));
}
