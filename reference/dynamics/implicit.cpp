#include "reference/dynamics/implicit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <variant>

#include "reference/dynamics/biconjugate_gradient.h"
#include "reference/dynamics/conjugate_gradient.h"
#include "reference/dynamics/finish_step.h"
#include "reference/forces/degenerate.h"

namespace foldproof {

namespace {

constexpr int max_newton_iterations = 60, max_halvings = 12;
constexpr double forcing = 1e-3;  // relative residual to which a Newton step is solved
// required relative decrease of the residual or work, per fraction of the step taken
constexpr double min_decrease = 1e-4;

/// The data of the stage equation (see the header).
struct Stage {
  double time;              // t [s]
  PerParticle3 X;           // 3 x N [m]
  PerParticle3 V;           // 3 x N [m/s]
  double s;                 // s
  std::vector<Bond> bonds;  // of the state that the step starts from
};

State state_of(const Stage& stage, const PerParticle3& w) {
  return {stage.time, stage.X + stage.s * w, w, stage.bonds};
}

double norm_of(const PerParticle3& momentum, const PerParticle& inverse_mass) {
  return std::sqrt(momentum.colwise().squaredNorm().dot(inverse_mass.transpose()));
}

/// s (F + D w) - M (w - V) at free particles, 0 at prescribed ones [kg m/s].
PerParticle3 residual_of(const System& system, const Stage& stage, const PerParticle3& w,
                         Work& work) {
  const State at = state_of(stage, w);
  const Forces forces = forces_at(system.forces, at, work);
  PerParticle3 force = *forces.elastic;
  forces.damping->add_product(w, force);
  ++work.damping_products;
  PerParticle3 residual = stage.s * force - (w - stage.V) * system.mass.asDiagonal();
  for (const PrescribedParticle& p : system.prescribed) residual.col(p.particle).setZero();
  return residual;
}

/// Where a line search ended.
struct Trial {
  PerParticle3 w, residual;
  double norm;
  bool is_improved;  // than where it started
};

double product(const PerParticle3& a, const PerParticle3& b) { return a.cwiseProduct(b).sum(); }

/// Halves the step until the residual falls, or until the residual's work along the step
/// (trapezoidal rule) is positive. The residual is minus the gradient of a potential, except for
/// damping; positive work means that the step leads downhill, though the residual may rise on the
/// way. Gives up after a dozen halvings.
Trial line_search(const System& system, const Stage& stage, const Trial& from,
                  const PerParticle3& dw, Work& work) {
  double part = 1;
  for (int i = 0; i < max_halvings; ++i, part /= 2) {
    try {
      const PerParticle3 w = from.w + part * dw;
      const PerParticle3 residual = residual_of(system, stage, w, work);
      const double norm = norm_of(residual, system.inverse_mass);
      const double before = product(from.residual, dw), after = product(residual, dw);
      if (norm < (1 - min_decrease * part) * from.norm || before + after > min_decrease * before)
        return {w, residual, norm, true};
    } catch (const DegenerateElement&) {  // too far: a triangle lost its area on the way
    }
  }
  return {from.w, from.residual, from.norm, false};
}

/// The Newton step by conjugate gradients, from the elastic derivative only: exact where it is
/// definite, else semidefinite element by element.
PerParticle3 symmetric_step(const System& system, const Stage& stage, const Trial& from,
                            Work& work) {
  const State at = state_of(stage, from.w);
  const auto damping = damping_at(system.forces, at, work);
  const SolverSettings settings{forcing, system.solver.max_iterations, ResidualScale::momentum};
  PerParticle3 dw;
  for (const Definiteness definiteness : {Definiteness::exact, Definiteness::semidefinite}) {
    const ForceDifferential stiffness =
        elastic_differential_at(system.forces, at, definiteness, work);
    const NewtonMatrix A{system.mass, system.inverse_mass, *damping, stiffness, stage.s};
    if (!solve_newton_step(A, settings, from.residual, dw, work).indefinite) break;
  }
  return dw;
}

/// The Newton step with the exact derivative of all forces, which is no longer symmetric. Empty if
/// the solve did not finish or if the step leads uphill.
std::optional<PerParticle3> exact_step(const System& system, const Stage& stage, const Trial& from,
                                       Work& work) {
  const State at = state_of(stage, from.w);
  const ForceDifferential derivative = force_differential_at(system.forces, at, work);
  if (derivative.symmetric) return {};
  const auto damping = damping_at(system.forces, at, work);
  const SolverSettings settings{forcing, system.solver.max_iterations, ResidualScale::momentum};
  PerParticle3 dw;
  const NewtonMatrix A{system.mass, system.inverse_mass, *damping, derivative, stage.s};
  const SolveResult solve = solve_unsymmetric_step(A, settings, from.residual, dw, work);
  if (!solve.converged || !(product(from.residual, dw) > 0)) return {};
  return dw;
}

/// One iteration of Newton's method. Where damping or current weighting makes the derivative
/// unsymmetric, the exact step is tried first; the symmetric one takes over where that fails, far
/// from the solution.
Trial newton_step(const System& system, const Stage& stage, const Trial& from, Work& work) {
  if (const std::optional<PerParticle3> dw = exact_step(system, stage, from, work)) {
    const Trial to = line_search(system, stage, from, *dw, work);
    if (to.is_improved) return to;
  }
  return line_search(system, stage, from, symmetric_step(system, stage, from, work), work);
}

/// The stage equation with the forces linearised about the state `now`, the elastic
/// derivative semidefinite:
///   (M - s D - s^2 K) dw = s (F + D w + K (X + s w - x)) - M (w - V),
/// minus the contribution of prescribed particles.
/// w: on entry the velocity to start from with the known velocities written in, on exit w + dw.
SolveResult solve_linearised(const System& system, const State& now, const Stage& stage,
                             const SolverSettings& settings, PerParticle3& w, Work& work) {
  const auto damping = damping_at(system.forces, now, work);
  const ForceDifferential stiffness =
      elastic_differential_at(system.forces, now, Definiteness::semidefinite, work);
  PerParticle3 force = elastic_forces(system.forces, now, work);
  damping->add_product(w, force);
  PerParticle3 displacement = stage.X - now.x + stage.s * w;
  stiffness.add_product(displacement, force);
  ++work.damping_products, ++work.stiffness_products;
  PerParticle3 impulse = stage.s * force - (w - stage.V) * system.mass.asDiagonal();
  for (const PrescribedParticle& p : system.prescribed) impulse.col(p.particle).setZero();

  PerParticle3 dw;
  const NewtonMatrix start_matrix{system.mass, system.inverse_mass, *damping, stiffness, stage.s};
  const SolveResult solve = solve_newton_step(start_matrix, settings, impulse, dw, work);
  w += dw;
  return solve;
}

/// Bound on the change of the residual by rounding of the positions alone [kg^1/2 m/s]: forces
/// change by a bound on the stiffness times a rounding of the largest coordinate.
double rounding_at(const System& system, const Stage& stage, const PerParticle3& w,
                   const Work& work) {
  const State at = state_of(stage, w);
  const PerParticle rows = stiffness_row_bounds(system.forces, at, StickingPart::all, work);
  const double rounding = std::numeric_limits<double>::epsilon() * at.x.cwiseAbs().maxCoeff();
  return stage.s * rounding * std::sqrt(rows.cwiseAbs2().dot(system.inverse_mass));
}

/// Newton's method from a trial, until its residual is `target_norm` [kg^1/2 m/s] or
/// nothing improves it.
Trial solve_newton(const System& system, const Stage& stage, Trial at, double target_norm,
                   Work& work) {
  for (int i = 0; at.norm > target_norm && at.is_improved && i < max_newton_iterations; ++i) {
    at = newton_step(system, stage, at, work);
    ++work.newton_iterations;
  }
  return at;
}

Trial trial_at(const System& system, const Stage& stage, const PerParticle3& w, Work& work) {
  const PerParticle3 residual = residual_of(system, stage, w, work);
  return {w, residual, norm_of(residual, system.inverse_mass), true};
}

/// Solves the linearised stage equation from the start's velocity, to the accuracy of a Newton
/// step. If a triangle loses its area there, returns the start, marked as not improved.
Trial linearised_trial(const System& system, const State& now, const Stage& stage,
                       const Trial& start, Work& work) {
  PerParticle3 w = start.w;
  solve_linearised(system, now, stage,
                   {forcing, system.solver.max_iterations, ResidualScale::momentum}, w, work);
  try {
    return trial_at(system, stage, w, work);
  } catch (const DegenerateElement&) {
    return {start.w, start.residual, start.norm, false};
  }
}

/// Solves the stage equation by Newton's method with a line search, starting from the current
/// velocity. It stops at a residual of the solver's tolerance times the momentum and impulse at
/// that velocity, or at the rounding error of the positions. If it does not converge, it starts
/// again from the linearised step: in a long step the current velocity may lead far from the
/// solution. Prescribed particles have their positions and velocities at the stage's time.
PerParticle3 solve_stage(const System& system, const State& now, Stage& stage, Work& work) {
  PerParticle3 w = now.v;
  impose(velocities_at(system.prescribed, stage.time), w);
  for (const PrescribedParticle& p : system.prescribed)
    stage.X.col(p.particle) =
        position_at(p.motion, p.start, stage.time) - stage.s * w.col(p.particle);

  const Trial start = trial_at(system, stage, w, work);
  const double size = start.norm + norm_of(w * system.mass.asDiagonal(), system.inverse_mass);
  const double target_norm =
      std::max(system.solver.tolerance * size, rounding_at(system, stage, w, work));
  Trial end = solve_newton(system, stage, start, target_norm, work);
  if (!(end.norm <= target_norm)) {
    const Trial again = solve_newton(
        system, stage, linearised_trial(system, now, stage, start, work), target_norm, work);
    if (again.norm < end.norm) end = again;
  }
  if (!(end.norm <= target_norm)) ++work.unfinished_solves;
  update_worst(work.worst_residual,
               target_norm > 0 ? system.solver.tolerance * end.norm / target_norm : end.norm);
  return end.w;
}

}  // namespace

State backward_euler(const System& system, std::span<const State> past, double h, Work& work) {
  const State& now = past.back();
  Stage stage{now.time + h, now.x, now.v, h, now.bonds};
  const PerParticle3 w = solve_stage(system, now, stage, work);
  return finish_step(system, now, h, {w, w}, work);
}

State linearised_backward_euler(const System& system, std::span<const State> past, double h,
                                Work& work) {
  const State& now = past.back();
  PerParticle3 w = now.v;
  impose(mean_velocities(system.prescribed, now.x, now.time, h), w);
  const Stage stage{now.time + h, now.x, now.v, h, now.bonds};
  const SolveResult solve = solve_linearised(system, now, stage, system.solver, w, work);
  if (!solve.converged) ++work.unfinished_solves;
  update_worst(work.worst_residual, solve.residual);
  return finish_step(system, now, h, {w, w}, work);
}

State implicit_midpoint(const System& system, std::span<const State> past, double h, Work& work) {
  const State& now = past.back();
  Stage stage{now.time + h / 2, now.x, now.v, h / 2, now.bonds};
  const PerParticle3 w = solve_stage(system, now, stage, work);
  return finish_step(system, now, h, {w, 2 * w - now.v}, work);
}

State bdf2(const System& system, std::span<const State> past, double h, Work& work) {
  if (past.size() < 2) return implicit_midpoint(system, past, h, work);
  const State &now = past.back(), &before = past[past.size() - 2];

  // x_{n+1} = (1 + p) x_n - p x_{n-1} + s w, the same for v, with r = h/h_before, p = r^2/(1 + 2
  // r), s = h (1 + r)/(1 + 2 r)
  const double r = h / (now.time - before.time);
  const double p = r * r / (1 + 2 * r), s = h * (1 + r) / (1 + 2 * r);
  Stage stage{now.time + h, now.x + p * (now.x - before.x), now.v + p * (now.v - before.v), s,
              now.bonds};
  const PerParticle3 w = solve_stage(system, now, stage, work);
  return finish_step(system, now, h, {(stage.X + stage.s * w - now.x) / h, w}, work);
}

}  // namespace foldproof
