// The statue, in its two kinds of triangles.
#include <Eigen/Geometry>
#include <array>
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

TEST_CASE("mesh: the statue is the figure that its limbs make") {
  const TriangleMesh statue = make_statue(1, 3);
  const PerParticle3& x = statue.rest;
  // as it was designed: every limb and fold has a part in these
  const std::array<double, 3> moments{0.0594365028, 0.268083368, 0.0301511016};  // m^4
  CHECK(volume(statue) == Approx(0.116025753).epsilon(1e-8));
  for (int axis = 0; axis < 3; ++axis)
    CHECK(x.row(axis).cwiseAbs2().dot(lumped_masses(statue, 1).transpose()) ==
          Approx(moments[size_t(axis)]).epsilon(1e-8));
}

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
