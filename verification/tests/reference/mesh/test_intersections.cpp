// Triangles that meet, against separating planes in whole numbers; crossings of rays,
// counted one by one.
#include <catch2/catch.hpp>
#include <numeric>
#include <random>

#include "reference/bodies/ray_parity.h"
#include "reference/mesh/self_intersection.h"

using namespace foldproof;

namespace {

using Whole = Eigen::Matrix<long, 3, 1>;
using Corners = std::vector<Whole>;

/// Does the axis keep the two apart, with a gap between them?
bool separates(const Whole& axis, const Corners& s, const Corners& t) {
  const auto range = [&](const Corners& of) {
    long low = axis.dot(of[0]), high = low;
    for (const Whole& x : of) low = std::min(low, axis.dot(x)), high = std::max(high, axis.dot(x));
    return std::pair{low, high};
  };
  const auto [s_low, s_high] = range(s);
  const auto [t_low, t_high] = range(t);
  return s_high < t_low || t_high < s_low;
}

std::vector<Whole> edges_of(const Corners& of) {
  if (of.size() == 2) return {of[1] - of[0]};
  return {of[1] - of[0], of[2] - of[1], of[0] - of[2]};
}

/// The separating axis theorem for triangles and segments: faces, pairs of edges, and borders
/// within a plane.
bool meet(const Corners& s, const Corners& t) {
  std::vector<Whole> axes;
  for (const Whole& a : edges_of(s))
    for (const Whole& b : edges_of(t)) axes.push_back(a.cross(b));
  for (const Corners* of : {&s, &t}) {
    if (of->size() < 3) continue;
    const Whole n = ((*of)[1] - (*of)[0]).cross((*of)[2] - (*of)[0]);
    axes.push_back(n);
    for (const Corners* other : {&s, &t})
      for (const Whole& edge : edges_of(*other)) axes.push_back(n.cross(edge));
  }
  return std::none_of(axes.begin(), axes.end(),
                      [&](const Whole& axis) { return separates(axis, s, t); });
}

/// Have the triangles more in common than the corners that they share by index?
bool meet_beyond(const std::vector<Whole>& x, const Triangle& s, const Triangle& t) {
  std::vector<int> shared, own, others;
  for (const int v : s) (std::count(t.begin(), t.end(), v) ? shared : own).push_back(v);
  for (const int v : t)
    if (!std::count(s.begin(), s.end(), v)) others.push_back(v);
  const auto at = [&](const std::vector<int>& corners) {
    Corners places;
    for (const int v : corners) places.push_back(x[size_t(v)]);
    return places;
  };
  const Corners all_of_s = at({s[0], s[1], s[2]}), all_of_t = at({t[0], t[1], t[2]});
  if (shared.empty()) return meet(all_of_s, all_of_t);
  if (shared.size() == 1) return meet(at(own), all_of_t) || meet(at(others), all_of_s);
  const Whole a = x[size_t(shared[0])], edge = x[size_t(shared[1])] - a;
  const Whole first = edge.cross(Whole(x[size_t(own[0])] - a)),
              second = edge.cross(Whole(x[size_t(others[0])] - a));
  return first.cross(second).isZero() && first.dot(second) > 0;
}

bool has_area(const std::vector<Whole>& x, const Triangle& t) {
  return !(x[size_t(t[1])] - x[size_t(t[0])]).cross(x[size_t(t[2])] - x[size_t(t[0])]).isZero();
}

PerParticle3 positions(const std::vector<Whole>& x) {
  PerParticle3 result(3, Eigen::Index(x.size()));
  for (size_t i = 0; i < x.size(); ++i) result.col(Eigen::Index(i)) = x[i].cast<double>();
  return result;
}

/// Points of a small cube of whole numbers, or of one of its planes.
std::vector<Whole> few_places(std::mt19937& random, int plane) {
  std::vector<Whole> x(6);
  for (Whole& at : x) {
    for (long& component : at) component = long(random() % 4);
    if (plane < 3) at[plane] = 2;
    if (plane == 3) at[2] = 5 - at[0] - 2 * at[1];
  }
  return x;
}

}  // namespace

TEST_CASE("two triangles meet where no axis separates them, whatever they share") {
  std::mt19937 random(20033);
  std::array<std::array<int, 2>, 3> seen{};
  for (int k = 0; k < 30000; ++k) {
    const std::vector<Whole> x = few_places(random, int(random() % 6));
    std::vector<int> order{0, 1, 2, 3, 4, 5};
    std::shuffle(order.begin(), order.end(), random);
    Triangle s{order[0], order[1], order[2]}, t{order[3], order[4], order[5]};
    const size_t shared = random() % 3;
    for (size_t i = 0; i < shared; ++i) t[i] = s[(i + k) % 3];
    std::shuffle(t.begin(), t.end(), random);
    if (!has_area(x, s) || !has_area(x, t)) continue;
    const bool expected = meet_beyond(x, s, t);
    ++seen[shared][expected];
    const PerParticle3 places = positions(x);
    if (intersect(places, s, t) != expected || intersect(places, t, s) != expected)
      FAIL("pair " << k << ", " << shared << " shared, expected " << expected);
  }
  for (const auto& [apart, together] : seen) {
    CHECK(apart > 500);
    CHECK(together > 500);
  }
}

TEST_CASE("all intersecting pairs are listed, in ascending order") {
  std::mt19937 random(77);
  for (const int count : {2, 4, 5, 9, 61}) {
    std::vector<Whole> x;
    std::vector<Triangle> triangles;
    while (int(triangles.size()) < count) {
      const Whole at(long(random() % 15), long(random() % 12), long(random() % 8));
      const int n = int(x.size());
      for (int k = 0; k < 3; ++k)
        x.push_back(at + Whole(long(random() % 8), long(random() % 8), long(random() % 8)));
      if (has_area(x, {n, n + 1, n + 2})) triangles.push_back({n, n + 1, n + 2});
    }
    std::vector<std::pair<int, int>> expected;
    for (int s = 0; s < count; ++s)
      for (int t = s + 1; t < count; ++t)
        if (meet_beyond(x, triangles[size_t(s)], triangles[size_t(t)])) expected.emplace_back(s, t);
    CHECK(self_intersections(positions(x), triangles) == expected);
    if (count == 61) CHECK(expected.size() > 20);
  }
}

namespace {

/// How many triangles the ray from p down the axis crosses, by barycentric coordinates.
int crossings_below(const PerParticle3& x, const std::vector<Triangle>& triangles, int axis,
                    const Vector3& p) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  int count = 0;
  for (const Triangle& t : triangles) {
    Eigen::Matrix3d corners;
    for (int k = 0; k < 3; ++k) corners.col(k) = Vector3(x(u, t[size_t(k)]), x(v, t[size_t(k)]), 1);
    const Vector3 weights = corners.inverse() * Vector3(p[u], p[v], 1);
    double height = 0;
    for (int k = 0; k < 3; ++k) height += weights[k] * x(axis, t[size_t(k)]);
    count += weights.minCoeff() > 0 && height < p[axis];
  }
  return count;
}

Lattice lattice_of(const Vector3& origin, double spacing, const Node& nodes) {
  return {origin, spacing, nodes};
}

}  // namespace

TEST_CASE("the votes of a node are the axes along which an odd number of triangles lies below it") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-1, 1);
  const double size = GENERATE(1.0, 7.0);
  const Vector3 middle = (size - 1) * Vector3(3, 5, 4);
  for (int k = 0; k < 40; ++k) {
    PerParticle3 x(3, 7);
    for (double& component : x.reshaped()) component = size * place(random);
    x.colwise() += middle;
    const std::vector<Triangle> triangles{{0, 1, 2}, {3, 1, 5}, {6, 4, 2}, {0, 5, 6}};
    // of many lattices the triangles reach beyond on some sides
    const Lattice lattice = lattice_of(
        middle + size * Vector3(-1.1 + 0.2 * (k % 3), -1.2 + 0.3 * (k % 5), -1.05 + 0.25 * (k % 4)),
        size * 0.23, {9, 7, 8});
    const std::vector<std::uint8_t> votes = ray_parity(x, triangles, lattice);
    REQUIRE(long(votes.size()) == lattice.size());
    int wrong = 0;
    for (long index = 0; index < lattice.size(); ++index) {
      int expected = 0;
      for (int axis = 0; axis < 3; ++axis)
        expected += crossings_below(x, triangles, axis, lattice.position(lattice.node(index))) % 2;
      wrong += votes[size_t(index)] != expected;
    }
    CHECK(wrong == 0);
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
  const Lattice lattice = lattice_of(Vector3::Zero(), 0.5, {6, 7, 8});
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
  grid.lattice = lattice_of(Vector3::Zero(), 1, {3, 3, 2});
  //                             near the surface    outside             inside             last
  const std::vector<double> phi{0.2, -0.2, 0.1, -0.1, 0.3, 0.4, 0.5, 0.6, -0.3, -0.4, -0.5, -0.6};
  const std::vector<int> votes{3, 0, 2, 1, 0, 1, 2, 3, 0, 1, 2, 3};
  grid.phi.assign(phi.begin(), phi.end());
  std::vector<std::uint8_t> parity(votes.begin(), votes.end());
  grid.phi.resize(18, 0.9);
  parity.resize(18, 0);
  grid.phi[17] = -0.7;
  const Disagreement found = disagreement(grid, parity, 0.2);
  CHECK(found.with_sign == std::vector<long>{6, 7, 8, 9, 17});
  CHECK(found.among_rays == std::vector<long>{5, 6, 9, 10});
  CHECK(disagreement(grid, parity, 0.19).with_sign == std::vector<long>{0, 1, 6, 7, 8, 9, 17});
  // on the surface is not inside
  grid.phi[4] = 0;
  CHECK(disagreement(grid, parity, -1).with_sign == std::vector<long>{0, 1, 2, 3, 6, 7, 8, 9, 17});
}

TEST_CASE("triangles of one plane intersect where only their edges cross") {
  PerParticle3 x(3, 6);
  x << 0, 4, 2, 0, 4, 2, 0, 0, 3, 2, 2, -1, 0, 0, 0, 0, 0, 0;
  const std::vector<Triangle> star{{0, 1, 2}, {3, 4, 5}};
  CHECK(self_intersections(x, star).size() == 1);
  x.rightCols(3).row(0).array() += 4.5;
  CHECK(self_intersections(x, star).empty());
}
