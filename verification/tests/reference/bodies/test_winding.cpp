// Winding numbers, and level sets of meshes that are repaired.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <random>

#include "reference/bodies/repair.h"
#include "reference/bodies/winding.h"
#include "reference/mesh/nearest_point.h"
#include "reference/mesh/shapes.h"

using namespace foldproof;
using Catch::Matchers::Contains;

namespace {

/// The angle at `at` of a spherical triangle on the unit sphere [rad].
double angle_at(const Vector3& at, const Vector3& b, const Vector3& c) {
  const Vector3 n = at.cross(b).normalized(), m = at.cross(c).normalized();
  return std::atan2(n.cross(m).norm(), n.dot(m));
}

/// The share of the sphere that a triangle covers: the spherical excess (Girard), positive where
/// its back is seen.
double share_of_sphere(const Vector3& a, const Vector3& b, const Vector3& c) {
  const Vector3 u = a.normalized(), v = b.normalized(), w = c.normalized();
  const double excess = angle_at(u, v, w) + angle_at(v, w, u) + angle_at(w, u, v) - pi;
  return (a.dot(b.cross(c)) > 0 ? 1 : -1) * excess / (4 * pi);
}

/// An uneven closed surface of 320 triangles, off the origin.
MeshDistance blob() {
  TriangleMesh ball = make_icosphere(0.7, 2);
  for (int i = 0; i < ball.particles(); ++i) {
    const Vector3 x = ball.rest.col(i);
    ball.rest.col(i) = Vector3(0.4, -0.3, 0.9) + (1 + 0.3 * x.x() + 0.2 * x.y() * x.z()) * x;
  }
  return make_mesh_distance(ball.rest, ball.triangles);
}

Vector3 some_point(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> place(-size, size);
  return {place(random), place(random), place(random)};
}

Vector3 centre_of(const Corners3& t) { return (t[0] + t[1] + t[2]) / 3; }
Vector3 area_of(const Corners3& t) { return (t[1] - t[0]).cross(t[2] - t[0]) / 2; }

/// A dipole's share of the sphere: area . f + slope : grad f for f = r/|r|^3, by differences.
double far_share(const Dipole& dipole, const Vector3& p) {
  const auto f = [](const Vector3& r) { return Vector3(r / std::pow(r.norm(), 3)); };
  const Vector3 r = dipole.centre - p;
  const double step = 1e-3 * r.norm();
  double sum = dipole.area.dot(f(r));
  for (int j = 0; j < 3; ++j) {
    const Vector3 d = step * Vector3::Unit(j);
    const Vector3 slope = (8 * (f(r + d) - f(r - d)) - (f(r + 2 * d) - f(r - 2 * d))) / (12 * step);
    sum += dipole.slope.col(j).dot(slope);
  }
  return sum / (4 * pi);
}

double tree_share(const MeshDistance& mesh, const std::vector<Dipole>& dipoles, int node,
                  const Vector3& p, double far) {
  const BoxNode& at = mesh.tree.nodes[size_t(node)];
  const Dipole& dipole = dipoles[size_t(node)];
  if ((dipole.centre - p).norm() > far * dipole.radius) return far_share(dipole, p);
  if (at.right >= 0)
    return tree_share(mesh, dipoles, node + 1, p, far) +
           tree_share(mesh, dipoles, at.right, p, far);
  double sum = 0;
  for (int i = at.first; i < at.first + at.count; ++i) {
    const Corners3& t = mesh.corners[size_t(i)];
    sum += share_of_sphere(t[0] - p, t[1] - p, t[2] - p);
  }
  return sum;
}

}  // namespace

TEST_CASE("a triangle winds by its share of the sphere, several by the sum") {
  std::mt19937 random(11);
  for (int k = 0; k < 200; ++k) {
    PerParticle3 x(3, 5);
    for (int i = 0; i < 5; ++i) x.col(i) = some_point(random, 1);
    const Vector3 p = some_point(random, 0.8);
    const auto share = [&](int a, int b, int c) {
      return share_of_sphere(x.col(a) - p, x.col(b) - p, x.col(c) - p);
    };
    CHECK(winding_number(x, {{1, 4, 2}}, p) == Approx(share(1, 4, 2)).margin(1e-9));
    CHECK(winding_number(x, {{1, 4, 2}, {3, 0, 4}}, p) ==
          Approx(share(1, 4, 2) + share(3, 0, 4)).margin(1e-9));
  }
  CHECK(winding_number(PerParticle3::Identity(3, 3), {{0, 1, 2}}, Vector3::Zero()) ==
        Approx(1. / 8));
}

TEST_CASE("a closed surface winds once around what is inside, and not around the rest") {
  const MeshDistance mesh = blob();
  CHECK(winding_number(mesh.x, mesh.triangles, {0.5, -0.2, 1.1}) == Approx(1));
  CHECK(winding_number(mesh.x, mesh.triangles, {1.5, -0.2, 1.1}) == Approx(0).margin(1e-12));
}

TEST_CASE("a node's dipole has the sums and the spread of its triangles") {
  const MeshDistance mesh = blob();
  const std::vector<Dipole> dipoles = make_dipoles(mesh);
  REQUIRE(dipoles.size() == mesh.tree.nodes.size());
  for (size_t k = 0; k < dipoles.size(); ++k) {
    const BoxNode& node = mesh.tree.nodes[k];
    Vector3 area = Vector3::Zero(), centre = Vector3::Zero();
    double sum = 0, radius = 0;
    Eigen::Matrix3d slope = Eigen::Matrix3d::Zero();
    std::vector<Corners3> own(mesh.corners.begin() + node.first,
                              mesh.corners.begin() + node.first + node.count);
    for (const Corners3& t : own) {
      area += area_of(t);
      centre += area_of(t).norm() * centre_of(t);
      sum += area_of(t).norm();
    }
    centre /= sum;
    for (const Corners3& t : own) {
      slope += area_of(t) * (centre_of(t) - centre).transpose();
      for (const Vector3& corner : t) radius = std::max(radius, (corner - centre).norm());
    }
    CHECK((dipoles[k].area - area).norm() < 1e-14);
    CHECK((dipoles[k].centre - centre).norm() < 1e-14);
    CHECK((dipoles[k].slope - slope).norm() < 1e-14);
    CHECK(dipoles[k].radius == Approx(radius).epsilon(1e-14));
  }
}

TEST_CASE("the tree's winding number is that of its near triangles and its far dipoles") {
  const MeshDistance mesh = blob();
  const std::vector<Dipole> dipoles = make_dipoles(mesh);
  std::mt19937 random(3);
  for (int k = 0; k < 60; ++k) {
    const Vector3 p = Vector3(0.4, -0.3, 0.9) + some_point(random, 1.5);
    for (const double far : {1.2, 2.0, 3.5})
      CHECK(winding_number(mesh, dipoles, p, far) ==
            Approx(tree_share(mesh, dipoles, 0, p, far)).margin(1e-9));
    CHECK(winding_number(mesh, dipoles, p, 1e9) ==
          Approx(winding_number(mesh.x, mesh.triangles, p)).margin(1e-12));
  }
}

TEST_CASE("a node just as far as its limit is summed triangle by triangle") {
  const MeshDistance mesh = make_mesh_distance(
      (PerParticle3(3, 3) << 0, 0.3, 0.1, 0, 0.1, 0.4, 0, 0.2, -0.1).finished(), {{0, 1, 2}});
  const std::vector<Dipole> dipoles = make_dipoles(mesh);
  int equal = 0;
  for (int k = 1; k < 40; ++k) {
    const Vector3 p(0.1 + 0.01 * k, -0.05 * k, 0.3);
    const double distance = (dipoles[0].centre - p).norm(), far = distance / dipoles[0].radius;
    if (far * dipoles[0].radius != distance) continue;
    ++equal;
    CHECK(winding_number(mesh, dipoles, p, far) == winding_number(mesh.x, mesh.triangles, p));
  }
  CHECK(equal > 5);
}

TEST_CASE("triangles without area, by their shape, are left out of a repair") {
  for (const double size : {1e-4, 1.0, 1e4}) {
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
}

namespace {

std::vector<Triangle> flipped(std::vector<Triangle> triangles, const std::vector<size_t>& which) {
  for (const size_t t : which) std::swap(triangles[t][1], triangles[t][2]);
  return triangles;
}

}  // namespace

TEST_CASE("the larger part of a patch's area keeps its orientation") {
  const TriangleMesh ball = make_icosphere(0.9, 1);
  const size_t count = ball.triangles.size();
  std::mt19937 random(8);
  for (int k = 0; k < 20; ++k) {
    std::vector<size_t> some, others;
    for (size_t t = 0; t < count; ++t) (random() % 3 == 0 ? some : others).push_back(t);
    const std::vector<Triangle> turned = flipped(ball.triangles, some);
    CHECK(orient_triangles({ball.rest, turned, {}}) == ball.triangles);
    std::vector<size_t> all = some;
    all.insert(all.end(), others.begin(), others.end());
    CHECK(orient_triangles({ball.rest, flipped(turned, all), {}}) == flipped(ball.triangles, all));
  }
}

TEST_CASE("few large triangles outweigh many small ones, and of equal areas the first is kept") {
  // a strip of triangles (0, 1, 2), (2, 1, 3), (2, 3, 4) with their heights
  const auto strip = [](double first, double rest) {
    PerParticle3 x(3, 5);
    x << -first, 0, 0, rest, rest, 0, -1, 1, -1, 1, 0, 0, 0, 0, 0;
    return x;
  };
  const std::vector<Triangle> even{{0, 1, 2}, {2, 1, 3}, {2, 3, 4}};
  // areas: first, rest, rest
  CHECK(orient_triangles({strip(5, 2), flipped(even, {0}), {}}) == flipped(even, {0, 1, 2}));
  CHECK(orient_triangles({strip(3, 2), flipped(even, {0}), {}}) == even);
  CHECK(orient_triangles({strip(4, 2), flipped(even, {0}), {}}) == flipped(even, {0, 1, 2}));
  CHECK(orient_triangles({strip(4, 2), flipped(even, {1, 2}), {}}) == even);
  CHECK(orient_triangles({strip(3, 2), flipped(even, {2}), {}}) == even);
}

TEST_CASE("each patch is turned by its own area") {
  PerParticle3 x = PerParticle3::Zero(3, 10);
  x.row(0) << -5, 0, 0, 2, 2, 15, 20, 20, 22, 22;
  x.row(1) << 0, -1, 1, -1, 1, 0, -1, 1, -1, 1;
  const std::vector<Triangle> even{{0, 1, 2}, {2, 1, 3}, {2, 3, 4},
                                   {5, 6, 7}, {7, 6, 8}, {7, 8, 9}};
  CHECK(orient_triangles({x, flipped(even, {2, 4}), {}}) == even);
}

TEST_CASE(
    "patches apart, and sheets that meet in an edge of three triangles, keep their own sides") {
  PerParticle3 x(3, 8);
  x << 0, 1, 0, 0, 0, 5, 6, 5, 0, 0, 1, 0, -1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0;
  // three triangles at the edge 0-1, of which two run the same way; and one apart
  const std::vector<Triangle> fins{{0, 1, 2}, {0, 1, 3}, {1, 0, 4}, {5, 7, 6}};
  CHECK(orient_triangles({x, fins, {}}) == fins);
}

TEST_CASE("a repaired level set has exact distances at the surface, and closes over holes") {
  const int subdivisions = GENERATE(0, 2);
  const TriangleMesh ball = make_icosphere(0.8, subdivisions);
  std::vector<Triangle> open;
  for (const Triangle& t : ball.triangles) {
    const Vector3 centre = (ball.rest.col(t[0]) + ball.rest.col(t[1]) + ball.rest.col(t[2])) / 3;
    if (centre.x() < 0.55) open.push_back(t);
  }
  const GridMethod method{11, 3, 2, MarchingOrder::first};
  const TriangleSoup soup{ball.rest, flipped(open, {3, 4}), {}};
  const std::shared_ptr<const Grid> grid = make_level_set(soup, method, Repair::winding);

  const MeshDistance mesh = make_mesh_distance(ball.rest, open);
  const std::vector<Dipole> dipoles = make_dipoles(mesh);
  const Lattice lattice = lattice_about(mesh.tree.nodes[0].bounds, 11, 3);
  REQUIRE(grid->lattice.size() == lattice.size());
  CHECK(grid->lattice.origin == lattice.origin);
  CHECK(grid->lattice.spacing == lattice.spacing);
  std::vector<float> side;
  for (long index = 0; index < lattice.size(); ++index)
    side.push_back(
        float(0.5 - winding_number(mesh, dipoles, lattice.position(lattice.node(index)), 2)));
  const Seeds seeds = seeds_from_sides(lattice, side);
  int exact = 0, over_the_hole = 0;
  for (size_t i = 0; i < seeds.nodes.size(); ++i) {
    const Vector3 p = lattice.position(lattice.node(seeds.nodes[i]));
    double nearest = 1e300;
    for (const Corners3& t : mesh.corners)
      nearest = std::min(nearest, std::sqrt(nearest_on_triangle(t, p).squared_distance));
    const double phi = grid->phi[size_t(seeds.nodes[i])];
    CHECK((phi < 0) == (side[size_t(seeds.nodes[i])] < 0));
    if (nearest < lattice.spacing) {
      CHECK(std::abs(phi) == Approx(nearest).margin(1e-13));
      ++exact;
    } else {
      CHECK(phi == seeds.phi[i]);
      ++over_the_hole;
    }
  }
  CHECK(exact > 50);
  CHECK(over_the_hole > 5);
}

TEST_CASE("a mesh without an inside cannot be repaired") {
  const TriangleMesh ball = make_icosphere(0.8, 1);
  std::vector<size_t> all(ball.triangles.size());
  for (size_t t = 0; t < all.size(); ++t) all[t] = t;
  const TriangleSoup soup{ball.rest, flipped(ball.triangles, all), {"ball.obj", {}, {}}};
  CHECK_THROWS_WITH(
      make_repaired_grid(soup, {9, 2, 2, MarchingOrder::first}),
      Catch::Equals("ball.obj: repair finds no inside: the winding number of its 80 triangles is "
                    "below 1/2 at every node; turn them outward, or give a finer grid"));
}

TEST_CASE("only a closed mesh has a level set without a repair") {
  const TriangleMesh ball = make_icosphere(0.8, 1);
  const GridMethod method{9, 2, 2, MarchingOrder::first};
  const TriangleSoup closed{ball.rest, ball.triangles, {}};
  const MeshDistance mesh = make_mesh_distance(ball.rest, ball.triangles);
  CHECK(make_level_set(closed, method, Repair::refuse)->phi == make_grid(mesh, method)->phi);
  CHECK(make_level_set(closed, method, Repair::winding)->phi !=
        make_level_set(closed, method, Repair::refuse)->phi);
  TriangleSoup open = closed;
  open.triangles.pop_back();
  CHECK_THROWS_WITH(make_level_set(open, method, Repair::refuse), Contains("a hole"));
  CHECK(make_level_set(open, method, Repair::winding)->phi.size() > 100);
}
