// The methods that the paper's schemes are compared with: the equations of a step, and the limits
// of the step.
#include <fmt/format.h>
#include <numeric>

#include "reference/dynamics/simulate.h"
#include "verification/oracles/dense_algebra.h"
#include "verification/specimens/check.h"
#include "verification/specimens/differences.h"
#include "verification/specimens/moving_sheets.h"
#include "verification/specimens/probe.h"
#include "verification/specimens/specimens.h"
#include "verification/specimens/stepper.h"

namespace foldproof {

namespace {

constexpr double tolerance = 1e-11;

/// The mass-weighted norm of a momentum over free particles [kg^1/2 m/s].
double norm_of(const PerParticle3& momentum, const PerParticle& inverse_mass) {
  return std::sqrt(momentum.colwise().squaredNorm().dot(inverse_mass.transpose()));
}

/// A step made by a method, and the states before it, the latest last.
struct MadeStep {
  std::vector<State> past;
  State next;
  double h() const { return next.time - past.back().time; }
};

MadeStep step_made_by(Stepper& stepper, double h) {
  const State start = stepper.start();
  const State second = stepper.step(start, 0.7 * h);
  return {{start, second}, stepper.step_after({start, second}, h)};
}

/// Position and velocity at which a method evaluates the forces, the span [s] that they act over,
/// and the resulting change of velocity, all by the textbook.
struct Equation {
  State at;
  double span;
  PerParticle3 change;  // 3 x N [m/s]
};

Equation equation_of(std::string_view method, const MadeStep& made) {
  const State &now = made.past.back(), &next = made.next;
  const double h = made.h();
  if (method == "implicit-midpoint")
    return {{now.time + h / 2, (now.x + next.x) / 2, (next.x - now.x) / h}, h, next.v - now.v};
  if (method == "backward-euler")
    return {{next.time, next.x, (next.x - now.x) / h}, h, next.v - now.v};

  // BDF2: the derivative at the end of the parabola through three points
  const State& before = made.past.front();
  const double g = now.time - before.time;
  const auto slope = [&](const PerParticle3& p2, const PerParticle3& p1,
                         const PerParticle3& p0) -> PerParticle3 {
    return (2 * h + g) / (h * (h + g)) * p2 - (h + g) / (h * g) * p1 + h / (g * (h + g)) * p0;
  };
  return {{next.time, next.x, slope(next.x, now.x, before.x)}, 1, slope(next.v, now.v, before.v)};
}

/// |M change - span (F + D v)| over the momentum, at free particles.
double residual_of(const Stepper& stepper, const Equation& equation, const PerParticle& mass,
                   const PerParticle& inverse_mass) {
  const PerParticle3 force =
      stepper.elastic_forces(equation.at) + stepper.damping_forces(equation.at, equation.at.v);
  const PerParticle3 impulse = equation.span * force,
                     momentum = equation.change * mass.asDiagonal();
  return norm_of(momentum - impulse, inverse_mass) /
         (norm_of(momentum, inverse_mass) + norm_of(impulse, inverse_mass));
}

/// Prescribed particles have the position and velocity prescribed for that time.
void lead(const System& system, State& s) {
  impose(velocities_at(system.prescribed, s.time), s.v);
  for (const PrescribedParticle& p : system.prescribed)
    s.x.col(p.particle) = position_at(p.motion, p.start, s.time);
}

Finding satisfies_its_equations(const Subject& subject, const std::string& method) {
  Table measured{{"case", ""}, {"residual over momentum and impulse", "1"}};
  for (Scene scene : {free_sheet(), partly_prescribed_sheet()}) {
    scene.solver.tolerance = tolerance;
    const System system = build_system(scene);
    Stepper stepper(subject, scene, method);
    for (const double h : {0.0017, 0.0071}) {
      const MadeStep made = step_made_by(stepper, h);
      Equation equation = equation_of(method, made);
      lead(system, equation.at);
      measured.row(
          (scene.prescribed.empty() ? "free, h = " : "led, h = ") + std::to_string(h) + " s",
          residual_of(stepper, equation, system.mass, system.inverse_mass));
    }
  }
  return judge_worst(
      measured, 100 * tolerance,
      "the solver's tolerance is 1e-11 of the momentum at its guess, which may be ten times the "
      "change in a step; this norm weights masses differently, by up to tenfold");
}

/// One step of the linearised method against a dense solve of its equation, with the
/// subject's forces.
Finding linearised_step(const Subject& subject) {
  Table measured{{"case", ""}, {"difference over the largest velocity", "1"}};
  for (const double h : {0.0017, 0.019}) {
    Scene scene = free_sheet();
    scene.solver.tolerance = 1e-13;
    Stepper stepper(subject, scene, "linear-backward-euler");
    const State now = stepper.start();
    const System system = build_system(scene);
    const Probe probe(subject, scene);
    Work uncounted;
    const ForceDifferential differential =
        elastic_differential_at(system.forces, now, Definiteness::semidefinite, uncounted);
    const Eigen::MatrixXd K = matrix_of(differential, now.x.cols());
    const Eigen::VectorXd mass = system.mass.transpose().replicate(3, 1).reshaped();
    const Eigen::MatrixXd A =
        Eigen::MatrixXd(mass.asDiagonal()) - h * damping_matrix(probe, now) - h * h * K;
    const PerParticle3 momentum = now.v * system.mass.asDiagonal() + h * probe.elastic(now);
    const Eigen::VectorXd v = oracles::solve_symmetric(A, momentum.reshaped());
    const PerParticle3 next = stepper.step(now, h).v;
    measured.row("h = " + std::to_string(h) + " s",
                 largest_difference(next, v.reshaped(3, next.cols())) / largest_speed(next));
  }
  return judge_worst(measured, 1e-10,
                     "the solver's tolerance is 1e-13 of the momentum, times the matrix's "
                     "condition, at most some 1e3");
}

/// The scene with its damping multiplied by 100.
Scene heavily_damped(Scene scene) {
  scene.stretch->damping *= 100;
  scene.bending->damping *= 100;
  return scene;
}

/// A damped sheet, two with 100 times its damping, and an undamped one whose springs are
/// compressed, so that the exact derivative is indefinite.
std::vector<std::pair<std::string, Scene>> sheets_to_solve() {
  std::vector<std::pair<std::string, Scene>> sheets = {
      {"damped", free_sheet()},
      {"heavily damped", heavily_damped(free_sheet())},
      {"heavily damped and led", heavily_damped(partly_prescribed_sheet())},
      {"compressed", undamped_sheet()}};
  sheets.back().second.stretch->rest_length_scale = 1.4;
  for (auto& [name, scene] : sheets) scene.solver.tolerance = 1e-9;
  return sheets;
}

/// Solves out of 36 that missed their tolerance, at steps up to 50 times the elastic limit.
Finding large_steps_finding(const Subject& subject) {
  Table missed{{"case", ""}, {"solves that missed their tolerance", "solves"}};
  for (const auto& [name, scene] : sheets_to_solve())
    for (const std::string method : {"backward-euler", "BDF2", "implicit-midpoint"}) {
      Stepper stepper(subject, scene, method);
      const State start = stepper.start();
      const double limit = elastic_limit(build_system(scene), start);
      for (const double over : {0.5, 5.0, 50.0}) {
        const long before = stepper.work().unfinished_solves;
        stepper.step(start, over * limit);
        missed.row(name + ", " + method + ", " + std::to_string(over) + " times the elastic limit",
                   stepper.work().unfinished_solves - before);
      }
    }
  const std::vector<double>& counts = missed.numbers("solves that missed their tolerance");
  return {{std::accumulate(counts.begin(), counts.end(), 0.0), 2, 0, "solves",
           "one in eighteen: a line search may end where no fraction of the step lowers the "
           "residual. A hinge's force jumps where it folds through half a circle, so an equation "
           "far beyond the limit need not have a solution; a solve that finds none says so"},
          missed};
}

/// Shapes at rest far from the origin, held together by springs alone or by hinges alone: the only
/// forces come from the rounding of positions.
std::vector<Specimen> shapes_at_rest() {
  std::vector<Specimen> cases;
  for (Specimen shape : curved_shapes())
    for (const bool has_springs : {true, false}) {
      Specimen rests = shape;
      if (has_springs) rests.scene.stretch = StretchMaterial{2900, 0, 1};
      if (!has_springs)
        rests.scene.bending =
            BendingMaterial{0.37, 0, Weighting::rest, DampingFactor::edge, "sine"};
      rests.state.x.colwise() += Vector3(57.3, -41.9, 23.1);
      rests.state.v.setZero();
      rests.scene.x = rests.state.x;
      rests.scene.v = rests.state.v;
      rests.name += has_springs ? ", springs" : ", hinges";
      cases.push_back(rests);
    }
  return cases;
}

Finding rest_is_found(const Subject& subject) {
  Table measured{{"case", ""}, {"solves that missed their tolerance", "1"}};
  for (const Specimen& shape : shapes_at_rest())
    for (const std::string method : {"backward-euler", "implicit-midpoint"}) {
      Stepper stepper(subject, shape.scene, method);
      const double limit = elastic_limit(build_system(shape.scene), shape.state);
      stepper.step(shape.state, 5 * limit);
      measured.row(shape.name + ", " + method, double(stepper.work().unfinished_solves));
    }
  return judge_worst(
      measured, 0,
      "cloth at rest up to the rounding of its positions needs no solve, and none can improve it");
}

/// Sheets that turn and crumple, with 100 times their usual damping.
Finding newton_is_quick(const Subject& subject) {
  Table measured{{"case", ""}, {"Newton iterations of a step", "1"}};
  for (Scene scene : {heavily_damped(free_sheet()), heavily_damped(partly_prescribed_sheet())}) {
    scene.solver.tolerance = 1e-9;
    for (const std::string method : {"backward-euler", "BDF2", "implicit-midpoint"}) {
      Stepper stepper(subject, scene, method);
      const State start = stepper.start();
      const double limit = elastic_limit(build_system(scene), start);
      for (const double over : {0.5, 2.0, 5.0}) {
        const long before = stepper.work().newton_iterations;
        stepper.step(start, over * limit);
        measured.row((scene.prescribed.empty() ? "free, " : "led, ") + method + ", " +
                         std::to_string(over) + " times the elastic limit",
                     double(stepper.work().newton_iterations - before));
      }
    }
  }
  return judge_worst(measured, 10,
                     "solved to a thousandth, an exact step leaves a thousandth near the solution: "
                     "three iterations for nine digits, plus seven to come near; without the "
                     "damping's derivative each leaves a large part");
}

/// The largest damping rate of the subject at the specimen's state over the reference's bound.
double rate_over_bound(const Subject& subject, const Specimen& specimen) {
  const System system = build_system(specimen.scene);
  const Eigen::MatrixXd D = damping_matrix(Probe(subject, specimen.scene), specimen.state);
  const Eigen::VectorXd roots =
      system.mass.transpose().replicate(3, 1).reshaped().cwiseSqrt().cwiseInverse();
  const Eigen::VectorXd rates =
      oracles::symmetric_eigenvalues(roots.asDiagonal() * D * roots.asDiagonal());
  Work uncounted;
  const double bound = damping_rate_bound(*damping_at(system.forces, specimen.state, uncounted),
                                          system.inverse_mass);
  return -rates.minCoeff() / bound;
}

Finding damping_bound_is_a_bound(const Subject& subject) {
  Table measured{{"case", ""}, {"largest rate over the bound", "1"}};
  const StretchMaterial springs{1, 0.017, 1};
  const BendingMaterial hinges = damped_bending_variants().front();
  for (Specimen specimen : small_crumpled_sheets()) {
    const std::string name = specimen.name;
    specimen.scene.stretch = springs;
    measured.row(name + ", springs", rate_over_bound(subject, specimen));
    specimen.scene.bending = hinges;
    measured.row(name + ", both", rate_over_bound(subject, specimen));
    specimen.scene.stretch.reset();
    measured.row(name + ", hinges", rate_over_bound(subject, specimen));
  }
  return judge_worst(measured, 1, "an upper bound may not be exceeded");
}

/// Two equal masses joined by a damper: they reach the bound.
Finding damping_rate_is_reached() {
  Table measured{{"case", ""}, {"bound over the rate of one damper, less 1", "1"}};
  for (const double mass : {0.3, 2.7}) {
    DampingOperator damper;
    const Vector3 along(0.4, -1.1, 0.7);  // sqrt(N s/m)
    damper.pairs.push_back({0, 1, along});
    const double rate = 2 * along.squaredNorm() / mass;  // of their relative velocity [1/s]
    measured.row(
        fmt::format("{} kg", mass),
        std::abs(damping_rate_bound(damper, PerParticle::Constant(2, 1 / mass)) / rate - 1));
  }
  return judge_worst(measured, 8 * epsilon,
                     "with one pair the bound is exact: the same number in a few roundings");
}

/// Automatic steps of a sheet whose damping, not its elasticity, limits explicit methods.
Finding explicit_steps_respect_damping() {
  Scene scene = free_sheet();
  scene.stretch->damping *= 1000;
  const System system = build_system(scene);
  const State s = start_state(scene);
  Work uncounted;
  const double rate =
      damping_rate_bound(*damping_at(system.forces, s, uncounted), system.inverse_mass);
  const StepRule rule{0, 0.7, 1e9};
  Table measured{{"case", ""}, {"step over 0.7 of the limit, less 1", "1"}};
  for (const Integrator& integrator : integrators()) {
    const bool limited = integrator.family == Family::fully_explicit;
    const double elastic = elastic_limit(system, s),
                 limit = limited ? std::min(2 / rate, elastic) : elastic;
    const double h = allowed_step(system, integrator, {&s, 1}, rule, elastic);
    measured.row(std::string(integrator.name), std::abs(h / (rule.safety * limit) - 1));
  }
  return judge_worst(measured, 8 * epsilon, "the limit times the safety, in a few roundings");
}

/// The next step after a step of a hundredth of the allowed one.
Finding growth_is_limited() {
  const System system = build_system(free_sheet());
  State before = start_state(free_sheet()), now = before;
  now.time = before.time + 1e-5;
  const StepRule rule{1e-3, 0.5, 0.1};
  const double zero_stable = 1 + std::sqrt(2.0);
  Table measured{{"case", ""}, {"growth over the largest allowed", "1"}};
  for (const Integrator& integrator : integrators()) {
    const std::array<State, 2> past = {before, now};
    const double growth =
        allowed_step(system, integrator, past, rule, elastic_limit(system, now)) / 1e-5;
    const double allowed = integrator.name == "BDF2" ? zero_stable : 100;
    measured.row(std::string(integrator.name), growth / allowed);
    if (integrator.name != "BDF2")
      measured.row(std::string(integrator.name) + " unhindered", allowed / growth);
  }
  return judge_worst(
      measured, 1 + 1e-9,
      "BDF2 is zero-stable for ratios below 1 + sqrt(2); one-step methods need no such limit");
}

/// Derivatives of the elastic forces in Newton iterations, where they are definite: the steps are
/// so short that the masses outweigh the negative stiffness of compressed springs and hinges.
Finding newton_asks_finding() {
  const System system = build_system(undamped_sheet());
  const State start = start_state(undamped_sheet());
  Table measured{{"case", ""}, {"derivatives an iteration, more than two", "1"}};
  for (const char* name : {"backward-euler", "implicit-midpoint"})
    for (const double share : {0.1, 0.3}) {
      Work work;
      integrator_named(name).step(system, {&start, 1}, share * elastic_limit(system, start), work);
      measured.row(fmt::format("{}, {} of the elastic limit, {} iterations", name, share,
                               work.newton_iterations),
                   work.newton_iterations > 1
                       ? double(work.stiffness_preparations) / double(work.newton_iterations) - 2
                       : NAN);
    }
  return judge_worst(
      measured, 0,
      "once the exact derivative, which is symmetric here, and once that of conjugate gradients");
}

}  // namespace

std::vector<Check> method_checks() {
  const std::string limits = "our automatic steps; Hairer, Norsett, Wanner, section III.5";
  std::vector<Check> checks;
  for (const std::string method : {"backward-euler", "BDF2", "implicit-midpoint"})
    checks.push_back(
        {"methods.step-satisfies-its-equation." + method,
         "A step of " + method +
             " solves the nonlinear equation that defines it, prescribed particles and variable "
             "steps included.",
         "Hairer, Norsett, Wanner, Solving Ordinary Differential Equations",
         [method](const Subject& subject) { return satisfies_its_equations(subject, method); }});
  checks.insert(
      checks.end(),
      {{"methods.linearised-step-solves-its-equation",
        "A step of linearised backward Euler is the solution of (M - h D - h^2 K) v = M v_n + h F.",
        "Baraff and Witkin 1998", linearised_step},
       {"methods.newton-solves-large-steps",
        "Newton's method solves at least 34 of 36 steps, up to fifty times the elastic limit, of "
        "damped and heavily damped crumpled sheets and of a compressed undamped one.",
        "what BMF03 section 3 expects of a fully implicit method", large_steps_finding},
       {"methods.newton-accepts-cloth-at-rest",
        "A step of shapes at rest far from the origin is not counted as unfinished: forces need "
        "not "
        "vanish beyond their rounding error.",
        "floating-point arithmetic", rest_is_found},
       {"methods.newton-converges-quickly-on-damped-cloth",
        "Newton's method takes at most ten iterations a step on heavily damped cloth that turns "
        "and "
        "crumples, at steps up to five times the elastic limit.",
        "what BMF03 section 3 expects of a fully implicit method", newton_is_quick},
       {"forces.damping-rate-bound-holds",
        "The reference's bound on damping rates exceeds the largest rate of crumpled sheets.",
        "Gershgorin's theorem", damping_bound_is_a_bound},
       {"dynamics.explicit-steps-respect-the-damping-limit",
        "Automatic steps of explicit methods obey the damping limit, those of other methods only "
        "the elastic limit.",
        limits, explicit_steps_respect_damping},
       {"dynamics.step-growth-is-limited",
        "BDF2's steps grow by factors below 1 + sqrt(2); those of one-step methods may grow "
        "freely.",
        limits, growth_is_limited},
       {"methods.newton-computes-no-needless-derivative",
        "Where the derivative of the elastic forces is definite, Newton's method "
        "computes no second one.",
        "ours", newton_asks_finding},
       {"methods.damping-rate-bound-is-exact-for-one-damper",
        "The bound on the damping rate is that of a single damper.", limits,
        damping_rate_is_reached}});
  return checks;
}

}  // namespace foldproof
