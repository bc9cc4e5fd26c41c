// heavy-cantilever: a clamped strip from nearly weightless to nearly limp, against the elastica.

#include "convergence/validation/comparison.h"
#include "convergence/validation/strip_ladder.h"
#include "convergence/study.h"
#include "verification/oracles/heavy_cantilever.h"

namespace foldproof {

namespace {

constexpr double share = 0.01;  // of the tip's way from level, as a laboratory reads it [1]

struct Weight {
  const char* name;
  double gamma;
};
constexpr Weight weights[] = {{"gamma-tenth", 0.1}, {"gamma-1", 1},      {"gamma-10", 10},
                              {"gamma-100", 100},   {"gamma-1000", 1e3}, {"gamma-10000", 1e4}};

/// A hundredth of the way that the tip has moved from where it is without weight, over L.
double resolution(const StripLadder& levels) {
  return share * std::hypot(levels.height.value, 1 - levels.reach.value);
}

/// A thin layer at the clamp, in which the heaviest bends, needs more panels.
std::vector<int> panels_for(const Weight& weight, Tier tier) {
  std::vector<int> panels{16, 32, 64};
  if (weight.gamma > 5000) panels = {32, 64, 128};
  if (tier == Tier::full) panels.push_back(2 * panels.back());
  return panels;
}

/// Drop and reach of the tip.
NamedFinding tip_agrees(const Weight& weight, const StripLadder& levels) {
  const oracles::CantileverTip tip = oracles::heavy_cantilever(weight.gamma);
  const double share_of_way = resolution(levels);
  Table table = no_comparisons("1");
  add_comparison(table,
                 compare_ladder("height of the tip over L", ladder_of(levels, height_column),
                                {-tip.drop.value, tip.drop.uncertainty}),
                 share_of_way);
  add_comparison(
      table, compare_ladder("reach of the tip over L", ladder_of(levels, reach_column), tip.reach),
      share_of_way);
  return {fmt::format("heavy-cantilever.tip-agrees.{}", weight.name),
          fmt::format("The tip of a clamped strip of weight gamma = {} hangs where the elastica's "
                      "does, within one percent of its way from level.",
                      weight.gamma),
          judge_comparisons(table, share_of_way,
                            "a laboratory reads how far the tip has come to a hundredth of it",
                            "S at the finest mesh; D by shooting from the tip")};
}

/// A limp thread hangs straight down from its clamp. The heaviest strips are near to that, so their
/// shape must be closer to the elastica than to the thread: a tenth of the tip's reach.
double resolution_of_shape(const StripLadder& levels) {
  return std::min(resolution(levels), levels.reach.value / 10);
}

NamedFinding shape_agrees(const Weight& weight, const StripLadder& levels) {
  return {fmt::format("heavy-cantilever.shape-agrees.{}", weight.name),
          fmt::format("At the finest mesh no row of a clamped strip of weight gamma = {} is "
                      "farther from the elastica than one percent of the tip's way from level, or "
                      "than a tenth of the tip's reach if that is less.",
                      weight.gamma),
          shape_verdict(levels, resolution_of_shape(levels),
                        "a hundredth of the way of the tip, for every point; where that is more, a "
                        "tenth of the tip's reach: a limp thread has none",
                        "D by collocation")};
}

StudyResult run_heavy_cantilever(const Subject& subject, Tier tier, const Progress& progress) {
  StudyResult result;
  Figure shapes{"shapes",
                "A clamped strip under its own weight",
                {"reach", "L"},
                {"height", "L"},
                "Every fourth row of the finest mesh beside the elastica."};
  for (const Weight& weight : weights) {
    const StripTest test{weight.name, "", "", {weight.gamma, 0, {}, 0}, 1};
    const StripLadder levels = strip_ladder(subject, test, panels_for(weight, tier));
    result.add({tip_agrees(weight, levels), shape_agrees(weight, levels)});
    show(levels, levels.points.size(),
         {fmt::format("elastica, gamma = {}", weight.gamma),
          fmt::format("simulated, gamma = {}", weight.gamma)},
         shapes);
    progress(double(result.findings.size()) / (2 * std::size(weights)));
  }
  result.figures.push_back(std::move(shapes));
  return result;
}

}  // namespace

Study heavy_cantilever_study() {
  return {
      "heavy-cantilever",
      "A clamped strip, from nearly weightless to nearly limp, hangs as the elastica with the "
      "mesh's own rigidity.",
      {"tip-agrees", "shape-agrees"},
      "BMF03 section 4; Romero et al. 2021 for the test",
      "The strip is that of the study cantilever: rows move as one, so that its rigidity is the "
      "homogenised cell's. gamma is weight per area times L^3 over that rigidity. S is what is "
      "simulated on the finest of three meshes (four in the full tier), with the error bar of the "
      "ladder; D is the elastica, by shooting from the tip, and by collocation for the shape. S "
      "and D agree within u, differ by d +- u, or u is too large to tell. Up to gamma = 1000, 64 "
      "panels suffice; the heaviest strip bends within L/100 of its clamp, and gets 128.",
      run_heavy_cantilever,
      "validation"};
}

}  // namespace foldproof
