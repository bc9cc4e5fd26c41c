#include "convergence/work_precision/work_precision.h"

#include <cmath>

#include "convergence/order.h"
#include "convergence/stability/step_matrix.h"
#include "verification/oracles/dense_algebra.h"

namespace foldproof {

namespace {

constexpr double zeta = 20;  // damping ratio
constexpr int levels = 8;    // steps, each half of the one before
constexpr double most = 32;  // h c/2 of the longest step, which is 0.8 of 2/omega

/// x'' = -omega^2 x - c x', overdamped: its slow solution is exp(-rate t).
struct Creeping {
  double omega, c, rate;  // 1/s
};

Creeping creeping(double omega) {
  const double c = 2 * zeta * omega;
  return {omega, c, omega / (zeta + std::sqrt(zeta * zeta - 1))};
}

/// Relative errors of the rate over the steps h [s]: -ln(mu)/(rate h) - 1, mu the step matrix's
/// eigenvalue next to exp(-rate h).
Convergence rate_errors(const Subject& subject, const std::string& scheme) {
  const SteppedMotion of = stepped_motion(subject, hinge_oscillator(zeta), scheme);
  const Creeping motion = creeping(of.motion.omega0);
  Convergence errors;
  for (int level = 0; level < levels; ++level) {
    const double h = 2 * most / motion.c / (1 << level), expected = std::exp(-motion.rate * h);
    const Eigen::VectorXcd values = oracles::eigenvalues(step_matrix(of, {h, h}));
    Eigen::Index next = 0;
    (values.array() - expected).abs().minCoeff(&next);
    errors.steps.push_back(h);
    errors.errors.push_back(std::abs(std::log(values[next].real()) / (-motion.rate * h) - 1));
  }
  return errors;
}

// On the slow solution v = -(k/c)(1 + d) x with d of the order k/c^2. With a = h c/2,
// C's move is h v~,
//   v~ = (v - h/2 k x)/(1 + a) = -(k/c) x (1 + d/(1 + a)),
// so that x is multiplied by 1 - h (k/c)(1 + d/(1 + a)) where exp(-h (k/c)(1 + d)) is exact. To
// second order in k/c, with d = k/c^2 = (k/c)(h/2)/a, the rate comes out too large by (k/c)^2 (h/2)
// a/(1 + a): of second order in h where a is small, of first order where it is large.
double derived_error(const Creeping& motion, double h) {
  const double a = h * motion.c / 2, slow = motion.omega * motion.omega / motion.c;
  return slow * slow * h / 2 * a / (1 + a) / motion.rate;
}

std::vector<double> dampings_of(const Convergence& errors, const Creeping& motion) {
  std::vector<double> a;
  for (const double h : errors.steps) a.push_back(h * motion.c / 2);
  return a;
}

NamedFinding as_derived(const Convergence& errors, const Creeping& motion) {
  Worst worst;
  std::vector<double> derived, orders = pair_orders(errors);
  orders.insert(orders.begin(), nan);
  for (size_t i = 0; i < errors.steps.size(); ++i) {
    derived.push_back(derived_error(motion, errors.steps[i]));
    worst.observe(std::abs(errors.errors[i] / derived.back() - 1));
  }
  return {"work-precision.slow-motion-is-first-order.C",
          "Under heavy damping C's error on the slow motion is that of a method of first order, "
          "unless the step resolves the damping.",
          {{worst.value(), 0.05, 0, "1",
            "the derivation leaves out the square of the rate times the step, a twenty-fifth at "
            "the longest step"},
           {{"h c/2", "1", dampings_of(errors, motion)},
            {"relative error of the rate", "1", errors.errors},
            {"derived", "1", derived},
            {"order of the pair", "1", orders}},
           "measured is the largest relative deviation from the derived error, (k/c)^2 (h/2) a/(1 "
           "+ a) with a = h c/2: of first order in h for a above one, of second below"}};
}

NamedFinding keeps_its_order(const Convergence& errors, const Creeping& motion) {
  Worst worst;
  std::vector<double> orders = pair_orders(errors);
  for (const double order : orders) worst.observe(std::abs(order - 2));
  orders.insert(orders.begin(), nan);
  return {"work-precision.slow-motion-is-second-order.A",
          "However large the damping, A's error on the slow motion is of second order in the step.",
          {{worst.value(), 0.1, 0, "1", "a method of first order is off by 1"},
           {{"h c/2", "1", dampings_of(errors, motion)},
            {"relative error of the rate", "1", errors.errors},
            {"order of the pair", "1", orders}},
           "measured is the largest |order - 2| of all pairs, from h c/2 = 32 down"}};
}

}  // namespace

void add_slow_motion(const Subject& subject, StudyResult& result) {
  Figure figure{"slow-motion",
                "Slow motion under heavy damping",
                {"h c/2", "1", Scale::log},
                {"relative error of the rate", "1", Scale::log},
                nan,
                "An oscillator with a damping ratio of 20 creeps home; the rate under each scheme "
                "against the exact one. C moves with a velocity that belongs to the start of the "
                "step once the damping is not resolved.",
                {}};
  const Creeping motion = creeping(hinge_oscillator(zeta).omega0);
  for (const std::string scheme : {"A", "B", "C"}) {
    const Convergence errors = rate_errors(subject, scheme);
    if (scheme == "A") result.findings.push_back(keeps_its_order(errors, motion));
    if (scheme == "C") result.findings.push_back(as_derived(errors, motion));
    // C's own goes from 2 to 1
    figure.curves.push_back({scheme, dampings_of(errors, motion), errors.errors, nan,
                             pair_orders(errors), scheme == "A" ? 2 : nan});
  }
  result.figures.push_back(std::move(figure));
}

}  // namespace foldproof
