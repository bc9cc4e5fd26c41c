// Measures of `foldproof compare` on cloth of known distances, folds and depths.
#include <catch2/catch.hpp>
#include <cmath>

#include "reference/bodies/level_set_provider.h"
#include "reference/mesh/shapes.h"
#include "verification/cases/frame_comparison.h"

using namespace foldproof;

namespace {

constexpr const char* text = R"([cloth]
shape = "sheet"
pattern = "one_diagonal"
width = 0.6
height = 0.4
columns = 6
rows = 4
density = 0.2
[stretch]
stiffness = 40
[bending]
stiffness = 1e-3
[[object]]
name = "ball"
shape = "sphere"
radius = 0.1
move = [0.3, 0.2, 0.13]
[time]
end = 0.05
frames_per_second = 100
)";

struct Trial {
  Scene scene = read_scene_text(text, "trial.toml");
  BuiltScene built = build(scene, computing_provider());
  State start = built.start;

  TimedMesh frame(const PerParticle3& x) const { return {"frame", 0, x, scene.mesh.triangles}; }
  FrameComparison compare(const TimedMesh& frame) const {
    return compare_frame({scene, built, matching_of(scene.mesh, std::span(&frame, 1))}, start,
                         frame);
  }
};

PerParticle3 moved(PerParticle3 x, const Vector3& by) { return x.colwise() += by; }

}  // namespace

TEST_CASE("frames match by their faces, in any order") {
  const Trial trial;
  TimedMesh frame = trial.frame(trial.start.x);
  std::reverse(frame.triangles.begin(), frame.triangles.end());
  for (Triangle& t : frame.triangles) t = {t[1], t[2], t[0]};
  CHECK(matching_of(trial.scene.mesh, std::span(&frame, 1)) == Matching::particles);
  frame.triangles[0] = {frame.triangles[0][0], frame.triangles[0][2], frame.triangles[0][1]};
  CHECK(matching_of(trial.scene.mesh, std::span(&frame, 1)) == Matching::surface);
  const TriangleMesh finer = make_sheet({SheetPattern::one_diagonal, 0.6, 0.4, 12, 8});
  const std::vector<TimedMesh> both = {trial.frame(trial.start.x),
                                       {"finer", 0, finer.rest, finer.triangles}};
  CHECK(matching_of(trial.scene.mesh, both) == Matching::surface);
}

TEST_CASE("frames of another mesh say which triangle differs first") {
  const Trial trial;
  const auto difference = [&](const TimedMesh& frame) {
    return mesh_difference(trial.scene.mesh, std::span(&frame, 1));
  };
  TimedMesh frame = trial.frame(trial.start.x);
  std::ranges::reverse(frame.triangles);
  CHECK(difference(frame) == "");
  const Triangle t = frame.triangles[3];
  frame.triangles[3] = {t[1], t[0], t[2]};
  CHECK(difference(frame).find("triangle 3, ") != std::string::npos);
  CHECK(difference(frame).find("turned over") != std::string::npos);
  frame.triangles[3] = {t[0], t[0], t[1]};
  CHECK(difference(frame).find("none of the case's") != std::string::npos);
  frame.triangles.pop_back(), frame.triangles[3] = t;
  CHECK(difference(frame).find("triangles, the case") != std::string::npos);
  frame.x.conservativeResize(3, 5);
  CHECK(difference(frame).find("has 5 vertices, the case") != std::string::npos);
}

TEST_CASE("cloth that is moved is as far away as it was moved") {
  const Trial trial;
  const FrameComparison c = trial.compare(trial.frame(moved(trial.start.x, {0.3, 0, 0.4})));
  CHECK(c.distance.rms == Approx(0.5));
  CHECK(c.distance.largest == Approx(0.5));
  CHECK(c.distance.weighted == Approx(0.5));
  CHECK(c.frame.stretch == Approx(c.run.stretch).margin(1e-12));
  PerParticle3 x = trial.start.x;  // one corner particle alone, a third of two triangles' mass
  x(2, 0) += 0.7;
  const FrameComparison one = trial.compare(trial.frame(x));
  CHECK(one.distance.rms == Approx(0.7 / std::sqrt(35)));
  CHECK(one.distance.largest == Approx(0.7));
  const double share = 2.0 / 3 / 48;  // of the mass: 48 triangles
  CHECK(one.distance.weighted == Approx(0.7 * std::sqrt(share)));
  CHECK(one.frame.stretch > 1e-2);
  CHECK(one.frame.bending > one.run.bending);
}

TEST_CASE("another mesh is compared by the nearest points of both surfaces") {
  const Trial trial;
  const TriangleMesh half = make_sheet({SheetPattern::union_jack, 0.3, 0.4, 5, 7});
  const FrameComparison c =
      trial.compare({"half", 0, moved(half.rest, {0, 0, 0.03}), half.triangles});
  CHECK(c.distance.largest == Approx(std::hypot(0.3, 0.03)));  // of the half that it lacks
  CHECK(c.distance.rms > 0.03);
  CHECK(std::isnan(c.frame.stretch));
  CHECK(c.frame.folds[0] == Approx(1));
  const TriangleMesh whole = make_sheet({SheetPattern::union_jack, 0.6, 0.4, 5, 7});
  const FrameComparison d =
      trial.compare({"whole", 0, moved(whole.rest, {0, 0, 0.03}), whole.triangles});
  CHECK(d.distance.rms == Approx(0.03));
  CHECK(d.distance.weighted == Approx(0.03));
}

TEST_CASE("crossings, folds and depth are those of the frame") {
  const Trial trial;
  CHECK(trial.compare(trial.frame(trial.start.x)).frame.depth == 0);
  const FrameComparison raised = trial.compare(trial.frame(moved(trial.start.x, {0, 0, 0.05})));
  CHECK(raised.frame.depth == Approx(0.02));  // the ball's lowest point is at z = 0.03
  CHECK(raised.run.depth == 0);
  PerParticle3 folded = trial.start.x;  // the right half turned back by 100 degrees about x = 0.3
  for (Eigen::Index i = 0; i < folded.cols(); ++i) {
    const double along = folded(0, i) - 0.3;
    if (along < 1e-9) continue;
    folded(0, i) = 0.3 + along * std::cos(100 * pi / 180);
    folded(2, i) = along * std::sin(100 * pi / 180);
  }
  const FrameComparison c = trial.compare(trial.frame(folded));
  CHECK(c.run.folds[4] == 0);
  CHECK(c.frame.folds[4] > 0.02);
  CHECK(c.frame.folds[2] == 0);
  CHECK(c.run.crossings == 0);
  PerParticle3 pierced = trial.start.x;  // a corner brought through the sheet's middle
  pierced.col(0) = Vector3(0.33, 0.21, -0.1);
  pierced.col(7) += Vector3(0.33, 0.1, 0.02);
  CHECK(trial.compare(trial.frame(pierced)).frame.crossings > 0);
}

TEST_CASE("between frames a cubic motion is met exactly") {
  const auto at = [](double t) {
    State s{t, PerParticle3::Zero(3, 2), PerParticle3::Zero(3, 2)};
    s.x.col(0) = Vector3(1 + 2 * t - 3 * t * t + 0.7 * t * t * t, t, 0.3);
    s.v.col(0) = Vector3(2 - 6 * t + 2.1 * t * t, 1, 0);
    return s;
  };
  const State a = at(0.4), b = at(1.9);
  for (const double t : {0.4, 0.7, 1.3, 1.9})
    CHECK((state_between(a, b, t).x - at(t).x).norm() < 1e-14);
}

TEST_CASE("a comparison is a study's evidence") {
  const Trial trial;
  const std::vector<FrameComparison> all(3, trial.compare(trial.frame(trial.start.x)));
  const ComparisonEvidence evidence = evidence_of(all, Matching::particles);
  REQUIRE(evidence.tables.size() == 2);
  CHECK(evidence.tables[0].numbers("rms distance").size() == 3);
  CHECK(evidence.tables[1].numbers("share, run").size() == 15);
  CHECK(evidence.figures.size() == 2);
  CHECK(evidence_of(all, Matching::surface).figures.size() == 1);
}
