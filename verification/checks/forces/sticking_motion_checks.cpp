// Motion of stuck cloth: following its target, lag, and stable steps.
#include <fmt/format.h>
#include <memory>

#include "reference/dynamics/simulate.h"
#include "verification/specimens/check.h"
#include "verification/specimens/differences.h"
#include "verification/specimens/moving_sheets.h"
#include "verification/specimens/stepper.h"
#include "verification/specimens/sticking_scenes.h"

namespace foldproof {

namespace {

/// Three free particles over the palm, one of them above an edge of its triangles; they weigh
/// 0.0021 kg each.
Scene over_the_palm(const RigidMotion& motion) {
  const PerParticle3 x =
      (PerParticle3(3, 3) << 0.05, 0.19, -0.11, -0.07, 0.06, 0.08, 0.004, 0.007, -0.003).finished();
  const TriangleMesh mesh = make_triangle_mesh(x, {{0, 1, 2}});
  Scene scene = scene_at_rest(mesh, 0.0063 / triangle_areas(mesh.triangles, mesh.rest)[0]);
  StickyPatch patch = palm(scene, 0.6, motion);
  patch.stiffness = 400;
  patch.near = 0.01;
  patch.far = 0.04;
  patch.forecast_time = 0.03;
  scene.sticky = {patch};
  return scene;
}

constexpr double mass = 0.0021;  // kg

/// Particles start with the palm's velocity.
State carried_start(const Scene& scene, const RigidMotion& motion) {
  State s = start_state(scene);
  for (Eigen::Index i = 0; i < s.x.cols(); ++i) s.v.col(i) = velocity_at(motion, s.x.col(i), 0);
  return s;
}

/// A swing with drift and a turn; its acceleration never exceeds (2 pi f)^2 |amplitude| + rate^2
/// |arm|.
Motion waving() {
  Motion motion;
  motion.velocity = {0.3, 0.7, -0.4};
  motion.amplitude = {0.11, -0.05, 0.07};
  motion.frequency = 0.9;
  motion.angular_velocity = {1.3, 0.9, -1.9};
  motion.center = {0.1, 0.2, -0.1};
  return motion;
}

double largest_acceleration(const Motion& motion, const PerParticle3& x) {
  const double rate = 2 * pi * motion.frequency;
  const double arm = (x.colwise() - motion.center).colwise().norm().maxCoeff();
  return rate * rate * motion.amplitude.norm() + motion.angular_velocity.squaredNorm() * arm;
}

Finding follows_finding(const Subject& subject) {
  const Motion motion = waving();
  const Scene scene = over_the_palm(motion);
  const StickyPatch& patch = scene.sticky[0];
  const double a = largest_acceleration(motion, scene.x), h = 0.0012;
  const double soft = mass * a / patch.stiffness,
               q = h * patch.forecast_time * patch.stiffness / (2 * mass);
  const double late = soft * q * q / (1 + q);  // derived in convergence/sticking/sticking_lag.cpp
  const double part = (soft + late) / patch.far;
  Table measured{{"case", ""}, {"largest distance from its place over what was derived", "1"}};
  for (const Integrator& integrator : paper_schemes()) {
    Stepper stepper(subject, scene, std::string(integrator.name));
    State s = carried_start(scene, motion);
    const double bound = integrator.name == "C" ? soft + late : soft;
    Worst worst;
    for (int n = 0; n < 1500; ++n) {
      s = stepper.step(s, h);
      if (s.bonds.size() < 3) worst.observe(NAN);
      for (Eigen::Index i = 0; i < s.x.cols(); ++i) {
        // rigid motion of the particle's start: its position in the palm's frame
        const Vector3 place = to_world(pose_at(motion, s.time), scene.x.col(i));
        worst.observe((s.x.col(i) - place).norm() / bound);
      }
    }
    measured.row("scheme " + std::string(integrator.name), worst.value());
  }
  return judge_worst(measured, 1 / std::pow(1 - part * part, 2) * (1 + 0.01),
                     "overdamped (omega tau_s/2 = 6.5), a spring lags by no more than the largest "
                     "m a/k, k less than k0 by (1 - (lag/far)^2)^2 at most; scheme C, which moves "
                     "with the target's velocity of the step's start, by q^2/(1 + q) of that more, "
                     "q = h tau_s k/(2 m); a hundredth for the schemes' second order");
}

Finding lag_finding(const Subject& subject) {
  Table measured{{"case", ""}, {"lag less what was derived, over it", "1"}};
  for (const double pull : {0.05, 0.15, 0.27}) {  // m g over k far; it breaks at .286
    Scene scene = over_the_palm(Motion{});
    const StickyPatch& patch = scene.sticky[0];
    scene.gravity = Vector3(0, 0, -pull * patch.stiffness * patch.far / mass);
    double r = pull;  // solves r (1 - r^2)^2 = pull by iteration
    for (int n = 0; n < 400; ++n) r = pull / std::pow(1 - r * r, 2);
    Stepper stepper(subject, scene, "C");
    State s = stepper.start();
    s = stepper.run(s, 0.002, 1500);
    const double lag = (s.x - scene.x).colwise().norm().mean();
    measured.row(fmt::format("{} k far", pull), std::abs(lag / (r * patch.far) - 1));
  }
  return judge_worst(measured, 1e-9,
                     "3 s are thirty times 2/(omega^2 tau_s) at least, until when it creeps at "
                     "e^-t; the solve's tolerance is 1e-10");
}

/// A surface of one triangle, bent by its animation: a stuck particle keeps its place in it.
Finding deforming_finding(const Subject& subject) {
  SceneObject part;
  const PerParticle3 x0 =
      (PerParticle3(3, 3) << -0.3, 0.5, -0.1, -0.2, 0.1, 0.4, 0, 0.01, 0.02).finished();
  PerParticle3 x1 = x0, x2 = x0;
  x1.row(2) += Eigen::RowVector3d(0.07, -0.03, 0.05);
  x2.row(0) *= 1.2;
  part.vertices = x0;
  part.triangles = {{0, 1, 2}};
  part.animation =
      std::make_shared<MeshSequence>(MeshSequence{part.triangles, {0, 0.6, 1.1}, {x0, x1, x2}});
  Scene scene = over_the_palm(Motion{});
  StickyPatch& patch = scene.sticky[0];
  patch.triangles = part.triangles;
  patch.place = [part](double t) { return surface_at(part, t); };
  patch.velocity = [part](double t) { return surface_velocity_at(part, t); };
  patch.near = 0.05;
  Stepper stepper(subject, scene, "C");
  State s = stepper.step(stepper.start(), 0.001);
  Table measured{{"case", ""}, {"distance from its place in the triangle", "m"}};
  for (int n = 1; n < 1600; ++n) {
    s = stepper.step(s, 0.001);
    if (n % 200 != 199) continue;
    oracles::StuckParticle stuck{Vector3::Zero(), {}, {}, 1, 1};
    const PerParticle3 now = surface_at(part, s.time);
    Worst worst;
    for (const Bond& bond : s.bonds) {
      stuck.corners = {{now.col(0), now.col(1), now.col(2)}};
      stuck.places = {bond.place};
      worst.observe((oracles::sticking_answer(stuck).target - s.x.col(bond.particle)).norm());
    }
    measured.row(fmt::format("{:.3f} s, {} bonds", s.time, s.bonds.size()),
                 s.bonds.size() == 3 ? worst.value() : NAN);
  }
  return judge_worst(measured, 1e-4,
                     "corners move at up to 0.2 m/s; at each frame's jump of it dv the overdamped "
                     "spring lags by no more than dv/(omega^2 tau_s) = 7e-5 m and forgets it; the "
                     "frame's own acceleration adds less than 1e-5 m: 8e-5 m, rounded up");
}

Finding forecast_step_finding() {
  Table measured{{"case", ""}, {"step over what was derived less 1", "1"}};
  for (const double tau : {0.0, 0.0007, 0.03}) {
    Scene scene = over_the_palm(Motion{});
    scene.sticky[0].forecast_time = tau;
    const System system = build_system(scene);
    State s = start_state(scene);
    begin_step(system, s);
    const double omega = std::sqrt(scene.sticky[0].stiffness / mass);
    StepRule rule;
    rule.safety = 0.7;
    const auto step = [&](const char* name) {
      return allowed_step(system, integrator_named(name), {&s, 1}, rule, elastic_limit(system, s));
    };
    for (const char* name : {"A", "B", "backward-euler"})
      measured.row(fmt::format("{}, tau_s = {} s", name, tau),
                   std::abs(step(name) * omega / (0.7 * 2) - 1));
    const double derived = 0.7 * std::max(2 / omega, 2 * tau);
    measured.row(fmt::format("C, tau_s = {} s", tau), std::abs(step("C") / derived - 1));
    if (tau > 0) {
      const double both = 0.7 * std::min(2 / omega, 2 / (omega * omega * tau));
      measured.row(fmt::format("RK4, tau_s = {} s", tau), std::abs(step("RK4") / both - 1));
    }
  }
  return judge_worst(
      measured, 1e-6,
      "dividing 10^9 s evenly into a hundred million steps or more changes a step in the eighth "
      "digit only; the bounds are exact for particles that share no spring");
}

Finding nothing_sticks_finding(const Subject& subject) {
  Table measured{{"case", ""}, {"numbers that differ, and counts", "1"}};
  for (const Integrator& integrator : integrators()) {
    const std::string name(integrator.name);
    Scene with = partly_prescribed_sheet();
    StickyPatch far_away = palm(with, 0.4, Motion{.velocity = {0, 0.1, 0}});
    far_away.stiffness = 1e4;
    far_away.forecast_time = 0.02;
    far_away.near = 0.01;
    far_away.far = 0.05;
    const auto place = far_away.place;
    far_away.place = [place](double t) -> PerParticle3 {
      return place(t).colwise() + Vector3(0, 0, 3);
    };
    StickyPatch of_cloth = far_away;
    of_cloth.place = {};
    of_cloth.velocity = {};
    of_cloth.triangles = {with.mesh.triangles.front()};
    of_cloth.particles = {with.mesh.particles() - 1};
    with.sticky = {far_away, of_cloth};
    Stepper sticky(subject, with, name), plain(subject, partly_prescribed_sheet(), name);
    const State a = sticky.run(sticky.start(), 1.1e-3, 12),
                b = plain.run(plain.start(), 1.1e-3, 12);
    const Work &one = sticky.work(), &other = plain.work();
    measured.row(name + ", bits",
                 count_differing_entries(a.x, b.x) + count_differing_entries(a.v, b.v));
    measured.row(name + ", iterations and products",
                 double(std::abs(one.cg_iterations - other.cg_iterations) +
                        std::abs(one.damping_products - other.damping_products) +
                        std::abs(one.newton_iterations - other.newton_iterations) + one.bonds));
  }
  return judge_worst(measured, 0, "patches that hold nothing add nothing to any force or matrix");
}

}  // namespace

std::vector<Check> sticking_motion_checks() {
  const std::string source = "BMF03 section 6";
  return {{"sticking.particles-follow-rigid-motion",
           "Particles stuck to a surface that turns, swings and drifts keep their place on it, "
           "with a lag of at most m a/k.",
           source, follows_finding},
          {"sticking.lag-is-as-derived",
           "Under a constant pull a stuck particle hangs where k(d) d is the pull: m a/k for soft "
           "pulls.",
           "our reading of BMF03 section 6", lag_finding},
          {"sticking.particles-follow-a-deforming-surface",
           "Particles stuck to a triangle that deforms keep their weights and height in it.",
           source, deforming_finding},
          {"sticking.forecasts-allow-longer-steps-in-C",
           "In the reference's automatic steps, bonds allow C twice their forecast time, and A and "
           "B only the step of their frequency.",
           "our reading of BMF03 section 6", forecast_step_finding},
          {"sticking.unused-patches-cost-nothing",
           "Patches that nothing sticks to change no bit of any method's steps, nor the cost of "
           "its solves.",
           "our reading of BMF03 section 6", nothing_sticks_finding}};
}

}  // namespace foldproof
