#include "verification/checks/oracles/agreement.h"
#include "verification/oracles/crossing_subdivision.h"
#include "verification/oracles/dense_algebra.h"
#include "verification/oracles/depth_maps.h"
#include "verification/oracles/exact_crossings.h"
#include "verification/oracles/exact_geometry.h"
#include "verification/oracles/feature_distance.h"
#include "verification/oracles/gsl.h"
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

/// Uniform whole numbers from -largest to largest.
double whole_in(Random& random, int largest) {
  return std::floor(random.uniform(-largest, largest + 1));
}

/// Four points on a grid: many of them coincide, line up or lie in a plane.
FourPoints grid_points(Random& random, int largest) {
  FourPoints x;
  for (double& c : x.reshaped()) c = whole_in(random, largest);
  return x;
}

/// numerator/denominator, and the linear factor with this root.
struct Rational {
  long numerator, denominator;

  Polynomial factor() const { return Polynomial({Whole(-numerator), Whole(denominator)}); }
  double value() const { return double(numerator) / double(denominator); }
};

/// Six triangles with corners on a grid; all have an area.
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

/// Surface of a prism over a notched pentagon whose corners are all visible from the fourth.
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

/// The minimum of a convex function of s in [0, 1], by cutting the bracket in thirds.
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

/// The slope of the map from eps at -t^ to tau at tau, integrated: y = f, or f and f'.
double integrate(const oracles::RightHandSide& rhs, const std::vector<double>& start, double from,
                 double to, double& uncertainty) {
  const auto solution =
      oracles::reference_solution(rhs, start, from, std::array<double, 1>{to}, 1e-13);
  uncertainty = solution.uncertainty[0];
  return solution.values[0][0];
}

/// f' = p (f - eps)/(phi + t^): the power law as a differential equation, solved back
/// from f(tau) = tau.
Estimate power_map_by_equation(const oracles::Band& band, double phi) {
  const double whole = band.reach + band.deepest, climb = band.reach - band.nearest,
               p = whole / climb;
  // backwards from f(tau) = tau, with s = tau - phi growing
  const oracles::RightHandSide rhs = [&](double s, std::span<const double> y,
                                         std::span<double> dy) {
    dy[0] = -p * (y[0] - band.nearest / whole) / (1 - s);
  };
  double off = 0;
  const double f = integrate(rhs, {band.reach / whole}, 0, (band.reach - phi) / whole, off);
  return {f * whole, off * whole};
}

/// f'' is 0 and then (1 - m)/w; m, found by bracketing, makes f climb from eps to tau.
Estimate blend_map_by_equation(const oracles::Band& band, double phi) {
  const double whole = band.reach + band.deepest, w = (band.reach - band.nearest) / 2 / whole,
               bend = 1 - w;
  double off = 0;
  const auto climbed = [&](double m, double to) {
    // in two parts, since f'' jumps between them
    const auto straight = std::min(to, bend);
    const double there = band.nearest / whole + m * straight;
    if (to <= bend) return there;
    const oracles::RightHandSide rhs = [&](double, std::span<const double> y,
                                           std::span<double> dy) {
      dy[0] = y[1];
      dy[1] = (1 - m) / w;
    };
    return integrate(rhs, {there, m}, bend, to, off);
  };
  const Estimate m = oracles::bracketed_root(
      [&](double slope) { return climbed(slope, 1) - band.reach / whole; }, -3, 3, 0);
  const double f = climbed(m.value, (phi + band.deepest) / whole);
  return {f * whole, (off + m.uncertainty + 1e-14) * whole};
}

void depth_maps_agree(Answers& answers) {
  for (const oracles::Band& band : {oracles::Band{.001, .02, .05}, oracles::Band{.003, .011, .004}})
    for (const double part : {.12, .55, .93}) {
      const double phi = -band.deepest + part * (band.reach + band.deepest);
      const std::string name =
          "t^ " + std::to_string(band.deepest) + ", phi " + std::to_string(phi);
      answers.compare("power, " + name, oracles::power_map(band, phi),
                      power_map_by_equation(band, phi));
      answers.compare("blend, " + name, oracles::blend_map(band, phi),
                      blend_map_by_equation(band, phi));
    }
}

// Matrices with known answers: second differences, with eigenvalues 2 - 2 cos(k pi/(n + 1)); a
// companion matrix with chosen roots; a system with a chosen solution; a product of two rotations
// and chosen singular values.
void dense_algebra_agrees(Answers& answers) {
  Random random(839);
  for (const int n : {5, 9}) {
    Eigen::MatrixXd K = 2 * Eigen::MatrixXd::Identity(n, n);
    K.diagonal(1).setConstant(-1);
    K.diagonal(-1).setConstant(-1);
    const Eigen::VectorXd values = oracles::symmetric_eigenvalues(K);
    Pairs pairs;
    for (int k = 1; k <= n; ++k)
      pairs.push_back(
          {{values[k - 1], 20 * n * epsilon}, {2 - 2 * std::cos(k * pi / (n + 1)), 4 * epsilon}});
    answers.compare_worst("second differences of " + std::to_string(n), pairs);
    const Eigen::MatrixXd A = K + .1 * Eigen::MatrixXd::Ones(n, n);
    const Eigen::VectorXd x = random.vectors(n, 1).row(0).transpose();
    const Eigen::VectorXd found = oracles::solve_linear(A, A * x),
                          again = oracles::solve_symmetric(A, A * x);
    pairs.clear();  // the condition of these is below 50
    for (int k = 0; k < n; ++k) {
      pairs.push_back({{found[k], 200 * n * epsilon}, {x[k], 0}});
      pairs.push_back({{again[k], 200 * n * epsilon}, {x[k], 0}});
    }
    answers.compare_worst("chosen solution of " + std::to_string(n), pairs);
  }
  for (const std::array<double, 3>& roots :
       {std::array<double, 3>{-.7, .4, 1.9}, std::array<double, 3>{-3.1, -1.2, .6}}) {
    Eigen::Matrix3d companion;
    companion << roots[0] + roots[1] + roots[2],
        -(roots[0] * roots[1] + roots[1] * roots[2] + roots[2] * roots[0]),
        roots[0] * roots[1] * roots[2], 1, 0, 0, 0, 1, 0;
    Eigen::VectorXd found = oracles::eigenvalues(companion).real();
    std::sort(found.begin(), found.end());
    Pairs pairs;
    for (int k = 0; k < 3; ++k)
      pairs.push_back({{found[k], 300 * epsilon}, {roots[std::size_t(k)], 0}});
    answers.compare_worst("companion of root " + std::to_string(roots[0]), pairs);
  }
  for (const Vector3& values : {Vector3(3.7, 1.1, .2), Vector3(41, 6, 5)}) {
    const Vector3 from = random.vectors(1, 1).col(0), to = random.vectors(1, 1).col(0);
    const Eigen::Matrix3d U = oracles::rotation_between(from, to).toRotationMatrix();
    // for nearly half a turn, the axis is known only as well as the half angle's cosine is large
    const double half = std::sqrt((1 + from.normalized().dot(to.normalized())) / 2);
    const Eigen::Matrix3d V = Eigen::AngleAxisd(1.1, from.normalized()).toRotationMatrix();
    const oracles::SingularParts parts =
        oracles::singular_parts(U * values.asDiagonal() * V.transpose());
    Pairs pairs;
    for (int k = 0; k < 3; ++k) {
      pairs.push_back({{parts.values[k], 30 * epsilon * values[0]}, {values[k], 0}});
      pairs.push_back(
          {{(U * from.normalized())[k], 10 * epsilon / half}, {to.normalized()[k], 10 * epsilon}});
    }
    answers.compare_worst("singular value " + std::to_string(values[0]), pairs);
  }
}

void crossing_times_agree(Answers& answers) {
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
      answers.compare_exact(point + ": meetings", by_roots, by_halving);
      answers.compare_exact(point + ": contradictions, and none", contradictions, 0);
    }
}

// Products of factors whose roots are known, of one without a real root, and of one squared.
void polynomial_roots_agree(Answers& answers) {
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
    answers.compare_exact(name + ": roots between 0 and 1", double(found.size()),
                          double(within.size()));
    int signs = 0, expected = 0;  // of all factors at all roots
    for (std::size_t i = 0; i < std::min(found.size(), within.size()); ++i)
      for (std::size_t j = 0; j < roots.size(); ++j) {
        const double weight = double(1 + i + 5 * j), apart = within[i] - roots[j].value();
        signs += int(weight) * oracles::sign_at(roots[j].factor(), found[i]);
        expected += int(weight) * ((apart > 0) - (apart < 0));
      }
    answers.compare_exact(name + ": signs of its factors there", signs, expected);
  }
}

void crossings_agree(Answers& answers) {
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
    answers.compare_exact(name + ": by a sweep and pair by pair", by_sweep, by_pairs);
    answers.compare_exact(name + ": pair by pair and by parting directions", by_pairs, by_parting);
    answers.compare_exact(name + ": contradictions, and none", contradictions, 0);
  }
}

void sides_agree(Answers& answers) {
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
    answers.compare_exact(name + ": points inside", by_segments[2], by_turns[2]);
    answers.compare_exact(name + ": points on the surface", by_segments[1], by_turns[1]);
    answers.compare_exact(name + ": contradictions, and none", contradictions, 0);
  }
}

// A vertex and a triangle in 50 digits and in extended precision; two edges in 50 digits and by a
// search in thirds.
void distances_agree(Answers& answers) {
  Random random(863);
  for (int k = 0; k < 12; ++k) {
    FourPoints x = random.vectors(4, random.log_uniform(1e-3, 10));
    if (k % 3 == 1) x.col(3) = x.col(2) + 1e-6 * (x.col(3) - x.col(2));          // thin
    if (k % 3 == 2) x.col(0) = .3 * x.col(1) + .7 * x.col(2) + 1e-5 * x.col(0);  // close to an edge
    const std::string name = " " + std::to_string(k + 1);
    answers.compare("vertex and triangle" + name,
                    oracles::feature_distance(Features::vertex_and_triangle, x),
                    oracles::distance_to_triangles(x.rightCols(3), {{0, 1, 2}}, x.col(0)));
    answers.compare("edge and edge" + name, oracles::feature_distance(Features::edge_and_edge, x),
                    edge_distance(x));
  }
}

}  // namespace

std::vector<Comparison> geometry_comparisons() {
  return {
      {"oracle.depth-maps-agree",
       "The oracle's depth maps in closed form are solutions of the differential equations that "
       "define them.",
       depth_maps_agree},
      {"oracle.dense-algebra-agrees",
       "The oracle's eigenvalues, solutions, singular values and rotations are those that the "
       "matrices were built from.",
       dense_algebra_agrees},
      {"oracle.crossing-times-agree",
       "The oracle's exact crossings of moving features by roots agree with bisection in time, "
       "wherever bisection decides.",
       crossing_times_agree},
      {"oracle.polynomial-roots-agree",
       "The oracle's roots of integer polynomials, and the signs of others there, are those that "
       "the "
       "polynomials were built from.",
       polynomial_roots_agree},
      {"oracle.crossings-agree",
       "The oracle's crossings by a sweep are those of all pairs, which are the pairs that no "
       "direction separates.",
       crossings_agree},
      {"oracle.inside-tests-agree",
       "The oracle's inside test by segments agrees with the test of a prism by angles, even at "
       "points on the surface.",
       sides_agree},
      {"oracle.distances-agree",
       "The oracle's distances of features in 50 digits agree with those by foot points in "
       "extended "
       "precision and by ternary search.",
       distances_agree}};
}

}  // namespace foldproof
