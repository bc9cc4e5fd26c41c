// Polynomials with whole coefficients: products of known factors, with fractions worked out.
#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>
#include <random>
#include <set>

#include "verification/oracles/crossing_subdivision.h"
#include "verification/oracles/exact_crossing_times.h"
#include "verification/oracles/feature_distance.h"
#include "verification/oracles/exact_geometry.h"
#include "verification/oracles/whole_polynomial.h"

using namespace foldproof;
using namespace foldproof::oracles;

namespace {

/// Sign of p at n/d, d > 0, times d^degree.
int sign_at_fraction(const Polynomial& p, int n, int d) {
  Whole sum = 0, power = 1;
  for (std::size_t k = p.c.size(); k-- > 0;) {
    Whole term = p.c[k] * power;
    for (std::size_t i = 0; i < k; ++i) term *= n;
    sum += term;
    power *= d;
  }
  return sum.sign();
}

bool is_less(const Dyadic& t, int n, int d) {  // t < n/d
  return t.numerator * d < (Whole(n) << unsigned(t.halvings));
}

FourPoints points(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  FourPoints x;
  x << a, b, c, d;
  return x;
}

}  // namespace

TEST_CASE("polynomials are added, subtracted and multiplied term by term") {
  const Polynomial p({3, -5, 7}), q({-2, 0, 0, 11});
  CHECK((p + q).c == std::vector<Whole>{1, -5, 7, 11});
  CHECK((q + p).c == std::vector<Whole>{1, -5, 7, 11});
  CHECK((p - q).c == std::vector<Whole>{5, -5, 7, -11});
  CHECK((q - p).c == std::vector<Whole>{-5, 5, -7, 11});
  CHECK((p * q).c == std::vector<Whole>{-6, 10, -14, 33, -55, 77});
  CHECK((p - p).is_zero());
  CHECK((p - p).degree() == -1);
  CHECK((p * Polynomial()).is_zero());
  CHECK((Polynomial() * p).is_zero());
  CHECK(Polynomial({4, 0, 0}).degree() == 0);
  CHECK_FALSE(Polynomial({4}).is_zero());
}

TEST_CASE("signs at fractions of two are those of the sums") {
  const Polynomial p({3, -16, 16});  // (4 t - 1)(4 t - 3)
  CHECK(sign_at(p, Dyadic{1, 2}) == 0);
  CHECK(sign_at(p, Dyadic{3, 2}) == 0);
  CHECK(sign_at(p, Dyadic{1, 1}) == -1);
  CHECK(sign_at(p, Dyadic{7, 3}) == 1);
  CHECK(sign_at(p, Dyadic{3, 4}) == 1);
  CHECK(sign_at(p, Dyadic{5, 4}) == -1);
  CHECK(sign_at(Polynomial(), Dyadic{5, 4}) == 0);
}

TEST_CASE("known fractions are all the roots, and each is alone between its bounds") {
  std::mt19937 bits(59);
  std::uniform_int_distribution<int> number(1, 40), factor(-9, 9);
  for (int k = 0; k < 150; ++k) {
    // fractions between 0 and 1, some of them of two, some repeated; others beyond
    std::set<std::pair<int, int>> roots;  // (n, d) in lowest terms
    Polynomial p({k % 2 == 0 ? 3 : -5});
    for (int i = 0; i < 1 + k % 4; ++i) {
      int d = i == 2 ? 8 : number(bits) + 1, n = number(bits) % (d - 1) + 1;
      if (d == 1) d = 2, n = 1;
      const int common = std::gcd(n, d);
      roots.insert({n / common, d / common});
      const Polynomial root({-n, d});
      p = p * root;
      if (k % 5 == i) p = p * root;
    }
    if (k % 3 == 0) p = p * Polynomial({0, 1});
    if (k % 4 == 0) p = p * Polynomial({-1, 1}) * Polynomial({-1, 1});
    if (k % 7 == 0) p = p * Polynomial({-7, 5});
    if (k % 6 == 0) p = p * Polynomial({2, 1, 1});
    const std::vector<Root> found = roots_within(p);
    REQUIRE(found.size() == roots.size());
    std::vector<std::pair<int, int>> sorted(roots.begin(), roots.end());
    std::sort(sorted.begin(), sorted.end(),
              [](const auto& a, const auto& b) { return a.first * b.second < b.first * a.second; });
    for (std::size_t i = 0; i < sorted.size(); ++i) {
      const auto [n, d] = sorted[i];
      REQUIRE(is_less(found[i].low, n, d));
      REQUIRE_FALSE(is_less(found[i].high, n, d));
      REQUIRE(sign_at(found[i].of, found[i].low) != 0);
      REQUIRE(sign_at(found[i].of, found[i].high) != 0);
      for (int other = 0; other < 6; ++other) {
        std::vector<Whole> c;
        for (int degree = 0; degree <= other; ++degree) c.push_back(factor(bits));
        Polynomial q(c);
        if (other == 5) q = q * Polynomial({-n, d});
        REQUIRE(sign_at(q, found[i]) == sign_at_fraction(q, n, d));
      }
    }
  }
}

TEST_CASE("the hull of Bernstein's coefficients says plain signs only") {
  CHECK(definite_sign(Polynomial()) == 0);
  CHECK(definite_sign(Polynomial({-3})) == -1);
  CHECK(definite_sign(Polynomial({1, -1})) == 0);  // vanishes at 1
  CHECK(definite_sign(Polynomial({0, 1})) == 0);   // and at 0
  CHECK(definite_sign(Polynomial({3, -2})) == 1);
  CHECK(definite_sign(Polynomial({-3, 2})) == -1);
  // coefficients 1, 1 + c/2, 1 + c + d: zero in the middle at c = -2
  CHECK(definite_sign(Polynomial({2, -3, 3})) == 1);
  CHECK(definite_sign(Polynomial({2, -4, 3})) == 0);
  // of a cubic: a, a + b/3, a + 2 b/3 + c/3, a + b + c + d
  CHECK(definite_sign(Polynomial({3, -8, 9, -3})) == 1);   // 3, 1/3, 2/3, 1
  CHECK(definite_sign(Polynomial({3, -9, 14, -3})) == 0);  // 3, 0, ...
  CHECK(definite_sign(Polynomial({3, -6, 5, 4})) == 1);    // 3, 1, 2/3, 6
  CHECK(definite_sign(Polynomial({3, -6, 3, 4})) == 0);    // third: 0
  CHECK(definite_sign(Polynomial({-3, 8, -9, 4})) == 0);   // last: 0
  CHECK_THROWS_AS(definite_sign(Polynomial({1, 1, 1, 1, 1})), std::invalid_argument);
  CHECK_THROWS_WITH(roots_within(Polynomial()), "the zero polynomial has all numbers as roots");
}

TEST_CASE("a motion up to a time ends where the whole one is then") {
  const Motion motion = exact_motion(points({3, 1, 2}, {5, -7, 4}, {6, 2, 9}, {-8, 1, 3}),
                                     points({1, .5, -2}, {-3, 6, 1}, {2, -4, 5}, {7, -1, .25}));
  for (const double end : {.375, 1., .1}) {
    const Motion part = until(motion, end);
    for (std::size_t i = 0; i < 4; ++i) {
      // way over start is `end` times what it was, exactly
      const Whole scale(std::int64_t(std::ldexp(end, 56))), one = Whole(1) << 56;
      CHECK(part.displacement[i].x * motion.start[i].x * one ==
            part.start[i].x * motion.displacement[i].x * scale);
      CHECK(part.displacement[i].y * motion.start[i].y * one ==
            part.start[i].y * motion.displacement[i].y * scale);
      CHECK(part.displacement[i].z * motion.start[i].z * one ==
            part.start[i].z * motion.displacement[i].z * scale);
    }
  }
}

TEST_CASE("the distance of two features is that of their nearest sampled points") {
  std::mt19937 bits(61);
  std::uniform_int_distribution<int> coordinate(-4, 4);
  for (int k = 0; k < 60; ++k) {
    FourPoints x;
    for (double& c : x.reshaped()) c = coordinate(bits);
    constexpr int fine = 40;
    double vertex = INFINITY, edges = INFINITY;
    for (int i = 0; i <= fine; ++i)
      for (int j = 0; j <= fine; ++j) {
        const double s = double(i) / fine, r = double(j) / fine;
        if (i + j <= fine)
          vertex = std::min(
              vertex,
              (x.col(1) + s * (x.col(2) - x.col(1)) + r * (x.col(3) - x.col(1)) - x.col(0)).norm());
        edges = std::min(
            edges,
            (x.col(0) + s * (x.col(1) - x.col(0)) - x.col(2) - r * (x.col(3) - x.col(2))).norm());
      }
    const double longest = 8 * std::sqrt(3.) / fine;
    const Estimate of_vertex = feature_distance(Features::vertex_and_triangle, x),
                   of_edges = feature_distance(Features::edge_and_edge, x);
    CHECK(of_vertex.value <= vertex + 1e-14);
    CHECK(of_vertex.value >= vertex - 2 * longest);
    CHECK(of_edges.value <= edges + 1e-14);
    CHECK(of_edges.value >= edges - 2 * longest);
    // a point apart moves the nearest point no further
    CHECK(meet(Features::vertex_and_triangle, x) == (of_vertex.value == 0));
  }
}

TEST_CASE("distances of features by hand: within, past a corner, along a side, crossed") {
  const auto vertex = [](const Vector3& p) {
    return feature_distance(Features::vertex_and_triangle,
                            points(p, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}))
        .value;
  };
  CHECK(vertex({1, 1, 7}) == 7);
  CHECK(vertex({1, 1, -7}) == 7);
  CHECK(vertex({-3, -4, 12}) == 13);
  CHECK(vertex({7, -4, 0}) == 5);
  CHECK(vertex({2, -3, 4}) == 5);
  CHECK(vertex({-3, 2, 4}) == 5);
  CHECK(vertex({4, 4, 1}) == Approx(3).epsilon(1e-15));  // sqrt(8 + 1)
  const auto edges = [](const Vector3& a, const Vector3& b) {
    return feature_distance(Features::edge_and_edge, points(a, b, {0, 0, 0}, {6, 0, 0})).value;
  };
  CHECK(edges({2, -1, 5}, {3, 4, 5}) == 5);
  CHECK(edges({-3, 4, 0}, {-3, 9, 0}) == 5);
  CHECK(edges({9, 4, 0}, {9, 9, 0}) == 5);
  CHECK(edges({2, 3, 0}, {2, 9, 0}) == 3);
  CHECK(edges({2, -9, 0}, {2, -3, 0}) == 3);
  CHECK(edges({1, 3, 4}, {5, 3, 4}) == 5);  // parallel
  CHECK(edges({9, 0, 4}, {13, 0, 4}) == 5);
  CHECK(edges({2, 3, 4}, {2, 3, 4}) == 5);  // a point
}

TEST_CASE("a triangle is clear of a ball just when its distance exceeds the radius") {
  std::mt19937 bits(67);
  std::uniform_int_distribution<int> coordinate(-4, 4);
  int touching = 0, clear = 0;
  TriangleSoup soup{PerParticle3(3, 0), {}};
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
  const Vector3 centre(1, -1, 2);
  std::vector<int> expected;
  soup.x.resize(3, 3 * 100);
  for (int k = 0; k < 100; ++k) {
    for (int i = 0; i < 3; ++i) soup.x.col(3 * k + i) = triangles[std::size_t(k)][std::size_t(i)];
    soup.triangles.push_back({3 * k, 3 * k + 1, 3 * k + 2});
    if (!clears_ball(triangles[std::size_t(k)], centre, 2)) expected.push_back(k);
  }
  CHECK(triangles_in_ball(soup, centre, 2) == expected);
  CHECK(expected.size() > 5);
}

TEST_CASE("triangles in a body are those that meet its surface or begin inside") {
  std::mt19937 bits(71);
  std::uniform_int_distribution<int> coordinate(-6, 6);
  const TriangleSoup body = box_between(Vector3(-3, -2, -4), Vector3(2, 4, 3));
  TriangleSoup cloth{PerParticle3(3, 3 * 200), {}};
  std::vector<int> expected;
  int wholly_inside = 0;
  for (int k = 0; k < 200; ++k) {
    for (int i = 0; i < 3; ++i)
      for (double& c : cloth.x.col(3 * k + i)) c = coordinate(bits) / (k % 3 == 0 ? 3. : 1.);
    cloth.triangles.push_back({3 * k, 3 * k + 1, 3 * k + 2});
    const Corners3 s = corners(cloth, std::size_t(k));
    if ((s[1] - s[0]).cross(s[2] - s[0]).isZero(0)) {  // the question needs an area
      cloth.x.col(3 * k) = Vector3(7, 8, 9);
      cloth.x.col(3 * k + 1) = Vector3(8, 8, 9);
      cloth.x.col(3 * k + 2) = Vector3(7, 9, 10);
      continue;
    }
    bool meets = false;
    for (std::size_t t = 0; t < 12; ++t) meets |= triangles_meet(s, corners(body, t));
    const bool is_inside = side_of(body, s[0]) == Side::inside;
    wholly_inside += is_inside && !meets;
    if (meets || is_inside) expected.push_back(k);
  }
  CHECK(triangles_in_body(cloth, body) == expected);
  CHECK(wholly_inside > 10);
  CHECK(expected.size() < 195);
}

TEST_CASE("features at rest are apart at once just when they have a distance") {
  std::mt19937 bits(73);
  std::uniform_int_distribution<int> coordinate(-5, 5);
  int apart = 0;
  for (int k = 0; k < 4000; ++k) {
    FourPoints x;
    for (double& c : x.reshaped()) c = coordinate(bits);
    const Motion rest = exact_motion(x, FourPoints::Zero());
    for (const Features kind : {Features::vertex_and_triangle, Features::edge_and_edge}) {
      const bool is_apart = feature_distance(kind, x).value > 0;
      apart += is_apart;
      REQUIRE(decide_by_subdivision(kind, rest, 0) ==
              (is_apart ? MeetDecision::apart : MeetDecision::unclear));
    }
  }
  CHECK(apart > 6000);
}

TEST_CASE("halved times decide what is plain, and say when they cannot") {
  const Vector3 still(0, 0, 0);
  const auto over = [&](const Vector3& from, const Vector3& way, int halvings) {
    return decide_by_subdivision(Features::vertex_and_triangle,
                                 exact_motion(points(from, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}),
                                              points(way, still, still, still)),
                                 halvings);
  };
  CHECK(over({1, 1, 3}, {0, 0, -7}, 0) == MeetDecision::meet);
  CHECK(over({1, 1, 3}, {0, 0, -2}, 0) == MeetDecision::apart);
  CHECK(over({5, 5, 3}, {0, 0, -7}, 0) == MeetDecision::apart);
  CHECK(over({1, 1, 3}, {0, 0, -3}, 6) == MeetDecision::unclear);  // just reaches it
  // through the plane while above the triangle in the middle of its way only
  CHECK(over({-4, 1, 4}, {10, 0, -9}, 0) == MeetDecision::unclear);
  CHECK(over({-4, 1, 4}, {10, 0, -9}, 5) == MeetDecision::meet);
  CHECK(decide_by_subdivision(Features::edge_and_edge,
                              exact_motion(points({-2, 0, 1}, {2, 0, 1}, {0, -2, 0}, {0, 2, 0}),
                                           points({0, 0, -3}, {0, 0, -3}, still, still)),
                              0) == MeetDecision::meet);
}
