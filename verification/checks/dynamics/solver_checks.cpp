// The conjugate gradients of the reference against dense linear algebra, and their promises.
#include "reference/dynamics/conjugate_gradient.h"
#include "reference/dynamics/system.h"
#include "reference/mesh/shapes.h"
#include "verification/oracles/dense_algebra.h"
#include "verification/specimens/check.h"
#include "verification/specimens/moving_sheets.h"
#include "verification/specimens/random.h"
#include "verification/specimens/solver_problems.h"
#include "verification/specimens/stepper.h"

namespace foldproof {

namespace {

const char* name_of_scale(ResidualScale scale) {
  return scale == ResidualScale::momentum ? "momentum" : "initial residual";
}

/// Of M^{-1/2} A M^{-1/2} [1].
double largest_eigenvalue(const DenseProblem& dense) {
  const Eigen::VectorXd root = dense.mass.cwiseSqrt().cwiseInverse();
  const Eigen::VectorXd values =
      oracles::symmetric_eigenvalues(root.asDiagonal() * dense.A * root.asDiagonal());
  return values.maxCoeff();
}

/// The solution of a problem, for half a step s [s].
struct Solved {
  PerParticle3 w;  // 3 x N [m/s], solved for
  Work work = {};
  SolveResult result = {};
};

Solved solve_problem(const Problem& problem, const SolverSettings& settings, double s,
                     const PerParticle3& guess) {
  Solved solved{guess};
  solved.result =
      solve_velocity(system_of(problem.system.mass, problem.system.inverse_mass, settings),
                     problem.damping, s, solved.w, solved.work);
  return solved;
}

/// Solves to many tolerances: the residual returned and recomputed, and |A| |w| of the solution,
/// where A is the operator of mass-weighted velocities.
Table residual_table() {
  Table table{{"relative to", "1"}, {"half step", "s"},
              {"tolerance", "1"},   {"returned", "1"},
              {"recomputed", "1"},  {"operator times solution", "of the scale"}};
  for (const ResidualScale scale : {ResidualScale::momentum, ResidualScale::initial_residual})
    for (double s : {2.3e-4, 3.1e-3, 0.047}) {
      Problem problem = make_problem(partly_prescribed_sheet(), 91);
      const DenseProblem dense = make_dense(problem, s);
      const double largest = largest_eigenvalue(dense);
      for (double tolerance : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
        const Solved solved = solve_problem(problem, {tolerance, 1000, scale}, s, problem.guess);
        const Eigen::VectorXd w = solved.w.reshaped()(dense.free), r = dense.b - dense.A * w,
                              momentum = dense.mass.cwiseProduct(w);
        const double size = scale_of(dense, scale);
        table.row(name_of_scale(scale), s, tolerance, solved.result.residual,
                  weighted_norm(r, dense.mass) / size,
                  largest * weighted_norm(momentum, dense.mass) / size);
      }
    }
  return table;
}

Finding promise_finding() {
  const Table table = residual_table();
  const std::vector<double>&tolerance = table.numbers("tolerance"),
        &recomputed = table.numbers("recomputed");
  Worst worst;
  for (size_t k = 0; k < table.rows(); ++k) worst.observe(recomputed[k] / tolerance[k]);
  return {{worst.value(), 1.05, 0, "of the tolerance",
           "the tolerance, and the drift between the iteration's residual and the true one: some "
           "hundred epsilon, a twentieth of the smallest tolerance, 1e-12"},
          table,
          "The residual b - (M - s D) w is recomputed with a dense D made of the modes of all "
          "dampers."};
}

Finding returned_finding() {
  const Table table = residual_table();
  const std::vector<double>&returned = table.numbers("returned"),
        &recomputed = table.numbers("recomputed");
  const std::vector<double>& size = table.numbers("operator times solution");
  Worst worst;
  for (size_t k = 0; k < table.rows(); ++k)
    worst.observe(std::abs(returned[k] - recomputed[k]) / (epsilon * size[k]));
  return {{worst.value(), 8, 0, "epsilon of the operator's norm times the solution's",
           "each iteration rounds r in proportion to the operator times the iterate (Greenbaum "
           "1997), and the first few, whose corrections are the largest, decide"},
          table};
}

Finding cholesky_finding() {
  Worst worst;
  Table errors{{"half step", "s"}, {"tolerance", "1"}, {"error over the velocity", "1"}};
  for (double s : {2.3e-4, 3.1e-3, 0.047})
    for (double tolerance : {1e-3, 1e-11}) {
      const Problem problem = make_problem(partly_prescribed_sheet(), 29);
      const DenseProblem dense = make_dense(problem, s);
      const PerParticle3 w =
          solve_problem(problem, {tolerance, 1000, ResidualScale::momentum}, s, problem.guess).w;
      const Eigen::VectorXd exact = oracles::solve_symmetric(dense.A, dense.b);
      const Eigen::VectorXd error =
          dense.mass.cwiseProduct(Eigen::VectorXd(w.reshaped()(dense.free)) - exact);
      const double size =
          weighted_norm(error, dense.mass) / scale_of(dense, ResidualScale::momentum);
      errors.row(s, tolerance, size);
      worst.observe(size / tolerance);
      for (const PrescribedParticle& p : problem.system.prescribed)
        if (w.col(p.particle) != problem.guess.col(p.particle)) worst.observe(INFINITY);
    }
  return {{worst.value(), 1.05, 0, "of the tolerance",
           "in the mass-weighted norm the operator is at least the identity, so that the error is "
           "at most the residual; 5 % for rounding"},
          errors,
          "Known velocities are moved to the right-hand side there, and must come back unchanged "
          "here."};
}

/// Particles that are each damped at one of k rates: D has k distinct nonzero eigenvalues.
SolveResult solve_with_rates(int k, unsigned seed) {
  const int particles = 23;
  Random random(seed);
  PerParticle mass(particles);
  for (double& m : mass) m = random.uniform(0.13, 0.57);
  System system = make_system(mass);
  CustomForce force;
  force.damping = [=](const State&) -> DampingOperator::Custom {
    return {[=](const PerParticle3& v, PerParticle3& f) {
              for (Eigen::Index i = 0; i < mass.size(); ++i)
                if (i % (k + 1) != 0)
                  f.col(i) -= mass[i] * (1.7 + 3.1 * double(i % (k + 1))) * v.col(i);
            },
            {}};
  };
  system.forces.push_back(force);
  PerParticle3 v = random.vectors(particles, 0.8);
  Work work;
  const State s{0, PerParticle3::Zero(3, particles), v};
  const DampingOperator damping = *damping_at(system.forces, s, work);
  return solve_velocity(
      system_of(system.mass, system.inverse_mass, {1e-12, 100, ResidualScale::momentum}), damping,
      0.19, v, work);
}

Finding eigenvalue_finding() {
  Worst worst;
  Table solves{{"distinct eigenvalues", "1"}, {"iterations", "1"}};
  for (int k = 1; k <= 7; ++k) {
    const SolveResult solve = solve_with_rates(k, 50 + unsigned(k));
    solves.row(k, solve.iterations);
    worst.observe(std::abs(solve.iterations - k));
    if (!solve.converged) worst.observe(1);
  }
  return {{worst.value(), 0, 0, "iterations",
           "conjugate gradients are exact after as many iterations as there are distinct "
           "eigenvalues in the residual; particles without damping are not in it"},
          solves};
}

/// Number of false reports by a solve whose iterations are capped, and by one that cannot converge.
Finding cap_finding() {
  const Problem problem = make_problem(free_sheet(), 3);
  const auto solve = [&](double tolerance, int cap, const PerParticle3& guess) {
    return solve_problem(problem, {tolerance, cap, ResidualScale::momentum}, 0.047, guess);
  };
  PerParticle3 spoiled = problem.guess;
  spoiled(1, 6) = nan;
  const Solved capped = solve(1e-13, 3, problem.guess), finished = solve(1e-6, 500, problem.guess),
               broken = solve(1e-6, 500, spoiled);
  const SolveResult &cap = capped.result, &whole = finished.result;
  Table holds = no_statements();
  holds.row("a capped solve is not converged", !cap.converged);
  holds.row("it took the cap's iterations", cap.iterations == 3 && capped.work.cg_iterations == 3);
  holds.row("its residual is above the tolerance", cap.residual > 1e-13);
  holds.row("it is counted as unfinished", capped.work.unfinished_solves == 1);
  holds.row("its residual is recorded", capped.work.worst_residual == cap.residual);
  holds.row("a whole solve is converged", whole.converged && whole.residual <= 1e-6);
  holds.row("it is not counted as unfinished",
            finished.work.unfinished_solves == 0 && finished.work.solves == 1);
  holds.row("NaN is not converged", !broken.result.converged);
  holds.row("NaN is counted as unfinished", broken.work.unfinished_solves == 1);
  holds.row("NaN is recorded", std::isnan(broken.work.worst_residual));
  return {{count_false(holds), 0, 0, "false reports", "a report is true or false"}, holds};
}

Finding operator_finding(const Subject& subject) {
  const double s = 0.047;
  Stepper stepper(subject, free_sheet(), "C");
  const State start = stepper.start();
  const PerParticle mass = lumped_masses(stepper.scene().mesh, stepper.scene().density);
  const Eigen::Index n = start.x.size();
  Eigen::MatrixXd A(n, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    PerParticle3 unit = PerParticle3::Zero(3, start.x.cols());
    unit.reshaped()[k] = 1 / std::sqrt(mass[k / 3]);
    const PerParticle3 column = unit * mass.asDiagonal() - s * stepper.damping_forces(start, unit);
    A.col(k) = PerParticle3(column * mass.cwiseSqrt().cwiseInverse().asDiagonal()).reshaped();
  }
  const double largest = A.cwiseAbs().maxCoeff();
  const Eigen::VectorXd eigenvalues = oracles::symmetric_eigenvalues(A);
  const double asymmetry = (A - A.transpose()).cwiseAbs().maxCoeff() / (epsilon * largest);
  const double deficit = (1 - eigenvalues[0]) / (epsilon * eigenvalues[n - 1]);
  Worst worst;
  worst.observe(asymmetry);
  worst.observe(deficit);
  return {{worst.value(), 64, 0, "epsilon of the largest",
           "an entry sums some twenty dampers of five roundings, half an epsilon each: 50; the "
           "smallest eigenvalue, 1 up to rounding, is found to about the square root of the "
           "matrix's size, 10, in epsilon of the largest"},
          Table{{"asymmetry", "epsilon of the largest entry"},
                {"smallest eigenvalue below 1", "epsilon of the largest"},
                {"largest eigenvalue", "1"}}
              .with_row(asymmetry, deficit, eigenvalues[n - 1]),
          "the operator is I - s M^{-1/2} D M^{-1/2}"};
}

Finding rigid_finding() {
  const Problem problem = make_problem(free_sheet(), 3);
  const Vector3 spin(2.3, -1.7, 0.6), drift(0.4, 3.1, -0.7);
  PerParticle3 v(3, problem.s.x.cols());
  for (Eigen::Index i = 0; i < v.cols(); ++i) {
    const Vector3 arm = problem.s.x.col(i);
    v.col(i) = drift + spin.cross(arm);
  }
  const Solved solved = solve_problem(problem, {1e-12, 100, ResidualScale::momentum}, 0.047, v);
  Worst worst;
  worst.observe(solved.result.iterations);
  worst.observe(double((solved.w.array() != v.array()).count()));
  return {
      {worst.value(), 0, 0, "iterations",
       "no damper resists a rigid motion: the explicit guess is the solution, and is not touched"},
      Table{{"residual", "1"}}.with_row(solved.result.residual)};
}

/// |b - (M - s D) w| over |M w0|, weighted with the masses, of a problem without known
/// velocities [1].
double residual_left(const Problem& problem, double s, const PerParticle3& w) {
  PerParticle3 damped = PerParticle3::Zero(3, w.cols());
  problem.damping.add_product(w, damped);
  const PerParticle& mass = problem.system.mass;
  const PerParticle3 r = (problem.guess - w) * mass.asDiagonal() + s * damped;
  const auto squared = [&](const PerParticle3& momentum) -> double {
    return momentum.colwise().squaredNorm().dot(mass.cwiseInverse().transpose());
  };
  return std::sqrt(squared(r) / squared(problem.guess * mass.asDiagonal()));
}

Finding large_finding() {
  constexpr double tolerance = 1e-7;
  Table measured{{"case", ""}, {"residual left", "of the tolerance"}};
  // 441, 529, 1024 and 2116 particles: less than one block, more, two blocks, five
  for (const int cells : {20, 22, 31, 45}) {
    Scene scene =
        scene_at_rest(make_sheet({SheetPattern::one_diagonal, 0.7, 0.6, cells, cells}), 0.2);
    scene.stretch = StretchMaterial{41, 0.053, 1};
    scene.bending = BendingMaterial{0.0037, 0.00053, Weighting::rest, DampingFactor::edge, "sine"};
    scene.rest_angles.assign(scene.mesh.hinges.size(), 0);
    const Problem problem = make_problem(scene, 97);
    const SolverSettings settings{tolerance, 200, ResidualScale::momentum};
    const Solved solved = solve_problem(problem, settings, 3.1e-3, problem.guess);
    const std::string name = std::to_string(scene.x.cols()) + " particles";
    measured.row(name, residual_left(problem, 3.1e-3, solved.w) / tolerance);
    measured.row(name + ", as returned",
                 solved.result.converged ? solved.result.residual / tolerance : nan);
  }
  return judge_worst(
      measured, 1.05,
      "the tolerance, and the drift between the iteration's residual and the true one");
}

}  // namespace

std::vector<Check> solver_checks() {
  const std::string source = "BMF03 section 3";
  return {
      {"solver.residual-is-below-the-tolerance",
       "The true residual of the reference's solve is below the tolerance, on both scales.", source,
       promise_finding},
      {"solver.reported-residual-is-true",
       "The residual that the reference's solve returns is the true one.", source,
       returned_finding},
      {"solver.solution-matches-dense-cholesky",
       "The reference's solve finds the velocities that a dense Cholesky factorization finds, "
       "known velocities included.",
       source, cholesky_finding},
      {"solver.iterations-equal-the-number-of-distinct-eigenvalues",
       "The reference's solve takes one iteration for each distinct nonzero eigenvalue of the "
       "damping.",
       source, eigenvalue_finding},
      {"solver.large-cloth-is-solved",
       "Cloth with many particles, which the reference solves block by block, is solved to the "
       "tolerance.",
       "algebra", large_finding},
      {"solver.iteration-cap-is-reported",
       "A solve of the reference that does not finish says so and is counted.", source,
       cap_finding},
      {"solver.operator-is-symmetric-positive-definite",
       "The operator of the implicit velocity is symmetric, and at least the identity in the "
       "mass-weighted norm.",
       source, operator_finding},
      {"solver.rigid-motion-needs-no-iteration",
       "The reference's solve leaves a rigid motion as it is, without an iteration.", source,
       rigid_finding},
  };
}

}  // namespace foldproof
