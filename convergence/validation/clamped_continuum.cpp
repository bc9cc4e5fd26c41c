#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "convergence/validation/clamped_findings.h"
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

}  // namespace

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
