// Strips bent as in a textile laboratory, clamped at both ends, against the elastica.

#include "verification/oracles/elastica.h"
#include "verification/oracles/folds.h"
#include "verification/subjects/suite/laws.h"
#include "verification/subjects/suite/relaxation.h"
#include "verification/subjects/suite/strips.h"

namespace foldproof {

namespace {

using namespace suite;
using oracles::HeavyStrip, oracles::StripPoint;

//   held     free      held
//  .-.-.-.-.- ... -.-.-.-.-.    -> arc length      Two rows at each end are held. Where triangles
//   0   1   2       n-1  n                          fold at edges, bending begins in the middle of
//                                                   the held panel, elsewhere at its inner row.
constexpr StripShape shape{3, 24, 0.04};
constexpr double given = 8e-3;                                     // B of the scene [N m]
constexpr double young = 500;                                      // N/m
const double h = shape.row_height(), length = shape.length() - h;  // between middles of panels [m]

/// A strip as it is bent. Its weight is such that the elastica moves by 2 % of its length and more
/// from the shape without weight, in which it starts.
struct Bent {
  const char* words;
  HeavyStrip elastica;
};

PortableScene flat_strip() {
  return free_strip(shape, {.young = young, .bending_rigidity = given}, 2e-4);
}

Eigen::Vector2d direction(double slope) { return {std::cos(slope), std::sin(slope)}; }

/// Places of the rows from the middle of the first held panel, across and up [m], if bending begins
/// `from` inside the middle of the held panels, and the strip weighs `heavier` times as much.
Eigen::Matrix2Xd rows_of_elastica(const HeavyStrip& given_strip, double from, double heavier) {
  HeavyStrip strip = given_strip;
  const double free = length - 2 * from;
  const Eigen::Vector2d first = from * direction(strip.first_slope),
                        last = length * Eigen::Vector2d(strip.last->across, strip.last->up) -
                               from * direction(strip.last->slope);
  strip.gamma *= heavier * std::pow(free / length, 3);
  strip.last->across = (last - first).x() / free;
  strip.last->up = (last - first).y() / free;
  std::vector<double> arcs;
  for (int k = 1; k < shape.rows; ++k)
    arcs.push_back(std::clamp(((k - 0.5) * h - from) / free, 0.0, 1.0));
  const oracles::StripShape bent = oracles::strip_by_collocation(strip, arcs);
  Eigen::Matrix2Xd rows(2, shape.rows + 1);
  for (int k = 1; k < shape.rows; ++k) {
    const StripPoint& point = bent.points[size_t(k - 1)];
    rows.col(k) = first + free * Eigen::Vector2d(point.across, point.up);
  }
  const Eigen::Vector2d ahead = h / 2 * direction(strip.last->slope),
                        end = length *
                              Eigen::Vector2d(given_strip.last->across, given_strip.last->up);
  rows.col(1) = h / 2 * direction(strip.first_slope);
  rows.col(0) = -rows.col(1);
  rows.col(shape.rows - 1) = end - ahead;
  rows.col(shape.rows) = end + ahead;
  return rows;
}

/// At rest in the shape that it would have without weight.
PortableScene weightless_start(const Bent& bent, double gravity) {
  PortableScene scene =
      clamped_strip(flat_strip(), shape, rows_of_elastica(bent.elastica, 0, 0), gravity);
  scene.name = bent.words;
  return scene;
}

/// Where the elastica's rows are: between those of four strips.
struct Allowed {
  Eigen::Matrix2Xd least, most;

  /// How far the farthest row is outside [m].
  double outside(const Eigen::Matrix2Xd& rows) const {
    Worst worst;
    for (Eigen::Index k = 0; k < rows.cols(); ++k)
      worst.observe(
          (least.col(k) - rows.col(k)).cwiseMax(rows.col(k) - most.col(k)).cwiseMax(0).norm());
    return worst.value();
  }
};

/// rounding: of the load [1]
Allowed allowed(const HeavyStrip& strip, double rounding) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Allowed all{Eigen::Matrix2Xd::Constant(2, shape.rows + 1, infinity),
              Eigen::Matrix2Xd::Constant(2, shape.rows + 1, -infinity)};
  for (const double from : {0.0, h / 2})
    for (const double heavier : possible_weights(rounding)) {
      const Eigen::Matrix2Xd rows = rows_of_elastica(strip, from, heavier);
      all.least = all.least.cwiseMin(rows);
      all.most = all.most.cwiseMax(rows);
    }
  return all;
}

/// The mean of (turn from panel to panel)^2/24: a chord is shorter than its arc by this share.
double share_of_chords(const Eigen::Matrix2Xd& rows) {
  return squared_turns(rows) / double(rows.cols() - 2) / 24;
}

/// How far forces that round positions may change a row's weight [1]. Throws NotOffered if that
/// is a tenth of it.
double rounding_of_load(const PortableScene& scene, const Declaration& declared) {
  const double of_force = scene.material.young * declared.rounding() * length / h,  // N/m
      share = of_force / (scene.material.density * scene.gravity.norm() * h);
  if (share < 0.1) return share;
  throw NotOffered{fmt::format("digits enough: rounding makes {:.2g} of a row's weight", share)};
}

void compare(Trial& trial, const Bent& bent, double rigidity, Table& shapes) {
  const double density = flat_strip().material.density,
               gravity = gravity_of(bent.elastica.gamma, rigidity, flat_strip(), length);
  const PortableScene scene = weightless_start(bent, gravity);
  const Relaxed end = relaxed(trial, scene, {scene.x, length, 1e-4, 4e-3});
  const Eigen::Matrix2Xd rows = mean_rows(scene, shape, end.x);
  const Allowed rest = allowed(bent.elastica, rounding_of_load(scene, trial.declaration()));
  const double outside = rest.outside(rows) / length, moved = end.last_move / length,
               stretch = density * gravity * length / (2 * young),
               bound = share_of_chords(rows_of_elastica(bent.elastica, 0, 1)) + stretch;
  constexpr int middle = shape.rows / 2;
  shapes.row(bent.words, rigidity, gravity, rows(1, middle) / length,
             rest.least(1, middle) / length, rest.most(1, middle) / length, outside, moved, bound,
             (outside + moved) / bound);
}

Finding take_their_shape(Trial& trial, const std::vector<Bent>& strips) {
  const double rigidity = measured_rigidity(trial, flat_strip(), shape);
  require_resistance("bending", rigidity, given);
  Table shapes = table_of(
      "strip | measured rigidity [N m] | gravity [m/s^2] | height of the middle [L] | at least [L] "
      "| "
      "at most [L] | farthest row outside [L] | last move [L] | allowed [L] | "
      "of both, over what is allowed [1]");
  for (const Bent& bent : strips) compare(trial, bent, rigidity, shapes);
  return judge_worst(
      shapes, 1,
      "allowed: chords instead of arcs, the mean of (turn a row)^2/24, and half the strain that "
      "the strip's weight makes; the elastica is that of its rigidity measured to 2 % and to the "
      "rounding of forces, as a plate or a beam, bent from the held row or half a row before it");
}

std::vector<Bent> loops() {
  const double down = -pi / 2, up = pi / 2;
  return {{"heart loop", {180, up, {{up - 3 * pi, 0, 0}}}},
          {"pear loop", {400, down, {{down - pi, 0, 0}}}}};
}

std::vector<Bent> rings() {
  return {{"hanging ring", {300, 0, {{-2 * pi, 0, 0}}}},
          {"standing ring", {180, 0, {{2 * pi, 0, 0}}}}};
}

std::vector<Bent> wrinkles() {
  return {{"hanging wrinkle", {400, 0, {{0, 0.8, 0}}, -1}},
          {"standing wrinkle", {80, 0, {{0, 0.8, 0}}, 1}}};
}

/// Clamped where a strip that is folded back over itself lifts off a floor, and where a long one
/// comes down; a short one is held there. Where it lifts off or comes down it has no moment: so
/// clamps hold it as the floor would.
std::vector<Bent> folds() {
  const oracles::FreeFold fold = oracles::free_fold_by_collocation();
  const double lifted = fold.lifted.value, across = fold.points.back().across / lifted;
  const HeavyStrip held{100, 0, {{pi, 0, 0}}};  // its last end over its first
  const oracles::Fold on_floor =
      oracles::fold_on_floor(held, 0.2, 0.4, oracles::strip_by_collocation);
  return {{"free fold", {std::pow(lifted, 3), 0, {{pi, across, 0}}}},
          {"clamped fold", oracles::lifted_part(held, on_floor.lift_off.value)}};
}

Law law_of(const char* name, const char* claim, std::vector<Bent> (*strips)()) {
  return {name, claim, "heavy elastica, Plaut 2015",
          [strips](Trial& trial) { return take_their_shape(trial, strips()); }, "L1 held bending"};
}

}  // namespace

std::vector<Law> bent_strip_laws() {
  return {
      law_of("strip.loops-hang-as-the-elastica",
             "A heart loop and a pear loop take the elastica's shape for their own rigidity.",
             loops),
      law_of("strip.rings-take-the-elastica-s-shape",
             "A ring that hangs, and one that stands, take the elastica's shape.", rings),
      law_of("strip.wrinkles-take-the-elastica-s-shape",
             "A wrinkle that hangs, and one that stands, take the elastica's shape.", wrinkles),
      law_of("strip.folds-take-the-elastica-s-shape",
             "A strip held where a fold lifts off a floor, and where it comes down or is clamped, "
             "takes the fold's shape.",
             folds),
  };
}

}  // namespace foldproof
