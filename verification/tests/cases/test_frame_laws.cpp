// Laws of frames placed by hand: the numbers of their evidence, their bounds, and what they need.
#include <Eigen/Geometry>

#include "verification/cases/frame_laws.h"
#include "verification/tests/cases/hand_made_frames.h"

using namespace foldproof;
using namespace foldproof::hand_made;
using Catch::Matchers::StartsWith;

namespace {

const std::vector<double> some_times = {0, 0.1, 0.24, 0.31};

const std::string weight = "[gravity]\nacceleration = [1, -8, 2]\n";
const std::string springs = "[stretch]\nstiffness = 31\n";
const std::string limits =
    springs + "[strain_limits]\nextension = 0.13\ncompression = 0.04\ntolerance = 0.003\n";

Case expecting(const std::string& more, const std::vector<Expectation>& expected) {
  Case of = sheet(more);
  of.expectations = expected;
  return of;
}

}  // namespace

TEST_CASE("laws of frames: each says what it needs of the case and of the frames") {
  struct Need {
    std::string law;
    Case of;
    std::vector<double> times;
    std::string needed;  // begins with this; "": nothing more
  };
  const std::vector<double> few = {0, 0.02, 0.04, 0.06, 0.08, 0.1, 0.12};
  Case weightless = sheet(weight), sticky = sheet(weight),
       stopping = sheet(weight + "[[hold]]\nparticles = [3]\n");
  weightless.scene.gravity = Vector3::Zero();
  sticky.scene.sticky.emplace_back();
  std::vector<Need> needs = {
      {"start-is-that-of-the-case", sheet(""), {0.01}, "a frame at t = 0"},
      {"prescribed-particles-follow", sheet(""), few, "prescribed particles:"},
      {"vertices-stay-outside", sheet(""), few, "objects:"},
      {"vertices-stay-outside", expecting(ball, {{"lies_inside", 1, ""}}), few, "a bound:"},
      {"touches-objects", expecting("", {{"makes_contact", 1, ""}}), few, "objects:"},
      {"touches-objects", expecting(ball, {{"sticks", 1, ""}}), few, "contact:"},
      {"springs-stay-within-limits", sheet(limits), few, ""},
      {"springs-stay-within-limits", sheet(springs), few, "a limit:"},
      {"folds-never-pass-through", sheet(""), {0}, "a second frame"},
      {"energy-stays-in-budget", sheet(driven), few, "a closed budget: prescribed"},
      {"motion-stays-in-budget", sheet(driven), few, "a closed budget: prescribed"},
      {"motion-stays-in-budget", sheet(""), {0, 0.1, 0.2}, ""},
      {"motion-stays-in-budget", sheet(""), {0, 0.1}, "three equally spaced frames"},
      {"motion-stays-in-budget", sheet(""), {0, 0.1, 0.205}, "three equally spaced frames"},
      {"motion-stays-in-budget", sheet(""), {0, 0.105, 0.205}, "three equally spaced frames"},
      {"motion-stays-in-budget", sheet(""), {0, 0.1, 0.205, 0.31}, ""},
      {"centre-falls-freely", sheet(weight), few, ""},
      {"centre-falls-freely", sheet(""), few, "gravity:"},
      {"centre-falls-freely", weightless, few, "gravity:"},
      {"centre-falls-freely", stopping, few, "free cloth: the case's [[hold]]"},
      {"centre-falls-freely", sticky, few, "free cloth: bonds"},
      {"centre-falls-freely", sheet(weight), {0.001, 0.021, 0.041}, "a frame at t = 0"},
      {"centre-falls-freely", sheet(weight), {0, 0.02}, "three frames before"},
      {"starts-as-fast-as-the-reference", stopping, few, ""},
      {"starts-as-fast-as-the-reference", stopping, {0}, "a second frame"},
      {"starts-as-fast-as-the-reference", stopping, {0.01, 0.03, 0.05}, "a frame at t = 0"},
      {"starts-as-fast-as-the-reference", sheet(weight), few, "a centre that its weight alone"},
      {"starts-as-fast-as-the-reference", sheet(weight + "[[hold]]\ntop = 1\n"), few, "free part"}};
  for (const char* key : {"makes_contact", "is_pinched", "lies_inside", "stays_between"})
    needs.push_back({"touches-objects", expecting(ball, {{key, 1, ""}}), few, ""});
  stopping.scene.schedule.step.fixed = 0.002, stopping.scene.schedule.max_steps = 2;
  needs.push_back(
      {"starts-as-fast-as-the-reference", stopping, few, "a reference that runs: it stops"});
  for (const auto& [name, of, times, needed] : needs) {
    const std::string missing = Frames(of, times).missing(law(name));
    CAPTURE(name, times.size(), needed);
    CHECK_THAT(missing, StartsWith(needed));
    CHECK(missing.empty() == needed.empty());
  }
  for (const char* name :
       {"start-is-that-of-the-case", "prescribed-particles-follow", "springs-stay-within-limits",
        "energy-stays-in-budget", "motion-stays-in-budget", "centre-falls-freely",
        "starts-as-fast-as-the-reference"}) {
    Frames other(sheet(weight), few);
    other.frames[0].triangles.pop_back();
    CHECK_THAT(other.missing(law(name)), StartsWith("the case's mesh"));
  }
}

TEST_CASE("laws of frames: the start is compared in mean edges, particle by particle") {
  Frames cloth(sheet(""));
  PerParticle3 x = cloth.of.scene.x;
  for (Eigen::Index i = 0; i < 12; ++i) x.col(i) += Vector3(1e-4, 2e-4, -2e-4) * double(i);
  cloth.add(0, x);
  const Finding finding = law("start-is-that-of-the-case")(cloth.motion());
  // 9 edges along x, 8 along y and 6 diagonals
  const double edge = (9 * 0.1 + 8 * 0.12 + 6 * std::hypot(0.1, 0.12)) / 23;
  REQUIRE(finding.evidence.rows() == 12);
  for (std::size_t i = 0; i < 12; ++i)
    CHECK(finding.evidence.numbers("distance from the case's start")[i] ==
          exactly(3e-4 * double(i) / edge));
  CHECK(finding.verdict.bound == 0.01);
}

TEST_CASE("laws of frames: frames that are missing at the end are counted") {
  const std::vector<std::pair<double, double>> rows = {{0.43, 3.5}, {0.487, 0.65}, {0.6, 0}};
  for (const auto& [last, missing] : rows) {
    const Frames cloth(sheet(""), {0, last});  // until 0.5 s, 50 frames per second
    const Verdict verdict = law("end-is-reached")(cloth.motion()).verdict;
    CHECK(verdict.measured == exactly(missing));
    CHECK(verdict.bound == 1);
  }
}

TEST_CASE("laws of frames: prescribed particles are compared with where they should be") {
  Frames cloth(sheet("[[hold]]\nparticles = [4, 7]\nvelocity = [0.3, 0.1, -0.2]\n"));
  for (std::size_t k = 0; k < some_times.size(); ++k) {
    PerParticle3 x = cloth.of.scene.x;
    x.colwise() += Vector3(0.3, 0.1, -0.2) * some_times[k];
    x.col(0) += Vector3(5, 5, 5);
    x.col(4) += Vector3(0.02, 0.03, 0.06) * double(k);
    x.col(7) += Vector3(0.01, 0.01, -0.02) * double(k);
    cloth.add(some_times[k], x);
  }
  const Finding finding = law("prescribed-particles-follow")(cloth.motion());
  CHECK(finding.evidence.numbers("time") == some_times);
  for (std::size_t k = 0; k < some_times.size(); ++k)
    CHECK(finding.evidence.numbers("largest distance from the prescribed place")[k] ==
          exactly(0.07 * double(k)));
  CHECK(finding.verdict.bound == exactly(2 * rounding_of(cloth.frames)));
}

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

TEST_CASE("laws of frames: contact is judged by the nearest vertex of any frame") {
  Frames cloth(expecting(ball, {{"makes_contact", 1, ""}}));
  for (const double z : {0.3, -0.03, 0.1, 0.4})  // of vertex 5, straight above the ball
    cloth.add(double(cloth.frames.size()), cloth.of.scene.x.colwise() + Vector3(0, 0, z));
  const Finding finding = law("touches-objects")(cloth.motion());
  for (std::size_t k = 0; k < 4; ++k)
    CHECK(finding.evidence.numbers("distance of the nearest vertex from an object")[k] ==
          exactly(cloth.frames[k].x(2, 5) + 0.1));
  CHECK(finding.verdict.measured == exactly(0.07));
  CHECK(finding.verdict.bound == exactly(radius_of_half_cells));
  cloth.frames[2].x(0, 3) = foldproof::nan;
  CHECK_THROWS_WITH(law("touches-objects")(cloth.motion()), StartsWith("frame 2: "));
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

TEST_CASE("folds: one oriented surface and two frames are needed") {
  const auto is_offered = [](const std::vector<std::vector<Triangle>>& triangles, int more = 0) {
    Frames cloth(three_pieces());
    for (const std::vector<Triangle>& of_frame : triangles) {
      cloth.add(0.1 * double(cloth.frames.size()), flaps(10, 20));
      cloth.frames.back().triangles = of_frame;
    }
    if (more > 0) cloth.frames.back().x = PerParticle3::Constant(3, 6 + more, 7);
    return cloth.missing(law("folds-never-pass-through")).empty();
  };
  const std::vector<Triangle> part = {{0, 1, 2}, {1, 3, 2}, {1, 0, 4}},
                              flipped = {{0, 1, 2}, {1, 2, 3}, {1, 0, 4}, {2, 3, 5}},
                              turned = {{0, 2, 1}, {1, 2, 3}, {1, 4, 0}, {2, 5, 3}};
  CHECK(is_offered({pieces, pieces}));
  CHECK(!is_offered({pieces}));
  CHECK(!is_offered({pieces, part}));
  CHECK(!is_offered({pieces, pieces}, 1));
  CHECK(!is_offered({flipped, flipped}));
  CHECK(is_offered({turned, turned}));  // another mesh than the case's, the same in all frames
}

TEST_CASE("budget of energy: what is stored less the start's total, and what is allowed") {
  Case of = sheet("[gravity]\n[stretch]\nstiffness = 31\n[bending]\nstiffness = 2e-3\n");
  of.scene.stretch->rest_length_scale = 0.97;
  of.scene.x.row(2) = 0.2 * of.scene.x.row(0).array().square();
  of.scene.v.colwise() += Vector3(0.3, 0.5, -0.2);
  Frames cloth(of);
  // stretched at rest and lifted; still; and lower, where it has less energy than at the start
  cloth.add(0, 1.1 * of.scene.mesh.rest + PerParticle3::Constant(3, 12, 2));
  cloth.add(0.1, of.scene.x), cloth.add(0.2, of.scene.x - PerParticle3::Constant(3, 12, 1));
  const Finding finding = law("energy-stays-in-budget")(cloth.motion());
  const auto column = [&](const char* name) { return finding.evidence.numbers(name); };
  const Energies start = energies(cloth.built.system, start_state(of.scene));
  const double M = cloth.built.system.mass.sum(), lifted = M * 9.80665 * (2 + 0.1 * 0.12);
  const double stretched = 3 * 31 * (0.13 / 0.97) * (0.13 / 0.97) / 2 * 0.3 * 0.24;
  CHECK(column("potential less the start's total")[0] ==
        Approx(lifted + stretched * 0.97 * 0.97 - start.kinetic - start.stretch - start.bending));
  // an elongation of 0.13 L of each spring of Y A/L^2, whose ends are rounded
  const Eigen::ArrayXd rest = rest_lengths(of.scene.mesh), areas = edge_areas(of.scene.mesh);
  const double moved = 2 * std::sqrt(3.0) * rounding_of(cloth.frames);
  const double rounding =
      (31 * areas / rest.square() * (0.13 * rest * moved + moved * moved / 2)).sum();
  CHECK(column("allowed excess")[0] == exactly(lifted / 100 + rounding));
  CHECK(column("measured over allowed")[0] > 10);
  CHECK(column("potential less the start's total")[1] == exactly(-start.kinetic));
  CHECK(column("measured over allowed")[2] == 0);
  CHECK(finding.verdict.bound == 1);
}
