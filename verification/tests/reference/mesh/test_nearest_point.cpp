// The nearest point of a triangle: ties between its parts.
#include <catch2/catch.hpp>

#include "reference/mesh/nearest_point.h"

using namespace foldproof;

TEST_CASE("what lies between two regions of a triangle belongs to its corner") {
  const Corners3 corners{Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0, 1, 0)};
  const auto feature_at = [&](double x, double y) {
    return nearest_on_triangle(corners, {x, y, 3}).feature;
  };
  CHECK(feature_at(0, -1) == Feature::a);
  CHECK(feature_at(-1, 0) == Feature::a);
  CHECK(feature_at(1, -1) == Feature::b);
  CHECK(feature_at(2, 1) == Feature::b);
  CHECK(feature_at(-1, 1) == Feature::c);
  CHECK(feature_at(1, 2) == Feature::c);
  // on the edges themselves
  CHECK(feature_at(0.5, 0) == Feature::ab);
  CHECK(feature_at(0, 0.5) == Feature::ca);
  CHECK(feature_at(0.5, 0.5) == Feature::bc);
  CHECK(feature_at(0.5, -1) == Feature::ab);
  const NearestFeature within = nearest_on_triangle(corners, {0.5, 0.25, 3});
  CHECK(within.triangle == -1);
  CHECK(within.feature == Feature::face);
  CHECK(within.point == Vector3(0.5, 0.25, 0));
  CHECK(within.squared_distance == 9);
}
