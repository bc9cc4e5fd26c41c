#include "convergence/studies.h"

#include "convergence/bending/studies.h"
#include "convergence/conjugate_gradients/studies.h"
#include "convergence/contact/studies.h"
#include "convergence/damping/studies.h"
#include "convergence/integrators/studies.h"
#include "convergence/level_sets/studies.h"
#include "convergence/stability/studies.h"
#include "convergence/sticking/studies.h"
#include "convergence/strain/studies.h"
#include "convergence/work_precision/studies.h"

namespace foldproof {

std::vector<Study> all_studies() {
  return {hinge_time_order(),
          sheet_time_order(),
          work_precision(),
          solve_tolerance(),
          mesh_error(),
          momentum_drift(),
          cg_iterations(),
          bending_scaling(),
          elastic_limit_study(),
          stability_oscillator(),
          stability_sheet(),
          variable_step_stability(),
          transient_growth_study(),
          bending_rigidity_study(),
          cantilever_study(),
          strip_vibration_study(),
          shape_return_study(),
          hard_limits(),
          buckling(),
          mirror_symmetry(),
          artificial_damping(),
          monotonicity(),
          octree_memory(),
          level_sets_in_time(),
          level_set_cache(),
          level_set_resolution(),
          wrinkles_kept(),
          eps_needed(),
          sharp_edges(),
          folds_inside(),
          forecast_time_study(),
          resting_contact(),
          pointwise_contact(),
          self_collision_cost(),
          crossing_queries(),
          strain_sweeps(),
          strain_momentum(),
          biphasic(),
          folding(),
          sticking_lag()};
}

}  // namespace foldproof
