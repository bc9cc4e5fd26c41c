// Motions known in closed form: free fall, a turning pair.
#include "reference/dynamics/integrator.h"
#include "verification/oracles/exact_solutions.h"
#include "verification/specimens/check.h"
#include "verification/specimens/moving_sheets.h"
#include "verification/specimens/stepper.h"

namespace foldproof {

namespace {

Finding free_fall_finding(const Subject& subject, const std::string& integrator) {
  Scene scene = partly_prescribed_sheet();
  scene.prescribed.clear();
  scene.stretch.reset();
  scene.bending.reset();
  Stepper stepper(subject, scene, integrator);
  const State start = stepper.start();
  State s = start;
  Worst worst;
  const int steps = 120;
  for (int n = 0; n < steps; ++n) s = stepper.step(s, n % 3 == 0 ? 0.0171 : 0.0033);
  double uncertainty = 0;
  for (Eigen::Index i = 0; i < s.x.cols(); ++i) {
    const oracles::FallEstimate exact =
        oracles::free_fall({start.x.col(i), start.v.col(i), *scene.gravity}, s.time);
    const double speed = start.v.col(i).norm() + scene.gravity->norm() * s.time;
    const double path_length = start.x.col(i).norm() + speed * s.time;
    worst.observe((s.x.col(i) - exact.x).norm() / (epsilon * path_length));
    worst.observe((s.v.col(i) - exact.v).norm() / (epsilon * speed));
    uncertainty = std::max(uncertainty, 2 * exact.x_uncertainty / (epsilon * path_length));
  }
  return {{worst.value(), 4.0 * steps, uncertainty, "epsilon of the way",
           "120 steps, each of which rounds the velocity three times, the position once and the "
           "time once"},
          {}};
}

struct TurningPair {
  System system;
  State start;
  double length, omega;
};

/// A pre-stretched pair that turns about its centre of mass, steadily in continuous time.
TurningPair turning_pair() {
  const oracles::SpringPair pair{53, 0.31, 0.62, 0.27, 0.43};
  TurningPair turning;
  turning.omega = 6.1;
  turning.length = oracles::steady_rotation_length(pair, turning.omega).value;
  turning.system = make_system(Eigen::Vector2d(pair.mass_a, pair.mass_b));
  const double stiffness = pair.young * pair.area / (pair.rest_length * pair.rest_length);
  const Elements<Spring> springs = {{0, 1, pair.rest_length, stiffness, 0}};
  turning.system.forces.push_back(StretchSprings{springs});

  const Vector3 direction = Vector3(0.3, -0.7, 0.5).normalized();
  const Vector3 spin = turning.omega * direction.cross(Vector3(0.9, 0.2, -0.4)).normalized();
  const double sum = pair.mass_a + pair.mass_b;
  turning.start.x.resize(3, 2);
  turning.start.x.col(0) = -pair.mass_b / sum * turning.length * direction;
  turning.start.x.col(1) = pair.mass_a / sum * turning.length * direction;
  turning.start.v.resize(3, 2);
  for (int i = 0; i < 2; ++i) {
    const Vector3 arm = turning.start.x.col(i);
    turning.start.v.col(i) = spin.cross(arm);
  }
  return turning;
}

/// Largest relative deviation of the length from the steady one over the turns (first, last] [1].
double deviation(const TurningPair& pair, const std::string& integrator, double h, double first,
                 double last) {
  const double turn = 2 * pi / pair.omega;
  State s = pair.start;
  Worst worst;
  while (s.time < last * turn) {
    s = step_once(integrator, pair.system, s, h);
    const double length = (s.x.col(1) - s.x.col(0)).norm();
    if (s.time > first * turn) worst.observe(std::abs(length / pair.length - 1));
  }
  return worst.value();
}

Finding rotation_finding(const std::string& integrator) {
  const TurningPair pair = turning_pair();
  Table deviations("step [s]; deviation of the length [1]; observed order [1]");
  Worst worst;
  double coarser = NAN;
  for (const double h : {8e-3, 4e-3, 2e-3, 1e-3}) {
    const double here = deviation(pair, integrator, h, 0, 6), order = std::log2(coarser / here);
    if (deviations.rows() > 0) worst.observe(std::abs(order - 2));
    deviations.row(h, here, order);
    coarser = here;
  }
  return {{worst.value(), 0.1, 0, "1",
           "second order, two-sided; the next term is of fourth order, (omega h)^2 < 0.03 of the "
           "first"},
          deviations,
          "over six turns"};
}

Finding no_drift_finding(const std::string& integrator) {
  const TurningPair pair = turning_pair();
  const double early = deviation(pair, integrator, 8e-3, 0, 6),
               late = deviation(pair, integrator, 8e-3, 54, 60);
  Table deviations{{"turns", "1"}, {"deviation of the length", "1"}};
  deviations.row("0 to 6", early);
  deviations.row("54 to 60", late);
  return {{late / early - 1, 0.02, 0, "1",
           "the length oscillates for ever about a steady one; steps sample its extremes to 2 %"},
          deviations};
}

/// A particle on a spring whose other end oscillates along it: a linear oscillator driven by a
/// force.
struct DrivenSpring {
  double stiffness = 41, mass = 0.13, rest_length = 0.7;  // N/m, kg, m
  double amplitude = 0.09, frequency = 1.3;               // m, Hz

  System system() const {
    System system = make_system(Eigen::Vector2d(mass, mass));
    const Elements<Spring> springs = {{0, 1, rest_length, stiffness, 0}};
    system.forces.push_back(StretchSprings{springs});
    Motion motion;
    motion.amplitude = Vector3(amplitude, 0, 0);
    motion.frequency = frequency;
    system.prescribed = {{0, Vector3::Zero(), motion}};
    system.inverse_mass[0] = 0;
    return system;
  }

  /// The solution that oscillates with the drive only: the free particle is at rest_length +
  /// response sin(omega t).
  double response() const {
    const double omega = 2 * pi * frequency;
    return amplitude * stiffness / (stiffness - mass * omega * omega);
  }

  State start() const {
    State s;
    s.x = PerParticle3::Zero(3, 2);
    s.v = PerParticle3::Zero(3, 2);
    s.x(0, 1) = rest_length;
    s.v(0, 0) = 2 * pi * frequency * amplitude;
    s.v(0, 1) = 2 * pi * frequency * response();
    return s;
  }

  double error_at(const State& s) const {
    return std::abs(s.x(0, 1) - rest_length - response() * std::sin(2 * pi * frequency * s.time));
  }
};

/// Observed orders with a driven end: each stage must place the end at the stage's own time.
Finding driven_finding() {
  const DrivenSpring driven;
  const System system = driven.system();
  Table measured("method; step [s]; error [m]; order [1]");
  Worst worst;
  for (const char* name : {"RK2", "SSP-RK3", "RK4"}) {
    const int formal = integrator_named(name).order;
    double coarser = NAN;
    for (const int steps : {200, 400, 800}) {
      State s = driven.start();
      for (int n = 0; n < steps; ++n) s = step_once(name, system, s, 0.93 / steps);
      const double error = driven.error_at(s), order = std::log2(coarser / error);
      if (steps > 200) worst.observe(std::abs(order - formal));
      measured.row(name, 0.93 / steps, error, order);
      coarser = error;
    }
  }
  return {{worst.value(), 0.1, 0, "1",
           "two-sided; at two hundred steps a run the next term is below a tenth of the first"},
          measured};
}

}  // namespace

std::vector<Check> exact_motion_checks() {
  const std::string source = "BMF03 section 3";
  std::vector<Check> list;
  add_for_each_scheme(
      list,
      {{"dynamics.free-fall-is-exact", "free fall is exact for any steps.", source,
        free_fall_finding},
       {"dynamics.steady-rotation-keeps-lengths-to-second-order",
        "the length of a steadily turning stretched pair of the reference is kept to second order.",
        source, rotation_finding},
       {"dynamics.steady-rotation-does-not-drift",
        "the length of a turning pair of the reference deviates no more after sixty "
        "turns than after six.",
        source, no_drift_finding}});
  list.push_back({"dynamics.explicit-stages-follow-a-driven-end",
                  "Explicit methods keep their order with a prescribed particle: each stage has it "
                  "at its place of that time.",
                  "Hairer, Norsett, Wanner 1993, II.1", driven_finding});
  return list;
}

}  // namespace foldproof
