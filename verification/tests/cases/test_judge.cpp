// The judge of a case, its repetition, its shapes, and quantities of folds, wrinkles and sticking.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "reference/bodies/level_set_provider.h"
#include "reference/mesh/shapes.h"
#include "verification/cases/folds.h"
#include "verification/cases/judge.h"

using namespace foldproof;

namespace {

Approx exactly(double value) { return Approx(value).epsilon(1e-10).margin(1e-14); }

const std::string text = R"([cloth]
shape = "sheet"
width = 0.3
height = 0.24
columns = 3
rows = 2
density = 0.17
[stretch]
stiffness = 31
[start]
velocity = [0.3, 0.1, -0.2]
[time]
end = 0.5
frames_per_second = 20
step = 0.005
)";

/// Runs the case; damages some rows of diagnostics on their way to the repetition.
double differing(const std::function<void(Diagnostics&)>& damage) {
  const Scene scene = read_scene_text(text, "judge.toml");
  Repetition repetition(scene, computing_provider());
  simulate(build_system(scene), integrator_named(scene.integrator), start_state(scene),
           scene.schedule,
           {{},
            [&](const Diagnostics& row) {
              Diagnostics changed = row;
              damage(changed);
              repetition.record(changed);
            },
            [&](const Checkpoint& at) { repetition.record(at); }});
  return repetition.count_differing_steps();
}

/// How many of the rows that end at these steps, counted from 1, are repeated.
double repeated(const std::vector<int>& steps) {
  return differing([&](Diagnostics& row) {
    for (const int step : steps)
      if (std::abs(row.time - 0.005 * step) < 1e-6) row.energy.kinetic *= 1 + 1e-15;
  });
}

}  // namespace

TEST_CASE("repetition: ten steps after the start, the middle and the last frame but one") {
  CHECK(differing([](Diagnostics&) {}) == 0);
  CHECK(differing([](Diagnostics& row) { row.seconds = 99; }) == 0);
  CHECK(differing([](Diagnostics& row) { row.angular_momentum[2] += 1e-9; }) == 30);
  // 10 frames of 10 steps: frames 0, 5 and 9
  CHECK(repeated({1, 10}) == 2);
  CHECK(repeated({51, 60}) == 2);
  CHECK(repeated({91, 100}) == 2);
  CHECK(repeated({11, 20, 41, 50, 61, 81, 90}) == 0);
  const Scene scene = read_scene_text(text, "judge.toml");
  CHECK(std::isnan(Repetition(scene, computing_provider()).count_differing_steps()));
}

TEST_CASE("repetition: a single step is enough to compare") {
  const Scene scene = read_scene_text(text, "judge.toml");
  Repetition repetition(scene, computing_provider());
  bool is_start = true;
  simulate(build_system(scene), integrator_named(scene.integrator), start_state(scene),
           scene.schedule,
           {{},
            [&](const Diagnostics& row) {
              if (std::abs(row.time - 0.005) < 1e-9) repetition.record(row);
            },
            [&](const Checkpoint& at) {
              if (is_start) repetition.record(at);
              is_start = false;
            }});
  CHECK(repetition.count_differing_steps() == 0);
}

TEST_CASE("repetition: frames are counted from the start of the run, and missing rows differ") {
  Scene scene = read_scene_text(text, "judge.toml");
  scene.schedule.end = 0.48;  // five frames and a short one
  State start = start_state(scene);
  start.time = 0.2;
  const auto count = [&](int first, int last, int more) {
    Repetition repetition(scene, computing_provider());
    int step = 0;
    Diagnostics latest;
    simulate(build_system(scene), integrator_named(scene.integrator), start, scene.schedule,
             {{},
              [&](const Diagnostics& row) {
                latest = row;
                if (step >= first && step <= last) latest.energy.stretch += 1e-9;
                ++step;
                repetition.record(latest);
              },
              [&](const Checkpoint& at) { repetition.record(at); }});
    for (int k = 0; k < more; ++k) repetition.record(latest);
    return repetition.count_differing_steps();
  };
  CHECK(count(-1, -1, 0) == 0);
  CHECK(count(11, 30, 0) == 0);
  CHECK(count(41, 50, 0) == 0);
  CHECK(count(31, 40, 0) == 10);
  CHECK(count(1, 10, 0) == 10);
  CHECK(count(51, 56, 0) == 6);  // the last frame has six steps
  CHECK(count(-1, -1, 3) == 3);
  CHECK(count(-1, -1, 99) == 4);
}

namespace {

/// The judge of these expectations, after frames that were moved by 3, 8 and 5 mm.
std::vector<Record> judged(const std::vector<Expectation>& expectations, bool stops) {
  Case of{read_scene_text(text, "judge.toml"), expectations};
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
                                              {"is_carried", 0.01, "far", "not here"}},
                                             false);
  REQUIRE(records.size() == 4);
  CHECK(records[0].name == "case.judge.keeps-its-place");
  CHECK(records[0].kind == "check");
  CHECK(records[0].source == "a title");
  CHECK(records[0].claim == find_quantity("keeps_its_place")->claim);
  CHECK(records[0].outcome == Outcome::holds);
  CHECK(records[0].finding.note == "");
  const Verdict& place = records[0].finding.verdict;
  CHECK(place.measured == exactly(8e-3));
  CHECK(place.bound == 0.009);
  CHECK(place.uncertainty == 0);
  CHECK(place.unit == "m");
  CHECK(place.why_bound == "why so");
  const Verdict& steps = records[1].finding.verdict;
  CHECK(steps.measured == -3);
  CHECK(steps.bound == 0);
  CHECK(steps.unit == "steps short of 20");
  CHECK(steps.why_bound == "many");
  CHECK(records[1].finding.note == "reached 23 steps; measured is what is missing from 20");
  CHECK(records[2].outcome == Outcome::fails);
  CHECK(records[2].finding.verdict.measured == exactly(2e-3));
  CHECK(records[2].finding.verdict.unit == "m short of 0.01");
  CHECK(records[3].outcome == Outcome::not_applicable);
  CHECK(records[3].finding.note == "not here");
  CHECK(std::isnan(records[3].finding.verdict.measured));
}

TEST_CASE("judge: rows and checkpoints of a run are for its energies and its repetition") {
  const Case of{read_scene_text(text, "judge.toml"),
                {{"is_reproducible", 0, "w"},
                 {"speed_is_limited", 9, "w"},
                 {"linear_momentum_is_conserved", 1e-9, "w"}}};
  CaseJudge judge(of, {}, computing_provider());
  const RunResult result = simulate(
      build_system(of.scene), integrator_named(of.scene.integrator), start_state(of.scene),
      of.scene.schedule,
      {[&](const State& s) { judge.record(s); }, [&](const Diagnostics& row) { judge.record(row); },
       [&](const Checkpoint& at) { judge.record(at); }});
  const std::vector<Record> records = judge.records(result);
  CHECK(records[0].finding.verdict.measured == 0);
  CHECK(records[1].finding.verdict.measured == exactly(Vector3(0.3, 0.1, -0.2).norm()));
  CHECK(records[2].finding.verdict.measured < 1e-12);
  for (const Record& record : records) CHECK(record.outcome == Outcome::holds);
}

TEST_CASE("judge: a bound without a unit says what it is short of") {
  const Record record = judged({{"lengthens_by", 0.5, "w"}}, false).at(0);
  CHECK(record.finding.verdict.unit == "short of 0.5");
}

TEST_CASE("judge: of a run that stopped only its end is known") {
  const std::vector<Record> records = judged(
      {{"runs_to_its_end", 0, "w"}, {"keeps_its_place", 1, "w"}, {"takes_steps", 2, "w"}}, true);
  CHECK(records[0].finding.verdict.measured == 1);
  CHECK(records[0].outcome == Outcome::fails);
  for (const std::size_t k : {1u, 2u}) {
    CHECK(std::isnan(records[k].finding.verdict.measured));
    CHECK(records[k].outcome == Outcome::fails);
  }
  for (const Record& record : records)
    CHECK(record.finding.note ==
          "the run stopped: it tears (step 7, after t = 0.125 s, particle 4)");
  CHECK(describe({"it tears", 0.125, 7, -1}) == "it tears (step 7, after t = 0.125 s)");
  CHECK(describe({"it tears", 0.125, 7, 0}) == "it tears (step 7, after t = 0.125 s, particle 0)");
}

TEST_CASE("fold spectrum: shares of the hinges' rest length, by the band of their angle") {
  // five strips of one metre along x, joined along y; the joints are of equal length
  const auto folded = [](const std::vector<double>& turns) {
    PerParticle3 x(3, 2 * int(turns.size()) + 4);
    Vector3 at(0, 0, 0);
    double angle = 0;
    for (Eigen::Index k = 0; k < x.cols() / 2; ++k) {
      x.col(2 * k) = at, x.col(2 * k + 1) = at + Vector3(0, 1, 0);
      if (k > 0 && std::size_t(k - 1) < turns.size()) angle += turns[std::size_t(k - 1)] * pi / 180;
      at += Vector3(std::cos(angle), 0, std::sin(angle));
    }
    return x;
  };
  const std::vector<double> turns = {3, -4.9, 5.1, 14.9, -15.1, 60, 89.9, -90.1};
  std::vector<Triangle> triangles;
  for (int k = 0; k < 9; ++k)
    triangles.push_back({2 * k, 2 * k + 2, 2 * k + 1}),
        triangles.push_back({2 * k + 2, 2 * k + 3, 2 * k + 1});
  const TriangleMesh mesh = make_triangle_mesh(folded(std::vector<double>(8, 0)), triangles);
  PerParticle3 x = folded(turns);
  const double joints = 8, all = joints + 9 * std::sqrt(2.0);  // diagonals stay flat
  const FoldSpectrum shares = fold_spectrum(mesh, x);
  CHECK(shares[0] == exactly((9 * std::sqrt(2.0) + 2) / all));
  CHECK(shares[1] == exactly(2 / all));
  CHECK(shares[2] == exactly(1 / all));
  CHECK(shares[3] == exactly(2 / all));
  CHECK(shares[4] == exactly(1 / all));
  CHECK(fold_spectrum(mesh, 1.7 * x)[3] == exactly(2 / all));  // weighted with rest lengths
  const TriangleMesh tiny = make_triangle_mesh(0.01 * mesh.rest, triangles);
  CHECK(fold_spectrum(tiny, x)[3] == exactly(2 / all));
  x(0, 3) = foldproof::nan;
  for (const double share : fold_spectrum(mesh, x)) CHECK(std::isnan(share));
  const TriangleMesh one = make_triangle_mesh(
      x.leftCols(3).array() * 0 + PerParticle3::Identity(3, 3).array(), {{0, 1, 2}});
  CHECK(fold_spectrum(one, one.rest) == FoldSpectrum{});
}

namespace {

/// A grid of 9 columns of cells, folded along lines of constant x.
struct Folded {
  Scene scene;
  RunResult result;
  DiagnosticsSummary summary;
  Repetition repetition{scene, computing_provider()};

  explicit Folded(int rows = 4)
      : scene(scene_at_rest(make_sheet({SheetPattern::one_diagonal, 0.9, 0.1 * rows, 9, rows}),
                            0.2)) {
    scene.bending = BendingMaterial{1};
    scene.rest_angles.assign(scene.mesh.hinges.size(), 0);
    result.last = start_state(scene);
  }
  /// Turns at the lines x = 0.1, 0.2, ... 0.8 [degrees].
  void fold(const std::vector<double>& turns) {
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
  double value(const char* key) const {
    return find_quantity(key)->of_run({scene, summary, result, repetition});
  }
};

}  // namespace

TEST_CASE("wrinkles: creases are lines of turned hinges, each to its side") {
  Folded cloth;
  cloth.fold({20.5, -12, -25, 19.9, 12, 0, 30, 0});
  CHECK(cloth.value("forms_creases") == 3);
  // middles of hinges at y = 0.05, ... along x = 0.1 and 0.7, and the valley along x = 0.3
  CHECK(cloth.value("wrinkles_stay_short") == exactly(2 * (4 * 0.2 + 4 * 0.4 + 4 * 0.2) / 12));
  cloth.fold({21, 0, 0, 19.9, 0, 0, 30, 0});
  CHECK(cloth.value("forms_creases") == 2);
  CHECK(std::isnan(cloth.value("wrinkles_stay_short")));
  cloth.fold({-21, 0, 0, 19.9, 0, 0, -30, -30});
  CHECK(cloth.value("forms_creases") == 3);
  CHECK(std::isnan(cloth.value("wrinkles_stay_short")));
  cloth.result.last.x(2, 4) = foldproof::nan;
  CHECK(std::isnan(cloth.value("forms_creases")));
}

TEST_CASE("wrinkles: turns are from the rest angles, and creases have three hinges") {
  Folded cloth;
  cloth.fold({30, 0, 0, 0, 0, 0, 0, 0});
  for (std::size_t h = 0; h < cloth.scene.mesh.hinges.size(); ++h) {
    const auto& p = cloth.scene.mesh.hinges[h].particles;
    const bool is_on_line = std::abs(cloth.scene.x(0, p[2]) - 0.1) < 1e-9 &&
                            std::abs(cloth.scene.x(0, p[3]) - 0.1) < 1e-9;
    const double angle = hinge_angles(cloth.scene.mesh, cloth.result.last.x)[h];
    if (is_on_line && cloth.scene.x(1, p[2]) + cloth.scene.x(1, p[3]) > 0.65)
      cloth.scene.rest_angles[h] = angle;  // one of four hinges is at rest
  }
  CHECK(cloth.value("forms_creases") == 1);
  for (std::size_t h = 0; h < cloth.scene.mesh.hinges.size(); ++h) {
    const auto& p = cloth.scene.mesh.hinges[h].particles;
    if (cloth.scene.x(1, p[2]) + cloth.scene.x(1, p[3]) > 0.45)
      cloth.scene.rest_angles[h] = hinge_angles(cloth.scene.mesh, cloth.result.last.x)[h];
  }
  CHECK(cloth.value("forms_creases") == 0);
}

TEST_CASE("wrinkles: creases of three hinges count, one ridge between two valleys") {
  Folded cloth(3);
  cloth.fold({-30, 0, 0, 40, 0, 0, 0, -30});
  CHECK(cloth.value("forms_creases") == 3);
  CHECK(cloth.value("wrinkles_stay_short") == exactly(2 * (3 * 0.3 + 3 * 0.3 + 3 * 0.4) / 9));
  Folded narrow(2);
  narrow.fold({-30, 0, 0, 40, 0, 0, 0, -30});
  CHECK(narrow.value("forms_creases") == 0);
}

TEST_CASE("wrinkles: a turn is the shorter way from the rest angle") {
  Folded cloth;
  cloth.fold({170, 0, 0, 0, 0, 0, 0, 0});
  CHECK(cloth.value("forms_creases") == 1);
  const std::vector<double> angles = hinge_angles(cloth.scene.mesh, cloth.result.last.x);
  const double folded = 170 * pi / 180, rest = 175 * pi / 180;
  for (std::size_t h = 0; h < angles.size(); ++h)
    if (std::abs(std::abs(angles[h]) - folded) < 1e-6)
      cloth.scene.rest_angles[h] = angles[h] > 0 ? -rest : rest;  // 15 degrees away
  CHECK(cloth.value("forms_creases") == 0);
}

TEST_CASE("sticking: stuck particles, their slack, and how far the cloth is lifted") {
  Folded cloth;
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
  s.x.col(4) = Vector3(0.2, 0.3, 0.05), s.x.col(9) = Vector3(0.4, 0.1, 0.02);
  s.bonds = {{0, 0, 4, {0.2, 0.3, 0.05}}, {0, 0, 9, {0.4, 0.1, 0.02}}};
  CHECK(value("sticks") == 2);
  CHECK(value("keeps_hold") == Approx(0).margin(1e-12));
  s.x.col(4) += Vector3(0.02, 0.03, 0.06), s.x.col(9) += Vector3(0.01, 0, 0);
  CHECK(value("keeps_hold") == exactly(0.07));
  cloth.result.last = s;
  CHECK(cloth.value("lets_go") == 2);
}
