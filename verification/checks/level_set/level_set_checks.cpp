#include "verification/checks/level_set/level_set_checks.h"

namespace foldproof {

std::vector<Check> level_set_checks() {
  std::vector<Check> all;
  for (const auto& part : {mesh_distance_checks(), grid_checks(), marching_checks(), closed_mesh_checks(),
                           repair_checks(), mesh_body_checks(), content_checks()})
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace foldproof
