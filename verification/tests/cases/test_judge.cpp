// The judge of a case, its repetition, its shapes, and quantities of folds, wrinkles and sticking.
#include <catch2/catch.hpp>

#include "reference/bodies/level_set_provider.h"
#include "reference/mesh/shapes.h"
#include "verification/cases/folds.h"
#include "verification/cases/judge.h"

using namespace foldproof;
using Catch::Matchers::Contains;

namespace {

Approx exactly(double value) { return Approx(value).epsilon(1e-10).margin(1e-14); }

Scene moving_sheet() {
  return read_scene_text(
      R"(
cloth = { shape = "sheet", width = 0.3, height = 0.24, columns = 3, rows = 2, density = 0.17 }
stretch = { stiffness = 31 }
start = { velocity = [0.3, 0.1, -0.2] }
time = { end = 0.5, frames_per_second = 20, step = 0.005 }
)",
      "judge.toml");
}

/// Runs from `start` to `end`; damages rows of diagnostics; the first belongs to the start
/// and has number 0, on their way to the repetition, and then adds `more` rows.
double differing(const std::function<void(Diagnostics&, int)>& damage, double start = 0,
                 double end = 0.5, int more = 0) {
  Scene scene = moving_sheet();
  scene.schedule.end = end;
  State from = start_state(scene);
  from.time = start;
  Repetition repetition(scene, computing_provider());
  Diagnostics latest;
  int number = 0;
  simulate(build_system(scene), integrator_named(scene.integrator), from, scene.schedule,
           {{},
            [&](const Diagnostics& row) {
              latest = row;
              damage(latest, number++);
              repetition.record(latest);
            },
            [&](const Checkpoint& at) { repetition.record(at); }});
  for (int k = 0; k < more; ++k) repetition.record(latest);
  return repetition.count_differing_steps();
}

/// How many of the rows with numbers from `first` to `last` are repeated.
double repeated(int first, int last, double start = 0, double end = 0.5) {
  const auto damage = [=](Diagnostics& row, int number) {
    if (number >= first && number <= last) row.energy.kinetic *= 1 + 1e-15;
  };
  return differing(damage, start, end);
}

}  // namespace

TEST_CASE("repetition: ten steps after the start, the middle and the last frame but one") {
  const auto intact = [](Diagnostics&, int) {};
  CHECK(differing(intact) == 0);
  CHECK(differing([](Diagnostics& row, int) { row.seconds = 99; }) == 0);
  CHECK(differing([](Diagnostics& row, int) { row.angular_momentum[2] += 1e-9; }) == 30);
  // 10 frames of 10 steps: frames 0, 5 and 9
  for (const int first : {1, 51, 91}) {
    CHECK(repeated(first, first) == 1);
    CHECK(repeated(first + 9, first + 9) == 1);
  }
  CHECK(repeated(11, 50) == 0);
  CHECK(repeated(61, 90) == 0);
  CHECK(differing(intact, 0, 0.005) == 0);  // a single step is enough
  const Scene scene = moving_sheet();
  CHECK(std::isnan(Repetition(scene, computing_provider()).count_differing_steps()));
}

TEST_CASE("repetition: frames are counted from the start of the run, and missing rows differ") {
  // five frames and a short one: frames 0, 3 and 5; the last has six steps
  CHECK(repeated(1, 10, 0.2, 0.48) == 10);
  CHECK(repeated(11, 30, 0.2, 0.48) == 0);
  CHECK(repeated(31, 40, 0.2, 0.48) == 10);
  CHECK(repeated(41, 50, 0.2, 0.48) == 0);
  CHECK(repeated(51, 56, 0.2, 0.48) == 6);
  const auto intact = [](Diagnostics&, int) {};
  CHECK(differing(intact, 0.2, 0.48, 3) == 3);
  CHECK(differing(intact, 0.2, 0.48, 99) == 4);
}

namespace {

/// The judge of these expectations, after frames that were moved by 3, 8 and 5 mm.
std::vector<Record> judged(const std::vector<Expectation>& expectations, bool stops = false) {
  Case of{moving_sheet(), expectations};
  of.scene.title = "a title";
  CaseJudge judge(of, {}, computing_provider());
  RunResult result;
  result.last = start_state(of.scene);
  for (const double way : {3e-3, 8e-3, 5e-3}) {
    State s = start_state(of.scene);
    s.x.row(1).array() += way;
    judge.record(s);
  }
  result.steps = 23;
  if (stops) result.stop = Stop{"it tears", 0.125, 7, 4};
  return judge.records(result);
}

}  // namespace

TEST_CASE("judge: each expectation has a record, with the largest value of all frames") {
  const std::vector<Record> records = judged({{"keeps_its_place", 0.009, "why so"},
                                              {"takes_steps", 20, "many"},
                                              {"is_carried", 0.01, "far"},
                                              {"is_carried", 0.01, "far", "not here"},
                                              {"lengthens_by", 0.5, "w"}});
  const std::vector<double> measured = {8e-3, -3, 2e-3, foldproof::nan, 0.5};
  const std::vector<std::string> units = {"m", "steps short of 20", "m short of 0.01",
                                          "m short of 0.01", "short of 0.5"};
  const std::vector<Outcome> outcomes = {Outcome::holds, Outcome::holds, Outcome::fails,
                                         Outcome::not_applicable, Outcome::fails};
  for (std::size_t k = 0; k < records.size(); ++k) {
    const Verdict& verdict = records[k].finding.verdict;
    if (k == 3)
      CHECK(std::isnan(verdict.measured));
    else
      CHECK(verdict.measured == exactly(measured[k]));
    CHECK(verdict.bound == (k == 0 ? 0.009 : 0));
    CHECK(verdict.unit == units[k]);
    CHECK(records[k].outcome == outcomes[k]);
  }
  CHECK(records[0].name == "case.judge.keeps-its-place");
  CHECK_THAT(records[1].finding.note, Contains("reached 23 steps"));
  CHECK(records[3].finding.note == "not here");
}

TEST_CASE("judge: of a run that stopped only its end is known") {
  const std::vector<Record> records = judged(
      {{"runs_to_its_end", 0, "w"}, {"keeps_its_place", 1, "w"}, {"takes_steps", 2, "w"}}, true);
  CHECK(records[0].finding.verdict.measured == 1);
  for (const std::size_t k : {1u, 2u}) CHECK(std::isnan(records[k].finding.verdict.measured));
  for (const Record& record : records) {
    CHECK(record.outcome == Outcome::fails);
    CHECK_THAT(record.finding.note, Contains("it tears (step 7, after t = 0.125 s, particle 4)"));
  }
  CHECK(describe({"it tears", 0.125, 7, -1}) == "it tears (step 7, after t = 0.125 s)");
  CHECK_THAT(describe({"it tears", 0.125, 7, 0}), Contains("particle 0"));
}

namespace {

/// A grid of cells 0.1 m wide and high, turned at the lines x = 0.1, 0.2, ... [degrees].
struct Folded {
  Scene scene;
  RunResult result;
  DiagnosticsSummary summary;
  Repetition repetition{scene, computing_provider()};

  explicit Folded(const std::vector<double>& turns, int rows = 4)
      : scene(scene_at_rest(make_sheet({SheetPattern::one_diagonal, 0.1 * double(turns.size() + 1),
                                        0.1 * rows, int(turns.size() + 1), rows}),
                            0.2)) {
    scene.bending = BendingMaterial{1};
    scene.rest_angles.assign(scene.mesh.hinges.size(), 0);
    result.last = start_state(scene);
    std::vector<Vector3> line = {Vector3(0, 0, 0), Vector3(0.1, 0, 0)};
    double angle = 0;
    for (const double turn : turns) {
      angle += turn * pi / 180;
      line.push_back(line.back() + 0.1 * Vector3(std::cos(angle), 0, std::sin(angle)));
    }
    for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
      const auto column = std::size_t(std::lround(scene.x(0, i) / 0.1));
      result.last.x.col(i) = line[column] + Vector3(0, scene.x(1, i), 0);
    }
  }
  /// The hinges above y are at rest as they are, times `factor`.
  void rest_above(double y, double factor = 1) {
    const std::vector<double> angles = hinge_angles(scene.mesh, result.last.x);
    for (std::size_t h = 0; h < angles.size(); ++h) {
      const auto& p = scene.mesh.hinges[h].particles;
      if (scene.x(1, p[2]) + scene.x(1, p[3]) > 2 * y) scene.rest_angles[h] = factor * angles[h];
    }
  }
  double value(const char* key) const {
    return find_quantity(key)->of_run({scene, summary, result, repetition});
  }
};

}  // namespace

TEST_CASE("fold spectrum: shares of the hinges' rest length, by the band of their angle") {
  const Folded cloth({3, -4.9, 5.1, 14.9, -15.1, 60, 89.9, -90.1}, 1);
  PerParticle3 x = cloth.result.last.x;
  const TriangleMesh& mesh = cloth.scene.mesh;
  const double all = 8 + 9 * std::sqrt(2.0);  // diagonals stay flat
  const FoldSpectrum shares = fold_spectrum(mesh, x);
  const std::vector<double> lengths = {9 * std::sqrt(2.0) + 2, 2, 1, 2, 1};
  for (std::size_t b = 0; b < 5; ++b) CHECK(shares[b] == exactly(lengths[b] / all));
  x(0, 3) = foldproof::nan;
  for (const double fraction : fold_spectrum(mesh, x)) CHECK(std::isnan(fraction));
  const TriangleMesh one = make_triangle_mesh(PerParticle3::Identity(3, 3), {{0, 1, 2}});
  CHECK(fold_spectrum(one, one.rest) == FoldSpectrum{});
}

TEST_CASE("wrinkles: creases are lines of three turned hinges, each to its side") {
  Folded cloth({20.5, -12, -25, 19.9, 12, 0, 30, 0});
  CHECK(cloth.value("forms_creases") == 3);
  // middles of hinges at y = 0.05, ... along x = 0.1 and 0.7, and the valley along x = 0.3
  CHECK(cloth.value("wrinkles_stay_short") == exactly(2 * (4 * 0.2 + 4 * 0.4 + 4 * 0.2) / 12));
  for (const double side : {1, -1}) {
    const Folded ridges({21 * side, 0, 0, -19.9 * side, 0, 0, 30 * side, 30 * side});
    CHECK(ridges.value("forms_creases") == 3);
    CHECK(std::isnan(ridges.value("wrinkles_stay_short")));
  }
  const std::vector<double> turns = {-30, 0, 0, 40, 0, 0, 0, -30};
  CHECK(Folded(turns, 3).value("wrinkles_stay_short") == exactly(2 * (0.3 + 0.3 + 0.4) / 3));
  CHECK(Folded(turns, 2).value("forms_creases") == 0);
  cloth.result.last.x(2, 4) = foldproof::nan;
  CHECK(std::isnan(cloth.value("forms_creases")));
}

TEST_CASE("wrinkles: turns are from the rest angles, the shorter way") {
  Folded cloth({170, 0, 0, 0, 0, 0, 0, 0});
  CHECK(cloth.value("forms_creases") == 1);
  cloth.rest_above(0.31);  // one of four hinges
  CHECK(cloth.value("forms_creases") == 1);
  cloth.rest_above(0.21);
  CHECK(cloth.value("forms_creases") == 0);
  cloth.rest_above(0, -175.0 / 170);  // 15 degrees away
  CHECK(cloth.value("forms_creases") == 0);
}

TEST_CASE("sticking: stuck particles, their slack, and how far the cloth is lifted") {
  Folded cloth({0, 0, 0});
  StickyPatch patch;
  patch.triangles = {{0, 1, 2}};
  patch.place = [](double) {
    return PerParticle3((PerParticle3(3, 3) << 0, 1, 0, 0, 0, 1, 0, 0, 0).finished());
  };
  patch.velocity = [](double) { return PerParticle3(PerParticle3::Zero(3, 3)); };
  patch.stiffness = 3, patch.near = 0.1, patch.far = 9, patch.particles = {4, 7, 9};
  cloth.scene.sticky = {patch};
  State s = start_state(cloth.scene);
  const auto value = [&](const char* key) {
    return value_at(*find_quantity(key), cloth.scene, {}, s);
  };
  CHECK(value("sticks") == 0);
  CHECK(value("keeps_hold") == 0);
  s.bonds = {{0, 0, 4, {0.2, 0.3, 0.05}}, {0, 0, 9, {0.4, 0.1, 0.02}}};
  s.x.col(4) = Vector3(0.22, 0.33, 0.11), s.x.col(9) = Vector3(0.41, 0.1, 0.02);
  CHECK(value("sticks") == 2);
  CHECK(value("keeps_hold") == exactly(0.07));
  cloth.result.last = s;
  CHECK(cloth.value("lets_go") == 2);
}
