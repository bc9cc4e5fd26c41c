// Discs, cylinders, spheres, hinges, pleats: vertices, triangles and limits.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <functional>

#include "reference/mesh/shapes.h"

using namespace foldproof;

TEST_CASE("a divided triangle has its parts in the order described") {
  PerParticle3 x = PerParticle3::Zero(3, 3);
  x(0, 1) = x(1, 2) = 4;
  const TriangleMesh mesh = make_triangle_mesh(x, {{0, 1, 2}});
  const TriangleMesh fine = divide_edges(mesh, 4);
  PerParticle3 places = PerParticle3::Zero(3, 15);  // corners, edges 01, 02, 12, inside
  places.row(0) << 0, 4, 0, 1, 2, 3, 0, 0, 0, 3, 2, 1, 1, 2, 1;
  places.row(1) << 0, 0, 4, 0, 0, 0, 1, 2, 3, 1, 2, 3, 1, 1, 2;
  CHECK((fine.rest - places).cwiseAbs().maxCoeff() < 1e-15);
  // row by row: those like the triangle, then those that are turned
  const std::vector<Triangle> expected{{0, 3, 6},    {3, 4, 12},   {4, 5, 13},   {5, 1, 9},
                                       {6, 12, 7},   {12, 13, 14}, {13, 9, 10},  {7, 14, 8},
                                       {14, 10, 11}, {8, 11, 2},   {3, 12, 6},   {4, 13, 12},
                                       {5, 9, 13},   {12, 14, 7},  {13, 10, 14}, {14, 11, 8}};
  CHECK(fine.triangles == expected);
  CHECK(divide_edges(mesh, 1).triangles == mesh.triangles);
  CHECK_THROWS_WITH(divide_edges(mesh, 0), "divided: parts is 0; give 1 or more");
}

TEST_CASE("spheres are divided icosahedra whose vertices are carried out to the radius") {
  const auto check_carried = [](const TriangleMesh& sphere, TriangleMesh divided) {
    divided.rest.colwise().normalize();
    CHECK(sphere.triangles == divided.triangles);
    CHECK((sphere.rest - 0.7 * divided.rest).cwiseAbs().maxCoeff() < 1e-15);
  };
  const TriangleMesh twelve = make_icosphere(1, 0);
  check_carried(make_icosphere(0.7, 0), twelve);
  check_carried(make_icosphere(0.7, 2), divide_edges(make_icosphere(1, 1), 2));
  for (const int divisions : {1, 3, 4})
    check_carried(make_geodesic_sphere(0.7, divisions), divide_edges(twelve, divisions));
}
