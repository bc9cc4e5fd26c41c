// time-order.hinge: the smallest problem that is nonlinear, damped and driven.
#include <array>
#include <cmath>

#include "convergence/integrators/oracle_problem.h"
#include "convergence/integrators/time_order.h"
#include "reference/mesh/shapes.h"
#include "verification/oracles/driven_hinge.h"

namespace foldproof {

namespace {

constexpr double length = 0.13;     // m
constexpr double rest_angle = 0.4;  // rad
constexpr double end = 0.4;         // s
constexpr double tolerance = 1e-13;

/// x1 is free, x2 oscillates in all three directions, the shared edge is held.
Scene driven_scene() {
  Scene scene = scene_at_rest(make_hinge(length, rest_angle), 0.21);
  scene.gravity = Vector3(0.4, -9.1, 1.3);
  scene.stretch = StretchMaterial{17, 0.013, 1};
  scene.bending = BendingMaterial{0.011, 0.0005};
  scene.rest_angles = {rest_angle};
  scene.solver.tolerance = 1e-15;
  scene.v.col(0) = Vector3(0.11, -0.17, 0.83);

  Motion swing;
  swing.amplitude = Vector3(0.006, 0.011, 0.047);
  swing.frequency = 3.7;
  swing.phase = 0.6;
  scene.prescribed = {{1, scene.mesh.rest.col(1), swing},
                      {2, scene.mesh.rest.col(2), {}},
                      {3, scene.mesh.rest.col(3), {}}};
  return scene;
}

/// The same in the oracle's own words: it finds masses, springs and factors from the rest
/// corners by itself.
oracles::ClothDefinition driven_oracle(const Scene& scene) {
  oracles::DrivenHinge hinge;
  for (size_t i = 0; i < 4; ++i) {
    hinge.hinge.rest[i] = scene.mesh.rest.col(Eigen::Index(i));
    hinge.hinge.x[i] = scene.x.col(Eigen::Index(i));
    hinge.hinge.v[i] = scene.v.col(Eigen::Index(i));
  }
  hinge.hinge.ke = scene.bending->stiffness;
  hinge.hinge.kd = scene.bending->damping;
  hinge.hinge.theta0 = rest_angle;
  hinge.density = scene.density;
  hinge.young = scene.stretch->stiffness;
  hinge.spring_damping = scene.stretch->damping;
  hinge.gravity = *scene.gravity;
  for (const PrescribedParticle& prescribed : scene.prescribed)
    hinge.prescribed[prescribed.particle] = oracle_motion(prescribed);
  return oracles::driven_hinge(hinge);
}

/// Where the next term of a method's error has become small: the sooner the higher its order;
/// forward Euler has to be stable first.
int first_level(const Integrator& integrator) {
  if (integrator.name == "forward-euler") return 6144;
  const std::array<int, 4> by_order = {3072, 576, 288, 192};
  return by_order.at(size_t(integrator.order - 1));
}

/// The paper's schemes and all they are compared with. BDF2 restricts the growth of its steps.
std::vector<ObservedMethod> methods(Tier tier) {
  const int more = tier == Tier::quick ? 0 : 2;
  std::vector<ObservedMethod> all = paper_methods(96, 7 + more);
  for (const Integrator& integrator : integrators()) {
    if (integrator.family == Family::mixed) continue;
    const bool restricted = std::isfinite(integrator.largest_growth);
    all.push_back({integrator, restricted ? gentle_step_patterns() : step_patterns(),
                   first_level(integrator), integrator.order == 4 ? 5 + more : 4 + more});
  }
  return all;
}

StudyResult run_hinge_order(const Subject& subject, Tier tier, const Progress& progress) {
  const Scene scene = driven_scene();
  const ExactEnd exact = exact_end(scene, driven_oracle(scene), end, tolerance);
  return time_order(subject,
                    {"time-order.hinge", "the driven hinge", scene, end, methods(tier), exact.state,
                     exact.uncertainty},
                    progress);
}

}  // namespace

Study hinge_time_order_study() {
  return {
      "time-order.hinge",
      "Schemes A, B and C are second order in x and v on a nonlinear, damped, driven hinge, with "
      "constant, alternating and random steps.",
      {"A", "B", "C", "B-is-second-order-with-variable-steps"},
      "BMF03 section 3",
      "Two triangles share a fixed edge; one opposite corner follows a periodic path, the other is "
      "free. Springs and bending are both damped, gravity pulls, and the angle covers a large part "
      "of its range, so that nothing is linear and the forces depend on time. Each scheme runs "
      "with constant, alternating and random steps; a finer level halves every step of the coarser "
      "one. The end is compared with a solution by GSL, which shares no formula with the solver.",
      run_hinge_order};
}

}  // namespace foldproof
