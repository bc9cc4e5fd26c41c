// A strip that lies on a smooth floor and is folded back over itself, against the elastica.

#include "verification/oracles/folds.h"
#include "verification/subjects/suite/laws.h"
#include "verification/subjects/suite/relaxation.h"
#include "verification/subjects/suite/strips.h"

namespace foldproof {

namespace {

using namespace suite;
using oracles::HeavyStrip, oracles::StripPoint;

//               .-'''-.       Two rows at each end are held flat on the floor, the last ones over
//   held   _.-''      |       the first. It starts in a heavier strip's shape, so that it must peel
//   ====:-._________.-'       off the floor: a floor that holds it down shows.
constexpr StripShape shape{3, 24, 0.04};
constexpr double given = 8e-3;                                     // B of the scene [N m]
constexpr double young = 500;                                      // N/m
constexpr double gamma_of_law = 80, gamma_of_start = 300;          // rho g L^3/B [1]
const double h = shape.row_height(), length = shape.length() - h;  // between middles of panels [m]

PortableScene flat_strip() {
  return free_strip(shape, {.young = young, .bending_rigidity = given}, 2e-4);
}

/// Points at these arc lengths, over the length [1].
std::vector<StripPoint> fold_of(double gamma, const std::vector<double>& arcs) {
  const HeavyStrip strip{gamma, 0, {{pi, 0, 0}}};
  const double lift =
      oracles::fold_on_floor(strip, 0.1, 0.45, oracles::strip_by_collocation).lift_off.value;
  std::vector<double> free;
  for (const double arc : arcs) free.push_back(std::max(0.0, (arc - lift) / (1 - lift)));
  std::vector<StripPoint> points =
      oracles::strip_by_collocation(oracles::lifted_part(strip, lift), free).points;
  for (size_t k = 0; k < arcs.size(); ++k)
    points[k] = arcs[k] < lift ? StripPoint{0, arcs[k], 0}
                               : StripPoint{points[k].slope, lift + (1 - lift) * points[k].across,
                                            (1 - lift) * points[k].up};
  return points;
}

/// Of the rows, from the middle of the held panels [m].
Eigen::Matrix2Xd rows_of_fold(double gamma) {
  std::vector<double> arcs;
  for (int k = 1; k < shape.rows; ++k) arcs.push_back((k - 0.5) * h / length);
  const std::vector<StripPoint> points = fold_of(gamma, arcs);
  Eigen::Matrix2Xd rows(2, shape.rows + 1);
  for (int k = 1; k < shape.rows; ++k)
    rows.col(k) = length * Eigen::Vector2d(points[size_t(k - 1)].across, points[size_t(k - 1)].up);
  rows.col(0) = rows.col(shape.rows) = Eigen::Vector2d(-h / 2, 0);
  rows.col(1) = rows.col(shape.rows - 1) = Eigen::Vector2d(h / 2, 0);
  return rows;
}

PortableScene fold_on_floor(double gravity) {
  PortableScene scene = clamped_strip(flat_strip(), shape, rows_of_fold(gamma_of_start), gravity);
  scene.name = "fold on a floor";
  scene.planes = {{Vector3::Zero(), Vector3::UnitZ(), 0}};
  return scene;
}

/// The largest of a row of numbers, by the parabola through it and its neighbours.
double largest(const Eigen::RowVectorXd& values) {
  Eigen::Index top = 0;
  values.maxCoeff(&top);
  top = std::clamp<Eigen::Index>(top, 1, values.size() - 2);
  const double before = values[top - 1], after = values[top + 1],
               bend = before - 2 * values[top] + after;
  return bend < 0 ? values[top] - std::pow((after - before) / 2, 2) / (2 * bend) : values[top];
}

/// How high a fold stands, and how far out it goes [m].
struct Extent {
  double height, reach;
};

Extent extent_of(const Eigen::Matrix2Xd& rows) {
  return {largest(rows.row(1)), largest(rows.row(0))};
}

/// Of the elastica of gamma, with bending from `inside` the middles of the held panels on.
Extent extent_of(double gamma, double inside) {
  constexpr int count = 400;
  const double free = length - 2 * inside;
  std::vector<double> arcs;
  for (int k = 0; k <= count; ++k) arcs.push_back(double(k) / count);
  const std::vector<StripPoint> points = fold_of(gamma * std::pow(free / length, 3), arcs);
  Eigen::Matrix2Xd rows(2, count + 1);
  for (int k = 0; k <= count; ++k) rows.col(k) << points[size_t(k)].across, points[size_t(k)].up;
  const Extent of_unit = extent_of(rows);
  return {free * of_unit.height, inside + free * of_unit.reach};
}

struct Allowed {
  Extent least, most;
};

/// rounding: of the load [1]
Allowed allowed(double rounding) {
  Allowed all{{length, length}, {0, 0}};
  for (const double inside : {0.0, h / 2})
    for (const double heavier : possible_weights(rounding)) {
      const Extent one = extent_of(gamma_of_law * heavier, inside);
      all.least.height = std::min(all.least.height, one.height);
      all.least.reach = std::min(all.least.reach, one.reach);
      all.most.height = std::max(all.most.height, one.height);
      all.most.reach = std::max(all.most.reach, one.reach);
    }
  return all;
}

Finding stands_as_high_as_the_elastica(Trial& trial) {
  const double rigidity = measured_rigidity(trial, flat_strip(), shape);
  require_resistance("bending", rigidity, given);
  const double density = flat_strip().material.density,
               gravity = gravity_of(gamma_of_law, rigidity, flat_strip(), length);
  const PortableScene scene = fold_on_floor(gravity);
  const Eigen::Matrix2Xd start = mean_rows(scene, shape, scene.x);
  const double stored = rigidity * shape.width() * squared_turns(start) / (2 * h);
  const Relaxed end = relaxed(trial, scene, {scene.x, length, 1e-4, 4e-3, stored});
  const Eigen::Matrix2Xd rows = mean_rows(scene, shape, end.x);
  const Extent found = extent_of(rows);
  // forces that round positions, over a row's weight
  const double rounding =
      young * trial.declaration().rounding() * length / h / (density * gravity * h);
  const Allowed range = allowed(rounding);
  const double moved = end.last_move / length,
               off_floor = std::abs(rows.row(1).segment(2, 3).mean()) / length,
               bound = squared_turns(rows_of_fold(gamma_of_law)) / (24 * shape.rows) +
                       density * gravity * length / (2 * young) + off_floor;
  Table measured = table_of(
      "of the fold | measured rigidity [N m] | at the start [L] | measured [L] | at least [L] | "
      "at most [L] | last move [L] | allowed [L] | "
      "outside of both and last move, over what is allowed [1]");
  const auto row = [&](const char* of, double began, double value, double least, double most) {
    const double outside = std::max({0.0, least - value, value - most}) / length;
    measured.row(of, rigidity, began / length, value / length, least / length, most / length, moved,
                 bound, (outside + moved) / bound);
  };
  const Extent began = extent_of(start);
  row("height", began.height, found.height, range.least.height, range.most.height);
  row("reach", began.reach, found.reach, range.least.reach, range.most.reach);
  return judge_worst(
      measured, 1,
      "allowed: chords instead of arcs, the mean of (turn a row)^2/24; half the strain that the "
      "strip's weight makes; how far above the floor its third to fifth rows lie. The elastica is "
      "that of its rigidity measured to 2 % and to the rounding of forces, as a plate or a beam, "
      "bent from the held row or half a row before it");
}

}  // namespace

std::vector<Law> fold_laws() {
  return {
      {"floor.clamped-fold-stands-as-high-as-the-elastica",
       "A strip that lies on a smooth floor, folded back over itself, stands as high as the "
       "elastica and goes as far out.",
       "heavy elastica, Plaut 2015", stands_as_high_as_the_elastica, "L1 held planes bending",
       "of the fold | measured | at least | at most"},
  };
}

}  // namespace foldproof
