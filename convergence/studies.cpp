#include "convergence/studies.h"

namespace foldproof {

std::vector<Study> all_studies() {
  return {hinge_time_order(),    sheet_time_order(), momentum_drift(), cg_iterations(),  bending_scaling(),
          elastic_limit_study(), hard_limits(),      buckling(),       mirror_symmetry()};
}

}  // namespace foldproof
