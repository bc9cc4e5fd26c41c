#include <Eigen/Dense>

#include "verification/checks/oracles/agreement.h"
#include "verification/oracles/elastica.h"
#include "verification/oracles/folds.h"
#include "verification/oracles/gsl.h"
#include "verification/oracles/heavy_cantilever.h"
#include "verification/oracles/homogenised_bending.h"
#include "verification/oracles/tip_load.h"

namespace foldproof {

namespace {

using oracles::Estimate;
using Series = std::array<long double, 26>;  // coefficients of powers of the arc length

/// Tip of the strip for one curvature at the clamp: derivative of the slope, drop, reach.
struct Tip {
  long double curvature, drop, reach;
};

/// theta'' = -(weight (1 - s) + load) cos(theta) from theta = 0 at the clamp, by its power series
/// about each of sixty points in extended precision, with no step-size control, stages or GSL.
/// weight = rho_A g L^3/B, load = P L^2/B.
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

/// The tip where its curvature is zero, by bisection on the clamp's. The series err by far less
/// than 1e-15; the answer is rounded.
BentTip bent_strip(double weight, double load) {
  long double low = 0, high = weight / 2 + load;
  for (int i = 0; i < 70; ++i) {
    const long double middle = (low + high) / 2;
    (bent_by_series(weight, load, middle).curvature < 0 ? low : high) = middle;
  }
  const Tip tip = bent_by_series(weight, load, low);
  return {{double(tip.drop), 1e-15}, {double(tip.reach), 1e-15}};
}

/// A patch of nine by nine rectangular cells, split according to `rises`; all its points stay on
/// the cylinder. Only the hinges of the 2 x 2 cells in its middle count.
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
  // the corner of cell (i, j) opposite to the side shared with a neighbour
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

void heavy_cantilevers_agree(Answers& answers) {
  for (const double gamma : {.37, 1., 5., 11.}) {
    const oracles::CantileverTip tip = oracles::heavy_cantilever(gamma);
    const BentTip other = bent_strip(gamma, 0);
    answers.compare_worst("gamma " + std::to_string(gamma),
                          {{tip.drop, other.drop}, {tip.reach, other.reach}});
  }
}

void loaded_tips_agree(Answers& answers) {
  for (const double alpha : {.23, 1., 4., 9.}) {
    const oracles::LoadedTip elliptic = oracles::tip_load(alpha),
                             shooting = oracles::tip_load_by_shooting(alpha);
    const BentTip series = bent_strip(0, alpha);
    const std::string name = "alpha " + std::to_string(alpha);
    answers.compare_worst(name + ", elliptic integrals and shooting",
                          {{elliptic.drop, shooting.drop}, {elliptic.reach, shooting.reach}});
    answers.compare_worst(name + ", elliptic integrals and series",
                          {{elliptic.drop, series.drop}, {elliptic.reach, series.reach}});
  }
}

void bent_strips_agree(Answers& answers) {
  using oracles::HeavyStrip;
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
    Pairs pairs;
    for (std::size_t i = 0; i < s.size(); ++i)
      for (const auto part :
           {&oracles::StripPoint::slope, &oracles::StripPoint::across, &oracles::StripPoint::up})
        pairs.push_back(
            {{one.points[i].*part, one.uncertainty}, {other.points[i].*part, other.uncertainty}});
    answers.compare_worst(std::string(name) + ", collocation and shooting", pairs);
  }
  const HeavyStrip folded{17, 0, {{pi, 0, 0}}, 0};
  const oracles::Fold one = oracles::fold_on_floor(folded, .15, .3, oracles::strip_by_collocation),
                      other = oracles::fold_on_floor(folded, .15, .3, oracles::strip_by_shooting);
  answers.compare_worst("clamped fold, collocation and shooting",
                        {{one.lift_off, other.lift_off}, {one.height, other.height}});
  for (const double gamma : {.1, 13., 700., 1e4}) {
    const oracles::StripShape shape =
        oracles::strip_by_collocation({gamma, 0, {}, 0}, std::array<double, 1>{1});
    const oracles::CantileverTip tip = oracles::heavy_cantilever(gamma);
    answers.compare_worst(
        "free end, collocation and shooting from the tip, gamma " + std::to_string(gamma),
        {{{-shape.points[0].up, shape.uncertainty}, tip.drop},
         {{shape.points[0].across, shape.uncertainty}, tip.reach}});
  }
}

void rigidities_agree(Answers& answers) {
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
      answers.compare(std::string(name) + ", cell and patch, at " + std::to_string(angle),
                      {oracles::cylinder_rigidity(periodic, angle), off},
                      {oracles::forced_cylinder_rigidity(patch, angle), off});
  }
  const auto jack =
      oracles::split_rectangles({1, 1, 2, 2, [](int i, int j) { return (i + j) % 2 == 0; }});
  for (const double angle : {.1, .9, 2.2})  // criss-cross is union jack turned by 45 degrees
    answers.compare("relaxed union jack and criss-cross, at " + std::to_string(angle),
                    {oracles::cylinder_rigidity(oracles::relaxed_rigidity(jack), angle), off},
                    {oracles::cylinder_rigidity(
                         oracles::relaxed_rigidity(oracles::crossed_squares(1)), angle + pi / 4),
                     off});
}

}  // namespace

std::vector<Comparison> static_comparisons() {
  return {
      {"oracle.heavy-cantilevers-agree",
       "The oracle's heavy cantilever by GSL from its tip is that by power series from its clamp.",
       heavy_cantilevers_agree},
      {"oracle.loaded-strips-agree",
       "The oracle's loaded strip by elliptic integrals is that by GSL's shooting and that by "
       "power "
       "series.",
       loaded_tips_agree},
      {"oracle.bent-strips-agree",
       "The oracle's strips by collocation are those by GSL's shooting from the clamp, and from "
       "the "
       "tip where one end is free.",
       bent_strips_agree},
      {"oracle.rigidities-agree",
       "The oracle's rigidities of a periodic cell are those of a patch of hinges, and of the same "
       "mesh turned by 45 degrees.",
       rigidities_agree}};
}

}  // namespace foldproof
