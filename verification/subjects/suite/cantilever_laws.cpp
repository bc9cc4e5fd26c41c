// A heavy strip, far bent by its own weight, against the elastica.
#include <algorithm>
#include <cmath>

#include "reference/mesh/shapes.h"
#include "verification/oracles/heavy_cantilever.h"
#include "verification/subjects/suite/laws.h"
#include "verification/subjects/suite/scenes.h"

namespace foldproof {

namespace {

using namespace suite;

//   end row      middle row     end row
//  .-.-.-.-.-.-.-.-o-.-.-.-.-.-.-.-.    -> y     A strip hangs over its middle row, which is held.
//                                                By symmetry each half is clamped level there.
constexpr int columns = 3, rows = 16;
constexpr double edge = 0.04;    // m
constexpr double weight = 9.81;  // m/s^2
constexpr double gamma = 10;     // rho g L^3/B of the scene [1]: the tip hangs 0.65 L low

// A wide strip has the plate's rigidity B. A narrow one, whose sides curl the other way, has the
// beam's, B (1 - nu^2), with Poisson's ratio nu at most 1/2. This one is between them.
constexpr double poisson = 0.5;  // [1]

const double row_height = edge * std::sqrt(3.0) / 2;
const double half_length = rows / 2 * row_height;

PortableScene strip() {
  PortableScene scene;
  scene.mesh = make_sheet({.pattern = SheetPattern::equilateral,
                           .width = columns * edge,
                           .columns = columns,
                           .rows = rows});
  scene.mesh.rest.row(1).array() -= half_length;
  scene.name = "heavy strip";
  scene.x = scene.mesh.rest;
  scene.v = PerParticle3::Zero(3, scene.x.cols());
  scene.material.young = 200;
  scene.material.bending_rigidity =
      scene.material.density * weight * std::pow(half_length, 3) / gamma;
  scene.mass = lumped_masses(scene.mesh, scene.material.density);
  scene.dt = 2e-4;
  return scene;
}

/// Particles of the rows at this distance from the middle row [m].
std::vector<int> at_distance(const PortableScene& scene, double distance) {
  std::vector<int> found;
  for (int i = 0; i < int(scene.x.cols()); ++i)
    if (std::abs(std::abs(scene.mesh.rest(1, i)) - distance) < row_height / 4) found.push_back(i);
  return found;
}

/// B as the law calibration.bending-rigidity-is-the-scene-s measures it, of this very mesh [N m]:
/// let go from a cylinder, half of the strip gains angular momentum by the moment in its middle.
double measured_rigidity(Trial& trial) {
  constexpr double curvature = 0.5;  // 1/m
  constexpr long steps = 6;          // 1.2 ms: bending comes sqrt(t sqrt(B/rho)) = 0.02 m far
  double moment = 0;                 // N, per width
  for (const double sign : {1.0, -1.0}) {
    PortableScene scene = strip();
    const double by = sign * curvature;
    for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
      const double turn = by * scene.mesh.rest(1, i);
      scene.x(1, i) = std::sin(turn) / by;
      scene.x(2, i) = (1 - std::cos(turn)) / by;
    }
    const PerParticle3 v = trial.after(scene, steps).v;
    double momentum = 0;
    for (Eigen::Index i = 0; i < v.cols(); ++i)
      if (scene.mesh.rest(1, i) > row_height / 4)
        momentum += scene.mass[i] * (scene.x(2, i) * v(1, i) - scene.x(1, i) * v(2, i));
    moment += sign * momentum / (2 * double(steps) * scene.dt * columns * edge);
  }
  return moment / curvature;
}

double kinetic_energy(const PortableScene& scene, const PerParticle3& v) {
  return (v.colwise().squaredNorm() * scene.mass)[0] / 2;
}

/// From rest to the next peak of the kinetic energy.
PerParticle3 until_fastest(Trial& trial, const PortableScene& scene) {
  constexpr long chunk = 20, most_chunks = 400;  // 1.6 s
  trial.prepare(scene);
  Snapshot last{scene.x, scene.v};
  for (long k = 0; k < most_chunks; ++k) {
    Snapshot next = trial.solver().advance(scene.dt, chunk);
    if (kinetic_energy(scene, next.v) < kinetic_energy(scene, last.v)) break;
    last = std::move(next);
  }
  return last.x;
}

struct Relaxed {
  PerParticle3 x;
  double last_move;  // largest, in the last two rounds [m]
};

/// Equilibrium by kinetic damping: the motion is stopped whenever its kinetic energy is largest,
/// until two rounds move it by less than 1e-4 of the length, or 24 times.
Relaxed relaxed(Trial& trial, PortableScene scene) {
  constexpr int most_rounds = 24;
  std::vector<PerParticle3> stops{scene.x, scene.x};
  double moved = nan;
  for (int k = 0; k < most_rounds && !(moved < 1e-4 * half_length); ++k) {
    scene.x = until_fastest(trial, scene);
    moved = (scene.x - stops[stops.size() - 2]).colwise().norm().maxCoeff();
    stops.push_back(scene.x);
  }
  return {scene.x, moved};
}

Finding hangs_as_the_elastica(Trial& trial) {
  trial.require_level(1);
  trial.require("held");
  const double rigidity = measured_rigidity(trial);
  PortableScene scene = strip();
  scene.gravity = Vector3(0, 0, -weight);
  scene.held = at_distance(scene, 0);
  const Relaxed end = relaxed(trial, scene);
  const double of_plate = scene.material.density * weight * std::pow(half_length, 3) / rigidity;
  const oracles::CantileverTip plate = oracles::heavy_cantilever(of_plate),
                               beam = oracles::heavy_cantilever(of_plate / (1 - poisson * poisson));
  double drop = 0, reach = 0;
  const std::vector<int> ends = at_distance(scene, half_length);
  for (const int i : ends) {
    drop -= end.x(2, i) / half_length / double(ends.size());
    reach += std::abs(end.x(1, i)) / half_length / double(ends.size());
  }
  Table measured{{"of the tip", ""},      {"measured rigidity", "N m"}, {"measured", "L"},
                 {"as a plate", "L"},     {"as a beam", "L"},           {"last move", "L"},
                 {"outside of both", "L"}};
  const double moved = end.last_move / half_length;
  const auto row = [&](const char* of, double value, double first, double second) {
    const auto [least, most] = std::minmax(first, second);
    measured.row(of, rigidity, value, first, second, moved,
                 std::max({0.0, least - value, value - most}) + moved);
  };
  row("drop", drop, plate.drop.value, beam.drop.value);
  row("reach", reach, plate.reach.value, beam.reach.value);
  return judge_worst(measured, 0.03,
                     "eight folds instead of a curve: (1/8)^2 of the drop, 1.6 %; the rigidity is "
                     "measured to 2 %, which moves the tip by 1 %; it stretches by 0.3 %");
}

}  // namespace

std::vector<Law> cantilever_laws() {
  return {
      {"cantilever.heavy-strip-hangs-as-the-elastica",
       "A strip that hangs from its middle row takes the elastica's shape for its own rigidity.",
       "heavy elastica", hangs_as_the_elastica},
  };
}

}  // namespace foldproof
