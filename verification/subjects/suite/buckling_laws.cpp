// A strip that stands on its clamped foot: the weight under which it falls over.

#include "verification/oracles/chains_and_ribbons.h"
#include "verification/subjects/suite/laws.h"
#include "verification/subjects/suite/strips.h"

namespace foldproof {

namespace {

using namespace suite;

// The strip starts at rest in the shape in which it falls, a little bent. Under too little weight
// it swings back, under too much it falls; under just so much it stays, whatever the scheme: all
// equilibria are the same in every scheme.
constexpr StripShape shape_of_column{3, 16, 0.04};
constexpr double given = 2e-3;  // B of the scene [N m]
constexpr double tip = 0.02;    // at the start, over L
constexpr double radians = 2;   // of the weightless strip's slowest vibration, that are waited for

// Both of the first rows are held. Where triangles fold at edges, bending begins at half the height
// of the first, elsewhere at the second row.
const double longest = (shape_of_column.rows - 0.5) * shape_of_column.row_height(),
             shortest = (shape_of_column.rows - 1) * shape_of_column.row_height();

PortableScene lying_strip() {
  return free_strip(shape_of_column, {.bending_rigidity = given}, 1e-3);
}

/// Upright, along z, bent towards x as it falls.
PortableScene standing_strip(double gravity) {
  PortableScene scene = lying_strip();
  scene.name = fmt::format("strip on its foot under {:.4g} m/s^2", gravity);
  scene.gravity = Vector3(0, 0, -gravity);
  std::vector<double> aside{0}, up{0};
  for (int row = 0; row < shape_of_column.rows; ++row) {
    const double from_tip =
        (shape_of_column.rows - row - 0.5) * shape_of_column.row_height() / longest;
    const double slope = row == 0 ? 0 : tip * oracles::self_buckling_slope(from_tip);
    aside.push_back(aside.back() + shape_of_column.row_height() * std::sin(slope));
    up.push_back(up.back() + shape_of_column.row_height() * std::cos(slope));
  }
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    const double along = scene.mesh.rest(1, i) + shape_of_column.length() / 2;
    const size_t row = size_t(std::lround(along / shape_of_column.row_height()));
    scene.x.col(i) << aside[row], scene.mesh.rest(0, i), up[row];
    if (row < 2) scene.held.push_back(int(i));
  }
  return scene;
}

double tip_aside(const PortableScene& scene, const PerParticle3& x) {
  double sum = 0;
  int count = 0;
  for (Eigen::Index i = 0; i < x.cols(); ++i)
    if (scene.mesh.rest(1, i) > shape_of_column.length() / 2 - shape_of_column.row_height() / 4)
      sum += x(0, i), ++count;
  return sum / count;
}

/// A strip of a measured rigidity, in steps that its solver can take.
struct Column {
  double rigidity;  // N m
  double dt;        // s
};

/// How far aside the tip is later, over how far at the start [1]; above 1 it falls.
double leaning(Trial& trial, const Column& column, double gravity) {
  PortableScene scene = standing_strip(gravity);
  scene.dt = column.dt;
  const double slowest = slowest_vibration(column.rigidity, scene, longest);
  const long steps = std::lround(radians / slowest / scene.dt);
  return tip_aside(scene, trial.after(scene, steps).x) / tip_aside(scene, scene.x);
}

/// True unless the strip is farther away than it is long, or the solver gives up.
bool is_stable(Trial& trial, const Column& column, double gravity) {
  try {
    return std::abs(leaning(trial, column, gravity)) < 1.2 / tip;
  } catch (const SolverFailure& failure) {
    if (failure.cause != "error" && failure.cause != "nan") throw;
    trial.restart();
    return false;
  }
}

/// Gravity under which a strip of this rigidity and length falls [m/s^2].
double falls_under(double rigidity, double length) {
  return gravity_of(oracles::self_buckling_load_by_series().value, rigidity, lying_strip(), length);
}

/// In steps short enough for the strip to be stable under half of the gravity.
Bracket bracket_of(Trial& trial, Column column) {
  const double expected = falls_under(column.rigidity, longest);
  for (int k = 0; k < 3 && !is_stable(trial, column, 0.5 * expected); ++k) column.dt /= 4;
  return bracketed(expected,
                   [&](double gravity) { return !(leaning(trial, column, gravity) < 1); });
}

Finding falls_at_greenhill_s_load(Trial& trial) {
  const double rigidity = measured_rigidity(trial, lying_strip(), shape_of_column);
  require_resistance("bending", rigidity, given);
  const double most = falls_under(rigidity, shortest),
               least = (1 - largest_poisson * largest_poisson) * falls_under(rigidity, longest);
  const Bracket bracket = bracket_of(trial, {rigidity, lying_strip().dt});
  Table measured = table_of(
      "measured rigidity [N m] | stands under | falls under | as a beam [m/s^2] | "
      "as a plate [m/s^2] | outside of both [1]");
  measured.row(rigidity, bracket.stands_text(), bracket.falls_text(), least, most,
               std::max({0.0, 1 - bracket.falls / least, bracket.stands / most - 1}));
  return judge_worst(measured, 0.03,
                     "the rigidity is measured to 2 %, and so is the load; fifteen folds instead "
                     "of a curve, (1/15)^2, 0.4 %; a tip 2 % aside, 0.1 %");
}

}  // namespace

std::vector<Law> buckling_laws() {
  return {
      {"buckling.upright-strip-falls-at-greenhill-s-load",
       "A strip that stands on a clamped foot falls over under the weight that its own rigidity "
       "says.",
       "Greenhill 1881", falls_at_greenhill_s_load, "L1 held bending",
       "stands under | falls under | as a beam | as a plate"},
  };
}

}  // namespace foldproof
