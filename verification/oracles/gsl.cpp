#include "verification/oracles/gsl.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_odeiv2.h>
#include <gsl/gsl_roots.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "reference/types.h"

namespace foldproof::oracles {

namespace {

/// A cap on the steps of one integration: an oracle that needs more has an unsuitable problem.
constexpr unsigned long most_steps = 20'000'000;

/// Likewise for one root: bisection alone would need 64.
constexpr int most_root_steps = 200;

void require(bool holds, const std::string& what) {
  if (!holds) throw InputError("oracle gsl: " + what);
}

bool all_finite(std::span<const double> y) {
  return std::all_of(y.begin(), y.end(), [](double component) { return std::isfinite(component); });
}

/// A right-hand side as GSL calls it, and the error raised in it: exceptions must not pass through
/// C.
struct GuardedRightHandSide {
  const RightHandSide& rhs;
  std::size_t dimension;
  std::exception_ptr thrown = nullptr;
};

extern "C" int call_right_hand_side(double t, const double y[], double dydt[], void* guarded_rhs) {
  auto* guarded = static_cast<GuardedRightHandSide*>(guarded_rhs);
  const std::span<double> derivative(dydt, guarded->dimension);
  try {
    guarded->rhs(t, {y, guarded->dimension}, derivative);
  } catch (...) {
    guarded->thrown = std::current_exception();
    return GSL_EBADFUNC;
  }
  const bool finite =
      std::all_of(derivative.begin(), derivative.end(), [](double d) { return std::isfinite(d); });
  return finite ? GSL_SUCCESS : GSL_EBADFUNC;
}

struct FreeDriver {
  void operator()(gsl_odeiv2_driver* driver) const { gsl_odeiv2_driver_free(driver); }
};

/// One initial value problem and the times at which its solution is wanted.
struct Problem {
  const RightHandSide& rhs;
  std::span<const double> y0;
  double t0;
  std::span<const double> times;
};

std::string failure(const gsl_odeiv2_step_type* method, double t, int status) {
  const std::string reason =
      status == GSL_EBADFUNC ? "the right-hand side is not finite" : gsl_strerror(status);
  return std::string("oracle gsl: ") + method->name + " stopped at t = " + std::to_string(t) +
         ": " + reason;
}

std::vector<std::vector<double>> integrate(const Problem& problem,
                                           const gsl_odeiv2_step_type* method, double tolerance) {
  GuardedRightHandSide guarded{problem.rhs, problem.y0.size()};
  gsl_odeiv2_system system{call_right_hand_side, nullptr, guarded.dimension, &guarded};
  const double span = problem.times.back() - problem.t0;
  const double first_step = span > 0 ? 1e-6 * span : 1e-6;
  const std::unique_ptr<gsl_odeiv2_driver, FreeDriver> driver(
      gsl_odeiv2_driver_alloc_y_new(&system, method, first_step, tolerance, tolerance));
  if (!driver) throw std::runtime_error("oracle gsl: no memory for an ODE driver");
  gsl_odeiv2_driver_set_nmax(driver.get(), most_steps);

  double t = problem.t0;
  std::vector<double> y(problem.y0.begin(), problem.y0.end());
  std::vector<std::vector<double>> values;
  for (const double wanted : problem.times) {
    const int status =
        wanted > t ? gsl_odeiv2_driver_apply(driver.get(), &t, wanted, y.data()) : GSL_SUCCESS;
    if (guarded.thrown) std::rethrow_exception(guarded.thrown);
    if (status != GSL_SUCCESS) throw std::runtime_error(failure(method, t, status));
    if (!all_finite(y)) throw std::runtime_error(failure(method, t, GSL_EOVRFLW));
    values.push_back(y);
  }
  return values;
}

double largest_difference(const std::vector<double>& p, const std::vector<double>& q) {
  double largest = 0;
  for (std::size_t i = 0; i < p.size(); ++i) largest = std::max(largest, std::abs(p[i] - q[i]));
  return largest;
}

/// A function of one number as GSL calls it, and the error raised in it.
struct GuardedFunction {
  const std::function<double(double)>& f;
  std::exception_ptr thrown = nullptr;
};

extern "C" double call_function(double x, void* guarded_function) {
  auto* guarded = static_cast<GuardedFunction*>(guarded_function);
  try {
    return guarded->f(x);
  } catch (...) {
    guarded->thrown = std::current_exception();
    return GSL_NAN;
  }
}

struct FreeRootSolver {
  void operator()(gsl_root_fsolver* solver) const { gsl_root_fsolver_free(solver); }
};

}  // namespace

ReferenceSolution reference_solution(const RightHandSide& rhs, std::span<const double> y0,
                                     double t0, std::span<const double> times, double tolerance) {
  require(!y0.empty() && !times.empty(), "reference_solution: y0 and times must not be empty");
  require(all_finite(y0) && std::isfinite(t0), "reference_solution: y0 and t0 must be finite");
  require(times.front() >= t0 && std::is_sorted(times.begin(), times.end()),
          "reference_solution: times must ascend from t0");
  require(std::isfinite(times.back()), "reference_solution: times must be finite");
  require(tolerance >= 1e-14 && tolerance <= 1e-3,
          "reference_solution: tolerance must be in [1e-14, 1e-3]");
  gsl_set_error_handler_off();

  const Problem problem{rhs, y0, t0, times};
  ReferenceSolution solution{
      {times.begin(), times.end()}, integrate(problem, gsl_odeiv2_step_rk8pd, tolerance), {}};
  const std::vector<std::vector<double>> looser =
      integrate(problem, gsl_odeiv2_step_rk8pd, 10 * tolerance);
  const std::vector<std::vector<double>> other =
      integrate(problem, gsl_odeiv2_step_rkck, tolerance);
  for (std::size_t i = 0; i < times.size(); ++i) {
    const std::vector<double>& y = solution.values[i];
    solution.uncertainty.push_back(
        std::max(largest_difference(y, looser[i]), largest_difference(y, other[i])));
  }
  return solution;
}

Estimate bracketed_root(const std::function<double(double)>& f, double lower, double upper,
                        double width) {
  require(lower < upper && std::isfinite(lower) && std::isfinite(upper),
          "bracketed_root: lower must be below upper");
  require(width >= 0, "bracketed_root: width must be at least 0");
  gsl_set_error_handler_off();
  GuardedFunction guarded{f};
  gsl_function function{call_function, &guarded};
  const std::unique_ptr<gsl_root_fsolver, FreeRootSolver> solver(
      gsl_root_fsolver_alloc(gsl_root_fsolver_brent));
  if (!solver) throw std::runtime_error("oracle gsl: no memory for a root solver");

  int status = gsl_root_fsolver_set(solver.get(), &function, lower, upper);
  if (guarded.thrown) std::rethrow_exception(guarded.thrown);
  require(status != GSL_EINVAL, "bracketed_root: f must have opposite signs at lower and upper");
  for (int i = 0; i < most_root_steps && status == GSL_SUCCESS; ++i) {
    const double root = gsl_root_fsolver_root(solver.get());
    const double bracket =
        gsl_root_fsolver_x_upper(solver.get()) - gsl_root_fsolver_x_lower(solver.get());
    if (bracket <= std::max(width, 4 * std::numeric_limits<double>::epsilon() * std::abs(root))) {
      return {root, bracket};
    }
    status = gsl_root_fsolver_iterate(solver.get());
    if (guarded.thrown) std::rethrow_exception(guarded.thrown);
  }
  const std::string reason =
      status == GSL_SUCCESS ? "the bracket does not shrink" : gsl_strerror(status);
  throw std::runtime_error("oracle gsl: bracketed_root: " + reason);
}

}  // namespace foldproof::oracles
