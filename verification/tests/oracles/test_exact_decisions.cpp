// Exact decisions, and the polynomials behind them.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include "verification/oracles/exact_crossings.h"
#include "verification/oracles/exact_geometry.h"
#include "verification/oracles/feature_distance.h"
#include "verification/oracles/whole_points.h"
#include "verification/oracles/whole_polynomial.h"

using namespace foldproof::oracles;
using namespace foldproof;

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
  const auto from_a = [&a](const Vector3& p) {  // whole numbers of 30 bits
    return Triple<Digits50>{p.x() - a.x(), p.y() - a.y(), p.z() - a.z()};
  };
  return dot(cross(from_a(b), from_a(c)), from_a(d)).sign();
}

FourPoints points(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  FourPoints x;
  x << a, b, c, d;
  return x;
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

TEST_CASE("crossings come by edge, then by triangle, and none of an empty mesh") {
  CHECK(exact_crossings(PerParticle3(3, 0), {}).empty());
  PerParticle3 x(3, 9);
  // two parallel triangles that the long edges of a third pierce
  x << 0, 4, 0, 0, 4, 0, 1, 1, 9, 0, 0, 4, 0, 0, 4, 1, 1, 9, 0, 0, 0, 1, 1, 1, -2, 3, -2;
  const std::vector<EdgeInTriangle> found = exact_crossings(x, {{3, 4, 5}, {0, 1, 2}, {6, 7, 8}});
  REQUIRE(found.size() >= 2);
  CHECK(std::is_sorted(found.begin(), found.end()));
  CHECK((found.end() - 2)->edge == std::array<int, 2>{6, 7});
  CHECK((found.end() - 2)->triangle == 0);
  CHECK(found.back().triangle == 1);
  x(2, 8) = NAN;
  CHECK_THROWS_AS(exact_crossings(x, {{0, 1, 2}}), std::invalid_argument);
}

TEST_CASE("doubles are whole numbers times the largest power of two that they share") {
  CHECK(common_exponent({Vector3::Zero()}) == 0);
  CHECK(common_exponent({Vector3(0, 12, 0)}) == 2);
  CHECK(common_exponent({Vector3(40, -24, 0), Vector3(0, 0, -0.375)}) == -3);
  CHECK(common_exponent({Vector3(5e-324, 1e300, 0)}) == -1074);
  CHECK(whole(-12, 2) == -3);
  CHECK(whole(-12, -1) == -24);
  CHECK(whole(0.1, -55) == Whole("3602879701896397"));
  CHECK(whole(-0x1p+100, 0) == -(Whole(1) << 100));
}

TEST_CASE("a point has no side where no segment from it is clean, or a triangle has no area") {
  const TriangleSoup thin{box_between({0, 0, 0}, {1, 1, 1}).x, {{0, 0, 1}, {0, 1, 2}}};
  CHECK_THROWS_WITH(side_of(thin, {0, 0, 0}), Catch::Contains("without area has no inside"));
  // so small a box about the point (1, 1, 1) that all segments leave it through one corner
  const double step = std::numeric_limits<double>::epsilon(), half = 1 + 2 * step,
               end = 1 + 4 * step;
  CHECK_THROWS_AS(side_of(box_between({1, 1, 1}, {end, end, end}), {half, half, half}),
                  std::runtime_error);
}

TEST_CASE("a triangle is clear of a ball just when its distance exceeds the radius") {
  std::mt19937 bits(67);
  std::uniform_int_distribution<int> coordinate(-4, 4);
  int touching = 0, clear = 0;
  std::vector<Corners3> triangles;
  for (int k = 0; k < 3000; ++k) {
    Corners3 t;
    for (Vector3& corner : t)
      corner = Vector3(coordinate(bits), coordinate(bits), coordinate(bits));
    triangles.push_back(t);
    const Vector3 centre(coordinate(bits), coordinate(bits), coordinate(bits));
    const double distance =
        feature_distance(Features::vertex_and_triangle, points(centre, t[0], t[1], t[2])).value;
    for (const int radius : {1, 2, 3}) {
      const bool is_clear = distance > radius;
      touching += distance == radius;
      clear += is_clear;
      REQUIRE(clears_ball(t, centre, radius) == is_clear);
    }
  }
  CHECK(touching > 60);
  CHECK(clear > 1000);
  TriangleSoup soup{PerParticle3(3, 3 * 100), {}};
  std::vector<int> expected;
  for (int k = 0; k < 100; ++k) {
    for (int i = 0; i < 3; ++i) soup.x.col(3 * k + i) = triangles[std::size_t(k)][std::size_t(i)];
    soup.triangles.push_back({3 * k, 3 * k + 1, 3 * k + 2});
    if (!clears_ball(triangles[std::size_t(k)], {1, -1, 2}, 2)) expected.push_back(k);
  }
  CHECK(triangles_in_ball(soup, {1, -1, 2}, 2) == expected);
  CHECK(expected.size() > 5);
}

TEST_CASE("triangles within a body are found, though they meet no triangle of it") {
  TriangleSoup cloth{PerParticle3(3, 9), {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}}};
  cloth.x.leftCols(3) << 0.1, 0.2, 0.1, 0.1, 0.1, 0.2, 0.15, 0.15, 0.15;       // inside
  cloth.x.middleCols(3, 3) << 0.1, 0.2, 0.1, 0.1, 0.1, 0.2, 0.35, 0.36, 0.37;  // outside
  cloth.x.rightCols(3) << 0.1, 0.2, 0.1, 0.1, 0.1, 0.2, 0.36, 0.3, 0.25;       // through the top
  const TriangleSoup box = box_between({0, 0, 0}, {.3, .3, .3});
  CHECK(triangles_in_body(cloth, box) == std::vector<int>{0, 2});
}

TEST_CASE("a last bit decides on which side of a plane a point is") {
  const Vector3 a(0.1, 0.2, 0.3), b(1.1, 0.2, 0.3), c(0.1, 1.2, 0.3);
  const double above = std::nextafter(0.3, 1);
  CHECK(orientation(a, b, c, {0.7, 0.4, above}) == 1);
  CHECK(orientation(a, b, c, {0.7, 0.4, 0.3}) == 0);
  CHECK(orientation(a, c, b, {0.7, 0.4, above}) == -1);
  const Vector3 far(0, 0, std::numeric_limits<double>::denorm_min());
  // the product underflows in double
  CHECK(orientation({0, 0, 0}, {1e-200, 0, 0}, {0, 1e-200, 0}, far) == 1);
}

TEST_CASE("polynomials are added, subtracted and multiplied, and have signs at fractions of two") {
  const Polynomial p({3, -5, 7}), q({-2, 0, 0, 11});
  CHECK((p + q).c == std::vector<Whole>{1, -5, 7, 11});
  CHECK((p - q).c == std::vector<Whole>{5, -5, 7, -11});
  CHECK((p * q).c == std::vector<Whole>{-6, 10, -14, 33, -55, 77});
  CHECK((p - p).degree() == -1);
  CHECK((Polynomial() * p).is_zero());
  CHECK(Polynomial({4, 0, 0}).degree() == 0);
  const Polynomial roots({3, -16, 16});  // (4 t - 1)(4 t - 3)
  for (const auto& [numerator, halvings, sign] :
       {std::array{1, 2, 0}, {3, 2, 0}, {1, 1, -1}, {7, 3, 1}, {3, 4, 1}, {5, 4, -1}})
    CHECK(sign_at(roots, Dyadic{numerator, halvings}) == sign);
  CHECK(sign_at(Polynomial(), Dyadic{5, 4}) == 0);
}

TEST_CASE("signs at roots that no fraction is") {
  const Polynomial p({-1, 0, 2});  // 2 t^2 - 1
  REQUIRE(roots_within(p).size() == 1);
  const Root root = roots_within(p)[0];
  CHECK(sign_at(Polynomial({-707106781, 1000000000}), root) == 1);
  CHECK(sign_at(Polynomial({-707106782, 1000000000}), root) == -1);
  CHECK(sign_at(p * Polynomial({3, 5}), root) == 0);
  CHECK(sign_at(Polynomial({-7}), root) == -1);
  CHECK(roots_within(Polynomial({1, 0, 1})).empty());
  // roots at the ends are not between them, repeated ones count once, fractions of two are found
  const Polynomial t({0, 1}), rest({1, -1}), half({-1, 2}), quarter({-1, 4});
  CHECK(roots_within(t * rest).empty());
  CHECK(roots_within(t * t * rest * half).size() == 1);
  const std::vector<Root> roots = roots_within(half * quarter * Polynomial({-3, 4}) * p * p);
  REQUIRE(roots.size() == 4);  // 1/4, 1/2, .707, 3/4
  CHECK(sign_at(quarter, roots[0]) == 0);
  CHECK(sign_at(half, roots[1]) == 0);
  CHECK(sign_at(p, roots[2]) == 0);
  CHECK(sign_at(p, roots[3]) == 1);
}

TEST_CASE("the hull of Bernstein's coefficients says plain signs only") {
  struct Row {
    std::vector<Whole> c;
    int sign;
  };
  for (const auto& [c, sign] : {Row{{}, 0}, Row{{-3}, -1}, Row{{1, -1}, 0},  // vanishes at 1
                                Row{{0, 1}, 0},                              // and at 0
                                Row{{3, -2}, 1}, Row{{-3, 2}, -1},
                                // coefficients 1, 1 + c/2, 1 + c + d: zero in the middle at c = -2
                                Row{{2, -3, 3}, 1}, Row{{2, -4, 3}, 0},
                                // of a cubic: a, a + b/3, a + 2 b/3 + c/3, a + b + c + d
                                Row{{3, -8, 9, -3}, 1},   // 3, 1/3, 2/3, 1
                                Row{{3, -9, 14, -3}, 0},  // 3, 0, ...
                                Row{{3, -6, 5, 4}, 1},    // 3, 1, 2/3, 6
                                Row{{3, -6, 3, 4}, 0},    // third: 0
                                Row{{-3, 8, -9, 4}, 0}})  // last: 0
    CHECK(definite_sign(Polynomial(c)) == sign);
  CHECK_THROWS_AS(definite_sign(Polynomial({1, 1, 1, 1, 1})), std::invalid_argument);
  CHECK_THROWS_AS(roots_within(Polynomial()), std::invalid_argument);
}
