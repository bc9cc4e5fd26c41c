#include "verification/oracles/dense_algebra.h"
#include "verification/specimens/check.h"
#include "verification/specimens/differences.h"
#include "verification/specimens/probe.h"
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

Finding hinge_is_second_derivative() {
  Table measured = roundings_of("the largest entry times the thinness squared");
  for (Specimen hinge : hinges_of_all_angles()) {
    hinge.scene.bending = bending_by("sine", Weighting::rest);
    const oracles::MatrixEstimate exact =
        oracles::bending_elastic_derivative_autodiff(hinge_input(hinge, 0));
    const double scale =
        epsilon * largest_entry(exact.value) *
        std::pow(aspect_ratio(corners_of(hinge.scene.mesh.hinges[0], hinge.state.x)), 2);
    const Matrix difference = stiffness_of(hinge, Definiteness::exact) - exact.value;
    measured.row(hinge.name,
                 oracles::Estimate{largest_entry(difference) / scale, exact.uncertainty / scale});
  }
  return judge_worst(measured, 16,
                     "an entry is a sum of four products of a dozen factors: 48 roundings of "
                     "either sign add up to some 7, twice that is allowed; a normal's rounding is "
                     "magnified by the triangle's thinness, its derivative's once more");
}

/// Sheets and hinges with all that has a derivative: springs, both laws of bending, both at once.
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

/// dF/dx of the subject by central differences with Richardson's extrapolation, 3N x 3N [N/m], and
/// how far the two steps disagree.
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

/// How far P is from the nearest negative semidefinite matrix to A in the Frobenius norm, which
/// alone has P <= 0, A - P >= 0 and P (A - P) = 0; relative to |A|.
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

/// Two particles and the one spring of their length, by the reference alone.
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
  };
}

}  // namespace foldproof
