#include "verification/checks/dynamics/dynamics_checks.h"

namespace foldproof {

std::vector<Check> dynamics_checks() {
  std::vector<Check> all;
  for (const auto& part :
       {oscillator_checks, exact_motion_checks, momentum_checks, step_checks, symmetry_checks, run_checks,
        resume_checks, event_checks, method_checks, energy_checks})
    for (const Check& check : part()) all.push_back(check);
  return all;
}

}  // namespace foldproof
