// The judge of a case, its repetition, its shapes, and quantities of folds, wrinkles and sticking.
#include <catch2/catch.hpp>

#include "reference/bodies/level_set_provider.h"
#include "reference/mesh/shapes.h"
#include "verification/cases/folds.h"
#include "verification/cases/judge.h"

using namespace foldproof;

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
/// and has number 0, on their way to the repetition.
double differing(const std::function<void(Diagnostics&, int)>& damage, double start = 0,
                 double end = 0.5) {
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
