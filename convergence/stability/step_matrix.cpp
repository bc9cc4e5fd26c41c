#include "convergence/stability/step_matrix.h"

#include <cmath>
#include <limits>
#include <vector>

#include "reference/dynamics/integrator.h"
#include "reference/mesh/shapes.h"
#include "verification/oracles/dense_algebra.h"
#include "verification/specimens/specimens.h"

namespace foldproof {

namespace {

constexpr double tight = 1e-13;  // of solves

// In the plane of a sheet places are rounded to 1e-17 m and strains of 1e-6 act as if there were
// none; the hinge's corner has its disturbance alone in z, so that nothing rounds.
constexpr double sheet_disturbance = 1e-7, hinge_disturbance = 1e-12;  // m

/// scene.x + q shapes and q' shapes; disturbances as SmallMotion has them, times the size
/// `unit` [m sqrt(kg)].
State disturb(const SmallMotion& motion, const Eigen::VectorXd& y, double time, double unit) {
  const Eigen::Index n = motion.shapes.cols(), particles = motion.scene.x.cols();
  const Eigen::VectorXd x = motion.shapes * y.head(n) * unit;
  const Eigen::VectorXd v = motion.shapes * y.tail(n) * (unit * motion.omega0);
  State s = start_state(motion.scene);
  s.time = time;
  s.x += Eigen::Map<const PerParticle3>(x.data(), 3, particles);
  s.v = Eigen::Map<const PerParticle3>(v.data(), 3, particles);
  return s;
}

/// shapes^T M of what differs, 3 x N.
Eigen::VectorXd coordinates(const SmallMotion& motion, const PerParticle3& difference) {
  const PerParticle3 weighted =
      difference * lumped_masses(motion.scene.mesh, motion.scene.density).asDiagonal();
  return motion.shapes.transpose() *
         Eigen::Map<const Eigen::VectorXd>(weighted.data(), weighted.size());
}

/// A q so small that no particle moves by more than the disturbance [m sqrt(kg)].
double unit_of(const SmallMotion& motion) {
  return motion.disturbance / motion.shapes.cwiseAbs().maxCoeff();
}

/// The state after one step from the disturbances y of the latest states.
State step_disturbance(const SteppedMotion& of, const Eigen::VectorXd& y, Steps steps,
                       double unit) {
  const Eigen::Index size = 2 * of.motion.shapes.cols();
  std::vector<State> past;
  for (int i = 0; i < of.history; ++i)
    past.push_back(disturb(of.motion, y.segment(i * size, size),
                           i + 1 < of.history ? -steps.before : 0, unit));
  Work uncounted;
  return of.subject.step(*of.prepared, past, steps.now, uncounted);
}

}  // namespace

// u1 = |E|/|N1| n1 near flat, and theta = z |E|/|N1|: the force on the corner is -ke c (theta/2)
// |E|/|N1| - kd |E| (|E|/|N1|)^2 z', c = |E|^2/(|N1| + |N2|).
SmallMotion hinge_oscillator(double zeta) {
  constexpr double length = 0.13, density = 0.21, ke = 0.0071;              // m, kg/m^2, J
  constexpr double N1 = 0.9 * length * length, N2 = 0.6 * length * length;  // m^2
  constexpr double mass = density * N1 / 2 / 3;                             // kg
  constexpr double squared_mode = (length / N1) * (length / N1);            // 1/m^2
  const double omega = std::sqrt(ke * length * length / (N1 + N2) / 2 * squared_mode / mass);
  const double kd = 2 * zeta * omega * mass / (length * squared_mode);  // N s

  Scene scene = scene_at_rest(make_hinge(length, 0), density);
  scene.bending = BendingMaterial{ke, kd};
  scene.rest_angles = {0};
  for (int i = 1; i < 4; ++i) scene.prescribed.push_back({i, scene.x.col(i), {}});
  Eigen::MatrixXd shape = Eigen::MatrixXd::Zero(12, 1);
  shape(2, 0) = 1 / std::sqrt(mass);
  return {std::move(scene), std::move(shape), omega, hinge_disturbance};
}

Scene clamped_sheet(double spring_damping, double bending_damping) {
  Scene scene = scene_at_rest(make_sheet({SheetPattern::union_jack, 0.33, 0.22, 3, 2}), 0.23);
  scene.stretch = StretchMaterial{29, spring_damping, 1};
  add_flat_hinges(scene, 0.11, bending_damping);
  for (int i = 0; i < scene.mesh.particles(); ++i)
    if (scene.mesh.rest(0, i) < 0.17) scene.prescribed.push_back({i, scene.x.col(i), {}});
  return scene;
}

SmallMotion free_motion(Scene scene, double omega0) {
  const PerParticle mass = lumped_masses(scene.mesh, scene.density);
  const std::vector<int> free = free_particles(scene);
  const Eigen::Index n = 3 * Eigen::Index(free.size());
  Eigen::MatrixXd shapes = Eigen::MatrixXd::Zero(3 * mass.size(), n);
  Eigen::Index column = 0;
  for (const int i : free)
    for (int d = 0; d < 3; ++d) shapes(3 * i + d, column++) = 1 / std::sqrt(mass[i]);
  return {std::move(scene), std::move(shapes), omega0, sheet_disturbance};
}

SmallMotion motion_along(Scene scene, const PerParticle3& shape, double omega0) {
  const PerParticle mass = lumped_masses(scene.mesh, scene.density);
  const double norm = std::sqrt(shape.colwise().squaredNorm().dot(mass.transpose()));
  Eigen::MatrixXd shapes = Eigen::Map<const Eigen::VectorXd>(shape.data(), shape.size()) / norm;
  return {std::move(scene), std::move(shapes), omega0, sheet_disturbance};
}

LinearForces linear_forces(const Subject& subject, const SmallMotion& motion) {
  const auto prepared = require_offered(subject.prepare, "prepare")(motion.scene);
  const auto& elastic = require_offered(subject.elastic_forces, "elastic_forces");
  const auto& damping = require_offered(subject.damping_forces, "damping_forces");
  const PerParticle inverse = lumped_masses(motion.scene.mesh, motion.scene.density).cwiseInverse();
  const Eigen::Index n = motion.shapes.cols();
  const double unit = unit_of(motion);
  LinearForces forces{Eigen::MatrixXd(n, n), Eigen::MatrixXd(n, n)};
  for (Eigen::Index j = 0; j < n; ++j) {
    const Eigen::VectorXd y = Eigen::VectorXd::Unit(2 * n, j);
    const State ahead = disturb(motion, y, 0, unit), behind = disturb(motion, -y, 0, unit);
    const PerParticle3 pull = (elastic(*prepared, behind) - elastic(*prepared, ahead)) / (2 * unit);
    forces.stiffness.col(j) = coordinates(motion, pull * inverse.asDiagonal());
    const PerParticle3 drag =
        -damping(*prepared, start_state(motion.scene), (ahead.x - behind.x) / (2 * unit));
    forces.damping.col(j) = coordinates(motion, drag * inverse.asDiagonal());
  }
  forces.stiffness = (forces.stiffness + forces.stiffness.transpose()).eval() / 2;
  forces.damping = (forces.damping + forces.damping.transpose()).eval() / 2;
  return forces;
}

SteppedMotion stepped_motion(const Subject& subject, SmallMotion motion,
                             std::string_view integrator) {
  motion.scene.integrator = std::string(integrator);
  motion.scene.solver.tolerance = tight;
  require_offered(subject.step, "step");
  auto prepared = require_offered(subject.prepare, "prepare")(motion.scene);
  return {subject, std::move(motion), integrator_named(integrator).history, std::move(prepared)};
}

Eigen::MatrixXd step_matrix(const SteppedMotion& of, Steps steps) {
  const Eigen::Index n = of.motion.shapes.cols(), size = 2 * n * of.history;
  const double unit = unit_of(of.motion);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
  for (Eigen::Index i = 0; i + 2 * n < size; ++i) matrix(i, i + 2 * n) = 1;  // now becomes before
  for (Eigen::Index j = 0; j < size; ++j) {
    const Eigen::VectorXd y = Eigen::VectorXd::Unit(size, j);
    const State ahead = step_disturbance(of, y, steps, unit),
                behind = step_disturbance(of, -y, steps, unit);
    matrix.col(j).segment(size - 2 * n, n) =
        coordinates(of.motion, ahead.x - behind.x) / (2 * unit);
    matrix.col(j).tail(n) =
        coordinates(of.motion, ahead.v - behind.v) / (2 * unit * of.motion.omega0);
  }
  return matrix;
}

Eigen::MatrixXd pair_matrix(const SteppedMotion& of, double first, double second) {
  return step_matrix(of, {second, first}) * step_matrix(of, {first, second});
}

oracles::Scheme derived_scheme(std::string_view integrator) {
  if (integrator == "A") return oracles::Scheme::mixed;
  if (integrator == "B") return oracles::Scheme::central_newmark;
  if (integrator == "C") return oracles::Scheme::variable_step_newmark;
  throw NotOffered{"a derived step matrix for integrator " + std::string(integrator)};
}

double spectral_radius(const Eigen::MatrixXd& matrix) {
  if (!matrix.allFinite()) return nan;
  Worst worst;
  const Eigen::VectorXcd values = oracles::eigenvalues(matrix);
  for (const std::complex<double>& value : values) worst.observe(std::abs(value));
  return worst.value();
}

double largest_constant_step(const SteppedMotion& of, const StepRange& range) {
  const auto stays = [&](double h) {
    return spectral_radius(step_matrix(of, {h, h})) <= 1 + range.threshold;
  };
  if (!stays(range.low)) return 0;
  double below = range.low, above = below * 8 / 7;
  while (stays(above)) {
    if (above >= range.high) return std::numeric_limits<double>::infinity();
    below = above;
    above *= 8. / 7;
  }
  for (int i = 0; i < range.halvings; ++i) {
    const double middle = (below + above) / 2;
    (stays(middle) ? below : above) = middle;
  }
  return (below + above) / 2;
}

double transient_growth(const Eigen::MatrixXd& matrix, int powers) {
  if (!matrix.allFinite()) return nan;
  Worst worst;
  worst.observe(1);
  Eigen::MatrixXd power = matrix;
  for (int i = 0; i < powers; ++i) {
    if (!power.allFinite()) return std::numeric_limits<double>::infinity();
    const Eigen::MatrixXd square = power.transpose() * power;
    worst.observe(std::sqrt(oracles::symmetric_eigenvalues(square)[square.rows() - 1]));
    power = matrix * power;
  }
  return worst.value();
}

Eigen::MatrixXd in_energy_norm(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& stiffness,
                               double omega0) {
  const Eigen::Index n = stiffness.rows();
  const auto [values, vectors] = oracles::symmetric_modes(stiffness);
  const Eigen::VectorXd roots = values.cwiseSqrt();
  Eigen::MatrixXd scale = Eigen::MatrixXd::Identity(2 * n, 2 * n), back = scale;
  scale.topLeftCorner(n, n) = vectors * roots.asDiagonal() * vectors.transpose() / omega0;
  back.topLeftCorner(n, n) =
      vectors * roots.cwiseInverse().asDiagonal() * vectors.transpose() * omega0;
  return scale * matrix * back;
}

}  // namespace foldproof
