// Triangles that meet, against separating planes in whole numbers; crossings of rays.
#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "reference/bodies/ray_parity.h"
#include "reference/mesh/self_intersection.h"

using namespace foldproof;

namespace {

using Corners = std::vector<Vector3>;  // of whole numbers

std::vector<Vector3> edges_of(const Corners& of) {
  if (of.size() == 2) return {of[1] - of[0]};
  return {of[1] - of[0], of[2] - of[1], of[0] - of[2]};
}

/// The separating axis theorem for triangles and segments: faces, pairs of edges, and borders
/// within a plane.
bool meet(const Corners& s, const Corners& t) {
  std::vector<Vector3> axes;
  for (const Vector3& a : edges_of(s))
    for (const Vector3& b : edges_of(t)) axes.push_back(a.cross(b));
  for (const Corners* of : {&s, &t}) {
    if (of->size() < 3) continue;
    const Vector3 n = ((*of)[1] - (*of)[0]).cross((*of)[2] - (*of)[0]);
    axes.push_back(n);
    for (const Corners* other : {&s, &t})
      for (const Vector3& edge : edges_of(*other)) axes.push_back(n.cross(edge));
  }
  return std::ranges::none_of(axes, [&](const Vector3& axis) {
    const auto along = [&](const Vector3& x) { return axis.dot(x); };
    const auto [s_low, s_high] = std::ranges::minmax(s, {}, along);
    const auto [t_low, t_high] = std::ranges::minmax(t, {}, along);
    return along(s_high) < along(t_low) || along(t_high) < along(s_low);
  });
}

/// Have the triangles more in common than the corners that they share by index?
bool meet_beyond(const PerParticle3& x, const Triangle& s, const Triangle& t) {
  Corners shared, own, others;
  for (const int v : s) (std::ranges::count(t, v) ? shared : own).push_back(x.col(v));
  for (const int v : t)
    if (!std::ranges::count(s, v)) others.push_back(x.col(v));
  const Corners all_of_s{x.col(s[0]), x.col(s[1]), x.col(s[2])},
      all_of_t{x.col(t[0]), x.col(t[1]), x.col(t[2])};
  if (shared.empty()) return meet(all_of_s, all_of_t);
  if (shared.size() == 1) return meet(own, all_of_t) || meet(others, all_of_s);
  const Vector3 edge = shared[1] - shared[0];
  const Vector3 first = edge.cross(own[0] - shared[0]), second = edge.cross(others[0] - shared[0]);
  return first.cross(second).isZero() && first.dot(second) > 0;
}

/// Points of a small cube of whole numbers, or of one of its planes.
PerParticle3 few_places(std::mt19937& random, int plane) {
  PerParticle3 x(3, 6);
  for (double& component : x.reshaped()) component = double(random() % 4);
  if (plane < 3) x.row(plane).setConstant(2);
  if (plane == 3) x.row(2) = 5 - x.row(0).array() - 2 * x.row(1).array();
  return x;
}

}  // namespace

TEST_CASE("two triangles meet where no axis separates them, whatever they share") {
  std::mt19937 random(20033);
  std::array<std::array<int, 2>, 3> seen{};
  for (int k = 0; k < 30000; ++k) {
    const PerParticle3 x = few_places(random, int(random() % 6));
    std::vector<int> order{0, 1, 2, 3, 4, 5};
    std::shuffle(order.begin(), order.end(), random);
    Triangle s{order[0], order[1], order[2]}, t{order[3], order[4], order[5]};
    const size_t shared = random() % 3;
    for (size_t i = 0; i < shared; ++i) t[i] = s[(i + k) % 3];
    std::shuffle(t.begin(), t.end(), random);
    if (triangle_areas({s, t}, x).minCoeff() == 0) continue;
    const bool expected = meet_beyond(x, s, t);
    ++seen[shared][expected];
    if (intersect(x, s, t) != expected || intersect(x, t, s) != expected)
      FAIL("pair " << k << ", " << shared << " shared, expected " << expected);
  }
  for (const auto& [apart, together] : seen) {
    CHECK(apart > 500);
    CHECK(together > 500);
  }
}

TEST_CASE("rays through edges and corners cross one triangle, on the lower sides of a cube") {
  // corners at nodes 1 and 4 of every row, or a hair above 4; each face of two triangles
  const double above = GENERATE(0.0, 5e-7);
  PerParticle3 x(3, 8);
  for (int k = 0; k < 8; ++k)
    x.col(k) = 0.5 * Vector3(k & 1 ? 4 + above : 1, k & 2 ? 4 + above : 1, k & 4 ? 4 + above : 1);
  const std::vector<Triangle> cube{{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6},
                                   {0, 1, 4}, {1, 5, 4}, {2, 6, 3}, {3, 6, 7},
                                   {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  const Lattice lattice{Vector3::Zero(), 0.5, {6, 7, 8}};
  const std::vector<std::uint8_t> votes = ray_parity(x, cube, lattice);
  for (long index = 0; index < lattice.size(); ++index) {
    const Node n = lattice.node(index);
    int expected = 0;
    for (size_t axis = 0; axis < 3; ++axis) {
      const auto crosses = [&](size_t across) { return 1 <= n[across] && n[across] < 4 + above; };
      expected += 1 < n[axis] && n[axis] <= 4 && crosses((axis + 1) % 3) && crosses((axis + 2) % 3);
    }
    CHECK(int(votes[size_t(index)]) == expected);
  }
}

TEST_CASE("disagreement: signs against the majority of rays, and rays against each other") {
  Grid grid;
  grid.lattice = {Vector3::Zero(), 1, {3, 2, 2}};
  //          near the surface  on it   outside          inside
  grid.phi = {0.2, -0.2, -0.1, 0, 0.3, 0.4, 0.5, 0.6, -0.3, -0.4, -0.5, -0.6};
  const std::vector<std::uint8_t> parity{3, 0, 1, 1, 0, 1, 2, 3, 0, 1, 2, 3};
  const Disagreement found = disagreement(grid, parity, grid.phi[0]);
  CHECK(found.with_sign == std::vector<long>{6, 7, 8, 9});
  CHECK(found.among_rays == std::vector<long>{5, 6, 9, 10});
  CHECK(disagreement(grid, parity, -1).with_sign == std::vector<long>{0, 1, 2, 6, 7, 8, 9});
}

TEST_CASE("triangles of one plane intersect where only their edges cross") {
  PerParticle3 x(3, 6);
  x << 0, 4, 2, 0, 4, 2, 0, 0, 3, 2, 2, -1, 0, 0, 0, 0, 0, 0;
  const std::vector<Triangle> star{{0, 1, 2}, {3, 4, 5}};
  CHECK(self_intersections(x, star).size() == 1);
  x.rightCols(3).row(0).array() += 4.5;
  CHECK(self_intersections(x, star).empty());
}
