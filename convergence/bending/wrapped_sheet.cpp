#include "convergence/bending/bending_rigidity.h"
#include "verification/specimens/probe.h"
#include "verification/specimens/specimens.h"

#include <cmath>
#include <numbers>

namespace foldproof {

namespace {

// height of an equilateral triangle over its edge
const double row_ratio = std::numbers::sqrt3 / 2;

bool one_kind(double, double) { return false; }
bool odd_row(double, double row) { return std::lround(row) % 2 != 0; }
bool odd_square(double column, double row) {
  return (std::lround(column) + std::lround(row)) % 2 != 0;
}
bool between_columns(double column, double) { return std::abs(column - std::round(column)) > 0.25; }

oracles::PeriodicMesh one_diagonal_cell() { return oracles::split_rectangles({}); }
oracles::PeriodicMesh rectangle_cell() {
  return oracles::split_rectangles({1, 0.25, 1, 1, nullptr});
}
oracles::PeriodicMesh alternating_cell() {
  return oracles::split_rectangles({1, 1, 1, 2, [](int, int j) { return j % 2 == 0; }});
}
oracles::PeriodicMesh union_jack_cell() {
  return oracles::split_rectangles({1, 1, 2, 2, [](int i, int j) { return (i + j) % 2 == 0; }});
}
oracles::PeriodicMesh criss_cross_cell() { return oracles::crossed_squares(1); }
oracles::PeriodicMesh equilateral_cell() { return oracles::equilateral_triangles(1); }

}  // namespace

const std::vector<RegularPattern>& regular_patterns() {
  static const double diagonal = std::numbers::sqrt2;
  static const std::vector<RegularPattern> patterns = {
      {"equilateral", "equilateral", SheetPattern::equilateral, 0, 1, equilateral_cell, one_kind},
      {"one-diagonal", "squares, one diagonal", SheetPattern::one_diagonal, 1, diagonal,
       one_diagonal_cell, one_kind},
      {"alternating", "squares, rows of alternating diagonal", SheetPattern::alternating, 1,
       diagonal, alternating_cell, odd_row},
      {"union-jack", "squares, union jack", SheetPattern::union_jack, 1, diagonal, union_jack_cell,
       odd_square},
      {"criss-cross", "squares, criss-cross", SheetPattern::criss_cross, 1, 1, criss_cross_cell,
       between_columns},
      {"rectangles", "4:1 rectangles, one diagonal", SheetPattern::one_diagonal, 0.25,
       std::sqrt(17.0) / 4, rectangle_cell, one_kind}};
  return patterns;
}

FourSheets::FourSheets(const Subject& subject, const RegularPattern& pattern, int n, double width,
                       double ke)
    : pattern_(pattern), width_(width) {
  height_ = width * (pattern.cell_height > 0 ? pattern.cell_height : row_ratio);
  area_ = n * width_ * n * height_;
  for (const int columns : {n, 2 * n}) {
    for (const int rows : {n, 2 * n}) {
      Scene scene = scene_at_rest(
          make_sheet({pattern.pattern, columns * width_, rows * height_, columns, rows}), 0.17);
      scene.bending = BendingMaterial{ke, 0, Weighting::rest, DampingFactor::edge, "sine"};
      scene.rest_angles.assign(scene.mesh.hinges.size(), 0);
      specimens_.push_back({scene.mesh.rest, Probe(subject, scene), columns == rows ? 1.0 : -1.0});
    }
  }
}

double FourSheets::energy_per_area(const std::function<Vector3(const Vector3&, bool)>& bend) const {
  double sum = 0;
  for (const Specimen& specimen : specimens_) {
    PerParticle3 x(3, specimen.rest.cols());
    for (Eigen::Index i = 0; i < x.cols(); ++i) {
      const Vector3 rest = specimen.rest.col(i);
      x.col(i) = bend(rest, pattern_.second_site(rest.x() / width_, rest.y() / height_));
    }
    sum += specimen.sign * specimen.probe.energy(resting_state(std::move(x)));
  }
  return sum / area_;
}

double FourSheets::energy_per_area(const Wrap& wrap) const {
  return energy_per_area(
      [&wrap](const Vector3& rest, bool second) { return wrap_position(wrap, rest, second); });
}

Vector3 wrap_position(const Wrap& wrap, const Vector3& rest, bool second) {
  const Vector3 along(std::cos(wrap.direction), std::sin(wrap.direction), 0),
      across(-along.y(), along.x(), 0);
  const double turn = wrap.curvature * along.dot(rest), half = std::sin(turn / 2);
  const double offset = second ? wrap.offset : 0, radius = 1 / wrap.curvature + offset;
  const double rise = offset * std::cos(turn) - 2 * half * half / wrap.curvature;
  return radius * std::sin(turn) * along + across.dot(rest) * across + rise * Vector3::UnitZ();
}

double forced_rigidity_of(const FourSheets& sheets, Wrap wrap, double ke) {
  wrap.offset = 0;
  return 2 * sheets.energy_per_area(wrap) / (ke * wrap.curvature * wrap.curvature);
}

double relaxed_rigidity_of(const FourSheets& sheets, Wrap wrap, double ke) {
  const double reach = wrap.offset;
  const auto rigidity = [&](double offset) {
    wrap.offset = offset;
    return 2 * sheets.energy_per_area(wrap) / (ke * wrap.curvature * wrap.curvature);
  };
  const double inner = rigidity(-reach), middle = rigidity(0), outer = rigidity(reach);
  const double slope = (outer - inner) / 2, bend = outer - 2 * middle + inner;
  return bend > 0 ? middle - slope * slope / (2 * bend) : middle;  // all alike: nothing to relax
}

Eigen::Matrix3d measured_tensor(const FourSheets& sheets, double curvature, double ke) {
  const auto energy = [&](const Eigen::Vector3d& k) {
    return sheets.energy_per_area([&k](const Vector3& rest, bool) {
      const double x = rest.x(), y = rest.y();
      return Vector3(x, y, 0.5 * (k[0] * x * x + k[1] * y * y + k[2] * x * y));
    });
  };
  Eigen::Matrix3d R;
  for (int i = 0; i < 3; ++i) R(i, i) = energy(curvature * Eigen::Vector3d::Unit(i));
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < i; ++j) {
      const Eigen::Vector3d both = Eigen::Vector3d::Unit(i) + Eigen::Vector3d::Unit(j);
      R(i, j) = R(j, i) = (energy(curvature * both) - R(i, i) - R(j, j)) / 2;
    }
  }
  return 2 / (ke * curvature * curvature) * R;
}

double whole_sheet_rigidity(const Subject& subject, const RegularPattern& pattern, int n,
                            double ke) {
  Scene scene = scene_at_rest(make_sheet({pattern.pattern, whole_side, whole_side, n, n}), 0.17);
  scene.bending = BendingMaterial{ke, 0, Weighting::rest, DampingFactor::edge, "sine"};
  scene.rest_angles.assign(scene.mesh.hinges.size(), 0);
  const Wrap wrap{0, 0.3, 0};
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i)
    scene.x.col(i) = wrap_position(wrap, scene.mesh.rest.col(i), false);
  const double energy = Probe(subject, scene).energy(resting_state(scene.x));
  return 2 * energy / (ke * std::pow(whole_side * wrap.curvature, 2));
}

}  // namespace foldproof
