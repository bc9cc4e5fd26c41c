// Contact with a fixed plane, oblique to all axes: resting, and Coulomb's friction.
#include <utility>

#include "verification/subjects/suite/laws.h"

namespace foldproof {

namespace {

using namespace suite;

constexpr long steps = 50;
constexpr double degree = pi / 180;

Finding rests_on_the_plane(Trial& trial) {
  const PortableScene scene = sheet_on_a_plane({0, 0}, 0.3);
  const double edge = rest_lengths(scene.mesh).mean();
  Table measured =
      table_of("steps [1] | deepest [m] | highest [m] | largest distance over what is allowed [1]");
  const std::vector<long> counts = multiples(2, steps);
  const std::vector<Snapshot> states = trial.motion(scene, counts);
  for (size_t k = 0; k < states.size(); ++k) {
    const Eigen::RowVectorXd z = seen_from_the_plane(states[k].x).row(2);
    const double deepest = std::max(0.0, -z.minCoeff()), highest = std::max(0.0, z.maxCoeff());
    measured.row(counts[k], deepest, highest,
                 std::max(deepest / (0.01 * edge), highest / (0.1 * edge)));
  }
  return judge_worst(measured, 1,
                     "empirical: a depth of a hundredth of an edge cannot be seen in a picture; "
                     "above the plane, a tenth of an edge is allowed for a thickness");
}

Finding resting_sheet_is_still(Trial& trial) {
  const PortableScene scene = sheet_on_a_plane({0, 0}, 0.3);
  std::vector<Snapshot> last = trial.motion(scene, {steps, steps + 1, steps + 2, steps + 3});
  Table measured{{"step", "1"}, {"largest displacement in it", "g dt^2"}};
  for (size_t k = 1; k < last.size(); ++k)
    measured.row(steps + long(k),
                 largest(last[k].x - last[k - 1].x) / (weight * scene.dt * scene.dt));
  const double rounding = rounding_error(scene, 1, trial.declaration()) * largest(scene.x) /
                          (weight * scene.dt * scene.dt);
  return judge_worst(
      measured, 1 + narrow(rounding, trial.declaration()),
      "gravity moves a particle by g dt^2 in the step before contact stops it; more is jitter");
}

/// Velocities that are stated at rest: after the response to contact, not before it.
Finding resting_sheet_states_no_velocity(Trial& trial) {
  const PortableScene scene = sheet_on_a_plane({0, 0}, 0.3);
  Table measured{{"step", "1"}, {"largest velocity stated", "g dt"}};
  for (const long count : {steps, steps + 1})
    measured.row(count, largest(trial.after(scene, count).v) / (weight * scene.dt));
  return judge_worst(measured, 0.25,
                     "a step without contact ends with g dt, and half a step with g dt/2: a "
                     "velocity that is stated before contact has stopped it");
}

/// What a slope does to a sheet in a time: it sticks where tan(slope) <= mu, else it slides with g
/// (sin - mu cos), straight down.
struct Slope {
  double degrees, friction;
  double heading;  // of the way down, in the plane [degrees]

  PortableScene sheet() const {
    return sheet_on_a_plane({degrees * degree, heading * degree}, friction);
  }
  double acceleration() const {
    const double down = std::sin(degrees * degree) - friction * std::cos(degrees * degree);
    return std::max(0.0, weight * down);
  }
  double frictionless_way(double time) const {
    return weight * std::sin(degrees * degree) * time * time / 2;
  }
  Vector3 way_down() const {  // as seen from the plane
    return {std::cos(heading * degree), std::sin(heading * degree), 0};
  }
};

/// The mean displacement in so many steps, as seen from the plane; not off it [m].
Vector3 mean_way(Trial& trial, const PortableScene& scene, long count) {
  const Vector3 end = seen_from_the_plane(trial.after(scene, count).x).rowwise().mean();
  const Vector3 way = end - seen_from_the_plane(scene.x).rowwise().mean();
  return {way.x(), way.y(), 0};
}

/// Coulomb on ten pairs, in ten directions; none is within a fifth of the limit of sticking.
Finding slides_as_coulomb_says(Trial& trial) {
  Table measured = table_of(
      "slope [degrees] | mu [1] | way down [degrees] | distance down [m] | distance sideways [m] | "
      "by Coulomb's law [m] | difference [of the frictionless distance]");
  for (const Slope& slope : {Slope{10, 0.3, 20},
                             {15, 0.5, 57},
                             {20, 0.6, 94},
                             {30, 0.9, 131},
                             {35, 1.1, 168},
                             {10, 0.05, 205},
                             {20, 0.1, 242},
                             {25, 0.3, 279},
                             {30, 0.2, 316},
                             {40, 0.5, 353}}) {
    const PortableScene scene = slope.sheet();
    const double time = steps * scene.dt, expected = slope.acceleration() * time * time / 2;
    const Vector3 way = mean_way(trial, scene, steps);
    const double down = way.dot(slope.way_down());
    measured.row(slope.degrees, slope.friction, slope.heading, down,
                 (way - down * slope.way_down()).norm(), expected,
                 (way - expected * slope.way_down()).norm() / slope.frictionless_way(time));
  }
  return judge_worst(measured, 0.05,
                     "a first order method errs by 2 %, the step in which contact begins by as "
                     "much, and the sheet's own waves by 1 %");
}

constexpr long long_steps = 200;
constexpr double share_of_way = 0.02;

/// Whether the sheet goes more than that share of the way that it would go without friction.
bool slips(Trial& trial, const Slope& slope) {
  const PortableScene scene = slope.sheet();
  const double time = double(long_steps) * scene.dt;
  return !(mean_way(trial, scene, long_steps).norm() <=
           share_of_way * slope.frictionless_way(time));
}

/// The slope at which it begins to slip, by bisection; one end of the search if it is outside. By
/// Coulomb's law it goes the share 1 - mu/slope of the way without friction.
Finding slips_at_coulomb_s_slope(Trial& trial) {
  Table measured = table_of(
      "mu [1] | way down [degrees] | slope that slips | by Coulomb's law [1] | "
      "difference [of mu]");
  for (const auto& [friction, heading] : {std::pair(0.23, 25.0), {0.61, 70.0}}) {
    const auto moves = [&, mu = friction, way = heading](double slope) {
      return slips(trial, {std::atan(slope) / degree, mu, way});
    };
    const Interval tried{0.7 * friction, 1.3 * friction},
        found = bisected(tried, 0.01 * friction, moves);
    const double expected = friction / (1 - share_of_way);
    measured.row(friction, heading, found_text(found, tried), expected,
                 std::abs(middle(found) - expected) / friction);
  }
  return judge_worst(
      measured, 0.03,
      "as shares of the frictionless way: the step in which contact begins, 1 %; 200 steps of a "
      "first order method, 0.5 %; the sheet's own waves, 1 %; half of the last bracket, 0.5 %");
}

/// Rattled in the plane on which it lies, without friction; the rattle is over before the slightest
/// height matters.
Finding springs_and_dampers_act_in_contact(Trial& trial) {
  constexpr long count = 10;
  PortableScene scene = sheet_on_a_plane({0, 0}, 0);
  scene.name = "sheet that is rattled on a plane";
  const bool is_damped = trial.declaration().offers("damping");
  const double tau = is_damped ? 1.5e-3 : 0;  // s
  scene.material.stretch_damping = tau * scene.material.young;
  scene.dt = 1e-4;
  const Vector3 normal = scene.planes[0].normal, one = normal.unitOrthogonal();
  for (Eigen::Index i = 0; i < scene.v.cols(); ++i)
    scene.v.col(i) = 0.3 * (std::sin(2.7 * double(i)) * one +
                            std::sin(1.9 * double(i) + 0.4) * normal.cross(one));
  PortableScene free = scene;
  free.planes.clear();
  free.gravity.setZero();
  const PerParticle3 alone = trial.after(free, count).v, there = trial.after(scene, count).v;
  const PerParticle3 across = normal * (normal.transpose() * (there - alone));
  const double falls = largest(across) / (weight * double(count) * scene.dt);
  if (!(falls < 0.5))
    throw FailedWithoutNumber("the sheet falls through the plane", "a sheet that lies on it");
  Table measured = table_of(
      "forces | change of velocities without the plane [m/s] | on the plane [m/s] | difference [of "
      "the change]");
  measured.row(is_damped ? "springs and dampers" : "springs", (alone - scene.v).norm(),
               (there - scene.v - across).norm(),
               (there - alone - across).norm() / (alone - scene.v).norm());
  return judge_worst(measured, 0.02,
                     "a plane without friction does nothing along itself; depths of g dt^2 turn an "
                     "edge by a millionth; rounding of single precision is less");
}

}  // namespace

std::vector<Law> contact_laws() {
  return {
      {"contact.sheet-rests-on-a-plane", "A sheet on a plane neither sinks in nor lifts off.",
       "impenetrability", rests_on_the_plane, "planes still", "deepest | highest"},
      {"contact.resting-sheet-is-still", "A sheet at rest on a plane does not jitter.",
       "equilibrium", resting_sheet_is_still, "planes still"},
      {"contact.resting-sheet-states-no-velocity",
       "The velocities of a sheet at rest on a plane are zero, not those before contact.",
       "equilibrium", resting_sheet_states_no_velocity, "planes still"},
      {"contact.springs-and-dampers-act-in-contact",
       "On a plane without friction springs and dampers act as they do elsewhere.",
       "superposition of forces", springs_and_dampers_act_in_contact, "planes",
       "forces | on the plane"},
      {"contact.slides-as-coulomb-says",
       "On slopes that face all ways, a sheet sticks, or slides straight down, as Coulomb's law "
       "says.",
       "Coulomb", slides_as_coulomb_says, "planes",
       "slope | mu | distance down | by Coulomb's law"},
      {"contact.slips-at-coulomb-s-slope",
       "A sheet begins to slip where the slope is the coefficient of friction, and does not creep "
       "before.",
       "Coulomb", slips_at_coulomb_s_slope, "planes", "mu | slope that slips | by Coulomb's law"},
  };
}

}  // namespace foldproof
