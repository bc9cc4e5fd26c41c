// The nearest point of a triangle, against the nearest of its seven parts.
#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <random>
#include <utility>

#include "reference/mesh/nearest_point.h"

using namespace foldproof;

namespace {

struct Candidate {
  Feature feature;
  Vector3 point;
};

/// The nearest of: the foot on the plane if inside, the feet on the edges if between their
/// ends, the corners.
Candidate nearest_of_parts(const Corners3& t, const Vector3& p) {
  std::vector<Candidate> all{{Feature::a, t[0]}, {Feature::b, t[1]}, {Feature::c, t[2]}};
  const Feature edges[] = {Feature::ab, Feature::bc, Feature::ca};
  for (size_t k = 0; k < 3; ++k) {
    const Vector3 from = t[k], along = t[(k + 1) % 3] - from;
    const double share = along.dot(p - from) / along.squaredNorm();
    if (share > 0 && share < 1) all.push_back({edges[k], from + share * along});
  }
  const Vector3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
  const Vector3 foot = p - normal.dot(p - t[0]) / normal.squaredNorm() * normal;
  const auto is_left_of = [&](size_t k) {
    return (t[(k + 1) % 3] - t[k]).cross(foot - t[k]).dot(normal) > 0;
  };
  if (is_left_of(0) && is_left_of(1) && is_left_of(2)) all.push_back({Feature::face, foot});
  return *std::ranges::min_element(all, {},
                                   [&](const Candidate& c) { return (c.point - p).squaredNorm(); });
}

}  // namespace

TEST_CASE("the nearest point of a triangle is the nearest of its corners, edges and face") {
  std::mt19937 random(83);
  std::uniform_real_distribution<double> inside(-1, 1);
  const auto vector = [&] { return Vector3(inside(random), inside(random), inside(random)); };
  std::map<Feature, int> found;
  for (int k = 0; k < 4000; ++k) {
    const Vector3 place = 7 * vector();
    const Corners3 t{place + vector(), place + vector(), place + vector()};
    const Vector3 p = place + 1.3 * vector();
    const Candidate expected = nearest_of_parts(t, p);
    const NearestFeature nearest = nearest_on_triangle(t, p);
    REQUIRE(nearest.triangle == -1);
    REQUIRE(nearest.feature == expected.feature);
    REQUIRE((nearest.point - expected.point).norm() < 1e-9);
    REQUIRE(nearest.squared_distance == (p - nearest.point).squaredNorm());
    ++found[nearest.feature];
  }
  CHECK(found.size() == 7);
  for (const auto& [feature, count] : found) CHECK(count > 100);
}

TEST_CASE("what is nearest to a corner's or an edge's very border belongs to the smaller part") {
  // sides of whole numbers, so that all products are exact
  const Corners3 t{Vector3(2, 3, 5), Vector3(6, 3, 5), Vector3(2, 9, 5)};
  const auto feature_at = [&](double x, double y) {
    return nearest_on_triangle(t, Vector3(x, y, 8)).feature;
  };
  // across the ends of ab and ac
  CHECK(feature_at(2, 1) == Feature::a);
  CHECK(feature_at(1, 3) == Feature::a);
  CHECK(feature_at(6, 2) == Feature::b);
  CHECK(feature_at(1, 9) == Feature::c);
  // on lines at right angles to bc = (-4, 6), through b and c
  CHECK(feature_at(12, 7) == Feature::b);
  CHECK(feature_at(8, 13) == Feature::c);
  CHECK(feature_at(11, 7) == Feature::bc);
  // on the edges and the corners themselves
  CHECK(feature_at(3, 3) == Feature::ab);
  CHECK(feature_at(2, 7) == Feature::ca);
  CHECK(feature_at(4, 6) == Feature::bc);
  CHECK(feature_at(2, 3) == Feature::a);
  CHECK(feature_at(6, 3) == Feature::b);
  CHECK(feature_at(2, 9) == Feature::c);
  CHECK(nearest_on_triangle(t, Vector3(3, 3, 8)).squared_distance == 9);
  CHECK(nearest_on_triangle(t, Vector3(3, 5, 8)).point == Vector3(3, 5, 5));
}

TEST_CASE("without a nearest triangle there is none, infinitely far away") {
  const NearestFeature none;
  CHECK(none.triangle == -1);
  CHECK(none.feature == Feature::face);
  CHECK(none.point == Vector3::Zero());
  CHECK(none.squared_distance == std::numeric_limits<double>::infinity());
}

TEST_CASE("what lies between two regions of a triangle belongs to its corner") {
  const Corners3 corners{Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0, 1, 0)};
  CHECK(nearest_on_triangle(corners, {0, -1, 0}).feature == Feature::a);
  CHECK(nearest_on_triangle(corners, {1, -1, 0}).feature == Feature::b);
  CHECK(nearest_on_triangle(corners, {-1, 1, 0}).feature == Feature::c);
  CHECK(nearest_on_triangle(corners, {0.5, -1, 0}).feature == Feature::ab);
}
