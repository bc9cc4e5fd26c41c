// Laws of frames placed by hand: the numbers of their evidence, their bounds, and what they need.
#include <Eigen/Geometry>

#include "verification/cases/frame_laws.h"
#include "verification/cases/judged_frames.h"
#include "verification/tests/cases/hand_made_frames.h"

using namespace foldproof;
using namespace foldproof::hand_made;
using Catch::Matchers::StartsWith;

namespace {

const std::vector<double> some_times = {0, 0.1, 0.24, 0.31};

const std::string springs = "[stretch]\nstiffness = 31\n";
const std::string limits =
    springs + "[strain_limits]\nextension = 0.13\ncompression = 0.04\ntolerance = 0.003\n";

Case expecting(const std::string& more, const std::vector<Expectation>& expected) {
  Case of = sheet(more);
  of.expectations = expected;
  return of;
}

}  // namespace

TEST_CASE("laws of frames: crossings are bounded by those of the case's start") {
  Case flat = sheet(""), tangled = flat;
  tangled.scene.x = crossed(tangled.scene.x);
  double crossings = 0;
  for (const Case& of : {flat, tangled}) {
    Frames cloth(of);
    cloth.add(0.1, flat.scene.x), cloth.add(0.3, tangled.scene.x);
    const Finding finding = law("never-cross-themselves")(cloth.motion());
    crossings = finding.evidence.numbers("crossings")[1];
    CHECK(finding.evidence.numbers("crossings")[0] == 0);
    CHECK(crossings > 0);
    CHECK(finding.verdict.measured == crossings);
    CHECK(finding.verdict.bound == (of.scene.x == flat.scene.x ? 0 : crossings));
    cloth.frames[0].x(1, 4) = foldproof::nan;
    CHECK(std::isnan(law("never-cross-themselves")(cloth.motion()).verdict.measured));
  }
}

TEST_CASE("laws of frames: depths in objects are bounded by the case, or by the triangles") {
  const std::vector<std::pair<std::vector<Expectation>, double>> rows = {
      {{}, radius_of_half_cells / 10},
      {{{"stays_outside", 0.037, "so it is"}}, 0.037},
      {{{"lies_inside", 1, ""}, {"stays_outside", 0.02, "w"}}, 0.02}};
  for (const auto& [expected, bound] : rows) {
    Frames cloth(expecting(ball, expected), some_times);
    for (std::size_t k = 0; k < 4; ++k) cloth.frames[k].x.row(2).array() -= 0.06 * double(k);
    const Finding finding = law("vertices-stay-outside")(cloth.motion());
    const std::vector<double> depths = finding.evidence.numbers("depth of the deepest vertex");
    CHECK(depths[1] == 0);
    CHECK(depths[2] == exactly(0.02));  // of vertex 5, straight above the ball
    CHECK(finding.verdict.measured == exactly(0.08));
    CHECK(finding.verdict.bound == exactly(bound + 2 * rounding_of(cloth.frames)));
    CHECK_THAT(finding.verdict.why_bound, StartsWith(expected.empty() ? "empirical" : "of the"));
  }
}

TEST_CASE("laws of frames: strains beyond a limit, and the rounding added to the tolerance") {
  const std::vector<std::pair<std::vector<Expectation>, double>> rows = {
      {{}, 0.003}, {{{"stays_within_strain_limits", 0.07, "so it is"}}, 0.07}};
  for (const auto& [expected, bound] : rows) {
    Frames cloth(expecting(limits, expected));
    for (const double scale : {1.05, 1.3, 0.94}) cloth.add(scale, scale * cloth.of.scene.x);
    const Finding finding = law("springs-stay-within-limits")(cloth.motion());
    const std::vector<double> beyond = finding.evidence.numbers("strain beyond a limit");
    CHECK(beyond[0] == exactly(0));
    CHECK(beyond[1] == exactly(0.17));
    CHECK(beyond[2] == exactly(0.02));
    CHECK(finding.verdict.bound == exactly(bound + 2 * rounding_of(cloth.frames) / 0.1));
    CHECK_THAT(finding.verdict.why_bound,
               StartsWith(expected.empty() ? "the case's own" : "of the case: so it is"));
  }
}

namespace {

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

const std::vector<Triangle> pieces = {{0, 1, 2}, {1, 3, 2}, {1, 0, 4}, {2, 3, 5}};

Case three_pieces() {
  Case of = sheet("");
  of.scene = scene_at_rest(make_triangle_mesh(flaps(0, 0), pieces), 0.2);
  return of;
}

/// The law's finding for these turns of the two flaps.
Finding folds(const std::vector<std::pair<double, double>>& turns) {
  Frames cloth(three_pieces());
  for (std::size_t k = 0; k < turns.size(); ++k)
    cloth.add(0.1 + 0.07 * double(k), flaps(turns[k].first, turns[k].second));
  return law("folds-never-pass-through")(cloth.motion());
}

void check_fold(const Finding& finding, double measured, double uncertainty, Outcome outcome) {
  CHECK(finding.verdict.measured == exactly(measured));
  CHECK(finding.verdict.uncertainty == exactly(uncertainty));
  CHECK(outcome_of(finding.verdict) == outcome);
}

}  // namespace

TEST_CASE("folds: a jump is as uncertain as the other hinges are fast, and the clearest counts") {
  const Finding calm = folds({{10, -20}, {70, 60}, {20, 61}});
  const char *largest = "largest change of a hinge's angle", *seen = "fastest turn of other hinges";
  for (const char* column : {largest, seen}) {
    CHECK(calm.evidence.numbers(column)[0] == exactly(80));
    CHECK(calm.evidence.numbers(column)[1] == exactly(50));
  }
  CHECK(calm.verdict.bound == 180);
  check_fold(calm, 80, 0, Outcome::holds);
  const Finding jumped = folds({{170, 30}, {-165, 47}, {-160, 50}});
  CHECK(jumped.evidence.numbers(largest)[0] == exactly(335));
  CHECK(jumped.evidence.numbers(seen)[0] == exactly(17));
  check_fold(jumped, 335, 17, Outcome::fails);
  // the larger jump comes with a faster turn, before or after the smaller one
  check_fold(folds({{170, 10}, {-170, 130}, {-120, 130}, {120, 138}}), 240, 8, Outcome::fails);
  check_fold(folds({{-120, 130}, {120, 138}, {170, 10}, {-170, 130}}), 240, 8, Outcome::fails);
  // one that goes on as it turned before and turns afterwards only looks like a jump
  check_fold(folds({{173, 0}, {106, 0}, {-78, 0}, {-89, 9}}), 67, 0, Outcome::holds);
  check_fold(folds({{-30, 0}, {106, 0}, {-78, 0}, {-9, 9}}), 184, 0, Outcome::fails);
  // a jump hardly larger than the other hinge's turn says nothing
  check_fold(folds({{-100, -90}, {80.4, 89.9}}), 180.4, 179.9, Outcome::inconclusive);
}

TEST_CASE("evidence of frames: rest is judged by the energies of the frames' differences") {
  Case of = sheet("");
  of.expectations = {{"comes_to_rest", 0.5, "w"}};
  Frames cloth(of);
  const std::vector<double> heights = {0, 1, 3, 3.5, 3.7};
  for (std::size_t k = 0; k < heights.size(); ++k)
    cloth.add(0.1 * double(k), of.scene.x.array() + heights[k]);
  // differences over neighbours: 1, 1.5, 1.25, 0.35, 0.2 a frame
  CHECK(judge_frames(cloth.of, cloth.built, cloth.frames).records.back().finding.verdict.measured ==
        exactly(0.04 / 2.25));
}
