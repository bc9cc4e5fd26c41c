// Contact with a fixed plane: resting, and Coulomb's friction.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "verification/subjects/suite/laws.h"
#include "verification/subjects/suite/scenes.h"

namespace foldproof {

namespace {

using namespace suite;

constexpr long steps = 50;
constexpr double weight = 9.81;  // m/s^2
constexpr double degree = pi / 180;

/// A sheet at rest that lies on the plane z = 0. Gravity is tilted instead of the plane.
PortableScene lying_sheet(double slope, double friction) {
  PortableScene scene = sheet_at_rest();
  scene.name = "sheet on a plane";
  scene.gravity = weight * Vector3(std::sin(slope), 0, -std::cos(slope));
  scene.planes = {{Vector3::Zero(), Vector3::UnitZ(), friction}};
  return scene;
}

Finding rests_on_the_plane(Trial& trial) {
  trial.require("planes");
  const PortableScene scene = lying_sheet(0, 0.3);
  const double edge = rest_lengths(scene.mesh).mean();
  Table measured{{"steps", "1"},
                 {"deepest", "m"},
                 {"highest", "m"},
                 {"largest distance over what is allowed", "1"}};
  for (const long count : {steps, 2 * steps}) {
    const Eigen::RowVectorXd z = trial.after(scene, count).x.row(2);
    const double deepest = std::max(0.0, -z.minCoeff()), highest = std::max(0.0, z.maxCoeff());
    measured.row(count, deepest, highest,
                 std::max(deepest / (0.01 * edge), highest / (0.1 * edge)));
  }
  return judge_worst(measured, 1,
                     "empirical: a depth of a hundredth of an edge cannot be seen in a picture; "
                     "above the plane, a tenth of an edge is allowed for a thickness");
}

Finding resting_sheet_is_still(Trial& trial) {
  trial.require("planes");
  const PortableScene scene = lying_sheet(0, 0.3);
  std::vector<Snapshot> last = trial.motion(scene, {steps, steps + 1, steps + 2, steps + 3});
  Table measured{{"step", "1"}, {"largest displacement in it", "g dt^2"}};
  for (size_t k = 1; k < last.size(); ++k)
    measured.row(steps + long(k), (last[k].x - last[k - 1].x).colwise().norm().maxCoeff() /
                                      (weight * scene.dt * scene.dt));
  const double rounding = rounding_error(scene, 1, trial.declaration()) * size_of(scene.x) /
                          (weight * scene.dt * scene.dt);
  return judge_worst(
      measured, 1 + rounding,
      "gravity moves a particle by g dt^2 in the step before contact stops it; more is jitter");
}

/// From a height, half as long again as it takes to fall.
Finding fall_gains_no_energy(Trial& trial) {
  trial.require("planes");
  constexpr double height = 0.2;  // m
  PortableScene scene = lying_sheet(0, 0.3);
  scene.planes[0].point.z() -= height;
  const long count = std::lround(1.5 * std::sqrt(2 * height / weight) / scene.dt);
  std::vector<long> at(static_cast<size_t>(count));
  std::iota(at.begin(), at.end(), 1);
  Worst worst;
  for (const Snapshot& now : trial.motion(scene, at)) {
    const double kinetic = (now.v.colwise().squaredNorm() * scene.mass)[0] / 2;
    worst.observe(kinetic - scene.gravity.dot((now.x - scene.x) * scene.mass));
  }
  Table measured{{"steps", "1"}, {"gained energy", "m g times the fall"}};
  measured.row(count, worst.value() / (scene.mass.sum() * weight * height));
  return judge_worst(measured, 0.02,
                     "a plane at rest does no work; a first order method errs by half a step of "
                     "the fall, g t dt/2 in height, 1 %, and by as much where the fall ends");
}

/// What a slope does to a sheet in a time: it sticks where tan(slope) <= mu, else it slides with g
/// (sin - mu cos).
struct Slope {
  double degrees, friction;

  double acceleration() const {
    const double down = std::sin(degrees * degree) - friction * std::cos(degrees * degree);
    return std::max(0.0, weight * down);
  }
};

/// Coulomb on ten pairs; none is within a fifth of the limit of sticking.
Finding slides_as_coulomb_says(Trial& trial) {
  trial.require("planes");
  Table measured{{"slope", "degrees"},
                 {"mu", "1"},
                 {"distance down", "m"},
                 {"by Coulomb's law", "m"},
                 {"difference", "frictionless distance"}};
  for (const Slope& slope : {Slope{10, 0.3},
                             {15, 0.5},
                             {20, 0.6},
                             {30, 0.9},
                             {35, 1.1},
                             {10, 0.05},
                             {20, 0.1},
                             {25, 0.3},
                             {30, 0.2},
                             {40, 0.5}}) {
    const PortableScene scene = lying_sheet(slope.degrees * degree, slope.friction);
    const double time = steps * scene.dt;
    const PerParticle3 moved = trial.after(scene, steps).x - scene.x;
    const double way = moved.row(0).mean(), expected = slope.acceleration() * time * time / 2;
    const double without = weight * std::sin(slope.degrees * degree) * time * time / 2;
    measured.row(slope.degrees, slope.friction, way, expected, std::abs(way - expected) / without);
  }
  return judge_worst(measured, 0.05,
                     "a first order method errs by 2 %, the step in which contact begins by as "
                     "much, and the sheet's own waves by 1 %");
}

constexpr long long_steps = 200;
constexpr double share_of_way = 0.02;

/// Whether the sheet goes more than that share of the way that it would go without friction.
bool slips(Trial& trial, double slope, double friction) {
  const PortableScene scene = lying_sheet(std::atan(slope), friction);
  const double time = double(long_steps) * scene.dt;
  const double without = weight * std::sin(std::atan(slope)) * time * time / 2;
  const PerParticle3 moved = trial.after(scene, long_steps).x - scene.x;
  return !(moved.row(0).mean() <= share_of_way * without);
}

/// The slope at which it begins to slip, by bisection; one end of the bracket if it is outside. By
/// Coulomb's law it goes the share 1 - mu/slope of the way without friction.
Finding slips_at_coulomb_s_slope(Trial& trial) {
  trial.require("planes");
  Table measured{
      {"mu", "1"}, {"slope that slips", "1"}, {"by Coulomb's law", "1"}, {"difference", "mu"}};
  for (const double friction : {0.23, 0.61}) {
    double rests = 0.7 * friction, moves = 1.3 * friction;
    while (moves - rests > 0.01 * friction) {
      const double middle = (rests + moves) / 2;
      (slips(trial, middle, friction) ? moves : rests) = middle;
    }
    const double found = (rests + moves) / 2, expected = friction / (1 - share_of_way);
    measured.row(friction, found, expected, std::abs(found - expected) / friction);
  }
  return judge_worst(
      measured, 0.03,
      "as shares of the frictionless way: the step in which contact begins, 1 %; 200 steps of a "
      "first order method, 0.5 %; the sheet's own waves, 1 %; half of the last bracket, 0.5 %");
}

}  // namespace

std::vector<Law> contact_laws() {
  return {
      {"contact.sheet-rests-on-a-plane", "A sheet on a plane neither sinks in nor lifts off.",
       "impenetrability", rests_on_the_plane},
      {"contact.resting-sheet-is-still", "A sheet at rest on a plane does not jitter.",
       "equilibrium", resting_sheet_is_still},
      {"contact.fall-gains-no-energy", "A sheet that falls on a plane gains no energy from it.",
       "energy", fall_gains_no_energy},
      {"contact.slides-as-coulomb-says",
       "On a slope, a sheet sticks or slides as Coulomb's law says.", "Coulomb",
       slides_as_coulomb_says},
      {"contact.slips-at-coulomb-s-slope",
       "A sheet begins to slip where the slope is the coefficient of friction, and does not creep "
       "before.",
       "Coulomb", slips_at_coulomb_s_slope},
  };
}

}  // namespace foldproof
