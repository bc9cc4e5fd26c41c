// fabric-strip: a strip cut from a simulated sheet, in the laboratory's bending test.

#include "convergence/validation/comparison.h"
#include "convergence/study.h"
#include "reference/mesh/shapes.h"
#include "reference/scene/fabrics.h"
#include "verification/oracles/gsl.h"
#include "verification/oracles/heavy_cantilever.h"
#include "verification/specimens/specimens.h"
#include "verification/specimens/stepper.h"

namespace foldproof {

namespace {

constexpr double resolution = 0.03;    // of the rigidity, as it is measured [1]
constexpr double g = 9.80665;          // m/s^2
constexpr double gamma_at_41_5 = 8.0;  // about where the tip is 41.5 degrees below the clamp [1]

struct CutStrip {
  const char *name, *words;
  SheetPattern pattern;
  double row_over_cell;  // of its cells along the strip [1]
};
constexpr CutStrip cut_strips[] = {
    {"alternating", "squares, rows of alternating diagonal", SheetPattern::alternating, 1},
    {"one-diagonal", "squares, one diagonal", SheetPattern::one_diagonal, 1},
    {"union-jack", "squares, union jack", SheetPattern::union_jack, 1}};

/// A made-up fabric: equations are the same for all, in their own units.
Fabric asked_fabric() { return {"asked", "", "", "", "", 0.2, {1e-5, 1e-5}, nan, {}}; }

/// A strip along x that is clamped in the middle of its first cell, and whose free length bends by
/// its weight as in the test; `cells` along that length, four across.
Scene strip_of(const CutStrip& cut, const Fabric& fabric, double ke, int cells) {
  const double length = std::cbrt(gamma_at_41_5 * fabric.rigidity[0] / (fabric.density * g));
  const double cell = length / (cells + 0.5);
  Scene scene = scene_at_rest(make_sheet({cut.pattern, cell * (cells + 1), 4 * cell, cells + 1, 4}),
                              fabric.density);
  add_flat_hinges(scene, ke, 0);
  const double weight = fabric.density * g * length;    // N/m
  scene.stretch = StretchMaterial{1e4 * weight, 0, 1};  // stretched by a ten-thousandth
  scene.gravity = Vector3(0, 0, -g);
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i)
    if (scene.x(0, i) < 1.5 * cell) scene.prescribed.push_back({int(i), scene.x.col(i), Motion{}});
  return scene;
}

/// Where the tip's middle has come to rest, below and beyond the clamp, over the free length.
struct TipAtRest {
  double drop, reach;  // 1
  double speed;        // what is left, over a fall by the length [1]
};

TipAtRest tip_of(const Subject& subject, const Scene& scene, int cells) {
  Stepper stepper(subject, scene, "linear-backward-euler");
  State s = stepper.start();
  const double length = scene.mesh.rest.row(0).maxCoeff() * (cells + 0.5) / (cells + 1);
  const double cell = length / (cells + 0.5), fall = std::sqrt(2 * g * length);
  const double h = 0.2 * length / fall;  // backward Euler's own damping brings it to rest
  double speed = 1;
  for (int k = 0; k < 2000 && !(speed < 1e-7); ++k) {
    s = stepper.step(s, h);
    speed = s.v.colwise().norm().maxCoeff() / fall;
  }
  const double end = scene.mesh.rest.row(0).maxCoeff();
  Vector3 tip = Vector3::Zero();
  int count = 0;
  for (Eigen::Index i = 0; i < s.x.cols(); ++i)
    if (scene.mesh.rest(0, i) > end - 1e-9) {
      tip += s.x.col(i);
      ++count;
    }
  tip /= count;
  return {-tip.z() / length, (tip.x() - cell / 2) / length, speed};
}

/// The rigidity that a laboratory would read from drop over reach, over the one asked for.
double read_rigidity(const TipAtRest& tip) {
  const auto miss = [&](double gamma) {
    const oracles::CantileverTip elastica = oracles::heavy_cantilever(gamma);
    return elastica.drop.value / elastica.reach.value - tip.drop / tip.reach;
  };
  return gamma_at_41_5 / oracles::bracketed_root(miss, 2, 40, 1e-6).value;
}

/// A strip of one pattern on finer and finer meshes.
Comparison reading_of(const Subject& subject, const CutStrip& cut, Tier tier,
                      const Progress& progress) {
  const Fabric fabric = asked_fabric();
  // ke from a whole sheet, as a case has it; the strip is cut from it
  const FabricOnMesh sheet = fabric_on_mesh(fabric, make_sheet({cut.pattern, 1, 1, 64, 64}));
  std::vector<int> cells{8, 16, 32};
  if (tier == Tier::full) cells.push_back(64);
  Ladder rigidities;
  for (const int count : cells) {
    const TipAtRest tip = tip_of(subject, strip_of(cut, fabric, sheet.stiffness, count), count);
    rigidities.values.push_back(read_rigidity(tip));
    rigidities.floor = std::max(rigidities.floor, 1e3 * tip.speed);
    progress(double(rigidities.values.size()) / double(cells.size()));
  }
  return compare_ladder("B as read over B as asked, " + std::string(cut.words), rigidities, {1, 0});
}

StudyResult run_fabric_strip(const Subject& subject, Tier tier, const Progress& progress) {
  Table carried = no_comparisons("1"), others = no_comparisons("1");
  double largest = 0;
  for (const CutStrip& cut : cut_strips) {
    const double done = double(carried.rows() + others.rows());
    const Comparison reading = reading_of(
        subject, cut, tier, [&](double part) { progress((done + part) / std::size(cut_strips)); });
    add_comparison(cut.pattern == SheetPattern::alternating ? carried : others, reading,
                   resolution);
    if (cut.pattern != SheetPattern::alternating)
      update_worst(largest, std::abs(difference(reading)) - combined_uncertainty(reading));
  }
  StudyResult result;
  result.findings = {
      {"fabric-strip.measures-as-asked.alternating",
       "A strip cut from a sheet of squares in rows of alternating diagonal measures, in a bending "
       "test at 41.5 degrees, the rigidity that its fabric was given, within three percent.",
       judge_comparisons(std::move(carried), resolution,
                         "a laboratory's readings of the bending length differ by one percent at "
                         "best, and its third power is the rigidity",
                         "ke from the rigidity of narrow strips of the whole sheet")},
      {"fabric-strip.other-patterns-differ",
       "On some other pattern the strip differs from its fabric by more than three percent.",
       {{resolution / largest, 1, 0, "1",
         "beyond the resolution, with the uncertainty taken off: such a mesh does not measure what "
         "it was given"},
        std::move(others),
        "particles of a union jack leave the curved surface, which makes it softer than its hinges "
        "say; squares with one diagonal twist"}}};
  return result;
}

}  // namespace

Study fabric_strip_study() {
  return {"fabric-strip",
          "A strip cut from a simulated sheet of alternating diagonals measures in the "
          "laboratory's bending test what its fabric measured; on another pattern it may not.",
          {"measures-as-asked", "other-patterns-differ"},
          "ASTM D1388; Peirce 1930",
          "The program gives a sheet of a measured fabric the ke for which narrow strips of that "
          "mesh have the measured rigidity. A strip of four cells' width is cut from it, clamped, "
          "and bends by its own weight to about 41.5 degrees, free to curve across and to twist. "
          "From its tip the rigidity is read as in the test. S is at the finest of three meshes, "
          "with the error bar of the ladder; D is the rigidity asked for, and has no scatter here: "
          "that of measured fabrics stands in cases/fabrics.toml. Equations have no scale: one "
          "made-up fabric stands for all.",
          run_fabric_strip,
          "validation"};
}

}  // namespace foldproof
