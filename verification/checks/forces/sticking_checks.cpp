#include "verification/checks/forces/sticking_checks.h"

namespace foldproof {

std::vector<Check> sticking_checks() {
  std::vector<Check> all;
  for (const auto& part :
       {sticking_force_checks, sticking_motion_checks, sticking_bond_checks, sticking_scene_checks})
    for (const Check& check : part()) all.push_back(check);
  return all;
}

}  // namespace foldproof
