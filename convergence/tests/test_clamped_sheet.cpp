// A sheet that only its clamps compress.
#include <catch2/catch.hpp>
#include <algorithm>
#include <cmath>

#include "convergence/validation/clamped_sheet.h"
#include "verification/oracles/sheets/clamped_stress.h"
#include "verification/subjects/reference_subject.h"

using namespace foldproof;

TEST_CASE("the mean wavelength of a fine sine is its own") {
  Section section;
  for (int i = 0; i <= 400; ++i) {
    section.places.push_back(0.3 * i / 400);
    section.heights.push_back(0.7 * std::cos(2 * pi * section.places.back() / 0.06));
  }
  CHECK(wavelength_of(section) == Approx(0.06).epsilon(1e-3));
}

TEST_CASE("clamps compress a long sheet across, not a short one, and wrinkle it") {
  ClampedSheet sheet{1.1e-8, 2000, 0.1, 7e-4, 14, 50};
  CHECK(length_of(sheet) == Approx(0.2).epsilon(1e-3));
  const ClampedFlat flat = clamped_flat(reference_subject(), sheet);
  CHECK(flat.tension == Approx(sheet.young * sheet.strain).epsilon(0.05));
  CHECK(std::ranges::max(flat.stresses) > 0.2 * flat.tension);  // near the clamps
  CHECK(flat.stresses.back() < -0.005 * flat.tension);          // halfway between them
  CHECK(flat.onset > 0);
  CHECK(flat.onset < 1);

  const ClampedWrinkles wrinkles = clamped_wrinkles(reference_subject(), sheet, flat);
  CHECK(wrinkles.stable);
  CHECK(wrinkles.unbalanced < 1e-9);
  CHECK(std::abs(wrinkles.section.heights.front()) > 1e-4 * sheet.width);

  sheet.half_edges = 26;
  const ClampedFlat wide = clamped_flat(reference_subject(), sheet);
  CHECK(std::ranges::min(wide.stresses) > 0);
  CHECK(std::isnan(wide.onset));
}

TEST_CASE("a coarse clamped sheet is compressed as a continuum, within a tenth") {
  const ClampedSheet sheet{0.1, 2000, 0.1, 1e-4, 18, 64};
  const ClampedFlat flat = clamped_flat(reference_subject(), sheet);
  const double places[] = {0.5}, ratio = length_of(sheet) / sheet.width;
  const double stress = oracles::clamped_stress_by_stresses({ratio, 1.0 / 3}, places)[0].value;
  CHECK(flat.stresses.back() / flat.tension == Approx(stress).epsilon(0.1));
  CHECK_THROWS_WITH(oracles::clamped_stress_by_displacements({0.4, 1.0 / 3}, places),
                    Catch::Contains("out of range"));
}
