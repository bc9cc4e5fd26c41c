#include "convergence/studies.h"

#include "convergence/any_case/studies.h"
#include "convergence/bending/studies.h"
#include "convergence/conjugate_gradients/studies.h"
#include "convergence/contact/studies.h"
#include "convergence/damping/studies.h"
#include "convergence/integrators/studies.h"
#include "convergence/level_sets/studies.h"
#include "convergence/stability/studies.h"
#include "convergence/sticking/studies.h"
#include "convergence/strain/studies.h"
#include "convergence/validation/studies.h"
#include "convergence/work_precision/studies.h"

namespace foldproof {

std::vector<Study> all_studies() {
  return {hinge_time_order_study(),
          sheet_time_order_study(),
          filtered_order_study(),
          work_precision_study(),
          price_by_scene_study(),
          solve_tolerance_study(),
          long_contact_study(),
          mesh_error_study(),
          momentum_drift_study(),
          cg_iterations_study(),
          bending_scaling_study(),
          elastic_limit_study(),
          stability_oscillator_study(),
          stability_sheet_study(),
          variable_step_stability_study(),
          transient_growth_study(),
          frame_long_steps_study(),
          bending_rigidity_study(),
          cantilever_study(),
          strip_vibration_study(),
          shape_return_study(),
          hard_limits_study(),
          buckling_study(),
          mirror_symmetry_study(),
          artificial_damping_study(),
          monotonicity_study(),
          octree_memory_study(),
          level_sets_in_time_study(),
          level_set_cache_study(),
          level_set_resolution_study(),
          wrinkles_kept_study(),
          eps_needed_study(),
          sharp_edges_study(),
          folds_inside_study(),
          forecast_time_study(),
          resting_contact_study(),
          pointwise_contact_study(),
          self_collision_cost_study(),
          crossing_queries_study(),
          contact_answers_study(),
          strain_sweeps_study(),
          strain_momentum_study(),
          biphasic_study(),
          folding_study(),
          sticking_lag_study(),
          heavy_cantilever_study(),
          strip_tests_study(),
          fold_tests_study(),
          free_fold_study(),
          pressed_strip_study(),
          lateral_buckling_study(),
          stretched_wrinkles_study(),
          hanging_chain_study(),
          friction_tests_study(),
          cusick_drape_study(),
          hung_disc_study(),
          fabric_strip_study()};
}

}  // namespace foldproof
