// Claims of BMF03 section 3: time integration and the linear solve.
#include <fmt/format.h>

#include "verification/claims/claims.h"

namespace foldproof {

namespace {

/// The findings time-order.<problem>.<scheme>.<steps>.<x or v> of both problems.
std::vector<Decider> orders_of(const std::string& scheme, const std::vector<std::string>& step_patterns) {
  std::vector<Decider> deciders;
  for (const char* problem : {"hinge", "sheet"})
    for (const std::string& pattern : step_patterns)
      for (const char* quantity : {"x", "v"})
        deciders.push_back(
            {fmt::format("time-order.{}.{}.{}.{}", problem, scheme, pattern, quantity), Role::supports});
  return deciders;
}

/// The same finding of several schemes, "<name>.<scheme>".
std::vector<Decider> each(const std::vector<std::string>& schemes, const std::string& name) {
  std::vector<Decider> deciders;
  for (const std::string& scheme : schemes) deciders.push_back({name + "." + scheme, Role::supports});
  return deciders;
}

std::vector<Decider> joined(std::vector<Decider> deciders, const std::vector<Decider>& more) {
  deciders.insert(deciders.end(), more.begin(), more.end());
  return deciders;
}

std::vector<Claim> orders_and_limits() {
  return {
      {"T1", "3",
       "Scheme A joins leapfrog for the positions with the trapezoidal rule for the velocities, and is "
       "of second order as a whole.",
       joined({{"dynamics.lines-one-and-four-are-the-trapezoidal-rule.A", Role::supports}},
              orders_of("A", {"constant", "alternating", "random"})),
       Standing::confirmed, "",
       "Without a filter, A's velocities obey the trapezoidal rule to "
       "{dynamics.lines-one-and-four-are-the-trapezoidal-rule.A} of the velocity, less than the tolerance of "
       "the solve. On a driven, damped hinge with large angles the observed order in positions and "
       "velocities is within {largest of: time-order.hinge.A.constant.x, time-order.hinge.A.constant.v} of "
       "two, on a hanging sheet within {largest of: time-order.sheet.A.constant.x, "
       "time-order.sheet.A.constant.v}, there with random steps within {largest of: "
       "time-order.sheet.A.random.x, time-order.sheet.A.random.v}."},
      {"T2",
       "3",
       "Scheme A is stable for h below a constant times dx sqrt(rho/Y), however large the damping.",
       {{"dynamics.stability-limit-is-as-derived.A", Role::supports},
        {"elastic-limit.is-two-over-omega.springs.A", Role::supports},
        {"elastic-limit.is-two-over-omega.bending.A", Role::supports},
        {"elastic-limit.exponent.springs", Role::supports},
        {"elastic-limit.exponent.bending", Role::limits},
        {"stability-sheet.independent-of-damping.springs.A", Role::supports},
        {"stability-sheet.independent-of-damping.bending.A", Role::supports},
        {"stability-sheet.independent-of-damping.both.A", Role::supports}},
       Standing::conditional,
       "where springs, not hinges, decide the largest frequency: where bending dominates, the limit "
       "falls with the square of dx",
       "On the oscillator A is stable up to h = 2/omega and not beyond, whatever the damping: "
       "{dynamics.stability-limit-is-as-derived.A} of the tried steps were misjudged by that rule. On an "
       "undamped sheet the largest stable step is 2/omega too, to "
       "{elastic-limit.is-two-over-omega.springs.A}, and it falls with the width of a cell to a power of "
       "{elastic-limit.exponent.springs|exponent|last} where springs resist, but of "
       "{elastic-limit.exponent.bending|exponent|last} where hinges do. While the damping of springs, of "
       "hinges or of both rises by ten thousand the limit of a clamped sheet stays at 2/omega, to "
       "{stability-sheet.independent-of-damping.both.A}."}};
}

std::vector<Claim> limits_of_explicit_methods() {
  return {
      {"T3", "3", "A fully explicit method needs h below a constant times dx^2 rho/kd.",
       joined(each({"forward-euler", "RK2", "SSP-RK3", "RK4"}, "stability-sheet.limit.both"),
              {{"stability-sheet.damping-exponent.springs", Role::supports},
               {"stability-sheet.damping-exponent.bending", Role::limits}}),
       Standing::conditional,
       "where springs are damped: damped bending makes the limit fall with the cube of dx",
       "The largest stable steps of forward Euler and of Runge-Kutta methods of second, third and fourth "
       "order on a damped sheet are where their stability polynomials leave 1, to "
       "{largest of: stability-sheet.limit.both.forward-euler, stability-sheet.limit.both.RK2, "
       "stability-sheet.limit.both.SSP-RK3, stability-sheet.limit.both.RK4}. Where damping decides, "
       "that is the inverse of its largest rate, which falls with the width of a cell to a power of "
       "{stability-sheet.damping-exponent.springs|exponent|last} with damped springs, but of "
       "{stability-sheet.damping-exponent.bending|exponent|last} with damped bending."},
      {"T4",
       "3",
       "The extra factor dx of the explicit limit costs an order of magnitude: at dx = 1/10, a hundred "
       "steps in place of ten.",
       {{"stability-sheet.a-tenth.order-of-magnitude", Role::supports},
        {"stability-sheet.a-tenth.factor-exponent", Role::supports},
        {"work-precision.mixed-steps-are-larger.heavy-sheet", Role::supports}},
       Standing::confirmed,
       "",
       "On a sheet whose side, modulus, damping and density are one, cells of a tenth need "
       "{stability-sheet.a-tenth.order-of-magnitude|schemes A and B|2} steps in one unit of time under A "
       "and {stability-sheet.a-tenth.order-of-magnitude|classical Runge-Kutta 4|2} under classical "
       "Runge-Kutta: more than ten times as many, and the factor grows as one over the width, its exponent "
       "within {stability-sheet.a-tenth.factor-exponent} of that."}};
}

std::vector<Claim> damping_of_modes() {
  return {
      {"T5",
       "3",
       "A fully implicit method damps elastic modes that no material damping acts on.",
       {{"artificial-damping.everywhere.backward-euler", Role::supports},
        {"artificial-damping.order.backward-euler", Role::supports},
        {"artificial-damping.order.BDF2", Role::supports},
        {"artificial-damping.dies-out.backward-euler", Role::supports},
        {"artificial-damping.no-trend.implicit-midpoint", Role::limits}},
       Standing::conditional,
       "of backward Euler, which the paper names, and of BDF2: the implicit midpoint rule is fully implicit "
       "and damps nothing",
       "Under backward Euler an undamped vibration loses the part omega h pi of its amplitude in a period, "
       "to {artificial-damping.order.backward-euler} in the order. At half the elastic limit a hundred "
       "periods leave {artificial-damping.dies-out.backward-euler}. But the energy of the same sheet under "
       "the implicit midpoint rule has no trend: its slope is "
       "{artificial-damping.no-trend.implicit-midpoint} from zero."},
      {"T6", "3",
       "A method that is implicit in the damping only adds artificial damping only where there is damping.",
       joined(each({"A", "B", "C"}, "dynamics.undamped-oscillator-is-verlet"),
              joined(each({"A", "B", "C"}, "dynamics.time-reverses"),
                     joined(each({"A", "B", "C"}, "artificial-damping.only-where-damped"),
                            each({"A", "B", "C"}, "artificial-damping.no-trend")))),
       Standing::confirmed, "",
       "Undamped, all three schemes are velocity Verlet: over a thousand steps they stay within "
       "{dynamics.undamped-oscillator-is-verlet.A}, {dynamics.undamped-oscillator-is-verlet.B} and "
       "{dynamics.undamped-oscillator-is-verlet.C} of its closed solution, which keeps its amplitude for "
       "ever, and an undamped sheet runs backwards to where it came from. Where springs alone are damped "
       "heavily, or hinges alone, the vibrations of the other part change under A by "
       "{artificial-damping.only-where-damped.A}. Over a hundred periods the energy of an undamped sheet has "
       "no trend under A: its slope is {artificial-damping.no-trend.A} from zero."}};
}

std::vector<Claim> linear_solve() {
  return {
      {"T7",
       "3",
       "Damping forces are linear in the velocity with a symmetric Jacobian, so conjugate gradients apply "
       "without approximation.",
       {{"bending.damping-is-symmetric", Role::supports},
        {"bending.damping-is-negative-semidefinite", Role::supports},
        {"springs.damping-is-symmetric-negative-semidefinite", Role::supports},
        {"solver.operator-is-symmetric-positive-definite", Role::supports},
        {"solver.iterate-is-the-dense-cholesky-solution", Role::supports}},
       Standing::confirmed,
       "",
       "Assembled column by column from products alone, the matrices of bending damping are symmetric to "
       "{bending.damping-is-symmetric}, without a positive eigenvalue beyond rounding, and the solver's "
       "operator is symmetric and positive definite. What conjugate gradients return is what a dense "
       "factorisation returns."},
      {"T8",
       "3",
       "Conjugate gradients need fewer than ten iterations, typically, and sometimes one or two, without a "
       "preconditioner.",
       {{"cg-iterations.fewer-than-ten-in-the-typical-setting", Role::supports},
        {"cg-iterations.do-not-grow-with-the-mesh", Role::supports},
        {"cg-iterations.within-the-bound-of-theory", Role::supports},
        {"cg-iterations.ten-or-more-in-harder-settings", Role::limits}},
       Standing::conditional,
       "for moderate damping, tolerance and steps: iterations grow with the square root of damping ratio "
       "times step, and with the logarithm of the tolerance",
       "In the typical setting, on a noisy sheet at a damping ratio of a tenth, half the elastic limit and a "
       "tolerance of a ten-thousandth, the largest count of any solve is {bare: "
       "cg-iterations.fewer-than-ten-in-the-typical-setting} and the mean "
       "{cg-iterations.fewer-than-ten-in-the-typical-setting|mean iterations|largest}. Meshes are refined in "
       "a harder setting, at a damping ratio of three and a tolerance of a hundred-millionth, in which "
       "growth would show: there the mean goes with the cells along a side to the power "
       "{cg-iterations.do-not-grow-with-the-mesh}. Over all settings, with tolerance, damping ratio, step or "
       "mesh varied one at a time, the mean goes from {cg-iterations.ten-or-more-in-harder-settings|mean "
       "iterations|smallest} to {cg-iterations.ten-or-more-in-harder-settings|mean iterations|largest} a "
       "solve, and the largest count of any solve is "
       "{cg-iterations.ten-or-more-in-harder-settings|largest|largest}. With residuals compared with the "
       "initial one, the largest count of a setting is at most {cg-iterations.within-the-bound-of-theory} of "
       "what the condition of the matrix allows."}};
}

std::vector<Claim> cached_terms_and_filters() {
  return {
      {"T9",
       "3",
       "No matrix needs to be assembled; position-dependent terms are computed once a solve and cached.",
       {{"dynamics.position-terms-are-computed-once", Role::supports},
        {"solver.cached-terms-save-time", Role::supports},
        {"solver.cached-terms-take-less-memory-than-a-matrix", Role::supports}},
       Standing::confirmed,
       "",
       "A step of C prepares the position-dependent terms "
       "{dynamics.position-terms-are-computed-once|preparations a step|C} times and multiplies with them "
       "{dynamics.position-terms-are-computed-once|products a step|C} times. A product with cached terms "
       "takes {solver.cached-terms-save-time} of the time of one that computes them anew, and the cache "
       "takes {solver.cached-terms-take-less-memory-than-a-matrix} of the memory that half of the symmetric "
       "matrix would need."},
      {"T10", "3",
       "With positions stepped explicitly, velocities can be modified at will for many kinds of constraints.",
       each({"A", "B", "C"}, "dynamics.filters-act-on-the-moving-velocity"), Standing::confirmed, "",
       "The velocity that a filter leaves is exactly the one that moves the cloth: under A, B and C, x + h v "
       "and the new positions differ in {bare: largest of: dynamics.filters-act-on-the-moving-velocity.A, "
       "dynamics.filters-act-on-the-moving-velocity.B, dynamics.filters-act-on-the-moving-velocity.C} of "
       "their numbers. What a filter promises of the positions at the end of the step therefore comes true "
       "to the bit."}};
}

std::vector<Claim> overshooting_methods() {
  return {
      {"T13",
       "3",
       "For highly damped material A is stable but not monotone: its explicit half step overshoots.",
       {{"dynamics.stability-limit-is-as-derived.A", Role::supports},
        {"dynamics.pure-damping-displacement.A", Role::supports},
        {"monotonicity.overdamped-sheet.overshoots.A", Role::supports},
        {"transient-growth.A.grows-with-damping", Role::supports},
        {"transient-growth.A.exponent", Role::supports}},
       Standing::confirmed,
       "",
       "A particle that is only damped comes, under A, to a total displacement of 1 - (h c/2)^2 of the exact "
       "one, to {bare: dynamics.pure-damping-displacement.A}: at h c/2 = "
       "{dynamics.pure-damping-displacement.A|h c/2|5} that is "
       "{dynamics.pure-damping-displacement.A|displacement over exact|5} times the way it "
       "should go: backwards. It is stable all the same: with damping ratios up to "
       "{dynamics.stability-limit-is-as-derived.A|damping ratio|largest} the limit is 2/omega. On an "
       "overdamped sheet with stiffness it throws a mode back by "
       "{bare: monotonicity.overdamped-sheet.overshoots.A|positions|first} times its way at h c/2 = 10. In "
       "the norm of the energy, in which exact motion never grows, A carries a disturbance of a damped "
       "oscillator to as much as {transient-growth.A.grows-with-damping|growth|largest} times its size on "
       "the way, in proportion to the damping."},
      {"T14",
       "3",
       "Fully implicit methods of second order, such as BDF2, oscillate too at large steps.",
       {{"monotonicity.overshoots.BDF2", Role::supports},
        {"monotonicity.way.BDF2", Role::supports},
        {"monotonicity.overdamped-sheet.swings.implicit-midpoint", Role::supports}},
       Standing::confirmed,
       "",
       "A motion that is only damped overshoots its way and turns back under BDF2 once h c is large, as its "
       "recurrence says, to {monotonicity.way.BDF2}: by a tenth of the way at most, where A goes wrong by (h "
       "c/2)^2 ways. Under the implicit midpoint rule velocities on an overdamped sheet with stiffness swing "
       "by up to {monotonicity.overdamped-sheet.swings.implicit-midpoint|velocities|last}."}};
}

std::vector<Claim> monotone_methods() {
  return {
      {"T15",
       "3",
       "Backward Euler is monotone for every step.",
       {{"monotonicity.monotone.backward-euler", Role::supports},
        {"monotonicity.monotone.linear-backward-euler", Role::supports},
        {"monotonicity.overdamped-sheet.monotone.backward-euler", Role::supports},
        {"monotonicity.overdamped-sheet.monotone.linear-backward-euler", Role::supports},
        {"monotonicity.closing-hinge.backward-euler", Role::supports},
        {"monotonicity.monotone-on-a-hinge.linear-backward-euler", Role::supports},
        {"monotonicity.passes-its-place.backward-euler", Role::limits}},
       Standing::conditional,
       "on linear motions, and on nonlinear ones that stiffness brings to rest: where damping alone does, "
       "and changes with the shape, the fully implicit method goes too far",
       "At no step tried does a linear motion overshoot or turn back, fully implicit "
       "({monotonicity.monotone.backward-euler}) or linearised "
       "({monotonicity.monotone.linear-backward-euler}), nor on a sheet whose stiffness damping outweighs "
       "({monotonicity.overdamped-sheet.monotone.backward-euler}). An overdamped hinge that closes by nearly "
       "two radians comes to its rest angle without passing it, to "
       "{monotonicity.closing-hinge.backward-euler}. On a hinge without stiffness the linearised method "
       "turns back by {monotonicity.monotone-on-a-hinge.linear-backward-euler}, no more than the exact "
       "motion allows; the fully implicit one, which takes the damping at the step's end, goes "
       "{bare: monotonicity.passes-its-place.backward-euler|farthest|largest} times the exact way, and stays "
       "there."},
      {"T16",
       "3",
       "B, with A's velocity steps in the other order, does not have A's trouble.",
       {{"dynamics.pure-damping-displacement.B", Role::supports},
        {"monotonicity.bounded.B", Role::supports},
        {"monotonicity.below-one.B", Role::supports},
        {"monotonicity.overdamped-sheet.bounded.B", Role::supports},
        {"monotonicity.overdamped-sheet.swings.B", Role::limits},
        {"monotonicity.alternates.B", Role::limits}},
       Standing::conditional,
       "in a bounded sense: no linear motion overshoots by more than the way itself, but for h c/2 > 1 the "
       "velocity changes its sign in every step",
       "Under B the total displacement of a particle that is only damped is the exact one, to "
       "{dynamics.pure-damping-displacement.B}, and no linear motion tried came further than "
       "{monotonicity.bounded.B}, however large the damping. For h c/2 below one it is monotone. On an "
       "overdamped sheet with stiffness positions overshoot by up to "
       "{monotonicity.overdamped-sheet.bounded.B|positions|largest} and velocities by "
       "{monotonicity.overdamped-sheet.bounded.B|velocities|largest}."}};
}

std::vector<Claim> variable_steps() {
  return {
      {"T17", "3", "B is second order and stable only while the step is constant.",
       joined(orders_of("B", {"constant"}),
              {{"time-order.hinge.observed-in-B-with-variable-steps", Role::contradicts},
               {"time-order.sheet.observed-in-B-with-variable-steps", Role::contradicts},
               {"variable-step-stability.resonance.B", Role::supports}}),
       Standing::refuted, "",
       "With steps that alternate nine to one, and with random ones, B's observed order stays within "
       "{time-order.hinge.observed-in-B-with-variable-steps} of two on a driven hinge and within "
       "{time-order.sheet.observed-in-B-with-variable-steps} on a sheet. B is a one-step map whose local "
       "error is of third order in x and in v, so its order cannot depend on the steps before. The other "
       "half of the sentence stands, though not for B alone: undamped, B is unstable with pairs of steps "
       "each of which is stable, and so are A and C."},
      {"T18", "3", "C is second order and monotone with variable steps.",
       joined(orders_of("C", {"constant", "alternating", "random"}),
              {{"dynamics.pure-damping-displacement.C", Role::supports},
               {"variable-step-stability.resonance.C", Role::limits},
               {"variable-step-stability.damping-cures.C", Role::supports},
               {"monotonicity.bounded.C", Role::supports},
               {"monotonicity.below-one.C", Role::supports},
               {"monotonicity.overdamped-sheet.bounded.C", Role::supports},
               {"monotonicity.overdamped-sheet.swings.C", Role::limits},
               {"monotonicity.alternates.C", Role::limits},
               {"monotonicity.beyond-the-bound.C", Role::limits}}),
       Standing::conditional,
       "order without condition; monotone for h c/2 < 1, beyond that only bounded, and that on linear "
       "motions; without damping, steps in turn can resonate though each alone is stable",
       "With alternating steps on a driven hinge the observed order of C is within "
       "{time-order.hinge.C.alternating.x} of two in positions and {time-order.hinge.C.alternating.v} in "
       "velocities, with random ones within {time-order.hinge.C.random.x} and {time-order.hinge.C.random.v}; "
       "on a sheet with random steps within {time-order.sheet.C.random.x} and {time-order.sheet.C.random.v}. "
       "But steps that are stable each by itself need not be so in turn: undamped, a long and a short one "
       "multiply a disturbance by {variable-step-stability.resonance.C|spectral radius of the pair|1} a pair "
       "under C, as under A and B; a damping ratio of a half cures it (radius "
       "{variable-step-stability.damping-cures.C}). A motion that is only damped comes no further than "
       "{monotonicity.bounded.C}, but swings about its end for h c/2 > 1."}};
}

std::vector<Claim> cost_and_momentum() {
  return {
      {"T19",
       "3",
       "C costs one more implicit solve a step than A and B.",
       {{"dynamics.solve-counts", Role::supports}},
       Standing::confirmed,
       "",
       "Counted on a sheet: {dynamics.solve-counts|solves a step|A} solve a step under A, "
       "{dynamics.solve-counts|solves a step|B} under B, {dynamics.solve-counts|solves a step|C} under C."},
      {"T20", "3", "Every scheme keeps the linear and the angular momentum of a free sheet (our reading).",
       joined(each({"A", "B", "C"}, "dynamics.linear-momentum-is-kept"),
              {{"momentum-drift.undamped.A", Role::supports},
               {"momentum-drift.undamped.B", Role::supports},
               {"momentum-drift.undamped.C", Role::supports},
               {"momentum-drift.damped.A", Role::supports},
               {"momentum-drift.damped.B", Role::supports},
               {"momentum-drift.damped.C.order", Role::contradicts},
               {"momentum-drift.damped.C.is-no-rounding", Role::contradicts}}),
       Standing::refuted, "",
       "Linear momentum is kept by all three. So is angular momentum without damping, and under A and B with "
       "it. But C moves the positions with one velocity and carries the momentum of another, and the two "
       "differ by damping: the angular momentum of a free, damped sheet drifts by "
       "{momentum-drift.damped.C.order|relative drift|first} of itself at a step of "
       "{momentum-drift.damped.C.order|step|first}, and by second order in the step (observed: "
       "{momentum-drift.damped.C.order|order of the pair|last})."}};
}

}  // namespace

std::vector<Claim> time_claims() {
  std::vector<Claim> claims;
  for (const auto& part : {orders_and_limits(), limits_of_explicit_methods(), damping_of_modes(),
                           linear_solve(), cached_terms_and_filters(), strain_claims(),
                           overshooting_methods(), monotone_methods(), variable_steps(), cost_and_momentum()})
    claims.insert(claims.end(), part.begin(), part.end());
  return claims;
}

}  // namespace foldproof
