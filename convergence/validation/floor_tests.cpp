// fold-tests and pressed-strip: strips that meet a floor, against the elastica.

#include "convergence/validation/comparison.h"
#include "convergence/validation/strip_ladder.h"
#include "convergence/study.h"
#include "verification/oracles/folds.h"

namespace foldproof {

namespace {

using oracles::EndHold;

// ---- folds

constexpr double fold_resolution = 0.01;  // of the height [1]

struct FoldTest {
  const char *name, *words;
  oracles::HeavyStrip strip;
  double least, most;  // between which it lifts off, over L
};

std::vector<FoldTest> fold_tests() {
  return {{"clamped-fold", "clamped fold", {20, 0, {{pi, 0, 0}}, 0}, 0.15, 0.3}};
}

/// A fold on one mesh: `flat` panels lie on the floor.
struct FoldOnMesh {
  int flat;
  double lift_off, height, spacing;  // over L [1]
  std::vector<oracles::StripPoint> points;
  double unfinished;  // of the solve [1]
};

/// Contact with the floor by its two conditions: no row is below it, and it pulls on none. A panel
/// more lies flat where the first free one points down, one less where the floor would have to pull
/// at the row where the strip lifts off.
FoldOnMesh fold_on_mesh(const Subject& subject, const FoldTest& test, int panels) {
  const double all = panels;
  int flat = int(std::lround((test.least + test.most) / 2 * all));
  for (int tries = 0; tries < 20; ++tries) {
    const double lift_off = flat / all, share = 1 - lift_off;
    const StripTest part{test.name, "", "", oracles::lifted_part(test.strip, lift_off), 1};
    const StripOnMesh mesh = strip_on_mesh(subject, part, panels - flat);
    if (mesh.rest.slopes[0] < 0) {
      ++flat;
    } else if (mesh.force_on_row_1 > 0) {
      --flat;
    } else {
      FoldOnMesh fold{flat,
                      lift_off,
                      share * highest_row(mesh.points),
                      share * mesh.spacing,
                      {},
                      mesh.rest.strain + mesh.rest.last_step};
      for (const oracles::StripPoint& point : mesh.points)
        fold.points.push_back({point.slope, lift_off + share * point.across, share * point.up});
      return fold;
    }
  }
  throw std::runtime_error(std::string("fold-tests: no contact found for the ") + test.words);
}

Curve shape_of(const FoldTest& test, double lift_off) {
  Curve curve{std::string(test.words) + ", elastica"};
  curve.point(0, 0);
  for (const oracles::StripPoint& point :
       oracles::strip_by_collocation(oracles::lifted_part(test.strip, lift_off),
                                     linear_range(0, 1, 101))
           .points)
    curve.point(lift_off + (1 - lift_off) * point.across, (1 - lift_off) * point.up);
  return curve;
}

void add_fold(const Subject& subject, const FoldTest& test, StudyResult& result) {
  const oracles::Fold fold =
      oracles::fold_on_floor(test.strip, test.least, test.most, oracles::strip_by_collocation);
  // 64 would do for the difference, but whole panels that lie flat make a wide error bar
  constexpr int panels[] = {32, 64, 128};
  Ladder heights;
  Table levels(
      "spacing of the rows over L [1]; flat panels [1]; lift-off over L [1]; height over L [1]");
  Curve rows{std::string(test.words) + ", simulated"};
  for (const int count : panels) {
    const FoldOnMesh mesh = fold_on_mesh(subject, test, count);
    levels.row(mesh.spacing, mesh.flat, mesh.lift_off, mesh.height);
    heights.values.push_back(mesh.height);
    heights.floor = std::max(heights.floor, mesh.unfinished);
    if (count != std::end(panels)[-1]) continue;
    for (std::size_t i = 0; i < mesh.points.size(); i += 4)
      rows.point(mesh.points[i].across, mesh.points[i].up);
  }
  result.figures.back().curves.push_back(shape_of(test, fold.lift_off.value));
  result.figures.back().curves.push_back(rows);
  result.tables.push_back({test.name, "Meshes of the " + std::string(test.words), levels});
  const double scale = fold_resolution * fold.height.value;
  result.findings.push_back(
      {fmt::format("fold-tests.height-agrees.{}", test.name),
       fmt::format("The height of a {} on a smooth floor is the elastica's within one percent.",
                   test.words),
       judge_comparison(compare_ladder("height of the fold over L", heights, fold.height), scale,
                        "a laboratory reads the height to one percent of it",
                        "S at the finest of the meshes; it lies flat in whole panels, so that "
                        "heights need not fall in order")});
}

StudyResult run_fold_tests(const Subject& subject, Tier, const Progress& progress) {
  StudyResult result;
  result.figures.push_back({"folds",
                            "Strips folded over on a floor",
                            {"across from the first end", "L"},
                            {"height over the floor", "L"},
                            "Every fourth row of the finest mesh beside the elastica, to scale; L "
                            "is the strip's length."});
  for (const FoldTest& test : fold_tests()) {
    add_fold(subject, test, result);
    progress(double(result.findings.size()) / double(fold_tests().size()));
  }
  return result;
}

// ---- a strip pressed on a floor

constexpr double threshold_resolution = 0.02;  // of the threshold [1]
constexpr double compressions[] = {0.01, 0.05, 0.1, 0.2, 0.3};

/// Hangs from its clamp, and is shortened by this share of L.
StripTest pressed(double compression) {
  // the branch that bulges to one side as a clamped and pinned column does
  return {"pressed",
          "",
          "",
          {0,
           -pi / 2,
           {{-pi / 2 + 2 * std::sqrt(compression), 0, compression - 1, EndHold::pinned}},
           -2 * std::sqrt(compression)},
          1};
}

double threshold_of(double across, double up) { return std::abs(across / up); }

NamedFinding threshold_agrees(const Subject& subject, double compression, Tier tier, Curve& exact,
                              Curve& simulated) {
  const StripTest test = pressed(compression);
  const std::vector<double> end{1};
  const oracles::StripShape shape = oracles::strip_by_collocation(test.strip, end);
  const oracles::Estimate should{threshold_of(shape.force_across, shape.force_up),
                                 1e3 * shape.uncertainty};
  std::vector<int> panels{16, 32, 64};
  if (tier == Tier::full) panels.push_back(128);
  Ladder thresholds;
  for (const int count : panels) {
    const StripAtRest rest = strip_on_mesh(subject, test, count).rest;
    thresholds.values.push_back(threshold_of(rest.hold_force.x(), rest.hold_force.y()));
    thresholds.floor = std::max(thresholds.floor, 100 * (rest.strain + rest.last_step));
  }
  exact.point(compression, should.value);
  simulated.point(compression, thresholds.values.back());
  const double scale = threshold_resolution * should.value;
  return {fmt::format("pressed-strip.threshold-agrees.eps-{:.2f}", compression),
          fmt::format("A strip that hangs from a clamp and is pressed on a floor by {:.0f} % of "
                      "its length slips at the elastica's friction, within two percent.",
                      100 * compression),
          judge_comparison(compare_ladder("friction at which the tip slips", thresholds, should),
                           scale, "two percent of the threshold",
                           "S is the ratio of the forces that hold the tip")};
}

StudyResult run_pressed_strip(const Subject& subject, Tier tier, const Progress& progress) {
  StudyResult result;
  Curve exact{"elastica"}, simulated{"simulated"};
  for (const double compression : compressions) {
    result.findings.push_back(threshold_agrees(subject, compression, tier, exact, simulated));
    progress(double(result.findings.size()) / std::size(compressions));
  }
  result.figures.push_back({"thresholds",
                            "Friction at which the tip of a pressed strip slips",
                            {"compression over L", "1"},
                            {"threshold of Coulomb's coefficient", "1"},
                            "The ratio of the tip's forces along and across the floor.",
                            {exact, simulated}});
  return result;
}

}  // namespace

Study fold_tests_study() {
  return {"fold-tests",
          "A strip folded over on a smooth floor stands as high as the elastica with the mesh's "
          "own rigidity.",
          {"height-agrees"},
          "Plaut 2015",
          "Both ends are held flat on the floor at one place, one on the other. The strip lies on "
          "the floor until it lifts off without a moment. On a mesh whole panels lie flat; how "
          "many follows from the two conditions of contact. Thickness counts for nothing. D is the "
          "elastica by collocation, which a check holds against shooting. A free fold, whose upper "
          "end is held by nothing, has a study of its own (free-fold).",
          run_fold_tests,
          "validation"};
}

Study pressed_strip_study() {
  return {"pressed-strip",
          "A strip pressed on a floor slips at the friction at which the elastica does.",
          {"threshold-agrees"},
          "Romero et al. 2021 for the test",
          "A weightless strip hangs from a clamp and is pressed on a floor, so that it buckles. "
          "Its tip sticks as long as Coulomb's coefficient is above the ratio of the forces on it "
          "along and across the floor. S is that ratio on the finest mesh of 16, 32, 64 panels, "
          "with the tip pinned; that the friction of the reference obeys Coulomb's law is checked "
          "elsewhere (contact.friction-obeys-coulomb).",
          run_pressed_strip,
          "validation"};
}

}  // namespace foldproof
