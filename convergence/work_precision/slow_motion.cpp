#include "convergence/work_precision/work_precision.h"

#include <cmath>

#include "convergence/order.h"
#include "convergence/ranges.h"
#include "convergence/tables.h"
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
Table rate_errors(const Subject& subject, const std::string& scheme) {
  const SteppedMotion of = stepped_motion(subject, hinge_oscillator(zeta), scheme);
  const Creeping motion = creeping(of.motion.omega0);
  return refine({{"h", "s"}, {"h c/2", "1"}, {"relative error of the rate", "1"}},
                halving_range(2 * most / motion.c, levels), [&](double h) {
                  const double expected = std::exp(-motion.rate * h);
                  const Eigen::VectorXcd values = oracles::eigenvalues(step_matrix(of, {h, h}));
                  Eigen::Index next = 0;
                  (values.array() - expected).abs().minCoeff(&next);
                  return std::tuple{
                      h, h * motion.c / 2,
                      std::abs(std::log(values[next].real()) / (-motion.rate * h) - 1)};
                });
}

Convergence errors_of(const Table& rates) {
  return convergence_of(rates, "relative error of the rate");
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

NamedFinding as_derived(const Table& rates, const Creeping& motion) {
  std::vector<double> derived;
  for (const double h : rates.numbers("h")) derived.push_back(derived_error(motion, h));
  Table evidence = with_columns(rates, {"h c/2", "relative error of the rate"});
  evidence.add({"derived", "1", derived});
  evidence.add({"order of the pair", "1", row_orders(errors_of(rates))});
  return {"work-precision.slow-motion-is-first-order.C",
          "At a damping ratio of 20, C's error on the slow motion is that of a method of first "
          "order, unless the step resolves the damping.",
          {{largest_deviation(evidence, "relative error of the rate", "derived"), 0.05, 0, "1",
            "the derivation leaves out the square of the rate times the step, a twenty-fifth at "
            "the longest step"},
           evidence,
           "measured is the largest relative deviation from the derived error, (k/c)^2 (h/2) a/(1 "
           "+ a) with a = h c/2: of first order in h for a above one, of second below"}};
}

NamedFinding keeps_its_order(const Table& rates) {
  Worst worst;
  for (const double order : pair_orders(errors_of(rates))) worst.observe(std::abs(order - 2));
  Table evidence = with_columns(rates, {"h c/2", "relative error of the rate"});
  evidence.add({"order of the pair", "1", row_orders(errors_of(rates))});
  return {"work-precision.slow-motion-is-second-order.A",
          "At a damping ratio of 20, A's error on the slow motion is of second order in the step, "
          "whether or not the step resolves the damping.",
          {{worst.value(), 0.1, 0, "1", "a method of first order is off by 1"},
           evidence,
           "measured is the largest |order - 2| of all pairs, from h c/2 = 32 down"}};
}

}  // namespace

void add_slow_motion(const Subject& subject, StudyResult& result) {
  Figure figure{"slow-motion",
                "Slow motion under heavy damping",
                {"h c/2", "1", Scale::log},
                {"relative error of the rate", "1", Scale::log},
                nan,
                "An oscillator with a damping ratio of 20 creeps to rest: the rate under each "
                "scheme against the exact one. Once the step does not resolve the damping, C moves "
                "with a velocity that belongs to the step's start.",
                {}};
  const Creeping motion = creeping(hinge_oscillator(zeta).omega0);
  for (const std::string scheme : {"A", "B", "C"}) {
    const Table rates = rate_errors(subject, scheme);
    if (scheme == "A") result.findings.push_back(keeps_its_order(rates));
    if (scheme == "C") result.findings.push_back(as_derived(rates, motion));
    Curve curve = curve_of(scheme, rates, "h c/2", "relative error of the rate");
    curve.pair_orders = pair_orders(errors_of(rates));
    curve.slope = scheme == "A" ? 2 : nan;  // C's own goes from 2 to 1
    figure.curves.push_back(std::move(curve));
  }
  result.figures.push_back(std::move(figure));
}

}  // namespace foldproof
