// Winding numbers far away, and repaired meshes: which way triangles are turned, and distances.
#include <catch2/catch.hpp>
#include <random>

#include "reference/bodies/repair.h"
#include "reference/bodies/winding.h"
#include "reference/mesh/nearest_point.h"
#include "reference/mesh/shapes.h"

using namespace foldproof;

namespace {

std::vector<Triangle> flipped(std::vector<Triangle> triangles, const std::vector<size_t>& which) {
  for (const size_t t : which) std::swap(triangles[t][1], triangles[t][2]);
  return triangles;
}

}  // namespace

TEST_CASE("far from a patch its winding number is as good as that of its second-order expansion") {
  TriangleMesh bowl = make_icosphere(0.7, 1);
  bowl.triangles.resize(30);
  const MeshDistance mesh = make_mesh_distance(bowl.rest, bowl.triangles);
  const std::vector<Dipole> dipoles = make_dipoles(mesh);
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const auto worst_error = [&](double radii, double far) {
    double worst = 0;
    for (int k = 0; k < 30; ++k) {
      const Vector3 way = Vector3(normal(random), normal(random), normal(random)).normalized();
      const Vector3 p = dipoles[0].centre + radii * dipoles[0].radius * way;
      worst = std::max(worst, std::abs(winding_number(mesh, dipoles, p, far) -
                                       winding_number(mesh.x, mesh.triangles, p)));
    }
    return worst;
  };
  CHECK(worst_error(1.5, 1e9) < 1e-12);
  // what is left falls with the fourth power of the distance
  CHECK(worst_error(100, 2) < 5e-10);
}

TEST_CASE("triangles without area, by their shape, are left out of a repair") {
  for (const double size : {1e-4, 1.0, 1e4})
    for (int turn = 0; turn < 3; ++turn) {
      // area over the longest side squared: half of the height
      PerParticle3 x(3, 6);
      x << 0, 1, 0.4, 0, 1, 0.4, 0, 0, 1.9e-12, 0, 0, 2.1e-12, 0, 0, 0, 1, 1, 1;
      const auto turned = [&](int first) {
        return Triangle{first + turn, first + (turn + 1) % 3, first + (turn + 2) % 3};
      };
      const TriangleSoup soup{size * x, {turned(0), turned(3)}, {}};
      CHECK(orient_triangles(soup) == std::vector<Triangle>{turned(3)});
    }
}

TEST_CASE("the larger part of a patch's area keeps its orientation") {
  const TriangleMesh ball = make_icosphere(0.9, 1);
  std::mt19937 random(8);
  for (int k = 0; k < 20; ++k) {
    std::vector<size_t> some, others;
    for (size_t t = 0; t < ball.triangles.size(); ++t)
      (random() % 3 == 0 ? some : others).push_back(t);
    CHECK(orient_triangles({ball.rest, flipped(ball.triangles, some), {}}) == ball.triangles);
    CHECK(orient_triangles({ball.rest, flipped(ball.triangles, others), {}}) ==
          flipped(flipped(ball.triangles, some), others));
  }
}

TEST_CASE("patches are turned by their own larger area, of equal ones to their first triangle") {
  // a strip of triangles (0, 1, 2), (2, 1, 3), (2, 3, 4) with their heights; another far beside it
  const auto strip = [](double first, double rest) {
    PerParticle3 x = PerParticle3::Zero(3, 10);
    x.row(0) << -first, 0, 0, rest, rest, 15, 20, 20, 22, 22;
    x.row(1) << 0, -1, 1, -1, 1, 0, -1, 1, -1, 1;
    return x;
  };
  const std::vector<Triangle> even{{0, 1, 2}, {2, 1, 3}, {2, 3, 4},
                                   {5, 6, 7}, {7, 6, 8}, {7, 8, 9}};
  const auto turned = [&](double first, const std::vector<size_t>& which) {
    return orient_triangles({strip(first, 2), flipped(even, which), {}});
  };
  // areas: first, 2, 2; and 5, 2, 2
  CHECK(turned(5, {0}) == flipped(even, {0, 1, 2}));
  CHECK(turned(3, {0}) == even);
  CHECK(turned(4, {0}) == flipped(even, {0, 1, 2}));
  CHECK(turned(4, {1, 2}) == even);
  CHECK(turned(5, {2, 4}) == even);
  // three triangles at the edge 0-1, of which two run the same way: sheets of their own
  const std::vector<Triangle> fins{{0, 1, 2}, {0, 1, 3}, {1, 0, 4}};
  CHECK(orient_triangles({strip(5, 2), fins, {}}) == fins);
}

TEST_CASE("a repaired level set has exact distances at the surface, and closes over holes") {
  const TriangleMesh ball = make_icosphere(0.8, 2);
  std::vector<Triangle> open;
  for (const Triangle& t : ball.triangles)
    if ((ball.rest.col(t[0]) + ball.rest.col(t[1]) + ball.rest.col(t[2])).x() < 1.65)
      open.push_back(t);
  const std::shared_ptr<const Grid> grid = make_level_set(
      {ball.rest, flipped(open, {3, 4}), {}}, {11, 3, 2, MarchingOrder::first}, Repair::winding);
  const MeshDistance mesh = make_mesh_distance(ball.rest, open);
  const std::vector<Dipole> dipoles = make_dipoles(mesh);
  const Lattice& lattice = grid->lattice;
  int exact = 0, over_the_hole = 0;
  for (long i = 0; i + 1 < lattice.size(); ++i) {
    const double phi = grid->phi[size_t(i)];
    const Vector3 p = lattice.position(lattice.node(i));
    CHECK((phi < 0) == (winding_number(mesh, dipoles, p, 2) > 0.5));
    const bool is_next = lattice.position(lattice.node(i + 1)).x() > p.x();
    if (!is_next || (phi < 0) == (grid->phi[size_t(i) + 1] < 0)) continue;
    double nearest = 1e300;
    for (const Corners3& t : mesh.corners)
      nearest = std::min(nearest, std::sqrt(nearest_on_triangle(t, p).squared_distance));
    const bool is_near = nearest < lattice.spacing;
    if (is_near) CHECK(std::abs(phi) == Approx(nearest).margin(1e-13));
    ++(is_near ? exact : over_the_hole);
  }
  CHECK(exact > 50);
  CHECK(over_the_hole > 0);
}
