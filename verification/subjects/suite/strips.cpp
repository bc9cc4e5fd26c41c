#include "verification/subjects/suite/strips.h"

#include <fmt/format.h>

#include <cmath>

#include "reference/mesh/shapes.h"

namespace foldproof::suite {

double StripShape::row_height() const { return edge * std::sqrt(3.0) / 2; }

double StripShape::length() const { return rows * row_height(); }

double StripShape::width() const { return columns * edge; }

PortableScene free_strip(const StripShape& shape) {
  PortableScene scene;
  scene.mesh = make_sheet({.pattern = SheetPattern::equilateral,
                           .width = shape.width(),
                           .columns = shape.columns,
                           .rows = shape.rows});
  scene.mesh.rest.row(1).array() -= shape.length() / 2;
  scene.x = scene.mesh.rest;
  scene.v = PerParticle3::Zero(3, scene.x.cols());
  scene.mass = lumped_masses(scene.mesh, scene.material.density);
  return scene;
}

std::vector<int> rows_at_distance(const PortableScene& strip, const StripShape& shape,
                                  double distance) {
  std::vector<int> found;
  for (int i = 0; i < int(strip.x.cols()); ++i)
    if (std::abs(std::abs(strip.mesh.rest(1, i)) - distance) < shape.row_height() / 4)
      found.push_back(i);
  return found;
}

double measured_rigidity(Trial& trial, const PortableScene& strip, const StripShape& shape) {
  constexpr double curvature = 0.5;  // 1/m
  constexpr long steps = 6;
  double moment = 0;  // N, per width
  for (const double sign : {1.0, -1.0}) {
    PortableScene scene = strip;
    const double by = sign * curvature;
    for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
      const double turn = by * scene.mesh.rest(1, i);
      scene.x(1, i) = std::sin(turn) / by;
      scene.x(2, i) = (1 - std::cos(turn)) / by;
    }
    const PerParticle3 v = trial.after(scene, steps).v;
    double momentum = 0;
    for (Eigen::Index i = 0; i < v.cols(); ++i)
      if (scene.mesh.rest(1, i) > shape.row_height() / 4)
        momentum += scene.mass[i] * (scene.x(2, i) * v(1, i) - scene.x(1, i) * v(2, i));
    moment += sign * momentum / (2 * double(steps) * scene.dt * shape.width());
  }
  return moment / curvature;
}

double measured_twisting(Trial& trial, const PortableScene& strip, const StripShape& shape,
                         double twist) {
  constexpr long steps = 6;
  double torque = 0;  // N m
  for (const double sign : {1.0, -1.0}) {
    PortableScene scene = strip;
    scene.x.row(0).array() -= shape.width() / 2;
    for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
      const double turn = sign * twist * scene.x(1, i), across = scene.x(0, i);
      scene.x(0, i) = across * std::cos(turn);
      scene.x(2, i) = across * std::sin(turn);
    }
    const PerParticle3 v = trial.after(scene, steps).v;
    double momentum = 0;
    for (Eigen::Index i = 0; i < v.cols(); ++i)
      if (scene.mesh.rest(1, i) > shape.row_height() / 4)
        momentum += scene.mass[i] * (scene.x(0, i) * v(2, i) - scene.x(2, i) * v(0, i));
    torque -= sign * momentum / (2 * double(steps) * scene.dt);
  }
  return torque / twist / shape.width();
}

void require_resistance(std::string_view to_what, double measured, double given) {
  constexpr double least_rigidity = 1e-2;  // of the scene's
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
