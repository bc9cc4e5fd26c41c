// The derivative of all forces by the positions while the velocities stay, which Newton's method
// needs on damped cloth.
#include <optional>

#include "reference/dynamics/system.h"
#include "reference/forces/springs.h"
#include "verification/oracles/force_derivatives.h"
#include "verification/specimens/check.h"
#include "verification/specimens/differences.h"
#include "verification/specimens/probe.h"
#include "verification/specimens/random.h"
#include "verification/specimens/specimens.h"

namespace foldproof {

namespace {

using Matrix = Eigen::MatrixXd;

Matrix derivative_of(const Specimen& specimen) {
  return force_derivative(specimen.scene, specimen.state);
}

/// Both factors of the damping with both weightings, damping and stiffness of like size.
std::vector<BendingMaterial> moving_materials() {
  return {{0.0037, 0.00053, Weighting::rest, DampingFactor::edge, "sine"},
          {0.0019, 0.0071, Weighting::current, DampingFactor::edge_squared_over_area, "sine"}};
}

Finding hinge_is_derivative() {
  Table measured = roundings_of("the largest entry times the thinness squared");
  for (const BendingMaterial& material : moving_materials())
    for (Specimen hinge : hinges_of_all_angles()) {
      hinge.scene.bending = material;
      const oracles::MatrixEstimate exact =
          oracles::bending_force_derivative_autodiff(hinge_input(hinge, 0));
      const double scale =
          epsilon * largest_entry(exact.value) *
          std::pow(aspect_ratio(corners_of(hinge.scene.mesh.hinges[0], hinge.state.x)), 2);
      const Matrix difference = derivative_of(hinge) - exact.value;
      measured.row(describe(hinge, material),
                   oracles::Estimate{largest_entry(difference) / scale, exact.uncertainty / scale});
    }
  return judge_worst(measured, 16,
                     "an entry is a sum of eight products of a dozen factors: a hundred roundings "
                     "of either sign add up to some 10; a normal's rounding is magnified by the "
                     "triangle's thinness, its derivative's once more");
}

Finding spring_is_derivative() {
  Table measured = roundings_of("the largest entry");
  Random random(67);
  for (const double stretch : {0.43, 0.97, 1.02, 1.7}) {
    // on the oracle's side Y A/L0^2 and kd A/L0^2
    const double area = 0.23, rest = 0.31, young = 7.9, damping = 0.59,
                 shape = area / (rest * rest);
    const StretchSprings springs{{{0, 1, rest, young * shape, damping * shape}}};
    State s = resting_state(random.vectors(2, 0.4));
    s.x.col(1) = s.x.col(0) + stretch * rest * (s.x.col(1) - s.x.col(0)).normalized();
    s.v = random.vectors(2, 1.3);
    ForceDifferential differential;
    springs.add_force_differential(s, differential);
    const oracles::SpringMatrixEstimate exact = oracles::spring_force_derivative_autodiff(
        {{s.x.col(0), s.x.col(1)}, {s.v.col(0), s.v.col(1)}, {young, damping, area, rest}});
    const double scale = epsilon * largest_entry(exact.value);
    measured.row("length over rest length " + std::to_string(stretch),
                 oracles::Estimate{largest_entry(matrix_of(differential, 2) - exact.value) / scale,
                                   exact.uncertainty / scale});
  }
  return judge_worst(
      measured, 32,
      "a 3 x 3 matrix of a dozen products; length less rest length loses a few roundings");
}

Finding matches_differences(const Subject& subject) {
  Table measured{{"case", ""}, {"largest difference over the largest entry", "1"}};
  for (Specimen sheet : small_crumpled_sheets())
    for (const BendingMaterial& material : moving_materials()) {
      sheet.scene.bending = material;
      sheet.scene.stretch = StretchMaterial{41, 0.31, 1.04};
      const Probe probe(subject, sheet.scene);
      const Matrix expected =
          differences_of_forces(probe, sheet.state, 1e-4 * extent(sheet.state.x));
      measured.row(describe(sheet, material),
                   largest_entry(derivative_of(sheet) - expected) / largest_entry(expected));
    }
  return judge_worst(
      measured, 1e-9,
      "rounding of differences at steps of 1e-4 of the cloth is epsilon over the step, 2e-12, "
      "magnified some hundredfold by thin triangles; a missing or wrong term is of order 1");
}

/// Damping force and derivative of these springs at s, side by side: 3N x (3N + 1).
Matrix damped_answers(const StretchSprings& springs, const State& s) {
  DampingOperator damping;
  springs.prepare_damping(s, springs.shapes_at(s.x), damping);
  PerParticle3 force = PerParticle3::Zero(3, s.x.cols());
  damping.add_product(s.v, force);
  ForceDifferential differential;
  springs.add_force_differential(s, differential);
  Matrix answers(s.x.size(), s.x.size() + 1);
  answers << matrix_of(differential, s.x.cols()), force.reshaped();
  return answers;
}

Finding springs_answer_for_themselves() {
  Table measured = roundings_of("the largest entry");
  Random random(71);
  const StretchSprings all{
      {{0, 1, 0.31, 7.9, 0.59}, {1, 2, 0.23, 5.3, 0}, {2, 3, 0.37, 3.1, 0.83}}};
  for (int k = 0; k < 4; ++k) {
    State s = resting_state(random.vectors(4, 0.4));
    s.v = random.vectors(4, 1.3);
    Matrix sum = Matrix::Zero(12, 13);
    for (const Spring& one : all.springs) sum += damped_answers({{one}}, s);
    measured.row("three springs, place " + std::to_string(k + 1),
                 largest_entry(damped_answers(all, s) - sum) / (epsilon * largest_entry(sum)));
  }
  return judge_worst(measured, 8, "the same terms, added in another order");
}

struct Variant {
  std::string name;
  std::optional<StretchMaterial> stretch;
  std::optional<BendingMaterial> bending;
};

Finding flag_is_right() {
  Table measured{{"case", ""}, {"derivatives wrongly marked as symmetric, or wrongly not", "1"}};
  const BendingMaterial plain{0.0037, 0, Weighting::rest, DampingFactor::edge, "sine"};
  const std::vector<Variant> variants = {
      {"springs", StretchMaterial{41, 0, 1.04}, {}},
      {"damped springs", StretchMaterial{41, 0.31, 1.04}, {}},
      {"hinges", {}, plain},
      {"damped hinges", {}, moving_materials()[0]},
      {"hinges by their current weights", {}, bending_variants()[1]}};
  for (const Specimen& sheet : small_crumpled_sheets())
    for (const Variant& variant : variants) {
      Scene scene = sheet.scene;
      scene.stretch = variant.stretch;
      scene.bending = variant.bending;
      const Matrix K = force_derivative(scene, sheet.state);
      const bool is_symmetric = largest_entry(K - K.transpose()) <= 1e-9 * largest_entry(K);
      const System system = build_system(scene);
      Work uncounted;
      const bool is_called = force_differential_at(system.forces, sheet.state, uncounted).symmetric;
      measured.row(sheet.name + ", " + variant.name, is_called == is_symmetric ? 0 : 1);
    }
  return judge_worst(measured, 0,
                     "it decides the solver: conjugate gradients need a symmetric matrix");
}

}  // namespace

std::vector<Check> force_differential_checks() {
  const std::string what =
      "calculus; the methods BMF03 section 3 compares its schemes with need it";
  return {{"force-differential.hinge-matches-exact-derivative",
           "How the reference's elastic and damping forces of a hinge change with the positions at "
           "given velocities is their derivative: 50 digits, autodiff, every angle, both factors, "
           "both weightings.",
           what, hinge_is_derivative},
          {"force-differential.spring-matches-exact-derivative",
           "How the reference's elastic and damping forces of a spring change with the positions "
           "at given velocities is their derivative: 50 digits, autodiff.",
           what, spring_is_derivative},
          {"force-differential.several-springs-add-up",
           "Damping and derivative of several springs, some of them without damping, are the sums "
           "of each one's.",
           what, springs_answer_for_themselves},
          {"force-differential.symmetry-is-reported-correctly",
           "The derivative is marked as symmetric exactly where its matrix is: without damping and "
           "current weights.",
           what, flag_is_right},
          {"force-differential.whole-matches-force-differences",
           "The reference's derivative of all forces at given velocities is that of the subject's "
           "forces, on sheets of damped springs and hinges.",
           what, matches_differences}};
}

}  // namespace foldproof
