// friction-tests: cloth on an incline, and a belt on a turning drum, against Coulomb's law.

#include <Eigen/Geometry>

#include "convergence/validation/comparison.h"
#include "convergence/study.h"
#include "reference/mesh/shapes.h"
#include "verification/specimens/contact_scenes.h"
#include "verification/specimens/stepper.h"

namespace foldproof {

namespace {

constexpr double resolution = 0.02;  // of each number [1]
constexpr double g = 9.80665;        // m/s^2

// ---- an incline

/// A cloth that lies on a plane with friction mu; the plane rises along x by an angle.
Scene cloth_on_incline(double angle, double mu) {
  Scene scene = scene_at_rest(make_sheet({SheetPattern::equilateral, 0.3, 0, 4, 4}), 0.21);
  const Eigen::AngleAxisd tilt(-angle, Vector3::UnitY());
  scene.x = tilt.toRotationMatrix() * scene.mesh.rest;
  scene.stretch = StretchMaterial{37, 0.01, 1};
  scene.gravity = Vector3(0, 0, -g);
  scene.objects.push_back(with_motion(
      object_at("incline", HalfSpace{}, {Eigen::Quaterniond(tilt), Vector3::Zero()}), {}, mu));
  return scene;
}

/// How far down the slope the cloth is after `steps` steps of h [m].
double slid(const Subject& subject, double angle, double mu, double h, int steps) {
  Stepper stepper(subject, cloth_on_incline(angle, mu), "C");
  const State start = stepper.start(), end = stepper.run(start, h, steps);
  const Vector3 down(-std::cos(angle), 0, -std::sin(angle));
  return down.dot((end.x - start.x).rowwise().mean());
}

/// The slope at which it slips, by bisection.
double slipping_slope(const Subject& subject, double mu, double h) {
  constexpr int steps = 30, halvings = 14;
  double holds = 0.5 * mu, slips = 1.5 * mu;
  for (int k = 0; k < halvings; ++k) {
    const double slope = (holds + slips) / 2, free_fall = g * std::pow(h * steps, 2) / 2;
    // a slope above the threshold by a hundred-thousandth moves it further than this
    const bool moves = slid(subject, std::atan(slope), mu, h, steps) > 1e-6 * free_fall;
    (moves ? slips : holds) = slope;
  }
  return (holds + slips) / 2;
}

NamedFinding threshold_agrees(const Subject& subject, double mu) {
  Ladder slopes;
  slopes.floor = mu * 1e-4;  // the last bracket of the bisection
  for (const double h : {2e-3, 1e-3, 5e-4}) slopes.values.push_back(slipping_slope(subject, mu, h));
  const double scale = resolution * mu;
  return {fmt::format("friction-tests.threshold-agrees.mu-{:.2f}", mu),
          fmt::format("A cloth on an incline with friction {} slips where the slope is that "
                      "number, within two percent.",
                      mu),
          judge_comparison(compare_ladder("slope at which it slips", slopes, {mu, 0}), scale,
                           "two percent of the slope",
                           "S by bisection, at the shortest of three steps; D is Coulomb's")};
}

NamedFinding slide_agrees(const Subject& subject, double mu) {
  const double angle = std::atan(1.7 * mu), duration = 0.32;  // s
  Ladder pulls;
  for (const int steps : {160, 320, 640}) {
    const double way = slid(subject, angle, mu, duration / steps, steps);
    pulls.values.push_back(2 * way / (duration * duration * g));
  }
  const double should = std::sin(angle) - mu * std::cos(angle), scale = resolution * should;
  pulls.floor = 1e-9;
  return {fmt::format("friction-tests.slide-agrees.mu-{:.2f}", mu),
          fmt::format("A cloth slides down an incline with friction {} as fast as Coulomb's law "
                      "says, within two percent.",
                      mu),
          judge_comparison(compare_ladder("acceleration over g", pulls, {should, 0}), scale,
                           "two percent of the acceleration",
                           "S from the way after 0.32 s, at the shortest of three steps")};
}

// ---- a belt on a drum

constexpr double radius = 0.09, tail = 0.05;          // m
constexpr double stiffness = 40, belt_density = 0.2;  // N/m, kg/m^2
constexpr double strain = 0.02;                       // of the belt before the drum turns [1]
constexpr double turning = 6;                         // rad/s

struct BeltTest {
  double mu, wrap;  // wrap [rad]
};

/// The place on the belt's way: tail, arc about the drum's top, tail. The drum's axis is y.
Vector3 on_way(double s, double wrap) {
  const double arc = radius * wrap;
  const double angle = std::clamp((s - tail) / radius, 0.0, wrap) - wrap / 2;
  const Vector3 out(std::sin(angle), 0, std::cos(angle)), along(out.z(), 0, -out.x());
  const double beyond = s < tail ? s - tail : std::max(0.0, s - tail - arc);
  return radius * out + beyond * along;
}

/// A belt of `cells` cells along, two across; its end rows are held, and a drum slides under it.
Scene belt(const BeltTest& test, int cells) {
  const double way = radius * test.wrap + 2 * tail, rest = way / (1 + strain), cell = rest / cells;
  Scene scene = scene_at_rest(make_sheet({SheetPattern::alternating, rest, 2 * cell, cells, 2}),
                              belt_density);
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    const double y = scene.x(1, i);
    scene.x.col(i) = on_way(scene.x(0, i) * (1 + strain), test.wrap) + Vector3(0, y, 0);
    const double along = scene.mesh.rest(0, i);
    if (along < 0.5 * cell || along > rest - 0.5 * cell)
      scene.prescribed.push_back({int(i), scene.x.col(i), Motion{}});
  }
  // damped so that the slowest wave along the belt dies out at once
  const double speed = std::sqrt(stiffness / belt_density);
  scene.stretch = StretchMaterial{stiffness, 2 * belt_density * speed * way / pi, 1};
  Motion turn;
  turn.angular_velocity = Vector3(0, turning, 0);
  const Pose upright{Eigen::Quaterniond::FromTwoVectors(Vector3::UnitZ(), Vector3::UnitY()),
                     Vector3::Zero()};
  scene.objects.push_back(
      with_motion(object_at("drum", Capsule{radius, 10 * radius}, upright), turn, test.mu));
  return scene;
}

struct PulledBelt {
  double ratio;   // of the pulls on its ends
  double change;  // of it over the last part of the run
};

PulledBelt pulled(const Subject& subject, const BeltTest& test, int cells) {
  Stepper stepper(subject, belt(test, cells), "C");
  const Scene& scene = stepper.scene();
  const double end = scene.mesh.rest.row(0).maxCoeff(), cell = end / cells;
  const double h = 0.3 * cell * std::sqrt(belt_density / stiffness);
  State s = stepper.start();
  PulledBelt belt{1, 1};
  for (int part = 0; part < 60 && belt.change > 1e-5; ++part) {
    s = stepper.run(s, h, 4 * cells);  // a little more than a wave's way along the belt
    const PerParticle3 force = stepper.elastic_forces(s);
    Vector3 first = Vector3::Zero(), last = Vector3::Zero();
    for (Eigen::Index i = 0; i < force.cols(); ++i) {
      if (scene.mesh.rest(0, i) < 0.5 * cell) first += force.col(i);
      if (scene.mesh.rest(0, i) > end - 0.5 * cell) last += force.col(i);
    }
    const double ratio = first.norm() / last.norm();
    belt.change = std::abs(ratio / belt.ratio - 1);
    belt.ratio = ratio;
  }
  return belt;
}

NamedFinding belt_agrees(const Subject& subject, const BeltTest& test, Tier tier, Curve& exact,
                         Curve& simulated) {
  std::vector<int> cells{16, 32, 64};
  if (tier == Tier::full) cells.push_back(128);
  Ladder ratios;
  for (const int count : cells) {
    const PulledBelt belt = pulled(subject, test, count);
    ratios.values.push_back(belt.ratio);
    update_worst(ratios.floor, 3 * belt.change * belt.ratio);
  }
  const double should = std::exp(test.mu * test.wrap), scale = resolution * should;
  exact.point(test.mu * test.wrap, should);
  simulated.point(test.mu * test.wrap, ratios.values.back());
  return {fmt::format("friction-tests.belt-agrees.mu-{:.2f}", test.mu),
          fmt::format("A belt wrapped by {:.0f} degrees about a turning drum with friction {} is "
                      "pulled at its ends in the capstan's ratio, within two percent.",
                      test.wrap * 180 / pi, test.mu),
          judge_comparison(compare_ladder("ratio of the pulls", ratios, {should, 0}), scale,
                           "two percent of the ratio",
                           "S at the finest mesh, once the belt is at rest; D is exp(mu beta)")};
}

StudyResult run_friction_tests(const Subject& subject, Tier tier, const Progress& progress) {
  StudyResult result;
  for (const double mu : {0.23, 0.61}) {
    result.add({threshold_agrees(subject, mu), slide_agrees(subject, mu)});
  }
  progress(0.3);
  Curve exact{"exp(mu beta)"}, simulated{"simulated"};
  for (const BeltTest& test : {BeltTest{0.19, 1.3}, BeltTest{0.33, 2.4}}) {
    result.findings.push_back(belt_agrees(subject, test, tier, exact, simulated));
    progress(0.3 + 0.35 * double(simulated.x.size()));
  }
  result.figures.push_back({"belts",
                            "Pulls at the ends of a belt on a turning drum",
                            {"friction times angle of wrap", "1"},
                            {"ratio of the pulls", "1", Scale::log},
                            "The finest meshes beside the capstan's formula.",
                            {exact, simulated}});
  return result;
}

}  // namespace

Study friction_tests_study() {
  return {"friction-tests",
          "Cloth slips on an incline, slides down it, and drags on a drum as Coulomb's law says.",
          {"threshold-agrees", "slide-agrees", "belt-agrees"},
          "Coulomb; Euler and Eytelwein for the belt; Romero et al. 2021 for such tests",
          "A cloth lies on a plane whose slope is bisected until it slips, and slides down a "
          "steeper one; the error bar is that of a ladder of steps. A belt is held at both ends "
          "and lies about a drum that turns under it: at rest its ends are pulled in the ratio "
          "exp(mu beta), beta the angle of wrap; the error bar is that of a ladder of meshes. "
          "Cloth meets objects in its particles. D is Coulomb's law and has no uncertainty.",
          run_friction_tests,
          "validation"};
}

}  // namespace foldproof
