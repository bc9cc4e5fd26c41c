// One hinge: two triangles of any shape, size and angle turn about their edge as the scene says.

#include "verification/subjects/suite/laws.h"

namespace foldproof {

namespace {

using namespace suite;

constexpr long steps = 4;

/// Two triangles on an edge of 0.1 m, of these heights, skewed, folded by an angle about it.
//
//           x1
//    x3 ---------- x4     heights of x1, x2 over the edge
//          x2
PortableScene kite(double first, double second, double angle) {
  constexpr double edge = 0.1;  // m
  PerParticle3 rest(3, 4);
  rest << 0.3 * edge, 0.6 * edge, 0, edge, first, -second, 0, 0, 0, 0, 0, 0;
  PortableScene scene =
      resting("kite", make_triangle_mesh(rest, {{0, 2, 3}, {1, 3, 2}}), {.young = 1});
  scene.x.col(0) = Vector3(rest(0, 0), first * std::cos(angle), first * std::sin(angle));
  scene.dt = 5e-4;
  return scene;
}

/// How fast both opposite corners turn about the edge after the steps, by their momenta [m/s].
Eigen::Array2d turning(Trial& trial, const PortableScene& scene, double angle) {
  const PerParticle3 v =
      momentum_velocities(scene, trial.after(scene, steps).v - scene.v, trial.declaration());
  const Vector3 up(0, -std::sin(angle), std::cos(angle));
  return {-v.col(0).dot(up), -v(2, 1)};
}

/// The moment 2 B w angle turns each corner by its lever.
Finding kites_have_their_weight(Trial& trial) {
  Table measured = table_of(
      "heights [edge] | weight [1] | slower corner [of what is due] | faster one [of what is due] "
      "| difference [of what is due]");
  constexpr double angle = 0.12, omega = 20;  // rad, 1/s
  for (const auto& [first, second] : {std::pair(0.0866, 0.0866),
                                      {0.03, drawn("a high triangle", 0.1, 0.14)},
                                      {0.1, 0.02},
                                      {drawn("a slender triangle", 0.008, 0.012), 0.01}}) {
    PortableScene scene = kite(first, second, angle);
    const double weight = 0.1 / (first + second);  // edge^2 over four times the mean area
    const double lever = std::min(first, second);
    scene.material.bending_rigidity =
        omega * omega * scene.mass.minCoeff() * lever * lever / (2 * weight);
    const double impulse = 2 * scene.material.bending_rigidity * weight * angle * steps * scene.dt;
    const Eigen::Array2d due(impulse / (first * scene.mass[0]), impulse / (second * scene.mass[1]));
    const Eigen::Array2d part = turning(trial, scene, angle) / due;
    measured.row(fmt::format("{:.2g}, {:.2g}", first / 0.1, second / 0.1), weight, part.minCoeff(),
                 part.maxCoeff(), (part - 1).abs().maxCoeff());
  }
  return judge_worst(measured, 0.1,
                     "(omega t)^2 is 0.002; sines and tangents of the angle differ from it by "
                     "0.005; rounding of single precision is less");
}

/// The weight is that of the rest shape, however large the triangles are now. Hinges whose energy
/// is quadratic in positions (Bergou et al. 2006) have a moment that grows as the size squared.
Finding squeezed_kites_have_their_weight(Trial& trial) {
  Table measured = table_of(
      "present size [of that at rest] | slower corner [of what is due] | faster one [of what is "
      "due] | beyond both kinds of hinges [1]");
  constexpr double angle = 0.12, height = 0.0866;  // rad, m
  for (const double size : {drawn("a squeezed hinge", 0.45, 0.55), 0.75, 1.4}) {
    PortableScene scene = kite(height, height, angle);
    scene.name = "kite that is squeezed or stretched";
    scene.material.young = 0.1;
    scene.x *= size;
    const double lever = size * height, weight = 0.1 / (2 * height);
    scene.material.bending_rigidity = 400 * scene.mass.minCoeff() * lever * lever / (2 * weight);
    const double due = 2 * scene.material.bending_rigidity * weight * angle * steps * scene.dt /
                       (lever * scene.mass[0]);
    const Eigen::Array2d part = turning(trial, scene, angle) / due;
    measured.row(size, part.minCoeff(), part.maxCoeff(),
                 std::max(std::min(1.0, size * size) / std::max(part.minCoeff(), 1e-3),
                          part.maxCoeff() / std::max(1.0, size * size)));
  }
  return judge_worst(measured, 1.25,
                     "as of hinges of all shapes; sides that spring back change the levers by some "
                     "per cent");
}

/// Hinge dampers at several angles: the motion with dampers, less the motion without.
Finding folded_kites_are_damped(Trial& trial) {
  Table measured = table_of(
      "angle [degrees] | slower corner [of what is due] | faster one [of what is due] | difference "
      "[of what is due]");
  const double height = 0.18, rate = 3;  // m, rad/s; other edges are nearly twice as long
  for (const double angle : {0.3, 1.1, drawn("a damped fold", 1.8, 2.0), 2.6}) {
    PortableScene free = kite(height, height, angle);
    free.name = "kite that is damped";
    free.material.bending_rigidity = 1e-6;  // solvers without hinges decline it
    free.v.col(0) = rate * height * Vector3(0, -std::sin(angle), std::cos(angle));
    PortableScene damped = free;
    const double lever = 0.1 / height;  // of an edge's length
    damped.material.bending_damping =
        0.02 * free.mass[0] * height / lever / (double(steps) * free.dt);
    const double due = damped.material.bending_damping * lever * rate * double(steps) * free.dt;
    const Eigen::Array2d part = (turning(trial, damped, angle) - turning(trial, free, angle)) /
                                (due / Eigen::Array2d(free.mass[0], free.mass[1]));
    measured.row(angle * 180 / pi, part.minCoeff(), part.maxCoeff(), (part - 1).abs().maxCoeff());
  }
  return judge_worst(measured, 0.1,
                     "the dampers take a fiftieth of the rate; a first order method errs by half "
                     "of it");
}

}  // namespace

std::vector<Law> kite_laws() {
  return {
      {"bending.hinges-of-all-shapes-have-their-weights",
       "Equal, unequal and slender triangles turn about their hinge as its weight says.",
       "protocol: 'hinge_weights'", kites_have_their_weight, "bending",
       "heights | slower corner | faster one"},
      {"bending.squeezed-hinges-resist",
       "Hinges of triangles that are squeezed or stretched have the moment of their weight at "
       "rest.",
       "protocol: 'hinge_weights'", squeezed_kites_have_their_weight, "bending",
       "present size | slower corner | faster one"},
      {"damping.folded-hinges-are-damped", "Hinges are damped alike at all angles.",
       "protocol: 'bending_damping'", folded_kites_are_damped, "damping bending",
       "angle | slower corner | faster one"},
  };
}

}  // namespace foldproof
