// Laws of frames about folds and elastic energy, on frames placed by hand.
#include <Eigen/Geometry>

#include "verification/cases/frame_laws.h"
#include "verification/tests/cases/hand_made_frames.h"

using namespace foldproof;
using namespace foldproof::hand_made;
using Catch::Matchers::Contains;

namespace {

Law law(const std::string& name) {
  for (const FrameLaw& one : frame_laws())
    if (one.name == "frames." + name) return one.run;
  throw std::logic_error("no law " + name);
}

/// Three triangles in a row with two parallel hinges, at y = 0 and at y = 1; from particles 0 and 3
/// hang flaps that turn by these angles about them [degrees].
PerParticle3 flaps(double first, double second) {
  const double a = first * pi / 180, b = second * pi / 180;
  PerParticle3 x(3, 6);
  x.col(0) = Vector3(0, 0, 0), x.col(1) = Vector3(1, 0, 0);
  x.col(2) = Vector3(0, 1, 0), x.col(3) = Vector3(1, 1, 0);
  x.col(4) = Vector3(0.5, -std::cos(a), std::sin(a));
  x.col(5) = Vector3(0.5, 1 + std::cos(b), std::sin(b));
  return x;
}

Case three_pieces() {
  Case of = sheet("");
  of.scene = scene_at_rest(
      make_triangle_mesh(flaps(0, 0), {{0, 1, 2}, {1, 3, 2}, {1, 0, 4}, {2, 3, 5}}), 0.2);
  return of;
}

/// The law's finding for these turns of the two flaps.
Finding folds(const std::vector<std::pair<double, double>>& turns) {
  Frames cloth(three_pieces());
  for (std::size_t k = 0; k < turns.size(); ++k)
    cloth.add(0.1 + 0.07 * double(k), flaps(turns[k].first, turns[k].second));
  return law("folds-never-pass-through")(cloth.motion());
}

}  // namespace

TEST_CASE("folds: the largest change of an angle, and that of the hinges that did not jump") {
  const Finding calm = folds({{10, -20}, {70, 60}, {20, 61}});
  CHECK(calm.evidence.numbers("time") == std::vector<double>{0.1 + 0.07, 0.1 + 0.07 * 2});
  const std::vector<double> largest = calm.evidence.numbers("largest change of a hinge's angle");
  const std::vector<double> seen = calm.evidence.numbers("fastest turn of other hinges");
  CHECK(largest[0] == exactly(80));
  CHECK(largest[1] == exactly(50));
  CHECK(seen[0] == exactly(80));
  CHECK(seen[1] == exactly(50));
  CHECK(calm.verdict.measured == exactly(80));
  CHECK(calm.verdict.bound == 180);
  CHECK(calm.verdict.uncertainty == 0);
  CHECK(outcome_of(calm.verdict) == Outcome::holds);
}

TEST_CASE("folds: a jump is as uncertain as the other hinges are fast, and the clearest counts") {
  const Finding jumped = folds({{170, 30}, {-165, 47}, {-160, 50}});
  CHECK(jumped.evidence.numbers("largest change of a hinge's angle")[0] == exactly(335));
  CHECK(jumped.evidence.numbers("fastest turn of other hinges")[0] == exactly(17));
  CHECK(jumped.verdict.measured == exactly(335));
  CHECK(jumped.verdict.uncertainty == exactly(17));
  CHECK(outcome_of(jumped.verdict) == Outcome::fails);
  // the larger jump comes with a faster turn, before or after the smaller one
  const Finding later = folds({{170, 10}, {-170, 130}, {-120, 130}, {120, 138}});
  CHECK(later.verdict.measured == exactly(240));
  CHECK(later.verdict.uncertainty == exactly(8));
  const Finding earlier = folds({{-120, 130}, {120, 138}, {170, 10}, {-170, 130}});
  CHECK(earlier.verdict.measured == exactly(240));
  CHECK(earlier.verdict.uncertainty == exactly(8));
  // a jump hardly larger than the other hinge's turn says nothing
  const Finding unclear = folds({{-100, -90}, {80.4, 89.9}});
  CHECK(unclear.verdict.measured == exactly(180.4));
  CHECK(unclear.verdict.uncertainty == exactly(179.9));
  CHECK(outcome_of(unclear.verdict) == Outcome::inconclusive);
}

TEST_CASE("folds: one oriented surface and two frames are needed") {
  const auto missing = [](const std::vector<std::vector<Triangle>>& triangles, int more = 0) {
    Frames cloth(three_pieces());
    for (const std::vector<Triangle>& of_frame : triangles) {
      cloth.add(0.1 * double(cloth.frames.size()), flaps(10, 20));
      cloth.frames.back().triangles = of_frame;
    }
    if (more > 0) cloth.frames.back().x.conservativeResize(3, 6 + more);
    if (more > 0) cloth.frames.back().x.rightCols(more).setConstant(7);
    return cloth.missing(law("folds-never-pass-through"));
  };
  const std::vector<Triangle> whole = {{0, 1, 2}, {1, 3, 2}, {1, 0, 4}, {2, 3, 5}},
                              part = {{0, 1, 2}, {1, 3, 2}, {1, 0, 4}},
                              flipped = {{0, 1, 2}, {1, 2, 3}, {1, 0, 4}, {2, 3, 5}};
  CHECK(missing({whole}) == "a second frame");
  CHECK(missing({whole, whole}) == "");
  CHECK(missing({whole, part}) == "one oriented surface for all frames");
  CHECK(missing({whole, whole}, 1) == "one oriented surface for all frames");
  CHECK(missing({flipped, flipped}) == "one oriented surface for all frames");
  // another mesh than the case's, but the same in all frames
  std::vector<Triangle> turned = whole;
  for (Triangle& t : turned) std::swap(t[1], t[2]);
  CHECK(missing({turned, turned}) == "");
}

namespace {

/// Elastic cloth with rest lengths a little shorter, that starts bent and moving.
Case elastic() {
  Case of = sheet(
      "[gravity]\nacceleration = [1.7, -8.9, 2.3]\n[stretch]\nstiffness = 31\n"
      "[bending]\nstiffness = 2e-3\n");
  of.scene.stretch->rest_length_scale = 0.97;
  of.scene.x.row(2) = 0.2 * of.scene.x.row(0).array().square();
  of.scene.x.colwise() += Vector3(2, 0.7, -0.3);
  of.scene.v.colwise() += Vector3(0.3, 0.5, -0.2);
  return of;
}

/// Half the thickness of the sheet's tiles of each edge: a third of its triangles' areas, and Y
/// A/L0^2 of each spring, from the case's definition of Y.
double of_rounding(const Case& of, const PerParticle3& x, double rounding) {
  const TriangleMesh& mesh = of.scene.mesh;
  const double moved = 2 * std::sqrt(3.0) * rounding;
  const Eigen::VectorXd areas = edge_areas(mesh);
  double sum = 0;
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    const auto length = [&](const PerParticle3& at) {
      return (at.col(mesh.edges[e].a) - at.col(mesh.edges[e].b)).norm();
    };
    const double rest = length(mesh.rest), k = 31 * areas[Eigen::Index(e)] / (rest * rest);
    sum += k * std::abs(length(x) - 0.97 * rest) * moved + k * moved * moved / 2;
  }
  return sum;
}

}  // namespace

TEST_CASE("budget of energy: what is stored less the start's total, and what is allowed") {
  Frames cloth(elastic());
  for (const double t : {0.0, 0.1, 0.24, 0.31, 0.4}) {
    PerParticle3 x = cloth.of.scene.x;
    for (Eigen::Index i = 0; i < x.cols(); ++i)
      x.col(i) += Vector3(0.3, 0.8, -0.2) * std::sin(7 * t) * (1 + 0.1 * double(i));
    cloth.add(t, x);
  }
  const Table table = law("energy-stays-in-budget")(cloth.motion()).evidence;
  REQUIRE(table.rows() == 5);
  const System& system = cloth.built.system;
  const Energies start = energies(system, start_state(cloth.of.scene));
  const double total = start.kinetic + start.stretch + start.bending + start.gravity;
  CHECK(start.kinetic > 1e-5);
  double largest = 0;
  int above = 0;
  for (std::size_t k = 0; k < 5; ++k) {
    const PerParticle3& x = cloth.frames[k].x;
    const Energies now = energies(system, {0, x, PerParticle3::Zero(3, 12)});
    largest =
        std::max({largest, start.kinetic, std::abs(now.stretch - start.stretch),
                  std::abs(now.bending - start.bending), std::abs(now.gravity - start.gravity)});
    const double excess = now.stretch + now.bending + now.gravity - total;
    const double allowed = largest / 100 + of_rounding(cloth.of, x, rounding_of(cloth.frames));
    CHECK(table.numbers("time")[k] == cloth.frames[k].time);
    CHECK(table.numbers("potential less the start's total")[k] == exactly(excess));
    CHECK(table.numbers("allowed excess")[k] == exactly(allowed));
    CHECK(table.numbers("measured over allowed")[k] == exactly(excess > 0 ? excess / allowed : 0));
    above += excess > 0;
  }
  CHECK(above > 0);
  CHECK(above < 5);
  Frames slack(sheet("[gravity]\n"));  // without springs nothing is added for rounding
  slack.of.scene.v.setZero();
  slack.add(0, slack.of.scene.x.array() + 0.3);
  const Table fallen = law("energy-stays-in-budget")(slack.motion()).evidence;
  const double lifted = slack.built.system.mass.sum() * 9.80665 * 0.3;
  CHECK(fallen.numbers("allowed excess")[0] == exactly(lifted / 100));
  CHECK(law("energy-stays-in-budget")(slack.motion()).verdict.bound == 1);
  Frames driven(sheet("[[hold]]\nparticles = [0]\nvelocity = [0, 0, 1]\n"));
  driven.add(0, driven.of.scene.x);
  CHECK_THAT(driven.missing(law("energy-stays-in-budget")), Contains("prescribed particles do"));
}
