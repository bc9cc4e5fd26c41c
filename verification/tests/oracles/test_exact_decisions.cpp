// Exact decisions where doubles round: whole coordinates near 2^27 times a few, off by a little,
// against polynomials in time and determinants of whole numbers.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <set>

#include "verification/oracles/exact_crossing_times.h"
#include "verification/oracles/exact_crossings.h"
#include "verification/oracles/exact_geometry.h"
#include "verification/oracles/whole_points.h"

using namespace foldproof;
using namespace foldproof::oracles;

namespace {

/// Small whole numbers times a large odd one, off by at most `off`: often nearly flat, and products
/// of differences need 58 bits.
class NearlyFlat {
 public:
  NearlyFlat(unsigned seed, int off) : bits_(seed), grid_(-2, 2), noise_(-off, off) {}
  Vector3 operator()() {
    Vector3 p;
    for (double& c : p) c = 94906267.0 * grid_(bits_) + noise_(bits_);
    return p;
  }

 private:
  std::mt19937 bits_;
  std::uniform_int_distribution<int> grid_, noise_;
};

int sign_of_volume(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  std::array<std::array<Whole, 3>, 3> m;
  const std::array<Vector3, 3> to{b - a, c - a, d - a};  // exact: whole numbers
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) m[i][k] = (long long)(to[i][Eigen::Index(k)]);
  const Whole volume = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                       m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                       m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  return volume.sign();
}

FourPoints points(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  FourPoints x;
  x << a, b, c, d;
  return x;
}

/// p moves to q: does it ever meet the triangle?
bool passes_through(const Vector3& p, const Vector3& q, const Corners3& t) {
  const Vector3 zero = Vector3::Zero();
  return ever_meet(Features::vertex_and_triangle,
                   exact_motion(points(p, t[0], t[1], t[2]), points(q - p, zero, zero, zero)));
}

bool any_edge_passes(const Corners3& s, const Corners3& t) {
  return passes_through(s[0], s[1], t) || passes_through(s[1], s[2], t) ||
         passes_through(s[2], s[0], t);
}

bool is_a_line(const Corners3& t) {
  for (int axis = 0; axis < 3; ++axis) {
    Vector3 off = Vector3::Zero();
    off[axis] = 1;
    if (sign_of_volume(t[0], t[1], t[2], t[0] + off) != 0) return false;
  }
  return true;
}

}  // namespace

TEST_CASE("orientations of points near a plane are those of whole determinants") {
  std::array<int, 3> seen{};
  for (const int off : {0, 1, 3}) {
    NearlyFlat draw(41 + unsigned(off), off);
    for (int k = 0; k < 6000; ++k) {
      const Vector3 a = draw(), b = draw(), c = draw(), d = draw();
      const int expected = sign_of_volume(a, b, c, d);
      REQUIRE(orientation(a, b, c, d) == expected);
      ++seen[std::size_t(expected + 1)];
    }
  }
  CHECK(*std::min_element(seen.begin(), seen.end()) > 600);
}

TEST_CASE("orientations in planes across any axis are decided to the last bit") {
  // x = b - a and y = c - a span the plane; d - a is their sum, off by one unit at most
  std::mt19937_64 bits(43);
  std::uniform_int_distribution<long long> size(-(1ll << 47), 1ll << 47);
  std::array<int, 3> seen{};
  for (int k = 0; k < 6000; ++k) {
    const auto draw = [&](int axis, int shift) {
      Vector3 v;
      for (int i = 0; i < 3; ++i) v[i] = double(size(bits) >> (i == axis ? shift : 0));
      return v;
    };
    const Vector3 b = draw(k % 3, 20 * (k % 4 / 2)), c = draw(k % 3, 20 * (k % 4 / 2));
    Vector3 d = (k % 5 == 0 ? 2.0 : 1.0) * b + (k % 7 == 0 ? -1.0 : 1.0) * c;
    d[(k / 3) % 3] += double(k % 11 % 3 - 1);
    const int expected = sign_of_volume(Vector3::Zero(), b, c, d);
    REQUIRE(orientation(Vector3::Zero(), b, c, d) == expected);
    ++seen[std::size_t(expected + 1)];
  }
  CHECK(*std::min_element(seen.begin(), seen.end()) > 500);
}

TEST_CASE("triangles whose coordinates round meet where an edge of one passes the other") {
  int meetings = 0;
  for (const int off : {0, 1}) {
    NearlyFlat draw(47 + unsigned(off), off);
    for (int k = 0; k < 700; ++k) {
      const Corners3 s{draw(), draw(), draw()}, t{draw(), draw(), draw()};
      if (is_a_line(s) || is_a_line(t)) continue;
      const bool expected = any_edge_passes(s, t) || any_edge_passes(t, s);
      meetings += expected;
      REQUIRE(triangles_meet(s, t) == expected);
    }
  }
  CHECK(meetings > 200);
}

TEST_CASE("crossings of meshes whose coordinates round are those of all pairs, one by one") {
  std::size_t found = 0, shared_ones = 0;
  for (const int off : {0, 1}) {
    NearlyFlat draw(53 + unsigned(off), off);
    for (int k = 0; k < 60; ++k) {
      PerParticle3 x(3, 7);
      for (int i = 0; i < 7; ++i) x.col(i) = draw();
      const std::vector<std::array<int, 3>> triangles{
          {0, 1, 2}, {2, 1, 3}, {4, 3, 5}, {6, 0, 5}, {4, 6, 2}};
      std::set<std::array<int, 2>> edges;
      for (const auto& t : triangles)
        for (std::size_t i = 0; i < 3; ++i)
          edges.insert({std::min(t[i], t[(i + 1) % 3]), std::max(t[i], t[(i + 1) % 3])});
      std::vector<EdgeInTriangle> expected;
      for (const auto& edge : edges)
        for (int t = 0; t < 5; ++t) {
          std::array<int, 3> c = triangles[std::size_t(t)];
          std::array<int, 2> e = edge;
          const auto has = [&](int i) { return std::find(c.begin(), c.end(), i) != c.end(); };
          if (has(e[0]) && has(e[1])) continue;
          if (has(e[1])) std::swap(e[0], e[1]);
          const Vector3 p = x.col(e[0]), q = x.col(e[1]);
          bool meets;
          if (has(e[0])) {
            while (c[0] != e[0]) std::rotate(c.begin(), c.begin() + 1, c.end());
            meets = meet(Features::vertex_and_triangle,
                         points(q, x.col(c[0]), x.col(c[1]), x.col(c[2]))) ||
                    meet(Features::edge_and_edge, points(p, q, x.col(c[1]), x.col(c[2])));
            shared_ones += meets;
          } else {
            // closed sets: an end within, a side crossed, or the inside passed
            meets = passes_through(p, q, {x.col(c[0]), x.col(c[1]), x.col(c[2])});
          }
          if (meets) expected.push_back({edge, t});
        }
      REQUIRE(exact_crossings(x, triangles) == expected);
      found += expected.size();
    }
  }
  CHECK(found > 200);
  CHECK(shared_ones > 30);
}

TEST_CASE("crossings come by edge, then by triangle, and none of an empty mesh") {
  CHECK(exact_crossings(PerParticle3(3, 0), {}).empty());
  PerParticle3 x(3, 9);
  // two parallel triangles that the long edges of a third pierce
  x << 0, 4, 0, 0, 4, 0, 1, 1, 9, 0, 0, 4, 0, 0, 4, 1, 1, 9, 0, 0, 0, 1, 1, 1, -2, 3, -2;
  const std::vector<EdgeInTriangle> found = exact_crossings(x, {{3, 4, 5}, {0, 1, 2}, {6, 7, 8}});
  REQUIRE(found.size() >= 2);
  CHECK(std::is_sorted(found.begin(), found.end()));
  CHECK(found.back().edge == std::array<int, 2>{6, 7});
  CHECK(found.back().triangle == 1);
  CHECK(found[found.size() - 2].edge == std::array<int, 2>{6, 7});
  CHECK(found[found.size() - 2].triangle == 0);
  for (const double bad : {double(NAN), double(INFINITY)}) {
    x(2, 8) = bad;
    CHECK_THROWS_WITH(exact_crossings(x, {{0, 1, 2}}),
                      "positions that are not finite cross nothing");
  }
}

TEST_CASE("doubles are whole numbers times the largest power of two that they share") {
  CHECK(common_exponent({}) == 0);
  CHECK(common_exponent({Vector3::Zero()}) == 0);
  CHECK(common_exponent({Vector3(0, 12, 0)}) == 2);
  CHECK(common_exponent({Vector3(40, -24, 0), Vector3(0, 0, -0.375)}) == -3);
  CHECK(common_exponent({Vector3(5e-324, 1e300, 0)}) == -1074);
  CHECK(whole(-12, 2) == -3);
  CHECK(whole(-12, -1) == -24);
  CHECK(whole(0, 7) == 0);
  CHECK(whole(0.1, -55) == Whole("3602879701896397"));
  CHECK(whole(0x1.8p+100, 98) == 6);
  CHECK(whole(-0x1p+100, 0) == -(Whole(1) << 100));
  const Exact p = exact(Vector3(3, -0.5, 10.25), -2);
  CHECK(p.x == 12);
  CHECK(p.y == -2);
  CHECK(p.z == 41);
}

TEST_CASE("a box has twelve triangles that look outward, between its two corners") {
  const Vector3 low(-.3, .2, 1.1), high(.4, .9, 1.7);
  const TriangleSoup box = box_between(low, high);
  REQUIRE(box.triangles.size() == 12);
  CHECK(box.x.rowwise().minCoeff() == low);
  CHECK(box.x.rowwise().maxCoeff() == high);
  Vector3 sum = Vector3::Zero();
  double volume = 0, area = 0;
  for (std::size_t t = 0; t < 12; ++t) {
    const Corners3 c = corners(box, t);
    const Vector3 n = (c[1] - c[0]).cross(c[2] - c[0]) / 2;
    sum += n;
    area += n.norm();
    volume += n.dot(c[0]) / 3;
    CHECK(n.dot(c[0] - (low + high) / 2) > 0);
  }
  CHECK(sum.norm() < 1e-15);
  CHECK(volume == Approx(.7 * .7 * .6).epsilon(1e-13));
  CHECK(area == Approx(2 * (.49 + .42 + .42)).epsilon(1e-13));
}

TEST_CASE("points beside a box are outside it, however far and on whichever side") {
  const TriangleSoup box = box_between(Vector3(-3, -2, -4), Vector3(2, 4, 3));
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1., 1.})
      for (const double off : {5., 6., 8.5, 11., 14., 40.}) {
        Vector3 p(-.3, .7, .4);
        p[axis] += side * off;
        REQUIRE(side_of(box, p) == Side::outside);
      }
  CHECK(side_of(box, {-.3, .7, .4}) == Side::inside);
  // so small a box about the point (1, 1, 1) that all segments leave it through one corner
  const double step = std::numeric_limits<double>::epsilon(), half = 1 + 2 * step,
               end = 1 + 4 * step;
  CHECK_THROWS_AS(side_of(box_between({1, 1, 1}, {end, end, end}), {half, half, half}),
                  std::runtime_error);
  for (const double off : {.1, 1., 2., 2.9}) {
    CHECK(side_of(box, {-off, .7, .4}) == Side::inside);
    CHECK(side_of(box, {-.3, 1 - off, .4}) == Side::inside);
  }
}

TEST_CASE("points of a lattice are inside, on, or outside a tetrahedron as its planes say") {
  TriangleSoup body{PerParticle3(3, 4), {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  body.x << 0, 12, 0, 0, 0, 0, 12, 0, 0, 0, 0, 12;
  body.x /= 7;  // no fractions of two
  for (int turned = 0; turned < 2; ++turned) {
    for (int i = -1; i <= 6; ++i)
      for (int j = -1; j <= 6; ++j)
        for (int k = -1; k <= 6; ++k) {
          const Vector3 p(2 * i / 7.0, 2 * j / 7.0, 2 * k / 7.0);
          const int least = std::min({i, j, k}), sum = i + j + k;
          if (sum == 6 && least > 0) continue;  // within a rounding of the slanting side
          if (sum == 6 && least == 0 && std::max({i, j, k}) < 6) continue;
          const Side expected = least < 0 || sum > 6     ? Side::outside
                                : least == 0 || sum == 6 ? Side::on_surface
                                                         : Side::inside;
          REQUIRE(side_of(body, p) == expected);
        }
    for (auto& t : body.triangles) std::swap(t[1], t[2]);
  }
  CHECK_THROWS_WITH(side_of({body.x, {{0, 0, 1}, {0, 1, 2}}}, {0, 0, 0}),
                    Catch::Contains("a triangle without area has no inside"));
}
