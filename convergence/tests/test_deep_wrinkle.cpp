// Unknowns that several particles share, and half a wave of a stretched sheet.
#include <catch2/catch.hpp>

#include "convergence/validation/deep_wrinkle.h"
#include "convergence/validation/freedoms.h"
#include "verification/subjects/reference_subject.h"

using namespace foldproof;

TEST_CASE("an image moves as its original does in a mirror, and its force does not count") {
  Freedoms freedoms;
  freedoms.count = 2;
  freedoms.of = {{Freedom{0, 1}, Freedom{}, Freedom{1, 1}},
                 {Freedom{0, -1}, Freedom{}, Freedom{1, 1}}};
  freedoms.share = {0.5, 0};
  PerParticle3 x(3, 2), force(3, 2);
  x << 3, -3, 7, 7, 0.4, 0.4;
  force << 12, 5, 11, 13, -8, 17;
  const PerParticle3 moved = freedoms.moved(x, Eigen::Vector2d(0.25, -0.1));
  CHECK(moved.col(0) == Vector3(3.25, 7, 0.4 - 0.1));
  CHECK(moved.col(1) == Vector3(-3.25, 7, 0.4 - 0.1));
  CHECK(freedoms.gather(force) == Eigen::Vector2d(6, -4));
}

TEST_CASE("a stretched sheet stays flat short of the onset and folds beyond it") {
  DeepWrinkleSheet sheet{9e-6, 2.9, 2.9e4, 0.15, 0, 18, 6};
  const double reach = std::sqrt(sheet.rigidity / sheet.tension) / sheet.length;
  const double onset = 2 * pi * reach * sheet.tension / sheet.young;
  const double fold = wavelength_of(sheet) / pi;
  sheet.compression = onset / 3;
  CHECK(std::abs(deep_wrinkle(reference_subject(), sheet).amplitude) < 1e-6 * fold);
  sheet.compression = 5 * onset;
  const DeepWrinkle folded = deep_wrinkle(reference_subject(), sheet);
  CHECK(folded.stable);
  CHECK(folded.unbalanced < 1e-9);
  CHECK(folded.amplitude > 0.6 * fold * std::sqrt(sheet.compression));
  CHECK(folded.amplitudes.front() == 0);
  CHECK(folded.amplitudes.back() == 0);
}
