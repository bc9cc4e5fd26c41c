// Friction in motion: inclines at rest and moving, a belt, a turntable, a strip round a drum, a
// sleeve on a shaft.
#include "reference/dynamics/simulate.h"
#include "reference/mesh/shapes.h"
#include "verification/oracles/dense_algebra.h"
#include "verification/specimens/check.h"
#include "verification/specimens/contact_scenes.h"
#include "verification/specimens/stepper.h"

namespace foldproof {

namespace {

constexpr double g = 9.80665;   // m/s^2
constexpr double h = 1. / 240;  // s

/// Particles at rest on a slope of the given angle [rad] that moves with a constant velocity.
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

/// Distance that the particles have slid, relative to the slope, and their largest distance from it
/// [m].
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

/// tan(angle) slightly below and above mu: at rest, and sliding by (sin - mu cos) g t^2/2.
Finding slope_finding(const Subject& subject, const std::string& integrator,
                      const Vector3& velocity) {
  Table ways("friction [1]; slope [degrees]; slid [m]; expected [m]");
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
          ways};
}

Finding resting_slope(const Subject& subject, const std::string& integrator) {
  return slope_finding(subject, integrator, Vector3::Zero());
}

Finding moving_slope(const Subject& subject, const std::string& integrator) {
  return slope_finding(subject, integrator, {1.3, 0.4, -0.9});
}

/// Laid on a belt that runs at U: it slides for U/(mu g), covers half of the belt's way, and then
/// is carried.
Finding belt_finding(const Subject& subject, const std::string& integrator) {
  const double mu = 0.37, speed = 0.9;
  const Vector3 belt(speed, 0, 0);
  Slope flat = slope(0, mu, belt);
  flat.scene.v.setZero();
  Stepper stepper(subject, flat.scene, integrator);
  State s = stepper.start();
  const double x0 = s.x(0, 0), sliding = speed / (mu * g);  // m, s
  Worst worst;
  Table places("time [s]; way [m]; exact [m]");
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
          places};
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

constexpr double drum_radius = 0.1, straight = 0.08, width = 0.016;  // m
constexpr double strained = 1.02;  // the strip's length at the start over its rest length
constexpr double speed = 0.04;     // speed at which one end is pulled [m/s]

/// The point of the strip's middle line at arc length s [m] along a straight piece, the drum and a
/// straight piece.
Vector3 on_path(double s, double wrap) {
  const auto on_drum = [](double a) {
    return Vector3(0, drum_radius * std::cos(a), drum_radius * std::sin(a));
  };
  const auto along = [](double a) { return Vector3(0, -std::sin(a), std::cos(a)); };
  if (s < straight) return on_drum(0) + (s - straight) * along(0);
  if (s < straight + drum_radius * wrap) return on_drum((s - straight) / drum_radius);
  return on_drum(wrap) + (s - straight - drum_radius * wrap) * along(wrap);
}

Scene wrapped_strip(double wrap, double friction) {
  const double length = 2 * straight + drum_radius * wrap;
  const int rows = int(std::lround(length / width));
  Scene scene = scene_at_rest(
      make_sheet({SheetPattern::criss_cross, width, length / strained, 1, rows}), 0.2);
  scene.stretch = StretchMaterial{60, 0.1, 1};
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    const double across = scene.x(0, i) - width / 2, s = scene.x(1, i) * strained;
    scene.x.col(i) = on_path(s, wrap) + Vector3(across, 0, 0);
    Motion motion;
    motion.velocity = speed * Vector3(0, -std::sin(wrap), std::cos(wrap));
    if (s < 1e-9) scene.prescribed.push_back({int(i), scene.x.col(i), {}});
    if (s > length - 1e-9) scene.prescribed.push_back({int(i), scene.x.col(i), motion});
  }
  SceneObject drum =
      object_at("drum", Capsule{drum_radius, 1},
                {oracles::rotation_between(Vector3::UnitZ(), Vector3::UnitX()), Vector3::Zero()});
  drum.object.friction = friction;
  scene.objects.push_back(drum);
  return scene;
}

/// Tension at the held and at the pulled end [N], and the wrap angle between them [rad].
struct Pull {
  double held = 0, drawn = 0, turn = 0;
};

Pull pull_after(const Subject& subject, const Scene& scene, double seconds) {
  Stepper stepper(subject, scene, "C");
  State s = stepper.start();
  const double h = 0.4 * elastic_limit(build_system(scene), s);
  while (s.time < seconds) s = stepper.step(s, h);
  const PerParticle3 force = stepper.elastic_forces(s);
  Vector3 held = Vector3::Zero(), drawn = Vector3::Zero();
  for (const PrescribedParticle& end : scene.prescribed)
    (end.motion.velocity.norm() > 0 ? drawn : held) += force.col(end.particle);
  return {held.norm(), drawn.norm(), std::acos(-held.dot(drawn) / (held.norm() * drawn.norm()))};
}

Finding capstan_finding(const Subject& subject) {
  Table pulls("friction [1]; turn [rad]; ratio of tensions [1]; e^(mu turn) [1]");
  Worst worst;
  for (const auto& [mu, wrap] :
       {std::pair{0.17, 2.9}, std::pair{0.43, 1.3}, std::pair{0.34, 2.2}}) {
    const Pull pull = pull_after(subject, wrapped_strip(wrap, mu), 0.5);
    const double ratio = pull.drawn / pull.held;
    pulls.row(mu, pull.turn, ratio, std::exp(mu * pull.turn));
    worst.observe(std::abs(std::log(ratio) / (mu * pull.turn) - 1));
  }
  return {{worst.value(), 0.02, 0, "of the exponent",
           "the strip turns by 0.08 rad at a row, where (1 + mu tan(d/2))/(1 - mu tan(d/2)) "
           "differs from e^(mu d) by d^2/12 of the exponent, 0.0005; inertia of the sliding strip, "
           "rho v^2 over its tension, is smaller; two percent allow for vibrations that damping "
           "has not yet removed"},
          pulls};
}

/// A tight sleeve at rest on a shaft of radius R: without friction until its length has settled.
Scene sleeve_on_shaft(const Subject& subject, double R) {
  Scene scene = scene_at_rest(make_cylinder(R / 1.03, 0.1, 40, 6), 0.3);
  scene.stretch = StretchMaterial{400, 2, 1};
  scene.x.row(0) *= 1.03;
  scene.x.row(2) *= 1.03;
  scene.objects.push_back(
      object_at("shaft", Capsule{R, 1},
                {oracles::rotation_between(Vector3::UnitZ(), Vector3::UnitY()), Vector3::Zero()}));
  Stepper stepper(subject, scene, "C");
  scene.x = stepper.run(stepper.start(), 5e-4, 2000).x;
  scene.stretch->damping = 0.1;
  return scene;
}

/// The shaft turns at Omega. With N the force that presses the sleeve on it at rest, friction turns
/// the sleeve by m R omega' = mu (N - m R omega^2): omega = a tanh(mu a t), a^2 = N/(m R), until it
/// is carried from atanh(Omega/a)/(mu a) on.
Finding sleeve_finding(const Subject& subject) {
  const double R = 0.05, mu = 0.23;
  Scene scene = sleeve_on_shaft(subject, R);
  const System system = build_system(scene);
  Stepper at_rest(subject, scene, "C");
  const auto pressing = [&](const State& s) {
    const PerParticle3 force = at_rest.elastic_forces(s);
    return -(force.row(0).dot(s.x.row(0)) + force.row(2).dot(s.x.row(2))) / R;
  };
  const double N = pressing(at_rest.start());
  const double a = std::sqrt(N / (system.mass.sum() * R)), Omega = 0.6 * a,
               carried = std::atanh(0.6) / (mu * a);
  Motion turning;
  turning.angular_velocity = {0, Omega, 0};
  scene.objects[0] = with_motion(scene.objects[0], turning, mu);
  Stepper stepper(subject, scene, "C");
  State s = stepper.start();
  Table speeds("time [1]; N [1]; omega [rad/s]; closed form [rad/s]; error [1]");
  for (const double time : {0.25, 0.5, 0.75, 1.5, 2.5}) {
    while (s.time < time * carried) s = stepper.step(s, carried / 1000);
    const double omega = angular_momentum(system, s).y() / (system.mass.sum() * R * R),
                 exact = time < 1 ? a * std::tanh(mu * a * s.time) : Omega;
    speeds.row(time, pressing(s) / N, omega, exact, std::abs(omega - exact) / Omega);
  }
  return judge_worst(speeds, "error", 0.016,
                     "rows that turn at different speeds shear the sleeve, which then presses by "
                     "up to 1.6 % less than at rest (column N)");
}

}  // namespace

std::vector<Check> friction_checks() {
  std::vector<Check> list;
  add_for_each_scheme(
      list,
      {{"contact.a-block-on-a-slope-sticks-or-slides",
        "a block on a slope of angle alpha stays in its place, to rounding, if tan(alpha) <= mu, "
        "and slides by g (sin(alpha) - mu cos(alpha)) t^2/2 otherwise.",
        "mechanics", resting_slope},
       {"contact.a-block-on-a-moving-slope-sticks-or-slides",
        "the same on a slope that moves at a constant velocity.", "mechanics", moving_slope},
       {"contact.a-belt-carries-cloth-along",
        "laid on a running belt, a block slides for U/(mu g) and is carried from then on.",
        "mechanics", belt_finding},
       {"contact.a-turntable-carries-without-drift",
        "a point that sticks to a turning object keeps its place on it.", "mechanics",
        turntable_finding}});
  list.push_back(
      {"contact.a-drum-obeys-the-capstan-equation",
       "In a strip that slides over a drum, round which it is wrapped by an angle, the pulled "
       "side has e^(mu angle) times the tension of the other.",
       "Euler and Eytelwein", capstan_finding});
  list.push_back({"contact.a-turning-shaft-carries-a-sleeve",
                  "A tight sleeve on a turning shaft is turned as fast as Coulomb's law says, and "
                  "then carried.",
                  "mechanics", sleeve_finding});
  return list;
}

}  // namespace foldproof
