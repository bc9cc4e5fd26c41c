#include "reference/dynamics/integrator.h"

#include "reference/dynamics/explicit.h"
#include "reference/dynamics/implicit.h"
#include "reference/dynamics/mixed.h"

namespace foldproof {

namespace {

// BDF2 is zero-stable below 1 + sqrt(2) (Hairer, Norsett, Wanner, Solving ODEs I, section III.5).
constexpr double bdf2_growth = 2.4;

}  // namespace

const std::vector<Integrator>& integrators() {
  using enum Family;
  static const std::vector<Integrator> table = {
      {"A", "mixed explicit/implicit", "BMF03 section 3, first list", 2, 1,
       mixed_explicit_implicit},
      {"B", "central Newmark", "BMF03 section 3, second list", 2, 1, central_newmark},
      {"C", "variable-step Newmark", "BMF03 section 3, last list", 2, 1, variable_step_newmark,
       mixed, std::numeric_limits<double>::infinity(), true},
      {"forward-euler", "forward Euler", "Euler 1768", 1, 1, forward_euler, fully_explicit},
      {"RK2", "explicit midpoint", "Runge 1895", 2, 1, explicit_midpoint, fully_explicit},
      {"SSP-RK3", "SSP Runge-Kutta 3", "Shu and Osher 1988", 3, 1, ssp_runge_kutta_3,
       fully_explicit},
      {"RK4", "classical Runge-Kutta 4", "Kutta 1901", 4, 1, runge_kutta_4, fully_explicit},
      {"backward-euler", "backward Euler", "BMF03 section 3", 1, 1, backward_euler, fully_implicit},
      {"linear-backward-euler", "linearised backward Euler", "Baraff and Witkin 1998", 1, 1,
       linearised_backward_euler, fully_implicit},
      {"BDF2", "BDF2", "Hairer, Norsett, Wanner, section III.5", 2, 2, bdf2, fully_implicit,
       bdf2_growth},
      {"implicit-midpoint", "implicit midpoint", "Hairer, Lubich, Wanner, section II.1", 2, 1,
       implicit_midpoint, fully_implicit},
  };
  return table;
}

std::vector<Integrator> paper_schemes() {
  std::vector<Integrator> schemes;
  for (const Integrator& integrator : integrators())
    if (integrator.family == Family::mixed) schemes.push_back(integrator);
  return schemes;
}

const Integrator& integrator_named(std::string_view name) {
  std::string known;
  for (const Integrator& integrator : integrators()) {
    if (integrator.name == name) return integrator;
    known += (known.empty() ? "" : ", ") + std::string(integrator.name);
  }
  throw InputError("unknown integrator '" + std::string(name) + "'; known: " + known);
}

}  // namespace foldproof
