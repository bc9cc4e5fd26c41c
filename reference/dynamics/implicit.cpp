#include "reference/dynamics/implicit.h"

#include <cmath>

#include "reference/dynamics/end_of_step.h"
#include "reference/forces/degenerate.h"

namespace foldproof {

namespace {

constexpr int most_newton_iterations = 60, most_halvings = 12;
constexpr double forcing = 1e-3;         // relative residual to which a Newton step is solved
constexpr double least_decrease = 1e-4;  // of the residual or of the work left, as a part of the step taken

/// The stage equation's data: see the header.
struct Stage {
  double time;     // t [s]
  PerParticle3 X;  // 3 x N [m]
  PerParticle3 V;  // 3 x N [m/s]
  double s;        // s
};

State state_of(const Stage& stage, const PerParticle3& w) { return {stage.time, stage.X + stage.s * w, w}; }

double norm_of(const PerParticle3& momentum, const PerParticle& inverse_mass) {
  return std::sqrt(momentum.colwise().squaredNorm().dot(inverse_mass.transpose()));
}

/// s (F + D w) - M (w - V) at free particles, 0 at prescribed ones [kg m/s].
PerParticle3 residual_of(const System& system, const Stage& stage, const PerParticle3& w, Work& work) {
  const State at = state_of(stage, w);
  PerParticle3 force = elastic_forces(system.forces, at, work);
  damping_at(system.forces, at, work).add_product(w, force);
  ++work.damping_products;
  PerParticle3 residual = stage.s * force - (w - stage.V) * system.mass.asDiagonal();
  for (const PrescribedParticle& p : system.led) residual.col(p.particle).setZero();
  return residual;
}

/// A Newton step from w: the exact derivative, or where that is indefinite the semidefinite one. The change of
/// D with the positions is left out, since it is not symmetric. That costs iterations, not accuracy, for the
/// residual is the true one: convergence is linear, the slower the more the cloth turns within a damped step.
PerParticle3 newton_step(const System& system, const Stage& stage, const PerParticle3& w,
                         const PerParticle3& residual, Work& work) {
  const State at = state_of(stage, w);
  const DampingOperator damping = damping_at(system.forces, at, work);
  const SolverSettings settings{forcing, system.solver.max_iterations, ResidualScale::momentum};
  PerParticle3 dw;
  for (const Definiteness definiteness : {Definiteness::exact, Definiteness::semidefinite}) {
    const ElasticDifferential stiffness = elastic_differential_at(system.forces, at, definiteness, work);
    const NewtonMatrix A{system.mass, system.inverse_mass, damping, stiffness, stage.s};
    if (!solve_newton_step(A, settings, residual, dw, work).indefinite) break;
  }
  return dw;
}

/// Where a line search ended.
struct Trial {
  PerParticle3 w, residual;
  double norm;
  bool better;  // than where it started
};

double product(const PerParticle3& a, const PerParticle3& b) { return a.cwiseProduct(b).sum(); }

/// Halves the step until the residual falls, or until the residual's work along the step, by the trapezoidal
/// rule, is positive: then the step leads downhill in the potential of which the residual is minus the
/// gradient (the damping's part has none), though the residual itself may have to rise on the way. Gives up
/// after a dozen halvings.
Trial search(const System& system, const Stage& stage, const Trial& from, const PerParticle3& dw,
             Work& work) {
  double part = 1;
  for (int i = 0; i < most_halvings; ++i, part /= 2) {
    try {
      const PerParticle3 w = from.w + part * dw;
      const PerParticle3 residual = residual_of(system, stage, w, work);
      const double norm = norm_of(residual, system.inverse_mass);
      const double before = product(from.residual, dw), after = product(residual, dw);
      if (norm < (1 - least_decrease * part) * from.norm || before + after > least_decrease * before)
        return {w, residual, norm, true};
    } catch (const DegenerateElement&) {  // too far: a triangle lost its area on the way
    }
  }
  return {from.w, from.residual, from.norm, false};
}

/// Solves the stage equation from the guess w by Newton's method with a line search, until the residual is the
/// solver's tolerance times the momentum of the guess and the impulse at it. Prescribed particles are where
/// they are at the stage's time, and as fast.
PerParticle3 solve_stage(const System& system, Stage& stage, PerParticle3 w, Work& work) {
  impose(velocities_at(system.led, stage.time), w);
  for (const PrescribedParticle& p : system.led)
    stage.X.col(p.particle) = position_at(p.motion, p.start, stage.time) - stage.s * w.col(p.particle);

  Trial at{w, residual_of(system, stage, w, work), 0, true};
  at.norm = norm_of(at.residual, system.inverse_mass);
  const PerParticle3 momentum = w * system.mass.asDiagonal();
  const double scale = at.norm + norm_of(momentum, system.inverse_mass);
  const double enough = system.solver.tolerance * scale;

  int iterations = 0;
  while (at.norm > enough && at.better && iterations < most_newton_iterations) {
    const PerParticle3 dw = newton_step(system, stage, at.w, at.residual, work);
    at = search(system, stage, at, dw, work);
    ++iterations;
  }
  work.newton_iterations += iterations;
  if (!(at.norm <= enough)) ++work.unfinished_solves;
  keep_worst(work.worst_residual, scale > 0 ? at.norm / scale : at.norm);
  return at.w;
}

}  // namespace

State backward_euler(const System& system, std::span<const State> past, double h, Work& work) {
  const State& now = past.back();
  Stage stage{now.time + h, now.x, now.v, h};
  const PerParticle3 w = solve_stage(system, stage, now.v, work);
  return end_of_step(system, now, h, {w, w}, work);
}

State linearised_backward_euler(const System& system, std::span<const State> past, double h, Work& work) {
  const State& now = past.back();
  PerParticle3 w = now.v;
  impose(mean_velocities(system.led, now.x, now.time, h), w);

  // (M - h D - h^2 K) dw = h (F(x_n) + D w + h K w), less the impulse that prescribed particles ask for
  const DampingOperator damping = damping_at(system.forces, now, work);
  const ElasticDifferential stiffness =
      elastic_differential_at(system.forces, now, Definiteness::semidefinite, work);
  PerParticle3 force = elastic_forces(system.forces, now, work);
  damping.add_product(w, force);
  PerParticle3 moved = h * w;
  stiffness.add_product(moved, force);
  ++work.damping_products, ++work.stiffness_products;
  PerParticle3 impulse = h * force;
  for (const PrescribedParticle& p : system.led) impulse.col(p.particle).setZero();

  PerParticle3 dw;
  const NewtonMatrix A{system.mass, system.inverse_mass, damping, stiffness, h};
  const Solve solve = solve_newton_step(A, system.solver, impulse, dw, work);
  if (!solve.converged) ++work.unfinished_solves;
  keep_worst(work.worst_residual, solve.residual);
  w += dw;
  return end_of_step(system, now, h, {w, w}, work);
}

State implicit_midpoint(const System& system, std::span<const State> past, double h, Work& work) {
  const State& now = past.back();
  Stage stage{now.time + h / 2, now.x, now.v, h / 2};
  const PerParticle3 w = solve_stage(system, stage, now.v, work);
  return end_of_step(system, now, h, {w, 2 * w - now.v}, work);
}

State bdf2(const System& system, std::span<const State> past, double h, Work& work) {
  if (past.size() < 2) return implicit_midpoint(system, past, h, work);
  const State &now = past.back(), &before = past[past.size() - 2];

  // x_{n+1} = (1 + p) x_n - p x_{n-1} + s w, the same for v, with r = h/h_before, p = r^2/(1 + 2 r),
  // s = h (1 + r)/(1 + 2 r)
  const double r = h / (now.time - before.time);
  const double p = r * r / (1 + 2 * r), s = h * (1 + r) / (1 + 2 * r);
  Stage stage{now.time + h, now.x + p * (now.x - before.x), now.v + p * (now.v - before.v), s};
  const PerParticle3 w = solve_stage(system, stage, now.v, work);
  return end_of_step(system, now, h, {(stage.X + stage.s * w - now.x) / h, w}, work);
}

}  // namespace foldproof
