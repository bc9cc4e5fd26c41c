// The statue, in its two kinds of triangles.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "reference/mesh/self_intersection.h"
#include "reference/mesh/shapes.h"

using namespace foldproof;

namespace {

double volume(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    sum += Vector3(mesh.rest.col(a)).cross(Vector3(mesh.rest.col(b))).dot(mesh.rest.col(c)) / 6;
  return sum;
}

/// On its base, of the height 1.7 m, and nowhere through itself.
void check_stands(const TriangleMesh& statue) {
  CHECK(statue.rest.row(1).minCoeff() == 0);
  CHECK(std::abs(statue.rest.row(1).maxCoeff() - 1.7) < 4 * std::numeric_limits<double>::epsilon());
  CHECK(self_intersections(statue.rest, statue.triangles).empty());
}

}  // namespace

TEST_CASE("mesh: the even statue is clean, too, and its smallest triangle is larger") {
  const TriangleMesh even = make_even_statue(1.7, 32), plain = make_statue(1.7, 5);
  REQUIRE(even.triangles.size() == plain.triangles.size());
  const double of_even = triangle_areas(even.triangles, even.rest).minCoeff();
  CHECK(of_even > 1.5 * triangle_areas(plain.triangles, plain.rest).minCoeff());
  CHECK(volume(even) == Approx(volume(plain)).epsilon(0.01));
  check_stands(even);
  check_stands(plain);
  CHECK_THROWS_WITH(make_even_statue(1.7, 14), Catch::Contains("give 15 to 256"));
}
