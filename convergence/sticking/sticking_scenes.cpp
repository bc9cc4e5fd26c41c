#include "convergence/sticking/sticking_scenes.h"

#include <cmath>
#include <vector>

#include "convergence/stability/stable_step.h"
#include "convergence/stability/step_matrix.h"
#include "verification/specimens/sticking_scenes.h"
#include "verification/specimens/specimens.h"
#include "verification/specimens/stepper.h"

namespace foldproof {

namespace {

/// Bonds after the first step, everything else at rest.
State begun(Stepper& stepper) {
  State s = stepper.start();
  s.bonds = stepper.step(s, 1e-12).bonds;
  return s;
}

}  // namespace

Scene particle_on_palm(const Vector3& place, const Motion& motion, double stiffness,
                       double forecast_time) {
  PerParticle3 x(3, 3);
  x << place, place + Vector3(0.1, 0, 0), place + Vector3(0, 0.1, 0);
  const TriangleMesh mesh = make_triangle_mesh(x, {{0, 1, 2}});
  Scene scene =
      scene_at_rest(mesh, 3 * particle_mass / triangle_areas(mesh.triangles, mesh.rest)[0]);
  StickyPatch patch = palm(scene, 2, motion);
  patch.particles = {0};
  patch.stiffness = stiffness;
  patch.forecast_time = forecast_time;
  patch.near = 0.01;
  patch.far = 0.04;
  scene.sticky = {patch};
  scene.solver.tolerance = 1e-13;
  return scene;
}

StuckParticle::StuckParticle(const Subject& subject, const char* method, double stiffness,
                             double forecast_time)
    : omega_(std::sqrt(stiffness / particle_mass)),
      stepper_(subject, particle_on_palm({0.11, 0.23, 0}, Motion{}, stiffness, forecast_time),
               method),
      rest_(begun(stepper_)) {}

Eigen::MatrixXd StuckParticle::step_matrix(double h) {
  constexpr double small = 1e-9;  // m; k fades by 1e-15 over it
  Eigen::MatrixXd matrix(2, 2);
  for (int j = 0; j < 2; ++j) {
    State s = rest_;
    if (j == 0) s.x(2, 0) += small;
    if (j == 1) s.v(2, 0) += small * omega_;
    const State next = stepper_.step(s, h);
    matrix.col(j) << (next.x(2, 0) - rest_.x(2, 0)) / small, next.v(2, 0) / (small * omega_);
  }
  return matrix;
}

namespace {

/// Two layers of soft cloth, the lower one held but for the particle nearest to its middle.
Scene held_layers() {
  constexpr double side = 0.2;
  Scene scene = scene_at_rest(two_sheets(2, side, 0.004), 0.2);
  scene.stretch = StretchMaterial{0.3, 0, 1};
  add_flat_hinges(scene, 1e-4, 0);
  const Eigen::Index lower = scene.x.cols() / 2;
  Eigen::Index middle = 0;
  (scene.x.leftCols(lower).colwise() - Vector3(side / 2, side / 2, 0))
      .colwise()
      .norm()
      .minCoeff(&middle);
  for (int i = 0; i < int(lower); ++i)
    if (i != middle) scene.prescribed.push_back({i, scene.x.col(i), Motion{}});
  return scene;
}

}  // namespace

double layers_radius(const Subject& subject, double omega_h, double share) {
  constexpr double h = 0.01, small = 1e-6;  // s, m
  Scene scene = held_layers();
  StickyPatch patch = layer_patch(scene.mesh);
  const double mass = lumped_masses(scene.mesh, scene.density).mean();
  patch.stiffness = mass * omega_h * omega_h / (h * h);
  patch.forecast_time = share * h;
  patch.near = 0.02;
  patch.far = 0.05;
  scene.sticky = {patch};
  scene.solver.tolerance = 1e-14;
  Stepper stepper(subject, scene, scene.integrator);
  const State rest = begun(stepper);

  std::vector<Eigen::Index> free;  // coordinates
  for (const int i : free_particles(scene))
    for (int k = 0; k < 3; ++k) free.push_back(3 * i + k);
  const Eigen::Index n = Eigen::Index(free.size());
  Eigen::MatrixXd matrix(2 * n, 2 * n);
  for (Eigen::Index j = 0; j < 2 * n; ++j) {
    const auto stepped = [&](double by) -> State {
      State s = rest;
      if (j < n) s.x.reshaped()[free[size_t(j)]] += by;
      if (j >= n) s.v.reshaped()[free[size_t(j - n)]] += by / h;
      return stepper.step(s, h);
    };
    const State ahead = stepped(small), behind = stepped(-small);
    const Eigen::VectorXd x = (ahead.x - behind.x).reshaped() / (2 * small),
                          v = (ahead.v - behind.v).reshaped() * (h / (2 * small));
    matrix.col(j) << x(free), v(free);
  }
  return spectral_radius(matrix);
}

double iterations_where(const Subject& subject, int n, StuckTo to, double number) {
  constexpr double h = 0.004, tau = 0.02, density = 0.2;
  const TriangleMesh mesh = two_sheets(n, 0.5, 0.002);
  Scene scene = scene_at_rest(mesh, density);
  scene.stretch = StretchMaterial{20, 0.3, 1};
  const double mass = density * (0.5 / n) * (0.5 / n);  // of a particle inside
  StickyPatch patch = to == StuckTo::cloth ? layer_patch(mesh) : palm(scene, 2, Motion{});
  if (to == StuckTo::nothing) patch.particles.clear();
  patch.forecast_time = tau;
  patch.stiffness = 2 * mass * number / (tau * h);
  patch.near = 0.003;
  patch.far = 0.05;
  scene.sticky = {patch};
  Stepper stepper(subject, scene, scene.integrator);
  State s = stepper.start();
  s.v = disturbance_shape(s.x.cols());
  stepper.run(s, h, 3);
  return double(stepper.work().cg_iterations) / double(stepper.work().solves);
}

}  // namespace foldproof
