// A heavy strip, far bent by its own weight, against the elastica.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

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

// A strip of less than this share of the scene's rigidity is as limp as a chain: its gamma is over
// 1e4, and the elastica is computed to 1e5.
constexpr double least_rigidity = 1e-3;  // [1]

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

/// The kinetic energy beyond what the weight has done from the flat start, over m g L [1]: none but
/// the scheme's error, as long as the step is stable.
double gained(const PortableScene& scene, const Snapshot& now) {
  const double work = scene.gravity.dot((now.x - scene.mesh.rest) * scene.mass);
  return (kinetic_energy(scene, now.v) - work) / (scene.mass.sum() * weight * half_length);
}

constexpr double chunk = 4e-3, longest = 1.6;  // s
constexpr double unstable = 0.05;              // m g L gained

/// From rest to the next peak of the kinetic energy; nothing if the step is unstable.
std::optional<PerParticle3> until_fastest(Trial& trial, const PortableScene& scene) {
  trial.prepare(scene);
  Snapshot last{scene.x, scene.v};
  for (double time = 0; time < longest; time += chunk) {
    Snapshot next = trial.solver().advance(scene.dt, std::lround(chunk / scene.dt));
    if (!(gained(scene, next) <= unstable)) return {};
    if (kinetic_energy(scene, next.v) < kinetic_energy(scene, last.v)) break;
    last = std::move(next);
  }
  return last.x;
}

struct Relaxed {
  PerParticle3 x;
  double last_move;  // largest, in the last two rounds [m]
};

/// Equilibrium by kinetic damping: the motion is stopped whenever its kinetic energy is
/// largest, until two rounds move it by less than 1e-4 of the length, or 24 times. Nothing if
/// the step is unstable.
std::optional<Relaxed> relaxed_in_steps(Trial& trial, PortableScene scene) {
  constexpr int most_rounds = 24;
  std::vector<PerParticle3> stops{scene.x, scene.x};
  double moved = nan;
  for (int k = 0; k < most_rounds && !(moved < 1e-4 * half_length); ++k) {
    const std::optional<PerParticle3> stop = until_fastest(trial, scene);
    if (!stop) return {};
    scene.x = *stop;
    moved = (scene.x - stops[stops.size() - 2]).colwise().norm().maxCoeff();
    stops.push_back(scene.x);
  }
  return Relaxed{scene.x, moved};
}

/// The same, in shorter steps where the scheme needs them.
Relaxed relaxed(Trial& trial, PortableScene scene) {
  constexpr int tries = 4;  // the last in steps of 3.1e-6 s
  std::string what = "it gains energy";
  for (int k = 0; k < tries; ++k) {
    if (k > 0) scene.dt /= 4;
    try {
      if (const std::optional<Relaxed> end = relaxed_in_steps(trial, scene)) return *end;
    } catch (const SolverFailure& failure) {
      if (failure.cause != "error" && failure.cause != "nan") throw;
      what = failure.what();
      trial.restart();
    }
  }
  throw SolverFailure(
      "error",
      fmt::format(
          "the strip does not come to rest in steps of {:.2g} s, the shortest that are tried: {}",
          scene.dt, what));
}

Finding hangs_as_the_elastica(Trial& trial) {
  trial.require_level(1);
  trial.require("held");
  const double rigidity = measured_rigidity(trial);
  PortableScene scene = strip();
  scene.gravity = Vector3(0, 0, -weight);
  scene.held = at_distance(scene, 0);
  const Relaxed end = relaxed(trial, scene);
  const bool resists = rigidity > least_rigidity * scene.material.bending_rigidity;
  const double compared = resists ? rigidity : scene.material.bending_rigidity;
  const double of_plate = scene.material.density * weight * std::pow(half_length, 3) / compared;
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
  std::string note;
  if (!resists)
    note = fmt::format(
        "It does not resist bending: {:.2g} N m are measured, the scene has {:.2g} N m; it hangs "
        "limp, {:.2f} of its length low, where a strip of the scene's rigidity hangs {:.2f}",
        rigidity, compared, drop, plate.drop.value);
  return judge_worst(measured, 0.03,
                     "eight folds instead of a curve: (1/8)^2 of the drop, 1.6 %; the rigidity is "
                     "measured to 2 %, which moves the tip by 1 %; it stretches by 0.3 %",
                     note);
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
