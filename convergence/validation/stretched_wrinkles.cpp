// stretched-wrinkles: a sheet that is stretched and compressed across wrinkles along its tension.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "convergence/validation/wrinkle_findings.h"
#include "convergence/validation/comparison.h"
#include "convergence/validation/wrinkled_sheet.h"
#include "verification/oracles/sheets/stretched_wrinkles.h"

namespace foldproof {

namespace {

constexpr double resolution = 0.01;       // of a wavelength [1]
constexpr double load_resolution = 0.02;  // of the compression [1]

/// The number in which a sheet differs from the first one.
enum class Varied { nothing, tension, length, rigidity };

struct Sheet {
  Varied varied;
  double factor;
  double rigidity, tension, length;  // D [J], T [N/m], L [m]
};

std::string_view name_of(Varied varied) {
  constexpr std::string_view names[] = {"first", "tension", "length", "rigidity"};
  return names[size_t(varied)];
}

/// The law's exponent of the wavelength.
double exponent_of(Varied varied) {
  return varied == Varied::length ? 0.5 : varied == Varied::tension ? -0.25 : 0.25;
}

std::string words_of(const Sheet& sheet) {
  if (sheet.varied == Varied::nothing) return "first sheet";
  return fmt::format("{} x {:g}", name_of(sheet.varied), sheet.factor);
}

Sheet sheet_with(Varied varied, double factor) {
  Sheet sheet{varied, factor, 1.7e-6, 2.9, 0.15};
  if (varied == Varied::tension) sheet.tension *= factor;
  if (varied == Varied::length) sheet.length *= factor;
  if (varied == Varied::rigidity) sheet.rigidity *= factor;
  return sheet;
}

/// The first one, then others whose bending reaches a fourth as far against their length; in the
/// full tier also a sixteenth.
std::vector<Sheet> sheets_of(Tier tier) {
  std::vector<Sheet> sheets{sheet_with(Varied::nothing, 1)};
  for (double part = 4; part <= (tier == Tier::quick ? 4 : 16); part *= 4) {
    sheets.push_back(sheet_with(Varied::tension, part * part));
    sheets.push_back(sheet_with(Varied::length, part));
    sheets.push_back(sheet_with(Varied::rigidity, 1 / (part * part)));
  }
  return sheets;
}

/// How far bending reaches against the tension [m].
double reach_of(const Sheet& sheet) { return std::sqrt(sheet.rigidity / sheet.tension); }

// the law of Cerda and Mahadevan
double law_of_wavelength(const Sheet& sheet) {
  return 2 * std::sqrt(std::numbers::pi * reach_of(sheet) * sheet.length);
}
double law_of_compression(const Sheet& sheet) {
  return 2 * std::numbers::pi * std::sqrt(sheet.rigidity * sheet.tension) / sheet.length;
}

/// Of a mesh whose edges are about so many reaches of bending long.
int rows_of(const Sheet& sheet, double edges) {
  const double spacing = edges * reach_of(sheet) * std::numbers::sqrt3 / 2;
  return std::max(6, int(std::lround(sheet.length / spacing)));
}

WrinkledSheet on_mesh(const Subject& subject, const Sheet& sheet, int rows) {
  return wrinkled(subject, {sheet.rigidity, sheet.tension, sheet.length, rows});
}

/// One sheet on three meshes, finer and finer.
struct SheetLadder {
  Sheet sheet;
  Comparison wavelength, compression;  // over the law's [1]
  WrinkledSheet finest;
};

SheetLadder ladder_of(const Subject& subject, const Sheet& sheet, Table& levels) {
  SheetLadder result{sheet, {}, {}, {}};
  Ladder wavelengths, compressions;
  wavelengths.floor = 1e-6;  // twice what the search for the least leaves open
  compressions.floor = 1e-7;
  const int coarsest = rows_of(sheet, 2);
  for (const int rows : {coarsest, 2 * coarsest, 4 * coarsest}) {
    result.finest = on_mesh(subject, sheet, rows);
    wavelengths.values.push_back(result.finest.wavelength / law_of_wavelength(sheet));
    compressions.values.push_back(result.finest.compression / law_of_compression(sheet));
    update_worst(compressions.floor, result.finest.unfinished);
    levels.row(words_of(sheet), rows, result.finest.wavelength, result.finest.compression,
               wavelengths.values.back(), compressions.values.back());
  }
  const double reach = reach_of(sheet) / sheet.length;
  const oracles::Wrinkles should = oracles::wrinkles_by_functions(reach);
  const auto over_law = [&](const oracles::Estimate& value, double law) {
    return oracles::Estimate{value.value / law, value.uncertainty / law};
  };
  result.wavelength =
      compare_ladder(words_of(sheet), wavelengths,
                     over_law(should.wavelength, law_of_wavelength(sheet) / sheet.length));
  result.compression =
      compare_ladder(words_of(sheet), compressions,
                     over_law(should.compression, law_of_compression(sheet) / sheet.tension));
  return result;
}

NamedFinding wavelength_agrees(const std::vector<SheetLadder>& ladders) {
  Table table = no_comparisons("1");
  for (const SheetLadder& one : ladders) add_comparison(table, one.wavelength, resolution);
  return {"stretched-wrinkles.wavelength-agrees",
          "A stretched sheet that is compressed across wrinkles with the wavelength of a plate "
          "under tension with the mesh's own rigidity, within one percent.",
          judge_comparisons(std::move(table), resolution, "one percent of a wavelength",
                            "over 2 pi^(1/2) (D/T)^(1/4) L^(1/2)")};
}

NamedFinding compression_agrees(const std::vector<SheetLadder>& ladders) {
  Table table = no_comparisons("1");
  for (const SheetLadder& one : ladders) add_comparison(table, one.compression, load_resolution);
  return {"stretched-wrinkles.compression-agrees",
          "The sheet wrinkles at the compression of a plate under tension, within two percent. "
          "Poisson's ratio 1/3 of the springs takes part: by it the tension narrows the sheet.",
          judge_comparisons(std::move(table), load_resolution, "two percent of a load",
                            "over 2 pi (D T)^(1/2)/L")};
}

/// From the first sheet to the farthest that differs in one number.
NamedFinding exponent_agrees(const std::vector<SheetLadder>& ladders, Varied varied) {
  const SheetLadder& first = ladders.front();
  const SheetLadder& last = *std::find_if(ladders.rbegin(), ladders.rend(), [&](const auto& one) {
    return one.sheet.varied == varied;
  });
  const double range = std::log(last.sheet.factor);
  const double law = std::log(law_of_wavelength(last.sheet) / law_of_wavelength(first.sheet));
  const auto exponent = [&](double first_over_law, double last_over_law) {
    return (std::log(last_over_law / first_over_law) + law) / range;
  };
  const auto relative = [](const Comparison& one) { return one.numerical / one.simulated; };
  const double should = exponent_of(varied);
  const Comparison comparison{
      fmt::format("exponent of the {}", name_of(varied)),
      exponent(first.wavelength.simulated, last.wavelength.simulated),
      (relative(first.wavelength) + relative(last.wavelength)) / std::abs(range),
      {should,
       std::abs(std::log(last.wavelength.should.value / first.wavelength.should.value) / range)}};
  const double at_ends = 2 * resolution / std::abs(range);
  Table table = no_comparisons("1");
  add_comparison(table, comparison, at_ends);
  return {
      fmt::format("stretched-wrinkles.exponent-agrees.{}", name_of(varied)),
      fmt::format("The wavelength goes with the power {:g} of the {}.", should, name_of(varied)),
      judge_comparisons(
          std::move(table), at_ends, "one percent of the wavelength at either end of the range",
          fmt::format("over a factor of {:g}; the uncertainty of D is what the law leaves out",
                      last.sheet.factor))};
}

NamedFinding prefactor_agrees(const SheetLadder& longest) {
  const double pi_root = 2 * std::sqrt(std::numbers::pi);
  const oracles::Wrinkles law =
      oracles::wrinkles_by_scaling(reach_of(longest.sheet) / longest.sheet.length);
  const double u = law.wavelength.uncertainty / law.wavelength.value;
  return {"stretched-wrinkles.prefactor-agrees",
          "Where bending reaches least far against the length, the wavelength is 2 pi^(1/2) "
          "(D/T)^(1/4) L^(1/2), within one percent.",
          judge_comparison({"wavelength over (D/T)^(1/4) L^(1/2)",
                            pi_root * longest.wavelength.simulated,
                            pi_root * longest.wavelength.numerical,
                            {pi_root, pi_root * u}},
                           pi_root * resolution, "one percent of a wavelength",
                           words_of(longest.sheet))};
}

/// Meshes whose edges are longer than bending reaches.
NamedFinding tension_stiffens(const Subject& subject, const Sheet& sheet, Tier tier,
                              Figure& figure) {
  std::vector<double> edges{4, 8};
  if (tier == Tier::full) edges = {3, 4, 6, 8, 12, 16};
  Table table = no_comparisons("1");
  Curve simulated{"simulated"}, expected{"D + T edge^2/48"};
  for (const double count : edges) {
    const int rows = rows_of(sheet, count);
    const WrinkledSheet found = on_mesh(subject, sheet, rows);
    const double edge = edge_of({sheet.rigidity, sheet.tension, sheet.length, rows});
    const oracles::Estimate D = oracles::rigidity_under_tension(
        sheet.rigidity, sheet.tension, edge, 2 * std::numbers::pi / found.wavelength);
    const oracles::Wrinkles should =
        oracles::wrinkles_by_functions(std::sqrt(D.value / sheet.tension) / sheet.length);
    const double law = law_of_wavelength(sheet),
                 D_over_law = should.wavelength.value / (law / sheet.length);
    const double in_reaches = edge / reach_of(sheet), S_over_law = found.wavelength / law;
    add_comparison(table,
                   {fmt::format("edges of {:.2f} reaches", in_reaches),
                    S_over_law,
                    1e-6 * S_over_law,
                    // the wavelength goes with the fourth root of the rigidity
                    {D_over_law, D_over_law * D.uncertainty / D.value / 4}},
                   resolution);
    simulated.point(in_reaches, S_over_law);
    expected.point(in_reaches, D_over_law);
  }
  figure.curves = {simulated, expected};
  return {"stretched-wrinkles.tension-stiffens-coarse-meshes",
          "On edges longer than (D/T)^(1/2) the tension itself resists waves across it, as an "
          "added rigidity of T edge^2/48 would: the wrinkles are too wide, as that rigidity says.",
          judge_comparisons(std::move(table), resolution, "one percent of a wavelength",
                            "over the law for D alone; one reach is (D/T)^(1/2)")};
}

Figure wavelength_figure(const std::vector<SheetLadder>& ladders) {
  Figure figure{"wavelengths",
                "Wavelength over the sheet's length",
                {"(D/T)^(1/2) over the length", "1", Scale::log},
                {"wavelength over the length", "1", Scale::log},
                0.5,
                "Sheets that differ in one number lie on one curve."};
  for (const Varied varied : {Varied::tension, Varied::length, Varied::rigidity}) {
    Curve curve{fmt::format("simulated, other {}", name_of(varied))};
    for (const SheetLadder& one : ladders)
      if (one.sheet.varied == varied || one.sheet.varied == Varied::nothing)
        curve.point(reach_of(one.sheet) / one.sheet.length,
                    one.finest.wavelength / one.sheet.length);
    figure.curves.push_back(std::move(curve));
  }
  Curve plate{"plate under tension"}, law{"law"};
  for (double reach = 1e-4; reach < 0.1; reach *= 1.5) {
    plate.point(reach, oracles::wrinkles_by_functions(reach).wavelength.value);
    law.point(reach, 2 * std::sqrt(std::numbers::pi * reach));
  }
  figure.curves.push_back(std::move(plate));
  figure.curves.push_back(std::move(law));
  return figure;
}

Figure profile_figure(const SheetLadder& first) {
  Figure figure{"profile",
                "A wrinkle along the tension",
                {"place over the length", "1"},
                {"height over the greatest", "1"},
                "The first sheet on its finest mesh beside the plate, by functions."};
  Curve simulated{"simulated"};
  const std::vector<double>& rows = first.finest.profile;
  const std::size_t stride = std::max<std::size_t>(rows.size() / 40, 1);
  for (std::size_t i = 0; i < rows.size(); i += stride)
    // row 0 is half a row before the clamp's middle
    simulated.point((double(i) + 0.5) / double(rows.size()), rows[i]);
  const std::vector<double> places = linear_range(0, 1, 101);
  const Curve plate{"plate under tension", places,
                    oracles::wrinkle_profile(reach_of(first.sheet) / first.sheet.length, places)};
  figure.curves = {simulated, plate};
  return figure;
}

Figure coarse_figure() {
  return {"coarse-meshes",
          "Wavelength on edges longer than bending reaches",
          {"edge over (D/T)^(1/2)", "1", Scale::log},
          {"wavelength over the law's for D", "1"},
          "A sheet needs edges below (D/T)^(1/2), not only below the wavelength."};
}

StudyResult run_stretched_wrinkles(const Subject& subject, Tier tier, const Progress& progress) {
  StudyResult result;
  Table levels(
      "sheet; rows of triangles [1]; wavelength [m]; compression [N/m]; wavelength over the law's "
      "[1]; compression over the law's [1]");
  const std::vector<Sheet> sheets = sheets_of(tier);
  std::vector<SheetLadder> ladders;
  for (const Sheet& sheet : sheets) {
    ladders.push_back(ladder_of(subject, sheet, levels));
    progress(double(ladders.size()) / double(2 * sheets.size()));
  }
  Figure coarse = coarse_figure();
  result.findings = {wavelength_agrees(ladders), compression_agrees(ladders)};
  for (const Varied varied : {Varied::tension, Varied::length, Varied::rigidity})
    result.findings.push_back(exponent_agrees(ladders, varied));
  result.add({prefactor_agrees(ladders.back()),
              tension_stiffens(subject, ladders.back().sheet, tier, coarse)});
  result.figures = {wavelength_figure(ladders), profile_figure(ladders.front()), coarse};
  result.tables.push_back({"meshes", "Every sheet on every mesh", levels});
  add_clamped_continuum(subject, result);
  add_deep_wrinkles(subject, tier, progress, result);
  if (tier == Tier::full) add_clamped_wrinkles(subject, result);
  return result;
}

}  // namespace

Study stretched_wrinkles_study() {
  return {
      "stretched-wrinkles",
      "A stretched sheet that is compressed across wrinkles with the wavelength 2 pi^(1/2) "
      "(D/T)^(1/4) L^(1/2) of Cerda and Mahadevan, with the mesh's own rigidity D, where edges are "
      "shorter than (D/T)^(1/2). On longer edges the tension stiffens the mesh. Beyond the onset "
      "its waves are as high as a plate's.",
      {"wavelength-agrees", "exponent-agrees", "prefactor-agrees", "tension-stiffens-coarse-meshes",
       "amplitude-agrees"},
      "Cerda and Mahadevan, Phys. Rev. Lett. 90 (2003) 074302",
      "A sheet is clamped at both ends, stretched, and compressed across by a force b per length; "
      "across it is endless. The wavelength is the one that leaves the plane under the least b. S "
      "is that of the finest of three meshes, with the ladder's error bar; D is a plate under "
      "tension, whose distance from the law is the law's uncertainty. For the height of deep "
      "wrinkles every section is made shorter by Delta/W, at the law's wavelength: then the "
      "profile along the tension is flat where it is deep, and the amplitude tends to (1/pi) "
      "wavelength (Delta/W)^(1/2), not to the law's (2^(1/2)/pi) wavelength (Delta/W)^(1/2), which "
      "is for a sine. In an experiment the clamps compress the sheet. Such sheets are compared, "
      "flat, with a continuum (both tiers), and wrinkled with the law (full tier). Strains are "
      "below 0.001: wrinkles that vanish again under large strains (Nayyar, Ravi-Chandar and "
      "Huang, Int. J. Solids Struct. 48 (2011) 3471) are not seen. No measured sheet is compared.",
      run_stretched_wrinkles,
      "validation"};
}

}  // namespace foldproof
