// Measures of `foldproof compare` on cloth of known distances, folds and depths.
#include "reference/mesh/shapes.h"
#include "verification/cases/frame_comparison.h"
#include "verification/tests/cases/hand_made_frames.h"

using namespace foldproof;
using namespace foldproof::hand_made;
using Catch::Matchers::Contains;

namespace {

/// How the last frame differs, after one that matches.
std::string difference(const std::vector<Triangle>& triangles, int vertices = 5) {
  const std::vector<Triangle> faces = {{0, 1, 2}, {1, 3, 2}, {2, 3, 4}};
  PerParticle3 x(3, 5);
  x << 0, 1, 0, 1, 0, 0, 0, 1, 1, 2, 0, 0, 0, 0, 0;
  const TriangleMesh cloth = make_triangle_mesh(x, faces);
  const std::vector<TimedMesh> frames = {
      {"first.obj", 0, x, {{3, 4, 2}, {2, 0, 1}, {1, 3, 2}}},
      {"second.obj", 1, PerParticle3::Zero(3, vertices), triangles}};
  const std::string said = mesh_difference(cloth, frames);
  CHECK((matching_of(cloth, frames) == Matching::particles) == said.empty());
  return said;
}

struct Compared : Frames {
  explicit Compared(const std::string& more = "")
      : Frames(sheet("[stretch]\nstiffness = 40\n[bending]\nstiffness = 1e-3\n" + more)) {}

  /// The cloth at its start and at `time`, with this frame.
  FrameComparison with(const TimedMesh& frame, double time = 0) const {
    const Matching matching = matching_of(of.scene.mesh, std::span(&frame, 1));
    return compare_frame({of.scene, built, matching}, {time, of.scene.x, of.scene.v}, frame);
  }
  FrameComparison with(const PerParticle3& x) const {
    return with({"frame", 0, x, of.scene.mesh.triangles});
  }
};

PerParticle3 moved(PerParticle3 x, const Vector3& by) { return x.colwise() += by; }

}  // namespace

TEST_CASE("frames match by their faces, in any order") {
  CHECK(difference({{0, 1, 2}, {1, 3, 2}, {2, 3, 4}}) == "");
  CHECK(difference({{4, 2, 3}, {2, 0, 1}, {3, 2, 1}}) == "");
}

TEST_CASE("frames of another mesh say which triangle differs first") {
  CHECK_THAT(difference({{0, 1, 2}, {1, 3, 2}, {2, 3, 4}}, 7),
             Contains("second.obj has 7 vertices, of them 2 in no triangle, the case 5"));
  CHECK_THAT(difference({{0, 1, 2}, {3, 1, 2}, {4, 3, 2}}), Contains("second.obj: ") &&
                                                                Contains("triangle 1, (3, 1, 2)") &&
                                                                Contains("turned over"));
  CHECK_THAT(difference({{0, 1, 2}, {1, 3, 2}, {2, 1, 4}}),
             Contains("triangle 2, (2, 1, 4)") && Contains("none of the case's"));
  CHECK_THAT(difference({{3, 1, 0}, {1, 2, 3}, {2, 3, 4}}),
             Contains("triangle 0, (3, 1, 0)") && Contains("none of the case's"));
  CHECK_THAT(difference({{0, 1, 2}, {1, 3, 2}}), Contains("has 2 triangles, the case 3"));
  CHECK_THAT(difference({{0, 1, 2}, {1, 3, 2}, {2, 3, 4}, {1, 3, 2}}), Contains("4 triangles"));
}

TEST_CASE("cloth that is moved is as far away as it was moved") {
  const Compared cloth;
  const PerParticle3& start = cloth.of.scene.x;
  const FrameComparison c = cloth.with(moved(start, {0.3, 0, 0.4}));
  for (const double distance : {c.distance.rms, c.distance.largest}) CHECK(distance == Approx(0.5));
  CHECK(c.frame.stretch == Approx(c.run.stretch).margin(1e-12));
  PerParticle3 x = start;  // one corner particle alone, a third of two triangles' mass
  x(2, 0) += 0.7;
  const FrameComparison one = cloth.with(x);
  const Energies e = energies(cloth.built.system, {0, x, PerParticle3::Zero(3, 12)});
  CHECK(one.distance.largest == Approx(0.7));
  CHECK(one.distance.rms == Approx(0.7 * std::sqrt(2.0 / 3 / 12)));
  CHECK(one.frame.stretch == exactly(e.stretch));
  CHECK(one.frame.bending == exactly(e.bending));
  CHECK(one.frame.bending > one.run.bending);
  CHECK(one.frame.folds == fold_spectrum(cloth.of.scene.mesh, x));
  CHECK(cloth.with(crossed(start)).frame.crossings > 0);
  CHECK(cloth.with(crossed(start)).run.crossings == 0);
}

TEST_CASE("another mesh is compared by the nearest points of both surfaces") {
  const Compared cloth;
  const auto above = [&](double width) {
    const TriangleMesh mesh = make_sheet({SheetPattern::union_jack, width, 0.24, 5, 7});
    return cloth.with({"above", 0, moved(mesh.rest, {0, 0, 0.03}), mesh.triangles});
  };
  const FrameComparison half = above(0.15), whole = above(0.3);
  CHECK(half.distance.largest == Approx(std::hypot(0.15, 0.03)));  // of the half that it lacks
  CHECK(half.distance.rms > 0.03);
  CHECK(std::isnan(half.frame.stretch));
  CHECK(half.frame.folds[0] == Approx(1));
  CHECK(whole.distance.rms == Approx(0.03));
}

TEST_CASE("the distance of two surfaces does not depend on their meshes") {
  const Compared cloth;
  // tilted about x = 0, so that distances differ; in narrower columns towards one side
  const auto tilted = [&](double grading) {
    TriangleMesh mesh =
        make_sheet({.width = 0.3, .height = 0.24, .columns = 40, .rows = 20, .grading = grading});
    mesh.rest.row(2) = 0.1 * mesh.rest.row(0);
    return cloth.with({"tilted", 0, mesh.rest, mesh.triangles}).distance.rms;
  };
  CHECK(tilted(8) == Approx(tilted(1)).epsilon(0.02));
}

TEST_CASE("points without faces are compared one-sided") {
  const Compared cloth;
  PerParticle3 points(3, 2);
  points << 0.1, 0.2, 0.1, 0.1, 0.03, -0.04;
  const FrameComparison c = cloth.with({"scan", 0, points, {}});
  CHECK(c.distance.rms == Approx(std::sqrt((0.03 * 0.03 + 0.04 * 0.04) / 2)));
  CHECK(c.distance.largest == Approx(0.04));  // and not what the points leave out of the cloth
  CHECK(std::isnan(c.frame.crossings));
  CHECK(name_of(matching_of(cloth.of.scene.mesh, std::vector<TimedMesh>{{"s", 0, points, {}}})) ==
        "one-sided, points to the run's surface");
}

TEST_CASE("between frames a cubic motion is met exactly") {
  const auto at = [](double t) {
    State s{t, PerParticle3::Zero(3, 2), PerParticle3::Zero(3, 2)};
    s.x.col(0) = Vector3(1 + 2 * t - 3 * t * t + 0.7 * t * t * t, t, 0.3);
    s.v.col(0) = Vector3(2 - 6 * t + 2.1 * t * t, 1, 0);
    return s;
  };
  for (const double t : {0.4, 0.7, 1.3, 1.9})
    CHECK((state_between(at(0.4), at(1.9), t).x - at(t).x).norm() < 1e-14);
}
