// strip-tests: the shapes into which a textile laboratory bends a strip, against the elastica.

#include "convergence/validation/comparison.h"
#include "convergence/validation/strip_ladder.h"
#include "convergence/study.h"

namespace foldproof {

namespace {

constexpr double resolution = 0.01;  // of the measured length [1]

/// gamma of each bends the weightless shape by a tenth and more.
std::vector<StripTest> strip_tests() {
  const double down = -pi / 2, up = pi / 2;
  return {
      {"heart-loop", "heart loop", "loops", {60, up, {{up - 3 * pi, 0, 0}}}, 0.5},
      {"pear-loop", "pear loop", "loops", {200, down, {{down - pi, 0, 0}}}, 0.5},
      {"hanging-ring", "hanging ring", "rings", {120, 0, {{-2 * pi, 0, 0}}}, 0.5},
      {"standing-ring", "standing ring", "rings", {90, 0, {{2 * pi, 0, 0}}}, 0.5},
      {"hanging-wrinkle", "hanging wrinkle", "wrinkles", {150, 0, {{0, 0.8, 0}}, -1}, 0.5},
      {"standing-wrinkle", "standing wrinkle", "wrinkles", {80, 0, {{0, 0.8, 0}}, 1}, 0.5},
  };
}

NamedFinding height_agrees(const StripTest& test, const StripLadder& levels) {
  const double scale = std::abs(levels.height.value) * resolution;
  return {fmt::format("strip-tests.height-agrees.{}", test.name),
          fmt::format("The height of a {} is the elastica's within one percent.", test.words),
          judge_comparison(compare_ladder("height of the middle over L",
                                          ladder_of(levels, height_column), levels.height),
                           scale, "a laboratory reads the height to one percent of it",
                           "S at the finest mesh")};
}

NamedFinding shape_agrees(const StripTest& test, const StripLadder& levels) {
  return {
      fmt::format("strip-tests.shape-agrees.{}", test.name),
      fmt::format("At the finest mesh no row of a {} is farther than one percent of the "
                  "strip's length from the elastica.",
                  test.words),
      shape_verdict(levels, resolution, "a hundredth of the strip's length, for every point", "")};
}

NamedFinding order_of(const StripTest& test, const StripLadder& levels) {
  Convergence errors = convergence_of(levels.levels, distance_column);
  errors.floor = levels.floor;
  Table evidence = levels.levels;
  evidence.add({"order", "1", row_orders(errors)});
  const Verdict verdict =
      order_verdict(errors, 2, 1, 0.1,
                    "another order, as with a clamp on the hinge line, is off by 1; the third "
                    "term of the error is smaller than the second by the number of panels");
  return {fmt::format("strip-tests.is-second-order.{}", test.name),
          fmt::format("The shape of a {} tends to the elastica's with second order.", test.words),
          {verdict, std::move(evidence)}};
}

Figure shapes_of(const std::string& kind) {
  return {kind,
          "Strips as a laboratory bends them: " + kind,
          {"across from the first clamp", "L"},
          {"height over the first clamp", "L"},
          "Every fourth row of the finest mesh beside the elastica, to scale; L is the strip's "
          "length."};
}

StudyResult run_strip_tests(const Subject& subject, Tier tier, const Progress& progress) {
  const std::vector<int> panels =
      tier == Tier::full ? std::vector{16, 32, 64, 128} : std::vector{16, 32, 64};
  StudyResult result;
  const std::vector<StripTest> tests = strip_tests();
  for (std::size_t i = 0; i < tests.size(); ++i) {
    const StripLadder levels = strip_ladder(subject, tests[i], panels);
    result.add({height_agrees(tests[i], levels), shape_agrees(tests[i], levels),
                order_of(tests[i], levels)});
    if (result.figures.empty() || result.figures.back().name != tests[i].kind)
      result.figures.push_back(shapes_of(tests[i].kind));
    show(levels, levels.points.size() - 1,
         {tests[i].words + ", elastica", tests[i].words + ", simulated"}, result.figures.back());
    progress(double(i + 1) / double(tests.size()));
  }
  return result;
}

}  // namespace

Study strip_tests_study() {
  return {
      "strip-tests",
      "Strips that are bent as in a textile laboratory take the shape of the elastica with the "
      "mesh's own rigidity, to second order.",
      {"height-agrees", "shape-agrees", "is-second-order"},
      "Peirce 1930; Plaut 2015",
      "Each strip is clamped at both ends, half a cell inside its held rows; a ring is a strip "
      "whose ends are clamped level at one place. Rows across move as one, so that the rigidity is "
      "the homogenised cell's. The measured length is the height of the strip's middle over its "
      "clamp. S is what is simulated on the finest of three meshes (four in the full tier) of 16, "
      "32, 64 panels, with the error bar of the ladder; D is the elastica by collocation, which a "
      "check holds against shooting. Standing ring and wrinkle stand on their clamps: they weigh "
      "less than what would press them flat on a floor.",
      run_strip_tests,
      "validation"};
}

}  // namespace foldproof
