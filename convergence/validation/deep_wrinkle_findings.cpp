#include "convergence/validation/deep_wrinkle_findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "convergence/validation/comparison.h"
#include "convergence/validation/deep_wrinkle.h"
#include "verification/oracles/sheets/deep_wrinkles.h"

namespace foldproof {

namespace {

// of an amplitude, and of the law where the plate is not yet far beyond the onset [1]
constexpr double height_resolution = 0.01, law_resolution = 0.05;

constexpr double tension = 2.9;          // N/m
constexpr double length = 0.15;          // m
constexpr double tension_strain = 1e-4;  // T/Y [1]

/// One compression on three meshes. Amplitudes are over (1/pi) wavelength (Delta/W)^(1/2).
struct DepthLadder {
  double over_onset = 0;   // Delta over that of the law's onset
  double compression = 0;  // Delta/W [1]
  oracles::DeepWrinkles plate;
  Comparison amplitude;
  DeepWrinkle finest;
  double unit = 0;  // (1/pi) wavelength (Delta/W)^(1/2) on the finest mesh [m]
};

/// With so many edges in a wave.
DeepWrinkleSheet sheet_of(double over_onset, int edges) {
  DeepWrinkleSheet sheet{0, tension, tension / tension_strain, length, 0, 3 * edges, edges};
  // the law's rigidity for this wavelength, and its onset
  const double reach = std::pow(wavelength_of(sheet), 2) / (4 * std::numbers::pi * length);
  sheet.rigidity = tension * reach * reach;
  sheet.compression = over_onset * 2 * std::numbers::pi * reach / length * tension_strain;
  return sheet;
}

oracles::DeepWrinkles plate_of(const DeepWrinkleSheet& sheet) {
  return {std::sqrt(sheet.rigidity / sheet.tension) / sheet.length,
          wavelength_of(sheet) / sheet.length, sheet.young * sheet.compression / sheet.tension};
}

DepthLadder ladder_at(const Subject& subject, double over_onset, Tier tier, Table& levels) {
  DepthLadder result;
  result.over_onset = over_onset;
  Ladder amplitudes;
  amplitudes.ratio = 1.5;
  amplitudes.floor = 1e-6;
  const std::vector<int> edges_a_wave =
      tier == Tier::quick ? std::vector{12, 18, 27} : std::vector{16, 24, 36};
  for (const int edges : edges_a_wave) {
    const DeepWrinkleSheet sheet = sheet_of(over_onset, edges);
    result.finest = deep_wrinkle(subject, sheet);
    result.compression = sheet.compression;
    result.plate = plate_of(sheet);
    result.unit = wavelength_of(sheet) / std::numbers::pi * std::sqrt(sheet.compression);
    amplitudes.values.push_back(result.finest.amplitude / result.unit);
    levels.row(over_onset, sheet.compression, sheet.rows, amplitudes.values.back(),
               result.finest.stable ? result.finest.unbalanced : nan);
  }
  result.amplitude = compare_ladder(fmt::format("amplitude at {:g} onsets", over_onset), amplitudes,
                                    oracles::deep_wrinkles_by_series(result.plate, {}).middle);
  return result;
}

NamedFinding amplitude_agrees(const std::vector<DepthLadder>& ladders) {
  Table table = no_comparisons("1");
  for (const DepthLadder& one : ladders) add_comparison(table, one.amplitude, height_resolution);
  return {"stretched-wrinkles.amplitude-agrees",
          "Beyond the onset, wrinkles are halfway between the clamps as high as those of a plate "
          "whose sections are all compressed alike, within one percent.",
          judge_comparisons(std::move(table), height_resolution, "one percent of an amplitude",
                            "over (1/pi) wavelength (Delta/W)^(1/2)")};
}

/// At the greatest compression, over the law for a sine along the length.
NamedFinding sections_fold_alike(const DepthLadder& deepest) {
  const double law = oracles::folded_in_the_mean, u = 1 - deepest.amplitude.should.value;
  Table table = no_comparisons("1");
  add_comparison(table,
                 {fmt::format("amplitude at {:g} onsets", deepest.over_onset),
                  deepest.amplitude.simulated / law,
                  deepest.amplitude.numerical / law,
                  {oracles::folded_in_each_section / law, std::abs(u) / law}},
                 law_resolution);
  return {"stretched-wrinkles.each-section-folds-its-own-compression",
          "At eight times the onset's compression, wrinkles halfway between the clamps are lower "
          "by 2^(1/2), within five percent of it, than the law for a sine along the length, which "
          "folds the compression away in the mean only.",
          judge_comparisons(std::move(table), law_resolution, "five percent of the law's amplitude",
                            "over (2^(1/2)/pi) wavelength (Delta/W)^(1/2); the uncertainty of D is "
                            "its distance from the plate")};
}

NamedFinding deep_wrinkles_rest(const Table& levels) {
  return {"stretched-wrinkles.deep-wrinkles-are-at-rest",
          "Every deep wrinkle is at rest, and stable against waves with its symmetries.",
          judge_worst(levels, "largest force over T edge", 1e-8,
                      "less than a thousandth of what bends the gentlest of them; the search ends "
                      "at a tenth of it")};
}

Figure depth_figure(const std::vector<DepthLadder>& ladders) {
  Figure figure{"amplitudes",
                "Amplitude of a wrinkle by its compression",
                {"compression over the onset's", "1", Scale::log},
                {"amplitude over (1/pi) wavelength (Delta/W)^(1/2)", "1"},
                "Halfway between the clamps. A sine along the length that folds the compression "
                "away in the mean would be at 2^(1/2), at any compression."};
  Curve simulated{"simulated"}, plate{"plate under tension"}, mean{"sine, in the mean"},
      each{"in each section"};
  for (const DepthLadder& one : ladders) {
    simulated.point(one.over_onset, one.amplitude.simulated);
    plate.point(one.over_onset, one.amplitude.should.value);
  }
  for (const DepthLadder* one : {&ladders.front(), &ladders.back()}) {
    mean.point(one->over_onset, oracles::folded_in_the_mean);
    each.point(one->over_onset, oracles::folded_in_each_section);
  }
  figure.curves = {simulated, plate, mean, each};
  return figure;
}

Figure deep_profiles(const std::vector<DepthLadder>& ladders) {
  Figure figure{"deep-profiles",
                "Deep wrinkles along the tension",
                {"place over the length", "1"},
                {"amplitude over (1/pi) wavelength (Delta/W)^(1/2)", "1"},
                "The finest meshes beside the plate: the farther beyond the onset, the flatter."};
  std::vector<double> places;
  for (int i = 0; i <= 100; ++i) places.push_back(i / 100.0);
  for (const DepthLadder* one : {&ladders.front(), &ladders.back()}) {
    Curve simulated{fmt::format("simulated, {:g} onsets", one->over_onset)},
        plate{fmt::format("plate, {:g} onsets", one->over_onset)};
    const std::vector<double>& rows = one->finest.amplitudes;
    for (std::size_t i = 1; i + 1 < rows.size(); i += 2)  // row 0 is half a row before the clamp
      simulated.point((double(i) - 0.5) / double(rows.size() - 2), rows[i] / one->unit);
    const std::vector<double> heights =
        oracles::deep_wrinkles_by_series(one->plate, places).heights;
    for (std::size_t i = 0; i < places.size(); ++i) plate.point(places[i], heights[i]);
    figure.curves.push_back(std::move(simulated));
    figure.curves.push_back(std::move(plate));
  }
  return figure;
}

}  // namespace

void add_deep_wrinkles(const Subject& subject, Tier tier, const Progress& progress,
                       StudyResult& result) {
  Table levels{{"compression over the onset's", "1"},
               {"Delta/W", "1"},
               {"rows of triangles", "1"},
               {"amplitude", "1"},
               {"largest force over T edge", "1"}};  // no number: not stable
  std::vector<DepthLadder> ladders;
  const std::vector<double> depths =
      tier == Tier::quick ? std::vector{4.0, 8.0} : std::vector{2.0, 3.0, 4.0, 6.0, 8.0};
  for (const double depth : depths) {
    ladders.push_back(ladder_at(subject, depth, tier, levels));
    progress((1 + double(ladders.size()) / double(depths.size())) / 2);
  }
  result.findings.push_back(amplitude_agrees(ladders));
  result.findings.push_back(sections_fold_alike(ladders.back()));
  result.findings.push_back(deep_wrinkles_rest(levels));
  result.figures.push_back(depth_figure(ladders));
  result.figures.push_back(deep_profiles(ladders));
  result.tables.push_back({"deep-meshes", "Every deep wrinkle on every mesh", std::move(levels)});
}

}  // namespace foldproof
