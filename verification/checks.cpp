#include "verification/checks.h"

#include "verification/checks/bodies/body_checks.h"
#include "verification/checks/dynamics/dynamics_checks.h"
#include "verification/checks/filters/filter_checks.h"
#include "verification/checks/forces/force_checks.h"
#include "verification/checks/level_set/level_set_checks.h"
#include "verification/checks/mesh/mesh_checks.h"
#include "verification/checks/oracles/oracle_checks.h"
#include "verification/checks/post/projection_checks.h"
#include "verification/checks/scene/scene_checks.h"

namespace foldproof {

std::vector<Check> all_checks() {
  std::vector<Check> all;
  for (const auto& part :
       {// oracles
        oracle_checks,
        // mesh
        mesh_checks, mesh_rejection_checks,
        // forces
        spring_checks, force_checks, bending_checks, bending_mode_checks,
        bending_alternative_checks, buckling_spring_checks, bending_angle_checks,
        bending_energy_checks, bending_damping_checks, bending_shape_checks, differential_checks,
        force_differential_checks,
        // dynamics
        solver_checks, unsymmetric_solver_checks, cached_terms_checks, oscillator_checks,
        exact_motion_checks, momentum_checks, step_checks, symmetry_checks, run_checks,
        resume_checks, thread_checks, reuse_checks, event_checks, method_checks,
        other_method_checks, energy_checks,
        // filters
        object_checks, response_checks, object_response_checks, pinch_checks, friction_checks,
        capstan_checks,
        // scene
        scene_rejection_checks, scene_meaning_checks, scene_place_checks, scene_object_checks,
        scene_body_checks, scene_cloth_checks,
        // mesh
        seam_checks, split_fan_checks,
        // level_set
        mesh_distance_checks, grid_checks, marching_checks,
        // bodies
        closed_mesh_checks, repair_checks, mesh_body_checks, content_checks,
        // post
        depth_map_checks, projection_checks, projection_exact_checks, projection_cloth_checks,
        projection_mesh_checks, smooth_cloth_checks,
        // level_set
        octree_checks, octree_union_checks, deforming_checks, level_set_thread_checks,
        // filters
        repulsion_checks, impact_checks, untangling_checks, impulse_checks, crossing_checks,
        // forces
        sticking_force_checks, sticking_motion_checks, sticking_bond_checks,
        // scene
        sticking_scene_checks,
        // filters
        strain_limit_checks, strain_step_checks})
    for (Check& check : part()) all.push_back(std::move(check));
  return all;
}

}  // namespace foldproof
