#include "convergence/damping/sheet_modes.h"

#include <algorithm>
#include <cmath>

#include "convergence/integrators/oracle_problem.h"
#include "reference/mesh/shapes.h"
#include "verification/oracles/dense_algebra.h"
#include "verification/specimens/random.h"
#include "verification/specimens/stepper.h"

namespace foldproof {

namespace {

constexpr double side = 0.6;      // m
constexpr double density = 0.23;  // kg/m^2
constexpr double young = 31;      // Y [N/m]
constexpr double bending = 0.41;  // ke [J]: as stiff as the springs at cells of a tenth of a metre
constexpr double size = 1e-7;     // of the largest displacement [m]
constexpr int steps_measured = 12;

/// The oracle's accelerations at the positions x, 3 x N [m/s^2].
PerParticle3 acceleration(const oracles::RightHandSide& rhs, const oracles::ClothDefinition& cloth,
                          const PerParticle3& x) {
  const std::vector<double> y =
      oracles::free_coordinates(cloth, {x, PerParticle3(PerParticle3::Zero(3, x.cols()))});
  std::vector<double> rates(y.size());
  rhs(0, y, rates);
  return oracles::cloth_state(cloth, 0, rates).v;
}

/// M^{-1/2} K M^{-1/2} over the coordinates of one kind, by central differences [1/s^2].
Eigen::MatrixXd scaled_stiffness(const Scene& scene, const std::vector<Eigen::Index>& coordinates) {
  constexpr double shift = 1e-6;  // m
  const oracles::ClothDefinition cloth = oracle_of(scene);
  const oracles::RightHandSide rhs = oracles::cloth_rhs(cloth);
  const PerParticle mass = lumped_masses(scene.mesh, scene.density);
  const Eigen::Index n = Eigen::Index(coordinates.size());
  Eigen::MatrixXd matrix(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    PerParticle3 ahead = scene.mesh.rest, behind = ahead;
    ahead.reshaped()[coordinates[size_t(j)]] += shift;
    behind.reshaped()[coordinates[size_t(j)]] -= shift;
    const PerParticle3 slope =
        (acceleration(rhs, cloth, behind) - acceleration(rhs, cloth, ahead)) / (2 * shift);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Eigen::Index row = coordinates[size_t(i)];
      matrix(i, j) =
          std::sqrt(mass[row / 3] / mass[coordinates[size_t(j)] / 3]) * slope.reshaped()[row];
    }
  }
  return (matrix + matrix.transpose()) / 2;
}

std::vector<Eigen::Index> coordinates_of(ModeKind kind, Eigen::Index particles) {
  std::vector<Eigen::Index> list;
  for (Eigen::Index k = 0; k < 3 * particles; ++k)
    if ((k % 3 == 2) == (kind == ModeKind::bending)) list.push_back(k);
  return list;
}

/// The three least eigenvalues of either kind are its rigid motions.
void add_modes(const Scene& scene, ModeKind kind, std::vector<SheetMode>& modes) {
  constexpr Eigen::Index rigid = 3;
  const std::vector<Eigen::Index> coordinates = coordinates_of(kind, scene.mesh.rest.cols());
  const PerParticle mass = lumped_masses(scene.mesh, scene.density);
  const oracles::SymmetricModes found =
      oracles::symmetric_modes(scaled_stiffness(scene, coordinates));
  for (Eigen::Index k = rigid; k < found.values.size(); ++k) {
    PerParticle3 shape = PerParticle3::Zero(3, mass.size());
    for (size_t i = 0; i < coordinates.size(); ++i)
      shape.reshaped()[coordinates[i]] =
          found.vectors(Eigen::Index(i), k) / std::sqrt(mass[coordinates[i] / 3]);
    modes.push_back({kind, std::sqrt(found.values[k]), shape});
  }
}

/// The two starts: all modes displaced, all modes moving. 3 x N [m], [m/s].
struct Kick {
  PerParticle3 x, v;
};

std::vector<Kick> kicks(const std::vector<SheetMode>& modes) {
  const PerParticle3 none = PerParticle3::Zero(3, modes.front().shape.cols());
  PerParticle3 sum = none;
  Random random(47);
  for (const SheetMode& mode : modes) sum += random.uniform(-1, 1) < 0 ? mode.shape : -mode.shape;
  sum *= size / sum.colwise().norm().maxCoeff();
  return {{sum, none}, {none, highest_frequency(modes) * sum}};
}

/// States of a run, one a step.
std::vector<State> run(Stepper& stepper, const Kick& kick, double h, int steps) {
  State start = stepper.start();
  start.x += kick.x;
  start.v += kick.v;
  std::vector<State> states = {start};
  for (int n = 0; n < steps; ++n) {
    const size_t length = std::min<size_t>(2, states.size());
    states.push_back(stepper.step_after({states.end() - std::ptrdiff_t(length), states.end()}, h));
  }
  return states;
}

/// (omega q, p) of a mode, a column a step; half the difference of two runs.
Eigen::Matrix2Xd coordinates_of(const SheetMode& mode, const PerParticle& mass,
                                const std::vector<State>& plus, const std::vector<State>& minus) {
  const PerParticle3 weighted = mode.shape * mass.asDiagonal();
  Eigen::Matrix2Xd y(2, Eigen::Index(plus.size()));
  for (size_t n = 0; n < plus.size(); ++n) {
    const double q = weighted.cwiseProduct(plus[n].x - minus[n].x).sum() / 2;
    const double p = weighted.cwiseProduct(plus[n].v - minus[n].v).sum() / 2;
    y.col(Eigen::Index(n)) << mode.frequency * q, p;
  }
  return y;
}

oracles::Factors eigenvalues(const Eigen::Matrix2d& matrix) {
  const double half_trace = matrix.trace() / 2;
  const std::complex<double> root =
      std::sqrt(std::complex<double>(half_trace * half_trace - matrix.determinant()));
  return {half_trace + root, half_trace - root};
}

}  // namespace

Scene sheet_at_rest(int cells, const Relaxation& relaxation) {
  Scene scene =
      scene_at_rest(make_sheet({SheetPattern::union_jack, side, side, cells, cells}), density);
  scene.mesh.rest.topRows(2).array() -= side / 2;
  scene.x = scene.mesh.rest;
  scene.stretch = StretchMaterial{young, relaxation.stretch * young, 1};
  // K = (ke/2) c u u^T and -D = kd c u u^T at a flat hinge
  scene.bending = BendingMaterial{bending, relaxation.bending * bending / 2, Weighting::rest,
                                  DampingFactor::edge_squared_over_area};
  scene.rest_angles.assign(scene.mesh.hinges.size(), 0);
  scene.solver.tolerance = 1e-10;
  return scene;
}

std::vector<SheetMode> modes_of(const Scene& scene) {
  Scene undamped = scene;
  undamped.stretch->damping = undamped.bending->damping = 0;
  std::vector<SheetMode> modes;
  add_modes(undamped, ModeKind::stretch, modes);
  add_modes(undamped, ModeKind::bending, modes);
  return modes;
}

double highest_frequency(const std::vector<SheetMode>& modes) {
  return std::ranges::max_element(modes, {}, &SheetMode::frequency)->frequency;
}

double lowest_frequency(const std::vector<SheetMode>& modes) {
  return std::ranges::min_element(modes, {}, &SheetMode::frequency)->frequency;
}

oracles::Oscillator oscillator_of(const SheetMode& mode, const Relaxation& relaxation) {
  const double squared = mode.frequency * mode.frequency;
  return {squared, relaxation.of(mode.kind) * squared, 0, 0};
}

std::vector<oracles::Factors> measured_factors(const Subject& subject, const Scene& scene,
                                               const std::vector<SheetMode>& modes, double h,
                                               int skipped) {
  const PerParticle mass = lumped_masses(scene.mesh, scene.density);
  Stepper stepper(subject, scene, scene.integrator);
  std::vector<Eigen::Matrix2d> next(modes.size(), Eigen::Matrix2d::Zero()), now = next;
  for (const Kick& kick : kicks(modes)) {
    const std::vector<State> plus = run(stepper, kick, h, skipped + steps_measured);
    const std::vector<State> minus = run(stepper, {-kick.x, -kick.v}, h, skipped + steps_measured);
    for (size_t i = 0; i < modes.size(); ++i) {
      const Eigen::Matrix2Xd y = coordinates_of(modes[i], mass, plus, minus);
      const Eigen::Matrix2Xd before = y.middleCols(skipped, steps_measured);
      next[i] += y.rightCols(steps_measured) * before.transpose();
      now[i] += before * before.transpose();
    }
  }
  std::vector<oracles::Factors> factors;
  for (size_t i = 0; i < modes.size(); ++i)
    factors.push_back(eigenvalues(next[i] * now[i].inverse()));
  return factors;
}

double distance_of(const oracles::Factors& a, const oracles::Factors& b) {
  Worst straight, crossed;
  for (size_t i = 0; i < 2; ++i) {
    straight.observe(std::abs(a[i] - b[i]));
    crossed.observe(std::abs(a[i] - b[1 - i]));
  }
  return crossed.value() < straight.value() ? crossed.value() : straight.value();
}

double decay_of(const oracles::Factors& factors) {
  Worst largest;
  for (const std::complex<double>& factor : factors) largest.observe(std::abs(factor));
  return largest.value();
}

VibratingSheet make_vibrating_sheet(int cells) {
  const std::vector<SheetMode> modes = modes_of(sheet_at_rest(cells, {}));
  return {cells, modes, 2 / highest_frequency(modes)};
}

std::vector<oracles::Factors> factors_of(const Subject& subject, const VibratingSheet& sheet,
                                         const Integrator& method, const Relaxation& relaxation,
                                         double h) {
  Scene scene = sheet_at_rest(sheet.cells, relaxation);
  scene.integrator = std::string(method.name);
  return measured_factors(subject, scene, sheet.modes, h, method.history > 1 ? 20 : 0);
}

double loss_per_period(const SheetMode& mode, const oracles::Factors& factors, double h) {
  return -2 * pi / (mode.frequency * h) * std::log(decay_of(factors));
}

}  // namespace foldproof
