#include "verification/checks/oracles/oracle_checks.h"

#include <string>

namespace foldproof {

namespace {

struct Comparison {
  const char *name, *claim;
  Table (*answers)();
  double allowed = 1e-5;  // uncertainty of an answer over its size [1]
};

constexpr Comparison comparisons[] = {
    {"oracle.hinge-angles-agree",
     "The oracle's angle by atan2 and its printed sin(theta/2) agree, both in 50 digits.",
     hinge_angles_agree},
    {"oracle.bending-modes-agree",
     "The oracle's bending mode as printed is minus the gradient of theta by automatic "
     "differentiation, which is that by differences.",
     bending_modes_agree},
    {"oracle.bending-forces-agree",
     "The oracle's elastic force as printed is minus the gradient of the energy, its damping force "
     "follows from the power that it takes.",
     bending_forces_agree},
    {"oracle.bending-derivatives-agree",
     "The oracle's derivatives of bending forces by automatic differentiation are those by "
     "differences in 50 digits.",
     bending_derivatives_agree},
    {"oracle.spring-forces-agree",
     "The oracle's spring force is minus the gradient of its energy, and its derivative is that by "
     "differences.",
     spring_forces_agree},
    {"oracle.sticking-forces-agree",
     "The oracle's sticking force, by automatic differentiation, is minus the slope of its energy "
     "by differences.",
     sticking_forces_agree},
    {"oracle.sheet-moduli-agree",
     "The oracle's closed-form moduli of a sheet of springs follow from the energy of one cell's "
     "springs.",
     sheet_moduli_agree},
    {"oracle.oscillators-agree",
     "The oracle's closed form of the damped oscillator is what GSL's Runge-Kutta methods find, "
     "weakly, critically and strongly damped.",
     oscillators_agree},
    {"oracle.verlet-oscillators-agree",
     "The oracle's closed form of velocity Verlet gives what a thousand undamped steps of schemes "
     "A, B and C give in 50 digits.",
     verlet_oscillators_agree},
    {"oracle.step-matrices-agree",
     "The oracle's step matrices are the printed lines of schemes A, B and C in 50 digits.",
     step_matrices_agree},
    {"oracle.stable-steps-agree",
     "At the oracle's closed-form stability limits the printed step has an eigenvalue -1, and the "
     "stiffness's eigenvalues give the same limits.",
     stable_steps_agree},
    {"oracle.free-falls-agree",
     "The oracle's free fall in closed form is what GSL's Runge-Kutta methods find.", falls_agree},
    {"oracle.turning-pair-lengths-agree",
     "At the oracle's closed-form length of a turning pair the spring's force is the centripetal "
     "force.",
     rotation_lengths_agree},
    {"oracle.amplification-factors-agree",
     "The oracle's factors of one step multiply and add up as the oscillator's, and agree with the "
     "methods' stages.",
     amplification_factors_agree},
    {"oracle.runge-kutta-limits-agree",
     "The oracle's stability limits of Runge-Kutta methods by polynomials and closed-form rates "
     "are those by stages and eigenvalues.",
     runge_kutta_limits_agree},
    {"oracle.forecasts-agree",
     "The oracle's forecast with Coulomb friction uses the impulse within the cone that leaves the "
     "least sliding speed.",
     forecasts_agree},
    {"oracle.strain-limiting-impulses-agree",
     "The oracle's strain-limiting impulse by Pythagoras is the root of the equation for the "
     "length after it.",
     limited_springs_agree},
    {"oracle.heavy-cantilevers-agree",
     "The oracle's heavy cantilever by GSL from its tip is that by power series from its clamp.",
     heavy_cantilevers_agree},
    {"oracle.loaded-strips-agree",
     "The oracle's loaded strip by elliptic integrals is that by GSL's shooting and that by power "
     "series.",
     loaded_tips_agree},
    {"oracle.bent-strips-agree",
     "The oracle's strips by collocation are those by GSL's shooting from the clamp, and from the "
     "tip where one end is free.",
     bent_strips_agree},
    {"oracle.rigidities-agree",
     "The oracle's rigidities of a periodic cell are those of a patch of hinges, and of the same "
     "mesh turned by 45 degrees.",
     rigidities_agree},
    {"oracle.free-folds-agree",
     "The oracle's free fold by shooting from its lift-off is that by collocation between clamps.",
     free_folds_agree},
    {"oracle.tipping-ribbons-agree",
     "The oracle's load under which a ribbon on edge tips over is the same by power series and by "
     "GSL, and ribbons of more rows gain the rigidity of a periodic cell.",
     tipping_ribbons_agree},
    {"oracle.stretched-wrinkles-agree",
     "The oracle's wrinkles of a stretched sheet by functions are those by a series, and tend to "
     "the scaling law; the rigidity that tension adds is that of a lattice of springs.",
     stretched_wrinkles_agree},
    {"oracle.deep-wrinkles-agree",
     "The oracle's heights of wrinkles beyond their onset are the same by a series and by "
     "shooting, and tend to a closed form far beyond it.",
     deep_wrinkles_agree},
    {"oracle.clamped-stresses-agree",
     "The oracle's stress across a stretched, clamped sheet is the same from stresses of least "
     "complementary energy and from displacements of least strain energy.",
     clamped_stresses_agree, 5e-4},
    {"oracle.hung-cones-agree",
     "The oracle's cone that hangs from its tip is the same by a series and by shooting, and tends "
     "to that of small slopes.",
     hung_cones_agree},
    {"oracle.sagging-rings-agree",
     "The oracle's ring of plate that is clamped along its inner edge sags as far by a formula as "
     "by least energy.",
     sagging_rings_agree},
    {"oracle.hung-chains-agree",
     "The oracle's hanging chains are the same by functions, by power series and by GSL: shapes, "
     "pulls and frequencies.",
     hung_chains_agree},
    {"oracle.depth-maps-agree",
     "The oracle's depth maps in closed form are solutions of the differential equations that "
     "define them.",
     depth_maps_agree},
    {"oracle.dense-algebra-agrees",
     "The oracle's eigenvalues, solutions, singular values and rotations are those that the "
     "matrices were built from.",
     dense_algebra_agrees},
    {"oracle.crossing-times-agree",
     "The oracle's exact crossings of moving features by roots agree with bisection in time, "
     "wherever bisection decides.",
     crossing_times_agree},
    {"oracle.polynomial-roots-agree",
     "The oracle's roots of integer polynomials, and the signs of others there, are those that the "
     "polynomials were built from.",
     polynomial_roots_agree},
    {"oracle.crossings-agree",
     "The oracle's crossings by a sweep are those of all pairs, which are the pairs that no "
     "direction separates.",
     crossings_agree},
    {"oracle.inside-tests-agree",
     "The oracle's inside test by segments agrees with the test of a prism by angles, even at "
     "points on the surface.",
     sides_agree},
    {"oracle.distances-agree",
     "The oracle's distances of features in 50 digits agree with those by foot points in extended "
     "precision and by ternary search.",
     distances_agree}};

Finding uncertainties_are_small(const Subject&) {
  Table largest{{"comparison", ""},
                {"largest uncertainty of a pair, of its answer", "1"},
                {"allowed", "1"},
                {"over what is allowed", "1"}};
  for (const Comparison& comparison : comparisons) {
    const double uncertainty = largest_uncertainty(comparison.answers());
    largest.row(comparison.name, uncertainty, comparison.allowed, uncertainty / comparison.allowed);
  }
  return judge_worst(largest, 1,
                     "two answers may agree merely because one of them is very uncertain: the "
                     "crudest, by differences in double precision, is good to five digits; "
                     "stresses of a clamped sheet, which are infinite in its corners, to three");
}

}  // namespace

std::vector<Check> oracle_checks() {
  std::vector<Check> list;
  for (const Comparison& comparison : comparisons)
    list.push_back(
        {comparison.name, comparison.claim, "verification/oracles/README.md",
         [answers = comparison.answers](const Subject&) { return judged_agreement(answers()); }});
  list.push_back({"oracle.uncertainties-are-small",
                  "The uncertainty of any two compared answers is a small part of the answer.",
                  "verification/oracles/README.md", uncertainties_are_small});
  return list;
}

}  // namespace foldproof
