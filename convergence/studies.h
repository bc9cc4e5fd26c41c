// The studies: rates and costs, measured over a range. Their findings are judged like checks.
#pragma once

#include <vector>

#include "verification/verdict.h"

namespace foldproof {

Study hinge_time_order();  // time-order.hinge: errors at the end of a driven hinge's motion against the step
Study sheet_time_order();  // time-order.sheet: the same on a hanging sheet
Study momentum_drift();    // momentum-drift: angular momentum of a free sheet
Study cg_iterations();     // cg-iterations: cost of the implicit solves
Study bending_scaling();   // bending-scaling: bending damping under refinement
Study elastic_limit_study();      // elastic-limit: the largest stable step under refinement
Study stability_oscillator();     // stability-oscillator: every method's limit over the damping ratio
Study stability_sheet();          // stability-sheet: limits of a sheet over damping and resolution
Study variable_step_stability();  // variable-step-stability: stable steps in turn; BDF2's growing steps
Study transient_growth_study();   // transient-growth: how far a stable scheme carries a disturbance
Study bending_rigidity_study();   // bending-rigidity: by pattern, direction and size of the triangles
Study cantilever_study();         // cantilever: a clamped strip's tip against the elastica
Study strip_vibration_study();    // strip-vibration: lowest frequencies of a clamped strip
Study shape_return_study();       // shape-return: a sculpted shell pulled out of shape and let go
Study hard_limits();           // hard-limits: largest stable steps of hard sheets, under damping, over jumps
Study buckling();              // buckling: critical load and growth of a compressed strip
Study mirror_symmetry();       // mirror-symmetry: how rounding breaks it
Study work_precision();        // work-precision: error against work and seconds, all methods
Study solve_tolerance();       // solve-tolerance: how loose a solve may be before the order suffers
Study octree_memory();         // octree-memory: an octree against a grid of the same error
Study level_sets_in_time();    // level-sets-in-time: between two frames of a body that deforms
Study level_set_cache();       // level-set-cache: level sets computed once for many runs
Study mesh_error();            // mesh-error: error of the mesh beside that of the step
Study artificial_damping();    // artificial-damping: what methods take from vibrations that nothing damps
Study monotonicity();          // monotonicity: coming to rest in steps longer than the damping's time
Study level_set_resolution();  // level-set-resolution: distance and normals of grids against their spacing
Study wrinkles_kept();         // wrinkles-kept: what each map of depth leaves of wrinkles inside an object
Study eps_needed();            // eps-needed: how far out the deepest points must go
Study sharp_edges();           // sharp-edges: normals of samples next to a body's edges
Study folds_inside();          // folds-inside: folds of cloth that may stay inside of an object
Study forecast_time_study();   // forecast-time: where a point is after its forecast, and what tau does
Study resting_contact();       // resting-contact: what keeps moving under each response
Study self_collision_cost();   // self-collision-cost: search, zones, gaps at rest
Study pointwise_contact();     // pointwise-contact: what lies between particles that are held out
Study crossing_queries();      // crossing-queries: moving features that meet, and whether that is noticed
Study sticking_lag();     // sticking-lag: lag, limits and cost of what sticks, with forecasts and without
Study strain_sweeps();    // strain-sweeps: sweeps of strain limiting over mesh and order
Study strain_momentum();  // strain-momentum: angular momentum at the strain limits
Study biphasic();         // biphasic: weak springs with limits under a growing load
Study folding();          // folding: 0 % compression between ends that come together

/// All of them, in the order in which they are reported.
std::vector<Study> all_studies();

}  // namespace foldproof
