// Oracles checked by oracles: each is compared with an independent computation at several
// parameter points.
#pragma once

#include <vector>

#include "verification/checks/oracles/agreement.h"

namespace foldproof {

// oracle_force_checks.cpp
Table hinge_angles_agree();
Table bending_modes_agree();
Table bending_forces_agree();
Table bending_derivatives_agree();
Table spring_forces_agree();
Table sticking_forces_agree();
Table sheet_moduli_agree();

// oracle_motion_checks.cpp
Table oscillators_agree();
Table verlet_oscillators_agree();
Table step_matrices_agree();
Table stable_steps_agree();
Table falls_agree();
Table rotation_lengths_agree();
Table amplification_factors_agree();
Table runge_kutta_limits_agree();
Table forecasts_agree();
Table limited_springs_agree();

// oracle_static_checks.cpp, oracle_strip_checks.cpp
Table heavy_cantilevers_agree();
Table loaded_tips_agree();
Table bent_strips_agree();
Table rigidities_agree();
Table free_folds_agree();
Table tipping_ribbons_agree();
Table stretched_wrinkles_agree();
Table deep_wrinkles_agree();
Table clamped_stresses_agree();
Table hung_cones_agree();
Table sagging_rings_agree();
Table hung_chains_agree();
Table depth_maps_agree();
Table dense_algebra_agrees();

// oracle_geometry_checks.cpp
Table crossing_times_agree();
Table polynomial_roots_agree();
Table crossings_agree();
Table sides_agree();
Table distances_agree();

std::vector<Check> oracle_checks();

}  // namespace foldproof
