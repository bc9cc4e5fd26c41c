// Derivatives of forces with respect to positions: of the elastic forces, and of all forces at
// fixed velocities, which Newton's method needs on damped cloth.
#include <optional>

#include "reference/dynamics/system.h"
#include "reference/forces/springs.h"
#include "verification/oracles/dense_algebra.h"
#include "verification/oracles/force_derivatives.h"
#include "verification/specimens/check.h"
#include "verification/specimens/differences.h"
#include "verification/specimens/probe.h"
#include "verification/specimens/random.h"
#include "verification/specimens/specimens.h"

namespace foldproof {

namespace {

using Matrix = Eigen::MatrixXd;

/// The reference's K at the specimen's state, column by column: 3N x 3N [N/m].
Matrix stiffness_of(const Specimen& specimen, Definiteness definiteness) {
  const System system = build_system(specimen.scene);
  Work uncounted;
  const ForceDifferential differential =
      elastic_differential_at(system.forces, specimen.state, definiteness, uncounted);
  return matrix_of(differential, specimen.state.x.cols());
}

Specimen with(Specimen specimen, const std::optional<BendingMaterial>& bending,
              const std::optional<StretchMaterial>& stretch) {
  specimen.scene.bending = bending;
  specimen.scene.stretch = stretch;
  return specimen;
}

BendingMaterial bending_by(std::string_view law, Weighting weighting) {
  return {0.0037, 0, weighting, DampingFactor::edge, law};
}

/// The largest difference in an entry of a hinge's matrix, in roundings of the largest entry times
/// the thinness squared.
oracles::Estimate entries_off(const Specimen& hinge, const Matrix& found,
                              const oracles::MatrixEstimate& exact) {
  const double scale =
      epsilon * largest_entry(exact.value) *
      std::pow(aspect_ratio(corners_of(hinge.scene.mesh.hinges[0], hinge.state.x)), 2);
  return {largest_entry(found - exact.value) / scale, exact.uncertainty / scale};
}

Finding hinge_is_second_derivative() {
  Table measured = roundings_of("the largest entry times the thinness squared");
  for (Specimen hinge : hinges_of_all_angles()) {
    hinge.scene.bending = bending_by("sine", Weighting::rest);
    const oracles::MatrixEstimate exact =
        oracles::bending_elastic_derivative_autodiff(hinge_input(hinge, 0));
    measured.row(hinge.name, entries_off(hinge, stiffness_of(hinge, Definiteness::exact), exact));
  }
  return judge_worst(measured, 16,
                     "an entry is a sum of four products of a dozen factors: 48 roundings of "
                     "either sign add up to some 7, twice that is allowed; a normal's rounding is "
                     "magnified by the triangle's thinness, its derivative's once more");
}

/// Sheets and hinges with each differentiable force: springs, both bending laws, both at once.
std::vector<Specimen> elastic_specimens() {
  std::vector<Specimen> all;
  const StretchMaterial springs{41.0, 0, 1.04};
  for (const Specimen& sheet : small_crumpled_sheets()) {
    all.push_back(with(sheet, {}, springs));
    all.push_back(with(sheet, bending_by("cubic", Weighting::rest), {}));
    all.push_back(with(sheet, bending_by("sine", Weighting::rest), springs));
  }
  return all;
}

/// dF/dx of the subject by central differences with Richardson extrapolation, 3N x 3N [N/m], and
/// the difference between the two steps.
struct EstimatedDerivative {
  Matrix K;
  double uncertainty;
};

EstimatedDerivative differences_of(const Probe& probe, const State& s) {
  const double step = 4e-4 * extent(s.x);
  const auto by = [&](double width) {
    return central_differences([&](const State& at) { return probe.elastic(at); }, s, width);
  };
  const Matrix coarse = by(step), fine = by(step / 2), finest = by(step / 4);
  const Matrix first = (4 * fine - coarse) / 3, second = (4 * finest - fine) / 3;
  return {(16 * second - first) / 15, largest_entry(second - first)};
}

Finding matches_differences(const Subject& subject) {
  Table measured{{"case", ""}, {"largest difference over the largest entry", "1"}};
  for (const Specimen& specimen : elastic_specimens()) {
    const EstimatedDerivative differences =
        differences_of(Probe(subject, specimen.scene), specimen.state);
    const double scale = largest_entry(differences.K);
    const Matrix difference = stiffness_of(specimen, Definiteness::exact) - differences.K;
    measured.row(specimen.name, oracles::Estimate{largest_entry(difference) / scale,
                                                  differences.uncertainty / scale});
  }
  return judge_worst(measured, 1e-9,
                     "rounding of differences at steps of 1e-4 of the cloth is epsilon over the "
                     "step, 2e-12, magnified some hundredfold by thin triangles; how far two "
                     "extrapolations disagree is added; a missing or wrong term is of order 1");
}

Finding is_symmetric() {
  Table measured = roundings_of("the largest entry");
  for (const Specimen& specimen : elastic_specimens())
    for (const Definiteness definiteness : {Definiteness::exact, Definiteness::semidefinite}) {
      const Matrix K = stiffness_of(specimen, definiteness);
      measured.row(specimen.name, largest_entry(K - K.transpose()) / (epsilon * largest_entry(K)));
    }
  return judge_worst(measured, 256,
                     "a hinge's rows and columns are summed by different formulas, each of a dozen "
                     "roundings magnified by crumpled triangles about ten times");
}

/// Distance of P from the negative semidefinite matrix nearest to A in the Frobenius norm, the only
/// one with P <= 0, A - P >= 0 and P (A - P) = 0; relative to |A|.
double projection_error(const Matrix& A, const Matrix& P) {
  const double scale = A.norm();
  Worst worst;
  worst.observe(oracles::symmetric_eigenvalues(P).maxCoeff() / scale);
  worst.observe(-oracles::symmetric_eigenvalues(A - P).minCoeff() / scale);
  worst.observe((P * (A - P)).norm() / (scale * scale));
  return worst.value() / epsilon;
}

Finding projection_is_nearest() {
  Table measured = roundings_of("the matrix");
  for (Specimen hinge : hinges_of_all_angles()) {
    hinge = with(hinge, bending_by("sine", Weighting::rest), {});
    const Matrix exact = stiffness_of(hinge, Definiteness::exact);
    measured.row(hinge.name,
                 projection_error(exact, stiffness_of(hinge, Definiteness::semidefinite)));
  }
  return judge_worst(measured, 64,
                     "the eigenvalue decomposition of a 12 x 12 matrix is good to a few dozen "
                     "roundings of its norm");
}

/// Error of one spring's derivatives at this stretch [1], by the reference alone.
double spring_error(double stretch) {
  StretchSprings springs{{{0, 1, 0.31, 23.0, 0}}};
  State s = resting_state(PerParticle3::Zero(3, 2));
  s.x.col(1) = stretch * 0.31 * Vector3(2, -1, 2) / 3;
  ForceDifferential exact, projected;
  springs.add_elastic_differential(s, Definiteness::exact, exact);
  springs.add_elastic_differential(s, Definiteness::semidefinite, projected);
  return projection_error(exact.pairs[0].block, projected.pairs[0].block);
}

Finding spring_projection_is_nearest() {
  Table measured = roundings_of("the matrix");
  for (const double stretch : {0.43, 0.97, 1.02, 1.7})
    measured.row("length over rest length " + std::to_string(stretch), spring_error(stretch));
  return judge_worst(measured, 16, "a 3 x 3 matrix of a few products");
}

Finding semidefinite_only_resists() {
  Table measured = roundings_of("the largest entry");
  for (const Specimen& specimen : elastic_specimens()) {
    const Matrix K = stiffness_of(specimen, Definiteness::semidefinite);
    const Eigen::VectorXd values = oracles::symmetric_eigenvalues(0.5 * (K + K.transpose()));
    measured.row(specimen.name, values.maxCoeff() / (epsilon * largest_entry(K)));
  }
  return judge_worst(
      measured, 256,
      "a sum of some hundred negative semidefinite blocks, each so to a few dozen roundings");
}

// ---- all forces

Matrix derivative_of(const Specimen& specimen) {
  return force_derivative(specimen.scene, specimen.state);
}

/// Both damping factors with both weightings; damping and stiffness of similar size.
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
      measured.row(describe(hinge, material), entries_off(hinge, derivative_of(hinge), exact));
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

Finding all_forces_match_differences(const Subject& subject) {
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

std::vector<Check> differential_checks() {
  const std::string what =
      "calculus; the methods BMF03 section 3 compares its schemes with need it";
  const std::string projection = "Teran et al. 2005, section 6; Higham 1988";
  return {
      {"elastic-differential.hinge-matches-exact-derivative",
       "The reference's hinge stiffness is the derivative of its force: 50 digits, autodiff, every "
       "angle.",
       what, hinge_is_second_derivative},
      {"elastic-differential.whole-matches-force-differences",
       "The reference's elastic derivative is the derivative of the subject's forces, for springs, "
       "both bending laws, and their sum.",
       what, matches_differences},
      {"elastic-differential.is-symmetric", "The reference's elastic derivative is symmetric.",
       what, is_symmetric},
      {"elastic-differential.hinge-projection-is-nearest-semidefinite",
       "A hinge's semidefinite stiffness is the negative semidefinite matrix nearest to the exact "
       "one.",
       projection, projection_is_nearest},
      {"elastic-differential.spring-projection-is-nearest-semidefinite",
       "A spring's semidefinite stiffness is the negative semidefinite matrix nearest to the exact "
       "one.",
       projection, spring_projection_is_nearest},
      {"elastic-differential.semidefinite-form-resists-every-displacement",
       "With semidefinite elements no displacement of a crumpled sheet is pushed further.",
       projection, semidefinite_only_resists},
      {"force-differential.hinge-matches-exact-derivative",
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
       what, all_forces_match_differences}};
}

}  // namespace foldproof
