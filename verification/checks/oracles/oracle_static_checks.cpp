#include <Eigen/Dense>
#include <array>
#include <cmath>

#include "verification/checks/oracles/oracle_checks.h"
#include "verification/evidence.h"
#include "verification/oracles/dense_algebra.h"
#include "verification/oracles/depth_maps.h"
#include "verification/oracles/elastica.h"
#include "verification/oracles/folds.h"
#include "verification/oracles/gsl.h"
#include "verification/oracles/heavy_cantilever.h"
#include "verification/oracles/homogenised_bending.h"
#include "verification/oracles/tip_load.h"
#include "verification/specimens/random.h"

namespace foldproof {

namespace {

using oracles::Estimate;
using Series = std::array<long double, 26>;  // coefficients of powers of the arc length

/// Tip of the strip for one curvature at the clamp: slope's derivative, drop, reach.
struct Tip {
  long double curvature, drop, reach;
};

/// theta'' = -(weight (1 - s) + load) cos(theta) from theta = 0 at the clamp, by its power series
/// about each of sixty places, in extended precision: no step-size control, no stages, nothing of
/// GSL. weight = rho_A g L^3/B, load = P L^2/B.
Tip bent_by_series(double weight, double load, long double curvature) {
  constexpr int places = 60;
  constexpr long double ds = 1.0L / places;
  long double theta = 0, drop = 0, reach = 0;
  for (int place = 0; place < places; ++place) {
    Series t{}, sine{}, cosine{};
    t[0] = theta;
    t[1] = curvature;
    sine[0] = std::sin(theta);
    cosine[0] = std::cos(theta);
    const long double force = weight * (1 - place * ds) + load;
    for (std::size_t k = 0; k + 2 < t.size(); ++k) {
      if (k > 0) {
        for (std::size_t j = 1; j <= k; ++j) {
          sine[k] += j * t[j] * cosine[k - j] / k;
          cosine[k] -= j * t[j] * sine[k - j] / k;
        }
      }
      t[k + 2] = -(force * cosine[k] - (k > 0 ? weight * cosine[k - 1] : 0)) / ((k + 1) * (k + 2));
    }
    theta = curvature = 0;
    for (std::size_t k = t.size() - 3; k + 1 > 0; --k) {
      theta = theta * ds + t[k];
      drop += sine[k] * std::pow(ds, (long double)(k + 1)) / (k + 1);
      reach += cosine[k] * std::pow(ds, (long double)(k + 1)) / (k + 1);
    }
    for (std::size_t k = t.size() - 3; k > 0; --k) curvature = curvature * ds + k * t[k];
  }
  return {curvature, drop, reach};
}

struct BentTip {
  Estimate drop, reach;
};

/// The tip without curvature, by bisection of the clamp's. The series err by far less than 1e-15,
/// the answer is rounded.
BentTip bent_strip(double weight, double load) {
  long double low = 0, high = weight / 2 + load;
  for (int i = 0; i < 70; ++i) {
    const long double middle = (low + high) / 2;
    (bent_by_series(weight, load, middle).curvature < 0 ? low : high) = middle;
  }
  const Tip tip = bent_by_series(weight, load, low);
  return {{double(tip.drop), 1e-15}, {double(tip.reach), 1e-15}};
}

/// A patch of nine by nine cells of rectangles split as `rises` says, all of whose points stay on
/// the cylinder; the hinges of a block of 2 x 2 cells in its middle count.
oracles::PlaneSheet patch_of(const oracles::SplitBlock& block) {
  constexpr int cells = 9, first = 4;
  oracles::PlaneSheet sheet;
  sheet.points.resize(2, (cells + 1) * (cells + 1));
  const auto point = [](int i, int j) { return j * (cells + 1) + i; };
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i)
      sheet.points.col(point(i, j)) = Eigen::Vector2d(i * block.width, j * block.height);
  const auto rises = [&](int i, int j) {
    return !block.rises || block.rises(i % block.columns, j % block.rows);
  };
  // the corner of cell (i, j) that is opposite to the side shared with a neighbour
  const auto add = [&](int x1, int x2, int x3, int x4, bool counts) {
    sheet.hinges.push_back({x1, x2, x3, x4});
    sheet.counted.push_back(counts);
  };
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      const bool inside = i >= first && i < first + 2 && j >= first && j < first + 2;
      const int a = point(i, j), b = point(i + 1, j), c = point(i + 1, j + 1), d = point(i, j + 1);
      if (rises(i, j))
        add(d, b, a, c, inside);  // triangles a b c below, a c d above the diagonal a c
      else
        add(a, c, b, d, inside);  // a b d and b c d
      if (i + 1 < cells)
        add(rises(i, j) ? a : d, rises(i + 1, j) ? point(i + 2, j + 1) : point(i + 2, j), b, c,
            inside);
      if (j + 1 < cells)
        add(rises(i, j + 1) ? point(i + 1, j + 2) : point(i, j + 2), rises(i, j) ? a : b, d, c,
            inside);
    }
  sheet.held.assign(std::size_t(sheet.points.cols()), 1);
  return sheet;
}

/// The slope of the map that climbs from eps at -t^ to tau at tau, integrated: y = f, or f and f'.
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

/// f'' is 0 and then (1 - m)/w; m such that f climbs from eps to tau, by bracketing.
Estimate blend_map_by_equation(const oracles::Band& band, double phi) {
  const double whole = band.reach + band.deepest, w = (band.reach - band.nearest) / 2 / whole,
               bend = 1 - w;
  double off = 0;
  const auto climbed = [&](double m, double to) {
    // in two parts, since the slope's slope jumps between them
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

}  // namespace

Table heavy_cantilevers_agree() {
  Table answers = no_answers();
  for (const double gamma : {.37, 1., 5., 11.}) {
    const oracles::CantileverTip tip = oracles::heavy_cantilever(gamma);
    const BentTip other = bent_strip(gamma, 0);
    compare_worst(answers, "gamma " + std::to_string(gamma),
                  {{tip.drop, other.drop}, {tip.reach, other.reach}});
  }
  return answers;
}

Table loaded_tips_agree() {
  Table answers = no_answers();
  for (const double alpha : {.23, 1., 4., 9.}) {
    const oracles::LoadedTip elliptic = oracles::tip_load(alpha),
                             shooting = oracles::tip_load_by_shooting(alpha);
    const BentTip series = bent_strip(0, alpha);
    const std::string name = "alpha " + std::to_string(alpha);
    compare_worst(answers, name + ", elliptic integrals and shooting",
                  {{elliptic.drop, shooting.drop}, {elliptic.reach, shooting.reach}});
    compare_worst(answers, name + ", elliptic integrals and series",
                  {{elliptic.drop, series.drop}, {elliptic.reach, series.reach}});
  }
  return answers;
}

Table bent_strips_agree() {
  using oracles::HeavyStrip;
  Table answers = no_answers();
  const std::array<double, 3> s{.13, .5, .81};
  using oracles::EndHold;
  const std::array<std::pair<const char*, HeavyStrip>, 7> strips{
      {{"heart loop", {37, pi / 2, {{-5 * pi / 2, 0, 0}}, 0}},
       {"pear loop", {110, -pi / 2, {{-3 * pi / 2, 0, 0}}, 0}},
       {"hanging ring", {53, 0, {{-2 * pi, 0, 0}}, 0}},
       {"standing ring", {71, 0, {{2 * pi, 0, 0}}, 0}},
       {"standing wrinkle", {29, 0, {{0, .7, 0}}, 1}},
       {"slanting wrinkle", {17, .2, {{-.3, .85, .11}}, .9}},
       {"pressed strip", {0, -pi / 2, {{-2, 0, -.93, EndHold::pinned}}, .5}}}};
  for (const auto& [name, strip] : strips) {
    const oracles::StripShape one = oracles::strip_by_collocation(strip, s),
                              other = oracles::strip_by_shooting(strip, s);
    std::vector<std::pair<Estimate, Estimate>> pairs;
    for (std::size_t i = 0; i < s.size(); ++i)
      for (const auto part :
           {&oracles::StripPoint::slope, &oracles::StripPoint::across, &oracles::StripPoint::up})
        pairs.push_back(
            {{one.points[i].*part, one.uncertainty}, {other.points[i].*part, other.uncertainty}});
    compare_worst(answers, std::string(name) + ", collocation and shooting", pairs);
  }
  const HeavyStrip folded{17, 0, {{pi, 0, 0}}, 0};
  const oracles::Fold one = oracles::fold_on_floor(folded, .15, .3, oracles::strip_by_collocation),
                      other = oracles::fold_on_floor(folded, .15, .3, oracles::strip_by_shooting);
  compare_worst(answers, "clamped fold, collocation and shooting",
                {{one.lift_off, other.lift_off}, {one.height, other.height}});
  for (const double gamma : {.1, 13., 700., 1e4}) {
    const oracles::StripShape shape =
        oracles::strip_by_collocation({gamma, 0, {}, 0}, std::array<double, 1>{1});
    const oracles::CantileverTip tip = oracles::heavy_cantilever(gamma);
    compare_worst(answers,
                  "free end, collocation and shooting from the tip, gamma " + std::to_string(gamma),
                  {{{-shape.points[0].up, shape.uncertainty}, tip.drop},
                   {{shape.points[0].across, shape.uncertainty}, tip.reach}});
  }
  return answers;
}

Table rigidities_agree() {
  Table answers = no_answers();
  const std::array<std::pair<const char*, oracles::SplitBlock>, 4> blocks{
      {{"one diagonal", {.8, .5, 1, 1, [](int, int) { return true; }}},
       {"alternating", {.7, .7, 1, 2, [](int, int j) { return j % 2 == 0; }}},
       {"union jack", {1.3, .9, 2, 2, [](int i, int j) { return (i + j) % 2 == 0; }}},
       {"falling rows", {.4, .6, 1, 2, [](int, int j) { return j % 2 == 1; }}}}};
  constexpr double off = 1e-12;  // some hundred roundings of numbers of size 1
  for (const auto& [name, block] : blocks) {
    const Eigen::Matrix3d periodic = oracles::forced_rigidity(oracles::split_rectangles(block));
    const oracles::PlaneSheet patch = patch_of(block);
    for (const double angle : {.1, 1.3, 2.2})
      compare(answers, std::string(name) + ", cell and patch, at " + std::to_string(angle),
              {oracles::cylinder_rigidity(periodic, angle), off},
              {oracles::forced_cylinder_rigidity(patch, angle), off});
  }
  const auto jack =
      oracles::split_rectangles({1, 1, 2, 2, [](int i, int j) { return (i + j) % 2 == 0; }});
  for (const double angle : {.1, .9, 2.2})  // criss-cross is union jack, turned by 45 degrees
    compare(answers, "relaxed union jack and criss-cross, at " + std::to_string(angle),
            {oracles::cylinder_rigidity(oracles::relaxed_rigidity(jack), angle), off},
            {oracles::cylinder_rigidity(oracles::relaxed_rigidity(oracles::crossed_squares(1)),
                                        angle + pi / 4),
             off});
  return answers;
}

Table depth_maps_agree() {
  Table answers = no_answers();
  for (const oracles::Band& band : {oracles::Band{.001, .02, .05}, oracles::Band{.003, .011, .004}})
    for (const double part : {.12, .55, .93}) {
      const double phi = -band.deepest + part * (band.reach + band.deepest);
      const std::string name =
          "t^ " + std::to_string(band.deepest) + ", phi " + std::to_string(phi);
      compare(answers, "power, " + name, oracles::power_map(band, phi),
              power_map_by_equation(band, phi));
      compare(answers, "blend, " + name, oracles::blend_map(band, phi),
              blend_map_by_equation(band, phi));
    }
  return answers;
}

// The matrix of second differences, whose eigenvalues are 2 - 2 cos(k pi/(n + 1)); a companion
// matrix, whose are the roots chosen; a system whose solution is chosen; a matrix made of two turns
// and chosen singular values.
Table dense_algebra_agrees() {
  Table answers = no_answers();
  Random random(839);
  for (const int n : {5, 9}) {
    Eigen::MatrixXd K = 2 * Eigen::MatrixXd::Identity(n, n);
    K.diagonal(1).setConstant(-1);
    K.diagonal(-1).setConstant(-1);
    const Eigen::VectorXd values = oracles::symmetric_eigenvalues(K);
    std::vector<std::pair<Estimate, Estimate>> pairs;
    for (int k = 1; k <= n; ++k)
      pairs.push_back(
          {{values[k - 1], 20 * n * epsilon}, {2 - 2 * std::cos(k * pi / (n + 1)), 4 * epsilon}});
    compare_worst(answers, "second differences of " + std::to_string(n), pairs);
    const Eigen::MatrixXd A = K + .1 * Eigen::MatrixXd::Ones(n, n);
    const Eigen::VectorXd x = random.vectors(n, 1).row(0).transpose();
    const Eigen::VectorXd found = oracles::solve_linear(A, A * x),
                          again = oracles::solve_symmetric(A, A * x);
    pairs.clear();  // the condition of these is below 50
    for (int k = 0; k < n; ++k) {
      pairs.push_back({{found[k], 200 * n * epsilon}, {x[k], 0}});
      pairs.push_back({{again[k], 200 * n * epsilon}, {x[k], 0}});
    }
    compare_worst(answers, "chosen solution of " + std::to_string(n), pairs);
  }
  for (const std::array<double, 3>& roots :
       {std::array<double, 3>{-.7, .4, 1.9}, std::array<double, 3>{-3.1, -1.2, .6}}) {
    Eigen::Matrix3d companion;
    companion << roots[0] + roots[1] + roots[2],
        -(roots[0] * roots[1] + roots[1] * roots[2] + roots[2] * roots[0]),
        roots[0] * roots[1] * roots[2], 1, 0, 0, 0, 1, 0;
    Eigen::VectorXd found = oracles::eigenvalues(companion).real();
    std::sort(found.begin(), found.end());
    std::vector<std::pair<Estimate, Estimate>> pairs;
    for (int k = 0; k < 3; ++k)
      pairs.push_back({{found[k], 300 * epsilon}, {roots[std::size_t(k)], 0}});
    compare_worst(answers, "companion of root " + std::to_string(roots[0]), pairs);
  }
  for (const Vector3& values : {Vector3(3.7, 1.1, .2), Vector3(41, 6, 5)}) {
    const Vector3 from = random.vectors(1, 1).col(0), to = random.vectors(1, 1).col(0);
    const Eigen::Matrix3d U = oracles::rotation_between(from, to).toRotationMatrix();
    // the axis of a turn by nearly half a circle is known as well as its half angle's
    // cosine is large
    const double half = std::sqrt((1 + from.normalized().dot(to.normalized())) / 2);
    const Eigen::Matrix3d V = Eigen::AngleAxisd(1.1, from.normalized()).toRotationMatrix();
    const oracles::SingularParts parts =
        oracles::singular_parts(U * values.asDiagonal() * V.transpose());
    std::vector<std::pair<Estimate, Estimate>> pairs;
    for (int k = 0; k < 3; ++k) {
      pairs.push_back({{parts.values[k], 30 * epsilon * values[0]}, {values[k], 0}});
      pairs.push_back(
          {{(U * from.normalized())[k], 10 * epsilon / half}, {to.normalized()[k], 10 * epsilon}});
    }
    compare_worst(answers, "singular value " + std::to_string(values[0]), pairs);
  }
  return answers;
}

}  // namespace foldproof
