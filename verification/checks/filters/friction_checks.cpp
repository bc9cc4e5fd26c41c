// Friction in motion: inclines at rest and moving, a belt, a turntable.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "reference/mesh/shapes.h"
#include "verification/checks/filters/filter_checks.h"
#include "verification/evidence.h"
#include "verification/oracles/dense_algebra.h"
#include "verification/specimens/contact_scenes.h"
#include "verification/specimens/paper_schemes.h"
#include "verification/specimens/stepper.h"

namespace foldproof {

namespace {

constexpr double g = 9.80665;   // m/s^2
constexpr double h = 1. / 240;  // s

/// Particles at rest on a slope of the angle al [rad] that moves along with a constant velocity.
struct Slope {
  Scene scene;
  Vector3 normal, down;  // out of the slope, along it
};

Slope slope(double angle, double friction, const Vector3& velocity) {
  Slope result{loose_particles(3),
               {0, std::cos(angle), std::sin(angle)},
               {0, -std::sin(angle), std::cos(angle)}};
  SceneObject part =
      object_at("slope", HalfSpace{},
                {oracles::rotation_between(Vector3::UnitZ(), result.normal), Vector3::Zero()});
  part.object.friction = friction;
  std::get<Motion>(std::get<RigidObject>(part.object.body).motion).velocity = velocity;
  Scene& scene = result.scene;
  scene.objects.push_back(part);
  scene.gravity = Vector3(0, -g, 0);
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    scene.x.col(i) -= scene.x.col(i).dot(result.normal) * result.normal;
    scene.v.col(i) = velocity;
  }
  return result;
}

/// How far the particles have slid on the slope, seen from it [m], and how far from it they
/// are at worst [m].
struct Slid {
  double distance, off;
};

Slid slid_on(const Subject& subject, const Slope& on, const Vector3& velocity,
             const std::string& integrator, int steps) {
  Stepper stepper(subject, on.scene, integrator);
  const State start = stepper.start();
  const State end = stepper.run(start, h, steps);
  Worst off;
  double distance = 0;
  for (Eigen::Index i = 0; i < start.x.cols(); ++i) {
    const Vector3 moved = end.x.col(i) - start.x.col(i) - (end.time - start.time) * velocity;
    off.observe(std::abs(moved.dot(on.normal)));
    distance += moved.dot(on.down) / double(start.x.cols());
  }
  return {distance, off.value()};
}

constexpr int steps = 240;

/// tan(angle) a little below and a little above mu: at rest, and sliding by (sin - mu cos) g t^2/2.
Finding slope_finding(const Subject& subject, const std::string& integrator,
                      const Vector3& velocity) {
  Table ways{{"friction", "1"}, {"slope", "degrees"}, {"slid", "m"}, {"expected", "m"}};
  Worst worst;
  for (const double mu : {0.23, 0.71})
    for (const double over : {0.5, 0.999, 1.001, 1.4, 3.0}) {
      const double al = std::atan(over * mu);
      const Slid slid = slid_on(subject, slope(al, mu, velocity), velocity, integrator, steps);
      const double time = h * steps;
      const double acceleration = std::max(0.0, g * (std::sin(al) - mu * std::cos(al)));
      const double expected = acceleration * time * time / 2;
      ways.row(mu, al * 180 / pi, slid.distance, expected);
      worst.observe(std::abs(slid.distance - expected));
      worst.observe(slid.off);
    }
  return {{worst.value(), 4000 * epsilon * (1 + velocity.norm()), 0, "m",
           "240 steps of a motion that the schemes integrate exactly, of lengths up to 5 m: a few "
           "roundings a step, and the velocity's add up over later steps"},
          ways,
          ""};
}

Finding resting_slope(const Subject& subject, const std::string& integrator) {
  return slope_finding(subject, integrator, Vector3::Zero());
}

Finding moving_slope(const Subject& subject, const std::string& integrator) {
  return slope_finding(subject, integrator, {1.3, 0.4, -0.9});
}

/// Laid on a belt that runs at U: it slides for U/(mu g), gains half of the way, and
/// then is carried.
Finding belt_finding(const Subject& subject, const std::string& integrator) {
  const double mu = 0.37, speed = 0.9;
  const Vector3 belt(speed, 0, 0);
  Slope flat = slope(0, mu, belt);
  flat.scene.v.setZero();
  Stepper stepper(subject, flat.scene, integrator);
  State s = stepper.start();
  const double x0 = s.x(0, 0), sliding = speed / (mu * g);  // m, s
  Worst worst;
  Table places{{"time", "s"}, {"way", "m"}, {"exact", "m"}};
  for (int n = 1; n <= 120; ++n) {
    s = stepper.step(s, h);
    const double t = s.time;
    const double exact = t < sliding ? mu * g * t * t / 2 : speed * (t - sliding / 2);
    worst.observe(std::abs(s.x(0, 0) - x0 - exact));
    if (n % 10 == 0) places.row(t, s.x(0, 0) - x0, exact);
  }
  return {{worst.value(), mu * g * h * h, 0, "m",
           "exact while it slides; when the belt starts to carry it, friction may act a step too "
           "long or too short, at most mu g h^2"},
          places,
          ""};
}

/// A turntable at omega: particles within mu g/omega^2 of its axis ride.
Finding turntable_finding(const Subject& subject, const std::string& integrator) {
  const double mu = 0.9, omega = 3.1, coarse = 1. / 60;
  Slope table = slope(0, mu, Vector3::Zero());
  auto& motion = std::get<Motion>(std::get<RigidObject>(table.scene.objects[0].object.body).motion);
  motion.angular_velocity = {0, omega, 0};
  Scene& scene = table.scene;
  scene.x.row(0).array() -= 0.3;
  scene.x.row(2).setLinSpaced(-0.2, 0.3);
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i)
    scene.v.col(i) = motion.angular_velocity.cross(Vector3(scene.x.col(i)));
  Stepper stepper(subject, scene, integrator);
  const State start = stepper.start();
  const State end = stepper.run(start, coarse, 1200);
  Table drifts{{"radius", "m"}, {"off its place", "m"}};
  for (Eigen::Index i = 0; i < start.x.cols(); ++i) {
    const Vector3 turned = rotate(start.x.col(i), motion.angular_velocity * end.time);
    drifts.row(Vector3(start.x.col(i)).norm(), (end.x.col(i) - turned).norm());
  }
  return judge_worst(drifts, 20000 * epsilon,
                     "1200 steps of 0.05 rad, each rounding positions of 0.7 m a few times; moving "
                     "along the tangent would carry a particle outwards by a factor of sqrt(1 + "
                     "(omega h)^2) a step, in these 20 s from 0.5 m to 2.5 m");
}

}  // namespace

std::vector<Check> friction_checks() {
  std::vector<Check> list;
  add_for_each_scheme(
      list,
      {"contact.a-block-on-a-slope-sticks-or-slides",
       "a block on a slope of angle alpha stays in its place, to rounding, if tan(alpha) <= mu, "
       "and slides by g (sin(alpha) - mu cos(alpha)) t^2/2 otherwise.",
       "mechanics",
       {}},
      resting_slope);
  add_for_each_scheme(list,
                      {"contact.a-block-on-a-moving-slope-sticks-or-slides",
                       "the same on a slope that moves at a constant velocity.",
                       "mechanics",
                       {}},
                      moving_slope);
  add_for_each_scheme(
      list,
      {"contact.a-belt-carries-cloth-along",
       "laid on a running belt, a block slides for U/(mu g) and is carried from then on.",
       "mechanics",
       {}},
      belt_finding);
  add_for_each_scheme(list,
                      {"contact.a-turntable-carries-without-drift",
                       "a point that sticks to a turning object keeps its place on it.",
                       "mechanics",
                       {}},
                      turntable_finding);
  return list;
}

}  // namespace foldproof
