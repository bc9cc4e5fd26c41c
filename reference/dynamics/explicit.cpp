#include "reference/dynamics/explicit.h"

#include <vector>

#include "reference/dynamics/finish_step.h"

namespace foldproof {

namespace {

/// A Butcher tableau. Stage i is evaluated at t + c_i h from the rates of the stages before it,
/// weighted by row i of A; the step uses the weights b.
struct Tableau {
  std::vector<std::vector<double>> A;  // row i has i entries
  std::vector<double> b, c;
};

/// Velocity and acceleration at one stage, 3 x N [m/s], [m/s^2].
struct Rate {
  PerParticle3 velocity, acceleration;
};

Rate rate_at(const System& system, const State& s, Work& work) {
  const Forces at = forces_at(system.forces, s, work);
  PerParticle3 force = *at.elastic;
  at.damping->add_product(s.v, force);
  ++work.damping_products;
  return {s.v, force * system.inverse_mass.asDiagonal()};
}

/// now + h sum_i weights_i rate_i, at the time t [s]; prescribed particles where they are then.
State advance(const System& system, const State& now, double t, const std::vector<double>& weights,
              const std::vector<Rate>& rates, double h) {
  State s{t, now.x, now.v, now.bonds};
  for (size_t i = 0; i < weights.size(); ++i) {
    s.x += h * weights[i] * rates[i].velocity;
    s.v += h * weights[i] * rates[i].acceleration;
  }
  for (const PrescribedParticle& p : system.prescribed)
    s.x.col(p.particle) = position_at(p.motion, p.start, t);
  impose(velocities_at(system.prescribed, t), s.v);
  return s;
}

State runge_kutta(const Tableau& tableau, const System& system, const State& now, double h,
                  Work& work) {
  std::vector<Rate> rates;
  for (size_t i = 0; i < tableau.b.size(); ++i) {
    const double t = now.time + tableau.c[i] * h;
    rates.push_back(rate_at(system, advance(system, now, t, tableau.A[i], rates, h), work));
  }
  PerParticle3 v_move = PerParticle3::Zero(3, now.x.cols());
  for (size_t i = 0; i < rates.size(); ++i) v_move += tableau.b[i] * rates[i].velocity;
  const State end = advance(system, now, now.time + h, tableau.b, rates, h);
  return finish_step(system, now, h, {std::move(v_move), end.v}, work);
}

}  // namespace

State forward_euler(const System& system, std::span<const State> past, double h, Work& work) {
  static const Tableau tableau = {{{}}, {1}, {0}};
  return runge_kutta(tableau, system, past.back(), h, work);
}

State explicit_midpoint(const System& system, std::span<const State> past, double h, Work& work) {
  static const Tableau tableau = {{{}, {0.5}}, {0, 1}, {0, 0.5}};
  return runge_kutta(tableau, system, past.back(), h, work);
}

State ssp_runge_kutta_3(const System& system, std::span<const State> past, double h, Work& work) {
  static const Tableau tableau = {{{}, {1}, {0.25, 0.25}}, {1. / 6, 1. / 6, 2. / 3}, {0, 1, 0.5}};
  return runge_kutta(tableau, system, past.back(), h, work);
}

State runge_kutta_4(const System& system, std::span<const State> past, double h, Work& work) {
  static const Tableau tableau = {
      {{}, {0.5}, {0, 0.5}, {0, 0, 1}}, {1. / 6, 1. / 3, 1. / 3, 1. / 6}, {0, 0.5, 0.5, 1}};
  return runge_kutta(tableau, system, past.back(), h, work);
}

}  // namespace foldproof
