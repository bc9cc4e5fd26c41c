#include "convergence/bending/row_strip.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "verification/oracles/dense_algebra.h"
#include "verification/specimens/specimens.h"

namespace foldproof {

namespace {

constexpr int cells_across = 3;  // an odd number of whole cells; equilateral: edges

Scene strip_scene(const StripPattern& pattern, int panels, double spacing, const StripLoad& load) {
  const double edge = spacing / pattern.spacing_over_edge;
  const double length = (panels + 1) * spacing, width = cells_across * edge;
  const bool along_x = pattern.along == 0;
  const Sheet sheet{pattern.pattern, along_x ? length : width, along_x ? width : length,
                    along_x ? panels + 1 : cells_across, along_x ? cells_across : panels + 1};
  Scene scene = scene_at_rest(make_sheet(sheet), strip_density);
  add_flat_hinges(scene, strip_ke, 0);
  if (load.gravity > 0) scene.gravity = Vector3(0, 0, -load.gravity);
  if (load.stretch > 0) scene.stretch = StretchMaterial{load.stretch, 0, 1};
  return scene;
}

Eigen::Vector2d direction(double slope) { return {std::cos(slope), std::sin(slope)}; }

/// Generalised forces: turning a panel [N m] carries all rows behind it, stretching it [N] too.
/// Slopes first, then strains (forces times the spacing [N m]).
Eigen::VectorXd generalised_forces(const RowStrip& strip, const Eigen::VectorXd& unknowns) {
  const Eigen::Index n = strip.panels();
  const Eigen::VectorXd slopes = unknowns.head(n),
                        lengths = strip.spacing() * unknowns.segment(n, n);
  const Eigen::Matrix2Xd force = strip.forces(strip.rows(slopes, lengths));
  Eigen::VectorXd generalised(2 * n);
  Eigen::Vector2d behind = Eigen::Vector2d::Zero();
  for (Eigen::Index k = n - 1; k >= 0; --k) {
    behind += force.col(k + 2);
    const Eigen::Vector2d along = direction(slopes[k]), across(-along.y(), along.x());
    generalised[k] = lengths[k] * across.dot(behind);
    generalised[n + k] = strip.spacing() * along.dot(behind);
  }
  return generalised;
}

/// The last panel is held in its middle.
bool is_held_in_a_panel(const RowStrip& strip) {
  return strip.hold().last && strip.hold().last->hold != RowHold::pinned;
}

/// Of slope, along and up (0, 1, 2): which the hold of the last end prescribes, and along which of
/// them it pushes.
struct HeldNumbers {
  std::vector<Eigen::Index> prescribed, pushed;
};

HeldNumbers held_numbers(const RowStrip& strip) {
  if (!strip.hold().last) return {};
  switch (strip.hold().last->hold) {
    case RowHold::clamped:
      return {{0, 1, 2}, {0, 1, 2}};
    case RowHold::pinned:
      return {{1, 2}, {1, 2}};
    case RowHold::propped:
      return {{0}, {2}};
  }
  throw std::logic_error("held_numbers: a hold without its numbers");
}

/// How the last panel's slope [rad] and its held place [m] change with slopes and strains: 3 x 2 n.
Eigen::Matrix3Xd motion_of_end(const RowStrip& strip, const Eigen::VectorXd& unknowns) {
  const Eigen::Index n = strip.panels();
  Eigen::Matrix3Xd motion = Eigen::Matrix3Xd::Zero(3, 2 * n);
  for (Eigen::Index k = 0; k < n; ++k) {
    // of the panel, before the held place
    const double part = k + 1 < n || !is_held_in_a_panel(strip) ? 1 : 0.5;
    const Eigen::Vector2d along = part * strip.spacing() * direction(unknowns[k]);
    motion.col(k).tail(2) = unknowns[n + k] * Eigen::Vector2d(-along.y(), along.x());
    motion.col(n + k).tail(2) = along;
  }
  motion(0, n - 1) = 1;
  return motion;
}

/// How far the last panel is from where it is held: slope [rad], place [m].
Eigen::Vector3d miss_of_end(const RowStrip& strip, const Eigen::VectorXd& unknowns) {
  const Eigen::Index n = strip.panels();
  const Eigen::Matrix2Xd rows =
      strip.rows(unknowns.head(n), strip.spacing() * unknowns.segment(n, n));
  const Eigen::Vector2d held = is_held_in_a_panel(strip)
                                   ? Eigen::Vector2d((rows.col(n) + rows.col(n + 1)) / 2)
                                   : rows.col(n + 1);
  Eigen::Vector3d miss;
  miss << unknowns[n - 1] - strip.hold().last->slope,
      held - rows.col(1) / 2 - strip.hold().last->place;
  return miss;
}

/// The residual, which vanishes at rest: generalised forces, those that hold the last panel
/// included, and that panel's misses. The unknowns are slopes, strains, and what holds the end.
Eigen::VectorXd imbalance(const RowStrip& strip, const Eigen::VectorXd& unknowns) {
  if (!strip.hold().last) return generalised_forces(strip, unknowns);
  const Eigen::Index n = 2 * strip.panels(), held = unknowns.size() - n;
  const HeldNumbers numbers = held_numbers(strip);
  Eigen::VectorXd all(n + held);
  all << generalised_forces(strip, unknowns.head(n)) +
             motion_of_end(strip, unknowns)(numbers.pushed, Eigen::all).transpose() *
                 unknowns.tail(held),
      miss_of_end(strip, unknowns)(numbers.prescribed);
  return all;
}

Eigen::MatrixXd jacobian(const RowStrip& strip, const Eigen::VectorXd& unknowns) {
  constexpr double change = 1e-6;  // rad and strain
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(unknowns.size(), unknowns.size());
  const Eigen::Index n = 2 * strip.panels();
  for (Eigen::Index k = 0; k < n; ++k) {
    Eigen::VectorXd ahead = unknowns, behind = unknowns;
    ahead[k] += change;
    behind[k] -= change;
    matrix.col(k) = (imbalance(strip, ahead) - imbalance(strip, behind)) / (2 * change);
  }
  const Eigen::Index held = unknowns.size() - n;
  if (held > 0)
    matrix.topRightCorner(n, held) =
        motion_of_end(strip, unknowns)(held_numbers(strip).pushed, Eigen::all).transpose();
  return matrix;
}

}  // namespace

const std::vector<StripPattern>& strip_patterns() {
  static const std::vector<StripPattern> patterns = {
      {"equilateral", SheetPattern::equilateral, 1, std::numbers::sqrt3 / 2},
      {"squares, one diagonal", SheetPattern::one_diagonal, 0, 1},
      {"squares, rows of alternating diagonal", SheetPattern::alternating, 0, 1},
      {"squares, union jack", SheetPattern::union_jack, 0, 1}};
  return patterns;
}

RowStrip::RowStrip(const Subject& subject, const StripPattern& pattern, int panels,
                   const StripLoad& load, const StripHold& hold)
    : pattern_(pattern),
      panels_(panels),
      hold_(hold),
      spacing_(strip_length / (is_held_in_a_panel(*this) ? panels : panels + 0.5)),
      width_(cells_across * spacing_ / pattern.spacing_over_edge),
      load_(load),
      scene_(strip_scene(pattern, panels, spacing_, load)),
      probe_(subject, scene_) {
  for (Eigen::Index i = 0; i < scene_.x.cols(); ++i)
    row_of_.push_back(int(std::lround(scene_.mesh.rest(pattern.along, i) / spacing_)));
}

Eigen::Matrix2Xd RowStrip::rows(const Eigen::VectorXd& slopes,
                                const Eigen::VectorXd& lengths) const {
  Eigen::Matrix2Xd places = Eigen::Matrix2Xd::Zero(2, panels_ + 2);
  places.col(1) = spacing_ * direction(hold_.slope);
  for (int k = 0; k < panels_; ++k)
    places.col(k + 2) = places.col(k + 1) + lengths[k] * direction(slopes[k]);
  return places;
}

Eigen::Matrix2Xd RowStrip::forces(const Eigen::Matrix2Xd& rows) const {
  PerParticle3 x = scene_.mesh.rest;
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    x(pattern_.along, i) = rows(0, row_of_[size_t(i)]);
    x(2, i) = rows(1, row_of_[size_t(i)]);
  }
  const PerParticle3 force = probe_.elastic(resting_state(std::move(x)));
  Eigen::Matrix2Xd sums = Eigen::Matrix2Xd::Zero(2, rows.cols());
  for (Eigen::Index i = 0; i < force.cols(); ++i)
    sums.col(row_of_[size_t(i)]) += Eigen::Vector2d(force(pattern_.along, i), force(2, i));
  sums(1, sums.cols() - 1) -= load_.tip * width_;
  return sums;
}

StripAtRest level(const RowStrip& strip) {
  StripAtRest flat;
  flat.slopes = Eigen::VectorXd::Constant(strip.panels(), strip.hold().slope);
  flat.lengths = Eigen::VectorXd::Constant(strip.panels(), strip.spacing());
  return flat;
}

StripAtRest at_rest(const RowStrip& strip, StripAtRest start) {
  constexpr int most_steps = 40;
  constexpr double longest = 0.3;  // of one step [rad]: keeps the chain from folding on its way
  const Eigen::Index n = strip.panels();
  Eigen::VectorXd unknowns =
      Eigen::VectorXd::Zero(2 * n + Eigen::Index(held_numbers(strip).pushed.size()));
  unknowns.head(2 * n) << start.slopes, start.lengths / strip.spacing();
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < most_steps; ++i) {
    const Eigen::VectorXd step =
        oracles::solve_linear(jacobian(strip, unknowns), -imbalance(strip, unknowns));
    Worst largest;
    for (const double change : step.head(2 * n)) largest.observe(std::abs(change));
    const double size = largest.value();
    unknowns += (size > longest ? longest / size : 1.0) * step;
    start.last_step = size;
    if (!(size > 1e-7) && !(size < 0.5 * before)) break;  // NaN ends it too
    before = size;
  }
  start.slopes = unknowns.head(n);
  start.lengths = strip.spacing() * unknowns.segment(n, n);
  const Eigen::Matrix2Xd places = strip.rows(start.slopes, start.lengths);
  start.reach = places(0, n + 1) - places(0, 1) / 2;
  start.drop = places(1, 1) / 2 - places(1, n + 1);
  Worst strain;
  for (Eigen::Index k = 0; k < n; ++k) strain.observe(std::abs(unknowns[n + k] - 1));
  start.strain = strain.value();
  if (!strip.hold().last) return start;
  if (strip.hold().last->hold == RowHold::propped)
    start.hold_force.y() = unknowns[2 * n];
  else
    start.hold_force = unknowns.tail(2);
  return start;
}

}  // namespace foldproof
