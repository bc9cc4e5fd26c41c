#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "convergence/validation/wrinkle_findings.h"
#include "convergence/validation/clamped_sheet.h"
#include "convergence/validation/comparison.h"
#include "verification/oracles/exact_solutions.h"
#include "verification/oracles/sheets/clamped_stress.h"

namespace foldproof {

namespace {

constexpr double stress_resolution = 5e-4;                       // of the tension [1]
constexpr std::array<int, 4> rows_of_triangles{12, 18, 27, 40};  // over half the width

/// So stiff that it stays flat, and strained so little that stresses go with the strain.
ClampedSheet stiff_sheet(int rows, double length_over_width) {
  ClampedSheet sheet;
  sheet.rigidity = 0.1;  // J
  sheet.young = 2000;    // N/m
  sheet.width = 0.1;     // m
  sheet.strain = 1e-4;
  sheet.rows = rows;
  sheet.half_edges = int(std::lround(std::numbers::sqrt3 * rows * length_over_width + 1.5));
  return sheet;
}

/// The mean of the two triangles around a place.
struct Stress {
  double place, over_tension;
};

Stress stress_near(const ClampedFlat& flat, double place) {
  const auto after = std::ranges::lower_bound(flat.places, place);
  const auto i = std::clamp<std::ptrdiff_t>(after - flat.places.begin(), 1,
                                            std::ptrdiff_t(flat.places.size()) - 1);
  const std::size_t k = std::size_t(i);
  return {(flat.places[k - 1] + flat.places[k]) / 2,
          (flat.stresses[k - 1] + flat.stresses[k]) / 2 / flat.tension};
}

/// The stress near a place on every mesh, and the continuum's at the same place of a sheet as long.
Comparison stress_compared(const std::string& quantity, const std::vector<ClampedSheet>& sheets,
                           const std::vector<ClampedFlat>& flats, double place) {
  const double poisson = oracles::equilateral_sheet_moduli(sheets.front().young).poisson.value;
  Ladder off;
  off.ratio = 1.5;
  off.floor = 1e-7;
  Comparison one{quantity, nan, nan, {nan, nan}};
  for (std::size_t k = 0; k < sheets.size(); ++k) {
    const Stress stress = stress_near(flats[k], place);
    one.should = oracles::clamped_stress_by_stresses(
        {length_of(sheets[k]) / sheets[k].width, poisson}, std::array{stress.place})[0];
    one.simulated = stress.over_tension;
    off.values.push_back(one.simulated - one.should.value);
  }
  one.numerical = error_bar(off).half_width;
  return one;
}

constexpr double width = 0.1;         // m
constexpr double young = 2000;        // N/m
constexpr double strain = 1e-3;       // of the clamps [1]
constexpr double reach_sq = 5.6e-10;  // D/(Y W^2): wrinkles at a fourth of the strain [1]

/// Twice as long as wide, within two parts in a thousand: rows over half the width, and half edges
/// along half the length.
constexpr std::array<std::array<int, 2>, 4> meshes{{{27, 95}, {40, 140}, {60, 209}, {90, 313}}};

/// The law's numbers for a rigidity, a tension and a length.
double law_of_wavelength(const ClampedSheet& sheet, double tension) {
  return 2 * std::sqrt(std::numbers::pi * std::sqrt(sheet.rigidity / tension) * length_of(sheet));
}
double law_of_compression(const ClampedSheet& sheet, double tension) {
  return 2 * std::numbers::pi * std::sqrt(sheet.rigidity * tension) / length_of(sheet);
}

/// With Delta/W by which a sheet that is free to narrow would.
double law_of_amplitude(double wavelength, double tension) {
  const double narrowing = oracles::equilateral_sheet_moduli(young).poisson.value * tension / young;
  return std::numbers::sqrt2 / std::numbers::pi * wavelength * std::sqrt(narrowing);
}

/// What the sheet does over what the law says [1].
struct OverLaw {
  double onset_compression, onset_wavelength, wavelength, amplitude;
};

ClampedSheet sheet_on(int rows, int half_edges) {
  return {reach_sq * young * width * width, young, width, strain, rows, half_edges};
}

/// The flat sheet's greatest compression across, over its tension, and its place over the length.
struct Compression {
  double over_tension, place;
};

Compression greatest_compression(const ClampedFlat& flat) {
  const auto most = std::ranges::min_element(flat.stresses);
  return {-*most / flat.tension, flat.places[std::size_t(most - flat.stresses.begin())]};
}

OverLaw over_law(const ClampedSheet& sheet, const ClampedFlat& flat,
                 const ClampedWrinkles& wrinkles) {
  const double onset_tension = flat.onset * flat.tension,
               wavelength = wavelength_of(wrinkles.section);
  return {
      greatest_compression(flat).over_tension * onset_tension /
          law_of_compression(sheet, onset_tension),
      wavelength_of(flat.mode) / law_of_wavelength(sheet, onset_tension),
      wavelength / law_of_wavelength(sheet, wrinkles.tension),
      std::abs(wrinkles.section.heights.front()) / law_of_amplitude(wavelength, wrinkles.tension)};
}

struct ClampedLadder {
  Table levels{
      "rows of triangles over the width [1]; length over width [1]; strain at the onset [1]; "
      "(D/T)^(1/2)/L at the onset [1]; greatest compression across at the onset over T [1]; place "
      "of it over the length [1]; onset's compression over the law's [1]; onset's wavelength over "
      "the law's [1]; wavelength over the law's [1]; amplitude over the law's [1]; largest force "
      "over Y strain edge [1]; stable rest"};
  std::vector<OverLaw> values;
  ClampedFlat flat;          // on the finest mesh
  ClampedWrinkles wrinkles;  // there
};

ClampedLadder ladder_of_meshes(const Subject& subject) {
  ClampedLadder ladder;
  for (const auto& [rows, half_edges] : meshes) {
    const ClampedSheet sheet = sheet_on(rows, half_edges);
    ladder.flat = clamped_flat(subject, sheet);
    ladder.wrinkles = clamped_wrinkles(subject, sheet, ladder.flat);
    OverLaw over = over_law(sheet, ladder.flat, ladder.wrinkles);
    const bool rests = ladder.wrinkles.stable && ladder.wrinkles.unbalanced < 1e-8;
    if (!rests) over.wavelength = over.amplitude = nan;
    const Compression most = greatest_compression(ladder.flat);
    const double onset_tension = ladder.flat.onset * ladder.flat.tension;
    ladder.levels.row(2 * rows, length_of(sheet) / width, ladder.flat.onset * strain,
                      std::sqrt(sheet.rigidity / onset_tension) / length_of(sheet),
                      most.over_tension, most.place, over.onset_compression, over.onset_wavelength,
                      over.wavelength, over.amplitude, ladder.wrinkles.unbalanced,
                      rests ? "yes" : "no");
    ladder.values.push_back(over);
  }
  return ladder;
}

/// Over the length, from a clamp; NaN if the sheet is compressed nowhere.
double place_where_compression_begins(const ClampedFlat& flat) {
  for (std::size_t i = 1; i < flat.places.size(); ++i) {
    const double before = flat.stresses[i - 1], after = flat.stresses[i];
    if (before > 0 && after <= 0)
      return flat.places[i - 1] + before / (before - after) * (flat.places[i] - flat.places[i - 1]);
  }
  return nan;
}

/// Shorter and longer sheets, flat, on a coarse mesh.
Table other_lengths(const Subject& subject) {
  Table table{"clamped-lengths",
              "Flat clamped sheets, shorter and longer",
              {{"length over width", "1"},
               {"greatest compression across over T", "1"},
               {"place of it over the length", "1"},
               {"compressed from this place on", "1"},
               {"halfway over T", "1"},
               {"strain at the onset", "1"}}};  // no number: above 0.001
  const int rows = meshes.front()[0];
  for (const double ratio : {1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 4.0}) {
    const ClampedSheet sheet =
        sheet_on(rows, int(std::lround(std::numbers::sqrt3 * rows * ratio + 1.5)));
    const ClampedFlat flat = clamped_flat(subject, sheet);
    const Compression most = greatest_compression(flat);
    table.row(length_of(sheet) / width, most.over_tension, most.place,
              place_where_compression_begins(flat), -flat.stresses.back() / flat.tension,
              flat.onset * strain);
  }
  return table;
}

Comparison compared(const std::string& words, const ClampedLadder& ladder,
                    double OverLaw::*quantity) {
  Ladder values;
  values.ratio = 1.5;
  values.floor = 1e-6;
  for (const OverLaw& one : ladder.values) values.values.push_back(one.*quantity);
  return compare_ladder(words, values, {1, 0});
}

Table over_law_table() {
  return Table("quantity; over the law's [1]; numerical u [1]; comparison");
}

void add_over_law(Table& table, const Comparison& one) {
  table.row(one.quantity, oracles::Estimate{one.simulated, one.numerical}, one.numerical,
            words_of(one, 0.1));
}

NamedFinding narrower(const ClampedLadder& ladder) {
  Table table = over_law_table();
  add_over_law(table, compared("wavelength at the onset", ladder, &OverLaw::onset_wavelength));
  add_over_law(table, compared("wavelength at four onsets", ladder, &OverLaw::wavelength));
  return {"stretched-wrinkles.clamps-cause-narrower-wrinkles",
          "A sheet that only its clamps compress wrinkles with shorter waves than the law for a "
          "sheet that is compressed over its whole length.",
          judge_worst(std::move(table), "over the law's", 1, "the law itself")};
}

NamedFinding later(const ClampedLadder& ladder) {
  Comparison one =
      compared("law's compression over the flat sheet's", ladder, &OverLaw::onset_compression);
  one.numerical /= one.simulated * one.simulated;
  one.simulated = 1 / one.simulated;
  Table table("quantity; law's over the sheet's [1]; numerical u [1]; comparison");
  add_over_law(table, one);
  return {"stretched-wrinkles.clamped-sheet-resists-longer",
          "It stays flat until its greatest compression across is above the law's.",
          judge_worst(std::move(table), "law's over the sheet's", 1, "the law itself")};
}

NamedFinding lower(const ClampedLadder& ladder) {
  Table table = over_law_table();
  add_over_law(table, compared("amplitude at four onsets", ladder, &OverLaw::amplitude));
  return {"stretched-wrinkles.clamps-cause-lower-wrinkles",
          "Its waves are lower than if they folded away all by which a free sheet would narrow, "
          "even in each section by itself.",
          judge_worst(std::move(table), "over the law's", 1 / std::numbers::sqrt2,
                      "2^(-1/2): each section folds away its own part",
                      "over (2^(1/2)/pi) wavelength (nu T/Y)^(1/2), with its own wavelength")};
}

Figure stress_figure(const ClampedFlat& flat) {
  Figure figure{"clamps-stress",
                "Stress across a flat sheet that is clamped and pulled",
                {"place over the length", "1"},
                {"stress across over the tension", "1"},
                "On the middle line, from a clamp to halfway. Below zero it compresses."};
  Curve stress{"simulated"}, none{"no stress"};
  for (std::size_t i = 0; i < flat.places.size(); i += 3)
    if (flat.places[i] > 0) stress.point(flat.places[i], flat.stresses[i] / flat.tension);
  none.point(0, 0);
  none.point(0.5, 0);
  figure.curves = {stress, none};
  return figure;
}

Figure section_figure(const ClampedLadder& ladder) {
  const ClampedWrinkles& run = ladder.wrinkles;
  Figure figure{"clamps-section",
                "Heights halfway between the clamps",
                {"place over the width", "1"},
                {"height over the width", "1"},
                "At four times the onset's strain, from the middle line to the free edge, beside "
                "the law's wave for the tension, the length and the narrowing of a free sheet."};
  const ClampedSheet sheet = sheet_on(meshes.back()[0], meshes.back()[1]);
  const double wavelength = law_of_wavelength(sheet, run.tension),
               amplitude = law_of_amplitude(wavelength, run.tension);
  Curve simulated{"simulated"}, law{"law"};
  const double sign = run.section.heights.front() < 0 ? -1 : 1;
  for (std::size_t i = 0; i < run.section.places.size(); ++i)
    simulated.point(run.section.places[i] / width, sign * run.section.heights[i] / width);
  for (int i = 0; i <= 200; ++i)
    law.point(i / 400.0,
              amplitude / width * std::cos(2 * std::numbers::pi * i / 400 * width / wavelength));
  figure.curves = {simulated, law};
  return figure;
}

}  // namespace

void add_clamped_wrinkles(const Subject& subject, StudyResult& result) {
  const ClampedLadder ladder = ladder_of_meshes(subject);
  result.add({narrower(ladder), later(ladder), lower(ladder)});
  result.figures.push_back(stress_figure(ladder.flat));
  result.figures.push_back(section_figure(ladder));
  result.tables.push_back(other_lengths(subject));
  result.tables.push_back({"clamped-meshes", "The clamped sheet on every mesh", ladder.levels});
}

void add_clamped_continuum(const Subject& subject, StudyResult& result) {
  Table halfway = no_comparisons("1"), nearer = no_comparisons("1");
  for (const double ratio : {1.25, 1.5, 2.0, 3.0}) {
    std::vector<ClampedSheet> sheets;
    std::vector<ClampedFlat> flats;
    for (const int rows : rows_of_triangles) {
      sheets.push_back(stiff_sheet(rows, ratio));
      flats.push_back(clamped_flat(subject, sheets.back()));
    }
    for (const double place : {0.2, 0.3, 0.5})
      add_comparison(place == 0.5 && ratio >= 2 ? halfway : nearer,
                     stress_compared(fmt::format("at {} of a length of {} widths", place, ratio),
                                     sheets, flats, place),
                     stress_resolution);
  }
  result.findings.push_back(
      {"stretched-wrinkles.clamps-compress-as-in-a-continuum",
       "Halfway between the clamps, the stress across a flat sheet of two or three widths' length "
       "is that of an elastic continuum.",
       judge_comparisons(
           std::move(halfway), stress_resolution,
           "a twentieth of the greatest compression across, which is near 0.01 of the tension",
           "over the tension")});
  nearer.name = "clamped-continuum";
  nearer.title = "Nearer to the clamps, and in shorter sheets: the stress across over the tension";
  result.tables.push_back(std::move(nearer));
}

}  // namespace foldproof
