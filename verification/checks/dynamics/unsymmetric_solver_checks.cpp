// The reference's solver for Newton steps whose matrix is not symmetric, against dense
// linear algebra.
#include "reference/dynamics/biconjugate_gradient.h"
#include "reference/dynamics/system.h"
#include "verification/oracles/dense_algebra.h"
#include "verification/specimens/check.h"
#include "verification/specimens/moving_sheets.h"
#include "verification/specimens/probe.h"
#include "verification/specimens/random.h"

namespace foldproof {

namespace {

/// M - s D - s^2 K of a moving, crumpled, damped sheet, as the reference's operator and as a dense
/// matrix, and a right-hand side.
struct NewtonProblem {
  System system;
  DampingOperator damping;
  ForceDifferential derivative;
  double s;
  PerParticle3 r;             // 3 x N [kg m/s]
  Eigen::MatrixXd A;          // of the free coordinates, scaled with M^{-1/2} from both sides [1]
  Eigen::VectorXd scaled_r;   // M^{-1/2} r of them [kg^1/2 m/s]
  Eigen::VectorXd root_mass;  // [kg^1/2]
  std::vector<Eigen::Index> free;  // coordinates

  NewtonMatrix matrix() const { return {system.mass, system.inverse_mass, damping, derivative, s}; }
};

/// Columns of D and K come from products with unit vectors, and are assembled here.
void make_dense(NewtonProblem& problem) {
  const Eigen::Index n = problem.r.size();
  const Eigen::MatrixXd whole = matrix_of(n / 3, [&](const PerParticle3& unit) -> PerParticle3 {
    PerParticle3 D = PerParticle3::Zero(3, n / 3), K = D;
    problem.damping.add_product(unit, D);
    problem.derivative.add_product(unit, K);
    return unit * problem.system.mass.asDiagonal() - problem.s * D - problem.s * problem.s * K;
  });
  for (Eigen::Index k = 0; k < n; ++k)
    if (problem.system.inverse_mass[k / 3] != 0) problem.free.push_back(k);
  problem.root_mass.resize(Eigen::Index(problem.free.size()));
  for (size_t i = 0; i < problem.free.size(); ++i)
    problem.root_mass[Eigen::Index(i)] = std::sqrt(problem.system.mass[problem.free[i] / 3]);
  const Eigen::VectorXd inverse = problem.root_mass.cwiseInverse();
  problem.A = inverse.asDiagonal() * whole(problem.free, problem.free) * inverse.asDiagonal();
  problem.scaled_r = inverse.cwiseProduct(Eigen::VectorXd(problem.r.reshaped()(problem.free)));
}

/// With the scene's damping multiplied by 30.
NewtonProblem make_newton_problem(Scene scene, double s, unsigned seed) {
  scene.stretch->damping *= 30;
  scene.bending->damping *= 30;
  System system = build_system(scene);
  const State state = start_state(scene);
  Work uncounted;
  const DampingOperator damping = *damping_at(system.forces, state, uncounted);
  const ForceDifferential derivative = force_differential_at(system.forces, state, uncounted);
  NewtonProblem problem{std::move(system), damping, derivative, s, {}, {}, {}, {}, {}};
  problem.r = Random(seed).vectors(state.x.cols(), 0.013);
  for (const PrescribedParticle& p : problem.system.prescribed) problem.r.col(p.particle).setZero();
  make_dense(problem);
  return problem;
}

std::vector<std::pair<std::string, NewtonProblem>> newton_problems() {
  std::vector<std::pair<std::string, NewtonProblem>> problems;
  for (const double s : {3.1e-3, 0.012, 0.041}) {
    problems.emplace_back("free, s = " + std::to_string(s),
                          make_newton_problem(free_sheet(), s, 53));
    problems.emplace_back("led, s = " + std::to_string(s),
                          make_newton_problem(partly_prescribed_sheet(), s, 59));
  }
  return problems;
}

/// M^{1/2} dw at the free coordinates.
Eigen::VectorXd solve_linear(const NewtonProblem& problem, double tolerance, SolveResult& solve) {
  PerParticle3 dw;
  Work work;
  solve = solve_unsymmetric_step(problem.matrix(), {tolerance, 2000, ResidualScale::momentum},
                                 problem.r, dw, work);
  return problem.root_mass.cwiseProduct(Eigen::VectorXd(dw.reshaped()(problem.free)));
}

Finding promise_is_kept() {
  Table measured{{"case", ""}, {"true residual over the tolerance", "1"}};
  for (const auto& [name, problem] : newton_problems())
    for (const double tolerance : {1e-1, 1e-3, 1e-6, 1e-9}) {
      SolveResult solve{};
      const Eigen::VectorXd dw = solve_linear(problem, tolerance, solve);
      const double residual = (problem.scaled_r - problem.A * dw).norm() / problem.scaled_r.norm();
      measured.row(name + ", tolerance " + std::to_string(tolerance),
                   solve.converged ? residual / tolerance : INFINITY);
    }
  return judge_worst(measured, 1.05,
                     "the tolerance, and the drift between the iteration's residual and the true "
                     "one: epsilon times the largest residual of any iteration, far below a "
                     "twentieth of the smallest tolerance");
}

Finding is_the_dense_solution() {
  Table measured{{"case", ""}, {"error over what the tolerance allows", "1"}};
  for (const auto& [name, problem] : newton_problems()) {
    SolveResult solve{};
    const double tolerance = 1e-8;
    const Eigen::VectorXd error = solve_linear(problem, tolerance, solve) -
                                  oracles::solve_linear(problem.A, problem.scaled_r);
    const double least = oracles::singular_parts(problem.A).values.minCoeff();
    measured.row(name, error.norm() * least / (tolerance * problem.scaled_r.norm()));
  }
  return judge_worst(
      measured, 1.05,
      "an error is at most the residual over the matrix's least singular value; 5 % for rounding");
}

Finding unsymmetry_is_there() {
  Table measured{{"case", ""}, {"a thousandth over the asymmetry", "1"}};
  const auto observe = [&](const std::string& damped, const Scene& scene) {
    const Eigen::MatrixXd A = make_newton_problem(scene, 0.012, 53).A;
    measured.row(damped,
                 1e-3 * A.cwiseAbs().maxCoeff() / (A - A.transpose()).cwiseAbs().maxCoeff());
  };
  Scene springs = free_sheet(), hinges = free_sheet();
  hinges.stretch->damping = springs.bending->damping = 0;
  observe("springs", springs);
  observe("hinges", hinges);
  return judge_worst(measured, 1,
                     "on a symmetric matrix the other checks of this solver would show little: the "
                     "largest entry of A - A^T exceeds a thousandth of that of A");
}

Finding work_is_counted() {
  const NewtonProblem problem = make_newton_problem(free_sheet(), 0.012, 53);
  PerParticle3 dw;
  Work whole, capped;
  const SolveResult finished = solve_unsymmetric_step(
      problem.matrix(), {1e-8, 2000, ResidualScale::momentum}, problem.r, dw, whole);
  const SolveResult cap = solve_unsymmetric_step(
      problem.matrix(), {1e-13, 3, ResidualScale::momentum}, problem.r, dw, capped);
  const int twice = 2 * finished.iterations;
  Table holds = no_statements();
  holds.row("two products with the damping an iteration", whole.damping_products == twice);
  holds.row("two products with the derivative an iteration", whole.stiffness_products == twice);
  holds.row("two counted iterations an iteration", whole.cg_iterations == twice);
  holds.row("a whole solve is converged", finished.converged && finished.residual <= 1e-8);
  holds.row("a capped solve is not converged", !cap.converged && cap.residual > 1e-13);
  holds.row("it took the cap's iterations", cap.iterations == 3 && capped.damping_products == 6);
  return {{count_false(holds), 0, 0, "false reports", "a report is true or false"}, holds};
}

}  // namespace

std::vector<Check> unsymmetric_solver_checks() {
  const std::string source = "van der Vorst 1992";
  return {{"solver.unsymmetric-residual-is-below-the-tolerance",
           "The true residual of the reference's solve of an unsymmetric Newton step is below the "
           "tolerance.",
           source, promise_is_kept},
          {"solver.unsymmetric-step-matches-dense-solution",
           "The reference's solve of an unsymmetric Newton step finds what a dense factorization "
           "finds.",
           source, is_the_dense_solution},
          {"solver.newton-matrix-is-unsymmetric-on-damped-cloth",
           "The matrix of a Newton step on moving, damped cloth is not symmetric.", source,
           unsymmetry_is_there},
          {"solver.unsymmetric-work-is-counted",
           "The reference's solve of an unsymmetric Newton step counts its products, and reports "
           "when it does not finish.",
           source, work_is_counted}};
}

}  // namespace foldproof
