// Oracles judged by oracles: each is held against a second road to the same numbers, at several parameter
// points.
#pragma once

#include <vector>

#include "verification/checks/oracles/agreement.h"

namespace foldproof {

// oracle_force_checks.cpp
Agreement hinge_angles_agree();
Agreement bending_modes_agree();
Agreement bending_forces_agree();
Agreement bending_derivatives_agree();
Agreement spring_forces_agree();
Agreement sticking_forces_agree();
Agreement sheet_moduli_agree();

// oracle_motion_checks.cpp
Agreement oscillators_agree();
Agreement verlet_oscillators_agree();
Agreement step_matrices_agree();
Agreement stable_steps_agree();
Agreement falls_agree();
Agreement rotation_lengths_agree();
Agreement amplification_factors_agree();
Agreement runge_kutta_limits_agree();
Agreement forecasts_agree();
Agreement limited_springs_agree();

// oracle_static_checks.cpp
Agreement heavy_cantilevers_agree();
Agreement loaded_tips_agree();
Agreement rigidities_agree();
Agreement depth_maps_agree();
Agreement dense_algebra_agrees();

// oracle_geometry_checks.cpp
Agreement crossing_times_agree();
Agreement polynomial_roots_agree();
Agreement crossings_agree();
Agreement sides_agree();
Agreement distances_agree();

std::vector<Check> oracle_checks();

}  // namespace foldproof
