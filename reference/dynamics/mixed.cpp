#include "reference/dynamics/mixed.h"

#include "reference/dynamics/conjugate_gradient.h"
#include "reference/fast/vectors.h"

namespace foldproof {

namespace {

/// v + h/2 M^{-1} (F_elastic + D v); prescribed particles keep v.
PerParticle3 explicit_half_step(const System& system, const Forces& at, const PerParticle3& v,
                                double h, Work& work) {
  PerParticle3 force = *at.elastic;
  at.damping->add_product(v, force);
  ++work.damping_products;
  return kicked(system.team, v, h / 2, force, system.inverse_mass);
}

/// Solves w = v + h/2 M^{-1} (F_elastic + D w) for w, with the known velocities imposed.
PerParticle3 implicit_half_step(const System& system, const Forces& at, const PerParticle3& v,
                                const std::vector<KnownVelocity>& known, double h, Work& work) {
  PerParticle3 w = kicked(system.team, v, h / 2, *at.elastic, system.inverse_mass);
  impose(known, w);
  solve_velocity(system, *at.damping, h / 2, w, work);
  return w;
}

/// The state h [s] later, with the positions moved by the velocity v at the middle of the step, and
/// that velocity extrapolated to the end. None of the paper's forces depends on it.
State moved(const System& system, const State& now, const PerParticle3& v, double h) {
  return {now.time + h, moved(system.team, now.x, h, v), 2 * v - now.v, now.bonds};
}

}  // namespace

State mixed_explicit_implicit(const System& system, std::span<const State> past, double h,
                              Work& work) {
  const State& now = past.back();
  const double end = now.time + h;
  const Forces here = forces_at(system.forces, now, work);

  // position: leapfrog with the explicit half-step velocity, once it has been modified
  const PerParticle3 v_half = explicit_half_step(system, here, now.v, h, work);
  PerParticle3 v_move = v_half;
  impose(mean_velocities(system.prescribed, now.x, now.time, h), v_move);
  correct(system.filters, {now.time, end, h}, now, v_move, work);
  State next = moved(system, now, v_move, h);

  // velocity: trapezoidal rule, continued from the half-step velocity before its modification
  const Forces there = forces_at(system.forces, next, work);
  next.v =
      implicit_half_step(system, there, v_half, velocities_at(system.prescribed, end), h, work);
  correct(system.filters, {end, end, h}, next, next.v, work);
  return next;
}

State central_newmark(const System& system, std::span<const State> past, double h, Work& work) {
  const State& now = past.back();
  const double end = now.time + h;
  const Forces here = forces_at(system.forces, now, work);

  // position: move with a velocity that is implicit in the damping
  PerParticle3 v_half = implicit_half_step(
      system, here, now.v, mean_velocities(system.prescribed, now.x, now.time, h), h, work);
  correct(system.filters, {now.time, end, h}, now, v_half, work);
  State next = moved(system, now, v_half, h);

  // velocity: the rest of the step, explicit, from the modified half-step velocity
  const Forces there = forces_at(system.forces, next, work);
  next.v = explicit_half_step(system, there, v_half, h, work);
  impose(velocities_at(system.prescribed, end), next.v);
  return next;
}

State variable_step_newmark(const System& system, std::span<const State> past, double h,
                            Work& work) {
  const State& now = past.back();
  const double end = now.time + h;
  const Forces here = forces_at(system.forces, now, work);

  // position: move with a velocity that is implicit in the damping, as in scheme B
  PerParticle3 v_move = implicit_half_step(
      system, here, now.v, mean_velocities(system.prescribed, now.x, now.time, h), h, work);
  correct(system.filters, {now.time, end, h}, now, v_move, work);
  State next = moved(system, now, v_move, h);

  // velocity: trapezoidal rule from v_n, as in scheme A
  const PerParticle3 v_half = explicit_half_step(system, here, now.v, h, work);
  const Forces there = forces_at(system.forces, next, work);
  next.v =
      implicit_half_step(system, there, v_half, velocities_at(system.prescribed, end), h, work);
  correct(system.filters, {end, end, h}, next, next.v, work);
  return next;
}

}  // namespace foldproof
