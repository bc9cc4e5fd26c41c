#include "verification/subjects/suite/strips.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "reference/mesh/shapes.h"

namespace foldproof::suite {

double StripShape::row_height() const { return edge * std::sqrt(3.0) / 2; }

double StripShape::length() const { return rows * row_height(); }

double StripShape::width() const { return columns * edge; }

PortableScene free_strip(const StripShape& shape, const PortableMaterial& material, double dt) {
  TriangleMesh mesh = make_sheet({.pattern = SheetPattern::equilateral,
                                  .width = shape.width(),
                                  .columns = shape.columns,
                                  .rows = shape.rows});
  mesh.rest.row(1).array() -= shape.length() / 2;
  PortableScene scene = resting("strip", std::move(mesh), material);
  scene.dt = dt;
  return scene;
}

std::vector<int> rows_of(const PortableScene& strip, const StripShape& shape) {
  std::vector<int> rows;
  for (Eigen::Index i = 0; i < strip.x.cols(); ++i)
    rows.push_back(
        int(std::lround((strip.mesh.rest(1, i) + shape.length() / 2) / shape.row_height())));
  return rows;
}

Eigen::Matrix2Xd mean_rows(const PortableScene& strip, const StripShape& shape,
                           const PerParticle3& x) {
  const std::vector<int> row = rows_of(strip, shape);
  Eigen::Matrix2Xd sum = Eigen::Matrix2Xd::Zero(2, shape.rows + 1);
  Eigen::RowVectorXd count = Eigen::RowVectorXd::Zero(shape.rows + 1);
  for (size_t i = 0; i < row.size(); ++i) {
    sum.col(row[i]) += x.col(Eigen::Index(i)).tail<2>();
    ++count[row[i]];
  }
  return sum.array().rowwise() / count.array();
}

PortableScene clamped_strip(const PortableScene& strip, const StripShape& shape,
                            const Eigen::Matrix2Xd& rows, double gravity) {
  PortableScene scene = strip;
  scene.gravity = Vector3(0, 0, -gravity);
  const std::vector<int> row_of = rows_of(scene, shape);
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    const int row = row_of[size_t(i)];
    scene.x.col(i) << scene.mesh.rest(0, i), rows.col(row);
    if (row < 2 || row > shape.rows - 2) scene.held.push_back(int(i));
  }
  return scene;
}

double squared_turns(const Eigen::Matrix2Xd& rows) {
  double sum = 0;
  for (Eigen::Index k = 1; k + 1 < rows.cols(); ++k) {
    const Eigen::Vector2d before = rows.col(k) - rows.col(k - 1),
                          after = rows.col(k + 1) - rows.col(k);
    const double cosine = before.normalized().dot(after.normalized());
    sum += std::pow(std::acos(std::clamp(cosine, -1.0, 1.0)), 2);
  }
  return sum;
}

std::vector<int> rows_at_distance(const PortableScene& strip, const StripShape& shape,
                                  double distance) {
  std::vector<int> found;
  for (int i = 0; i < int(strip.x.cols()); ++i)
    if (std::abs(std::abs(strip.mesh.rest(1, i)) - distance) < shape.row_height() / 4)
      found.push_back(i);
  return found;
}

double gravity_of(double gamma, double rigidity, const PortableScene& strip, double length) {
  return gamma * rigidity / (strip.material.density * std::pow(length, 3));
}

std::array<double, 2> possible_weights(double rounding) {
  const double off = 0.02 + rounding;
  return {1 / (1 + off), 1 / ((1 - off) * (1 - largest_poisson * largest_poisson))};
}

double slowest_vibration(double rigidity, const PortableScene& strip, double length) {
  return 3.516 * std::sqrt(rigidity / strip.material.density) / (length * length);
}

void bend(PortableScene& sheet, int axis, double curvature) {
  for (Eigen::Index i = 0; i < sheet.x.cols(); ++i) {
    const double turn = curvature * sheet.mesh.rest(axis, i);
    sheet.x(axis, i) = std::sin(turn) / curvature;
    sheet.x(2, i) = (1 - std::cos(turn)) / curvature;
  }
}

double angular_momentum(const PortableScene& sheet, const PerParticle3& v, int axis, double from,
                        const Vector3& away) {
  double sum = 0;
  for (Eigen::Index i = 0; i < v.cols(); ++i) {
    const Vector3 arm = sheet.x.col(i) - away;
    if (sheet.mesh.rest(axis, i) > from)
      sum += sheet.mass[i] * (arm.z() * v(axis, i) - arm[axis] * v(2, i));
  }
  return sum;
}

namespace {

/// Of a strip that lies elsewhere [m].
double rigidity_at(Trial& trial, const PortableScene& strip, const StripShape& shape,
                   const Vector3& away) {
  constexpr double curvature = 0.5;  // 1/m
  constexpr long steps = 6;
  double moment = 0;  // N, per width
  for (const double sign : {1.0, -1.0}) {
    PortableScene scene = strip;
    bend(scene, 1, sign * curvature);
    scene.x.colwise() += away;
    const PerParticle3 v =
        momentum_velocities(scene, trial.after(scene, steps).v, trial.declaration());
    const double momentum = angular_momentum(scene, v, 1, shape.row_height() / 4, away);
    moment += sign * momentum / (2 * double(steps) * scene.dt * shape.width());
  }
  return moment / curvature;
}

double twisting_at(Trial& trial, const PortableScene& strip, const StripShape& shape, double twist,
                   const Vector3& away) {
  constexpr long steps = 6;
  double torque = 0;  // N m
  for (const double sign : {1.0, -1.0}) {
    PortableScene scene = strip;
    for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
      const double turn = sign * twist * scene.x(1, i), across = scene.x(0, i) - shape.width() / 2;
      scene.x(0, i) = across * std::cos(turn);
      scene.x(2, i) = across * std::sin(turn);
    }
    scene.x.colwise() += away;
    const PerParticle3 v =
        momentum_velocities(scene, trial.after(scene, steps).v, trial.declaration());
    double momentum = 0;
    for (Eigen::Index i = 0; i < v.cols(); ++i)
      if (scene.mesh.rest(1, i) > shape.row_height() / 4)
        momentum -= scene.mass[i] * (scene.x.col(i) - away).cross(v.col(i)).y();
    torque -= sign * momentum / (2 * double(steps) * scene.dt);
  }
  return torque / twist / shape.width();
}

}  // namespace

double beyond_rounding(Trial& trial, const char* of, double most,
                       const std::function<double(const Vector3& away)>& measured) {
  double least = measured(Vector3::Zero());
  if (!trial.declaration().is_single) return least;
  double largest = least, sum = least;
  // no farther than sheets are wide and waves are high: as many digits are left
  const Vector3 places[] = {{0.1, 0.1, 0.003}, {-0.07, 0.03, -0.002}, {0.02, -0.09, 0.001}};
  for (const Vector3& place : places) {
    const double there = measured(place);
    least = std::min(least, there), largest = std::max(largest, there), sum += there;
  }
  const double mean = sum / (1 + std::size(places));
  if (!(largest - least <= 2 * most * std::abs(mean)))
    throw NotOffered{fmt::format(
        "digits enough: where it lies decides whether {} is {:.3g} or {:.3g}", of, least, largest)};
  return mean;
}

double measured_rigidity(Trial& trial, const PortableScene& strip, const StripShape& shape,
                         double most) {
  return beyond_rounding(trial, "a strip's rigidity [N m]", most, [&](const Vector3& away) {
    return rigidity_at(trial, strip, shape, away);
  });
}

double measured_twisting(Trial& trial, const PortableScene& strip, const StripShape& shape,
                         double twist) {
  return beyond_rounding(
      trial, "a strip's rigidity to twisting [N m]", 0.02,
      [&](const Vector3& away) { return twisting_at(trial, strip, shape, twist, away); });
}

void require_resistance(std::string_view to_what, double measured, double given) {
  if (measured > least_rigidity * given) return;
  throw FailedWithoutNumber(
      fmt::format("the strip does not resist {}: {:.2g} N m are measured, the scene has {:.2g} N m",
                  to_what, measured, given),
      fmt::format("at least {:.0f} % of the scene's rigidity; a limper strip takes too long to "
                  "come to rest, or to fall",
                  100 * least_rigidity));
}

std::string Bracket::stands_text() const {
  return stands > 0 ? fmt::format("{:.4g} m/s^2", stands) : "none that is tried";
}

std::string Bracket::falls_text() const {
  return has_fallen ? fmt::format("{:.4g} m/s^2", falls) : fmt::format("> {:.4g} m/s^2", falls);
}

Bracket bracketed(double expected, const std::function<bool(double)>& falls) {
  Bracket bracket{0.5 * expected, 1.5 * expected};
  if (falls(bracket.stands)) return {0, bracket.stands};
  if (!falls(bracket.falls)) return {bracket.falls, bracket.falls, false};
  while (bracket.falls - bracket.stands > 0.02 * expected) {
    const double middle = (bracket.stands + bracket.falls) / 2;
    (falls(middle) ? bracket.falls : bracket.stands) = middle;
  }
  return bracket;
}

}  // namespace foldproof::suite
