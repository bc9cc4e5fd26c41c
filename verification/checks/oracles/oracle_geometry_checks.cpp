#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "verification/checks/oracles/oracle_checks.h"
#include "verification/evidence.h"
#include "verification/oracles/crossing_subdivision.h"
#include "verification/oracles/exact_crossings.h"
#include "verification/oracles/exact_geometry.h"
#include "verification/oracles/feature_distance.h"
#include "verification/oracles/separated_triangles.h"
#include "verification/oracles/solid_prisms.h"
#include "verification/oracles/triangle_distance.h"
#include "verification/oracles/whole_polynomial.h"
#include "verification/specimens/random.h"

namespace foldproof {

namespace {

using oracles::are_separated;
using oracles::Corners3;
using oracles::Estimate;
using oracles::Features;
using oracles::FourPoints;
using oracles::normal_of;
using oracles::Polynomial;
using oracles::Whole;

constexpr std::array<std::pair<Features, const char*>, 2> features{
    {{Features::vertex_and_triangle, "vertex and triangle"},
     {Features::edge_and_edge, "edge and edge"}}};

/// Whole numbers from -largest to largest, each as likely as the others.
double whole_in(Random& random, int largest) {
  return std::floor(random.uniform(-largest, largest + 1));
}

/// Four points on a grid: many of them coincide, line up or lie in a plane.
FourPoints grid_points(Random& random, int largest) {
  FourPoints x;
  for (double& c : x.reshaped()) c = whole_in(random, largest);
  return x;
}

/// numerator/denominator as a factor with that root, and the number itself.
struct Rational {
  long numerator, denominator;

  Polynomial factor() const { return Polynomial({Whole(-numerator), Whole(denominator)}); }
  double value() const { return double(numerator) / double(denominator); }
};

/// Six triangles with corners on a grid; none without an area.
PerParticle3 six_triangles(Random& random) {
  PerParticle3 x(3, 18);
  for (int t = 0; t < 6; ++t) do
      for (double& c : x.middleCols(3 * t, 3).reshaped()) c = whole_in(random, 3);
    while (normal_of({x.col(3 * t), x.col(3 * t + 1), x.col(3 * t + 2)}).isZero(0));
  return x;
}

/// Does any edge of one of the two triangles meet the other?
bool found_between(const std::vector<oracles::EdgeInTriangle>& found, int s, int t) {
  return std::any_of(found.begin(), found.end(), [&](const oracles::EdgeInTriangle& pair) {
    const auto [first, second] = std::minmax({pair.edge[0] / 3, pair.triangle});
    return first == s && second == t;
  });
}

/// The surface of a prism over a pentagon with a notch, all of whose corners the fourth one sees.
oracles::TriangleSoup notched_surface(const oracles::WholePrism& prism) {
  const int n = int(prism.polygon.size());
  oracles::TriangleSoup soup;
  soup.x.resize(3, 2 * n);
  for (int k = 0; k < n; ++k) {
    const auto [px, py] = prism.polygon[std::size_t(k)];
    soup.x.col(k) = Vector3(double(px), double(py), double(prism.low));
    soup.x.col(n + k) = Vector3(double(px), double(py), double(prism.high));
    const int next = (k + 1) % n;
    soup.triangles.push_back({k, next, n + next});
    soup.triangles.push_back({k, n + next, n + k});
  }
  for (const auto& [a, b, c] : {std::array<int, 3>{3, 4, 0}, {3, 0, 1}, {3, 1, 2}}) {
    soup.triangles.push_back({c, b, a});
    soup.triangles.push_back({n + a, n + b, n + c});
  }
  return soup;
}

/// Distance from the point at s of the first edge to the second one, in extended precision.
long double to_second_edge(const FourPoints& x, long double s) {
  using Long3 = Eigen::Matrix<long double, 3, 1>;
  const Eigen::Matrix<long double, 3, 4> p = x.cast<long double>();
  const Long3 at = p.col(0) + s * (p.col(1) - p.col(0)), d = p.col(3) - p.col(2);
  const long double along = std::clamp((at - p.col(2)).dot(d) / d.squaredNorm(), 0.0L, 1.0L);
  return Long3(at - p.col(2) - along * d).norm();
}

/// The least of a convex function of s in [0, 1], by cutting the bracket in thirds.
Estimate edge_distance(const FourPoints& x) {
  long double low = 0, high = 1;
  for (int i = 0; i < 160; ++i) {
    const long double third = (high - low) / 3;
    if (to_second_edge(x, low + third) > to_second_edge(x, high - third))
      low += third;
    else
      high -= third;
  }
  const long double least =
      std::min({to_second_edge(x, low), to_second_edge(x, 0), to_second_edge(x, 1)});
  return {double(least), 4 * epsilon * double(least) + 1e-9 * epsilon};
}

}  // namespace

Table crossing_times_agree() {
  Table answers = no_answers();
  for (const auto& [kind, name] : features)
    for (const int largest : {3, 9}) {
      Random random(unsigned(841 + largest));
      int by_roots = 0, by_halving = 0, contradictions = 0;
      for (int k = 0; k < 600; ++k) {
        const auto motion =
            oracles::exact_motion(grid_points(random, 9), grid_points(random, largest));
        const oracles::MeetDecision seen = oracles::decide_by_subdivision(kind, motion, 8);
        if (seen == oracles::MeetDecision::unclear) continue;
        const bool ever = oracles::ever_meet(kind, motion);
        by_roots += ever;
        by_halving += seen == oracles::MeetDecision::meet;
        contradictions += ever != (seen == oracles::MeetDecision::meet);
      }
      const std::string point = std::string(name) + ", moved by up to " + std::to_string(largest);
      compare_exact(answers, point + ": meetings", by_roots, by_halving);
      compare_exact(answers, point + ": contradictions, and none", contradictions, 0);
    }
  return answers;
}

// Products of factors whose roots are known, of one without a real root, and of one squared.
Table polynomial_roots_agree() {
  Table answers = no_answers();
  Random random(853);
  for (int k = 0; k < 12; ++k) {
    std::vector<Rational> roots;
    Polynomial product({1, 1, 1});
    for (int i = 0; i < 2 + k % 3; ++i) {
      const Rational root{long(random.uniform(-30, 90)), long(random.uniform(35, 60))};
      roots.push_back(root);
      product = product * root.factor() * (i == 1 ? root.factor() : Polynomial({1}));
    }
    std::vector<double> within;
    for (const Rational& root : roots)
      if (root.numerator > 0 && root.numerator < root.denominator) within.push_back(root.value());
    std::sort(within.begin(), within.end());
    within.erase(std::unique(within.begin(), within.end()), within.end());
    const std::vector<oracles::Root> found = oracles::roots_within(product);
    const std::string name = "product " + std::to_string(k + 1);
    compare_exact(answers, name + ": roots between 0 and 1", double(found.size()),
                  double(within.size()));
    int signs = 0, expected = 0;  // of all factors at all roots
    for (std::size_t i = 0; i < std::min(found.size(), within.size()); ++i)
      for (std::size_t j = 0; j < roots.size(); ++j) {
        const double weight = double(1 + i + 5 * j), apart = within[i] - roots[j].value();
        signs += int(weight) * oracles::sign_at(roots[j].factor(), found[i]);
        expected += int(weight) * ((apart > 0) - (apart < 0));
      }
    compare_exact(answers, name + ": signs of its factors there", signs, expected);
  }
  return answers;
}

Table crossings_agree() {
  Table answers = no_answers();
  for (const unsigned seed : {857U, 859U}) {
    Random random(seed);
    int by_sweep = 0, by_pairs = 0, by_parting = 0, contradictions = 0;
    for (int k = 0; k < 60; ++k) {
      const PerParticle3 x = six_triangles(random);
      const auto triangle = [&](int t) {
        return Corners3{x.col(3 * t), x.col(3 * t + 1), x.col(3 * t + 2)};
      };
      const auto found = oracles::exact_crossings(
          x, {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}, {9, 10, 11}, {12, 13, 14}, {15, 16, 17}});
      for (int s = 0; s < 6; ++s)
        for (int t = s + 1; t < 6; ++t) {
          const bool one = found_between(found, s, t),
                     two = oracles::triangles_meet(triangle(s), triangle(t)),
                     three = !are_separated(triangle(s), triangle(t));
          by_sweep += one;
          by_pairs += two;
          by_parting += three;
          contradictions += one != two || two != three;
        }
    }
    const std::string name = "seed " + std::to_string(seed);
    compare_exact(answers, name + ": by a sweep and pair by pair", by_sweep, by_pairs);
    compare_exact(answers, name + ": pair by pair and by parting directions", by_pairs, by_parting);
    compare_exact(answers, name + ": contradictions, and none", contradictions, 0);
  }
  return answers;
}

Table sides_agree() {
  Table answers = no_answers();
  for (const oracles::WholePrism& prism :
       {oracles::WholePrism{{{0, 0}, {12, 0}, {12, 8}, {6, 2}, {0, 8}}, -3, 2},
        oracles::WholePrism{{{-2, 1}, {7, 0}, {9, 9}, {3, 3}, {-1, 7}}, 1, 5}}) {
    const oracles::TriangleSoup surface = notched_surface(prism);
    std::array<int, 3> by_segments{}, by_turns{};
    int contradictions = 0;
    for (long i = -3; i <= 13; ++i)
      for (long j = -1; j <= 10; ++j)
        for (const long k : {prism.low - 1, prism.low, prism.low + 1, prism.high}) {
          const oracles::Side side =
              oracles::side_of(surface, Vector3(double(i), double(j), double(k)));
          const int one = side == oracles::Side::inside    ? 1
                          : side == oracles::Side::outside ? -1
                                                           : 0;
          const int other = oracles::inside_prism(prism, {i, j, k});
          ++by_segments[std::size_t(one + 1)];
          ++by_turns[std::size_t(other + 1)];
          contradictions += one != other;
        }
    const std::string name =
        "prism from " + std::to_string(prism.low) + " to " + std::to_string(prism.high);
    compare_exact(answers, name + ": points inside", by_segments[2], by_turns[2]);
    compare_exact(answers, name + ": points on the surface", by_segments[1], by_turns[1]);
    compare_exact(answers, name + ": contradictions, and none", contradictions, 0);
  }
  return answers;
}

// A vertex and a triangle in 50 digits and in extended precision; two edges in 50 digits and by
// cutting in thirds.
Table distances_agree() {
  Table answers = no_answers();
  Random random(863);
  for (int k = 0; k < 12; ++k) {
    FourPoints x = random.vectors(4, random.log_uniform(1e-3, 10));
    if (k % 3 == 1) x.col(3) = x.col(2) + 1e-6 * (x.col(3) - x.col(2));          // thin
    if (k % 3 == 2) x.col(0) = .3 * x.col(1) + .7 * x.col(2) + 1e-5 * x.col(0);  // close to an edge
    const std::string name = " " + std::to_string(k + 1);
    compare(answers, "vertex and triangle" + name,
            oracles::feature_distance(Features::vertex_and_triangle, x),
            oracles::distance_to_triangles(x.rightCols(3), {{0, 1, 2}}, x.col(0)));
    compare(answers, "edge and edge" + name, oracles::feature_distance(Features::edge_and_edge, x),
            edge_distance(x));
  }
  return answers;
}

}  // namespace foldproof
