#include "verification/checks.h"

#include "verification/checks/forces/bending_checks.h"
#include "verification/checks/filters/contact_checks.h"
#include "verification/checks/filters/crossing_checks.h"
#include "verification/checks/level_set/deforming_checks.h"
#include "verification/checks/forces/differential_checks.h"
#include "verification/checks/dynamics/dynamics_checks.h"
#include "verification/checks/forces/force_checks.h"
#include "verification/checks/level_set/level_set_checks.h"
#include "verification/checks/mesh/mesh_checks.h"
#include "verification/checks/oracles/oracle_checks.h"
#include "verification/checks/post/projection_checks.h"
#include "verification/checks/level_set/octree_checks.h"
#include "verification/checks/scene/scene_checks.h"
#include "verification/checks/filters/self_collision_checks.h"
#include "verification/checks/dynamics/solver_checks.h"
#include "verification/checks/forces/sticking_checks.h"
#include "verification/checks/filters/strain_limit_checks.h"

namespace foldproof {

std::vector<Check> all_checks() {
  std::vector<Check> all;
  for (const auto& part : {oracle_checks(),
                           mesh_checks(),
                           force_checks(),
                           bending_checks(),
                           differential_checks(),
                           force_differential_checks(),
                           solver_checks(),
                           unsymmetric_solver_checks(),
                           cached_terms_checks(),
                           dynamics_checks(),
                           contact_checks(),
                           scene_checks(),
                           level_set_checks(),
                           projection_checks(),
                           octree_checks(),
                           octree_union_checks(),
                           deforming_checks(),
                           self_collision_checks(),
                           crossing_checks(),
                           sticking_checks(),
                           strain_limit_checks()})
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace foldproof
