// The schemes on one oscillator, where each is a 2 x 2 matrix.
#include "reference/dynamics/integrator.h"
#include "verification/oracles/dense_algebra.h"
#include "verification/oracles/exact_solutions.h"
#include "verification/specimens/check.h"
#include "verification/specimens/random.h"
#include "verification/specimens/stepper.h"

namespace foldproof {

namespace {

using oracles::Oscillator;
using oracles::Scheme;

Scheme scheme_named(const std::string& integrator) {
  if (integrator == "A") return Scheme::mixed;
  if (integrator == "B") return Scheme::central_newmark;
  if (integrator == "C") return Scheme::variable_step_newmark;
  throw NotOffered{"a derived step matrix for integrator " + integrator};
}

/// One particle with x'' = -k x - c x' in every direction; it weighs 1/4 kg, so that the mass adds
/// no rounding.
System oscillator_system(const Oscillator& oscillator) {
  const double m = 0.25, k = oscillator.stiffness, c = oscillator.damping;
  System system = make_system(PerParticle::Constant(1, m));
  CustomForce force;
  force.elastic = [m, k](const State& s, PerParticle3& f) { f -= m * (k * s.x); };
  force.damping = [=](const State&) -> DampingOperator::Custom {
    return {[=](const PerParticle3& v, PerParticle3& f) { f -= m * (c * v); }, {}};
  };
  system.forces.push_back(force);
  system.solver.tolerance = 1e-15;
  system.solver.max_iterations = 3;  // one iteration suffices: D is a multiple of M
  return system;
}

State one_particle(double x, double v) {
  return {0, PerParticle3(Vector3(x, 0, 0)), PerParticle3(Vector3(v, 0, 0))};
}

/// The reference's step matrix, from steps of the two unit vectors.
Eigen::Matrix2d stepped_matrix(const std::string& integrator, const Oscillator& oscillator,
                               double h) {
  const System system = oscillator_system(oscillator);
  const State from_x = step_once(integrator, system, one_particle(1, 0), h);
  const State from_v = step_once(integrator, system, one_particle(0, 1), h);
  Eigen::Matrix2d matrix;
  matrix << from_x.x(0, 0), from_v.x(0, 0), from_x.v(0, 0), from_v.v(0, 0);
  return matrix;
}

Finding verlet_finding(const std::string& integrator) {
  const std::vector<std::pair<Oscillator, double>> cases = {
      {{27.25, 0, 0.6875, -1.84375}, 0.140625}, {{11.375, 0, -0.40625, 0.78125}, 0.53125}};
  Table errors{{"omega h", "1"}, {"error over amplitude", "1"}};
  for (const auto& [oscillator, h] : cases) {
    const System system = oscillator_system(oscillator);
    const double omega = std::sqrt(oscillator.stiffness),
                 speed = omega * std::cos(std::asin(omega * h / 2));
    const double amplitude = std::hypot(oscillator.x0, oscillator.v0 / speed);
    Worst here;
    State s = one_particle(oscillator.x0, oscillator.v0);
    for (int n = 1; n <= 1000; ++n) {
      s = step_once(integrator, system, s, h);
      if (n % 9 != 1) continue;  // step 1,000 included; 50 digits are slow
      const oracles::OscillatorEstimate exact = oracles::verlet_oscillator(oscillator, h, n);
      here.observe(std::abs(s.x(0, 0) - exact.x.value) / amplitude);
      here.observe(std::abs(s.v(0, 0) - exact.v.value) / (amplitude * speed));
    }
    errors.row(omega * h, here.value());
  }
  return {
      {errors.worst("error over amplitude"), 4e-14, 2 * epsilon, "1",
       "1,000 steps of five roundings that add up like a random walk: sqrt(5000)/2 = 35 epsilon of "
       "the amplitude, and up to five times that at the worst step near the stability limit. The "
       "constants have few bits, so that no rounding is the same in every step"},
      errors};
}

/// Sums of the absolute values of the terms in each entry of the step matrix, including explicit
/// guesses.
Eigen::Matrix2d term_sizes(const std::string& integrator, const Oscillator& oscillator, double h) {
  const double a = h * oscillator.damping / 2, b = h * h * oscillator.stiffness / 2;
  const double first = integrator == "A" ? 1 + a : 1;  // coefficient of v in the moving velocity
  Eigen::Matrix2d sizes;
  sizes << 1 + b, h * first, b / h * (2 + a + b), (1 + a) + b * first;
  if (integrator == "B") sizes(1, 1) = (1 + a) + b;
  return sizes;
}

Finding matrix_finding(const std::string& integrator) {
  const Scheme scheme = scheme_named(integrator);
  Random random(12);
  Table errors{{"h c/2", "1"}, {"h^2 k/2", "1"}, {"error", "epsilon of the terms"}};
  for (int n = 0; n < 300; ++n) {
    const double h = random.log_uniform(1e-4, 0.7), a = random.log_uniform(3e-3, 300),
                 b = random.log_uniform(2e-3, 9);
    const Oscillator oscillator{2 * b / (h * h), 2 * a / h, 0, 0};
    const Eigen::Matrix2d error =
        stepped_matrix(integrator, oscillator, h) - oracles::step_matrix(scheme, oscillator, h);
    const Eigen::Matrix2d sizes = term_sizes(integrator, oscillator, h);
    Worst here;
    for (int k = 0; k < 4; ++k) here.observe(std::abs(error(k)) / (epsilon * sizes(k)));
    errors.row(a, b, here.value());
  }
  return {{errors.worst("error"), 16, 0.5, "epsilon of the terms",
           "about twenty roundings lie between the unit vector and an entry, half an epsilon each, "
           "and one correction of the solve"},
          errors};
}

double spectral_radius(const Eigen::Matrix2d& matrix) {
  return oracles::eigenvalues(matrix).cwiseAbs().maxCoeff();
}

Finding stability_finding(const std::string& integrator) {
  constexpr double threshold = 1e-10;
  const Scheme scheme = scheme_named(integrator);
  const std::vector<double> over_limit = {0.03,     0.21,     0.57, 0.83, 0.97,
                                          1 - 1e-6, 1 + 1e-6, 1.04, 1.37, 2.9};
  Random random(23);
  double misjudged = 0;
  Table wrong{{"damping ratio", "1"}, {"steps misjudged", "1"}};
  for (int n = 0; n < 60; ++n) {
    const double k = random.log_uniform(0.3, 3000),
                 ratio = n % 10 == 0 ? 0 : random.log_uniform(0.003, 30);
    const Oscillator oscillator{k, 2 * ratio * std::sqrt(k), 0, 0};
    const double limit = oracles::largest_stable_step(scheme, oscillator).value;
    int here = 0;
    for (double part : over_limit) {
      const double radius = spectral_radius(stepped_matrix(integrator, oscillator, part * limit));
      const bool right = part < 1 ? radius <= 1 + threshold : radius > 1 + threshold;
      if (!right) ++here;
    }
    misjudged += here;
    wrong.row(ratio, here);
  }
  return {{misjudged, 0, 0, "1",
           "a step is stable if the spectral radius is at most 1 + 1e-10: rounding moves it by "
           "1e-13 at most, and a millionth beyond the limit it exceeds 1 by 1e-8 at least"},
          wrong};
}

Finding pure_damping_finding(const std::string& integrator) {
  const double c = 7.3, v0 = -0.83;
  Worst worst;
  Table totals{{"h c/2", "1"}, {"displacement over exact", "1"}};
  for (double a : {0.11, 0.37, 0.94, 2.7, 10.0, 23.0}) {
    const double h = 2 * a / c, expected = integrator == "A" ? 1 - a * a : 1;
    const System system = oscillator_system({0, c, 0, 0});
    // the velocity decays by e^-40
    const int steps = int(std::ceil(40 / -std::log(std::abs((1 - a) / (1 + a)))));
    State s = one_particle(0, v0);
    double path = 0;
    for (int n = 0; n < steps; ++n) {
      const double before = s.x(0, 0);
      s = step_once(integrator, system, s, h);
      path += std::abs(s.x(0, 0) - before);
    }
    const double total = s.x(0, 0) / (v0 / c), scale = path / std::abs(v0 / c) * (1 + a);
    worst.observe(std::abs(total - expected) / (epsilon * steps * scale));
    totals.row(a, total);
  }
  return {{worst.value(), 4, 0, "epsilon of the path, a step",
           "each step rounds the position once and the velocity about six times; (1 + h c/2) is "
           "the ratio of the terms to the velocity left after they cancel"},
          totals};
}

}  // namespace

std::vector<Check> oscillator_checks() {
  const std::string source = "BMF03 section 3", derived = "derived from BMF03 section 3";
  std::vector<Check> list;
  add_for_each_scheme(
      list,
      {{"dynamics.undamped-oscillator-matches-velocity-verlet",
        "the reference's undamped oscillator is velocity Verlet's.", source, verlet_finding},
       {"dynamics.step-matrix-is-as-derived",
        "the reference's step on the damped oscillator is the derived matrix.", derived,
        matrix_finding},
       {"dynamics.stability-limit-is-as-derived",
        "the reference is stable on the damped oscillator up to the derived step and not beyond.",
        derived, stability_finding},
       {"dynamics.pure-damping-displacement-is-as-derived",
        "a particle that is only damped travels 1 - (h c/2)^2 times the exact distance in the "
        "reference's A, and the exact distance in B and C.",
        derived, pure_damping_finding}});
  return list;
}

}  // namespace foldproof
