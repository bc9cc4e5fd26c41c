// Conservation in every step: momentum and, without damping, reversibility.
#include "reference/dynamics/conjugate_gradient.h"
#include "reference/dynamics/system.h"
#include "verification/specimens/check.h"
#include "verification/specimens/differences.h"
#include "verification/specimens/moving_sheets.h"
#include "verification/specimens/random.h"
#include "verification/specimens/stepper.h"

namespace foldproof {

namespace {

/// Momenta of velocities v at positions x, and the sums of absolute values used as their scale.
struct Momenta {
  Vector3 linear, angular;           // kg m/s, kg m^2/s about the origin
  double linear_size, angular_size;  // sum m |v|, sum m |x| |v|
};

Momenta momenta(const PerParticle& mass, const PerParticle3& x, const PerParticle3& v) {
  Momenta sum{Vector3::Zero(), Vector3::Zero(), 0, 0};
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    const Vector3 position = x.col(i), momentum = mass[i] * v.col(i);
    sum.linear += momentum;
    sum.angular += position.cross(momentum);
    sum.linear_size += momentum.norm();
    sum.angular_size += position.norm() * momentum.norm();
  }
  return sum;
}

enum class Momentum { linear, angular };

/// Drift from the start, in epsilon of `size`, the largest sum of absolute values on the way.
double drift(const Momenta& now, const Momenta& start, Momentum which, double size) {
  const Vector3 change = which == Momentum::linear ? Vector3(now.linear - start.linear)
                                                   : Vector3(now.angular - start.angular);
  return change.norm() / (epsilon * size);
}

/// Runs a free sheet for many steps and follows one momentum.
Finding kept(const Subject& subject, const std::string& integrator, const Scene& scene,
             Momentum which) {
  const int steps = 1000;
  const PerParticle mass = lumped_masses(scene.mesh, scene.density);
  Stepper stepper(subject, scene, integrator);
  State s = stepper.start();
  const Momenta start = momenta(mass, s.x, s.v);
  Worst worst, size;
  Table drifts{{"time", "s"}, {"drift", "epsilon of the sum"}};
  for (int n = 1; n <= steps; ++n) {
    s = stepper.step(s, n % 2 == 0 ? 2.3e-3 : 0.7e-3);
    const Momenta now = momenta(mass, s.x, s.v);
    size.observe(which == Momentum::linear ? now.linear_size : now.angular_size);
    const double drifted = drift(now, start, which, size.value());
    worst.observe(drifted);
    if (n % 50 == 0) drifts.row(s.time, drifted);
  }
  const double bound = 16 * std::sqrt(double(steps));
  return {{worst.value(), bound, 0, "epsilon of the sum",
           "a step rounds each particle's momentum and impulse about 16 times, and 1,000 steps add "
           "up like a random walk; a defect of the scheme would show at the order of h^2"},
          drifts,
          smallest_defect(bound, "sum of the momenta's sizes, over all steps")};
}

Scene loosely_solved_sheet() {
  Scene scene = free_sheet();
  scene.solver.max_iterations = 2;  // every solve stops short of its tolerance
  return scene;
}

Finding linear_finding(const Subject& subject, const std::string& integrator) {
  return kept(subject, integrator, loosely_solved_sheet(), Momentum::linear);
}

Finding undamped_angular_finding(const Subject& subject, const std::string& integrator) {
  return kept(subject, integrator, undamped_sheet(), Momentum::angular);
}

Finding damped_angular_finding(const Subject& subject, const std::string& integrator) {
  return kept(subject, integrator, loosely_solved_sheet(), Momentum::angular);
}

Finding reversal_finding(const Subject& subject, const std::string& integrator) {
  const double h = 1.9e-3;
  const int steps = 150;
  Scene scene = undamped_sheet();
  scene.gravity = Vector3(0.7, -9.1, 1.9);
  scene.prescribed = {{3, scene.x.col(3), Motion{}}, {9, scene.x.col(9), Motion{}}};
  Stepper stepper(subject, scene, integrator);
  const State start = stepper.start();
  State s = stepper.run(start, h, steps);
  const double displacement = largest_difference(s.x, start.x);
  s.v = -s.v;
  s = stepper.run(s, h, steps);
  const double grown = growth(stepper, start, h, 2 * steps);
  const double off_x = largest_difference(s.x, start.x) / (epsilon * extent(start.x));
  const double off_v =
      largest_difference(-s.v, start.v) * 2 * steps * h / (epsilon * extent(start.x));
  Worst worst;
  worst.observe(off_x);
  worst.observe(off_v);
  const double bound = 16 * std::sqrt(2.0 * steps) * grown;
  return {{worst.value(), bound, 0, "epsilon of the extent",
           "16 roundings a step, 300 steps that add up like a random walk, each amplified at most "
           "as a disturbance at the start (see the evidence)"},
          Table{{"growth", "1"}, {"way there", "m"}}.with_row(grown, displacement),
          smallest_defect(bound, "extent")};
}

struct Truncation {
  std::string name;
  double tolerance;
  int max_iterations;
};

/// Momentum changes of one solve on the crumpled sheet, in epsilon of the sums.
std::pair<double, double> truncate(const Truncation& how, double h, unsigned seed) {
  const Scene scene = free_sheet();
  System system = build_system(scene);
  system.solver.tolerance = how.tolerance;
  system.solver.max_iterations = how.max_iterations;
  Random random(seed);
  State s = start_state(scene);
  s.x.colwise() += Vector3(0.31, -0.17, 0.23);
  PerParticle3 v = random.vectors(s.x.cols(), 0.7);
  Work work;
  const DampingOperator damping = *damping_at(system.forces, s, work);
  const Momenta before = momenta(system.mass, s.x, v);
  solve_velocity(system, damping, h / 2, v, work);
  const Momenta after = momenta(system.mass, s.x, v);
  return {drift(after, before, Momentum::linear, before.linear_size),
          drift(after, before, Momentum::angular, before.angular_size)};
}

Finding truncated_finding() {
  const std::vector<Truncation> ways = {{"1 iteration", 1e-14, 1},
                                        {"2 iterations", 1e-14, 2},
                                        {"3 iterations", 1e-14, 3},
                                        {"tolerance 0.5", 0.5, 1000},
                                        {"tolerance 1e-8", 1e-8, 1000}};
  Worst worst;
  Table changes(
      "stopped after [1]; step [s]; linear [epsilon of sum m |v|]; angular [epsilon of sum m |x| "
      "|v|]");
  for (const Truncation& displacement : ways)
    for (double h : {3.7e-4, 5.9e-3, 0.11}) {
      const auto [p, l] = truncate(displacement, h, 77);
      worst.observe(p);
      worst.observe(l);
      changes.row(displacement.name, h, p, l);
    }
  return {{worst.value(), 64, 0, "epsilon of the sum",
           "an iteration rounds every velocity twice and every damping force about ten times; tens "
           "of iterations of the tight solves add up at random, with decreasing size"},
          changes,
          "The momenta are those at the positions for which the damping was prepared."};
}

}  // namespace

std::vector<Check> momentum_checks() {
  const std::string source = "BMF03 sections 3 and 4";
  std::vector<Check> list;
  add_for_each_scheme(
      list, {{"dynamics.undamped-motion-is-time-reversible",
              "an undamped sheet runs back the way that it came.", source, reversal_finding},
             {"dynamics.linear-momentum-is-conserved",
              "a free damped sheet keeps its linear momentum to rounding, however loose "
              "the tolerance of its solves.",
              source, linear_finding},
             {"dynamics.angular-momentum-is-conserved.undamped",
              "a free undamped sheet keeps its angular momentum to rounding.", source,
              undamped_angular_finding}});
  std::vector<Check> damped;
  add_for_each_scheme(damped,
                      {{"dynamics.angular-momentum-is-conserved.damped",
                        "a free damped sheet keeps its angular momentum to rounding, however loose "
                        "the tolerance of its solves.",
                        source, damped_angular_finding}});
  // C moves x with one velocity and carries momentum with another: its drift is O(h^2); a study
  // measures it
  std::erase_if(damped, [](const Check& check) { return check.name.ends_with(".C"); });
  list.insert(list.end(), damped.begin(), damped.end());
  list.push_back({"dynamics.truncated-solve-conserves-momentum",
                  "The reference's solve keeps linear and angular momentum to rounding however "
                  "early it stops.",
                  "BMF03 section 3", truncated_finding});
  return list;
}

}  // namespace foldproof
